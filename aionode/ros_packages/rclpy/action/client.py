"""Action clients."""

from __future__ import annotations

import threading
import uuid
import weakref
from typing import TYPE_CHECKING, Any, Generic

from action_msgs.srv import CancelGoal

from aionode.engine.rules.goal import GoalStatus
from rclpy._entities import wait_until
from rclpy._impl.actions import ActionClientHandle
from rclpy._impl.destroyable import Wakeup
from rclpy._impl.errors import RCLError
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
    "ActionClient",
    "CancelGoal",
    "ClientGoalHandle",
]

FEEDBACK_QOS = QoSProfile(depth=10)

SERVICES = ("goal", "cancel", "result")
"""The services of an action, as attributes of its handle."""

ENDED = (GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED)


class ClientGoalHandle(Generic[GoalT, ResultT, FeedbackT]):
    """A goal that was sent, and the server's answer to it."""

    def __init__(
        self,
        action_client: ActionClient[GoalT, ResultT, FeedbackT],
        goal_id: Any,
        goal_response: Any,
    ) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status = int(GoalStatus.UNKNOWN)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other._goal_id

    __hash__ = None  # type: ignore[assignment] # as in rclpy

    def __repr__(self) -> str:
        return (
            f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, "
            f"status={self.status}>"
        )

    @property
    def goal_id(self) -> Any:
        """Its id."""
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """The time of its acceptance."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the server accepted the goal."""
        accepted: bool = self._goal_response.accepted
        return accepted

    @property
    def status(self) -> int:
        """Its state in the server's latest status message."""
        return self._status

    def cancel_goal(self) -> Any:
        """Ask the server to cancel it; block until it answers, while another thread spins.

        Raises:
            RCLError: the context was shut down meanwhile.
        """
        return self._action_client._ActionClient__blocked(self.cancel_goal_async())

    def cancel_goal_async(self) -> Future[Any]:
        """Ask the server to cancel it; return a future for the answer."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Request the goal's result; block until it arrives, while another thread spins.

        Raises:
            RCLError: the context was shut down meanwhile.
        """
        return self._action_client._ActionClient__blocked(self.get_result_async())

    def get_result_async(self) -> Future[Any]:
        """Request the goal's result; return a future for it."""
        return self._action_client._get_result_async(self)


