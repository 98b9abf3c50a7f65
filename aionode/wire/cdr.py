"""Messages as bytes and back, in the encoding that ROS 2 nodes send each other (XCDR1).

The functions are generated when a type is first encoded or decoded: about a millisecond, once.
What they cannot take in their stride is done, or refused with the reason, by slower code.
"""

from __future__ import annotations

import copy
import struct
from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias, TypeVar

from aionode.errors import MessageError
from aionode.message import Message, fields, type_name
from aionode.message import snapshotter
from aionode.wire.decoding import generate_decoder
from aionode.wire.encoding import MISFITS, generate_encoder
from aionode.wire.plain import decode_plainly

__all__ = ["Data", "decode", "decoder", "encode", "encoder"]

MessageT = TypeVar("MessageT", bound=Message)

Data: TypeAlias = bytes | bytearray | memoryview
"""What may hold an encoded message."""


def encode(msg: Message) -> bytes:
    """Return a message as bytes: little endian, zeros as padding, nothing after the last field.

    Raises:
        MessageError: A value does not fit its field.
        TypeError: `msg` is not a message.
    """
    return ENCODERS[msg.__class__](msg)


def decode(msg_type: type[MessageT], data: Data) -> MessageT:
    """Return the message of this type in `data`; what follows it is not looked at.

    Arrays of numbers and sequences of bytes are read-only views of `data`: no copy is made, and
    `data` lives as long as they do. It must not change while they are in use.

    Raises:
        DecodeError: `data` holds no such message: it is cut, corrupted, or of another type.
        TypeError: `msg_type` is not a message class, or `data` not bytes-like.
    """
    message: MessageT = DECODERS[msg_type](data)
    return message


def encoder(cls: type[MessageT]) -> Callable[[MessageT], bytes]:
    """Return the function that encodes messages of one class, as `encode` does.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return ENCODERS[cls]


def decoder(cls: type[MessageT]) -> Callable[[Data], MessageT]:
    """Return the function that decodes messages of one class, as `decode` does.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return DECODERS[cls]


class Encoders(dict[Any, Callable[[Any], bytes]]):
    """The encoder of each class, made when it is first looked up."""

    def __missing__(self, cls: Any) -> Callable[[Any], bytes]:
        """Make the encoder of a class."""
        name = type_name(cls)
        fields(cls)  # tells a service from a message
        take = snapshotter(cls)

        def encode_unusual(msg: Any) -> bytes:
            taken = take(msg)
            try:
                return function(taken, True)
            except MISFITS:
                pass
            try:
                # Arrays with gaps between their elements, which a snapshot may share.
                return function(copy.deepcopy(taken), True)
            except struct.error as error:
                raise MessageError(name, f"does not fit into a message ({error})") from error

        function = self[cls] = generate_encoder(cls, encode_unusual)
        return function


class Decoders(dict[Any, Callable[[Any], Any]]):
    """The decoder of each class, made when it is first looked up."""

    def __missing__(self, cls: Any) -> Callable[[Any], Any]:
        """Make the decoder of a class."""
        fields(cls)  # tells a service from a message

        def decode_carefully(data: bytes) -> Any:
            return decode_plainly(cls, memoryview(data))

        def decode_other(data: Any) -> Any:
            return view_decoder(cls)(read_only(data))

        function = self[cls] = generate_decoder(cls, decode_carefully, decode_other)
        return function


ENCODERS = Encoders()
DECODERS = Decoders()


@cache
def view_decoder(cls: Any) -> Callable[[memoryview], Any]:
    """Return the decoder for what is not a bytes object."""

    def decode_carefully(data: memoryview) -> Any:
        return decode_plainly(cls, data)

    return generate_decoder(cls, decode_carefully)


def read_only(data: Any) -> memoryview:
    """Return the memory of `data`, as single bytes that cannot be changed through it."""
    view = memoryview(data)
    if not view.nbytes or not view.c_contiguous:
        view = memoryview(bytes(view))
    return view.cast("B").toreadonly()
