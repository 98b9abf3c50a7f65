"""A server for any action, which only waits."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.parameter import Parameter

__all__ = ["GenericServer"]


class GenericServer:
    """A node whose action server accepts a goal, waits, and succeeds; a new goal preempts it.

    The parameter ``duration`` sets how long the next goal takes, in seconds.

    Args:
        node_name: The name of the node.
        action_name: The name of the action.
        action_type: The class of the action.
        generate_feedback_message: Creates the feedback.
        generate_cancelled_result: Creates the result of a cancelled goal.
        generate_preempted_result: Creates the result of a preempted goal.
        generate_success_result: Creates the result of a goal that succeeds.
        goal_received_callback: Called with each goal.
        duration: The initial value of the parameter; 5 seconds by default.
    """

    def __init__(
        self,
        node_name: str,
        action_name: str,
        action_type: Any,
        generate_feedback_message: Callable[[], Any] | None = None,
        generate_cancelled_result: Callable[[], Any] | None = None,
        generate_preempted_result: Callable[[], Any] | None = None,
        generate_success_result: Callable[[], Any] | None = None,
        goal_received_callback: Callable[[Any], Any] = lambda _: None,
        duration: float | None = None,
    ) -> None:
        value = 5.0 if duration is None else float(duration)
        self.node = rclpy.create_node(
            node_name,
            parameter_overrides=[Parameter("duration", value=value)],
            automatically_declare_parameters_from_overrides=True,
        )
        self.duration = self.node.get_parameter("duration").value
        self.goal_handle: Any = None
        self.goal_lock = threading.Lock()
        self.frequency = 3.0
        self.percent_completed = 0.0
        self.action_type = action_type

        def result_of(message: str) -> Callable[[], Any]:
            return lambda: action_type.Result(message=message)

        self.generate_feedback_message = generate_feedback_message or action_type.Feedback
        self.generate_cancelled_result = generate_cancelled_result or result_of("goal cancelled")
        self.generate_preempted_result = generate_preempted_result or result_of("goal pre-empted")
        self.generate_success_result = generate_success_result or result_of(
            "goal executed with success"
        )
        self.goal_received_callback = goal_received_callback
        self.action_server: Any = ActionServer(
            self.node,
            action_type,
            action_name,
            callback_group=ReentrantCallbackGroup(),
            cancel_callback=self.cancel_callback,
            execute_callback=self.execute_goal_callback,
            goal_callback=self.goal_callback,
            handle_accepted_callback=self.handle_accepted_callback,
            result_timeout=10,
        )

    def goal_callback(self, goal_request: Any) -> GoalResponse:
        """Accept a goal."""
        self.node.get_logger().info("received a goal")
        self.goal_received_callback(goal_request)
        self.percent_completed = 0.0
        self.duration = self.node.get_parameter("duration").value
        return GoalResponse.ACCEPT

    def cancel_callback(self, goal_handle: Any) -> CancelResponse:
        """Accept a request to cancel."""
        self.node.get_logger().info(f"cancel requested: [{goal_handle.goal_id}]")
        return CancelResponse.ACCEPT

    def execute_goal_callback(self, goal_handle: Any) -> Any:
        """Wait until the goal's time has passed, or it is cancelled or preempted."""
        log = self.node.get_logger()
        log.info("executing a goal")
        clock = Clock()
        while True:
            clock.sleep_for(Duration(seconds=1.0 / self.frequency))
            self.percent_completed += 100 / (self.frequency * self.duration)
            at = f"{self.percent_completed:.2f}%"
            with self.goal_lock:
                if not goal_handle.is_active:
                    log.info("goal is no longer active, aborting")
                    return self.action_type.Result()
                if goal_handle.is_cancel_requested:
                    log.info(f"goal cancelled at {at}")
                    goal_handle.canceled()
                    return self.generate_cancelled_result()
                if goal_handle is not self.goal_handle:
                    log.info(f"goal pre-empted at {at}")
                    goal_handle.abort()
                    return self.generate_preempted_result()
                if self.percent_completed >= 100:
                    self.percent_completed = 100.0
                    log.info("goal executed with success")
                    goal_handle.succeed()
                    return self.generate_success_result()
                log.info(f"sending feedback {at}")
                goal_handle.publish_feedback(self.generate_feedback_message())

    def handle_accepted_callback(self, goal_handle: Any) -> None:
        """Execute a goal, as the newest one."""
        self.node.get_logger().info("handle accepted")
        with self.goal_lock:
            self.goal_handle = goal_handle
            goal_handle.execute()

    def abort(self) -> None:
        """Abort the newest goal, if it is still active."""
        with self.goal_lock:
            if self.goal_handle and self.goal_handle.is_active:
                self.node.get_logger().info("aborting...")
                self.goal_handle.abort()

    def shutdown(self) -> None:
        """Destroy the server and its node."""
        self.action_server.destroy()
        self.node.destroy_node()
