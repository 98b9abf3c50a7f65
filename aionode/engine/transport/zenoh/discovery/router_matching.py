"""Detects whether sessions behind a router subscribe to our publishers' topics.

A publisher's own matching status does not reveal it, since linked subscriptions match too: they
stay subscribed over Zenoh, for publishers without a link. But a router tells a peer nothing about
other peers, as these are expected to be connected to each other. So there is an additional session
per router, a peer that is connected to nothing else and takes no part in gossip. The matching
status of its publishers covers the clients of that router, and what other routers announce.

Only declarations are used. The router's admin space would reveal it as well, but must not be
queried (`_defects.admin_space`).
"""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Final

import zenoh

from aionode._process.later import Later
from aionode._process.restart import doubled
from aionode.engine.transport.send_thread import SendThread
from aionode.engine.transport.zenoh.connections.config import open_probe
from aionode.engine.transport.zenoh.connections.handlers import direct, reason
from aionode.engine.transport.zenoh.session.session import CLOSE_S
from aionode.errors import ConfigurationError, TransportError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.engine.transport.network import Network
    from aionode.engine.transport.zenoh._session_state import SessionState

__all__ = ["RouterMatching"]

logger = logging.getLogger("aionode.transport.zenoh")

SETTLE_S: Final = 1.0
"""Delay of the session after the first query, in seconds.

A process that ends sooner, such as a command, costs the router nothing.
"""

AGAIN_S: Final = 1.0
"""Delay of the next attempt after a failure, in seconds; it doubles with each further failure."""

LAST_AGAIN_S: Final = 30.0

ANSWER_S: Final = 2.0
"""Timeout for the router's answer that it has handled all declarations, in seconds."""

FENCE: Final = "@aionode/fence"
"""A token that does not exist. The answer that there is none follows everything before it."""


class KeyMatching:
    """A publisher whose matching status concerns one key, and the listener to its changes."""

    def __init__(self, session: zenoh.Session, key: str, changed: Callable[[str], None]) -> None:
        self._key = key
        self._changed = changed
        self._publisher = session.declare_publisher(key, allowed_destination=zenoh.Locality.REMOTE)
        # It listens as long as it exists.
        self._listener = self._publisher.declare_matching_listener(direct(self._on_change))

    def _on_change(self, _: zenoh.MatchingStatus) -> None:
        self._changed(self._key)

    @property
    def excluded(self) -> bool:
        """Whether there certainly is no subscriber."""
        try:
            return not self._publisher.matching_status.matching  # type: ignore[attr-defined]  # no bool, as the stub says
        except zenoh.ZError:  # the session was closed meanwhile
            return False

    def undeclare(self) -> None:
        """Undeclare both, in a thread, as Zenoh may have to wait."""
        with suppress(zenoh.ZError):
            self._listener.undeclare()
            self._publisher.undeclare()


class RouterSession:
    """The session with one router, replaced by a new object when its connection is lost.

    Attributes:
        zid: The id of the router.
        failures: Number of consecutive failed attempts.
        known: What is known about each key; only used on the loop.
        declared: The keys that are known, or will be; only used on the loop.
        session: The session while it is open; only used in the thread.
        listener: Listens to the end of its connection; only used in the thread.
    """

    def __init__(self, zid: str, failures: int = 0) -> None:
        self.zid = zid
        self.failures = failures
        self.known: dict[str, KeyMatching] = {}
        self.declared: set[str] = set()
        # The thread of `RouterMatching` does everything with a session in order, so nothing is used
        # after `close`.
        self.session: zenoh.Session | None = None
        self.listener: zenoh.TransportEventsListener[None] | None = None

    def excludes(self, key: str) -> bool:
        """Return whether certainly no session behind the router subscribes to `key`."""
        matching = self.known.get(key)
        return matching is not None and matching.excluded

    def close(self, known: list[KeyMatching]) -> None:
        """Close the session, in the thread, where the last references to `known` also end."""
        session, self.session = self.session, None
        if session is not None:
            try:
                session.close()
            except zenoh.ZError as error:
                logger.debug("router %s: not closed properly: %s", self.zid, reason(error))
        known.clear()
        self.listener = None


