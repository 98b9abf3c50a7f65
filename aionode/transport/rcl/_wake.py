"""From the middleware's threads to the event loop: its callback is libc's ``eventfd_write``.

A Python function in its place deadlocks: it wants the GIL while the middleware holds a lock that a
publisher, which holds the GIL, waits for.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from aionode._concurrency import SLICE_NS
from aionode.clock import perf_ns

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

__all__ = ["Wake"]


class Wake:
    """Calls `take` on the loop while it returns true, whenever an entity has something.

    Args:
        loop: The event loop.
        set_callback: Sets the callback of the entity: a function of rcl.
        pointer: The entity.
        notify: ``eventfd_write``.
        take: Takes one item, given until which `perf_ns` a callback may run at once; returns
            whether there may be more. Must not raise.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        set_callback: Callable[..., int],
        pointer: int,
        notify: Any,
        take: Callable[[int], bool],
    ) -> None:
        self._loop = loop
        self._set_callback = set_callback
        self._pointer = pointer
        self._take = take
        self._fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        loop.add_reader(self._fd, self._on_event)
        set_callback(pointer, notify, self._fd)
        self.again()  # what came before the callback was set

    def again(self) -> None:
        """Take on the next turn of the loop, although nothing new has come."""
        if self._fd >= 0:
            os.eventfd_write(self._fd, 1)

    def _on_event(self) -> None:
        try:
            os.eventfd_read(self._fd)
        except BlockingIOError:  # the event was taken by an earlier turn
            return
        ends_ns = perf_ns() + SLICE_NS
        take = self._take
        while take(ends_ns):
            if perf_ns() >= ends_ns:
                self.again()
                return

    def close(self) -> None:
        """Call `take` never again. To be called before the entity is destroyed."""
        fd, self._fd = self._fd, -1
        if fd < 0:
            return
        self._set_callback(self._pointer, None, None)  # first: nothing may write to a reused fd
        if not self._loop.is_closed():
            self._loop.remove_reader(fd)
        os.close(fd)
