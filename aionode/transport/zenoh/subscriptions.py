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
from aionode.qos import HistoryPolicy
from aionode.transport.base import Origin
from aionode.transport.reliability import NEVER, OVERHEAD_BYTES, WriterProxy
from aionode.transport.zenoh.link import Entity
from aionode.transport.zenoh.topics import depth_of, has_buffers, is_reliable, is_transient
from aionode.wire import acknack, attachment, cdr
from aionode.wire.acknack import Kind
from aionode.wire.keyexpr import buffer_key, data_key
from aionode.wire.liveliness import CPU_BACKEND, endpoint_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from aionode.transport.base import Reader
    from aionode.transport.zenoh.link import Link
    from aionode.wire.acknack import Submessage

__all__ = ["NOBODY", "ZenohReader", "origin_of"]

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
            if not self._keep_all and proxy.takes_at_once(origin.sequence, len(payload)):
                self._hand_over(payload, origin)
            else:
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
