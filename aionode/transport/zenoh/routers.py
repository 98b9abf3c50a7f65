"""Who listens behind the routers that a session is connected to.

A session sees routers, but not who is connected to those. A router tells it in its admin space:
`@/<router>/router` has the sessions, and `@/<router>/router/subscriber/<key>` has who subscribes to
a key. The first is one answer, so it is asked for each time. The second is one answer for each key
that is subscribed to, so it is asked for only if the first has somebody unknown, or is news.
"""

from __future__ import annotations

import asyncio
import json
import logging
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import zenoh

from aionode.transport.zenoh.handlers import direct, reason

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.transport.zenoh.link import Link

__all__ = ["Routers"]

logger = logging.getLogger("aionode.transport.zenoh")

ANSWER_S: Final = 0.3
"""How long a router may take to answer; it takes a millisecond."""

AGAIN_S: Final = 1.0
"""How often routers are asked: nothing tells of a new subscription behind them."""


@dataclass(slots=True)
class Look:
    """One question to all routers, and the answers so far: by router, or by key."""

    closer: bool
    answers: dict[str, bytes] = field(default_factory=dict)
    failed: bool = False


@dataclass(slots=True)
class Seen:
    """What the routers have told.

    Attributes:
        answers: The answers, as they came.
        routers: Those whose answer could be read.
        unread: Those that others named, or that answered something else.
        behind: The sessions behind them.
        plugins: Whether one has plugins, which subscribe without a session.
    """

    answers: dict[str, bytes]
    routers: set[str] = field(default_factory=set)
    unread: set[str] = field(default_factory=set)
    behind: set[str] = field(default_factory=set)
    plugins: bool = False


class Routers:
    """Finds out whether there are strangers behind routers, while somebody wants to know.

    Args:
        link: The connection.
        is_known: Whether somebody announces the subscriptions of a session.
        on_answer: Called when `strangers` may have changed by what a router has said.
    """

    def __init__(
        self, link: Link, is_known: Callable[[str], bool], on_answer: Callable[[], None]
    ) -> None:
        self._domain_id = link.domain_id
        self._is_known = is_known
        self._on_answer = on_answer
        self._lane = link.lane(self._take)
        self._session: zenoh.Session | None = None
        self._connected: set[str] = set()
        self._watching = False
        self._timer: asyncio.TimerHandle | None = None
        self._look: Look | None = None
        self._again = False
        self._seen = Seen({})
        # Who subscribes to what ours may publish; None if nobody had to look.
        self._listeners: set[str] | None = None

    @property
    def strangers(self) -> bool:
        """Whether somebody unknown may listen. Without `watch`, behind a router always."""
        if not self._connected:
            return False
        seen = self._seen
        if seen.unread or not self._connected <= seen.routers:
            return True
        listeners = seen.behind if self._listeners is None else self._listeners
        return not all(map(self._is_known, listeners))

    @property
    def behind(self) -> set[str]:
        """The sessions behind routers, as far as these have told."""
        return self._seen.behind

    def start(self, session: zenoh.Session) -> None:
        """Ask in `session` from now on."""
        self._session = session

    def stop(self) -> None:
        """Ask no longer."""
        self.watch(on=False)
        self._session = None
        self._connected.clear()
        self._lane.clear()

    def connect(self, routers: Iterable[str]) -> None:
        """Note to which routers there is a connection, and ask them: the others may be new too."""
        self._connected = set(routers)
        self.ask()

    def watch(self, *, on: bool) -> None:
        """Begin to ask, now and each second, or end it and forget the answers."""
        if on == self._watching:
            return
        self._watching = on
        if on:
            self.ask()
            return
        self._look = None
        self._again = False
        self._seen = Seen({})
        self._listeners = None
        self._disarm()

    def ask(self) -> None:
        """Ask all routers, or once more after the question that is under way."""
        if not (self._watching and self._connected):
            self._disarm()
        elif self._look is not None:
            self._again = True
        else:
            self._disarm()
            self._query(Look(closer=False), "@/*/router")

    def _disarm(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _query(self, look: Look, key: str) -> None:
        if self._session is None:
            return
        lane = self._lane
        self._look = look

        def answered(reply: zenoh.Reply) -> None:
            lane.put((look, reply))

        try:
            self._session.get(
                key,
                direct(answered, lambda: lane.put((look, None))),
                target=zenoh.QueryTarget.ALL,
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=ANSWER_S,
                # Neither waits behind messages, here or in the router, nor holds the loop up.
                priority=zenoh.Priority.INTERACTIVE_HIGH,
                congestion_control=zenoh.CongestionControl.DROP,
            )
        except zenoh.ZError as error:
            logger.debug("%s: not asked: %s", key, reason(error))
            look.failed = True
            lane.put((look, None))

    def _take(self, item: tuple[Look, zenoh.Reply | None]) -> None:
        look, reply = item
        if look is not self._look:
            return
        if reply is None:
            self._finish(look)
        elif reply.ok is None:
            look.failed = True
        else:
            key = str(reply.ok.key_expr).removeprefix("@/")
            if not look.closer:
                key = key.partition("/")[0]
            look.answers[key] = reply.ok.payload.to_bytes()

    def _finish(self, look: Look) -> None:
        if not look.closer:
            news = look.answers != self._seen.answers
            doubtful = self.strangers
            self._seen = seen_in(look.answers)
            self._listeners = None
            unread = self._seen.unread or not self._connected <= self._seen.routers
            if not unread and (news or doubtful or self._seen.plugins or self.strangers):
                # Every expression that matches keys of this domain, such as `**`.
                self._query(Look(closer=True), f"@/*/router/subscriber/{self._domain_id}/**")
                return
        elif look.failed:
            self._seen.unread = set(self._seen.routers)
        else:
            self._listeners = listeners_in(look.answers)
        self._look = None
        self._on_answer()
        again, self._again = self._again, False
        if again:
            self.ask()
        elif self._watching and self._connected:
            self._timer = asyncio.get_running_loop().call_later(AGAIN_S, self.ask)


def seen_in(answers: dict[str, bytes]) -> Seen:
    """Return what routers say of their sessions."""
    seen = Seen(answers)
    named: set[str] = set()
    for router, text in answers.items():
        try:
            told = json.loads(text)
            for session in told["sessions"]:
                (named if session["whatami"] == "router" else seen.behind).add(session["peer"])
            seen.plugins |= bool(told.get("plugins"))
            seen.routers.add(router)
        except (ValueError, TypeError, KeyError, AttributeError):
            named.add(router)
    # A router behind a router has an answer of its own.
    seen.unread = named - seen.routers
    return seen


def listeners_in(answers: dict[str, bytes]) -> set[str]:
    """Return the sessions that subscribe, as routers say of each key."""
    listeners: set[str] = set()
    for key, text in answers.items():
        router = key.partition("/")[0]
        try:
            told = json.loads(text)
            sessions = {*told["peers"], *told["clients"]}
            own = router in told["routers"]
        except (ValueError, TypeError, KeyError):
            sessions, own = set(), True
        # One that subscribes for nobody does so for itself.
        listeners |= sessions or ({router} if own else set())
    return listeners
