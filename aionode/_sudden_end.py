"""What is sent before the process ends, or is suspended, without the ends of its nodes.

Two kinds of functions are called, in this order: those of `STOPS` send the stop of each open lease,
those of `SENDS` hand what was published to the operating system.

**When.** At the second signal, at Ctrl-Z while a lease is open, and when the interpreter exits. A
handler of signals runs in the main thread, between any two steps of what that thread does, and what
it has interrupted does not go on meanwhile. So a handler asks `is_sending` first: within publishers
and transports, a frame may be in a socket in part while the connection does not know it yet. Such a
moment is over soon, and the handler comes back after it. At any other moment the main thread may
publish and send as in a callback: aionode holds no lock there.
"""

from __future__ import annotations

import atexit
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from types import FrameType

__all__ = ["LIMIT_NS", "SENDS", "STOPS", "is_sending", "send_last_messages"]

LIMIT_NS: Final = 200_000_000
"""How long sending takes at most, in nanoseconds."""

STOPS: list[Callable[[], bool]] = []
"""Send the stop of each open lease at once, and return whether there was one.

Each may be called in any thread, and again; it must not wait for the event loop, which stands
still.
"""

SENDS: list[Callable[[int], bool]] = []
"""Hand what was published to the operating system, until a time of `perf_ns` at most.

They are called in the main thread, whose event loop stands still, and return whether other threads,
such as Zenoh's, need the rest of the time.
"""

LIBRARY: Final = sys.stdlib_module_names | {"aionode", "uvloop"}
SENDING: Final = ("aionode.endpoints", "aionode.transport")


def is_sending(frame: FrameType | None) -> bool:
    """Return whether `frame`, which a signal interrupted, is within a publisher or transport.

    Their callers are of no interest: a callback that blocks the loop was called by a transport too,
    and interrupted in the user's code.
    """
    while frame is not None:
        module = frame.f_globals.get("__name__", "aionode")  # generated code has no name
        if module.startswith(SENDING):
            return True
        if module.partition(".")[0] not in LIBRARY:
            return False
        frame = frame.f_back
    return False


def send_last_messages(ends_ns: int) -> bool:
    """Send the stop of each open lease, and then what was published.

    Args:
        ends_ns: Until when, by the `perf_ns` of `aionode.clock`.

    Returns:
        Whether other threads need the rest of the time.

    Raises:
        ExceptionGroup: functions have failed; the others were called.
    """
    failures: list[Exception] = []
    needs_time = False
    for stop in STOPS:
        try:
            stop()
        except Exception as failure:  # noqa: BLE001  # raised below: the others come first
            failures.append(failure)
    for send in SENDS:
        try:
            needs_time |= send(ends_ns)
        except Exception as failure:  # noqa: BLE001  # as above
            failures.append(failure)
    if failures:
        raise ExceptionGroup("the last messages were not sent", failures)
    return needs_time


@atexit.register
def stop_at_exit() -> None:
    """Send the stop of leases that are still open: nothing has ended their blocks.

    So it is after a second or third Ctrl-C in a program that `aionode.run` does not run.
    """
    sent = [stop() for stop in STOPS]
    if any(sent):
        threading.Event().wait(LIMIT_NS / 1e9)
