"""Messages as bytes and back, in the encoding that ROS 2 nodes send each other (XCDR1).

The functions are generated when a type is first encoded or decoded: about a millisecond, once.
What they cannot take in their stride is done, or refused with the reason, by slower code.
"""

from __future__ import annotations

import copy
import struct
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, TypeAlias, TypeVar

from aionode.errors import MessageError
from aionode.message import Message, fields, snapshotter, type_name
from aionode.wire.cdr._decoder import generate_decoder
from aionode.wire.cdr._encoder import FALLBACK_ERRORS, JOIN, generate_encoder, views
from aionode.wire.cdr._fallback_decoder import decode_slowly
from aionode.wire.cdr._layout import has_views

__all__ = [
    "Data",
    "decode",
    "decoder",
    "encode",
    "encoder",
    "has_views",
    "parts_encoder",
]

MessageT = TypeVar("MessageT", bound=Message)
Encoded = TypeVar("Encoded")

Data: TypeAlias = bytes | bytearray | memoryview
"""What may hold an encoded message."""


def encode(msg: Message) -> bytes:
    """Return a message as bytes: little endian, zeros as padding, nothing after the last field.

    Raises:
        MessageError: A value does not fit its field.
        TypeError: `msg` is not a message.
    """
    try:
        function = ENCODERS[msg.__class__]
    except KeyError:
        function = encoder(msg.__class__)
    return function(msg)


def decode(msg_type: type[MessageT], data: Data) -> MessageT:
    """Return the message of this type in `data`; what follows it is not looked at.

    Arrays of numbers and sequences of bytes are read-only views of `data`: no copy is made, and
    `data` lives as long as they do. It must not change while they are in use.

    Raises:
        DecodeError: `data` holds no such message: it is cut, corrupted, or of another type.
        TypeError: `msg_type` is not a message class, or `data` not bytes-like.
    """
    try:
        function = DECODERS[msg_type]
    except KeyError:
        function = decoder(msg_type)
    return function(data)  # type: ignore[no-any-return] # of this type


def encoder(cls: type[MessageT]) -> Callable[[MessageT], bytes]:
    """Return the function that encodes messages of one class, as `encode` does.

    Raises:
        TypeError: `cls` is not a message class.
    """
    if cls not in ENCODERS:
        ENCODERS[cls] = new_encoder(cls, JOIN)
    return ENCODERS[cls]


def parts_encoder(cls: type[MessageT]) -> Callable[[MessageT], list[bytes | memoryview]]:
    """Return the function that encodes messages of one class into pieces, not yet put together.

    Put one after the other they are what `encode` returns. Large arrays and octets of the message
    are read-only views of its own memory, of single bytes: no copy is made, and they show what the
    message holds when they are read, not when it was encoded. Read them before the message may
    change. It is worth it for classes of which `has_views` is true; all others have no such pieces.

    Raises:
        TypeError: `cls` is not a message class.
    """
    if cls not in PARTS_ENCODERS:
        PARTS_ENCODERS[cls] = new_encoder(cls, views)
    return PARTS_ENCODERS[cls]


def decoder(cls: type[MessageT]) -> Callable[[Data], MessageT]:
    """Return the function that decodes messages of one class, as `decode` does.

    Raises:
        TypeError: `cls` is not a message class.
    """
    if cls not in DECODERS:
        DECODERS[cls] = new_decoder(cls)
    return DECODERS[cls]


ENCODERS: dict[type[Message], Callable[[Any], bytes]] = {}
PARTS_ENCODERS: dict[type[Message], Callable[[Any], list[bytes | memoryview]]] = {}
DECODERS: dict[type[Message], Callable[[Any], Any]] = {}


def new_encoder(
    cls: type[Message], finish: Callable[[Sequence[Any]], Encoded]
) -> Callable[[Any], Encoded]:
    """Return the encoder of a class, newly made; `finish` as for `generate_encoder`."""
    fields(cls)  # tells a service from a message
    take = snapshotter(cls)

    def encode_unusual(msg: Any) -> Encoded:
        taken = take(msg)
        try:
            return fast(taken, True)
        except struct.error as error:
            raise MessageError(type_name(cls), f"too large to be sent ({error})") from None
        except FALLBACK_ERRORS:
            # Arrays with gaps between their elements, which a snapshot may share.
            return fast(copy.deepcopy(taken), True)

    fast = generate_encoder(cls, encode_unusual, finish)
    return fast


def new_decoder(cls: type[Message]) -> Callable[[Any], Any]:
    """Return the decoder of a class, newly made."""
    fields(cls)  # tells a service from a message

    def decode_carefully(data: bytes) -> Any:
        return decode_slowly(cls, memoryview(data))

    def decode_other(data: Any) -> Any:
        return view_decoder(cls)(read_only(data))

    return generate_decoder(cls, decode_carefully, decode_other)


@cache
def view_decoder(cls: Any) -> Callable[[memoryview], Any]:
    """Return the decoder for what is not a bytes object."""

    def decode_carefully(data: memoryview) -> Any:
        return decode_slowly(cls, data)

    return generate_decoder(cls, decode_carefully)


def read_only(data: Any) -> memoryview:
    """Return the memory of `data`, as single bytes that cannot be changed through it."""
    view = memoryview(data)
    if not view.nbytes or not view.c_contiguous:
        view = memoryview(bytes(view))
    return view.cast("B").toreadonly()
