"""The end of a command: at the time that was promised, whatever it is waiting for."""

from __future__ import annotations

import contextlib
import os
import sys
import threading

from aionode._streams import accepts

__all__ = ["Deadline", "leave_if_busy"]


class Deadline:
    """Ends the process at a time, whatever it is waiting for then.

    What has been asked for is done and printed by then. What may still wait is Zenoh, for a peer
    that is frozen or overloaded, and nothing would be gained by waiting with it.
    """

    def __init__(self) -> None:
        self._timer: threading.Timer | None = None

    def set(self, seconds: float, status: int, text: str = "") -> None:
        """End with `status` in so many seconds, and with `text` on stderr; not as set before."""
        self.cancel()
        self._timer = threading.Timer(seconds, leave, (status, text))
        self._timer.daemon = True
        self._timer.start()

    def cancel(self) -> None:
        """Do nothing of the kind."""
        if self._timer is not None:
            self._timer.cancel()


def leave(status: int, text: str = "") -> None:
    """End the process at once, past everything that Python and foreign threads would wait for.

    All output has been flushed, and asking for that again might wait for its reader.
    """
    if text and accepts(sys.stderr.fileno()):
        with contextlib.suppress(OSError):
            os.write(sys.stderr.fileno(), text.encode(errors="backslashreplace"))
    os._exit(status)


def leave_if_busy(status: int) -> None:
    """End the process at once if a thread is still at work, such as on closing a connection.

    Python would wait for it, and stop a daemon in the middle of foreign code, which aborts.
    """
    if threading.active_count() > 1:
        leave(status)
