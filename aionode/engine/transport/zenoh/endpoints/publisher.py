"""Publishers on Zenoh."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import zenoh
from zenoh import ext

from aionode.clock import SilenceAlarm, perf_ns
from aionode.engine.transport.base import Writer
from aionode.engine.transport.reliability.stateful_writer import MUTE_TICKS, StatefulWriter
from aionode.engine.transport.send_thread import SendQueue, SendThread
from aionode.engine.transport.zenoh._defects import history_lock
from aionode.engine.transport.zenoh._session_state import Declaration
from aionode.engine.transport.zenoh.connections.handlers import (
    BLOCKING_PRIORITY,
    BULK_BYTES,
    BULK_PRIORITY,
    LOOP_PRIORITY,
    direct,
    reason,
)
from aionode.engine.transport.zenoh.delivery.acknowledgements import TICK_S
from aionode.engine.transport.zenoh.delivery.delivery import (
    FLUSH_NS,
    GIVEN_UP_NS,
    STILL_NS,
    is_reliable,
    is_transient,
    send_bulk,
    withdraw,
)
from aionode.engine.transport.zenoh.delivery.expiry import unless_expired
from aionode.engine.transport.zenoh.delivery.kept_history import declare_keeping, declare_plain
from aionode.engine.transport.zenoh.discovery.matched_readers import MatchedReaders
from aionode.engine.transport.zenoh.endpoints.stop import ZenohStop
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import Side
from aionode.errors import TransportError
from aionode.qos import depth_of, is_unlimited, keeps_all

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import StopSender
    from aionode.engine.transport.reliability.reader_proxy import ReaderProxy
    from aionode.engine.transport.reliability.submessage import Submessage
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.graph import EndpointInfo

__all__ = ["ZenohWriter"]

logger = logging.getLogger("aionode.transport.zenoh")

LATE = 1_000
"""Messages of a KEEP_LAST publisher, or its depth if that is more, that wait for Zenoh while Zenoh
answers a late reader, or in a crowd; else none wait."""

MORE_DEPTH = "A greater depth keeps more of them, KEEP_ALL and `await drain()` all"
DRAIN = "`await drain()` before the end waits for readers that still take them"


class ZenohWriter(Declaration, Writer):
    """A publisher for the subscriptions of other contexts.

    A message is sent in one of three ways, each with a priority and so a queue of its own in Zenoh:
    by the event loop, which never waits; by the thread for large messages; or by a thread of this
    publisher, which waits: for readers that do not acknowledge and must not lose it, or, of a
    transient local one, for Zenoh, which answers a late reader with the history locked.
    """

    recovers: ClassVar[bool] = True  # whether its readers ask again for what they miss
    used_bulk = False  # whether a large message was put since a lease began
    _stop: ZenohStop | None = None  # of a lease, while it is put again

    def __init__(self, state: SessionState, endpoint: EndpointInfo, msg_type: type[Any]) -> None:
        self._key, token, gid = state.names_of(endpoint)
        super().__init__(state, token, gid)
        self.endpoint = endpoint
        qos = endpoint.qos
        self._msg_type = msg_type
        # None until it is needed, as it takes a while to make; `_update` does that, so that no
        # callback has to.
        self._encode: Callable[[Any], bytes] | None = None
        # Set by the loop only. A thread puts into the one that its job was given, and the same
        # thread undeclares that after its last job (`_withdraw`).
        self._publisher: zenoh.Publisher | ext.AdvancedPublisher | None = None
        self._matching: zenoh.MatchingListener[None] | None = None
        # Whether Zenoh has subscribers, those without a token included; its listener tells.
        self._is_matching = False
        self._matching_changed = state.queue(self._update_with, limit=1)
        self._matched = MatchedReaders(endpoint, state)
        # Whether a small message may be put at once, see `_update_route`.
        self._is_direct = True
        # Whether a message has been put into `_large` since that was last seen empty.
        self._is_large_used = False
        self._is_watched = False  # whether `tick` is being called
        self._transient = is_transient(qos)
        self._needs_thread = history_lock.needs_thread(is_transient=self._transient)
        self._depth = depth_of(qos)
        self._reliable = is_reliable(qos)
        lifespan = qos.lifespan
        self._lifespan_ns = 0 if is_unlimited(lifespan) else lifespan.nanoseconds
        self._expiry: SilenceAlarm | None = None
        if self._transient and self._lifespan_ns:
            self._expiry = SilenceAlarm(state.time_base, self._lifespan_ns, self._forget_expired)
        # Messages for late readers that were published before the session is open.
        self._early: deque[tuple[int, bytes, bytes]] = deque(maxlen=self._depth)
        self.active = self._transient
        self.bounded = keeps_all(qos)
        # A transient local KEEP_LAST publisher has none: Zenoh repeats its lost messages, if no
        # connection is lost meanwhile.
        self._history: StatefulWriter | None = None
        if self._reliable and self.recovers and (self.bounded or not self._transient):
            self._history = StatefulWriter(
                *(self.gid, state.participant, self, self._depth, state.queue_bytes),
                keep_all=self.bounded,
                now_ns=perf_ns,
                has_lost=state.connections.has_lost,
            )
        # Large messages, and small ones after them to keep the order.
        self._large = self._send_queue(state.bulk, self._depth, keep_all=False)
        # Messages for readers that do not acknowledge, sent by a thread that blocks. There is none
        # until it is needed; from then on it is used for all messages, to keep the order.
        self._blocking: SendQueue | None = None
        self._blocking_thread = SendThread("aionode-blocking", state.waker)
        self._blocking_publisher: zenoh.Publisher | None = None
        # Clear while `drain` waits for acknowledgements.
        self._drained = asyncio.Event()
        self._dropped = 0
        self._given_up = state.queue(self.lost)  # from the thread that blocks to the loop
        self._closed = False
        self._ends_ns = 0  # when a lingering publisher gives up
        self._moved: tuple[int, ...] = ()
        self._moved_ns = 0
        self._update_route()
        state.own_gids.add(self.gid)
        state.on_reader.setdefault(endpoint.name, {})[self._update] = None
        state.add(self)

    def _send_queue(self, send_thread: SendThread, limit: int, *, keep_all: bool) -> SendQueue:
        return send_thread.send_queue(
            limit, self.state.queue_bytes, keep_all=keep_all, lost=self.lost
        )

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the publisher, and send what was published before."""
        self._is_watched = False
        history = self._history
        if self._transient:
            self._publisher = self._declare_keeping(session)
            if self._expiry is not None:
                self._expiry.start()
            while self._early:
                sequence, payload, extra = self._early.popleft()
                put = self.put if history is None else partial(history.write, sequence)
                self._unless_expired(extra, partial(put, payload, extra))()
        else:
            self._publisher = declare_plain(
                session, self._key, LOOP_PRIORITY, reliable=self._reliable, waits=False
            )
            if self.recovers:  # else a bridge has announced every reader
                self._matching = self._publisher.declare_matching_listener(
                    direct(self._matching_changed.put)
                )
                # Here only: Zenoh looks through all subscribers of all topics for an answer.
                self._is_matching = bool(self._publisher.matching_status.matching)  # type: ignore[attr-defined]  # no bool, as the stub says
        self._update()

    def _declare_keeping(self, session: zenoh.Session) -> ext.AdvancedPublisher:
        return declare_keeping(
            session,
            self._key,
            self._depth,
            BLOCKING_PRIORITY if self.bounded else BULK_PRIORITY,
            reliable=self._reliable,
            waits=self.bounded,
            numbered=self.recovers,
        )

    def _forget_expired(self, periods: int) -> bool:  # noqa: ARG002  # one lifespan is enough
        """Replace the publisher by a new one: all that Zenoh keeps of it has expired."""
        if self.state.session is not None and self._publisher is not None:
            if not self.is_done():
                return True  # once more, after another lifespan
            before, self._publisher = self._publisher, self._declare_keeping(self.state.session)
            self._blocking_thread.submit(partial(withdraw, before))
        return False

    def undeclare_data(self) -> None:
        """Undeclare the publisher as soon as its messages are acknowledged or given up."""
        self.linger()
        if self not in self.state.lingering or self.state.session is None:
            self.finish()

    def linger(self) -> None:
        """Wait a while for acknowledgements before the publisher is undeclared."""
        if self.is_done() or self in self.state.lingering or self._publisher is None:
            return
        now_ns = perf_ns()
        self._ends_ns = now_ns + FLUSH_NS
        self._moved_ns = now_ns
        self._moved = ()
        self.state.lingering[self] = None
        self._watch()

    def is_done(self) -> bool:
        """Return whether all messages were sent and acknowledged."""
        return (
            (self._history is None or self._history.done)
            and not len(self._large)
            and (self._blocking is None or not len(self._blocking))
            and (self._stop is None or not self._stop.is_repeated)
        )

    def finish(self) -> None:
        """Undeclare the publisher, and count the messages that were not delivered."""
        if self._expiry is not None:
            self._expiry.stop()
        self.state.has_lingered(self)
        if self._history is not None and (missing := self._history.give_up()):
            self.lost(missing)
        self._abandon_queues()
        self._stop = None
        matching, self._matching = self._matching, None
        if matching is not None:
            matching.undeclare()
        self._withdraw()
        self._drained.set()
        self._update()
        if self._closed:
            self._forget()

    def _withdraw(self) -> None:
        """Undeclare, in the thread that may be using the publisher: Zenoh locks it meanwhile."""
        self.state.acknowledgements.remove_writer(self._key, self.gid)
        publisher, self._publisher = self._publisher, None
        blocking, self._blocking_publisher = self._blocking_publisher, None
        if self._blocking is not None:
            self._blocking = None
            self._update_route()
            if blocking is not None:
                self._blocking_thread.submit(partial(withdraw, blocking))
            elif publisher is not None:  # it is the thread's own
                self._blocking_thread.submit(partial(withdraw, publisher))
                publisher = None
        self.state.send_threads.discard(self._blocking_thread)
        self._blocking_thread.close()
        if publisher is None:
            return
        if len(self._large):
            self.state.bulk.submit(partial(withdraw, publisher))
        else:
            withdraw(publisher)

    # Readers

    def _update_with(self, status: zenoh.MatchingStatus) -> None:
        self._is_matching = status.matching
        self._update()

    def _update(self, reader: EndpointInfo | None = None, present: bool = True) -> None:
        """Update `active` and the history from the matching readers.

        Args:
            reader: The only one that may have changed; None for all of them.
            present: Whether it exists.
        """
        history, graph = self._history, self.state.graph
        self.active = self._transient
        if graph is not None and self._publisher is not None:
            self._matched.update(graph, reader, present=present)
            # The token of a reader can arrive before Zenoh has told of a match, or has a route to
            # it; what is lost until then is sent again.
            self.active = self.active or self._is_matching or bool(self._matched.participants)
            if history is not None:
                self._update_readers(history, None if reader is None else reader.gid)
        if self.active and self._encode is None:
            self._encode = cdr.encoder(self._msg_type)

    def _update_readers(self, history: StatefulWriter, gid: bytes | None) -> None:
        """Add new and returned readers to the history, and remove those that have vanished.

        All of them, or the one with this gid.
        """
        acknowledging = self._matched.acknowledging
        for vanished in list(history.readers) if gid is None else (gid,):
            if vanished not in acknowledging:
                history.remove(vanished)
        if not self._closed:
            for known in acknowledging if gid is None else acknowledging.keys() & {gid}:
                reader = history.readers.get(known)
                if reader is None or reader.away_until_ns:
                    self.state.acknowledgements.add_writer(
                        self._key, self.gid, self.receive_acknack
                    )
                    history.add(known, acknowledging[known])
        if self.bounded and history.readers:
            self.state.acknowledgements.probe(history.probe)
        if not self._is_watched and history.readers:  # one that is away may be to be given up
            self._watch()
        self._progress()
        # Subscribers without a token may match; beside readers that acknowledge, none is known.
        self.active = self.active or bool(history.readers)
        history.has_other_readers = bool(self._matched.others) or not history.readers
        self._update_route()

    # Messages

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg` to the readers of other contexts."""
        encode = self._encode
        if encode is None:
            encode = self._encode = cdr.encoder(self._msg_type)
        payload = encode(msg)
        extra = attachment.pack(sequence, source_ns, self.gid)
        history = self._history
        if self._publisher is None:
            self._keep_early(sequence, payload, extra)
        elif history is None:
            self.put(payload, extra)
        else:
            history.write(sequence, payload, extra)
            if not self._is_watched and history.entries:
                self._watch()

    def _keep_early(self, sequence: int, payload: bytes, extra: bytes) -> None:
        """Keep a message for late readers until the session is open."""
        if self._transient:
            self._early.append((sequence, payload, extra))

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:
        """Return what sends the stop of a lease."""
        return ZenohStop(self, stop, is_last)

    def _abandon_queues(self) -> None:
        """Drop what waits for a thread."""
        for send_queue in (self._large, self._blocking):
            if send_queue is not None:
                send_queue.abandon()

    def _has_unacknowledging(self) -> bool:
        """Return whether there may be readers for which nothing lost is sent again."""
        known, acknowledging = self._matched.participants, self._matched.acknowledging
        return self._history is None or not known or not known.keys() <= acknowledging.keys()

    def _watch(self) -> None:
        self._is_watched = True
        self.state.acknowledgements.watch(self.tick)

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send a message to every reader."""
        publisher = self._publisher
        if publisher is None:
            return
        if (
            len(payload) < BULK_BYTES and self._is_direct and not self._is_large_used
        ) or not self._put_in_thread(publisher, payload, extra):
            try:
                publisher.put(payload, attachment=extra)
            except zenoh.ZError as error:
                raise TransportError(f"{self._key}: {reason(error)}") from error

    def _put_in_thread(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> bool:
        """Have a thread send what may wait for Zenoh, is large, or follows such a message.

        Returns whether one does; else the loop may put it at once.
        """
        size = len(payload)
        is_crowded = self.state.control_messages.is_crowded
        self.used_bulk = self.used_bulk or size >= BULK_BYTES or is_crowded
        self._is_large_used = bool(len(self._large))
        if is_crowded or not self._is_large_used:
            self._large.limit = max(self._depth, LATE) if is_crowded else self._depth
        if (
            self._needs_thread
            or self._blocking is not None
            or (
                self._may_not_drop
                and (self.bounded or (size < BULK_BYTES and not self.state.burst.spend(size)))
            )
        ):
            self._put_blocking(publisher, payload, extra)
        elif size >= BULK_BYTES or self._is_large_used or is_crowded:
            self._is_large_used = True
            send = partial(self._send, publisher, payload, extra)
            self._large.put(self._unless_expired(extra, send), size)
        else:
            return False
        return True

    def _update_route(self) -> None:
        """Find out whether small messages may be put at once, and dropped by Zenoh if need be.

        Not if a reader may lose none of them and does not acknowledge: then a thread sends them
        when they are many, and always for KEEP_ALL. Never if Zenoh keeps them for late readers.
        """
        others = self._history is None or self._history.has_other_readers
        self._may_not_drop = others and self._reliable
        self._is_direct = not (
            self._blocking is not None
            or self._needs_thread
            or self._may_not_drop
            or self.state.control_messages.is_crowded
        )

    def note_crowd(self) -> None:
        """Have the thread for large messages send all while Zenoh may stand still."""
        self._update_route()

    def _put_blocking(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send from the thread that waits for slow readers."""
        if self._blocking is None:
            self.state.send_threads.add(self._blocking_thread)
            limit = max(self._depth, LATE) if self._transient else self._depth
            self._blocking = self._send_queue(self._blocking_thread, limit, keep_all=self.bounded)
            self._update_route()
            if not self._transient and self.state.session is not None:
                self._blocking_publisher = declare_plain(
                    self.state.session, self._key, BLOCKING_PRIORITY, reliable=True, waits=True
                )
        if self._expiry is not None:
            self._expiry.note()
        blocking = self._blocking_publisher or publisher
        send = partial(self._send_blocking, blocking, payload, extra)
        self._blocking.put(self._unless_expired(extra, send), len(payload))

    def _unless_expired(self, extra: bytes, send: Callable[[], None]) -> Callable[[], None]:
        return unless_expired(extra, self._lifespan_ns, self.state.now_ns, send)

    def _send_blocking(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send in the thread. Zenoh gives up after a while without an error, so time tells."""
        began_ns = perf_ns()
        try:
            publisher.put(payload, attachment=extra)
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", self._key, reason(error))
        waits = self.bounded or not self._transient
        if waits and perf_ns() - began_ns >= GIVEN_UP_NS:
            self._given_up.put(1)

    def _send(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send from a thread."""
        send_bulk(self.state.session or publisher, self._key, payload, extra)

    def assert_liveliness(self) -> None:
        """Tell the subscriptions of other contexts."""
        self.state.assertions.send(self._key, self.gid)

    def has_room(self) -> bool:
        """Return whether one more message can wait to be sent."""
        if not self.bounded:
            return True
        return (self._history is None or self._history.has_room()) and (
            self._blocking is None or self._blocking.has_room()
        )

    async def drain(self) -> None:
        """Wait until there is room and all messages were handed to Zenoh."""
        while self._history is not None and (self._history.unsent or not self.has_room()):
            self._drained.clear()
            self._watch()
            await self._drained.wait()
        if self._blocking is not None:
            await self._blocking.drain()
        await self._large.drain()

    def _progress(self) -> None:
        """Wake `drain` if there is room now."""
        history = self._history
        if history is None or not (history.unsent or not history.has_room()):
            self._drained.set()

    # Submessages

    def send(self, participant: str, submessage: bytes) -> None:
        """Send a submessage to the context of a reader; any thread may."""
        self.state.acknowledgements.send(self._key, Side.PUBLISHERS, participant, submessage)

    def source_ns(self, extra: bytes) -> int:
        """Return when a message was published, in nanoseconds since 1970."""
        fields = attachment.unpack_fields(extra)
        return 0 if fields is None else fields[1]

    def receive_acknack(self, submessage: Submessage) -> None:
        """Handle an ACKNACK of one of its readers."""
        if self._matched.note_heard(submessage.reader):
            self._update()
        if self._history is not None:
            self._history.acknack(submessage)
            self._progress()
            if self in self.state.lingering and self.is_done():
                self.finish()

    def mute(self, reader: ReaderProxy) -> None:
        """Leave a reader that has never answered to Zenoh, as one of a ROS node, until it does."""
        if self._matched.note_mute(reader.gid):
            text = "%s: a reader in context %s has acknowledged nothing for %.3g s, and is left out"
            logger.warning(text, self.endpoint.name, reader.participant, MUTE_TICKS * TICK_S)
        if self._history is not None:
            self._history.has_other_readers = True
            self._update_route()

    def tick(self) -> bool:
        """Send heartbeats, and give up in the end; return whether to call again."""
        self._is_watched = self._tick()
        return self._is_watched

    def _tick(self) -> bool:
        history = self._history
        again = False
        if history is not None:
            known = len(history.readers)
            again = history.tick()
            if len(history.readers) != known:
                self._update()
        if self._stop is not None:
            self._stop = self._stop.tick()
            again = again or self._stop is not None
        self._progress()
        if self in self.state.lingering:
            now_ns = perf_ns()
            moved = (
                0 if history is None else history.sent,
                0 if history is None else sum(r.acked for r in history.readers.values()),
                self._large.sent,
                0 if self._blocking is None else self._blocking.sent,
            )
            if moved != self._moved:
                self._moved, self._moved_ns = moved, now_ns
            if self.is_done() or now_ns > min(self._ends_ns, self._moved_ns + STILL_NS):
                self.finish()
                return False
            return True
        return again

    def lost(self, count: int) -> None:
        """Count dropped messages; the first of a reliable publisher are logged."""
        if self._reliable and not self._dropped:
            logger.warning(
                "%s: %d of the messages published here were dropped before every reader had them: "
                "one is too slow, hangs or has gone; more of them are only counted, in the "
                "publisher's stats.dropped. %s",
                *(self.endpoint.name, count, DRAIN if self.bounded else MORE_DEPTH),
            )
        self._dropped += count

    @property
    def dropped(self) -> int:
        """Number of messages that are known to have been dropped on the way."""
        return self._dropped

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return ``zenoh`` for subscriptions of other contexts."""
        return "zenoh" if self.state.reaches(reader.node) else None

    def close(self) -> None:
        """Undeclare the publisher for good, after it has lingered."""
        self._closed = True
        super().close()
        self._transient = False
        if self not in self.state.lingering:
            self._forget()
            self._update()

    def _forget(self) -> None:
        self.state.own_gids.discard(self.gid)
        updates = self.state.on_reader.get(self.endpoint.name, {})
        updates.pop(self._update, None)
        if not updates:
            self.state.on_reader.pop(self.endpoint.name, None)
