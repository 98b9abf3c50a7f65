"""JSON of clients, and how much may be in it."""

from __future__ import annotations

import json
import reprlib
from typing import Any, Final

import msgspec

from aionode.errors import MessageError

__all__ = ["check_items", "check_parts", "decoded", "is_large", "shown", "type_text"]

VALUES_PER_PART: Final = 10
"""As many times more values than objects and lists: to read a million takes some 50 ms."""

MOST_ITEMS: Final = 10_000
"""Items that the value of a parameter may have."""

LARGE_ITEMS: Final = 1_000
"""Beyond so many values, what is made of them is made in a thread: each takes some microseconds."""

LARGE_BYTES: Final = 64 << 10
"""The limit for a message in CDR, which is decoded faster."""


def decoded(text: str | bytes | memoryview, most_parts: int, what: str = "frame") -> Any:
    """Return the value of JSON.

    Python's json module also writes NaN and Infinity, which JSON has not.

    Args:
        text: The JSON.
        most_parts: How many objects and lists it may have: an empty object of two characters may
            become a message of some kilobytes.
        what: The name of the data, for errors.

    Raises:
        MessageError: it is not JSON, is nested too deeply, or has too many parts.
    """
    octets = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else bytes(text)
    check_parts(octets, most_parts, what)
    try:
        return msgspec.json.decode(octets)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        return with_infinities(octets, what, error)


def check_parts(octets: bytes, most: int, what: str = "frame") -> None:
    """Refuse JSON with too many parts.

    Raises:
        MessageError: there are too many.
    """
    limit = "as frame_parts of the gateway's limits says"
    has_many = octets.count(b",") > VALUES_PER_PART * most
    if not has_many and brackets(octets) <= most:
        return
    plain = without_texts(octets)
    if (count := brackets(plain)) > most:
        raise MessageError(what, f"{count} objects and lists, at most {most} fit, {limit}")
    if (count := plain.count(b",")) > VALUES_PER_PART * most:
        problem = f"{count} values, at most {VALUES_PER_PART * most} fit, {limit}"
        raise MessageError(what, problem)


def brackets(octets: bytes) -> int:
    """Count the opening brackets."""
    return octets.count(b"{") + octets.count(b"[")


def without_texts(octets: bytes) -> bytes:
    """Return JSON without its strings, each of which is between two quotation marks."""
    plain = octets.replace(rb"\\", b"").replace(rb"\"", b"")
    return b"".join(plain.split(b'"')[::2])


def with_infinities(octets: bytes, what: str, error: Exception) -> object:
    """Return the values of JSON as Python's json module writes them."""
    try:
        if b"NaN" in octets or b"Infinity" in octets:
            values = json.loads(octets)
            msgspec.json.encode(values)  # halves of surrogate pairs raise, and huge numbers
            return values
    except (ValueError, OverflowError, RecursionError):
        pass  # the error of the first attempt is told
    raise MessageError(what, f"invalid JSON: {error}") from None


def check_items(value: object, what: str) -> None:
    """Refuse a value of a parameter that has too many items: each takes some microseconds.

    Raises:
        MessageError: there are too many.
    """
    if isinstance(value, list) and len(value) > MOST_ITEMS:
        raise MessageError(what[:200], f"{len(value)} items, at most {MOST_ITEMS} fit")


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
    """Return a value, shortened: it may be nested deeper than Python's repr can follow."""
    try:
        return reprlib.repr(value)
    except ValueError:  # Python writes no numbers of thousands of digits
        return "a huge number"


def type_text(name: str, kind: str) -> str:
    """Return the name of a type with its kind, which clients omit: ``std_msgs/String``.

    Args:
        name: The name that a client has sent.
        kind: ``msg``, ``srv`` or ``action``.
    """
    parts = name.split("/")
    return "/".join((parts[0], kind, parts[1])) if len(parts) == 2 else name
