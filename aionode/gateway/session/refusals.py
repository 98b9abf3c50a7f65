"""What a gateway refuses, drops or reads late: each kind has a count and a log line.

All such places go through `Refusals`, mostly through `Session.note`.
"""

from __future__ import annotations

import enum
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from aionode._process.rated_lines import WAIT_NS, RatedLines
from aionode.clock import S_TO_NS
from aionode.errors import MessageError, RefusedError, escaped

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Identity
    from aionode.node import Node

__all__ = ["Refusal", "Refusals"]

MOST_LINES: Final = 10
"""Lines about clients of one name within `WAIT_NS`: others have lines of their own."""

MOST_PLACES: Final = 100
"""Places whose clients without a name have lines of their own; those of further ones share some."""

NOBODY: Final = ("", "")
"""The client of the lines that all share who have neither a name nor a place of their own."""

MOST_SUBJECTS: Final = 1_000
"""What is remembered of clients of all names: they may invent any subjects."""

MOST_TEXT: Final = 500
"""The longest subject or reason in a line, in characters."""


class Refusal(enum.Enum):
    """Why something was refused, dropped or is late; the value is its word for programs."""

    # The codes of RefusedError
    UNAUTHORIZED = "unauthorized"
    NOT_ALLOWED = "not_allowed"
    NOT_CONFIRMED = "not_confirmed"
    OUT_OF_LIMITS = "out_of_limits"
    HELD = "held"
    TOO_OLD = "too_old"
    TOO_LARGE = "too_large"
    TOO_FAST = "too_fast"
    TOO_MANY = "too_many"
    UNSUPPORTED = "unsupported"
    # Others
    INVALID = "invalid_message"
    """The client sent something that is not an op, or not a message of its type."""
    FAILED = "failed"
    """A request failed: no node knows the type, or nothing has answered."""
    IGNORED = "ignored"
    """It has no effect."""
    UNREADABLE = "unreadable"
    """A message for the client is not valid for its type."""
    SLOW = "slow"
    """Messages for the client were dropped because it reads too slowly."""
    LATE = "late"
    """The gateway reads the client later than it sends."""
    DISCONNECTED = "disconnected"
    """The gateway has ended the client's connection."""

    @classmethod
    def of(cls, error: Exception) -> Refusal:
        """Return the kind of an error."""
        if isinstance(error, RefusedError):
            return cls(error.code)
        return cls.INVALID if isinstance(error, MessageError) else cls.FAILED


@dataclass(slots=True)
class Window:
    """How many lines there were about one client in `WAIT_NS`, and how many there would have been.

    A client is all those of one name, or those without a name at one place.
    """

    until_ns: int
    lines: int = 0
    left_out: int = 0

    def has_room(self) -> bool:
        """Count one more line; return whether there may be so many."""
        if self.lines >= MOST_LINES:
            self.left_out += 1
            return False
        self.lines += 1
        return True


class Refusals:
    """Counts what is refused, dropped or late, by its kind, and warns of it.

    The first of each client and subject is said, and then how many more there were: after 10 s,
    20 s and so on. How many lines about a client were left out, as there were too many in
    `WAIT_NS`, is said before the next one that begins such a time.

    Args:
        node: The gateway's node, whose log it is.

    Attributes:
        counts: How many there were of each kind.
    """

    def __init__(self, node: Node) -> None:
        self.counts: Counter[Refusal] = Counter()
        self._node = node
        self._now_ns = node.context.time_base.steady_ns
        self._lines: RatedLines[tuple[tuple[str, str], str, Refusal, str]] = RatedLines(
            self._now_ns, MOST_SUBJECTS
        )
        self._windows: dict[tuple[str, str], Window] = {}

    def note(
        self, identity: Identity, way: str, kind: Refusal, subject: str, reason: str, count: int = 1
    ) -> None:
        """Count something, and warn of it.

        Args:
            identity: The client; one without a name if the policy does not know it.
            way: The way in, such as ``rosbridge``.
            kind: Why.
            subject: Which op, and about what. It is said again only after a while.
            reason: What happened, and what fits.
            count: How many there were.
        """
        self.counts[kind] += count
        now_ns, subject = self._now_ns(), subject[:MOST_TEXT]
        client = (identity.name, "" if identity.name else identity.place)
        window = self._window(client, now_ns)
        key = (client, way, kind, subject)
        more = self._lines.note(key, count, has_room=window.has_room)
        if more is None:
            return
        where = f"{identity.address or 'this process'}, {way}"
        text = f"{identity.name or 'unknown client'} ({where}): {subject}: {reason[:MOST_TEXT]}"
        # On one line, so that a name of a client cannot look like another line of the log.
        self._node.get_logger().warning(f"gateway: {escaped(' '.join(text.split()))}{more}")

    def _window(self, client: tuple[str, str], now_ns: int) -> Window:
        """Return the window of a client's lines; those that are over are told of and forgotten."""
        window = self._windows.get(client)
        if window is not None and now_ns < window.until_ns:
            return window
        for each in [key for key, old in self._windows.items() if now_ns >= old.until_ns]:
            self._tell_left_out(each, self._windows.pop(each).left_out)
        if client[1] and sum(1 for _, other in self._windows if other) >= MOST_PLACES:
            client = NOBODY
        return self._windows.setdefault(client, Window(now_ns + WAIT_NS))

    def _tell_left_out(self, client: tuple[str, str], count: int) -> None:
        """Log how many lines about a client were omitted in its window."""
        if count:
            name, place = client
            who = name or (f"unknown client ({place})" if place else "unknown clients")
            self._node.get_logger().warning(
                f"gateway: {escaped(who)}: {count} more lines in {WAIT_NS // S_TO_NS} s were left"
                f" out, as there are at most {MOST_LINES} about one client"
            )
