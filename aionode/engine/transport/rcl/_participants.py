"""Counts the processes of a domain on this host, whether or not they have been discovered.

Fast DDS announces a new participant before it listens, so immediate answers are lost, and are only
repeated with the next regular announcement, every 3 s. Until then nothing in the graph reveals
those processes, but each has taken a port of the domain.
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
"""The UDP sockets of this host or container: a heading, then one per line."""

NOT_CONNECTED: Final = "00000000:0000"
"""The remote address of a socket that receives messages from anybody."""

FIRST_PORT: Final = 7410
"""The discovery port of the first participant of domain 0 (RTPS 2.5, 9.6.2.3)."""

DOMAIN_PORTS: Final = 250
"""Distance between the ports of consecutive domains."""

PARTICIPANTS: Final = 120
"""Participants with ports in a domain; each has two ports, the first one for discovery."""

DISCOVERY_TOPIC: Final = "ros_discovery_info"
"""The topic on which each ROS 2 participant announces its nodes."""

HOST_BYTES: Final = 4
"""Bytes of a gid that identify Fast DDS and the host."""


def lacks_participants(state: RclState) -> bool:
    """Return whether there are undiscovered participants on this host.

    Returns False with middleware other than Fast DDS, and for a context without a publisher or
    client, which does not know what gids of this host look like.
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
    """Return the ROS 2 participants that have been discovered."""
    return prefixes(module.rclpy_get_publishers_info_by_topic, asker, DISCOVERY_TOPIC)


def with_endpoints(module: Any, asker: Any) -> set[bytes]:
    """Return all participants discovered with an endpoint; this query is more expensive."""
    with asker:
        topics = module.rclpy_get_topic_names_and_types(asker, True)
    prefixes_found: set[bytes] = set()
    for topic, _ in topics:
        prefixes_found |= prefixes(module.rclpy_get_publishers_info_by_topic, asker, topic)
        prefixes_found |= prefixes(module.rclpy_get_subscriptions_info_by_topic, asker, topic)
    return prefixes_found


def prefixes(ask: Callable[..., Any], asker: Any, topic: str) -> set[bytes]:
    """Return the participants of a topic's endpoints, given its DDS name."""
    with asker:
        infos = ask(asker, topic, True)
    return {bytes(info["endpoint_gid"][:PREFIX_BYTES]) for info in infos}


def count_on_this_host(domain_id: int) -> int:
    """Count the participants of a domain with a discovery port on this host."""
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
