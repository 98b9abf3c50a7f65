"""Warnings about other processes' announcements: a few in full, the rest as a count."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final

from aionode.logging import get_logger
from aionode.names import logger_name

if TYPE_CHECKING:
    from aionode.graph import NodeInfo

__all__ = ["PeerWarnings"]

EACH: Final = 10
"""Maximum number of warnings about one subject to log in full."""

ALL: Final = 100
"""Maximum total number of warnings to log in full."""


class PeerWarnings:
    """Logs warnings of one kind, of which other processes can cause any number.

    Warnings beyond the limits are counted; the count is logged when it reaches 1, 10, 100 and so
    on.

    Args:
        kind: What they are about, in the plural, such as ``endpoints that do not match``.
    """

    def __init__(self, kind: str) -> None:
        self._kind = kind
        self._logged: Counter[str] = Counter()  # by subject; at most `ALL` of them
        self._left_out = 0

    def warn(self, node: NodeInfo, subject: str, text: str) -> None:
        """Log a warning as `node`, unless there were too many of its kind."""
        logger = get_logger(logger_name(node.namespace, node.name))
        if self._logged[subject] < EACH and self._logged.total() < ALL:
            self._logged[subject] += 1
            logger.warning(text)
            return
        self._left_out += 1
        if str(self._left_out).strip("0") == "1":
            logger.warning(
                f"{self._left_out} more warnings about {self._kind} were left out, the last one "
                f"about {subject}; `aionode doctor` shows all"
            )
