"""Who is connected, and which contexts of aionode say more of themselves than ROS asks for."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Any, Final

import zenoh

from aionode.transport.base import LinkStatus
from aionode.transport.zenoh._handlers import direct, reason, translated
from aionode.transport.zenoh._recovery import is_look
from aionode.wire._liveliness import PREFIX as ROS_PREFIX

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.transport.zenoh._session_state import SessionState

__all__ = ["ZenohPeerDirectory"]

logger = logging.getLogger("aionode.transport.zenoh")

PREFIX: Final = "@aionode"

LINKS_S: Final = 0.5
"""How long `links` waits for everybody's answers; it takes a millisecond."""


class ZenohPeerDirectory:
    """Tokens beside the ROS graph, the sessions that are connected, and a box for post.

    A session is known once it has announced a node or a context of aionode, in any domain: then
    it announces its subscriptions as well. Anybody else is a stranger, who may subscribe to
    anything: a session that is connected, as long as it has not announced itself; and a router,
    since nothing tells who is behind it. It could be asked through its admin space, but must not
    be: it holds its routing table's lock while it answers, and takes it once more for each reply.
    With a declaration in between it never lets go (zenoh 1.8 to 1.10, pull request 2619), and no
    newcomer of the whole system gets in any more.

    Attributes:
        advertisement: What to announce, as chunks of a key that begin with the participant; None
            for nothing, and then nothing is looked for either.
        on_advertisement: Called with what another context announces, and whether it is there.
        has_unannounced_peers: Whether somebody can be reached whose subscriptions nobody announces.
        on_unannounced_peers: Called with `has_unannounced_peers` when that has changed.
        on_retransmit: Called with what others have sent to this context; in order for each of them.
    """

    def __init__(self, state: SessionState) -> None:
        self.advertisement: str | None = None
        self.on_advertisement: Callable[[str, bool], None] = ignore
        self.has_unannounced_peers = False
        self.on_unannounced_peers: Callable[[bool], None] = ignore
        self.on_retransmit: Callable[[bytes], None] = ignore
        self._state = state
        self._prefix = f"{PREFIX}/{state.domain_id}/"
        self._tokens = state.queue(self._take_token)
        self._nodes = state.queue(self._take_node)
        self._changes = state.queue(self._take_change)
        self._retransmits = state.queue(self._take_retransmit)
        # The tokens of each session that has announced itself. It stays known without any while
        # it can be reached: a context announces its subscriptions, with a node or without.
        self._known: dict[str, set[str]] = {}
        # Contexts with strangers whom only they see.
        self._hosts: set[str] = set()
        self._connected: dict[str, zenoh.WhatAmI] = {}
        self._declared: list[Any] = []
        self._warning: zenoh.LivelinessToken | None = None
        # By the other context, in this session; only the thread that sends touches them.
        self._linked: dict[str, zenoh.LivelinessToken] = {}
        self._session: zenoh.Session | None = None

    def start(self, session: zenoh.Session) -> None:
        """Announce and listen; what exists already comes at once."""
        if self.advertisement is None:
            return
        self._session = session
        self._linked = {}
        liveliness = session.liveliness()
        with translated("links"):
            self._declared = [
                session.declare_subscriber(
                    self._retransmit_key(self._state.participant), direct(self._retransmits.put)
                ),
                liveliness.declare_subscriber(
                    f"{PREFIX}/*/*/**", direct(self._tokens.put), history=True
                ),
                liveliness.declare_subscriber(
                    f"{ROS_PREFIX}/*/*/*/*/NN/**", direct(self._nodes.put), history=True
                ),
                session.info.declare_transport_events_listener(direct(self._changes.put)),
                liveliness.declare_token(self._prefix + self.advertisement),
            ]
        self._connected = {
            str(transport.zid): transport.whatami for transport in session.info.transports()
        }
        self._update()

    def stop(self) -> None:
        """Announce nothing, and listen no longer."""
        self._session = None
        self._warn(needed=False)
        declared, self._declared = self._declared, []
        for one in reversed(declared):
            one.undeclare()
        for queue in (self._tokens, self._nodes, self._changes, self._retransmits):
            queue.clear()
        self._known.clear()
        self._hosts.clear()
        self._connected.clear()
        self.has_unannounced_peers = False

    def retransmit(self, participant: str, data: bytes) -> None:
        """Send `data` to another context, from a thread; nothing is dropped while both are open."""
        session = self._session
        if session is not None:
            key = self._retransmit_key(participant)
            self._state.bulk.submit(lambda: send(session, key, data))

    def announce_link(self, participant: str, on: bool) -> None:
        """Tell whoever asks that there is a link to another context, or no longer.

        Of the two the one with the smaller id does it. From a thread, since the other end may hang
        just now, and Zenoh may wait for it.
        """
        session, linked = self._session, self._linked
        if session is None or participant < self._state.participant:
            return
        key = f"{self._prefix}{self._state.participant}/linked/{participant}"

        def announce() -> None:
            token = linked.pop(participant, None)
            try:
                if token is not None:
                    token.undeclare()
                if on:
                    linked[participant] = session.liveliness().declare_token(key)
            except zenoh.ZError as error:  # it was closed meanwhile
                logger.debug("%s: not announced: %s", key, reason(error))

        self._state.bulk.submit(announce)

    async def link_status(self) -> LinkStatus:
        """Ask everybody who can be linked, and who is; without answers after a while, nobody."""
        session = self._state.session
        advertisements: set[str] = set()
        pairs: set[frozenset[str]] = set()
        if session is None:
            return LinkStatus(advertisements, pairs)
        answered: asyncio.Future[None] = asyncio.get_running_loop().create_future()

        def take(reply: zenoh.Reply | None) -> None:
            if reply is None:
                if not answered.done():
                    answered.set_result(None)
            elif reply.ok is not None:
                text = str(reply.ok.key_expr).removeprefix(self._prefix)
                participant, _, what = text.partition("/")
                if what.startswith("link/"):
                    advertisements.add(text)
                elif what.startswith("linked/"):
                    pairs.add(frozenset((participant, what.removeprefix("linked/"))))

        queue = self._state.queue(take)
        session.liveliness().get(
            f"{self._prefix}*/**", direct(queue.put, lambda: queue.put(None)), timeout=LINKS_S
        )
        await answered
        return LinkStatus(advertisements, pairs)

    def _retransmit_key(self, participant: str) -> str:
        return f"{self._prefix}{participant}/post"

    def _take_retransmit(self, sample: zenoh.Sample) -> None:
        self.on_retransmit(sample.payload.to_bytes())

    # Who is there

    def _take_token(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        present = sample.kind == zenoh.SampleKind.PUT
        participant, _, what = key.split("/", 2)[2].partition("/")
        self._note(participant, key, present=present)
        if what == "strangers":
            if participant != self._state.participant and present:
                self._hosts.add(participant)
            else:
                self._hosts.discard(participant)
        elif what.startswith("link/") and key.startswith(self._prefix):
            self.on_advertisement(key.removeprefix(self._prefix), present)
        self._update()

    def _take_node(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        self._note(key.split("/", 3)[2], key, present=sample.kind == zenoh.SampleKind.PUT)
        self._update()

    def _note(self, zid: str, key: str, *, present: bool) -> None:
        if present:
            self._known.setdefault(zid, set()).add(key)
        elif zid in self._known:
            self._known[zid].discard(key)
            self._forget(zid)

    def _forget(self, zid: str) -> None:
        """Forget a session that announces nothing and is not connected."""
        if zid not in self._connected and not self._known.get(zid, True):
            del self._known[zid]

    def _take_change(self, event: zenoh.TransportEvent) -> None:
        # `transports()` may still have one whose end is being told.
        zid = str(event.transport.zid)
        if event.kind == zenoh.SampleKind.PUT:
            self._connected[zid] = event.transport.whatami
        else:
            self._connected.pop(zid, None)
            self._forget(zid)
        self._update()

    def _of_kind(self, kind: zenoh.WhatAmI) -> set[str]:
        return {zid for zid, whatami in self._connected.items() if whatami == kind}

    def _update(self) -> None:
        """Find out whether there are strangers, and tell."""
        if self._session is None:
            return
        # A router announces nothing, and stays unknown.
        unknown = {zid for zid in self._connected if zid not in self._known and not is_look(zid)}
        # Everybody reaches the clients of this session, but nobody else sees them.
        self._warn(needed=bool(unknown & self._of_kind(zenoh.WhatAmI.CLIENT)))
        has_unannounced_peers = bool(unknown or self._hosts)
        if has_unannounced_peers != self.has_unannounced_peers:
            self.has_unannounced_peers = has_unannounced_peers
            self.on_unannounced_peers(has_unannounced_peers)

    def _warn(self, *, needed: bool) -> None:
        """Tell other contexts of strangers here, or no longer."""
        if self._warning is not None and not needed:
            self._warning.undeclare()
            self._warning = None
        elif self._warning is None and needed and self._session is not None:
            with translated("links"):
                self._warning = self._session.liveliness().declare_token(
                    f"{self._prefix}{self._state.participant}/strangers"
                )


def send(session: zenoh.Session, key: str, data: bytes) -> None:
    """Send post; in a thread."""
    try:
        session.put(
            key,
            data,
            congestion_control=zenoh.CongestionControl.BLOCK,
            allowed_destination=zenoh.Locality.REMOTE,
        )
    except zenoh.ZError as error:
        logger.debug("%s: not sent: %s", key, reason(error))


def ignore(*_: object) -> None:
    """Do nothing."""
