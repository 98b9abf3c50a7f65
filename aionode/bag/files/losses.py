"""What a bag lacks, stored in its custom data, which rosbag2 preserves."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = [
    "LOSSES",
    "MISSING",
    "Lost",
    "added_losses",
    "losses_from",
    "losses_text",
    "missing_from",
    "missing_text",
]

LOSSES: Final = "messages_lost"
"""The key for losses in the custom data of a bag."""

MISSING: Final = "messages_missing"
"""The key for messages that were written, and are no longer in the files of a bag."""


class Lost(NamedTuple):
    """The messages of one topic that a recorder lost.

    Attributes:
        in_transport: How many were published but did not arrive, judging by sequence numbers.
        in_recorder: How many arrived but were not written.
    """

    in_transport: int
    in_recorder: int


def losses_text(losses: Mapping[str, Lost]) -> str:
    """Return losses as text for the custom data, omitting topics without any."""
    return json.dumps({name: lost._asdict() for name, lost in losses.items() if any(lost)})


def losses_from(custom_data: Mapping[str, str]) -> dict[str, Lost] | None:
    """Return the losses by topic; None if the custom data contain none."""
    try:
        listed = json.loads(custom_data[LOSSES])
        return {
            str(name): Lost(int(counts["in_transport"]), int(counts["in_recorder"]))
            for name, counts in listed.items()
        }
    except (KeyError, TypeError, ValueError, AttributeError):
        return None  # another recorder's, or a user's own entry of this name


def added_losses(losses: Iterable[Mapping[str, Lost] | None]) -> dict[str, Lost] | None:
    """Return the sums over several bags; None unless all of them report losses."""
    total: dict[str, Lost] = {}
    for by_topic in losses:
        if by_topic is None:
            return None
        for name, lost in by_topic.items():
            before = total.get(name, Lost(0, 0))
            total[name] = Lost(
                before.in_transport + lost.in_transport, before.in_recorder + lost.in_recorder
            )
    return total


def missing_text(missing: Mapping[str, int]) -> str:
    """Return numbers of missing messages by topic as text for the custom data."""
    return json.dumps(missing)


def missing_from(custom_data: Mapping[str, str]) -> dict[str, int]:
    """Return the numbers of missing messages by topic; empty if the custom data contain none."""
    try:
        listed = json.loads(custom_data[MISSING])
        return {str(name): int(count) for name, count in listed.items() if int(count) > 0}
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError):
        return {}  # a user's own entry of this name
