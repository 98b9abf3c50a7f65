"""The supervisor's side of the guardian: starts programs, and learns of their fate."""

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

from aionode._process.sudden_end import SENDS
from aionode.errors import ProgramStartError
from aionode.system import _guardian
from aionode.system._guardian import LOOK_S, Program, descendants, owned_by, send

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

__all__ = ["Guard", "ProgramDescription", "RunningProgram"]

LOST: Final = "the guardian of the system has ended"

END_LIMIT_SEC: Final = 30.0
"""Maximum wait for the guardian at the end, in seconds: both signals, for two generations."""


def future() -> asyncio.Future[Any]:
    """Return a future of the running loop."""
    return asyncio.get_running_loop().create_future()


@dataclass(frozen=True)
class ProgramDescription:
    """A program to start.

    Attributes:
        argv: The command line.
        env: The whole environment.
        ladder: The signals that end the program, each with the time before the next, in seconds.
        cwd: The working directory; the supervisor's if None.
    """

    argv: Sequence[str]
    env: Mapping[str, str]
    ladder: Sequence[tuple[str, float]]
    cwd: str | None = None

    def encoded(self) -> bytes:
        """Encode it as JSON for the guardian."""
        return json.dumps(
            {
                "argv": list(self.argv),
                "env": dict(self.env),
                "ladder": list(self.ladder),
                "cwd": self.cwd,
            }
        ).encode()


@dataclass
class RunningProgram:
    """A program that the guardian was told to start.

    Attributes:
        number: Its number for the guardian.
        pid: The id of its first process, also its process group.
        started: Done when it runs; fails with ProgramStartError.
        exited: Done when its first process has ended, with the exit code; negative for a signal,
            None if unknown because the guardian was gone.
        gone: Done when none of its processes is left.
        is_stopping: Whether the guardian was told to stop it.
    """

    number: int
    pid: int = 0
    is_stopping: bool = False
    started: asyncio.Future[None] = field(default_factory=future)
    exited: asyncio.Future[int | None] = field(default_factory=future)
    gone: asyncio.Future[None] = field(default_factory=future)

    def note(self, event: Mapping[str, Any], argv: Sequence[str]) -> None:
        """Handle an event of the guardian."""
        if event["event"] == "started":
            self.pid = event["pid"]
            settle(self.started, None)
        elif event["event"] == "refused":
            self.refuse(argv, event["text"])
        elif event["event"] == "exited":
            settle(self.exited, event["code"])
        else:
            settle(self.gone, None)

    def refuse(self, argv: Sequence[str], text: str) -> None:
        """End all waits, as the program was not started."""
        if not self.started.done():
            self.started.set_exception(ProgramStartError(list(argv), text))
        settle(self.exited, None)
        settle(self.gone, None)


def settle(waiter: asyncio.Future[Any], value: object) -> None:
    """Set the result of a future, unless it is done."""
    if not waiter.done():
        waiter.set_result(value)


class Orphans:
    """Programs whose guardian was killed; the supervisor stops them itself, with the same signals.

    They have other parents now, so their exit codes are unknown. All processes on the system are
    searched for theirs, ten times a second, until none is left.

    Args:
        guardian: The process of the guardian.
        programs: The programs and their descriptions.
    """

    def __init__(
        self, guardian: int, programs: Iterable[tuple[RunningProgram, ProgramDescription]]
    ) -> None:
        self._left: dict[int, tuple[RunningProgram, Program]] = {}
        for running, description in programs:
            # A program that was just starting is stopped too; its session is unknown, but its token
            # is known.
            pid = running.pid or -1
            program = Program(running.number, pid, [], list(description.ladder), guardian)
            if not running.started.done():
                running.refuse(description.argv, LOST)
                program.note_end()
            elif running.is_stopping:
                program.stop()
            self._left[running.number] = running, program
        self._look()

    def stop(self, running: RunningProgram) -> None:
        """Stop one program with the signals of its description."""
        if running.number in self._left:
            self._left[running.number][1].stop()

    def kill(self) -> None:
        """Kill all programs now."""
        for pids in self._owned().values():
            for pid in pids:
                send(os.kill, pid, signal.SIGKILL)

    def _owned(self) -> dict[int, list[int]]:
        return owned_by([program for _, program in self._left.values()], descendants(0))

    def _look(self) -> None:
        owned = self._owned()
        for number, (running, program) in list(self._left.items()):
            rest = owned.get(number, [])
            if not program.ended and program.pid not in rest:
                program.note_end()
                settle(running.exited, None)
            if not rest:
                settle(running.gone, None)
                del self._left[number]
            elif program.stopping:
                program.advance(rest)
        if self._left:
            asyncio.get_running_loop().call_later(LOOK_S, self._look)


