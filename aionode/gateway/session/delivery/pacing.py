"""Limits the rate of messages to a client; of those that come too early, the newest wait."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from aionode.gateway.session.delivery.waiting import Waiting

if TYPE_CHECKING:
    from aionode.clock import Alarm, TimeBase
    from aionode.gateway.session.feed import Received

__all__ = ["Pacing"]


class Pacing:
    """Delivers messages with a minimum time between them, including the last of a burst.

    Messages that come earlier wait, but only the newest of them, so that the latest state is always
    delivered.

    Args:
        time_base: The source of time.
        period_ns: The shortest time between two messages, in nanoseconds.
        deliver: Called with each message when its time has come.
        depth: Maximum number of waiting messages.
    """

    def __init__(
        self,
        time_base: TimeBase,
        period_ns: int,
        deliver: Callable[[Received], None],
        depth: int,
    ) -> None:
        self._time_base = time_base
        self._period_ns = period_ns
        self._deliver = deliver
        self._waiting = Waiting(depth)
        self._due_ns = time_base.steady_ns()
        self._alarm: Alarm | None = None  # while messages wait

    def put(self, received: Received) -> None:
        """Deliver a message if its time has come, otherwise queue it; the oldest are dropped."""
        if self._alarm is None and self._time_base.steady_ns() >= self._due_ns:
            self._send(received)
            return
        self._waiting.put(received)
        self._watch()

    def close(self) -> None:
        """Forget the waiting messages."""
        self._waiting.clear()
        if self._alarm is not None:
            self._alarm.cancel()

    def _send(self, received: Received) -> None:
        self._due_ns = self._time_base.steady_ns() + self._period_ns
        self._deliver(received)

    def _watch(self) -> None:
        """Set an alarm for the time at which the oldest message may leave."""
        if self._alarm is None and self._waiting:
            self._alarm = self._time_base.call_at(self._due_ns, self._ring)

    def _ring(self) -> None:
        self._alarm = None
        if self._waiting:
            self._send(self._waiting.take())
            self._watch()
