"""Tests of the tree of frames, taken from tf2's tests of its core in C++ and Python."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from aionode.clock import Duration, Time
from aionode.errors import (
    BackwardExtrapolationException,
    ConnectivityException,
    ExtrapolationException,
    ForwardExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NoDataForExtrapolationException,
    TransformException,
)
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.logging import get_logger
from aionode.tf import BufferCore
from aionode.tf.buffer_core import MAX_NAME
from tests.support.transforms import parts, transform

LATEST = Time()
HALF = math.sqrt(0.5)


def at(seconds: float) -> Time:
    """Return a time."""
    return Time(nanoseconds=round(seconds * 1e9))


def core_with(*transforms: TransformStamped, static: bool = False) -> BufferCore:
    """Return a core with some transforms."""
    core = BufferCore()
    for one in transforms:
        (core.set_transform_static if static else core.set_transform)(one, "me")
    return core


@pytest.fixture
def logged() -> Iterator[list[str]]:
    """Return what is logged about refused transforms."""
    texts: list[str] = []
    remove = get_logger("tf2_buffer").add_sink(lambda event: texts.append(event.msg))
    yield texts
    remove()


# What is refused


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        (
            transform("same", "same"),
            (
                'TF_SELF_TRANSFORM: Ignoring transform from authority "/arm" with frame_id and  '
                'child_frame_id "same" because they are the same'
            ),
        ),
        (
            transform("same", "/same"),
            (
                'TF_SELF_TRANSFORM: Ignoring transform from authority "/arm" with frame_id and  '
                'child_frame_id "same" because they are the same'
            ),
        ),
        (
            transform("parent", ""),
            (
                'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "/arm" because '
                "child_frame_id not set "
            ),
        ),
        (
            transform("", "child"),
            (
                'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "child"  from authority '
                '"/arm" because frame_id not set'
            ),
        ),
        (
            transform("parent", "child", translation=(math.nan, 2.0, 0.0)),
            (
                'TF_NAN_INPUT: Ignoring transform for child_frame_id "child" from authority "/arm" '
                "because of a nan value in the transform (nan 2.000000 0.000000) "
                "(0.000000 0.000000 0.000000 1.000000)"
            ),
        ),
        (
            transform("parent", "child", rotation=(0.0, 0.0, 0.0, math.nan)),
            (
                'TF_NAN_INPUT: Ignoring transform for child_frame_id "child" from authority "/arm" '
                "because of a nan value in the transform (1.000000 0.000000 0.000000) "
                "(0.000000 0.000000 0.000000 nan)"
            ),
        ),
        (
            transform("parent", "child", rotation=(0.0, 0.0, 0.0, 0.99)),
            (
                'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "child" from '
                'authority "/arm" because of an invalid quaternion in the transform (0.000000 '
                "0.000000 0.000000 0.990000)"
            ),
        ),
        (
            transform("parent", "c" * (MAX_NAME + 1)),
            (
                'TF_LONG_FRAME_ID: Ignoring transform from authority "/arm" because a frame id has '
                "more than 1000 characters"
            ),
        ),
    ],
)
def test_wrong_input_is_refused_as_in_tf2_and_logged_once(
    wrong: TransformStamped, text: str, logged: list[str]
) -> None:
    """A faulty sender repeats its mistake a hundred times a second."""
    core = BufferCore()
    for _ in range(3):
        core.set_transform(wrong, "/arm")

    assert logged.count(text) == 1
    assert core._getFrameStrings() == []


def test_what_is_older_than_the_cache_time_is_refused(logged: list[str]) -> None:
    """The log names the sender."""
    core = core_with(transform("p", "c", 20.0))
    core.set_transform(transform("p", "c", 9.5), "/late")
    core.set_transform(transform("p", "c", 9.4), "/late")

    assert logged == [
        (
            "TF_OLD_DATA ignoring data from the past for frame c at time 9.500000 according to "
            "authority /late\nPossible reasons are listed at "
            "http://wiki.ros.org/tf/Errors%20explained"
        )
    ]
    assert not core.can_transform_core("p", "c", at(9.5))[0]


@pytest.mark.slow
def test_a_flood_of_frames_takes_bounded_memory(
    logged: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Existing frames keep working."""
    monkeypatch.setattr("aionode.tf.buffer_core.MAX_FRAMES", 100)
    core = core_with(transform("p", "c", 1.0))
    for number in range(100_000):
        core.set_transform(transform("p", f"flood{number}"), "/flood")
    core.set_transform(transform("p", "c", 2.0), "me")

    assert len(core._getFrameStrings()) == 100
    assert logged == [
        (
            'TF_TOO_MANY_FRAMES: Ignoring new frames from authority "/flood" because the buffer '
            "has 100 frames already"
        )
    ]
    assert core.can_transform_core("p", "c", at(1.5))[0]


