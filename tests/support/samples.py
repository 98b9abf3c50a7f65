"""Golden values: messages that ROS 2 Jazzy and rosbags encoded, and the hashes of their types.

``rosidl_vectors.json`` comes from ROS 2 Jazzy's own rosidl and rclpy; ``vectors.json`` from rosbags
and mcap-ros2-support, which agree. Their `meta` entries say how they were made.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from aionode.message import DTYPES, FieldType, Message, Sequence, char, fields
from aionode.message import Array as ArrayOf
from tests.support.strategies import message_classes, shipped_types

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["Sample", "all_samples", "build", "rosidl_hashes", "type_of", "vectors"]

FOLDER = Path(__file__).parents[1].joinpath("vectors")


class Gid(Message, typename="rmw_dds_common/msg/Gid"):
    """An id of a DDS entity. Its package is not one that users send messages of."""

    data: ArrayOf[char, 16]


class NodeEntitiesInfo(Message, typename="rmw_dds_common/msg/NodeEntitiesInfo"):
    """The readers and writers of a node."""

    node_namespace: str
    node_name: str
    reader_gid_seq: Sequence[Gid]
    writer_gid_seq: Sequence[Gid]


class ParticipantEntitiesInfo(Message, typename="rmw_dds_common/msg/ParticipantEntitiesInfo"):
    """The nodes of a participant."""

    gid: Gid
    node_entities_info_seq: Sequence[NodeEntitiesInfo]


FURTHER = {
    "rmw_dds_common/msg/Gid": Gid,
    "rmw_dds_common/msg/NodeEntitiesInfo": NodeEntitiesInfo,
    "rmw_dds_common/msg/ParticipantEntitiesInfo": ParticipantEntitiesInfo,
}


@dataclass(frozen=True)
class Sample:
    """One message and its encoding.

    Attributes:
        name: ROS name of its type.
        message: The message.
        data: Its encoding by aionode.
        others: Encodings by other implementations, with arbitrary bytes as padding or at the end.
    """

    name: str
    message: Message
    data: bytes
    others: tuple[bytes, ...]


@cache
def vectors(name: str) -> Any:
    """Return one of the files."""
    return json.loads((FOLDER / f"{name}.json").read_text())


def rosidl_hashes() -> dict[str, str]:
    """Return the hashes that rosidl computed, by name of the type."""
    hashes: dict[str, str] = vectors("rosidl_vectors")["hashes"]
    return hashes


def type_of(name: str) -> Any:
    """Return the class of a ROS name."""
    services = {"SendGoal": "SendGoalService", "GetResult": "GetResultService"}
    action, _, part = name.rpartition("_")
    if part in services and action in shipped_types():
        return getattr(shipped_types()[action].Impl, services[part])
    return {**FURTHER, **shipped_types(), **message_classes()}[name]


def build(cls: type[Message], plain: dict[str, Any]) -> Message:
    """Return a message from the numbers, strings and lists of a file."""
    return cls(**{field.name: value(field.type, plain[field.name]) for field in fields(cls)})


def value(kind: FieldType, plain: Any) -> Any:
    """Return the value of one field."""
    if kind.form == "bytes":
        return bytes(plain)
    if kind.form == "ndarray":
        return np.array(plain, DTYPES[kind.kind])
    if kind.form == "list":
        return [value(kind.element, item) for item in plain]
    if kind.nested is not None:
        return build(kind.nested, plain)
    if kind.kind == "byte":
        return bytes([plain])
    return float(plain) if kind.kind.startswith("float") else plain


@cache
def all_samples() -> tuple[Sample, ...]:
    """Return every sample of both files."""
    return tuple(
        Sample(
            name=name,
            message=build(type_of(name), entry["value"]),
            data=bytes.fromhex(entry["cdr"]),
            others=tuple(bytes.fromhex(entry[key]) for key in ("cdr_fastcdr",) if key in entry),
        )
        for name, entry in entries()
    )


def entries() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield name and entry of everything in the files that has an encoding."""
    for name, several in vectors("rosidl_vectors")["samples"].items():
        for entry in several:
            yield name, entry
    parts = vectors("vectors")
    yield from parts["messages"].items()
    for name, service in parts["services"].items():
        for half in ("request", "response"):
            if half in service:
                yield f"{name}_{half.title()}", service[half]
    for name, action in parts["actions"].items():
        for part, entry in action.get("cdr", {}).items():
            yield f"{name}_{part}", entry
