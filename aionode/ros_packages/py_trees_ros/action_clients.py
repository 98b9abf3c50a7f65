"""Behaviours that send goals to an action, and cancel them when they are interrupted."""

from __future__ import annotations

import uuid
from abc import ABC, abstractmethod
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

import py_trees
from action_msgs.msg import GoalStatus
from py_trees.blackboard import Blackboard
from py_trees.common import Access, Status

from py_trees_ros._waiting import wait_for_server
from py_trees_ros.utilities import node_among
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import ActionClient
from rclpy.exceptions import InvalidHandle

__all__ = ["AttributesFromBlackboard", "FromBlackboard", "FromCallback", "FromConstant"]

STATUS_STRINGS: Final = {
    getattr(GoalStatus, name): name
    for name in (
        "STATUS_UNKNOWN",
        "STATUS_ACCEPTED",
        "STATUS_EXECUTING",
        "STATUS_CANCELING",
        "STATUS_SUCCEEDED",
        "STATUS_CANCELED",
        "STATUS_ABORTED",
    )
}


class FromBlackboard(py_trees.behaviour.Behaviour):
    """Sends a goal from the blackboard, and runs until it has ended.

    It fails if there is no goal, or if the goal is rejected or does not succeed. A goal is
    cancelled when the behaviour is interrupted, even if it is accepted only later, and when the
    tree is shut down. A behaviour whose server is gone keeps running, and warns once for each goal.

    Args:
        name: The behaviour's name.
        action_type: The class of the action.
        action_name: The action's name.
        key: The key of the goal.
        generate_feedback_message: Converts a feedback message to text.
        wait_for_server_timeout_sec: How long `setup` waits for the server; negative to wait
            forever, with a warning each time that many seconds have passed, and 0 not to wait.
        callback_group: The callback group of the client.
    """

    def __init__(
        self,
        name: str,
        action_type: Any,
        action_name: str,
        key: str,
        generate_feedback_message: Callable[[Any], str] | None = None,
        wait_for_server_timeout_sec: float = -3.0,
        callback_group: Any = None,
    ) -> None:
        super().__init__(name)
        self.action_type = action_type
        self.action_name = action_name
        self.wait_for_server_timeout_sec = wait_for_server_timeout_sec
        self.callback_group = callback_group
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard.register_key(
            key="goal", access=Access.READ, remap_to=Blackboard.absolute_name("/", key)
        )
        self.generate_feedback_message = generate_feedback_message
        self.node: Any = None
        self.action_client: Any = None
        self.status_strings = STATUS_STRINGS
        self._forget()

    def _forget(self) -> None:
        self.goal_handle: Any = None
        self.send_goal_future: Any = None
        self.get_result_future: Any = None
        self.result_message: Any = None
        self.result_status: int | None = None
        self.result_status_string: str | None = None
        self._has_warned = False

    def setup(self, **kwargs: Any) -> None:
        """Create the client, and wait for the server.

        Raises:
            KeyError: The argument ``node`` is missing.
            TimedOutError: The server does not become available in time.
        """
        self.logger.debug(f"{self.qualified_name}.setup()")
        self.node = node_among(kwargs, self)
        client = self.action_client = ActionClient(
            self.node, self.action_type, self.action_name, callback_group=self.callback_group
        )
        wait_for_server(
            self,
            client.wait_for_server,
            self.wait_for_server_timeout_sec,
            "action",
            self.action_name,
        )

    def initialise(self) -> None:
        """Send the goal, if there is one."""
        self.logger.debug(f"{self.qualified_name}.initialise()")
        self._forget()
        try:
            goal = self.blackboard.goal
        except KeyError:
            return
        try:
            self.send_goal_request(goal)
        except TypeError:
            self.logger.error(  # noqa: TRY400  # the logger of py_trees
                f"Received a goal of type <{type(goal).__name__}> instead of "
                f"<{self.action_type.Goal.__name__}>"
            )
        else:
            self.feedback_message = "sent goal request"

    def update(self) -> Status:
        """Check the state of the goal."""
        self.logger.debug(f"{self.qualified_name}.update()")
        if self.send_goal_future is None:
            self.feedback_message = "no goal to send"
            return Status.FAILURE
        if self.goal_handle is not None and not self.goal_handle.accepted:
            self.feedback_message = "goal rejected"
            return Status.FAILURE
        if self.result_status is None:
            self._warn_without_server()
            return Status.RUNNING
        log = self.node.get_logger()
        log.debug(f"goal result [{self.qualified_name}]")
        log.debug(f"  status: {self.result_status_string}")
        log.debug(f"  message: {self.result_message}")
        if self.result_status == GoalStatus.STATUS_SUCCEEDED:
            self.feedback_message = "successfully completed"
            return Status.SUCCESS
        self.feedback_message = "failed"
        return Status.FAILURE

    def _warn_without_server(self) -> None:
        if self._has_warned:
            return
        with suppress(RCLError):  # a signal has shut the context down
            if not self.action_client.server_is_ready():
                self._has_warned = True
                self.feedback_message = f"no action server [{self.action_name}], still waiting"
                self.node.get_logger().warning(f"{self.feedback_message} [{self.qualified_name}]")

    def terminate(self, new_status: Status) -> None:
        """Cancel the goal if the behaviour is interrupted."""
        self.logger.debug(f"{self.qualified_name}.terminate({self.status}->{new_status})")
        if self.status is Status.RUNNING and new_status is Status.INVALID:
            self.send_cancel_request()

    def shutdown(self) -> None:
        """Cancel the goal that is under way, and destroy the client."""
        if self.action_client is None:
            return
        if self.status is Status.RUNNING:
            with suppress(InvalidHandle, RCLError):  # the node or its context ended before the tree
                self.send_cancel_request()
            self._forget()
        self.action_client.destroy()

    def feedback_callback(self, msg: Any) -> None:
        """Use feedback of the server as feedback of the behaviour."""
        if self.generate_feedback_message is not None:
            self.feedback_message = f"feedback: {self.generate_feedback_message(msg)}"
            self.node.get_logger().debug(f"{self.feedback_message} [{self.qualified_name}]")

    def send_goal_request(self, goal: Any) -> None:
        """Send a goal.

        Raises:
            TypeError: It is not a goal of the action.
        """
        self.feedback_message = "sending goal ..."
        self.node.get_logger().debug(f"{self.feedback_message} [{self.qualified_name}]")
        self.send_goal_future = self.action_client.send_goal_async(
            goal, feedback_callback=self.feedback_callback
        )
        self.send_goal_future.add_done_callback(self.goal_response_callback)

    def goal_response_callback(self, future: Any) -> None:
        """Request the result of an accepted goal; cancel it if it is no longer wanted."""
        handle = None if future.exception() is not None else future.result()
        if future is not self.send_goal_future:
            if handle is not None and handle.accepted:
                handle.cancel_goal_async().add_done_callback(self.cancel_response_callback)
            return
        if handle is None:
            self.feedback_message = (
                f"goal request failed :[ [{self.qualified_name}]\n{future.exception()!r}"
            )
            self.node.get_logger().debug(f"... {self.feedback_message}")
            return
        self.goal_handle = handle
        how = "accepted :)" if handle.accepted else "rejected :("
        self.feedback_message = f"goal {how} [{self.qualified_name}]"
        self.node.get_logger().debug(f"... {self.feedback_message}")
        if handle.accepted:
            self.get_result_future = handle.get_result_async()
            self.get_result_future.add_done_callback(self.get_result_callback)

    def send_cancel_request(self) -> None:
        """Cancel the goal, now or as soon as the server accepts it."""
        self.feedback_message = f"cancelling goal ... [{self.qualified_name}]"
        self.node.get_logger().debug(self.feedback_message)
        if self.goal_handle is None:
            self.send_goal_future = None
        else:
            future = self.goal_handle.cancel_goal_async()
            future.add_done_callback(self.cancel_response_callback)

    def cancel_response_callback(self, future: Any) -> None:
        """Log whether the server accepted the cancellation."""
        how = "successfully cancelled" if future.result().goals_canceling else "failed to cancel"
        self.feedback_message = f"goal {how} [{self.qualified_name}]"
        self.node.get_logger().debug(f"... {self.feedback_message}")

    def get_result_callback(self, future: Any) -> None:
        """Keep the result of the goal for the next tick."""
        if future is not self.get_result_future:
            return
        self.result_message = future.result()
        self.result_status = self.result_message.status
        self.result_status_string = STATUS_STRINGS.get(self.result_status, "STATUS_UNKNOWN")