def test_two_senders_of_one_frame_are_named(logged: list[str]) -> None:
    """A node that replaces another one is fine; two that alternate are not."""
    core = BufferCore()
    core.set_transform(transform("p", "c", 1.0), "/one")
    core.set_transform(transform("p", "c", 2.0), "/two")
    assert logged == []
    for stamp in range(3, 9):
        core.set_transform(transform("p", "c", float(stamp)), ("/two", "/one")[stamp % 2])
    assert logged == [
        (
            'TF_TWO_BROADCASTERS: frame "c" is sent by /two and by /one in turns, so its transform '
            "jumps between theirs; stop one of them, or rename its frame"
        )
    ]


def test_a_leading_slash_is_left_out_on_insertion_and_refused_in_questions() -> None:
    """Empty names are refused as well, with tf2's messages."""
    core = core_with(transform("/a", "/b"))
    core.lookup_transform_core("a", "b", at(1))
    for question, text in (
        (("", "a"), "target_frame - in tf2 frame_ids cannot be empty"),
        (("b", ""), "source_frame - in tf2 frame_ids cannot be empty"),
        (("/b", "a"), "target_frame - in tf2 frame_ids cannot start with a '/'"),
        (("b", "/a"), "source_frame - in tf2 frame_ids cannot start with a '/'"),
    ):
        with pytest.raises(InvalidArgumentException) as caught:
            core.lookup_transform_core(*question, at(1))
        wrong = next(name for name in question if name not in "ab" or not name)
        assert (
            str(caught.value)
            == f'Invalid argument "{wrong}" passed to lookupTransform argument {text}'
        )
        assert core.can_transform_core(*question, at(1)) == (
            False,
            f'Invalid frame ID "{wrong}" passed to canTransform argument {text}',
        )


# Lookups


def test_nothing_is_there_at_first() -> None:
    """The errors are worded as in tf2."""
    core = BufferCore()
    with pytest.raises(LookupException) as caught:
        core.lookup_transform_core("a", "b", at(1))
    assert (
        str(caught.value) == '"a" passed to lookupTransform argument target_frame does not exist. '
    )
    assert core.can_transform_core("a", "b", at(1)) == (
        False,
        'Invalid frame ID "a" passed to canTransform argument target_frame - frame does not exist',
    )
    core.set_transform(transform("foo", "child"), "me")
    with pytest.raises(LookupException, match='"bar" passed to'):
        core.lookup_transform_core("foo", "bar", at(1))
    assert not core.can_transform_core("foo", "bar", at(1))[0]


def test_a_frame_seen_from_itself_is_where_it_is() -> None:
    """This holds even if the frame does not exist."""
    core = core_with(transform("p", "c", 3.0))
    assert parts(core.lookup_transform_core("x", "x", at(1))) == (0, 0, 0, 0, 0, 0, 1)
    assert core.lookup_transform_core("c", "c", LATEST).header.stamp.sec == 3
    assert core.can_transform_core("x", "x", at(1)) == (True, "")


CHILD = (1.0, 0.0, 0.0)
CONFIGURATIONS: dict[str, list[tuple[str, str, tuple[float, float, float]]]] = {
    "i": [("a", "b", CHILD), ("b", "c", CHILD)],
    "v": [
        ("a", "b", (1.0, 0.0, 0.0)),
        ("b", "c", (1.0, 0.0, 0.0)),
        ("a", "d", (0.0, 1.0, 0.0)),
        ("d", "e", (0.0, 1.0, 0.0)),
    ],
    "inverse v": [("a", "b", (1.0, 0.0, 0.0)), ("a", "c", (-1.0, 0.0, 0.0))],
    "y": [
        ("a", "b", (1.0, 0.0, 0.0)),
        ("b", "c", (1.0, 0.0, 0.0)),
        ("b", "d", (0.0, 1.0, 0.0)),
    ],
}


