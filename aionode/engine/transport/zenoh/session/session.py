"""Opens and closes Zenoh sessions without blocking the event loop."""

from __future__ import annotations

import asyncio
import logging
import os
import selectors
import socket
import threading
from contextlib import ExitStack, closing, suppress
from typing import TYPE_CHECKING, Final, TypeVar

import zenoh
from msgspec import Struct
from msgspec.structs import replace

from aionode._process.concurrency import running_loop
from aionode.clock import perf_ns
from aionode.engine.transport.network import network_from, pid_of
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh._defects.closing import cut_unanswered
from aionode.engine.transport.zenoh._defects.lingering import SocketOptions
from aionode.engine.transport.zenoh.connections.config import (
    LOOPBACK,
    load_config,
    near,
    probed_ports,
)
from aionode.engine.transport.zenoh.connections.handlers import reason
from aionode.engine.transport.zenoh.session.connect_slots import one_at_a_time
from aionode.engine.transport.zenoh.session.local_sessions import announce, listed, reserve_port
from aionode.engine.transport.zenoh.session.settings import (
    Neighbours,
    listening_address,
    router_settings,
    session_settings,
)
from aionode.errors import TransportError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.engine.transport.network import Network

__all__ = [
    "answering_ports",
    "close_session",
    "open_router",
    "open_session",
    "run_in_own_thread",
]

logger = logging.getLogger("aionode.transport.zenoh")

T = TypeVar("T")

PROBE_S = 0.2
"""Timeout for a port on this machine to accept a connection, in seconds; it takes 0.1 ms."""

SPEAK_S = 2.0
"""Timeout for an answer to Zenoh's first message, in seconds; it takes a millisecond.

An aionode process may take longer when many start at once. Other programs mostly answer or close
the connection immediately.
"""

CLOSE_S = 0.8
"""Maximum time that `close` takes, in seconds. With a frozen peer it continues in a thread."""


INIT: Final = 1
CLOSE: Final = 3
KIND: Final = 0x1F
"""Kinds of Zenoh messages, and the bits of the first byte that encode them."""

INIT_SYN: Final = bytes([INIT, 9, 0xF1])
"""The first message of a session: version 9, a peer, followed by its 16-byte id."""


def outcome_of(work: Callable[[], T]) -> tuple[T | None, BaseException | None]:
    """Return the result of `work`, or its exception."""
    try:
        return work(), None
    except BaseException as raised:  # noqa: BLE001  # raised by the caller
        return None, raised


async def run_in_own_thread(work: Callable[[], T], late: Callable[[T], object] | None = None) -> T:
    """Run `work` in a dedicated thread, and return its result.

    If cancelled, the result is passed to `late`, if given.
    """
    loop = running_loop()
    done: asyncio.Future[T] = (
        loop.create_future()
    )  # belongs to the loop; the thread calls `deliver` there

    def deliver(result: T | None, error: BaseException | None) -> None:
        if error is None and done.cancelled() and late is not None:
            start_thread(threading.Thread(target=late, args=(result,), name="aionode-zenoh"))
        elif not done.done():
            if error is None:
                done.set_result(result)  # type: ignore[arg-type]  # there is one without an error
            else:
                done.set_exception(error)

    def run() -> None:
        result, error = outcome_of(work)
        try:
            loop.call_soon_threadsafe(deliver, result, error)
        except RuntimeError:  # the loop was closed meanwhile
            if error is None and late is not None:
                late(result)  # type: ignore[arg-type]  # there is one without an error

    # Not a daemon, so that Python waits for it at exit: a thread inside Zenoh would abort the
    # process.
    thread = threading.Thread(target=run, name="aionode-zenoh")
    if not start_thread(thread):
        return work()
    try:
        return await done
    finally:
        if done.done() and not done.cancelled():
            thread.join()  # it has nothing left to do, and is gone when this returns


