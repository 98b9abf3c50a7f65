"""Sends the frames of a WebSocket: framed once for all clients, and large ones in slices."""

from __future__ import annotations

import asyncio
import struct
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from aionode.gateway.session.delivery.outbox import LongFrame

if TYPE_CHECKING:
    from aionode.gateway.session.delivery.outbox import Frame

__all__ = ["Framing", "Outgoing"]

TEXT: Final = 0x81
BINARY: Final = 0x82
"""The first byte of a frame that is a whole message, of either kind (RFC 6455)."""

SLICE: Final = 256 << 10
"""Number of bytes of a large frame to pass to the transport at a time."""

SLICES_IN_A_TURN: Final = 4
"""Number of slices to send before yielding to the event loop: they take about half a
millisecond."""

MAX_CONTROL_BYTES: Final = 1 << 20
"""Bytes that may wait when a pong is added: a client may request many and read none."""


class Framing:
    """Puts WebSocket frame headers before messages.

    A server masks nothing, so a frame is the same for all clients, which get it one after another:
    the last one is cached.
    """

    def __init__(self) -> None:
        self._frame: Frame | None = None
        self._parts: tuple[bytes | memoryview, ...] = ()

    def parts(self, frame: Frame) -> tuple[bytes | memoryview, ...]:
        """Return the bytes to send: one part, or a header and the parts of a large payload."""
        if frame is not self._frame:
            self._parts = framed(frame)
            self._frame = frame
        return self._parts


def framed(frame: Frame) -> tuple[bytes | memoryview, ...]:
    """Return a WebSocket frame with its header, which is separate for a large payload."""
    if isinstance(frame, LongFrame):
        return (head(TEXT if frame.is_text else BINARY, len(frame)), *frame.pieces)
    first, payload = (TEXT, frame.encode()) if isinstance(frame, str) else (BINARY, frame)
    before = head(first, len(payload))
    return (before, payload) if len(payload) > SLICE else (before + payload,)


def head(first: int, size: int) -> bytes:
    """Return the header of a frame with a payload of this size."""
    if size < 126:
        return struct.pack(">BB", first, size)
    if size < 1 << 16:
        return struct.pack(">BBH", first, 126, size)
    return struct.pack(">BBQ", first, 127, size)


class Outgoing:
    """The sending side of a WebSocket; a large frame is sent in slices as its client reads.

    A transport copies what its socket does not take at once. Anything that the protocol sends
    meanwhile, such as the answer to a ping, follows the frame.

    Args:
        transport: The transport of the connection.
        writable: Set while the client has read enough of what was sent, and no frame is being sent.

    Attributes:
        on_abort: Called when the connection is closed because too many answers to pings wait.
    """

    def __init__(self, transport: asyncio.Transport, writable: asyncio.Event) -> None:
        self._transport = transport
        self._writable = writable
        self._is_paused = False
        self._rest: deque[bytes | memoryview] = deque()  # of the frame that is being sent
        self._after: list[bytes] = []
        self._after_bytes = 0
        self._turn: asyncio.Handle | None = None
        self.on_abort: Callable[[], object] = bool

    def send(self, parts: tuple[bytes | memoryview, ...]) -> None:
        """Send a frame, while `writable` is set."""
        self._transport.write(parts[0])
        if len(parts) > 1:
            self._writable.clear()
            self._rest.extend(parts[1:])
            self._go_on()

    def pause(self) -> None:
        """Pause sending until `resume`: the client has not read enough of what was sent."""
        self._is_paused = True
        self._writable.clear()

    def resume(self) -> None:
        """Continue with the frame that is being sent."""
        self._is_paused = False
        if not self._rest:
            self._writable.set()
        elif self._turn is None:
            # Not immediately: a transport whose connection breaks within this call would end twice.
            self._turn = asyncio.get_running_loop().call_soon(self._go_on)

    def _go_on(self) -> None:
        self._turn = None
        if self._transport.is_closing():
            self._rest.clear()
        for _ in range(SLICES_IN_A_TURN):
            if not self._rest or self._is_paused:
                break
            self._transport.write(self._slice())
        if not self._rest:
            self._finish()
        elif not self._is_paused:
            self._turn = asyncio.get_running_loop().call_soon(self._go_on)

    def _slice(self) -> bytes | memoryview:
        part = self._rest.popleft()
        if len(part) > SLICE:
            part = memoryview(part)
            self._rest.appendleft(part[SLICE:])
        return part[:SLICE]

    def _finish(self) -> None:
        """Send what has waited for the end of the frame."""
        after, self._after, self._after_bytes = self._after, [], 0
        if after:
            self._transport.write(b"".join(after))
        if not self._is_paused:
            self._writable.set()

    def _forget_turn(self) -> None:
        if self._turn is not None:
            self._turn.cancel()
            self._turn = None

    def write(self, data: bytes) -> None:
        """Write a control frame, after the frame that is being sent."""
        waiting = self._after_bytes + self._transport.get_write_buffer_size()
        if waiting > MAX_CONTROL_BYTES:
            self.on_abort()
            self.abort()
        elif not self._rest:
            self._transport.write(data)
        else:
            self._after.append(data)
            self._after_bytes += len(data)

    def close(self) -> None:
        """Close the connection when everything was sent."""
        self._forget_turn()
        if self._rest and not self._transport.is_closing():
            self._transport.write(b"".join(self._rest))
            self._rest.clear()
            self._finish()
        self._transport.close()

    def abort(self) -> None:
        """Close the connection immediately."""
        self._forget_turn()
        self._rest.clear()
        self._after.clear()
        self._transport.abort()
