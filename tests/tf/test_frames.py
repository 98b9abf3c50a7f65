"""Tests of the history of one frame, taken from tf2's tests of its caches."""

from __future__ import annotations

import random

import pytest

from aionode.tf._arithmetic import Pose, interpolated
from aionode.tf._frames import COMPACT, DynamicFrame, Room, StaticFrame

ORIGIN: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
LONG_NS = 10**10


def frame(max_ns: int = LONG_NS, room: Room | None = None) -> DynamicFrame:
    """Return an empty history."""
    return DynamicFrame(max_ns, room or Room())


def stored(one: DynamicFrame) -> list[tuple[int, str]]:
    """Return stamps and parents, the newest first."""
    first = one.first
    return list(zip(one.stamps[first:], one.parents[first:], strict=True))[::-1]


def parent_at(one: DynamicFrame | StaticFrame, time_ns: int) -> str | None:
    """Return the parent at a given time."""
    found = one.find(time_ns)
    return None if found is None else found[0]


def test_equal_stamps_are_kept_duplicates_are_not_and_what_is_too_old_leaves() -> None:
    """The order is tf2's: of equal stamps, the one that arrived last is the newest."""
    one = frame(10)
    items = [(0, "a"), (10, "b"), (5, "c"), (3, "d"), (8, "e"), (8, "f"), (8, "g")]
    expected = [(10, "b"), (8, "g"), (8, "f"), (8, "e"), (5, "c"), (3, "d"), (0, "a")]

    for stamp, parent in items:
        assert one.insert(stamp, parent, ORIGIN)
    assert stored(one) == expected
    for stamp, parent in reversed(items):
        assert one.insert(stamp, parent, ORIGIN)
    assert stored(one) == expected

    assert one.insert(15, "h", ORIGIN)
    assert not one.insert(0, "i", ORIGIN)
    assert one.insert(5, "j", ORIGIN)
    assert stored(one) == [
        (15, "h"), (10, "b"), (8, "g"), (8, "f"), (8, "e"), (5, "j"), (5, "c"),
    ]  # fmt: skip


@pytest.mark.parametrize("order", [1, -1])
def test_every_stamp_is_found_in_whatever_order_they_came(order: int) -> None:
    """Messages of several publishers overtake one another."""
    one = frame()
    for stamp in range(1, 100)[::order]:
        one.insert(stamp, f"p{stamp}", ORIGIN)

    assert len(one) == 99
    assert [parent_at(one, stamp) for stamp in range(1, 100)] == [f"p{n}" for n in range(1, 100)]


def test_the_time_0_is_the_newest() -> None:
    """tf2 uses 0 for the latest time, even after newer data has arrived."""
    one = frame()
    for stamp in (1, 100):
        one.insert(stamp, f"p{stamp}", ORIGIN)
    assert parent_at(one, 0) == "p100"
    one.insert(101, "p101", ORIGIN)
    assert parent_at(one, 0) == "p101"


def test_one_pose_a_hundred_times_is_one_pose() -> None:
    """Latched publishers repeat their transforms."""
    one = frame()
    for _ in range(100):
        assert one.insert(1, "p", ORIGIN)
    assert len(one) == 1
    assert one.find(1) == ("p", (ORIGIN, None, 0.0))


def test_a_translation_is_interpolated_along_a_line() -> None:
    """This holds for every time in between."""
    chance = random.Random(7)  # noqa: S311  # no secret
    for _ in range(10):
        one = frame()
        begin, end = ([chance.uniform(-10, 10) for _ in range(3)] for _ in range(2))
        one.insert(200, "p", (*begin, 0.0, 0.0, 0.0, 1.0))  # type: ignore[arg-type]
        one.insert(300, "p", (*end, 0.0, 0.0, 0.0, 1.0))  # type: ignore[arg-type]
        for pos in range(1, 100):
            found = one.find(200 + pos)
            assert found is not None
            older, newer, ratio = found[1]
            assert newer is not None
            expected = [b + (e - b) * pos / 100 for b, e in zip(begin, end, strict=True)]
            assert interpolated(older, newer, ratio)[:3] == pytest.approx(expected, abs=1e-12)


def test_between_two_parents_nothing_is_interpolated() -> None:
    """The older pose is used until the frame has its new parent."""
    one = frame()
    one.insert(100, "old", ORIGIN)
    one.insert(200, "new", (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))

    assert one.find(150) == ("old", (ORIGIN, None, 0.0))
    assert one.find(200) == ("new", ((1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), None, 0.0))


def test_slerp_takes_the_shorter_arc() -> None:
    """A quaternion and its negative are the same rotation."""
    one: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    other: Pose = (0.0, 0.0, 0.0, 0.0, 0.0, -(0.5**0.5), -(0.5**0.5))  # 90 degrees around z

    _, _, _, _, _, k, w = interpolated(one, other, 0.5)
    assert (k, w) == pytest.approx((0.3826834323650898, 0.9238795325112867), abs=1e-15)
    assert interpolated(one, one, 0.5) == one


def test_the_history_ends_where_the_data_ends() -> None:
    """Nothing is extrapolated."""
    one = frame()
    assert one.find(5) is None
    assert one.latest() is None
    one.insert(5, "p", ORIGIN)
    assert parent_at(one, 5) == "p"
    assert one.find(4) is one.find(6) is None
    one.insert(7, "p", ORIGIN)
    assert parent_at(one, 6) == "p"
    assert one.find(8) is None
    assert (one.oldest_ns, one.newest_ns) == (5, 7)


def test_a_static_frame_has_its_newest_pose_at_any_time() -> None:
    """Its stamp does not matter."""
    one = StaticFrame("p1", ORIGIN)
    for stamp in range(2, 100):
        one.insert(stamp, f"p{stamp}", ORIGIN)
        assert parent_at(one, stamp) == f"p{stamp}"
    assert len(one) == 1
    one.clear()
    assert parent_at(one, 10**18) == "p99"


def test_without_room_a_history_does_not_grow() -> None:
    """A flood of transforms takes no more memory than the limit allows."""
    room = Room(10)
    one, other = frame(room=room), frame(room=room)
    for stamp in range(20):
        one.insert(stamp, "p", ORIGIN)
    other.insert(1, "p", ORIGIN)
    other.insert(2, "p", ORIGIN)

    assert (len(one), one.oldest_ns) == (10, 10)
    assert (len(other), other.oldest_ns) == (1, 2)
    one.clear()
    assert room.left == 10


def test_forgotten_poses_leave_the_lists() -> None:
    """A history that runs for weeks is no longer than its cache time."""
    room = Room(1000)
    one = frame(100, room)
    for stamp in range(10_000):
        one.insert(stamp, "p", ORIGIN)

    assert len(one) <= 102
    assert len(one.stamps) <= 2 * (102 + COMPACT)
    assert room.left == 1000 - len(one)
