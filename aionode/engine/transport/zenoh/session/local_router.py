"""Makes one process of this machine its router to static peers.

Zenoh routers do not forward messages between the peers of one router, as these are expected to
reach each other. Nodes listen on loopback only, so a node that dialled the router of another
machine would hear nothing behind it: each machine needs its own router, linked with those of
others. If there is none, the first process with static peers opens it; if there is one, a process
with static peers opens a router that links it with them, and accepts no peers.
"""

from __future__ import annotations

import logging
import os
import threading
from contextlib import closing, suppress
from typing import TYPE_CHECKING, Final

import zenoh

from aionode._process.later import Later
from aionode.clock import perf_ns
from aionode.engine.transport.network import is_near
from aionode.engine.transport.send_thread import start_thread
from aionode.engine.transport.zenoh._defects.lingering import SocketOptions
from aionode.engine.transport.zenoh.connections.config import LOOPBACK, load_config, open_probe
from aionode.engine.transport.zenoh.connections.handlers import reason
from aionode.engine.transport.zenoh.session.session import (
    answering_ports,
    close_session,
    run_in_own_thread,
)
from aionode.engine.transport.zenoh.session.settings import router_settings
from aionode.errors import ConfigurationError

if TYPE_CHECKING:
    from aionode.engine.transport.network import Network
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.connections.connections import ConnectionChange

__all__ = ["LocalRouter"]

logger = logging.getLogger("aionode.transport.zenoh")

ROUTER_IDS: Final = "a10de20c"
"""The id prefix of such routers."""

LINKED_S: Final = 1.0
"""How long `open` waits for the first static peer, in seconds; the peer may be absent."""

LINKED_POLL_S: Final = 0.005

TREES_S: Final = 0.25
"""How long routers take to exchange their tokens, in seconds; Zenoh itself waits 0.1 s."""

TAKE_OVER_S: Final = 0.3
"""Within this time after another process's router has ended, this process opens its own."""


class LocalRouter:
    """Links this machine with the static peers of a context, through a router if necessary.

    Args:
        state: The session state of the context.
        network: Its settings.
    """

    def __init__(self, state: SessionState, network: Network) -> None:
        self._state = state
        self._network = network
        self._router: zenoh.Session | None = None
        self._closed = True
        state.connections.on_change.append(self._take_change)
        self._later = Later()
        # Held to read and change `_router`, and while a router is opened, so that `close` finds it.
        # `close` sets `_closed` before it takes the lock: no router is opened after that.
        self._opening = threading.Lock()

    async def open(self) -> None:
        """Open a router if this machine needs one; return once it is linked, if that is soon.

        Raises:
            ConfigurationError: the configuration cannot be used.
        """
        if not self._network.far_peers:
            return
        self._closed = False
        await run_in_own_thread(self._open)

    async def close(self) -> None:
        """Close the router, if this process has one."""
        if self._closed:
            return
        self._closed = True
        self._later.cancel()
        router = await run_in_own_thread(self._give_up)
        if router is not None:
            await close_session(router)

    def _give_up(self) -> zenoh.Session | None:
        """Return the router, for the caller to close; runs in a thread, as it may be opening."""
        with self._opening:
            router, self._router = self._router, None
        return router

    def _take_change(self, change: ConnectionChange) -> None:
        """Replace another process's router when that has ended."""
        if change.is_made or not change.zid.startswith(ROUTER_IDS) or self._closed:
            return
        if not self._later.waits:
            delay_s = TAKE_OVER_S * int(self._state.participant[-4:], 16) / 0x10000
            self._later.call(delay_s, self._take_over)

    def _take_over(self) -> None:
        start_thread(threading.Thread(target=self._open_again, name="aionode-zenoh"))

    def _open_again(self) -> None:
        with suppress(ConfigurationError):  # it was valid before
            self._open()

    def _open(self) -> None:
        """Open a router unless another process has one; runs in a thread."""
        with self._opening:
            if self._closed or self._router is not None:
                return
            port = self._network.router_port
            there = self._router_at(port) if answering_ports((port,)) else ""
            if there.startswith(ROUTER_IDS):
                return
            here = f"tcp/{LOOPBACK}:{port}"
            settings = router_settings(
                [] if there else [here], (*self._network.far_peers, *([here] if there else ()))
            )
            config = load_config(self._network, {}, ROUTER_IDS + os.urandom(12).hex(), settings)
            try:
                router = self._router = zenoh.open(config)
            except zenoh.ZError as error:  # another process was faster
                logger.debug("%s: no router was opened: %s", here, reason(error))
                return
        SocketOptions(router)
        until_linked(router)

    def _router_at(self, port: int) -> str:
        """Return the id of the router at a port of this machine; "unknown" if it does not say."""
        with (
            suppress(zenoh.ZError),
            closing(open_probe(self._network, f"tcp/{LOOPBACK}:{port}")) as probe,
        ):
            for zid in probe.info.routers_zid():
                return str(zid)
        return "unknown"


def until_linked(router: zenoh.Session) -> None:
    """Wait until a router is linked with another machine, and knows what is there."""
    ends_ns = perf_ns() + int(LINKED_S * 1e9)
    while perf_ns() < ends_ns:
        with suppress(zenoh.ZError):  # it was closed meanwhile
            if any(not is_near(str(link.dst)) for link in router.info.links()):
                threading.Event().wait(TREES_S)
                return
        threading.Event().wait(LINKED_POLL_S)