def answering_ports(ports: Iterable[int]) -> list[int]:
    """Return the given ports of this machine that accept a connection."""
    answering = []
    ends_ns = perf_ns() + int(PROBE_S * 1e9)
    # Not select(), which cannot handle descriptors above 1023.
    with ExitStack() as stack, selectors.DefaultSelector() as pending:
        for port in ports:
            probe = stack.enter_context(socket.socket())
            probe.setblocking(False)
            with suppress(BlockingIOError):
                # An immediate refusal is reported by the selector too.
                probe.connect_ex((LOOPBACK, port))
            pending.register(probe, selectors.EVENT_WRITE, (port, probe))
        while pending.get_map() and (left_s := (ends_ns - perf_ns()) / 1e9) > 0:
            for key, _ in pending.select(left_s):
                port, probe = key.data
                pending.unregister(probe)
                if probe.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR) == 0:
                    answering.append(port)
    return answering


def meeting(network: Network, answering: set[int]) -> tuple[Network, set[int]]:
    """Return a network with usable meeting ports, and those of them that are taken.

    Args:
        network: The settings of the context.
        answering: Those of its ports that accept a connection. If Zenoh answers at none of the
            meeting ports, these are removed, and spare ports where it does are added.
    """
    address = listening_address(network)
    taken = {port for port in network.meeting_ports if not can_listen(address, port)}
    if taken < set(network.meeting_ports):
        return network, taken
    if speaking_ports(taken):
        return network, taken
    answering -= taken
    spare = network.spare_ports
    spare_taken = {port for port in spare if not can_listen(address, port)}
    named = ", ".join(map(str, network.meeting_ports))
    met = speaking_ports(spare_taken)
    if met or spare_taken < set(spare):
        answering |= met
        logger.info(
            "other programs use the ports %s, on which processes of this machine meet: they meet "
            "on %s instead",
            named,
            ", ".join(map(str, spare)),
        )
    elif network.router_port not in answering:
        logger.warning(
            "other programs use the ports %s, on which processes of this machine meet: nodes of "
            "other processes will not be found without a router; `ss -ltnp` names the programs, "
            "and AIONODE_MEETING_PORTS, with three free ports, makes all processes meet elsewhere",
            ", ".join(map(str, (*network.meeting_ports, *spare))),
        )
    return replace(network, meeting_ports=network.meeting_ports + spare), taken | spare_taken


def can_listen(address: str, port: int) -> bool:
    """Return whether a port is free."""
    with socket.socket() as tried:
        if os.name == "posix":  # it has another meaning elsewhere
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind((address, port))
            tried.listen()
        except OSError:
            return False
    return True


def speaking_ports(ports: Iterable[int]) -> set[int]:
    """Return the ports of this machine where Zenoh answers; not all, if one answers immediately."""
    syn = INIT_SYN + os.urandom(16)
    speaking: set[int] = set()
    with ExitStack() as stack, selectors.DefaultSelector() as probes:
        for port in ports:
            with suppress(OSError):
                probe = socket.create_connection((LOOPBACK, port), SPEAK_S)
                probes.register(stack.enter_context(probe), selectors.EVENT_READ, (port, probe))
                probe.sendall(len(syn).to_bytes(2, "little") + syn)
        ends_ns = perf_ns() + int(SPEAK_S * 1e9)
        while probes.get_map() and not speaking and (left_s := (ends_ns - perf_ns()) / 1e9) > 0:
            for key, _ in probes.select(left_s):
                port, probe = key.data
                probes.unregister(probe)
                with suppress(OSError):
                    answer = probe.recv(3)
                    if len(answer) == 3 and answer[2] & KIND in (INIT, CLOSE):
                        speaking.add(port)
    return speaking


class Opened(Struct, frozen=True):
    """A session, and associated data.

    Attributes:
        session: The session.
        expected: Number of peers about to be connected.
        presence: Keeps it listed on this machine until closed; None if it is not listed.
        dialled: The ports of the other listed sessions.
        others: Number of all other sessions; None if there may be some that are not listed.
    """

    session: zenoh.Session
    expected: int
    presence: socket.socket | None
    dialled: set[int] = set()
    others: int | None = None

    def close(self) -> None:
        """Close both."""
        if self.presence is not None:
            self.presence.close()
        self.session.close()


async def open_session(network: Network, participant: str) -> Opened:
    """Open a session.

    Raises:
        ConfigurationError: the configuration cannot be used.
        TransportError: Zenoh cannot open a session.
    """

    def work() -> Opened:
        try:
            opened = open_listed(network, participant) if near(network) else None
            return opened or open_unlisted(network, participant)
        except zenoh.ZError as error:
            raise TransportError(
                f"Zenoh: no session could be opened: {reason(error)}; check "
                "ZENOH_SESSION_CONFIG_URI, ZENOH_CONFIG_OVERRIDE and Context(config=...)"
            ) from error

    return await run_in_own_thread(work, late=Opened.close)


