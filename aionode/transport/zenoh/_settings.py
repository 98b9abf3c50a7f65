"""Zenoh's configuration of the sessions and routers of aionode, made of a `Network`.

Pure functions; nothing is connected here, and zenoh is not imported.

Without configuration the processes of one machine find each other over loopback: each tries to
listen on one of three meeting ports, and dials those that are listed (`_local_sessions`), other
listeners on these ports, and the port of a ROS 2 router. Where the machine lists nothing, each
dials the meeting ports, and gossip introduces all of them to each other; if other programs hold all
three, there are three spare ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from aionode.transport._network import ROUTER_PORT, DiscoveryRange

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.transport._network import Network

__all__ = [
    "LOOPBACK",
    "Neighbours",
    "introducers",
    "listening_address",
    "look_settings",
    "near",
    "probed_ports",
    "router_settings",
    "session_settings",
]

LOOPBACK: Final = "127.0.0.1"
EVERYWHERE: Final = "0.0.0.0"  # noqa: S104  # only on request: ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET

FLUSH_S: Final = 2.0
"""How long the end of a context waits for reliable messages, while their readers make progress."""

BLOCK_US: Final = 7_000_000
"""How long a blocking send waits for a peer, in microseconds, before the connection is ended.

It has to be less than the lease of 10 s: when that ends while a send waits, the thread of Zenoh
that ends the connection waits too, and with it everything that it does for other connections.
"""

BATCHES: Final = 16
"""How many batches of 64 kB wait for a peer that is busy, of each priority in `BURSTING`."""

BURSTING: Final = ("control", "interactive_low", "data_high", "data_low")
"""The priorities of what the loop sends, tokens, requests and replies, messages, and that of
messages which late readers get, too."""


OPEN_MS: Final = 30_000
"""How long making a connection may take, in milliseconds.

Where many processes start at once it takes seconds, and Zenoh must not give up meanwhile: the end
that gives up while it takes the connection into use keeps one for good which it sends on, but never
reads (zenoh 1.10). It sees no token of that peer, and the peer refuses further connections.
"""

FAR_OPEN_MS: Final = 3_000
"""The same where other machines may be dialled: `close` waits for one that is switched off."""

INTRODUCERS: Final = 4
"""How many of the sessions that a machine lists tell all others by gossip of sessions that are not
listed, such as those of other programs. One is too few: Zenoh drops what it hears on a connection
that it is just taking into use. With all of them a hundred would send half a million messages.
"""

LEASE_MS: Final = 10_000
"""After so long without a sign of a process its peers take it for dead."""

LEASE_MS_EACH: Final = 500
"""So much longer for each process that was there when it started.

