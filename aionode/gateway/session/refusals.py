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

MAX_LINES: Final = 10
"""Lines about clients of one name within `WAIT_NS`: others have lines of their own."""

MAX_PLACES: Final = 100
"""Places whose clients without a name have lines of their own; those of further ones share some."""

NOBODY: Final = ("", "")
"""The client name for log lines about all clients that have neither a name nor a place of their
own."""

MAX_SUBJECTS: Final = 1_000
"""Number of subjects remembered for each client, since clients may invent any."""

MAX_TEXT: Final = 500
"""The longest subject or reason in a line, in characters."""


class Refusal(enum.Enum):
    """Why something was refused, dropped or late; the value is the code for programs."""

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
    """The op has no effect."""
    UNREADABLE = "unreadable"
    """A message for the client is not valid for its type."""
    SLOW = "slow"
    """Messages for the client were dropped because it reads too slowly."""
    LATE = "late"
    """The gateway reads from the client more slowly than it sends."""
    DISCONNECTED = "disconnected"
    """The gateway has ended the client's connection."""

    @classmethod
    def of(cls, error: Exception) -> Refusal:
        """Return the kind of refusal for an error."""
        if isinstance(error, RefusedError):
            return cls(error.code)
        return cls.INVALID if isinstance(error, MessageError) else cls.FAILED


@dataclass(slots=True)
class Window:
    """The number of log lines about one client within `WAIT_NS`, written and omitted.

    A client here is everyone with one name, or everyone without a name at one place.
    """

    until_ns: int
    lines: int = 0
    left_out: int = 0

    def has_room(self) -> bool:
        """Count one more line; return whether it may be written."""
        if self.lines >= MAX_LINES:
            self.left_out += 1
            return False
        self.lines += 1
        return True


class Refusals:
    """Counts what is refused, dropped or late, by kind, and logs warnings.

    The first refusal for each client and subject is logged, and then how many more there were:
    after 10 s, 20 s and so on. If there were too many lines about a client within `WAIT_NS`, the
    number of omitted lines is logged before the first line of its next period.

    Args:
        node: The gateway's node, whose log is used.

    Attributes:
        counts: How many there were of each kind.
    """

    def __init__(self, node: Node) -> None:
        self.counts: Counter[Refusal] = Counter()
        self._node = node
        self._now_ns = node.context.time_base.steady_ns
        self._lines: RatedLines[tuple[tuple[str, str], str, Refusal, str]] = RatedLines(
            self._now_ns, MAX_SUBJECTS
        )
        self._windows: dict[tuple[str, str], Window] = {}

    def note(
        self, identity: Identity, way: str, kind: Refusal, subject: str, reason: str, count: int = 1
    ) -> None:
        """Count something, and log a warning.

        Args:
            identity: The client; one without a name if the policy does not know it.
            way: The protocol, such as ``rosbridge``.
            kind: Why.
            subject: The op and its subject; repeated in the log only after a while.
            reason: What happened, and what would be valid.
            count: How many there were.
        """
        self.counts[kind] += count
        now_ns, subject = self._now_ns(), subject[:MAX_TEXT]
        client = (identity.name, "" if identity.name else identity.place)
        window = self._window(client, now_ns)
        key = (client, way, kind, subject)
        more = self._lines.note(key, count, has_room=window.has_room)
        if more is None:
            return
        where = f"{identity.address or 'this process'}, {way}"
        text = f"{identity.name or 'unknown client'} ({where}): {subject}: {reason[:MAX_TEXT]}"
        # On one line, so that a client's name cannot look like another line of the log.
        self._node.get_logger().warning(f"gateway: {escaped(' '.join(text.split()))}{more}")

    def _window(self, client: tuple[str, str], now_ns: int) -> Window:
        """Return the window of a client's lines; expired windows are reported and forgotten."""
        window = self._windows.get(client)
        if window is not None and now_ns < window.until_ns:
            return window
        for each in [key for key, old in self._windows.items() if now_ns >= old.until_ns]:
            self._tell_left_out(each, self._windows.pop(each).left_out)
        if client[1] and sum(1 for _, other in self._windows if other) >= MAX_PLACES:
            client = NOBODY
        return self._windows.setdefault(client, Window(now_ns + WAIT_NS))

    def _tell_left_out(self, client: tuple[str, str], count: int) -> None:
        """Log how many lines about a client were omitted in its window."""
        if count:
            name, place = client
            who = name or (f"unknown client ({place})" if place else "unknown clients")
            self._node.get_logger().warning(
                f"gateway: {escaped(who)}: {count} more lines in {WAIT_NS // S_TO_NS} s were "
                f"omitted: the limit is {MAX_LINES} about one client"
            )
