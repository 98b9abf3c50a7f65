"""SIGINT, SIGTERM and SIGHUP: the first ends the program in order, a later one at once."""

from __future__ import annotations

import _thread
import contextlib
import os
import select
import signal
import threading
import traceback
from typing import TYPE_CHECKING, Any, Final

from aionode._streams import UnreadWatch, interrupt_main
from aionode._sudden_end import LIMIT_NS, is_sending, send_last_messages
from aionode.clock import perf_ns

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

__all__ = ["signals_to"]

SAME_SEC: Final = 1.0
"""Signals within this time after the first count as the first, of whichever kind they are.

GNU ``timeout``, ``ros2 launch`` and other parents forward a signal that the whole process group has
got already.
"""

SENDING_NS: Final = 50_000_000
"""How long a publisher or transport may take for what a signal has interrupted, in nanoseconds."""

AGAIN_SEC: Final = 0.001
"""After how long a handler comes back that was called within a publisher or transport."""

STDERR: Final = 2


@contextlib.contextmanager
def signals_to(stop: Callable[[], object]) -> Iterator[None]:
    """Call `stop` at the first SIGINT, SIGTERM or SIGHUP, and end the process at a later one.

    Those within a second of the first count as the first. SIGHUP is taken only where it would end
    the process: it is left alone if it is ignored, as under ``nohup``, or has a handler.

    The handlers are Python's and not the event loop's, so that they run even while a callback
    blocks the loop. Outside the main thread nothing is installed, as signals do not arrive there.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = EndHandler(stop)
    before = {number: signal.signal(number, handler) for number in ending_signals()}
    try:
        yield
    finally:
        handler.close()
        for number, earlier in before.items():
            if signal.getsignal(number) is handler:  # or the program has set its own meanwhile
                restore(number, earlier)


def ending_signals() -> list[signal.Signals]:
    """Return which signals end a program."""
    found = [signal.SIGINT, signal.SIGTERM]
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        found.append(signal.SIGHUP)
    return found


def restore(number: signal.Signals, handler: Any) -> None:
    """Set the handler that was there before; what was not set by Python cannot be set again."""
    signal.signal(number, signal.SIG_DFL if handler is None else handler)


class EndHandler:
    """The handler of the signals that end a program.

    Args:
        stop: Called by the first of them.
    """

    def __init__(self, stop: Callable[[], object]) -> None:
        self._stop = stop
        self._first: int | None = None
        self._first_ns = 0
        self._woken: list[int] = []
        # The loop may be blocked by a write to a full pipe whose reader is gone.
        self._unread = UnreadWatch(self._wake)

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal."""
        if number in self._woken:
            self._woken.remove(number)
        elif self._first is None:
            self._first, self._first_ns = number, perf_ns()
            self._unread.start()
            self._stop()
        elif perf_ns() - self._first_ns >= SAME_SEC * 1e9:
            SuddenEnd(signal.Signals(number)).begin(self, frame)

    def _wake(self) -> None:
        if self._first is not None:
            self._woken.append(self._first)
            interrupt_main(signal.Signals(self._first))

    def close(self) -> None:
        """Stop watching the standard streams."""
        self._unread.stop()


class SuddenEnd:
    """Ends the process within 0.2 s: threads cannot be cancelled, and may run for any time.

    The main thread sends the last messages. Another thread ends the process when the time is over,
    whatever the main thread is doing then.

    Args:
        number: The signal that asks for it.
    """

    def __init__(self, number: signal.Signals) -> None:
        self._number = number
        self._began_ns = perf_ns()
        self._is_sending = False
        self._failure = ""
        self._leaving = _thread.allocate_lock()

    def begin(self, handler: EndHandler, frame: FrameType | None) -> None:
        """Begin, called by `handler`, which is not needed any more."""
        for each in signal.valid_signals():
            if signal.getsignal(each) is handler:
                signal.signal(each, signal.SIG_IGN)  # a third one has nothing to add
        signal.signal(self._number, self._on_signal)
        # `Thread.start` takes locks that the interrupted thread may hold.
        with contextlib.suppress(RuntimeError):  # the system has no more threads
            _thread.start_new_thread(self._watch, ())
        self._on_signal(self._number, frame)

    def _on_signal(self, _number: int, frame: FrameType | None) -> None:
        if self._is_sending:
            return
        if is_sending(frame) and perf_ns() - self._began_ns < SENDING_NS:
            return  # `_watch` sends the signal again
        self._is_sending = True
        try:
            needs_time = send_last_messages(self._began_ns + LIMIT_NS)
        except Exception:  # noqa: BLE001  # printed: there is no caller
            self._failure = traceback.format_exc()
            needs_time = True
        if needs_time:
            wait_until(self._began_ns + LIMIT_NS)
        self._leave()

    def _watch(self) -> None:
        while not self._is_sending and perf_ns() - self._began_ns < LIMIT_NS:
            threading.Event().wait(AGAIN_SEC)
            if not self._is_sending:
                interrupt_main(self._number)
        wait_until(self._began_ns + LIMIT_NS)
        self._leave()

    def _leave(self) -> None:
        if not self._leaving.acquire(blocking=False):
            return  # the other thread is faster
        name = self._number.name
        text = f"{self._failure}aionode: ended at once by a second signal ({name})\n"
        # A reader of stderr that is gone must not keep the process from ending.
        with contextlib.suppress(OSError, ValueError):
            if select.select([], [STDERR], [], 0)[1]:
                os.write(STDERR, text.encode())
        os._exit(128 + self._number)


def wait_until(ends_ns: int) -> None:
    """Wait until a time of `perf_ns`."""
    while (left_ns := ends_ns - perf_ns()) > 0:
        threading.Event().wait(left_ns / 1e9)
