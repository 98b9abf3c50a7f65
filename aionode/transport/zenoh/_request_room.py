"""How many bytes of requests from other contexts may be here at once."""

from __future__ import annotations

import threading

__all__ = ["RequestRoom"]


class RequestRoom:
    """Counts the requests to all services of a context, from their arrival to their end.

    A request is kept until its answer was sent, also where the client reads no answers. Threads of
    Zenoh take room, and whichever thread sends the answer gives it back.

    Args:
        limit_bytes: How many bytes they have at most; a single one always fits.
    """

    def __init__(self, limit_bytes: int) -> None:
        self.limit_bytes = limit_bytes
        self._lock = threading.Lock()
        self._bytes = 0

    def take(self, size_bytes: int) -> bool:
        """Return whether there is room for a request, and count it if so."""
        with self._lock:
            if self._bytes and self._bytes + size_bytes > self.limit_bytes:
                return False
            self._bytes += size_bytes
        return True

    def give_back(self, size_bytes: int) -> None:
        """Count a request no more: it has ended."""
        with self._lock:
            self._bytes -= size_bytes
