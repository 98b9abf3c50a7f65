"""Implements the transport contract on Zenoh."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from functools import partial
from itertools import filterfalse
from typing import TYPE_CHECKING, Any

import zenoh

from aionode._process.concurrency import running_loop
from aionode._process.stopped import is_stopped
from aionode.clock import perf_ns
from aionode.engine.transport.base import Transport
from aionode.engine.transport.drops import Drop, Drops
from aionode.engine.transport.network import pid_of
from aionode.engine.transport.zenoh._defects.closing import cut_stuck
from aionode.engine.transport.zenoh._defects.forgotten_peers import Recovery, nodes_at_gossip_source
from aionode.engine.transport.zenoh._defects.lingering import SocketOptions
from aionode.engine.transport.zenoh._defects.scarcity import refuse_scarcity
from aionode.engine.transport.zenoh._defects.stale_transports import StaleTransports
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh.connections.sockets import arrived_bytes, pair_of
from aionode.engine.transport.zenoh.connections.stopped_peers import StoppedPeers
from aionode.engine.transport.zenoh.discovery.graph_watcher import (
    NodeDeclaration,
    Watcher,
    participant_of,
)
from aionode.engine.transport.zenoh.discovery.observed import Observed
from aionode.engine.transport.zenoh.discovery.other_domains import other_domains
from aionode.engine.transport.zenoh.discovery.peer_directory import ZenohPeerDirectory
from aionode.engine.transport.zenoh.discovery.router_matching import RouterMatching
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.endpoints.services import ZenohRequester, ZenohServer
from aionode.engine.transport.zenoh.endpoints.subscription import ZenohReader
from aionode.engine.transport.zenoh.session.connect_slots import connecting
from aionode.engine.transport.zenoh.session.local_router import LocalRouter
from aionode.engine.transport.zenoh.session.local_sessions import listed, listening, processes
from aionode.engine.transport.zenoh.session.session import (
    close_session,
    open_session,
    run_in_own_thread,
)

if TYPE_CHECKING:
    import socket
    from collections import Counter
    from collections.abc import Callable, Collection, Mapping
    from collections.abc import Set as AbstractSet

    from aionode.clock import TimeBase
    from aionode.engine.transport.base import (
        LinkStatus,
        Reader,
        Registration,
        Requester,
        Serve,
        Writer,
    )
    from aionode.engine.transport.network import Network
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["ZenohTransport"]

KNOWN_S = 0.3
"""How long `open` waits for the graph of connected peers, in seconds; it takes a millisecond."""

ASK_AGAIN_S = 0.2
"""The interval at which expected nodes and arriving bytes are checked, in seconds."""

TOKEN_BYTES = 100
"""Approximate minimum size of an endpoint's announcement; keep-alives are a few bytes."""

MAX_PORTS = 3
"""Number of ports to name at which unknown processes do not answer."""

NAMED_NS = 10_000_000_000
"""How long to wait for a peer named by others while more tokens arrive, in nanoseconds."""


