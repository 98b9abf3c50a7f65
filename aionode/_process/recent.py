"""A bounded dict that evicts its oldest key."""

from __future__ import annotations

from typing import TypeVar

__all__ = ["Recent"]

K = TypeVar("K")
V = TypeVar("V")


class Recent(dict[K, V]):
    """A dict with a maximum number of keys: a new key evicts the oldest one.

    For keys that others choose, such as gids, addresses and ids. `put` adds a key; the value of an
    existing key may be set as in any dict, which is faster.

    Args:
        max_keys: The maximum number of keys.
    """

    __slots__ = ("_max_keys",)

    def __init__(self, max_keys: int) -> None:
        super().__init__()
        self._max_keys = max_keys

    def put(self, key: K, value: V) -> V | None:
        """Set the value of a key; return the value of the evicted key, if any."""
        forgotten = None
        if key not in self and len(self) >= self._max_keys:
            forgotten = self.pop(next(iter(self)), None)  # another thread may have removed it
        self[key] = value
        return forgotten
