"""Helpers of the programs: sessions of Zenoh, and other processes that freeze.

Each program shows one defect of Zenoh, without aionode, and fails once Zenoh no longer has it. They
are not part of the tests: ``make zenoh-defects`` runs them.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any

import zenoh

from aionode._process.socket_queue import queued_bytes
from tests.support.peers import free_ports

__all__ = [
    "READER",
    "WAIT",
    "dialling",
    "endpoint",
    "frozen",
    "is_frozen",
    "is_matched",
    "is_stuck",
    "listening",
    "opened",
    "process",
    "session",
    "sockets",
    "stands_still",
    "suppressed",
    "until",
]


WAIT = "transport/link/tx/queue/congestion_control/block/wait_before_close"
"""The setting for how long a blocking send waits for a peer, in microseconds."""


def endpoint() -> str:
    """Return a free endpoint on loopback."""
    return f"tcp/127.0.0.1:{free_ports(1)[0]}"


def opened(settings: dict[str, Any]) -> zenoh.Session:
    """Open a session that discovers nothing by itself."""
    config = zenoh.Config()
    quiet = {"scouting/multicast/enabled": False, "listen/endpoints": []}
    for key, value in (quiet | settings).items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


@contextmanager
def session(settings: dict[str, Any]) -> Iterator[zenoh.Session]:
    """Yield a session, and close it at the end."""
    with closing(opened(settings)) as one:
        yield one


def listening(there: str) -> dict[str, Any]:
    """Return the settings of a session that listens."""
    return {"listen/endpoints": [there]}


def dialling(there: str) -> dict[str, Any]:
    """Return the settings of a session that dials."""
    return {"connect/endpoints": [there]}


PREAMBLE = """
import os, signal, sys, threading, time, zenoh
from tests.zenoh_defects._support import *
"""


@contextmanager
def process(program: str, *arguments: str) -> Iterator[subprocess.Popen[str]]:
    """Yield a process that runs a program and has printed a line; kill it at the end."""
    with subprocess.Popen(
        [sys.executable, "-c", PREAMBLE + program, *arguments],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as running:
        try:
            assert running.stdout is not None
            assert running.stdout.readline()
            yield running
        finally:
            with suppress(ProcessLookupError):
                running.kill()


READER = """
with session(listening(sys.argv[1])) as one:
    reader = one.declare_subscriber("**", lambda _: None)
    print("open", flush=True)
    threading.Event().wait()
"""
"""A process that listens at an endpoint, and subscribes to everything."""


def is_frozen(running: subprocess.Popen[str]) -> bool:
    """Return whether a process has been stopped, with all its threads."""
    tasks = Path(f"/proc/{running.pid}/task").iterdir()
    states = [(task / "stat").read_text("utf-8").rpartition(")")[2].split()[0] for task in tasks]
    return set(states) == {"T"}


@contextmanager
def frozen(running: subprocess.Popen[str]) -> Iterator[None]:
    """Freeze a process within the block."""
    os.kill(running.pid, signal.SIGSTOP)
    try:
        assert until(lambda: is_frozen(running))
        yield
    finally:
        os.kill(running.pid, signal.SIGCONT)


def is_matched(publisher: zenoh.Publisher) -> bool:
    """Return whether a publisher has subscribers."""
    return bool(publisher.matching_status.matching)  # type: ignore[attr-defined]  # no bool, as the stub says


def stands_still(call: Callable[[], object], limit_s: float = 1.0) -> bool:
    """Return whether a call takes longer than a limit; it continues in a thread."""
    thread = threading.Thread(target=suppressed(call), daemon=True)
    thread.start()
    thread.join(limit_s)
    return thread.is_alive()


def suppressed(call: Callable[[], object]) -> Callable[[], None]:
    """Return a function that ignores Zenoh's errors, as its session may be closed meanwhile."""

    def run() -> None:
        with suppress(zenoh.ZError):
            call()

    return run


def sockets() -> Iterator[tuple[int, int, socket.socket]]:
    """Yield the TCP connections of this process: local port, remote port, and a duplicate."""
    for path in Path("/proc/self/fd").iterdir():
        with suppress(OSError):
            if not str(path.readlink()).startswith("socket:"):
                continue
            with socket.socket(fileno=os.dup(int(path.name))) as one:
                yield one.getsockname()[1], one.getpeername()[1], one


def is_stuck(port: int) -> bool:
    """Return whether a connection to a port is full, and stays full for a while."""
    for _ in range(4):
        time.sleep(0.01)
        if not any(queued_bytes(one) > 30_000 for _, there, one in sockets() if there == port):
            return False
    return True


def until(condition: Callable[[], object], limit_s: float = 4.0) -> bool:
    """Wait until a condition holds; return whether it does."""
    ends_s = time.perf_counter() + limit_s
    while not condition():
        if time.perf_counter() > ends_s:
            return False
        time.sleep(0.005)
    return True