@pytest.mark.parametrize("name", CONFIGURATIONS)
@pytest.mark.parametrize("order", [0, 1])
def test_a_tree_without_rotations_adds_up(name: str, order: int) -> None:
    """This holds between any two frames, in whatever order the transforms came."""
    edges = CONFIGURATIONS[name]
    core = BufferCore()
    places = {"a": (0.0, 0.0, 0.0)}
    for parent, child, (x, y, z) in edges:
        px, py, pz = places[parent]
        places[child] = (px + x, py + y, pz + z)
    for stamp in (1.0, 2.0):
        for parent, child, offset in edges[:: 1 if order else -1]:
            core.set_transform(transform(parent, child, stamp, offset), "me")

    for target, source in itertools.product(places, repeat=2):
        for time in (at(1), at(1.5), at(2), LATEST):
            found = core.lookup_transform_core(target, source, time)
            expected = [s - t for s, t in zip(places[source], places[target], strict=True)]
            assert parts(found) == pytest.approx((*expected, 0, 0, 0, 1), abs=1e-12)
            assert (found.header.frame_id, found.child_frame_id) == (target, source)
            assert core.can_transform_core(target, source, time) == (True, "")


def test_eight_turns_of_45_degrees_come_back() -> None:
    """In tf2's ring, each frame is one step along a regular octagon."""
    frames = "abcdefghi"
    step = transform(
        "", "", 1.0, (math.sqrt(2) / 2 - 1, math.sqrt(2) / 2, 0.0), yaw=math.radians(45)
    ).transform
    core = BufferCore()
    for stamp in (1.0, 3.0):
        for parent, child in itertools.pairwise(frames):
            one = transform(parent, child, stamp)
            core.set_transform(
                TransformStamped(header=one.header, child_frame_id=child, transform=step), "me"
            )
    for first, second in itertools.product(range(9), repeat=2):
        found = core.lookup_transform_core(frames[first], frames[second], at(2))
        angle = math.radians(45) * (second - first)
        _, _, _, _, _, k, w = parts(found)
        assert 2 * math.atan2(k, w) % (2 * math.pi) == pytest.approx(
            angle % (2 * math.pi), abs=1e-9
        ) or math.isclose(abs(w), 1.0)
    closing = parts(core.lookup_transform_core("a", "i", at(2)))
    assert closing == pytest.approx((0, 0, 0, 0, 0, 0, 1), abs=1e-12)


def test_times_outside_of_the_data_are_refused_with_the_texts_of_tf2() -> None:
    """The three cases are a single value, too early and too late."""
    core = core_with(transform("foo", "bar", 2.0))
    way = ", when looking up transform from frame [bar] to frame [foo]"
    core.lookup_transform_core("foo", "bar", at(2))
    cases: list[tuple[type[TransformException], float, str]] = [
        (
            NoDataForExtrapolationException,
            4,
            (
                "Lookup would require extrapolation at time 4.000000, but only time 2.000000 is in "
                f"the buffer{way}"
            ),
        )
    ]
    check(core, cases)
    core.set_transform(transform("foo", "bar", 3.0), "me")
    cases = [
        (
            BackwardExtrapolationException,
            1,
            (
                "Lookup would require extrapolation into the past.  Requested time 1.000000 but "
                f"the earliest data is at time 2.000000{way}"
            ),
        ),
        (
            ForwardExtrapolationException,
            4,
            (
                "Lookup would require extrapolation into the future.  Requested time 4.000000 but "
                f"the latest data is at time 3.000000{way}"
            ),
        ),
    ]
    check(core, cases)


@pytest.mark.parametrize(
    ("target", "source"),
    [
        ("odom", "base_link"),
        ("base_link", "odom"),
        ("odom", "laser"),
        ("laser", "odom"),
        ("camera", "laser"),
        ("laser", "camera"),
    ],
)
def test_an_error_of_extrapolation_names_the_time_of_an_edge_of_the_way(
    target: str, source: str
) -> None:
    """Localization lags behind odometry, but its edge lies above the path and is not needed."""
    core = BufferCore()
    for stamp in (0.5, 1.0):
        core.set_transform(transform("map", "odom", stamp), "me")
    for stamp in (1.5, 2.0):
        core.set_transform(transform("odom", "base_link", stamp), "me")
    core.set_transform_static(transform("base_link", "laser", 0.0), "me")
    core.set_transform_static(transform("odom", "camera", 0.0), "me")
    with pytest.raises(ForwardExtrapolationException, match=r"latest data is at time 2\.000000"):
        core.lookup_transform_core(target, source, at(3))


