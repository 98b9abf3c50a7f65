"""Why something in a bag was sent, from the causes that were recorded with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.bag._selection import CAUSES
from aionode.clock import Duration
from aionode.engine.wire import cdr
from aionode.errors import BagError, DecodeError
from aionode.interfaces.std_msgs.msg import String
from aionode.observe import RecordedCauses

if TYPE_CHECKING:
    from aionode.bag._bag import Bag
    from aionode.clock import Time
    from aionode.observe import Why

__all__ = ["why"]

REMEDY = "record with `aionode bag record --causes`, or Recorder(causes=True)"


def why(bag: Bag, name: str, at: Time | Duration | None = None) -> Why:
    """Return what led to the last message of a topic, from the causes in a bag.

    It is what `observe.why` would have answered at that time; ages count back from there.

    Args:
        bag: The bag, whose recorder has recorded causes.
        name: The name of a topic, service, action or node, or the id of a goal in hexadecimal.
        at: The time, or how long after the start of the bag; by default the end of the recording.

    Raises:
        BagError: there are no causes in the bag, or they cannot be read.
    """
    path = str(bag.path)
    if CAUSES not in bag.topics or not bag.topics[CAUSES].message_count:
        raise BagError(path, f"it has no causes: {CAUSES} has no messages in it", REMEDY)
    at_ns = None
    if at is not None:
        at_ns = at.nanoseconds + (bag.start_ns if isinstance(at, Duration) else 0)
    causes = RecordedCauses()
    last_ns = 0
    for record in bag.read(CAUSES):
        if at_ns is not None and at_ns <= last_ns < record.time_ns:
            break
        last_ns = record.time_ns
        if not causes.add(text_of(record.raw, record.info.type)):
            raise BagError(
                path,
                f"the message of {CAUSES} at {last_ns / 1e9:.9f} cannot be read",
                "it is damaged, or another version of aionode has recorded it: use that version",
            )
    return causes.why(name, at_ns)


def text_of(raw: bytes, typename: str) -> str:
    """Return the text of a message; an empty one if it has none."""
    if typename != "std_msgs/msg/String":
        return ""
    try:
        return cdr.decode(String, raw).data
    except DecodeError:
        return ""
