"""Publishers and subscriptions on Zenoh."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from typing import TYPE_CHECKING, Any

import zenoh
from zenoh import ext

from aionode.clock import perf_ns
from aionode.errors import DecodeError, TransportError
from aionode.graph import EndpointKind
from aionode.message import fields
from aionode.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from aionode.transport.base import Origin, Writer
from aionode.transport.reliability import NEVER, OVERHEAD_BYTES, WriterHistory, WriterProxy
from aionode.transport.sender import Outlet, Sender
from aionode.transport.zenoh.handlers import (
    BULK_PRIORITY,
    LOOP_PRIORITY,
    PATIENT_PRIORITY,
    direct,
    reason,
)
from aionode.transport.zenoh.link import Entity
from aionode.transport.zenoh_config import BLOCK_US
from aionode.wire import acknack, attachment, cdr
from aionode.wire.acknack import Kind
from aionode.wire.keyexpr import buffer_key, data_key
from aionode.wire.liveliness import CPU_BACKEND, endpoint_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile
    from aionode.transport.base import Reader
    from aionode.transport.reliability import Entry, ReaderProxy
    from aionode.transport.zenoh.link import Link
    from aionode.wire.acknack import Submessage

__all__ = ["ZenohReader", "ZenohWriter", "has_buffers", "origin_of"]

logger = logging.getLogger("aionode.transport.zenoh")

KEEP_ALL_DEPTH = 10_000
"""How many messages a KEEP_ALL publisher holds that are not sent yet, or are kept for late ones."""

BACKLOG = 10_000
"""How many small messages wait for the loop at least, before the oldest are dropped."""

BULK_BYTES = 60_000
"""From this size on a message is sent from a thread: it takes more than one packet of Zenoh's."""

KEEP_ALL_ARRIVING = 100_000
"""How many messages for a KEEP_ALL subscription wait for the loop, if it hangs."""

FULL_BYTES = 256 << 20
"""How much waits for room in a KEEP_ALL subscription of what cannot be held back."""

SPAN = 1_000
"""How many small messages a KEEP_LAST subscription waits for at least that were lost on the way."""

REMEMBERED_WRITERS = 1_024

FLUSH_NS = 2_000_000_000
"""How long what was published has to arrive after the publisher was destroyed."""

STILL_NS = 500_000_000
"""The same while nothing moves."""

GONE_NS = 15_000_000_000
"""After so long a publisher that is not there will not fill any gap."""

GIVEN_UP_NS = BLOCK_US * 900
"""What took so long to send was given up by Zenoh."""

BLOCK = zenoh.CongestionControl.BLOCK
DROP = zenoh.CongestionControl.DROP

NOBODY = bytes(16)


def has_buffers(msg_type: type[Any]) -> bool:
    """Whether messages hold sequences of numbers without a bound, at any depth.

    Such messages may be large, and from ROS 2 Lyrical on their publishers use a second key.
    """
    for field in fields(msg_type):
        kind = field.type
        if kind.kind == "message":
            if kind.nested is not None and has_buffers(kind.nested):
                return True
        elif kind.container == "unbounded" and kind.kind not in ("string", "wstring"):
            return True
    return False


def depth_of(qos: QoSProfile) -> int:
    """Return how many messages an endpoint keeps."""
    resolved = qos.resolved()
    if resolved.history is HistoryPolicy.KEEP_ALL:
        return max(resolved.depth, KEEP_ALL_DEPTH)
    return resolved.depth


def is_reliable(qos: QoSProfile) -> bool:
    """Whether lost messages are sent again."""
    return qos.resolved().reliability is ReliabilityPolicy.RELIABLE


def is_transient(qos: QoSProfile) -> bool:
    """Whether late subscriptions get what was published before."""
    return qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


# Sending


