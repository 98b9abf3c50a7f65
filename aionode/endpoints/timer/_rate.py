"""Rates, which pace a loop on a fixed grid of times."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.concurrency import checkpoint
from aionode.clock import S_TO_NS
from aionode.endpoints.core.entity import EndStage, Entity
from aionode.engine.rules.schedule import Ticker
from aionode.errors import brief

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.clock import Clock

__all__ = ["Rate"]


class Rate(Entity):
    """Paces a loop. Created by `Node.create_rate`.

    Use ``await rate.sleep()`` in the loop, or ``async for _ in rate``. Turns are on a grid that
    starts with the rate: the first comes one period after its creation. A loop that was too slow
    gets its next turn at once, and missed turns are skipped. Several tasks may wait for the same
    turn.

    Args:
        frequency: Turns per second.
        clock: The clock that measures the seconds.

    Raises:
        TypeError: `frequency` is not a number.
        ValueError: It is not positive, or not finite.
    """

    def __init__(self, frequency: float, clock: Clock) -> None:
        super().__init__(f"rate of {frequency} Hz", EndStage.LAST)
        self._ticker = Ticker(clock, to_rate_period_ns(frequency))

    def __repr__(self) -> str:
        schedule = self._ticker.schedule
        return f"<Rate {S_TO_NS / schedule.period_ns:g} Hz skipped={schedule.skipped}>"

    async def sleep(self) -> None:
        """Return at the next turn.

        Cancelling loses nothing.

        Raises:
            EntityDestroyedError: The rate was destroyed before or during the wait (a RuntimeError);
                its ``__cause__`` is the node's error, if it failed.
            asyncio.CancelledError: It was destroyed during the wait of one of the node's own tasks:
                a callback, or the body of ``async with node``.
        """
        self._refuse_if_destroyed("sleep")
        if not await self._next_turn():
            raise self._end_of_wait()

    def __aiter__(self) -> AsyncIterator[None]:
        """Yield None at each turn, until the rate is destroyed."""
        return self

    async def __anext__(self) -> None:
        """Return at the next turn; end the iteration when the rate is destroyed."""
        if self.destroyed or not await self._next_turn():
            raise StopAsyncIteration

    async def _next_turn(self) -> bool:
        """Return True at the next turn, or False when destroyed."""
        schedule = self._ticker.schedule
        turn = schedule.calls
        if self._ticker.is_ready():
            await checkpoint()  # even a loop that is always late must let others run
        while not self.destroyed:
            if schedule.calls != turn:
                return True  # another task woke first and took the turn for all
            now_ns = self._ticker.clock.now_ns()
            if schedule.is_ready(now_ns):
                schedule.call(now_ns)
                return True
            await self._ticker.wait()
        return False

    def _close(self) -> None:
        """End all sleeps."""
        self._ticker.close()


def to_rate_period_ns(frequency: float) -> int:
    """Return the period in nanoseconds."""
    if not isinstance(frequency, int | float):
        raise TypeError(f"rate: got {brief(frequency)}; a number of turns per second is needed")
    if not 0 < frequency < float("inf"):
        raise ValueError(f"rate: got {frequency} Hz; it must be finite, and more than 0")
    return max(1, round(S_TO_NS / frequency))
