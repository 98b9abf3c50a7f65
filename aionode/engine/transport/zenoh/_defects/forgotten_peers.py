"""A peer that gossip has named is dialled once: a lost connection to it is not re-established.

Zenoh:
    Zenoh keeps redialling the endpoints of its configuration, but redials a peer that gossip has
    named only when gossip names it again. Routers and peers gossip only when they are connected.
    After a freeze, a process reconnects to its gossip source within 3 ms of losing that connection,
    perhaps before it has noticed that it has lost others. Those are named too early, and never
    again.
Reported:
    No.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    After the loss of a connection, a probe asks the gossip source (a router, or the peer at a
    configured endpoint) which tokens it sees, and they are compared with those of this session. If
    the source sees a participant that this session does not see or has lost, or if it does not see
    this session, the connection to the source is cut. Zenoh re-establishes it at once, and the
    source names all others again. If only sessions that this machine lists are connected, nothing
    is compared: each has the earlier ones in its configuration. Nor is it if all that were lost are
    sessions of processes that have ended.
"""

from __future__ import annotations

import logging
import os
import socket
import threading
from contextlib import closing, suppress
from typing import TYPE_CHECKING, Final

import zenoh
from msgspec import Struct

from aionode._process.concurrency import running_loop
from aionode.engine.transport.network import DiscoveryRange, pid_of
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh._defects._connection_mend import (
    ATTEMPTS,
    POSTPONED_S,
    ConnectionMend,
)
from aionode.engine.transport.zenoh._defects.incomplete_answers import ANSWER_S, tokens
from aionode.engine.transport.zenoh.connections.config import gossip_endpoints, open_probe
from aionode.engine.transport.zenoh.connections.sockets import (
    connections,
    cut,
    pair_of,
    split_locator,
)
from aionode.engine.wire._liveliness import PREFIX as ROS_PREFIX
from aionode.errors import ConfigurationError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from collections.abc import Set as AbstractSet

    from aionode.engine.transport.network import Network
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.connections.connections import ConnectionChange
    from aionode.engine.transport.zenoh.connections.sockets import Address
    from aionode.engine.transport.zenoh.discovery.graph_watcher import Watcher

__all__ = ["Recovery", "nodes_at_gossip_source"]

logger = logging.getLogger("aionode.transport.zenoh")

MAX_LOST: Final = 1_000
"""Number of lost sessions whose processes are looked at: others may open and close any number."""

FIRST_S: Final = 0.5
"""Delay of the first comparison after a connection was lost or made, in seconds; Zenoh needs
milliseconds."""

AGAIN_S: Final = 3.0
"""The interval of further comparisons, in seconds: there is no event when a frozen process
continues."""

WATCH_S: Final = 120.0
"""How long comparisons are repeated after the last loss of a connection, in seconds."""

SURE_S: Final = 0.3
"""How long a participant must be missing, in seconds; a starting one is missing for
milliseconds."""

NODES_S: Final = 3.0
"""Timeout for an answer, in seconds; with 300 nodes on a busy machine one takes a second."""

CHECKS: Final = 3
"""Number of comparisons of the graph after connections have come or gone."""


class GossipSource(Struct, frozen=True):
    """A connection to a gossip source.

    Attributes:
        zid: The id of its session.
        endpoint: Where it is dialled.
    """

    zid: str
    endpoint: str


