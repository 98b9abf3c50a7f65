"""`Session.close` waits for peers that read nothing, and for peers that do not answer.

Zenoh:
    In `close`, Zenoh waits until a peer that has stopped reading continues, or its connection is
    lost. It also waits for the answer of each peer with which it is just making a connection,
    whoever dialled. That takes ten seconds, or as long as `open_timeout` and `accept_timeout`
    allow.
Reported:
    https://github.com/eclipse-zenoh/zenoh/issues/2675
Seen in:
    1.5.1, 1.7.2, 1.8.0, 1.9.0, 1.10.2
Workaround:
    Such connections are cut: existing ones by `cut_stuck` before `close`, and those made meanwhile
    by `cut_unanswered`. This works on Linux only; elsewhere `close` takes as long as Zenoh waits,
    in a thread.
"""

from __future__ import annotations

import socket
import struct
import sys
import threading
from typing import TYPE_CHECKING, Final

from aionode._process.socket_queue import queued_bytes, unsent_bytes
from aionode.clock import perf_ns
from aionode.engine.transport.zenoh._defects import _switch
from aionode.engine.transport.zenoh._defects.lingering import stop_lingering
from aionode.engine.transport.zenoh.connections.sockets import (
    ACKED,
    RECEIVED,
    Descriptor,
    connections,
    cut,
    duplicates,
    info_of,
    number_in,
    polled_by_zenoh,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    import zenoh

__all__ = ["cut_stuck", "cut_unanswered"]

INTERNET: Final = {socket.AF_INET, socket.AF_INET6}
"""The address families of connections between hosts."""

STUCK_S: Final = 0.1
"""How long a peer may leave no room for pending bytes before nothing waits for it any more, in
seconds."""

FIRST_PAUSE_S: Final = 0.001
"""The time until the first check within that time, in seconds; each further one takes twice as
long. Most peers read within a millisecond."""

RESET: Final = struct.pack("ii", 1, 0)
"""SO_LINGER for a connection that is cut: pending bytes are dropped."""

ESTABLISHED: Final = 1
"""The first byte of ``struct tcp_info`` while both ends are connected."""

FIRST_BYTES: Final = 2048
"""Zenoh sends 34 bytes before it waits for an answer, and TLS less than this."""

ZENOH_LINGER: Final = struct.pack("ii", 1, 10)
"""SO_LINGER as Zenoh sets it."""


def is_mended() -> bool:
    """Return whether sockets can be found here, and the workaround is enabled."""
    return sys.platform.startswith("linux") and _switch.is_mended("closing")


def with_unsent_bytes(those: Iterable[Descriptor]) -> dict[Descriptor, int]:
    """Return the number of bytes that could not be sent yet, by socket, omitting zeros."""
    unsent = {descriptor: unsent_bytes(copy) for descriptor, copy in duplicates(those)}
    return {descriptor: size for descriptor, size in unsent.items() if size}


def unanswered() -> set[Descriptor]:
    """Return the sockets of connections being made with peers that do not answer.

    This covers all sessions of the process: the system does not distinguish them.
    """
    return {descriptor for descriptor, copy in duplicates(polled_by_zenoh()) if is_unanswered(copy)}


def is_unanswered(copy: socket.socket) -> bool:
    """Return whether a socket has Zenoh's options, is connected, and has received nothing."""
    if copy.type != socket.SOCK_STREAM or copy.family not in INTERNET:
        return False
    if copy.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8) != ZENOH_LINGER:
        return False
    info = info_of(copy)
    sent = number_in(info, ACKED) + queued_bytes(copy)
    return info[0] == ESTABLISHED and not number_in(info, RECEIVED) and sent <= FIRST_BYTES


def cut_unanswered(done: threading.Event) -> None:
    """Cut connections being made with peers that do not answer, until `done` is set.

    A session being closed waits ten seconds for each of them, and meanwhile redials those that it
    has lost. Runs in a thread.
    """
    silent: set[Descriptor] = set()
    while is_mended() and not done.wait(STUCK_S):
        before, silent = silent, unanswered()
        cut(before & silent, RESET)


def cut_stuck(session: zenoh.Session) -> None:
    """Cut connections that a session about to be closed would wait for.

    These are connections whose peers do not read, and connections being made with peers that do not
    answer; both are waited for as long as they may still do so. Runs in a thread.
    """
    if not is_mended():
        return
    own = connections(session)
    stop_lingering(own)
    unsent, silent = with_unsent_bytes(own), unanswered()
    ends_ns = perf_ns() + int(STUCK_S * 1e9)
    pause_s = FIRST_PAUSE_S
    while (unsent or silent) and (left_s := (ends_ns - perf_ns()) / 1e9) > 0:
        threading.Event().wait(min(pause_s, left_s))
        pause_s *= 2
        still = with_unsent_bytes(unsent)
        unsent = {each: size for each, size in unsent.items() if still.get(each, 0) >= size}
        silent = silent and silent & unanswered()
    cut({*unsent, *silent}, RESET)
