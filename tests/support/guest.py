"""Checks that a library leaves everything that belongs to the program as it was."""

from __future__ import annotations

import asyncio
import fcntl
import gc
import locale
import logging
import multiprocessing
import os
import pty
import random
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import termios
import threading
import warnings
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

BREAKER = """
import fcntl, sqlite3, sys
with open(sys.argv[1], "rb+") as file:
    try:
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        pass
    else:
        print("the record lock")
try:
    sqlite3.connect(sys.argv[2], timeout=0).execute("INSERT INTO log VALUES (2)")
except sqlite3.OperationalError as error:
    assert "locked" in str(error), error
else:
    print("the transaction")
"""
"""A process that tries to break the locks of another, and prints those that it could."""

ZENOH_LINGER = struct.pack("ii", 1, 10)
"""SO_LINGER as Zenoh sets it."""

FROZEN_BY_PYTHON = 1000
"""Python 3.12 itself has frozen 375 objects when a program begins."""

HANDLED = sorted(signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP})

STEP_S = 0.01
"""How often the thread of the program works."""


@contextmanager
def locks(folder: Path) -> Iterator[None]:
    """Hold an exclusive record lock and an exclusive transaction, and check both at the end."""
    record, database = folder / "record", folder / "log.sqlite"
    record.write_bytes(b"mine")
    with (
        record.open("rb+") as file,
        closing(sqlite3.connect(database, isolation_level=None)) as connection,
    ):
        connection.execute("CREATE TABLE log (line INTEGER)")
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        connection.execute("BEGIN EXCLUSIVE")
        connection.execute("INSERT INTO log VALUES (1)")

        yield

        if lost := broken(record, database):
            raise AssertionError(f"another process took {lost}")
        connection.execute("COMMIT")


def broken(record: Path, database: Path) -> str:
    """Return which of the locks another process can take."""
    command = [sys.executable, "-I", "-S", "-c", BREAKER, str(record), str(database)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return str(done.stdout)


@contextmanager
def guest(folder: Path) -> Iterator[None]:
    """Hold and set everything that a program may, and check at the end that it is unchanged.

    Locks, pipes, a terminal, sockets, signal handlers, children, a thread, and the settings of the
    interpreter and of a running event loop. For the main thread.

    Args:
        folder: A folder for files.
    """
    with ExitStack() as stack:
        stack.enter_context(locks(folder))
        stack.enter_context(handlers())
        checks = [stack.enter_context(one()) for one in (pipes, connections, children, thread)]
        before = settings()

        yield

        assert_same("settings", before, settings())
        for check in checks:
            check()


def assert_same(subject: str, before: dict[str, Any], after: dict[str, Any]) -> None:
    """Raise an error that names what has changed."""
    changed = {name: (value, after[name]) for name, value in before.items() if value != after[name]}
    if changed:
        raise AssertionError(f"{subject}: before and now: {changed}")


def states(files: dict[str, int]) -> dict[str, Any]:
    """Return the targets of descriptors, and whether they block and are inherited."""
    return {
        name: (Path(f"/proc/self/fd/{number}").readlink(), fcntl.fcntl(number, fcntl.F_GETFL))
        for name, number in files.items()
    }


@contextmanager
def handlers() -> Iterator[None]:
    """Install signal handlers of the program, and its own wake-up descriptor."""
    numbers = {signal.SIGUSR1, signal.SIGUSR2, signal.SIGHUP, signal.SIGALRM, signal.SIGCHLD}
    before = {number: signal.signal(number, lambda *_: None) for number in numbers}
    ours, theirs = socket.socketpair()
    ours.setblocking(False)
    wakeup = signal.set_wakeup_fd(ours.fileno())
    signal.setitimer(signal.ITIMER_REAL, 3600)
    try:
        yield
        left_s, _ = signal.setitimer(signal.ITIMER_REAL, 0)
        assert_same("signals", {"the alarm": True}, {"the alarm": left_s > 3000})
    finally:
        set_to = signal.set_wakeup_fd(wakeup)
        signal.setitimer(signal.ITIMER_REAL, 0)
        for number, handler in before.items():
            signal.signal(number, handler)
        expected, now = {"wakeup": ours.fileno()}, {"wakeup": set_to}
        ours.close()
        theirs.close()
    assert_same("signals", expected, now)


@contextmanager
def pipes() -> Iterator[Callable[[], None]]:
    """Hold a pipe and a terminal with data in them, which is read at the end."""
    read, write = os.pipe()
    master, slave = pty.openpty()
    files = {"pipe": read, "its end": write, "terminal": master, "its other side": slave}
    modes = termios.tcgetattr(slave)
    os.write(write, b"kept")
    os.write(master, b"typed\n")
    before = states(files)

    def check() -> None:
        assert_same("files", before, states(files))
        assert_same("terminal", {"modes": modes}, {"modes": termios.tcgetattr(slave)})
        held = {"pipe": os.read(read, 10), "terminal": os.read(slave, 10)}
        assert_same("content", {"pipe": b"kept", "terminal": b"typed\n"}, held)

    try:
        yield check
    finally:
        for number in files.values():
            os.close(number)


@contextmanager
def connections() -> Iterator[Callable[[], None]]:
    """Hold sockets: one that only sends and has Zenoh's SO_LINGER, and others."""
    with ExitStack() as stack:
        server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        log = stack.enter_context(socket.create_connection(server.getsockname()))
        log.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, ZENOH_LINGER)
        log.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        log.sendall(bytes(34))
        reader = stack.enter_context(server.accept()[0])
        database = stack.enter_context(socket.create_connection(server.getsockname()))
        stack.enter_context(server.accept()[0]).sendall(b"row")
        datagram = stack.enter_context(socket.socket(type=socket.SOCK_DGRAM))
        datagram.bind(("127.0.0.1", 0))
        near, far = map(stack.enter_context, socket.socketpair())
        sockets = {"server": server, "log": log, "database": database, "datagram": datagram}
        sockets |= {"near": near, "far": far}
        before = options(sockets)

        def check() -> None:
            assert_same("sockets", before, options(sockets))
            log.sendall(b"!")
            near.sendall(b"?")
            held = {
                "log": reader.recv(100, socket.MSG_WAITALL | socket.MSG_DONTWAIT),
                "database": database.recv(10, socket.MSG_DONTWAIT),
                "far": far.recv(10, socket.MSG_DONTWAIT),
            }
            assert_same("sent", {"log": bytes(34) + b"!", "database": b"row", "far": b"?"}, held)

        yield check


