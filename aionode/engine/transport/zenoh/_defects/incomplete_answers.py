"""The answer of a peer that is connected to a router may lack tokens, even all of them.

Zenoh:
    A peer that is queried for tokens sends them from one thread, and passes on the end of its
    router's answer from another, which may be faster. Then the query ends, and the rest is dropped:
    one answer in ten lacked tokens, mostly all 300 of them.
Reported:
    No.
Seen in:
    1.5.1, 1.7.2, 1.8.0, 1.9.0, 1.10.2
Workaround:
    A session is queried again while known tokens are missing (`tokens`). An answer that still lacks
    them in the end is ignored (`forgotten_peers`, `graph_watcher`).
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
        if reply.ok is None:  # the query timed out
            raise TimeoutError(f"{key}: not all tokens were named within {timeout_s:g} s")
        yield str(reply.ok.key_expr)
