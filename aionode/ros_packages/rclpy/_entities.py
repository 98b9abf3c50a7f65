"""The base classes of the entities of nodes: a handle, and how it is destroyed."""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, Self, TypeVar

from aionode.clock import MachineTime
from rclpy._impl.destroyable import Destroyable, Signal, Wakeup

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy._impl.endpoint import EndpointHandle
    from rclpy._impl.services import ClientHandle, ServiceHandle
    from rclpy._impl.topics import PublisherHandle, SubscriptionHandle
    from rclpy.context import Context
    from rclpy.event_handler import EventHandler

__all__ = ["HandleOwner", "ServiceEntity", "TopicEntity", "in_use", "in_use_by_node", "wait_until"]

CHECK_S = 0.05
"""Time between two checks while waiting for another process."""

steady_ns = MachineTime().steady_ns

P = ParamSpec("P")
T = TypeVar("T")
HandleT = TypeVar("HandleT", bound=Destroyable)
EndpointHandleT = TypeVar("EndpointHandleT", bound="EndpointHandle[Any]")
TopicHandleT = TypeVar("TopicHandleT", bound="PublisherHandle | SubscriptionHandle")
ServiceHandleT = TypeVar("ServiceHandleT", bound="ClientHandle | ServiceHandle")


def in_use(method: Callable[Concatenate[HandleT, P], T]) -> Callable[Concatenate[Any, P], T]:
    """Return a method for owners of handles that calls `method` of their handle.

    The handle is not destroyed during a call; once it is destroyed, calls raise InvalidHandle.
    """

    @wraps(method)
    def call(self: HandleOwner[HandleT], /, *args: P.args, **kwargs: P.kwargs) -> T:
        with self._handle as handle:
            return method(handle, *args, **kwargs)

    return call


def in_use_by_node(
    method: Callable[Concatenate[HandleT, P], T],
) -> Callable[Concatenate[Any, P], T]:
    """Return the same for nodes, whose names with one underscore belong to their users."""

    @wraps(method)
    def call(self: Any, /, *args: P.args, **kwargs: P.kwargs) -> T:
        with self._Node__handle as handle:
            return method(handle, *args, **kwargs)

    return call


class HandleOwner(Generic[HandleT]):
    """An object with a handle, destroyed at the end of ``with``."""

    _handle: HandleT

    @property
    def handle(self) -> HandleT:
        """The handle."""
        return self._handle

    def destroy(self) -> None:
        """Destroy it. For entities created by a node, use the node's method."""
        self._handle.destroy_when_not_in_use()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class EndpointEntity(HandleOwner[EndpointHandleT]):
    """A publisher, subscription, client or server."""

    @property
    def logger_name(self) -> str:
        """The name of the node's logger."""
        with self._handle:
            return self._handle.get_logger_name()


class TopicEntity(EndpointEntity[TopicHandleT]):
    """A publisher or subscription."""

    event_handlers: list[EventHandler]

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        with self._handle:
            return self._handle.name

    def destroy(self) -> None:
        """Destroy it, and its event handlers. Use the method of the node."""
        for handler in self.event_handlers:
            handler.destroy()
        super().destroy()


class ServiceEntity(EndpointEntity[ServiceHandleT]):
    """A client or service server."""

    @property
    def service_name(self) -> str:
        """The full name of the service."""
        with self._handle:
            return self._handle.name


def wait_until(
    is_ready: Callable[[], object],
    context: Context,
    timeout_sec: float | None,
    wakeup: Wakeup | None = None,
) -> bool:
    """Block the thread until something is ready; nothing has to spin.

    Args:
        is_ready: Returns something true if it is.
        context: The context, whose shutdown ends the wait.
        timeout_sec: Maximum time to wait, in seconds; None for no limit.
        wakeup: Woken when it may be ready; if None, `is_ready` is asked again and again.

    Returns:
        Whether it is ready.
    """
    ends_ns = None if timeout_sec is None else steady_ns() + timeout_sec * 1e9
    step_s = CHECK_S if wakeup is None else None
    wakeup = wakeup or Wakeup()
    signal = Signal() if context.handle is None else context.handle.signal
    try:
        signal.add(wakeup)
        while not is_ready():
            left_s = step_s
            if ends_ns is not None:
                left_s = (ends_ns - steady_ns()) / 1e9
                if left_s <= 0:
                    return False
                left_s = left_s if step_s is None else min(left_s, step_s)
            if not context.ok():
                return False
            wakeup.wait(left_s)
        return True
    finally:
        signal.remove(wakeup)
