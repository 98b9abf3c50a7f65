"""Standard output and error streams that nobody reads or that cannot be written."""

from __future__ import annotations

import _thread
import os
import select
import signal
import sys
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TextIO

__all__ = [
    "UnreadWatch",
    "accepts",
    "discard",
    "discard_lost",
    "interrupt_main",
    "open_missing",
    "standard",
]

CHECK_S = 0.01
"""Time between two checks of the descriptors, in seconds."""

FULL_CHECKS = 20
"""Consecutive checks that must find a descriptor full before it is discarded."""


def standard() -> set[int]:
    """Return the descriptors of standard output and error.

    One that was closed when the process started may since have become a file or socket of the
    program.
    """
    descriptors = set()
    for stream in (sys.__stdout__, sys.__stderr__):
        if stream is not None:
            with suppress(OSError, ValueError):  # closed or replaced meanwhile
                descriptors.add(stream.fileno())
    return descriptors


def accepts(descriptor: int) -> bool:
    """Return whether a write to a descriptor would not block; True if unknown."""
    if not hasattr(select, "poll"):
        return True
    poll = select.poll()
    poll.register(descriptor, select.POLLOUT)
    return bool(poll.poll(0))


def is_lost(descriptor: int) -> bool:
    """Return whether nobody can ever read what is written to a descriptor, so that writes fail.

    That is so for a pipe without a reader (EPIPE) and a closed terminal (EIO).
    """
    if not hasattr(select, "poll"):
        return False
    poll = select.poll()
    poll.register(descriptor, select.POLLOUT)
    return any(events & (select.POLLERR | select.POLLHUP) for _, events in poll.poll(0))


def discard_lost() -> None:
    """Redirect standard streams that nobody can read any more to the null device.

    Otherwise a print before a program's last message would raise, and the message would never be
    sent.
    """
    for descriptor in standard():
        if is_lost(descriptor):
            discard(descriptor)


def discard(stream: TextIO | int) -> None:
    """Redirect a stream or descriptor to the null device.

    Buffered text is lost too, so that Python's own flush at exit does not fail.
    """
    try:
        descriptor = stream if isinstance(stream, int) else stream.fileno()
    except (OSError, ValueError):  # not a file, or closed
        return
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, descriptor)
    os.close(null)


def open_missing() -> None:
    """Open the null device for standard streams that were closed when the process started.

    Otherwise the process's first sockets would get their descriptors; Python itself has None in
    place of such a stream.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            null = os.open(os.devnull, os.O_RDWR)
            if null != descriptor:
                os.dup2(null, descriptor)
                os.close(null)
            setattr(sys, name, open(descriptor, "w" if descriptor else "r", encoding="utf-8"))  # noqa: PTH123, SIM115


class UnreadWatch:
    """Keeps a process that is ending from blocking on output that nobody reads.

    A write to a full pipe or a stopped terminal blocks the whole event loop. After `start`, a
    thread redirects to the null device a standard stream that has accepted nothing for 0.2 s, and
    within 10 ms one that nobody can read any more; what is written to it is lost.

    Args:
        wake: Called in that thread to interrupt a blocked write in the main thread, which then
            succeeds.
    """

    def __init__(self, wake: Callable[[], object]) -> None:
        self._wake = wake
        self._ended = threading.Event()
        self._waking = threading.Lock()  # held while waking, so that no signal comes after `stop`

    def start(self) -> None:
        """Start checking; signal handlers may call this."""
        discard_lost()
        # `Thread.start` takes locks that the interrupted thread may hold. The process does not wait
        # for this thread at exit.
        with suppress(RuntimeError):  # the system is out of threads
            _thread.start_new_thread(self._check, ())

    def stop(self) -> None:
        """Stop checking; `wake` is not called after this."""
        with self._waking:
            self._ended.set()

    def _check(self) -> None:
        full = dict.fromkeys(standard(), 0)
        while not self._ended.wait(CHECK_S):
            discard_lost()
            for descriptor in full:
                full[descriptor] = 0 if accepts(descriptor) else full[descriptor] + 1
                if full[descriptor] == FULL_CHECKS:
                    self._discard(descriptor)

    def _discard(self, descriptor: int) -> None:
        with self._waking:
            if not self._ended.is_set():
                discard(descriptor)
                self._wake()


def interrupt_main(number: signal.Signals) -> None:
    """Send the main thread a signal, which interrupts a blocking system call."""
    main = threading.main_thread().ident
    if main is not None and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main, number)
