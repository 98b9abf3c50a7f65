"""The losses of recorders, as bags keep them: in the custom data, which rosbag2 keeps as well."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = ["LOSSES", "Lost", "added_losses", "losses_from", "losses_text"]

LOSSES: Final = "messages_lost"
"""The key of the losses in the custom data of a bag."""


class Lost(NamedTuple):
    """The messages of one topic that a recorder has lost.

    Attributes:
        in_transport: How many were published and did not arrive, by their numbers.
        in_recorder: How many arrived and were not written.
    """

    in_transport: int
    in_recorder: int


def losses_text(losses: Mapping[str, Lost]) -> str:
    """Return losses as the text that is in the custom data; topics without any are left out."""
    return json.dumps({name: lost._asdict() for name, lost in losses.items() if any(lost)})


def losses_from(custom_data: Mapping[str, str]) -> dict[str, Lost] | None:
    """Return the losses by topic; None if the custom data tell of none."""
    try:
        listed = json.loads(custom_data[LOSSES])
        return {
            str(name): Lost(int(counts["in_transport"]), int(counts["in_recorder"]))
            for name, counts in listed.items()
        }
    except (KeyError, TypeError, ValueError, AttributeError):
        return None  # another recorder, or somebody's own entry of this name


def added_losses(losses: Iterable[Mapping[str, Lost] | None]) -> dict[str, Lost] | None:
    """Return the sums of several bags; None unless each of them tells."""
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
