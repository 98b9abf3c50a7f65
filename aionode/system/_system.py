"""`System`: processes and nodes that are started, watched and stopped as one unit."""

from __future__ import annotations

import asyncio
import os
import sys
from typing import TYPE_CHECKING, Final, Self, Unpack

from aionode import names
from aionode._process.concurrency import to_the_end
from aionode.clock import S_TO_NS, SteadyClock
from aionode.engine.context import Context
from aionode.errors import ConfigurationError, MemberNotFoundError
from aionode.node import Node
from aionode.system._control import Control
from aionode.system._guard import Guard
from aionode.system._log import SystemLog
from aionode.system._member import Member, MemberOptions, Restart, options_of
from aionode.system._node_member import (
    NodeMember,
    Parameters,
    maker_of,
    program_of,
    ros_arguments,
)
from aionode.system._output import OutputReader
from aionode.system._process import ProcessMember, ProcessOptions
from aionode.system._readiness import Fact, NodeExists, facts_of
from aionode.system._report import exit_report
from aionode.system._status import (
    MemberEnd,
    MemberStatus,
    SystemHealth,
    end_text,
    shell_status,
)
from aionode.system._usage import UsageMeter

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping, Sequence
    from types import TracebackType

__all__ = ["System"]

MAX_ENDS: Final = 1000
"""Maximum number of ends that the system remembers."""


