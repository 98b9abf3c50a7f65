"""The network settings of a context: from environment variables to a Zenoh configuration.

Pure functions; nothing is connected here, and zenoh is not imported.

Without configuration the processes of one machine find each other over loopback: each tries to
listen on one of three meeting ports, and dials those that are listed (`_local_sessions`), other
listeners on these ports, and the port of a ROS 2 router. Where the machine lists nothing, each
dials the meeting ports, and gossip introduces all of them to each other; if other programs hold all
three, there are three spare ones.
"""

from __future__ import annotations

import enum
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from aionode.errors import ConfigurationError, brief

__all__ = [
    "MEETING_PORTS",
    "ROUTER_PORT",
    "DiscoveryRange",
    "Neighbours",
    "Network",
    "introducers",
    "is_near",
    "listening_address",
    "look_settings",
    "near",
    "network_from",
    "peer_endpoints",
    "probed_ports",
    "router_settings",
    "session_settings",
    "unheard_middleware",
]

MEETING_PORTS: Final = (17449, 17450, 17451)
"""Where processes of one machine meet: below the ephemeral ports, and not a ROS router's."""

SPARE_PORTS: Final = (17452, 17453, 17454)
"""Where they meet if other programs have taken all of those."""

ROUTER_PORT: Final = 7447
"""Where `rmw_zenohd` and `aionode router` listen."""

LOCALHOST_ONLY_VARIABLE: Final = "ROS_LOCALHOST_ONLY"
"""Set to 1 by users of ROS 2 Humble; later distributions call it deprecated and honour it."""

MEETING_PORTS_VARIABLE: Final = "AIONODE_MEETING_PORTS"
ROUTER_PORT_VARIABLE: Final = "AIONODE_ROUTER_PORT"

LOOPBACK: Final = "127.0.0.1"
EVERYWHERE: Final = "0.0.0.0"  # noqa: S104  # only on request: ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET

MAX_DOMAIN_ID: Final = 2**32 - 1

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


class DiscoveryRange(enum.Enum):
    """How far a context looks for others by itself."""

    OFF = "OFF"
    """It finds no other context, and none finds it."""
    LOCALHOST = "LOCALHOST"
    """It finds the processes of its machine; nothing listens beyond loopback."""
    SUBNET = "SUBNET"
    """It finds machines of its network too, by multicast, and listens on every interface."""
    SYSTEM_DEFAULT = "SYSTEM_DEFAULT"
    """As a ROS 2 node on rmw_zenoh does: only through a router on this machine."""


QUEUE_BYTES: Final = 32 << 20
"""How many bytes of messages wait in one queue, unless the context says otherwise."""

QUEUE_BYTES_VARIABLE: Final = "AIONODE_QUEUE_BYTES"
"""The environment variable that says otherwise."""

GRAPH_BYTES: Final = 64 << 20
"""How many bytes of what other processes announce are kept, unless the context says otherwise."""

GRAPH_BYTES_VARIABLE: Final = "AIONODE_GRAPH_BYTES"
"""The environment variable that says otherwise."""

LEAST_BYTES: Final = 65_536
"""Less than this would be less than a message that is sent at once."""


@dataclass(frozen=True, slots=True)
class Network:
    """The network settings of a context.

    Attributes:
        domain_id: Contexts of different domains do not hear each other.
        discovery_range: How far it looks for others.
        static_peers: Zenoh endpoints that it dials besides, such as ``tcp/10.0.0.7:7447``.
        config_file: A Zenoh configuration that takes the place of aionode's own.
        config_source: Where its path comes from, for error texts.
        overrides: Settings that win over all others: key path and JSON5 text.
        override_source: Where the overrides come from, for error texts.
        meeting_ports: Ports on which processes of one machine meet.
        spare_ports: Further ones, for when other programs have taken all of those.
        router_port: Port of a router on this machine.
        queue_bytes: How many bytes of messages may wait in each queue from and to other processes.
        graph_bytes: How many bytes of what other processes announce are kept.
    """

    domain_id: int = 0
    discovery_range: DiscoveryRange = DiscoveryRange.LOCALHOST
    static_peers: tuple[str, ...] = ()
    config_file: str | None = None
    config_source: str = "ZENOH_SESSION_CONFIG_URI"
    overrides: tuple[tuple[str, str], ...] = ()
    override_source: str = "config"
    meeting_ports: tuple[int, ...] = MEETING_PORTS
    spare_ports: tuple[int, ...] = SPARE_PORTS
    router_port: int = ROUTER_PORT
    queue_bytes: int = QUEUE_BYTES
    graph_bytes: int = GRAPH_BYTES

    @property
    def may_reach_far(self) -> bool:
        """Whether a session may be connected to other machines itself."""
        subnet = self.discovery_range is DiscoveryRange.SUBNET
        return subnet or self.config_file is not None or bool(self.overrides)

    @property
    def far_peers(self) -> tuple[str, ...]:
        """Those static peers that a router of this machine dials: on other machines."""
        if self.discovery_range is DiscoveryRange.OFF:
            return ()
        return tuple(endpoint for endpoint in self.static_peers if not is_near(endpoint))

    @property
    def near_peers(self) -> tuple[str, ...]:
        """Those static peers that a session dials itself: on this machine."""
        if self.discovery_range is DiscoveryRange.OFF:
            return ()
        return tuple(endpoint for endpoint in self.static_peers if is_near(endpoint))


