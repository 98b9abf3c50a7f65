"""Publishers.

`engine/wire/cdr/_encoder.py` encodes messages field by field; the writers in
`engine/transport/link/_publisher.py` and `engine/transport/zenoh/endpoints/publisher.py` send them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import cached_property, partial
from threading import get_ident
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.endpoints._qos.event_hub import is_limited
from aionode.endpoints._qos.publisher_monitor import PublisherMonitor
from aionode.endpoints.core.endpoint import Endpoint
from aionode.endpoints.core.entity import EndStage
from aionode.endpoints.core.noting_writer import NotingWriter
from aionode.endpoints.lease import CommandLease
from aionode.endpoints.stats import PublisherStats
from aionode.engine.causes import Party
from aionode.engine.membership import register
from aionode.engine.transport.base import Writer
from aionode.errors import (
    EntityDestroyedError,
    InvalidQoSProfileException,
    LeaseHeldError,
    MessageError,
    QueueFullError,
)
from aionode.message import Message, checker, snapshot
from aionode.qos import KEEP_ALL_DEPTH, DurabilityPolicy, depth_of, keeps_all

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.endpoints.core.endpoint import EndpointSetup
    from aionode.endpoints.events import EventStream, PublisherEvent, PublisherEventCallbacks
    from aionode.engine.transport.base import StopSender

__all__ = ["Publisher", "make_lease"]

MsgT = TypeVar("MsgT", bound=Message)


class HeldWriter(Writer):
    """Replaces a publisher's writers while a lease is held, so that `publish` raises.

    That way `publish` needs no check for a lease.
    """

    bounded = True

    def __init__(self, topic: str) -> None:
        self._topic = topic

    def has_room(self) -> bool:
        """Refuse the message.

        Raises:
            LeaseHeldError: always.
        """
        raise LeaseHeldError(self._topic)

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing: there is nothing to withdraw."""


