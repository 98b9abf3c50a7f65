"""The times of publication, for any error of the publisher's clock."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.rules import publication_times
from aionode.engine.rules.publication_times import PublicationTimes
from tests.support.living import living

S = 10**9
MS = 10**6
GID = bytes(15) + b"1"
BEGAN = -1_700_000_000 * S
"""The time that the steady clock of these tests showed when the system clock showed 0."""


class Stream:
    """Messages of one publisher, whose clock is fast by `fast_ns`."""

    def __init__(self, fast_ns: int = 0) -> None:
        self.times = PublicationTimes()
        self.fast_ns = fast_ns

    def come(self, published_ns: int, arrived_ns: int) -> int:
        """Let a message arrive; return when it seems to have been published."""
        stamp = published_ns - BEGAN + self.fast_ns
        return self.times.published_ns(GID, stamp, arrived_ns, BEGAN)


@given(
    fast_ns=st.integers(-(10**6) * S, 10**6 * S),
    delays=st.lists(st.integers(0, 50 * MS), min_size=2, max_size=30),
    held_ns=st.integers(0, 100 * S),
)
def test_a_stream_shows_the_difference_of_the_clocks(
    fast_ns: int, delays: list[int], held_ns: int
) -> None:
    """It shows it up to the shortest delay; then a delayed message is recognized."""
    stream = Stream(fast_ns)
    for number, delay_ns in enumerate(delays):
        stream.come(number * 100 * MS, number * 100 * MS + delay_ns)
    published_ns = len(delays) * 100 * MS
    seems_ns = stream.come(published_ns, published_ns + held_ns)
    slack_ns = 2 * len(delays) * 100 * MS // publication_times.DRIFT
    assert seems_ns <= published_ns + min(*delays, held_ns) + slack_ns + held_ns // 10_000
    if fast_ns <= 0:
        assert seems_ns >= published_ns - min(-fast_ns, publication_times.SYNCHRONIZED_NS)
    assert seems_ns <= published_ns + held_ns


@given(st.lists(st.integers(1 * MS, 10 * S), min_size=1, max_size=20), st.integers(0, S))
def test_what_was_held_back_comes_at_once(intervals: list[int], wait_ns: int) -> None:
    """A publisher that was never received before cannot be known to have a slow clock."""
    stream = Stream()
    published_ns = -sum(intervals) - wait_ns
    for number, interval_ns in enumerate(intervals):
        arrived_ns = number * 50_000
        assert stream.come(published_ns, arrived_ns) == published_ns
        published_ns += interval_ns


@given(st.lists(st.integers(0, 49 * MS), min_size=2, max_size=30), st.integers(0, 100 * S))
def test_on_one_host_the_time_of_publication_is_exact(delays: list[int], held_ns: int) -> None:
    """However busy the host is: a command from before a stop arrived after it, as if newer."""
    stream = Stream()
    for number, delay_ns in enumerate(delays):
        published_ns = number * 100 * MS
        assert stream.come(published_ns, published_ns + delay_ns) == published_ns
    published_ns = len(delays) * 100 * MS
    assert stream.come(published_ns, published_ns + held_ns) == published_ns


def test_one_message_shows_that_a_clock_is_fast() -> None:
    """It cannot have been published after it arrived."""
    stream = Stream(fast_ns=60 * S)
    assert stream.come(0, 3 * MS) == 3 * MS
    assert stream.come(100 * MS, 101 * MS) == 101 * MS
    assert stream.come(200 * MS, 5 * S) == 201 * MS + 4899 * MS // publication_times.DRIFT


def test_two_messages_show_that_a_clock_is_slow() -> None:
    """The first seems to have been delayed; the second arrived at the pace of publication."""
    stream = Stream(fast_ns=-60 * S)
    assert stream.come(0, 3 * MS) == -60 * S
    assert stream.come(100 * MS, 103 * MS) == 103 * MS
    assert stream.come(200 * MS, 5 * S) <= 204 * MS


def test_a_clock_that_is_set_back_is_learned_anew() -> None:
    """Its stamps go back, and those of one publisher never do otherwise."""
    stream = Stream()
    for number in range(5):
        stream.come(number * 100 * MS, number * 100 * MS)
    stream.fast_ns = -3600 * S
    assert stream.come(S, S) < 0
    assert stream.come(S + 100 * MS, S + 100 * MS) == S + 100 * MS


def test_clocks_may_drift_apart() -> None:
    """By less than one part in ten thousand; a day is enough for seconds."""
    stream = Stream()
    stream.come(-100 * MS, -99 * MS)
    for hour in range(24):
        stream.fast_ns = -hour * 180 * MS  # 50 parts in a million
        published_ns = hour * 3600 * S
        assert stream.come(published_ns, published_ns + MS) == pytest.approx(
            published_ns, abs=2 * MS
        )


def test_a_message_without_a_stamp_was_published_when_it_came() -> None:
    """There is nothing else to rely on."""
    assert PublicationTimes().published_ns(GID, 0, 5, BEGAN) == 5


def test_few_publishers_are_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Anything from the network is bounded."""
    clocks = living(publication_times.PublisherClock)
    monkeypatch.setattr(publication_times, "REMEMBERED_PUBLISHERS", 2)
    times = PublicationTimes()
    for number in range(5):
        times.published_ns(bytes([number]), 1, 1, 0)
    assert living(publication_times.PublisherClock) <= clocks + 2
