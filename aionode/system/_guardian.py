"""The guardian: starts the programs of a system, and stops them when the system is gone.

It is a separate program that imports nothing from aionode: ``python -I -S _guardian.py FD``. Its
only connection is a socket to the supervisor. When that closes, however the supervisor ended, the
guardian stops every program, the last one first, and exits after the last process.

Each program is started in its own session. The guardian is the subreaper of all of them
(``PR_SET_CHILD_SUBREAPER``): a process that loses its parent, such as one that forked twice,
becomes the guardian's child, so every process of the system is a descendant of the guardian. A
process is assigned to its program by its session, its parent, or the token in its environment.

Commands and events are packets of JSON. Commands: ``start`` (with five or six descriptors: the
description of the program, its three standard streams, and the read ends of its output), ``stop``,
``kill``. Events: ``started``, ``refused``, ``exited``, ``gone`` (nothing is left).
"""

from __future__ import annotations

import ctypes
import json
import os
import select
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

__all__ = [
    "LOOK_S",
    "TOKEN_VARIABLE",
    "Guardian",
    "Program",
    "descendants",
    "main",
    "owned_by",
    "send",
]

TOKEN_VARIABLE = "AIONODE_SYSTEM"  # noqa: S105  # not a secret: names the system of a process
PR_SET_CHILD_SUBREAPER = 36
PR_SET_NAME = 15
LOOK_S = 0.1
"""Time between two checks of processes that should end, in seconds."""
EXEC_S = 2.0
"""The longest time that an exec may take, in seconds; it may wait for a processor."""


class Program:
    """A running program, with the processes that it has started.

    Attributes:
        number: Its number for the supervisor.
        pid: The id of its first process; also its session and process group.
        ended: Whether the first process has ended.
        gone: Whether no process is left.
        outputs: The read ends of its output, drained once the supervisor is gone.
        ladder: The signals that end it, and how long to wait after each, in seconds.
        token: The marker in the environment of its processes.
    """

    def __init__(
        self,
        number: int,
        pid: int,
        outputs: list[int],
        ladder: list[tuple[str, float]],
        guardian: int,
    ) -> None:
        self.number, self.pid, self.outputs, self.ladder = number, pid, outputs, ladder
        self.token = token_of(guardian, number)
        self.ended = self.gone = False
        self.stopping = False
        self._steps: list[tuple[str, float]] = []
        self._due = 0.0
        self._doubted = 0.0

    def stop(self) -> None:
        """Send the first signal, unless it is already being stopped."""
        if not self.stopping:
            self.stopping = True
            self._steps, self._due = list(self.ladder), 0.0

    def kill(self) -> None:
        """Escalate to SIGKILL now."""
        self.stopping = True
        self._steps, self._due = [], 0.0

    def note_end(self) -> None:
        """Record the end of the first process; from now on, what it left behind is stopped."""
        self.ended = True
        if self._steps or not self.stopping:
            self.stopping = False
            self.stop()

    def is_left(self, *, strangers: bool, in_exec: bool) -> bool:
        """Return whether a process may be left even though none was found.

        During an exec a process has no environment for a moment, and thus no token.

        Args:
            strangers: Whether there are processes that could not be assigned to a program.
            in_exec: Whether one of them is in an exec.
        """
        if not strangers:
            return False
        now = time.monotonic()
        self._doubted = self._doubted or now
        return now < self._doubted + (EXEC_S if in_exec else LOOK_S / 2)

    def advance(self, rest: list[int]) -> None:
        """Send the signal that is due, if any.

        While the first process is alive, SIGINT and SIGTERM go only to its process group, as from a
        terminal, since it may end its children in a certain order.

        Args:
            rest: The processes of the program.
        """
        self._doubted = 0.0
        now = time.monotonic()
        if now < self._due:
            return
        name, wait_s = self._steps.pop(0) if self._steps else ("SIGKILL", 0.0)
        self._due = now + wait_s
        number = signal.Signals[name]
        if not self.ended and number != signal.SIGKILL:
            send(os.killpg, self.pid, number)
        else:
            for pid in rest:
                send(os.kill, pid, number)


def send(function: Any, pid: int, number: signal.Signals) -> None:
    """Send a signal to a process or group that may have ended meanwhile."""
    # Ended meanwhile, or runs as another user, as with sudo.
    with suppress(ProcessLookupError, PermissionError):
        function(pid, number)


