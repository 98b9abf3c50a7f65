"""The tokens of aionode contexts, apart from the ROS graph, and unannounced peers.

An unannounced peer is a connected session with no such token and no ROS node.
"""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Any, Final

import zenoh

from aionode.engine.transport.base import LinkStatus
from aionode.engine.transport.send_thread import SendThread
from aionode.engine.transport.zenoh.connections.config import is_probe
from aionode.engine.transport.zenoh.connections.handlers import (
    BLOCK,
    DROP,
    LOOP_PRIORITY,
    RETRANSMIT_PRIORITY,
    direct,
    reason,
    translated,
)
from aionode.engine.wire._liveliness import PREFIX as ROS_PREFIX

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.connections.connections import ConnectionChange
    from aionode.engine.transport.zenoh.discovery.router_matching import RouterMatching
    from aionode.graph import EndpointInfo

__all__ = ["ZenohPeerDirectory"]

logger = logging.getLogger("aionode.transport.zenoh")

PREFIX: Final = "@aionode"

LINKS: Final = "links"
"""The end of the key on which a context publishes its links, one per line."""

LINKS_S: Final = 0.5
"""How long `link_status` waits for replies, in seconds; they take a millisecond."""


class ZenohPeerDirectory:
    """Tokens apart from the ROS graph, connected sessions, and retransmissions between contexts.

    A session is known once it has announced a node or an aionode context, in any domain: then it
    also announces its subscriptions. All others are unannounced peers, which may subscribe to
    anything: a connected session that has not announced itself, and a router, as the sessions
    behind it are not visible. What those subscribe to is only known for single keys:
    `RouterMatching`.

    Attributes:
        advertisement: The announcement of this context, as chunks of a key starting with the
            participant; None to announce and look for nothing.
        on_advertisement: Called with the advertisement of another context, and whether it exists.
        has_unannounced_peers: Whether a reachable peer does not announce its subscriptions.
        on_unannounced_peers: Called with `has_unannounced_peers` when it has changed.
        on_retransmit: Called with what other contexts have sent, in order for each of them.
    """

    def __init__(self, state: SessionState, router_matching: RouterMatching) -> None:
        self.advertisement: str | None = None
        self.on_advertisement: Callable[[str, bool], None] = ignore
        self.has_unannounced_peers = False
        self.on_unannounced_peers: Callable[[bool], None] = ignore
        self.on_retransmit: Callable[[bytes], None] = ignore
        self._state = state
        self._router_matching = router_matching
        # Whether there is an unannounced peer that is not a router.
        self._has_plain_peers = False
        self._prefix = f"{PREFIX}/{state.domain_id}/"
        self._tokens = state.queue(self._take_token)
        self._nodes = state.queue(self._take_node)
        self._connected = state.connections.kinds
        state.connections.on_change.append(self._take_change)
        self._retransmits = state.queue(self._take_retransmit)
        # The tokens of each session that has announced itself. A connected session stays here
        # without any: a context announces its subscriptions, with or without a node.
        self._known: dict[str, set[str]] = {}
        # Contexts that have announced unannounced peers seen only by them.
        self._hosts: set[str] = set()
        # The connected routers, and the connected sessions that have announced nothing. Searching
        # for them at each token would be quadratic.
        self._routers: set[str] = set()
        self._unknown: set[str] = set()
        self._declared: list[Any] = []
        self._warning: zenoh.LivelinessToken | None = None
        # The contexts linked with this one.
        self._linked: set[str] = set()
        self._queries = state.queue(self._take_query)
        self._answering = SendThread("aionode-links", state.waker)
        self._session: zenoh.Session | None = None

    def announce(self, session: zenoh.Session) -> None:
        """Declare the token, if there is one.

        Must be called before `Acknowledgements.start`: a context that acknowledges and announces no
        links counts as one without.
        """
        if self.advertisement is not None:
            with translated("links"):
                token = session.liveliness().declare_token(self._prefix + self.advertisement)
            self._declared = [token]

    def start(self, session: zenoh.Session) -> None:
        """Subscribe to the tokens of others; existing ones arrive immediately.

        Without links, there is nothing to look for.
        """
        self._state.acknowledgements.listen(has_links=self.advertisement is not None)
        if self.advertisement is None:
            return
        self._session = session
        liveliness = session.liveliness()
        with translated("links"):
            self._declared += [
                liveliness.declare_subscriber(
                    f"{PREFIX}/*/*/**", direct(self._tokens.put), history=True
                ),
                liveliness.declare_subscriber(
                    f"{ROS_PREFIX}/*/*/*/*/NN/**", direct(self._nodes.put), history=True
                ),
                session.declare_subscriber(
                    self._retransmit_key(self._state.participant), direct(self._retransmits.put)
                ),
                session.declare_queryable(
                    self._links_key(self._state.participant), direct(self._queries.put)
                ),
            ]
        for zid, kind in self._connected.items():
            self._connect(zid, kind)
        self._update()

    def stop(self) -> None:
        """Undeclare everything, and forget all peers."""
        self._session = None
        self._answering.abandon()
        self._linked.clear()
        self._warn(needed=False)
        declared, self._declared = self._declared, []
        for declaration in reversed(declared):
            declaration.undeclare()
        for queue in (self._tokens, self._nodes, self._retransmits, self._queries):
            queue.clear()
        self._known.clear()
        self._hosts.clear()
        self._routers.clear()
        self._unknown.clear()
        self._router_matching.stop()
        self._has_plain_peers = False
        self.has_unannounced_peers = False

    def contexts(self) -> set[str]:
        """Return the other contexts that have announced themselves, whether they answer or not."""
        return {
            zid
            for zid, keys in self._known.items()
            if any(key.startswith(PREFIX) for key in keys) and zid != self._state.participant
        }

    def retransmit(self, participant: str, data: bytes) -> None:
        """Send `data` to another context from a thread; it is not dropped while both are open.

        That context may be stalled, so the thread sends to no other.
        """
        session = self._session
        if session is not None:
            key = self._retransmit_key(participant)
            self._state.peer_senders.submit(
                participant, len(data), lambda: send(session, key, data)
            )

    def post(self, participant: str, data: bytes) -> None:
        """Send `data` to another context immediately, from any thread; it may be dropped."""
        session = self._session
        if session is not None:
            send(session, self._retransmit_key(participant), data, waits=False)

    def note_link(self, participant: str, on: bool) -> None:
        """Record whether there is a link to another context, for those that ask.

        A token per link would reach every context: with 100 contexts, each would get 4950.
        """
        if on:
            self._linked.add(participant)
        else:
            self._linked.discard(participant)

    def _take_query(self, query: zenoh.Query) -> None:
        """Tell a context which links there are, from a thread, as it may be stalled."""
        key = self._links_key(self._state.participant)
        links = "\n".join(sorted(self._linked))

        def answer() -> None:
            try:
                with query:
                    query.reply(key, links)
            except zenoh.ZError as error:  # the session was closed meanwhile
                logger.debug("%s: not answered: %s", key, reason(error))

        self._answering.submit(answer)

    async def link_status(self) -> LinkStatus:
        """Ask all contexts which links they offer and have; empty if no replies arrive in time."""
        session = self._state.session
        advertisements: set[str] = set()
        pairs: set[frozenset[str]] = set()
        if session is None:
            return LinkStatus(advertisements, pairs)
        answers = asyncio.Semaphore(0)

        def take(reply: zenoh.Reply | None) -> None:
            if reply is None:
                answers.release()
            elif reply.ok is not None:
                text = str(reply.ok.key_expr).removeprefix(self._prefix)
                participant, _, what = text.partition("/")
                if what == LINKS:
                    for other in reply.ok.payload.to_bytes().decode(errors="replace").split():
                        pairs.add(frozenset((participant, other)))
                else:
                    advertisements.add(text)

        queue = self._state.queue(take)
        handler = direct(queue.put, lambda: queue.put(None))
        session.liveliness().get(f"{self._prefix}*/link/**", handler, timeout=LINKS_S)
        handler = direct(queue.put, lambda: queue.put(None))
        session.get(self._links_key("*"), handler, target=zenoh.QueryTarget.ALL, timeout=LINKS_S)
        await answers.acquire()
        await answers.acquire()
        return LinkStatus(advertisements, pairs)

    def _links_key(self, participant: str) -> str:
        return f"{self._prefix}{participant}/{LINKS}"

    def may_be_heard(self, publisher: EndpointInfo, changed: Callable[[], None]) -> bool:
        """Return whether an unannounced peer may subscribe to what a publisher sends.

        Args:
            publisher: A publisher of this context.
            changed: Called when the answer may have changed, but `on_unannounced_peers` is not
                called.
        """
        if not self.has_unannounced_peers or self._has_plain_peers:
            return self.has_unannounced_peers
        return self._router_matching.may_match(self._state.names_of(publisher).key, changed)

    def forget(self, publisher: EndpointInfo, changed: Callable[[], None]) -> None:
        """Stop calling `changed`, as the publisher is closed."""
        self._router_matching.forget(self._state.names_of(publisher).key, changed)

    def _retransmit_key(self, participant: str) -> str:
        return f"{self._prefix}{participant}/post"

    def _take_retransmit(self, sample: zenoh.Sample) -> None:
        self.on_retransmit(sample.payload.to_bytes())

    # Peers

    def _take_token(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        present = sample.kind == zenoh.SampleKind.PUT
        participant, _, what = key.split("/", 2)[2].partition("/")
        if not self._note(participant, key, present=present):
            return
        if what == "strangers":
            if participant != self._state.participant and present:
                self._hosts.add(participant)
            else:
                self._hosts.discard(participant)
        elif what.startswith("link/") and key.startswith(self._prefix):
            if participant != self._state.participant:
                is_near = what == (self.advertisement or "").partition("/")[2]
                self._state.acknowledgements.note_links(
                    participant, is_near=is_near, present=present
                )
            self.on_advertisement(key.removeprefix(self._prefix), present)
        self._update()

    def _take_node(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        self._note(key.split("/", 3)[2], key, present=sample.kind == zenoh.SampleKind.PUT)
        self._update()

    def _note(self, zid: str, key: str, *, present: bool) -> bool:
        """Record a token of a session; return whether it counts, or is one too many."""
        keys = self._known.get(zid, set())
        if present and key not in keys:
            if not self._state.announced.admit(zid, key):
                return False
            self._known.setdefault(zid, keys).add(key)
        elif not present and key in keys:
            self._state.announced.release(zid, key)
            keys.discard(key)
            self._forget(zid)
        self._classify(zid)
        return True

    def _forget(self, zid: str) -> None:
        """Forget a session that announces nothing and is not connected."""
        if zid not in self._connected and not self._known.get(zid, True):
            del self._known[zid]

    def _connect(self, zid: str, kind: zenoh.WhatAmI) -> None:
        if kind == zenoh.WhatAmI.ROUTER:
            self._routers.add(zid)
        self._classify(zid)

    def _classify(self, zid: str) -> None:
        """Record whether a session is connected that has announced nothing."""
        if zid in self._connected and zid not in self._known and not is_probe(zid):
            self._unknown.add(zid)
        else:
            self._unknown.discard(zid)

    def _take_change(self, change: ConnectionChange) -> None:
        if self._session is None:
            return
        if change.is_made:
            self._connect(change.zid, change.kind)
        else:
            self._routers.discard(change.zid)
            self._forget(change.zid)
            self._classify(change.zid)
        self._update()

    def _update(self) -> None:
        """Update `has_unannounced_peers`, and call back if it has changed."""
        if self._session is None:
            return
        # All other contexts reach the clients of this session, but do not see them.
        self._warn(
            needed=any(self._connected[zid] == zenoh.WhatAmI.CLIENT for zid in self._unknown)
        )
        self._router_matching.set_routers(self._routers)
        had = self.has_unannounced_peers, self._has_plain_peers
        has_unannounced_peers = bool(self._unknown or self._hosts)
        self._has_plain_peers = bool(self._unknown - self._routers or self._hosts)
        self.has_unannounced_peers = has_unannounced_peers
        if had != (has_unannounced_peers, self._has_plain_peers):
            self.on_unannounced_peers(has_unannounced_peers)

    def _warn(self, *, needed: bool) -> None:
        """Announce whether this context has unannounced peers to other contexts."""
        if self._warning is not None and not needed:
            self._warning.undeclare()
            self._warning = None
        elif self._warning is None and needed and self._session is not None:
            with translated("links"):
                self._warning = self._session.liveliness().declare_token(
                    f"{self._prefix}{self._state.participant}/strangers"
                )


def send(session: zenoh.Session, key: str, data: bytes, *, waits: bool = True) -> None:
    """Send `data`, in a thread."""
    try:
        session.put(
            key,
            data,
            congestion_control=BLOCK if waits else DROP,
            priority=RETRANSMIT_PRIORITY if waits else LOOP_PRIORITY,
            allowed_destination=zenoh.Locality.REMOTE,
        )
    except zenoh.ZError as error:
        logger.debug("%s: not sent: %s", key, reason(error))


def ignore(*_: object) -> None:
    """Do nothing."""
