"""Restart a node when it fails, and report its health.

The terms are systemd's: `restart` is its ``Restart=``. A node fails through an exception in one of
its callbacks; its replacement is created by the same function.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, Literal, Self, TypeVar

from aionode._process.restart import Backoff, wants_another
from aionode._process.tracebacks import traceback_text
from aionode.clock import S_TO_NS, SteadyClock
from aionode.endpoints.core.end_record import NodeEnd, short_text
from aionode.errors import NodeNotRunningError
from aionode.logging import get_logger
from aionode.node import Node

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.clock import TimeBase

__all__ = ["Health", "Restart", "Supervisor"]

NodeT = TypeVar("NodeT", bound=Node)

Restart = Literal["on-failure", "always", "no"]


@dataclass(frozen=True)
class Health:
    """The health of a supervised node, for a log or an HTTP endpoint such as ``/healthz``.

    Attributes:
        ok: Whether the node is running: HTTP status 200, otherwise 503.
        state: ``"starting"`` (for the first time), ``"running"``, ``"restarting"`` (it failed, and
            the next one starts soon) or ``"ended"``.
        node: Full name of the node; empty before the first was created.
        restarts: How often it was restarted.
        uptime_sec: How long it has been running, in seconds; 0 while it is not.
        error: Why the last node failed, in one line; empty if none has.
    """

    ok: bool
    state: Literal["starting", "running", "restarting", "ended"]
    node: str
    restarts: int
    uptime_sec: float
    error: str


class Supervisor(Generic[NodeT]):
    """Keeps a node running by creating a new one when it fails.

    Use it as the main program, or for the lifetime of a web application::

        aionode.run(Supervisor(Robot).run)

        async with Supervisor(Robot) as robot:
            ...
            robot.node.arm.call(...)    # the node running now
            robot.health()

    The delay before a restart is `min_delay_sec`, and doubles with each failure in a row up to
    `max_delay_sec`; a node that has run for `max_delay_sec` resets it. Each failure is logged with
    its traceback. A failure of the very first start, before the node runs, is raised and not
    retried, as it is a mistake in the program or its arguments.

    Args:
        make_node: Creates the node, such as its class; called in the running loop for each start.
        restart: ``"on-failure"``: when a callback raised; ``"always"``: when the node was destroyed
            as well; ``"no"``: never, only to report `health`.
        min_delay_sec: The first delay, in seconds.
        max_delay_sec: The longest delay, in seconds.
        clock: The time base of the delays, such as a `ManualClock`; the machine's by default.

    Raises:
        ValueError: `restart` is unknown, or the delays are negative or not in order.
    """

    def __init__(
        self,
        make_node: Callable[[], NodeT],
        *,
        restart: Restart = "on-failure",
        min_delay_sec: float = 0.5,
        max_delay_sec: float = 30.0,
        clock: TimeBase | None = None,
    ) -> None:
        if restart not in ("on-failure", "always", "no"):
            raise ValueError(
                f'Supervisor: restart={restart!r} is unknown; use "on-failure", "always" or "no"'
            )
        self.__backoff = Backoff(min_delay_sec, max_delay_sec, "Supervisor")
        self.__make_node = make_node
        self.__restart = restart
        self.__clock = SteadyClock(time_base=clock)
        self.__state: Literal["starting", "running", "restarting", "ended"] = "starting"
        self.__node: NodeT | None = None
        self.__name = ""
        self.__since_ns = 0
        self.__restarts = 0
        self.__last_end: NodeEnd | None = None
        self.__error = ""
        self.__tasks: asyncio.TaskGroup | None = None
        self.__work: asyncio.Task[None] | None = None

    def __repr__(self) -> str:
        return f"<Supervisor {self.__name} {self.__state} restarts={self.__restarts}>"

    # Lifetime

    async def __aenter__(self) -> Self:
        """Create the node, and return when it is running.

        Raises:
            RuntimeError: it was entered before.
            Exception: the node could not be created or started.
        """
        if self.__tasks is not None:
            raise RuntimeError("Supervisor: cannot be entered twice; create another one")
        started: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self.__tasks = await asyncio.TaskGroup().__aenter__()
        self.__work = self.__tasks.create_task(self.__supervise(started), name="supervisor")
        try:
            await started
        except BaseException:
            await self.__aexit__(None, None, None)
            raise
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Destroy the node, and wait until its callbacks have ended.

        An exception from the body propagates unchanged.
        """
        assert self.__tasks is not None  # noqa: S101  # set by __aenter__
        assert self.__work is not None  # noqa: S101  # as above
        self.__work.cancel()
        await self.__tasks.__aexit__(None, None, None)

    async def run(self) -> None:
        """Run the node until no restart follows; with ``restart="always"``, until cancelled.

        Raises:
            Exception: the node could not be started for the first time, or it failed and
                ``restart="no"``.
        """
        async with self:
            assert self.__work is not None  # noqa: S101  # set by __aenter__
            await asyncio.wait([self.__work])
        if self.__last_end is not None and self.__last_end.error is not None:
            raise self.__last_end.error

    # Health

    @property
    def node(self) -> NodeT:
        """The node that is running now; read it each time, as it changes with a restart.

        Raises:
            NodeNotRunningError: none is running, as it failed or was destroyed (a RuntimeError).
        """
        if self.__node is None:
            raise NodeNotRunningError(self.__name or "of the supervisor", self.__why_none())
        return self.__node

    def __why_none(self) -> str:
        if self.__state == "starting":
            return "it has not started yet; enter the supervisor with `async with` first"
        if self.__state == "restarting":
            return f"it failed ({self.__error}) and restarts soon; answer 503, or retry later"
        return f"it failed ({self.__error})" if self.__error else "it was destroyed"

    def health(self) -> Health:
        """Return the current health of the node."""
        running = self.__state == "running"
        return Health(
            ok=running,
            state=self.__state,
            node=self.__name,
            restarts=self.__restarts,
            uptime_sec=(self.__clock.now_ns() - self.__since_ns) / S_TO_NS if running else 0.0,
            error=self.__error,
        )

    # Supervision

    async def __supervise(self, started: asyncio.Future[None]) -> None:
        try:
            while True:
                self.__last_end = end = await self.__run_one(started)
                if not started.done():
                    started.set_exception(end.error or RuntimeError("the node did not start"))
                    return
                if not self.__wants_another(end):
                    return
                await self.__pause(end)
                self.__restarts += 1
        finally:
            self.__state = "ended"

    async def __run_one(self, started: asyncio.Future[None]) -> NodeEnd:
        """Run one node until it ends; an exception is returned as the reason."""
        try:
            node = self.__make_node()
            self.__name = node.get_fully_qualified_name()
            async with node:
                self.__node = node
                self.__state = "running"
                self.__since_ns = self.__clock.now_ns()
                if not started.done():
                    started.set_result(None)
                await node.until_destroyed()
        except Exception as error:  # noqa: BLE001  # reported by the log, `health` and `run`
            self.__error = short_text(error)
            return NodeEnd("failed", error)
        finally:
            self.__node = None
        return NodeEnd("destroyed")

    def __wants_another(self, end: NodeEnd) -> bool:
        # A cancellation during the shutdown of a failed node is hidden by the node's exceptions.
        if self.__work is not None and self.__work.cancelling():
            return False
        return wants_another(self.__restart, failed=end.reason == "failed")

    async def __pause(self, end: NodeEnd) -> None:
        """Wait before the next start, longer with each failure in a row."""
        was_running, self.__state = self.__state == "running", "restarting"
        ran_ns = self.__clock.now_ns() - self.__since_ns if was_running else 0
        delay_sec = self.__backoff.delay_after(ran_ns / S_TO_NS)
        trace = "" if end.error is None else ":\n" + traceback_text(end.error)
        get_logger("aionode.supervisor").error(
            f"node {self.__name} {end.reason}; restarting in {delay_sec:g} s{trace}"
        )
        await self.__clock.sleep(delay_sec)
