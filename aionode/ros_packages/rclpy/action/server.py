"""Action servers."""

from __future__ import annotations

import threading
import traceback as tracebacks
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, Generic

from aionode._process.recent import Recent
from aionode.engine.reports.limits import tell_full, tell_rejected
from aionode.engine.rules.goal import (
    MAX_REJECTIONS,
    CancelResponse,
    GoalEvent,
    GoalResponse,
    GoalStatus,
    next_status,
    reason_id,
)
from aionode.engine.rules.goal_store import MAX_GOALS, checked_max_goals
from aionode.errors import GoalRejected, GoalTransitionError
from rclpy._impl.actions import ActionServerHandle
from rclpy._impl.errors import RCLError
from rclpy._impl.typesupport import message_like
from rclpy.action._entity import ActionEntity
from rclpy.executors import await_or_execute
from rclpy.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from rclpy.task import Future
from rclpy.type_support import FeedbackT, GoalT, ResultT, check_for_type_support
from rclpy.waitable import NumberOfEntities

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy._impl.wait_set import WaitSet
    from rclpy.callback_groups import CallbackGroup
    from rclpy.node import Node

__all__ = [
    "ActionServer",
    "CancelResponse",
    "GoalEvent",
    "GoalResponse",
    "RCLError",
    "ServerGoalHandle",
    "default_cancel_callback",
    "default_goal_callback",
    "default_handle_accepted_callback",
]

FEEDBACK_QOS = QoSProfile(depth=10)


class ServerGoalHandle(Generic[GoalT, ResultT, FeedbackT]):
    """An accepted goal."""

    def __init__(
        self,
        action_server: ActionServer[GoalT, ResultT, FeedbackT],
        goal_info: Any,
        goal_request: Any,
    ) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._status = GoalStatus.ACCEPTED
        self._is_destroyed = False
        self._result: Future[Any] = Future()
        self._reason = ""  # why it was aborted
        self._lock = threading.RLock()
        action_server._handle.add_goal(self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and self.goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment] # as in rclpy

    @property
    def request(self) -> Any:
        """The goal."""
        return self._goal_request

    @property
    def goal_id(self) -> Any:
        """Its id."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """Whether it has not ended."""
        with self._lock:
            return self._status.is_active and not self._is_destroyed

    @property
    def is_cancel_requested(self) -> bool:
        """Whether its cancellation was requested."""
        return self.status == GoalStatus.CANCELING

    @property
    def status(self) -> int:
        """Its state."""
        with self._lock:
            return int(GoalStatus.UNKNOWN if self._is_destroyed else self._status)

    def _update_state(self, event: GoalEvent) -> None:
        with self._lock:
            if self._is_destroyed:
                return
            goal_id = bytes(self.goal_id.uuid)
            try:
                self._status = next_status(self._status, event, goal_id.hex())
            except GoalTransitionError as error:
                raise RCLError(f"Failed to update goal state: {error}") from error
            handle = self._action_server._handle
            if not self._status.is_active:
                with self._action_server._lock:
                    handle.expiry.keep(goal_id)
            handle.publish_status()

    def execute(self, execute_callback: Callable[[AnyGoalHandle], Any] | None = None) -> None:
        """Schedule the execute callback with the executor; by default the server's own callback."""
        if not self.is_cancel_requested:  # otherwise the callback itself finds out
            self._update_state(GoalEvent.EXECUTE)
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Publish feedback.

        Raises:
            TypeError: it is of another class.
        """
        action_type = self._action_server.action_type
        if not isinstance(feedback, action_type.Feedback):
            raise TypeError
        with self._lock:
            if not self._is_destroyed:
                message = action_type.Impl.FeedbackMessage()
                message.goal_id = self.goal_id
                message.feedback = feedback
                self._action_server._handle.feedback.publish(message)

    def executing(self) -> None:
        """Mark it as executing, if no execute callback does; of newer rclpy."""
        self._update_state(GoalEvent.EXECUTE)

    def succeed(self, response: Any = None) -> None:
        """End the goal as succeeded; newer rclpy may pass the result here."""
        self._end(GoalEvent.SUCCEED, response)

    def abort(self, response: Any = None) -> None:
        """End the goal as aborted; newer rclpy may pass the result here."""
        self._end(GoalEvent.ABORT, response)

    def canceled(self, response: Any = None) -> None:
        """End the goal as canceled; newer rclpy may pass the result here."""
        self._end(GoalEvent.CANCELED, response)

    def _end(self, event: GoalEvent, response: Any) -> None:
        expected = self._action_server.action_type.Result
        if response is not None and not isinstance(response, expected):
            raise TypeError(
                f"the result of a goal is a {type(response).__name__}; use a Result of its action"
            )
        self._update_state(event)
        if response is not None:
            self._set_result(response)

    def _set_result(self, result: Any) -> None:
        """Answer those who wait for the result; the first result counts."""
        if self._result.done():
            return
        response = self._action_server.action_type.Impl.GetResultService.Response()
        response.status = self.status
        response.result = result
        self._result.set_result(response)

    def destroy(self) -> None:
        """Forget the goal."""
        with self._lock:
            self._is_destroyed = True


AnyGoalHandle = ServerGoalHandle[Any, Any, Any]


def default_handle_accepted_callback(goal_handle: AnyGoalHandle) -> None:
    """Execute the goal immediately."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept each goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Reject each cancel request."""
    return CancelResponse.REJECT


