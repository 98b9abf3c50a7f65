"""The fields of a rosbridge op, each of them checked."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import msgspec

from aionode.clock import Duration
from aionode.errors import MessageError
from aionode.gateway.session.encoding.client_json import decoded, shown
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

__all__ = [
    "FragmentStore",
    "full_name",
    "head_of",
    "id_of",
    "number",
    "op_of",
    "profile",
    "text",
    "values",
]

Op = dict[str, Any]

POLICIES: Final[dict[str, Mapping[str, Any]]] = {
    "history": {"keep_last": HistoryPolicy.KEEP_LAST, "keep_all": HistoryPolicy.KEEP_ALL},
    "reliability": {
        "reliable": ReliabilityPolicy.RELIABLE,
        "best_effort": ReliabilityPolicy.BEST_EFFORT,
        "best_available": ReliabilityPolicy.BEST_AVAILABLE,
    },
    "durability": {
        "transient_local": DurabilityPolicy.TRANSIENT_LOCAL,
        "volatile": DurabilityPolicy.VOLATILE,
        "best_available": DurabilityPolicy.BEST_AVAILABLE,
    },
}

MAX_NAME: Final = 1000
"""The longest name, id or word in an op, in characters: they are stored, and repeated in
answers."""

MAX_FRAGMENTS: Final = 10_000

OVERHEAD: Final = 20
"""Bytes that a fragment counts besides its content, since even empty ones take memory."""


def op_of(frame: str | bytes, max_parts: int) -> Op:
    """Parse the op in a frame, which is one JSON object.

    Raises:
        MessageError: the frame is anything else.
    """
    op = decoded(frame, max_parts)
    if not isinstance(op, dict):
        raise MessageError("frame", "not a JSON object, as every frame of rosbridge must be")
    if not isinstance(op.get("op"), str):
        raise MessageError("frame", "no text field 'op', which every frame of rosbridge must have")
    return op


def text(op: Op, name: str, default: str | None = None, max_length: int | None = MAX_NAME) -> str:
    """Return a field of text.

    Args:
        op: The op.
        name: The name of the field.
        default: The value of a missing field; None if the field is required.
        max_length: The longest text, in characters.

    Raises:
        MessageError: the field is missing without a default, is not text, or is too long.
    """
    value = op.get(name)
    if value is None and default is not None:
        return default
    if not isinstance(value, str):
        raise MessageError(f"{op['op']}.{name}", f"{given(op, name)}; use text")
    if max_length is not None and len(value) > max_length:
        raise MessageError(
            f"{op['op']}.{name}", f"{len(value)} characters, at most {max_length} are allowed"
        )
    return value


def optional_text(op: Op, name: str) -> str | None:
    """Return a field of text, or None if it is missing; see `text`."""
    return None if op.get(name) is None else text(op, name)


def id_of(op: Op) -> str | None:
    """Return the id of an op as JSON, or None without one; it may be any JSON value.

    Raises:
        MessageError: it is too long to be stored.
    """
    value = op.get("id")
    if value is None:
        return None
    try:
        told = msgspec.json.encode(value).decode()
    except OverflowError:  # a number of more than 64 bits
        told = json.dumps(value)
    if len(told) > MAX_NAME:
        problem = f"{len(told)} characters, at most {MAX_NAME} are allowed"
        raise MessageError(f"{op['op']}.id", problem)
    return told


class Head(msgspec.Struct):
    """The fields of an op needed for an answer."""

    op: str
    id: Any = None
    service: str = ""
    action: str = ""


def head_of(frame: str | bytes) -> Op | None:
    """Return the answer fields of a frame that is too large to decode; None if it has none."""
    try:
        head = msgspec.json.decode(frame, type=Head)
    except (msgspec.DecodeError, UnicodeError, RecursionError):
        return None
    return msgspec.structs.asdict(head)


def number(op: Op, name: str, default: float = 0) -> float:
    """Return a field that is a number of at least 0; for a missing or negative one, `default`.

    Raises:
        MessageError: the field is not a number.
    """
    value = op.get(name)
    if value is None:
        return default
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise MessageError(f"{op['op']}.{name}", f"{given(op, name)}; use a number")
    return min(value, 1e9) if value >= 0 else default  # NaN is neither


def values(op: Op, name: str) -> dict[str, Any] | list[Any]:
    """Return a field with the values of a message: a dict, or a list by position.

    Without the field all values are defaults, as in rosbridge. The same applies to ``args`` of
    null; but a message of null is sent by a page that has none, and must not move anything.

    Raises:
        MessageError: the field is something else.
    """
    value = op.get(name)
    if name not in op or (value is None and name == "args"):
        return {}
    if not isinstance(value, dict | list):
        raise MessageError(f"{op['op']}.{name}", f"{given(op, name)}; use an object or a list")
    return value


def given(op: Op, name: str) -> str:
    """Return the description of a field's value for an error."""
    if name not in op:
        return "missing"
    return f"{shown(op[name])} ({type(op[name]).__name__})"