class Recovery(ConnectionMend):
    """Finds processes that are alive, but no longer connected.

    Args:
        state: The session state of the context.
        network: The settings of the context, with the endpoints that it dials.
        watcher: The graph, which is compared a few times after connections were made or lost.
        listed: Returns the ports of the sessions that this machine lists; None if it has no list.
    """

    defect = "forgotten_peers"

    def __init__(
        self,
        state: SessionState,
        network: Network,
        watcher: Watcher,
        listed: Callable[[], AbstractSet[int] | None],
    ) -> None:
        super().__init__(state, network)
        self._listed = listed
        self._watcher = watcher
        self._checks = 0
        self._comparisons = state.queue(self._take_comparison)
        self._is_comparing = False
        self._until_s = 0.0
        # Lost sessions whose process was running when it was last looked at.
        self._lost: set[str] = set()
        self._has_met_router = False
        self._changing_since_s = 0.0  # when the first change was seen after the last comparison
        # Those that were missing in the last comparison; used by its thread only.
        self._suspected: set[str] = set()
        # Number of cuts per missing participant. The thread of a comparison reads this, and the
        # loop replaces it when that thread has ended.
        self._attempts: dict[str, int] = {}

    def stop(self) -> None:
        """Stop acting; a running comparison ends by itself."""
        super().stop()
        self._comparisons.clear()
        self._is_comparing = False
        self._until_s = 0.0
        self._lost.clear()
        self._attempts = {}  # not cleared: a thread may read the old one

    def _take_change(self, change: ConnectionChange, now_s: float) -> None:
        self._has_met_router |= change.kind == zenoh.WhatAmI.ROUTER
        if not change.is_made:
            self._until_s = now_s + WATCH_S
            if len(self._lost) < MAX_LOST:
                self._lost.add(change.zid)
        elif now_s >= self._until_s:
            return  # nothing was lost
        self._checks = CHECKS
        if not self._later.waits:
            self._changing_since_s = now_s
        if now_s - self._changing_since_s < POSTPONED_S:
            self._compare_in(FIRST_S)

    def _compare_in(self, delay_s: float) -> None:
        """Compare after a random delay, so that not all processes do so at once."""
        spread = 1 + int(self._state.participant[-4:], 16) / 0x10000
        self._later.call(delay_s * spread, self._compare)

    def _compare(self) -> None:
        session = self._session
        if session is None or self._state.announced.left_out:
            return  # ignored announcements would seem lost
        if self._is_comparing:
            self._compare_in(FIRST_S)
            return
        if not self._may_have_forgotten():
            self._until_s = 0.0
            return
        if not self._may_be_introduced():
            self._until_s = 0.0
            # A token that is out of date has to be missing twice, so its session stays.
            announced, connected = self._state.announced, self._state.connections.kinds
            self._lost = {zid for zid in self._lost if announced.has(zid) and zid not in connected}
            self._watcher.check()
            return
        known = self._watcher.node_tokens() | self._state.acknowledgements.tokens()
        self._is_comparing = start_thread(
            threading.Thread(
                target=self._compare_in_thread,
                # A router may forward what lost participants send, but not always what this
                # session sends.
                args=(session, self._state.connections.lost.copy(), known),
                name="aionode-zenoh",
            )
        )

    def _may_have_forgotten(self) -> bool:
        """Return whether a session was lost that may exist, or is in the graph nevertheless.

        Most are lost because their process has ended: each process would compare all tokens.
        """
        announced = self._state.announced
        self._lost = {zid for zid in self._lost if not has_ended(zid) or announced.has(zid)}
        return bool(self._lost)

    def _may_be_introduced(self) -> bool:
        """Return whether gossip may have named a session that is, or was, connected."""
        network, connections = self._network, self._state.connections
        if (
            self._has_met_router
            or network.discovery_range is not DiscoveryRange.LOCALHOST
            or network.config_file is not None
            or network.static_peers
        ):
            return True
        there = self._listed()
        return there is None or len(connections.kinds) >= len(there)  # with its own

    def _compare_in_thread(self, session: zenoh.Session, lost: set[str], known: set[str]) -> None:
        missing: set[str] | None = None
        with suppress(zenoh.ZError, ConfigurationError, TimeoutError):
            connection = gossip_source(session, self._network)
            if connection is not None:
                missing = self._reconnect(session, connection, lost, known)
        self._comparisons.put(missing)

    def _reconnect(
        self, session: zenoh.Session, connection: GossipSource, lost: set[str], known: set[str]
    ) -> set[str]:
        """Cut what has to be re-established, and return the participants concerned."""
        apart, is_sure = self._missing(session, connection, lost, known)
        # If many start at once, connecting takes seconds, and a cut prolongs it: a participant that
        # was never connected must be missing in two consecutive comparisons.
        missing = apart & (lost | self._suspected)
        if is_sure:
            missing |= apart & {self._state.participant}
        self._suspected = apart
        if missing:
            threading.Event().wait(SURE_S)
            missing &= self._missing(session, connection, lost, known)[0]
        missing = {zid for zid in missing if self._attempts.get(zid, 0) < ATTEMPTS}
        if missing:
            cut(connections(session, missing | {connection.zid}))
        return missing

    def _missing(
        self, session: zenoh.Session, connection: GossipSource, lost: set[str], known: set[str]
    ) -> tuple[set[str], bool]:
        """Return the participants that should be connected and are not, and whether that is sure.

        These are the ones that only the gossip source sees, lost ones that it sees and that are not
        connected here, and this one if the gossip source does not see it. The last is sure if the
        gossip source sees all others that are connected with both.

        Raises:
            TimeoutError: an answer is not complete.
        """
        keys = participants(self._state)
        connected = {str(transport.zid) for transport in session.info.transports()}
        common = {token for token in known if participant_of(token) in connected - lost}
        # An answer could lack only the tokens of this context, so they are expected as well.
        own = {token for token in known if participant_of(token) == self._state.participant}
        there = seen_at(self._network, connection, *keys, expected=common | own)
        here = tokens(session, *keys, expected=known)
        if not known <= here:
            raise TimeoutError(f"{len(known - here)} tokens that are known were not named")
        # A session sees all of its own tokens: one that only the source names was just undeclared,
        # or the answer here lacks it.
        unseen = {participant_of(token) for token in there - here} - {self._state.participant}
        unconnected = {participant_of(token) for token in there} & (lost - connected)
        missing = unseen | unconnected | {participant_of(token) for token in own - there}
        return missing, common <= there

    def _take_comparison(self, missing: set[str] | None) -> None:
        """Handle the result of a comparison: the missing participants; None if it has failed."""
        self._is_comparing = False
        if self._session is None:
            return
        if missing is not None:
            # A source whose connection was just re-established may not name all others yet. One
            # that it does not name is back only if it is connected; this context is back once the
            # source sees it.
            back = self._state.connections.kinds.keys() | {self._state.participant}
            self._attempts = {
                zid: count
                for zid, count in self._attempts.items()
                if count >= ATTEMPTS or zid not in back
            } | {zid: self._attempts.get(zid, 0) + 1 for zid in missing}
        if missing:
            logger.info(
                "lost touch with running processes %s; cutting connections, so that Zenoh "
                "reconnects",
                ", ".join(sorted(missing)[:5]),
            )
        if self._checks:
            self._checks -= 1
            self._watcher.check()
        now_s = running_loop().time()
        if not self._later.waits and now_s < self._until_s:
            self._compare_in(FIRST_S if missing else AGAIN_S)


