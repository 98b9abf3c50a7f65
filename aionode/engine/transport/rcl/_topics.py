"""Publishers and subscriptions on rcl."""

from __future__ import annotations

from collections import deque
from ctypes import byref, c_size_t, string_at
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode._process.recent import Recent
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS
from aionode.engine.transport.base import StopSender, Writer
from aionode.engine.transport.rcl._bindings import UNNUMBERED, ByteArray, MessageInfo, load, view
from aionode.engine.transport.rcl._state import RclDeclaration
from aionode.engine.transport.rcl._types import rosidl_class
from aionode.engine.transport.rcl._wake import Wake
from aionode.engine.transport.send_thread import SendQueue, SendThread
from aionode.engine.wire import cdr
from aionode.errors import DecodeError
from aionode.graph import EndpointKind
from aionode.qos import DurabilityPolicy, depth_of, keeps_all

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import Reader
    from aionode.engine.transport.rcl._bindings import Rcl
    from aionode.engine.transport.rcl._state import RclState
    from aionode.graph import EndpointInfo

__all__ = ["RclReader", "RclWriter"]

BULK_BYTES: Final = 60_000
"""Size from which a thread sends messages; after the first such message, a subscription takes all
of its messages without holding the GIL.
"""

GIVE_UP_TRIES: Final = 20
"""Attempts of a publisher being destroyed to send one more message (0.1 s each)."""


