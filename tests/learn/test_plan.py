"""What of a policy's chunks is sent, and when: no node, no clock."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.learn._plan import ActionPlan

MS = 1_000_000
PERIOD_NS = 100 * MS


def plan_of(lower: float = -100.0, upper: float = 100.0, blend_ns: int = 0) -> ActionPlan:
    """Return a plan of single numbers, ten a second."""
    return ActionPlan(PERIOD_NS, np.array([lower]), np.array([upper]), blend_ns)


def chunk(*values: float) -> np.ndarray:
    """Return a chunk of single numbers."""
    return np.array(values, dtype=float).reshape(-1, 1)


def drained(plan: ActionPlan, until_ns: int) -> list[tuple[int, float]]:
    """Take every action at its time, and return the times in milliseconds and the values."""
    taken = []
    while plan.next_ns is not None and plan.next_ns <= until_ns:
        action = plan.take(plan.next_ns)
        assert action is not None
        taken.append((action.time_ns // MS, float(action.values[0])))
    return taken


def test_each_action_is_sent_at_its_time() -> None:
    """A period apart."""
    plan = plan_of()
    plan.put(chunk(1, 2, 3), first_ns=0, now_ns=0)

    assert drained(plan, 10**12) == [(0, 1.0), (100, 2.0), (200, 3.0)]


def test_what_a_policy_took_too_long_for_is_dropped_and_counted() -> None:
    """A chunk is not shifted to the time of its arrival: that is where the error comes from."""
    plan = plan_of()
    plan.put(chunk(1, 2, 3, 4), first_ns=0, now_ns=250 * MS)

    taken = plan.take(250 * MS)
    assert taken is not None
    assert taken.values[0] == 3.0  # still applies until 300 ms
    assert plan.late == 2
    assert drained(plan, 10**12) == [(300, 4.0)]


def test_what_the_last_chunk_has_sent_for_a_time_is_not_sent_again() -> None:
    """Two commands within a few milliseconds would be a jump."""
    plan = plan_of()
    plan.put(chunk(1, 2, 3, 4), first_ns=0, now_ns=0)
    assert drained(plan, 200 * MS) == [(0, 1.0), (100, 2.0), (200, 3.0)]

    plan.put(chunk(20, 30, 40), first_ns=110 * MS, now_ns=215 * MS)
    assert drained(plan, 10**12) == [(310, 40.0)]


def test_a_chunk_replaces_what_was_planned_for_its_time() -> None:
    """The actions before its first one stay."""
    plan = plan_of()
    plan.put(chunk(1, 2, 3, 4, 5), first_ns=0, now_ns=0)
    plan.put(chunk(30, 40, 50), first_ns=200 * MS, now_ns=0)

    assert drained(plan, 10**12) == [(0, 1.0), (100, 2.0), (200, 30.0), (300, 40.0), (400, 50.0)]


def test_a_blocked_loop_sends_the_newest_action_and_counts_the_others() -> None:
    """Nothing is made up for: the robot would jump through the past."""
    plan = plan_of()
    plan.put(chunk(1, 2, 3), first_ns=0, now_ns=0)

    action = plan.take(240 * MS)
    assert action is not None
    assert action.values[0] == 3.0
    assert (plan.sent, plan.late) == (1, 2)


def test_nothing_is_sent_once_the_last_action_is_over() -> None:
    """The lease stops the robot then; an old command would prolong it."""
    plan = plan_of()
    plan.put(chunk(1, 2), first_ns=0, now_ns=0)

    assert plan.take(200 * MS) is None
    assert (plan.sent, plan.late, plan.next_ns) == (0, 2, None)


def test_a_chunk_that_is_over_plans_nothing() -> None:
    """A policy slower than its chunk."""
    plan = plan_of()

    assert plan.put(chunk(1, 2), first_ns=0, now_ns=200 * MS) == 0
    assert (plan.late, plan.next_ns, plan.end_ns) == (2, None, None)


def test_periods_without_an_action_are_underruns() -> None:
    """From the first action on, and while they last."""
    plan = plan_of()
    plan.note_time(500 * MS)
    assert plan.underruns == 0

    plan.put(chunk(1), first_ns=500 * MS, now_ns=500 * MS)
    plan.take(500 * MS)
    plan.note_time(640 * MS)
    assert plan.underruns == 0
    plan.note_time(720 * MS)
    assert plan.underruns == 1

    plan.put(chunk(2), first_ns=800 * MS, now_ns=800 * MS)
    plan.take(800 * MS)
    assert plan.underruns == 2


def test_limits_clamp_and_count() -> None:
    """Only actions that are sent count."""
    plan = plan_of(-1.0, 1.0)
    plan.put(chunk(5, 0.5, -5, 7), first_ns=0, now_ns=150 * MS)

    assert plan.take(150 * MS) is not None
    assert drained(plan, 200 * MS) == [(200, -1.0)]
    assert plan.clamped == 1


def test_a_blend_goes_over_to_the_new_chunk_step_by_step() -> None:
    """Two chunks of one policy differ; a step between them would be felt."""
    plan = plan_of(blend_ns=400 * MS)
    plan.put(chunk(*[0] * 10), first_ns=0, now_ns=0)
    plan.put(chunk(*[4] * 10), first_ns=0, now_ns=0)

    assert [value for _, value in drained(plan, 500 * MS)] == [1.0, 2.0, 3.0, 4.0, 4.0, 4.0]


def test_a_blend_needs_something_to_blend_with() -> None:
    """After an underrun the new chunk counts alone."""
    plan = plan_of(blend_ns=400 * MS)
    plan.put(chunk(0, 0), first_ns=0, now_ns=0)
    drained(plan, 10**12)
    plan.put(chunk(4, 4), first_ns=300 * MS, now_ns=300 * MS)

    assert [value for _, value in drained(plan, 10**12)] == [4.0, 4.0]


def test_what_is_left_over_begins_at_the_time_asked_for() -> None:
    """Its rows are those of the next chunk, sent or not, as real-time chunking needs."""
    plan = plan_of()
    assert plan.left_over(0).shape == (0, 1)
    plan.put(chunk(1, 2, 3, 4), first_ns=0, now_ns=0)
    drained(plan, 200 * MS)

    assert plan.left_over(110 * MS).ravel().tolist() == [2.0, 3.0, 4.0]
    assert plan.left_over(290 * MS).ravel().tolist() == [4.0]
    assert plan.left_over(900 * MS).shape == (0, 1)


@given(
    chunks=st.lists(
        st.tuples(
            st.integers(min_value=1, max_value=12),  # actions
            st.integers(min_value=0, max_value=900),  # ms from the last observation to this one
            st.integers(min_value=0, max_value=900),  # ms of latency
        ),
        max_size=8,
    )
)
def test_actions_are_sent_in_order_and_never_twice_for_a_time(
    chunks: list[tuple[int, int, int]],
) -> None:
    """Whatever the latencies are: half a period apart at least, each within its own period."""
    plan, now_ns, seen_ns, given_to = plan_of(), 0, 0, 0
    sent: list[int] = []
    for length, later_ms, latency_ms in chunks:
        seen_ns = max(now_ns, seen_ns + later_ms * MS)
        arrives_ns = seen_ns + latency_ms * MS
        sent += [ms * MS for ms, _ in drained(plan, arrives_ns)]
        now_ns = arrives_ns
        plan.put(chunk(*[0] * length), seen_ns, now_ns)
        given_to += length
        action = plan.take(now_ns)
        if action is not None:
            assert action.time_ns <= now_ns < action.time_ns + PERIOD_NS
            sent.append(action.time_ns)
    sent += [ms * MS for ms, _ in drained(plan, 10**15)]

    gaps = [after - before for before, after in pairwise(sent)]
    assert all(gap >= PERIOD_NS // 2 for gap in gaps)
    assert plan.sent == len(sent)
    assert plan.sent + plan.late <= given_to
    assert plan.underruns == sum((gap + PERIOD_NS // 2) // PERIOD_NS - 1 for gap in gaps)


@pytest.mark.parametrize("length", [1, 7])
def test_what_was_sent_is_forgotten_with_the_next_chunk(length: int) -> None:
    """A policy may run for days."""
    plan = plan_of()
    for turn in range(100):
        plan.put(chunk(*[0] * length), turn * length * PERIOD_NS, turn * length * PERIOD_NS)
        drained(plan, (turn + 1) * length * PERIOD_NS - 1)

    assert len(plan.left_over(0)) <= 100 * length
    assert len(plan._done) <= length


def test_what_was_sent_is_forgotten_with_the_next_action() -> None:
    """A person may drive for days as well."""
    plan = plan_of()
    for now_ns in range(0, 100 * PERIOD_NS, PERIOD_NS):
        plan.put_now(np.zeros(1), now_ns)
        assert plan.take(now_ns) is not None

    assert len(plan._done) == 1
