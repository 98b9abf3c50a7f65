"""Limits on the tokens of other contexts that are kept: nodes, endpoints, links."""

from __future__ import annotations

import logging
from collections import Counter
from typing import TYPE_CHECKING, Final

from aionode.engine.transport.drops import Drop, Drops
from aionode.engine.transport.zenoh._defects.crowd import is_crowd

if TYPE_CHECKING:
    from collections.abc import Callable, Container

__all__ = ["AnnouncedLimit"]

logger = logging.getLogger("aionode.transport.zenoh")

TOKEN_BYTES: Final = 2_000
"""Approximate bytes that a token counts besides its text: the memory of an endpoint in the
graph."""

SHARE: Final = 8
"""One participant may use this fraction of the total (an eighth)."""

RESERVED_BYTES: Final = 256_000
"""Bytes reserved for each connected participant whatever others announce: 100 endpoints. A process
that fills the graph under invented names displaces no participant that is there."""


class AnnouncedLimit:
    """Limits how many liveliness tokens of others are kept, in total and per participant.

    Zenoh itself keeps all of them, and takes about 4 kB for each.

    Args:
        limit_bytes: The total limit; a token counts its text, and `TOKEN_BYTES`.
        connected: The participants that are connected now; others may be behind routers, or
            invented.
        drops: Counts ignored tokens.

    Attributes:
        left_out: Number of tokens ignored since the graph was last filled up; repeated ones count
            again.
        is_crowded: Whether there are so many that Zenoh may block for a moment.
        on_crowded: Called when that has changed.
    """

    def __init__(
        self, limit_bytes: int, connected: Container[str] = (), drops: Drops | None = None
    ) -> None:
        self.left_out = 0
        self.is_crowded = False
        self.on_crowded: list[Callable[[], None]] = []
        self._count = 0
        self._drops = Drops(logger) if drops is None else drops
        self._connected = connected
        self._limit_bytes = limit_bytes
        self._used_bytes = 0
        self._of: Counter[str] = Counter()  # by participant

    def admit(self, participant: str, key: str) -> bool:
        """Admit a token within the limits; return whether it was, and log the first refusal."""
        size_bytes = TOKEN_BYTES + len(key)
        own_bytes = self._of[participant] + size_bytes
        is_reserved = own_bytes <= RESERVED_BYTES and participant in self._connected
        fits = self._used_bytes + size_bytes <= self._limit_bytes
        if own_bytes > max(self._limit_bytes // SHARE, RESERVED_BYTES) or not (fits or is_reserved):
            self._leave_out(participant)
            return False
        self._of[participant] = own_bytes
        self._used_bytes += size_bytes
        self._count += 1
        self._judge()
        return True

    def has(self, participant: str) -> bool:
        """Return whether a token of a participant is kept."""
        return participant in self._of

    def release(self, participant: str, key: str) -> None:
        """Release a token that was admitted."""
        if participant not in self._of:  # everything was forgotten meanwhile
            return
        size_bytes = TOKEN_BYTES + len(key)
        self._used_bytes -= size_bytes
        self._of[participant] -= size_bytes
        if not self._of[participant]:
            del self._of[participant]
        self._count -= 1
        self._judge()

    def begin_to_fill(self) -> None:
        """Reset the count of ignored tokens, as everything is queried again."""
        self.left_out = 0
        self._judge()

    def clear(self) -> None:
        """Start over: nothing is kept any more."""
        self._used_bytes = self._count = 0
        self._of.clear()
        self._judge()

    def _judge(self) -> None:
        """Determine whether it is crowded."""
        is_crowded = is_crowd(self._count) or self.left_out > 0
        if is_crowded is not self.is_crowded:
            self.is_crowded = is_crowded
            for call in self.on_crowded:
                call()

    def _leave_out(self, participant: str) -> None:
        if not self._of[participant]:
            del self._of[participant]  # it was only queried
        self.left_out += 1
        self._judge()
        kept = (
            f"it keeps {self._limit_bytes / 2**20:.3g} MiB, about "
            f"{self._limit_bytes // (TOKEN_BYTES + 200)} endpoints, and an eighth of that from one "
            "process"
        )
        self._drops.note(Drop.GRAPH, "the graph", kept)
