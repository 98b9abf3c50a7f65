"""The last messages of a process that exits or is suspended without shutting its nodes down.

Two lists of functions are called, in this order: `STOPS` send the stops of open leases, and `SENDS`
hand published messages to the operating system.

A signal starts it: the second request to end, or Ctrl-Z while a lease is open. The handler runs in
the main thread, between any two bytecodes, and the interrupted code does not continue meanwhile. So
the handler first checks whether that code is a publisher or transport: a socket may hold part of a
frame that the connection does not know of yet. Such a step is over soon, and the
signal is sent again after it. At any other moment the main thread may publish and send as in a
callback, and holds none of their locks. When the interpreter exits, only the stops are sent.
"""

from __future__ import annotations

import _thread
import atexit
import contextlib
import os
import select
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from aionode._process.streams import interrupt_main
from aionode.clock import perf_ns

if TYPE_CHECKING:
    from types import FrameType

__all__ = [
    "SENDS",
    "STOPS",
    "LastMessages",
    "is_sending",
    "mark_sending",
    "print_error",
    "start_thread",
]

LIMIT_NS: Final = 200_000_000
"""Maximum time for sending, in nanoseconds."""

STEP_NS: Final = 50_000_000
"""Maximum time for a publisher or transport to finish a step that a signal interrupted, in
nanoseconds.
"""

AGAIN_SEC: Final = 0.001
"""The delay before a signal that interrupted such a step is sent again."""

STOPS: list[Callable[[], bool]] = []
"""Functions that send the stops of open leases, and return whether there were any.

They are called in the main thread, perhaps repeatedly. They wait neither for the event loop, which
stands still, nor for other threads, which get the rest of the time.
"""

SENDS: list[Callable[[int], bool]] = []
"""Functions that hand published messages to the operating system, until a time of `perf_ns`.

They are called in the main thread, whose event loop stands still, and return whether other threads,
such as Zenoh's, need the rest of the time.
"""

LIBRARY: Final = sys.stdlib_module_names | {"aionode", "rclpy", "uvloop"}
"""The code between a callback and the transport that called it."""

SENDING: Final[list[str]] = []
"""The packages and modules of publishers and transports, which register themselves: see
`mark_sending`."""


def mark_sending(package: str) -> None:
    """Forbid sending from a signal handler that interrupts a module of `package`.

    A package's own ``__init__`` calls it, so that it stays true when the package moves; the classes
    of `aionode.engine.transport.base` call it for each module that derives from them. It is for
    code that a signal can interrupt in the middle of a message: between numbering a message and
    writing its bytes, or with part of a frame in a socket.

    Args:
        package: The name of the package, or of a single module.
    """
    if not f"{package}.".startswith(tuple(SENDING)):
        SENDING.append(f"{package}.")


def is_sending(frame: FrameType | None) -> bool:
    """Return whether `frame`, which a signal interrupted, is inside a publisher or transport.

    Callers further up do not count: a callback that blocks the loop was called by a transport too,
    but interrupted in the user's code.
    """
    while frame is not None:
        module = frame.f_globals.get("__name__", "aionode")  # generated code has no name
        if f"{module}.".startswith(tuple(SENDING)):
            return True
        if module.partition(".")[0] not in LIBRARY:
            return False
        frame = frame.f_back
    return False


class LastMessages:
    """The last messages, sent within 0.2 s by a signal handler.

    Args:
        number: The signal.

    Attributes:
        ends_ns: When the time is up, by `perf_ns`.
        failure: What failed, as text for users.
    """

    def __init__(self, number: int) -> None:
        self._number = signal.Signals(number)
        self._began_ns = perf_ns()
        self._has_begun = False
        self.ends_ns = self._began_ns + LIMIT_NS
        self.failure = ""

    def send(self, frame: FrameType | None) -> bool:
        """Send the messages, and leave other threads the rest of the time.

        Args:
            frame: What the signal interrupted.

        Returns:
            Whether this call sent them: not if another call is sending, nor if `frame` is inside a
            publisher or transport. In the latter case the signal is sent again.
        """
        if self._has_begun:
            return False
        if is_sending(frame) and perf_ns() - self._began_ns < STEP_NS:
            start_thread(self._come_again)
            return False
        self._has_begun = True
        needs_time = [self._call(stop) for stop in STOPS]
        needs_time += [self._call(send, self.ends_ns) for send in SENDS]
        if any(needs_time):
            self.wait()
        return True

    def _call(self, function: Callable[..., bool], *args: int) -> bool:
        try:
            return function(*args)
        except Exception:  # noqa: BLE001  # printed, as nobody could catch it and the others come first
            self.failure += traceback.format_exc()
            return True

    def _come_again(self) -> None:
        threading.Event().wait(AGAIN_SEC)
        interrupt_main(self._number)

    def wait(self) -> None:
        """Wait until the time is up."""
        while (left_ns := self.ends_ns - perf_ns()) > 0:
            threading.Event().wait(left_ns / 1e9)


def start_thread(work: Callable[[], object]) -> None:
    """Start a thread from a signal handler, unless the system is out of threads.

    `threading.Thread.start` takes locks that the interrupted thread may hold.
    """
    with contextlib.suppress(RuntimeError):
        _thread.start_new_thread(work, ())


def print_error(text: str) -> None:
    """Write to stderr, unless nobody reads it, as the process must go on to its end."""
    if sys.__stderr__ is None:  # closed at the start; descriptor 2 is something else now
        return
    with contextlib.suppress(OSError, ValueError):
        descriptor = sys.__stderr__.fileno()
        if text and select.select([], [descriptor], [], 0)[1]:
            os.write(descriptor, text.encode())


@atexit.register
def stop_at_exit() -> None:
    """Send the stops of leases that are still open, as nothing has ended their blocks.

    That is so after a second or third Ctrl-C in a program not run by `aionode.run`.
    """
    sent = [stop() for stop in STOPS]
    if any(sent):
        threading.Event().wait(LIMIT_NS / 1e9)
