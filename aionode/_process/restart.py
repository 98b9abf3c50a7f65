"""Restart policies and delays."""

from __future__ import annotations

__all__ = ["Backoff", "doubled", "wants_another"]


class Backoff:
    """The delays between restarts, doubled with each failure in a row up to a limit.

    Args:
        min_delay_sec: The first delay, in seconds.
        max_delay_sec: The longest delay, in seconds; a run of at least this length resets the
            delay.
        subject: Who restarts, for errors.

    Raises:
        ValueError: the delays are negative or not in order.
    """

    def __init__(self, min_delay_sec: float, max_delay_sec: float, subject: str) -> None:
        if not 0 <= min_delay_sec <= max_delay_sec:
            raise ValueError(
                f"{subject}: min_delay_sec={min_delay_sec}, max_delay_sec={max_delay_sec}; the "
                "first delay must be at least 0 and at most the longest"
            )
        self._min_delay_sec = min_delay_sec
        self._max_delay_sec = max_delay_sec
        self.failed_in_a_row = 0

    def delay_after(self, ran_sec: float) -> float:
        """Count a failure, and return the delay before the next start, in seconds.

        Args:
            ran_sec: How long the last run took, in seconds; 0 if it did not start.
        """
        if ran_sec > 0 and ran_sec >= self._max_delay_sec:
            self.failed_in_a_row = 0
        delay = doubled(self._min_delay_sec, self.failed_in_a_row, self._max_delay_sec)
        self.failed_in_a_row += 1
        return delay


def doubled(first: float, failures: int, longest: float) -> float:
    """Return the delay after a number of failures, doubled with each up to a limit."""
    # The exponent is bounded, since 2.0**1024 would overflow after a week of failures.
    return min(longest, first * 2.0 ** min(failures, 64))


def wants_another(policy: str, *, failed: bool) -> bool:
    """Return whether a restart policy asks for another start."""
    return policy == "always" or (policy == "on-failure" and failed)
