"""The network settings of a context: from arguments and environment variables to a `Network`.

Pure functions; nothing is connected here. Every transport between processes uses these settings;
`aionode.engine.transport.zenoh` turns them into Zenoh's configuration.
"""

from __future__ import annotations

import enum
import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

import msgspec

from aionode._process.stopped import pid_space
from aionode.clock import perf_ns
from aionode.errors import ConfigurationError, brief

__all__ = [
    "MEETING_PORTS",
    "ROUTER_PORT",
    "DiscoveryRange",
    "Network",
    "domain_of_port",
    "is_near",
    "network_from",
    "new_participant",
    "peer_endpoints",
    "pid_of",
    "udp_sockets",
    "unheard_middleware",
]

MEETING_PORTS: Final = (17449, 17450, 17451)
"""The ports where processes of domain 0 meet on one machine; further domains have the next ones.

They are below the ephemeral ports, and a ROS router uses none of them.
"""

SPARE_PORTS: Final = (17452, 17453, 17454)
"""The ports where processes of domain 0 meet if other programs have taken all of those."""

PORTS_OF_A_DOMAIN: Final = len(MEETING_PORTS) + len(SPARE_PORTS)

DOMAINS_WITH_PORTS: Final = 2500
"""Number of domains with ports of their own: all that fit below the ephemeral ports.

Domain 2500 shares those of domain 0, and so on. Such processes are connected, but only receive what
belongs to their own domain, as everywhere in ROS 2 on Zenoh.
"""

ROUTER_PORT: Final = 7447
"""The port of `rmw_zenohd` and `aionode router`."""

LOCALHOST_ONLY_VARIABLE: Final = "ROS_LOCALHOST_ONLY"
"""Set to 1 by users of ROS 2 Humble; later distributions deprecate it but honour it."""

MEETING_PORTS_VARIABLE: Final = "AIONODE_MEETING_PORTS"
ROUTER_PORT_VARIABLE: Final = "AIONODE_ROUTER_PORT"

MAX_DOMAIN_ID: Final = 2**32 - 1

UDP_SOCKETS: Final = Path("/proc/net/udp")

LATER: Final = "f"
"""The first digit of the id of a session that looks others up: it dials all others."""

SOUGHT: Final = "1"
"""The first digit of the id of a session that looks nobody up: others dial it once introduced."""


class DiscoveryRange(enum.Enum):
    """The range in which a context discovers others by itself."""

    OFF = "OFF"
    """It discovers no other context, and is not discovered."""
    LOCALHOST = "LOCALHOST"
    """It discovers the processes on its machine; nothing listens beyond loopback."""
    SUBNET = "SUBNET"
    """It also discovers machines on its network by multicast, and listens on every interface."""
    SYSTEM_DEFAULT = "SYSTEM_DEFAULT"
    """It discovers others only through a router on this machine, like ROS 2 on rmw_zenoh."""


QUEUE_BYTES: Final = 32 << 20
"""Default limit of the messages that wait in one queue, in bytes."""

QUEUE_BYTES_VARIABLE: Final = "AIONODE_QUEUE_BYTES"
"""The environment variable that changes the limit."""

GRAPH_BYTES: Final = 64 << 20
"""Default limit of other processes' announcements to keep, in bytes."""

GRAPH_BYTES_VARIABLE: Final = "AIONODE_GRAPH_BYTES"
"""The environment variable that changes the limit."""

MIN_BYTES: Final = 65_536
"""The minimum of either limit: messages up to this size are sent at once."""


