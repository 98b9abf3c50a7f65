"""Has processes introduced again whose connection was lost while both live.

Zenoh dials the endpoints of its configuration for ever, but somebody whom gossip has introduced
only when gossip names it. A router or a peer does that whenever it is connected anew, and only
then: 3 ms after a process that was frozen has lost that connection, and perhaps before it has seen
that others are lost as well. Those are named too early, and never again.

So after a connection was lost we compare what we see with what whoever introduces sees: it is
asked for the tokens of the domain, by a second session that is open for some milliseconds. If it
sees somebody whom we do not, or to whom we have lost the connection, or does not see us, the
connection to it is cut, and Zenoh makes it anew at once.
"""

from __future__ import annotations

import asyncio
import logging
import os
import secrets
import socket
import threading
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import zenoh

from aionode.errors import ConfigurationError
from aionode.transport._zenoh_config import introducers, look_settings
from aionode.transport.zenoh._handlers import direct, translated
from aionode.transport.zenoh._session import load_config
from aionode.wire._liveliness import PREFIX as ROS_PREFIX

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from aionode.transport._zenoh_config import Network
    from aionode.transport.zenoh._session_state import SessionState

__all__ = ["Recovery", "is_look"]

logger = logging.getLogger("aionode.transport.zenoh")

LOOK_IDS: Final = "a10de10c"
"""How the ids of sessions begin that are open for one look only."""

FIRST_S: Final = 0.5
"""How long after a connection was lost, or made, we look; Zenoh needs some milliseconds."""

AGAIN_S: Final = 3.0
"""How often we look after that: one that was frozen comes back without telling us."""

WATCH_S: Final = 120.0
"""For how long after the last connection was lost."""

SURE_S: Final = 0.3
"""For how long somebody has to be missing. Who has just started is, for some milliseconds."""

ANSWER_S: Final = 1.0
"""How long the tokens may take to come; it takes a millisecond."""

ATTEMPTS: Final = 4
"""How often somebody is introduced again; some can be seen, but not be reached from here."""


CHECKS: Final = 3
"""How often the graph is compared after connections have come or gone."""


def is_look(zid: str) -> bool:
    """Whether a session is one of ours that is open for a moment, and subscribes to nothing."""
    return zid.startswith(LOOK_IDS) and len(zid) == 32


@dataclass(frozen=True, slots=True)
class Way:
    """A connection that we have dialled, and Zenoh dials again when it is lost."""

    zid: str
    source: tuple[str, int]
    target: tuple[str, int]
    endpoint: str


class Recovery:
    """Looks for processes that are not connected any more, though they live.

    Args:
        state: The connection of the context.
        network: Whom it dials.
        on_change: Called some times after connections have come or gone.
    """

    def __init__(
        self, state: SessionState, network: Network, on_change: Callable[[], None]
    ) -> None:
        self._state = state
        self._network = network
        self._on_change = on_change
        self._checks = 0
        self._changes = state.queue(self._take_change)
        self._looks = state.queue(self._take_look)
        self._listener: zenoh.TransportEventsListener[None] | None = None
        self._session: zenoh.Session | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._looking = False
        self._until_s = 0.0
        # Whose connection was lost, and not made anew. A router may bring what they send meanwhile,
        # but not always what we send.
        self._lost: set[str] = set()
        # How often those who are missing were introduced again.
        self._attempts: dict[str, int] = {}

    def start(self, session: zenoh.Session) -> None:
        """Begin to watch the connections of a session."""
        if not introducers(self._network):
            return  # nobody is dialled again
        self._session = session
        with translated("connections"):
            self._listener = session.info.declare_transport_events_listener(
                direct(self._changes.put)
            )

    def stop(self) -> None:
        """Watch no longer; a look that is under way ends by itself."""
        self._session = None
        listener, self._listener = self._listener, None
        if listener is not None:
            listener.undeclare()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        for queue in (self._changes, self._looks):
            queue.clear()
        self._looking = False
        self._until_s = 0.0
        self._attempts.clear()
        self._lost.clear()

    def _take_change(self, event: zenoh.TransportEvent) -> None:
        if event.transport.whatami == zenoh.WhatAmI.CLIENT:
            return  # it dials by itself
        self._checks = CHECKS
        now_s = asyncio.get_running_loop().time()
        zid = str(event.transport.zid)
        if event.kind == zenoh.SampleKind.DELETE:
            if now_s >= self._until_s:
                self._lost.clear()  # nobody looks for those any more
            self._until_s = now_s + WATCH_S
            self._lost.add(zid)
        else:
            self._lost.discard(zid)
            if now_s >= self._until_s:
                return
        self._look_in(FIRST_S)

    def _look_in(self, delay_s: float) -> None:
        """Look in a while; processes that saw the same end do not all look at once."""
        if self._timer is not None:
            self._timer.cancel()
        spread = 1 + int(self._state.participant[-4:], 16) / 0x10000
        self._timer = asyncio.get_running_loop().call_later(delay_s * spread, self._look)

    def _look(self) -> None:
        self._timer = None
        session = self._session
        if session is None or self._looking:
            return
        self._looking = True
        threading.Thread(
            target=self._look_in_thread, args=(session, set(self._lost)), name="aionode-zenoh"
        ).start()

    def _look_in_thread(self, session: zenoh.Session, lost: set[str]) -> None:
        missing: set[str] = set()
        with suppress(zenoh.ZError, ConfigurationError):
            way = way_to_introducer(session, self._network)
            if way is not None:
                missing = self._missing(session, way, lost)
                if missing:
                    threading.Event().wait(SURE_S)
                    missing &= self._missing(session, way, lost)
                missing = {zid for zid in missing if self._attempts.get(zid, 0) < ATTEMPTS}
                if missing:
                    cut(way)
        self._looks.put(missing)

    def _missing(self, session: zenoh.Session, way: Way, lost: set[str]) -> set[str]:
        """Return who is seen at the other end of a way and not here, or the other way round we."""
        there = self._seen_at(way)
        here = participants(session, self._state.domain_id)
        connected = {str(transport.zid) for transport in session.info.transports()}
        unseen = {self._state.participant} & here - there
        return (there - here) | (there & lost - connected) | unseen

    def _seen_at(self, way: Way) -> set[str]:
        """Return the participants that are seen at the other end of a way."""
        look_id = LOOK_IDS + secrets.token_hex(12)
        config = load_config(self._network, {}, look_id, look_settings(way.endpoint))
        with closing(zenoh.open(config)) as look:
            return participants(look, self._state.domain_id)

    def _take_look(self, missing: set[str]) -> None:
        self._looking = False
        if self._session is None:
            return
        self._attempts = {zid: self._attempts.get(zid, 0) + 1 for zid in missing} | {
            zid: count for zid, count in self._attempts.items() if count >= ATTEMPTS
        }
        if missing:
            logger.info(
                "processes %s live, but were not connected any more: connected anew",
                ", ".join(sorted(missing)[:5]),
            )
        if self._checks:
            self._checks -= 1
            self._on_change()
        if self._timer is None and asyncio.get_running_loop().time() < self._until_s:
            self._look_in(FIRST_S if missing else AGAIN_S)


