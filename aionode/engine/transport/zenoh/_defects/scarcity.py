"""Zenoh panics, or aborts the process, if it gets no descriptors or threads for a session.

Zenoh:
    It panics in a thread of its own if it gets no descriptor or no thread while it opens a session,
    so no exception says why.
Reported:
    No.
Seen in:
    1.5.1, 1.7.2, 1.8.0, 1.9.0, 1.10.2
Workaround:
    `refuse_scarcity` checks before a session is opened, and raises.
"""

from __future__ import annotations

import os
import threading
from pathlib import Path
from typing import Final

from aionode.engine.transport.zenoh._defects._switch import is_mended
from aionode.errors import TransportError

__all__ = ["refuse_scarcity"]

DESCRIPTORS: Final = Path("/proc/self/fd")
PIDS_MAX: Final = Path("/sys/fs/cgroup/pids.max")

NEEDED_DESCRIPTORS: Final = 24
"""Number of descriptors that a session opens, including some for its first connections."""

NEEDED_THREADS: Final = 16
"""Number of threads that a session starts, including some for sending."""

MANY: Final = 4096
"""A limit that one process of a usual system does not reach."""


def refuse_scarcity() -> None:
    """Refuse to open a session if there are too few descriptors or threads for it.

    Raises:
        TransportError: the message names the limit, and how to raise it.
    """
    if not is_mended("scarcity"):
        return
    try:
        import resource
    except ImportError:  # Windows, which has no such limits
        return
    limit, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    free = limit - open_descriptors()
    if limit != resource.RLIM_INFINITY and free < NEEDED_DESCRIPTORS:
        raise TransportError(
            f"Zenoh: no session could be opened: this process may open {max(free, 0)} more "
            f"descriptors (files and sockets) of its {limit}, and a session needs about "
            f"{NEEDED_DESCRIPTORS}; raise the limit, for example with `ulimit -n 1024` before the "
            "program, or LimitNOFILE= of its systemd unit"
        )
    of_user, _ = resource.getrlimit(resource.RLIMIT_NPROC)
    limits = [most for most in (of_user, of_container()) if 0 <= most < MANY]
    if limits and not can_start_threads(NEEDED_THREADS):
        raise TransportError(
            f"Zenoh: no session could be opened: the system lets this process start fewer than "
            f"{NEEDED_THREADS} more threads (the limit is {min(limits)} for its user or its "
            "container); raise it, for example with `ulimit -u`, `--pids-limit` of the container, "
            "or TasksMax= of its systemd unit"
        )


def open_descriptors() -> int:
    """Return the number of open descriptors; 0 if they cannot be listed."""
    try:
        return len(os.listdir(DESCRIPTORS))  # noqa: PTH208  # in half the time
    except FileNotFoundError:  # no Linux
        return 0
    except OSError:  # there is none left to list the others with
        return 1 << 62


def of_container() -> int:
    """Return the thread limit of the container; -1 if there is none."""
    try:
        text = PIDS_MAX.read_text("ascii").strip()
    except OSError:
        return -1
    return int(text) if text.isdigit() else -1


def can_start_threads(count: int) -> bool:
    """Return whether this many threads can run at the same time."""
    stop = threading.Event()
    started: list[threading.Thread] = []
    try:
        for _ in range(count):
            thread = threading.Thread(target=stop.wait, name="aionode-probe")
            thread.start()
            started.append(thread)
    except RuntimeError:
        return False
    finally:
        stop.set()
        for thread in started:
            thread.join()
    return True
