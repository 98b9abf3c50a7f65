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
from aionode.engine.transport.zenoh._defects import overtaken_history
from aionode.engine.transport.zenoh._session_state import Declaration
from aionode.engine.transport.zenoh.connections.handlers import (
    BLOCKING_PRIORITY,
    BULK_PRIORITY,
    LOOP_PRIORITY,
    direct,
)
from aionode.engine.transport.zenoh.delivery.acknowledgements import TICK_S
from aionode.engine.transport.zenoh.delivery.delivery import (
    FLUSH_NS,
    STILL_NS,
    is_reliable,
    is_transient,
)
from aionode.engine.transport.zenoh.delivery.kept_history import declare_keeping, declare_plain
from aionode.engine.transport.zenoh.discovery.matched_readers import MatchedReaders
from aionode.engine.transport.zenoh.endpoints.sender import ZenohSender
from aionode.engine.transport.zenoh.endpoints.stop import ZenohStop
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import Side
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

MORE_DEPTH = "A greater depth keeps more of them; KEEP_ALL with `await drain()` keeps all"
DRAIN = "`await drain()` before exiting waits for readers that still accept them"


class ZenohWriter(Declaration, Writer):
    """A publisher for subscriptions of other contexts.

    Its `sender` decides whether the event loop or a thread sends a message.

    Attributes:
        sender: Passes the messages to Zenoh.
        history: Messages that acknowledging readers lack. None for a transient local KEEP_LAST
            publisher: Zenoh resends its lost messages, unless a connection is lost meanwhile.
    """

    recovers: ClassVar[bool] = True  # whether its readers ask again for what they miss
    _stop: ZenohStop | None = None  # of a lease, while it is being repeated

    def __init__(self, state: SessionState, endpoint: EndpointInfo, msg_type: type[Any]) -> None:
        names = state.names_of(endpoint)
        super().__init__(state, names.token, names.gid)
        self._key = names.key
        self.endpoint = endpoint
        qos = endpoint.qos
        self._msg_type = msg_type
        # None until needed, as creating it takes a while; `_update` does that, so that no callback
        # has to.
        self._encode: Callable[[Any], bytes] | None = None
        self._matching: zenoh.MatchingListener[None] | None = None
        # Whether Zenoh has subscribers, including those without a token; set by its listener.
        self._is_matching = False
        self._matching_changed = state.queue(self._update_with, limit=1)
        self._matched = MatchedReaders(endpoint, state)
        self._is_watched = False  # whether `tick` is being called
        self._transient = is_transient(qos)
        self.needs_graph = overtaken_history.needs_peers(is_transient=self._transient)
        self._depth = depth_of(qos)
        self._reliable = is_reliable(qos)
        self.sender = ZenohSender(state, self._key, qos, self.lost)
        self.put = self.sender.put
        if self._transient and not is_unlimited(qos.lifespan):
            self.sender.expiry = SilenceAlarm(
                state.time_base, qos.lifespan.nanoseconds, self._forget_expired
            )
        # Messages for late readers that were published before the session was open.
        self._early: deque[tuple[int, bytes, bytes]] = deque(maxlen=self._depth)
        self.active = self._transient
        self.bounded = keeps_all(qos)
        self.history: StatefulWriter | None = None
        if self._reliable and self.recovers and (self.bounded or not self._transient):
            self.history = StatefulWriter(
                *(self.gid, state.participant, self, self._depth, state.queue_bytes),
                keep_all=self.bounded,
                now_ns=perf_ns,
                has_lost=state.connections.has_lost,
            )
        # Clear while `drain` waits for acknowledgements.
        self._drained = asyncio.Event()
        self._dropped = 0
        self._closed = False
        self._ends_ns = 0  # when a lingering publisher gives up
        self._moved: tuple[int, ...] = ()
        self._moved_ns = 0
        self._note_others()
        state.own_gids.add(self.gid)
        state.on_reader.setdefault(endpoint.name, {})[self._update] = None
        state.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the publisher, and send what was published before."""
        self._is_watched = False
        history = self.history
        if self._transient:
            self.sender.publisher = self._declare_keeping(session)
            if self.sender.expiry is not None:
                self.sender.expiry.start()
            while self._early:
                sequence, payload, extra = self._early.popleft()
                put = self.put if history is None else partial(history.write, sequence)
                self.sender.unless_expired(extra, partial(put, payload, extra))()
        else:
            self.sender.publisher = declare_plain(
                session, self._key, LOOP_PRIORITY, reliable=self._reliable, waits=False
            )
            if self.recovers:  # otherwise a bridge has announced every reader
                self._matching = self.sender.publisher.declare_matching_listener(
                    direct(self._matching_changed.put)
                )
                # Only here: Zenoh searches all subscribers of all topics for an answer.
                self._is_matching = bool(self.sender.publisher.matching_status.matching)  # type: ignore[attr-defined]  # no bool, as the stub says
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
        """Replace the publisher by a new one, as everything that Zenoh keeps for it has expired."""
        if self.state.session is not None and self.sender.publisher is not None:
            if not self.is_done():
                return True  # again, after another lifespan
            self.sender.replace(self._declare_keeping(self.state.session))
        return False

    def undeclare_data(self) -> None:
        """Undeclare the publisher as soon as its messages are acknowledged or given up."""
        self.linger()
        if self not in self.state.lingering or self.state.session is None:
            self.finish()

    def linger(self) -> None:
        """Wait a while for acknowledgements before the publisher is undeclared."""
        if self.is_done() or self in self.state.lingering or self.sender.publisher is None:
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
            (self.history is None or self.history.done)
            and self.sender.is_done()
            and (self._stop is None or not self._stop.is_repeated)
        )

    def finish(self) -> None:
        """Undeclare the publisher, and count the messages that were not delivered."""
        if self.sender.expiry is not None:
            self.sender.expiry.stop()
        self.state.has_lingered(self)
        if self.history is not None and (missing := self.history.give_up()):
            self.lost(missing)
        self.sender.abandon()
        self._stop = None
        matching, self._matching = self._matching, None
        if matching is not None:
            matching.undeclare()
        self.state.acknowledgements.remove_writer(self._key, self.gid)
        self.sender.withdraw()
        self._drained.set()
        self._update()
        if self._closed:
            self._forget()

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
        history, graph = self.history, self.state.graph
        self.active = self._transient
        if graph is not None and self.sender.publisher is not None:
            self._matched.update(graph, reader, present=present)
            # The token of a reader can arrive before Zenoh has reported a match, or has a route to
            # it; what is lost until then is resent.
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
        if not self._is_watched and history.readers:  # an absent one may have to be given up
            self._watch()
        self._progress()
        # Subscribers without a token may match; besides acknowledging readers, none is known.
        self.active = self.active or bool(history.readers)
        history.has_other_readers = bool(self._matched.others) or not history.readers
        self._note_others()

    # Messages

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg` to the readers of other contexts."""
        encode = self._encode
        if encode is None:
            encode = self._encode = cdr.encoder(self._msg_type)
        payload = encode(msg)
        extra = attachment.pack(sequence, source_ns, self.gid)
        history = self.history
        if self.sender.publisher is None:
            self.keep_early(sequence, payload, extra)
        elif history is None:
            self.put(payload, extra)
        else:
            history.write(sequence, payload, extra)
            if not self._is_watched and history.entries:
                self._watch()

    def keep_early(self, sequence: int, payload: bytes, extra: bytes) -> None:
        """Keep a message for late readers until the session is open."""
        if self._transient:
            self._early.append((sequence, payload, extra))

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:
        """Return an object that sends the stop of a lease."""
        return ZenohStop(self, stop, is_last)

    def _has_unacknowledging(self) -> bool:
        """Return whether there may be readers for which nothing lost is resent."""
        known, acknowledging = self._matched.participants, self._matched.acknowledging
        return self.history is None or not known or not known.keys() <= acknowledging.keys()

    def watch_stop(self, stop: ZenohStop) -> None:
        """Repeat the stop of a lease for readers that do not acknowledge, if there may be any."""
        if self._has_unacknowledging():
            self._stop = stop
        self._watch()

    def _watch(self) -> None:
        self._is_watched = True
        self.state.acknowledgements.watch(self.tick)

    def _note_others(self) -> None:
        history = self.history
        self.sender.note_others(present=history is None or history.has_other_readers)

    def note_crowd(self) -> None:
        """Send everything from the thread for large messages while Zenoh may block."""
        self.sender.update()

    def assert_liveliness(self) -> None:
        """Tell the subscriptions of other contexts."""
        self.state.assertions.send(self._key, self.gid)

    def has_room(self) -> bool:
        """Return whether another message can wait to be sent."""
        if not self.bounded:
            return True
        return (self.history is None or self.history.has_room()) and self.sender.has_room()

    async def drain(self) -> None:
        """Wait until there is room and all messages were passed to Zenoh."""
        while self._has_unsent():
            self._drained.clear()
            self._watch()
            await self._drained.wait()
        await self.sender.drain()

    def is_drained(self) -> bool:
        """Return whether `drain` would not have to wait."""
        return not self._has_unsent() and self.sender.is_done()

    def _has_unsent(self) -> bool:
        """Return whether messages wait for reliable readers."""
        return self.history is not None and bool(self.history.unsent or not self.has_room())

    def _progress(self) -> None:
        """Wake `drain` if there is room now."""
        history = self.history
        if history is None or not (history.unsent or not history.has_room()):
            self._drained.set()

    # Submessages

    def send(self, participant: str, submessage: bytes) -> None:
        """Send a submessage to the context of a reader, from any thread."""
        self.state.acknowledgements.send(self._key, Side.PUBLISHERS, participant, submessage)

    def source_ns(self, extra: bytes) -> int:
        """Return when a message was published, in nanoseconds since 1970."""
        fields = attachment.unpack_fields(extra)
        return 0 if fields is None else fields[1]

    def receive_acknack(self, submessage: Submessage) -> None:
        """Handle an ACKNACK of one of its readers."""
        if self._matched.note_heard(submessage.reader):
            self._update()
        if self.history is not None:
            self.history.acknack(submessage)
            self._progress()
            if self in self.state.lingering and self.is_done():
                self.finish()

    def mute(self, reader: ReaderProxy) -> None:
        """Leave a reader that has never answered to Zenoh, like a ROS node's, until it does."""
        if self._matched.note_mute(reader.gid):
            text = "%s: a reader in context %s has acknowledged nothing for %.3g s, and is ignored"
            logger.warning(text, self.endpoint.name, reader.participant, MUTE_TICKS * TICK_S)
        if self.history is not None:
            self.history.has_other_readers = True
            self._note_others()

    def tick(self) -> bool:
        """Send heartbeats, and eventually give up; return whether to call again."""
        self._is_watched = self._tick()
        return self._is_watched

    def _tick(self) -> bool:
        history = self.history
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
                *self.sender.sent,
            )
            if moved != self._moved:
                self._moved, self._moved_ns = moved, now_ns
            if self.is_done() or now_ns > min(self._ends_ns, self._moved_ns + STILL_NS):
                self.finish()
                return False
            return True
        return again

    def lost(self, count: int) -> None:
        """Count dropped messages, and log the first ones of a reliable publisher."""
        if self._reliable and not self._dropped:
            logger.warning(
                "%s: %d of the messages published here were dropped before every reader had them: "
                "a reader is too slow, frozen or gone; further ones are only counted, in the "
                "publisher's stats.dropped. %s",
                *(self.endpoint.name, count, DRAIN if self.bounded else MORE_DEPTH),
            )
        self._dropped += count

    @property
    def dropped(self) -> int:
        """Number of messages known to have been dropped on the way."""
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