def check(core: BufferCore, cases: list[tuple[type[TransformException], float, str]]) -> None:
    """Look foo ← bar up at several times."""
    for error, seconds, text in cases:
        with pytest.raises(error) as caught:
            core.lookup_transform_core("foo", "bar", at(seconds))
        assert isinstance(caught.value, ExtrapolationException)
        assert str(caught.value) == text
        assert core.can_transform_core("foo", "bar", at(seconds)) == (False, text)


def test_frames_of_two_trees_are_not_connected() -> None:
    """tf2's message lacks a space, and programs search for it as it is."""
    core = core_with(transform("a", "b"), transform("c", "d"))
    for time in (at(1), LATEST):
        with pytest.raises(ConnectivityException) as caught:
            core.lookup_transform_core("a", "d", time)
        assert str(caught.value) == (
            "Could not find a connection between 'a' and 'd' because they are not part of the "
            "same tree.Tf has two or more unconnected trees."
        )
    with pytest.raises(TransformException) as general:
        core.get_latest_common_time("a", "d")
    assert type(general.value) is TransformException


def test_a_loop_is_reported_and_ends() -> None:
    """It has no root, but tf2 stops after 1000 edges."""
    core = core_with(transform("b", "a"), transform("c", "b"), transform("a", "c"))
    core.set_transform(transform("x", "y"), "me")
    for time in (at(1), LATEST):
        with pytest.raises(LookupException) as caught:
            core.lookup_transform_core("y", "a", time)
        assert str(caught.value) == (
            "The tf tree is invalid because it contains a loop.\n"
            "Frame a exists with parent b.\nFrame b exists with parent c.\n"
            "Frame c exists with parent a.\nFrame y exists with parent x.\n\n"
        )
    assert core.can_transform_core("b", "a", at(1))[0]


def test_no_data_above_the_common_ancestor_is_no_obstacle() -> None:
    """Only the frames between the two are needed."""
    core = BufferCore()
    for stamp in (1.0, 10.0):
        core.set_transform(transform("parent", "a", stamp), "me")
        core.set_transform(transform("parent", "b", stamp), "me")
    core.set_transform(transform("grandparent", "parent", 1.0), "me")

    for target, source in (("b", "a"), ("parent", "a"), ("a", "parent")):
        assert core.can_transform_core(target, source, at(5)) == (True, "")
        core.lookup_transform_core(target, source, at(5))
    with pytest.raises(NoDataForExtrapolationException):
        core.lookup_transform_core("grandparent", "a", at(5))


def test_repeated_stamps_make_no_invalid_numbers() -> None:
    """If two poses have the same time, one of them is used."""
    core = core_with(transform("a", "b", 4.0, yaw=0.0), transform("a", "b", 4.0, yaw=1.0))
    for time in (at(4), LATEST):
        assert not any(map(math.isnan, parts(core.lookup_transform_core("a", "b", time))))


def test_a_frame_may_change_its_parent() -> None:
    """Each time has its own parent, even after lookups before the change."""
    core = core_with(*(transform("old", "c", t, (1.0, 0.0, 0.0)) for t in (1.0, 2.0)))
    assert parts(core.lookup_transform_core("old", "c", at(1.5)))[0] == 1.0
    for t in (3.0, 4.0):
        core.set_transform(transform("new", "c", t, (5.0, 0.0, 0.0)), "me")

    assert parts(core.lookup_transform_core("old", "c", at(1.5)))[0] == 1.0
    assert parts(core.lookup_transform_core("old", "c", at(2.5)))[0] == 1.0
    assert parts(core.lookup_transform_core("new", "c", at(3.5)))[0] == 5.0
    assert parts(core.lookup_transform_core("new", "c", LATEST))[0] == 5.0
    with pytest.raises(ConnectivityException):
        core.lookup_transform_core("old", "c", at(3.5))


