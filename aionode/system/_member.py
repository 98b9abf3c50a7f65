"""A member of a system: running it, restarting it by its policy, and its readiness."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final, Literal, Protocol, TypedDict

from aionode._process.restart import Backoff, wants_another
from aionode.clock import S_TO_NS, SteadyClock
from aionode.errors import AionodeError, NotReadyError
from aionode.system._readiness import Fact, missing_of
from aionode.system._status import MemberEnd, MemberStatus, State

if TYPE_CHECKING:
    from aionode.lifecycle import LifecycleManager
    from aionode.node import Node
    from aionode.system._log import SystemLog

__all__ = ["Host", "Member", "MemberOptions", "Options", "Restart", "options_of"]

Restart = Literal["never", "on-failure", "always"]


@dataclass(frozen=True)
class Options:
    """The options that processes and nodes of a system share.

    Attributes:
        restart: When to start it again.
        min_delay_sec: The first delay before a restart, in seconds; doubled with each restart in a
            row.
        max_delay_sec: The longest delay, in seconds.
        max_restarts: How many restarts in a row there are before it is given up; None for no limit.
        ready: What is awaited before it is ready.
        after: The members that have to be ready before it starts.
        required: Whether the system ends when this member has ended for good.
        fails_with: The members with whose failure it is stopped, and then started again with them.
        managed: The managed nodes that are configured and activated, in this order.
    """

    restart: Restart = "never"
    min_delay_sec: float = 0.5
    max_delay_sec: float = 30.0
    max_restarts: int | None = None
    ready: tuple[Fact, ...] = ()
    after: tuple[str, ...] = ()
    required: bool = False
    fails_with: tuple[str, ...] = ()
    managed: tuple[str, ...] = ()


class MemberOptions(TypedDict, total=False):
    """Keyword arguments shared by `System.process` and `System.node`.

    Attributes:
        min_delay_sec: The first delay before a restart, in seconds; doubled with each restart in a
            row.
        max_delay_sec: The longest delay, in seconds; a run of that length resets the delay.
        max_restarts: How many restarts in a row there are before it is given up; None for no limit.
        after: Members that have to be ready before it starts.
        required: Whether the system ends when this member has ended for good.
        fails_with: Members with whose failure it is stopped; it starts again when they do.
        managed: Full names of managed nodes, which are configured and activated in this order
            before it is ready, and brought down in reverse order before it is stopped.
    """

    min_delay_sec: float
    max_delay_sec: float
    max_restarts: int | None
    after: str | Sequence[str]
    required: bool
    fails_with: str | Sequence[str]
    managed: str | Sequence[str]


FORMER_LIMITS: Final = {"memory_bytes": "MemoryMax=", "cpu_cores": "CPUQuota="}
"""Removed options, and systemd's replacement for each."""


def options_of(
    restart: Restart, ready: tuple[Fact, ...], shared: MemberOptions, subject: str
) -> Options:
    """Parse the options that a user passed.

    Raises:
        ValueError: the policy is unknown.
        TypeError: an option is unknown.
    """
    if restart not in ("never", "on-failure", "always"):
        raise ValueError(
            f'{subject}: restart={restart!r} is unknown; use "never", "on-failure" or "always"'
        )
    given: dict[str, Any] = dict(shared)
    for key in ("after", "fails_with", "managed"):
        names = given.get(key, ())
        given[key] = (names,) if isinstance(names, str) else tuple(names)
    try:
        return Options(restart=restart, ready=ready, **given)
    except TypeError as error:
        known = f"the options are {', '.join(MemberOptions.__annotations__)}"
        if former := FORMER_LIMITS.keys() & shared.keys():
            settings = " and ".join(sorted(FORMER_LIMITS[name] for name in former))
            known = f"limit the whole system by {settings} in its systemd unit"
        raise TypeError(f"{subject}: {error}; {known}") from None


class Host(Protocol):
    """The methods of a system that its members call."""

    log: SystemLog
    tasks: asyncio.TaskGroup
    graph_node: Node
    closing: bool

    def member(self, name: str) -> Member:
        """Return a member by its name."""
        ...

    def note_end(self, member: Member, end: MemberEnd, *, for_good: bool) -> None:
        """Record the unrequested end of a run."""
        ...

    def note_change(self) -> None:
        """Record a change of state."""
        ...


@dataclass
class Run:
    """One run of a member, from its start to its end.

    Attributes:
        since_ns: When it started, by the steady clock.
        ready: Done when everything awaited is there; fails with a NotReadyError otherwise.
    """

    since_ns: int = 0
    ready: asyncio.Future[None] = field(
        default_factory=lambda: asyncio.get_running_loop().create_future()
    )


