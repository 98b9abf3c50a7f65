"""A program as a member of a system."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from aionode.errors import ProgramStartError
from aionode.system._guard import ProgramDescription
from aionode.system._member import Member
from aionode.system._status import MemberEnd, end_text, shell_status

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from aionode.system._guard import Guard, RunningProgram
    from aionode.system._limits import Limits
    from aionode.system._member import Host, Options
    from aionode.system._output import OutputReader

__all__ = ["ProcessHost", "ProcessMember", "ProcessOptions"]


@dataclass(frozen=True)
class ProcessOptions:
    """What only processes have.

    Attributes:
        argv: The command line.
        env: Variables beside those of the system.
        cwd: The working folder.
        stdin: Whether it reads the keyboard: it gets the terminal.
        term_after_sec: How long after SIGINT it gets SIGTERM, in seconds.
        kill_after_sec: How long after SIGTERM it gets SIGKILL, in seconds.
        limits: Of memory and processors.
    """

    argv: Sequence[str]
    env: Mapping[str, str]
    cwd: str | None
    stdin: bool
    term_after_sec: float
    kill_after_sec: float
    limits: Limits

    def ladder(self) -> list[tuple[str, float]]:
        """Return the signals that end it, and how long each is waited for, in seconds."""
        return [
            ("SIGINT", self.term_after_sec),
            ("SIGTERM", self.kill_after_sec),
            ("SIGKILL", 0.0),
        ]


class ProcessHost(Protocol):
    """What a process needs of its system beside what each member does."""

    guard: Guard
    reader: OutputReader

    def environment(self) -> dict[str, str]:
        """Return the environment of its processes."""
        ...


class ProcessMember(Member):
    """A program, started by the guardian.

    Args:
        name: Its name in the system.
        host: The system.
        processes: The same, for what processes need.
        options: What both kinds have in common.
        process: What only processes have.
    """

    def __init__(
        self,
        name: str,
        host: Host,
        processes: ProcessHost,
        options: Options,
        process: ProcessOptions,
    ) -> None:
        super().__init__(name, host, options)
        self._processes = processes
        self.process = process

    async def run_once(self, stop: asyncio.Event) -> MemberEnd:
        """Start it, and wait until no process of it is left."""
        cgroup = self.process.limits.enter(self.name, self.host.log)
        pipe, program = self._start(cgroup)
        try:
            await program.started
        except ProgramStartError as error:
            self._processes.reader.remove(pipe)
            self.host.log.note(f"{self.name}: {error}")
            return MemberEnd(self.name, failed=True, text="could not be started", status=127)
        self.note_running(program.pid)
        stopper = self.host.tasks.create_task(self._stop_at(stop, program))
        try:
            code = await program.exited
            await program.gone
        finally:
            stopper.cancel()
            self._processes.reader.remove(pipe)
            self.process.limits.leave(cgroup)
        if stop.is_set() and code == -signal.SIGKILL:
            self.host.log.note(f"{self.name} did not end by itself, and {end_text(code)}")
        return MemberEnd(
            self.name, failed=code != 0, text=end_text(code), status=shell_status(code)
        )

    async def _stop_at(self, stop: asyncio.Event, program: RunningProgram) -> None:
        await stop.wait()
        self.set_state("stopping")
        self._processes.guard.stop(program)

    def _start(self, cgroup: str | None) -> tuple[int, RunningProgram]:
        """Have it started; return the pipe that it prints to, and the program."""
        output, pipe = os.pipe()
        os.set_blocking(output, False)
        null = os.open(os.devnull, os.O_RDONLY)
        streams = [null, pipe, pipe]
        if self.process.stdin and sys.__stdin__ is not None:
            terminal = sys.__stdin__.fileno()
            streams[0] = terminal
            if os.isatty(terminal) and os.isatty(1):
                streams[1] = 1
        description = ProgramDescription(
            [os.fspath(word) for word in self.process.argv],
            self._processes.environment() | {"PYTHONUNBUFFERED": "1"} | dict(self.process.env),
            self.process.ladder(),
            self.process.cwd,
            cgroup,
        )
        program = self._processes.guard.start(description, streams, output)
        os.close(pipe)
        os.close(null)
        self._processes.reader.add(output, self.name)
        return output, program
