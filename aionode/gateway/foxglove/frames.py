"""The frames of Foxglove's protocol, ``foxglove.sdk.v1``: ops in JSON, and binary frames.

Nothing here does input or output. All numbers are little endian.
"""

from __future__ import annotations

import base64
import struct
from typing import TYPE_CHECKING, Annotated, Any, Final, NamedTuple, TypeAlias

import msgspec

from aionode.errors import MessageError
from aionode.gateway.session.delivery.outbox import LongFrame, binary_frame
from aionode.gateway.session.encoding.client_json import check_parts
from aionode.parameter import Parameter, ParameterType

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = [
    "SUBPROTOCOLS",
    "Advertise",
    "Asked",
    "ClientChannel",
    "ClientMessage",
    "FoxgloveParameter",
    "GetParameters",
    "Op",
    "PlaybackRequest",
    "ServiceCall",
    "SetParameters",
    "Subscribe",
    "SubscribeConnectionGraph",
    "SubscribeParameterUpdates",
    "Unadvertise",
    "Unsubscribe",
    "UnsubscribeConnectionGraph",
    "UnsubscribeParameterUpdates",
    "binary_of",
    "message_frame",
    "op_frame",
    "op_of",
    "playback_frame",
    "response_frame",
    "shown_parameter",
    "time_frame",
]

SUBPROTOCOLS: Final = ("foxglove.sdk.v1", "foxglove.websocket.v1")
"""The names of the protocol: the older one is that of Lichtblick and @foxglove/ws-protocol."""

Id = Annotated[int, msgspec.Meta(ge=0, lt=1 << 32)]


# Ops of clients


class Op(msgspec.Struct, frozen=True, rename="camel", tag_field="op"):
    """An op of a client in JSON; unknown fields are ignored."""


class Wish(msgspec.Struct, frozen=True, rename="camel"):
    """The subscription to one channel."""

    id: Id
    channel_id: Id


class ClientChannel(msgspec.Struct, frozen=True, rename="camel"):
    """A topic on which the client will publish."""

    id: Id
    topic: str
    encoding: str
    schema_name: str


class FoxgloveParameter(msgspec.Struct, frozen=True):
    """A parameter, named by its node, a dot and its own name, such as ``/driver.speed``."""

    name: str
    value: Any = None
    type: str | None = None


class Subscribe(Op, frozen=True, tag="subscribe"):
    """Subscribe to these channels."""

    subscriptions: list[Wish]


class Unsubscribe(Op, frozen=True, tag="unsubscribe"):
    """Unsubscribe from them."""

    subscription_ids: list[Id]


class Advertise(Op, frozen=True, tag="advertise"):
    """Advertise topics that the client will publish."""

    channels: list[ClientChannel]


class Unadvertise(Op, frozen=True, tag="unadvertise"):
    """Stop advertising topics."""

    channel_ids: list[Id]


class GetParameters(Op, frozen=True, tag="getParameters"):
    """Request the values of these parameters; without names, of all."""

    parameter_names: list[str] = []
    id: str | None = None


class SetParameters(Op, frozen=True, tag="setParameters"):
    """Set new values; a parameter without a value is undeclared."""

    parameters: list[FoxgloveParameter]
    id: str | None = None


class SubscribeParameterUpdates(Op, frozen=True, tag="subscribeParameterUpdates"):
    """Request the values whenever they change."""

    parameter_names: list[str] = []


class UnsubscribeParameterUpdates(Op, frozen=True, tag="unsubscribeParameterUpdates"):
    """Stop requesting them."""

    parameter_names: list[str] = []


class SubscribeConnectionGraph(Op, frozen=True, tag="subscribeConnectionGraph"):
    """Request the nodes that publish, subscribe and serve."""


class UnsubscribeConnectionGraph(Op, frozen=True, tag="unsubscribeConnectionGraph"):
    """Stop requesting them."""


class FetchAsset(Op, frozen=True, tag="fetchAsset"):
    """A file, such as a mesh of ``package://``."""

    uri: str
    request_id: Id


ClientOp: TypeAlias = (
    Subscribe
    | Unsubscribe
    | Advertise
    | Unadvertise
    | GetParameters
    | SetParameters
    | SubscribeParameterUpdates
    | UnsubscribeParameterUpdates
    | SubscribeConnectionGraph
    | UnsubscribeConnectionGraph
    | FetchAsset
)
DECODER: Final = msgspec.json.Decoder(ClientOp)


def op_of(frame: str, max_parts: int) -> Op:
    """Return the op in a text frame.

    Raises:
        MessageError: the frame is not an op of a client.
    """
    try:
        octets = frame.encode()
        check_parts(octets, max_parts)
        op: Op = DECODER.decode(octets)
    except (msgspec.DecodeError, RecursionError, UnicodeError) as error:
        raise MessageError("frame", f"{error}") from None
    return op


