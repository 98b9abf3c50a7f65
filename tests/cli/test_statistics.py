"""Statistics of a stream of messages."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.cli._nouns.topic.measure import Bandwidth, Intervals, size_texts, spread_of


@given(st.lists(st.integers(0, 10**12), min_size=1, max_size=50))
def test_the_spread_holds_its_mean(values: list[int]) -> None:
    """Minimum, mean and maximum are in order, and the deviation is not negative."""
    spread = spread_of(values)

    assert spread.low <= spread.mean <= spread.high
    assert 0 <= spread.deviation <= spread.high - spread.low + 1


def test_the_deviation_is_that_of_the_population() -> None:
    """As ros2's."""
    assert spread_of([1, 3]).deviation == 1.0


def test_time_that_goes_backwards_resets() -> None:
    """A simulation was restarted."""
    intervals = Intervals(10)
    for now in (100, 200, 300):
        assert not intervals.arrive(now)

    assert intervals.arrive(0)
    assert intervals.spread() is None


def test_statistics_are_printed_once() -> None:
    """Without a new message there is nothing to report."""
    intervals = Intervals(10)
    intervals.arrive(0)
    intervals.arrive(5)

    assert intervals.spread() is not None
    assert intervals.spread() is None


def test_one_message_makes_no_bandwidth() -> None:
    """A rate needs two points in time."""
    bandwidth = Bandwidth(10)
    bandwidth.arrive(0, 100)

    assert bandwidth.rate(1_000_000_000) is None


@pytest.mark.parametrize("late_s", [0.0, 0.01, 0.019])
def test_the_bandwidth_is_exact_from_the_second_message_on(late_s: float) -> None:
    """The first message's bytes came before the counted time: otherwise 5 instead of 4.8 MB/s."""
    bandwidth = Bandwidth(100)
    for number in range(3):
        bandwidth.arrive(number * 20_000_000, 1_000)

    rate = bandwidth.rate(40_000_000 + int(late_s * 1e9))

    assert rate is not None
    assert rate.bytes_per_s == 50_000


def test_the_bandwidth_falls_when_messages_stop() -> None:
    """Time counts again as soon as the next message is overdue."""
    bandwidth = Bandwidth(100)
    for number in range(3):
        bandwidth.arrive(number * 20_000_000, 1_000)

    rate = bandwidth.rate(100_000_000)

    assert rate is not None
    assert rate.bytes_per_s == pytest.approx(25_000)


@pytest.mark.parametrize(
    ("bytes_per_s", "texts"),
    [
        (999.4, ["999 B", "20 B"]),
        (1_000.0, ["1.00 KB", "0.02 KB"]),
        (1_234_567.0, ["1.23 MB", "0.00 MB"]),
    ],
)
def test_all_sizes_have_the_unit_of_the_rate(bytes_per_s: float, texts: list[str]) -> None:
    """As in ros2: one unit per line."""
    assert size_texts(bytes_per_s, 20) == texts