Where a hundred start at once, each is silent for more than ten seconds while it is connected with
the others. Those that give it up connect anew, and all of it takes longer still.
"""

MOST_LEASE_MS: Final = 60_000
"""The longest lease, which is that of ROS 2 nodes: any user of the machine can be listed as many
processes."""

RETRY: Final = {"period_init_ms": 100, "period_max_ms": 2000, "period_increase_factor": 2}
"""How often what does not answer is dialled again."""


@dataclass(frozen=True, slots=True)
class Neighbours:
    """The other sessions of a machine that lists them, as one sees them that is about to open.

    Attributes:
        port: Where it will listen itself.
        others: Where it dials others.
    """

    port: int
    others: tuple[int, ...]


def probed_ports(network: Network) -> tuple[int, ...]:
    """Return the ports of this machine whose listeners a session will dial."""
    if network.config_file is not None or network.discovery_range is DiscoveryRange.OFF:
        return ()
    if network.discovery_range is DiscoveryRange.SYSTEM_DEFAULT:
        return (network.router_port,)
    return (*network.meeting_ports, network.router_port)


def introducers(network: Network) -> tuple[str, ...]:
    """Return the endpoints that a session dials again and again, as far as aionode knows."""
    if network.config_file is not None or network.discovery_range is DiscoveryRange.OFF:
        return ()
    ports = (*probed_ports(network), *network.spare_ports)
    return (*(f"tcp/{LOOPBACK}:{p}" for p in ports), *network.near_peers)


def look_settings(endpoint: str) -> dict[str, Any]:
    """Return the settings of a session that looks what is to be seen at one endpoint."""
    return {
        "mode": "client",
        "connect/endpoints": [endpoint],
        "connect/timeout_ms": 700,
        "connect/exit_on_failure": True,
        "listen/endpoints": [],
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "transport/unicast/open_timeout": 700,
        "transport/shared_memory/enabled": False,
    }


def session_settings(
    network: Network, taken: Iterable[int], neighbours: Neighbours | None = None
) -> dict[str, Any]:
    """Return the settings of a session, by key path, without those of `network.overrides`.

    Args:
        network: The settings of the context.
        taken: Those of its meeting ports on which it cannot listen.
        neighbours: What this machine lists; None if it lists nothing.
    """
    if network.config_file is not None:
        return {}
    taken = set(taken)
    mine = next((p for p in network.meeting_ports if p not in taken), None)
    off = network.discovery_range is DiscoveryRange.OFF
    subnet = network.discovery_range is DiscoveryRange.SUBNET
    gossip: dict[str, Any] = {"scouting/gossip/enabled": not off}
    listed = neighbours.others if neighbours is not None else ()
    if neighbours is not None:
        listen = [neighbours.port]
        dial = [*neighbours.others, network.router_port]
        introduces = (
            len(neighbours.others) < INTRODUCERS or neighbours.port in network.meeting_ports
        )
        if not (introduces or subnet or network.near_peers):
            gossip["scouting/gossip/target"] = {"router": ["router"], "peer": ["router"]}
    else:
        listen = [mine, 0] if near(network) and mine is not None else [0]
        dial = [p for p in probed_ports(network) if p != mine]
    return {
        "mode": "peer",
        "listen/endpoints": []
        if off
        else [f"tcp/{listening_address(network)}:{p}" for p in listen],
        # A lost race for the port is no error. Retrying would make close() wait for the port.
        "listen/timeout_ms": 0,
        "listen/exit_on_failure": False,
        "connect/endpoints": [
            *(f"tcp/{LOOPBACK}:{p}" for p in dial),
            *network.near_peers,
        ],
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": RETRY,
        "open/return_conditions/connect_scouted": False,
        "transport/link/tx/queue/congestion_control/block/wait_before_close": BLOCK_US,
        # Batches of 64 kB, made when they are needed: what the loop sends never waits for one.
        **{f"transport/link/tx/queue/size/{name}": BATCHES for name in BURSTING},
        # Large messages are sent from a thread, which may wait longer for a slow network.
        "transport/link/tx/queue/congestion_control/drop/max_wait_before_drop_fragments": 500_000,
        # Zenoh never gives back the shared memory of a peer that has ended: two descriptors and
        # mappings for each restart of a publisher (1.10). Links have shared memory of their own;
        # processes of other users cannot open Zenoh's, and ROS 2 nodes have it switched off.
        "transport/shared_memory/enabled": False,
        "transport/unicast/open_timeout": FAR_OPEN_MS if network.may_reach_far else OPEN_MS,
        "transport/unicast/accept_timeout": OPEN_MS,
        "scouting/multicast/enabled": subnet,
        "transport/link/tx/lease": min(LEASE_MS + LEASE_MS_EACH * len(listed), MOST_LEASE_MS),
        **gossip,
        # As rmw_zenoh: if both dialled, Zenoh might keep neither of the two connections.
        "scouting/gossip/autoconnect_strategy": {
            "peer": {"to_router": "always", "to_peer": "greater-zid"}
        },
        # The history of transient_local topics is put in order by time stamps.
        "timestamping/enabled": True,
        # Histories are fetched with this timeout; every other query says its own.
        "queries_default_timeout": 600_000,
    }


def near(network: Network) -> bool:
    """Return whether a session looks for others of its machine by itself."""
    return network.config_file is None and network.discovery_range in (
        DiscoveryRange.LOCALHOST,
        DiscoveryRange.SUBNET,
    )


def listening_address(network: Network) -> str:
    """Return where a session listens: beyond loopback on request only."""
    return EVERYWHERE if network.discovery_range is DiscoveryRange.SUBNET else LOOPBACK


def router_settings(
    listen: Iterable[str] = (f"tcp/[::]:{ROUTER_PORT}",), connect: Iterable[str] = ()
) -> dict[str, Any]:
    """Return the settings of a router, as those of `rmw_zenohd`: it introduces all peers.

    Args:
        listen: The endpoints on which it listens; it does not open if it cannot.
        connect: The endpoints of other routers, which it dials until they are there.
    """
    all_kinds = ["router", "peer"]
    return {
        "mode": "router",
        "listen/endpoints": list(listen),
        "connect/endpoints": list(connect),
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": {**RETRY, "period_max_ms": 1000},
        "open/return_conditions/connect_scouted": False,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": True,
        "scouting/gossip/target": {"router": all_kinds, "peer": ["router"]},
        "scouting/gossip/autoconnect": {"router": [], "peer": all_kinds},
        "timestamping/enabled": True,
        "queries_default_timeout": 600_000,
        # Another machine may be out of reach for a while: each end gives the connection up soon, so
        # that it can be made anew as soon as the network is back. `rmw_zenohd` has 60 s.
        "transport/link/tx/lease": 8_000,
        "transport/link/tx/keep_alive": 4,
        "transport/unicast/open_timeout": 2_000,
        "transport/shared_memory/enabled": False,
        # A query for its routing table can deadlock it: zenoh's pull request 2619.
        "adminspace/enabled": False,
    }
