"""Wait sets: one thread waits for any of several handles."""

from __future__ import annotations

from functools import partialmethod
from typing import TYPE_CHECKING, Any

from aionode.clock import MachineTime
from rclpy._impl.destroyable import Destroyable, Wakeup

if TYPE_CHECKING:
    from rclpy._impl.context import ContextHandle

__all__ = ["WaitSet"]

KINDS = ("subscription", "guard_condition", "timer", "client", "service", "event")

steady_ns = MachineTime().steady_ns


class WaitSet(Destroyable):
    """Handles, and which of them were ready when the last wait ended.

    Args:
        num_subscriptions, num_guard_conditions, num_timers, num_clients, num_services, num_events:
            How many handles of each kind will be added; not needed here.
        context: The context, whose shutdown ends a wait.
    """

    def __init__(
        self,
        num_subscriptions: int,
        num_guard_conditions: int,
        num_timers: int,
        num_clients: int,
        num_services: int,
        num_events: int,
        context: ContextHandle,
    ) -> None:
        super().__init__()
        self._context = context
        self._handles: dict[str, list[Any]] = {kind: [] for kind in KINDS}
        self._ready: dict[str, list[Any]] = {kind: [] for kind in KINDS}

    def clear_entities(self) -> None:
        """Remove all handles."""
        for handles in self._handles.values():
            handles.clear()

    def _add(self, kind: str, handle: Any) -> int:
        """Add a handle; return its index among those of its kind."""
        self._handles[kind].append(handle)
        return len(self._handles[kind]) - 1

    add_subscription = partialmethod(_add, "subscription")
    add_guard_condition = partialmethod(_add, "guard_condition")
    add_timer = partialmethod(_add, "timer")
    add_client = partialmethod(_add, "client")
    add_service = partialmethod(_add, "service")
    add_event = partialmethod(_add, "event")

    def is_ready(self, kind: str, index: int) -> bool:
        """Return whether the handle with this index was ready when the last wait ended."""
        return self._handles[kind][index] in self._ready[kind]

    def get_ready_entities(self, kind: str) -> list[int]:
        """Return the pointers of the handles of a kind that were ready when the last wait ended."""
        return [handle.pointer for handle in self._ready[kind]]

    def may_be_ready(self) -> bool:
        """Return whether a handle is ready now."""
        return any(handle.ready() for handles in self._handles.values() for handle in handles)

    def look(self) -> bool:
        """Record which handles are ready now, and return whether any is."""
        for kind, handles in self._handles.items():
            self._ready[kind] = [handle for handle in handles if handle.ready()]
        for guard_condition in self._ready["guard_condition"]:
            guard_condition.take()
        return any(self._ready.values())

    def watch(self, wakeup: Wakeup) -> None:
        """Wake `wakeup` whenever a handle may have become ready, until `unwatch`."""
        for handles in self._handles.values():
            for handle in handles:
                handle.signal.add(wakeup)

    def unwatch(self, wakeup: Wakeup) -> None:
        """Undo `watch`."""
        for handles in self._handles.values():
            for handle in handles:
                handle.signal.remove(wakeup)

    def due_in_ns(self) -> int | None:
        """Return the time until the next timer, or None."""
        waits_ns = [timer.due_in_ns() for timer in self._handles["timer"]]
        return min((wait_ns for wait_ns in waits_ns if wait_ns is not None), default=None)

    def wait(self, timeout_nsec: int) -> None:
        """Wait until a handle is ready, the context is shut down, or the time has passed.

        Args:
            timeout_nsec: Maximum time to wait, in nanoseconds; negative for no limit.
        """
        wakeup = Wakeup()
        ends_ns = steady_ns() + timeout_nsec
        self._context.signal.add(wakeup)
        self.watch(wakeup)
        try:
            while not self.look() and self._context.ok():
                left_ns = None if timeout_nsec < 0 else ends_ns - steady_ns()
                if left_ns is not None and left_ns <= 0:
                    return
                due_ns = self.due_in_ns()
                waits_ns = [wait_ns for wait_ns in (left_ns, due_ns) if wait_ns is not None]
                wakeup.wait(max(0, min(waits_ns)) / 1e9 if waits_ns else None)
        finally:
            self.unwatch(wakeup)
            self._context.signal.remove(wakeup)
