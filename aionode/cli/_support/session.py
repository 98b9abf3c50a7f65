"""Running a verb with a node, handling Ctrl-C, and the exit status."""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING

import click

from aionode._distribution import other_distribution
from aionode._process.imports import uncollected
from aionode.cli._support.error_text import one_line
from aionode.cli._support.exit import INTERRUPTED, owns_process, status_of
from aionode.cli._support.output import Output
from aionode.errors import AionodeError

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine

    from aionode.engine.context import Context
    from aionode.node import Node
    from aionode.runner import LoopFactory

__all__ = ["make_node", "run_verb", "silent_processes"]

CLOSE_S = 0.9
"""Timeout for a command to exit after printing its answer, in seconds."""

STOP_S = 3.5
"""Timeout for a command to exit after a signal, in seconds."""

QUIET_S = 2.0
"""How long discovery must be quiet to count as complete, in seconds.

Zenoh has been seen to pause this long between the first of 3000 endpoints and the rest.
"""

PROGRESS_S = 1.0
"""Interval of progress reports while a command waits, in seconds."""

UNLIMITED_MS = 3_600_000.0
"""Callback budget of a command: nothing else runs in its loop, and terminals are slow."""


def make_node(
    context: Context | None = None,
    node_name: str | None = None,
    *,
    use_sim_time: bool = False,
) -> Node:
    """Return the node of a command: hidden, without a log, and with a single service.

    Without a `context` it creates one: the process's default context depends on the environment at
    its first use, and belongs to the program that runs the command. The service describes the
    types that it uses, which others may not know: those of a topic used only by ``topic echo
    --interfaces``, for example.
    """
    # Imported when a command runs; its help does not need it.
    from aionode.engine.context import Context
    from aionode.node import Node
    from aionode.parameter import Parameter

    return Node(
        node_name or f"_aionode_cli_{os.getpid()}",
        context=Context() if context is None else context,
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("use_sim_time", value=use_sim_time)],
        callback_budget_ms=UNLIMITED_MS,
    )


def run_verb(
    verb: Callable[[Node, Output], Awaitable[int | None]],
    *,
    json: bool = False,
    node_name: str | None = None,
    use_sim_time: bool = False,
    endless: bool = False,
    busy: bool = False,
    asks: bool = True,
    stop_s: float = STOP_S,
) -> None:
    """Run `verb` with a node until it returns or Ctrl-C is pressed; then end the command.

    Args:
        verb: Called with a running node and the output; it may return an exit status.
        json: Whether to print records.
        node_name: Name of the node; defaults to a hidden name.
        use_sim_time: Whether the node takes its time from ``/clock``.
        endless: Whether Ctrl-C is the normal end (status 0) and not an interruption (130).
        busy: Whether to expect many messages, which makes the faster event loop worth its import.
        asks: Whether the verb needs a complete graph and so waits for discovery first.
        stop_s: Timeout for the exit after a signal, in seconds.

    Raises:
        click.exceptions.Exit: always, with the exit status.
        AionodeError: the verb failed.
    """
    # Imported when a command runs; its help does not need it.
    with uncollected():
        from aionode.cli._support.deadline import Deadline
        from aionode.runner import best_loop_factory

    output = Output(json=json)
    stopped_status = 0 if endless else INTERRUPTED
    deadline = Deadline(armed=owns_process())

    async def work() -> int | None:
        async with make_node(node_name=node_name, use_sim_time=use_sim_time) as node:
            try:
                if asks:
                    await wait_until_known(node, output)
                status = await verb(node, output)
            except AionodeError as error:
                text, status = f"{one_line(error)}\n", status_of(error)
                deadline.set(CLOSE_S, status, text)
                raise
            except asyncio.CancelledError:
                deadline.set(CLOSE_S, stopped_status)
                raise
            deadline.set(CLOSE_S, status or 0)
            return status

    try:
        status = run_until_stopped(
            work(),
            loop_factory=best_loop_factory() if busy else None,
            on_stop=lambda: deadline.set(stop_s, stopped_status),
        )
    finally:
        deadline.cancel()
    raise click.exceptions.Exit(stopped_status if status is None else status)


async def wait_until_known(node: Node, output: Output) -> None:
    """Wait until discovery is complete, and report progress if that takes long.

    It waits as long as new information arrives. If a peer does not answer, it warns that the output
    may be incomplete.
    """
    transports = node.context.transports
    asked = asyncio.gather(*(transport.all_known(QUIET_S) for transport in transports))
    while not (await asyncio.wait((asked,), timeout=PROGRESS_S))[0]:
        count = len(node.graph.nodes()) + len(node.graph.endpoints())
        output.warn(f"Waiting for discovery: {count} nodes and endpoints so far")
    if not all(await asked):
        unknown = "a reachable peer has not answered (frozen, overloaded or far away?)"
        for who in silent_processes(node) or [unknown]:
            output.warn(f"WARNING: {who}: this may be incomplete")
    participant = node.context.participant
    hashes = {
        endpoint.type_hash
        for endpoint in node.graph.endpoints()
        if endpoint.node.participant != participant and not endpoint.node.bridged
    }
    hint = other_distribution(node.context.ros_distro, hashes)
    if hint is not None:
        output.warn(f"WARNING: {hint}")


def silent_processes(node: Node) -> list[str]:
    """Describe the processes that do not answer the command's node."""
    return [who for transport in node.context.transports for who in transport.silent_processes()]


def run_until_stopped(
    work: Coroutine[None, None, int | None],
    loop_factory: LoopFactory | None = None,
    on_stop: Callable[[], object] = lambda: None,
) -> int | None:
    """Return the exit status of `work`, or None if a signal ended it.

    Args:
        work: Cancelled at the first signal.
        loop_factory: Creates the event loop; defaults to asyncio's own.
        on_stop: Called at the first signal, even while the loop is blocked.

    Raises:
        BaseException: what `work` raised; the most informative error if there are several.
    """
    from aionode._process.signals import signals_to, woken_by_signals
    from aionode.runner import Stop

    stop = Stop()

    def on_signal() -> None:
        on_stop()
        stop()

    async def stoppable() -> int | None:
        stop.begin()
        with signals_to(on_signal), woken_by_signals(asyncio.get_running_loop()):
            try:
                return await work or 0
            except asyncio.CancelledError:
                if stop.wanted:
                    return None
                raise

    try:
        with asyncio.Runner(loop_factory=loop_factory) as runner:
            return runner.run(stoppable())
    except BaseExceptionGroup as group:
        raise first_error(group) from None


def first_error(group: BaseExceptionGroup[BaseException]) -> BaseException:
    """Return the most informative error of a group: one of aionode's own if there is one."""
    known, _ = group.split((AionodeError, BrokenPipeError))
    error: BaseException = known or group
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return error
