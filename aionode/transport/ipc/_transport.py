"""Zenoh, and links beside it: the contract of transports with two ways to each reader."""

from __future__ import annotations

import logging
import os
from typing import TYPE_CHECKING, Any

from aionode.errors import TransportError
from aionode.transport.base import Transport
from aionode.transport.ipc._listener import Advertisement, Listener, socket_folder
from aionode.transport.ipc._manager import LinkManager
from aionode.transport.ipc._protocol import can_link
from aionode.transport.ipc._publisher import IpcWriter
from aionode.transport.ipc._service import IpcRequester, IpcServer
from aionode.transport.ipc._subscription import IpcReader, ZenohFilter, may_be_large

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo, Graph, NodeInfo
    from aionode.transport.base import LinkStatus, Reader, Registration, Requester, Serve, Writer
    from aionode.transport.ipc._manager import PeerDirectory

__all__ = ["IpcTransport"]

logger = logging.getLogger("aionode.transport.ipc")


class IpcTransport(Transport):
    """Uses links where there are some, and another transport for everything else.

    Args:
        participant: Id of the context: hexadecimal, no leading zeros.
        domain_id: The ROS domain.
        zenoh: The other transport.
        peer_directory: What it knows of who is there.
    """

    def __init__(
        self, participant: str, domain_id: int, zenoh: Transport, peer_directory: PeerDirectory
    ) -> None:
        self.zenoh = zenoh
        self.manager = LinkManager(participant, domain_id, peer_directory)
        self._peer_directory = peer_directory
        self._graph: Graph | None = None

    def __repr__(self) -> str:
        return f"<IpcTransport links={len(self.manager.links)} beside {self.zenoh!r}>"

    @property
    def other_domains(self) -> frozenset[int]:
        """Domains of nodes that can be reached, but are not heard."""
        return frozenset(getattr(self.zenoh, "other_domains", ()))

    async def open(self, graph: Graph) -> None:
        """Connect; without a folder to meet in, or descriptors, over the other transport only."""
        listener = None
        try:
            listener = Listener(socket_folder(os.environ), self.manager.participant)
        except TransportError as error:
            logger.warning("%s; Zenoh is used between processes of this host as well", error)
        else:
            own = Advertisement.own(self.manager.participant)
            self._peer_directory.advertisement = own.text()
            self._peer_directory.on_advertisement = lambda text, present: self._on_advertisement(
                own, text, present
            )
        self.manager.open(graph, listener)
        if self._graph is not graph:
            self._graph = graph
            graph.on_endpoint(self.manager.on_endpoint)
        try:
            await self.zenoh.open(graph)
        except BaseException:
            self.manager.close()
            raise

    def _on_advertisement(self, own: Advertisement, text: str, present: bool) -> None:
        advertisement = Advertisement.parse(text)
        if advertisement is not None and own.is_near(advertisement):
            self.manager.on_advertisement(advertisement, present)

    async def all_known(self, quiet_s: float) -> bool:
        """Wait until everybody who can be reached has said what there is."""
        return await self.zenoh.all_known(quiet_s)

    async def link_status(self) -> LinkStatus:
        """Ask everybody who can be linked, and who is."""
        return await self.zenoh.link_status()

    async def close(self) -> None:
        """Withdraw everything and disconnect.

        Linked processes get what waits for them as long as they read; one that reads nothing for a
        second is given up, and a warning says what was lost. The rest takes a second at most.
        """
        try:
            await self.manager.flush()
        finally:
            self.manager.close()
            self._peer_directory.advertisement = None
            await self.zenoh.close()

    def abandon(self) -> None:
        """Leave the links to the process that this one was forked from."""
        self.manager.abandon()
        self.zenoh.abandon()

    def create_node(self, node: NodeInfo) -> Registration:
        """Announce a node."""
        return self.zenoh.create_node(node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher."""
        zenoh = self.zenoh.create_writer(endpoint, msg_type)
        return IpcWriter(self.manager, endpoint, msg_type, zenoh) if can_link(endpoint) else zenoh

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription."""
        if may_be_large(msg_type):
            # Shared memory is looked at through it: the first message would wait for the import.
            import numpy  # noqa: F401, ICN001
        zenoh_filter = ZenohFilter(reader)
        zenoh = self.zenoh.create_reader(endpoint, msg_type, zenoh_filter)
        return IpcReader(self.manager, msg_type, reader, zenoh_filter, zenoh)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server."""
        zenoh = self.zenoh.create_server(endpoint, srv_type, serve)
        return IpcServer(self.manager, endpoint, srv_type, serve, zenoh)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client."""
        zenoh = self.zenoh.create_requester(endpoint, srv_type)
        return IpcRequester(self.manager, endpoint, srv_type, zenoh)
