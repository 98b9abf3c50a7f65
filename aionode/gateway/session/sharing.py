"""Endpoints shared by clients: created for the first one, and destroyed a while after the last."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import S_TO_NS

if TYPE_CHECKING:
    from aionode.clock import Alarm, TimeBase

__all__ = ["Shared"]

LINGER_NS: Final = 10 * S_TO_NS
"""How long an endpoint stays without a user: a page that is reloaded finds it again."""

MAX_UNUSED: Final = 100
"""Number of endpoints that stay without a user: clients may use one name after another."""


class Shared:
    """Endpoints by their keys: name, type and profile.

    Args:
        time_base: Measures time.
        linger_ns: How long an unused endpoint stays, in nanoseconds.
    """

    def __init__(self, time_base: TimeBase, linger_ns: int = LINGER_NS) -> None:
        self._time_base = time_base
        self._linger_ns = linger_ns
        self._entities: dict[Hashable, Any] = {}
        self._users: dict[Hashable, int] = {}
        self._alarms: dict[Hashable, Alarm] = {}

    def __len__(self) -> int:
        """Return how many endpoints there are."""
        return len(self._entities)

    def take(self, key: Hashable, make: Callable[[], Any]) -> tuple[Any, Callable[[], None]]:
        """Return an endpoint, and a function that releases it.

        Args:
            key: Its name, type and profile: two that ask for the same get the same one.
            make: Makes it.
        """
        entity = self._entities.get(key)
        if entity is None or entity.destroyed:
            entity = self._entities[key] = make()
        alarm = self._alarms.pop(key, None)
        if alarm is not None:
            alarm.cancel()
        self._users[key] = self._users.get(key, 0) + 1
        given_back = False

        def give_back() -> None:
            nonlocal given_back
            if not given_back:
                given_back = True
                self._note_unused(key)

        return entity, give_back

    def _note_unused(self, key: Hashable) -> None:
        if key not in self._users:
            return
        self._users[key] -= 1
        if not self._users[key]:
            due_ns = self._time_base.steady_ns() + self._linger_ns
            self._alarms[key] = self._time_base.call_at(due_ns, lambda: self._destroy(key))
            if len(self._alarms) > MAX_UNUSED:
                self._destroy(next(iter(self._alarms)))

    def _destroy(self, key: Hashable) -> None:
        alarm = self._alarms.pop(key, None)
        if alarm is not None:
            alarm.cancel()
        self._users.pop(key, None)
        entity = self._entities.pop(key, None)
        if entity is not None:
            entity.destroy()

    def close(self) -> None:
        """Destroy all endpoints."""
        for key in list(self._entities):
            self._destroy(key)
