"""The common part of publishers, subscriptions, servers and clients: a bare node's endpoint."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rclpy._impl.destroyable import Destroyable
from rclpy._impl.qos import profile_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.bare_node import BareEndpoint
    from aionode.engine.causes import CauseLog
    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile
    from rclpy._impl.node import NodeHandle

__all__ = ["EndpointHandle"]

BareT = TypeVar("BareT", bound="BareEndpoint")


class EndpointHandle(Destroyable, Generic[BareT]):
    """The handle of an endpoint of a bare node, which `_announce` creates.

    Args:
        node: Its node.
        name: Its topic or service, as given by the program.
        qos_profile: Its profile.
        failure: The text of the error after shutdown.
        is_service: Whether the name is that of a service.

    Attributes:
        io: The thread that works for it.
        causes: What its callbacks work on is noted there; None if it is not.
        bare: The endpoint in the core; used in that thread only.
        name: The full name of its topic or service.
        profile: Its profile, with policies that the endpoint resolves.

    Raises:
        RCLError: the context is shut down.
    """

    bare: BareT

    def __init__(
        self, node: NodeHandle, name: str, qos_profile: Any, failure: str, *, is_service: bool
    ) -> None:
        super().__init__(node.signal)
        self._node = node
        self.io = node.io
        self.causes: CauseLog | None = node.bare.context.causes
        node.context_handle.refuse_after_shutdown(failure)
        self.name = node.resolve(name, is_service=is_service)
        self.profile: QoSProfile = profile_of(qos_profile)

    def _announce(self, create: Callable[..., BareT], wire_type: Any, *receiver: Any) -> None:
        """Create the endpoint at the bare node; nothing is delivered here meanwhile."""
        self.bare = self.io.call(
            self.io.change_delivery, partial(create, wire_type, self.name, self.profile, *receiver)
        )

    @property
    def endpoint(self) -> EndpointInfo:
        """The entry in the graph."""
        return self.bare.endpoint

    def get_logger_name(self) -> str:
        """Return the name of the node's logger."""
        return self._node.logger_name()

    def _count_matched(self) -> int:
        """Return the number of matched endpoints of the opposite kind."""
        return len(self.io.call(self.bare.matched))

    def _destroy(self) -> None:
        if hasattr(self, "bare"):
            self.io.post(partial(self.io.change_delivery, self.bare.destroy))
        self.signal.notify()
