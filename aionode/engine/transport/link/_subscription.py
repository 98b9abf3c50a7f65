"""Subscriptions that receive from a remote publisher over Zenoh, a link, or both (hand-over).

The hand-over moves a stream from one route to the other without losing, duplicating or reordering
messages. A subscription first receives from a publisher of another process over Zenoh. Once the two
processes are linked:

1. The subscription asks for the publisher's messages (`Open`).
2. The publisher answers with the number of its last message (`Opened`), and writes to both routes
   from the next one on.
3. The subscription continues with what arrives over Zenoh and holds what arrives over the link,
   until Zenoh has delivered that number or a later one: then nothing older is on its way. If Zenoh
   stays silent, it lost the message, or was not matched when it was sent: the wait ends as well.
4. The subscription switches to the link and says so (`Switched`), and the publisher stops writing
   to Zenoh if no other subscription needs it. Copies that Zenoh delivers ahead of the link are
   held.

When the link ends, the publisher continues over Zenoh and retransmits what the subscription has not
confirmed, only to the subscription's process, so that no other subscription gets it twice; then it
says that this was all (`RetransmitDone`). Meanwhile the subscription recovers: it accepts the next
number from any route, including a new link, and holds what is further ahead.
"""

from __future__ import annotations

import enum
from collections import defaultdict, deque
from typing import TYPE_CHECKING, Any, Final

from msgspec import Struct

from aionode.engine.transport.base import NOT_INLINE_NS, ReaderRegistration, Registration
from aionode.engine.transport.drops import Drop
from aionode.engine.transport.link._endpoint_table import can_link
from aionode.engine.transport.link._protocol import Close, Credit, Kind, Open, Switched
from aionode.engine.wire import cdr
from aionode.errors import DecodeError, FrameError
from aionode.qos import ReliabilityPolicy, depth_of, keeps_all

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.engine.transport.base import Reader
    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._protocol import Frame
    from aionode.engine.transport.link._registry import LinkRegistry
    from aionode.engine.wire.cdr import Data
    from aionode.graph import EndpointInfo

__all__ = ["LinkReader", "RemotePublisher", "Route", "heard_from"]

WINDOW: Final = 1_000
"""How many messages a publisher may send ahead of those that a KEEP_ALL subscription has used."""

MAX_FULL: Final = 50_000
"""Maximum number of messages that wait for room in a KEEP_ALL subscription: its window, and the
last ones of a publisher that is destroyed.
"""

MAX_HELD: Final = 2_000
"""Maximum number of messages held until Zenoh has caught up; beyond it, the link is used.

A reliable subscription holds up to its depth, if that is more; a KEEP_ALL one always waits.
"""

MAX_RECOVERING: Final = 50_000
"""Maximum number of messages held while waiting for retransmitted ones."""

CONFIRM_BYTES: Final = 1 << 16
"""Number of bytes after which a subscription confirms what it has received."""

MESSAGE_BYTES: Final = 1 << 10
"""Bytes that each message counts besides its payload, so that 64 empty ones are confirmed too."""

ZENOH_LATE_S: Final = 0.1
"""How long a subscription that holds messages waits for the other route, in seconds."""

RECOVERY_S: Final = 0.5
"""The same when messages are retransmitted: to a KEEP_ALL subscription, or after a link has ended,
which the other process has to notice first.
"""


class Route(enum.Enum):
    """The route from which a subscription accepts a publisher's messages."""

    ZENOH = "zenoh"
    BOTH = "both"
    """From Zenoh; what arrives over the link is held."""
    LINK = "link"
    """From the link; what Zenoh delivers ahead of it is held."""
    RECOVERING = "recovering"
    """The next number from any route; what is further ahead is held."""


ZENOH: Final = Route.ZENOH
LINK: Final = Route.LINK


class Message(Struct, frozen=True):
    """A message that may be held until others have arrived."""

    msg: Any
    sequence: int
    source_ns: int
    arrived_ns: int


