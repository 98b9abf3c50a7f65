"""What a context drops or refuses of what others send: each kind has a count and a log message.

Drops due to a QoS queue depth are not included: subscriptions count them in their `stats`.
"""

from __future__ import annotations

import enum
import logging
from collections import Counter
from collections.abc import Callable
from typing import Final

from aionode._process.rated_lines import RatedLines
from aionode.clock import perf_ns
from aionode.errors import escaped

__all__ = ["Drop", "Drops"]

logger = logging.getLogger("aionode.transport")

SUBJECTS: Final = 1_000
"""Number of topics, services and keys counted individually: others may invent any."""

LIMIT: Final = "AIONODE_QUEUE_BYTES, or Context(queue_bytes=…), sets the limit"


class Drop(enum.Enum):
    """Why something was dropped or refused; the value is the log message."""

    MALFORMED = (
        "another process sent data in an unknown format: {}; it was dropped. Does the "
        "sender use another definition of the type?"
    )
    FALSE_NAME = (
        "a process impersonates another one: {}. Router access rules can prevent this: "
        "docs/howto/security.md"
    )
    BUSY_LOOP = (
        "messages were dropped before they reached the event loop, which was busy while more than "
        f"{{}} of them came; stats.lost counts them, too. {LIMIT}"
    )
    KEEP_ALL = (
        "messages are lost although the subscription is KEEP_ALL: {} are already waiting, and "
        f"their publisher cannot be held back. {LIMIT}"
    )
    REQUESTS = (
        "requests are refused, as more than {} of them are waiting in this process for its event "
        f"loop, or until their answers are sent. {LIMIT}"
    )
    GRAPH = (
        "nodes or endpoints announced by other processes are ignored, as the graph is full: {}. "
        "AIONODE_GRAPH_BYTES, or Context(graph_bytes=…), sets the limit"
    )
    BRIDGES = "there are more than {} namespaces of bridges; further bridges are ignored"
    NOT_SENT = "a message was not sent: {}"


class Drops:
    """Counts drops by kind and subject, and logs them at a limited rate (`RatedLines`).

    Any thread may call `note`: of two simultaneous calls one may not be counted, which is harmless.

    Args:
        log: The logger to use.
        now_ns: Returns the time of a steady clock, in nanoseconds.
    """

    def __init__(self, log: logging.Logger = logger, now_ns: Callable[[], int] = perf_ns) -> None:
        self._log = log
        self._lines: RatedLines[tuple[Drop, str]] = RatedLines(now_ns, len(Drop) * (SUBJECTS + 1))
        self._counts: dict[Drop, Counter[str]] = {drop: Counter() for drop in Drop}

    def note(self, drop: Drop, subject: str, detail: str = "", count: int = 1) -> None:
        """Count something, and log it unless the same was logged recently.

        Args:
            drop: Why it was dropped.
            subject: The topic, service or key.
            detail: Fills in the log message.
            count: Number of items dropped.
        """
        counts = self._counts[drop]
        if subject not in counts and len(counts) >= SUBJECTS:
            subject = "other names"
        counts[subject] += count
        more = self._lines.note((drop, subject), count)
        if more is not None:
            text = drop.value.format(escaped(detail))
            self._log.warning("%s: %s%s", escaped(subject), text, more)

    def of(self, drop: Drop) -> Counter[str]:
        """Return the number of drops for a reason, by subject."""
        return self._counts[drop]

    def totals(self) -> Counter[str]:
        """Return the number of drops by reason in lower case, omitting zeros."""
        return Counter(
            {drop.name.lower(): total for drop in Drop if (total := self.of(drop).total())}
        )
