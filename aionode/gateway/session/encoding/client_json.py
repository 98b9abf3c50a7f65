"""JSON from clients, and limits on its contents."""

from __future__ import annotations

import json
import reprlib
from typing import Any, Final

import msgspec

from aionode.errors import MessageError

__all__ = ["check_items", "check_parts", "decoded", "is_large", "shown", "type_text"]

VALUES_PER_PART: Final = 10
"""Allowed values per object or list: reading a million takes some 50 ms."""

MAX_ITEMS: Final = 10_000
"""Number of items that the value of a parameter may have."""

LARGE_ITEMS: Final = 1_000
"""Above this many values, messages are created in a thread: each value takes some microseconds."""

LARGE_BYTES: Final = 64 << 10
"""The limit for a message in CDR, which is decoded faster."""


def decoded(text: str | bytes | memoryview, max_parts: int, what: str = "frame") -> Any:
    """Return the value of JSON.

    Python's json module also accepts NaN and Infinity, which JSON does not have.

    Args:
        text: The JSON.
        max_parts: The most objects and lists that it may contain: an empty object of two
            characters may become a message of some kilobytes.
        what: The name of the data, for errors.

    Raises:
        MessageError: it is not JSON, is nested too deeply, or has too many parts.
    """
    octets = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else bytes(text)
    check_parts(octets, max_parts, what)
    try:
        return msgspec.json.decode(octets)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        return with_infinities(octets, what, error)


def check_parts(octets: bytes, max_parts: int, what: str = "frame") -> None:
    """Refuse JSON with too many parts.

    Raises:
        MessageError: there are too many.
    """
    limit = "by frame_parts in the gateway's limits"
    has_many = octets.count(b",") > VALUES_PER_PART * max_parts
    if not has_many and brackets(octets) <= max_parts:
        return
    plain = without_texts(octets)
    if (count := brackets(plain)) > max_parts:
        raise MessageError(
            what, f"{count} objects and lists, at most {max_parts} are allowed {limit}"
        )
    if (count := plain.count(b",")) > VALUES_PER_PART * max_parts:
        problem = f"{count} values, at most {VALUES_PER_PART * max_parts} are allowed {limit}"
        raise MessageError(what, problem)


def brackets(octets: bytes) -> int:
    """Count the opening brackets."""
    return octets.count(b"{") + octets.count(b"[")


def without_texts(octets: bytes) -> bytes:
    """Return JSON without its strings, which are enclosed in quotation marks."""
    plain = octets.replace(rb"\\", b"").replace(rb"\"", b"")
    return b"".join(plain.split(b'"')[::2])


def with_infinities(octets: bytes, what: str, error: Exception) -> object:
    """Return the values of JSON as written by Python's json module."""
    try:
        if b"NaN" in octets or b"Infinity" in octets:
            values = json.loads(octets)
            msgspec.json.encode(values)  # lone surrogates and huge numbers raise
            return values
    except (ValueError, OverflowError, RecursionError):
        pass  # report the error of the first attempt
    raise MessageError(what, f"invalid JSON: {error}") from None


def check_items(value: object, what: str) -> None:
    """Refuse a value of a parameter that has too many items: each takes some microseconds.

    Raises:
        MessageError: there are too many.
    """
    if isinstance(value, list) and len(value) > MAX_ITEMS:
        raise MessageError(what[:200], f"{len(value)} items, at most {MAX_ITEMS} are allowed")


def is_large(values: object) -> bool:
    """Return whether converting values, or their bytes, to a message takes long."""
    if isinstance(values, bytes | bytearray | memoryview):
        return len(values) > LARGE_BYTES
    waiting, count = [values], 0
    while waiting:
        value = waiting.pop()
        if not isinstance(value, dict | list):
            continue
        count += len(value)
        if count > LARGE_ITEMS:
            return True
        inner = value.values() if isinstance(value, dict) else value
        waiting.extend(item for item in inner if isinstance(item, dict | list))
    return False


def shown(value: object) -> str:
    """Return a value as shortened text: it may be nested deeper than Python's repr can follow."""
    try:
        return reprlib.repr(value)
    except ValueError:  # Python refuses to format numbers of thousands of digits
        return "a huge number"


def type_text(name: str, kind: str) -> str:
    """Return the name of a type including its kind, which clients omit, as in ``std_msgs/String``.

    Args:
        name: The name sent by a client.
        kind: ``msg``, ``srv`` or ``action``.
    """
    parts = name.split("/")
    return "/".join((parts[0], kind, parts[1])) if len(parts) == 2 else name
