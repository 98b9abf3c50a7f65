"""Tests of log lines about events that others cause."""

from __future__ import annotations

import itertools

from hypothesis import given
from hypothesis import strategies as st

from aionode._process.rated_lines import MAX_WAIT_NS, WAIT_NS, RatedLines

STEPS = st.lists(st.tuples(st.integers(0, 2 * MAX_WAIT_NS), st.integers(1, 5)), max_size=50)


def number_in(text: str) -> int:
    """Return how many events a line reports, including its own."""
    if not text:
        return 1
    number = int(text.removeprefix(" (").split()[0])
    return number if "at once" in text else number + 1


@given(STEPS)
def test_what_was_counted_is_said_with_the_next_line(steps: list[tuple[int, int]]) -> None:
    """Nothing is lost between the lines, which keep the promised distance."""
    now_ns, noted, said = 0, 0, 0
    times: list[int] = []
    lines: RatedLines[str] = RatedLines(lambda: now_ns)
    for wait_ns, count in steps:
        now_ns += wait_ns
        noted += count
        text = lines.note("/scan", count)
        if text is not None:
            said += number_in(text)
            assert said == noted
            times.append(now_ns)
    assert all(later - earlier >= WAIT_NS for earlier, later in itertools.pairwise(times))


def test_a_flood_is_said_less_and_less_often() -> None:
    """People read twelve lines an hour, but not a thousand."""
    now_ns = 0
    lines: RatedLines[str] = RatedLines(lambda: now_ns)
    said: list[int] = []
    for second in range(3600):
        now_ns = second * 1_000_000_000
        if lines.note("/scan") is not None:
            said.append(second)

    assert said == [0, 10, 30, 70, 150, 310, 630, 1270, 1910, 2550, 3190]


def test_what_is_left_out_for_lack_of_room_is_not_remembered() -> None:
    """A flood of invented subjects displaces none that was logged."""
    lines: RatedLines[int] = RatedLines(lambda: 0, max_subjects=1)
    assert lines.note(0) == ""
    for subject in range(1, 10):
        assert lines.note(subject, has_room=lambda: False) is None
    assert lines.note(0) is None
