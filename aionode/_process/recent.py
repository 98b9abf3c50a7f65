"""A dict that stays small: it forgets what came first."""

from __future__ import annotations

from typing import TypeVar

__all__ = ["Recent"]

K = TypeVar("K")
V = TypeVar("V")


class Recent(dict[K, V]):
    """A dict of at most so many keys: a new one takes the place of the one that came first.

    What others send can be any number of keys: gids, addresses, ids. `put` enters a key; a value
    of a key that is there may be set as in any dict, which is quicker.

    Args:
        most: The number of keys.
    """

    __slots__ = ("_most",)

    def __init__(self, most: int) -> None:
        super().__init__()
        self._most = most

    def put(self, key: K, value: V) -> V | None:
        """Set the value of a key, and return that of the key that is forgotten for it, if any."""
        forgotten = None
        if key not in self and len(self) >= self._most:
            forgotten = self.pop(next(iter(self)))
        self[key] = value
        return forgotten
