"""The transport that uses links where possible, and Zenoh for everything else."""

from __future__ import annotations

import logging
import os
import select
from typing import TYPE_CHECKING, Any

from aionode.clock import perf_ns
from aionode.engine.transport.base import Transport
from aionode.engine.transport.link._endpoint_table import can_link
from aionode.engine.transport.link._listener import Advertisement, Listener, socket_folder
from aionode.engine.transport.link._manager import LinkManager
from aionode.engine.transport.link._publisher import LinkWriter
from aionode.engine.transport.link._service import LinkRequester, LinkServer
from aionode.engine.transport.link._subscription import LinkReader
from aionode.engine.wire import cdr
from aionode.errors import TransportError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from aionode.clock import TimeBase
    from aionode.engine.transport.base import (
        LinkStatus,
        Reader,
        Registration,
        Requester,
        Serve,
        Writer,
    )
    from aionode.engine.transport.drops import Drops
    from aionode.engine.transport.link._registry import PeerDirectory
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["LinkTransport"]

logger = logging.getLogger("aionode.transport.link")

LOOK_S = 0.001
"""Interval at which `send_rest` retries a full socket, in seconds."""


class LinkTransport(Transport):
    """Uses links to processes of this user on this host, and another transport for all others.

    Args:
        participant: Id of the context: hexadecimal, no leading zeros.
        domain_id: The ROS domain.
        zenoh: The other transport.
        peer_directory: What the other transport knows about other contexts.
        time_base: The time of the context; defaults to that of the machine.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        zenoh: Transport,
        peer_directory: PeerDirectory,
        time_base: TimeBase | None = None,
    ) -> None:
        self.zenoh = zenoh
        self.manager = LinkManager(participant, domain_id, peer_directory)
        self.manager.drops = zenoh.drops
        if time_base is not None:
            self.manager.now_ns = time_base.system_ns
        self._peer_directory = peer_directory
        self._graph: Graph | None = None

    def __repr__(self) -> str:
        return f"<LinkTransport links={len(self.manager.links)} beside {self.zenoh!r}>"

    async def other_domains(self) -> frozenset[int]:
        """Look for domains other than this one."""
        return await self.zenoh.other_domains()

    async def open(self, graph: Graph) -> None:
        """Connect; without a folder for sockets, or descriptors, only over the other transport."""
        listener = None
        try:
            listener = Listener(socket_folder(os.environ), self.manager.participant)
        except TransportError as error:
            logger.warning("%s; using Zenoh between processes on this host as well", error)
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
        """Wait until every reachable context has announced its endpoints."""
        return await self.zenoh.all_known(quiet_s)

    @property
    def drops(self) -> Drops:
        """Counts what is dropped of what others send, over links or not."""
        return self.manager.drops

    def silent_processes(self) -> list[str]:
        """Return the processes that do not answer."""
        return self.zenoh.silent_processes()

    async def observe(
        self,
        what: str,
        question: bytes,
        timeout_s: float,
        participants: Collection[str] | None = None,
    ) -> dict[str, bytes | None]:
        """Ask other contexts of the domain about themselves."""
        return await self.zenoh.observe(what, question, timeout_s, participants)

    def tell(self, answers: Mapping[str, Callable[[bytes], bytes]]) -> None:
        """Answer other contexts that ask."""
        self.zenoh.tell(answers)

    async def link_status(self) -> LinkStatus:
        """Ask all contexts which of them can be linked, and which are."""
        return await self.zenoh.link_status()

    async def close(self) -> None:
        """Withdraw everything and disconnect.

        Linked processes receive pending data as long as they read; one that reads nothing for a
        second is given up, with a warning about what was lost. The rest takes a second at most.
        Cancelling it closes everything immediately, and pending data is lost.
        """
        try:
            await self.manager.flush()
        finally:
            self.manager.close()
            self._peer_directory.advertisement = None
            await self.zenoh.close()

    def send_rest(self, ends_ns: int) -> None:
        """Send pending data on the links, as far as the other processes read it."""
        slow = list(self.manager._links.values())
        while slow := [connection for connection in slow if not connection.send_rest()]:
            if perf_ns() >= ends_ns:
                return
            select.select([], [], [], LOOK_S)

    def abandon(self) -> None:
        """Leave the links to the process from which this one was forked."""
        self.manager.abandon()
        self.zenoh.abandon()

    def create_node(self, node: NodeInfo) -> Registration:
        """Announce a node."""
        return self.zenoh.create_node(node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher."""
        zenoh = self.zenoh.create_writer(endpoint, msg_type)
        if not can_link(endpoint):
            return zenoh
        writer = LinkWriter(self.manager, endpoint, msg_type, zenoh)
        self.manager.writers.add(endpoint.gid, writer)
        return writer

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription."""
        if cdr.has_buffers(msg_type):
            # Shared memory is read through it: the first message would wait for the import.
            import numpy  # noqa: F401, ICN001
        link_reader = LinkReader(self.manager, msg_type, reader)
        link_reader.attach(self.zenoh.create_reader(endpoint, msg_type, link_reader))
        self.manager.readers.add(link_reader.gid, link_reader)
        return link_reader

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server."""
        zenoh = self.zenoh.create_server(endpoint, srv_type, serve)
        server = LinkServer(self.manager, endpoint, srv_type, serve, zenoh)
        self.manager.servers[endpoint.gid] = server
        return server

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client."""
        zenoh = self.zenoh.create_requester(endpoint, srv_type)
        requester = LinkRequester(self.manager, endpoint, srv_type, zenoh)
        self.manager.requesters[endpoint.gid] = requester
        return requester