def options(sockets: dict[str, socket.socket]) -> dict[str, Any]:
    """Return the addresses and options of sockets."""
    found = states({name: one.fileno() for name, one in sockets.items()})
    for name, one in sockets.items():
        found[f"{name}: linger"] = one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8)
        if one.type == socket.SOCK_STREAM and one.family == socket.AF_INET:
            found[f"{name}: limit"] = one.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT)
    return found


@contextmanager
def children() -> Iterator[Callable[[], None]]:
    """Hold a forked child and a spawned one, which nobody else may signal or reap."""
    forked = os.fork()
    if forked == 0:
        signal.pause()
        os._exit(1)
    spawned = subprocess.Popen([sys.executable, "-I", "-S", "-c", "input()"], stdin=subprocess.PIPE)

    def check() -> None:
        running = {"forked": os.waitpid(forked, os.WNOHANG), "spawned": spawned.poll()}
        assert_same("children", {"forked": (0, 0), "spawned": None}, running)

    try:
        yield check
    finally:
        os.kill(forked, signal.SIGKILL)
        os.waitpid(forked, 0)
        spawned.communicate()


@contextmanager
def thread() -> Iterator[Callable[[], None]]:
    """Hold a running thread."""
    turns, ended = [0], threading.Event()

    def work() -> None:
        while not ended.wait(STEP_S):
            turns[0] += 1

    worker = threading.Thread(target=work, name="of the program")
    worker.start()

    def check() -> None:
        before = turns[0]
        while worker.is_alive() and turns[0] == before:
            ended.wait(STEP_S)
        assert_same("thread", {"runs": True}, {"runs": worker.is_alive()})

    try:
        yield check
    finally:
        ended.set()
        worker.join()


def settings() -> dict[str, Any]:
    """Return the settings of the process, the interpreter and the running event loop, if any."""
    root = logging.getLogger()
    found: dict[str, Any] = {
        "handlers of signals": {number: signal.getsignal(number) for number in HANDLED},
        "gc": (gc.isenabled(), gc.get_threshold(), gc.get_debug(), list(gc.callbacks)),
        "frozen objects": gc.get_freeze_count() > FROZEN_BY_PYTHON,
        "hooks": (sys.excepthook, sys.unraisablehook, threading.excepthook, sys.displayhook),
        "traces": (sys.gettrace(), sys.getprofile(), threading.gettrace()),
        "asyncgen hooks": sys.get_asyncgen_hooks() if running_loop() is None else None,
        "limits": (sys.getswitchinterval(), sys.getrecursionlimit(), threading.stack_size()),
        "warnings": list(warnings.filters),
        "streams": (sys.stdin, sys.stdout, sys.stderr),
        "environment": dict(os.environ),
        "folder": Path.cwd(),
        "umask": umask(),
        "locale": locale.setlocale(locale.LC_ALL),
        "start method": multiprocessing.get_start_method(allow_none=True),
        "random numbers": random.getstate(),
        "logging": (
            root.level,
            list(root.handlers),
            logging.getLoggerClass(),
            logging.raiseExceptions,
        ),
        "loop policy": policy(),
    }
    if loop := running_loop():
        found["loop"] = (
            loop.get_debug(),
            loop.get_exception_handler(),
            loop.get_task_factory(),
            loop.slow_callback_duration,
        )
    return found


def running_loop() -> asyncio.AbstractEventLoop | None:
    """Return the running event loop, if any."""
    return asyncio._get_running_loop()


def policy() -> object:
    """Return the policy of event loops."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # since Python 3.14
        return asyncio.get_event_loop_policy()


def umask() -> int:
    """Return the mask of new files."""
    mask = os.umask(0o077)
    os.umask(mask)
    return mask
