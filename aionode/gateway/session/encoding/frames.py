"""Frames of rosbridge: one message as JSON, CBOR, CDR in CBOR (cbor-raw) or a picture (png)."""

from __future__ import annotations

import base64
import math
import struct
import zlib
from collections.abc import Iterator, Sequence
from typing import Any, Final

import cbor2
import msgspec

from aionode._process.concurrency import run_in_thread
from aionode.gateway.session.delivery.outbox import LongFrame, binary_frame
from aionode.gateway.session.encoding.large_json import base64_in_turns
from aionode.gateway.session.encoding.values import cbor_values, json_of
from aionode.message import Message

__all__ = [
    "Fragmented",
    "cbor_frame",
    "cbor_raw_frame",
    "fragments",
    "json_frame",
    "long_json_frame",
    "op_frame",
    "png_frame",
    "png_frame_in_turns",
]

PNG_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"

LONG: Final = 0x5A
"""The first byte of a CBOR byte string whose length is given in the next four bytes."""


def op_frame(op: dict[str, Any]) -> str:
    """Return an op as JSON."""
    return msgspec.json.encode(op).decode()


def json_frame(topic: str, message: Message | bytes) -> str:
    """Return a message of a topic as JSON, from the message or its JSON."""
    values = message if isinstance(message, bytes) else json_of(message)
    # The message is copied only once: it may be an image.
    return b"".join((json_head(topic), values, b"}")).decode()


def long_json_frame(topic: str, pieces: Sequence[bytes]) -> LongFrame:
    """Return a message of a topic as JSON, from the pieces of its JSON."""
    return LongFrame((json_head(topic), *pieces, b"}"), is_text=True)


def json_head(topic: str) -> bytes:
    """Return the part of a JSON frame before the message."""
    return msgspec.json.encode({"op": "publish", "topic": topic})[:-1] + b',"msg":'


def cbor_frame(topic: str, message: Message) -> bytes:
    """Return a message of a topic as CBOR, with typed arrays."""
    return cbor2.dumps({"op": "publish", "topic": topic, "msg": cbor_values(message)})


def cbor_raw_frame(topic: str, data: bytes | memoryview, time_ns: int) -> bytes | LongFrame:
    """Return a CBOR frame with an encoded message of a topic, without decoding it.

    Args:
        topic: The name of the topic.
        data: The message in CDR with its header.
        time_ns: When it was received, in nanoseconds.
    """
    secs, nsecs = divmod(time_ns, 10**9)
    msg = {"secs": secs, "nsecs": nsecs, "bytes": b""}
    head = cbor2.dumps({"op": "publish", "topic": topic, "msg": msg})
    # The bytes are the last value of the frame, so everything before them is its header.
    return binary_frame(head[:-1] + struct.pack(">BI", LONG, len(data)), data)


def png_frame(text: str) -> str:
    """Return a frame of JSON compressed as a PNG, in base64."""
    return op_frame({"op": "png", "data": base64.b64encode(png_of(text)).decode()})


async def png_frame_in_turns(text: str) -> LongFrame:
    """Do the work of `png_frame` for long text, yielding to the event loop."""
    picture = await run_in_thread(png_of, text)
    parts = await base64_in_turns(memoryview(picture))
    return LongFrame((b'{"op":"png","data":"', *parts, b'"}'), is_text=True)


def png_of(text: str) -> bytes:
    """Return text as a PNG with three bytes in each pixel."""
    data = text.encode()
    width = max(math.isqrt(-(-len(data) // 3)), 1)
    stride = 3 * width
    height = -(-len(data) // stride)
    data = data.ljust(height * stride, b"\n")
    rows = b"".join(b"\0" + data[at : at + stride] for at in range(0, len(data), stride))
    return b"".join(
        (
            PNG_SIGNATURE,
            png_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
            png_chunk(b"IDAT", zlib.compress(rows)),
            png_chunk(b"IEND", b""),
        )
    )


def png_chunk(kind: bytes, data: bytes) -> bytes:
    """Return one part of a PNG file."""
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


class Fragmented(str):
    """A frame sent in fragments, as its client has requested; it waits as one.

    Attributes:
        size: The longest fragment, in characters.
        message_id: The id of the fragments.
    """

    __slots__ = ("message_id", "size")
    size: int
    message_id: str

    @classmethod
    def of(cls, frame: str, size: int, message_id: str) -> Fragmented:
        """Return a frame to be sent in fragments of a size."""
        fragmented = cls(frame)
        fragmented.size, fragmented.message_id = size, message_id
        return fragmented

    def parts(self) -> Iterator[str]:
        """Yield the fragments."""
        return fragments(self, self.size, self.message_id)


MAX_FRAGMENTS: Final = 1000
"""The most fragments of a frame, however small the client wants them."""


def fragments(frame: str, size: int, message_id: str) -> Iterator[str]:
    """Split a frame into parts of `size` characters, if it is longer."""
    size = max(size, -(-len(frame) // MAX_FRAGMENTS))
    if len(frame) <= size:
        yield frame
        return
    total = -(-len(frame) // size)
    for num in range(total):
        part = frame[num * size : (num + 1) * size]
        yield op_frame(
            {"op": "fragment", "id": message_id, "data": part, "num": num, "total": total}
        )