class Network(msgspec.Struct, frozen=True):
    """The network settings of a context.

    Attributes:
        domain_id: Contexts of different domains do not hear each other.
        discovery_range: How far it looks for others.
        static_peers: Zenoh endpoints that it dials besides, such as ``tcp/10.0.0.7:7447``.
        config_file: A Zenoh configuration that takes the place of aionode's own.
        config_source: Where its path comes from, for error texts.
        overrides: Settings that win over all others: key path and JSON5 text.
        override_source: Where the overrides come from, for error texts.
        meeting_ports: Ports on which processes of one machine and domain meet.
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
        """Whether a session may itself be connected to other machines."""
        subnet = self.discovery_range is DiscoveryRange.SUBNET
        return subnet or self.config_file is not None or bool(self.overrides)

    @property
    def far_peers(self) -> tuple[str, ...]:
        """The static peers that a router on this machine connects to: those on other machines."""
        if self.discovery_range is DiscoveryRange.OFF:
            return ()
        return tuple(endpoint for endpoint in self.static_peers if not is_near(endpoint))

    @property
    def near_peers(self) -> tuple[str, ...]:
        """The static peers that a session connects to itself: those on this machine."""
        if self.discovery_range is DiscoveryRange.OFF:
            return ()
        return tuple(endpoint for endpoint in self.static_peers if is_near(endpoint))


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
    """Return the settings from the arguments or, where they are None, from the environment.

    Args:
        environ: Usually `os.environ`: ``ROS_DOMAIN_ID``, ``ROS_AUTOMATIC_DISCOVERY_RANGE``,
            ``ROS_STATIC_PEERS``, ``ROS_LOCALHOST_ONLY``, ``ZENOH_SESSION_CONFIG_URI``,
            ``ZENOH_CONFIG_OVERRIDE``.
        domain_id: Overrides ``ROS_DOMAIN_ID``.
        discovery_range: Overrides ``ROS_AUTOMATIC_DISCOVERY_RANGE``.
        static_peers: Overrides ``ROS_STATIC_PEERS``: hosts, ``host:port`` or Zenoh endpoints.
        config: A path to a Zenoh configuration file, overriding ``ZENOH_SESSION_CONFIG_URI``, or
            single settings by key path, which override ``ZENOH_CONFIG_OVERRIDE``.
        queue_bytes: Overrides ``AIONODE_QUEUE_BYTES``.
        graph_bytes: Overrides ``AIONODE_GRAPH_BYTES``.

    Raises:
        ConfigurationError: one of them is invalid; the message names it.
    """
    domain_id = choose_domain_id(environ, domain_id)
    ports, spare_ports = meeting_ports(environ, domain_id)
    router_port = port(
        environ.get("AIONODE_ROUTER_PORT") or str(ROUTER_PORT), "AIONODE_ROUTER_PORT"
    )
    overrides = parse_overrides(environ.get("ZENOH_CONFIG_OVERRIDE", ""))
    override_source = "ZENOH_CONFIG_OVERRIDE"
    config_source = "ZENOH_SESSION_CONFIG_URI"
    config_file = environ.get(config_source) or None
    if isinstance(config, Mapping):
        overrides += tuple(
            (key, msgspec.json.encode(value).decode()) for key, value in config.items()
        )
        override_source = "config"
    elif config is not None:
        config_file = str(config)
        config_source = "config"
    if environ.get(LOCALHOST_ONLY_VARIABLE, "").strip() == "1":
        # As in ROS 2 since Iron: it overrides the two newer variables.
        hidden = {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS"}
        environ = {name: text for name, text in environ.items() if name not in hidden}
    if static_peers is None:
        peers_source = "ROS_STATIC_PEERS"
        static_peers = environ.get(peers_source, "").split(";")
    else:
        peers_source = "static_peers"
        if isinstance(static_peers, str):  # iterable too, but never meant that way
            static_peers = static_peers.split(";")
    return Network(
        domain_id=domain_id,
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
    """Return a limit in bytes, from the argument or the environment."""
    fits = f"use an integer number of bytes, at least {MIN_BYTES}"
    if given is None:
        text = environ.get(variable, "").strip() or str(usual)
        source, known = variable, text.isascii() and text.isdigit() and len(text) <= 18
        given = int(text) if known else 0
    elif isinstance(given, bool) or not isinstance(given, int):
        raise TypeError(f"{argument}: {brief(given)} given; {fits}")
    else:
        source, text = argument, str(given)
    if given < MIN_BYTES:
        raise ConfigurationError(source, text, fits)
    return given


def choose_domain_id(environ: Mapping[str, str], domain_id: int | None) -> int:
    """Return the domain id from the argument or the environment."""
    fits = f"use an integer from 0 to {MAX_DOMAIN_ID}"
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
    """Return the discovery range from the argument or the environment."""
    if isinstance(discovery_range, DiscoveryRange):
        return discovery_range
    source = "ROS_AUTOMATIC_DISCOVERY_RANGE" if discovery_range is None else "discovery_range"
    text = environ.get(source, "") if discovery_range is None else discovery_range
    text = text.strip() or DiscoveryRange.LOCALHOST.value
    try:
        return DiscoveryRange[text.upper()]
    except KeyError:
        fits = "use one of " + ", ".join(r.value for r in DiscoveryRange)
        raise ConfigurationError(source, text, fits) from None


def parse_overrides(text: str) -> tuple[tuple[str, str], ...]:
    """Parse the settings in ``ZENOH_CONFIG_OVERRIDE``: ``key/path=json5;…``."""
    overrides = []
    for item in text.split(";"):
        if not item.strip():
            continue
        key, equals, value = item.partition("=")
        if not (equals and key.strip() and value.strip()):
            fits = "use settings such as scouting/multicast/enabled=true, separated by ;"
            raise ConfigurationError("ZENOH_CONFIG_OVERRIDE", item.strip(), fits)
        overrides.append((key.strip(), value.strip()))
    return tuple(overrides)


def peer_endpoints(peer: str, source: str, ports: tuple[int, ...]) -> list[str]:
    """Return the endpoints of a static peer to dial; without a port, wherever one could listen."""
    if "/" in peer:
        protocol, _, address = peer.partition("/")
        if protocol and address:
            return [peer]
    else:
        host, colon, given_port = split_port(peer)
        if host and not any(c.isspace() for c in host):
            dialled = (port(given_port, source),) if colon else ports
            return [f"tcp/{host}:{p}" for p in dialled]
    fits = "use a host, host:port or a Zenoh endpoint such as tcp/10.0.0.7:7447"
    raise ConfigurationError(source, peer, fits)


def is_near(endpoint: str) -> bool:
    """Return whether an endpoint is on this machine, judging by its text."""
    protocol, _, address = endpoint.partition("/")
    host = split_port(address.partition("?")[0].partition("#")[0])[0].strip("[]")
    host = host.removeprefix("::ffff:")  # an IPv4-mapped IPv6 address
    return protocol.startswith("unix") or host in ("localhost", "::1") or host.startswith("127.")


def split_port(peer: str) -> tuple[str, str, str]:
    """Return host, colon and port; the last two are empty if there is no port."""
    if peer.startswith("["):  # an IPv6 address in brackets
        host, bracket, rest = peer.partition("]")
        return host + bracket, rest[:1], rest[1:]
    if peer.count(":") > 1:  # a bare IPv6 address has no room for a port
        return f"[{peer}]", "", ""
    return peer.partition(":")


def port(text: str, source: str) -> int:
    """Parse a TCP port."""
    if not (text.isascii() and text.isdigit()) or len(text) > 5 or not 0 < int(text) < 2**16:
        raise ConfigurationError(source, text, "use a TCP port from 1 to 65535")
    return int(text)


def domain_of_port(first: int) -> int | None:
    """Return the domain whose processes meet on a port and the next ones, by default; else None."""
    domain_id, rest = divmod(first - MEETING_PORTS[0], PORTS_OF_A_DOMAIN)
    return domain_id if rest == 0 and 0 <= domain_id < DOMAINS_WITH_PORTS else None


def meeting_ports(
    environ: Mapping[str, str], domain_id: int
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the ports to meet on, and spare ones.

    By default each domain has its own, so that processes of different domains are not even
    connected. Where the variable sets them, processes of all domains meet there.
    """
    text = environ.get(MEETING_PORTS_VARIABLE, "")
    if not text:
        shift = domain_id % DOMAINS_WITH_PORTS * PORTS_OF_A_DOMAIN
        return tuple(p + shift for p in MEETING_PORTS), tuple(p + shift for p in SPARE_PORTS)
    ports = tuple(port(p.strip(), MEETING_PORTS_VARIABLE) for p in text.split(","))
    return ports[: len(MEETING_PORTS)], ports[len(MEETING_PORTS) :]


