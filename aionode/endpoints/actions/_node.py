"""The node as action servers and clients see it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    import asyncio

    from aionode.clock import Clock, TimeBase
    from aionode.endpoints._core.callback_runner import Callbacks
    from aionode.graph import Graph
    from aionode.logging import RcutilsLogger

__all__ = ["ActionNode"]


class ActionContext(Protocol):
    """The context of such a node."""

    @property
    def participant(self) -> str:
        """The id of the context in the graph."""

    @property
    def time_base(self) -> TimeBase:
        """The source of time."""

    def new_uuid(self) -> bytes:
        """Return the 16 bytes of a new id for a goal."""

    @property
    def network(self) -> Any:
        """The settings of the context, with what may wait in a queue."""


class ActionNode(Protocol):
    """The methods of an `aionode.Node` that actions call.

    A protocol, as `Node` itself imports the actions.
    """

    _Node__callbacks: Callbacks

    @property
    def context(self) -> ActionContext:
        """The node's context."""

    @property
    def graph(self) -> Graph:
        """The nodes and endpoints known now."""

    def get_clock(self) -> Clock:
        """Return the node's clock."""

    def get_logger(self) -> RcutilsLogger:
        """Return the node's logger."""

    def resolve_topic_name(self, topic: str) -> str:
        """Return the full name of a topic."""

    def create_publisher(self, msg_type: Any, topic: str, qos_profile: Any) -> Any:
        """Return a publisher."""

    def create_subscription(
        self, msg_type: Any, topic: str, callback: Any, qos_profile: Any
    ) -> Any:
        """Return a subscription."""

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Any,
        *,
        qos_profile: Any,
        concurrent: Any = ...,
        on_error: Any = ...,
    ) -> Any:
        """Return a service server."""

    def create_client(self, srv_type: Any, srv_name: str, *, qos_profile: Any) -> Any:
        """Return a client."""

    def _Node__add_entity(self, entity: Any) -> Any:
        """Own an entity that is made of others."""

    def _Node__expect_at_end(self, answer: asyncio.Future[Any]) -> None:
        """Have the end of the node wait for an answer."""
