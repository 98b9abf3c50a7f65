"""Builds the graph of other contexts from their liveliness tokens."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import TYPE_CHECKING, Final

import zenoh
from msgspec import Struct

from aionode._process.later import Later
from aionode.clock import perf_ns
from aionode.engine.transport.send_thread import SendThread
from aionode.engine.transport.zenoh._session_state import Declaration
from aionode.engine.transport.zenoh.connections.handlers import direct, translated
from aionode.engine.wire._liveliness import PREFIX, is_node_token, node_token, parse_token
from aionode.graph import EndpointInfo, NodeInfo

if TYPE_CHECKING:
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.connections.connections import ConnectionChange

__all__ = ["NodeDeclaration", "Watcher", "participant_of"]

CHECK_S: Final = 2.0
"""Timeout for the tokens of others, in seconds; they take a millisecond."""

ATTEMPTS: Final = 5
"""Number of queries for tokens while answers lack those of this context."""

ANSWER_S: Final = 60.0
"""How long Zenoh waits for the tokens of all peers, in seconds; a frozen peer is cut long
before."""

FILL_S: Final = 5.0
"""Maximum delay until tokens that were ignored replace tokens that have gone, in seconds."""

SHOWN: Final = 200
"""Maximum number of characters of an unknown text to show."""


def participant_of(key: str) -> str:
    """Return the participant in a liveliness token; empty if there is none."""
    return key.split("/", 3)[2] if key.count("/") > 1 else ""


class NodeDeclaration(Declaration):
    """A node, which consists only of its token."""

    def __init__(self, state: SessionState, node: NodeInfo) -> None:
        super().__init__(state, node_token(state.domain_id, node))
        state.add(self)

    def declare_data(self, session: zenoh.Session) -> None:
        """Do nothing: nodes do not send or receive anything themselves."""

    def undeclare_data(self) -> None:
        """Do nothing: there is nothing to withdraw."""


class Answer:
    """The end of a query for all tokens.

    Attributes:
        answered: The future that waits for it.
        complete: Whether no reply is missing.
    """

    def __init__(self, answered: asyncio.Future[bool]) -> None:
        self.answered = answered
        # Zenoh's thread sets it before it reports the end, after which the loop reads it.
        self.complete = True

    def take(self, reply: zenoh.Reply) -> None:
        """Record a failure, in a Zenoh thread, before the end is reported."""
        if reply.ok is None:
            self.complete = False


class Check:
    """A query for all tokens, whose replies are compared with the known ones.

    Attributes:
        tokens: The tokens in the replies.
        changed: Tokens declared or undeclared meanwhile; replies may be older.
        failed: Whether replies may be missing.
        attempt: The number of the attempt, from 1.
    """

    def __init__(self, attempt: int) -> None:
        self.attempt = attempt
        self.tokens: set[str] = set()
        self.changed: set[str] = set()
        # The querying thread may set it, but only before it puts the check into the queue from
        # which the loop takes it, so the two never access it at the same time.
        self.failed = False


class Change(Struct, frozen=True):
    """The declaration or undeclaration of a token.

    Attributes:
        key: The token.
        present: Whether it is declared.
    """

    key: str
    present: bool


class Watcher:
    """Keeps the graph up to date with the tokens of other contexts.

    Attributes:
        newest_ns: When the newest token arrived, or was asked for, by `perf_ns`.
    """

    def __init__(self, state: SessionState) -> None:
        self.newest_ns = 0
        self._state = state
        self._tokens = f"{PREFIX}/{state.domain_id}/**"
        self._node_tokens = f"{PREFIX}/{state.domain_id}/*/*/*/NN/**"
        self._check: Check | None = None
        self._missing: set[str] = set()
        self._known: dict[str, NodeInfo | EndpointInfo] = {}
        self._filling = Later()
        self._subscriber: zenoh.Subscriber[None] | None = None
        self._asking = SendThread("aionode-graph", state.waker)
        self._queue = state.queue(self._take)
        state.connections.on_change.append(self._take_change)

    def start(self, session: zenoh.Session) -> None:
        """Subscribe to the tokens; existing ones arrive immediately."""
        with translated("the graph"):
            self._subscriber = session.liveliness().declare_subscriber(
                self._tokens, direct(self._hand_over), history=True
            )

    def stop(self) -> None:
        """Unsubscribe, and forget all tokens."""
        if self._subscriber is not None:
            self._subscriber.undeclare()
            self._subscriber = None
        self._filling.cancel()
        self._asking.abandon()
        self._queue.clear()
        self._state.announced.clear()
        self._check = None
        self._missing = set()
        self._known.clear()

    def ask(self, session: zenoh.Session, answered: asyncio.Future[bool]) -> None:
        """Resolve `answered` once the tokens of all connected peers are in the graph.

        The result is False if some may be missing because a peer has not answered in time.
        """
        self.newest_ns = perf_ns()  # from now on the first one is waited for as well
        answer = Answer(answered)
        # A peer answers the subscriber first, over the same connection: only the end of the replies
        # matters, and whether one failed. A reply for each endpoint would cost every peer as much
        # as the subscriber does.
        session.liveliness().get(
            self._node_tokens,
            direct(answer.take, lambda: self._queue.put(answer)),
            timeout=ANSWER_S,
        )

    def knows(self, key: str) -> bool:
        """Return whether a token is in the graph, is this context's own, or may be ignored."""
        return (
            key in self._known
            or participant_of(key) == self._state.participant
            or self._state.announced.left_out > 0
        )

    def node_tokens(self) -> set[str]:
        """Return the tokens of all known nodes, including those of this context."""
        own = {token for token in self._state.own_tokens() if is_node_token(token)}
        return own | {token for token, info in self._known.items() if isinstance(info, NodeInfo)}

    def check(self, attempt: int = 1) -> None:
        """Compare the graph with the existing tokens, and correct it.

        While connections break and are re-established, Zenoh may deliver the end of a token on the
        old one after its declaration on the new one. At the same time its replies may lack existing
        tokens: one is removed if it is missing twice, and its context is not connected. Replies
        without the tokens of this context are ignored, and the query is repeated.
        """
        session = self._state.session
        if session is None or self._check is not None:
            return
        check = self._check = Check(attempt)
        self._asking.submit(partial(self._ask_all, session, check))

    def _ask_all(self, session: zenoh.Session, check: Check) -> None:
        """Query in a thread: Zenoh takes 0.2 ms per known token before it returns."""
        try:
            session.liveliness().get(
                self._tokens,
                direct(self._queue.put, lambda: self._queue.put(check)),
                timeout=CHECK_S,
            )
        except zenoh.ZError:  # the session was closed meanwhile
            check.failed = True
            self._queue.put(check)

    def _hand_over(self, sample: zenoh.Sample) -> None:
        """Queue a token for the loop; a sample would take three times as much memory."""
        self._queue.put(Change(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT))

    def _take(self, item: Change | zenoh.Reply | Check | Answer) -> None:
        if isinstance(item, Change):
            self.newest_ns = perf_ns()
            if self._check is not None:
                self._check.changed.add(item.key)
            if item.present:
                self._add(item.key)
            else:
                self._remove(item.key)
        elif isinstance(item, zenoh.Reply):
            if self._check is None:
                return
            if item.ok is None:
                self._check.failed = True
            else:
                self._check.tokens.add(str(item.ok.key_expr))
        elif isinstance(item, Check):
            self._end_check(item)
        else:
            self.newest_ns = perf_ns()
            if not item.answered.done():
                item.answered.set_result(item.complete)

    def _take_change(self, change: ConnectionChange) -> None:
        """Record the loss of a router: the tokens of everyone behind it go as well."""
        graph = self._state.graph
        if not change.is_made and change.kind == zenoh.WhatAmI.ROUTER and graph is not None:
            graph.router_lost_ns = perf_ns()

    def _end_check(self, check: Check) -> None:
        if check is not self._check:
            return
        self._check = None
        for key in check.tokens - check.changed:
            self._add(key)
        if check.failed or self._state.session is None:
            return
        if not self._state.own_tokens() <= check.tokens | check.changed:
            if check.attempt < ATTEMPTS:
                self.check(check.attempt + 1)
            return
        missing = self._known.keys() - check.tokens - check.changed
        for key in missing & self._missing:
            if key.split("/", 3)[2] not in self._state.connections.kinds:
                self._remove(key)
        self._missing = missing

    def _add(self, key: str) -> None:
        participant = participant_of(key)
        if key in self._known or participant == self._state.participant:
            return
        announced = self._state.announced
        if not announced.admit(participant, key):
            return
        if not self._show(key):
            announced.release(participant, key)

    def _show(self, key: str) -> bool:
        """Add a token to the graph; return whether it belongs there."""
        token = parse_token(key)
        if token is None:
            self._state.note_malformed(self._tokens, f"the liveliness token {key[:SHOWN]}")
        elif self._state.graph is not None:
            info = self._known[key] = token.info
            if isinstance(info, NodeInfo):
                self._state.graph.add_node(info)
            else:
                self._state.graph.add_endpoint(info)
                self._state.tell_writers(info, present=True)
            return True
        return False

    def _remove(self, key: str) -> None:
        info = self._known.pop(key, None)
        if info is None:
            return
        self._state.announced.release(participant_of(key), key)
        if self._state.announced.left_out and not self._filling.waits:
            self._filling.call(FILL_S, self._fill)
        if self._state.graph is None:
            return
        if isinstance(info, NodeInfo):
            self._state.graph.remove_node(info)
        else:
            self._state.graph.remove_endpoint(info)
            self._state.tell_writers(info, present=False)

    def _fill(self) -> None:
        """Query for what was ignored, as there is room again."""
        self._state.announced.begin_to_fill()
        self.check()
