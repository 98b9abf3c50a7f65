"""The individual cases of tf2's tests of its core; see also `test_buffer_core`."""

from __future__ import annotations

import itertools
from math import cos, nan, radians, sin, sqrt

import pytest

from aionode.clock import Duration, Time
from aionode.errors import (
    BackwardExtrapolationException,
    ConnectivityException,
    ExtrapolationException,
    ForwardExtrapolationException,
    NoDataForExtrapolationException,
    TransformException,
)
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.tf import BufferCore
from tests.support.transforms import parts, transform

LATEST = Time()
HALF = sqrt(0.5)


def at(seconds: float) -> Time:
    """Return a time."""
    return Time(nanoseconds=round(seconds * 1e9))


def core_with(*transforms: TransformStamped) -> BufferCore:
    """Return a core with some transforms."""
    core = BufferCore()
    for one in transforms:
        core.set_transform(one, "me")
    return core


# What is refused


@pytest.mark.parametrize(
    ("parent", "child"), [("", ""), ("/", "/"), ("p", "/"), ("/", "c"), ("/same", "same")]
)
def test_a_name_that_is_only_a_slash_is_no_name(parent: str, child: str) -> None:
    """The slash is removed first; a message that nobody filled in has no names either."""
    assert core_with(transform(parent, child))._getFrameStrings() == []


def test_a_refused_transform_leaves_what_is_there() -> None:
    """One bad reading of a driver must not create a gap."""
    core = core_with(transform("p", "c", 10.0))
    core.set_transform(transform("p", "c", 11.0, (nan, 0.0, 0.0)), "me")

    assert core.get_latest_common_time("p", "c") == at(10)
    assert parts(core.lookup_transform_core("p", "c", at(10))) == (1, 0, 0, 0, 0, 0, 1)


@pytest.mark.parametrize(
    ("rotation", "is_valid"),
    [
        ((1.0, 0.0, 0.0, 0.0), True),
        ((0.0, 0.0, 0.0, 0.0), False),
        ((0.0, 1.0, 0.0, 0.0), True),
        ((0.0, 1.0, 1.0, 0.0), False),
        ((0.0, 0.0, 1.0, 0.0), True),
        ((0.0, 0.0, 1.0, 1.0), False),
        ((0.0, 0.0, 0.0, 1.0), True),
        ((0.0, 0.0, HALF, 1.0), False),
        ((0.0, 0.0, HALF, HALF), True),
        ((0.0, 0.0, HALF + 0.01, HALF), False),
        ((0.0, 0.0, HALF - 0.01, HALF), False),
    ],
)
def test_a_rotation_is_taken_if_its_length_is_1(
    rotation: tuple[float, float, float, float], is_valid: bool
) -> None:
    """It is tested along each axis, and on both sides of the limit."""
    core = core_with(transform("p", "c", rotation=rotation))

    assert core.can_transform_core("p", "c", at(1))[0] is is_valid


# Trees

EVALUATED = [(when, space) for when in (1.0, 10.0, 0.0) for space in (1.0, 0.001, 0.1, 0.0)]
"""Times of questions, and how far apart the samples around them are, in seconds."""

TREES: dict[str, dict[str, tuple[str, tuple[float, float]]]] = {
    "one link": {"2": ("1", (1, 0))},
    "i": {"b": ("a", (1, 0)), "c": ("b", (1, 0))},
    "v": {"b": ("a", (1, 0)), "c": ("b", (1, 0)), "f": ("a", (0, 1)), "g": ("f", (0, 1))},
    "y": {"b": ("a", (1, 0)), "c": ("b", (1, 0)), "d": ("b", (0, 1)), "e": ("d", (0, 1))},
}
TREES["two trees"] = TREES["one link"] | TREES["v"]