class ZenohWriter(Entity, Writer):
    """A publisher as the subscriptions of others see it.

    A message leaves in one of three ways, each with a queue of its own in Zenoh: from the loop,
    which never waits; from the thread for large ones; or, for readers that do not acknowledge and
    must not lose it, from a thread of this publisher that waits for them.
    """

    def __init__(self, link: Link, endpoint: EndpointInfo, msg_type: type[Any]) -> None:
        super().__init__(link, endpoint_token(link.domain_id, endpoint))
        self.endpoint = endpoint
        qos = endpoint.qos
        self._key = data_key(link.domain_id, endpoint.name, endpoint.type_name, endpoint.type_hash)
        self._msg_type = msg_type
        # Making a codec takes a while: not before it is needed, and not within a callback.
        self._encode: Callable[[Any], bytes] | None = None
        self._publisher: zenoh.Publisher | ext.AdvancedPublisher | None = None
        self._matching: zenoh.MatchingListener[None] | None = None
        self._matching_changed = link.lane(self._update_with, limit=1)
        self._transient = is_transient(qos)
        self._depth = depth_of(qos)
        self._reliable = is_reliable(qos)
        # What a publisher keeps for late readers before the session is open.
        self._early: deque[tuple[bytes, bytes]] = deque(maxlen=self._depth)
        self.active = self._transient
        self.bounded = qos.history is HistoryPolicy.KEEP_ALL and self._reliable
        # Who keeps messages for late readers leaves it to Zenoh to send them again.
        self._history: WriterHistory | None = None
        if self._reliable and not self._transient:
            self._history = WriterHistory(
                self._depth, keep_all=self.bounded, side=self, now_ns=perf_ns
            )
            link.acknowledgements.writers[self.gid] = self
        # Large messages, and small ones behind them so that the order stays.
        self._large = self._outlet(link.bulk, keep_all=False)
        self._bulk_only = self._transient and not self.bounded and has_buffers(msg_type)
        # What waits for readers that do not acknowledge; once begun it stays so, for the order.
        self._patient: Outlet | None = None
        self._patient_sender = Sender("aionode-patient", link.wakeup)
        self._patient_publisher: zenoh.Publisher | None = None
        self._drained: list[asyncio.Future[None]] = []
        self._dropped = 0
        self._given_up = link.lane(self.lost)
        self._closed = False
        self._ends_ns = 0  # when a publisher that lingers gives up
        self._moved: tuple[int, ...] = ()
        self._moved_ns = 0
        link.own_gids.add(self.gid)
        link.on_reader.setdefault(endpoint.name, []).append(self._update)
        link.add(self)

    def _outlet(self, sender: Sender, *, keep_all: bool) -> Outlet:
        lost = self.lost if self._reliable else self._count_lost
        return sender.outlet(self._depth, keep_all=keep_all, lost=lost)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the publisher, and send what was kept."""
        reliable = self._reliable
        reliability = zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT
        if self._transient:
            priority = BULK_PRIORITY if self._bulk_only else LOOP_PRIORITY
            self._publisher = ext.declare_advanced_publisher(
                session,
                self._key,
                congestion_control=BLOCK if self.bounded else DROP,
                priority=PATIENT_PRIORITY if self.bounded else priority,
                reliability=reliability,
                allowed_destination=zenoh.Locality.REMOTE,
                cache=ext.CacheConfig(max_samples=self._depth),
                publisher_detection=True,
                # Samples are numbered, so that readers ask again for what is missing between two.
                # No heartbeat, which would tell of a missing last one too: undeclaring waits for
                # its task with the GIL held, and for 10 s if that task's thread needs the GIL for
                # a callback just then (zenoh-python 1.10).
                sample_miss_detection=ext.MissDetectionConfig(
                    heartbeat=None, sporadic_heartbeat=None
                )
                if reliable
                else None,
            )
            while self._early:
                self._put(*self._early.popleft())
        else:
            self._publisher = session.declare_publisher(
                self._key,
                congestion_control=DROP,
                priority=LOOP_PRIORITY,
                reliability=reliability,
                allowed_destination=zenoh.Locality.REMOTE,
            )
            self._matching = self._publisher.declare_matching_listener(
                direct(self._matching_changed.put)
            )
        self._update()

    def undeclare_data(self) -> None:
        """Withdraw the publisher, as soon as what was published is sent or given up."""
        self.linger()
        if self not in self.link.lingering or self.link.session is None:
            self.finish()

    def linger(self) -> None:
        """Give what was published some time to arrive."""
        if self.is_done() or self in self.link.lingering or self._publisher is None:
            return
        now_ns = perf_ns()
        self._ends_ns = now_ns + FLUSH_NS
        self._moved_ns = now_ns
        self._moved = ()
        self.link.lingering[self] = None
        self.link.acknowledgements.watch(self)

    def is_done(self) -> bool:
        """Whether nothing is left to send, or to be acknowledged."""
        return (
            (self._history is None or self._history.done)
            and not len(self._large)
            and (self._patient is None or not len(self._patient))
        )

    def finish(self) -> None:
        """Withdraw the publisher, and count what was not sent."""
        self.link.lingering.pop(self, None)
        publisher, self._publisher = self._publisher, None
        matching, self._matching = self._matching, None
        if self._history is not None:
            missing = self._history.give_up()
            if missing:
                self.lost(missing)
        self._large.abandon()
        if self._patient is not None:
            self._patient.abandon()
        patient, self._patient_publisher = self._patient_publisher, None
        if matching is not None:
            matching.undeclare()
        if patient is not None:
            self._patient_sender.submit(lambda: withdraw(patient))
        self.link.senders.discard(self._patient_sender)
        self._patient_sender.close()
        self._patient = None
        if publisher is not None:
            if len(self._large):
                # The thread may be inside `put`, and Zenoh's object is used by one at a time.
                self.link.bulk.submit(lambda: withdraw(publisher))
            else:
                withdraw(publisher)
        self._wake()
        self._update()
        if self._closed:
            self._forget()

    # Who listens

    def _update_with(self, _: zenoh.MatchingStatus) -> None:
        self._update()

    def _update(self) -> None:
        """Find out whether anybody listens, and who of them acknowledges."""
        if not self._transient:
            publisher = self._publisher
            self.active = isinstance(publisher, zenoh.Publisher) and bool(
                publisher.matching_status.matching  # type: ignore[attr-defined]  # no bool, as the stub says
            )
        if self.active and self._encode is None:
            self._encode = cdr.encoder(self._msg_type)
        history = self._history
        graph = self.link.graph
        if history is None or graph is None or self._publisher is None:
            return
        able = self.link.acknowledgements.participants
        acknowledging: dict[bytes, str] = {}
        others = False
        for reader in graph.endpoints(EndpointKind.SUBSCRIPTION, name=self.endpoint.name):
            participant = reader.node.participant
            if participant == self.link.participant or not self.endpoint.matches(reader):
                continue
            if participant not in able:
                others = True
            elif is_reliable(reader.qos):
                if is_transient(reader.qos):
                    others = True
                else:
                    acknowledging[reader.gid] = participant
        # Somebody without a token may listen too; of one beside others nothing is known.
        history.others = others or not acknowledging
        for gid, known in list(history.readers.items()):
            if gid not in acknowledging and not known.away_ns:
                history.remove(gid)
        if not self._closed:
            for gid, participant in acknowledging.items():
                known_reader = history.readers.get(gid)
                if known_reader is None or known_reader.away_ns:
                    history.add(gid, participant)
        self._progress()

    # Messages

    def write(self, msg: Any, origin: Origin) -> None:
        """Send `msg`."""
        encode = self._encode
        if encode is None:
            encode = self._encode = cdr.encoder(self._msg_type)
        payload = encode(msg)
        extra = attachment.pack(origin.sequence, origin.source_ns, self.gid)
        history = self._history
        if self._publisher is None:
            if self._transient:
                self._early.append((payload, extra))
        elif history is None:
            self._put(payload, extra)
        else:
            history.write(origin.sequence, payload, extra)
            if history.entries:
                self.link.acknowledgements.watch(self)

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send a message to every reader."""
        self._put(payload, extra)

    def _put(self, payload: bytes, extra: bytes) -> None:
        publisher = self._publisher
        if publisher is None:
            return
        history = self._history
        others = history is None or history.others
        size = len(payload)
        if (
            self._patient is not None
            or (others and self.bounded)
            or (
                others
                and self._reliable
                and not self._transient
                and size < BULK_BYTES
                and not self.link.burst.spend(size)
            )
        ):
            self._put_patiently(publisher, payload, extra)
        elif size >= BULK_BYTES or self._bulk_only or len(self._large):
            self._large.put(lambda: self._send(publisher, payload, extra))
        else:
            try:
                publisher.put(payload, attachment=extra)
            except zenoh.ZError as error:
                raise TransportError(f"{self._key}: {reason(error)}") from error

    def _put_patiently(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send from the thread that waits for slow readers."""
        if self._patient is None:
            self.link.senders.add(self._patient_sender)
            self._patient = self._outlet(self._patient_sender, keep_all=self.bounded)
            if not self._transient and self.link.session is not None:
                self._patient_publisher = self.link.session.declare_publisher(
                    self._key,
                    congestion_control=BLOCK,
                    priority=PATIENT_PRIORITY,
                    reliability=zenoh.Reliability.RELIABLE,
                    allowed_destination=zenoh.Locality.REMOTE,
                )
        patient = self._patient_publisher or publisher
        self._patient.put(lambda: self._send_patiently(patient, payload, extra))

    def _send_patiently(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send in the thread; Zenoh gives up after a while, and says so to nobody."""
        began_ns = perf_ns()
        try:
            publisher.put(payload, attachment=extra)
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", self._key, reason(error))
        if perf_ns() - began_ns >= GIVEN_UP_NS:
            self._given_up.put(1)

    def _send(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send from a thread, where nobody can be told that the session was closed meanwhile."""
        session = self.link.session
        try:
            if session is None or self._transient:
                publisher.put(payload, attachment=extra)
            else:
                waits = self._reliable and self.link.begins_to_share()
                session.put(
                    self._key,
                    payload,
                    attachment=extra,
                    congestion_control=BLOCK if waits else DROP,
                    priority=BULK_PRIORITY,
                    allowed_destination=zenoh.Locality.REMOTE,
                )
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", self._key, reason(error))

    def has_room(self) -> bool:
        """Whether one more message can wait to be sent."""
        if not self.bounded:
            return True
        return (self._history is None or self._history.has_room()) and (
            self._patient is None or self._patient.has_room()
        )

    async def drain(self) -> None:
        """Wait until there is room, and everything was handed to Zenoh."""
        while self._history is not None and (self._history.unsent or not self.has_room()):
            waiter = asyncio.get_running_loop().create_future()
            self._drained.append(waiter)
            self.link.acknowledgements.watch(self)
            await waiter
        if self._patient is not None:
            await self._patient.drain()
        await self._large.drain()

    def _progress(self) -> None:
        """Let those go on who wait for it."""
        history = self._history
        if self._drained and (history is None or not (history.unsent or not history.has_room())):
            self._wake()

    def _wake(self) -> None:
        drained, self._drained = self._drained, []
        for waiter in drained:
            if not waiter.done():
                waiter.set_result(None)

    # What readers say, and are told

    def answer(self, said: Submessage) -> None:
        """Take an ACKNACK."""
        if self._history is not None:
            self._history.acknack(said.reader, said.first, said.ranges())
            self._progress()

    def tick(self) -> bool:
        """Ask readers, and give up in the end; return whether to come again."""
        history = self._history
        again = history is not None and history.tick()
        self._progress()
        if self in self.link.lingering:
            now_ns = perf_ns()
            moved = (
                0 if history is None else history.sent,
                0 if history is None else sum(r.acked for r in history.readers.values()),
                self._large.sent,
                0 if self._patient is None else self._patient.sent,
            )
            if moved != self._moved:
                self._moved, self._moved_ns = moved, now_ns
            if self.is_done() or now_ns > min(self._ends_ns, self._moved_ns + STILL_NS):
                self.finish()
                return False
            return True
        return again

    def heartbeat(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Tell a reader how far the messages go."""
        self._say(Kind.HEARTBEAT, reader, first, last, self.link.participant.encode())

    def gap(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Tell a reader that some will not come."""
        self._say(Kind.GAP, reader, first, last)

    def resend(self, reader: ReaderProxy, entry: Entry) -> None:
        """Send a message again to one reader."""
        fields = attachment.unpack_fields(entry.extra)
        source_ns = 0 if fields is None else fields[1]
        self._say(Kind.DATA, reader, entry.sequence, source_ns, entry.payload)

    def _say(
        self, kind: Kind, reader: ReaderProxy, first: int, last: int, rest: bytes = b""
    ) -> None:
        data = acknack.pack(kind, self.gid, reader.gid, first, last, rest)
        self.link.acknowledgements.say(reader.participant, data)

    def lost(self, count: int) -> None:
        """Count dropped messages, and say so the first time."""
        if not self._dropped:
            logger.warning(
                "%s: %d of the messages published here were dropped before every reader had them: "
                "one is too slow, hangs or has gone; more of them are only counted, in the "
                "publisher's stats.dropped. A greater depth keeps more of them, KEEP_ALL and "
                "`await drain()` all",
                self.endpoint.name,
                count,
            )
        self._dropped += count

    def _count_lost(self, count: int) -> None:
        self._dropped += count

    @property
    def dropped(self) -> int:
        """How many messages were dropped on their way, as far as that can be known."""
        return self._dropped

    def way_of(self, reader: EndpointInfo) -> str | None:
        """Return ``zenoh`` for the subscriptions of others."""
        return "zenoh" if reader.node.participant != self.link.participant else None

    def close(self) -> None:
        """Withdraw the publisher for good; what was published has some time to arrive."""
        self._closed = True
        super().close()
        self._transient = False
        if self not in self.link.lingering:
            self._forget()
            self._update()

    def _forget(self) -> None:
        self.link.own_gids.discard(self.gid)
        self.link.acknowledgements.writers.pop(self.gid, None)
        updates = self.link.on_reader.get(self.endpoint.name, [])
        if self._update in updates:
            updates.remove(self._update)
            if not updates:
                del self.link.on_reader[self.endpoint.name]


def withdraw(publisher: zenoh.Publisher | ext.AdvancedPublisher) -> None:
    """Undeclare a publisher, which an end of its session may have done already."""
    try:
        publisher.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
    except zenoh.ZError as error:
        logger.debug("%s: not undeclared: %s", publisher.key_expr, error)


# Receiving


class ZenohReader(Entity):
    """A subscription as the publishers of others see it."""

    def __init__(
        self, link: Link, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> None:
        self._buffers = has_buffers(msg_type)
        transient = is_transient(endpoint.qos)
        self._second_key = self._buffers and not transient
        backends = CPU_BACKEND if self._second_key else ""
        # Without a hash it takes every definition of the type, which ROS has no token for.
        visible = bool(endpoint.type_hash)
        super().__init__(
            link, endpoint_token(link.domain_id, endpoint, backends) if visible else ""
        )
        self.endpoint = endpoint
        self._key = data_key(link.domain_id, endpoint.name, endpoint.type_name, endpoint.type_hash)
        self._transient = transient
        self._reader = reader
        self._deliver = reader.deliver
        self._wakeup = link.wakeup
        self._raw = reader.raw
        self._msg_type = msg_type
        self._decode: Callable[[bytes], Any] | None = None
        depth = depth_of(endpoint.qos)
        reliable = is_reliable(endpoint.qos)
        self._keep_all = endpoint.qos.history is HistoryPolicy.KEEP_ALL and reliable
        # A few hundred images waiting for a busy loop would take all memory; what is small may
        # wait for its turn in the subscription's own queue, where it is counted if dropped.
        limit = depth if self._buffers else max(depth, BACKLOG)
        # Who acknowledges sends no more than a window ahead, and sends again what is dropped here.
        self._lane = link.lane(self._take, KEEP_ALL_ARRIVING if self._keep_all else limit)
        self._span = NEVER if self._keep_all else depth if self._buffers else max(depth, SPAN)
        self._proxies: dict[bytes, WriterProxy] = {}
        # The last numbers of those who do not acknowledge, or have not begun to.
        self._last: dict[bytes, int] = {}
        # What a KEEP_ALL subscription has no room for yet.
        self._full: deque[tuple[bytes, Origin, WriterProxy | None]] = deque()
        self._full_bytes = 0
        self._waits_for_room = False
        self._refused = 0
        self._subscribers: list[zenoh.Subscriber[None] | ext.AdvancedSubscriber[None]] = []
        if reliable and not transient and visible:
            link.acknowledgements.readers[self.gid] = self
        link.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the subscriber; a transient local one is given the history."""
        put = self._lane.put
        if self._transient:
            reliable = is_reliable(self.endpoint.qos)
            subscriber: Any = ext.declare_advanced_subscriber(
                session,
                self._key,
                put,
                allowed_origin=zenoh.Locality.REMOTE,
                history=ext.HistoryConfig(
                    detect_late_publishers=True, max_samples=depth_of(self.endpoint.qos)
                ),
                recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
                if reliable
                else None,
                subscriber_detection=True,
            )
            self._subscribers.append(subscriber)
            return
        for key in (self._key, buffer_key(self._key)) if self._second_key else (self._key,):
            self._subscribers.append(
                session.declare_subscriber(key, put, allowed_origin=zenoh.Locality.REMOTE)
            )

    def undeclare_data(self) -> None:
        """Withdraw the subscriber."""
        subscribers, self._subscribers = self._subscribers, []
        for subscriber in subscribers:
            subscriber.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
        self._lane.clear()
        self._full.clear()
        self._proxies.clear()

    def close(self) -> None:
        """Withdraw the subscription for good."""
        self.link.acknowledgements.readers.pop(self.gid, None)
        super().close()

    def _take(self, sample: zenoh.Sample) -> None:
        extra = sample.attachment
        origin = origin_of(extra)
        if origin is None:
            # ROS drops it; here the message counts, and who sent it stays unknown.
            if extra is not None:
                self.link.note_garbage(self._key, "an attachment")
            origin = Origin(NOBODY, 0, 0, True)
        elif origin.gid in self.link.own_gids:
            return  # a late subscription asks the publishers of its own context for history too
        payload = sample.payload.to_bytes()
        gid = origin.gid
        proxy = self._proxies.get(gid)
        if proxy is not None:
            self._take_in_order(proxy, payload, origin)
            return
        self._last[gid] = origin.sequence
        if len(self._last) > REMEMBERED_WRITERS:
            del self._last[next(iter(self._last))]
        if self._keep_all:
            self._accept_or_wait(payload, origin, None)
        else:
            self._hand_over(payload, origin)

    def _take_in_order(self, proxy: WriterProxy, payload: bytes, origin: Origin) -> None:
        proxy.take(origin.sequence, (payload, origin), len(payload) + OVERHEAD_BYTES)
        if proxy.next <= proxy.last:
            self.link.acknowledgements.watch(self)

    def accept(self, item: tuple[bytes, Origin], proxy: WriterProxy) -> bool:
        """Take the next message of a writer; return whether it is used already."""
        if self._keep_all:
            return self._accept_or_wait(*item, proxy)
        self._hand_over(*item)
        return True

    def _accept_or_wait(self, payload: bytes, origin: Origin, proxy: WriterProxy | None) -> bool:
        """Give a message to a KEEP_ALL subscription as soon as it has room."""
        if not self._full and self._reader.has_room():
            self._hand_over(payload, origin)
            return True
        if proxy is None and self._full_bytes >= FULL_BYTES:
            self._refuse()  # who sent it cannot be held back
            return True
        self._full.append((payload, origin, proxy))
        self._full_bytes += len(payload) + OVERHEAD_BYTES
        self._wait_for_room()
        return False

    def _refuse(self) -> None:
        if not self._refused:
            logger.warning(
                "%s: messages are lost although the subscription keeps all: %d MB wait already, "
                "and their publisher cannot be held back",
                self.endpoint.name,
                FULL_BYTES >> 20,
            )
        self._refused += 1

    def _wait_for_room(self) -> None:
        if not self._waits_for_room:
            self._waits_for_room = True
            self._reader.when_room(self._use_room)

    def _use_room(self) -> None:
        self._waits_for_room = False
        full = self._full
        while full and self._reader.has_room():
            payload, origin, proxy = full.popleft()
            self._full_bytes -= len(payload) + OVERHEAD_BYTES
            self._hand_over(payload, origin)
            if proxy is not None:
                proxy.used(len(payload) + OVERHEAD_BYTES)
        if full:
            self._wait_for_room()

    def _hand_over(self, payload: bytes, origin: Origin) -> None:
        if self._raw:
            self._deliver(payload, origin, self._wakeup.until_ns)
            return
        decode = self._decode
        if decode is None:
            decode = self._decode = cdr.decoder(self._msg_type)
        try:
            msg = decode(payload)
        except DecodeError as error:
            self.link.note_garbage(self._key, str(error))
            self._reader.reject(error)
        else:
            self._deliver(msg, origin, self._wakeup.until_ns)

    # What writers say, and are told

    def told(self, said: Submessage) -> None:
        """Take what a writer says."""
        proxy = self._proxies.get(said.writer)
        if said.kind is Kind.HEARTBEAT:
            if proxy is None:
                participant = said.rest.decode(errors="replace")
                if not participant.isalnum():  # it becomes part of a key
                    self.link.note_garbage(self._key, "an acknowledgement")
                    return
                first = max(said.first, self._last.pop(said.writer, 0) + 1)
                proxy = WriterProxy(said.writer, participant, first, self, perf_ns, self._span)
                self._forget_writers()
                self._proxies[said.writer] = proxy
            # While some of its messages wait for their turn, nobody can tell what is missing.
            proxy.heartbeat(said.first, said.last, ask=not len(self._lane))
        elif proxy is not None:
            if said.kind is Kind.GAP:
                proxy.gap(said.first, said.last)
            else:
                origin = Origin(said.writer, said.first, said.last, True)
                self._take_in_order(proxy, said.rest, origin)
                return
        if proxy is not None and proxy.next <= proxy.last:
            self.link.acknowledgements.watch(self)

    def _forget_writers(self) -> None:
        """Forget those that have been silent for longest, if there are many."""
        if len(self._proxies) >= REMEMBERED_WRITERS:
            del self._proxies[min(self._proxies, key=lambda gid: self._proxies[gid].heard_ns)]

    def tick(self) -> bool:
        """Ask again for what is missing; return whether to come again."""
        graph = self.link.graph
        again = False
        for proxy in list(self._proxies.values()):
            if proxy.next > proxy.last:
                continue
            if graph is not None and perf_ns() - proxy.heard_ns >= GONE_NS:
                there = {
                    one.gid
                    for one in graph.endpoints(EndpointKind.PUBLISHER, name=self.endpoint.name)
                }
                if proxy.gid not in there:
                    proxy.give_up()
                    continue
            again = True
            if not len(self._lane):
                proxy.remind()
        return again

    def acknack(self, proxy: WriterProxy, first: int, ranges: list[tuple[int, int]]) -> None:
        """Tell a writer what is here and what is not."""
        data = acknack.pack(
            Kind.ACKNACK, proxy.gid, self.gid, first, 0, acknack.pack_ranges(ranges)
        )
        self.link.acknowledgements.say(proxy.participant, data)


def origin_of(extra: zenoh.ZBytes | None) -> Origin | None:
    """Return what an attachment says, or None when there is none in a known form."""
    if extra is None:
        return None
    fields = attachment.unpack_fields(extra.to_bytes())
    return None if fields is None else Origin(fields[2], fields[0], fields[1], True)
