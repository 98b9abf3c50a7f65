"""Behaviours between transforms and the blackboard."""

from __future__ import annotations

from typing import Any

import py_trees
from geometry_msgs.msg import Transform, TransformStamped
from py_trees.common import Access, ClearingPolicy, Status

from py_trees_ros.utilities import node_among
from rclpy.time import Time
from tf2_ros import (
    Buffer,
    StaticTransformBroadcaster,
    TransformBroadcaster,
    TransformListener,
)

__all__ = ["FromBlackboard", "ToBlackboard"]


class FromBlackboard(py_trees.behaviour.Behaviour):
    """Broadcasts a `Transform` from the blackboard with the current time; fails without one.

    Args:
        name: The behaviour's name.
        variable_name: The key.
        target_frame: The child frame of the transform.
        source_frame: The parent frame of the transform.
        static: Whether to send it to /tf_static.
        qos_profile: The profile for /tf.
        static_qos_profile: The profile for /tf_static; tf2's by default.
    """

    def __init__(
        self,
        name: str,
        variable_name: str,
        target_frame: str,
        source_frame: str,
        static: bool,
        qos_profile: Any,
        static_qos_profile: Any = None,
    ) -> None:
        super().__init__(name=name)
        self.blackboard = self.attach_blackboard_client(name)
        self.variable_name = variable_name
        self.target_frame = target_frame
        self.source_frame = source_frame
        self.static = static
        self.qos_profile = qos_profile
        self.static_qos_profile = static_qos_profile
        self.blackboard.register_key(key=self.variable_name, access=Access.READ)

    def setup(self, **kwargs: Any) -> None:
        """Create the broadcaster.

        Raises:
            KeyError: The argument ``node`` is missing.
        """
        self.node = node_among(kwargs, self)
        self.broadcaster: Any
        if self.static:
            self.broadcaster = StaticTransformBroadcaster(self.node, qos=self.static_qos_profile)
        else:
            self.broadcaster = TransformBroadcaster(self.node, qos=self.qos_profile)

    def update(self) -> Status:
        """Broadcast.

        Raises:
            TypeError: The value is not a `Transform`.
        """
        transform = None
        if self.blackboard.exists(self.variable_name):
            transform = self.blackboard.get(self.variable_name)
        if transform is None:
            self.feedback_message = "no transform to broadcast"
            return Status.FAILURE
        if type(transform) is not Transform:
            raise TypeError(f"'{self.variable_name}' is not of type geometry_msgs/Transform")
        stamped = TransformStamped(child_frame_id=self.target_frame, transform=transform)
        stamped.header.stamp = self.node.get_clock().now().to_msg()
        stamped.header.frame_id = self.source_frame
        self.broadcaster.sendTransform(stamped)
        self.feedback_message = "transform sent"
        return Status.SUCCESS


class ToBlackboard(py_trees.behaviour.Behaviour):
    """Writes the newest transform to the blackboard as a `TransformStamped`; runs without one.

    Args:
        name: The behaviour's name.
        variable_name: The key, whose value is None until there is a transform.
        target_frame: The frame to transform to.
        source_frame: The frame to transform from.
        qos_profile: The profile for /tf.
        static_qos_profile: The profile for /tf_static; tf2's by default.
        clearing_policy: Whether it is reset to None when the behaviour starts again (ON_INITIALISE)
            or kept (NEVER).

    Raises:
        TypeError: The policy is ON_SUCCESS.
    """

    def __init__(
        self,
        name: str,
        variable_name: str,
        target_frame: str,
        source_frame: str,
        qos_profile: Any,
        static_qos_profile: Any = None,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name=name)
        if clearing_policy is ClearingPolicy.ON_SUCCESS:
            raise TypeError("ON_SUCCESS is not a valid policy for transforms.ToBlackboard")
        self.variable_name = variable_name
        self.blackboard = self.attach_blackboard_client(name)
        self.blackboard.register_key(key=self.variable_name, access=Access.WRITE)
        self.target_frame = target_frame
        self.source_frame = source_frame
        self.qos_profile = qos_profile
        self.static_qos_profile = static_qos_profile
        self.clearing_policy = clearing_policy
        self.buffer: Any = Buffer()
        self.blackboard.set(self.variable_name, None)

    def setup(self, **kwargs: Any) -> None:
        """Listen to transforms.

        Raises:
            KeyError: The argument ``node`` is missing.
        """
        self.node = node_among(kwargs, self)
        self.listener = TransformListener(
            self.buffer, self.node, qos=self.qos_profile, static_qos=self.static_qos_profile
        )

    def initialise(self) -> None:
        """Write None if the policy says so."""
        if self.clearing_policy is ClearingPolicy.ON_INITIALISE:
            self.blackboard.set(self.variable_name, None)

    def update(self) -> Status:
        """Write the newest transform if there is one."""
        frames = self.target_frame, self.source_frame
        if not self.buffer.can_transform(*frames, Time()):
            self.feedback_message = "waiting for transform"
            return Status.RUNNING
        self.blackboard.set(self.variable_name, self.buffer.lookup_transform(*frames, Time()))
        self.feedback_message = f"transform saved to {self.variable_name}"
        return Status.SUCCESS