class RouterMatching:
    """The sessions with all routers of a context.

    Args:
        state: The session state of the context.
        network: Its settings.
    """

    def __init__(self, state: SessionState, network: Network) -> None:
        self._state = state
        self._network = network
        self._routers: dict[str, RouterSession] = {}
        # Functions to call when the answer for a key may have changed; ordered sets.
        self._asked: dict[str, dict[Callable[[], None], None]] = {}
        self._changes = state.queue(self._take_change)
        self._declared = state.queue(self._take_declared)
        self._lost = state.queue(self._take_lost)
        self._thread = SendThread("aionode-routers", state.waker)
        self._later = Later()

    def set_routers(self, zids: Iterable[str]) -> None:
        """Set the ids of the routers to which the context is connected."""
        zids = set(zids)
        for zid in self._routers.keys() - zids:
            self._end(self._routers.pop(zid))
        for zid in zids - self._routers.keys():
            self._routers[zid] = RouterSession(zid)
            if self._asked:
                self._declare_in(SETTLE_S)

    def may_match(self, key: str, changed: Callable[[], None]) -> bool:
        """Return whether a session behind a router may subscribe to `key`.

        Args:
            key: The key of a publisher.
            changed: Called when the answer may have changed, until `forget`.
        """
        self._asked.setdefault(key, {})[changed] = None
        if any(key not in router.declared for router in self._routers.values()):
            self._declare_in(SETTLE_S)
        return not all(router.excludes(key) for router in self._routers.values())

    def forget(self, key: str, changed: Callable[[], None]) -> None:
        """Stop calling `changed`."""
        asked = self._asked.get(key)
        if asked is None:
            return
        asked.pop(changed, None)
        if not asked:
            del self._asked[key]
            for router in self._routers.values():
                self._drop(router, key)

    def _drop(self, router: RouterSession, key: str) -> None:
        matching = router.known.pop(key, None)
        if matching is not None:  # otherwise it is being declared, and dropped once known
            router.declared.discard(key)
            self._thread.submit(matching.undeclare)

    def stop(self) -> None:
        """End all sessions; `close` waits for that."""
        self._later.cancel()
        self.set_routers(())
        for queue in (self._changes, self._declared, self._lost):
            queue.clear()

    async def close(self) -> None:
        """Wait until all sessions are closed, if that is soon."""
        with suppress(TimeoutError):
            async with asyncio.timeout(CLOSE_S):
                await self._thread.flush()

    # On the loop

    def _declare_in(self, delay_s: float) -> None:
        if not self._later.waits:
            self._later.call(delay_s, self._declare_all)

    def _declare_all(self) -> None:
        """Declare a publisher for each requested key that has none yet."""
        session = self._state.session
        if session is None:
            return
        for router in self._routers.values():
            keys = self._asked.keys() - router.declared
            if keys:
                router.declared |= keys
                self._thread.submit(partial(self._declare, router, session, keys))

    def _end(self, router: RouterSession) -> None:
        """Forget what a router has reported, and close the session with it."""
        known = list(router.known.values())
        router.known.clear()
        self._thread.submit(partial(router.close, known))

    def _take_declared(self, item: tuple[RouterSession, dict[str, KeyMatching]]) -> None:
        """Record what is known about some keys from now on."""
        router, known = item
        if self._routers.get(router.zid) is not router:
            return  # its session is closed
        router.failures = 0
        router.known |= known
        for key in known:
            if key in self._asked:
                self._take_change(key)
            else:
                self._drop(router, key)

    def _take_lost(self, router: RouterSession) -> None:
        """Start over with a router whose session was lost, if it is still connected."""
        if self._routers.get(router.zid) is not router:
            return
        self._end(router)
        self._routers[router.zid] = RouterSession(router.zid, router.failures + 1)
        self._declare_in(doubled(AGAIN_S, router.failures, LAST_AGAIN_S))
        for key in list(self._asked):
            self._take_change(key)

    def _take_change(self, key: str) -> None:
        for changed in list(self._asked.get(key, {})):
            changed()

    # In the thread

    def _declare(self, router: RouterSession, session: zenoh.Session, keys: set[str]) -> None:
        """Declare publishers, and wait until the router has reported what they match."""
        try:
            if router.session is None:
                router.session = self._open(router, session)
            asked = router.session
            known = {key: KeyMatching(asked, key, self._changes.put) for key in keys}
            wait_for_answer(asked)
        except (zenoh.ZError, ConfigurationError, TimeoutError, TransportError) as error:
            logger.debug("router %s: what it announces is not known: %s", router.zid, error)
            self._lost.put(router)
        else:
            self._declared.put((router, known))

    def _open(self, router: RouterSession, session: zenoh.Session) -> zenoh.Session:
        """Open a session that is connected to the router, and to nothing else."""
        locators = [str(link.dst) for link in session.info.links() if str(link.zid) == router.zid]
        opened = open_probe(self._network, next(iter(locators), ""), mode="peer")

        def on_event(event: zenoh.TransportEvent) -> None:
            if event.kind == zenoh.SampleKind.DELETE:
                self._lost.put(router)

        router.listener = opened.info.declare_transport_events_listener(direct(on_event))
        if router.zid not in {str(transport.zid) for transport in opened.info.transports()}:
            opened.close()
            raise TransportError("not connected to it any more; another one may have its address")
        return opened


def wait_for_answer(session: zenoh.Session) -> None:
    """Wait until a router has reported everything requested so far.

    Raises:
        TimeoutError: it has not.
    """
    for reply in session.liveliness().get(FENCE, timeout=ANSWER_S):
        if reply.ok is None:
            raise TimeoutError("no answer in time")