class System:
    """Processes and nodes that are started, watched and stopped as one unit.

    ::

        async with System() as system:
            system.process("driver", ["my_driver"], ready=TopicPublished("/odom"))
            system.node("planner", "my_robot.planner:Planner", restart="on-failure")
            await system.ready()
            await system.wait()

    Members start in the order in which they are added. Those added before ``async with`` start when
    the block is entered, later ones at once. When the block ends, the members stop in reverse
    order, one at a time: a process gets SIGINT, after 7 s SIGTERM, and after another 5 s SIGKILL.

    When a process ends, the system also stops all processes that it left behind. If this process is
    killed, a guardian, a small separate process, stops all members in the same order. Processes
    need Linux.

    Args:
        name: Name of the system; its node is called ``aionode_system_NAME``. The default is the
            process id.
        context: The context of its nodes; `Context.default()` by default.
        log: Receives the output of all members; `SystemLog` on ``sys.stdout`` by default.

    Attributes:
        context: The context of its nodes; its processes are in the same domain.
        log: The log.
        ends: The unrequested ends of members, in order; the first 1000.

    Raises:
        ConfigurationError: the machine does not run Linux (a ValueError).
    """

    def __init__(
        self,
        name: str = "",
        *,
        context: Context | None = None,
        log: SystemLog | None = None,
    ) -> None:
        if not sys.platform.startswith("linux"):
            raise ConfigurationError("System", sys.platform, "systems of processes need Linux")
        self.name = name or str(os.getpid())
        self.context = Context.default() if context is None else context
        self.log = SystemLog() if log is None else log
        self.ends: list[MemberEnd] = []
        self.closing = False
        self._members: dict[str, Member] = {}
        self._over = asyncio.Event()
        self._first_failure: MemberEnd | None = None
        self._usage = UsageMeter()
        self._entered = False
        self._changed = asyncio.Event()
        self._clock = SteadyClock()
        self._since_ns = 0
        self._unguarded = ""  # how the guardian ended; empty while it is running
        self.tasks: asyncio.TaskGroup
        self.guard: Guard
        self.reader: OutputReader
        self.graph_node: Node
        self._control: Control

    def __repr__(self) -> str:
        return f"<System {self.name} members={len(self._members)}>"

    # Members

    def process(
        self,
        name: str,
        argv: Sequence[str | os.PathLike[str]],
        *,
        parameters: Parameters | Sequence[Parameters] | None = None,
        remappings: Mapping[str, str] | Sequence[tuple[str, str]] | None = None,
        namespace: str | None = None,
        env: Mapping[str, str | None] | None = None,
        cwd: str | os.PathLike[str] | None = None,
        restart: Restart = "never",
        ready: Fact | Sequence[Fact] | None = None,
        stdin: bool = False,
        terminal: bool = False,
        on_output: Callable[[bytes, int], object] | None = None,
        term_after_sec: float = 7.0,
        kill_after_sec: float = 5.0,
        **options: Unpack[MemberOptions],
    ) -> Member:
        """Add a program.

        The program runs in its own session, so Ctrl-C in the terminal does not reach it; the system
        stops it. When it ends, the system also stops the processes that it left behind.

        Args:
            name: Its name in the system.
            argv: Its command line.
            parameters: Parameters for the ROS nodes of the program: a mapping of names to values,
                the path of a parameter file, or a sequence of both, in which later entries win.
                Parameters, remappings and the namespace become arguments after ``--ros-args``.
            remappings: Names of topics and services, each with its new name.
            namespace: The namespace of its nodes.
            env: Variables to add to the environment of this process, or to remove if the value is
                None.
            cwd: Its working directory.
            restart: When to start it again: ``"never"``, ``"on-failure"`` (a non-zero exit status,
                or a signal) or ``"always"``.
            ready: Facts to await before the member counts as ready; by default it is ready as soon
                as it runs.
            stdin: Whether the program reads the keyboard. If so, and if there is a terminal, its
                standard input and output are that terminal, and its standard error goes to the log.
                Other programs have an empty standard input.
            terminal: Whether the program gets its own terminal, whose output goes to the log. Many
                programs print unbuffered and in colours if they have a terminal.
            on_output: Called with each piece of output as it arrives, and with 1 for standard
                output or 2 for standard error. With it, lines of the two streams may be reordered
                in the log.
            term_after_sec: Time from SIGINT to SIGTERM, in seconds.
            kill_after_sec: Time from SIGTERM to SIGKILL, in seconds.
            options: Further options; see `MemberOptions`.

        Returns:
            The member; the other methods take its `name`.

        Raises:
            ValueError: the name is taken, or an argument does not fit.
            MemberNotFoundError: `after` or `fails_with` names no member (a LookupError).
            TypeError: `ready` is not a fact, or an option is unknown.
        """
        if not argv or isinstance(argv, str):
            raise ValueError(f"{name}: argv={argv!r}; use a list, such as ['my_driver', '--fast']")
        arguments = ros_arguments(None, namespace, parameters, remappings)
        process = ProcessOptions(
            [os.fspath(word) for word in argv] + (["--ros-args", *arguments] if arguments else []),
            dict(env or {}),
            None if cwd is None else os.fspath(cwd),
            stdin,
            term_after_sec,
            kill_after_sec,
            terminal,
            on_output,
        )
        shared = options_of(restart, facts_of(ready, name), options, name)
        return self._add(ProcessMember(name, self, self, shared, process))

    def node(
        self,
        name: str,
        node: Callable[[], Node] | str,
        *,
        parameters: Parameters | Sequence[Parameters] | None = None,
        remappings: Mapping[str, str] | Sequence[tuple[str, str]] | None = None,
        namespace: str | None = None,
        processes: bool = False,
        restart: Restart = "never",
        ready: Fact | Sequence[Fact] | None = None,
        env: Mapping[str, str | None] | None = None,
        cwd: str | os.PathLike[str] | None = None,
        **options: Unpack[MemberOptions],
    ) -> Member:
        """Add a node, as tasks of this process or as a separate process.

        The node is called `name`, whatever name its class gives it, so that one class can be used
        twice.

        Args:
            name: Name of the member and of the node.
            node: A callable that returns the node, such as its class; or ``"module:Class"`` or
                ``"file.py:Class"``.
            parameters: A mapping of names to values, the path of a parameter file, or a sequence
                of both, in which later entries win.
            remappings: Names of topics and services, each with its new name.
            namespace: Its namespace.
            processes: Whether the node runs in a separate process, as several processes can use
                several cores.
            restart: When to start it again; as for `process`.
            ready: Facts to await before the member counts as ready; by default it is ready when it
                is in the graph.
            env: Variables to add to the environment of its separate process, or to remove if the
                value is None.
            cwd: Working directory of its separate process.
            options: Further options; see `MemberOptions`.

        Returns:
            The member; the other methods take its `name`.

        Raises:
            InvalidNodeNameException: `name` is not a valid node name (a ValueError).
            ValueError: the name is taken, or an argument does not fit.
            CommandError: there is no such module or class (a RuntimeError).
            MemberNotFoundError: `after` or `fails_with` names no member (a LookupError).
            TypeError: `ready` is not a fact, or an option is unknown.
        """
        names.validate_node_name(name)
        arguments = ros_arguments(name, namespace, parameters, remappings)
        full_name = names.fully_qualified_name(names.normalize_namespace(namespace), name)
        facts = facts_of(NodeExists(full_name) if ready is None else ready, name)
        if processes:
            argv = [*program_of(node, name), *arguments]
            return self.process(
                name, argv, env=env, cwd=cwd, restart=restart, ready=facts, **options
            )
        if env is not None or cwd is not None:
            raise ValueError(f"{name}: env and cwd are for nodes with processes=True")
        shared = options_of(restart, facts, options, name)
        make_node = maker_of(node)
        return self._add(NodeMember(name, self, shared, make_node, self.context, arguments))

    def _add(self, member: Member) -> Member:
        if member.name in self._members or member.name == "system":
            raise ValueError(f"{member.name}: this name is taken; each member has its own")
        for name in (*member.options.after, *member.options.fails_with):
            self.member(name)
        self._members[member.name] = member
        self.log.add_member(member.name)
        if self._entered:
            member.start()
        return member

    def member(self, name: str) -> Member:
        """Return a member by its name.

        Raises:
            MemberNotFoundError: there is no such member (a LookupError).
        """
        if name not in self._members:
            raise MemberNotFoundError(name, tuple(self._members))
        return self._members[name]

    # Lifetime

    async def __aenter__(self) -> Self:
        """Start the guardian, the system's node, and the members that were added.

        Raises:
            RuntimeError: it was entered before.
            TransportError: the context cannot connect.
        """
        if self._entered:
            raise RuntimeError("System: cannot be entered twice; create another one")
        self._entered = True
        self._since_ns = self._clock.now_ns()
        self.graph_node = Node(
            f"aionode_system_{self.name}",
            context=self.context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._control = Control(self, self.graph_node)
        self.guard = Guard(self._note_guardian_lost)
        self.guard.open()
        try:
            await self.graph_node.__aenter__()
        except BaseException:
            await to_the_end(self.guard.close())
            raise
        self.reader = OutputReader(self.log)
        self.tasks = await asyncio.TaskGroup().__aenter__()
        for member in list(self._members.values()):
            member.start()
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop all members in reverse order, and wait until none of their processes is left.

        Cancelling does not interrupt this. An exception from the body propagates unchanged.
        """
        try:
            await to_the_end(self._stop_all(), exc)
        finally:
            try:
                await self.graph_node.__aexit__(None, None, None)
            finally:
                await self.tasks.__aexit__(None, None, None)
                self.log.close()

    async def _stop_all(self) -> None:
        self.closing = True
        self._over.set()
        for member in reversed(self._members.values()):
            await member.stop()
        if not await self.guard.close():
            self.log.note("some processes could not be ended, as they run as another user")
        self.reader.close()
        self._control.close()
        if self.first_failure is not None:
            self.log.note(exit_report(self.ends, self.first_failure))

    def _note_guardian_lost(self, code: int) -> None:
        """End the system, as nothing would stop the members if this process were killed too."""
        ran_sec = (self._clock.now_ns() - self._since_ns) / S_TO_NS
        end = MemberEnd("the guardian", True, end_text(code), shell_status(code), ran_sec)
        self._unguarded = f"the guardian of the system {end.text}: the system ends"
        self.log.note(self._unguarded)
        self.ends.append(end)
        if self._first_failure is None:
            self._first_failure = end
        self.request_end()

    async def ready(self) -> None:
        """Wait until all members are ready, except those that were stopped.

        Cancelling is safe.

        Raises:
            NotReadyError: a member did not become ready: `name`, `problem` and `last_lines` of the
                error say why (a TimeoutError).
        """
        waits = [member.run.ready for member in self._members.values() if member.state != "stopped"]
        if waits:
            done, _ = await asyncio.wait(waits, return_when=asyncio.FIRST_EXCEPTION)
            for ready in waits:
                if ready in done:
                    ready.result()

    async def wait(self) -> None:
        """Wait until the system is over.

        The system is over when all members have ended for good, when a `required` member has, or
        when `request_end` is called. Cancelling is safe.
        """
        while not self._over.is_set():
            if all(member.is_over() for member in self._members.values()):
                return
            await self.changed()

    async def end_requested(self) -> None:
        """Wait until the system is asked to end.

        That is by `request_end`, by a request from outside such as ``aionode system stop --all``,
        or by the end of a `required` member or of the guardian. Cancelling is safe.
        """
        await self._over.wait()

    async def run_main(self, main: Callable[[Self], Awaitable[object]]) -> None:
        """Call `main` with the system, then wait until the system is over, like `wait`.

        A request to end the system cancels `main`, which must not wait for it. Cancelling is safe.

        Args:
            main: Adds members, and may await things such as `ready`.
        """

        async def work() -> None:
            await main(self)

        try:
            async with asyncio.TaskGroup() as tasks:
                ways = [tasks.create_task(work()), tasks.create_task(self._over.wait())]
                await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
                for way in ways:
                    way.cancel()
        except BaseExceptionGroup as group:
            raise group.exceptions[0] from None  # the one of `main`, as nothing else can fail
        await self.wait()

    async def changed(self) -> None:
        """Wait until the state of a member changes, or `request_end` is called.

        No change after the call is missed: check your condition, then call this method, with no
        ``await`` in between. Cancelling is safe.
        """
        if self._changed.is_set():
            self._changed = asyncio.Event()
        await self._changed.wait()

    def request_end(self) -> None:
        """Make `wait`, `end_requested` and `run_main` return.

        It may be called at any time, and more than once.
        """
        self._over.set()
        self.note_change()

    # Control

    async def stop(self, name: str) -> None:
        """Stop a member for good, and wait until none of its processes is left.

        Raises:
            MemberNotFoundError: there is no member of this name (a LookupError).
        """
        await self.member(name).stop()

    async def restart(self, name: str) -> None:
        """Stop a member and start it again, or start a member that has ended.

        It returns when the member starts; `ready` waits until it is ready.

        Raises:
            MemberNotFoundError: there is no member of this name (a LookupError).
        """
        await self.member(name).restart()

    def status(self) -> dict[str, MemberStatus]:
        """Return the current status of each member by name, in the order of their starts."""
        return {
            name: member.status(self._usage.of(member.pid))
            for name, member in self._members.items()
        }

    def health(self) -> SystemHealth:
        """Return the current health of the system; calling this costs next to nothing."""
        problems, ready = [self._unguarded] if self._unguarded else [], True
        for name, member in self._members.items():
            if member.state in {"ended", "stopped"} or member.is_running_and_ready():
                continue
            ready = False
            state = "not ready" if member.state == "running" else member.state
            problems.append(f"{name}: {state}{member.error and ': '}{member.error}")
        return SystemHealth(
            ok=not problems,
            ready=ready,
            problems=tuple(problems),
            members={name: member.state for name, member in self._members.items()},
        )

    @property
    def first_failure(self) -> MemberEnd | None:
        """The end of the first member that failed for good; None if there is none."""
        return self._first_failure

    @property
    def exit_status(self) -> int:
        """The exit status of the first member that failed for good; 0 if there is none."""
        return 0 if self._first_failure is None else self._first_failure.status

    # For members

    def environment(self) -> dict[str, str]:
        """Return the environment of processes, which join the domain of the system's context."""
        network = self.context.network
        return {
            **os.environ,
            "ROS_DOMAIN_ID": str(network.domain_id),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": network.discovery_range.value,
        }

    def note_change(self) -> None:
        """Wake all waiters of `changed`, after a member has changed its state."""
        self._changed.set()

    def note_end(self, member: Member, end: MemberEnd, *, for_good: bool) -> None:
        """Record the unrequested end of a run, and stop the members that depend on it."""
        if self.closing:
            return
        if len(self.ends) < MAX_ENDS:
            self.ends.append(end)
        if for_good and end.failed and self._first_failure is None:
            self._first_failure = end
        if for_good and member.options.required:
            self.log.note(f"{member.name} is required: the system ends")
            self.request_end()
        if end.failed:
            for other in self._members.values():
                if member.name in other.options.fails_with:
                    self.tasks.create_task(self._follow(other, member))

    async def _follow(self, member: Member, failed: Member) -> None:
        """Stop a member that fails with another one, and start it when the other runs again."""
        if member.is_over():
            return
        self.log.note(f"{member.name} is stopped: it fails with {failed.name}")
        await member.stop()
        while not (failed.is_over() or failed.is_running_and_ready() or self.closing):
            await self.changed()
        if not self.closing and failed.is_running_and_ready():
            await member.restart()