class Publisher(Endpoint, Generic[MsgT]):
    """Sends messages of one type to one topic. Created by `Node.create_publisher`.

    Attributes:
        msg_type: The class of its messages.
        qos_profile: Its profile.
        stats: How much it sent, and over which routes.
    """

    def __init__(
        self,
        setup: EndpointSetup,
        msg_type: type[MsgT],
        event_callbacks: PublisherEventCallbacks | None = None,
    ) -> None:
        super().__init__(f"publisher of {setup.endpoint.name}", setup, EndStage.LAST)
        self.msg_type = msg_type
        self._time_base = time_base = setup.context.time_base
        self._now_ns = time_base.system_ns
        self._monitor: PublisherMonitor | None = None  # if a policy or the program needs one
        qos = self.qos_profile
        if event_callbacks is not None or is_limited(qos.deadline, qos.liveliness_lease_duration):
            # Before anything is announced to others, as it may reject callbacks.
            self._monitor = PublisherMonitor(self, time_base, event_callbacks)
        self._lease: CommandLease[MsgT] | None = None  # while it is held
        writers = self._all_writers = tuple(  # one per transport
            register(
                setup.context, lambda transport: transport.create_writer(setup.endpoint, msg_type)
            )
        )
        self.stats = PublisherStats(writers, self._matched)
        # The tasks in `drain`, and whether `_close` cancelled them.
        self._draining: dict[asyncio.Task[Any], bool] = {}
        notes: list[Callable[[int], None]] = []
        if self._monitor is not None and self._monitor.needs_signs:
            notes.append(self._monitor.note_message)
        if self._causes is not None:
            notes.append(partial(self._causes.note, "message", Party.of(self._endpoint)))
        self._noting: tuple[Writer, ...] = ()
        if notes:
            self._noting = (NotingWriter(writers, checker(msg_type), notes),)
        self._leave_out_placeholders()
        for writer in writers:
            writer.when_replaced(self._leave_out_placeholders)

    def _leave_out_placeholders(self) -> None:
        """Send messages only to writers that are not placeholders."""
        ready = tuple(writer for writer in self._all_writers if not writer.is_placeholder)
        self._ready_writers: tuple[Writer, ...] = ready + self._noting
        if self._lease is None:
            self._writers: tuple[Writer, ...] = self._ready_writers
        else:
            self._lease.prepare()

    def __repr__(self) -> str:
        return (
            f"<Publisher {self.topic_name} {self._endpoint.type_name} "
            f"{self.qos_profile} published={self.stats.published}>"
        )

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self._endpoint.name

    topic = topic_name

    def publish(self, msg: MsgT | bytes | bytearray | memoryview) -> None:
        """Send `msg` to every matched subscription; never blocks or waits.

        The object may be changed and published again at once, as readers get a snapshot. A full
        KEEP_LAST queue drops and counts its oldest message. To wait for slow readers instead,
        subscribe with KEEP_ALL and `await drain()` before the next message.

        The message may also be CDR bytes, for example as received by a subscription with
        ``raw=True``.

        It may be called from any thread, such as that of an offloaded callback. Outside the event
        loop's thread it blocks until the loop has taken the message.

        Raises:
            TypeError: `msg` is not of this publisher's type.
            MessageError: a value does not fit its field; nothing was sent.
            DecodeError: the bytes are not a message of this publisher's type (a ValueError).
            QueueFullError: a reliable KEEP_ALL subscription of this process is full;
                nothing was sent.
            LeaseHeldError: a lease of the publisher is held (a RuntimeError); nothing was sent.
            EntityDestroyedError: the publisher or its node was destroyed (a RuntimeError).
        """
        thread = self._affinity.thread
        if thread and thread != get_ident() and self._affinity.is_other_thread():
            self._affinity.wait_for(self.publish, msg)
            return
        if self.destroyed:
            raise EntityDestroyedError(self._subject)
        if type(msg) is not self.msg_type:
            msg = self._fitting(msg)
        for writer in self._writers:
            if writer.bounded and not writer.has_room():
                raise QueueFullError(self.topic_name, KEEP_ALL_DEPTH)
        stats = self.stats
        sequence, source_ns = stats.published + 1, self._now_ns()
        used = False
        try:
            for writer in self._writers:
                if writer.active:
                    writer.write(msg, sequence, source_ns)
                    used = True
            if not used:
                self._check(msg)
        except MessageError as error:
            error.add_note(f"published by {self._subject}")
            raise
        stats.published = sequence

    @cached_property
    def _check(self) -> Callable[[Any], None]:
        """Raises what `publish` raises for a message that no writer checks."""
        return checker(self.msg_type)

    def _fitting(self, msg: Any) -> Any:
        """Return `msg`, decoded if bytes; TypeError if it is of an unrelated class."""
        if isinstance(msg, bytes | bytearray | memoryview):
            from aionode.engine.wire import cdr  # most publishers never need the codec

            return cdr.decode(self.msg_type, msg)
        self._check(msg)  # raises TypeError; accepts subclasses
        return msg

    # The lease

    def lease(
        self,
        stop: MsgT | bytes | bytearray | memoryview | None,
        ttl_sec: float = 0.3,
        clock: Clock | None = None,
    ) -> CommandLease[MsgT]:
        """Create a command lease for ``async with``, which sends `stop` when it ends.

        ::

            async with publisher.lease(stop=Twist(), ttl_sec=0.3) as lease:
                lease.publish(command)

        While the lease is held, only ``lease.publish`` publishes, and no other lease of this
        publisher can be entered. Other publishers of the topic are not affected. See `CommandLease`
        for when the stop is sent.

        Args:
            stop: The message that stops what the commands move, or its CDR bytes. It is validated
                and encoded when the block is entered. None if there is nothing to stop before the
                first command, which brings its own stop; see `CommandLease.publish`.
            ttl_sec: The longest pause between commands, in seconds, from the first command on. It
                is measured in steady time, including time while the host is suspended.
            clock: A different clock to measure it, as for timers. If that clock stands still for
                `ttl_sec` of steady time, the lease ends as well.

        Raises:
            InvalidQoSProfileException: the publisher is KEEP_ALL, so the stop might have to wait,
                or transient local with a depth above 1, so late subscriptions would get old
                commands before the stop (a ValueError).
            TypeError: `ttl_sec` is not a number, or `clock` not a clock.
            ValueError: `ttl_sec` is not positive and finite.
        """
        return make_lease(self, stop, ttl_sec, clock)

    def _hold(
        self, lease: CommandLease[MsgT], stop: MsgT | bytes | bytearray | memoryview | None
    ) -> None:
        """Give `lease` the exclusive right to publish, and prepare its stop, if there is one."""
        self._refuse_if_destroyed("enter a lease")
        if self._lease is not None:
            self._lease.finish()
        if self._lease is not None:
            raise LeaseHeldError(self.topic_name)
        lease.prepare(None if stop is None else self._stop_of(stop))
        self._lease = lease
        self._writers = (HeldWriter(self.topic_name),)

    def _stop_of(self, stop: MsgT | bytes | bytearray | memoryview) -> MsgT:
        """Return a stop as a message that nobody modifies."""
        return snapshot(stop if type(stop) is self.msg_type else self._fitting(stop))

    def _prepare_stop(self, stop: MsgT, number: Callable[[], int]) -> tuple[StopSender, ...]:
        """Return the stop senders of a lease, one per transport; `number` numbers the stop."""
        stats = self.stats
        return tuple(
            writer.prepare_stop(stop, lambda: number() == stats.published)
            for writer in self._ready_writers
        )

    def _let_go(self) -> None:
        """Allow `publish` again, as the lease has ended."""
        self._lease = None
        self._writers = self._ready_writers

    def _publish_leased(self, msg: MsgT | bytes | bytearray | memoryview, source_ns: int) -> None:
        """Publish a command of the lease, stamped with a time."""
        held, now_ns = self._writers, self._now_ns
        self._writers, self._now_ns = self._ready_writers, lambda: source_ns
        try:
            self.publish(msg)
        finally:
            self._writers, self._now_ns = held, now_ns

    def _number_stop(self, step: int) -> tuple[int, int]:
        """Return the sequence number of the stop, `step` after the last one, and its time."""
        self.stats.published += step
        return self.stats.published, self._time_base.system_ns()  # also while a command is sent

    def _end_lease(self, refusal: Callable[[], Exception]) -> None:
        """Send the stop of an open lease; its `publish` then raises what `refusal` returns."""
        if self._lease is not None:
            self._lease.end_for(refusal)

    def assert_liveliness(self) -> None:
        """Signal to subscriptions that the publisher is alive, without a message.

        With liveliness MANUAL_BY_TOPIC it must be called, or a message published, at least once per
        `liveliness_lease_duration`. Like `publish`, it may be called from any thread.

        Raises:
            EntityDestroyedError: the publisher or its node was destroyed (a RuntimeError).
        """
        if self._affinity.is_other_thread():
            self._affinity.wait_for(self.assert_liveliness)
            return
        self._refuse_if_destroyed("assert liveliness")
        if self._monitor is not None:
            self._monitor.renew_lease()
        for writer in self._all_writers:
            writer.assert_liveliness()

    @property
    def events(self) -> EventStream[PublisherEvent]:
        """The events of the publisher: ``async for event in publisher.events``.

        It is the same stream each time, and starts with what has happened so far.
        """
        if self._monitor is None:
            self._monitor = PublisherMonitor(self, self._time_base, None)
            if self.destroyed:
                self._monitor.close()
        return self._monitor.events()

    def _is_drained(self) -> bool:
        """Return whether `drain` would not have to wait."""
        return all(writer.is_drained() for writer in self._ready_writers)

    async def drain(self) -> None:
        """Wait until every reliable KEEP_ALL reader has room and nothing is left to send.

        By then, messages to other processes have been handed to the transport. It does not wait
        for callbacks. Cancelling is safe.

        Raises:
            EntityDestroyedError: the publisher was destroyed during the wait (a RuntimeError);
                published messages are sent all the same. Its ``__cause__`` is the node's error, if
                it failed.
            CancelledError: the publisher was destroyed during the wait of one of the node's own
                tasks: a callback, or the body of ``async with node``.
        """
        task = asyncio.current_task()
        assert task is not None  # noqa: S101  # a coroutine runs in one
        cancelling = task.cancelling()
        self._draining[task] = False
        try:
            for writer in self._ready_writers:
                await writer.drain()
        except asyncio.CancelledError:
            # As in asyncio.timeout, a cancellation by others propagates.
            if not self._draining[task] or task.uncancel() > cancelling:
                raise
            end = self._end_of_wait()
            raise end from end.__cause__
        finally:
            del self._draining[task]

    def get_subscription_count(self) -> int:
        """Return the number of matched subscriptions, in this process and others."""
        return self._count_matched()

    async def wait_for_subscribers(self, count: int = 1) -> None:
        """Wait, without a timeout, until at least `count` subscriptions are matched.

        Raises:
            EntityDestroyedError, CancelledError: the publisher was destroyed, as in `drain`.
        """
        await self._until(lambda: self.get_subscription_count() >= count)

    def _run(self) -> None:
        """Start monitoring deadline and liveliness; there is no work for a task."""
        if self._monitor is not None:
            self._monitor.start(self._all_writers)

    def _close(self) -> None:
        """Withdraw the publisher, with the stop of an open lease as its last message."""
        self._end_lease(lambda: EntityDestroyedError(self._subject))
        if self._monitor is not None:
            self._monitor.close()
        self._leave_graph()
        for task in self._draining:
            self._draining[task] = True
            task.cancel()
        for writer in self._all_writers:
            writer.close()


def make_lease(
    publisher: Publisher[MsgT],
    stop: MsgT | bytes | bytearray | memoryview | None,
    ttl_sec: float,
    clock: Clock | None,
    refuse: Callable[[], None] | None = None,
) -> CommandLease[MsgT]:
    """Create a lease, like `Publisher.lease`; `refuse` raises if it cannot be entered."""
    qos, topic = publisher.qos_profile, publisher.topic_name
    if keeps_all(qos):
        raise InvalidQoSProfileException(
            f"a lease of {topic} needs a KEEP_LAST publisher: the stop must not wait for slow "
            "readers, as messages of a KEEP_ALL one do"
        )
    depth = depth_of(qos)
    if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL and depth > 1:
        raise InvalidQoSProfileException(
            f"a lease of {topic} needs depth 1 with TRANSIENT_LOCAL, not {depth}: a late "
            "subscription would get old commands before the stop"
        )
    return CommandLease(publisher, stop, ttl_sec, clock, publisher._time_base, refuse)
