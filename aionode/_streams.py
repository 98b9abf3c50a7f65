"""Standard output and error, when nobody reads them or they cannot be written to."""

from __future__ import annotations

import os
import select
import signal
import sys
import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TextIO

__all__ = ["STANDARD", "UnreadWatch", "accepts", "discard", "interrupt_main", "open_missing"]

STANDARD = (1, 2)
"""The descriptors of standard output and error."""

LOOK_S = 0.05
"""How often the descriptors are looked at, in seconds."""

PATIENCE = 4
"""So many looks in a row have to find a descriptor full before it is given up."""


def accepts(descriptor: int) -> bool:
    """Whether writing to a descriptor would not block; True where that cannot be told."""
    if not hasattr(select, "poll"):
        return True
    looking = select.poll()
    looking.register(descriptor, select.POLLOUT)
    return bool(looking.poll(0))


def discard(stream: TextIO | int) -> None:
    """Send what is still written to a stream, or a descriptor, nowhere.

    What waits in its buffer goes there as well, so Python's own flush at the exit does not fail.
    """
    try:
        descriptor = stream if isinstance(stream, int) else stream.fileno()
    except (OSError, ValueError):  # it is no file, or was closed
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, descriptor)
    os.close(nowhere)


def open_missing() -> None:
    """Let the standard streams that were closed at the start lead nowhere.

    Without it the first sockets of the process would get their numbers, and Python has None for
    them.
    """
    for descriptor, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            nowhere = os.open(os.devnull, os.O_RDWR)
            if nowhere != descriptor:
                os.dup2(nowhere, descriptor)
                os.close(nowhere)
            setattr(sys, name, open(descriptor, "w" if descriptor else "r", encoding="utf-8"))  # noqa: PTH123, SIM115


class UnreadWatch:
    """Keeps a process that is asked to end from waiting for a reader of its output that is gone.

    A write to a full pipe, or a terminal that was stopped, holds up the whole event loop. After
    `start` a thread gives up a standard stream that has taken nothing for 0.2 s: what is still
    written to it is lost.

    Args:
        wake: Called, in that thread, to interrupt a write in the main thread, which then goes on
            to nowhere.
    """

    def __init__(self, wake: Callable[[], object]) -> None:
        self._wake = wake
        self._ended = threading.Event()
        self._waking = threading.Lock()  # a signal after `stop` would meet another handler

    def start(self) -> None:
        """Begin to look."""
        # Not waited for at the end: it does nothing but look.
        threading.Thread(target=self._look, name="aionode-unread", daemon=True).start()

    def stop(self) -> None:
        """Look no longer; `wake` is not called after this."""
        with self._waking:
            self._ended.set()

    def _look(self) -> None:
        full = dict.fromkeys(STANDARD, 0)
        while not self._ended.wait(LOOK_S):
            for descriptor in STANDARD:
                full[descriptor] = 0 if accepts(descriptor) else full[descriptor] + 1
                if full[descriptor] == PATIENCE:
                    self._give_up(descriptor)

    def _give_up(self, descriptor: int) -> None:
        with self._waking:
            if not self._ended.is_set():
                discard(descriptor)
                self._wake()


def interrupt_main(number: signal.Signals) -> None:
    """Send the main thread a signal, which ends the system call that it waits in."""
    main = threading.main_thread().ident
    if main is not None and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main, number)
