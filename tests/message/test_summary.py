"""Summaries of messages, for people and agents."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from aionode.errors import MessageError
from aionode.idl import define
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.interfaces.geometry_msgs.msg import Point, PoseStamped, Quaternion
from aionode.interfaces.nav_msgs.msg import Odometry, Path
from aionode.interfaces.sensor_msgs.msg import Image, LaserScan
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.message import Message, summarize
from aionode.message._units import unit_of
from tests.support.strategies import any_messages


def length(summary: dict[str, Any]) -> int:
    """Return the bytes of a summary as JSON."""
    return len(json.dumps(summary, ensure_ascii=False, allow_nan=False).encode())


@settings(suppress_health_check=[HealthCheck.too_slow])
@given(any_messages(), st.integers(64, 3000))
def test_no_summary_is_longer_than_its_limit(message: Message, limit: int) -> None:
    """A model's context has limited room, whatever robots publish; and JSON has no NaN."""
    assert length(summarize(message, limit)) <= limit


def test_large_numbers_fit_as_json_writes_them() -> None:
    """`json.dumps` writes 1e+17, other encoders 1e17."""
    message = Quaternion(x=1e17, y=1e17, z=1e17, w=1e17)

    assert [n for n in range(64, 300) if length(summarize(message, n)) > n] == []


def test_a_long_array_is_described() -> None:
    """Its extent says more than its first hundred numbers; float32 has no digits beyond its own."""
    ranges = np.linspace(0.1, 9, 360, dtype=np.float32)
    ranges[3] = np.inf

    assert summarize(LaserScan(ranges=ranges))["value"]["ranges"] == {
        "shape": [360],
        "dtype": "float32",
        "min": 0.1,
        "max": 9.0,
        "head": [0.1, 0.1247911, 0.1495822, "Infinity", 0.1991643, 0.2239554, 0.2487465, 0.2735376],
    }


def test_bytes_and_messages_are_described_as_well() -> None:
    """An image of megabytes, a path of thousands of poses."""
    image = summarize(Image(data=b"abc" * 1_000_000))["value"]["data"]
    path = summarize(Path(poses=[PoseStamped(header=Header(frame_id="map"))] * 1000))

    assert image == {"shape": [3_000_000], "dtype": "uint8", "head": [97, 98, 99] * 2 + [97, 98]}
    assert path["value"]["poses"]["shape"] == [1000]
    assert path["value"]["poses"]["type"] == "geometry_msgs/msg/PoseStamped"
    assert path["value"]["poses"]["head"][0]["header"]["frame_id"] == "map"


def test_a_long_string_is_cut() -> None:
    """Its length is given, so that the beginning is not taken for the whole."""
    assert summarize(String(data="x" * 5000), 100)["value"]["data"].endswith(
        "x... (5000 characters)"
    )


def test_units_stand_beside_the_values_by_their_paths() -> None:
    """They come from the comments of fields, including nested messages and array elements."""
    assert summarize(Odometry())["units"] == {
        "pose.pose.position": "m",
        "twist.twist.linear": "m/s",
        "twist.twist.angular": "rad/s",
    }
    assert summarize(Path(poses=[PoseStamped()]))["units"] == {"poses[].pose.position": "m"}
    assert summarize(Point())["units"] == {"": "m"}


def test_units_of_definitions_of_others_are_found() -> None:
    """The authors of ``.msg`` files write units in many ways."""
    battery = define("tutorial/msg/Cell", "float32 heat # Temperature in degrees Celsius\nint8 n")

    assert summarize(battery())["units"] == {"heat": "°C"}


@pytest.mark.parametrize(
    ("comment", "unit"),
    [
        ("Linear velocity in meters per second.", "m/s"),
        ("speed [m/s]", "m/s"),
        ("acceleration (m/s^2)", "m/s²"),
        ("in rad/sec", "rad/s"),
        ("In N·m", "N·m"),
        ("about x, y and z, in (rad/s)².", "(rad/s)²"),
        ("in m, from the base; longer ones in m are none", "m"),
        ("In m and rad", None),
        ("[m], or [rad] for a turning joint", None),
        ("The joint(s) in use", None),
        ("In a box", None),
        ("in steps", None),
        ("from [0, 1]", None),
        ("In square meters", None),
        ("in seconds_per_step", None),
    ],
)
def test_a_comment_tells_one_unit_or_none(comment: str, unit: str | None) -> None:
    """A wrong unit is worse than none."""
    assert unit_of(comment) == unit


def test_what_has_no_room_is_counted() -> None:
    """The reader learns that there is more."""
    assert summarize(LaserScan(), 100) == {
        "type": "sensor_msgs/msg/LaserScan",
        "value": {"angle_min": 0.0, "angle_max": 0.0},
        "left_out": 8,
    }


def test_a_message_of_very_many_values_is_summarized_in_few_steps() -> None:
    """A robot's diagnostics may have a thousand statuses of a thousand values each."""
    status = DiagnosticStatus(name="motor", message="x" * 1000)

    assert summarize(DiagnosticArray(status=[status] * 1000), 500)["value"]["status"]["shape"] == [
        1000
    ]


def test_an_invalid_message_and_a_limit_without_room_are_refused() -> None:
    """The error names the field, or a limit that would do."""
    with pytest.raises(MessageError, match="data"):
        summarize(String(data=5))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="at least 64"):
        summarize(String(), 10)
