"""A new message that overtakes a late publisher's history replaces it.

Zenoh:
    An AdvancedSubscriber that is connected with a publisher later than it was declared asks for the
    history. A message that arrives before the answer is delivered at once, and everything before
    it in the answer is then dropped as old. Only the first query of a subscriber holds back what is
    new.
Reported:
    No.
Seen in:
    1.9.0, 1.10.2
Workaround:
    A transient local publisher whose context opens is declared only once the peers are connected:
    then they get everything as new messages, and nothing before that (`ZenohWriter.needs_graph`). A
    peer that is connected later may still lose the history, if a message is published at that
    moment; the last message always arrives.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["needs_peers"]


def needs_peers(*, is_transient: bool) -> bool:
    """Return whether a publisher is declared after connecting, given whether it has a history."""
    return is_transient and is_mended("overtaken_history")
