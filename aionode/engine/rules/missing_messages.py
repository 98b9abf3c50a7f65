"""Detects missing messages of a publisher from gaps in its sequence numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from aionode._process.recent import Recent

__all__ = ["REMEMBERED_PUBLISHERS", "missing_before"]

REMEMBERED_PUBLISHERS = 1024
"""Maximum number of publishers about which a subscription remembers anything."""


def missing_before(last_sequences: Recent[bytes, int], gid: bytes, sequence: int) -> int:
    """Record the number of a message; return how many before it are missing.

    Args:
        last_sequences: The last number of each publisher, by gid; messages may carry arbitrarily
            many invented gids.
        gid: The publisher.
        sequence: The number. If it is not newer than the last one, it is ignored.
    """
    last = last_sequences.get(gid)
    if last is None:
        last_sequences.put(gid, sequence)
        return 0
    if sequence <= last:
        return 0
    last_sequences[gid] = sequence
    return sequence - last - 1
