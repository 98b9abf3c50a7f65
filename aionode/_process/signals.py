"""SIGINT, SIGTERM and SIGHUP: the first one shuts the program down, a later one ends it at once."""

from __future__ import annotations

import _thread
import asyncio
import contextlib
import os
import signal
import socket
import threading
from typing import TYPE_CHECKING, Any, Final

from aionode._process.streams import UnreadWatch, interrupt_main
from aionode._process.sudden_end import LastMessages, print_error, start_thread
from aionode._process.temporary import remove_temporary_folders
from aionode.clock import perf_ns

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

__all__ = ["signals_to", "woken_by_signals"]

SAME_SEC: Final = 1.0
"""Further signals of any kind within this time after the first are ignored.

GNU ``timeout``, ``ros2 launch`` and other parents forward a signal that the whole process group has
already received.
"""


@contextlib.contextmanager
def signals_to(stop: Callable[[], object]) -> Iterator[None]:
    """Call `stop` at the first SIGINT, SIGTERM or SIGHUP, and end the process at a later one.

    Further ones within a second of the first are ignored. SIGHUP is handled only if it would end
    the process, so not if it is ignored, as under ``nohup``, or has a handler.

    The handlers are Python's rather than the event loop's, so that they run even while a callback
    blocks the loop. Outside the main thread nothing is installed, as signals do not arrive there.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = EndHandler(stop)
    handler.install()
    try:
        yield
    finally:
        handler.close()


@contextlib.contextmanager
def woken_by_signals(loop: asyncio.AbstractEventLoop) -> Iterator[None]:
    """Wake a running event loop for each signal, so that Python calls its handler.

    Python does so between two bytecodes of the main thread. A signal that comes just before the
    loop goes to sleep, or in another thread, would wait until something else wakes the loop. Other
    loops than asyncio's selector loop wake themselves; a wakeup descriptor of the program stays.
    """
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or not isinstance(loop, asyncio.SelectorEventLoop):
        yield
        return
    reader, writer = socket.socketpair()
    with reader, writer:
        reader.setblocking(False)
        writer.setblocking(False)
        before = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
        if before == -1:
            loop.add_reader(reader, reader.recv, 4096)
        else:
            signal.set_wakeup_fd(before)
        try:
            yield
        finally:
            if before == -1:
                loop.remove_reader(reader)
                found = signal.set_wakeup_fd(-1)
                if found != writer.fileno():  # the program's, installed meanwhile
                    signal.set_wakeup_fd(found)


def ending_signals() -> list[signal.Signals]:
    """Return the signals that end a program."""
    numbers = [signal.SIGINT, signal.SIGTERM]
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        numbers.append(signal.SIGHUP)
    return numbers


class EndHandler:
    """The handler of the signals that end a program.

    Args:
        stop: Called by the first of them.
    """

    def __init__(self, stop: Callable[[], object]) -> None:
        self._stop = stop
        self._pid = os.getpid()
        self._before: dict[int, Any] = {}
        self._first: int | None = None
        self._first_ns = 0
        self._woken: list[int] = []
        # The loop may be blocked by a write to a full pipe whose reader is gone.
        self._unread = UnreadWatch(self._wake)

    def install(self) -> None:
        """Handle the signals from now on."""
        self._before = {number: signal.signal(number, self) for number in ending_signals()}

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal."""
        if os.getpid() != self._pid:  # a forked child, in which `aionode.run` is not running
            self._restore(number)
            signal.raise_signal(number)
        elif number in self._woken:
            self._woken.remove(number)
        elif self._first is None:
            self._first, self._first_ns = number, perf_ns()
            self._unread.start()
            self._stop()
        elif perf_ns() - self._first_ns >= SAME_SEC * 1e9:
            SuddenEnd(number).begin(self, frame)

    def _wake(self) -> None:
        if self._first is not None:
            self._woken.append(self._first)
            interrupt_main(signal.Signals(self._first))

    def _restore(self, number: int) -> None:
        """Restore the previous handler, unless the program has set its own meanwhile."""
        current: object = signal.getsignal(number)
        if current is self:
            before = self._before[number]
            # None means a handler not set from Python, which Python cannot restore.
            signal.signal(number, signal.SIG_DFL if before is None else before)

    def close(self) -> None:
        """Restore the handlers, and stop watching the standard streams."""
        self._unread.stop()
        for number in self._before:
            self._restore(number)
        if self._first is not None:
            # `atexit` calls its functions too late: Python joins threads and process pools before.
            with contextlib.suppress(AttributeError, RuntimeError):  # private; at the end already
                threading._register_atexit(self._handle_at_exit)  # type: ignore[attr-defined]

    def _handle_at_exit(self) -> None:
        """Handle a second signal even while the interpreter exits after a first one.

        It waits without a limit for threads and for the workers of process pools, and a worker that
        is stopped (SIGSTOP) does not end. Python's own handler ends just one of these waits. Other
        signals end the process by themselves, and a handler of the program is left alone.
        """
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self)


class SuddenEnd:
    """Ends the process within 0.2 s, as threads cannot be cancelled and may run for any time.

    The main thread sends the last messages. Another thread ends the process when the time is up,
    whatever the main thread is doing.

    Args:
        number: The signal that caused it.
    """

    def __init__(self, number: int) -> None:
        self._number = signal.Signals(number)
        self._messages = LastMessages(number)
        self._leaving = _thread.allocate_lock()  # acquired once, by the thread that exits

    def begin(self, handler: EndHandler, frame: FrameType | None) -> None:
        """Start ending; called by `handler`, which is not needed any more."""
        for number in signal.valid_signals():
            if signal.getsignal(number) is handler:
                signal.signal(number, signal.SIG_IGN)  # a third signal has nothing to add
        signal.signal(self._number, self._on_signal)
        start_thread(self._leave_in_time)
        self._on_signal(self._number, frame)

    def _on_signal(self, _number: int, frame: FrameType | None) -> None:
        if self._messages.send(frame):
            self._leave()

    def _leave_in_time(self) -> None:
        self._messages.wait()
        self._leave()

    def _leave(self) -> None:
        if self._leaving.acquire(blocking=False):  # the first of the two threads
            name = self._number.name
            text = f"aionode: ended at once by a second signal ({name})\n"
            print_error(self._messages.failure + text)
            remove_temporary_folders()
            os._exit(128 + self._number)
