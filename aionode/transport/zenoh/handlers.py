"""Small things around Zenoh's own calls."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import zenoh

from aionode.errors import TransportError

__all__ = ["direct", "reason", "translated"]

T = TypeVar("T")


def reason(error: zenoh.ZError) -> str:
    """Return what went wrong, without the place in Zenoh's own source."""
    return str(error).partition(" at /")[0]


@contextmanager
def translated(what: str) -> Iterator[None]:
    """Turn Zenoh's errors into ours, which say what was being done."""
    try:
        yield
    except zenoh.ZError as error:
        raise TransportError(f"{what}: {reason(error)}") from error


def direct(
    callback: Callable[[T], None], drop: Callable[[], None] | None = None
) -> zenoh.handlers.Callback[T]:
    """Return a handler that runs in Zenoh's network thread, for what comes seldom.

    It saves a thread for each entity and each call, and costs some latency where much comes.
    """
    return zenoh.handlers.Callback(callback, drop, indirect=False)