class ActionServer(ActionEntity[ActionServerHandle], Generic[GoalT, ResultT, FeedbackT]):
    """Executes goals.

    Args:
        node: Its node.
        action_type: The action class.
        action_name: Its name.
        execute_callback: Called with each goal's handle, as a task of the executor; returns the
            result. If it does not end the goal, the goal is aborted.
        callback_group: The group of the other callbacks.
        goal_callback: Decides whether a goal is accepted.
        handle_accepted_callback: Called with each accepted goal; by default executes it.
        cancel_callback: Decides whether a goal may be cancelled; by default it may not.
        goal_service_qos_profile, result_service_qos_profile, cancel_service_qos_profile,
            feedback_pub_qos_profile, status_pub_qos_profile: QoS of its services and topics.
        result_timeout: How long to keep results, in seconds; negative for no limit.
        max_goals: How many goals may be active at once; more are rejected before `goal_callback` is
            called. As many results are kept. rclpy has no such argument.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[AnyGoalHandle], Any],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] | None = default_goal_callback,
        handle_accepted_callback: (
            Callable[[AnyGoalHandle], Any] | None
        ) = default_handle_accepted_callback,
        cancel_callback: Callable[[AnyGoalHandle], Any] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = FEEDBACK_QOS,
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 10,
        max_goals: int = MAX_GOALS,
    ) -> None:
        super().__init__(callback_group or node.default_callback_group)
        self._lock = threading.RLock()
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        check_for_type_support(action_type)
        self._node = node
        self._action_type = action_type
        with node.handle, node.get_clock().handle:
            self._handle = self._ActionEntity__handle = ActionServerHandle(
                node.handle,
                node.get_clock().handle,
                action_type,
                action_name,
                goal_service_qos_profile,
                result_service_qos_profile,
                cancel_service_qos_profile,
                feedback_pub_qos_profile,
                status_pub_qos_profile,
                result_timeout=result_timeout,
                max_goals=checked_max_goals(max_goals, f"action server {action_name}"),
            )
        self._ActionServer__action_name = action_name
        self._ActionServer__rejections: Recent[bytes, str] = Recent(MAX_REJECTIONS)
        self._goal_handles: dict[bytes, AnyGoalHandle] = self._handle.goals
        self._logger = node.get_logger().get_child("action_server")
        node.add_waitable(self)

    @property
    def action_type(self) -> Any:
        """The action class."""
        return self._action_type

    # Requests

    async def _execute_goal_request(self, header: Any, request: Any) -> None:
        goal_id = request.goal_id
        info = message_like(self._action_type, "action_msgs/msg/GoalInfo")()
        info.goal_id = goal_id
        accepted = False
        if bytes(goal_id.uuid) not in self._goal_handles and not self._ActionServer__is_full(
            request
        ):
            try:
                answer = await await_or_execute(self._goal_callback, request.goal)
            except GoalRejected as rejected:  # rclpy has no such answer
                subject = f"action server {self._ActionServer__action_name}"
                tell_rejected(self._logger, subject, rejected.reason)
                self._ActionServer__rejections.put(bytes(goal_id.uuid), rejected.reason)
                answer = GoalResponse.REJECT
            if isinstance(answer, GoalResponse):
                accepted = answer is GoalResponse.ACCEPT
            else:
                self._logger.warning(
                    "Goal request callback did not return a GoalResponse type. Rejecting goal."
                )
        goal_handle = self._ActionServer__accept(info, request.goal) if accepted else None
        response = self._action_type.Impl.SendGoalService.Response()
        response.accepted = goal_handle is not None
        response.stamp = info.stamp
        self._handle.goal.service_send_response(response, header.request_id)
        if goal_handle is not None:
            self._handle.publish_status()
            await await_or_execute(self._handle_accepted_callback, goal_handle)

    def _ActionServer__is_full(self, request: Any) -> bool:
        """Return whether there is no room for a goal; if so, log why it is rejected."""
        why: str = self._handle.goals.refusal(request.goal)
        if why:
            tell_full(self._logger, f"action server {self._ActionServer__action_name}", why)
            self._ActionServer__rejections.put(bytes(request.goal_id.uuid), why)
        return bool(why)

    def _ActionServer__accept(self, info: Any, goal: Any) -> AnyGoalHandle | None:
        now = self._node.get_clock().now().to_msg()  # its class may be of the other family
        info.stamp.sec, info.stamp.nanosec = now.sec, now.nanosec
        try:
            with self._lock:
                goal_handle: AnyGoalHandle = ServerGoalHandle(self, info, goal)
        except RCLError as error:
            self._logger.error(  # noqa: TRY400  # as above
                f"Failed to accept new goal with ID {info.goal_id.uuid}: {error}"
            )
            return None
        self.add_future(goal_handle._result)
        return goal_handle

    async def _execute_goal(
        self,
        execute_callback: Callable[[AnyGoalHandle], Any],
        goal_handle: AnyGoalHandle,
    ) -> None:
        goal_id = goal_handle.goal_id.uuid
        try:
            result = await await_or_execute(execute_callback, goal_handle)
        except Exception as error:  # noqa: BLE001  # the client gets an empty result
            result = self._action_type.Result()
            goal_handle._reason = f"{type(error).__name__}: {error}"
            self._logger.error(  # noqa: TRY400  # rclpy's loggers have no exception()
                f"Error raised in execute callback: {error}"
            )
            tracebacks.print_exc()
        if goal_handle.is_active:
            self._logger.warning(f"Goal state not set, assuming aborted. Goal ID: {goal_id}")
            goal_handle.abort()
        goal_handle._set_result(result)

    async def _execute_cancel_request(self, header: Any, request: Any) -> None:
        with self._lock:
            response = self._handle.process_cancel_request(request)
        canceling = []
        for info in response.goals_canceling:
            goal_handle = self._goal_handles.get(bytes(info.goal_id.uuid))
            if goal_handle is None:
                continue
            answer = await await_or_execute(self._cancel_callback, goal_handle)
            if answer is not CancelResponse.ACCEPT:
                continue
            try:
                goal_handle._update_state(GoalEvent.CANCEL_GOAL)
            except RCLError as error:  # it has ended meanwhile
                self._logger.debug(f"Failed to cancel goal in cancel callback: {error}")
            else:
                canceling.append(info)
        response.goals_canceling = canceling
        self._handle.cancel.service_send_response(response, header.request_id)

    def _execute_get_result_request(self, header: Any, request: Any) -> None:
        goal_id = bytes(request.goal_id.uuid)
        asked_id = reason_id(goal_id)  # for clients of aionode that want to know the reason
        aborted = self._goal_handles.get(asked_id)
        rejection = self._ActionServer__rejections.get(asked_id)
        if reason := rejection if aborted is None else aborted._reason:
            self._handle.result.service_send_error("AbortReason", reason, header.request_id)
            return
        goal_handle = self._goal_handles.get(goal_id)
        if goal_handle is None:
            tell = self._logger.warning if aborted is None else self._logger.debug
            tell(f"Sending result response for unknown or expired goal ID: {request.goal_id.uuid}")
            response = self._action_type.Impl.GetResultService.Response()
            response.status = int(GoalStatus.UNKNOWN)
            self._handle.result.service_send_response(response, header.request_id)
            return
        goal_handle._result.add_done_callback(partial(self._send_result_response, header))

    def _send_result_response(self, header: Any, future: Future[Any]) -> None:
        result = future.result()
        if result is not None:
            self._handle.result.service_send_response(result, header.request_id)

    def _ActionServer__expire_goals(self) -> None:
        with self._lock:  # a goal may end in another thread meanwhile
            forgotten = self._handle.expiry.take()
        for goal_handle in forgotten:
            goal_handle.destroy()
            with suppress(ValueError):  # the server was destroyed, which removes all goals
                self.remove_future(goal_handle._result)

    # Called by executors

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Return whether a request has arrived, or a goal must be forgotten."""
        handle = self._handle
        return any(
            part.ready() for part in (handle.goal, handle.cancel, handle.result, handle.expiry)
        )

    def take_data(self) -> dict[str, Any]:
        """Take one item of each kind that is ready."""
        handle = self._handle
        data: dict[str, Any] = {}
        with self._lock:
            for name, service in (
                ("goal", handle.goal),
                ("cancel", handle.cancel),
                ("result", handle.result),
            ):
                request, header = service.service_take_request(None)
                if header is not None:
                    data[name] = (header, request)
        return data

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Answer requests, and forget goals."""
        for name, service, answer in (
            ("goal", self._handle.goal, self._execute_goal_request),
            ("cancel", self._handle.cancel, self._execute_cancel_request),
        ):
            if name in taken_data:
                header, request = taken_data[name]
                try:
                    await answer(header, request)
                finally:  # a user's callback may have failed
                    service.give_up(header.request_id)
        if "result" in taken_data:
            self._execute_get_result_request(*taken_data["result"])
        self._ActionServer__expire_goals()  # last: a result may have been requested just before

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of handles it adds to a wait set."""
        return NumberOfEntities(num_timers=1, num_services=3)

    # For goals

    def notify_execute(
        self,
        goal_handle: AnyGoalHandle,
        execute_callback: Callable[[AnyGoalHandle], Any] | None,
    ) -> None:
        """Schedule a callback for a goal with the executor; by default the server's own."""
        executor = self._node.executor
        if executor is not None:
            executor.create_task(
                self._execute_goal, execute_callback or self._execute_callback, goal_handle
            )

    # Callbacks

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[AnyGoalHandle], Any] | None
    ) -> None:
        """Set the function called with each accepted goal; None for the default."""
        self._handle_accepted_callback = (
            handle_accepted_callback or default_handle_accepted_callback
        )

    def register_goal_callback(self, goal_callback: Callable[[Any], Any] | None) -> None:
        """Set the function that decides whether a goal is accepted; None for the default."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(
        self, cancel_callback: Callable[[AnyGoalHandle], Any] | None
    ) -> None:
        """Set the function that decides whether a goal may be cancelled; None for the default."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[[AnyGoalHandle], Any]) -> None:
        """Set the function that executes goals.

        Raises:
            TypeError: it is not callable.
        """
        if not callable(execute_callback):
            raise TypeError("Failed to register goal execution callback: not callable")
        self._execute_callback = execute_callback

    def destroy(self) -> None:
        """Destroy it; goals being executed continue, without effect on clients."""
        for goal_handle in list(self._goal_handles.values()):
            goal_handle.destroy()
            self.remove_future(goal_handle._result)
        super().destroy()
