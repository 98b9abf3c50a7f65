"""Subscriptions on Zenoh."""

from __future__ import annotations

import logging
from collections import deque
from typing import TYPE_CHECKING, Any, ClassVar

import zenoh
from zenoh import ext

from aionode.clock import perf_ns
from aionode.engine.transport.base import NOT_INLINE_NS, SampleInfo
from aionode.engine.transport.drops import Drop
from aionode.engine.transport.reliability.limits import NEVER, OVERHEAD_BYTES
from aionode.engine.transport.reliability.stateful_reader import StatefulReader
from aionode.engine.transport.zenoh._defects.undeclared_subscribers import foreground
from aionode.engine.transport.zenoh._session_state import Declaration
from aionode.engine.transport.zenoh._target_numbers import TargetNumbers
from aionode.engine.transport.zenoh.connections.handlers import direct
from aionode.engine.transport.zenoh.delivery.delivery import (
    UNKNOWN_GID,
    is_reliable,
    is_transient,
)
from aionode.engine.wire import cdr
from aionode.engine.wire._attachment import unpack_fields
from aionode.engine.wire._key_expression import BUFFER_SUFFIX, Side, buffer_key
from aionode.engine.wire._liveliness import CPU_BACKEND
from aionode.errors import DecodeError
from aionode.graph import EndpointKind
from aionode.qos import depth_of, is_unlimited, keeps_all

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import Reader
    from aionode.engine.transport.reliability.submessage import Submessage
    from aionode.engine.transport.reliability.writer_proxy import WriterProxy
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.delivery.shared_payload import SharedPayload
    from aionode.graph import EndpointInfo

__all__ = ["ZenohReader"]

logger = logging.getLogger("aionode.transport.zenoh")

BACKLOG = 10_000
"""Minimum number of small messages that wait for the loop before the oldest are dropped."""

KEEP_ALL_ARRIVING = 100_000
"""Number of messages for a KEEP_ALL subscription that may wait for a stalled loop."""

WINDOWS = 8
"""Factor for what may wait for room in a KEEP_ALL subscription from publishers with flow control:
512 of them with a full window."""

SPAN = 1_000
"""Minimum number of small messages a KEEP_LAST subscription holds while earlier ones are
missing."""


