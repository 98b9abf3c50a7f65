"""Encodes and decodes messages in ROS 2's encoding (XCDR1).

The functions are generated when a type is first encoded or decoded, which takes about a
millisecond. Slower code handles unusual values, and raises the errors. How a field is encoded:
`_encoder.py`.
"""

from __future__ import annotations

import copy
import struct
import sys
from collections.abc import Callable, Sequence
from functools import cache
from operator import attrgetter
from typing import Any, TypeAlias, TypeVar

from aionode.engine.wire.cdr._decoder import generate_decoder
from aionode.engine.wire.cdr._encoder import FALLBACK_ERRORS, JOIN, generate_encoder, views
from aionode.engine.wire.cdr._family import OWN, PLAIN, MessageFamily
from aionode.engine.wire.cdr._layout import has_buffers, has_views
from aionode.errors import MessageError
from aionode.message import Message, fields, snapshotter, type_name, unserialized

__all__ = [
    "PLAIN",
    "Data",
    "MessageFamily",
    "decode",
    "decode_request",
    "decoder",
    "encode",
    "encoder",
    "has_buffers",
    "has_views",
    "parts_encoder",
]

MessageT = TypeVar("MessageT", bound=Message)

Data: TypeAlias = bytes | bytearray | memoryview
"""Types that can hold an encoded message."""


def encode(msg: Message) -> bytes:
    """Return an encoded message: little-endian, zero padding, nothing after the last field.

    Raises:
        MessageError: a value does not fit its field.
        TypeError: `msg` is not a message.
    """
    try:
        function = ENCODERS[msg.__class__]
    except KeyError:
        function = ENCODERS[msg.__class__] = encoder(msg.__class__)
    return function(msg)


def decode(msg_type: type[MessageT], data: Data) -> MessageT:
    """Return the message of this type in `data`; bytes after it are ignored.

    Arrays of numbers and sequences of bytes are read-only views of `data`: they are not copied, and
    they keep `data` alive. It must not change while they are in use.

    Raises:
        DecodeError: `data` does not hold such a message: it is truncated, corrupt, or of another
            type.
        TypeError: `msg_type` is not a message class, or `data` is not bytes-like.
    """
    try:
        function = DECODERS[msg_type]
    except KeyError:
        function = DECODERS[msg_type] = decoder(msg_type)
    return function(data)  # type: ignore[no-any-return] # a message of this type


def decode_request(msg_type: type[MessageT], data: Data) -> MessageT:
    """Decode like `decode`, but with memoryviews in place of arrays if numpy is not loaded.

    Importing it takes longer than a callback may. It is loaded before an endpoint of such a type
    is created, except for a node's built-in services, which read either.
    """
    if "numpy" in sys.modules:
        return decode(msg_type, data)
    return decoder(msg_type, PLAIN)(data)


def encoder(cls: type[MessageT], family: MessageFamily = OWN) -> Callable[[MessageT], bytes]:
    """Return the function that encodes messages of one class, as `encode` does.

    Args:
        cls: An aionode message class.
        family: The family of the messages; aionode's own by default.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return encoder_of(cls, JOIN, family)


def parts_encoder(
    cls: type[MessageT], family: MessageFamily = OWN
) -> Callable[[MessageT], list[bytes | memoryview]]:
    """Return the function that encodes messages of one class into a list of parts.

    Joined, the parts are what `encode` returns. Large arrays and byte sequences of the message are
    read-only views of its own memory, as bytes: they are not copied and show the current content of
    the message, so use the parts before the message may change. This pays off for classes for which
    `has_views` is true; other classes have no such views.

    Args:
        cls: An aionode message class.
        family: The family of the messages; aionode's own by default.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return encoder_of(cls, views, family)


def decoder(cls: type[MessageT], family: MessageFamily = OWN) -> Callable[[Data], MessageT]:
    """Return the function that decodes messages of one class, as `decode` does.

    Args:
        cls: An aionode message class.
        family: The family of the messages; aionode's own by default.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return decoder_of(cls, family)


ENCODERS: dict[type[Message], Callable[[Any], bytes]] = {}
DECODERS: dict[type[Message], Callable[[Any], Any]] = {}
"""Functions that `encode` and `decode` have used: a dict is faster than the caches."""


@cache
def encoder_of(
    cls: Any, finish: Callable[[Sequence[Any]], Any], family: MessageFamily
) -> Callable[[Any], Any]:
    """Return the encoder of a class; the arguments are those of `generate_encoder`."""
    fields(cls)  # raises TypeError for a service class
    if unserialized(cls) is not cls:
        return attrgetter("data") if finish is JOIN else lambda msg: finish((msg.data,))
    if family is not OWN:
        own = encoder_of(cls, finish, OWN)
        return generate_encoder(cls, lambda msg: own(family.adopt(msg)), finish, family)
    take = snapshotter(cls)

    def encode_unusual(msg: Any) -> Any:
        taken = take(msg)
        try:
            return fast(taken, True)
        except struct.error as error:
            raise MessageError(type_name(cls), f"too large to encode ({error})") from None
        except FALLBACK_ERRORS:
            # Non-contiguous arrays, which a snapshot may share with the message.
            return fast(copy.deepcopy(taken), True)

    fast = generate_encoder(cls, encode_unusual, finish)
    return fast


@cache
def decoder_of(cls: Any, family: MessageFamily) -> Callable[[Any], Any]:
    """Return the decoder of a class that creates objects of `family`."""
    fields(cls)  # raises TypeError for a service class
    if unserialized(cls) is not cls:
        constructor: Callable[[Any], Any] = cls
        return constructor

    def decode_carefully(data: bytes) -> Any:
        from aionode.engine.wire.cdr._fallback_decoder import decode_slowly  # rarely needed

        return decode_slowly(cls, memoryview(data), family)

    def decode_other(data: Any) -> Any:
        return view_decoder(cls, family)(read_only(data))

    return generate_decoder(cls, decode_carefully, decode_other, family=family)


@cache
def view_decoder(cls: Any, family: MessageFamily) -> Callable[[memoryview], Any]:
    """Return the decoder of a class for data that is not a bytes object."""

    def decode_carefully(data: memoryview) -> Any:
        from aionode.engine.wire.cdr._fallback_decoder import decode_slowly  # rarely needed

        return decode_slowly(cls, data, family)

    return generate_decoder(cls, decode_carefully, family=family)


def read_only(data: Any) -> memoryview:
    """Return `data` as a read-only view of bytes."""
    view = memoryview(data)
    if not view.nbytes or not view.c_contiguous:
        view = memoryview(bytes(view))
    return view.cast("B").toreadonly()