def new_participant() -> str:
    """Return an id for a context and its session; later ones are greater.

    When gossip introduces two sessions, Zenoh makes the one with the greater id dial. A later
    session also dials those that are listed, so no two ever dial each other. The time is the
    machine's uptime, which is the same for all processes. Zenoh writes ids without leading zeros,
    and everyone must see the same text.

    After the time comes the process, for `pid_of`.
    """
    first = SOUGHT if udp_sockets() is None else LATER
    space = pid_space()
    process = "" if space is None else f"{space:04x}{os.getpid():08x}"
    rest = os.urandom(10).hex()[: 19 - len(process)]
    return f"{first}{perf_ns() >> 16:012x}{process}{rest}"


def pid_of(participant: str) -> int | None:
    """Return the process of a context, if it is one of those that this process can name.

    Others choose their ids: it may be any process.
    """
    space = pid_space()
    is_named = len(participant) == 32 and space is not None
    if not is_named or participant[13:17] != f"{space:04x}":
        return None
    try:
        pid = int(participant[17:25], 16)
    except ValueError:
        return None
    return pid if 0 < pid < 1 << 31 else None


def udp_sockets() -> list[str] | None:
    """Return a line for each bound UDP socket; None if they cannot be listed."""
    if not sys.platform.startswith("linux"):
        return None
    try:
        return UDP_SOCKETS.read_text("ascii").splitlines()[1:]
    except OSError:  # a sandbox may hide it
        return None


def unheard_middleware(environ: Mapping[str, str]) -> str | None:
    """Return what to do if this environment's ROS 2 nodes are not reachable; None if they are."""
    middleware = environ.get("RMW_IMPLEMENTATION", "")
    if middleware in {"", "rmw_zenoh_cpp"}:
        return None
    return (
        f"RMW_IMPLEMENTATION={middleware}: nodes on DDS are not reachable; use "
        "AIONODE_TRANSPORT=rcl to reach them"
    )
