"""The contract of transports, on Zenoh."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from aionode.clock import perf_ns
from aionode.transport.base import Transport
from aionode.transport.zenoh.link import Link
from aionode.transport.zenoh.neighbours import Neighbours
from aionode.transport.zenoh.recovery import Recovery
from aionode.transport.zenoh.services import ZenohRequester, ZenohServer
from aionode.transport.zenoh.session import Links, close_session, open_session
from aionode.transport.zenoh.sockets import cut_stuck
from aionode.transport.zenoh.subscriptions import ZenohReader
from aionode.transport.zenoh.tokens import NodeEntity, Watcher
from aionode.transport.zenoh.topics import ZenohWriter

if TYPE_CHECKING:
    from collections import Counter

    from aionode.graph import EndpointInfo, Graph, NodeInfo
    from aionode.transport.base import Announcement, Linkage, Reader, Requester, Serve, Writer
    from aionode.transport.zenoh_config import Network

__all__ = ["ZenohTransport"]

KNOWN_S = 0.3
"""How long `open` waits for the graph of those who are linked; it takes a millisecond."""


class ZenohTransport(Transport):
    """Reaches other processes and machines, and ROS 2 nodes that run rmw_zenoh_cpp.

    Args:
        participant: Id of the context and of its Zenoh session: hexadecimal, no leading zeros.
        network: Domain, discovery and peers.

    Attributes:
        neighbours: Who is there, for links beside this transport.
    """

    def __init__(self, participant: str, network: Network) -> None:
        self.network = network
        self._link = Link(participant, network.domain_id)
        self._watcher = Watcher(self._link)
        self.neighbours = Neighbours(self._link)
        # Done when those who are linked have said what there is.
        self._answered: asyncio.Future[None] | None = None
        self._missing = 0  # so many who accept connections were not linked in time
        self._recovery = Recovery(self._link, network, self._watcher.check)

    def __repr__(self) -> str:
        state = "closed" if self._link.session is None else "open"
        return (
            f"<ZenohTransport {self._link.participant} domain={self.network.domain_id} {state} "
            f"garbage={self.garbage.total()}>"
        )

    @property
    def garbage(self) -> Counter[str]:
        """How many samples in no known form came from the network, for each key."""
        return self._link.garbage

    @property
    def other_domains(self) -> frozenset[int]:
        """The domains of nodes that can be reached, but do not hear this one."""
        return self._watcher.other_domains

    async def links(self) -> Linkage:
        """Ask everybody who can be linked, and who is."""
        return await self.neighbours.links()

    async def open(self, graph: Graph) -> None:
        """Connect; return when those who are there are known, as far as can be told."""
        session, neighbours = await open_session(self.network, self._link.participant)
        self._link.wakeup.open(asyncio.get_running_loop())
        # Before waiting for others, so that who comes meanwhile sees everything. What fails from
        # here on is undone by `close`, which knows the session now.
        self._link.connect(session, graph)
        links = Links(session, self._link.lane)
        try:
            self._watcher.start(session)
            self.neighbours.start(session)
            self._recovery.start(session)
            await links.settle(neighbours)
            # Of those who were configured nobody knows whether they are there.
            hoped_for = bool(self.network.static_peers or self.network.config_file)
            self._missing = neighbours - hoped_for - len(session.info.transports())
            self._answered = asyncio.get_running_loop().create_future()
            self._watcher.ask(session, self._answered)
            with suppress(TimeoutError):
                async with asyncio.timeout(KNOWN_S):
                    await asyncio.shield(self._answered)
            self._watcher.note_domains()
        finally:
            links.close()

    async def all_known(self, quiet_s: float) -> bool:
        """Wait until everybody who can be reached has said what there is."""
        answered = self._answered
        while answered is not None and not answered.done():
            left_s = quiet_s - (perf_ns() - self._watcher.newest_ns) / 1e9
            if left_s <= 0:
                return False
            with suppress(TimeoutError):
                async with asyncio.timeout(left_s):
                    await asyncio.shield(answered)
        return self._missing <= 0

    async def close(self) -> None:
        """Withdraw everything and disconnect, within a second of what `Link.flush` takes."""
        link = self._link
        self._answered = None
        await link.flush()
        self._recovery.stop()
        self.neighbours.stop()
        self._watcher.stop()
        session = link.disconnect()
        if session is not None:
            await cut_stuck(session)
            await close_session(session)
        link.wakeup.close()

    def create_node(self, node: NodeInfo) -> Announcement:
        """Announce a node."""
        return NodeEntity(self._link, node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher."""
        return ZenohWriter(self._link, endpoint, msg_type)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Announcement:
        """Announce a subscription."""
        return ZenohReader(self._link, endpoint, msg_type, reader)

    def create_server(
        self, endpoint: EndpointInfo, srv_type: type[Any], serve: Serve
    ) -> Announcement:
        """Announce a server."""
        return ZenohServer(self._link, endpoint, srv_type, serve)

    def create_requester(self, endpoint: EndpointInfo, srv_type: type[Any]) -> Requester:
        """Announce a client."""
        return ZenohRequester(self._link, endpoint, srv_type)
