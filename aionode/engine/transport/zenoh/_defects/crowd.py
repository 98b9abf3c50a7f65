"""Nothing can be sent while Zenoh drops the tokens of a lost connection.

Zenoh:
    When a connection ends, Zenoh drops all tokens that came over it at once, and holds a lock that
    every `put` needs. For each token it searches the list of all tokens that a subscriber of
    tokens matches, so the time grows quadratically: about 10 ms for 1,000 tokens, 40 ms for 2,000,
    240 ms for 5,000.
Reported:
    No.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    While others have announced more tokens than `is_crowd` allows, the event loop sends nothing
    through Zenoh: `AnnouncedLimit` counts them, and `control_messages`, `peer_senders` and
    `publisher` send from threads.
"""

from __future__ import annotations

from typing import Final

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["is_crowd"]

CROWDED: Final = 2_000
"""Number of tokens beyond which Zenoh's lock may be held for long."""


def is_crowd(tokens: int) -> bool:
    """Return whether others have announced so many tokens that only threads may send."""
    return tokens > CROWDED and is_mended("crowd")
