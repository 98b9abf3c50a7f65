"""An assistant for the robot within a program, or behind a command's standard streams."""

from __future__ import annotations

from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any, Self

from mcp.server.stdio import stdio_server

from aionode._process.concurrency import to_the_end
from aionode.errors import ConfigurationError, RefusedError
from aionode.gateway._clients import Clients
from aionode.gateway.mcp.server import McpServer
from aionode.gateway.policy.identity import Credentials, Identity
from aionode.gateway.policy.policy import Policy

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.gateway.session.robot import Ask
    from aionode.node import Node

__all__ = ["Assistant"]

LOOPBACK = Credentials(address="127.0.0.1", host="127.0.0.1")
"""The credentials of a program on this host that has no others."""


class Assistant:
    """Lets the MCP client of a model use a robot: ``async with Assistant(node) as assistant:``.

    The policy decides on the tools, their limits and what they may reach; see `Policy`. It needs
    the extra ``mcp``. For clients over HTTP, use `Gateway` with ``mcp=True``.

    Args:
        node: The node by which the assistant takes part in the graph. The node has to be running.
        policy: Who may do what; by default `Policy.default`, by which it only looks.
        name: The ``[[who]]`` of the policy for this client; by default that for programs on this
            host.
        ask: Asks a person, where a rule of the policy has ``ask``, as for `Gateway`; by default the
            client asks its user, and if it cannot, the request is refused.
        about: A description of this robot for the model: what it is for, and what to be careful
            about.
        bags: A folder of recordings of which the model gets summaries; empty for none.

    Raises:
        ConfigurationError: the policy has no client of that name (a ValueError).

    Attributes:
        node: The node.
        clients: The sessions of the clients, their policy, and the robot.
    """

    def __init__(
        self,
        node: Node,
        policy: Policy | None = None,
        *,
        name: str = "",
        ask: Ask | None = None,
        about: str = "",
        bags: str = "",
    ) -> None:
        self.node = node
        self.clients = Clients(node, Policy.default() if policy is None else policy, ask)
        self._name = name
        if name:
            self.identity()
        self._mcp = McpServer(self.clients, self._client, about, bags)

    @property
    def server(self) -> Any:
        """The low-level server of the MCP SDK, for its transports and for clients in tests."""
        return self._mcp.server

    def identity(self) -> Identity:
        """Return the client's identity under the current policy.

        Raises:
            ConfigurationError: the policy has no client of the name (a ValueError).
            RefusedError: the policy has no entry for programs on this host.
        """
        if not self._name:
            return self.clients.policy.identify(LOOPBACK)
        identity = self.clients.policy.named(self._name, LOOPBACK.address)
        if identity is not None:
            return identity
        known = ", ".join(who.name for who in self.clients.policy.who) or "none"
        raise ConfigurationError(
            "assistant's name",
            self._name,
            f"the policy has no [[who]] of this name; use one of {known}",
        )

    def _client(self) -> Identity:
        """Return the identity of a request's client.

        Raises:
            RefusedError: the policy, which may have changed, does not know the client.
        """
        try:
            return self.identity()
        except ConfigurationError as error:
            raise RefusedError("client", str(error), "unauthorized") from error

    async def __aenter__(self) -> Self:
        """Start; clients are served from now on.

        Raises:
            RuntimeError: the node is not running.
        """
        self.clients.check_node()
        async with AsyncExitStack() as stack:
            tasks = await self.clients.open(stack)
            stack.callback(tasks.create_task(self._mcp.run()).cancel)
            stack.push_async_callback(self._end)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End the calls in progress: send the stops of their leases, and cancel their goals."""
        if isinstance(error, Exception):
            kind = error = traceback = None  # the task group would wrap the program's error
        await to_the_end(self._stack.__aexit__(kind, error, traceback))

    async def _end(self) -> None:
        self.clients.end()
        await self.clients.robot.commands.close()

    def tell(self, text: str) -> None:
        """Tell listening clients about an event, such as ``the battery is low``.

        They read it from the resource ``robot://events``, together with the warnings of the robot's
        log.
        """
        self._mcp.events.tell(text)

    async def serve_stdio(self) -> None:
        """Serve one client over the standard streams of this process, until it closes them."""
        async with stdio_server() as (incoming, outgoing):
            await self.server.run(incoming, outgoing, self.server.create_initialization_options())
