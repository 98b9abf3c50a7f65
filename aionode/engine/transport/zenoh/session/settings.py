"""Builds Zenoh's configuration for aionode's sessions and routers from a `Network`.

Pure functions; nothing is connected here. The settings include the intervals at which a lost router
or peer is redialled (`RETRY`), and the time after which a silent peer is considered dead
(`LEASE`).

Without configuration, the processes of one machine find each other over loopback: each tries to
listen on one of three meeting ports, and dials those that are listed (`local_sessions`), other
listeners on these ports, and the port of a ROS 2 router. If the machine lists nothing, each dials
the meeting ports, and gossip introduces all of them to each other; if other programs use all three,
there are three spare ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from msgspec import Struct

from aionode.engine.transport.network import ROUTER_PORT, DiscoveryRange
from aionode.engine.transport.zenoh._defects import (
    admin_space,
    blocked_sends,
    early_redial,
    half_open,
    shared_memory,
)
from aionode.engine.transport.zenoh.connections.config import LOOPBACK, near, probed_ports

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.engine.transport.network import Network

__all__ = [
    "Neighbours",
    "listening_address",
    "router_settings",
    "session_settings",
]

EVERYWHERE: Final = "0.0.0.0"  # noqa: S104  # only on request: ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET

FLUSH_S: Final = 2.0
"""How long the end of a context waits for reliable messages while their readers make progress, in
seconds."""

BATCHES: Final = 16
"""Number of 64 kB batches that may wait for a busy peer, for each priority in `BURSTING`."""

BURSTING: Final = ("control", "interactive_low", "data_high", "data_low")
"""The priorities of what the loop sends: tokens, requests and replies, messages, and messages for
late readers."""

GOSSIPING: Final = 4
"""Number of listed sessions whose gossip introduces sessions that are not listed, such as those of
other programs. One is too few: Zenoh drops gossip on a connection that is just starting. If all
gossiped, a hundred sessions would send half a million messages.
"""


class SessionLease(Struct, frozen=True):
    """How long a process may be silent before its peers consider it dead.

    When a hundred start at once, each is silent for more than ten seconds while it connects with
    the others. Peers that gave it up would connect again, and everything would take even longer.

    Attributes:
        first_ms: The lease of a process that starts alone, in milliseconds.
        each_ms: Addition for each other process that was listed when it started.
        most_ms: The longest lease, as any user of the machine can list any number of sessions.
        keep_alives: The number of keep-alive messages per lease.
    """

    first_ms: int
    each_ms: int
    most_ms: int
    keep_alives: int


LEASE: Final = SessionLease(10_000, 500, 60_000, keep_alives=4)
"""The longest one is the lease of ROS 2 nodes."""

WATCHED_LEASE: Final = SessionLease(100_000, 30_000, 3_600_000, keep_alives=2)
"""The lease of a session whose process the others check (`StoppedPeers`).

Keep-alive messages are what wakes an idle process among many. It gets them from each of the others,
so each of many sends fewer.
"""

RETRY: Final = {"period_init_ms": 100, "period_max_ms": 2000, "period_increase_factor": 2}
"""Intervals at which an endpoint that does not answer is redialled."""


class Neighbours(Struct, frozen=True):
    """The sessions of this machine, as a session sees them that is about to open.

    Attributes:
        port: The port on which it will listen.
        others: The ports of the others, which it dials.
    """

    port: int
    others: tuple[int, ...]


def session_settings(
    network: Network,
    taken: Iterable[int],
    neighbours: Neighbours | None = None,
    *,
    is_watched: bool = False,
) -> dict[str, Any]:
    """Return the settings of a session, by key path, without those of `network.overrides`.

    Args:
        network: The settings of the context.
        taken: The meeting ports on which it cannot listen.
        neighbours: What this machine lists; None if it lists nothing.
        is_watched: Whether the others on this machine check its process.
    """
    if network.config_file is not None:
        return {}
    taken = set(taken)
    mine = next((p for p in network.meeting_ports if p not in taken), None)
    off = network.discovery_range is DiscoveryRange.OFF
    subnet = network.discovery_range is DiscoveryRange.SUBNET
    gossip: dict[str, Any] = {"scouting/gossip/enabled": not off}
    listed = neighbours.others if neighbours is not None else ()
    lease = WATCHED_LEASE if is_watched and not network.may_reach_far else LEASE
    if neighbours is not None:
        listen = [neighbours.port]
        dial = [*neighbours.others, network.router_port]
        introduces = len(neighbours.others) < GOSSIPING or neighbours.port in network.meeting_ports
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
        # A lost race for the port is not an error. Retrying would make close() wait for the port.
        "listen/timeout_ms": 0,
        "listen/exit_on_failure": False,
        "connect/endpoints": early_redial.dialled(
            (*(f"tcp/{LOOPBACK}:{p}" for p in dial), *network.near_peers), RETRY["period_init_ms"]
        ),
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": RETRY,
        "open/return_conditions/connect_scouted": False,
        # Batches of 64 kB, made when they are needed: what the loop sends never waits for one.
        **{f"transport/link/tx/queue/size/{name}": BATCHES for name in BURSTING},
        # Large messages are sent from a thread, which may wait longer for a slow network.
        "transport/link/tx/queue/congestion_control/drop/max_wait_before_drop_fragments": 500_000,
        "scouting/multicast/enabled": subnet,
        "transport/link/tx/lease": min(lease.first_ms + lease.each_ms * len(listed), lease.most_ms),
        "transport/link/tx/keep_alive": lease.keep_alives,
        **gossip,
        **blocked_sends.settings(),
        **half_open.settings(network),
        **shared_memory.settings(),
        # As rmw_zenoh: if both dialled, Zenoh might keep neither of the two connections.
        "scouting/gossip/autoconnect_strategy": {
            "peer": {"to_router": "always", "to_peer": "greater-zid"}
        },
        # The history of transient_local topics is put in order by time stamps.
        "timestamping/enabled": True,
        # Histories are fetched with this timeout; every other query says its own.
        "queries_default_timeout": 600_000,
    }


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
        "connect/endpoints": early_redial.dialled(connect, RETRY["period_init_ms"]),
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
        **admin_space.settings(),
        **shared_memory.settings(),
    }
