"""The deque that drops expired items, compared with the simplest model of one."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.rules.lifespan import NEVER_NS, ExpiringItems

STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("append"), st.one_of(st.integers(0, 20), st.just(NEVER_NS))),
        st.tuples(st.just("take"), st.just(0)),
        st.tuples(st.just("pass"), st.integers(0, 10)),
        st.tuples(st.just("look"), st.just(0)),
        st.tuples(st.just("clear"), st.just(0)),
    ),
    max_size=60,
)


@given(STEPS, st.integers(0, 3))
def test_it_holds_what_has_not_expired_in_order(steps: list[tuple[str, int]], queued: int) -> None:
    """Each dropped item is counted once."""
    now_ns = 0
    expired = 0
    number = queued
    model: list[tuple[int, int]] = [(each, NEVER_NS) for each in range(queued)]
    gone = 0

    def on_expired(count: int) -> None:
        nonlocal expired
        expired += count

    items = ExpiringItems([(0, each) for each in range(queued)], lambda: now_ns, on_expired)

    def valid() -> list[tuple[int, int]]:
        nonlocal gone
        left = [entry for entry in model if entry[1] > now_ns]
        gone += len(model) - len(left)
        return left

    for what, value in steps:
        if what == "append":
            expires_ns = value if value == NEVER_NS else now_ns + 1 + value
            items.next_expires_ns = expires_ns
            items.append((0, number))
            model.append((number, expires_ns))
            number += 1
        elif what == "pass":
            now_ns += value
        elif what == "clear":
            model = valid()
            assert len(items) == len(model)
            items.clear()
            model = []
        else:
            model = valid()
            assert bool(items) == bool(model)
            taken: Any = items.popleft()[1] if what == "take" and items else None
            if taken is not None:
                assert taken == model.pop(0)[0]
        if what not in {"append", "pass"}:
            assert expired == gone
            assert [item for _, item in items] == [entry[0] for entry in model]