def test_of_two_ways_the_one_from_the_source_upwards_is_taken() -> None:
    """A frame that has moved from below another frame to above it is found in both directions."""
    core = core_with(
        transform("b", "a", 1.0, (3.0, 0.0, 0.0)), transform("root", "a", 9.0, (5.0, 0.0, 0.0))
    )
    core.set_transform_static(transform("a", "b", 1.0, (7.0, 0.0, 0.0)), "me")
    core.can_transform_core("b", "a", LATEST)

    assert parts(core.lookup_transform_core("b", "a", at(1)))[0] == 3.0
    assert parts(core.lookup_transform_core("b", "a", at(9)))[0] == -7.0


def test_static_and_dynamic_transforms_replace_each_other() -> None:
    """The latest transform decides whether a frame is static."""
    core = core_with(transform("p", "c", 1.0))
    assert not core.can_transform_core("p", "c", at(0.5))[0]
    core.set_transform_static(transform("p", "c", 1.0), "me")
    assert core.can_transform_core("p", "c", at(0.5))[0]
    core.set_transform(transform("p", "c", 1.0), "me")
    assert not core.can_transform_core("p", "c", at(0.5))[0]


def test_the_latest_common_time_leaves_out_static_frames() -> None:
    """It is the oldest of the newest stamps on the path."""
    core = core_with(
        transform("map", "odom", 5.0),
        transform("odom", "base", 7.0),
        transform("map", "other", 3.0),
        transform("odom", "base", 4.0),
    )
    core.set_transform_static(transform("base", "camera", 1.0), "me")

    assert core.get_latest_common_time("map", "camera") == at(5)
    assert core.get_latest_common_time("camera", "odom") == at(7)
    assert core.get_latest_common_time("camera", "other") == at(3)
    assert core.get_latest_common_time("camera", "base") == LATEST
    assert core.get_latest_common_time("base", "base") == at(7)
    assert core.lookup_transform_core("map", "camera", LATEST).header.stamp.sec == 5
    with pytest.raises(LookupException) as caught:
        core.get_latest_common_time("map", "x")
    assert str(caught.value) == '"x" passed to get_latest_common_time does not exist. '


def test_clear_forgets_the_history_but_no_static_transform() -> None:
    """Names are kept as well."""
    core = core_with(transform("p", "c", 1.0))
    core.set_transform_static(transform("c", "s"), "me")
    assert core.can_transform_core("p", "s", LATEST)[0]
    core.clear()

    assert not core.can_transform_core("p", "c", LATEST)[0]
    assert core.can_transform_core("p", "c", at(1)) == (
        False,
        (
            "Lookup would require extrapolation at time 1.000000, but only time 0.000000 is in the "
            "buffer, when looking up transform from frame [c] to frame [p]"
        ),
    )
    assert core.can_transform_core("c", "s", at(9))[0]
    assert core._frameExists("p")
    core.set_transform(transform("p", "c", 2.0), "me")
    assert core.can_transform_core("p", "s", LATEST)[0]


def test_two_times_are_joined_by_a_fixed_frame() -> None:
    """An example is where the robot was a second ago, seen from where it is now."""
    core = core_with(*(transform("map", "robot", t, (t, 0.0, 0.0)) for t in (1.0, 2.0, 3.0)))

    found = core.lookup_transform_full_core("robot", at(3), "robot", at(1.5), "map")
    assert parts(found)[:3] == pytest.approx((-1.5, 0, 0))
    assert (found.header.stamp.sec, found.child_frame_id) == (3, "robot")
    assert core.can_transform_full_core("robot", at(3), "robot", at(1.5), "map") == (True, "")
    fails = core.can_transform_full_core("robot", at(4), "robot", at(1.5), "map")
    assert (fails[0], "into the future" in fails[1]) == (False, True)
    assert core.can_transform_full_core("robot", at(3), "robot", at(1), "x") == (
        False,
        'Invalid frame ID "x" passed to canTransform argument fixed_frame - frame does not exist',
    )
    with pytest.raises(LookupException, match="argument fixed_frame does not exist"):
        core.lookup_transform_full_core("robot", at(3), "robot", at(1), "x")


# tf2_py