class ActionClient(ActionEntity[ActionClientHandle], Generic[GoalT, ResultT, FeedbackT]):
    """Sends goals to an action server.

    Args:
        node: Its node.
        action_type: The action class.
        action_name: Its name.
        callback_group: The group in which answers are handled and feedback callbacks are called.
        goal_service_qos_profile, result_service_qos_profile, cancel_service_qos_profile,
            feedback_sub_qos_profile, status_sub_qos_profile: QoS of its services and topics.
        enable_feedback_msg_optimization: An option of rclpy in Lyrical, without effect: feedback of
            other clients' goals is dropped on arrival.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = FEEDBACK_QOS,
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
        enable_feedback_msg_optimization: bool = False,
    ) -> None:
        super().__init__(callback_group or node.default_callback_group)
        check_for_type_support(action_type)
        self._node = node
        self._action_type = action_type
        self._action_name = action_name
        with node.handle:
            self._ActionEntity__handle = ActionClientHandle(
                node.handle,
                action_type,
                action_name,
                goal_service_qos_profile,
                result_service_qos_profile,
                cancel_service_qos_profile,
                feedback_sub_qos_profile,
                status_sub_qos_profile,
            )
        self._goal_handles: dict[bytes, weakref.ref[ClientGoalHandle[Any, Any, Any]]] = {}
        # For each service: future and request, by the number of the request.
        self._ActionClient__pending: dict[str, dict[int, tuple[Future[Any], Any]]] = {
            name: {} for name in SERVICES
        }
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        # The states published last: they may arrive before the response to a goal.
        self._ActionClient__states: list[Any] = []
        self._lock = threading.RLock()
        self._logger = node.get_logger().get_child("action_client")
        node.add_waitable(self)

    # Sending

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Send a goal; block until its result arrives, while another thread spins.

        Raises:
            TypeError: `goal` is of another class.
            RCLError: the context was shut down meanwhile.
        """
        handle = self._ActionClient__blocked(self.send_goal_async(goal, **kwargs))
        return handle.get_result()

    def _ActionClient__blocked(self, future: Future[Any]) -> Any:
        """Block the thread until a future is done; return its result.

        Raises:
            RCLError: the context was shut down meanwhile.
        """
        done = Wakeup()
        future.add_done_callback(lambda _: done.wake())
        if not wait_until(future.done, self._node.context, None, done):
            raise RCLError(f"no answer of {self._action_name}: the context is shut down")
        return future.result()

    def send_goal_async(
        self,
        goal: Any,
        feedback_callback: Callable[[Any], Any] | None = None,
        goal_uuid: Any | None = None,
    ) -> Future[Any]:
        """Send a goal; return a future for its `ClientGoalHandle`, accepted or not.

        Args:
            goal: The goal.
            feedback_callback: Called with each feedback message until the result arrives.
            goal_uuid: Its id; a random one by default.

        Raises:
            TypeError: `goal` is of another class.
            RCLError: the client is destroyed.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError(
                f"Expected goal type ({self._action_type.Goal}) but received ({type(goal)})"
            )
        request = self._action_type.Impl.SendGoalService.Request()
        if goal_uuid is None:
            request.goal_id.uuid = list(uuid.uuid4().bytes)
        else:
            request.goal_id = goal_uuid
        request.goal = goal
        if feedback_callback is not None:
            self._feedback_callbacks[bytes(request.goal_id.uuid)] = feedback_callback
        return self._ActionClient__send("goal", request)

    def _cancel_goal_async(self, goal_handle: ClientGoalHandle[Any, Any, Any]) -> Future[Any]:
        expect_goal_handle(goal_handle)
        request = self._action_type.Impl.CancelGoalService.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        return self._ActionClient__send("cancel", request)

    def _get_result_async(self, goal_handle: ClientGoalHandle[Any, Any, Any]) -> Future[Any]:
        expect_goal_handle(goal_handle)
        request = self._action_type.Impl.GetResultService.Request()
        request.goal_id = goal_handle.goal_id
        future = self._ActionClient__send("result", request)
        goal_id = bytes(goal_handle.goal_id.uuid)
        future.add_done_callback(lambda _: self._feedback_callbacks.pop(goal_id, None))
        return future

    def _ActionClient__send(self, service: str, request: Any) -> Future[Any]:
        """Send a request to one of the services; return a future that executors complete."""
        future: Future[Any] = Future()
        pending = self._ActionClient__pending[service]
        handle = self._ActionEntity__handle
        handle.refuse_if_destroyed(f"Failed to send {service} request")
        with self._lock:
            sequence = getattr(handle, service).send_request(request)
            pending[sequence] = future, request
        self.add_future(future)

        def forget(_: Future[Any]) -> None:
            if pending.pop(sequence, None) is not None:
                self.remove_future(future)

        future.add_done_callback(forget)
        return future

    # Called by executors

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Return whether an answer, feedback or status has arrived."""
        return any(part.ready() for part in self._ActionEntity__handle.parts)

    def take_data(self) -> dict[str, Any]:
        """Take one item of each kind that is ready."""
        handle = self._ActionEntity__handle
        data: dict[str, Any] = {}
        with self._lock:
            for name in SERVICES:
                header, response = getattr(handle, name).take_response(None)
                if header is not None:
                    data[name] = (header.request_id.sequence_number, response)
            for name, subscription in (("feedback", handle.feedback), ("status", handle.status)):
                taken = subscription.take_message(subscription.msg_type, raw=False)
                if taken is not None:
                    data[name] = taken[0]
        return data

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Complete futures, call feedback callbacks, and record states."""
        for name in SERVICES:
            if name in taken_data:
                self._ActionClient__take_response(name, *taken_data[name])
        if "feedback" in taken_data:
            feedback = taken_data["feedback"]
            callback = self._feedback_callbacks.get(bytes(feedback.goal_id.uuid))
            if callback is not None:
                await await_or_execute(callback, feedback)
        if "status" in taken_data:
            self._ActionClient__states = taken_data["status"].status_list
            for status in self._ActionClient__states:
                self._ActionClient__take_status(status)

    def _ActionClient__take_response(self, service: str, sequence: int, response: Any) -> None:
        pending = self._ActionClient__pending[service].get(
            sequence
        )  # another thread may give it up meanwhile
        if pending is None:
            self._logger.warning(
                f"Ignoring unexpected {service} response. There may be more than one action server "
                f"for the action '{self._action_name}'"
            )
            return
        future, request = pending
        future.set_result(
            self._ActionClient__goal(request, response) if service == "goal" else response
        )

    def _ActionClient__goal(self, request: Any, response: Any) -> ClientGoalHandle[Any, Any, Any]:
        """Return the goal of a request, which is tracked if the server has accepted it."""
        handle = ClientGoalHandle(self, request.goal_id, response)
        goal_id = bytes(handle.goal_id.uuid)
        if not handle.accepted:
            self._feedback_callbacks.pop(goal_id, None)
        else:
            if goal_id in self._goal_handles:
                raise RuntimeError(f"Two goals were accepted with the same ID ({handle})")
            self._goal_handles[goal_id] = weakref.ref(handle)
            for status in self._ActionClient__states:
                self._ActionClient__take_status(status)
        return handle

    def _ActionClient__take_status(self, status: Any) -> None:
        goal_id = bytes(status.goal_info.goal_id.uuid)
        reference = self._goal_handles.get(goal_id)
        if reference is None:
            return
        handle = reference()
        if handle is not None:
            handle._status = status.status
        if handle is None or status.status in ENDED:
            del self._goal_handles[goal_id]

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of handles that it adds to a wait set."""
        return NumberOfEntities(num_subs=2, num_clients=3)

    # The server

    def server_is_ready(self) -> bool:
        """Return whether a server is available.

        Raises:
            RCLError: the client is destroyed, or the context is shut down.
        """
        with self._node.handle:
            return self._ActionEntity__handle.is_action_server_available()

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Block the thread until a server is available; nobody needs to spin.

        Args:
            timeout_sec: Maximum time to wait, in seconds; None for no limit.

        Returns:
            Whether one is available.

        Raises:
            RCLError: the client is destroyed, or the context is shut down.
        """
        return wait_until(self.server_is_ready, self._node.context, timeout_sec)


def expect_goal_handle(value: object) -> None:
    """Raise TypeError unless `value` is a `ClientGoalHandle`."""
    if not isinstance(value, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(value)}")
