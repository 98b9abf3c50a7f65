"""Signals the event loop from the middleware's threads: the callback is libc's ``eventfd_write``.

A Python function instead would deadlock: it needs the GIL while the middleware holds a lock for
which a publisher, which holds the GIL, is waiting.
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
"""More items than there ever are: take them until there are none."""


class Wake:
    """Calls `take` on the loop as many times as an entity has items.

    The middleware adds the number of new items to the eventfd. So there is no unnecessary call,
    which would cost as much as taking an item, and wait for the middleware's lock.

    Args:
        loop: The event loop.
        rcl: The functions of rcl.
        set_callback: Sets the callback of the entity; a function of rcl.
        pointer: The entity.
        take: Takes one item, given the `perf_ns` deadline for running callbacks inline; returns
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
        self._left = 0  # how many items there may be
        self._fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        loop.add_reader(self._fd, self._on_event)
        set_callback(pointer, rcl.notify, self._fd)
        self.again()  # for what arrived before the callback was set

    def again(self) -> None:
        """Take everything there is, from the next loop iteration on."""
        self._go_on(UNCOUNTED)

    def _on_event(self) -> None:
        try:
            left = self._left + os.eventfd_read(self._fd)
        except BlockingIOError:  # an earlier iteration consumed the event
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
        """Take this many more, from the next loop iteration on."""
        if self._fd >= 0:
            self._left += left - 1
            os.eventfd_write(self._fd, 1)  # counts as one

    def close(self) -> None:
        """Stop calling `take`. Must be called before the entity is destroyed."""
        fd, self._fd = self._fd, -1
        if fd < 0:
            return
        self._set_callback(
            self._pointer, None, None
        )  # first, so that nothing writes to a reused descriptor
        if not self._loop.is_closed():
            self._loop.remove_reader(fd)
        os.close(fd)
