"""Counts and reports how long the loops of this process have waited for a processor."""

from __future__ import annotations

import logging
import os
from typing import Final

__all__ = ["WAITS", "ProcessorWaits"]

REPORT_NS: Final = 60_000_000_000
"""Minimum time between two reports, in nanoseconds."""

MUCH_NS: Final = REPORT_NS // 100
"""The sum of waits from which there is a report, in nanoseconds; less is only counted."""

logger = logging.getLogger("aionode.load")


class ProcessorWaits:
    """Counts callbacks that took long because their thread was ready to run but had no processor.

    Nothing in the program can cure that, so the log has at most one line a minute for the whole
    process, and none before the waits add up to a hundredth of a minute. `top` and `doctor` show
    all of them.

    Attributes:
        count: How many callbacks have waited for a processor for longer than their budget.
        total_ns: The sum of their waits.
        longest_ns: The longest of their waits.
    """

    def __init__(self) -> None:
        self.count = 0
        self.total_ns = 0
        self.longest_ns = 0
        self._reported_ns = -REPORT_NS
        self._reported = (0, 0)

    def note(self, waited_ns: int, now_ns: int) -> None:
        """Count one such callback, and report it if no report was within a minute.

        Args:
            waited_ns: How long its thread was ready without a processor.
            now_ns: The time.
        """
        self.count += 1
        self.total_ns += waited_ns
        self.longest_ns = max(self.longest_ns, waited_ns)
        if now_ns - self._reported_ns < REPORT_NS:
            return
        count, total_ns = self._reported
        since_ns = self.total_ns - total_ns
        if since_ns < MUCH_NS:
            return
        load = os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0
        cores = os.cpu_count() or 1
        self._reported, self._reported_ns = (self.count, self.total_ns), now_ns
        more = ", which is more than they can run at a time" if load > cores else ""
        logger.warning(
            "callbacks of this process wait for a processor: %d since the last such line, %.0f ms "
            "in all; the load is %.1f on %d cores%s",
            self.count - count,
            since_ns / 1e6,
            load,
            cores,
            more,
        )


WAITS: Final = ProcessorWaits()
"""The waits of this process."""
