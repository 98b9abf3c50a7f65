"""Counts the processes of a domain on this host, whether discovery has found them or not.

Fast DDS announces a new participant before it listens. Those that answer at once are not heard,
and they say no more until their next regular announcement, which they make every 3 s. Nothing in
the graph tells of them meanwhile, but each has taken a port of the domain.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode.engine.transport.rcl._state import PREFIX_BYTES

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.rcl._state import RclState

__all__ = ["count_on_this_host", "lacks_participants"]

UDP_SOCKETS: Final = Path("/proc/net/udp")
"""The UDP sockets of this host or container: a heading, then one in each line."""

NOT_CONNECTED: Final = "00000000:0000"
"""The other end of a socket that takes messages from anybody."""

FIRST_PORT: Final = 7410
"""The port for discovery of the first participant of domain 0 (RTPS 2.5, 9.6.2.3)."""

DOMAIN_PORTS: Final = 250
"""Distance between the ports of one domain and those of the next."""

PARTICIPANTS: Final = 120
"""Participants with ports in a domain; each has two ports, the first one for discovery."""

DISCOVERY_TOPIC: Final = "ros_discovery_info"
"""The topic on which each participant of ROS 2 tells of its nodes."""

HOST_BYTES: Final = 4
"""Bytes of a gid that identify Fast DDS and the host."""


def lacks_participants(state: RclState) -> bool:
    """Return whether participants run on this host that have not been discovered.

    Other middlewares than Fast DDS, and a context without a publisher or client of its own, which
    does not know what gids of this host look like, lack none.
    """
    hosts = {prefix[:HOST_BYTES] for prefix in state.own_prefixes}
    if state.rcl is None or not hosts:
        return False
    module, asker = state.rcl.module, state.watcher
    count = count_on_this_host(state.domain_id)
    return all(
        sum(prefix[:HOST_BYTES] in hosts for prefix in discovered(module, asker)) < count
        for discovered in (announced, with_endpoints)
    )


def announced(module: Any, asker: Any) -> set[bytes]:
    """Return the participants of ROS 2 that have been discovered."""
    return prefixes(module.rclpy_get_publishers_info_by_topic, asker, DISCOVERY_TOPIC)


def with_endpoints(module: Any, asker: Any) -> set[bytes]:
    """Return all participants that have been discovered with an endpoint; dearer to find."""
    with asker:
        topics = module.rclpy_get_topic_names_and_types(asker, True)
    prefixes_found: set[bytes] = set()
    for topic, _ in topics:
        prefixes_found |= prefixes(module.rclpy_get_publishers_info_by_topic, asker, topic)
        prefixes_found |= prefixes(module.rclpy_get_subscriptions_info_by_topic, asker, topic)
    return prefixes_found


def prefixes(ask: Callable[..., Any], asker: Any, topic: str) -> set[bytes]:
    """Return the participants of the endpoints of a topic, which has the name of DDS."""
    with asker:
        infos = ask(asker, topic, True)
    return {bytes(info["endpoint_gid"][:PREFIX_BYTES]) for info in infos}


def count_on_this_host(domain_id: int) -> int:
    """Return how many participants of a domain have a port for discovery on this host."""
    try:
        lines = UDP_SOCKETS.read_text("ascii").splitlines()[1:]
    except OSError:
        return 0
    first = FIRST_PORT + DOMAIN_PORTS * domain_id
    fields = (line.split(maxsplit=3) for line in lines)
    ports = {
        int(local.rpartition(":")[2], 16)
        for _, local, remote, _ in fields
        if remote == NOT_CONNECTED  # others are not for discovery
    }
    return len(ports.intersection(range(first, first + 2 * PARTICIPANTS, 2)))