@pytest.mark.parametrize(("when", "space"), EVALUATED)
@pytest.mark.parametrize("name", TREES)
def test_each_pair_of_frames_is_answered_for_the_time_that_was_asked_for(
    name: str, when: float, space: float
) -> None:
    """With one sample or two, also at time 0, and never between two trees."""
    tree = TREES[name]
    core = BufferCore()
    for child, (parent, (x, y)) in tree.items():
        for stamp in (max(when - space / 2, 0.0), when):
            core.set_transform(transform(parent, child, stamp, (x, y, 0.0)), "me")

    def root_and_place(frame: str) -> tuple[str, float, float]:
        if frame not in tree:
            return frame, 0.0, 0.0
        parent, (x, y) = tree[frame]
        root, above_x, above_y = root_and_place(parent)
        return root, above_x + x, above_y + y

    for target, source in itertools.product(core._getFrameStrings(), repeat=2):
        (root, x, y), (other_root, other_x, other_y) = map(root_and_place, (target, source))
        assert core.can_transform_core(target, source, at(when))[0] is (root == other_root)
        if root != other_root:
            with pytest.raises(ConnectivityException):
                core.lookup_transform_core(target, source, at(when))
            continue
        found = core.lookup_transform_core(target, source, at(when))
        assert parts(found) == pytest.approx((other_x - x, other_y - y, 0, 0, 0, 0, 1), abs=1e-12)
        stamp_of_answer = found.header.stamp
        assert stamp_of_answer.sec + stamp_of_answer.nanosec / 1e9 == when


def test_each_pair_on_a_ring_is_where_the_ring_has_it() -> None:
    """Nine frames are 45 degrees apart on the unit circle: the last one equals the first."""
    frames = "abcdefghi"
    x, y = cos(radians(45)) - 1, sin(radians(45))
    core = core_with(
        *(
            transform(parent, child, stamp, (x, y, 0.0), yaw=radians(45))
            for stamp in (1.0, 3.0)
            for parent, child in itertools.pairwise(frames)
        )
    )
    for first, second in itertools.product(range(9), repeat=2):
        angle = radians(45) * (second - first)
        found = parts(core.lookup_transform_core(frames[first], frames[second], at(2)))
        sign = 1 if found[6] * cos(angle / 2) + found[5] * sin(angle / 2) > 0 else -1
        expected = (
            *(cos(angle) - 1, sin(angle), 0),
            *(0, 0, sign * sin(angle / 2), sign * cos(angle / 2)),
        )
        assert found == pytest.approx(expected, abs=1e-12)


def test_of_two_parents_at_one_time_the_last_to_come_holds() -> None:
    """A frame has only one parent."""
    core = core_with(transform("one", "c", 5.0), transform("two", "c", 5.0))

    for time in (at(5), LATEST):
        assert core.can_transform_core("two", "c", time)[0]
        assert not core.can_transform_core("one", "c", time)[0]


# Times

CHILDREN = core_with(
    *(transform("parent", child, t) for t in range(10, 20) for child in ("child", "other"))
)
TIMES = {"latest": LATEST, "old": at(5), "valid": at(15), "future": at(25)}


@pytest.mark.parametrize("time", TIMES)
def test_whether_there_is_data_decides_except_for_a_frame_and_itself(time: str) -> None:
    """`can_transform` and the lookup agree."""
    for target, source in itertools.product(("child", "other", "parent", "nobody"), repeat=2):
        if target != source and "nobody" in (target, source):
            continue
        expected = target == source or time in ("latest", "valid")
        assert CHILDREN.can_transform_core(target, source, TIMES[time])[0] is expected
        if expected:
            CHILDREN.lookup_transform_core(target, source, TIMES[time])
        else:
            with pytest.raises(ExtrapolationException):
                CHILDREN.lookup_transform_core(target, source, TIMES[time])


@pytest.mark.parametrize(("target_time", "source_time"), list(itertools.product(TIMES, repeat=2)))
@pytest.mark.parametrize(
    ("source", "fixed"), [("parent", "child"), ("other", "child"), ("parent", "parent")]
)
def test_of_two_times_only_that_of_a_frame_other_than_the_fixed_one_needs_data(
    source: str, fixed: str, target_time: str, source_time: str
) -> None:
    """A frame seen from itself needs no data."""
    expected = (fixed == "child" or target_time in ("latest", "valid")) and (
        source == fixed or source_time in ("latest", "valid")
    )
    question = ("child", TIMES[target_time], source, TIMES[source_time], fixed)

    assert CHILDREN.can_transform_full_core(*question)[0] is expected
    if expected:
        CHILDREN.lookup_transform_full_core(*question)
    else:
        with pytest.raises(ExtrapolationException):
            CHILDREN.lookup_transform_full_core(*question)


