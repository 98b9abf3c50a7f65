"""The public methods of a node, as used by actions and built-in services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from aionode.endpoints.core.node_core import HasCore

if TYPE_CHECKING:
    from aionode.clock import Clock
    from aionode.engine.context import Context
    from aionode.graph import Graph
    from aionode.logging import RcutilsLogger
    from aionode.parameter import OnSetCallback, Parameter, PostSetCallback

__all__ = ["NodeMethods"]


class NodeMethods(HasCore, Protocol):
    """Methods of `aionode.Node`; a protocol, because `Node` imports their callers."""

    context: Context

    @property
    def graph(self) -> Graph:
        """The currently known nodes and endpoints."""

    def get_clock(self) -> Clock:
        """Return the node's clock."""

    def get_logger(self) -> RcutilsLogger:
        """Return the node's logger."""

    def resolve_topic_name(self, topic: str) -> str:
        """Return the full name of a topic."""

    def create_publisher(self, msg_type: Any, topic: str, qos_profile: Any) -> Any:
        """Create a publisher."""

    def create_subscription(
        self, msg_type: Any, topic: str, callback: Any, qos_profile: Any
    ) -> Any:
        """Create a subscription."""

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Any,
        *,
        qos_profile: Any = ...,
        concurrent: Any = ...,
        on_error: Any = ...,
    ) -> Any:
        """Create a service server."""

    def create_client(self, srv_type: Any, srv_name: str, *, qos_profile: Any = ...) -> Any:
        """Create a client."""

    # Entities

    @property
    def publishers(self) -> list[Any]:
        """The publishers of this node."""

    @property
    def subscriptions(self) -> list[Any]:
        """The subscriptions of this node."""

    @property
    def services(self) -> list[Any]:
        """The services of this node."""

    @property
    def clients(self) -> list[Any]:
        """The clients of this node."""

    # Parameters

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter is declared."""

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter."""

    def declare_parameter(self, name: str, value: Any, descriptor: Any = ...) -> Parameter:
        """Declare a parameter and return it."""

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a callback that checks changes."""

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a callback that runs after each change."""