def op_frame(op: str, fields: Mapping[str, Any]) -> str:
    """Return the text frame of an op of the server."""
    return msgspec.json.encode({"op": op, **fields}).decode()


# Binary frames of clients


class ClientMessage(NamedTuple):
    """A message published by a client."""

    channel_id: int
    data: memoryview


class ServiceCall(NamedTuple):
    """A request to a service."""

    service_id: int
    call_id: int
    encoding: str
    data: memoryview


class PlaybackRequest(NamedTuple):
    """A request to the player; without `seek_ns`, it continues where it is."""

    paused: bool
    rate: float
    seek_ns: int | None
    request_id: str


Asked: TypeAlias = Op | ClientMessage | ServiceCall | PlaybackRequest
"""A decoded frame of a client."""

MESSAGE: Final = struct.Struct("<BI")
CALL: Final = struct.Struct("<BIII")
PLAYBACK: Final = struct.Struct("<BBfBQI")


def binary_of(frame: bytes) -> ClientMessage | ServiceCall | PlaybackRequest:
    """Decode a binary frame of a client.

    Raises:
        MessageError: the frame is malformed.
    """
    opcode = frame[:1]
    try:
        if opcode == b"\x01":
            _, channel_id = MESSAGE.unpack_from(frame)
            return ClientMessage(channel_id, memoryview(frame)[MESSAGE.size :])
        if opcode == b"\x02":
            _, service_id, call_id, length = CALL.unpack_from(frame)
            encoding = text_at(frame, CALL.size, length)
            data = memoryview(frame)[CALL.size + length :]
            return ServiceCall(service_id, call_id, encoding, data)
        if opcode == b"\x03":
            _, command, rate, has_seek, seek_ns, length = PLAYBACK.unpack_from(frame)
            request_id = text_at(frame, PLAYBACK.size, length)
            return PlaybackRequest(bool(command), rate, seek_ns if has_seek else None, request_id)
    except struct.error as error:
        raise MessageError("frame", f"it has only {len(frame)} bytes: {error}") from None
    raise MessageError("frame", f"its opcode {opcode!r} is unknown")


def text_at(frame: bytes, start: int, length: int) -> str:
    """Return a text within a frame.

    Raises:
        MessageError: it is not UTF-8, or longer than the frame.
    """
    piece = frame[start : start + length]
    if len(piece) < length:
        raise MessageError("frame", f"its {len(frame)} bytes end within a text of {length} bytes")
    try:
        return piece.decode()
    except UnicodeDecodeError as error:
        raise MessageError("frame", f"{error}") from None


# Binary frames of the server


def message_frame(
    subscription_id: int, time_ns: int, data: bytes | memoryview
) -> bytes | LongFrame:
    """Return the frame of a message."""
    return binary_frame(struct.pack("<BIQ", 1, subscription_id, time_ns), data)


def time_frame(time_ns: int) -> bytes:
    """Return a frame with the time."""
    return struct.pack("<BQ", 2, time_ns)


def response_frame(call: ServiceCall, data: bytes) -> bytes:
    """Return the frame of a service's response, encoded like its request."""
    encoding = call.encoding.encode()
    head = struct.pack("<BIII", 3, call.service_id, call.call_id, len(encoding))
    return head + encoding + data


PLAYING, PAUSED, ENDED = 0, 1, 3


def asset_frame(request_id: int, data: bytes = b"", error: str = "") -> bytes | LongFrame:
    """Return the frame of a file, or of the reason why there is none."""
    text = error.encode()
    head = struct.pack("<BIBI", 4, request_id, bool(text), len(text))
    return binary_frame(head + text, data)


def playback_frame(
    status: int, time_ns: int, rate: float, *, did_seek: bool, request_id: str = ""
) -> bytes:
    """Return a frame with the state of a player."""
    answered = request_id.encode()
    return struct.pack("<BBQfBI", 5, status, time_ns, rate, did_seek, len(answered)) + answered


# Parameters


def shown_parameter(name: str, parameter: Parameter) -> dict[str, Any]:
    """Return a parameter in the form sent to clients; without a value if it is not set.

    Args:
        name: Its name for clients.
        parameter: The parameter of the node.
    """
    value, kind = parameter.value, parameter.type_
    if kind is ParameterType.NOT_SET:
        return {"name": name}
    if kind is ParameterType.BYTE_ARRAY:
        text = base64.b64encode(b"".join(value)).decode()
        return {"name": name, "value": text, "type": "byte_array"}
    hints = {ParameterType.DOUBLE: "float64", ParameterType.DOUBLE_ARRAY: "float64_array"}
    hint = {"type": hints[kind]} if kind in hints else {}
    return {"name": name, "value": value, **hint}
