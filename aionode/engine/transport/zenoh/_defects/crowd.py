"""Nothing can be sent while Zenoh drops what a lost connection has announced.

Zenoh:
    When a connection ends, Zenoh drops all tokens that came over it in one piece, with a lock that
    every `put` needs. For each token it goes through the list of all tokens that a subscriber of
    tokens matches, so the time grows with the square: about 10 ms for 1,000 tokens, 40 ms for
    2,000, 240 ms for 5,000.
Known as:
    Not reported.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Mend:
    While others have announced more than `is_crowd` allows, the event loop puts nothing:
    `AnnouncedLimit` counts, and `_control_messages`, `_peer_senders` and `_publisher` have threads
    put.
"""

from __future__ import annotations

from typing import Final

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["is_crowd"]

CROWDED: Final = 2_000
"""Number of tokens beyond which Zenoh's lock may be held for long."""


def is_crowd(tokens: int) -> bool:
    """Return whether others have announced so many tokens that the event loop must not put."""
    return tokens > CROWDED and is_mended("crowd")
