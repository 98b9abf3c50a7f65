"""Counts messages with a text that is no Unicode, such as Latin-1 from C++, and logs some of them.

Whatever decodes a message reads it with U+FFFD instead, so the count is that of the process.
"""

from __future__ import annotations

import logging
from collections import Counter
from typing import Final

from aionode._process.rated_lines import RatedLines
from aionode.clock import perf_ns

__all__ = ["REPLACED_TEXTS", "ReplacedTexts"]

logger = logging.getLogger("aionode.wire")

TYPES: Final = 1_000
"""Of so many types each is counted by itself: recordings and other nodes may define any."""

SHOWN: Final = 40
"""Bytes of a text that the log shows."""


class ReplacedTexts:
    """Counts them by their type, and logs those of each type as `RatedLines` says.

    Any thread may note one: of two at the same moment one may not be counted, which does no harm.
    """

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._lines: RatedLines[str] = RatedLines(perf_ns, TYPES + 1)

    def total(self) -> int:
        """Return how many messages of all types there were."""
        return self._counts.total()

    def note(self, type_name: str, path: str, data: bytes) -> None:
        """Count a message.

        Args:
            type_name: Its type.
            path: Where its first such text is, such as `.status[0].name`.
            data: That text as it came.
        """
        if type_name not in self._counts and len(self._counts) >= TYPES:
            type_name = "other types"
        self._counts[type_name] += 1
        more = self._lines.note(type_name)
        if more is not None:
            logger.warning(
                "%s%s: a text is no Unicode: %r; what is wrong in it was replaced by U+FFFD. "
                "Strings of ROS 2 are UTF-8: does the sender write Latin-1?%s",
                *(type_name, path, data[:SHOWN], more),
            )


REPLACED_TEXTS: Final = ReplacedTexts()
