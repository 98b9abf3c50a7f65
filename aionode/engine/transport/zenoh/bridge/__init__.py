"""A transport for nodes on DDS behind `zenoh-bridge-ros2dds`.

A bridge announces itself, and has its own keys and tokens (`aionode.engine.wire._bridge`). The
endpoints here are those of `rmw_zenoh` with other names; `_placeholders` stand in for them until
the first bridge is seen.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.engine.transport.base import Registration, Transport
from aionode.engine.transport.zenoh.bridge._graph import BridgeWatcher
from aionode.engine.transport.zenoh.bridge._placeholders import (
    Placeholder,
    RequesterPlaceholder,
    WriterPlaceholder,
)
from aionode.engine.transport.zenoh.bridge._services import BridgeRequester, BridgeServer
from aionode.engine.transport.zenoh.bridge._state import BridgeState
from aionode.engine.transport.zenoh.bridge._topics import (
    BridgeReader,
    BridgeWriter,
    keeps_for_late_readers,
)

if TYPE_CHECKING:
    from aionode.clock import TimeBase
    from aionode.engine.transport.base import Reader, Requester, Serve, Writer
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["BridgeTransport"]

KNOWN_S = 0.3
"""How long `open` waits for the graph of connected bridges, in seconds; it takes a millisecond."""


class Unannounced(Registration):
    """A node, which is not announced to bridges."""

    def close(self) -> None:
        """Do nothing."""


class BridgeTransport(Transport):
    """Reaches nodes on DDS through the bridges connected to the Zenoh session of a context.

    Until a bridge is seen, nothing is declared for it.

    Args:
        session_state: The session state of the context, which must be open while this is.
        time_base: The time of the context; defaults to that of the machine.
    """

    def __init__(self, session_state: SessionState, time_base: TimeBase | None = None) -> None:
        self._session_state = session_state
        self._state = BridgeState(
            session_state.participant, session_state.domain_id, time_base, session_state.waker
        )
        self._state.follow(session_state.announced)
        self._state.drops = session_state.drops
        self._watcher = BridgeWatcher(session_state, self._state)

    def __repr__(self) -> str:
        return f"<BridgeTransport bridges={len(self._state.prefixes)}>"

    @property
    def dds_bridges(self) -> dict[str, bool]:
        """The Zenoh ids of the bridges, each with whether nodes on Fast DDS are behind it."""
        return {zid: zid in self._state.fast_dds for zid in self._state.prefixes}

    async def open(self, graph: Graph) -> None:
        """Look for bridges; return when the graphs of existing ones are known, if they answer."""
        session = self._session_state.session
        if session is not None:
            with suppress(TimeoutError):
                async with asyncio.timeout(KNOWN_S):
                    await self._watcher.start(session, graph)

    async def close(self) -> None:
        """Withdraw everything, within a second after `SessionState.flush`; the session stays."""
        await self._state.flush()
        self._watcher.stop()
        self._state.disconnect()

    async def all_known(self, quiet_s: float) -> bool:  # noqa: ARG002  # a bridge has its own limit
        """Ask the bridges for the nodes behind them."""
        await self._watcher.ask_for_nodes()
        return True

    def create_node(self, node: NodeInfo) -> Registration:  # noqa: ARG002  # not announced
        """Do nothing: a bridge shows our endpoints as its own."""
        return Unannounced()

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Declare a publisher once there is a bridge.

        One that keeps messages for late readers starts immediately: the bridge may be such a
        reader.
        """
        make = partial(BridgeWriter, self._state, endpoint, msg_type)
        is_needed = self._state.session is not None or keeps_for_late_readers(endpoint.qos)
        return make() if is_needed else WriterPlaceholder(self._state.placeholders, make)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Declare a subscription once there is a bridge."""
        make = partial(BridgeReader, self._state, endpoint, msg_type, reader)
        return (
            make()
            if self._state.session is not None
            else Placeholder(self._state.placeholders, make)
        )

    def create_server(
        self, endpoint: EndpointInfo, srv_type: type[Any], serve: Serve
    ) -> Registration:
        """Declare a server once there is a bridge."""
        make = partial(BridgeServer, self._state, endpoint, srv_type, serve)
        return (
            make()
            if self._state.session is not None
            else Placeholder(self._state.placeholders, make)
        )

    def create_requester(self, endpoint: EndpointInfo, srv_type: type[Any]) -> Requester:
        """Declare a client once there is a bridge."""
        make = partial(BridgeRequester, self._state, endpoint, srv_type)
        return (
            make()
            if self._state.session is not None
            else RequesterPlaceholder(self._state.placeholders, make)
        )
