"""The handles that an executor checks."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from rclpy._impl.destroyable import Arrivals, Signal
from rclpy._taking import find_ready


class Handles:
    """A node with one subscription, whose readiness is given by a function."""

    def __init__(self, ready: Callable[[], bool]) -> None:
        self.messages = Arrivals(Signal())
        self.looks = 0
        self._ready = ready
        others = [Arrivals(Signal()) for _ in range(2)]
        self.node: Any = SimpleNamespace(
            _Node__waitables=[],
            _timers=[],
            _subscriptions=[SimpleNamespace(_handle=SimpleNamespace(ready=self._look))],
            _guards=[],
            _clients=[],
            _services=[],
            _Node__handle=SimpleNamespace(
                messages=self.messages, responses=others[0], requests=others[1]
            ),
        )

    def _look(self) -> bool:
        self.looks += 1
        return self._ready()

    def found(self) -> int:
        """Return how many callbacks are ready."""
        return len(find_ready([self.node], lambda _: True, None))


def test_subscriptions_are_looked_at_only_after_something_has_come() -> None:
    """Checking each handle is the most expensive part of a round."""
    handles = Handles(lambda: False)

    handles.found()
    assert handles.looks == 0
    handles.messages.note()
    handles.found()
    handles.found()

    assert handles.looks == 1


def test_a_subscription_is_looked_at_as_long_as_something_waits() -> None:
    """One call of a round takes one message; others may wait behind it."""
    waiting = [True, True, False]
    handles = Handles(lambda: waiting.pop(0))

    handles.messages.note()

    assert [handles.found() for _ in range(4)] == [1, 1, 0, 0]


def test_what_comes_during_a_look_is_found_by_the_next_one() -> None:
    """Another thread may fill a handle right after it was checked."""

    def too_late() -> bool:
        if handles.looks == 1:
            handles.messages.note()
            return False
        return True

    handles = Handles(too_late)
    handles.messages.note()

    assert [handles.found() for _ in range(2)] == [0, 1]
