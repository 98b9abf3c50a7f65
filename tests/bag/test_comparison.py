"""The differences between two recordings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from aionode import bag
from aionode.bag import Outputs
from aionode.clock import Time
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Float64, String

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture
def outputs(tmp_path: Path) -> Callable[..., Outputs]:
    """Return a function that makes outputs of triples: topic, message, milliseconds."""
    count = 0

    def make(*messages: tuple[str, Any, int]) -> Outputs:
        nonlocal count
        count += 1
        path = tmp_path / str(count)
        with bag.BagWriter(path) as writer:
            for topic, message, at_ms in messages:
                writer.write_message(topic, message, Time(nanoseconds=at_ms * 1_000_000))
        with bag.open(path) as made:
            return Outputs(made.read())

    return make


def test_a_recording_does_not_differ_from_itself(outputs: Callable[..., Outputs]) -> None:
    """This holds even where it contains NaN."""
    one = outputs(("/x", Float64(data=math.nan), 1), ("/y", String(data="a"), 2))

    assert bag.compare(one, one.records) == []


def test_a_difference_has_topic_time_and_field(outputs: Callable[..., Outputs]) -> None:
    """It says where to look, in the program and in the recording."""
    a = outputs(("/a", String(), 100), ("/cmd", Twist(linear=Vector3(x=1.0)), 350))
    b = outputs(("/a", String(), 100), ("/cmd", Twist(linear=Vector3(x=1.5)), 350))

    (difference,) = bag.compare(a, b)

    assert str(difference) == "/cmd at 0.250000 s: linear.x: 1.0 != 1.5"
    assert difference.time_ns == 350_000_000
    assert (difference.field, difference.left, difference.right) == ("linear.x", 1.0, 1.5)


@pytest.mark.parametrize(
    ("tolerance", "differs"),
    [
        (0.4, True),
        (0.6, False),
        ({"/cmd": 0.6}, False),
        ({"/other": 0.6}, True),
        ({"/cmd linear.x": 0.6}, False),
        ({"/cmd": 0.6, "/cmd linear.x": 0.4}, True),
    ],
)
def test_numbers_may_differ_by_the_tolerance(
    outputs: Callable[..., Outputs], tolerance: Any, differs: bool
) -> None:
    """For all topics, for one, or for one field; the closest one counts."""
    a = outputs(("/cmd", Twist(linear=Vector3(x=1.0)), 1))
    b = outputs(("/cmd", Twist(linear=Vector3(x=1.5)), 1))

    assert bool(bag.compare(a, b, tolerance)) is differs


def test_elements_and_lengths_of_sequences_are_named(outputs: Callable[..., Outputs]) -> None:
    """A message of a hundred joints may differ in a single one."""
    a = outputs(("/j", JointState(name=["a", "b"], position=[1.0, 2.0]), 1))
    b = outputs(("/j", JointState(name=["a", "b"], position=[1.0, 3.0]), 1))
    c = outputs(("/j", JointState(name=["a"], position=[1.0, 2.0]), 1))

    assert [each.field for each in bag.compare(a, b)] == ["position[1]"]
    assert [each.field for each in bag.compare(a, c, tolerance=9)] == ["len(name)"]


def test_missing_messages_times_and_types_are_differences(outputs: Callable[..., Outputs]) -> None:
    """Whatever a reader of the topic could notice."""
    a = outputs(("/x", String(data="a"), 1), ("/x", String(data="b"), 2))

    assert [each.field for each in bag.compare(a, outputs(("/x", String(data="a"), 1)))] == [
        "message"
    ]
    assert [each.field for each in bag.compare(outputs(), a)] == ["message", "message"]
    late = outputs(("/x", String(data="a"), 1), ("/x", String(data="b"), 4))
    assert [each.field for each in bag.compare(a, late)] == ["time"]
    assert bag.compare(a, late, time_tolerance_sec=0.002) == []
    other = outputs(("/x", String(data="a"), 1), ("/x", Float64(), 2))
    assert [each.field for each in bag.compare(a, other)] == ["type"]


def test_so_many_differences_of_each_topic_are_listed(outputs: Callable[..., Outputs]) -> None:
    """A topic that differs everywhere does not hide the others."""
    a = outputs(*[("/a", Float64(data=float(i)), i) for i in range(50)], ("/b", String(), 99))
    b = outputs(*[("/a", Float64(data=-1.0), i) for i in range(50)], ("/b", String(data="x"), 99))

    found = bag.compare(a, b, limit=3)

    assert [each.topic for each in found] == ["/a", "/a", "/a", "/b"]
