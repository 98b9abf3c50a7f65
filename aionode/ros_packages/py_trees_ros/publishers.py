"""A behaviour that publishes a message from the blackboard."""

from __future__ import annotations

from typing import Any

import py_trees
from py_trees.common import Access, Status

from py_trees_ros.utilities import node_among

__all__ = ["FromBlackboard"]


class FromBlackboard(py_trees.behaviour.Behaviour):
    """Publishes a message from the blackboard at each tick; fails if there is none.

    Args:
        name: The behaviour's name.
        topic_name: The topic.
        topic_type: The class of its messages.
        qos_profile: The profile of the publisher.
        blackboard_variable: The key, or a part of its value, such as ``state.pose``.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: Any,
        blackboard_variable: str,
    ) -> None:
        super().__init__(name=name)
        self.topic_name = topic_name
        self.topic_type = topic_type
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard_variable = blackboard_variable
        self.key = blackboard_variable.partition(".")[0]
        self.blackboard.register_key(key=self.key, access=Access.READ)
        self.publisher: Any = None
        self.qos_profile = qos_profile
        self.node: Any = None

    def setup(self, **kwargs: Any) -> None:
        """Create the publisher.

        Raises:
            KeyError: The argument ``node`` is missing.
        """
        self.node = node_among(kwargs, self)
        self.publisher = self.node.create_publisher(
            self.topic_type, self.topic_name, self.qos_profile
        )

    def update(self) -> Status:
        """Publish.

        Raises:
            TypeError: The value is not a message of the topic's type.
        """
        self.logger.debug(f"{type(self).__name__}.update()")
        try:
            message = self.blackboard.get(self.blackboard_variable)
        except KeyError:
            self.feedback_message = "nothing to publish"
            return Status.FAILURE
        if not isinstance(message, self.topic_type):
            raise TypeError(
                f"{self.blackboard_variable} is not the required type "
                f"[{self.topic_type}][{type(message)}]"
            )
        self.publisher.publish(message)
        self.feedback_message = "published"
        return Status.SUCCESS
