"""Large payloads for several subscriptions of one context, copied out of Zenoh's memory once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import zenoh

__all__ = ["SharedPayload", "SharedPayloads"]

SHARED_BYTES: Final = 1 << 16
"""Size from which a payload is kept for the other subscriptions, in bytes."""


class SharedPayload:
    """The last large payload of a key, until all subscriptions of the key have read it.

    Zenoh passes each message to every subscription, one right after the other. If one does not read
    it, it stays here until the next message: at most one payload for each key.

    Attributes:
        readers: The number of subscriptions.
    """

    __slots__ = ("_id", "_left", "_payload", "readers")

    def __init__(self) -> None:
        self.readers = 0
        self._id: tuple[bytes, int, int] | None = None
        self._payload = b""
        self._left = 0

    def bytes_of(self, message_id: tuple[bytes, int, int], payload: zenoh.ZBytes) -> bytes:
        """Return the bytes of a message.

        Args:
            message_id: Its publisher, its number and its time.
            payload: Its payload, which is only read if no other subscription has read it.
        """
        if message_id == self._id:
            found = self._payload
            self._left -= 1
            if not self._left:
                self.clear()
            return found
        found = payload.to_bytes()
        self.clear()
        if len(found) >= SHARED_BYTES:
            self._id, self._payload, self._left = message_id, found, self.readers - 1
        return found

    def clear(self) -> None:
        """Forget the payload."""
        self._id = None
        self._payload = b""


class SharedPayloads:
    """The shared payloads of a session, by key."""

    def __init__(self) -> None:
        self._by_key: dict[str, SharedPayload] = {}

    def join(self, key: str) -> SharedPayload:
        """Return what the subscriptions of a key share, with one more of them."""
        shared = self._by_key.setdefault(key, SharedPayload())
        shared.readers += 1
        return shared

    def leave(self, key: str) -> None:
        """Count one subscription less."""
        shared = self._by_key[key]
        shared.readers -= 1
        shared.clear()
        if not shared.readers:
            del self._by_key[key]