@pytest.mark.parametrize(("target", "source"), [("top", "c"), ("c", "top"), ("p", "c"), ("c", "p")])
def test_data_is_missing_upwards_and_downwards_over_one_link_and_two(
    target: str, source: str
) -> None:
    """It is tested with one sample and with two."""
    core = core_with(transform("top", "p", 2.0), transform("p", "c", 2.0))

    def check(seconds: float, error: type[TransformException]) -> None:
        with pytest.raises(error):
            core.lookup_transform_core(target, source, at(seconds))
        assert not core.can_transform_core(target, source, at(seconds))[0]

    check(1, NoDataForExtrapolationException)
    check(4, NoDataForExtrapolationException)
    for parent, child in (("top", "p"), ("p", "c")):
        core.set_transform(transform(parent, child, 4.0), "me")
    check(1, BackwardExtrapolationException)
    check(5, ForwardExtrapolationException)
    assert core.can_transform_core(target, source, at(3)) == (True, "")


def test_the_latest_common_time_is_the_same_in_both_directions() -> None:
    """It advances with the link that lags behind."""
    core = core_with(transform("top", "p", 2.0), transform("p", "a", 1.0))
    assert core.get_latest_common_time("a", "top") == at(1)
    core.set_transform(transform("p", "a", 3.0), "me")
    assert core.get_latest_common_time("a", "top") == at(2)
    more = (("p", "b", 4.0), ("b", "c", 3.0), ("c", "d", 9.0), ("f", "e", 5.0))
    for parent, child, stamp in more:
        core.set_transform(transform(parent, child, stamp), "me")

    for other in ("b", "c", "d"):
        for frames in itertools.permutations(("a", other)):
            assert core.get_latest_common_time(*frames) == at(3)
    for frames in itertools.permutations(("e", "f")):
        assert core.get_latest_common_time(*frames) == at(5)
    assert core.lookup_transform_core("p", "b", LATEST).header.stamp.sec == 4


# Static transforms


def test_a_static_transform_answers_with_the_time_that_was_asked_for() -> None:
    """Its own stamp does not matter; repeating it changes nothing."""
    core = BufferCore()
    core.clear()
    for _ in range(2):
        core.set_transform_static(transform("p", "c", 1.1), "me")
        found = core.lookup_transform_core("p", "c", at(1.5))
        assert (found.header.stamp.sec, found.header.stamp.nanosec) == (1, 500_000_000)
        assert parts(found) == (1, 0, 0, 0, 0, 0, 1)
        assert parts(core.lookup_transform_core("p", "c", at(0.1))) == parts(found)


def test_a_frame_with_forgotten_history_may_become_static() -> None:
    """A driver may restart in another mode."""
    core = core_with(transform("p", "c", 1.0))
    core.clear()
    core.set_transform_static(transform("p", "c", 1.0, (5.0, 0.0, 0.0)), "me")

    assert parts(core.lookup_transform_core("p", "c", at(2)))[0] == 5.0


# Names, and velocities


def test_a_frame_exists_once_it_is_named_as_child_or_parent() -> None:
    """Names have no leading slash, and are listed in order of arrival."""
    core = BufferCore()
    assert not core._frameExists("b")
    core.set_transform(transform("/parent", "/b"), "me")
    assert core._getFrameStrings() == ["b", "parent"]
    assert [core._frameExists(name) for name in ("b", "parent", "other")] == [True, True, False]
    core.set_transform(transform("frame", "other"), "me")
    assert core._getFrameStrings() == ["b", "parent", "other", "frame"]
    assert core._frameExists("frame")


def test_a_velocity_at_the_latest_time_takes_the_data_there_is() -> None:
    """The interval may exceed the data, and stamps may be clock times, as in tf2_py's test."""
    core = BufferCore()
    for second in range(5):
        one = transform("P", "C", 0.0, (3.0 * second, 0.0, 0.0))
        one.header.stamp = Time(seconds=second)  # type: ignore[assignment]
        core.set_transform(one, "me")
    interval = Duration(seconds=4, nanoseconds=1_000_000)

    found = core.lookupVelocityCore("C", "P", LATEST, interval)
    assert found[0] == pytest.approx((3, 0, 0))
    assert found == core.lookupVelocityFullCore(
        "C", "P", "P", (0.0, 0.0, 0.0), "C", LATEST, interval
    )
