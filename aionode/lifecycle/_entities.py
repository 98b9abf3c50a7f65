"""Entities of a managed node that work only while the node is active."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.endpoints.core.entity import end_lease
from aionode.endpoints.publisher import make_lease
from aionode.engine.rules.lifecycle_states import ACTIVE, TransitionCallbackReturn
from aionode.engine.rules.managed_entity import ManagedEntity, SimpleManagedEntity
from aionode.errors import EntityInactiveError
from aionode.message import Message

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.clock import Clock
    from aionode.endpoints.core.silence_watch import SilenceWatch
    from aionode.endpoints.events import EventStream, PublisherEvent
    from aionode.endpoints.lease import CommandLease
    from aionode.endpoints.publisher import Publisher
    from aionode.endpoints.stats import PublisherStats
    from aionode.endpoints.timer import Timer
    from aionode.engine.rules.lifecycle_states import State
    from aionode.qos import QoSProfile

__all__ = [
    "LifecyclePublisher",
    "LifecycleTimer",
    "enabled_of",
    "settle_entities",
]

MsgT = TypeVar("MsgT", bound=Message)


class LifecyclePublisher(SimpleManagedEntity, Generic[MsgT]):
    """A publisher that sends only while its node is active; made by `create_lifecycle_publisher`.

    Attributes:
        discarded: How many messages were published and discarded while it was disabled.
    """

    def __init__(self, publisher: Publisher[MsgT]) -> None:
        super().__init__()
        self.discarded = 0
        self._publisher = publisher

    def __repr__(self) -> str:
        state = "enabled" if self.is_activated else "disabled"
        return f"<LifecyclePublisher {state} {self._publisher!r}>"

    @property
    def msg_type(self) -> type[MsgT]:
        """The class of its messages."""
        return self._publisher.msg_type

    @property
    def topic_name(self) -> str:
        """The topic's full name."""
        return self._publisher.topic_name

    topic = topic_name

    @property
    def qos_profile(self) -> QoSProfile:
        """Its QoS."""
        return self._publisher.qos_profile

    @property
    def stats(self) -> PublisherStats:
        """Its statistics."""
        return self._publisher.stats

    def publish(self, msg: MsgT | bytes | bytearray | memoryview) -> None:
        """Publish a message if enabled, like `Publisher.publish`; otherwise discard it.

        Raises:
            Exception: while enabled, the exceptions of `Publisher.publish`.
        """
        if self.is_activated:
            self._publisher.publish(msg)
        else:
            self.discarded += 1

    def lease(
        self,
        stop: MsgT | bytes | bytearray | memoryview | None,
        ttl_sec: float = 0.3,
        clock: Clock | None = None,
    ) -> CommandLease[MsgT]:
        """Create a command lease, like `Publisher.lease`.

        It can be entered only while the publisher is enabled. On deactivation the stop is sent
        first, and ``lease.publish`` raises EntityInactiveError from then on.

        Raises:
            Exception: the exceptions of `Publisher.lease`.
        """
        return make_lease(self._publisher, stop, ttl_sec, clock, self._refuse_if_disabled)

    def _refuse_if_disabled(self) -> None:
        if not self.is_activated:
            raise self._inactive()

    def _inactive(self) -> EntityInactiveError:
        return EntityInactiveError(f"publisher of {self.topic_name}")

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Send the stop of an open lease, and disable the publisher."""
        end_lease(self._publisher, self._inactive)
        return super().on_deactivate(state)

    def assert_liveliness(self) -> None:
        """Signal to subscriptions that the publisher is alive, in any state of the node.

        Raises:
            EntityDestroyedError: the publisher or its node was destroyed (a RuntimeError).
        """
        self._publisher.assert_liveliness()

    @property
    def events(self) -> EventStream[PublisherEvent]:
        """The events of the publisher; see `Publisher.events`."""
        return self._publisher.events

    async def drain(self) -> None:
        """Wait until messages have been sent; see `Publisher.drain`."""
        await self._publisher.drain()

    def get_subscription_count(self) -> int:
        """Return how many subscriptions are matched."""
        return self._publisher.get_subscription_count()

    async def wait_for_subscribers(self, count: int = 1) -> None:
        """Wait until at least `count` subscriptions are matched; `asyncio.timeout` limits it."""
        await self._publisher.wait_for_subscribers(count)

    def destroy(self) -> None:
        """Destroy the publisher; calling it again has no effect."""
        self._publisher.destroy()


class LifecycleTimer(SimpleManagedEntity):
    """A timer that runs only while its node is active; made by `create_lifecycle_timer`.

    Each activation starts a new first period.

    Attributes:
        timer: The timer itself.
    """

    def __init__(self, timer: Timer) -> None:
        super().__init__()
        self.timer = timer

    def reset(self) -> None:
        """Make the next call one period from now, even if the timer was canceled.

        While the node is not active this has no effect: the activation starts the timer.

        Raises:
            EntityDestroyedError: the timer or its node was destroyed (a RuntimeError).
        """
        if self.is_activated:
            self.timer.reset()

    def cancel(self) -> None:
        """Stop calling until `reset` or the next activation."""
        self.timer.cancel()

    def is_canceled(self) -> bool:
        """Return whether the timer is stopped: canceled, or its node not active."""
        return self.timer.is_canceled()

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Start the timer."""
        self.timer.reset()
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Stop the timer."""
        self.timer.cancel()
        return super().on_deactivate(state)


class Gate(SimpleManagedEntity):
    """Lets calls through to a callback while its node is active.

    Attributes:
        discarded: How many messages arrived while it was disabled.
    """

    def __init__(self) -> None:
        super().__init__()
        self.discarded = 0
        self._watch: SilenceWatch | None = None

    def guard(self, watch: SilenceWatch) -> None:
        """Watch a subscription for silence only while it is enabled."""
        self._watch = watch
        watch.enable(enabled=self.is_activated)

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Let calls through; the first message arms the silence watch."""
        result = super().on_activate(state)
        if self._watch is not None:
            self._watch.enable(enabled=True)
        return result

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Block calls and watch no silence: whoever deactivates the node decides what stops."""
        result = super().on_deactivate(state)
        if self._watch is not None:
            self._watch.enable(enabled=False)
        return result

    def dropping(self, callback: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a message callback so that it discards messages while disabled."""

        @functools.wraps(callback)
        def gated(*args: Any) -> Any:
            if self.is_activated:
                return callback(*args)
            self.discarded += 1
            return None

        return gated

    def refusing(self, callback: Callable[..., Any], subject: str) -> Callable[..., Any]:
        """Wrap a request callback so that it raises EntityInactiveError while disabled."""

        @functools.wraps(callback)
        def gated(*args: Any) -> Any:
            if not self.is_activated:
                raise EntityInactiveError(subject)
            return callback(*args)

        return gated


def enabled_of(entities: Iterable[ManagedEntity]) -> list[SimpleManagedEntity]:
    """Return the entities that are currently enabled."""
    return [
        entity
        for entity in entities
        if isinstance(entity, SimpleManagedEntity) and entity.is_activated
    ]


def settle_entities(
    entities: Iterable[ManagedEntity],
    enabled: Iterable[SimpleManagedEntity],
    start: State,
    *,
    is_active: bool,
) -> None:
    """Enable entities in the active state and disable them in others, however a transition ended.

    Args:
        entities: All entities of the node.
        enabled: The entities that were enabled before the transition.
        start: The state in which the transition started.
        is_active: Whether the node is active now.
    """
    if not is_active:
        for entity in reversed(enabled_of(entities)):
            entity.on_deactivate(start)
    elif start == ACTIVE:  # a deactivation failed half-way
        for entity in enabled:
            if not entity.is_activated:
                entity.on_activate(start)
