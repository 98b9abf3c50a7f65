"""The methods of executors and nodes called by modules on lower levels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy._impl.node import NodeHandle

__all__ = ["ExecutorLike", "NodeLike"]


class ExecutorLike(Protocol):
    """An executor, as seen by tasks and nodes."""

    def create_task(self, callback: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        """Schedule a function or coroutine; return its future."""

    def wake(self) -> None:
        """Wake it to check again what is ready."""

    def get_nodes(self) -> list[Any]:
        """Return the nodes that it serves."""


class NodeLike(Protocol):
    """A node, as seen by executors and its own services."""

    executor: Any
    _publishers: list[Any]
    _timers: list[Any]
    _subscriptions: list[Any]
    _guards: list[Any]
    _clients: list[Any]
    _services: list[Any]
    _Node__handle: NodeHandle
    _Node__waitables: list[Any]

    @property
    def handle(self) -> NodeHandle:
        """The handle."""

    def get_name(self) -> str:
        """Return the name."""

    def get_logger(self) -> Any:
        """Return the logger."""

    def has_parameter(self, name: str) -> bool:
        """Return whether a parameter is declared."""

    def declare_parameter(self, name: str, value: Any = ..., descriptor: Any = ...) -> Any:
        """Declare a parameter."""

    def get_parameter(self, name: str) -> Any:
        """Return a parameter."""

    def add_on_set_parameters_callback(self, callback: Callable[[list[Any]], Any]) -> None:
        """Add a callback."""

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: Any,
    ) -> Any:
        """Return a subscription."""

    def destroy_subscription(self, subscription: Any) -> bool:
        """Destroy a subscription."""

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: Any = ...,
    ) -> Any:
        """Return a service."""
