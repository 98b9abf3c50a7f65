"""Handles of action servers and clients: three services and two topics, as in rcl_action."""

from __future__ import annotations

import threading
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from aionode.clock import S_TO_NS, MachineTime
from aionode.engine.rules.goal import GoalEvent, GoalKey, GoalStatus, goals_to_cancel
from aionode.engine.rules.goal_store import GoalStore
from aionode.engine.rules.status_pace import StatusSpacing
from rclpy._impl.destroyable import Destroyable
from rclpy._impl.errors import RCLError
from rclpy._impl.services import ClientHandle, ServiceHandle
from rclpy._impl.topics import PublisherHandle, SubscriptionHandle
from rclpy._impl.typesupport import message_like
from rosidl_generator_py import aionode_class

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.engine.rules.service_events import ServiceIntrospectionState
    from aionode.qos import QoSProfile
    from rclpy._impl.node import NodeHandle
    from rclpy._impl.timers import ClockHandle

__all__ = ["ActionClientHandle", "ActionHandle", "ActionServerHandle", "Expiry", "GoalEvent"]

RETRY_S = 0.001
"""How long status messages wait for a thread that is sending earlier ones, in seconds."""

steady_ns = MachineTime().steady_ns


def now_s() -> float:
    """Return the steady clock, in seconds."""
    return steady_ns() / S_TO_NS


class Goal(Protocol):
    """The part of a `ServerGoalHandle` shown in status messages and answers to clients.

    Attributes:
        _goal_info: Its id and acceptance time.
        _status: Its state.
    """

    _goal_info: Any
    _status: GoalStatus


def goal_key(info: Any, status: GoalStatus = GoalStatus.UNKNOWN) -> GoalKey:
    """Return the key by which cancel requests select a goal."""
    stamp_ns = info.stamp.sec * S_TO_NS + info.stamp.nanosec
    return GoalKey(bytes(info.goal_id.uuid), stamp_ns, status)


class ActionHandle(Destroyable):
    """One end of an action: its ends of three services and two topics.

    Args:
        node: Its node.
        service_class: `ServiceHandle` for the server, `ClientHandle` for the client.
        topic_class: `PublisherHandle` or `SubscriptionHandle` likewise.
        action_type: The action class.
        action_name: Its name.
        goal_qos, result_qos, cancel_qos, feedback_qos, status_qos: QoS of the parts.
    """

    def __init__(
        self,
        node: NodeHandle,
        service_class: Any,
        topic_class: Any,
        action_type: Any,
        action_name: str,
        goal_qos: Any,
        result_qos: Any,
        cancel_qos: Any,
        feedback_qos: Any,
        status_qos: Any,
    ) -> None:
        super().__init__(node.signal)
        self.parts: list[Any] = []
        impl = action_type.Impl
        name = f"{node.resolve(action_name)}/_action"

        def add(handle_class: Any, type_: Any, part_name: str, qos: Any) -> Any:
            part = handle_class(node, type_, f"{name}/{part_name}", qos)
            self.parts.append(part)  # now: if a later one cannot be created, this one is destroyed
            return part

        self.goal = add(service_class, impl.SendGoalService, "send_goal", goal_qos)
        self.cancel = add(service_class, impl.CancelGoalService, "cancel_goal", cancel_qos)
        self.result = add(service_class, impl.GetResultService, "get_result", result_qos)
        self.feedback = add(topic_class, impl.FeedbackMessage, "feedback", feedback_qos)
        self.status = add(topic_class, impl.GoalStatusMessage, "status", status_qos)

    def add_to_waitset(self, wait_set: Any) -> None:
        """Add the handles that can become ready."""
        for part in self.parts:
            if isinstance(part, SubscriptionHandle):
                wait_set.add_subscription(part)
            elif isinstance(part, ClientHandle):
                wait_set.add_client(part)
            elif isinstance(part, ServiceHandle):
                wait_set.add_service(part)
            elif isinstance(part, Expiry):
                wait_set.add_timer(part)

    def configure_introspection(
        self,
        clock: Clock,
        service_event_qos_profile: QoSProfile,
        introspection_state: ServiceIntrospectionState,
    ) -> None:
        """Publish the calls of the three services on ``…/_service_event``."""
        for service in (self.goal, self.result, self.cancel):
            service.configure_introspection(clock, service_event_qos_profile, introspection_state)

    def _destroy(self) -> None:
        for part in getattr(self, "parts", ()):
            part.destroy_when_not_in_use()


class ActionClientHandle(ActionHandle):
    """The client's end of an action; the arguments are those of `ActionHandle`."""

    def __init__(self, node: NodeHandle, action_type: Any, action_name: str, *qos: Any) -> None:
        super().__init__(node, ClientHandle, SubscriptionHandle, action_type, action_name, *qos)
        self.name = action_name
        self.io = node.io
        self.context_handle = node.context_handle

    def refuse_if_destroyed(self, failure: str) -> None:
        """Raise if it is destroyed.

        Raises:
            RCLError: it is; rclpy raises InvalidHandle for other entities only.
        """
        if not self.is_valid:
            raise RCLError(f"{failure}: the action client is destroyed")

    def is_action_server_available(self) -> bool:
        """Return whether all parts of a server exist.

        Raises:
            RCLError: it is destroyed, or the context is shut down.
        """
        self.refuse_if_destroyed("Failed to check if action server is available")
        self.context_handle.refuse_after_shutdown("Failed to check if action server is available")
        services = (self.goal, self.result, self.cancel)
        return all(client.service_server_is_available() for client in services) and all(
            topic.get_publisher_count() for topic in (self.feedback, self.status)
        )