def token_of(guardian: int, number: int) -> str:
    """Return the token in the environment of a program's processes."""
    return f"{guardian}.{number}"


class Guardian:
    """Starts programs, and reports and stops them, in one thread.

    Args:
        link: The socket to the supervisor.
    """

    def __init__(self, link: socket.socket) -> None:
        self._link: socket.socket | None = link
        self._programs: dict[int, Program] = {}  # in the order of their starts
        self._wake, wake = socket.socketpair()
        self._wake.setblocking(False)
        wake.setblocking(False)
        self._waker = wake
        for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGCHLD"):
            signal.signal(signal.Signals[name], lambda *_: None)
        signal.set_wakeup_fd(wake.fileno(), warn_on_full_buffer=False)

    def run(self) -> None:
        """Serve the supervisor until it is gone and every process of the system has ended."""
        while self._link is not None or not self._is_over():
            self._wait()
            self._reap()
            if self._link is None:
                self._stop_next()
            self._advance()

    def _is_over(self) -> bool:
        return all(program.gone for program in self._programs.values()) and not children()

    def _wait(self) -> None:
        poll = select.poll()
        poll.register(self._wake, select.POLLIN)
        if self._link is not None:
            poll.register(self._link, select.POLLIN)
        else:
            for program in self._programs.values():
                for output in program.outputs:
                    poll.register(output, select.POLLIN)
        busy = self._link is None or any(
            program.stopping and not program.gone for program in self._programs.values()
        )
        for descriptor, _ in poll.poll(LOOK_S * 1000 if busy else None):
            if descriptor == self._wake.fileno():
                self._wake.recv(4096)
            elif self._link is not None:
                self._receive(self._link)
            else:
                self._drain(descriptor)

    def _drain(self, descriptor: int) -> None:
        """Drain unread output, so that a program that prints while ending is not blocked."""
        output = b""
        with suppress(OSError):  # a terminal that nobody has open any more
            output = os.read(descriptor, 1 << 16)
        if not output:
            for program in self._programs.values():
                if descriptor in program.outputs:
                    os.close(descriptor)
                    program.outputs.remove(descriptor)

    # Commands and events

    def _receive(self, link: socket.socket) -> None:
        try:
            packet, descriptors, _, _ = socket.recv_fds(link, 65536, 6)
        except ConnectionError:
            packet, descriptors = b"", []
        if not packet:
            self._link = None
            link.close()
            return
        command = json.loads(packet)
        if command["do"] == "start":
            self._start(command["number"], *descriptors)
        elif command["do"] == "stop":
            program = self._programs.get(command["number"])
            if program is not None and not program.gone:
                program.stop()
        elif command["do"] == "kill":
            for program in self._programs.values():
                program.kill()

    def _tell(self, **event: Any) -> None:
        if self._link is not None:
            with suppress(OSError):  # it is gone; the next check will notice
                self._link.send(json.dumps(event).encode())

    def _start(
        self, number: int, description: int, stdin: int, stdout: int, stderr: int, *outputs: int
    ) -> None:
        with open(description, "rb") as file:  # a descriptor
            program = json.load(file)
        env = program["env"]
        token = token_of(os.getpid(), number)
        env[TOKEN_VARIABLE] = ":".join(filter(None, [env.get(TOKEN_VARIABLE), token]))
        try:
            process = subprocess.Popen(  # noqa: S603  # the programs of the user's system
                program["argv"],
                env=env,
                cwd=program["cwd"],
                stdin=stdin,
                stdout=stdout,
                stderr=stderr,
                start_new_session=True,
            )
        except OSError as error:
            for output in outputs:
                os.close(output)
            self._tell(event="refused", number=number, text=str(error))
        else:
            process.returncode = 0  # reaped here, not by subprocess
            self._programs[number] = Program(
                number, process.pid, [*outputs], program["ladder"], os.getpid()
            )
            self._tell(event="started", number=number, pid=process.pid)
        finally:
            for descriptor in (stdin, stdout, stderr):
                os.close(descriptor)

    # Processes

    def _reap(self) -> None:
        by_pid = {program.pid: program for program in self._programs.values() if not program.ended}
        while True:
            try:
                pid, status = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return
            if not pid:
                return
            program = by_pid.get(pid)
            if program is not None:
                program.note_end()
                code = os.waitstatus_to_exitcode(status)
                self._tell(event="exited", number=program.number, code=code)

    def _stop_next(self) -> None:
        """Stop the last running program; the earlier ones follow when it is gone."""
        for program in reversed(self._programs.values()):
            if not program.gone:
                program.stop()
                return
        for (
            pid
        ) in children():  # assigned to no program: their sessions and environments are their own
            send(os.kill, pid, signal.SIGKILL)

    def _advance(self) -> None:
        stopping = [
            program for program in self._programs.values() if program.stopping and not program.gone
        ]
        if not stopping:
            return
        processes = descendants(os.getpid())
        owned = owned_by(self._programs.values(), processes)
        known = {pid for pids in owned.values() for pid in pids}
        strangers = [pid for pid, _, _ in processes if pid not in known]
        in_exec = any(map(is_in_exec, strangers))
        for program in stopping:
            rest = owned.get(program.number, [])
            if program.ended and not rest:
                if program.is_left(strangers=bool(strangers), in_exec=in_exec):
                    continue
                program.gone = True
                self._forget(program)
                self._tell(event="gone", number=program.number)
            else:
                program.advance(rest)

    def _forget(self, program: Program) -> None:
        if self._link is not None:
            for output in program.outputs:
                os.close(output)
            del self._programs[program.number]


