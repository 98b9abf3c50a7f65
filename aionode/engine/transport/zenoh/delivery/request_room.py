"""Limits the bytes of requests from other contexts."""

from __future__ import annotations

import threading
from collections import Counter
from typing import Final

__all__ = ["RequestRoom"]

SHARE: Final = 3
"""A client may have this many times as much as is left: three quarters of the room if it is alone.
So there is always room for the first request of another client."""


class RequestRoom:
    """Tracks the requests to all services of a context, from their arrival to their end.

    A request is kept until its answer was sent, even if the client does not read answers. Zenoh's
    threads reserve room, and the thread that sends the answer releases it.

    Args:
        limit_bytes: Maximum number of bytes; a single request always fits.
    """

    def __init__(self, limit_bytes: int) -> None:
        self.limit_bytes = limit_bytes
        # Guards the next three. `_bytes` is always the sum of `_of`, and of `_requests`.
        self._lock = threading.Lock()
        self._bytes = 0
        self._of: Counter[str] = Counter()  # bytes, by client
        self._requests: dict[int, tuple[str, int]] = {}  # client and bytes, by id of the object

    def reserve(self, request: object, client: str, size_bytes: int) -> bool:
        """Reserve room for a request, if there is any; return whether there was.

        Args:
            request: The request, which must exist until its room is released.
            client: The client, as each has a share.
            size_bytes: Its size.
        """
        with self._lock:
            left_bytes = self.limit_bytes - self._bytes
            own_bytes = self._of.get(client, 0)
            if self._bytes and (
                size_bytes > left_bytes
                or (own_bytes and own_bytes + size_bytes > SHARE * left_bytes)
            ):
                return False
            self._bytes += size_bytes
            self._of[client] = own_bytes + size_bytes
            self._requests[id(request)] = client, size_bytes
        return True

    def release(self, request: object) -> None:
        """Release the room of a request that has ended."""
        with self._lock:
            client, size_bytes = self._requests.pop(id(request), ("", 0))
            self._bytes -= size_bytes
            self._of[client] -= size_bytes
            if not self._of[client]:
                del self._of[client]
