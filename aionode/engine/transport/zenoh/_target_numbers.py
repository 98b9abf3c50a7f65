"""Sequence numbers of publishers that number each target of a message, as in ROS 2 Lyrical.

A publisher of byte sequences sends a message once to the key of all subscriptions that accept bytes
from the CPU, and once to the key of each other subscription that it has ever discovered. Each of
these sends uses one of its numbers, so the numbers on one key rise by the number of targets, though
nothing is lost.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from aionode._process.recent import Recent
from aionode.engine.rules.missing_messages import REMEMBERED_PUBLISHERS

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["TargetNumbers"]

STEADY: Final = 5
"""After this many equal increments, apparent losses were due to the number of targets: one came and
went unseen."""


class Numbers:
    """The numbers of one publisher.

    Attributes:
        taken: The last one that it used for this topic.
        given: The number assigned to that message here.
        rise: The increment with that message.
        repeats: Number of consecutive messages with that increment.
        targets: The increment per message, if known from increments; otherwise 0.
        doubtful: Number of messages missing before that one, unless the increment repeats.
        by_target: Whether that message came on the key of subscriptions that accept bytes from the
            CPU.
    """

    __slots__ = ("by_target", "doubtful", "given", "repeats", "rise", "taken", "targets")

    def __init__(self, taken: int, *, by_target: bool) -> None:
        self.taken = self.given = taken
        self.rise = self.repeats = self.targets = self.doubtful = 0
        self.by_target = by_target


class TargetNumbers:
    """Numbers the messages of such publishers consecutively from 1, with gaps for lost ones.

    Args:
        others: Returns the number of known subscriptions of the topic that are targets of their
            own. Those that left before they were known here also stay targets forever; the
            increment reveals them when it repeats.
    """

    def __init__(self, others: Callable[[], int]) -> None:
        self._others = others
        self._of: Recent[bytes, Numbers] = Recent(REMEMBERED_PUBLISHERS)

    def number(self, gid: bytes, taken: int, *, by_target: bool) -> int:
        """Return the number of a message.

        Args:
            gid: Its publisher.
            taken: The publisher's number.
            by_target: Whether it came on the key of subscriptions that accept bytes from the CPU.
                If so, the publisher numbers each target, otherwise each message.
        """
        known = self._of.get(gid)
        if known is None:
            if by_target:
                self._of.put(gid, Numbers(taken, by_target=True))
            return taken
        rise = taken - known.taken
        if rise <= 0:  # late, or a repetition
            return known.given + rise
        known.given += 1 + self._missing(known, rise, by_target=by_target)
        known.taken = taken
        known.by_target = by_target
        return known.given

    def _missing(self, known: Numbers, rise: int, *, by_target: bool) -> int:
        """Return the number of messages missing before one with this increment."""
        if not by_target:
            last = max(known.targets, 1 + self._others()) if known.by_target else 1
            return max(rise - last, 0)
        if not known.by_target:
            return rise - 1
        known.repeats = known.repeats + 1 if rise == known.rise else 1
        known.rise = rise
        expected = max(known.targets, 1 + self._others()) if rise > 1 else 1
        is_explained = not known.targets or rise <= expected
        if known.repeats >= (2 if is_explained else STEADY):
            known.targets = expected = rise
            known.doubtful = 0
        before, known.doubtful = known.doubtful, 0
        missing = max(rise // expected - 1, 0)
        if not known.targets:
            missing, known.doubtful = 0, missing
        return before + missing
