"""Whether another process of this machine is stopped, by a signal or a debugger.

The system knows, and asking it wakes nobody: a process that is merely busy, or waits for a
processor, is not stopped, however long it is silent. Nor is one that is stopped again and again for
a moment, as each system call does under `strace`.
"""

from __future__ import annotations

import os
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Final

import xxhash

__all__ = ["WatchedProcess", "is_stopped", "pid_space"]

BOOT_ID: Final = Path("/proc/sys/kernel/random/boot_id")
OWN_PROCESS: Final = Path("/proc/self")
PID_NAMESPACE: Final = OWN_PROCESS / "ns/pid"

STOPPED: Final = {b"T", b"t"}
"""States of processes that a signal, or a debugger, has stopped; see proc(5)."""


@cache
def pid_space() -> int | None:
    """Return 16 bits that identify the set of processes to which this process's pids apply.

    Containers and other machines have pids of their own. None if the system does not say, or shows
    the processes outside this one's container. It is the same for the life of a process, and asked
    for each peer that comes or goes.
    """
    with suppress(OSError):
        if OWN_PROCESS.readlink().name != str(os.getpid()):
            return None
        namespace = BOOT_ID.read_bytes() + str(PID_NAMESPACE.stat().st_ino).encode()
        return xxhash.xxh3_64_intdigest(namespace) & 0xFFFF
    return None


if hasattr(os, "register_at_fork"):  # a child may be the first process of a container
    os.register_at_fork(after_in_child=pid_space.cache_clear)


def is_stopped(pid: int) -> bool:
    """Return whether a signal or a debugger has stopped a process, as far as the system says."""
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


class WatchedProcess:
    """Another process that is checked repeatedly.

    Most processes have run between two checks, and their main thread's processor time shows that in
    an eighth of the time that `is_stopped` takes.

    Args:
        pid: The process.
    """

    __slots__ = ("_descriptor", "_pid", "_ran")

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._ran = b""
        self._descriptor: int | None = None
        with suppress(OSError):  # some systems do not count it
            self._descriptor = os.open(f"/proc/{pid}/schedstat", os.O_RDONLY)
            self._ran = os.pread(self._descriptor, 128, 0)

    def is_stopped(self) -> bool:
        """Return whether it is stopped, and has not run since the last check."""
        if self._descriptor is not None:
            try:
                ran = os.pread(self._descriptor, 128, 0)
            except OSError:  # it has ended
                return False
            if ran != self._ran:
                self._ran = ran
                return False
        return is_stopped(self._pid)

    def close(self) -> None:
        """Release its descriptor."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None