@dataclass(frozen=True, slots=True)
class Neighbours:
    """The other sessions of a machine that lists them, as one sees them that is about to open.

    Attributes:
        port: Where it will listen itself.
        others: Where it dials others.
    """

    port: int
    others: tuple[int, ...]


def network_from(
    environ: Mapping[str, str],
    *,
    domain_id: int | None = None,
    discovery_range: DiscoveryRange | str | None = None,
    static_peers: Iterable[str] | None = None,
    config: str | Path | Mapping[str, Any] | None = None,
    queue_bytes: int | None = None,
    graph_bytes: int | None = None,
) -> Network:
    """Return what the arguments say and, where they are None, the environment.

    Args:
        environ: Usually `os.environ`: ``ROS_DOMAIN_ID``, ``ROS_AUTOMATIC_DISCOVERY_RANGE``,
            ``ROS_STATIC_PEERS``, ``ROS_LOCALHOST_ONLY``, ``ZENOH_SESSION_CONFIG_URI``,
            ``ZENOH_CONFIG_OVERRIDE``.
        domain_id: Instead of ``ROS_DOMAIN_ID``.
        discovery_range: Instead of ``ROS_AUTOMATIC_DISCOVERY_RANGE``.
        static_peers: Instead of ``ROS_STATIC_PEERS``: hosts, ``host:port`` or Zenoh endpoints.
        config: A path to a Zenoh configuration file, instead of ``ZENOH_SESSION_CONFIG_URI``, or
            single settings by their key path, which win over ``ZENOH_CONFIG_OVERRIDE``.
        queue_bytes: Instead of ``AIONODE_QUEUE_BYTES``.
        graph_bytes: Instead of ``AIONODE_GRAPH_BYTES``.

    Raises:
        ConfigurationError: one of them does not fit; the text names it.
    """
    ports, spare_ports = meeting_ports(environ)
    router_port = port(
        environ.get("AIONODE_ROUTER_PORT") or str(ROUTER_PORT), "AIONODE_ROUTER_PORT"
    )
    overrides = parse_overrides(environ.get("ZENOH_CONFIG_OVERRIDE", ""))
    override_source = "ZENOH_CONFIG_OVERRIDE"
    config_source = "ZENOH_SESSION_CONFIG_URI"
    config_file = environ.get(config_source) or None
    if isinstance(config, Mapping):
        overrides += tuple((key, json.dumps(value)) for key, value in config.items())
        override_source = "config"
    elif config is not None:
        config_file = str(config)
        config_source = "config"
    if environ.get(LOCALHOST_ONLY_VARIABLE, "").strip() == "1":
        # As in ROS 2 since Iron: it overrules the two variables that came after it.
        hidden = {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS"}
        environ = {name: text for name, text in environ.items() if name not in hidden}
    if static_peers is None:
        peers_source = "ROS_STATIC_PEERS"
        static_peers = environ.get(peers_source, "").split(";")
    else:
        peers_source = "static_peers"
        if isinstance(static_peers, str):  # a string is iterable too, and never meant so
            static_peers = static_peers.split(";")
    return Network(
        domain_id=choose_domain_id(environ, domain_id),
        discovery_range=choose_range(environ, discovery_range),
        static_peers=tuple(
            endpoint
            for peer in static_peers
            if peer.strip()
            for endpoint in peer_endpoints(peer.strip(), peers_source, (router_port, *ports))
        ),
        config_file=config_file,
        config_source=config_source,
        overrides=overrides,
        override_source=override_source,
        meeting_ports=ports,
        spare_ports=spare_ports,
        router_port=router_port,
        queue_bytes=choose_bytes(
            environ, QUEUE_BYTES_VARIABLE, "queue_bytes", queue_bytes, QUEUE_BYTES
        ),
        graph_bytes=choose_bytes(
            environ, GRAPH_BYTES_VARIABLE, "graph_bytes", graph_bytes, GRAPH_BYTES
        ),
    )


def choose_bytes(
    environ: Mapping[str, str], variable: str, argument: str, given: int | None, usual: int
) -> int:
    """Return a limit in bytes, as the argument or the environment says."""
    fits = f"a whole number of bytes from {LEAST_BYTES} on fits"
    if given is None:
        text = environ.get(variable, "").strip() or str(usual)
        source, known = variable, text.isascii() and text.isdigit() and len(text) <= 18
        given = int(text) if known else 0
    elif isinstance(given, bool) or not isinstance(given, int):
        raise TypeError(f"{argument}: {brief(given)} given; {fits}")
    else:
        source, text = argument, str(given)
    if given < LEAST_BYTES:
        raise ConfigurationError(source, text, fits)
    return given


def choose_domain_id(environ: Mapping[str, str], domain_id: int | None) -> int:
    """Return the domain id that the argument or the environment says."""
    fits = f"a whole number from 0 to {MAX_DOMAIN_ID} fits"
    if domain_id is not None:
        if isinstance(domain_id, bool) or not isinstance(domain_id, int):
            raise TypeError(f"domain_id: {brief(domain_id)} given; {fits}")
        if not 0 <= domain_id <= MAX_DOMAIN_ID:
            raise ConfigurationError("domain_id", str(domain_id), fits)
        return domain_id
    text = environ.get("ROS_DOMAIN_ID", "").strip() or "0"
    if not (text.isascii() and text.isdigit()) or len(text) > 10 or int(text) > MAX_DOMAIN_ID:
        raise ConfigurationError("ROS_DOMAIN_ID", text, fits)
    return int(text)


def choose_range(
    environ: Mapping[str, str], discovery_range: DiscoveryRange | str | None
) -> DiscoveryRange:
    """Return the discovery range that the argument or the environment says."""
    if isinstance(discovery_range, DiscoveryRange):
        return discovery_range
    source = "ROS_AUTOMATIC_DISCOVERY_RANGE" if discovery_range is None else "discovery_range"
    text = environ.get(source, "") if discovery_range is None else discovery_range
    text = text.strip() or DiscoveryRange.LOCALHOST.value
    try:
        return DiscoveryRange[text.upper()]
    except KeyError:
        fits = "one of " + ", ".join(r.value for r in DiscoveryRange) + " fits"
        raise ConfigurationError(source, text, fits) from None


def parse_overrides(text: str) -> tuple[tuple[str, str], ...]:
    """Return the settings of ``ZENOH_CONFIG_OVERRIDE``: ``key/path=json5;…``."""
    overrides = []
    for item in text.split(";"):
        if not item.strip():
            continue
        key, equals, value = item.partition("=")
        if not (equals and key.strip() and value.strip()):
            fits = "settings such as scouting/multicast/enabled=true, separated by ;, fit"
            raise ConfigurationError("ZENOH_CONFIG_OVERRIDE", item.strip(), fits)
        overrides.append((key.strip(), value.strip()))
    return tuple(overrides)


def peer_endpoints(peer: str, source: str, ports: tuple[int, ...]) -> list[str]:
    """Return where to dial a static peer; without a port, wherever one could listen."""
    if "/" in peer:
        protocol, _, address = peer.partition("/")
        if protocol and address:
            return [peer]
    else:
        host, colon, given_port = split_port(peer)
        if host and not any(c.isspace() for c in host):
            dialled = (port(given_port, source),) if colon else ports
            return [f"tcp/{host}:{p}" for p in dialled]
    fits = "a host, host:port or a Zenoh endpoint such as tcp/10.0.0.7:7447 fits"
    raise ConfigurationError(source, peer, fits)


def is_near(endpoint: str) -> bool:
    """Return whether an endpoint is on this machine, as far as its text tells."""
    protocol, _, address = endpoint.partition("/")
    host = split_port(address.partition("?")[0].partition("#")[0])[0].strip("[]")
    host = host.removeprefix("::ffff:")  # an IPv4 address as IPv6 has it
    return protocol.startswith("unix") or host in ("localhost", "::1") or host.startswith("127.")


def split_port(peer: str) -> tuple[str, str, str]:
    """Return host, colon and port; the last two are empty without a port."""
    if peer.startswith("["):  # an IPv6 address in brackets
        host, bracket, rest = peer.partition("]")
        return host + bracket, rest[:1], rest[1:]
    if peer.count(":") > 1:  # a bare IPv6 address has no room for a port
        return f"[{peer}]", "", ""
    return peer.partition(":")


def port(text: str, source: str) -> int:
    """Return a TCP port."""
    if not (text.isascii() and text.isdigit()) or len(text) > 5 or not 0 < int(text) < 2**16:
        raise ConfigurationError(source, text, "a TCP port from 1 to 65535 fits")
    return int(text)


def meeting_ports(environ: Mapping[str, str]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the ports to meet on, and spare ones.

    Tests set others, so as not to hear what else runs.
    """
    text = environ.get(MEETING_PORTS_VARIABLE, "")
    if not text:
        return MEETING_PORTS, SPARE_PORTS
    ports = tuple(port(p.strip(), MEETING_PORTS_VARIABLE) for p in text.split(","))
    return ports[: len(MEETING_PORTS)], ports[len(MEETING_PORTS) :]


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


def unheard_middleware(environ: Mapping[str, str]) -> str | None:
    """Return what to do if the ROS 2 nodes of this environment are not heard; None if they are."""
    middleware = environ.get("RMW_IMPLEMENTATION", "")
    if middleware in {"", "rmw_zenoh_cpp"}:
        return None
    return (
        f"RMW_IMPLEMENTATION={middleware}: nodes over DDS are not heard; AIONODE_TRANSPORT=rcl "
        "reaches them"
    )