class RemotePublisher:
    """One publisher of another process, as seen by one subscription: the state of the hand-over.

    Args:
        registry: The links of this context.
        reader: The subscription.
        publisher: The publisher.

    Attributes:
        gid: The gid of the subscription.
        publisher: The gid of the publisher.
        participant: The context of the publisher.
        connection: The link over which it was asked for; None if there is none.
        route: Where its messages currently come from.
        last: Number of the last message delivered.
        full: Messages for which a KEEP_ALL subscription has no room yet.
    """

    __slots__ = (
        "_base",
        "_confirms",
        "_decode",
        "_deliver",
        "_gone",
        "_held",
        "_keep_all",
        "_linked",
        "_max_held",
        "_owed",
        "_progressed",
        "_registry",
        "_timer_runs",
        "_used",
        "_used_bytes",
        "_waiting_for_room",
        "connection",
        "full",
        "gid",
        "last",
        "participant",
        "publisher",
        "reader",
        "route",
    )

    def __init__(self, registry: LinkRegistry, reader: LinkReader, publisher: EndpointInfo) -> None:
        self.gid = reader.gid
        self.reader = reader
        self.publisher = publisher.gid
        self.participant = publisher.node.participant
        self.connection: Connection | None = None
        self.route = ZENOH
        self.last = 0
        self.full: deque[Message] = deque()
        self._registry = registry
        self._decode = reader.decoder()
        self._deliver = reader.deliver_local
        qos = reader.endpoint.qos
        reliable = ReliabilityPolicy.RELIABLE
        self._confirms = (
            qos.resolved().reliability is reliable
            and publisher.qos.resolved().reliability is reliable
        )
        self._keep_all = keeps_all(qos)
        # The publisher writes to both routes after this number; set when a link is opened.
        self._base = 0
        # Whether the publisher is sending over a link, and whether it has sent its last frame.
        self._linked = False
        self._gone = False
        # Ended links whose unconfirmed messages have not all been retransmitted yet.
        self._owed = 0
        # By number: what arrived over one route and must wait for the other; empty in steady state.
        self._held: dict[int, Message] = {}
        self._max_held = MAX_HELD
        if self._keep_all:
            self._max_held = MAX_RECOVERING
        elif self._confirms:
            self._max_held = max(MAX_HELD, depth_of(qos))
        # Messages, and their bytes, received over the link since the last confirmation.
        self._used = 0
        self._used_bytes = 0
        self._waiting_for_room = False
        # Whether `_on_timer` is scheduled, and whether anything has arrived since.
        self._timer_runs = False
        self._progressed = False

    # The link

    @property
    def is_linked(self) -> bool:
        """Whether there is a link, and the publisher has not been destroyed."""
        return self.connection is not None and not self._gone

    def open(self, connection: Connection) -> None:
        """Ask for the publisher's messages over `connection`."""
        self.connection = connection
        self._used = self._used_bytes = 0
        connection.receivers.add(self.publisher, self)
        window = WINDOW if self._keep_all else 0
        connection.send(Open(self.publisher, self.gid, window, self._confirms))

    def opened(self, sequence: int) -> None:
        """Expect the messages after number `sequence` over the link."""
        self._base = sequence
        self._linked = True
        if self.route is Route.RECOVERING:
            self._recover()
        else:
            self.route = Route.BOTH
            if self.last >= sequence:
                self._switch()
        self._route_changed()

    def close(self) -> None:
        """Request nothing more from the publisher."""
        connection, self.connection = self.connection, None
        if connection is not None:
            connection.receivers.remove(self.publisher, self)
            connection.send(Close(self.publisher, self.gid))

    def gone(self) -> None:
        """Expect nothing more over the link, as the publisher was destroyed.

        What it has written to Zenoh may still be on its way: messages older than those from the
        link, or copies of them.
        """
        self._linked = False
        self._gone = True
        if self.route is LINK or (self.route is Route.BOTH and self.last >= self._base):
            self._release()
            self.route = ZENOH
        self._confirm()  # or the publisher's process would keep the messages until the link ends
        self._start_timer()

    def broken(self) -> None:
        """Switch back to Zenoh as soon as nothing is missing, as the link has ended."""
        self.connection = None
        self._owed += 1
        self._linked = False
        if self.route is not ZENOH:
            self.route = Route.RECOVERING
            self._recover()
        self._route_changed()

    def retransmit_done(self) -> None:
        """Expect no more messages that a broken link left unconfirmed."""
        self._owed = max(self._owed - 1, 0)
        self._recover()
        self._route_changed()

    # Messages

    def from_link(
        self, payload: Data, sequence: int, source_ns: int, inline_deadline_ns: int
    ) -> None:
        """Handle a message from the link; before `opened` it is for another reader."""
        try:
            msg = self._decode(payload)
        except DecodeError as error:
            self._reject(error)
            return
        if self.route is LINK and not self._held and not self._keep_all:
            if sequence > self.last:
                self.last = sequence
                self._deliver(msg, self.publisher, sequence, source_ns, inline_deadline_ns)
        else:
            # It may be held for a while, so record that it has arrived now.
            message = Message(msg, sequence, source_ns, self._registry.now_ns())
            self._from_link_in_order(message, inline_deadline_ns)
        if self._confirms:
            self._used += 1
            self._used_bytes = used_bytes = self._used_bytes + len(payload) + MESSAGE_BYTES
            if used_bytes >= CONFIRM_BYTES:
                self._confirm()

    def _from_link_in_order(self, message: Message, inline_deadline_ns: int) -> None:
        if len(self.full) >= MAX_FULL:
            raise FrameError(
                f"{self.reader.endpoint.name}: {MAX_FULL} messages beyond the window of "
                f"{WINDOW} that was granted"
            )
        before = self.route
        if before is Route.BOTH:
            self._hold(message)
            if len(self._held) >= self._max_held:
                self._switch()
        elif before is LINK and message.sequence > self.last:
            self._next(message, inline_deadline_ns)
            held = self._held
            while held and (oldest := next(iter(held))) <= self.last:
                del held[oldest]
        elif before is Route.RECOVERING and self._linked and message.sequence > self.last:
            self._hold(message)
            self._recover()
        if self.route is not before or self.waits:
            self._route_changed()

    def from_zenoh(self, message: Message, inline_deadline_ns: int = NOT_INLINE_NS) -> None:
        """Handle a message from Zenoh."""
        before = self.route
        self._progressed = True
        number = message.sequence
        if number > self.last:
            if before is LINK or before is Route.RECOVERING:
                self._hold(message)
                self._recover()
            else:
                self._next(message, inline_deadline_ns)
                if before is Route.BOTH and number >= self._base:
                    self._switch()
        if self.route is not before or self.waits:
            self._route_changed()

    def _reject(self, error: DecodeError) -> None:
        self._registry.drops.note(Drop.MALFORMED, self.reader.endpoint.name, str(error))
        self.reader.reject(error)

    def from_other_route(self, payload: Data, frame: Frame) -> None:
        """Handle what a link should have delivered, from its broken end or from a blocked loop."""
        if frame.kind not in (Kind.DATA, Kind.STOP):
            return
        try:
            msg = self._decode(payload)
        except DecodeError as error:
            self._reject(error)
            return
        if frame.kind == Kind.STOP:
            self._stop(Message(msg, frame.sequence, frame.source_ns, 0))
            return
        self._progressed = True
        if frame.sequence > self.last:
            if self.route is ZENOH:  # never opened here: what is older was sent over Zenoh
                self.route = Route.RECOVERING
                self._base = frame.sequence - 1
                self._owed = max(self._owed, 1)
            self._hold(Message(msg, frame.sequence, frame.source_ns, 0))
            self._recover()
        self._route_changed()

    def _stop(self, message: Message) -> None:
        """Handle the stop of a lease that bypassed the link: accept nothing older from now on."""
        if message.sequence <= self.last:
            return
        self._held = {n: held for n, held in self._held.items() if n > message.sequence}
        self._next(message)
        if self.route is Route.BOTH and self.last >= self._base:
            self._switch()
        self._recover()
        self._route_changed()

    # The state machine

    @property
    def waits(self) -> bool:
        """Whether messages are held until others have arrived."""
        return bool(self._held) and self.route in (Route.BOTH, Route.RECOVERING)

    def stop_waiting(self) -> None:
        """Deliver what is held: what has not arrived by now is lost."""
        self._finish()
        self._route_changed()

    def _switch(self) -> None:
        """Switch to the link, and first deliver what it has brought so far."""
        if self.route is Route.BOTH:
            self._finish()

    def _finish(self) -> None:
        """Deliver what is held, and continue with the link if there is one, else with Zenoh."""
        self._owed = 0
        if self.route is Route.BOTH or self.route is Route.RECOVERING:
            self._release()
            self.route = LINK if self._linked else ZENOH

    def _next(self, message: Message, inline_deadline_ns: int = NOT_INLINE_NS) -> None:
        self.last = message.sequence
        if self._keep_all and (self.full or not self.reader.has_room_itself()):
            self.full.append(message)
            self._wait_for_room()
        else:
            self._hand_over(message, inline_deadline_ns)

    def _hand_over(self, message: Message, inline_deadline_ns: int = NOT_INLINE_NS) -> None:
        self._deliver(
            message.msg,
            self.publisher,
            message.sequence,
            message.source_ns,
            inline_deadline_ns,
            message.arrived_ns,
        )

    def _hold(self, message: Message) -> None:
        self._held[message.sequence] = message
        if self.route is LINK and len(self._held) > MAX_HELD:
            # Only a copy: it also comes over the link, or is retransmitted if that ends.
            del self._held[next(iter(self._held))]
        elif len(self._held) > MAX_RECOVERING:
            self._finish()

    def _recover(self) -> None:
        if self.route is not Route.RECOVERING:
            return
        while self.last + 1 in self._held:
            self._next(self._held.pop(self.last + 1))
        if not self._owed and self.last >= self._base:
            if self._linked:  # what is held came over Zenoh, ahead of the link
                self.route = LINK
            else:
                self._finish()

    def _release(self) -> None:
        """Deliver everything that is held, in order."""
        held, self._held = self._held, {}
        for number in sorted(held):
            if number > self.last:
                self._next(held[number])

    # Effects of a decision

    def _route_changed(self) -> None:
        """Tell the publisher about the switch to the link, or wait for what is missing."""
        if self.route is LINK and self.connection is not None:
            self.connection.send(Switched(self.publisher, self.gid))
            self._confirm()
        elif self.waits:
            self._start_timer()

    def _start_timer(self) -> None:
        if self._timer_runs:
            return
        self._timer_runs = True
        self._progressed = False
        # Messages that a KEEP_ALL subscription waits for are certain to arrive, perhaps
        # retransmitted.
        patient = self._keep_all or self._gone or self.route is Route.RECOVERING
        self._registry.later(RECOVERY_S if patient else ZENOH_LATE_S, self._on_timer)

    def _on_timer(self) -> None:
        """Stop waiting if nothing has arrived since the timer was set."""
        self._timer_runs = False
        if (self._gone or self.waits) and self._progressed:
            self._start_timer()
            return
        if self.waits:
            self.stop_waiting()
        if self._gone and self.full:
            self._start_timer()
        elif self._gone:
            self.reader.forget(self)

    def _wait_for_room(self) -> None:
        if not self._waiting_for_room:
            self._waiting_for_room = True
            self.reader.when_room(self._on_room)

    def _on_room(self) -> None:
        self._waiting_for_room = False
        full = self.full
        while full and self.reader.has_room_itself():
            self._hand_over(full.popleft())
        if full:
            self._wait_for_room()
        else:
            self._confirm()

    def _confirm(self) -> None:
        """Confirm what was received, unless it is held or a KEEP_ALL queue has no room for it."""
        if self._used and self.connection is not None and not self.full:
            if self.route is not LINK and not self._gone:
                return
            used, self._used, self._used_bytes = self._used, 0, 0
            # Messages held when the publisher has gone are not requested again.
            last = max(self.last, *self._held) if self._gone and self._held else self.last
            self.connection.send(Credit(self.publisher, self.gid, used, last))


