"""Ending the process by a deadline, whatever it is still waiting for."""

from __future__ import annotations

import contextlib
import os
import sys
import threading

from aionode._streams import accepts

__all__ = ["Deadline", "leave"]


class Deadline:
    """Ends the process at a given time, whatever it is waiting for.

    By then the work is done and its output printed. Only Zenoh may still be waiting, for a peer
    that is frozen or overloaded, and there is no reason to wait with it.
    """

    def __init__(self) -> None:
        self._timer: threading.Timer | None = None

    def set(self, seconds: float, status: int, text: str = "") -> None:
        """Exit with `status` in `seconds`, with `text` on stderr; replaces an earlier deadline."""
        self.cancel()
        self._timer = threading.Timer(seconds, leave, (status, text))
        self._timer.daemon = True
        self._timer.start()

    def cancel(self) -> None:
        """Remove the deadline."""
        if self._timer is not None:
            self._timer.cancel()


def leave(status: int, text: str = "") -> None:
    """Exit at once, without waiting for threads or exit handlers.

    Output has been flushed already; flushing again could block on its reader.
    """
    if text and accepts(sys.stderr.fileno()):
        with contextlib.suppress(OSError):
            os.write(sys.stderr.fileno(), text.encode(errors="backslashreplace"))
    os._exit(status)
