"""Requests transforms from a server, in a thread that may block."""

from __future__ import annotations

import threading
from typing import Any

from aionode.tf import TimeoutException, TransformException
from aionode.tf.buffer_core import time_ns_of
from aionode.tf.remote import transform_in
from rclpy.action.client import ActionClient
from rclpy.duration import Duration
from rclpy.time import Time
from rosidl_generator_py import action_class
from tf2_ros.buffer_interface import NOW, BufferInterface

__all__ = ["BufferClient"]

HANGS = "Something is likely wrong with the server."


class BufferClient(BufferInterface):
    """Requests transforms from a server; another thread has to spin its node.

    Args:
        node: The node that asks.
        ns: The name of the server's action.
        check_frequency: Not used: the client waits for the answer without polling.
        timeout_padding: How much longer than the server to wait.
    """

    def __init__(
        self,
        node: Any,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = Duration(seconds=2.0),  # noqa: B008  # it cannot be changed
    ) -> None:
        super().__init__()
        self.node = node
        self.action_client: Any = ActionClient(
            node, action_class("tf2_msgs/action/LookupTransform"), ns
        )
        self.check_frequency = check_frequency
        self.timeout_padding = timeout_padding

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NOW
    ) -> Any:
        """Return the transform between two frames.

        Raises:
            TransformException: it is not available, or the server does not answer.
        """
        return self._BufferClient__ask(
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=stamp(time),
            timeout=timeout.to_msg(),
        )

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> Any:
        """Return the transform between two frames at two times; see `lookup_transform`."""
        return self._BufferClient__ask(
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=stamp(source_time),
            timeout=timeout.to_msg(),
            target_time=stamp(target_time),
            fixed_frame=fixed_frame,
            advanced=True,
        )

    def can_transform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NOW
    ) -> bool:
        """Return whether a transform is available."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> bool:
        """Return whether a transform between two times is available."""
        try:
            self.lookup_transform_full(
                target_frame, target_time, source_frame, source_time, fixed_frame, timeout
            )
        except TransformException:
            return False
        return True

    def _BufferClient__ask(self, **fields: Any) -> Any:
        goal = action_class("tf2_msgs/action/LookupTransform").Goal(**fields)
        if not self.action_client.server_is_ready():
            raise TimeoutException("The BufferServer is not ready.")
        limit_s = (time_ns_of(goal.timeout) + self.timeout_padding.nanoseconds) / 1e9
        sent = "The LookupTransform goal sent to the BufferServer did not come back"
        handle = outcome(
            self.action_client.send_goal_async(goal),
            limit_s,
            f"{sent} in the specified time. {HANGS}",
        )
        if not handle.accepted:
            raise TimeoutException(f"{sent} with accepted status. {HANGS}")
        answer = outcome(
            handle.get_result_async(), limit_s, f"{sent} in the specified time. {HANGS}"
        )
        return transform_in(answer.result)

    def destroy(self) -> None:
        """Destroy the action client."""
        self.action_client.destroy()


def outcome(future: Any, limit_s: float, text: str) -> Any:
    """Block until a future is done, and return its result; TimeoutException after the limit."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    if not done.wait(limit_s):
        raise TimeoutException(text)
    return future.result()


def stamp(time: Any) -> Any:
    """Return a time as a message."""
    return Time(nanoseconds=time_ns_of(time)).to_msg()