class LinkReader(ReaderRegistration):
    """A subscription that may receive from publishers over links.

    Zenoh delivers to this object instead of the subscription's own reader, so that what arrives
    over both routes is delivered once.

    Args:
        registry: The links of this context.
        msg_type: The type of the messages.
        reader: Receives the messages.

    Attributes:
        endpoint: The subscription.
        raw: Whether messages are delivered as CDR bytes.
        gid: The gid by which other processes know the subscription.
        remote_publishers: The publishers to which it was linked, by gid. Added when asked for over
            a link; kept when the link ends, and removed after the publisher has gone.
    """

    def __init__(self, registry: LinkRegistry, msg_type: type[Any], reader: Reader) -> None:
        self._reader = reader
        self.endpoint = reader.endpoint
        self.raw = reader.raw
        self.reject = reader.reject
        self.note_alive = reader.note_alive
        self.when_room = reader.when_room
        self.wait_for_room = reader.wait_for_room
        self.deliver_local = reader.deliver
        self.has_room_itself = reader.has_room
        self.gid = self.endpoint.gid
        self.remote_publishers: dict[bytes, RemotePublisher] = {}
        self._msg_type = msg_type
        self._registry = registry
        self._zenoh: Registration | None = None

    def attach(self, zenoh: Registration) -> None:
        """Set the subscription's registration with Zenoh, whose token determines the gid."""
        self._zenoh = zenoh
        # Others know it by its token, which may contain more than the graph does (`CPU_BACKEND`).
        self.gid = getattr(zenoh, "gid", self.gid)

    def decoder(self) -> Callable[[Data], Any]:
        """Return the function that decodes its messages."""
        if self.raw == "parts":
            return memory_or_bytes
        return bytes if self.raw else cdr.decoder(self._msg_type)

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Handle a message from Zenoh."""
        remote_publisher = self.remote_publishers.get(gid)
        if remote_publisher is None:
            self.deliver_local(msg, gid, sequence, source_ns, inline_deadline_ns, arrived_ns)
        else:
            message = Message(msg, sequence, source_ns, arrived_ns)
            remote_publisher.from_zenoh(message, inline_deadline_ns)

    @property
    def waiting(self) -> int:
        """The number of messages waiting in the subscription."""
        return self._reader.waiting

    def has_room(self) -> bool:
        """Whether a message can be accepted without losing one that must be kept."""
        return self.has_room_itself() and not any(
            remote_publisher.full for remote_publisher in self.remote_publishers.values()
        )

    def open(self, publisher: EndpointInfo, connection: Connection) -> None:
        """Ask for the messages of `publisher` over `connection`, unless already done."""
        if not can_link(publisher) or not self.endpoint.matches(publisher):
            return
        remote_publisher = self.remote_publishers.get(publisher.gid)
        if remote_publisher is None:
            remote_publisher = self.remote_publishers[publisher.gid] = RemotePublisher(
                self._registry, self, publisher
            )
        if remote_publisher.connection is None:
            remote_publisher.open(connection)

    def is_linked(self, publisher: bytes) -> bool | None:
        """Return whether a publisher sends over a link; None if it never did."""
        remote_publisher = self.remote_publishers.get(publisher)
        return None if remote_publisher is None else remote_publisher.is_linked

    def forget(self, remote_publisher: RemotePublisher) -> None:
        """Forget a destroyed publisher once none of its messages is on its way any more."""
        self.remote_publishers.pop(remote_publisher.publisher, None)

    def close(self) -> None:
        """Withdraw the subscription."""
        self._registry.remove(self.gid)
        if self._zenoh is not None:
            self._zenoh.close()
        for remote_publisher in self.remote_publishers.values():
            remote_publisher.close()
        self.remote_publishers.clear()


def memory_or_bytes(payload: Data) -> memoryview | bytes:
    """Return a payload without copying it."""
    return payload if isinstance(payload, memoryview) else bytes(payload)


def heard_from(
    readers: Iterable[LinkReader], participant: str
) -> dict[bytes, list[RemotePublisher]]:
    """Return the subscriptions' state for the publishers of a context, by their gids."""
    heard: dict[bytes, list[RemotePublisher]] = defaultdict(list)
    for reader in readers:
        for remote_publisher in reader.remote_publishers.values():
            if remote_publisher.participant == participant:
                heard[remote_publisher.publisher].append(remote_publisher)
    return heard
