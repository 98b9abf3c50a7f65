"""The configuration of Zenoh sessions, the endpoints that they dial, and probes.

A probe is a short-lived session that reads the tokens seen by one endpoint.
"""

from __future__ import annotations

import os
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import msgspec
import zenoh

from aionode.engine.transport.network import DiscoveryRange
from aionode.engine.transport.zenoh.connections.handlers import reason
from aionode.errors import ConfigurationError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from aionode.engine.transport.network import Network

__all__ = [
    "LOOPBACK",
    "gossip_endpoints",
    "is_probe",
    "load_config",
    "near",
    "open_probe",
    "probed_ports",
]

LOOPBACK: Final = "127.0.0.1"

PROBE_IDS: Final = "a10de10c"
"""The id prefix of sessions that are only open for one query."""


def near(network: Network) -> bool:
    """Return whether a session looks for others on its machine by itself."""
    return network.config_file is None and network.discovery_range in (
        DiscoveryRange.LOCALHOST,
        DiscoveryRange.SUBNET,
    )


def probed_ports(network: Network) -> tuple[int, ...]:
    """Return the ports of this machine whose listeners a session will dial."""
    if network.config_file is not None or network.discovery_range is DiscoveryRange.OFF:
        return ()
    if network.discovery_range is DiscoveryRange.SYSTEM_DEFAULT:
        return (network.router_port,)
    return (*network.meeting_ports, network.router_port)


def gossip_endpoints(network: Network) -> tuple[str, ...]:
    """Return the endpoints that a session keeps dialling, as far as aionode knows.

    A router or peer there is a gossip source: it tells this session about others.
    """
    if network.config_file is not None or network.discovery_range is DiscoveryRange.OFF:
        return ()
    ports = (*probed_ports(network), *network.spare_ports)
    return (*(f"tcp/{LOOPBACK}:{p}" for p in ports), *network.near_peers)


def load_config(
    network: Network,
    settings: dict[str, Any],
    participant: str | None = None,
    last: Mapping[str, Any] = MappingProxyType({}),
) -> zenoh.Config:
    """Return a configuration in Zenoh's own form.

    Args:
        network: Provides the file and the overrides.
        settings: Replaces Zenoh's defaults.
        participant: The id of the session.
        last: Overrides everything else.

    Raises:
        ConfigurationError: the file or an override cannot be used; the message says why.
    """
    config = zenoh.Config()
    if network.config_file is not None:
        path = network.config_file.removeprefix("file://")
        try:
            config = zenoh.Config.from_file(path)
        except zenoh.ZError as error:
            fits = f"use the path of a Zenoh configuration (JSON5): {reason(error)}"
            raise ConfigurationError(network.config_source, path, fits) from error
    for key, value in settings.items():
        config.insert_json5(key, as_json(value))
    for key, text in network.overrides:
        try:
            config.insert_json5(key, text)
        except zenoh.ZError as error:
            fits = f"use key paths and values of Zenoh's configuration: {reason(error)}"
            raise ConfigurationError(network.override_source, f"{key}={text}", fits) from error
    for key, value in last.items():
        config.insert_json5(key, as_json(value))
    if participant is not None:
        config.insert_json5("id", as_json(participant))
    return config


def as_json(value: object) -> str:
    """Return a value as Zenoh reads it."""
    return msgspec.json.encode(value).decode()


def is_probe(zid: str) -> bool:
    """Return whether a session is only open for one query, and subscribes to nothing."""
    return zid.startswith(PROBE_IDS) and len(zid) == 32


def open_probe(network: Network, endpoint: str, mode: str = "client") -> zenoh.Session:
    """Open a session that is connected to one endpoint only.

    Raises:
        ConfigurationError: the settings of the context cannot be used.
        zenoh.ZError: nothing answers there.
    """
    settings = {
        "mode": mode,
        "connect/endpoints": [endpoint],
        "connect/timeout_ms": 700,
        "connect/exit_on_failure": True,
        "listen/endpoints": [],
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "transport/unicast/open_timeout": 700,
        "transport/shared_memory/enabled": False,
    }
    return zenoh.open(load_config(network, {}, PROBE_IDS + os.urandom(12).hex(), settings))