class RclWriter(RclDeclaration, Writer):
    """A publisher for subscriptions of other contexts.

    The loop itself sends small messages, which never blocks with KEEP_LAST. Large ones are sent by
    the context's thread; with KEEP_ALL, where DDS waits 0.1 s for readers and then gives up, all
    are sent by a thread of this publisher, which retries.
    """

    def __init__(self, state: RclState, endpoint: EndpointInfo, msg_type: type[Any]) -> None:
        super().__init__(state, endpoint)
        self._encode: Callable[[Any], bytes] = cdr.encoder(msg_type)
        self._transient = endpoint.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self.bounded = keeps_all(endpoint.qos)
        self._handle: Any = None
        self._pointer = 0
        self._publish: Callable[..., int] | None = None
        # Messages published before the context was open, for late readers.
        self._early: deque[bytes] = deque(maxlen=depth_of(endpoint.qos))
        self._blocking = SendThread("aionode-rcl-blocking", state.waker) if self.bounded else None
        self._queue: SendQueue = (self._blocking or state.bulk).send_queue(
            depth_of(endpoint.qos), keep_all=self.bounded
        )
        self._queued = self.bounded  # whether messages go through the queue
        self._readers: set[EndpointInfo] = set()
        self._matched = c_size_t()
        self._unwatch: Callable[[], None] | None = None
        self._closing = False
        self._refused = 0
        state.add(self)

    def declare(self, rcl: Rcl) -> None:
        """Create the publisher, and send what was published before."""
        ros_class = rosidl_class(self.endpoint.type_name, self.endpoint.type_hash)
        self._closing = False
        self._handle = self.make(rcl.module.Publisher, ros_class)
        self._pointer = self._handle.pointer
        self._publish = rcl.publish
        gid = rcl.publisher_gid(self._pointer)
        self.state.note_own(gid)
        self.identify(gid)
        if self.state.graph is not None:
            self._unwatch = self.state.graph.watch(
                EndpointKind.SUBSCRIPTION, self.endpoint.name, self._note_reader
            )
        while self._early:
            self._put(self._early.popleft())

    def _note_reader(self, reader: EndpointInfo, present: bool) -> None:
        if present and reader.node.over_rcl and self.endpoint.matches(reader):
            self._readers.add(reader)
        else:
            self._readers.discard(reader)

    @property
    def active(self) -> bool:  # type: ignore[override]  # it is asked for
        """Whether a reader is known to the graph or, possibly earlier, to the middleware."""
        return self._transient or bool(self._readers) or self._is_matched()

    def _is_matched(self) -> bool:
        """Return whether the middleware knows more readers than those of this context."""
        rcl, matched = self.state.rcl, self._matched
        if rcl is None or self._handle is None:
            return False
        if rcl.count_subscriptions(self._pointer, byref(matched)):
            rcl.forget_error()
            return False
        return matched.value > 0 and matched.value > self.state.count_own_readers(self.endpoint)

    def undeclare(self) -> None:
        """Destroy the publisher, after the messages pending in a thread."""
        handle, self._handle = self._handle, None
        self._publish = None
        self._closing = True
        if self._unwatch is not None:
            self._unwatch()
            self._unwatch = None
        self._readers.clear()
        if handle is None:
            return
        if not len(self._queue):
            handle.destroy_when_not_in_use()
        else:
            (self._blocking or self.state.bulk).submit(handle.destroy_when_not_in_use)
        if self._blocking is not None:
            self._blocking.close()

    # Messages

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:  # noqa: ARG002  # DDS numbers them
        """Send `msg`."""
        payload = self._encode(msg)
        publish = self._publish
        if publish is None:
            if self._transient:
                self._early.append(payload)
        elif len(payload) >= BULK_BYTES or (self._queued and self._is_queueing()):
            self._put(payload)
        elif publish(self._pointer, byref(view(payload)), None):
            self._note_refused()

    def _put(self, payload: bytes) -> None:
        """Send a message from a thread: it may take long, or follows one that may."""
        send = partial(self._send_without_gil, self._handle, self._pointer, payload)
        self._queue.put(send, len(payload))
        self._queued = True

    def _is_queueing(self) -> bool:
        """Return whether the next message has to wait for earlier ones."""
        self._queued = self.bounded or len(self._queue) > 0
        return self._queued

    def _send_without_gil(self, handle: Any, pointer: int, payload: bytes) -> None:  # noqa: ARG002
        """Send a message in a thread; `handle` keeps the publisher alive meanwhile."""
        rcl, array = load(), view(payload)
        tries = 0
        while rcl.publish_without_gil(pointer, byref(array), None):
            if not self.bounded or (self._closing and tries >= GIVE_UP_TRIES):
                self._note_refused()
                return
            rcl.forget_error()
            tries += self._closing

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:  # noqa: ARG002  # DDS sends lost ones again
        """Return an object that sends the stop of a lease."""
        return RclStop(self, self._encode(stop))

    def write_stop(self, payload: bytes) -> None:
        """Send the stop of a lease, after a large message that a thread is currently sending."""
        self._queue.abandon()
        if self._publish is None:
            if self._transient:
                self._early.append(payload)
        elif len(self._queue) or len(payload) >= BULK_BYTES:
            self._put(payload)
        else:
            self.put_stop(payload)

    def put_stop(self, payload: bytes) -> None:
        """Send the stop of a lease immediately, from any thread."""
        rcl, pointer = self.state.rcl, self._pointer
        if rcl is None or self._handle is None:
            return
        if rcl.publish_without_gil(pointer, byref(view(payload)), None):
            self._note_refused()

    def _note_refused(self) -> None:
        self._refused += 1
        self.state.note_refused(self.endpoint.name)

    def has_room(self) -> bool:
        """Whether another message can wait for its turn."""
        return not self.bounded or self._queue.has_room()

    async def flush(self) -> None:
        """Wait until everything was passed to the middleware."""
        await self._queue.drain()

    def is_drained(self) -> bool:
        """Return whether everything was passed to the middleware."""
        return not len(self._queue)

    async def drain(self) -> None:
        """Wait until everything was passed to the middleware."""
        await self._queue.drain()

    def assert_liveliness(self) -> None:
        """Tell the readers, the DDS way."""
        if self._handle is not None and self.state.rcl is not None:
            self.state.rcl.assert_liveliness(self._pointer)

    @property
    def dropped(self) -> int:
        """The number of messages dropped on their way because it was slow."""
        return self._queue.dropped + self._refused

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return ``rcl`` for subscriptions of other contexts."""
        return "rcl" if reader in self._readers else None


class RclStop(StopSender):
    """Sends the stop of a lease over rcl, whose publishers any thread may use."""

    def __init__(self, writer: RclWriter, payload: bytes) -> None:
        self._writer = writer
        self._payload = payload
        self._past = 0  # its number, once it was sent while the loop was blocked

    def send(self, sequence: int, source_ns: int) -> None:  # noqa: ARG002  # DDS has its own
        """Send the stop, unless that was done while the loop was blocked."""
        if sequence != self._past and self._writer.active:
            self._writer.write_stop(self._payload)

    def send_past_loop(self, sequence: int, source_ns: int) -> None:  # noqa: ARG002  # the same
        """Send the stop."""
        self._past = sequence
        self._writer.put_stop(self._payload)


class RclReader(RclDeclaration):
    """A subscription for publishers of other contexts.

    It cannot exclude this context's own publishers, which `LocalTransport` serves, so it drops
    their messages.
    """

    def __init__(
        self, state: RclState, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> None:
        super().__init__(state, endpoint)
        self._reader = reader
        self._decode: Callable[[bytes], Any] = bytes if reader.raw else cdr.decoder(msg_type)
        self._keep_all = keeps_all(endpoint.qos)
        self._handle: Any = None
        self._pointer = 0
        self._wake: Wake | None = None
        self._array = ByteArray()  # where the middleware writes messages
        self._to_array = byref(self._array)
        self._info = MessageInfo()
        self._to_info = byref(self._info)
        self._take_it: Callable[..., int] | None = None
        self._other = b""  # gid of the last message's publisher, if not our own
        self._waits_for_room = False
        # For middleware that does not number messages.
        self._counts: Recent[bytes, int] = Recent(REMEMBERED_PUBLISHERS)
        state.add(self)

    def declare(self, rcl: Rcl) -> None:
        """Make the subscription."""
        ros_class = rosidl_class(self.endpoint.type_name, self.endpoint.type_hash)
        loop = self.state.loop
        if loop is None:
            return
        self._handle = self.make(rcl.module.Subscription, ros_class)
        self._pointer = self._handle.pointer
        self._array = rcl.new_array()
        self._to_array = byref(self._array)
        self._take_it = rcl.take
        gid = self._find_gid(rcl)
        if gid is not None:
            self.identify(gid)
        self._wake = Wake(loop, rcl, rcl.set_subscription_callback, self._pointer, self._take)

    def _find_gid(self, rcl: Rcl) -> bytes | None:
        """Return the gid of this subscription: the one on its node that is not known yet."""
        node, graph = self.state.node(self.endpoint.node), self.state.graph
        if graph is None:
            return None
        name = self.endpoint.name
        with node:
            infos = rcl.module.rclpy_get_subscriptions_info_by_topic(node, name, False)
        known = {info.gid for info in graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)}
        known |= self.state.own_gids
        for info in infos:
            gid = bytes(info["endpoint_gid"])
            names = (info["node_name"], info["node_namespace"])
            own = (self.endpoint.node.name, self.endpoint.node.namespace)
            if names == own and gid not in known:
                self.state.note_own(gid)
                return gid
        return None

    def undeclare(self) -> None:
        """Destroy the subscription."""
        wake, self._wake = self._wake, None
        handle, self._handle = self._handle, None
        array, self._array = self._array, ByteArray()
        self._take_it = None
        if wake is not None:
            wake.close()
        if handle is not None:
            handle.destroy_when_not_in_use()
            if self.state.rcl is not None:
                self.state.rcl.free_array(array)

    def _take(self, inline_deadline_ns: int) -> bool:
        """Take one message; return whether there was one that could be taken."""
        rcl, take = self.state.rcl, self._take_it
        if rcl is None or take is None:
            return False
        if self._keep_all and not self._reader.has_room():
            self._wait_for_room()
            return False
        if take(self._pointer, self._to_array, self._to_info, None):
            rcl.forget_error()
            return False
        gid = bytes(self._info.gid)
        if gid != self._other:
            if self.state.is_own(gid):
                return True
            self._other = gid
        self._deliver(rcl, gid, inline_deadline_ns)
        return True

    def _deliver(self, rcl: Rcl, gid: bytes, inline_deadline_ns: int) -> None:
        """Pass on the message that was taken."""
        info, array = self._info, self._array
        size = array.length
        if size >= BULK_BYTES:
            self._take_it = rcl.take_without_gil
        payload = string_at(array.buffer, size)
        sequence = info.sequence
        if sequence == UNNUMBERED:
            sequence = self._counts.get(gid, 0) + 1
            self._counts.put(gid, sequence)
        try:
            msg = self._decode(payload)
        except DecodeError as error:
            self.state.note_malformed(self.endpoint.name, str(error))
            self._reader.reject(error)
        else:
            self._reader.deliver(msg, gid, sequence, info.source_ns, inline_deadline_ns)

    def _wait_for_room(self) -> None:
        """Leave messages in the middleware, which slows their publishers down."""
        if not self._waits_for_room:
            self._waits_for_room = True
            self._reader.when_room(self._go_on)

    def _go_on(self) -> None:
        self._waits_for_room = False
        if self._wake is not None:
            self._wake.again()
