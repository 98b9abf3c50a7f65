"""Ctrl-Z in a program with open leases: their stops are sent before it is suspended."""

from __future__ import annotations

import signal
import threading
from typing import TYPE_CHECKING

from aionode._process.sudden_end import LastMessages, print_error

if TYPE_CHECKING:
    from types import FrameType

__all__ = ["SuspensionHandler", "suspension"]


class SuspensionHandler:
    """The handler of SIGTSTP, installed only while leases are open.

    It is installed only if SIGTSTP would suspend the process, and only for leases of an event loop
    in the main thread, where Python sets and calls handlers.
    """

    def __init__(self) -> None:
        self._messages: LastMessages | None = None

    def install(self) -> None:
        """Handle SIGTSTP from now on, as a lease is open; calling it again has no effect."""
        if is_main_thread() and signal.getsignal(signal.SIGTSTP) is signal.SIG_DFL:
            signal.signal(signal.SIGTSTP, self)

    def remove(self) -> None:
        """Stop handling SIGTSTP, as no lease is open."""
        if is_main_thread() and signal.getsignal(signal.SIGTSTP) is self:
            signal.signal(signal.SIGTSTP, signal.SIG_DFL)

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Send the stops and published messages, then suspend the process."""
        if self._messages is None:
            self._messages = LastMessages(number)
        if self._messages.send(frame):
            failure, self._messages = self._messages.failure, None
            print_error(failure)
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)  # returns when the process continues
            signal.signal(number, self)


def is_main_thread() -> bool:
    """Return whether signals arrive in this thread, on a system that suspends processes."""
    return hasattr(signal, "SIGTSTP") and threading.current_thread() is threading.main_thread()


suspension = SuspensionHandler()
"""This process's handler."""
