"""Zenoh's sockets: finds them among the process's descriptors, reads their state, cuts them.

No other descriptor is touched. To cut a connection means to shut down its socket, as a network
would.

Zenoh reveals the two addresses of each connection, but not its socket. Duplicating every descriptor
to query its addresses would do harm: closing a duplicate of a file drops the process's POSIX locks
on it, and with them an exclusive transaction of SQLite. So the system is asked: a netlink socket,
or
``/proc/self/net/tcp``, reveals the inode of a connection, and ``/proc/self/fd`` that of each
descriptor. Only a socket found this way is duplicated, and its inode is compared again before the
duplicate is used.

Zenoh does not reveal a connection that is still being made. The system reveals for which sockets an
epoll instance waits, and how: Zenoh's runtime does so differently from Python's event loops.

Only on Linux: nothing is found elsewhere, or where ``/proc`` is hidden.

A socket also reveals how many bytes its peer has accepted, and how many have arrived.
"""

from __future__ import annotations

import logging
import os
import re
import select
import socket
import struct
import sys
import threading
from contextlib import suppress
from stat import S_ISREG
from typing import TYPE_CHECKING, Final

import zenoh
from msgspec import Struct

from aionode._process.socket_queue import queued_bytes

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator
    from collections.abc import Set as AbstractSet

__all__ = [
    "Address",
    "Descriptor",
    "Pair",
    "arrived_bytes",
    "connections",
    "cut",
    "cut_participants",
    "duplicates",
    "find",
    "info_of",
    "number_in",
    "numbers",
    "pair_of",
    "polled_by_zenoh",
    "send_progress",
    "split_locator",
]

logger = logging.getLogger("aionode.transport.zenoh")

DESCRIPTORS: Final = "/proc/self/fd"
DETAILS: Final = "/proc/self/fdinfo"
CONNECTIONS: Final = ("/proc/self/net/tcp", "/proc/self/net/tcp6")

STREAMS: Final = {"tcp", "tls", "ws", "wss"}
"""The protocols of Zenoh that use one TCP connection per link."""

EVENT_POLL: Final = "anon_inode:[eventpoll]"

POLLED: Final = r"(?m)^tfd: +(\d+) events: +8000201d .* ino:([0-9a-f]+) "
"""A socket for which an epoll instance waits like that of Zenoh's runtime: for everything but
urgent data (IN, OUT, ERR, HUP, RDHUP), edge-triggered (ET)."""

SOCK_DIAG: Final = 4
"""The netlink protocol for information about sockets; see sock_diag(7)."""

SOCK_DIAG_BY_FAMILY: Final = 20
NLM_F_REQUEST: Final = 1
ANY_STATE: Final = 0xFFF
NO_COOKIE: Final = b"\xff" * 8

HEADER: Final = struct.Struct("=IHHII")
"""``struct nlmsghdr``: length, type, flags, sequence number, port."""

REQUEST: Final = struct.Struct("=BBBxI")
"""The start of ``struct inet_diag_req_v2``: family, protocol, extensions, states."""

ADDRESSES: Final = struct.Struct("!HH16s16s")
"""The start of ``struct inet_diag_sockid``: both ports, the local address, the remote one."""

ANSWER: Final = struct.Struct("=4x36s12x16xI")
"""``struct inet_diag_msg``: its `ADDRESSES`, and the inode at its end."""

ACKED: Final = slice(120, 128)
"""Place in ``struct tcp_info`` of the number of bytes acknowledged by the peer's system."""

RECEIVED: Final = slice(128, 136)
"""Place in ``struct tcp_info`` of the number of bytes received."""

NO_LINGER: Final = struct.pack("ii", 0, 0)
"""SO_LINGER for connections that are closed immediately, while the system keeps sending."""

Address = tuple[bytes, int]
"""An IP address of 4 or 16 bytes, and a port."""

Descriptor = tuple[int, int]
"""The numbers of a descriptor and its inode, as the former is reused."""

lock = threading.Lock()  # held to read and change `known`
known: dict[Pair, Descriptor] = {}
"""Descriptors of connections found before, so that most searches read neither list."""

holders: dict[int, Pair] = {}
"""The connection that was last found at each descriptor's number."""


class Pair(Struct, frozen=True):
    """The two addresses of a connection."""

    local: Address
    remote: Address


def pair_of(link: zenoh.Link) -> Pair | None:
    """Return the addresses of a connection; None if it is not TCP."""
    local, remote = address_in(str(link.src)), address_in(str(link.dst))
    return Pair(local, remote) if local and remote else None


