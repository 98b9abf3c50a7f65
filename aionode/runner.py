"""The one-line main program: a loop, signals, and an exit status."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import os
import select
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Coroutine, Iterator, Sequence
from pathlib import Path
from types import FrameType
from typing import Any

from aionode._streams import UnreadWatch, interrupt_main
from aionode.arguments import Arguments, parse_arguments
from aionode.context import Context
from aionode.errors import AionodeError, InvalidROSArgsError
from aionode.logging import configure, get_logger
from aionode.node import Node

__all__ = ["Runnable", "run"]

Runnable = Node | Callable[[], Node] | Callable[[], Coroutine[Any, Any, None]]
LoopFactory = Callable[[], asyncio.AbstractEventLoop]

TRACEBACK_VARIABLE = "AIONODE_TRACEBACK"
"""Set to anything, it makes `run` show errors of aionode with their traceback, too."""

LIBRARY = Path(__file__).parent
STANDARD_LIBRARY = Path(asyncio.__file__).parent.parent


def run(
    *nodes: Runnable,
    args: Sequence[str] | None = None,
    loop_factory: LoopFactory | None = None,
) -> None:
    """Run nodes until all have ended, or until Ctrl-C or SIGTERM.

    The first signal destroys every node: its callbacks are cancelled and waited for, up to 5 s, and
    what they publish in ``finally`` is sent. The function then returns, so that the program ends
    with status 0. A callback in a thread (``offload=True``) cannot be cancelled; the log names it,
    and the program does not end before it has returned. A second signal ends the process at once,
    with status 130 after Ctrl-C and 143 after SIGTERM, as shells have it.

    Args:
        nodes: Nodes, or functions that make one, such as a class; they are called in the running
            loop. A coroutine function is run beside them.
        args: The command line without the name of the program, ``sys.argv[1:]`` if None. What is
            between ``--ros-args`` and ``--`` holds for all nodes that are made from now on until
            the function returns.
        loop_factory: Makes the event loop; uvloop's if that is installed, else asyncio's.

    Raises:
        SystemExit: with status 1 after an error, which was printed on stderr. Of an error of
            aionode's own it tells node, entity, file and line; of a bug in a callback, or with
            ``AIONODE_TRACEBACK=1`` in the environment, the whole traceback.
        TypeError: there is nothing to run.
        RuntimeError: it is called inside a running event loop.
    """
    if not nodes:
        raise TypeError("run: give at least one node, or a function that makes one")
    if asyncio._get_running_loop() is not None:  # get_running_loop raises instead
        raise RuntimeError(
            "run: an event loop runs already; `await node.run()` or `async with node:` runs a node "
            "in it"
        )
    try:
        args = sys.argv if args is None else [sys.argv[0], *args]
        arguments = set_up(args)
        refuse_made_before(nodes, arguments, args)
        stop = Stop()
        # The end of the loop waits for threads, so signals are watched for until after that.
        with (
            Context._obeying(arguments),
            signals_to(stop),
            asyncio.Runner(loop_factory=loop_factory or best_loop_factory()) as runner,
        ):
            runner.run(_until_stopped(nodes, stop))
    except Exception as error:  # told to the user, as the exit status is to the shell
        sys.stderr.write(failure_text(error))
        raise SystemExit(1) from error


def set_up(args: Sequence[str]) -> Arguments:
    """Read the arguments, and set up logging as they say.

    Raises:
        InvalidROSArgsError: an argument of ROS cannot be read (a ValueError).
        UnknownROSArgsError: an argument of ROS is unknown (a ValueError).
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


def refuse_made_before(
    nodes: Sequence[Runnable], arguments: Arguments, args: Sequence[str]
) -> None:
    """Raise if arguments that shape nodes come too late for one that exists.

    Raises:
        InvalidROSArgsError: there is such a node; the text says what to give in its place.
    """
    shaping = (arguments.remap_rules, arguments.parameter_rules, arguments.enclave)
    if not any(shaping) and arguments.rosout_logs:
        return
    for node in nodes:
        if isinstance(node, Node) and node._uses_global_arguments:
            given = args[args.index("--ros-args") + 1 :]
            raise InvalidROSArgsError(
                " ".join(given),
                f"too late for node {node.get_fully_qualified_name()}, which was made before `run` "
                f"read it; let `run` make the node, as in aionode.run({maker_of(node)}), or make "
                "it with use_global_arguments=False",
            )


def maker_of(node: Node) -> str:
    """Return what makes a node like this one, in code."""
    kind = type(node)
    return "lambda: Node(...)" if kind is Node else kind.__name__


def best_loop_factory() -> LoopFactory | None:
    """Return what makes uvloop's loop where that is installed; None stands for asyncio's own."""
    try:
        import uvloop  # an optional extra
    except ImportError:
        return None
    factory: LoopFactory = uvloop.new_event_loop
    return factory


