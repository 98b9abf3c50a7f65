"""Opening Zenoh sessions with few threads.

Zenoh has five thread pools in a process, and reads their sizes from the environment variable
``ZENOH_RUNTIME`` when it first opens a session. A keep-alive wakes up to three threads by default:
one whose pool made the connection, and two that take turns in receiving. Python handles one message
at a time anyway, so here one thread receives and connects, and another one sends: a process has
four threads fewer, and wakes up half as often.
"""

from __future__ import annotations

import os
import threading
from typing import Final

import zenoh

__all__ = ["open_zenoh"]

VARIABLE: Final = "ZENOH_RUNTIME"

POOLS: Final = "(rx: (handover: net), acc: (handover: net), app: (handover: net))"
"""One thread for all but sending, which has its own: keep-alives are not to wait for Python."""

LOCK: Final = threading.Lock()
"""Held while the variable is set."""

opened = False
"""Whether this process has opened a session; Zenoh does not read the variable again."""


def open_zenoh(config: zenoh.Config) -> zenoh.Session:
    """Open a session, the first one with few threads unless the environment says how many.

    The variable is set for that moment only: programs that this one starts are not affected.

    Raises:
        zenoh.ZError: Zenoh cannot open it.
    """
    global opened  # noqa: PLW0603  # the pools belong to the process
    if opened or VARIABLE in os.environ:
        return zenoh.open(config)
    with LOCK:
        os.environ[VARIABLE] = POOLS
        try:
            return zenoh.open(config)
        finally:
            opened = True
            del os.environ[VARIABLE]