def participants(session: zenoh.Session, domain_id: int) -> set[str]:
    """Return the participants of a domain that a session sees."""
    found = set()
    for tokens in (f"{ROS_PREFIX}/{domain_id}/*/*/*/NN/**", f"@aionode/{domain_id}/*/link/**"):
        for reply in session.liveliness().get(tokens, timeout=ANSWER_S):
            if reply.ok is not None:
                found.add(str(reply.ok.key_expr).split("/", 3)[2])
    return found


def way_to_introducer(session: zenoh.Session, network: Network) -> Way | None:
    """Return a connection to somebody who introduces others, a router if there is one."""
    routers = {str(zid) for zid in session.info.routers_zid()}
    ways = []
    dialled = {
        address: endpoint for endpoint in introducers(network) for address in addresses_of(endpoint)
    }
    for each in session.info.links():
        source, target = address_in(str(each.src)), address_in(str(each.dst))
        if source is not None and target in dialled:
            ways.append(Way(str(each.zid), source, target, dialled[target]))
    ways.sort(key=lambda way: way.zid not in routers)
    return ways[0] if ways else None


def address_in(locator: str) -> tuple[str, int] | None:
    """Return host and port of ``tcp/127.0.0.1:7447?…``, None if it has none."""
    text = locator.partition("/")[2].partition("?")[0].partition("#")[0]
    host, colon, port = text.rpartition(":")
    if not (colon and port.isdigit()):
        return None
    return host.strip("[]"), int(port)


def addresses_of(endpoint: str) -> Iterator[tuple[str, int]]:
    """Yield where an endpoint is, by number."""
    address = address_in(endpoint)
    if address is not None:
        with suppress(OSError):
            for *_, found in socket.getaddrinfo(*address, type=socket.SOCK_STREAM):
                yield str(found[0]), int(found[1])


def cut(way: Way) -> None:
    """End a connection of Zenoh's, as the network would."""
    for one in own_sockets():
        with closing(one), suppress(OSError):
            ends = one.getsockname()[:2], one.getpeername()[:2]
            if ends == (way.source, way.target):
                one.shutdown(socket.SHUT_RDWR)


def own_sockets() -> Iterator[socket.socket]:
    """Yield a second descriptor of each socket of this process, where the system lists them."""
    for folder in ("/proc/self/fd", "/dev/fd"):
        with suppress(OSError):
            names = [entry.name for entry in Path(folder).iterdir()]
            break
    else:
        return
    for name in names:
        with suppress(OSError, ValueError):
            descriptor = os.dup(int(name))
            try:
                one = socket.socket(fileno=descriptor)
            except OSError:
                os.close(descriptor)
                continue
            yield one