def test_the_methods_have_the_names_arguments_and_results_of_tf2_py() -> None:
    """All 16 are called as in tf2_py's own tests."""
    core = BufferCore(Duration(seconds=10))
    assert core.set_transform(transform("bar", "foo", 0.0), "unittest") is None  # type: ignore[func-returns-value]
    later = transform("bar", "foo", 1.0, (2.0, 0.0, 0.0))
    core.set_transform(later, "unittest")
    questions: dict[str, Any] = {"target_frame": "foo", "source_frame": "bar"}
    assert core.can_transform_core(**questions, time=at(0.5)) == (True, "")
    assert "into the future" in core.can_transform_core(**questions, time=at(2.5))[1]
    assert core.lookup_transform_core("bar", "foo", time=LATEST) == later
    assert core.lookup_transform_core("bar", "foo", later.header.stamp) == later
    assert core.set_transform_static(transform("foo", "baz"), "unittest") is None  # type: ignore[func-returns-value]
    assert core.can_transform_full_core(
        target_frame="foo",
        target_time=LATEST,
        source_frame="baz",
        source_time=LATEST,
        fixed_frame="bar",
    ) == (True, "")
    assert core._getFrameStrings() == ["foo", "bar", "baz"]
    assert core._frameExists("bar")
    assert core._chain("bar", LATEST, "baz", LATEST, "bar") == ["baz", "foo", "bar"]
    with pytest.raises(TypeError, match="time must have sec and nanosec, or nanoseconds"):
        core.lookup_transform_core("bar", "foo", 1.0)
    core.clear()
    assert not core.can_transform_core(**questions, time=LATEST)[0]


def test_velocity_is_averaged_over_an_interval() -> None:
    """The cases are that of tf2_py's test, and a rotation."""
    core = core_with(*(transform("P", "C", float(t), (3.0 * t, 0.0, 0.0)) for t in range(5)))
    for t in range(5):
        core.set_transform(transform("P", "T", float(t), (0.0, 0.0, 0.0), yaw=0.1 * t), "me")
    interval = Duration(seconds=2)
    linear, angular = core.lookupVelocityCore("C", "P", at(2), interval)
    assert linear == pytest.approx((3, 0, 0))
    assert angular == pytest.approx((0, 0, 0))
    linear, angular = core.lookupVelocityCore("T", "P", at(2), interval)
    assert linear == pytest.approx((0, 0, 0))
    assert angular == pytest.approx((0, 0, 0.1))
    full = core.lookupVelocityFullCore("T", "P", "P", (0.0, 0.0, 0.0), "T", at(2), interval)
    assert full == (linear, angular)
    with pytest.raises(LookupException):
        core.lookupVelocityCore("x", "P", at(2.0), Duration(seconds=2))


# Texts about all frames


def texts(core: BufferCore) -> dict[str, Callable[[], str]]:
    """Return the methods that describe all frames."""
    return {
        "string": core.all_frames_as_string,
        "yaml": core.all_frames_as_yaml,
        "dot": core._allFramesAsDot,
    }


def test_all_frames_are_described_as_by_tf2() -> None:
    """The formats are lines, YAML and Graphviz."""
    core = core_with(*(transform("bar", "foo", t) for t in (1.0, 1.5)))

    assert core.all_frames_as_string() == "Frame foo exists with parent bar.\n"
    assert core.all_frames_as_yaml() == (
        "foo: \n  parent: 'bar'\n  broadcaster: 'me'\n  rate: 4.000\n"
        "  most_recent_transform: 1.500000\n  oldest_transform: 1.000000\n  buffer_length: 0.500\n"
    )
    assert core._allFramesAsDot(at(2)) == (
        'digraph G {\n"bar" -> "foo"[label="Broadcaster: me\\nAverage rate: 4.000 Hz\\n'
        'Most recent transform: 1.500000 ( 0.500 sec old)\\nBuffer length: 0.500 sec\\n"];\n'
        "edge [style=invis];\n subgraph cluster_legend { style=bold; color=black; "
        'label ="view_frames Result";\n"Recorded at time: 2.000000"[ shape=plaintext ] ;\n '
        '}->"bar";\n}'
    )


def test_an_empty_buffer_describes_itself() -> None:
    """The spelling is tf2's."""
    found = {name: text() for name, text in texts(BufferCore()).items()}
    assert found == {
        "string": "",
        "yaml": "[]",
        "dot": 'digraph G {\n"no tf data recieved"}',
    }
