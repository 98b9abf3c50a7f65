"""Runs fault cases: starts the processes, applies the fault, and counts.

A `Case` consists of the roles of its processes, a fault, and promises. Whatever happens, no process
outlives its case: each leads a process group that is killed at the end.
"""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import signal
import sys
import tempfile
import termios
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from pathlib import Path
from typing import Any, Literal, Protocol

import msgspec

from tests.faults.motion.words import Handed
from tests.faults.roles import (
    REPORTS_VARIABLE,
    Report,
    Role,
    hear_mark,
    missing,
    stream_key,
)
from tests.support.peers import isolated_environment

__all__ = [
    "END_S",
    "GAP_LIMIT_S",
    "RECOVERY_LIMIT_S",
    "Case",
    "Job",
    "Outcome",
    "Skipped",
    "Stage",
    "run_case",
    "run_together",
]

ROOT = Path(__file__).parent.parent.parent
RCLPY_PROGRAM = Path(__file__).with_name("motion") / "rclpy_program.py"

READY_LIMIT_S = 30.0
"""How long all processes may take until they receive from each other, on a busy machine."""

RECOVERY_LIMIT_S = 20.0
"""Time after which anything that does not work again counts as hung, in seconds."""

BEFORE_S = 1.0
"""How long everything works before the fault, in seconds."""

START_S = 1.0
"""How long a process that replaces another may still be busy starting, in seconds."""

AFTER_S = 1.5
"""How long everything works after the fault, in seconds."""

QUIET_LIMIT_S = 10.0
"""How long messages in transit may take to arrive when nothing more is sent, in seconds."""

END_LIMIT_S = 30.0
"""How long a process may take to end on a busy machine before it is killed, in seconds."""


END_S = 3.0
"""How long ending should take: a second more than it waits for readers that lack messages."""

BUSY = 2
"""How many cases start or end processes at a time, which takes the processor from all others."""

GAP_LIMIT_S = 0.05
"""How long a loop may be stalled by itself, in seconds."""

CONTROL = Role("control", control=True)
"""A process that does next to nothing, which measures how long the machine makes any process wait.
"""


class Skipped(Exception):  # noqa: N818  # no error
    """The machine cannot run this case; the text says why."""


class Outcome(msgspec.Struct):
    """The outcome of one run of a case.

    Attributes:
        sent: Number of messages, counted once per reader, and of calls and goals.
        lost: How many of them did not arrive, or ended with an error.
        kept_lost: How many messages of KEEP_ALL publishers are among these.
        healthy_lost: How many messages between processes that were not hurt are among these.
        told: How many of those were reported: counted by a publisher or subscription, or an error.
        doubled: How many arrived twice.
        hung: What did not recover, exceeded its time limit, or did not end.
        recovery_s: From the end of the fault until everything worked again.
        gap_s: The longest stall of the loop of a process that was not struck.
        own_gap_s: The same, without the time for which its threads waited for a core.
        control_gap_s: Like `gap_s`, for a control process without a node.
        control_own_gap_s: Like `own_gap_s`, for that process: the machine itself was stalled.
        end_s: The longest time that a process took to end after SIGTERM.
        control_end_s: Like `end_s`, for the process without a node.
    """

    sent: int = 0
    lost: int = 0
    kept_lost: int = 0
    healthy_lost: int = 0
    told: int = 0
    doubled: int = 0
    hung: list[str] = []
    recovery_s: float = 0.0
    gap_s: float = 0.0
    own_gap_s: float = 0.0
    control_gap_s: float = 0.0
    control_own_gap_s: float = 0.0
    end_s: float = 0.0
    control_end_s: float = 0.0


