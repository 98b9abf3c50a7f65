"""The Zenoh sessions of this machine, as Linux lists them.

Each session that other processes may dial connects a UDP socket, which sends nothing: the remote
address says which sessions it meets, and the remote port is that on which Zenoh listens.
``/proc/net/udp`` lists these sockets, so that a session knows all others before it is opened, and
dials them. They belong to a network namespace, as loopback does: a listed session can be dialled,
whatever user or container it belongs to. A socket ends with its process, however that ends.

Unix sockets with abstract names would do as well, but ``/proc/net/unix`` lists all connections too:
with a hundred processes that are linked it takes 8 ms to read, when all of them start and wait.

Zenoh's gossip would introduce the sessions too, but each one tells all that it is connected with of
each new one: a hundred that start at once send half a million such messages. Where nothing is
listed, that is how sessions meet.
"""

from __future__ import annotations

import socket
import sys
from contextlib import suppress
from typing import Final

from aionode.transport._network import udp_sockets
from aionode.transport.zenoh._config import LOOPBACK

__all__ = ["announce", "holder_of", "listed", "reserve_port"]

PRESENCE: Final = 97
"""The second number of these addresses, all of which belong to loopback."""


def announce(group: int, port: int) -> socket.socket:
    """Have this machine list a session, until what is returned is closed.

    Args:
        group: The first of the ports on which sessions meet; those with others do not meet.
        port: Where it listens on loopback.
    """
    presence = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    presence.bind((LOOPBACK, 0))
    with suppress(OSError):  # loopback is down, and nobody could dial it
        presence.connect((address_of(group), port))
    return presence


def listed(group: int) -> set[int] | None:
    """Return the ports of the sessions that are listed; None if the machine has no list."""
    lines = udp_sockets()
    if lines is None:
        return None
    address = int.from_bytes(socket.inet_aton(address_of(group)), sys.byteorder)
    start = f"{address:08X}:"
    ports = set()
    for line in lines:
        remote = line.split(maxsplit=3)[2]
        if remote.startswith(start):
            ports.add(int(remote.removeprefix(start), 16))
    return ports


def holder_of(port: int) -> int | None:
    """Return the user id of the process that has bound a UDP port of loopback, if it is listed."""
    local = f"{int.from_bytes(socket.inet_aton(LOOPBACK), sys.byteorder):08X}:{port:04X}"
    for line in udp_sockets() or ():
        columns = line.split()
        if columns[1] == local:
            return int(columns[7])
    return None


def reserve_port(host: str) -> socket.socket:
    """Return a socket with a free port, where a session can listen as long as it is open."""
    reserved = socket.socket()
    try:
        reserved.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        reserved.bind((host, 0))
    except OSError:
        reserved.close()
        raise
    return reserved


def address_of(group: int) -> str:
    """Return the address with which the sessions of a group are connected."""
    return f"127.{PRESENCE}.{group >> 8}.{group & 0xFF}"
