"""The grid of a timer, without a clock."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.rules.schedule import Schedule

PERIOD = 100


@pytest.mark.parametrize(
    ("now", "expected", "next_ns", "skipped"),
    [
        (1100, 1100, 1200, 0),  # on time
        (1101, 1100, 1200, 0),  # a little late: the next is not
        (1199, 1100, 1200, 0),
        (1200, 1100, 1300, 1),  # late by a whole period: one call for both
        (1250, 1100, 1300, 1),
        (1999, 1100, 2000, 8),
        (2000, 1100, 2100, 9),
    ],
)
def test_a_call_is_followed_by_the_next_point_of_the_grid(
    now: int, expected: int, next_ns: int, skipped: int
) -> None:
    """Lateness neither adds up nor ends in a burst (T1, T2)."""
    schedule = Schedule(PERIOD, 1000)
    assert schedule.is_ready(now)
    assert schedule.call(now) == expected
    assert schedule.next_ns == next_ns
    assert schedule.skipped == skipped
    assert not schedule.is_ready(now)


def test_the_first_call_is_one_period_after_the_start() -> None:
    """There is no call at the start (T1)."""
    schedule = Schedule(PERIOD, 1000)
    assert [now for now in (1000, 1099, 1100) if schedule.is_ready(now)] == [1100]
    assert schedule.until_next_ns(1030) == 70
    assert schedule.until_next_ns(1130) == -30
    assert schedule.since_last_ns(1030) == 30


def test_a_schedule_may_start_canceled() -> None:
    """Then it waits for a reset (T1)."""
    schedule = Schedule(PERIOD, 1000, autostart=False)
    assert not schedule.is_ready(5000)
    assert schedule.until_next_ns(5000) is None
    schedule.reset(5000)
    assert schedule.until_next_ns(5000) == PERIOD


def test_period_zero_is_always_ready() -> None:
    """It leaves out nothing (T2)."""
    schedule = Schedule(0, 1000)
    for now in (1000, 1000, 1700):
        assert schedule.is_ready(now)
        schedule.call(now)
    assert schedule.skipped == 0


def test_a_canceled_schedule_cannot_be_called() -> None:
    """Calling it is an error, as in rcl; a reset begins a new grid (T3)."""
    schedule = Schedule(PERIOD, 1000)
    schedule.cancel()
    assert not schedule.is_ready(1100)
    with pytest.raises(RuntimeError, match="reset"):
        schedule.call(1100)
    schedule.reset(1234)
    assert not schedule.is_ready(1333)
    assert schedule.call(1334) == 1334


def test_a_new_period_leaves_the_planned_call_alone() -> None:
    """It takes effect after that (T3)."""
    schedule = Schedule(PERIOD, 1000)
    schedule.change_period(7)
    assert schedule.next_ns == 1100
    schedule.call(1100)
    assert schedule.next_ns == 1107


@pytest.mark.parametrize("period", [-1, -(10**9)])
def test_a_period_is_not_negative(period: int) -> None:
    """A ValueError where the mistake is made."""
    with pytest.raises(ValueError, match="0 or more"):
        Schedule(period, 0)
    with pytest.raises(ValueError, match="period"):
        Schedule(PERIOD, 0).change_period(period)


@pytest.mark.parametrize(
    ("now", "next_ns"),
    [
        (1099, 1199),  # before the last call: one period from now
        (0, 100),
        (1100, 1200),  # back to the last call or less far: the plan stands
        (1150, 1200),
    ],
)
def test_a_clock_set_back_before_the_last_call_begins_a_new_grid(now: int, next_ns: int) -> None:
    """Otherwise the timer would wait until the old time has come again (T4)."""
    schedule = Schedule(PERIOD, 1000)
    schedule.call(1100)
    schedule.look_back(now)
    assert schedule.next_ns == next_ns


@pytest.mark.parametrize(
    ("old_now", "new_now", "left"),
    [(1130, 50_000, 70), (1130, 0, 70), (1100, 3, 100), (1250, 7, 0)],
)
def test_what_is_left_of_a_period_survives_a_switch_of_the_clock(
    old_now: int, new_now: int, left: int
) -> None:
    """The time waited already counts, whatever the new source calls it (T4)."""
    schedule = Schedule(PERIOD, 1000)
    schedule.call(1100)
    since = schedule.since_last_ns(old_now)
    schedule.carry_over(old_now, new_now)
    assert schedule.until_next_ns(new_now) == left
    assert schedule.since_last_ns(new_now) == since


@given(
    period=st.integers(1, 10**12),
    start=st.integers(0, 10**18),
    steps=st.lists(st.integers(0, 10**13), max_size=50),
)
def test_every_call_is_planned_on_the_grid(period: int, start: int, steps: list[int]) -> None:
    """Whatever the delays: no drift, one call for each stretch missed, and all are counted."""
    schedule = Schedule(period, start)
    now = start
    for step in steps:
        now += step
        if not schedule.is_ready(now):
            continue
        expected = schedule.call(now)
        assert expected <= now < schedule.next_ns <= now + period
        assert (expected - start) % period == 0
        assert (schedule.next_ns - start) % period == 0
        assert not schedule.is_ready(now)
    # Each point of the grid so far was called for, or left out.
    assert schedule.calls + schedule.skipped == (schedule.next_ns - start) // period - 1


def test_a_hundred_thousand_calls_do_not_drift() -> None:
    """The period may be one that no float can hold, with each call late by a different amount."""
    period, start = 33_333_333, 1_700_000_000_123_456_789
    schedule = Schedule(period, start)
    for n in range(1, 100_001):
        assert schedule.call(start + n * period + n % 1000) == start + n * period
    assert schedule.skipped == 0
