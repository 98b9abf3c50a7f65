"""ROS 2 launch files in Python, XML and YAML: from a file to running processes.

`Plan` evaluates a file as far as possible before anything runs, so that unknown names, wrong
arguments and missing packages are errors with file and line.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Iterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode._packages import Packages, remark_on, use_stand_ins, workspace_of
from aionode.errors import LaunchFileError
from aionode.launch._watch import restart_changed
from aionode.launch.plan import Call, LoadNodes, Log, Missing, Opaque, Process, Step, Timer, Watch
from aionode.rclpy import install

if TYPE_CHECKING:
    from aionode.system import System

# The classes of launch files are those of `launch`, which only `install` makes importable; modules
# that import them are therefore imported by the functions below, after it.

__all__ = ["DeclaredArgument", "Plan", "plan_running", "run_plan", "share_directory"]


@dataclass(frozen=True)
class DeclaredArgument:
    """An argument that a launch file takes.

    Attributes:
        name: Its name.
        description: What it is for.
        default: Its default, as written in the file; None if it is required.
        choices: The valid values; None if all are valid.
    """

    name: str
    description: str
    default: str | None
    choices: tuple[str, ...] | None


class Plan:
    """The actions of a launch file, in order; creating a plan starts nothing.

    A Python file is run like any program of the user, and may do anything a program may do.

    Args:
        path: The launch file.
        arguments: Values for its arguments.
        workspace: The folder with its packages, which need no build; the workspace around the file
            by default. Installed packages are found in any case.
        skip_missing: Whether to leave out, with a warning, what needs a missing package.

    Attributes:
        path: The launch file.
        description: The launch description; an empty one if the file has `main`.
        main: The function ``async def main(system)`` of the file, if it has that.

    Raises:
        LaunchFileError: The file cannot be read, or asks for something impossible (a ValueError).
        FileNotFoundError: There is no such workspace.
    """

    def __init__(
        self,
        path: str,
        arguments: Mapping[str, str] | None = None,
        *,
        workspace: str | Path | None = None,
        skip_missing: bool = False,
    ) -> None:
        self._before = dict(os.environ)  # a Python file may change it
        around = workspace_of(Path(path)) if workspace is None else Path(workspace)
        install(workspace=around)
        from aionode.launch._evaluation import load_file
        from aionode.launch._stand_ins import forget_stand_ins

        self._packages = Packages(around)
        self.path = path
        self._skip_missing = skip_missing
        use_stand_ins(wanted=skip_missing)
        forget_stand_ins()
        self.description, self.main = load_file(path)
        self._arguments = dict(arguments or {})
        self._steps: list[Step] | None = None

    @property
    def declared(self) -> list[DeclaredArgument]:
        """The arguments that the file takes."""
        from aionode.launch._evaluation import arguments_of

        return [
            DeclaredArgument(
                name=argument.name,
                description=argument.description,
                default=None if argument.default_value is None else joined(argument.default_value),
                choices=None if argument.choices is None else tuple(argument.choices),
            )
            for argument in arguments_of(self.description, self.path)
        ]

    @property
    def steps(self) -> list[Step]:
        """The actions, in order.

        Raises:
            LaunchFileError: It cannot be evaluated with these arguments (a ValueError).
        """
        if self._steps is None:
            from aionode.launch._evaluation import check_later_steps, evaluate, new_context

            context = new_context(self.path, self._arguments)
            context.packages = self._packages
            context.skips_missing = self._skip_missing
            steps = evaluate([self.description], context)
            self._names, self._names_before = context.names, dict(context.names)
            check_later_steps(steps, set())
            self._forget_names()
            warnings = list(left_out_texts(context.left_out, steps))
            if warnings and not (self._skip_missing or any(map(does_something, steps))):
                windows = ", ".join(missing.name for missing in context.left_out)
                problem = f"starts only graphical tools that are missing: {windows}; {INSTEAD}"
                raise LaunchFileError(self.path, problem)
            self._steps = [
                *self._misspelt(context.declared),
                *(Log(text, "WARN") for text in warnings),
                *steps,
            ]
        return self._steps

    def _forget_names(self) -> None:
        """Reset the names of processes of timers and event handlers."""
        self._names.clear()
        self._names.update(self._names_before)

    def _misspelt(self, declared: set[str]) -> Iterator[Step]:
        """Yield a warning for each argument that looks misspelled.

        Other undeclared arguments may still be read by the file.
        """
        for name in self._arguments:
            close = get_close_matches(name, declared - set(self._arguments))
            if name not in declared and close:
                problem = f"argument '{name}' is not one of the file; is it '{close[0]}'?"
                yield Log(problem, "WARN")

    def records(self) -> Iterator[dict[str, Any]]:
        """Yield what is started, as JSON-compatible values."""
        from aionode.launch._preview import records

        yield from records(self.steps, self._before)
        self._forget_names()

    def lines(self) -> Iterator[str]:
        """Yield what is started, as readable lines."""
        from aionode.launch._preview import text_of

        return (text_of(record) for record in self.records())


def left_out_texts(left_out: Mapping[Missing, list[Any]], steps: list[Step]) -> Iterator[str]:
    """Yield what is left out, by what is missing, and which handlers never run."""
    from launch.launch_description_entity import where_of  # after `install`

    for missing, entities in left_out.items():
        is_package = missing.kind == "package"
        remark = remark_on(missing.name, missing.executable) if is_package else ""
        places = ", ".join(f"{entity.describe()} ({where_of(entity)})" for entity in entities)
        yield f"{missing}{remark and f': it is {remark}'}; left out: {places}"
    ids = {id(entity) for entities in left_out.values() for entity in entities}
    for step in steps:
        if isinstance(step, Watch) and not step.ends:
            target = getattr(step.handler, "_OnActionEventBase__action_matcher", None)
            if id(target) in ids:
                yield f"the {step.handler.describe()} never comes: that is left out"


INSTEAD: Final = "use the page of `aionode gateway`, or Foxglove connected to it"


def does_something(step: Step) -> bool:
    """Return whether a step starts anything, now or later."""
    return isinstance(step, Process | LoadNodes | Timer | Call | Opaque)


async def run_plan(
    plan: Plan, system: System, *, watch: bool = False, once_ready: str | None = None
) -> None:
    """Run a plan until nothing of it is running any more or a shutdown is requested.

    The plan may request one, and so may others, such as ``aionode system stop --all``. The system
    also ends if it loses the guardian, which would stop the processes if this one were killed.

    The processes and nodes are added to `system`, which must have been entered, and which stops
    them at its end. Cancelling is safe.

    Args:
        plan: The plan.
        system: The system.
        watch: Whether to restart a process when its program's file changes, even after it has
            ended. In that case the launch goes on until a shutdown is requested.
        once_ready: A shell command that is run once all nodes are in the graph.

    Raises:
        LaunchFileError: An event handler or a timer cannot be evaluated (a ValueError).
        NotReadyError: A node did not appear, so `once_ready` was not run (a TimeoutError).
    """
    from aionode.launch.running import RunningLaunch, first_of

    running = RunningLaunch(system, waits_for_nodes=once_ready is not None, stays=watch)
    try:
        async with asyncio.TaskGroup() as tasks:
            beside = [tasks.create_task(note_start(system))]
            if watch:
                beside.append(tasks.create_task(restart_changed(system)))
            if once_ready is not None:
                beside.append(tasks.create_task(run_once_ready(system, once_ready)))
            if plan.main is None:
                await running.run(plan.steps)
            else:
                await system.run_main(plan.main)
            for task in beside:
                task.cancel()
    except BaseExceptionGroup as group:
        raise first_of(group) from None


@asynccontextmanager
async def plan_running(plan: Plan, system: System) -> AsyncIterator[None]:
    """Run a plan alongside the body of ``async with``, which starts when everything is ready.

    A process is ready when its node is in the graph, if the file names one, and otherwise when it
    is running. At the end, the event handlers see a shutdown; `system`, which must have been
    entered, stops the rest.

    Args:
        plan: The plan.
        system: The system.

    Raises:
        LaunchFileError: The file, an event handler or a timer cannot be evaluated (a ValueError).
        NotReadyError: A node did not appear (a TimeoutError).
    """
    from aionode.launch.running import RunningLaunch

    running = RunningLaunch(system, waits_for_nodes=True)
    try:
        async with asyncio.TaskGroup() as tasks:
            work = tasks.create_task(running.run(plan.steps))
            if plan.main is not None:
                await plan.main(system)
            await running.begun.wait()
            await system.ready()
            yield
            work.cancel()
    except BaseExceptionGroup as group:
        raise group.exceptions[0] from None  # the one of the body or of the launch


async def note_start(system: System) -> None:
    """Log which members are running, with their process ids, once all have been started."""
    while not (table := system.status()) or any(
        status.state in {"waiting", "starting"} for status in table.values()
    ):
        await system.changed()
    width = max(map(len, table))
    for name, status in table.items():
        pid = "" if status.pid is None else f", process {status.pid}"
        system.log.note(f"{name:<{width}}  {status.state}{pid}")


async def run_once_ready(system: System, command: str) -> None:
    """Run a shell command when all members are ready, and log how it ended."""
    await system.ready()
    process = await asyncio.create_subprocess_shell(command)
    try:
        status = await process.wait()
    finally:
        if process.returncode is None:  # the launch is ending and leaves nothing behind
            process.kill()
            await process.wait()
    if status:
        system.log.note(f"{command!r} ended with status {status}")


def share_directory(package: str, workspace: str | Path | None = None) -> Path:
    """Return the share folder of a package, which contains its launch files and other data.

    Args:
        package: The name of the package.
        workspace: The folder with packages; by default the workspace around the current folder.

    Raises:
        PackageNotFoundError: There is no such package (a LookupError).
    """
    around = workspace_of(Path.cwd()) if workspace is None else Path(workspace)
    return Packages(around).share(package)


def joined(substitutions: list[Any]) -> str:
    """Return substitutions as written in the file."""
    return " + ".join(sub.describe() for sub in substitutions)