def has_ended(zid: str) -> bool:
    """Return whether the process of a session has ended, as far as this process can tell."""
    pid = pid_of(zid)
    if pid is None:
        return False
    try:
        os.kill(pid, 0)  # sends nothing; unlike /proc, it also knows what the system hides
    except ProcessLookupError:
        return True
    except OSError:  # another user's
        return False
    return False


def seen_at(
    network: Network,
    connection: GossipSource,
    *keys: str,
    expected: AbstractSet[str] = frozenset(),
    timeout_s: float = ANSWER_S,
) -> set[str]:
    """Return the tokens that match `keys` and are visible at the other end of a connection.

    Args:
        network: The settings of the context.
        connection: The connection.
        *keys: The key expressions to query.
        expected: As for `tokens`.
        timeout_s: How long each answer may take.

    Raises:
        TimeoutError: an answer was not complete in time.
    """
    with closing(open_probe(network, connection.endpoint)) as probe:
        return tokens(probe, *keys, expected=expected, timeout_s=timeout_s)


def nodes_at_gossip_source(
    session: zenoh.Session, network: Network, known: AbstractSet[str]
) -> set[str] | None:
    """Return the tokens of all nodes that a gossip source sees, if there is one.

    None if it does not answer completely.

    Args:
        session: The session, which may be connected with a gossip source.
        network: The settings of the context.
        known: The tokens of known nodes; an answer without them is incomplete.
    """
    try:
        connection = gossip_source(session, network)
        if connection is None:
            return set()
        nodes = f"{ROS_PREFIX}/{network.domain_id}/*/*/*/NN/**"
        return seen_at(network, connection, nodes, expected=known, timeout_s=NODES_S)
    except (zenoh.ZError, ConfigurationError, TimeoutError):
        return None


def participants(state: SessionState) -> tuple[str, ...]:
    """Return the keys of the tokens of nodes and contexts in a domain."""
    return f"{ROS_PREFIX}/{state.domain_id}/*/*/*/NN/**", state.acknowledgements.token_of("*")


def participant_of(token: str) -> str:
    """Return the participant of a token of a node or context."""
    return token.split("/", 3)[2]


def gossip_source(session: zenoh.Session, network: Network) -> GossipSource | None:
    """Return a connection to a gossip source, a router if there is one."""
    routers = {str(zid) for zid in session.info.routers_zid()}
    sources = []
    dialled = {
        address: endpoint
        for endpoint in gossip_endpoints(network)
        for address in addresses_of(endpoint)
    }
    for link in session.info.links():
        pair = pair_of(link)
        if pair is not None and pair.remote in dialled:
            sources.append(GossipSource(str(link.zid), dialled[pair.remote]))
    return min(sources, key=lambda connection: connection.zid not in routers, default=None)


def addresses_of(endpoint: str) -> Iterator[Address]:
    """Yield the addresses of an endpoint, which may name its host."""
    where = split_locator(endpoint)
    if where is not None:
        host, port = where
        # Given text, Python would load its tables of internationalized names.
        name = host.encode() if host.isascii() else host
        with suppress(OSError):
            for family, *_, address in socket.getaddrinfo(name, port, type=socket.SOCK_STREAM):
                yield socket.inet_pton(family, str(address[0]).partition("%")[0]), int(address[1])
