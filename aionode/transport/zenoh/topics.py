"""Publishers and subscriptions on Zenoh."""

from __future__ import annotations

import logging
from collections import deque
from typing import TYPE_CHECKING, Any

import zenoh
from zenoh import ext

from aionode.errors import DecodeError, TransportError
from aionode.message import fields
from aionode.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from aionode.transport.base import Origin, Writer
from aionode.transport.sender import Sender
from aionode.transport.wakeup import Lane, PatientLane
from aionode.transport.zenoh.handlers import direct, reason
from aionode.transport.zenoh.link import Entity
from aionode.wire import attachment, cdr
from aionode.wire.keyexpr import buffer_key, data_key
from aionode.wire.liveliness import CPU_BACKEND, endpoint_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile
    from aionode.transport.base import Reader
    from aionode.transport.zenoh.link import Link

__all__ = ["ZenohReader", "ZenohWriter", "has_buffers", "origin_of"]

logger = logging.getLogger("aionode.transport.zenoh")

KEEP_ALL_DEPTH = 10_000
"""How many messages a KEEP_ALL publisher holds that are not sent yet, or are kept for late ones."""

BACKLOG = 10_000
"""How many small messages wait for the loop at least, before the oldest are dropped."""

BULK_BYTES = 60_000
"""From this size on a message is sent from a thread: it takes more than one packet of Zenoh's."""

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
    """A publisher as the subscriptions of others see it."""

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
        depth = depth_of(qos)
        # What a publisher keeps for late readers before the session is open.
        self._early: deque[tuple[bytes, bytes]] = deque(maxlen=depth)
        self.active = self._transient
        self.bounded = qos.history is HistoryPolicy.KEEP_ALL and is_reliable(qos)
        # One that `_send` may make wait; the others wait anyway, or may lose what they send.
        self._patient = is_reliable(qos) and not self.bounded and not self._transient
        # One that waits for slow readers holds up nobody else.
        self._sender = Sender("aionode-keep-all", link.wakeup) if self.bounded else link.bulk
        link.senders.add(self._sender)
        self._outlet = self._sender.outlet(depth, keep_all=self.bounded)
        link.own_gids.add(self.gid)
        link.on_reader.setdefault(endpoint.name, []).append(self._update)
        link.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the publisher, and send what was kept."""
        qos = self.endpoint.qos
        reliable = is_reliable(qos)
        reliability = zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT
        congestion = zenoh.CongestionControl.BLOCK if self.bounded else zenoh.CongestionControl.DROP
        if self._transient:
            self._publisher = ext.declare_advanced_publisher(
                session,
                self._key,
                congestion_control=congestion,
                reliability=reliability,
                allowed_destination=zenoh.Locality.REMOTE,
                cache=ext.CacheConfig(max_samples=depth_of(qos)),
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
                payload, extra = self._early.popleft()
                self._publisher.put(payload, attachment=extra)
        else:
            self._publisher = session.declare_publisher(
                self._key,
                congestion_control=congestion,
                reliability=reliability,
                allowed_destination=zenoh.Locality.REMOTE,
            )
            self._matching = self._publisher.declare_matching_listener(
                direct(self._matching_changed.put)
            )
        self._update()

    def undeclare_data(self) -> None:
        """Withdraw the publisher."""
        publisher, self._publisher = self._publisher, None
        matching, self._matching = self._matching, None
        if matching is not None:
            matching.undeclare()
        if publisher is not None:
            if len(self._outlet):
                # The thread may be inside `put`, and Zenoh's object is used by one at a time; what
                # was published before is still sent.
                self._sender.submit(lambda: withdraw(publisher))
            else:
                withdraw(publisher)
        self._update()

    def _update_with(self, _: zenoh.MatchingStatus) -> None:
        self._update()

    def _update(self) -> None:
        """Find out whether anybody listens."""
        if not self._transient:
            publisher = self._publisher
            self.active = isinstance(publisher, zenoh.Publisher) and bool(
                publisher.matching_status.matching  # type: ignore[attr-defined]  # no bool, as the stub says
            )
        if self.active and self._encode is None:
            self._encode = cdr.encoder(self._msg_type)

    def write(self, msg: Any, origin: Origin) -> None:
        """Send `msg`."""
        encode = self._encode
        if encode is None:
            encode = self._encode = cdr.encoder(self._msg_type)
        payload = encode(msg)
        extra = attachment.pack(origin.sequence, origin.source_ns, self.gid)
        publisher = self._publisher
        if publisher is None:
            if self._transient:
                self._early.append((payload, extra))
        elif self.bounded or len(payload) >= BULK_BYTES or len(self._outlet):
            # Small ones wait behind a large one, so that the order stays.
            self._outlet.put(lambda: self._send(publisher, payload, extra))
        else:
            try:
                publisher.put(payload, attachment=extra)
            except zenoh.ZError as error:
                raise TransportError(f"{self._key}: {reason(error)}") from error

    def _send(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None:
        """Send from a thread, where nobody can be told that the session was closed meanwhile."""
        session = self.link.session
        try:
            if session is not None and self._patient and self.link.begins_to_share():
                session.put(
                    self._key,
                    payload,
                    attachment=extra,
                    congestion_control=zenoh.CongestionControl.BLOCK,
                    allowed_destination=zenoh.Locality.REMOTE,
                )
            else:
                publisher.put(payload, attachment=extra)
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", self._key, reason(error))

    def has_room(self) -> bool:
        """Whether one more message can wait to be sent."""
        return not self.bounded or self._outlet.has_room()

    async def drain(self) -> None:
        """Wait until everything was handed to Zenoh."""
        await self._outlet.drain()

    @property
    def dropped(self) -> int:
        """How many large messages were dropped before Zenoh took them."""
        return self._outlet.dropped

    def way_of(self, reader: EndpointInfo) -> str | None:
        """Return ``zenoh`` for the subscriptions of others."""
        return "zenoh" if reader.node.participant != self.link.participant else None

    def close(self) -> None:
        """Withdraw the publisher for good."""
        updates = self.link.on_reader.get(self.endpoint.name, [])
        if self._update in updates:
            updates.remove(self._update)
            if not updates:
                del self.link.on_reader[self.endpoint.name]
        self._transient = False
        super().close()
        self.link.own_gids.discard(self.gid)
        if self.bounded:
            self.link.senders.discard(self._sender)
            self._sender.close()
        self._update()


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
        self._deliver = reader.deliver
        self._wakeup = link.wakeup
        self._reject = reader.reject
        self._raw = reader.raw
        self._msg_type = msg_type
        self._decode: Callable[[bytes], Any] | None = None
        depth = depth_of(endpoint.qos)
        # A few hundred images waiting for a busy loop would take all memory; what is small may
        # wait for its turn in the subscription's own queue, where it is counted if dropped.
        limit = depth if self._buffers else max(depth, BACKLOG)
        if endpoint.qos.history is HistoryPolicy.KEEP_ALL and is_reliable(endpoint.qos):
            self._lane: Lane[zenoh.Sample] = PatientLane(
                link.wakeup, self._take, limit, reader.has_room, reader.when_room
            )
        else:
            self._lane = link.lane(self._take, limit)
        self._subscribers: list[zenoh.Subscriber[None] | ext.AdvancedSubscriber[None]] = []
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
        self._lane.clear()  # a thread that waits for room would hold up what follows
        for subscriber in subscribers:
            subscriber.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
        self._lane.clear()

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
            self._reject(error)
        else:
            self._deliver(msg, origin, self._wakeup.until_ns)


def origin_of(extra: zenoh.ZBytes | None) -> Origin | None:
    """Return what an attachment says, or None when there is none in a known form."""
    if extra is None:
        return None
    fields = attachment.unpack_fields(extra.to_bytes())
    return None if fields is None else Origin(fields[2], fields[0], fields[1], True)
