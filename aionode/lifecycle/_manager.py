"""Bring managed nodes up in order, and down in reverse order, through their services."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Self

from aionode.errors import AionodeError, ServiceUnavailableError, TransitionError
from aionode.interfaces.lifecycle_msgs.msg import Transition
from aionode.interfaces.lifecycle_msgs.srv import ChangeState, GetState
from aionode.lifecycle._events import EventSource
from aionode.lifecycle._node_watch import LEVELS, ManagedNodeEvent, NodeWatch

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Sequence
    from types import TracebackType

    from aionode.endpoints.client import Client
    from aionode.node import Node

__all__ = ["LifecycleManager"]

UPWARD = ("configure", "activate")
"""The transitions from each of `LEVELS` to the next."""

DOWNWARD = ("cleanup", "deactivate")
"""The transitions that undo them."""

GOALS = {
    "configure": "inactive",
    "activate": "active",
    "deactivate": "inactive",
    "cleanup": "unconfigured",
    "shutdown": "finalized",
}
"""The state that each transition leads to."""


class LifecycleManager:
    """Manages nodes in this process, in other processes, or in ROS 2.

    ::

        async with LifecycleManager(node, ["/camera", "/planner"]):
            ...  # both are active; at the end /planner goes down first, then /camera

    Within ``async with`` it watches the nodes. The log and `events` report a node that has gone or
    become unreachable, and one that is back: restarted by a `Supervisor` or a launch file, it is
    unconfigured again. With `restore` it is brought back to the state that it had.

    Args:
        node: The node whose clients call the managed ones; it must be running.
        node_names: Full names of the managed nodes, in the order in which they are brought up.
        timeout_sec: How long a node may take to appear, and to answer each request, in seconds.
        restore: Whether a node that is back is brought to the state that it had. It might then
            start moving without anybody asking for it, so by default it is left as it is. The nodes
            that use it keep their states.
    """

    def __init__(
        self,
        node: Node,
        node_names: Sequence[str],
        *,
        timeout_sec: float = 10.0,
        restore: bool = False,
    ) -> None:
        self.node_names = list(node_names)
        self._node = node
        self._timeout_s = timeout_sec
        self._restores = restore
        self._changes: dict[str, Client[ChangeState.Request, ChangeState.Response]] = {}
        self._states: dict[str, Client[GetState.Request, GetState.Response]] = {}
        for name in self.node_names:
            self._changes[name] = node.create_client(ChangeState, f"{name}/change_state")
            self._states[name] = node.create_client(GetState, f"{name}/get_state")
        self._last_states: dict[str, str] = {}  # as far as known without asking
        self._events: EventSource[ManagedNodeEvent] = EventSource()
        self._tasks: asyncio.TaskGroup | None = None
        self._watch: NodeWatch | None = None
        self._watching: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        """Bring the nodes up, as `startup` does, and watch them."""
        await self.startup()
        if self._watch is not None:  # already entered
            self._events = EventSource()
        services = {name: client.srv_name for name, client in self._changes.items()}
        self._watch = NodeWatch(self._node, services, self._last_states, self._tell)
        self._tasks = await asyncio.TaskGroup().__aenter__()
        work = self._welcome_all(self._watch)
        self._watching = self._tasks.create_task(work, name="lifecycle manager")
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Bring the nodes down; see `reset`. The log names those that are gone."""
        assert self._watch is not None  # noqa: S101  # set by __aenter__
        assert self._tasks is not None  # noqa: S101  # as above
        assert self._watching is not None  # noqa: S101  # as above
        self._watch.close()
        # A transition in progress has to end first: a node that is configuring cannot go down.
        await asyncio.wait([self._watching], timeout=self._timeout_s)
        self._watching.cancel()
        await self._tasks.__aexit__(None, None, None)
        try:
            await self.reset()
        finally:
            self._events.end()

    async def startup(self) -> None:
        """Configure the nodes in order, then activate them in order.

        If one fails, or this is cancelled, the nodes already configured are brought down again, the
        last one first; the log names those for which that failed.

        Raises:
            TransitionError: a node refused, failed, or did not appear.
            RequestTimeoutError: a node did not answer in time.
        """
        try:
            for label in ("configure", "activate"):
                for name in self.node_names:
                    await self.change_state(name, label)
        except BaseException:
            for error in await self._down():
                self._node.get_logger().error(f"lifecycle manager: {error}")
            raise

    async def reset(self) -> None:
        """Bring the nodes down to unconfigured, the last one first, whatever states they are in.

        Every node is brought down, even if another one fails. The log names nodes that are gone but
        were configured or active when last seen.

        Raises:
            ExceptionGroup: the failures of the nodes.
        """
        errors = await self._down()
        if errors:
            raise ExceptionGroup("managed nodes could not be brought down", errors)

    async def shutdown(self) -> None:
        """Finalize the nodes, the last one first.

        Raises:
            TransitionError: a node refused, failed, or did not appear.
            RequestTimeoutError: a node did not answer in time.
        """
        for name in reversed(self.node_names):
            if await self.get_state(name) != "finalized":
                await self.change_state(name, "shutdown")

    async def change_state(self, node_name: str, label: str) -> None:
        """Make one node perform a transition.

        Raises:
            TransitionError: it refused, failed, or did not appear.
            RequestTimeoutError: it did not answer in time.
        """
        client = self._changes[node_name]
        if not await client.wait_for_service(self._timeout_s):
            raise TransitionError(
                node_name, label, "unknown", f"no such node appeared in {self._timeout_s:g} s"
            )
        request = ChangeState.Request(transition=Transition(label=label))
        response = await client.call(request, timeout_sec=self._timeout_s)
        if not response.success:
            state = await self.get_state(node_name)
            raise TransitionError(node_name, label, state, "it refused or failed; see its log")
        self._last_states[node_name] = GOALS.get(label, "unknown")

    async def get_state(self, node_name: str) -> str:
        """Return the label of a node's state.

        Raises:
            RequestTimeoutError: it did not answer in time.
        """
        response = await self._states[node_name].call(
            GetState.Request(), timeout_sec=self._timeout_s
        )
        state: str = response.current_state.label
        if state in (*LEVELS, "finalized"):
            self._last_states[node_name] = state
        return state

    async def events(self) -> AsyncIterator[ManagedNodeEvent]:
        """Iterate over the events of the nodes, from the first step of the iteration on.

        It ends when ``async with`` is left. The newest hundred events are kept for a slow reader.
        """
        async for event in self._events.iterate():
            yield event

    async def _down(self) -> list[Exception]:
        """Bring down all nodes that are present; return the failures."""
        errors: list[Exception] = []
        for name in reversed(self.node_names):
            try:
                if self._states[name].service_is_ready():
                    await self._lead(name, "unconfigured")
                else:
                    self._warn_of_gone(name)
            except ServiceUnavailableError:  # it is just ending
                self._warn_of_gone(name)
            except (AionodeError, TimeoutError) as error:
                errors.append(error)
        return errors

    def _warn_of_gone(self, name: str) -> None:
        """Log that a node is gone, if it may still be active somewhere."""
        last_state = self._last_states.get(name, "")
        if last_state in LEVELS[1:]:
            self._node.get_logger().warning(
                f"lifecycle manager: {name} was {last_state} when it was last seen, and has gone "
                "or cannot be reached: it could not be brought down; check that it has stopped"
            )

    async def _lead(self, name: str, goal: str) -> None:
        """Take a node through the transitions from its state to `goal`, one of `LEVELS`.

        Raises:
            TransitionError: it refused or failed, or no transition leads there.
            RequestTimeoutError: it did not answer in time.
        """
        state = await self.get_state(name)
        if state == "finalized" and goal == "unconfigured":
            return
        if state not in LEVELS:
            raise TransitionError(name, f"become {goal}", state, "no transition leads there")
        start, end = LEVELS.index(state), LEVELS.index(goal)
        for label in UPWARD[start:end] or reversed(DOWNWARD[end:start]):
            await self.change_state(name, label)

    # Nodes that go and return

    def _tell(self, event: ManagedNodeEvent) -> None:
        """Log an event, and pass it to the readers."""
        if event.kind in ("lost", "failed"):
            self._node.get_logger().error(f"lifecycle manager: {event}")
        else:
            self._node.get_logger().info(f"lifecycle manager: {event}")
        self._events.emit(event)

    async def _welcome_all(self, watch: NodeWatch) -> None:
        """Handle each node that is back, until the watch is closed or the manager's node ends."""
        while (name := await watch.next_return()) is not None:
            try:
                await self._welcome(name, watch)
            except (AionodeError, TimeoutError) as error:
                if self._node.destroyed:
                    return
                state = self._last_states.get(name, "unknown")
                self._tell(ManagedNodeEvent(name, "failed", state, watch.state_before(name), error))

    async def _welcome(self, name: str, watch: NodeWatch) -> None:
        """Report a node that is back, and restore its state if configured to.

        Raises:
            TransitionError: it refused, failed, or went away again.
            RequestTimeoutError: it did not answer in time.
        """
        if not await self._states[name].wait_for_service(self._timeout_s):
            raise TransitionError(name, "be asked for its state", "unknown", "it has gone again")
        state = await self.get_state(name)
        before = watch.state_before(name)
        if watch.was_lost(name) or state != before:
            self._tell(ManagedNodeEvent(name, "returned", state, before))
        if self._restores and state != before and before in LEVELS:
            await self._lead(name, before)
            self._tell(ManagedNodeEvent(name, "restored", before, before))
        watch.settle(name)
