"""Skips messages that expire before they can be sent over Zenoh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.engine.wire import _attachment as attachment

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["unless_expired"]


def unless_expired(
    extra: bytes, lifespan_ns: int, now_ns: Callable[[], int], send: Callable[[], None]
) -> Callable[[], None]:
    """Return a function that calls `send`, unless the message has expired by then.

    Only aionode readers check the age of what arrives.

    Args:
        extra: The attachment of the message, with its publication time.
        lifespan_ns: How long it is valid; 0 for no limit.
        now_ns: Returns nanoseconds since 1970.
        send: Sends the message.
    """
    fields = attachment.unpack_fields(extra)
    if not lifespan_ns or fields is None:
        return send
    expires_ns = fields[1] + lifespan_ns

    def send_if_fresh() -> None:
        if now_ns() < expires_ns:
            send()

    return send_if_fresh
