"""The answer of a peer beside a router may lack tokens, even all of them.

Zenoh:
    A peer that is asked for tokens names them in one thread, and in another passes on that the
    answer of its router has ended, which may come first. Then the query ends, and the rest is
    dropped: one answer of ten lacked tokens, and mostly all of 300.
Known as:
    Not reported.
Seen in:
    1.5.1, 1.7.2, 1.8.0, 1.9.0, 1.10.2
Mend:
    A session is asked again while tokens that are known are missing (`tokens`). An answer that
    lacks them in the end counts for nothing (`forgotten_peers`, `_graph_watcher`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from aionode.clock import perf_ns
from aionode.engine.transport.zenoh._defects._switch import is_mended

if TYPE_CHECKING:
    from collections.abc import Iterator
    from collections.abc import Set as AbstractSet

    import zenoh

__all__ = ["ANSWER_S", "tokens"]

ANSWER_S: Final = 1.0
"""Timeout of a query for tokens, in seconds; it takes a millisecond."""

ANSWERS: Final = 20
"""Maximum number of queries while answers lack known tokens."""

ANSWERS_S: Final = 0.2
"""How long a session is queried again, in seconds; each answer takes a millisecond or two."""


def tokens(
    session: zenoh.Session,
    *keys: str,
    expected: AbstractSet[str] = frozenset(),
    timeout_s: float = ANSWER_S,
) -> set[str]:
    """Return the tokens that match `keys` and that a session sees.

    The session is queried again while `expected` tokens are missing, and tokens from all answers
    count.

    Args:
        session: The session.
        *keys: The key expressions to query.
        expected: Tokens in a complete answer; some may still be missing from the result.
        timeout_s: Timeout for each answer, in seconds.

    Raises:
        TimeoutError: an answer was not complete in time; tokens that it lacks may exist.
    """
    named: set[str] = set()
    ends_ns = perf_ns() + int(ANSWERS_S * 1e9)
    for _ in range(ANSWERS if is_mended("incomplete_answers") else 1):
        for key in keys:
            named.update(answer(session, key, timeout_s))
        if expected <= named or perf_ns() > ends_ns:
            break
    return named


def answer(session: zenoh.Session, key: str, timeout_s: float) -> Iterator[str]:
    """Yield the tokens that match one key and are named in one answer."""
    for reply in session.liveliness().get(key, timeout=timeout_s):
        if reply.ok is None:  # the time is up
            raise TimeoutError(f"{key}: not all tokens were named within {timeout_s:g} s")
        yield str(reply.ok.key_expr)