class Stop:
    """What the first signal does: cancels the work, now or as soon as it begins.

    Attributes:
        wanted: Whether the signal has come.
    """

    def __init__(self) -> None:
        self.wanted = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._work: asyncio.Task[Any] | None = None

    def begin(self) -> None:
        """Note that the work is this task."""
        self._loop = asyncio.get_running_loop()
        self._work = asyncio.current_task()
        if self.wanted:
            self._cancel()

    def __call__(self) -> None:
        """Cancel the work; called by a signal, so at any moment."""
        self.wanted = True
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop was closed, and all has ended
                self._loop.call_soon_threadsafe(self._cancel)

    def _cancel(self) -> None:
        if self._work is not None:
            self._work.cancel()


async def _until_stopped(nodes: Sequence[Runnable], stop: Stop) -> None:
    """Run all, and end quietly when a signal says so."""
    stop.begin()
    try:
        async with asyncio.TaskGroup() as tasks:
            for node in nodes:
                tasks.create_task(_work_of(node))
    except asyncio.CancelledError:
        if not stop.wanted:
            raise


def _work_of(node: Runnable) -> Coroutine[Any, Any, None]:
    made = node if isinstance(node, Node) else node()
    if isinstance(made, Node):
        return made.run()
    if inspect.iscoroutine(made):
        return made
    raise TypeError(f"run: {node!r} made {made!r}, which is neither a node nor a coroutine")


@contextlib.contextmanager
def signals_to(stop: Callable[[], object]) -> Iterator[None]:
    """Call `stop` at the first SIGINT or SIGTERM, and let the second one end the process.

    The handlers are Python's own and not the loop's, so that they work while a callback blocks the
    loop. Outside the main thread nothing is changed: signals do not arrive there.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    first: list[int] = []
    woken: list[int] = []

    def wake() -> None:
        woken.append(first[0])
        interrupt_main(signal.Signals(first[0]))

    # What blocks the loop may be a full pipe that nobody reads any more.
    unread = UnreadWatch(wake)

    def on_signal(number: int, _frame: object) -> None:
        for each in watched:
            signal.signal(each, on_second)
        first.append(number)
        unread.start()
        stop()

    def on_second(number: int, frame: FrameType | None) -> None:
        if number in woken:
            woken.remove(number)
        else:
            end_at_once(number, frame)

    watched = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, on_signal) for number in watched]
    try:
        yield
    finally:
        unread.stop()
        for number, handler in zip(watched, before, strict=True):
            signal.signal(number, handler)


def end_at_once(number: int, _frame: object) -> None:
    """End the process, whatever it is doing: threads cannot be cancelled, and may take any time."""
    text = f"aionode: ended at once by a second signal ({signal.Signals(number).name})\n"
    stderr = 2
    # Whoever reads stderr may not read any more; that must not keep the process.
    with contextlib.suppress(OSError, ValueError):
        if select.select([], [stderr], [], 0)[1]:
            os.write(stderr, text.encode())
    os._exit(128 + number)


# Failures


def failure_text(error: BaseException) -> str:
    """Return what a user needs to see of `error`: the place of ours, a traceback for a bug."""
    if isinstance(error, BaseExceptionGroup):
        return "".join(failure_text(part) for part in error.exceptions)
    if not isinstance(error, AionodeError) or os.environ.get(TRACEBACK_VARIABLE):
        return "".join(traceback.format_exception(error))
    lines = [f"error: {error}", *circumstances(error)]
    return "\n  ".join(lines) + "\n"


def circumstances(error: AionodeError) -> list[str]:
    """Return where `error` was made: entity and node, and the line of the user's program."""
    found = list(getattr(error, "__notes__", ()))
    place = None
    for frame, line in traceback.walk_tb(error.__traceback__):
        if is_of_user(frame):
            place = (frame, line)
        owner = frame.f_locals.get("self")
        # A node whose name was refused has none.
        if isinstance(owner, Node) and not found and hasattr(owner, "_info"):
            found.append(f"in node {owner.get_fully_qualified_name()}")
    if place is not None:
        (summary,) = traceback.StackSummary.extract(iter([place]))
        said = f'File "{summary.filename}", line {summary.lineno}, in {summary.name}'
        found.append(f"{said}: {summary.line}" if summary.line else said)
        found.append(f"({TRACEBACK_VARIABLE}=1 shows the whole traceback)")
    return found


def is_of_user(frame: FrameType) -> bool:
    """Whether a frame is neither of aionode nor of Python's standard library."""
    path = Path(frame.f_code.co_filename)
    installed = "site-packages" in path.parts
    generated = "__name__" not in frame.f_globals  # such as what checks a message
    standard = STANDARD_LIBRARY in path.parents and not installed
    return not (generated or standard or LIBRARY in path.parents)
