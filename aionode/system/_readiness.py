"""Facts of the graph that determine when a member of a system is ready."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, ClassVar, Protocol, runtime_checkable

from aionode.errors import ServiceError
from aionode.graph import EndpointKind
from aionode.interfaces.lifecycle_msgs.msg import TransitionEvent
from aionode.interfaces.lifecycle_msgs.srv import GetState

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.node import Node

__all__ = ["ActionReady", "Fact", "NodeActive", "NodeExists", "ServiceReady", "TopicPublished"]

ASK_SEC = 2.0
"""Maximum time for a managed node to report its state, in seconds."""


@runtime_checkable
class Fact(Protocol):
    """A condition that a system waits for. Your own class may be one."""

    @property
    def timeout_sec(self) -> float:
        """Maximum time for the condition to become true, in seconds."""
        ...

    def __str__(self) -> str:
        """Describe what is awaited, such as ``a publisher of /odom``."""
        ...

    async def wait(self, node: Node) -> None:
        """Wait until the condition is true; cancelled after `timeout_sec`.

        Args:
            node: The system's node, which sees the graph.
        """
        ...


class GraphFact:
    """A fact about a name in the graph, which is the first field of the class."""

    timeout_sec: float
    _text: ClassVar[str]  # with {} for the name
    _endpoints: ClassVar[Sequence[tuple[EndpointKind, str]]] = ()  # kinds, and ends of names

    def __str__(self) -> str:
        """Describe what is awaited."""
        return self._text.format(self._name)

    @property
    def _name(self) -> str:
        """The full name; the leading slash may be omitted."""
        return f"/{getattr(self, fields(self)[0].name).lstrip('/')}"  # type: ignore[arg-type]

    async def wait(self, node: Node) -> None:
        """Wait until all of its endpoints are there."""
        for kind, end in self._endpoints:
            await endpoint_of(node, kind, self._name + end)


@dataclass(frozen=True)
class NodeExists(GraphFact):
    """A node is in the graph.

    Attributes:
        name: Its full name, such as ``/driver``.
        timeout_sec: How long this may take, in seconds.
    """

    _text = "node {}"
    name: str
    timeout_sec: float = 10.0

    async def wait(self, node: Node) -> None:
        """Wait until it is there."""
        name = self._name
        await node.graph.until(lambda: bool(node.graph.nodes_named(name)), name)


@dataclass(frozen=True)
class TopicPublished(GraphFact):
    """A topic has a publisher.

    Attributes:
        topic: Its full name.
        timeout_sec: How long this may take, in seconds.
    """

    _text = "a publisher of {}"
    _endpoints = ((EndpointKind.PUBLISHER, ""),)
    topic: str
    timeout_sec: float = 10.0


@dataclass(frozen=True)
class ServiceReady(GraphFact):
    """A service has a server.

    Attributes:
        service: Its full name.
        timeout_sec: How long this may take, in seconds.
    """

    _text = "service {}"
    _endpoints = ((EndpointKind.SERVER, ""),)
    service: str
    timeout_sec: float = 10.0


@dataclass(frozen=True)
class ActionReady(GraphFact):
    """An action has a server, so that goals can be sent, cancelled and awaited.

    Attributes:
        action: Its full name.
        timeout_sec: How long this may take, in seconds.
    """

    _text = "action {}"
    _endpoints = tuple(
        (EndpointKind.SERVER, f"/_action/{service}")
        for service in ("send_goal", "cancel_goal", "get_result")
    )
    action: str
    timeout_sec: float = 10.0


@dataclass(frozen=True)
class NodeActive(GraphFact):
    """A managed node is active, whoever activated it.

    Attributes:
        name: Its full name.
        timeout_sec: How long this may take, in seconds.
    """

    _text = "managed node {} to be active"
    name: str
    timeout_sec: float = 10.0

    async def wait(self, node: Node) -> None:
        """Wait until it is, requesting its state initially and after each of its transitions."""
        name = self._name
        moved = asyncio.Event()
        events = node.create_subscription(
            TransitionEvent, f"{name}/transition_event", lambda _: moved.set()
        )
        client = node.create_client(GetState, f"{name}/get_state")
        try:
            while True:
                moved.clear()
                await client.wait_for_service()
                try:
                    response = await client.call(GetState.Request(), timeout_sec=ASK_SEC)
                except (ServiceError, TimeoutError):
                    continue  # gone again, or busy; the next call waits for it
                if response.current_state.label == "active":
                    return
                await moved.wait()
        finally:
            events.destroy()
            client.destroy()


async def endpoint_of(node: Node, kind: EndpointKind, name: str) -> None:
    """Wait until the graph has an endpoint of this kind and name."""
    await node.graph.until(lambda: node.graph.count(kind, name) > 0, name)


def facts_of(ready: Fact | Sequence[Fact] | None, subject: str) -> tuple[Fact, ...]:
    """Return the facts that a user passed.

    Raises:
        TypeError: something else was given.
    """
    facts = () if ready is None else (ready,) if isinstance(ready, Fact) else tuple(ready)
    for fact in facts:
        if not isinstance(fact, Fact):
            raise TypeError(
                f"{subject}: ready={fact!r} is not a fact; use NodeExists, TopicPublished, "
                "ServiceReady, ActionReady or NodeActive of aionode.system"
            )
    return facts


async def missing_of(facts: Sequence[Fact], node: Node) -> list[str]:
    """Wait for all facts concurrently, and return those that did not come true in time."""

    async def wait(fact: Fact) -> str:
        try:
            async with asyncio.timeout(fact.timeout_sec):
                await fact.wait(node)
        except TimeoutError:
            return f"{fact} (waited {fact.timeout_sec:g} s)"
        return ""

    async with asyncio.TaskGroup() as tasks:
        waits = [tasks.create_task(wait(fact)) for fact in facts]
    return [text for task in waits if (text := task.result())]