class Case(msgspec.Struct, frozen=True):
    """Processes, and what happens to them.

    Attributes:
        name: What happens, for the table.
        roles: The processes.
        strike: The fault; returns when it is over.
        hurt: Names of the processes whose own event loop the fault blocks.
        loss: What may be lost: ``none`` of a KEEP_ALL publisher, and of others only what is
            reported; only what is reported (``told``); or ``any``, if readers that a publisher
            considers gone miss what it sends meanwhile.
        recovery_limit_s: Time after which everything has to work again.
        lasts_s: About how long the fault takes; the longest start first.
        short: Whether it is part of the ordinary tests.
        around: What has to exist before its processes start, such as two hosts.
    """

    name: str
    roles: tuple[Role, ...]
    strike: Callable[[Stage], Awaitable[None]]
    hurt: tuple[str, ...] = ()
    loss: Literal["none", "told", "any"] = "none"
    recovery_limit_s: float = 5.0
    lasts_s: float = 5.0
    short: bool = False
    around: contextlib.AbstractContextManager[None] = contextlib.nullcontext()

    async def run(self, busy: asyncio.Semaphore) -> Sequence[tuple[Case, Outcome | Exception]]:
        """Run once; see `run_case`."""
        try:
            return [(self, await run_case(self, busy))]
        except Exception as error:  # noqa: BLE001 - it is reported
            return [(self, error)]

    def broken(
        self, outcome: Outcome, gap_limit_s: float = GAP_LIMIT_S, end_limit_s: float = END_S
    ) -> list[str]:
        """Return the promises that an outcome breaks."""
        untold = outcome.lost - outcome.told
        return [
            text
            for is_broken, text in (
                (
                    self.loss == "none" and outcome.kept_lost > 0,
                    f"{outcome.kept_lost} of {outcome.sent} lost",
                ),
                (
                    self.loss != "any" and bool(self.hurt) and outcome.healthy_lost > 0,
                    f"{outcome.healthy_lost} lost between others",
                ),
                (self.loss != "any" and untold > 0, f"{untold} of {outcome.sent} lost untold"),
                (outcome.doubled > 0, f"{outcome.doubled} doubled"),
                (bool(outcome.hung), f"hung: {', '.join(outcome.hung)}"),
                (
                    outcome.recovery_s > self.recovery_limit_s,
                    f"recovered after {outcome.recovery_s:.1f} s, not {self.recovery_limit_s:g} s",
                ),
                (
                    outcome.own_gap_s > gap_limit_s + outcome.control_own_gap_s,
                    f"a loop stood still for {1000 * outcome.own_gap_s:.0f} ms",
                ),
                (
                    outcome.end_s > end_limit_s + outcome.control_end_s,
                    f"ended in {outcome.end_s:.1f} s",
                ),
            )
            if is_broken
        ]


