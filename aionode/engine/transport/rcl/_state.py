"""The state shared by all entities of a context: rclpy's context, its nodes, the event loop."""

from __future__ import annotations

import logging
from abc import abstractmethod
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

from aionode.engine.transport.base import Registration
from aionode.engine.transport.drops import Drop, Drops
from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.rcl._bindings import load, middleware_problem
from aionode.engine.transport.rcl._qos import to_rmw
from aionode.engine.transport.send_thread import SendThread
from aionode.errors import TransportError
from aionode.graph import EndpointKind
from aionode.qos import QoSProfile

if TYPE_CHECKING:
    import asyncio

    from aionode.engine.transport.rcl._bindings import Rcl
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["PREFIX_BYTES", "RclDeclaration", "RclState"]

logger = logging.getLogger("aionode.transport.rcl")

PREFIX_BYTES: Final = 12
"""Bytes of a gid that identify the participant over DDS (RTPS 2.5, 9.3.1.1)."""


class RclState:
    """The connection of one context, open or not.

    Attributes:
        participant: Id of the context.
        domain_id: The ROS domain.
        rcl: The functions of rcl, while it is open or after.
        loop: The event loop while it is open, else None.
        graph: The graph while it is open, else None.
        waker: Wakes the loop from the threads that send.
        bulk: The thread that sends large messages.
        watcher: The node that queries the graph while it is open; hidden from it.
        own_gids: Gids of this context's publishers and clients.
        own_prefixes: Their prefixes over Fast DDS: each participant has one.
        malformed: Number of malformed messages by topic or service.
        refused: Number of messages that rcl did not send, by topic.
    """

    def __init__(self, participant: str, domain_id: int) -> None:
        self.participant = participant
        self.domain_id = domain_id
        self.rcl: Rcl | None = None
        self.loop: asyncio.AbstractEventLoop | None = None
        self.graph: Graph | None = None
        self.waker = LoopWaker()
        self.bulk = SendThread("aionode-rcl-bulk", self.waker)
        self.watcher: Any = None
        self.own_gids: set[bytes] = set()
        self.own_prefixes: set[bytes] = set()
        self.drops = Drops(logger)
        self._context: Any = None
        self._nodes: dict[NodeInfo, Any] = {}  # with their handles, or None while closed
        self._declarations: dict[RclDeclaration, None] = {}

    @property
    def context_handle(self) -> Any:
        """The extension module's context."""
        return self._context.handle

    @property
    def watcher_name(self) -> str:
        """The name of the node that queries the graph."""
        return f"_aionode_graph_{self.participant[:16]}"

    def open(self, loop: asyncio.AbstractEventLoop, graph: Graph) -> None:
        """Join the domain, and declare everything.

        Raises:
            TransportError: rclpy is not installed, is too old, or cannot join.
        """
        rcl = self.rcl = load()
        from rclpy.context import Context

        context = Context()
        try:
            # No signal handlers, and no log file in the user's home.
            context.init(args=[], initialize_logging=False, domain_id=self.domain_id)
        except Exception as error:  # rclpy's own exceptions, none of which is public
            raise TransportError(middleware_problem(error)) from error
        self._context, self.loop, self.graph = context, loop, graph
        self.waker.open(loop)
        self.watcher = self._make_node(rcl, self.watcher_name, "/")
        for info in self._nodes:
            self.node(info)
        for declaration in list(self._declarations):
            declaration.declare(rcl)

    async def flush(self) -> None:
        """Wait until the threads have sent what is pending."""
        for declaration in list(self._declarations):
            await declaration.flush()

    def close(self) -> None:
        """Undeclare everything, newest first, and leave the domain."""
        if self._context is None:
            return
        for declaration in reversed(self._declarations):
            declaration.undeclare()
        for info, node in self._nodes.items():
            if node is not None:
                node.destroy_when_not_in_use()
            self._nodes[info] = None
        self.watcher.destroy_when_not_in_use()
        context, self._context = self._context, None
        self.watcher = self.loop = self.graph = None
        context.shutdown()
        context.destroy()
        self.bulk.close()
        self.waker.close()
        self.own_gids.clear()
        self.own_prefixes.clear()

    def add(self, declaration: RclDeclaration) -> None:
        """Declare now, or as soon as it is open."""
        self._declarations[declaration] = None
        if self._context is not None and self.rcl is not None:
            try:
                declaration.declare(self.rcl)
            except BaseException:
                del self._declarations[declaration]
                raise

    def remove(self, declaration: RclDeclaration) -> None:
        """Forget a declaration."""
        self._declarations.pop(declaration, None)

    def add_node(self, info: NodeInfo) -> None:
        """Create a node now, or as soon as it is open."""
        self._nodes[info] = None
        if self._context is not None:
            self.node(info)

    def node(self, info: NodeInfo) -> Any:
        """Return the handle of a node of this context, creating it on first use."""
        handle = self._nodes.get(info)
        if handle is None and self.rcl is not None:
            handle = self._nodes[info] = self._make_node(self.rcl, info.name, info.namespace)
        return handle

    def remove_node(self, info: NodeInfo) -> None:
        """Destroy the handle of a node."""
        handle = self._nodes.pop(info, None)
        if handle is not None:
            handle.destroy_when_not_in_use()

    def own_node_names(self) -> Counter[str]:
        """Count the nodes of this context by full name."""
        return Counter(info.fully_qualified_name for info in self._nodes)

    def _make_node(self, rcl: Rcl, name: str, namespace: str) -> Any:
        arguments: tuple[Any, ...] = (name, namespace, self.context_handle, [], False, False)
        with self.context_handle:
            try:
                return rcl.module.Node(*arguments, to_rmw(QoSProfile(depth=1)))
            except TypeError:  # Jazzy's has no profile for /rosout
                return rcl.module.Node(*arguments)

    def count_own_readers(self, writer: EndpointInfo) -> int:
        """Count the subscriptions of this context that match one of its publishers."""
        return sum(
            declaration.endpoint.kind is EndpointKind.SUBSCRIPTION
            and declaration.endpoint.name == writer.name
            and writer.matches(declaration.endpoint)
            for declaration in self._declarations
        )

    def note_own(self, gid: bytes) -> None:
        """Record the gid of a publisher or client of this context."""
        self.own_gids.add(gid)
        if self.rcl is not None and self.rcl.is_fast_dds:
            self.own_prefixes.add(gid[:PREFIX_BYTES])

    def is_own(self, gid: bytes) -> bool:
        """Return whether a message is this context's own, which `LocalTransport` has delivered."""
        return gid in self.own_gids or gid[:PREFIX_BYTES] in self.own_prefixes

    def note_refused(self, topic: str) -> None:
        """Count a message that the middleware rejected, and log the reason."""
        reason = "" if self.rcl is None else self.rcl.error()
        self.drops.note(Drop.NOT_SENT, topic, reason)

    def note_malformed(self, name: str, problem: str) -> None:
        """Count a malformed message, and log it as `Drops` does."""
        self.drops.note(Drop.MALFORMED, name, problem)


