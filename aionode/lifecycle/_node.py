"""A managed node: it can be configured, activated, deactivated, cleaned up and shut down."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from aionode.endpoints.core.callback_runner import accepts
from aionode.endpoints.core.node_core import core_of
from aionode.endpoints.subscription import silence_watch_of
from aionode.engine.rules.lifecycle_answers import StateAnswers, fill_event
from aionode.engine.rules.lifecycle_states import (
    ERROR_PROCESSING,
    TRANSITIONS,
    TransitionCallbackReturn,
)
from aionode.engine.rules.managed_entity import ManagedEntity
from aionode.errors import brief
from aionode.interfaces.lifecycle_msgs import msg
from aionode.interfaces.lifecycle_msgs.srv import (
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)
from aionode.lifecycle._entities import Gate, LifecyclePublisher, LifecycleTimer
from aionode.lifecycle._events import EventSource
from aionode.lifecycle._runner import SUCCESS, TransitionRunner
from aionode.message import Message
from aionode.node import Node
from aionode.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterable
    from typing import TypeAlias

    from aionode.clock import Clock
    from aionode.endpoints.service import Service, ServiceCallback
    from aionode.endpoints.subscription import Subscription, SubscriptionCallback
    from aionode.endpoints.timer import TimerCallback
    from aionode.engine.rules.lifecycle_states import State
    from aionode.lifecycle._runner import LifecycleEvent
    from aionode.message import ServiceClass

    Result: TypeAlias = TransitionCallbackReturn | Any
    """A `TransitionCallbackReturn`, or an awaitable of one. To type checkers these methods return
    the former, so that ``return super().on_activate(state)`` passes; `Any` lets overrides be
    coroutine functions.
    """

__all__ = ["LifecycleNode"]

MsgT = TypeVar("MsgT", bound=Message)
RequestT = TypeVar("RequestT", bound=Message)
ResponseT = TypeVar("ResponseT", bound=Message)

EVENT_QOS = QoSProfile(depth=10)
"""Reliable and volatile, as in `rcl_lifecycle`."""


class LifecycleNode(Node):
    """A managed node: it works only after it has been configured and activated.

    Override `on_configure`, `on_activate` and the others. They receive the state in which the
    transition started, and return a `TransitionCallbackReturn`. They may be coroutines and await
    anything, including services of this node. An exception is logged with its traceback, raised by
    the `trigger_*` method that was called, and passed to `on_error`.

    Other processes manage the node through the standard services (``aionode lifecycle``, ``ros2
    lifecycle``); `get_state` also answers during a transition. Requests during a transition are
    refused, with three exceptions. ``transition_failure`` and ``transition_error``, which
    `rcl_lifecycle` allows in this state, cancel the callback with that result. ``shutdown`` cancels
    it as a failure, and then shuts down.

    Args:
        node_name: As for `Node`.
        enable_communication_interface: Whether other processes can manage the node.
        options: The other arguments of `Node`.

    Raises:
        CallbackSignatureError: one of its callbacks takes other arguments.
    """

    def __init__(
        self, node_name: str, *, enable_communication_interface: bool = True, **options: Any
    ) -> None:
        self.__events: EventSource[LifecycleEvent] = EventSource()
        super().__init__(node_name, **options)
        core_of(self).at_end.append(self.__events.end)
        for verb in ("configure", "cleanup", "activate", "deactivate", "shutdown"):
            self.__accepts(f"on_{verb}", 1, wanted="(state)")
        self.__error_callback_takes = self.__accepts(
            "on_error", 2, 1, wanted="(state) or (state, error)"
        )
        self.__transition_events = self.create_publisher(
            msg.TransitionEvent, "~/transition_event", EVENT_QOS
        )
        self.__transitions = TransitionRunner(
            self.get_fully_qualified_name(),
            self.get_logger(),
            self.__callback_of,
            self.__publish_event,
            self.__events,
        )
        if enable_communication_interface:
            self.__serve()

    def __accepts(self, name: str, *counts: int, wanted: str) -> int:
        subject = f"{self.get_fully_qualified_name()}: {name}"
        return accepts(getattr(self, name), *counts, subject=subject, wanted=wanted)

    def __callback_of(self, name: str) -> Callable[[State, Exception | None], Any]:
        callback = getattr(self, f"on_{name}")
        if name == "error" and self.__error_callback_takes == 2:  # (state, error)
            return callback  # type: ignore[no-any-return]  # found by name
        return lambda state, _: callback(state)

    # To override

    def on_configure(self, state: State) -> Result:
        """Read parameters and allocate resources; by default, configure all entities."""
        return self.__all("on_configure", self.__transitions.entities, state)

    def on_cleanup(self, state: State) -> Result:
        """Undo `on_configure`; by default, clean up all entities, the last one first."""
        return self.__all("on_cleanup", reversed(self.__transitions.entities), state)

    def on_activate(self, state: State) -> Result:
        """Start working; by default, enable all entities.

        An override also calls this: ``return super().on_activate(state)``.
        """
        return self.__all("on_activate", self.__transitions.entities, state)

    def on_deactivate(self, state: State) -> Result:
        """Stop working; by default, disable all entities, the last one first."""
        return self.__all("on_deactivate", reversed(self.__transitions.entities), state)

    def on_shutdown(self, state: State) -> Result:
        """Shut down permanently; by default, shut down all entities, the last one first."""
        return self.__all("on_shutdown", reversed(self.__transitions.entities), state)

    def on_error(self, state: State, error: Exception | None = None) -> Result:  # noqa: ARG002  # for overrides
        """Recover from an error; SUCCESS leads to unconfigured, other results to finalized.

        By default, all entities recover, the last one first, which makes the node unconfigured as
        in rclpy. An override takes ``(state)``, as in rclpy, or ``(state, error)``.

        Args:
            state: The state in which the failed transition started.
            error: The exception, or None if the callback returned ERROR.
        """
        return self.__all("on_error", reversed(self.__transitions.entities), state)

    def __all(
        self, name: str, entities: Iterable[ManagedEntity], state: State
    ) -> TransitionCallbackReturn:
        for entity in entities:
            result: TransitionCallbackReturn = getattr(entity, name)(state)
            if result is not SUCCESS:
                return result
        return SUCCESS

    def report_progress(self, text: str, fraction: float | None = None) -> None:
        """Report the progress of a transition to the log and to readers of `lifecycle_events`.

        Args:
            text: The current step.
            fraction: How much is done, from 0 to 1.
        """
        share = "" if fraction is None else f" ({fraction:.0%})"
        self.get_logger().info(f"{self.lifecycle_state.label}: {text}{share}")
        self.__transitions.report(text, fraction)

    # From within this process

    @property
    def lifecycle_state(self) -> State:
        """The current state."""
        return self.__transitions.machine.state

    def lifecycle_events(self) -> AsyncIterator[LifecycleEvent]:
        """Iterate over state changes and progress reports; a slow reader gets the newest 100.

        Events are collected from the first step of the iteration, which ends with the node.
        """
        return self.__events.iterate()

    async def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node, and return the result of `on_configure`.

        Cancelling, for example by `asyncio.timeout`, cancels the callback, and the node enters the
        state to which a failure leads. The other `trigger_*` methods do the same.

        Raises:
            TransitionError: the node is in another state, or the callback raised an exception,
                which is the cause.
        """
        return await self.__transitions.trigger("configure")

    async def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Clean the node up; see `trigger_configure`."""
        return await self.__transitions.trigger("cleanup")

    async def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node; see `trigger_configure`."""
        return await self.__transitions.trigger("activate")

    async def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node; see `trigger_configure`."""
        return await self.__transitions.trigger("deactivate")

    async def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut the node down, cancelling a transition in progress; see `trigger_configure`."""
        await self.__transitions.make_way_for_shutdown()
        return await self.__transitions.trigger("shutdown")

    # Entities

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Make `entity` take part in transitions from now on, after those added earlier.

        Raises:
            TypeError: it is not a `ManagedEntity`.
        """
        if not isinstance(entity, ManagedEntity):
            raise TypeError(
                f"{self.get_fully_qualified_name()}: {brief(entity)} is not a managed entity; "
                "derive its class from aionode.lifecycle.ManagedEntity"
            )
        self.__transitions.entities.append(entity)

    def create_lifecycle_publisher(
        self, msg_type: type[MsgT], topic: str, qos_profile: QoSProfile | int, **options: Any
    ) -> LifecyclePublisher[MsgT]:
        """Create a publisher that sends only while the node is active; see `create_publisher`."""
        publisher = LifecyclePublisher(
            self.create_publisher(msg_type, topic, qos_profile, **options)
        )
        self.add_managed_entity(publisher)
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher[Any]) -> bool:
        """Destroy a publisher; False if it is not one of this node's."""
        if publisher not in self.__transitions.entities:
            return False
        self.__transitions.entities.remove(publisher)
        publisher.destroy()
        return True

    def create_lifecycle_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: SubscriptionCallback[MsgT],
        qos_profile: QoSProfile | int = 10,
        **options: Any,
    ) -> Subscription[MsgT]:
        """Create a subscription whose callback is called only while the node is active.

        Messages that arrive in other states are discarded, and silence is not watched for; see
        `create_subscription`.
        """
        gate = Gate()
        self.add_managed_entity(gate)
        subscription = self.create_subscription(
            msg_type, topic, gate.dropping(callback), qos_profile, **options
        )
        watch = silence_watch_of(subscription)
        if watch is not None:
            gate.guard(watch)
        return subscription

    def create_lifecycle_service(
        self,
        srv_type: ServiceClass[RequestT, ResponseT],
        srv_name: str,
        callback: ServiceCallback[RequestT, ResponseT],
        **options: Any,
    ) -> Service[RequestT, ResponseT]:
        """Create a service that answers only while the node is active.

        In other states the client gets a `ServiceError`; see `create_service`.
        """
        gate = Gate()
        self.add_managed_entity(gate)
        refusing = gate.refusing(callback, f"service {self.resolve_service_name(srv_name)}")
        return self.create_service(srv_type, srv_name, refusing, **{"on_error": "log"} | options)

    def create_lifecycle_timer(
        self,
        timer_period_sec: float,
        callback: TimerCallback,
        clock: Clock | None = None,
        **options: Any,
    ) -> LifecycleTimer:
        """Create a timer that runs only while the node is active; see `create_timer`."""
        timer = LifecycleTimer(
            self.create_timer(timer_period_sec, callback, clock, autostart=False, **options)
        )
        self.add_managed_entity(timer)
        return timer

    # Services for other processes

    def __serve(self) -> None:
        self.create_service(ChangeState, "~/change_state", self.__change_state, concurrent=True)
        answers = StateAnswers(self.__transitions.machine, msg.State, msg.TransitionDescription)
        for srv_type, answer in (
            (GetState, answers.get_state),
            (GetAvailableStates, answers.get_available_states),
            (GetAvailableTransitions, answers.get_available_transitions),
            (GetAvailableTransitions, answers.get_transition_graph),
        ):
            self.create_service(srv_type, f"~/{answer.__name__}", answer)

    async def __change_state(
        self, request: ChangeState.Request, response: ChangeState.Response
    ) -> ChangeState.Response:
        response.success = await self.__change(request.transition.label, request.transition.id)
        return response

    async def __change(self, label: str, transition_id: int) -> bool:
        """Carry out a request; return whether it succeeded."""
        machine = self.__transitions.machine
        if machine.in_transition and is_shutdown(label, transition_id):
            await self.__transitions.make_way_for_shutdown()
            transition = self.__transitions.find("shutdown")
        else:
            transition = self.__transitions.find(label, transition_id)
        if transition is None:
            return False
        if not machine.in_transition:
            return await self.__transitions.run(transition) is SUCCESS
        # The requester ends the running callback with the result of its choice.
        if transition.label == SUCCESS.to_label() or transition.start == ERROR_PROCESSING:
            return False
        wanted = next(
            result for result in TransitionCallbackReturn if result.to_label() == transition.label
        )
        self.__transitions.cancel(wanted)
        await self.__transitions.wait_idle()
        return True

    def __publish_event(self, start: State, goal: State) -> None:
        if not self.__transition_events.destroyed:
            self.__transition_events.publish(fill_event(msg.TransitionEvent(), start, goal))


def is_shutdown(label: str, transition_id: int) -> bool:
    """Whether a request is for a shutdown, which has a number for each state."""
    if label:
        return label == "shutdown"
    return any(
        transition.label == "shutdown" and transition.transition_id == transition_id
        for transition in TRANSITIONS
    )
