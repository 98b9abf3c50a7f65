"""Lists this machine's Zenoh sessions, using Linux's list of sockets.

Each session that other processes may dial connects a UDP socket, which sends nothing: the remote
address identifies the group of sessions, and the remote port is the one on which Zenoh listens.
``/proc/net/udp`` lists these sockets, so that a session knows all others before it is opened, and
dials them. They belong to a network namespace, as loopback does: a listed session can be dialled
whatever its user or container. A socket ends with its process, however that happens.

Unix sockets with abstract names would work too, but ``/proc/net/unix`` also lists all connections:
with a hundred linked processes it takes 8 ms to read, while all of them start and wait.

Zenoh's gossip would introduce the sessions too, but each one tells all its peers about each new
one: a hundred that start at once send half a million such messages. Where nothing is listed, that
is how sessions meet.
"""

from __future__ import annotations

import socket
import sys
from contextlib import suppress
from pathlib import Path
from typing import Final

from msgspec import Struct

from aionode._process.stopped import is_stopped
from aionode.engine.transport.network import udp_sockets
from aionode.engine.transport.zenoh.connections.config import LOOPBACK
from aionode.errors import escaped, shortened

__all__ = [
    "LocalProcess",
    "announce",
    "groups",
    "holder_of",
    "listed",
    "listening",
    "processes",
    "reserve_port",
]

PROCESSES: Final = Path("/proc")

TCP_SOCKETS: Final = (Path("/proc/net/tcp"), Path("/proc/net/tcp6"))

LISTENS: Final = "0A"
"""The state of a listening socket in these lists: TCP_LISTEN of Linux's net/tcp_states.h."""

COMMAND: Final = 100
"""Maximum number of characters of a command line to show."""

PRESENCE: Final = 97
"""The second byte of these addresses, all of which belong to loopback."""


def announce(group: int, port: int) -> socket.socket:
    """Register a session on this machine until the returned object is closed.

    Args:
        group: The first of the ports on which sessions meet; those with other ports do not meet.
        port: The port on which it listens on loopback.
    """
    presence = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    presence.bind((LOOPBACK, 0))
    with suppress(OSError):  # loopback is down, and nobody could dial it
        presence.connect((address_of(group), port))
    return presence


def listed(group: int) -> set[int] | None:
    """Return the ports of the listed sessions; None if the machine has no list."""
    lines = udp_sockets()
    if lines is None:
        return None
    start = address_in_list(group)
    ports = set()
    for line in lines:
        remote = line.split(maxsplit=3)[2]
        if remote.startswith(start):
            ports.add(int(remote.removeprefix(start), 16))
    return ports


def listening() -> set[int] | None:
    """Return the TCP ports at which processes listen; None if the machine does not list them."""
    paths = [path for path in TCP_SOCKETS if path.exists()]  # without IPv6, one of them
    try:
        lines = [line for path in paths for line in path.read_text("ascii").splitlines()[1:]]
    except OSError:  # a sandbox may hide it
        return None
    columns = (line.split(maxsplit=4) for line in lines)
    ports = {
        int(local.rpartition(":")[2], 16) for _, local, _, state, _ in columns if state == LISTENS
    }
    return ports if paths else None


def groups() -> set[int]:
    """Return the groups that have sessions on this machine, as far as it lists them."""
    found = set()
    for line in udp_sockets() or ():
        remote = line.split(maxsplit=3)[2].partition(":")[0]
        net, presence, high, low = int(remote, 16).to_bytes(4, sys.byteorder)
        if (net, presence) == (127, PRESENCE):
            found.add(high << 8 | low)
    return found


class LocalProcess(Struct, frozen=True):
    """The process of a listed session.

    Attributes:
        pid: Its id.
        command: Its command line, for display.
        is_stopped: Whether a signal or debugger has stopped it, so that it cannot answer.
    """

    pid: int
    command: str
    is_stopped: bool


def processes(group: int) -> dict[int, LocalProcess]:
    """Return the processes with listed sessions by port, as far as the system reveals them."""
    start = address_in_list(group)
    ports = {}
    for line in udp_sockets() or ():
        columns = line.split()
        if columns[2].startswith(start):
            ports[f"socket:[{columns[9]}]"] = int(columns[2].removeprefix(start), 16)
    found: dict[int, LocalProcess] = {}
    for folder in PROCESSES.iterdir() if ports else ():
        if folder.name.isdigit():
            with suppress(OSError):  # another user's, or it has ended
                for descriptor in (folder / "fd").iterdir():
                    port = ports.get(str(descriptor.readlink()))
                    if port is not None:
                        found[port] = process_in(folder)
    return found


def process_in(folder: Path) -> LocalProcess:
    """Return what the system reveals about a process."""
    command = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
    text = shortened(escaped(" ".join(command.split())), COMMAND)  # in one line
    return LocalProcess(int(folder.name), text, is_stopped(int(folder.name)))


def address_in_list(group: int) -> str:
    """Return the address of a group as in the list, up to the port."""
    address = int.from_bytes(socket.inet_aton(address_of(group)), sys.byteorder)
    return f"{address:08X}:"


def holder_of(port: int) -> int | None:
    """Return the user id of the process that has bound a loopback UDP port, if it is listed."""
    local = f"{int.from_bytes(socket.inet_aton(LOOPBACK), sys.byteorder):08X}:{port:04X}"
    for line in udp_sockets() or ():
        columns = line.split()
        if columns[1] == local:
            return int(columns[7])
    return None


def reserve_port(host: str) -> socket.socket:
    """Return a socket with a free port, on which a session can listen while it is open."""
    reserved = socket.socket()
    try:
        reserved.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        reserved.bind((host, 0))
    except OSError:
        reserved.close()
        raise
    return reserved


def address_of(group: int) -> str:
    """Return the address to which the sessions of a group are connected."""
    return f"127.{PRESENCE}.{group >> 8}.{group & 0xFF}"
