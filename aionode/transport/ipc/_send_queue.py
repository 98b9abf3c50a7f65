"""Messages from one publisher to one other process: waiting, sent, unacknowledged."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Final

from aionode.errors import FrameError
from aionode.transport.ipc._connection import whole
from aionode.transport.ipc._protocol import Kind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.transport.ipc._connection import Connection
    from aionode.transport.ipc._shared_memory import SharedBuffer

__all__ = ["DATA", "IpcSendQueue", "RemoteSubscription"]

MAX_READERS: Final = 1_000
"""How many subscriptions to one topic a process may have."""

MAX_UNCONFIRMED: Final = 20_000
"""How many messages are kept until they are confirmed; more than any reader has that confirms."""

DATA: Final = int(Kind.DATA)


class RemoteSubscription:
    """A subscription at the other end of a link, as its publisher sees it."""

    __slots__ = ("confirmed", "confirms", "switched", "used", "window")

    def __init__(self, window: int, used: int, confirmed: int, *, confirms: bool) -> None:
        self.window = window
        self.used = used
        self.confirms = confirms
        self.confirmed = confirmed
        self.switched = False


class IpcSendQueue:
    """The way from one publisher to the subscriptions of one other process.

    A message waits here while the socket is full, or a KEEP_ALL subscription has no window for it;
    the oldest is dropped if that may be. What was sent is kept until it is confirmed.

    Attributes:
        name: The topic.
        connection: The link.
        readers: The subscriptions, by gid.
        dropped: How many messages were dropped because others waited.
    """

    __slots__ = (
        "_depth",
        "_keep_all",
        "_limited",
        "_sent",
        "_unconfirmed",
        "_waiting",
        "confirmed",
        "connection",
        "dropped",
        "name",
        "readers",
    )

    def __init__(self, name: str, connection: Connection, depth: int, *, keep_all: bool) -> None:
        self.name = name
        self.connection = connection
        self.readers: dict[bytes, RemoteSubscription] = {}
        self.dropped = 0
        self.confirmed = False
        self._depth = depth
        self._keep_all = keep_all
        self._limited = False
        self._sent = 0
        # By number: the frame, and the memory that holds its payload.
        self._waiting: deque[tuple[int, bytes, SharedBuffer | None]] = deque()
        self._unconfirmed: deque[tuple[int, bytes, SharedBuffer | None]] = deque()

    # Who listens

    def add(self, gid: bytes, reader: RemoteSubscription) -> None:
        """Send to a reader from now on.

        Raises:
            FrameError: there are more of them than can be.
        """
        if len(self.readers) >= MAX_READERS:
            raise FrameError(f"more than {MAX_READERS} subscriptions of one process to {self.name}")
        reader.used = self._sent
        self.readers[gid] = reader
        self._note_readers()

    def remove(self, gid: bytes) -> None:
        """Send to a reader no longer."""
        self.readers.pop(gid, None)
        self._note_readers()
        self._confirm()
        self.on_writable()

    def _note_readers(self) -> None:
        self.confirmed = any(reader.confirms for reader in self.readers.values())
        self._limited = any(reader.window for reader in self.readers.values())

    def credit(self, gid: bytes, used: int, confirmed: int) -> None:
        """Note that a reader has used so many more messages, and has those up to a number."""
        reader = self.readers.get(gid)
        if reader is None:
            return
        reader.used += used
        reader.confirmed = confirmed
        self._confirm()
        if self._waiting:
            self.on_writable()
        self.connection.wake()

    def _confirm(self) -> None:
        """Forget what everybody has."""
        everybody = min(
            (reader.confirmed for reader in self.readers.values() if reader.confirms),
            default=1 << 63,
        )
        unconfirmed = self._unconfirmed
        while unconfirmed and unconfirmed[0][0] <= everybody:
            self._let_go(unconfirmed.popleft()[2])

    # What is sent

    def send(self, sequence: int, data: bytes, buffer: SharedBuffer | None = None) -> None:
        """Send a frame in its turn; without waiting where that is possible."""
        if not (self._limited or self._waiting or buffer):  # `_pass` in fewer calls
            if self.confirmed:
                self._unconfirmed.append((sequence, data, None))
            if self.connection.write(data):
                self._sent += 1
                if len(self._unconfirmed) > MAX_UNCONFIRMED:
                    self._let_go(self._unconfirmed.popleft()[2])
                return
            if self.confirmed:
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

    def _pass(self, sequence: int, data: bytes, buffer: SharedBuffer | None) -> bool:
        """Give a frame to the connection, if that and all readers can take it."""
        if self._limited and not self._has_window():
            return False
        if buffer is not None:
            buffer.users += 1  # of the receiver
        if self.confirmed:
            if buffer is not None:
                buffer.users += 1
            # First, as the link may turn out to be broken.
            self._unconfirmed.append((sequence, data, buffer))
        if not self.connection.write(data, buffer):
            self._let_go(buffer)
            if self.connection.closed:  # it has taken what is unconfirmed along
                return True
            if self.confirmed:
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
        """Send what waits, as far as the socket and the readers take it."""
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
        """Whether one more can wait."""
        return len(self._waiting) < self._depth

    def is_done(self) -> bool:
        """Whether nothing waits here, nor in the connection."""
        return not self._waiting and self.connection.idle

    def end(self, last: bytes) -> None:
        """Send what waits, whoever has a window for it, and then one last frame."""
        self._limited = False
        self._keep_all = True
        self.send(0, last)
        self.on_writable()  # a window may have been waited for, and no credit comes

    @property
    def waiting(self) -> int:
        """How many messages wait."""
        return sum(sequence > 0 for sequence, _, _ in self._waiting)

    @property
    def settled(self) -> bool:
        """Whether nothing waits, and nothing has to be sent again if the link breaks."""
        return not (self._waiting or self._unconfirmed)

    def drop(self) -> None:
        """Give up what is not known to have arrived."""
        for entries in (self._unconfirmed, self._waiting):
            for _, _, buffer in entries:
                self._let_go(buffer)
            entries.clear()

    def unacked(self) -> Iterator[bytes]:
        """Yield, as frames with everything in them, what is not known to have arrived."""
        for entries in (self._unconfirmed, self._waiting):
            for _, data, buffer in entries:
                yield data if buffer is None else whole(data, buffer)
                self._let_go(buffer)
            entries.clear()
