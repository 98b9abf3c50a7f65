"""Whether another process of this machine is stopped, by a signal or a debugger.

The system knows, and asking it wakes nobody: a process that is merely busy, or waits for a
processor, is not stopped, however long it is silent.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Final

import xxhash

__all__ = ["is_stopped", "pid_space"]

BOOT_ID: Final = Path("/proc/sys/kernel/random/boot_id")
PID_NAMESPACE: Final = Path("/proc/self/ns/pid")

STOPPED: Final = {b"T", b"t"}
"""States of processes that a signal, or a debugger, has stopped; see proc(5)."""


def pid_space() -> int | None:
    """Return 16 bits that name the processes among which a pid means the same one.

    Containers, and other machines, have pids of their own. None if the system does not tell.
    """
    with suppress(OSError):
        namespace = BOOT_ID.read_bytes() + str(PID_NAMESPACE.stat().st_ino).encode()
        return xxhash.xxh3_64_intdigest(namespace) & 0xFFFF
    return None


def is_stopped(pid: int) -> bool:
    """Return whether a signal or a debugger has stopped a process, as far as the system tells."""
    try:
        descriptor = os.open(f"/proc/{pid}/stat", os.O_RDONLY)  # a third of the time of `Path`
    except OSError:  # it has ended, or the system hides it
        return False
    try:
        # The name of the process comes before its state, in parentheses, and may contain some.
        return os.read(descriptor, 1024).rpartition(b") ")[2][:1] in STOPPED
    except OSError:
        return False
    finally:
        os.close(descriptor)