class Member:
    """A process or a node of a system.

    Args:
        name: Its name in the system.
        host: The system.
        options: The options that both kinds share.
    """

    def __init__(self, name: str, host: Host, options: Options) -> None:
        self.name = name
        self.options = options
        self.host = host
        self.state: State = "waiting"
        self.pid: int | None = None
        self.restarts = 0
        self.error = ""
        self.last_end: MemberEnd | None = None
        self.backoff = Backoff(options.min_delay_sec, options.max_delay_sec, name)
        self.clock = SteadyClock()
        self.run: Run  # set by `start`, as a member may be added before there is an event loop
        self._stop = asyncio.Event()
        self._restarting = False
        self._work: asyncio.Task[None] | None = None
        self._watch: asyncio.Task[None] | None = None
        self._manager: LifecycleManager | None = None

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name} {self.state} restarts={self.restarts}>"

    # Defined by subclasses

    async def run_once(self, stop: asyncio.Event) -> MemberEnd:
        """Start the member, call `note_running`, and return how it ended. `stop` ends it."""
        raise NotImplementedError

    # Control

    def start(self) -> None:
        """Start the member, unless it is running or the system is ending."""
        if not self.host.closing and (self._work is None or self._work.done()):
            self._stop = asyncio.Event()
            self.run = Run()
            self.set_state("waiting")
            self._work = self.host.tasks.create_task(self._supervise(), name=f"member {self.name}")

    async def stop(self) -> None:
        """Stop the member, and wait until nothing of it is left."""
        if self._work is None or self._work.done():
            if self.state != "stopped" and not self.host.closing:
                self.set_state("stopped")
            return
        if not self._stop.is_set():
            if self._watch is not None:
                self._watch.cancel()
                await asyncio.wait([self._watch])
            await self._deactivate()
        self._stop.set()
        await asyncio.wait([self._work])

    async def restart(self) -> None:
        """Stop the member and start it again; return once it is starting."""
        self._restarting = True
        try:
            await self.stop()
        finally:
            self._restarting = False
            self.host.note_change()
        self.restarts += 1
        self.start()

    def set_state(self, state: State) -> None:
        """Change the state, and wake those waiting for it."""
        self.state = state
        self.host.note_change()

    def is_over(self) -> bool:
        """Return whether it has ended for good or was stopped, and is not being started again."""
        return not self._restarting and self.state in {"stopped", "ended", "failed"}

    # Supervision

    async def _supervise(self) -> None:
        try:
            if not await self._wait_for_others():
                self.set_state("stopped" if self._stop.is_set() else "failed")
                return
            while not self._stop.is_set():
                if not await self._run_and_judge():
                    return
            self.set_state("stopped")
        finally:
            if self._watch is not None:
                self._watch.cancel()
            if not self.is_over():
                self.set_state("stopped")
            if not self.run.ready.done():
                self._set_not_ready("it was stopped")

    async def _wait_for_others(self) -> bool:
        """Wait until the members it starts after are ready; return whether they are."""
        for name in self.options.after:
            other = self.host.member(name)
            try:
                await self._until_stopped_or(other.wait_ready())
            except NotReadyError as error:
                self.error = f"it starts after {name}, which is not ready"
                self.host.log.note(f"{self.name} is not started: {error}")
                self._set_not_ready(self.error)
                end = MemberEnd(
                    self.name, failed=True, text=f"was not started: {self.error}", status=1
                )
                self.host.note_end(self, end, for_good=True)
                return False
            if self._stop.is_set():
                return False
        return True

    async def _until_stopped_or(self, work: Any) -> None:
        """Await `work`, or until it should stop."""
        async with asyncio.TaskGroup() as tasks:
            waiting = tasks.create_task(outcome_of(work))
            stop = tasks.create_task(self._stop.wait())
            await asyncio.wait([waiting, stop], return_when=asyncio.FIRST_COMPLETED)
            waiting.cancel()
            stop.cancel()
        if not waiting.cancelled() and (error := waiting.result()) is not None:
            raise error

    async def _run_and_judge(self) -> bool:
        """Run it once, and wait for the restart delay; return whether to run it again."""
        self.set_state("starting")
        self.run.since_ns = 0
        end = await self.run_once(self._stop)
        self.pid = None
        ran_sec = self._ran_sec()
        lines = tuple(self.host.log.last_lines(self.name))
        self.last_end = end = replace(end, ran_sec=ran_sec, last_lines=lines)
        if self._stop.is_set():
            return True
        if end.failed:
            self.error = end.text
        again = wants_another(self.options.restart, failed=end.failed)
        delay_sec = self.backoff.delay_after(ran_sec) if again else 0.0
        limit = self.options.max_restarts
        if again and limit is not None and self.backoff.failed_in_a_row > limit:
            again = False
            self.host.log.note(f"{self.name} was restarted {limit} times in a row, and is given up")
        self._tell(end, again, delay_sec)
        self.host.note_end(self, end, for_good=not again)
        if not again:
            if not self.run.ready.done():
                self._set_not_ready(f"it {end.text} before it was ready")
            self.set_state("failed" if end.failed else "ended")
            return False
        self.set_state("restarting")
        await self._until_stopped_or(self.clock.sleep(delay_sec))
        if not self._stop.is_set():
            self.restarts += 1
            if self.run.ready.done():
                self.run = Run()
        return True

    def _tell(self, end: MemberEnd, again: bool, delay_sec: float) -> None:
        then = f"; restarting in {delay_sec:g} s" if again else ""
        self.host.log.note(f"{self.name} {end.text}{then}")

    def _ran_sec(self) -> float:
        since_ns = self.run.since_ns if self._work is not None else 0
        return (self.clock.now_ns() - since_ns) / S_TO_NS if since_ns else 0.0

    def note_running(self, pid: int) -> None:
        """Record that it is running, and start watching its readiness."""
        self.pid = pid
        self.run.since_ns = self.clock.now_ns()
        self.set_state("running")
        if not (self.options.ready or self.options.managed):
            settle(self.run.ready)
            return
        # A restart before it was ready does not extend the time for becoming ready.
        if self._watch is None or self._watch.done():
            self._watch = self.host.tasks.create_task(
                self._watch_readiness(self.run), name=f"readiness of {self.name}"
            )

    # Readiness

    async def _watch_readiness(self, run: Run) -> None:
        missing = await missing_of(self.options.ready, self.host.graph_node)
        if missing:
            self._set_not_ready(f"missing: {', '.join(missing)}")
            return
        try:
            await self._activate()
        except (AionodeError, TimeoutError) as error:
            self._set_not_ready(str(error))
            return
        settle(run.ready)
        self.error = ""
        self.host.note_change()

    async def _activate(self) -> None:
        if self.options.managed:
            from aionode.lifecycle import LifecycleManager  # few systems have managed nodes

            if self._manager is None:
                self._manager = LifecycleManager(self.host.graph_node, self.options.managed)
            await self._manager.startup()

    async def _deactivate(self) -> None:
        """Bring down those of its managed nodes that are there."""
        if self._manager is not None and self.state == "running":
            self.set_state("stopping")
            try:
                await self._manager.reset()
            except* (AionodeError, TimeoutError) as group:
                for error in group.exceptions:
                    self.host.log.note(f"{self.name}: {error}")

    def _set_not_ready(self, problem: str) -> None:
        self.error = problem
        if not self.run.ready.done():
            error = NotReadyError(self.name, problem, self.host.log.last_lines(self.name))
            self.run.ready.set_exception(error)
            self.run.ready.exception()  # perhaps nobody asks
            if not self._stop.is_set():
                self.host.log.note(f"{self.name} is not ready: {problem}")

    def is_ready(self) -> bool:
        """Return whether it is currently ready."""
        if self._work is None:
            return False
        ready = self.run.ready
        return ready.done() and ready.exception() is None

    def is_running_and_ready(self) -> bool:
        """Return whether it is running and ready."""
        return self.state == "running" and self.is_ready()

    async def wait_ready(self) -> None:
        """Wait until it is ready.

        Raises:
            NotReadyError: something awaited did not appear in time, or the member ended for good.
        """
        await asyncio.shield(self.run.ready)

    # Status

    def status(self, usage: tuple[float | None, int | None]) -> MemberStatus:
        """Return its current status.

        Args:
            usage: Its share of a core in percent, and its memory in bytes.
        """
        running = self.state == "running"
        return MemberStatus(
            name=self.name,
            state=self.state,
            pid=self.pid,
            restarts=self.restarts,
            ready=self.is_running_and_ready(),
            exit_status=None if self.last_end is None else self.last_end.status,
            uptime_sec=self._ran_sec() if running else 0.0,
            cpu_percent=usage[0],
            memory_bytes=usage[1],
            error=self.error,
        )


async def outcome_of(work: Any) -> NotReadyError | None:
    """Await `work`, and return its error, if any."""
    try:
        await work
    except NotReadyError as error:
        return error
    return None


def settle(waiter: asyncio.Future[None]) -> None:
    """Complete a future, unless it is done."""
    if not waiter.done():
        waiter.set_result(None)