class ZenohTransport(Transport):
    """Reaches other processes and machines, including ROS 2 nodes that use rmw_zenoh_cpp.

    Args:
        participant: Id of the context and of its Zenoh session: hexadecimal, no leading zeros.
        network: Domain, discovery and peers.
        time_base: The time of the context; defaults to that of the machine.

    Attributes:
        peer_directory: The other contexts, for links next to this transport.
        session_state: Its connection, for the bridge transport next to this one.
    """

    def __init__(
        self, participant: str, network: Network, time_base: TimeBase | None = None
    ) -> None:
        self.network = network
        self.session_state = SessionState(
            participant,
            network.domain_id,
            time_base,
            queue_bytes=network.queue_bytes,
            graph_bytes=network.graph_bytes,
        )
        self._state = self.session_state
        self._watcher = Watcher(self._state)
        self._router_matching = RouterMatching(self._state, network)
        self.peer_directory = ZenohPeerDirectory(self._state, self._router_matching)
        self._observed = Observed(self._state, self.peer_directory)
        # Done when the tokens of all connected peers are in the graph.
        self._answered: asyncio.Future[bool] | None = None
        self._expected = 0  # how many peers accept connections, and so should be connected
        self._dialled: set[int] = set()  # the ports of this machine's other sessions
        self._recovery = Recovery(
            self._state, network, self._watcher, partial(listed, network.meeting_ports[0])
        )
        self._stale_transports = StaleTransports(self._state, network)
        self._stopped_peers = StoppedPeers(self._state)
        self._local_router = LocalRouter(self._state, network)
        self._socket_options: SocketOptions | None = None
        self._presence: socket.socket | None = None  # in the list of this machine's sessions

    def __repr__(self) -> str:
        state = "closed" if self._state.session is None else "open"
        return (
            f"<ZenohTransport {self._state.participant} domain={self.network.domain_id} {state} "
            f"garbage={self.malformed.total()}>"
        )

    @property
    def malformed(self) -> Counter[str]:
        """The number of malformed samples from the network, by key."""
        return self.drops.of(Drop.MALFORMED)

    @property
    def drops(self) -> Drops:
        """Counts what is dropped of what others send."""
        return self._state.drops

    async def other_domains(self) -> frozenset[int]:
        """Look for other domains on this machine, and wherever nodes of them can be reached.

        Returns:
            A hundred domain ids at most; none if the transport is closed.
        """
        session = self._state.session
        if session is None:
            return frozenset()
        with suppress(zenoh.ZError):  # closed meanwhile
            return await run_in_own_thread(partial(other_domains, session, self.network))
        return frozenset()

    async def observe(
        self,
        what: str,
        question: bytes,
        timeout_s: float,
        participants: Collection[str] | None = None,
    ) -> dict[str, bytes | None]:
        """Ask other contexts of the domain about themselves."""
        return await self._observed.ask(what, question, timeout_s, participants)

    def tell(self, answers: Mapping[str, Callable[[bytes], bytes]]) -> None:
        """Answer other contexts that ask."""
        self._observed.answers = answers

    async def link_status(self) -> LinkStatus:
        """Ask all contexts which links they offer and have."""
        return await self.peer_directory.link_status()

    async def open(self, graph: Graph) -> None:
        """Connect; return when the running peers are known, as far as can be determined."""
        refuse_scarcity()
        async with connecting(self.network):
            await self._open(graph)

    async def _open(self, graph: Graph) -> None:
        try:
            await self._local_router.open()
            opened = await open_session(self.network, self._state.participant)
        except BaseException:
            await asyncio.shield(self._local_router.close())
            raise
        session, expected = opened.session, opened.expected
        self._presence, self._dialled = opened.presence, opened.dialled
        self._state.waker.open(running_loop())
        # Before waiting for others, so that peers connecting meanwhile see everything. After a
        # failure from here on, `close` closes the session.
        self.peer_directory.announce(session)
        self._state.connect(session, graph)
        self._state.connections.start(session)
        self._socket_options = SocketOptions(session)
        self._watcher.start(session)
        self.peer_directory.start(session)
        self._observed.start(session)
        self._recovery.start(session)
        self._stale_transports.start(session)
        self._stopped_peers.start(session)
        await self._state.connections.wait_until_connected(
            expected, opened.others, self._unconnected
        )
        # Configured peers may be absent, so they are not expected.
        self._expected = expected - bool(self.network.near_peers or self.network.config_file)
        answered = self._ask(session)
        with suppress(TimeoutError):
            async with asyncio.timeout(KNOWN_S):
                await asyncio.shield(answered)
        self._state.graph_is_known()

    async def all_known(self, quiet_s: float) -> bool:
        """Wait until the tokens of all reachable peers are in the graph.

        It does not wait for processes of this machine that cannot answer: they are stopped, or have
        listed a session that does not listen.
        """
        session, graph = self._state.session, self._state.graph
        if session is None or graph is None:
            return False
        absent: AbstractSet[int] = frozenset()
        if not self._is_connected():  # on a busy machine that takes longer than `open` waits
            absent, stopped = await run_in_own_thread(self._unreachable_ports)
            is_enough = partial(self._is_connected, absent | stopped)
            await self._state.connections.wait_longer(is_enough, quiet_s)
            self._ask(session)
        if not await self._has_answers(session, quiet_s):
            return False
        # Peers named by a router or another peer may not be connected yet: only what the latter
        # sees reveals them.
        missing = await self._missing_nodes(session, quiet_s)
        if not missing:
            return missing is not None and self._is_connected(absent)
        quiet_ns = int(quiet_s * 1e9)
        ends_ns = perf_ns() + NAMED_NS
        while not all(map(is_of_stopped_process, missing)):
            with suppress(TimeoutError):
                async with asyncio.timeout(ASK_AGAIN_S):
                    await graph.until(partial(known_all, self._watcher, missing))
            left = await self._missing_nodes(session, quiet_s)
            if left is None:
                return False
            left &= missing  # not what has arrived meanwhile
            now_ns = perf_ns()
            if left == missing and now_ns > min(self._watcher.newest_ns + quiet_ns, ends_ns):
                return False
            missing = left
        self._ask(session)  # the tokens of these peers are complete after that
        has_answers = await self._has_answers(session, quiet_s)
        return has_answers and not missing and self._is_connected(absent)

    def _is_connected(self, besides: AbstractSet[int] = frozenset()) -> bool:
        """Return whether all peers that accept connections have been connected.

        Args:
            besides: The ports of sessions that need not be.
        """
        silent = self._silent_ports()
        count = len(self._state.connections.kinds) + len(silent & besides)
        return count >= self._expected and silent <= besides

    def _unreachable_ports(self) -> tuple[set[int], set[int]]:
        """Return the ports at which no session listens, and those of stopped processes."""
        found, listeners = processes(self.network.meeting_ports[0]), listening()
        absent = set() if listeners is None else self._dialled - listeners
        return absent, {port for port, process in found.items() if process.is_stopped}

    def _silent_ports(self) -> set[int]:
        """Return the ports of those sessions of this machine that were dialled in vain.

        None, if there are as many connections as sessions: some may have dialled this one.
        """
        unconnected = self._unconnected()
        connected = len(self._state.connections.kinds)
        return set() if connected >= len(self._listed_others()) else unconnected

    def _unconnected(self) -> set[int]:
        """Return the ports of the other sessions to which no connection was made."""
        session = self._state.session
        if session is None:
            return set()
        pairs = map(pair_of, session.info.links())
        unconnected = self._dialled - {pair.remote[1] for pair in pairs if pair is not None}
        return unconnected & self._listed_others() if unconnected else set()

    def _listed_others(self) -> set[int]:
        """Return the ports of this machine's other sessions that have not ended."""
        return self._dialled & (listed(self.network.meeting_ports[0]) or set())

    def silent_processes(self) -> list[str]:
        """Describe the processes on this machine that do not answer, as far as the system knows."""
        found, listeners = processes(self.network.meeting_ports[0]), listening()
        unconnected, ports = self._silent_ports(), self._listed_others()
        if listeners is not None:
            ports &= listeners
        silent: dict[str, None] = {}  # once for each process, which may have many sessions
        unnamed = []
        for port in sorted(ports):
            process = found.get(port)
            if process is None:
                if port in unconnected:
                    unnamed.append(str(port))
            elif process.is_stopped or port in unconnected:
                why = "does not answer"
                if process.is_stopped:
                    why = f"is stopped (kill -CONT {process.pid})"
                silent[f"process {process.pid} ({process.command}) {why}"] = None
        if unnamed:
            more = f" and {len(unnamed) - MAX_PORTS} others" if len(unnamed) > MAX_PORTS else ""
            where = f"{', '.join(unnamed[:MAX_PORTS])}{more}"
            silent[f"what listens at port {where} does not answer"] = None
        return list(silent)

    async def _missing_nodes(self, session: zenoh.Session, quiet_s: float) -> set[str] | None:
        """Return the nodes that a gossip source sees but the graph lacks; None if unanswered."""
        ends_ns = perf_ns() + int(quiet_s * 1e9)
        while True:
            known = self._watcher.node_tokens()
            ask = partial(nodes_at_gossip_source, session, self.network, known)
            seen = await run_in_own_thread(ask)
            if seen is not None:
                return set(filterfalse(self._watcher.knows, seen))
            if perf_ns() > ends_ns:
                return None

    async def _has_answers(self, session: zenoh.Session, quiet_s: float) -> bool:
        """Return whether all connected peers have sent their tokens; wait while some arrive.

        On a busy machine, Zenoh reads thousands of them for seconds, and then delivers all at once.
        So it also waits while there is something to read.
        """
        answered = self._answered
        before: dict[str, tuple[int, int]] = {}
        while answered is not None:
            with suppress(TimeoutError):
                async with asyncio.timeout(min(quiet_s, ASK_AGAIN_S)):
                    return await asyncio.shield(answered)
            arrived = await run_in_own_thread(partial(arrived_bytes, session))
            for peer, (received, unread) in arrived.items():
                if received - before.get(peer, (0, 0))[0] + unread > TOKEN_BYTES:
                    self._watcher.newest_ns = perf_ns()
            before = arrived
            if perf_ns() - self._watcher.newest_ns > quiet_s * 1e9:
                return False
        return True

    def _ask(self, session: zenoh.Session) -> asyncio.Future[bool]:
        """Ask all connected peers for their tokens; the future completes when all have answered."""
        self._answered = answered = running_loop().create_future()
        self._watcher.ask(session, answered)
        return answered

    async def close(self) -> None:
        """Undeclare everything and disconnect, within a second after `SessionState.flush`."""
        state = self._state
        self._answered = None
        self.abandon()  # nobody dials this session any more
        await state.flush()
        if self._socket_options is not None:
            self._socket_options.close()
            self._socket_options = None
        self._state.connections.stop()
        self._recovery.stop()
        self._stale_transports.stop()
        self._stopped_peers.stop()
        self._observed.stop()
        self.peer_directory.stop()
        self._watcher.stop()
        session = state.disconnect()
        if session is not None:
            await run_in_own_thread(partial(cut_stuck, session))
            await close_session(session)
        await self._router_matching.close()
        await self._local_router.close()
        state.waker.close()

    def abandon(self) -> None:
        """Leave the list of this machine's sessions."""
        if self._presence is not None:
            self._presence.close()
            self._presence = None

    def create_node(self, node: NodeInfo) -> Registration:
        """Declare a node."""
        return NodeDeclaration(self._state, node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Declare a publisher."""
        return ZenohWriter(self._state, endpoint, msg_type)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Declare a subscription."""
        return ZenohReader(self._state, endpoint, msg_type, reader)

    def create_server(
        self, endpoint: EndpointInfo, srv_type: type[Any], serve: Serve
    ) -> Registration:
        """Declare a server."""
        return ZenohServer(self._state, endpoint, srv_type, serve)

    def create_requester(self, endpoint: EndpointInfo, srv_type: type[Any]) -> Requester:
        """Declare a client."""
        return ZenohRequester(self._state, endpoint, srv_type)


def is_of_stopped_process(key: str) -> bool:
    """Return whether the process that has declared a token is known to be stopped."""
    pid = pid_of(participant_of(key))
    return pid is not None and is_stopped(pid)


def known_all(watcher: Watcher, keys: set[str]) -> bool:
    """Return whether all of the given tokens are in the graph."""
    return all(map(watcher.knows, keys))
