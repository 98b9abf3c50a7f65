"""Connect slots: processes that start together take their ports and connect one after another.

A process takes a slot by binding the loopback UDP port that stands for it. Unlike a lock file, the
port belongs to no user, and is released as soon as its process ends, however that happens.
"""

from __future__ import annotations

import asyncio
import os
import socket
import threading
from contextlib import asynccontextmanager, closing, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

from aionode.clock import perf_ns
from aionode.engine.transport.zenoh.connections.config import LOOPBACK, near
from aionode.engine.transport.zenoh.session.local_sessions import holder_of, listed

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Iterator, Sequence

    from aionode.engine.transport.network import Network

__all__ = ["connecting", "one_at_a_time"]

SLOT_S: Final = 3.0
"""How long a process waits for another that holds the slot without making progress, in seconds."""

FOREIGN_SLOT_S: Final = 0.3
"""How long a process waits while another user's process holds the slot, in seconds, as that may be
on purpose."""

FIRST_POLL_S: Final = 0.002
"""The first interval at which a process tries to take a slot, in seconds."""

POLL_GROWTH: Final = 1.5
"""Growth factor of that interval: with more processes waiting, each waits longer."""

LAST_POLL_S: Final = 0.03
"""The longest interval for a place in the list of sessions, in seconds; a slot is held for a
millisecond."""

LAST_CONNECTING_POLL_S: Final = 0.5
"""The longest interval for connecting, in seconds; a slot is held for up to a second."""

LOAD: Final = Path("/proc/loadavg")
"""Contains how many threads of this machine are running or runnable."""


@contextmanager
def one_at_a_time(port: int | None) -> Iterator[None]:
    """Serialize the choice of a free meeting port among the processes of this machine.

    Two that choose at the same moment would both choose the first port; the loser would have none,
    and not dial the winner either. Two that list each other would dial each other. Blocks.

    Args:
        port: The first meeting port; None if there is none.
    """
    if port is None:
        yield
        return
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as slot:
        wait = SlotWait((port,))
        poll_s = FIRST_POLL_S
        while not (takes(slot, port) or wait.is_over()):
            threading.Event().wait(poll_s)
            poll_s = min(poll_s * POLL_GROWTH, LAST_POLL_S)
        yield


@asynccontextmanager
async def connecting(network: Network) -> AsyncIterator[None]:
    """Limit how many processes of this machine connect at once: one for every two processors.

    Each is connected to all others. If a hundred start together, and all connect at once, each of
    the 4950 connections is made while hundreds of threads wait for a processor, and the first
    processes to be ready have to wait for the last ones. While a processor is idle, or if the
    machine does not list its sessions, or there is only one meeting port, nobody waits.
    """
    group = network.meeting_ports[0]
    others = listed(group) if near(network) else None
    ports = connecting_ports(network)
    if not (others and ports):
        yield
        return
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as slot:
        wait, poll_s = SlotWait(ports), FIRST_POLL_S
        while not (any(takes(slot, port) for port in ports) or is_idle()):
            await asyncio.sleep(poll_s)
            poll_s = min(poll_s * POLL_GROWTH, LAST_CONNECTING_POLL_S)
            if wait.is_over():
                before, others = others, listed(group)
                if wait.is_foreign or others == before:
                    break  # nobody has started meanwhile: those that hold slots are stuck
                wait = SlotWait(ports)
        yield


class SlotWait:
    """One process's wait for any of several slots.

    Attributes:
        is_foreign: Whether processes of other users have all slots.
    """

    def __init__(self, ports: Sequence[int]) -> None:
        self._ports = ports
        self._began_ns = perf_ns()
        self.is_foreign = False

    def is_over(self) -> bool:
        """Return whether this has taken long enough, given the users that hold the slots."""
        waited_s = (perf_ns() - self._began_ns) / 1e9
        if waited_s < FOREIGN_SLOT_S:
            return False
        own = None if not hasattr(os, "getuid") else os.getuid()
        self.is_foreign = not {holder_of(port) for port in self._ports} & {own, None}
        return self.is_foreign or waited_s >= SLOT_S


def connecting_ports(network: Network) -> tuple[int, ...]:
    """Return a port for each process that may connect now: one per two processors."""
    ports = (*network.meeting_ports[1:], *network.spare_ports)
    return ports[: max(processors() // 2, 1)]


def is_idle() -> bool:
    """Return whether a processor of this machine is idle, or may be as far as is known."""
    try:
        running, _, _ = LOAD.read_text("ascii").split()[3].partition("/")
        return int(running) <= processors()  # this thread is among the running ones
    except (OSError, ValueError, IndexError):  # a sandbox may hide it
        return True


def processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1


def takes(slot: socket.socket, port: int) -> bool:
    """Take the slot of a port if it is free, which the socket then holds; return whether it was."""
    with suppress(OSError):
        slot.bind((LOOPBACK, port))
        return True
    return False
