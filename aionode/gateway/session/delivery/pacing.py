"""Limits the rate of messages to a client; the newest ones wait for their time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from aionode.gateway.session.delivery.waiting import Waiting

if TYPE_CHECKING:
    from aionode.clock import Alarm, TimeBase
    from aionode.gateway.session.feed import Received

__all__ = ["Pacing"]


class Pacing:
    """Delivers messages with a shortest time between them, the last of a burst too.

    Those that come earlier wait, the newest of them only: what was true last is always told.

    Args:
        time_base: Drives it.
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
        """Forget what waits."""
        self._waiting.clear()
        if self._alarm is not None:
            self._alarm.cancel()

    def _send(self, received: Received) -> None:
        self._due_ns = self._time_base.steady_ns() + self._period_ns
        self._deliver(received)

    def _watch(self) -> None:
        """Ring when the oldest message may leave."""
        if self._alarm is None and self._waiting:
            self._alarm = self._time_base.call_at(self._due_ns, self._ring)

    def _ring(self) -> None:
        self._alarm = None
        if self._waiting:
            self._send(self._waiting.take())
            self._watch()