def open_listed(network: Network, participant: str) -> Opened | None:
    """Open a session on a machine that lists its sessions, and dial the existing ones.

    Returns None if the machine has no list.
    """
    group = network.meeting_ports[0]
    address = listening_address(network)
    with closing(reserve_port(address)) as reserved, ExitStack() as failed:
        with one_at_a_time(group):
            there = listed(group)
            if there is None:
                return None
            free = (p for p in network.meeting_ports if p not in there and can_listen(address, p))
            mine = next(free, None)
            port = mine or reserved.getsockname()[1]
            presence = failed.enter_context(announce(group, port))
            # Listed again: one that got no slot may have come meanwhile, and if one has ended while
            # the list was read, another may be missing from it.
            others = (there | (listed(group) or set())) - {port}
        # Other programs may listen there, or aionode processes that cannot be listed.
        unlisted = set(
            answering_ports(p for p in probed_ports(network) if p not in {port, *others})
        )
        dialled = sorted(others | (unlisted & set(network.meeting_ports)))
        neighbours = Neighbours(port, tuple(dialled))
        # Routers cannot check processes, and announce them to other machines.
        has_router = network.router_port in unlisted or bool(network.far_peers)
        is_watched = pid_of(participant) is not None and not has_router
        settings = session_settings(network, (), neighbours, is_watched=is_watched)
        session = zenoh.open(load_config(network, settings, participant))
        failed.pop_all()
    met = others & set(network.meeting_ports)
    expected = len(met) + len(unlisted) + bool(network.near_peers)
    # Peers of other machines are introduced by gossip; overrides may name any.
    are_listed = not (unlisted or has_router or network.near_peers or network.may_reach_far)
    return Opened(session, expected, presence, others, len(others) if are_listed else None)


def open_unlisted(network: Network, participant: str) -> Opened:
    """Open a session that meets others at well-known ports, or is told where they are."""
    ports = probed_ports(network)
    with one_at_a_time(network.meeting_ports[0] if near(network) else None):
        answering = set(answering_ports(ports))
        used, taken = meeting(network, answering) if near(network) else (network, set())
        settings = session_settings(used, taken)
        session = zenoh.open(load_config(network, settings, participant))
    # Configured peers may be absent; one of them is waited for.
    configured = bool(network.near_peers or network.config_file)
    return Opened(session, len(answering) + configured, None)


async def open_router(listen: Iterable[str], connect: Iterable[str] = ()) -> zenoh.Session:
    """Open a router, like `rmw_zenohd`; `close_session` ends it.

    ``ZENOH_CONFIG_OVERRIDE`` is honoured, for TLS and access control.

    Args:
        listen: The Zenoh endpoints to listen on.
        connect: Endpoints of routers on other machines to link with; they may be absent.

    Raises:
        ConfigurationError: the override is invalid.
        TransportError: it cannot listen there, for example because another router does.
    """
    endpoints = list(listen)
    name = "ZENOH_CONFIG_OVERRIDE"
    network = network_from({name: os.environ.get(name, "")})

    def work() -> zenoh.Session:
        try:
            router = zenoh.open(load_config(network, router_settings(endpoints, connect)))
        except zenoh.ZError as error:
            raise TransportError(
                f"router on {', '.join(endpoints)}: {reason(error)}; "
                "is another router running there?"
            ) from error
        SocketOptions(router)
        return router

    return await run_in_own_thread(work, late=lambda session: session.close())


async def close_session(session: zenoh.Session) -> None:
    """Close a session; if that takes too long, it continues in a thread."""

    def work() -> None:
        done = threading.Event()
        # Connections may have started after `cut_stuck`, and others start meanwhile.
        cutting = threading.Thread(target=cut_unanswered, args=(done,), name="aionode-zenoh")
        is_cutting = start_thread(cutting)
        try:
            session.close()
        except zenoh.ZError as error:
            logger.debug("session: not closed properly: %s", error)
        finally:
            done.set()
            if is_cutting:
                cutting.join()

    with suppress(TimeoutError):
        async with asyncio.timeout(CLOSE_S):
            await run_in_own_thread(work)