def owned_by(
    programs: Collection[Program], processes: Iterable[tuple[int, int, int]]
) -> dict[int, list[int]]:
    """Return the live processes of each program, by program number.

    Args:
        programs: The programs.
        processes: Process, parent and session of the candidates, parents first.
    """
    sessions = {program.pid: program.number for program in programs}
    tokens = {program.token: program.number for program in programs}
    owners: dict[int, int] = {}
    for pid, parent, session in processes:
        number = sessions.get(session, owners.get(parent))
        if number is None:
            number = next((tokens[token] for token in tokens_in(pid) if token in tokens), None)
        if number is not None:
            owners[pid] = number
    owned: dict[int, list[int]] = {}
    for pid, number in owners.items():
        owned.setdefault(number, []).append(pid)
    return owned


def descendants(ancestor: int) -> list[tuple[int, int, int]]:
    """Return process, parent and session of all live descendants, parents first.

    Args:
        ancestor: The process; 0 for all processes.
    """
    below: dict[int, list[tuple[int, int, int]]] = {}
    for name in os.listdir("/proc"):  # noqa: PTH208  # imports here slow down every start
        if name.isdigit() and (fields := stat_of(name)) and fields[0] not in {"Z", "X"}:
            parent, session = int(fields[1]), int(fields[3])
            below.setdefault(parent, []).append((int(name), parent, session))
    group = below.get(ancestor, [])
    for pid, _, _ in group:  # grows meanwhile
        group.extend(below.get(pid, []))
    return group


def children() -> list[int]:
    """Return the live processes below this one."""
    return [pid for pid, _, _ in descendants(os.getpid())]


def stat_of(name: str) -> list[str]:
    """Return the fields of ``/proc/PID/stat`` after the program name; none if it is gone."""
    try:
        file = os.open(f"/proc/{name}/stat", os.O_RDONLY)
        try:
            return os.read(file, 4096).decode(errors="replace").rpartition(")")[2].split()
        finally:
            os.close(file)
    except OSError:
        return []


def is_in_exec(pid: int) -> bool:
    """Return whether a process that had no token is in an exec, or has come out of one meanwhile.

    In an exec it has no arguments either. It may stay there for long where it waits for a
    processor.
    """
    try:
        with open(f"/proc/{pid}/cmdline", "rb") as file:  # noqa: PTH123
            return not file.read(1) or bool(tokens_in(pid))
    except OSError:  # it has ended, or runs as another user
        return False


def tokens_in(pid: int) -> list[str]:
    """Return the tokens in the environment of a process; none if it cannot be read."""
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:  # noqa: PTH123
            entries = file.read().split(b"\0")
    except OSError:
        return []
    start = f"{TOKEN_VARIABLE}=".encode()
    values = [entry[len(start) :].decode() for entry in entries if entry.startswith(start)]
    return values[0].split(":") if values else []


def main() -> None:
    """Serve the supervisor on the socket given as the only argument."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    libc.prctl(PR_SET_NAME, b"aionode-guard", 0, 0, 0)
    Guardian(socket.socket(fileno=int(sys.argv[1]))).run()


if __name__ == "__main__":
    main()