class FromConstant(FromBlackboard):
    """Always sends the same goal.

    Args:
        name: The behaviour's name.
        action_type: The class of the action.
        action_name: The action's name.
        action_goal: The goal.
        generate_feedback_message: Converts a feedback message to text.
        wait_for_server_timeout_sec: As for `FromBlackboard`.
    """

    def __init__(
        self,
        name: str,
        action_type: Any,
        action_name: str,
        action_goal: Any,
        generate_feedback_message: Callable[[Any], str] | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        key = f"/goal_{uuid.uuid4()}"
        super().__init__(
            name=name,
            action_type=action_type,
            action_name=action_name,
            key=key,
            generate_feedback_message=generate_feedback_message,
            wait_for_server_timeout_sec=wait_for_server_timeout_sec,
        )
        self.blackboard.register_key(key=key, access=Access.WRITE)
        self.blackboard.set(name=key, value=action_goal)


class FromCallback(FromBlackboard, ABC):
    """Sends the goal that `get_goal` of a subclass returns.

    Args:
        name: The behaviour's name.
        action_type: The class of the action.
        action_name: The action's name.
        generate_feedback_message: Converts a feedback message to text.
        wait_for_server_timeout_sec: As for `FromBlackboard`.
    """

    def __init__(
        self,
        name: str,
        action_type: Any,
        action_name: str,
        generate_feedback_message: Callable[[Any], str] | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        self.key = f"/goal_{uuid.uuid4()}"
        super().__init__(
            name=name,
            action_type=action_type,
            action_name=action_name,
            key=self.key,
            generate_feedback_message=generate_feedback_message,
            wait_for_server_timeout_sec=wait_for_server_timeout_sec,
        )
        self.blackboard.register_key(key=self.key, access=Access.WRITE)

    def initialise(self) -> None:
        """Get the goal, and send it."""
        self.blackboard.set(name=self.key, value=self.get_goal())
        super().initialise()

    @abstractmethod
    def get_goal(self) -> Any:
        """Return the goal."""


class AttributesFromBlackboard(FromCallback):
    """Sends a goal whose fields are on the blackboard.

    Args:
        name: The behaviour's name.
        action_type: The class of the action.
        action_name: The action's name.
        goal_fields: The key of each field.
        generate_feedback_message: Converts a feedback message to text.
        wait_for_server_timeout_sec: As for `FromBlackboard`.
    """

    def __init__(
        self,
        name: str,
        action_type: Any,
        action_name: str,
        goal_fields: dict[str, str],
        generate_feedback_message: Callable[[Any], str] | None = None,
        wait_for_server_timeout_sec: float = -3.0,
    ) -> None:
        super().__init__(
            name, action_type, action_name, generate_feedback_message, wait_for_server_timeout_sec
        )
        self.goal_fields = goal_fields
        for key in goal_fields.values():
            self.blackboard.register_key(key=key, access=Access.READ)

    def get_goal(self) -> Any:
        """Return a goal made of values on the blackboard.

        Raises:
            KeyError: A field is missing.
        """
        fields = {field: self.blackboard.get(key) for field, key in self.goal_fields.items()}
        return self.action_type.Goal(**fields)
