"""The connections of a session: the routers, peers and clients at their other ends.

Zenoh reports each connection made or lost to one place, which informs all parts of the context, on
the event loop, in the order in which they were added.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

import zenoh
from msgspec import Struct

from aionode.clock import perf_ns
from aionode.engine.transport.loop_waker import ThreadsafeQueue
from aionode.engine.transport.zenoh.connections.handlers import direct, translated

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.loop_waker import LoopWaker

__all__ = ["ConnectionChange", "Connections"]

FIRST_LINK_S: Final = 1.0
"""How long `open` waits for the first peer that accepts connections, in seconds; a frozen peer
never answers."""

NEXT_LINK_S: Final = 0.3
"""How long `open` waits for each further peer, in seconds."""

QUIET_S: Final = 0.015
"""All peers are assumed to be connected after this long without a new one, in seconds, where their
number is not known."""

QUIETS: Final = 16
"""How many times as long `open` waits for a further one that is known to be there: 0.24 s. They are
counted, as a busy machine may not run this process for that long."""

LISTED_S: Final = 3.0
"""How long it waits for those in all, in seconds, however many connect one after another."""

MOMENT_NS: Final = 10_000_000_000
"""Time after the loss of a connection in which what was declared over it may return."""

REMEMBERED: Final = 10_000
"""Number of lost sessions to remember: others may open and close any number."""


class ConnectionChange(Struct, frozen=True):
    """A connection that was made or lost.

    Attributes:
        zid: The id of the session at its other end.
        kind: The kind of that session: router, peer or client.
        is_made: Whether it was made; otherwise it was lost.
        is_return: Whether it was made again after being lost.
    """

    zid: str
    kind: zenoh.WhatAmI
    is_made: bool
    is_return: bool = False


class Connections:
    """The connections of one session, shared by all parts of a context.

    Zenoh's threads only append to the queue; all attributes belong to the event loop.

    Args:
        waker: Wakes the event loop from Zenoh's threads.
        waits_for_link: Returns whether a connection counts only once its link is reported as well.

    Attributes:
        kinds: The kind of each connected session, by its id.
        lost: The routers and peers whose connection was lost and not made again; clients reconnect
            themselves.
        on_change: Called with each change, after `kinds` and `lost` are updated.
    """

    def __init__(self, waker: LoopWaker, waits_for_link: Callable[[zenoh.Transport], bool]) -> None:
        self.kinds: dict[str, zenoh.WhatAmI] = {}
        self.lost: set[str] = set()
        self.on_change: list[Callable[[ConnectionChange], None]] = []
        self._queue: ThreadsafeQueue[zenoh.TransportEvent | str] = ThreadsafeQueue(waker, self.take)
        self._waits_for_link = waits_for_link
        # The kinds of sessions whose connections are reported, but not their links.
        self._reported: dict[str, zenoh.WhatAmI] = {}
        self._lost_ns: dict[str, int] = {}  # when the connection to each session was last lost
        self._changed = asyncio.Event()
        self._listeners: list[Any] = []

    def start(self, session: zenoh.Session) -> None:
        """Start with a session's existing connections, and listen to changes."""
        self._changed = asyncio.Event()  # an event belongs to the loop that first waits for it
        with translated("connections"):
            self._listeners = [
                session.info.declare_transport_events_listener(direct(self._queue.put)),
                session.info.declare_link_events_listener(direct(self._hand_over)),
            ]
        # After the listeners: a connection in between is reported twice, which is harmless.
        for transport in session.info.transports():
            self._add(ConnectionChange(str(transport.zid), transport.whatami, is_made=True))

    def stop(self) -> None:
        """Stop listening, and forget all connections."""
        listeners, self._listeners = self._listeners, []
        for listener in listeners:
            listener.undeclare()
        self._queue.clear()
        self._reported.clear()
        self.kinds.clear()
        self.lost.clear()
        self._lost_ns.clear()

    def has_lost(self, zid: str) -> bool:
        """Return whether a connection is lost, or was lost and made again in the last seconds.

        What the other end had declared vanished with it, and may not have returned yet. Zenoh
        reports the loss later than what vanishes with it.
        """
        return zid in self.lost or perf_ns() - self._lost_ns.get(zid, -MOMENT_NS) < MOMENT_NS

    def _hand_over(self, event: zenoh.LinkEvent) -> None:
        """Queue the session of a new link, in a Zenoh thread."""
        if event.kind == zenoh.SampleKind.PUT:
            self._queue.put(str(event.link.zid))

    def take(self, event: zenoh.TransportEvent | str) -> None:
        """Handle Zenoh's event for one connection, or the session of a link, on the event loop."""
        if isinstance(event, str):
            kind = self._reported.pop(event, None)
            if kind is not None:
                self._take(event, kind, is_made=True)
            return
        transport = event.transport
        zid = str(transport.zid)
        is_made = event.kind == zenoh.SampleKind.PUT
        if is_made and self._waits_for_link(transport):
            self._reported[zid] = transport.whatami
        elif is_made or self._reported.pop(zid, None) is None:
            self._take(zid, transport.whatami, is_made=is_made)

    def _take(self, zid: str, kind: zenoh.WhatAmI, *, is_made: bool) -> None:
        change = ConnectionChange(zid, kind, is_made, is_made and zid in self.lost)
        self._add(change)
        self._changed.set()
        for call in self.on_change:
            call(change)

    def _add(self, change: ConnectionChange) -> None:
        if change.is_made:
            self.kinds[change.zid] = change.kind
            self.lost.discard(change.zid)
            return
        self.kinds.pop(change.zid, None)
        if len(self._lost_ns) >= REMEMBERED:
            self._lost_ns.clear()
        self._lost_ns[change.zid] = perf_ns()
        if change.kind != zenoh.WhatAmI.CLIENT:
            if len(self.lost) >= REMEMBERED:
                self.lost.clear()
            self.lost.add(change.zid)

    async def wait_until_connected(
        self, expected: int, others: int | None = None, missing: Callable[[], object] = bool
    ) -> None:
        """Wait until `expected` peers, and others dialled meanwhile, are connected.

        Gives up after about a second without the first, or a quarter of one without a further one.

        Args:
            expected: Number of peers that connect at once.
            others: Number of all peers, if it is known; otherwise those that come soon after one
                another are waited for.
            missing: Returns something true while a peer is known to be there, but not connected. It
                may take half a millisecond, so it is called only if nothing else decides.
        """
        if expected == 0 and not missing():
            return
        try:
            while (count := len(self.kinds)) < expected:
                async with asyncio.timeout(NEXT_LINK_S if count else FIRST_LINK_S):
                    await self._next()
            async with asyncio.timeout(FIRST_LINK_S if others is None else LISTED_S):
                quiet = 0
                while others is None or len(self.kinds) < others or missing():
                    count = len(self.kinds)
                    with suppress(TimeoutError):
                        async with asyncio.timeout(QUIET_S):
                            await self._next()
                    quiet = 0 if len(self.kinds) > count else quiet + 1
                    if quiet and (quiet == QUIETS or not missing()):
                        return
        except TimeoutError:
            return

    async def wait_longer(self, is_enough: Callable[[], bool], limit_s: float) -> None:
        """Wait until there are enough connections, for at most `limit_s`."""
        with suppress(TimeoutError):
            async with asyncio.timeout(limit_s):
                while not is_enough():
                    await self._next()

    async def _next(self) -> None:
        self._changed.clear()
        await self._changed.wait()