def address_in(locator: str) -> Address | None:
    """Return the address in a TCP locator such as ``tcp/127.0.0.1:7447?…``."""
    where = split_locator(locator)
    if where is None or locator.partition("/")[0] not in STREAMS:
        return None
    host, port = where
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with suppress(OSError):  # a name; Zenoh's connections have numeric ones
        return socket.inet_pton(family, host), port
    return None


def split_locator(locator: str) -> tuple[str, int] | None:
    """Return host and port of a locator; None if there is no port."""
    text = re.split("[?#]", locator.partition("/")[2], maxsplit=1)[0]
    host, _, port = text.rpartition(":")
    return (host.strip("[]").partition("%")[0], int(port)) if host and port.isdigit() else None


def connections(
    session: zenoh.Session, participants: AbstractSet[str] | None = None
) -> dict[Descriptor, zenoh.Link]:
    """Return a session's open sockets, each with Zenoh's information about it.

    Empty if the system does not reveal them. It may take some milliseconds, so it is not for the
    event loop.

    Args:
        session: The session.
        participants: Only connections to these; None for all.
    """
    if not sys.platform.startswith("linux"):
        return {}
    links = {
        pair: link
        for link in session.info.links()
        if participants is None or str(link.zid) in participants
        if (pair := pair_of(link))
    }
    return {descriptor: links[pair] for pair, descriptor in find(links).items()}


def find(pairs: Collection[Pair]) -> dict[Pair, Descriptor]:
    """Return the open sockets of some connections.

    It may take some milliseconds, so it is not for the event loop.
    """
    with lock:
        result = {pair: known[pair] for pair in pairs if pair in known and is_open(known[pair])}
        missing = {pair for pair in pairs if pair not in result}
        for pair in missing:
            known.pop(pair, None)
        if missing and (inodes := inodes_of(missing)):
            sought = {inode: pair for pair, inode in inodes.items()}
            for number, inode in sockets():
                if found := sought.pop(inode, None):
                    known.pop(holders.get(number, found), None)  # closed: the number was reused
                    holders[number] = found
                    result[found] = known[found] = number, inode
                    if not sought:
                        break
        return result


def is_open(descriptor: Descriptor) -> bool:
    """Return whether a descriptor still refers to the same socket."""
    number, inode = descriptor
    with suppress(OSError):
        return target_of(number) == f"socket:[{inode}]"
    return False


def inodes_of(pairs: Collection[Pair]) -> dict[Pair, int]:
    """Return the inodes of some connections, omitting closed ones."""
    # A sandbox may forbid the query, and a kernel may not support it.
    return told_inodes(pairs) or listed_inodes(pairs)


def told_inodes(pairs: Iterable[Pair]) -> dict[Pair, int]:
    """Query the inode of each connection by netlink, which takes microseconds."""
    inodes = {}
    with suppress(OSError), socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, SOCK_DIAG) as system:
        for pair in pairs:
            (local, port), (remote, remote_port) = pair.local, pair.remote
            family = socket.AF_INET if len(local) == 4 else socket.AF_INET6
            addresses = ADDRESSES.pack(port, remote_port, local, remote)
            request = REQUEST.pack(family, socket.IPPROTO_TCP, 0, ANY_STATE)
            request += addresses + bytes(4) + NO_COOKIE
            size = HEADER.size + len(request)
            system.send(HEADER.pack(size, SOCK_DIAG_BY_FAMILY, NLM_F_REQUEST, 0, 0) + request)
            answer = system.recv(4096, socket.MSG_DONTWAIT)
            if HEADER.unpack_from(answer)[1] == SOCK_DIAG_BY_FAMILY:
                told, inode = ANSWER.unpack_from(answer, HEADER.size)
                # For a closed connection, the system returns the socket that listens there.
                if told == addresses and inode:
                    inodes[pair] = inode
    return inodes


def listed_inodes(pairs: Iterable[Pair]) -> dict[Pair, int]:
    """Look up the inode of each connection in the lists of all, which takes milliseconds."""
    sought = {(listed_form(pair.local), listed_form(pair.remote)): pair for pair in pairs}
    inodes = {}
    for path in CONNECTIONS:
        with suppress(OSError), open(path, "rb") as lines:  # noqa: PTH123 - a third faster
            for line in lines:
                _, local, remote, rest = line.split(maxsplit=3)
                pair = sought.get((local, remote))
                if pair is not None and (inode := int(rest.split(maxsplit=7)[6])):
                    inodes[pair] = inode  # 0 for a closed one
    return inodes


def listed_form(address: Address) -> bytes:
    """Return an address as in these lists: ``0100007F:1D17``, in native words."""
    packed, port = address
    words = (packed[at : at + 4] for at in range(0, len(packed), 4))
    text = "".join(f"{int.from_bytes(word, sys.byteorder):08X}" for word in words)
    return f"{text}:{port:04X}".encode()


