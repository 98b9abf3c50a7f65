"""Content filters for messages that are delivered as bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.wire import cdr
from aionode.errors import DecodeError

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.message import Message

__all__ = ["decoding"]


def decoding(msg_type: type[Message], accepts: Callable[[Any], bool]) -> Callable[[Any], bool]:
    """Return a filter for messages that are delivered as CDR bytes."""
    decode = cdr.decoder(msg_type)

    def accepts_bytes(data: Any) -> bool:
        try:
            return accepts(decode(data))
        except DecodeError:
            return True  # raw subscriptions also get malformed messages

    return accepts_bytes
