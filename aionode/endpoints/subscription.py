"""Subscriptions.

Messages arrive in `core/subscription_reader.py`; a full `core/message_queue.py` drops the oldest;
`core/callback_runner.py` calls the callback.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode._process.concurrency import checkpoint
from aionode.clock import perf_ns
from aionode.endpoints._qos.event_hub import is_limited
from aionode.endpoints._qos.subscription_monitor import SubscriptionMonitor
from aionode.endpoints.core.callback_runner import (
    CallbackRunner,
    accepts,
    checked_concurrency,
    consume,
)
from aionode.endpoints.core.endpoint import Endpoint, report_heavy
from aionode.endpoints.core.silence_watch import Silence, SilenceWatch
from aionode.endpoints.core.subscription_reader import (
    CausalReader,
    DirectReader,
    MessageInfo,
    SubscriptionReader,
    size_of_raw,
)
from aionode.endpoints.stats import CallbackStats
from aionode.engine.membership import register
from aionode.engine.transport.base import ReaderRegistration
from aionode.engine.wire.byte_filter import decoding
from aionode.errors import EntityDestroyedError
from aionode.message import Message
from aionode.message.memory_size import memory_size

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Sequence

    from aionode.content_filter import ContentFilterOptions
    from aionode.endpoints.core.callback_runner import OnError
    from aionode.endpoints.core.endpoint import EndpointSetup
    from aionode.endpoints.core.subscription_reader import Take
    from aionode.endpoints.events import (
        EventStream,
        SubscriptionEvent,
        SubscriptionEventCallbacks,
    )
    from aionode.engine.transport.base import Raw, Registration
    from aionode.graph import EndpointInfo

__all__ = [
    "MessageInfo",
    "Subscription",
    "SubscriptionCallback",
    "reader_of",
    "silence_watch_of",
    "take_from",
]

ItemT = TypeVar("ItemT")

SubscriptionCallback = Callable[[ItemT], object] | Callable[[ItemT, MessageInfo], object]
"""The callback of a subscription, sync or async; an awaitable result is awaited."""


class Subscription(Endpoint, Generic[ItemT]):
    """Receives the messages of one topic. Created by `Node.create_subscription`.

    A callback is called with each message while the node runs. Without one, the subscription is an
    async iterator: ``async for msg in subscription``. If several tasks read it, each message goes
    to one of them.

    Attributes:
        msg_type: The class of its messages.
        qos_profile: Its profile.
        raw: Whether it receives CDR bytes instead of messages.
        callback: The callback, or None.
        stats: Counts and durations of its messages.
    """

    def __init__(
        self,
        setup: EndpointSetup,
        msg_type: type[Message],
        callback: SubscriptionCallback[ItemT] | None,
        *,
        concurrent: bool | int,
        raw: Raw,
        on_error: OnError,
        offload: bool,
        content_filter_options: ContentFilterOptions | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        silence: Silence | None = None,
        take: Take | None = None,
    ) -> None:
        super().__init__(f"subscription of {setup.endpoint.name}", setup)
        self._time_base = time_base = setup.context.time_base
        self.msg_type = msg_type
        self.raw = bool(raw)
        self.callback = callback or take
        self.stats = CallbackStats()
        self._registrations: list[Registration] = []  # one per transport, once it is complete
        self._content_filter: ContentFilterOptions | None = None
        self._concurrent = checked_concurrency(concurrent, self._subject)
        self._turn_ends_ns = 0
        self._runner: CallbackRunner | None = None
        wants = 1
        if callback is not None:
            wants = accepts(
                callback, 1, 2, subject=self._subject, wanted="(message) or (message, info)"
            )
            self._runner = setup.callbacks.make_runner(
                callback, self, self.stats, on_error=on_error, offload=offload
            )
        self._reader: SubscriptionReader
        options: dict[str, Any] = {"raw": raw, "wants_info": wants == 2}
        if take is not None:
            self._reader = DirectReader(setup.endpoint, self.stats, time_base, take)
        elif self._causes is not None:
            self._reader = CausalReader(
                setup.endpoint, self.stats, time_base, log=self._causes, **options
            )
        else:
            self._reader = SubscriptionReader(setup.endpoint, self.stats, time_base, **options)
        size_of = size_of_raw if raw else memory_size(msg_type)
        if size_of is not None:
            self._reader.weigh_messages(
                size_of, setup.context.network.queue_bytes, partial(report_heavy, setup, "dropped")
            )
        if self._runner is not None:
            self._reader.set_runner(self._runner)
        self._runs = False
        self._monitor: SubscriptionMonitor | None = None  # if a policy or the program needs one
        qos = self.qos_profile
        limits = qos.deadline, qos.lifespan, qos.liveliness_lease_duration
        if event_callbacks is not None or is_limited(*limits):
            self._make_monitor(event_callbacks)
        else:
            self._watch(self._note_publisher)
        self._silence_watch: SilenceWatch | None = None
        if silence is not None and self._runner is not None:
            self._silence_watch = self._make_watch(silence, self._runner, on_error)
            self._reader.set_watch(self._silence_watch)
        if content_filter_options is not None:
            self.set_content_filter(
                content_filter_options.filter_expression,
                content_filter_options.expression_parameters,
            )
        # Last, as messages may arrive from now on.
        self._registrations = register(
            setup.context,
            lambda transport: transport.create_reader(self._endpoint, msg_type, self._reader),
        )

    def __repr__(self) -> str:
        return (
            f"<Subscription {self.topic_name} {self._endpoint.type_name} "
            f"{self.qos_profile} "
            f"received={self.stats.received} dropped={self.stats.dropped}>"
        )

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self._endpoint.name

    topic = topic_name

    def get_publisher_count(self) -> int:
        """Return the number of matched publishers, in this process and others."""
        return self._count_matched()

    # Content filter

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a content filter is set."""
        options = self._content_filter
        return options is not None and bool(options.filter_expression)

    def set_content_filter(
        self, filter_expression: str, expression_parameters: Sequence[str] = ()
    ) -> None:
        """Receive only messages that pass a filter, from now on.

        Messages already in the queue stay there. `stats.filtered` counts messages that arrived but
        did not pass.

        Args:
            filter_expression: A condition over the fields of the message, as described in
                `aionode.content_filter`; an empty one lets all messages pass.
            expression_parameters: The literals that ``%0``, ``%1`` and so on stand for, as text.

        Raises:
            ContentFilterError: the expression is malformed, or does not fit the type (a
                ValueError); the previous filter stays.
            TypeError: a parameter is not a str.
            EntityDestroyedError: the subscription was destroyed (a RuntimeError).
        """
        if self._affinity.is_other_thread():
            self._affinity.wait_for(
                self.set_content_filter, filter_expression, expression_parameters
            )
            return
        # Imported on demand: few subscriptions have one.
        from aionode.content_filter import ContentFilterOptions, compile_filter

        self._refuse_if_destroyed("set content filter")
        accepts = None
        options = ContentFilterOptions(filter_expression, list(expression_parameters))
        if filter_expression:
            accepts = compile_filter(self.msg_type, filter_expression, expression_parameters)
            if self.raw:
                accepts = decoding(self.msg_type, accepts)
        self._content_filter = options
        self._reader.set_filter(accepts)

    def get_content_filter(self) -> ContentFilterOptions:
        """Return the content filter; its expression is empty if there is none."""
        from aionode.content_filter import ContentFilterOptions

        given = self._content_filter or ContentFilterOptions()
        return ContentFilterOptions(given.filter_expression, list(given.expression_parameters))

    # Events

    @property
    def events(self) -> EventStream[SubscriptionEvent]:
        """The events of the subscription: ``async for event in subscription.events``.

        It is the same stream each time, and starts with what has happened so far.
        """
        return (self._monitor or self._make_monitor()).events()

    def _note_publisher(self, publisher: EndpointInfo, present: bool) -> None:
        """Enable the expiry of messages if a publisher has a lifespan."""
        limited = present and is_limited(publisher.qos.lifespan)
        if limited and self._monitor is None and self._endpoint.matches(publisher):
            self._make_monitor()

    def _make_monitor(
        self, event_callbacks: SubscriptionEventCallbacks | None = None
    ) -> SubscriptionMonitor:
        monitor = SubscriptionMonitor(self, self._reader, self._time_base, event_callbacks)
        self._monitor = self._reader.monitor = monitor
        if self._runs:
            monitor.start()
        if self.destroyed:
            monitor.close()
        return monitor

    def _make_watch(
        self, silence: Silence, runner: CallbackRunner, on_error: OnError
    ) -> SilenceWatch:
        return SilenceWatch(
            self,
            self._reader,
            runner,
            # Never in a thread: stopping a robot must not wait for a free one.
            lambda callback: self._callbacks.make_runner(
                callback, self, self.stats, on_error=on_error, offload=False
            ),
            silence,
            self._time_base,
            self._is_linked,
        )

    def _is_linked(self, gid: bytes) -> bool | None:
        """Return whether a publisher is connected by a link; None if it never was."""
        for registration in self._registrations:
            if isinstance(registration, ReaderRegistration):
                linked = registration.is_linked(gid)
                if linked is not None:
                    return linked
        return None

    # Reading without a callback

    def __aiter__(self) -> AsyncIterator[ItemT]:
        """Iterate over messages as they arrive, until the subscription is destroyed."""
        reader_of(self)
        return self

    async def __anext__(self) -> ItemT:
        """Wait for the next message; stop once destroyed and empty."""
        try:
            return await self.receive()
        except EntityDestroyedError:
            raise StopAsyncIteration from None

    async def receive(self) -> ItemT:
        """Wait for the next message and return it. Cancelling loses no message.

        Raises:
            EntityDestroyedError: the subscription is destroyed, and all messages have been read.
            RuntimeError: the subscription has a callback, which gets the messages.
        """
        reader = reader_of(self)
        if perf_ns() >= self._turn_ends_ns:
            # While the queue has messages this never waits, so nothing else would run.
            await checkpoint()
            self._turn_ends_ns = perf_ns() + reader.slice_ns
        while not reader:
            self._refuse_if_destroyed("read messages")
            await reader.wait()
        return take_from(self)

    # Called by the node

    def _run(self) -> Coroutine[Any, Any, None] | None:
        """Return the coroutine that calls the callback; None without a callback."""
        self._runs = True
        if self._monitor is not None:
            self._monitor.start()
        if self._runner is None:
            return None
        receive: Callable[[int, Any], Coroutine[Any, Any, None] | None] = self._runner.receive
        if self._reader.wants_info:
            with_info = self._runner.receive
            receive = lambda entered_ns, item: with_info(entered_ns, *item)  # noqa: E731
        if isinstance(self._reader, CausalReader):
            receive = self._reader.noting(receive)
        if self._silence_watch is not None:
            self._silence_watch.start()
            return self._silence_watch.consume(receive, self._concurrent)
        self._reader.is_concurrent = self._concurrent is not False
        inline = self._runner.is_sync and not self._reader.is_concurrent
        return consume(self._reader, receive, self._concurrent, inline=inline)

    def _close(self) -> None:
        """Withdraw the subscription; without a callback, unread messages can still be read."""
        if self._monitor is not None:
            self._monitor.close()
        if self._silence_watch is not None:
            self._silence_watch.close()
        self._leave_graph()
        for registration in self._registrations:
            registration.close()
        self._reader.close(discard=self._runner is not None)


def reader_of(subscription: Subscription[Any]) -> SubscriptionReader:
    """Return where the messages of a subscription without a callback wait for `take_from`.

    Raises:
        RuntimeError: it has a callback, which gets them.
    """
    if subscription.callback is not None:
        raise RuntimeError(
            f"{subscription._subject}: its callback gets the messages; to read them yourself, "
            "create the subscription without a callback"
        )
    return subscription._reader


def take_from(subscription: Subscription[ItemT]) -> ItemT:
    """Take the oldest message and count it."""
    reader, stats = subscription._reader, subscription.stats
    entered_ns, item = reader.pop()
    stats.received += 1
    stats.queue_wait.record(perf_ns() - entered_ns)
    if isinstance(reader, CausalReader):
        item = reader.taken(entered_ns, item)
    taken: ItemT = item
    return taken


def silence_watch_of(subscription: Subscription[Any]) -> SilenceWatch | None:
    """Return what calls `on_silence` of a subscription; None without one."""
    return subscription._silence_watch
