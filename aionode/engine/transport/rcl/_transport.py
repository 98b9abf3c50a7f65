"""Implements the transport contract on rcl."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

from aionode._process.concurrency import running_loop
from aionode.clock import perf_ns
from aionode.engine.transport.base import Registration, Transport
from aionode.engine.transport.drops import Drop, Drops
from aionode.engine.transport.rcl._graph_watcher import RclGraphWatcher
from aionode.engine.transport.rcl._participants import lacks_participants
from aionode.engine.transport.rcl._services import RclRequester, RclServer
from aionode.engine.transport.rcl._state import RclState
from aionode.engine.transport.rcl._topics import RclReader, RclWriter

if TYPE_CHECKING:
    from collections import Counter

    from aionode.engine.transport.base import Reader, Requester, Serve, Writer
    from aionode.engine.transport.network import Network
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["RclTransport"]

KNOWN_S: Final = 0.25
"""How long `open` waits for the graph, in seconds: nothing signals that discovery is complete."""

QUIET_S: Final = 0.06
"""Quiet time after which `open` returns early, if another node was found, in seconds."""

ALONE_QUIETS: Final = 1.6
"""How long `all_known` waits for a first node, as a multiple of its quiet time.

With the 2 s of tools, that exceeds the 3 s after which Fast DDS announces a process again if its
first announcements were lost on a busy machine.
"""

LACKING_QUIETS: Final = 3.5
"""How long `all_known` waits for other processes on this host, as a multiple of its quiet time.

With the 2 s of tools, that is more than twice the 3 s after which Fast DDS announces them again.
"""

MAX_QUIETS: Final = 5
"""Maximum time that `all_known` waits, as a multiple of its quiet time."""

CLOSE_S: Final = 0.8
"""How long `close` waits for messages that a thread is sending, in seconds."""


class RclTransport(Transport):
    """Reaches the nodes of the installed ROS 2, over its middleware.

    Args:
        participant: Id of the context, in hexadecimal.
        network: The domain. Discovery range and peers are up to the middleware, which reads the
            same environment variables.
    """

    def __init__(self, participant: str, network: Network) -> None:
        self._network = network
        self._state = RclState(participant, network.domain_id)
        self._watcher = RclGraphWatcher(self._state)

    def __repr__(self) -> str:
        rcl = self._state.rcl
        middleware = "" if rcl is None else f" {rcl.middleware}"
        state = "closed" if self._state.loop is None else "open"
        return f"<RclTransport{middleware} domain={self._network.domain_id} {state}>"

    @property
    def malformed(self) -> Counter[str]:
        """The number of malformed messages, by topic and service."""
        return self.drops.of(Drop.MALFORMED)

    @property
    def drops(self) -> Drops:
        """Counts what is dropped of what others send."""
        return self._state.drops

    @property
    def middleware(self) -> str:
        """The middleware, such as ``rmw_fastrtps_cpp``; empty until the context is open."""
        return "" if self._state.rcl is None else self._state.rcl.middleware

    async def open(self, graph: Graph) -> None:
        """Join the domain; return when the running nodes are known, as far as can be determined."""
        self._state.open(running_loop(), graph)
        if self._state.rcl is not None:
            self._watcher.start(self._state.rcl)
        await self._until_quiet(QUIET_S, KNOWN_S, 0, KNOWN_S)

    async def all_known(self, quiet_s: float) -> bool:
        """Wait until the graph has not changed for half of `quiet_s`, and no part is missing.

        Without another node, it waits longer than `quiet_s`. For undiscovered processes on this
        host, it waits `LACKING_QUIETS` times as long after `open`, and while changes continue, up
        to `MAX_QUIETS` times as long.
        """
        await self._until_quiet(
            quiet_s / 2, quiet_s * ALONE_QUIETS, quiet_s * LACKING_QUIETS, quiet_s * MAX_QUIETS
        )
        return self._watcher.is_complete and not lacks_participants(self._state)

    async def _until_quiet(
        self, quiet_s: float, alone_s: float, lacking_s: float, limit_s: float
    ) -> None:
        """Wait until nothing has changed for a while; for longer if something is missing."""
        ended = running_loop().create_future()
        with suppress(TimeoutError):
            async with asyncio.timeout(limit_s):
                while not self._is_quiet(quiet_s, alone_s, lacking_s):
                    with suppress(TimeoutError):
                        async with asyncio.timeout(quiet_s / 2):
                            await asyncio.shield(ended)

    def _is_quiet(self, quiet_s: float, alone_s: float, lacking_s: float) -> bool:
        watcher, now_ns = self._watcher, perf_ns()
        enough_s = quiet_s if watcher.has_foreign else alone_s
        if not watcher.is_settled or now_ns - watcher.changed_ns < enough_s * 1e9:
            return False
        return now_ns - watcher.started_ns >= lacking_s * 1e9 or not lacks_participants(self._state)

    async def close(self) -> None:
        """Withdraw everything and leave the domain; threads get 0.8 s to finish sending."""
        self._watcher.stop()
        with suppress(TimeoutError):
            async with asyncio.timeout(CLOSE_S):
                await self._state.flush()
        self._state.close()

    def create_node(self, node: NodeInfo) -> Registration:
        """Create a node."""
        return RclNode(self._state, node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Create a publisher."""
        return RclWriter(self._state, endpoint, msg_type)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Create a subscription."""
        return RclReader(self._state, endpoint, msg_type, reader)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Create a server."""
        return RclServer(self._state, endpoint, srv_type, serve)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Create a client."""
        return RclRequester(self._state, endpoint, srv_type)


class RclNode(Registration):
    """A node, which is created once the context is open."""

    def __init__(self, state: RclState, info: NodeInfo) -> None:
        self._state = state
        self._info = info
        state.add_node(info)

    def close(self) -> None:
        """Destroy the node."""
        self._state.remove_node(self._info)
