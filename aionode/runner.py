"""The one-line main program: a loop, signals, and an exit status."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Coroutine, Iterator, Sequence
from typing import Any

from aionode.arguments import parse_arguments
from aionode.context import Context
from aionode.errors import AionodeError
from aionode.logging import configure, get_logger
from aionode.node import Node
from aionode.streams import UnreadWatch, interrupt_main

__all__ = ["Runnable", "run"]

Runnable = Node | Callable[[], Node] | Callable[[], Coroutine[Any, Any, None]]
LoopFactory = Callable[[], asyncio.AbstractEventLoop]


def run(
    *nodes: Runnable,
    args: Sequence[str] | None = None,
    loop_factory: LoopFactory | None = None,
) -> None:
    """Run nodes until all have ended, or until Ctrl-C or SIGTERM.

    The first signal destroys every node, cancels its callbacks and waits for them; the function
    then returns, so that the program ends with status 0. A second one ends the process at once.

    Args:
        nodes: Nodes, or functions that make one, such as a class; they are called in the running
            loop. A coroutine function is run beside them.
        args: The command line without the name of the program, ``sys.argv[1:]`` if None. What is
            between ``--ros-args`` and ``--`` holds for all nodes.
        loop_factory: Makes the event loop; uvloop's if that is installed, else asyncio's.

    Raises:
        SystemExit: with status 1 after an error, which was printed on stderr: one line for an error
            of aionode's own, a traceback for a bug in a callback.
        TypeError: there is nothing to run.
        RuntimeError: it is called inside a running event loop.
    """
    if not nodes:
        raise TypeError("run: give at least one node, or a function that makes one")
    if asyncio._get_running_loop() is not None:  # noqa: SLF001  # get_running_loop raises instead
        raise RuntimeError(
            "run: an event loop runs already; `await node.run()` or `async with node:` runs a node "
            "in it"
        )
    try:
        set_up(sys.argv if args is None else [sys.argv[0], *args])
        with asyncio.Runner(loop_factory=loop_factory or best_loop_factory()) as runner:
            runner.run(_until_stopped(nodes))
    except Exception as error:  # told to the user, as the exit status is to the shell
        sys.stderr.write(failure_text(error))
        raise SystemExit(1) from error


def set_up(words: Sequence[str]) -> None:
    """Make the arguments hold for the default context and for logging.

    Raises:
        InvalidROSArgsError: an argument of ROS cannot be read (a ValueError).
        UnknownROSArgsError: an argument of ROS is unknown (a ValueError).
    """
    arguments = parse_arguments(words)
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
    Context.default().arguments = arguments


def best_loop_factory() -> LoopFactory | None:
    """Return what makes uvloop's loop where that is installed; None stands for asyncio's own."""
    try:
        import uvloop  # an optional extra
    except ImportError:
        return None
    factory: LoopFactory = uvloop.new_event_loop
    return factory


async def _until_stopped(nodes: Sequence[Runnable]) -> None:
    """Run all, and end quietly when a signal says so."""
    work = asyncio.current_task()
    assert work is not None  # noqa: S101  # a coroutine runs in a task
    loop = asyncio.get_running_loop()
    stopped = False

    def stop() -> None:
        nonlocal stopped
        stopped = True
        work.cancel()

    with signals_to(lambda: loop.call_soon_threadsafe(stop)):
        try:
            async with asyncio.TaskGroup() as tasks:
                for node in nodes:
                    tasks.create_task(_work_of(node))
        except asyncio.CancelledError:
            if not stopped:
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
    """Call `stop` at the first SIGINT or SIGTERM, and let the second one kill the process.

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
        signal.signal(number, on_second)
        if not first:
            first.append(number)
            unread.start()
        stop()

    def on_second(number: int, _frame: object) -> None:
        if number in woken:
            woken.remove(number)
            return
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    watched = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, on_signal) for number in watched]
    try:
        yield
    finally:
        unread.stop()
        for number, handler in zip(watched, before, strict=True):
            signal.signal(number, handler)


def failure_text(error: BaseException) -> str:
    """Return what a user needs to see of `error`: one line for ours, a traceback for a bug."""
    if isinstance(error, BaseExceptionGroup):
        return "".join(failure_text(part) for part in error.exceptions)
    if isinstance(error, AionodeError):
        return f"error: {error}\n"
    return "".join(traceback.format_exception(error))