class Expiry(Destroyable):
    """When the next goal result expires: a timer, for wait sets.

    Attributes:
        goals: The goals.
        forgotten: Goals that had to make room for others, until an executor has handled them.
    """

    def __init__(self, node: NodeHandle, clock: ClockHandle, goals: GoalStore) -> None:
        super().__init__(node.signal)
        self._clock = clock
        self.goals = goals
        self.forgotten: list[Any] = []

    def keep(self, goal_id: bytes) -> None:
        """Keep an ended goal until its result times out, and forget the oldest of too many."""
        self.forgotten += self.goals.keep(goal_id)
        self.signal.notify()

    def ready(self) -> bool:
        """Return whether a goal has expired, or was forgotten."""
        due_ns = self.goals.due_ns
        return bool(self.forgotten) or (due_ns is not None and self._clock.now_ns() >= due_ns)

    def due_in_ns(self) -> int | None:
        """Return the time until the next goal expires; None if no goal has ended."""
        due_ns = self.goals.due_ns
        if due_ns is None or self._clock.ros_time_is_active:
            return None
        return max(0, due_ns - self._clock.now_ns())

    def take(self) -> list[Any]:
        """Forget expired goals; return all that were forgotten."""
        forgotten, self.forgotten = self.forgotten, []
        return forgotten + self.goals.expire()


class ActionServerHandle(ActionHandle):
    """The server's end of an action, and its goals.

    Args:
        node: Its node.
        clock: The clock for the age of results.
        action_type: The action class.
        action_name: Its name.
        qos: The profiles, in the order of `ActionHandle`.
        result_timeout: How long to keep results, in seconds; negative for no limit.
        max_goals: Maximum number of active goals.
    """

    def __init__(
        self,
        node: NodeHandle,
        clock: ClockHandle,
        action_type: Any,
        action_name: str,
        *qos: Any,
        result_timeout: float,
        max_goals: int,
    ) -> None:
        # Held until the status is sent: none may arrive after a newer one. A signal handler that
        # ends a goal meanwhile leaves the status to the thread that it has interrupted.
        self._status_lock = threading.RLock()
        self._is_sending_status = False
        self._has_newer_status = False
        self._waits_to_send = False
        self._spacing = StatusSpacing()
        super().__init__(node, ServiceHandle, PublisherHandle, action_type, action_name, *qos)
        self._io = node.io
        self.action_type = action_type
        self._status_message = message_like(action_type, "action_msgs/msg/GoalStatus")
        self.goals = GoalStore(
            clock.now_ns,
            max_goals,
            int(result_timeout * 1e9),
            node.bare.context.network.queue_bytes,
            aionode_class(action_type.Goal),
        )
        self.expiry = Expiry(node, clock, self.goals)
        self.parts.append(self.expiry)

    def add_goal(self, goal: Goal) -> None:
        """Add a new goal.

        Raises:
            RCLError: there is one with this id.
        """
        goal_id = bytes(goal._goal_info.goal_id.uuid)
        if goal_id in self.goals:
            raise RCLError("Failed to accept new goal: goal ID already exists")
        self.goals[goal_id] = goal

    def publish_status(self) -> None:
        """Publish the status of all goals: now, or after a delay if there are many."""
        with self._status_lock:
            self._has_newer_status = True
            if self._is_sending_status or self._waits_to_send:
                return
            wait_s = self._spacing.wait_s(now_s())
            if wait_s:
                self._waits_to_send = True
                self._io.post(partial(self._send_later, wait_s))
            else:
                self._send_status()

    def _send_later(self, wait_s: float) -> None:
        self._io.loop.call_later(wait_s, self._send_waiting)

    def _send_waiting(self) -> None:
        """Send the postponed status; in the thread of the context."""
        # It must not wait for a thread that holds the lock and may be waiting for this thread.
        if not self._status_lock.acquire(blocking=False):
            self._send_later(RETRY_S)
            return
        try:
            if self._waits_to_send:
                self._waits_to_send = False
                with suppress(RCLError):  # nothing can be sent after shutdown
                    self._send_status()
        finally:
            self._status_lock.release()

    def _send_status(self) -> None:
        self._is_sending_status = True
        try:
            while self._has_newer_status:
                self._has_newer_status = False
                goals = list(self.goals.values())
                self.status.publish(self._status_of(goals))
                self._spacing.note_sent(len(goals), now_s())
        finally:
            self._is_sending_status = False

    def _status_of(self, goals: list[Goal]) -> Any:
        message = self.action_type.Impl.GoalStatusMessage()
        message.status_list = [
            self._status_message(goal_info=goal._goal_info, status=int(goal._status))
            for goal in goals
        ]
        return message

    def _destroy(self) -> None:
        if getattr(self, "_waits_to_send", False):
            self._io.post(self._send_waiting)
            self._io.post(super()._destroy)
        else:
            super()._destroy()

    def process_cancel_request(self, request: Any) -> Any:
        """Return the response to a cancel request: the goals selected by its id and time.

        The rules are those of `aionode.engine.rules.cancel_selection`.
        """
        code, selected = goals_to_cancel(
            [goal_key(goal._goal_info, goal._status) for goal in list(self.goals.values())],
            goal_key(request.goal_info),
        )
        response = self.action_type.Impl.CancelGoalService.Response()
        response.return_code = int(code)
        response.goals_canceling = [self.goals[goal_id]._goal_info for goal_id in selected]
        return response
