"""Writes JSON of large messages in slices, while the event loop runs in between.

JSON of an image of 6 MB takes some 20 ms. A thread would not help: writing JSON holds the GIL, so
the loop would wait for it after each socket that it reads.
"""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.concurrency import checkpoint
from aionode.gateway.session.encoding.values import ENCODER, numbered_value
from aionode.message import FieldType, Message, fields

if TYPE_CHECKING:
    from aionode.gateway.session.feed import Received

__all__ = ["base64_in_turns", "json_in_turns", "pieces_of", "prepare_json"]

OCTETS: Final = frozenset({"uint8", "char"})
"""Types of numbers whose arrays are Base64 text in JSON."""

HOLE: Final = b"\0"
"""A character that never occurs in JSON, where control characters are escaped."""

SLICE_BYTES: Final = 192 << 10
"""Bytes written between two loop iterations, in a quarter of a millisecond; divisible by three, so
that the pieces of base64 text can be joined."""

SLICE_ITEMS: Final = 4096
"""Numbers or messages of an array written between two loop iterations."""


async def prepare_json(received: Received) -> None:
    """Write the JSON of a large message, for `Received.once` with the key ``json``.

    Raises:
        DecodeError: the bytes are not a message of its type.
    """
    if not received.has("json"):
        data = b"".join(await pieces_of(received))
        received.once("json", lambda _: data)


async def pieces_of(received: Received) -> list[bytes]:
    """Return the JSON of a large message in pieces, written once for all clients.

    Raises:
        DecodeError: the bytes are not a message of its type.
    """
    if not received.has("json in pieces"):
        pieces = await json_in_turns(received.message)
        received.once("json in pieces", lambda _: pieces)
    return received.once("json in pieces", lambda _: [])


async def json_in_turns(message: Message) -> list[bytes]:
    """Return the JSON of a valid message in pieces, yielding to the event loop between them."""
    large = Large()
    values = await large.leave_out(message)
    around = ENCODER.encode(values).split(HOLE)
    pieces = [around[0]]
    for value, following in zip(large.values, around[1:], strict=True):
        pieces += [*value, following]
    return pieces


class Large:
    """The large values of a message, which are written first, in slices.

    Attributes:
        values: The JSON of each, in pieces.
    """

    def __init__(self) -> None:
        self.values: list[list[bytes]] = []

    async def leave_out(self, message: Message) -> dict[str, object]:
        """Return a message as a dict, with placeholders for the large values."""
        return {
            field.name: await self._value(field.type, getattr(message, field.name))
            for field in fields(type(message))
        }

    async def _value(self, type_: FieldType, value: Any) -> object:
        if type_.container == "single":
            if type_.nested is not None:
                return await self.leave_out(value)
            return numbered_value(type_, value)
        if type_.kind in OCTETS:
            self.values.append([b'"', *await base64_in_turns(memoryview(value)), b'"'])
        elif len(value) <= SLICE_ITEMS:
            return numbered_value(type_, value)
        else:
            self.values.append([b"[", *await items_in_turns(type_, value), b"]"])
        return msgspec.Raw(HOLE)


async def base64_in_turns(data: memoryview) -> list[bytes]:
    """Return base64 text in pieces."""
    parts = []
    for at in range(0, len(data), SLICE_BYTES):
        parts.append(base64.b64encode(data[at : at + SLICE_BYTES]))
        await checkpoint()
    return parts


async def items_in_turns(type_: FieldType, values: Any) -> list[bytes]:
    """Return the items of an array in JSON, separated by commas."""
    parts = []
    for at in range(0, len(values), SLICE_ITEMS):
        part = ENCODER.encode(numbered_value(type_, values[at : at + SLICE_ITEMS]))
        parts.append(part[1:-1] if not at else b"," + part[1:-1])
        await checkpoint()
    return parts
