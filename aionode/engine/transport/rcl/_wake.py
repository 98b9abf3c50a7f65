"""From the middleware's threads to the event loop: its callback is libc's ``eventfd_write``.

A Python function in its place deadlocks: it wants the GIL while the middleware holds a lock that a
publisher, which holds the GIL, waits for.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Final

from aionode._process.concurrency import SLICE_NS
from aionode.clock import perf_ns

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.engine.transport.rcl._bindings import Rcl

__all__ = ["Wake"]

UNCOUNTED: Final = 2**32
"""More than there ever are: then it is taken until there is nothing."""


class Wake:
    """Calls `take` on the loop as many times as an entity has items.

    The middleware adds the number of new ones to the eventfd. So none is asked for in vain, which
    costs as much as taking one, and waits for the middleware's lock.

    Args:
        loop: The event loop.
        rcl: The functions of rcl.
        set_callback: Sets the callback of the entity: a function of rcl.
        pointer: The entity.
        take: Takes one item, given until which `perf_ns` a callback may run at once; returns
            whether there was one that could be taken. Must not raise.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        rcl: Rcl,
        set_callback: Callable[..., int],
        pointer: int,
        take: Callable[[int], bool],
    ) -> None:
        self._loop = loop
        self._rcl = rcl
        self._set_callback = set_callback
        self._pointer = pointer
        self._take = take
        self._left = 0  # how many there may be
        self._fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        loop.add_reader(self._fd, self._on_event)
        set_callback(pointer, rcl.notify, self._fd)
        self.again()  # what came before the callback was set

    def again(self) -> None:
        """Take everything there is from the next turn of the loop on."""
        self._go_on(UNCOUNTED)

    def _on_event(self) -> None:
        try:
            left = self._left + os.eventfd_read(self._fd)
        except BlockingIOError:  # the event was taken by an earlier turn
            return
        self._left = 0
        if not self._rcl.is_fast_dds:
            left = UNCOUNTED
        ends_ns = perf_ns() + SLICE_NS
        take = self._take
        while take(ends_ns):
            left -= 1
            if left <= 0:
                return
            if perf_ns() >= ends_ns:
                self._go_on(left)
                return

    def _go_on(self, left: int) -> None:
        """Take so many more from the next turn of the loop on."""
        if self._fd >= 0:
            self._left += left - 1
            os.eventfd_write(self._fd, 1)  # counts as one

    def close(self) -> None:
        """Call `take` never again. To be called before the entity is destroyed."""
        fd, self._fd = self._fd, -1
        if fd < 0:
            return
        self._set_callback(self._pointer, None, None)  # first: nothing may write to a reused fd
        if not self._loop.is_closed():
            self._loop.remove_reader(fd)
        os.close(fd)