class ZenohReader(Declaration):
    """A subscription to publishers of other contexts."""

    recovers: ClassVar[bool] = True  # whether its publishers resend what it misses

    def __init__(
        self, state: SessionState, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> None:
        self._buffers = cdr.has_buffers(msg_type)
        transient = is_transient(endpoint.qos)
        self._second_key = self._buffers and not transient and self.recovers
        backends = CPU_BACKEND if self._second_key else ""
        names = state.names_of(endpoint, backends)
        super().__init__(state, names.token, names.gid)
        self._key = names.key
        self.endpoint = endpoint
        self._transient = transient
        # The history comes at once, and a message's lifespan is in its publisher's token.
        self.needs_graph = transient
        self._reader = reader
        self._deliver = reader.deliver
        self._waker = state.waker
        self._raw = reader.raw
        self._msg_type = msg_type
        self._decode: Callable[[bytes], Any] | None = None
        depth = depth_of(endpoint.qos)
        reliable = is_reliable(endpoint.qos)
        self._keep_all = keeps_all(endpoint.qos)
        # A few hundred images waiting for a busy loop would take all memory; small messages may
        # wait for their turn in the subscription's own queue, where drops are counted.
        limit = depth if self._buffers else max(depth, BACKLOG)
        # A publisher that gets acknowledgements sends at most a window ahead, and resends what is
        # dropped here.
        self._queue = state.arrivals(
            self._receive, KEEP_ALL_ARRIVING if self._keep_all else limit, self._note_dropped
        )
        self._numbers = TargetNumbers(self._count_targets) if self._second_key else None
        self._stateful: StatefulReader | None = None
        if reliable and names.token and self.recovers:
            span = NEVER if self._keep_all else depth if self._buffers else max(depth, SPAN)
            self._stateful = StatefulReader(
                self.gid, self, perf_ns, span, has_history=self._transient
            )
        # With other subscriptions of this context, while it is declared.
        self._shared: SharedPayload | None = None
        self._proxies = {} if self._stateful is None else self._stateful.proxies
        # Messages for which a KEEP_ALL subscription has no room yet.
        self._full: deque[tuple[bytes, SampleInfo, WriterProxy | None]] = deque()
        self._full_bytes = 0
        # The largest message that a KEEP_ALL subscription has not accepted.
        self._largest_bytes = 0
        self._waits_for_room = False
        self._subscribers: list[zenoh.Subscriber[None] | ext.AdvancedSubscriber[None]] = []
        self._has_lease = not is_unlimited(endpoint.qos.liveliness_lease_duration)
        if self._has_lease:
            state.assertions.listen(self._key, reader.note_alive)
        state.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the subscriber; a transient local one gets the history."""
        if self._stateful is not None:
            self.state.acknowledgements.add_reader(self._key, self.gid, self.receive_submessage)
        self._shared = self.state.payloads.join(self._key)
        put = self._queue.put
        if self._transient:
            reliable = is_reliable(self.endpoint.qos)
            # Not `direct`: Zenoh calls it with a lock held, for which undeclaring would also wait.
            subscriber: Any = ext.declare_advanced_subscriber(
                session,
                self._key,
                foreground(put),
                allowed_origin=zenoh.Locality.REMOTE,
                history=ext.HistoryConfig(
                    detect_late_publishers=True, max_samples=depth_of(self.endpoint.qos)
                ),
                recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
                if reliable and self.recovers
                else None,
                subscriber_detection=True,
            )
            self._subscribers.append(subscriber)
            return
        for key in (self._key, buffer_key(self._key)) if self._second_key else (self._key,):
            self._subscribers.append(
                session.declare_subscriber(key, direct(put), allowed_origin=zenoh.Locality.REMOTE)
            )

    def undeclare_data(self) -> None:
        """Undeclare the subscriber."""
        if self._stateful is not None:
            self.state.acknowledgements.remove_reader(self._key, self.gid)
        if self._shared is not None:
            self._shared = None
            self.state.payloads.leave(self._key)
        subscribers, self._subscribers = self._subscribers, []
        for subscriber in subscribers:
            subscriber.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
        self._queue.clear()
        self._full.clear()
        if self._stateful is not None:
            self._stateful.clear()

    def close(self) -> None:
        """Undeclare the subscription for good."""
        if self._has_lease:
            self.state.assertions.unlisten(self._key, self._reader.note_alive)
        super().close()

    def _receive(self, sample: zenoh.Sample) -> None:
        extra = sample.attachment
        fields = None if extra is None else unpack_fields(extra.to_bytes())
        sequence, source_ns, gid = fields or self._without_attachment(extra)
        if self._numbers is not None:
            by_target = str(sample.key_expr).endswith(BUFFER_SUFFIX)
            sequence = self._numbers.number(gid, sequence, by_target=by_target)
        if self._transient and gid in self.state.own_gids:
            return  # a late subscription also asks the publishers of its own context for history
        shared = self._shared
        payload = (
            sample.payload.to_bytes()
            if shared is None or shared.readers < 2 or fields is None
            else shared.bytes_of((gid, fields[0], source_ns), sample.payload)
        )
        proxy = self._proxies.get(gid)
        if proxy is None:
            if self._stateful is not None and not self._stateful.receive_early(gid, sequence):
                return  # its publisher has resent it
            if self._keep_all:
                self._accept_or_wait(payload, self._held(gid, sequence, source_ns), None)
                return
        elif sequence == proxy.expected and (
            not self._keep_all or (not self._full and self._has_room(len(payload)))
        ):
            proxy.receive_expected(len(payload))
        else:
            sample_info = self._held(gid, sequence, source_ns)
            # The history of a transient local publisher may come again.
            self._receive_in_order(proxy, payload, sample_info, is_resent=self._transient)
            return
        # Like `_hand_over`, which would be one more call per message.
        decode = self._decode
        if decode is None:
            decode = self._make_decode()
        try:
            msg = decode(payload)
        except DecodeError as error:
            self._reject(error)
        else:
            self._deliver(msg, gid, sequence, source_ns, self._waker.inline_deadline_ns)

    def _without_attachment(self, extra: zenoh.ZBytes | None) -> tuple[int, int, bytes]:
        """Return the fields of a message that ROS would drop; here its sender is unknown."""
        if extra is not None:
            self.state.note_malformed(self._key, "an attachment")
        return 0, 0, UNKNOWN_GID

    def _count_targets(self) -> int:
        """Count the topic's subscriptions to which a publisher of Lyrical sends individually."""
        graph = self.state.graph
        if graph is None:
            return 0
        subscriptions = graph.endpoints(EndpointKind.SUBSCRIPTION, name=self.endpoint.name)
        return sum(
            bool(known.type_hash) and is_transient(known.qos)
            if known.node.participant == self.state.participant
            else known.backends != CPU_BACKEND and not known.node.bridged
            for known in subscriptions
        )

    def _held(self, gid: bytes, sequence: int, source_ns: int) -> SampleInfo:
        """Return the metadata of a message that may wait here, with its arrival time."""
        return SampleInfo(gid, sequence, source_ns, self.state.time_base.system_ns())

    def _note_dropped(self, count: int) -> None:
        """Count messages dropped because too many bytes of them waited for the loop."""
        limit = f"{self.state.queue_bytes / 2**20:.3g} MiB"
        self.state.drops.note(Drop.BUSY_LOOP, self.endpoint.name, limit, count)

    def _has_room(self, size_bytes: int) -> bool:
        """Return whether a KEEP_ALL subscription can accept another message of this size.

        What it has not accepted counts as if every message had the size of the largest.
        """
        waiting = self._reader.waiting
        if not waiting:
            self._largest_bytes = 0
        self._largest_bytes = max(self._largest_bytes, size_bytes + OVERHEAD_BYTES)
        fits = not waiting or (waiting + 1) * self._largest_bytes <= self.state.queue_bytes
        return fits and self._reader.has_room()

    def _receive_in_order(
        self,
        proxy: WriterProxy,
        payload: bytes,
        sample_info: SampleInfo,
        *,
        is_resent: bool = False,
    ) -> None:
        item, size = (payload, sample_info), len(payload) + OVERHEAD_BYTES
        proxy.receive(sample_info.sequence, item, size, is_resent=is_resent)
        if proxy.lacks:
            self._watch()

    def accept(self, item: tuple[bytes, SampleInfo], proxy: WriterProxy) -> bool:
        """Accept a writer's next message; return whether it is used now, or else waits for room."""
        if self._keep_all:
            return self._accept_or_wait(*item, proxy)
        self._hand_over(*item)
        return True

    def _accept_or_wait(
        self, payload: bytes, sample_info: SampleInfo, proxy: WriterProxy | None
    ) -> bool:
        """Deliver a message to a KEEP_ALL subscription as soon as it has room."""
        if not self._full and self._has_room(len(payload)):
            self._hand_over(payload, sample_info)
            return True
        # Acknowledged publishers send at most a window ahead, so only very many of them, or one
        # that is not aionode's, can fill this.
        limit = self.state.queue_bytes if proxy is None else WINDOWS * self.state.queue_bytes
        if self._full_bytes >= limit:
            self._refuse(limit)
            return True
        self._full.append((payload, sample_info, proxy))
        self._full_bytes += len(payload) + OVERHEAD_BYTES
        self._wait_for_room()
        return False

    def _refuse(self, limit_bytes: int) -> None:
        self.state.drops.note(Drop.KEEP_ALL, self.endpoint.name, f"{limit_bytes / 2**20:.3g} MiB")

    def _wait_for_room(self) -> None:
        if not self._waits_for_room:
            self._waits_for_room = True
            self._reader.when_room(self._use_room)

    def _use_room(self) -> None:
        self._waits_for_room = False
        full = self._full
        while full and self._has_room(len(full[0][0])):
            payload, sample_info, proxy = full.popleft()
            self._full_bytes -= len(payload) + OVERHEAD_BYTES
            self._hand_over(payload, sample_info)
            if proxy is not None:
                proxy.used(len(payload) + OVERHEAD_BYTES)
        if full:
            self._wait_for_room()

    def _make_decode(self) -> Callable[[bytes], Any]:
        """Create the decoder with the first message, as most subscriptions never need it."""
        decode = self._decode = bytes if self._raw else cdr.decoder(self._msg_type)
        return decode

    def _hand_over(self, payload: bytes, sample_info: SampleInfo) -> None:
        """Deliver a message that may have waited."""
        try:
            msg = (self._decode or self._make_decode())(payload)
        except DecodeError as error:
            self._reject(error)
        else:
            self._deliver(
                msg,
                sample_info.gid,
                sample_info.sequence,
                sample_info.source_ns,
                self._waker.inline_deadline_ns or NOT_INLINE_NS,
                sample_info.arrived_ns,
            )

    def _reject(self, error: DecodeError) -> None:
        self.state.note_malformed(self._key, str(error))
        self._reader.reject(error)

    # Submessages

    def receive_submessage(self, submessage: Submessage) -> None:
        """Handle a HEARTBEAT, GAP or DATA of one of its writers."""
        if self._stateful is not None and self._stateful.receive(submessage):
            self._watch()

    def _watch(self) -> None:
        """Ask again for missing messages until they have arrived."""
        if self._stateful is not None:
            self.state.acknowledgements.watch(self._stateful.tick)

    def send(self, participant: str, submessage: bytes) -> None:
        """Send a submessage to the context of a publisher."""
        self.state.acknowledgements.send(self._key, Side.SUBSCRIPTIONS, participant, submessage)

    def item_of(self, submessage: Submessage) -> tuple[bytes, SampleInfo]:
        """Return a resent message in the form that `accept` takes."""
        return submessage.rest, self._held(submessage.writer, submessage.first, submessage.last)

    def has_arrivals(self) -> bool:
        """Return whether messages wait for the loop."""
        return bool(len(self._queue))

    def receive_arrivals(self) -> None:
        """Handle the messages that wait for the loop."""
        self._queue.take_all()

    def participant_of(self, writer: bytes) -> str:
        """Return the context of a publisher of the topic; empty if it is not in the graph."""
        graph = self.state.graph
        if graph is None:
            return ""
        for publisher in graph.endpoints(EndpointKind.PUBLISHER, name=self.endpoint.name):
            if publisher.gid == writer:
                return publisher.node.participant
        return ""

    def malformed(self) -> None:
        """Count a submessage that does not name a context to answer."""
        self.state.note_malformed(self._key, "an acknowledgement")

    def refused(self, last: int) -> None:
        """Log once that something was claimed in a publisher's name that it cannot have said."""
        self.state.note_lie(
            self.endpoint.name,
            f"a HEARTBEAT or GAP up to message {last} was refused, as the publisher has not sent "
            "that many",
        )

    def started_anew(self, first: int) -> None:
        """Log once that messages arrive that were announced as missing."""
        self.state.note_lie(
            self.endpoint.name,
            f"messages from number {first} on are accepted, although they were announced as "
            "missing",
        )
