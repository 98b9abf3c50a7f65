"""Counts messages with invalid Unicode, such as Latin-1 from C++, and logs some of them.

Any decoder replaces it by U+FFFD, so the count is for the whole process.
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
"""Number of types that are counted individually: recordings and peers may define any."""

SHOWN: Final = 40
"""Number of bytes of a text that the log shows."""


class ReplacedTexts:
    """Counts such messages by type, and logs each type at a limited rate (`RatedLines`).

    Any thread may call `note`: of two simultaneous calls one may not be counted, which is harmless.
    """

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._lines: RatedLines[str] = RatedLines(perf_ns, TYPES + 1)

    def total(self) -> int:
        """Return the number of such messages of all types."""
        return self._counts.total()

    def note(self, type_name: str, path: str, data: bytes) -> None:
        """Count a message.

        Args:
            type_name: Its type.
            path: Where the first such text is, such as `.status[0].name`.
            data: The text as received.
        """
        if type_name not in self._counts and len(self._counts) >= TYPES:
            type_name = "other types"
        self._counts[type_name] += 1
        more = self._lines.note(type_name)
        if more is not None:
            logger.warning(
                "%s%s: a string is not valid UTF-8: %r; the invalid parts were replaced by U+FFFD. "
                "ROS 2 strings are UTF-8: does the sender write Latin-1?%s",
                *(type_name, path, data[:SHOWN], more),
            )


REPLACED_TEXTS: Final = ReplacedTexts()
