"""One publisher's messages for one other process: waiting, or sent but not confirmed."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Final

from aionode.engine.transport.link._connection import whole
from aionode.engine.transport.link._protocol import Kind
from aionode.errors import FrameError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._protocol import Credit
    from aionode.engine.transport.link._shared_memory import SharedBuffer

__all__ = ["DATA", "LinkSendQueue", "RemoteSubscription"]

MAX_READERS: Final = 1_000
"""Maximum number of subscriptions to one topic in a process."""

MAX_UNCONFIRMED: Final = 20_000
"""Maximum number of unconfirmed messages to keep: more than a subscription in a working process
ever leaves unconfirmed. Beyond it, the oldest are forgotten.
"""

DATA: Final = int(Kind.DATA)


class RemoteSubscription:
    """A subscription at the other end of a link, as seen by its publisher.

    Attributes:
        window: How many messages may be sent beyond what it has used; 0 for no limit.
        used: Number of messages it has used, counted like those that were sent.
        confirmed: Number of the last message it has confirmed.
        confirms: Whether it confirms messages at all.
        switched: Whether it accepts messages only from the link.
    """

    __slots__ = ("confirmed", "confirms", "switched", "used", "window")

    def __init__(self, window: int, used: int, confirmed: int, *, confirms: bool) -> None:
        self.window = window
        self.used = used
        self.confirms = confirms
        self.confirmed = confirmed
        self.switched = False


class LinkSendQueue:
    """Sends the messages of one publisher to the subscriptions of one other process.

    Messages wait here while the socket is full, or the window of a KEEP_ALL subscription is used
    up; a KEEP_LAST publisher drops the oldest beyond its depth. Sent messages are kept until they
    are confirmed.

    Args:
        gid: The publisher.
        name: The topic.
        connection: The link.
        depth: Maximum number of waiting messages.
        keep_all: Whether nothing may be dropped.

    Attributes:
        name: The topic.
        connection: The link.
        readers: The subscriptions by gid; updated by `Open` and `Close`.
        confirms: Whether any of them confirms messages.
        dropped: Number of messages dropped because the queue was full.
    """

    __slots__ = (
        "_depth",
        "_gid",
        "_keep_all",
        "_limited",
        "_sent",
        "_unconfirmed",
        "_waiting",
        "confirms",
        "connection",
        "dropped",
        "name",
        "readers",
    )

    def __init__(
        self, gid: bytes, name: str, connection: Connection, depth: int, *, keep_all: bool
    ) -> None:
        self.name = name
        self.connection = connection
        self.readers: dict[bytes, RemoteSubscription] = {}
        self.dropped = 0
        self.confirms = False
        self._gid = gid
        self._depth = depth
        self._keep_all = keep_all
        self._limited = False  # whether a subscription has a window
        self._sent = 0  # frames sent by `_pass`, for comparison with `used`
        # Number, frame, and the buffer with its payload: messages waiting for the socket or a
        # window, and messages that not every confirming subscription has confirmed.
        self._waiting: deque[tuple[int, bytes, SharedBuffer | None]] = deque()
        self._unconfirmed: deque[tuple[int, bytes, SharedBuffer | None]] = deque()

    # Subscriptions

    def add(self, gid: bytes, reader: RemoteSubscription) -> None:
        """Send to a subscription from now on.

        Raises:
            FrameError: the process has more than `MAX_READERS` of them.
        """
        if len(self.readers) >= MAX_READERS:
            raise FrameError(f"more than {MAX_READERS} subscriptions of one process to {self.name}")
        reader.used = self._sent
        self.readers[gid] = reader
        self.confirms = self.confirms or reader.confirms
        self._limited = self._limited or bool(reader.window)

    def remove(self, gid: bytes) -> None:
        """Stop sending to a subscription."""
        self.readers.pop(gid, None)
        self.confirms = any(reader.confirms for reader in self.readers.values())
        self._limited = any(reader.window for reader in self.readers.values())
        self._confirm()
        self.on_writable()

    def credit(self, credit: Credit) -> None:
        """Extend the window of a subscription, and forget what it has confirmed."""
        reader = self.readers.get(credit.subscription)
        if reader is None:
            return
        reader.used += credit.used
        reader.confirmed = credit.confirmed
        self._confirm()
        if self._waiting:
            self.on_writable()
        self.connection.wake()

    def _confirm(self) -> None:
        """Forget what every subscription has confirmed."""
        confirmed = min(
            (reader.confirmed for reader in self.readers.values() if reader.confirms),
            default=1 << 63,
        )
        unconfirmed = self._unconfirmed
        while unconfirmed and unconfirmed[0][0] <= confirmed:
            self._let_go(unconfirmed.popleft()[2])

    # Sending

    def send(self, sequence: int, data: bytes, buffer: SharedBuffer | None = None) -> None:
        """Send a frame after those that wait; immediately if none does."""
        if not (self._limited or self._waiting or buffer):  # `_pass` inlined: fewer calls
            if self.confirms:
                self._unconfirmed.append((sequence, data, None))
            if self.connection.write(data):
                if len(self._unconfirmed) > MAX_UNCONFIRMED:
                    self._let_go(self._unconfirmed.popleft()[2])
                return
            if self.confirms:
                self._unconfirmed.pop()
        if self._waiting or not self._pass(sequence, data, buffer):
            waiting = self._waiting
            if not self._keep_all and len(waiting) >= self._depth:
                self.dropped += 1
                self._let_go(waiting.popleft()[2])
            if buffer is not None:
                buffer.users += 1
            waiting.append((sequence, data, buffer))
            self.connection.when_writable(self)

    def send_stop(self, sequence: int, data: bytes, buffer: SharedBuffer | None) -> None:
        """Send the stop of a lease, dropping what waits."""
        while self._waiting:
            self.dropped += 1
            self._let_go(self._waiting.popleft()[2])
        self.send(sequence, data, buffer)

    def _pass(self, sequence: int, data: bytes, buffer: SharedBuffer | None) -> bool:
        """Pass a frame to the connection if it and every subscription's window permit."""
        if self._limited and not self._has_window():
            return False
        if buffer is not None:
            buffer.users += 1  # the receiver
        if self.confirms:
            if buffer is not None:
                buffer.users += 1
            # Before writing, which may find that the link is broken.
            self._unconfirmed.append((sequence, data, buffer))
        if not self.connection.write(data, buffer):
            self._let_go(buffer)
            if self.connection.closed:  # `unacked` has taken what is unconfirmed
                return True
            if self.confirms:
                self._unconfirmed.pop()
                self._let_go(buffer)
            return False
        self._sent += 1
        if len(self._unconfirmed) > MAX_UNCONFIRMED:
            self._let_go(self._unconfirmed.popleft()[2])
        return True

    def _let_go(self, buffer: SharedBuffer | None) -> None:
        if buffer is not None:
            self.connection.pool.release(buffer)

    def on_writable(self) -> None:
        """Send what waits, as far as the socket and the windows permit."""
        waiting = self._waiting
        while waiting and self._pass(*waiting[0]):
            self._let_go(waiting.popleft()[2])
        if waiting:
            self.connection.when_writable(self)

    def _has_window(self) -> bool:
        return all(
            not reader.window or self._sent - reader.used < reader.window
            for reader in self.readers.values()
        )

    def has_room(self) -> bool:
        """Whether another message can wait."""
        return len(self._waiting) < self._depth

    def is_done(self) -> bool:
        """Whether nothing waits here, or in the connection."""
        return not self._waiting and self.connection.idle

    def end(self, last: bytes) -> None:
        """Send what waits regardless of windows, and then a last frame."""
        self._limited = False
        self._keep_all = True
        self.send(0, last)
        self.on_writable()  # the queue may have waited for a window

    @property
    def waits(self) -> bool:
        """Whether a message waits here."""
        return bool(self._waiting)

    @property
    def unsent(self) -> int:
        """The number of messages that wait here, or are not completely written to the socket."""
        waiting = sum(sequence > 0 for sequence, _, _ in self._waiting)
        return waiting + self.connection.unsent(self._gid)

    @property
    def settled(self) -> bool:
        """Whether nothing waits, and nothing would have to be retransmitted if the link broke."""
        return not (self._waiting or self._unconfirmed)

    def drop(self) -> None:
        """Forget unconfirmed messages."""
        for entries in (self._unconfirmed, self._waiting):
            for _, _, buffer in entries:
                self._let_go(buffer)
            entries.clear()

    def unacked(self) -> Iterator[bytes]:
        """Yield unconfirmed messages as frames that include their payload, and forget them."""
        for entries in (self._unconfirmed, self._waiting):
            for _, data, buffer in entries:
                yield data if buffer is None else whole(data, buffer)
                self._let_go(buffer)
            entries.clear()
