"""Subscriptions on Zenoh."""

from __future__ import annotations

import logging
from collections import deque
from typing import TYPE_CHECKING, Any

import zenoh
from zenoh import ext

from aionode.clock import perf_ns
from aionode.errors import DecodeError
from aionode.graph import EndpointKind
from aionode.qos import HistoryPolicy, depth_of
from aionode.transport._reliability import NEVER, OVERHEAD_BYTES, WriterProxy
from aionode.transport.base import SampleInfo
from aionode.transport.zenoh._delivery import has_buffers, is_reliable, is_transient
from aionode.transport.zenoh._session_state import Declaration
from aionode.wire import _acknack as acknack
from aionode.wire import _attachment as attachment
from aionode.wire import cdr
from aionode.wire._acknack import Kind
from aionode.wire._key_expression import buffer_key, data_key
from aionode.wire._liveliness import CPU_BACKEND, endpoint_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from aionode.transport.base import Reader
    from aionode.transport.zenoh._session_state import SessionState
    from aionode.wire._acknack import Submessage

__all__ = ["NOBODY", "ZenohReader", "sample_info_of"]

logger = logging.getLogger("aionode.transport.zenoh")

BACKLOG = 10_000
"""How many small messages wait for the loop at least, before the oldest are dropped."""

KEEP_ALL_ARRIVING = 100_000
"""How many messages for a KEEP_ALL subscription wait for the loop, if it hangs."""

FULL_BYTES = 256 << 20
"""How much waits for room in a KEEP_ALL subscription of what cannot be held back."""

SPAN = 1_000
"""How many small messages a KEEP_LAST subscription waits for at least that were lost on the way."""

REMEMBERED_WRITERS = 1_024

GONE_NS = 15_000_000_000
"""After so long a publisher that is not there will not fill any gap."""

NOBODY = bytes(16)


