"""Drops messages from a queue once they exceed their lifespan."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

__all__ = ["NEVER_NS", "ExpiringItems", "expires_ns"]

NEVER_NS: Final = 1 << 63
"""The expiry time of a message without a lifespan."""


def expires_ns(source_ns: int, arrived_ns: int, limit_ns: int) -> int:
    """Return when a message expires, in nanoseconds since 1970.

    Args:
        source_ns: When it was published, by its publisher's clock; 0 if unknown.
        arrived_ns: When it arrived.
        limit_ns: Its lifespan.
    """
    # A stamp in the future means that the clocks are not synchronized. DDS then uses the arrival
    # time, as one must without a stamp.
    return (source_ns if 0 < source_ns <= arrived_ns else arrived_ns) + limit_ns


class ExpiringItems(deque[tuple[int, Any]]):
    """The items of a message queue, each with its expiry time.

    Expired items are dropped before anything asks for the items or their number; a queue does so
    before it takes or adds one.

    Args:
        items: Items that are already queued, and do not expire.
        now_ns: Returns nanoseconds since 1970.
        on_expired: Called with the number of items that were dropped, if any.

    Attributes:
        next_expires_ns: The expiry time of the item to be appended next.
    """

    def __init__(
        self,
        items: Iterable[tuple[int, Any]],
        now_ns: Callable[[], int],
        on_expired: Callable[[int], None],
    ) -> None:
        super().__init__(items)
        self.next_expires_ns = NEVER_NS
        self._now_ns = now_ns
        self._on_expired = on_expired
        self._expires_ns = deque([NEVER_NS] * super().__len__())
        self._earliest_ns = NEVER_NS  # no item expires before this

    @property
    def earliest_ns(self) -> int:
        """When the first item expires, or earlier."""
        return self._earliest_ns

    def __bool__(self) -> bool:
        return len(self) > 0

    def __len__(self) -> int:
        if self._earliest_ns != NEVER_NS and self._now_ns() >= self._earliest_ns:
            self._drop_expired()
        return super().__len__()

    def append(self, item: tuple[int, Any]) -> None:
        """Add an item that expires at `next_expires_ns`."""
        super().append(item)
        self._expires_ns.append(self.next_expires_ns)
        self._earliest_ns = min(self._earliest_ns, self.next_expires_ns)

    def popleft(self) -> tuple[int, Any]:
        """Remove and return the oldest item."""
        self._expires_ns.popleft()
        return super().popleft()

    def clear(self) -> None:
        """Remove all items."""
        super().clear()
        self._expires_ns.clear()

    def _drop_expired(self) -> None:
        now_ns = self._now_ns()
        kept = [
            (item, expires_ns)
            for item, expires_ns in zip(self, self._expires_ns, strict=True)
            if expires_ns > now_ns
        ]
        dropped = super().__len__() - len(kept)
        super().clear()
        super().extend(item for item, _ in kept)
        self._expires_ns = deque(expires_ns for _, expires_ns in kept)
        self._earliest_ns = min(self._expires_ns, default=NEVER_NS)
        if dropped:
            self._on_expired(dropped)