def sockets() -> Iterator[Descriptor]:
    """Yield the sockets of this process, the highest number first: most new ones are there."""
    for number, target in descriptors():
        if target.startswith("socket:["):
            yield number, int(target[8:-1])


def descriptors() -> Iterator[tuple[int, str]]:
    """Yield the number of each descriptor of this process, and its target, from the last one."""
    for name in reversed(numbers()):
        with suppress(OSError):  # closed meanwhile
            yield int(name), target_of(name)


def numbers() -> list[str]:
    """Return the numbers of all descriptors of this process, which takes 0.5 µs for each."""
    try:
        return os.listdir(DESCRIPTORS)  # noqa: PTH208 - in half the time
    except OSError:  # no descriptors are left, or there is no /proc
        return []


def target_of(name: int | str) -> str:
    """Return a descriptor's target, without opening anything."""
    return os.readlink(f"{DESCRIPTORS}/{name}")  # noqa: PTH115 - in half the time


def polled_by_zenoh() -> set[Descriptor]:
    """Return the sockets for which an epoll instance waits as Zenoh's does.

    Those of other Rust libraries may be among them, those of Python are not.
    """
    polled: set[Descriptor] = set()
    for number, target in descriptors():
        if target == EVENT_POLL:
            with suppress(OSError), open(f"{DETAILS}/{number}") as details:  # noqa: PTH123
                text = details.read()
                polled.update(
                    (int(number), int(ino, 16)) for number, ino in re.findall(POLLED, text)
                )
    return polled


def duplicates(those: Iterable[Descriptor]) -> Iterator[tuple[Descriptor, socket.socket]]:
    """Yield a duplicate of each open socket.

    One duplicate is open at a time: several threads duplicating all sockets would soon exhaust the
    process's descriptors.
    """
    for descriptor in those:
        copy = duplicate(descriptor) if is_open(descriptor) else None
        if copy is not None:
            with copy:
                yield descriptor, copy


def duplicate(descriptor: Descriptor) -> socket.socket | None:
    """Duplicate a socket; return None if its number refers to something else by now."""
    number, inode = descriptor
    with suppress(OSError):  # closed meanwhile
        copy = os.dup(number)
        status = os.fstat(copy)
        if status.st_ino == inode:
            return socket.socket(fileno=copy)
        # It was closed and its number reused within microseconds. If by a file, the duplicate stays
        # open: closing it would drop the process's locks on that file.
        if not S_ISREG(status.st_mode):
            os.close(copy)
    return None


def info_of(copy: socket.socket) -> bytes:
    """Return the start of a connection's ``struct tcp_info``."""
    return copy.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, RECEIVED.stop)


def number_in(info: bytes, field: slice) -> int:
    """Return one of its numbers."""
    return int.from_bytes(info[field], sys.byteorder)


def arrived_bytes(session: zenoh.Session) -> dict[str, tuple[int, int]]:
    """Return the bytes that arrived from each peer, and those that Zenoh has not read yet.

    Empty if the system does not reveal them.
    """
    own = connections(session)
    if not own:
        return {}
    import fcntl
    import termios

    arrived = {}
    for descriptor, copy in duplicates(own):
        unread = fcntl.ioctl(copy, termios.FIONREAD, bytes(4))
        arrived[str(own[descriptor].dst)] = (
            number_in(info_of(copy), RECEIVED),
            int.from_bytes(unread, sys.byteorder),
        )
    return arrived


def send_progress(session: zenoh.Session, participant: str) -> tuple[bool, int] | None:
    """Return whether the socket to a peer has room, and how many bytes were written to it so far.

    None if there is no such socket, or the system does not reveal it.
    """
    for _, copy in duplicates(connections(session, {participant})):
        poll = select.poll()
        poll.register(copy, select.POLLOUT)
        return bool(poll.poll(0)), number_in(info_of(copy), ACKED) + queued_bytes(copy)
    return None


def cut(those: Iterable[Descriptor], linger: bytes = NO_LINGER) -> None:
    """Cut connections, as a network would.

    Args:
        those: Zenoh's sockets.
        linger: SO_LINGER; a different one if the peer must not receive what has been sent.
    """
    for _, copy in duplicates(those):
        with suppress(OSError):  # already lost
            logger.debug("%s: the connection is cut", copy.getpeername())
            copy.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
            copy.shutdown(socket.SHUT_RDWR)


def cut_participants(session: zenoh.Session, participants: AbstractSet[str]) -> None:
    """Cut the connections to some participants, in a thread."""
    with suppress(zenoh.ZError):  # the session was closed meanwhile
        cut(connections(session, participants))
