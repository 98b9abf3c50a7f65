"""The main program in one call: an event loop, signal handling and an exit status.

`_process/signals.py` handles the first and the second Ctrl-C.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
import inspect
import os
import sys
import traceback
from collections.abc import Callable, Coroutine, Sequence
from typing import Any, Final, Self, TextIO

from aionode._process.imports import program_has_frozen
from aionode._process.signals import signals_to, woken_by_signals
from aionode._process.tracebacks import TRACEBACK_VARIABLE, is_of_user, is_whole, traceback_text
from aionode.arguments import Arguments, parse_arguments
from aionode.endpoints.core.node_core import core_of, is_named
from aionode.engine.context import obeying
from aionode.errors import AionodeError, ConfigurationError, InvalidROSArgsError
from aionode.logging import configure, get_logger, release_root
from aionode.node import Node

__all__ = ["Runnable", "freeze_objects", "run"]

LOOP_VARIABLE: Final = "AIONODE_LOOP"

Runnable = Node | Callable[[], Node] | Callable[[], Coroutine[Any, Any, None]]
LoopFactory = Callable[[], asyncio.AbstractEventLoop]

STARTED_SEC = 1.0
"""Seconds after which a program has imported and created most of what it keeps."""


def run(
    *nodes: Runnable,
    args: Sequence[str] | None = None,
    loop_factory: LoopFactory | None = None,
) -> None:
    """Run nodes until all have ended, or until Ctrl-C, SIGTERM or SIGHUP.

    The first signal destroys every node: its callbacks are cancelled and waited for, up to 5 s, and
    what they publish in ``finally`` is sent. The function then returns, so the program ends with
    status 0. A callback in a thread (``offload=True``) cannot be cancelled; the log names it, and
    the program does not end before it has returned.

    Further signals of any kind within 1 s of the first are ignored: a parent such as GNU
    ``timeout`` or ``ros2 launch`` forwards a signal that the process group has already received. A
    later one ends the process within 0.2 s, with the shell's status for it: 130 after Ctrl-C, 143
    after SIGTERM, 129 after SIGHUP. Even then the stop of each open lease and everything published
    before are sent, even while a callback blocks the event loop; only a C function that does not
    return to Python delays this.

    SIGHUP means that the terminal is gone, such as that of an ssh session. It is handled only if it
    would end the process: not if it is ignored, as under ``nohup``, or if the program has its own
    handler. From the first signal on, output to a terminal or pipe that nobody can read any more is
    dropped instead of raising OSError. The previous handlers are restored at the end. SIGTSTP
    (Ctrl-Z) is handled only while a lease is open, even without this function: the stop is sent,
    and 0.2 s later the process is suspended.

    A second after the start it calls `freeze_objects`, unless the program has called ``gc.freeze``
    or ``gc.disable``, and undoes that when it returns; what the program freezes itself stays
    frozen. Messages of other loggers are shown until it returns, unless the program has configured
    `logging` itself.

    Args:
        nodes: Nodes, or callables that return one, such as a class, which are called in the running
            loop. A coroutine function is run alongside them.
        args: The command line without the program name; ``sys.argv[1:]`` if None. Arguments between
            ``--ros-args`` and ``--`` apply to all nodes created until the function returns.
        loop_factory: Creates the event loop; by default the one named by ``AIONODE_LOOP``,
            ``asyncio`` or ``uvloop``; without that variable, uvloop's if installed, else asyncio's.

    Raises:
        SystemExit: with status 1 after an error, which is printed on stderr: an error of aionode
            with the node, entity, file and line; any other exception with its traceback, without
            the lines inside aionode. ``AIONODE_TRACEBACK=1`` in the environment shows the whole
            traceback of either.
        TypeError: there is nothing to run, or a coroutine was given in place of its function.
        RuntimeError: it was called inside a running event loop.
    """
    if not nodes:
        raise TypeError("run: pass at least one node, or a function that returns one")
    given: tuple[object, ...] = nodes
    for each in given:
        if inspect.iscoroutine(each):
            each.close()
            name = each.__name__
            raise TypeError(f"run: {name}() was called; pass the function itself: run({name})")
    if asyncio._get_running_loop() is not None:  # get_running_loop raises instead
        raise RuntimeError(
            "run: an event loop is already running; use `await node.run()` or `async with node:` "
            "inside it"
        )
    try:
        args = sys.argv if args is None else [sys.argv[0], *args]
        arguments = set_up(args)
        refuse_created_before(nodes, arguments, args)
        stop = Stop()
        # Closing the loop waits for threads, so signals are handled until after that.
        with (
            obeying(arguments),
            signals_to(stop),
            Freeze() as freeze,
            asyncio.Runner(loop_factory=loop_factory or best_loop_factory()) as runner,
        ):
            runner.run(_until_stopped(nodes, stop, freeze))
    except Exception as error:  # printed for the user; the shell gets the exit status
        stderr: TextIO | None = sys.stderr  # None if it was closed when Python started
        if stderr is not None:
            with contextlib.suppress(OSError):  # the terminal is lost; the shell gets the status
                stderr.write(failure_text(error))
        raise SystemExit(1) from error
    finally:
        release_root()


def set_up(args: Sequence[str]) -> Arguments:
    """Parse the arguments, and set up logging accordingly.

    Raises:
        InvalidROSArgsError: a ROS argument is invalid (a ValueError).
        UnknownROSArgsError: a ROS argument is unknown (a ValueError).
    """
    arguments = parse_arguments(args)
    arguments.refuse_unknown()
    configure(
        level=arguments.log_level,
        levels=arguments.log_levels,
        console=arguments.stdout_logs,
        file_name=arguments.log_file_prefix(),
        whole_process=True,
    )
    for warning in arguments.warnings:
        get_logger("aionode").warning(warning)
    return arguments


def refuse_created_before(
    nodes: Sequence[Runnable], arguments: Arguments, args: Sequence[str]
) -> None:
    """Raise if arguments that apply to nodes come too late for an already created node.

    Raises:
        InvalidROSArgsError: there is such a node; the text says what to pass instead.
    """
    node_rules = (arguments.remap_rules, arguments.parameter_rules, arguments.enclave)
    if not any(node_rules) and arguments.rosout_logs:
        return
    for node in nodes:
        if isinstance(node, Node) and core_of(node).uses_global_arguments:
            given = args[args.index("--ros-args") + 1 :]
            raise InvalidROSArgsError(
                " ".join(given),
                f"too late for node {node.get_fully_qualified_name()}, which was created before "
                f"`run` read the arguments; let `run` create it, as in "
                f"aionode.run({maker_of(node)}), or pass it use_global_arguments=False",
            )


def maker_of(node: Node) -> str:
    """Return code that would create this node."""
    kind = type(node)
    return "lambda: Node(...)" if kind is Node else kind.__name__


def best_loop_factory() -> LoopFactory | None:
    """Return the factory of the event loop; None means asyncio's own.

    Raises:
        ConfigurationError: ``AIONODE_LOOP`` names no event loop, or one that is not installed (a
            ValueError).
    """
    wanted = os.environ.get(LOOP_VARIABLE, "")
    if wanted not in {"", "asyncio", "uvloop"}:
        raise ConfigurationError(LOOP_VARIABLE, wanted, "use asyncio or uvloop")
    if wanted == "asyncio":
        return None
    try:
        import uvloop  # an optional extra
    except ImportError:
        if wanted:
            fits = "it is not installed: pip install 'aionode[fast]', or use asyncio"
            raise ConfigurationError(LOOP_VARIABLE, wanted, fits) from None
        return None
    factory: LoopFactory = uvloop.new_event_loop
    return factory


class Stop:
    """Cancels the main task at the first signal, or as soon as it starts.

    Attributes:
        wanted: Whether the signal has arrived.
    """

    def __init__(self) -> None:
        self.wanted = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[Any] | None = None

    def begin(self) -> None:
        """Make the current task the one to cancel."""
        self._loop = asyncio.get_running_loop()
        self._task = asyncio.current_task()
        if self.wanted:
            self._cancel()

    def __call__(self) -> None:
        """Cancel the task; a signal handler may call this at any moment."""
        self.wanted = True
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop is closed: everything has ended
                self._loop.call_soon_threadsafe(self._cancel)

    def _cancel(self) -> None:
        if self._task is not None:
            self._task.cancel()


async def _until_stopped(nodes: Sequence[Runnable], stop: Stop, freeze: Freeze) -> None:
    """Run everything, and return normally if a signal stops it."""
    stop.begin()
    loop = asyncio.get_running_loop()
    loop.call_later(STARTED_SEC, freeze)
    try:
        with woken_by_signals(loop):
            async with asyncio.TaskGroup() as tasks:
                for node in nodes:
                    tasks.create_task(_coroutine_of(node))
    except asyncio.CancelledError:
        if not stop.wanted:
            raise


def _coroutine_of(node: Runnable) -> Coroutine[Any, Any, None]:
    work = node if isinstance(node, Node) else node()
    if isinstance(work, Node):
        return _run_node(work)
    if inspect.iscoroutine(work):
        return work
    raise TypeError(f"run: {node!r} returned {work!r}, which is neither a node nor a coroutine")


async def _run_node(node: Node) -> None:
    """Run a node without logging its failure, since `run` prints it in more detail."""
    await node.run()


def freeze_objects() -> None:
    """Collect garbage now, and exclude every existing object from later collections.

    A full collection looks at every object of the process while the event loop stands still: 30 ms
    for an empty node, more with each library and node. Afterwards it looks only at objects created
    since. `run` calls this a second after the start; in a program of your own, call it once the
    nodes run. It takes as long as one full collection.

    Objects that were frozen are still freed as soon as nothing refers to them. Only reference
    cycles stay in memory, until ``gc.unfreeze()``.
    """
    gc.collect()
    gc.freeze()


class Freeze:
    """Calls `freeze_objects` within a block, and undoes that at its end.

    The process may continue afterwards. What the program itself has frozen stays frozen.
    """

    def __init__(self) -> None:
        self._count = 0  # number of frozen objects after ours were frozen

    def __enter__(self) -> Self:
        return self

    def __call__(self) -> None:
        """Freeze all objects, unless the program has frozen some or has disabled collection."""
        if gc.isenabled() and not program_has_frozen():
            freeze_objects()
            self._count = gc.get_freeze_count()

    def __exit__(self, *_: object) -> None:
        if self._count and gc.get_freeze_count() <= self._count:
            gc.unfreeze()


# Failures


def failure_text(error: BaseException) -> str:
    """Return what to print for `error`: a summary for aionode's own errors, else a traceback."""
    if isinstance(error, BaseExceptionGroup):
        return "".join(failure_text(part) for part in error.exceptions)
    if is_whole():
        return traceback_text(error)
    if not isinstance(error, AionodeError):
        return f"{traceback_text(error)}({TRACEBACK_VARIABLE}=1 shows aionode's lines as well)\n"
    lines = [f"error: {error}", *circumstances(error)]
    return "\n  ".join(lines) + "\n"


def circumstances(error: AionodeError) -> list[str]:
    """Return the origin of `error`: the entity, the node and the line of the user's program."""
    lines = list(getattr(error, "__notes__", ()))
    place = None
    for frame, line in traceback.walk_tb(error.__traceback__):
        if is_of_user(frame):
            place = (frame, line)
        owner = frame.f_locals.get("self")
        if isinstance(owner, Node) and not lines and is_named(owner):
            lines.append(f"in node {owner.get_fully_qualified_name()}")
    if place is not None:
        (summary,) = traceback.StackSummary.extract(iter([place]))
        location = f'File "{summary.filename}", line {summary.lineno}, in {summary.name}'
        lines.append(f"{location}: {summary.line}" if summary.line else location)
        lines.append(f"({TRACEBACK_VARIABLE}=1 shows the whole traceback)")
    return lines
