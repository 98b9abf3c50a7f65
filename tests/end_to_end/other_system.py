"""Runs a program as if on another system, without what Python lacks there.

Usage: ``python other_system.py windows|macos PROGRAM ARGUMENTS``. It removes what CPython's
documentation marks as unavailable there and aionode, apart from its tests, could use. The name of
the system stays, or the standard library would look for the other system's modules.
"""

from __future__ import annotations

import asyncio
import errno
import importlib
import mmap
import multiprocessing  # noqa: F401  # the standard library is imported before it loses anything
import os
import runpy
import select
import selectors
import signal
import socket
import subprocess  # noqa: F401
import sys
import tempfile  # noqa: F401
from contextlib import suppress
from typing import Any, NoReturn

import numpy as np  # noqa: F401  # the build for Linux looks at Linux's attributes

NOT_ON_MACOS = {
    os: "eventfd eventfd_read eventfd_write EFD_NONBLOCK EFD_CLOEXEC memfd_create MFD_CLOEXEC "
    "MFD_ALLOW_SEALING sched_setaffinity sched_getaffinity timerfd_create pidfd_open",
    select: "epoll",
    selectors: "EpollSelector",
    socket: "SO_PEERCRED MSG_CMSG_CLOEXEC",
    mmap: "MAP_POPULATE",
}
NOT_ON_WINDOWS = {
    os: "getuid geteuid getgid fork register_at_fork killpg getpgid mkfifo posix_spawn set_blocking"
    " get_blocking uname",
    select: "poll",
    selectors: "PollSelector",
    socket: "AF_UNIX SCM_RIGHTS SCM_CREDENTIALS CMSG_SPACE CMSG_LEN send_fds recv_fds",
    signal: "SIGKILL SIGSTOP SIGCONT SIGHUP SIGQUIT SIGUSR1 SIGUSR2 SIGWINCH SIGTSTP SIGPIPE "
    "SIGCHLD SIGALRM pthread_sigmask pthread_kill setitimer sigwait",
    mmap: "MAP_SHARED MAP_PRIVATE PROT_READ PROT_WRITE MAP_POPULATE",
}
NO_MODULES_ON_WINDOWS = "fcntl termios tty pty pwd grp resource syslog readline"


def remove(attributes: dict[Any, str]) -> None:
    """Remove attributes."""
    for module, names in attributes.items():
        for name in names.split():
            if hasattr(module, name):
                delattr(module, name)


def refuse(*_: object, **__: object) -> NoReturn:
    """Refuse, like the loop on Windows."""
    raise NotImplementedError


def no_timerfd() -> NoReturn:
    """Fail like a C library without `timerfd`."""
    raise OSError(errno.ENOSYS, "no timerfd here")


def import_libraries() -> None:
    """Import libraries that ask for this system's name, which stays."""
    for name in ("textual.app", "mcp.server"):
        with suppress(ImportError):
            importlib.import_module(name)


def become(system: str) -> None:
    """Remove what `system` lacks."""
    asyncio.new_event_loop().close()  # which imports the rest of asyncio
    pair, unix = socket.socketpair, socket.AF_UNIX
    socket.socketpair = lambda *_, **__: pair(unix)  # Windows has it
    fitting = selectors.SelectSelector if system == "windows" else selectors.PollSelector
    selectors.DefaultSelector = fitting  # type: ignore[misc, assignment]
    remove(NOT_ON_MACOS)
    sys.modules["uvloop"] = None  # type: ignore[assignment]  # not installed, that is
    if system == "windows":
        remove(NOT_ON_WINDOWS)
        for name in ("add_signal_handler", "remove_signal_handler"):
            setattr(asyncio.SelectorEventLoop, name, refuse)
        for name in NO_MODULES_ON_WINDOWS.split():
            sys.modules[name] = None  # type: ignore[assignment]
    from aionode.clock import _timerfd as timerfd

    timerfd.libc = no_timerfd  # type: ignore[assignment]


if __name__ == "__main__":
    if sys.argv[3:] == ["import"]:  # of every module; it takes a second
        import_libraries()
    become(sys.argv[1])
    program = sys.argv[2]
    sys.argv[:] = sys.argv[2:]
    if program.endswith(".py"):
        runpy.run_path(program, run_name="__main__")
    else:
        runpy.run_module(program, run_name="__main__", alter_sys=True)
