"""Frames of a WebSocket are framed once for all clients, and large ones are sent in slices."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from websockets.frames import Frame as WebSocketFrame
from websockets.frames import Opcode

from aionode._process.concurrency import checkpoint
from aionode.gateway.server.outgoing import (
    MAX_CONTROL_BYTES,
    SLICE,
    SLICES_IN_A_TURN,
    Framing,
    Outgoing,
)
from aionode.gateway.session.delivery.outbox import LongFrame

LARGE = bytes(range(256)) * 16 * 1024  # 4 MiB


class Transport(asyncio.Transport):
    """Accepts what is written, and buffers it while told to."""

    def __init__(self) -> None:
        super().__init__()
        self.written: list[bytes] = []
        self.waiting = 0
        self.is_aborted = self.is_closed = False

    def write(self, data: Any) -> None:
        """Accept bytes."""
        self.written.append(bytes(data))

    def get_write_buffer_size(self) -> int:
        """Return the number of buffered bytes."""
        return self.waiting

    def is_closing(self) -> bool:
        """Return whether it is closed."""
        return self.is_closed or self.is_aborted

    def close(self) -> None:
        """Close it."""
        self.is_closed = True

    def abort(self) -> None:
        """Close it immediately."""
        self.is_aborted = True


class Connection:
    """A connection through which frames are sent."""

    def __init__(self) -> None:
        self.transport = Transport()
        self.writable = asyncio.Event()
        self.writable.set()
        self.outgoing = Outgoing(self.transport, self.writable)

    def send(self, frame: bytes | str) -> None:
        """Send a frame."""
        self.outgoing.send(Framing().parts(frame))

    @property
    def sent(self) -> bytes:
        """Everything sent so far."""
        return b"".join(self.transport.written)


@pytest.fixture
async def connection() -> Connection:
    """Return a connection."""
    return Connection()


def whole(frame: bytes | str) -> bytes:
    """Return a frame as created by another library."""
    is_text = isinstance(frame, str)
    payload = frame.encode() if isinstance(frame, str) else frame
    made = WebSocketFrame(Opcode.TEXT if is_text else Opcode.BINARY, payload)
    return bytes(made.serialize(mask=False))


@pytest.mark.parametrize("size", [0, 1, 125, 126, 65535, 65536, SLICE, SLICE + 1])
@pytest.mark.parametrize("kind", ["text", "bytes"])
def test_frames_are_those_of_the_protocol(size: int, kind: str) -> None:
    """Each length has its header."""
    frame = "x" * size if kind == "text" else b"x" * size

    assert b"".join(Framing().parts(frame)) == whole(frame)


def test_a_frame_is_made_once_for_all_clients() -> None:
    """Clients get one message after another; its text is encoded once."""
    framing, frame = Framing(), "x" * 1000

    assert framing.parts(frame) is framing.parts(frame)
    assert framing.parts("y") != framing.parts("z")


async def test_a_large_frame_leaves_in_slices_while_the_loop_turns(connection: Connection) -> None:
    """Nothing of it is copied, and other clients get their turns meanwhile."""
    connection.send(LARGE)
    before = len(connection.sent)
    await connection.writable.wait()

    assert before < SLICES_IN_A_TURN * SLICE + 20
    assert max(map(len, connection.transport.written)) == SLICE
    assert connection.sent == whole(LARGE)


async def test_no_more_is_sent_than_the_client_reads(connection: Connection) -> None:
    """Otherwise the transport would have to buffer all of it."""
    connection.outgoing.pause()
    connection.outgoing.send(Framing().parts(LARGE))
    await checkpoint()

    assert len(connection.sent) < 20
    assert not connection.writable.is_set()

    connection.outgoing.resume()
    await connection.writable.wait()

    assert connection.sent == whole(LARGE)


async def test_nothing_is_written_within_the_transports_own_call(connection: Connection) -> None:
    """Asyncio ends a connection twice if it breaks then, and logs a traceback."""
    connection.outgoing.pause()
    connection.send(LARGE)
    before = len(connection.sent)
    connection.outgoing.resume()

    assert len(connection.sent) == before


@pytest.mark.parametrize("is_text", [False, True])
async def test_a_long_frame_leaves_in_its_pieces(connection: Connection, is_text: bool) -> None:
    """They are not joined before."""
    pieces = [b"a" * 10, b"b" * (SLICE + 1), b"c" * 10]
    connection.outgoing.send(Framing().parts(LongFrame(pieces, is_text=is_text)))
    await connection.writable.wait()

    together = b"".join(pieces)
    assert connection.sent == whole(together.decode() if is_text else together)
    assert pieces[0] in connection.transport.written


async def test_pongs_leave_after_the_frame_that_is_leaving(connection: Connection) -> None:
    """Within a frame they would be part of the message."""
    connection.send(LARGE)
    connection.outgoing.write(b"pong")
    await connection.writable.wait()

    assert connection.sent == whole(LARGE) + b"pong"


async def test_a_client_that_reads_no_pongs_is_disconnected(connection: Connection) -> None:
    """Otherwise the gateway would have to buffer all of them."""
    connection.send(LARGE)
    for _ in range(MAX_CONTROL_BYTES // 100 + 2):
        connection.outgoing.write(b"x" * 100)

    assert connection.transport.is_aborted


async def test_a_frame_that_is_leaving_is_whole_when_the_connection_is_closed(
    connection: Connection,
) -> None:
    """The close frame follows it, as the protocol requires."""
    connection.send(LARGE)
    connection.outgoing.write(b"closing")
    connection.outgoing.close()
    await checkpoint()

    assert connection.sent == whole(LARGE) + b"closing"
    assert connection.transport.is_closed


async def test_nothing_leaves_into_a_connection_that_is_gone(connection: Connection) -> None:
    """The transport would log a warning."""
    connection.send(LARGE)
    connection.transport.abort()
    before = len(connection.sent)
    await checkpoint()

    assert len(connection.sent) == before
