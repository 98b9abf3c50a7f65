"""The Zenoh sessions of this machine, as Linux lists them.

Each session that other processes may dial binds a Unix socket to an abstract name, which says its
id and where it listens. ``/proc/net/unix`` lists these names, so that a session knows all others
before it is opened, and dials them. Abstract names belong to a network namespace, as loopback does:
whoever is listed can be dialled, whatever user or container it belongs to. A name ends with its
process, however that ends.

Zenoh's gossip would introduce the sessions too, but each one tells all that it is connected with of
each new one: a hundred that start at once send half a million such messages. Where nothing is
listed, that is how sessions meet.

Zenoh has the session with the greater id dial if gossip introduces two. Ids grow with the time,
so that this is the later one here too, and no two ever dial each other.
"""

from __future__ import annotations

import secrets
import socket
import sys
from pathlib import Path
from typing import Final

from aionode.clock import perf_ns

__all__ = ["announce", "listed", "new_participant", "reserve_port"]

UNIX_SOCKETS: Final = Path("/proc/net/unix")

LATER: Final = "f"
"""The first digit of the id of a session that looks others up: it dials all others."""

SOUGHT: Final = "1"
"""That of a session that does not: all others dial it, if one has introduced it to them."""


def new_participant() -> str:
    """Return an id for a context and its session; one that is made later is greater.

    The time is that since the machine was started, which is the same for all processes. Zenoh
    writes ids without leading zeros, and all have to see the same text.
    """
    first = SOUGHT if unix_sockets() is None else LATER
    return f"{first}{perf_ns() >> 16:012x}{secrets.token_hex(10)[:19]}"


def announce(group: int, participant: str, port: int) -> socket.socket:
    """Have this machine list a session, until what is returned is closed.

    Nobody can connect to it, as it does not listen: it is there for its name.

    Args:
        group: The first of the ports on which sessions meet; those with others do not meet.
        participant: The id of the session.
        port: Where it listens on loopback.
    """
    presence = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    presence.bind(f"\0{prefix(group)}{participant}/{port}")
    return presence


def listed(group: int) -> dict[str, int] | None:
    """Return the sessions that are listed, each with its port; None if the machine has no list."""
    start = f"@{prefix(group)}"
    lines = unix_sockets()
    if lines is None:
        return None
    sessions = {}
    for line in lines:
        name = line.rpartition(" ")[2]
        if name.startswith(start):
            participant, _, port = name.removeprefix(start).partition("/")
            # Any program may bind any name.
            if port.isascii() and port.isdigit() and len(port) <= 5 and 0 < int(port) < 2**16:
                sessions[participant] = int(port)
    return sessions


def reserve_port(host: str) -> socket.socket:
    """Return a socket with a free port, where a session can listen as long as it is open."""
    one = socket.socket()
    try:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        one.bind((host, 0))
    except OSError:
        one.close()
        raise
    return one


def unix_sockets() -> list[str] | None:
    """Return a line for each Unix socket that can be reached; None where nothing lists them."""
    if not (sys.platform.startswith("linux") and hasattr(socket, "AF_UNIX")):
        return None
    try:
        return UNIX_SOCKETS.read_bytes().decode("ascii", "replace").splitlines()
    except OSError:  # a sandbox may hide it
        return None


def prefix(group: int) -> str:
    """Return what the names of a group start with."""
    return f"aionode/{group}/"