class ZenohReader(Declaration):
    """A subscription as the publishers of others see it."""

    def __init__(
        self, state: SessionState, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> None:
        self._buffers = has_buffers(msg_type)
        transient = is_transient(endpoint.qos)
        self._second_key = self._buffers and not transient
        backends = CPU_BACKEND if self._second_key else ""
        # Without a hash it takes every definition of the type, which ROS has no token for.
        visible = bool(endpoint.type_hash)
        super().__init__(
            state, endpoint_token(state.domain_id, endpoint, backends) if visible else ""
        )
        self.endpoint = endpoint
        self._key = data_key(state.domain_id, endpoint.name, endpoint.type_name, endpoint.type_hash)
        self._transient = transient
        self._reader = reader
        self._deliver = reader.deliver
        self._waker = state.waker
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
        self._queue = state.queue(self._take, KEEP_ALL_ARRIVING if self._keep_all else limit)
        self._span = NEVER if self._keep_all else depth if self._buffers else max(depth, SPAN)
        self._proxies: dict[bytes, WriterProxy] = {}
        # The last numbers of those who do not acknowledge, or have not begun to.
        self._last: dict[bytes, int] = {}
        # What a KEEP_ALL subscription has no room for yet.
        self._full: deque[tuple[bytes, SampleInfo, WriterProxy | None]] = deque()
        self._full_bytes = 0
        self._waits_for_room = False
        self._refused = 0
        self._subscribers: list[zenoh.Subscriber[None] | ext.AdvancedSubscriber[None]] = []
        if reliable and not transient and visible:
            state.acknowledgements.readers[self.gid] = self
        state.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Declare the subscriber; a transient local one is given the history."""
        put = self._queue.put
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
        self._queue.clear()
        self._full.clear()
        self._proxies.clear()

    def close(self) -> None:
        """Withdraw the subscription for good."""
        self.state.acknowledgements.readers.pop(self.gid, None)
        super().close()

    def _take(self, sample: zenoh.Sample) -> None:
        extra = sample.attachment
        sample_info = sample_info_of(extra)
        if sample_info is None:
            # ROS drops it; here the message counts, and who sent it stays unknown.
            if extra is not None:
                self.state.note_malformed(self._key, "an attachment")
            sample_info = SampleInfo(NOBODY, 0, 0, True)
        elif sample_info.gid in self.state.own_gids:
            return  # a late subscription asks the publishers of its own context for history too
        payload = sample.payload.to_bytes()
        gid = sample_info.gid
        proxy = self._proxies.get(gid)
        if proxy is not None:
            if not self._keep_all and proxy.takes_at_once(sample_info.sequence, len(payload)):
                self._hand_over(payload, sample_info)
            else:
                self._take_in_order(proxy, payload, sample_info)
            return
        self._last[gid] = sample_info.sequence
        if len(self._last) > REMEMBERED_WRITERS:
            del self._last[next(iter(self._last))]
        if self._keep_all:
            self._accept_or_wait(payload, sample_info, None)
        else:
            self._hand_over(payload, sample_info)

    def _take_in_order(self, proxy: WriterProxy, payload: bytes, sample_info: SampleInfo) -> None:
        proxy.take(sample_info.sequence, (payload, sample_info), len(payload) + OVERHEAD_BYTES)
        if proxy.next <= proxy.last:
            self.state.acknowledgements.watch(self)

    def accept(self, item: tuple[bytes, SampleInfo], proxy: WriterProxy) -> bool:
        """Take the next message of a writer; return whether it is used already."""
        if self._keep_all:
            return self._accept_or_wait(*item, proxy)
        self._hand_over(*item)
        return True

    def _accept_or_wait(
        self, payload: bytes, sample_info: SampleInfo, proxy: WriterProxy | None
    ) -> bool:
        """Give a message to a KEEP_ALL subscription as soon as it has room."""
        if not self._full and self._reader.has_room():
            self._hand_over(payload, sample_info)
            return True
        if proxy is None and self._full_bytes >= FULL_BYTES:
            self._refuse()  # who sent it cannot be held back
            return True
        self._full.append((payload, sample_info, proxy))
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
            payload, sample_info, proxy = full.popleft()
            self._full_bytes -= len(payload) + OVERHEAD_BYTES
            self._hand_over(payload, sample_info)
            if proxy is not None:
                proxy.used(len(payload) + OVERHEAD_BYTES)
        if full:
            self._wait_for_room()

    def _hand_over(self, payload: bytes, sample_info: SampleInfo) -> None:
        if self._raw:
            self._deliver(payload, sample_info, self._waker.inline_deadline_ns)
            return
        decode = self._decode
        if decode is None:
            decode = self._decode = cdr.decoder(self._msg_type)
        try:
            msg = decode(payload)
        except DecodeError as error:
            self.state.note_malformed(self._key, str(error))
            self._reader.reject(error)
        else:
            self._deliver(msg, sample_info, self._waker.inline_deadline_ns)

    # What writers say, and are told

    def told(self, said: Submessage) -> None:
        """Take what a writer says."""
        proxy = self._proxies.get(said.writer)
        if said.kind is Kind.HEARTBEAT:
            if proxy is None:
                participant = said.rest.decode(errors="replace")
                if not participant.isalnum():  # it becomes part of a key
                    self.state.note_malformed(self._key, "an acknowledgement")
                    return
                first = max(said.first, self._last.pop(said.writer, 0) + 1)
                proxy = WriterProxy(said.writer, participant, first, self, perf_ns, self._span)
                self._forget_writers()
                self._proxies[said.writer] = proxy
            # While some of its messages wait for their turn, nobody can tell what is missing.
            proxy.heartbeat(said.first, said.last, ask=not len(self._queue))
        elif proxy is not None:
            if said.kind is Kind.GAP:
                proxy.gap(said.first, said.last)
            else:
                sample_info = SampleInfo(said.writer, said.first, said.last, True)
                self._take_in_order(proxy, said.rest, sample_info)
                return
        if proxy is not None and proxy.next <= proxy.last:
            self.state.acknowledgements.watch(self)

    def _forget_writers(self) -> None:
        """Forget those that have been silent for longest, if there are many."""
        if len(self._proxies) >= REMEMBERED_WRITERS:
            del self._proxies[min(self._proxies, key=lambda gid: self._proxies[gid].heard_ns)]

    def tick(self) -> bool:
        """Ask again for what is missing; return whether to come again."""
        graph = self.state.graph
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
            if not len(self._queue):
                proxy.remind()
        return again

    def acknack(self, proxy: WriterProxy, first: int, ranges: list[tuple[int, int]]) -> None:
        """Tell a writer what is here and what is not."""
        data = acknack.pack(
            Kind.ACKNACK, proxy.gid, self.gid, first, 0, acknack.pack_ranges(ranges)
        )
        self.state.acknowledgements.say(proxy.participant, data)


def sample_info_of(extra: zenoh.ZBytes | None) -> SampleInfo | None:
    """Return what an attachment says, or None when there is none in a known form."""
    if extra is None:
        return None
    fields = attachment.unpack_fields(extra.to_bytes())
    return None if fields is None else SampleInfo(fields[2], fields[0], fields[1], True)