class Guard:
    """The guardian of one system, from `open` to `close`.

    Args:
        on_lost: Called with its exit code if the guardian ends unasked.
    """

    def __init__(self, on_lost: Callable[[int], object]) -> None:
        self._on_lost = on_lost
        self._loop = asyncio.get_running_loop()
        self._link, self._other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._link.setblocking(False)
        self._process: subprocess.Popen[bytes] | None = None
        self._programs: dict[int, tuple[RunningProgram, ProgramDescription]] = {}
        self._orphans: Orphans | None = None
        self._last_number = 0
        self._unsent: list[tuple[bytes, list[int]]] = []
        self._ended = asyncio.Event()
        self._closing = False

    def open(self) -> None:
        """Start the guardian."""
        file = str(Path(_guardian.__file__))
        # Not asyncio's subprocesses, which may set a SIGCHLD handler; that belongs to the program.
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
        self, description: ProgramDescription, streams: Sequence[int], outputs: Sequence[int]
    ) -> RunningProgram:
        """Ask the guardian to start a program; the caller closes its descriptors afterwards.

        Args:
            description: The program to start.
            streams: Its standard input, output and error.
            outputs: The read ends of its output. The guardian keeps them open, so that after the
                supervisor's end a program that prints while ending is not killed by SIGPIPE.
        """
        self._last_number += 1
        program = RunningProgram(self._last_number)
        if self._ended.is_set():
            program.refuse(description.argv, LOST)
            return program
        with contextlib.ExitStack() as copies:
            text = os.memfd_create("aionode-program")
            copies.callback(os.close, text)
            os.write(text, description.encoded())
            os.lseek(text, 0, os.SEEK_SET)
            descriptors = [text]
            for descriptor in (*streams, *outputs):
                descriptors.append(os.dup(descriptor))
                copies.callback(os.close, descriptors[-1])
            copies.pop_all()
        self._programs[program.number] = (program, description)
        self._send({"do": "start", "number": program.number}, descriptors)
        return program

    def stop(self, program: RunningProgram) -> None:
        """Ask the guardian to stop a program with the signals of its description."""
        program.is_stopping = True
        if self._orphans is None:
            self._send({"do": "stop", "number": program.number})
        else:
            self._orphans.stop(program)

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
            except OSError:  # it has ended; `_receive` will notice
                pass
            del self._unsent[0]
            for descriptor in descriptors:
                os.close(descriptor)
        self._loop.remove_writer(self._link)

    def _kill_at_sudden_end(self, _ends_ns: int) -> bool:
        """Kill every process when a second signal ends this process at once."""
        if self._orphans is not None:
            self._orphans.kill()
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
            program, description = self._programs[event["number"]]
            program.note(event, description.argv)
            if program.gone.done():
                del self._programs[event["number"]]

    def _note_end(self) -> None:
        self._loop.remove_reader(self._link)
        self._ended.set()
        if self._closing:
            return
        assert self._process is not None  # noqa: S101  # set by `open`
        self._orphans = Orphans(self._process.pid, self._programs.values())
        self._on_lost(self._process.wait())

    async def close(self) -> bool:
        """End the guardian, which stops what is left; return whether it ended."""
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