class Child:
    """One process of a case."""

    def __init__(self, role: Role, env: dict[str, str], folder: Path) -> None:
        self.role = role
        self.reports: list[Report] = []
        self.handed: dict[str, list[Handed]] = {}
        self.end_s = 0.0
        self._env = {**os.environ, "PYTHONPATH": str(ROOT), **env, **role.env}
        self._output = folder / f"{role.name}.txt"
        self._process: asyncio.subprocess.Process | None = None
        self._closing = contextlib.ExitStack()
        self._terminal = contextlib.ExitStack()

    async def start(self) -> None:
        """Start it."""
        reading, writing = os.pipe()
        output = self._open_output()
        terminal = self.role.output == "terminal"
        try:
            self._process = await asyncio.create_subprocess_exec(
                *self.role.wrapper,
                self.role.python or sys.executable,
                *command_of(self.role),
                stdin=asyncio.subprocess.PIPE,
                stdout=output,
                stderr=output,
                pass_fds=[writing],
                env={**self._env, REPORTS_VARIABLE: str(writing)},
                cwd=ROOT,
                # A process group of the harness's session can be suspended, one in a session of its
                # own cannot; but only a session leader can have a controlling terminal.
                start_new_session=terminal,
                process_group=None if terminal else 0,
                preexec_fn=take_terminal if terminal else None,
            )
        finally:
            os.close(writing)
            os.close(output)
        reader = asyncio.StreamReader(limit=1 << 24)
        transport, _ = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(reader), os.fdopen(reading, "rb")
        )
        self._closing.callback(transport.close)
        self._reports = reader

    def _open_output(self) -> int:
        """Return a descriptor for its output."""
        match self.role.output:
            case "unread":
                unread, output = os.pipe()
                self._closing.callback(os.close, unread)
            case "terminal":
                terminal, output = os.openpty()
                self._terminal.callback(os.close, terminal)
                loop = asyncio.get_running_loop()
                loop.add_reader(terminal, self._keep_output, terminal)
                self._terminal.callback(loop.remove_reader, terminal)
            case "full":
                output = os.open("/dev/full", os.O_WRONLY)
            case "file":
                output = os.open(self._output, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        return output

    def _keep_output(self, terminal: int) -> None:
        """Copy the output on its terminal to its file."""
        with contextlib.suppress(OSError), self._output.open("ab") as file:
            file.write(os.read(terminal, 1 << 16))

    def hang_up(self) -> None:
        """Close its terminal, as when a connection ends: it gets SIGHUP."""
        self._terminal.close()

    def core_waits(self) -> dict[str, float]:
        """Return how long each of its threads was ready to run without a core, in seconds."""
        waits: dict[str, float] = {}
        for stat in Path(f"/proc/{self.pid}/task").glob("*/schedstat"):
            with contextlib.suppress(OSError):  # the thread has just ended
                waits[stat.parent.name] = int(stat.read_bytes().split()[1]) / 1e9
        return waits

    def core_wait_s(self, before: dict[str, float]) -> float:
        """Return how long it has waited for a core since then.

        The time of its main thread plus the longest of the others, for which the main thread
        may have waited.
        """
        waited = {name: s - before.get(name, 0.0) for name, s in self.core_waits().items()}
        return waited.pop(str(self.pid), 0.0) + max(waited.values(), default=0.0)

    async def read(self) -> None:
        """Read its reports until it has ended."""
        while line := await self._reports.readline():
            report = msgspec.json.decode(line, type=Report)
            self.reports.append(report)
            for each in report.handed:
                self.handed.setdefault(each.topic, []).append(each)

    @property
    def last(self) -> Report:
        """The newest report, an empty one before the first."""
        return self.reports[-1] if self.reports else Report()

    @property
    def started_s(self) -> float:
        """When its start was over, including imports and the first use of its types."""
        return next((each.time_s for each in self.reports if each.ready), 0.0) + START_S

    @property
    def runs(self) -> bool:
        """Whether it still runs."""
        return self._process is not None and self._process.returncode is None

    def send(self, number: int) -> None:
        """Send a signal to its process group."""
        if self._process is not None and self.runs:
            with contextlib.suppress(ProcessLookupError):  # it has just ended
                os.killpg(self._process.pid, number)

    @property
    def pid(self) -> int:
        """Its process id."""
        assert self._process is not None
        return self._process.pid

    def tell(self, word: str) -> None:
        """Send it a command, as a line on its stdin."""
        if self._process is not None and self._process.stdin is not None and self.runs:
            with contextlib.suppress(ConnectionError):
                self._process.stdin.write(f"{word}\n".encode())

    async def until_ended(self) -> int:
        """Wait for its end, and return its status."""
        assert self._process is not None
        return await self._process.wait()

    async def end(self) -> str | None:
        """End it with SIGTERM; return what went wrong."""
        if not self.runs:
            status = await self.until_ended()
            return f"{self.role.name} had ended with status {status}" if status else None
        began_s = time.monotonic()
        self.send(signal.SIGTERM)
        try:
            async with asyncio.timeout(END_LIMIT_S):
                status = await self.until_ended()
        except TimeoutError:
            self.end_s = END_LIMIT_S
            return f"{self.role.name} did not end"
        self.end_s = time.monotonic() - began_s
        return f"{self.role.name} ended with status {status}" if status else None

    async def kill(self) -> None:
        """Kill it and whatever it started."""
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            await self._process.wait()
            if self._process.stdin is not None:
                self._process.stdin.close()

    def close(self) -> None:
        """Close its pipes and files here."""
        self._terminal.close()
        self._closing.close()

    def whole_output(self) -> str:
        """Return its whole output."""
        return self._output.read_text(errors="replace") if self._output.exists() else ""

    def output(self) -> str:
        """Return the end of its output."""
        return self.whole_output()[-2000:]


def command_of(role: Role) -> Sequence[str]:
    """Return the command line for a role."""
    if role.command:
        return role.command
    text = msgspec.json.encode(role).decode()
    if role.rclpy:
        runner = () if role.python else ("-m", "aionode", "run")
        return (*runner, str(RCLPY_PROGRAM), text)
    module = "standin" if role.ros else "process"
    if role.mover is not None and not role.ros:
        module = "motion.mover"
    return ("-m", f"tests.faults.{module}", text)


def take_terminal() -> None:
    """Make standard output the controlling terminal; called in the child process."""
    fcntl.ioctl(1, termios.TIOCSCTTY, 0)


class Stage:
    """The processes of a case while it runs."""

    def __init__(self, case: Case, tasks: asyncio.TaskGroup, folder: Path) -> None:
        self.case = case
        self.env = {**isolated_environment(), "XDG_RUNTIME_DIR": str(folder)}
        self.children: dict[str, Child] = {}
        self.former: list[Child] = []
        self._tasks = tasks
        self._folder = folder

    async def start(self, role: Role) -> None:
        """Start a process, perhaps in place of an earlier one with its name."""
        if role.name in self.children:
            self.former.append(self.children[role.name])
        env = {key: value.format_map(self.env) for key, value in role.env.items()}
        role = msgspec.structs.replace(role, env=env, router=role.router.format_map(self.env))
        child = self.children[role.name] = Child(role, self.env, self._folder)
        await child.start()
        self._tasks.create_task(child.read())

    def role(self, name: str) -> Role:
        """Return the role of a process."""
        return next(role for role in self.case.roles if role.name == name)

    def expected(self) -> list[tuple[Child, str]]:
        """Return the marks that have to recur: with whom, and which."""
        living = [child for child in self.children.values() if child.runs]
        marks = [
            (child, hear_mark(hear.topic, sender.role.name))
            for child in living
            for hear in child.role.hear
            for sender in living
            # Two ROS 2 nodes find each other by Zenoh alone: that it may not is no fault of ours.
            if sender is not child and not (sender.role.ros and child.role.ros)
            for publish in sender.role.publish
            if publish.topic == hear.topic and not publish.count
        ]
        marks += [(child, "call") for child in living if child.role.call]
        return marks + [(child, "goal") for child in living if child.role.send]

    def wrong_graphs(self) -> list[str]:
        """Return which processes see a wrong set of nodes."""
        nodes = [
            child
            for child in self.children.values()
            if child.runs and not (child.role.router or child.role.control)
        ]
        names = sorted(child.role.name for child in nodes)
        return [
            f"{child.role.name}: sees {', '.join(child.last.nodes)}"
            for child in nodes
            if not child.role.ros
            # One whose output is not read tells nothing more.
            and not (child.role.noisy or child.role.output == "unread")
            and child.last.nodes != names
        ]

    async def until_working(self, since_s: float, limit_s: float) -> list[str]:
        """Wait until everything has worked since `since_s`; return what does not."""
        ends_s = time.monotonic() + limit_s
        while True:
            waiting = [
                f"{child.role.name}: {mark}"
                for child, mark in self.expected()
                if child.last.marks.get(mark, 0.0) < since_s
            ]
            waiting += [
                f"{child.role.name}: not ready"
                for child in self.children.values()
                if child.runs and not child.last.ready
            ]
            waiting += self.wrong_graphs()
            if not waiting or time.monotonic() > ends_s:
                return waiting
            await asyncio.sleep(0.02)

    async def until_arrived(self) -> None:
        """Stop sending, and wait until everything in transit has arrived, or nothing moves."""
        for child in self.children.values():
            child.tell("quiet")
        # A backlog that takes long to be over takes as long again to arrive, and then some.
        limit_s = max(QUIET_LIMIT_S, 1.5 * self.case.recovery_limit_s)
        ends_s = time.monotonic() + limit_s
        await asyncio.sleep(0.3)
        before = None
        while time.monotonic() < ends_s:
            now = [child.last.heard for child in self.children.values()]
            if self.lost() == 0 or (now == before and time.monotonic() > ends_s - 5.0):
                return
            before = now
            await asyncio.sleep(0.5)

    def streams(self) -> dict[str, int]:
        """Return how many messages each publisher sent that was not killed."""
        children = [*self.children.values(), *self.former]
        return {key: number for child in children for key, number in child.last.sent.items()}

    def lost(self, *, only_kept: bool = False, only_healthy: bool = False) -> int:
        """Return how many messages are missing at running readers.

        Args:
            only_kept: Count only those of KEEP_ALL publishers.
            only_healthy: Count only those between processes that were not struck.
        """
        sent = self.streams()
        counted = tuple(
            stream_key(publish.topic, role.name)
            for role in self.case.roles
            for publish in role.publish
            if (publish.keep_all or not only_kept)
            and not (only_healthy and role.name in self.case.hurt)
        )
        killed = {key for child in self.former if not child.last.last for key in child.last.sent}
        return sum(
            missing(ranges, 0 if key in killed else sent.get(key, 0))
            for child in self.children.values()
            if not (only_healthy and child.role.name in self.case.hurt)
            for key, ranges in child.last.heard.items()
            if key.startswith(counted)
        )

    def outcome(self, steady_s: float, quiet_s: float) -> Outcome:
        """Return the outcome."""
        children = [*self.children.values(), *self.former]
        last = [child.last for child in children]
        calls = sum(report.calls for report in last)
        failed = sum(report.failed for report in last)
        heard = sum(
            end - begin + 1
            for report in last
            for ranges in report.heard.values()
            for begin, end in ranges
        )
        lost = self.lost()
        steady = {
            control: [
                report
                for child in children
                if child.role.control is control and child.role.name not in self.case.hurt
                for report in child.reports
                if max(steady_s, child.started_s) < report.time_s < quiet_s
            ]
            for control in (False, True)
        }
        return Outcome(
            sent=heard + lost + calls,
            lost=lost + failed,
            kept_lost=self.lost(only_kept=True),
            healthy_lost=self.lost(only_healthy=True),
            told=min(lost, sum(report.told for report in last)) + failed,
            doubled=sum(report.doubled for report in last),
            hung=[
                f"{child.role.name}: {child.last.hung} calls"
                for child in children
                if child.last.hung and child.role.name not in self.case.hurt
            ],
            gap_s=max((report.gap_s for report in steady[False]), default=0.0),
            own_gap_s=max((report.own_gap_s for report in steady[False]), default=0.0),
            control_gap_s=max((report.gap_s for report in steady[True]), default=0.0),
            control_own_gap_s=max((report.own_gap_s for report in steady[True]), default=0.0),
            end_s=max(child.end_s for child in children if not child.role.control),
            control_end_s=max(child.end_s for child in children if child.role.control),
        )


@contextlib.asynccontextmanager
async def staged(case: Case) -> AsyncIterator[Stage]:
    """Yield the stage of a case, and leave nothing behind."""
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        failure: Exception | None = None
        async with asyncio.TaskGroup() as tasks:
            stage = Stage(case, tasks, Path(folder))
            try:
                yield stage
            except Exception as error:  # noqa: BLE001 - raised below, outside of the group
                failure = error
            finally:
                children = [*stage.children.values(), *stage.former]
                for child in children:
                    await child.kill()
        for child in children:
            if failure is not None:
                failure.add_note(f"{child.role.name}: {child.output()}")
            child.close()
        if failure is not None:
            raise failure


async def run_case(case: Case, busy: asyncio.Semaphore) -> Outcome:
    """Run a case once.

    Args:
        case: The case.
        busy: Held while its processes start, and while they end.

    Raises:
        Skipped: The machine cannot do it.
    """
    async with contextlib.AsyncExitStack() as stack:
        async with busy:
            stack.enter_context(case.around)
            stage = await stack.enter_async_context(staged(case))
            for role in (*case.roles, CONTROL):
                await stage.start(role)
            hung = await stage.until_working(0.001, READY_LIMIT_S)
        await asyncio.sleep(BEFORE_S / 2)
        steady_s = time.monotonic()
        await asyncio.sleep(BEFORE_S / 2)
        if hung:
            return Outcome(hung=[f"never: {each}" for each in hung])
        await case.strike(stage)
        over_s = time.monotonic()
        hung = await stage.until_working(over_s, RECOVERY_LIMIT_S)
        recovery_s = time.monotonic() - over_s
        await asyncio.sleep(AFTER_S)
        quiet_s = time.monotonic()
        await stage.until_arrived()
        async with busy:
            endings = await asyncio.gather(*(child.end() for child in stage.children.values()))
        await asyncio.sleep(0.05)  # for the last reports
        outcome = stage.outcome(steady_s, quiet_s)
        outcome.hung = [*outcome.hung, *hung, *(text for text in endings if text)]
        outcome.recovery_s = recovery_s
        return outcome
    raise AssertionError("not reached")


class Job(Protocol):
    """A unit that runs at once: a `Case`, or a scene of several."""

    @property
    def lasts_s(self) -> float:
        """About how long its fault takes."""

    async def run(self, busy: asyncio.Semaphore) -> Sequence[tuple[Any, Any]]:
        """Run, and return the outcome of each of its cases."""


async def run_together(cases: Sequence[Job], jobs: int, tell: Callable[[Any, Any], None]) -> None:
    """Run several cases at the same time, once each, and report each as soon as it is over.

    Args:
        cases: The cases, those that take long first.
        jobs: How many run at once.
        tell: Called with each case and its outcome, or what it raised.
    """
    turns, busy = asyncio.Semaphore(jobs), asyncio.Semaphore(BUSY)

    async def run(job: Job) -> None:
        async with turns:
            outcomes = await job.run(busy)
        for case, outcome in outcomes:
            tell(case, outcome)

    async with asyncio.TaskGroup() as tasks:
        for case in cases:
            tasks.create_task(run(case))