def full_name(name: str) -> str:
    """Return the full name of a topic, service or action; clients omit its leading slash."""
    return name if name.startswith("/") else f"/{name}"


# QoS


def profile(op: Op, start: QoSProfile) -> QoSProfile | None:
    """Return `start` with the policies in an op's ``qos`` field; None if it has none.

    Raises:
        MessageError: a policy or its value is unknown.
    """
    asked = op.get("qos")
    if asked is None:
        return None
    path = f"{op['op']}.qos"
    if not isinstance(asked, Mapping):
        raise MessageError(path, f"{given(op, 'qos')}; use an object of policies")
    policies = {name: policy(name, value, f"{path}.{name}") for name, value in asked.items()}
    kept = {name: getattr(start, name) for name in ("history", "depth", "reliability")}
    kept["durability"] = start.durability
    return QoSProfile(**{**kept, **policies})


def policy(name: str, value: object, path: str) -> Any:
    """Return one policy of a profile."""
    if name in POLICIES:
        options = POLICIES[name]
        choice = options.get(value.lower()) if isinstance(value, str) else None
        if choice is None:
            raise MessageError(path, f"{shown(value)}; use one of {', '.join(options)}")
        return choice
    if name == "depth":
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= 10_000:
            raise MessageError(path, f"{shown(value)}; use a number of messages from 0 to 10000")
        return value
    if name in {"deadline", "lifespan"}:
        return duration(value, path)
    raise MessageError(
        path,
        "no such policy; use history, depth, reliability, durability, deadline or lifespan",
    )


def duration(value: object, path: str) -> Duration:
    """Return a duration, given in seconds, as secs and nsecs, or as a word."""
    if isinstance(value, str) and value.lower() in {"infinite", "best_available"}:
        return Duration()
    if isinstance(value, Mapping):
        secs, nsecs = value.get("secs", 0), value.get("nsecs", 0)
    else:
        secs, nsecs = value, 0
    for part in (secs, nsecs):
        if isinstance(part, bool) or not isinstance(part, int | float) or not 0 <= part <= 1e9:
            raise MessageError(path, f"{shown(value)}; use seconds, secs and nsecs, or 'infinite'")
    return Duration(nanoseconds=int(secs * 1e9) + int(nsecs))


# Fragments


class Part(NamedTuple):
    """A fragment, and the number of bytes that it counts for."""

    data: str
    size: int


class FragmentStore:
    """The fragments of one client's incomplete messages.

    Args:
        limit_bytes: The most bytes of incomplete messages that are kept; the largest message that a
            client may send.
    """

    def __init__(self, limit_bytes: int) -> None:
        self._limit = limit_bytes
        self._parts: dict[str, dict[int, Part]] = {}
        self._kept = 0

    def add(self, op: Op) -> str | None:
        """Keep a fragment; return the whole message if it is now complete.

        Raises:
            MessageError: the fragment is invalid, or too many bytes are kept; then all fragments
                are discarded.
        """
        message_id, data = text(op, "id"), text(op, "data", max_length=None)
        num, total = op.get("num"), op.get("total")
        if type(total) is not int or not 0 < total <= MAX_FRAGMENTS:
            raise MessageError("fragment.total", f"{given(op, 'total')}, at most {MAX_FRAGMENTS}")
        if type(num) is not int or not 0 <= num < total:
            raise MessageError("fragment.num", f"{given(op, 'num')}, use 0 to {total - 1}")
        size = len(data.encode()) + len(message_id) + OVERHEAD
        parts = self._parts.setdefault(message_id, {})
        self._kept += size - parts.get(num, Part("", 0)).size
        if self._kept > self._limit:
            self._parts.clear()
            self._kept = 0
            raise MessageError("fragment", f"incomplete messages exceed {self._limit} bytes")
        parts[num] = Part(data, size)
        if len(parts) < total:
            return None
        del self._parts[message_id]
        self._kept -= sum(part.size for part in parts.values())
        return "".join(parts[index].data for index in sorted(parts))
