"""A program as a member of a system."""

from __future__ import annotations

import asyncio
import errno
import os
import signal
import sys
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from aionode.system._guard import ProgramDescription
from aionode.system._member import Member
from aionode.system._output import open_output
from aionode.system._status import MemberEnd, end_text, shell_status

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from aionode.system._guard import Guard, RunningProgram
    from aionode.system._member import Host, Options
    from aionode.system._output import OutputReader

__all__ = ["ProcessHost", "ProcessMember", "ProcessOptions"]


@dataclass(frozen=True)
class ProcessOptions:
    """The options of processes only.

    Attributes:
        argv: The command line.
        env: Variables in addition to those of the system; None removes one.
        cwd: The working directory.
        stdin: Whether it reads the keyboard and thus gets the terminal.
        term_after_sec: How long after SIGINT it gets SIGTERM, in seconds.
        kill_after_sec: How long after SIGTERM it gets SIGKILL, in seconds.
        terminal: Whether it prints to its own terminal.
        on_output: Called with its output, and with 1 for standard output or 2 for error.
    """

    argv: Sequence[str]
    env: Mapping[str, str | None]
    cwd: str | None
    stdin: bool
    term_after_sec: float
    kill_after_sec: float
    terminal: bool = False
    on_output: Callable[[bytes, int], object] | None = None

    def ladder(self) -> list[tuple[str, float]]:
        """Return the signals that end it, and how long to wait after each, in seconds."""
        return [
            ("SIGINT", self.term_after_sec),
            ("SIGTERM", self.kill_after_sec),
            ("SIGKILL", 0.0),
        ]


class ProcessHost(Protocol):
    """The methods of a system that processes call, in addition to those for all members."""

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
        processes: The system again, as the host of processes.
        options: The options that both kinds share.
        process: The options of processes.
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
        """Start the program, and wait until none of its processes is left."""
        pipes: list[int] = []
        try:
            pipes, program = self._start()
            await program.started
        except OSError as error:  # a ProgramStartError, or out of descriptors
            self._stop_reading(pipes)
            self.host.log.note(f"{self.name}: {error}{hint_at_limit(error)}")
            return MemberEnd(self.name, failed=True, text="could not be started", status=127)
        self.note_running(program.pid)
        stopper = self.host.tasks.create_task(self._stop_at(stop, program))
        try:
            code = await program.exited
            await program.gone
        finally:
            stopper.cancel()
            self._stop_reading(pipes)
        if stop.is_set() and code == -signal.SIGKILL:
            self.host.log.note(f"{self.name} did not end by itself, and {end_text(code)}")
        return MemberEnd(
            self.name,
            failed=code != 0,
            text=end_text(code),
            status=shell_status(code),
            code=code,
        )

    async def _stop_at(self, stop: asyncio.Event, program: RunningProgram) -> None:
        await stop.wait()
        self.set_state("stopping")
        self._processes.guard.stop(program)

    def _stop_reading(self, pipes: Sequence[int]) -> None:
        for pipe in pipes:
            self._processes.reader.remove(pipe)

    def _start(self) -> tuple[list[int], RunningProgram]:
        """Start the program; return its output pipes and what runs.

        Both streams share one pipe, which keeps the order of their lines, unless they have to be
        told apart.
        """
        with ExitStack() as given, ExitStack() as kept:
            program, outputs = self._hand_over(given, kept)
            kept.pop_all()
        for stream, output in enumerate(outputs, start=1):
            self._processes.reader.add(output, self.name, stream, self.process.on_output)
        return outputs, program

    def _hand_over(self, given: ExitStack, kept: ExitStack) -> tuple[RunningProgram, list[int]]:
        """Start it; return the program and its outputs. The stacks close descriptors."""
        outputs: list[int] = []
        streams = [os.open(os.devnull, os.O_RDONLY)]
        given.callback(os.close, streams[0])
        for _ in range(1 if self.process.on_output is None else 2):
            output, pipe = open_output(terminal=self.process.terminal)
            kept.callback(os.close, output)
            given.callback(os.close, pipe)
            outputs.append(output)
            streams.append(pipe)
        streams = [streams[0], streams[1], streams[-1]]
        if self.process.stdin and sys.__stdin__ is not None:
            terminal = sys.__stdin__.fileno()
            streams[0] = terminal
            if os.isatty(terminal) and os.isatty(1):
                streams[1] = 1
        variables = {"PYTHONUNBUFFERED": "1", **self.process.env}
        env = self._processes.environment() | variables
        description = ProgramDescription(
            [os.fspath(word) for word in self.process.argv],
            {name: value for name, value in env.items() if value is not None},
            self.process.ladder(),
            self.process.cwd,
        )
        return self._processes.guard.start(description, streams, outputs), outputs


def hint_at_limit(error: OSError) -> str:
    """Return advice for an error, if this process is out of file descriptors."""
    if error.errno != errno.EMFILE:
        return ""
    return "; each program takes some of the open files of this process: raise `ulimit -n`"
