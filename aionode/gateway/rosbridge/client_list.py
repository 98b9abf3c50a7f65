"""The topics that rosbridge publishes about the number of its clients and their addresses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.std_msgs.msg import Int32
from aionode.message import DEFAULT, Message, Sequence
from aionode.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["ClientList", "ConnectedClients"]

LATEST = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class ConnectedClient(Message, typename="rosbridge_msgs/msg/ConnectedClient"):
    """A client, and the time of its connection."""

    ip_address: str = ""
    connection_time: Time = DEFAULT


class ConnectedClients(Message, typename="rosbridge_msgs/msg/ConnectedClients"):
    """The connected clients."""

    clients: Annotated[list[ConnectedClient], Sequence[ConnectedClient]] = DEFAULT


class ClientList:
    """Publishes ``client_count`` and ``connected_clients``, which rosbridge dashboards read.

    Args:
        node: The node of the gateway.
    """

    def __init__(self, node: Node) -> None:
        self._clock = node.get_clock()
        self._clients: dict[object, ConnectedClient] = {}
        self._count = node.create_publisher(Int32, "client_count", LATEST)
        self._list = node.create_publisher(ConnectedClients, "connected_clients", LATEST)
        self._publish()

    @contextmanager
    def listing(self, address: str) -> Iterator[None]:
        """List a rosbridge client for as long as it is connected.

        Args:
            address: Its address.
        """
        key = object()
        now = self._clock.now().to_msg()
        self._clients[key] = ConnectedClient(ip_address=address, connection_time=now)
        self._publish()
        try:
            yield
        finally:
            del self._clients[key]
            self._publish()

    def close(self) -> None:
        """Destroy the publishers."""
        self._count.destroy()
        self._list.destroy()

    def _publish(self) -> None:
        if not self._count.destroyed:
            self._count.publish(Int32(data=len(self._clients)))
            self._list.publish(ConnectedClients(clients=list(self._clients.values())))
