"""The supervisor's end of the guardian: starts programs, and hears what becomes of them."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode._sudden_end import SENDS
from aionode.errors import ProgramStartError
from aionode.system import _guardian

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

__all__ = ["Guard", "ProgramDescription", "RunningProgram"]

END_LIMIT_SEC: Final = 30.0
"""How long the guardian is waited for at the end, in seconds: both signals, for two generations."""


def future() -> asyncio.Future[Any]:
    """Return a future of the running loop."""
    return asyncio.get_running_loop().create_future()


@dataclass(frozen=True)
class ProgramDescription:
    """What is started.

    Attributes:
        argv: The command line.
        env: The whole environment.
        ladder: The signals that end it, and how long each is waited for, in seconds.
        cwd: The working folder; that of the supervisor if None.
        cgroup: The folder of the cgroup that it enters; none if None.
    """

    argv: Sequence[str]
    env: Mapping[str, str]
    ladder: Sequence[tuple[str, float]]
    cwd: str | None = None
    cgroup: str | None = None

    def encoded(self) -> bytes:
        """Return it as JSON, for the guardian."""
        return json.dumps(
            {
                "argv": list(self.argv),
                "env": dict(self.env),
                "ladder": list(self.ladder),
                "cwd": self.cwd,
                "cgroup": self.cgroup,
            }
        ).encode()


@dataclass
class RunningProgram:
    """A program that the guardian was told to start.

    Attributes:
        number: By which the guardian knows it.
        pid: Of its first process, which is also its process group.
        started: Done when it runs; fails with ProgramStartError.
        exited: Done when its first process has ended, with the exit code; negative for a signal.
        gone: Done when no process of it is left.
    """

    number: int
    pid: int = 0
    started: asyncio.Future[None] = field(default_factory=future)
    exited: asyncio.Future[int] = field(default_factory=future)
    gone: asyncio.Future[None] = field(default_factory=future)

    def note(self, event: Mapping[str, Any], argv: Sequence[str]) -> None:
        """Take an event of the guardian."""
        if event["event"] == "started":
            self.pid = event["pid"]
            settle(self.started, None)
        elif event["event"] == "refused":
            self.started.set_exception(ProgramStartError(list(argv), event["text"]))
            settle(self.exited, -signal.SIGKILL)
            settle(self.gone, None)
        elif event["event"] == "exited":
            settle(self.exited, event["code"])
        else:
            settle(self.gone, None)

    def lose(self) -> None:
        """End all waits: the guardian is gone, and its programs were killed."""
        settle(self.started, None)
        settle(self.exited, -signal.SIGKILL)
        settle(self.gone, None)


def settle(waiter: asyncio.Future[Any], value: object) -> None:
    """Set the result of a future, unless it is done."""
    if not waiter.done():
        waiter.set_result(value)


class Guard:
    """The guardian of one system, from `open` to `close`.

    Args:
        on_lost: Called if the guardian ends before it is told to.
    """

    def __init__(self, on_lost: Callable[[], object]) -> None:
        self._on_lost = on_lost
        self._loop = asyncio.get_running_loop()
        self._link, self._other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._link.setblocking(False)
        self._process: subprocess.Popen[bytes] | None = None
        self._programs: dict[int, tuple[RunningProgram, Sequence[str]]] = {}
        self._last_number = 0
        self._unsent: list[tuple[bytes, list[int]]] = []
        self._ended = asyncio.Event()
        self._closing = False

    def open(self) -> None:
        """Start the guardian."""
        file = str(Path(_guardian.__file__))
        # Not asyncio's subprocesses: they may set a handler of SIGCHLD, which is the program's.
        self._process = subprocess.Popen(  # noqa: S603  # a program of aionode's own
            [sys.executable, "-I", "-S", file, str(self._other.fileno())],
            pass_fds=[self._other.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            start_new_session=True,
        )
        self._other.close()
        self._loop.add_reader(self._link, self._receive)
        SENDS.append(self._kill_at_sudden_end)

    def start(
        self, description: ProgramDescription, streams: Sequence[int], output: int
    ) -> RunningProgram:
        """Have a program started; the caller closes its descriptors afterwards.

        Args:
            description: What is started.
            streams: Its standard input, output and error.
            output: The end of its output that is read. The guardian keeps it open, so that a
                program that prints as it ends is not killed for it, after the supervisor has ended.
        """
        self._last_number += 1
        program = RunningProgram(self._last_number)
        self._programs[program.number] = (program, description.argv)
        if self._ended.is_set():
            program.started.set_exception(
                ProgramStartError(list(description.argv), "the guardian of the system has ended")
            )
            program.lose()
            return program
        text = os.memfd_create("aionode-program")
        os.write(text, description.encoded())
        os.lseek(text, 0, os.SEEK_SET)
        self._send(
            {"do": "start", "number": program.number}, [text, *map(os.dup, (*streams, output))]
        )
        return program

    def stop(self, program: RunningProgram) -> None:
        """Have a program stopped by the signals of its description."""
        self._send({"do": "stop", "number": program.number})

    def kill(self) -> None:
        """Have every process of the system killed, now."""
        self._send({"do": "kill"})

    def _send(self, command: Mapping[str, Any], descriptors: Sequence[int] = ()) -> None:
        self._unsent.append((json.dumps(command).encode(), list(descriptors)))
        if len(self._unsent) == 1:
            self._flush()

    def _flush(self) -> None:
        while self._unsent:
            packet, descriptors = self._unsent[0]
            try:
                socket.send_fds(self._link, [packet], descriptors)
            except BlockingIOError:
                self._loop.add_writer(self._link, self._flush)
                return
            except OSError:  # it has ended, which `_receive` notices
                pass
            del self._unsent[0]
            for descriptor in descriptors:
                os.close(descriptor)
        self._loop.remove_writer(self._link)

    def _kill_at_sudden_end(self, _ends_ns: int) -> bool:
        """Have every process killed when a second signal ends this process at once."""
        with contextlib.suppress(OSError):
            self._link.send(json.dumps({"do": "kill"}).encode())
        return False

    def _receive(self) -> None:
        while True:
            try:
                packet = self._link.recv(65536)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                self._note_end()
                return
            event = json.loads(packet)
            program, argv = self._programs[event["number"]]
            program.note(event, argv)
            if program.gone.done():
                del self._programs[event["number"]]

    def _note_end(self) -> None:
        self._loop.remove_reader(self._link)
        self._ended.set()
        if self._closing:
            return
        for program, _ in reversed(self._programs.values()):
            if program.pid and not program.exited.done():
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.killpg(program.pid, signal.SIGKILL)
            program.lose()
        self._on_lost()

    async def close(self) -> bool:
        """End the guardian, which stops what is left; return whether it has ended."""
        assert self._process is not None  # noqa: S101  # set by `open`
        self._closing = True
        with contextlib.suppress(OSError):
            self._link.shutdown(socket.SHUT_WR)
        try:
            async with asyncio.timeout(END_LIMIT_SEC):
                await self._ended.wait()
        except TimeoutError:
            pass
        SENDS.remove(self._kill_at_sudden_end)
        self._loop.remove_reader(self._link)
        self._loop.remove_writer(self._link)
        self._link.close()
        if self._ended.is_set():
            self._process.wait()
        return self._ended.is_set()