class RclDeclaration(Registration):
    """A registration that exists in rcl while the context is open.

    Attributes:
        state: The state of the context.
        endpoint: The endpoint.
    """

    def __init__(self, state: RclState, endpoint: EndpointInfo) -> None:
        self.state = state
        self.endpoint = endpoint

    def __hash__(self) -> int:
        return id(self)

    @abstractmethod
    def declare(self, rcl: Rcl) -> None:
        """Create its entity.

        Raises:
            TransportError: its type is not installed, or rcl refuses it.
        """

    @abstractmethod
    def undeclare(self) -> None:
        """Destroy its entity, if there is one."""

    async def flush(self) -> None:
        """Wait until what is pending in a thread was sent."""

    def close(self) -> None:
        """Destroy it for good. Repeating it has no effect."""
        self.state.remove(self)
        self.undeclare()

    def make(self, factory: Any, ros_class: Any, least_depth: int = 0) -> Any:
        """Create an entity on the endpoint's node.

        Raises:
            TransportError: rcl refuses it.
        """
        node = self.state.node(self.endpoint.node)
        try:
            with node:
                return factory(
                    node, ros_class, self.endpoint.name, to_rmw(self.endpoint.qos, least_depth)
                )
        except Exception as error:  # rclpy's own exceptions, none of which is public
            raise TransportError(
                f"{self.endpoint.kind.value} of {self.endpoint.name}: rcl refuses it: {error}"
            ) from error

    def identify(self, gid: bytes) -> None:
        """Use the gid that other processes see."""
        if self.state.graph is not None:
            self.state.graph.identify(self.endpoint, gid)
