"""Bringing managed nodes up in order, and down in reverse order, through their services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

from aionode.errors import TransitionError
from aionode.interfaces.lifecycle_msgs.msg import Transition
from aionode.interfaces.lifecycle_msgs.srv import ChangeState, GetState

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from types import TracebackType

    from aionode.endpoints.client import Client
    from aionode.node import Node

__all__ = ["LifecycleManager"]

DOWN = {
    "active": ("deactivate", "cleanup"),
    "inactive": ("cleanup",),
}
"""The transitions that lead from a state back to unconfigured."""


class LifecycleManager:
    """Manages nodes in this process, in other processes, or in ROS 2.

    ::

        async with LifecycleManager(node, ["/camera", "/planner"]):
            ...  # both are active; at the end /planner goes down first, then /camera

    Args:
        node: The node whose clients call the managed ones; it must be running.
        node_names: Full names of the managed nodes, in the order in which they are brought up.
        timeout_sec: How long a node may take to appear, and to answer each request, in seconds.
    """

    def __init__(self, node: Node, node_names: Sequence[str], *, timeout_sec: float = 10.0) -> None:
        self.node_names = list(node_names)
        self._timeout_s = timeout_sec
        self._changes: dict[str, Client[ChangeState.Request, ChangeState.Response]] = {}
        self._states: dict[str, Client[GetState.Request, GetState.Response]] = {}
        for name in self.node_names:
            self._changes[name] = node.create_client(ChangeState, f"{name}/change_state")
            self._states[name] = node.create_client(GetState, f"{name}/get_state")

    async def __aenter__(self) -> Self:
        """Bring the nodes up; see `startup`."""
        await self.startup()
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Bring them down; see `reset`."""
        await self.reset()

    async def startup(self) -> None:
        """Configure the nodes in order, then activate them in order.

        If one fails, or this is cancelled, the nodes already configured are brought down again, the
        last one first.

        Raises:
            TransitionError: a node refused, failed, or did not appear.
            RequestTimeoutError: a node did not answer in time.
        """
        try:
            for label in ("configure", "activate"):
                for name in self.node_names:
                    await self.change_state(name, label)
        except BaseException:
            await self._down(self.node_names, strict=False)
            raise

    async def reset(self) -> None:
        """Bring the nodes down to unconfigured, the last one first, whatever states they are in.

        Every node is brought down, even if another one fails.

        Raises:
            ExceptionGroup: the failures of the nodes.
        """
        await self._down(self.node_names, strict=True)

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
        """Have one node make a transition.

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

    async def get_state(self, node_name: str) -> str:
        """Return the label of a node's state.

        Raises:
            RequestTimeoutError: it did not answer in time.
        """
        response = await self._states[node_name].call(
            GetState.Request(), timeout_sec=self._timeout_s
        )
        return response.current_state.label

    async def _down(self, names: Iterable[str], *, strict: bool) -> None:
        errors: list[Exception] = []
        for name in reversed(list(names)):
            if not self._states[name].service_is_ready():
                continue  # it is gone, or never appeared
            try:
                for label in DOWN.get(await self.get_state(name), ()):
                    await self.change_state(name, label)
            except (TransitionError, TimeoutError) as error:
                errors.append(error)
        if errors and strict:
            raise ExceptionGroup("managed nodes could not be brought down", errors)
