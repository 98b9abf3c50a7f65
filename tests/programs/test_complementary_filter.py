"""The program that finds the orientation of an IMU."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode.interfaces.geometry_msgs.msg import Vector3, Vector3Stamped
from aionode.interfaces.sensor_msgs.msg import Imu, MagneticField
from aionode.interfaces.std_msgs.msg import Bool
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.programs._imu_tools.complementary_filter import GRAVITY, ComplementaryFilter
from aionode.programs._imu_tools.complementary_filter_node import ComplementaryFilterNode
from aionode.programs._imu_tools.quaternions import blended, product, rotated, tilt
from aionode.testing import settle
from tests.programs.conftest import Start

UP = (0.0, 0.0, GRAVITY)
NORTH = (0.3, 0.0, -0.4)
STILL = (0.0, 0.0, 0.0)


def tilted(roll: float, pitch: float) -> tuple[float, float, float]:
    """Return the measurements of an IMU that stands still at these angles."""
    return (
        -GRAVITY * math.sin(pitch),
        GRAVITY * math.cos(pitch) * math.sin(roll),
        GRAVITY * math.cos(pitch) * math.cos(roll),
    )


def angles(filter_: ComplementaryFilter) -> tuple[float, float, float]:
    """Return roll, pitch and yaw."""
    w, x, y, z = filter_.orientation
    return (
        math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x)))),
        math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    )


@pytest.mark.parametrize(("roll", "pitch"), [(0.0, 0.0), (0.4, 0.0), (0.0, -0.6), (2.5, 0.3)])
def test_the_first_message_tells_roll_and_pitch_by_gravity(roll: float, pitch: float) -> None:
    """Without a magnetometer the heading is arbitrary."""
    filter_ = ComplementaryFilter()

    assert filter_.update(tilted(roll, pitch), STILL, 0.01)

    up = rotated(tilted(roll, pitch), filter_.orientation)
    assert up == pytest.approx(UP)


@pytest.mark.parametrize("yaw", [0.0, 1.0, -2.0, math.pi])
def test_the_first_magnetic_field_tells_the_heading(yaw: float) -> None:
    """North is at a heading of zero."""
    filter_ = ComplementaryFilter()
    field = rotated(NORTH, (math.cos(yaw / 2), 0.0, 0.0, -math.sin(yaw / 2)))

    filter_.update(UP, STILL, 0.01, field)

    assert math.cos(angles(filter_)[2] - yaw) == pytest.approx(1.0)


def test_gyroscopes_turn_the_orientation() -> None:
    """Half a radian a second, for a second."""
    filter_ = ComplementaryFilter(gain_acc=0.0, estimates_bias=False)
    filter_.update(UP, STILL, 0.01)

    for _ in range(1000):
        filter_.update(UP, (0.0, 0.0, 0.5), 0.001)

    assert angles(filter_) == pytest.approx((0.0, 0.0, 0.5), abs=1e-6)


def test_gravity_takes_a_share_of_a_wrong_tilt_away() -> None:
    """At a gain of 0.5 and a small angle, half of it."""
    filter_ = ComplementaryFilter(gain_acc=0.5)
    filter_.update(tilted(0.1, 0.0), STILL, 0.01)

    filter_.update(UP, STILL, 0.01)

    assert angles(filter_)[0] == pytest.approx(0.05, abs=1e-4)


def test_the_magnetic_field_takes_a_share_of_a_wrong_heading_away() -> None:
    """It does so even where the other sensors say nothing new."""
    filter_ = ComplementaryFilter(gain_mag=0.5)
    filter_.update(UP, STILL, 0.01)

    filter_.update(UP, STILL, 0.01, rotated(NORTH, (math.cos(0.05), 0.0, 0.0, -math.sin(0.05))))

    assert angles(filter_)[2] == pytest.approx(0.05, abs=1e-4)


@pytest.mark.parametrize(("factor", "left"), [(1.05, 0.05), (1.15, 0.075), (1.3, 0.1)])
def test_gravity_counts_less_while_the_robot_accelerates(factor: float, left: float) -> None:
    """It counts fully below an error of 10 %, and not at all from 20 % on."""
    filter_ = ComplementaryFilter(gain_acc=0.5, has_adaptive_gain=True)
    filter_.update(tilted(0.1, 0.0), STILL, 0.01)

    filter_.update((0.0, 0.0, factor * GRAVITY), STILL, 0.01)

    assert angles(filter_)[0] == pytest.approx(left, abs=1e-4)


def test_the_bias_is_learned_while_it_stands_still() -> None:
    """A share of it is learned at each step; a robot that accelerates does not stand still."""
    filter_ = ComplementaryFilter(bias_alpha=0.1)
    filter_.update(UP, STILL, 0.01)

    filter_.update(UP, (0.0, 0.0, 0.01), 0.01)
    assert filter_.bias == pytest.approx((0.0, 0.0, 0.001))
    assert filter_.is_still
    filter_.update((3.0, 0.0, GRAVITY), (0.0, 0.0, 0.01), 0.01)
    assert filter_.bias == pytest.approx((0.0, 0.0, 0.001))
    assert not filter_.is_still


def test_a_turn_is_not_taken_for_a_bias() -> None:
    """It begins with a change."""
    filter_ = ComplementaryFilter(bias_alpha=0.1)
    filter_.update(UP, STILL, 0.01)

    filter_.update(UP, (0.0, 0.0, 0.1), 0.01)

    assert filter_.bias == STILL


@pytest.mark.parametrize(
    "given",
    [
        ((math.nan, 0.0, 1.0), STILL, 0.01),
        (UP, (0.0, math.inf, 0.0), 0.01),
        (UP, STILL, math.nan),
        (UP, (1e308, 1e308, 1e308), 10.0),
    ],
)
def test_numbers_that_are_not_finite_change_nothing(given: Any) -> None:
    """They would stay in the estimate forever."""
    filter_ = ComplementaryFilter()
    filter_.update(UP, STILL, 0.01)

    assert not filter_.update(*given)
    assert filter_.orientation == (1.0, 0.0, 0.0, 0.0)


def test_a_field_too_strong_for_numbers_is_no_first_heading() -> None:
    """It would stay in the estimate forever."""
    filter_ = ComplementaryFilter()

    assert not filter_.update(tilted(0.4, 0.5), STILL, 0.01, (1.79e308, 1.79e308, 1.79e308))
    assert filter_.update(UP, STILL, 0.01, NORTH)
    assert angles(filter_) == pytest.approx(STILL)


def test_a_gravity_too_weak_to_be_turned_is_free_fall() -> None:
    """Half of the smallest number is none, which has no direction."""
    filter_ = ComplementaryFilter(_world=(0.5, 0.5, 0.5, 0.5))

    assert filter_.update((5e-324, 0.0, 0.0), STILL, 0.01)


def test_free_fall_and_a_magnetic_pole_only_leave_the_gyroscopes() -> None:
    """They contain no direction."""
    filter_ = ComplementaryFilter()
    assert not filter_.update(STILL, STILL, 0.01)
    filter_.update(UP, STILL, 0.01)

    assert filter_.update(STILL, STILL, 0.01, (0.0, 0.0, -1.0))
    assert angles(filter_) == pytest.approx(STILL)


def test_an_imu_that_is_upside_down_is_turned_along_the_arc() -> None:
    """Half of half a turn."""
    assert tilt((0.0, 0.0, -1.0)) == pytest.approx((0.0, 1.0, 0.0, 0.0))
    assert blended((-0.5, math.sqrt(0.75), 0.0, 0.0), 0.5) == pytest.approx(
        (0.5, math.sqrt(0.75), 0.0, 0.0)
    )
    assert product((0.0, 1.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)) == (-1.0, 0.0, 0.0, 0.0)


class Wires:
    """The topics of the program."""

    def __init__(self, node: Any) -> None:
        self.imu = node.create_publisher(Imu, "imu/data_raw", 10)
        self.magnetometer = node.create_publisher(MagneticField, "imu/mag", 10)
        self.found: list[Imu] = []
        self.angles: list[Vector3] = []
        self.still: list[bool] = []
        self.transforms: list[Any] = []
        node.create_subscription(Imu, "imu/data", self.found.append)
        node.create_subscription(
            Vector3Stamped, "imu/rpy/filtered", lambda msg: self.angles.append(msg.vector)
        )
        node.create_subscription(Bool, "imu/steady_state", lambda msg: self.still.append(msg.data))
        node.create_subscription(
            TFMessage, "/tf", lambda msg: self.transforms.extend(msg.transforms)
        )
        self.count = 0

    async def measure(
        self, acceleration: tuple[float, ...] = UP, turning: tuple[float, ...] = STILL
    ) -> None:
        """Publish a message, 10 ms after the last one."""
        self.count += 1
        msg = Imu()
        msg.header.frame_id = "imu_link"
        msg.header.stamp.sec, msg.header.stamp.nanosec = 1, self.count * 10_000_000
        x, y, z = acceleration
        msg.linear_acceleration = Vector3(x=x, y=y, z=z)
        x, y, z = turning
        msg.angular_velocity = Vector3(x=x, y=y, z=z)
        self.imu.publish(msg)
        await settle()


@pytest.fixture
def wires(start: Start, node_factory: Callable[..., Any]) -> Callable[..., Any]:
    """Start the program."""

    async def make(**parameters: Any) -> Wires:
        start(ComplementaryFilterNode, **parameters)
        result = Wires(node_factory("driver"))
        await settle()
        return result

    return make


async def test_messages_get_an_orientation_from_the_second_one_on(
    wires: Callable[..., Any],
) -> None:
    """The first one sets the time from which seconds are counted."""
    robot = await wires(orientation_stddev=0.1)
    await robot.measure()
    assert robot.found == []
    await robot.measure(tilted(0.4, 0.0))

    (msg,) = robot.found
    assert (msg.orientation.x, msg.orientation.w) == pytest.approx((math.sin(0.2), math.cos(0.2)))
    assert list(msg.orientation_covariance) == pytest.approx([0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01])
    assert msg.header.frame_id == "imu_link"


async def test_the_bias_is_taken_away_from_the_angular_velocity(
    wires: Callable[..., Any],
) -> None:
    """Whoever integrates it drifts less."""
    robot = await wires(bias_alpha=0.5)
    for _ in range(3):
        await robot.measure(UP, (0.0, 0.0, 0.008))

    assert robot.found[-1].angular_velocity.z == pytest.approx(0.004)


async def test_the_time_between_messages_may_be_given(wires: Callable[..., Any]) -> None:
    """For drivers whose stamps jitter."""
    robot = await wires(constant_dt=0.5, gain_acc=0.0, do_bias_estimation=False)
    for _ in range(3):
        await robot.measure(UP, (0.0, 0.0, 0.2))

    msg = robot.found[-1]
    assert 2 * math.atan2(msg.orientation.z, msg.orientation.w) == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize(
    ("reverse", "frames", "sign"),
    [(False, ("map", "imu_link"), 1.0), (True, ("imu_link", "map"), -1.0)],
)
async def test_the_orientation_is_broadcast_in_either_direction(
    wires: Callable[..., Any], reverse: bool, frames: tuple[str, str], sign: float
) -> None:
    """If another program already broadcasts where the IMU is, it cannot be a child twice."""
    robot = await wires(publish_tf=True, reverse_tf=reverse, fixed_frame="map")
    await robot.measure()
    await robot.measure(tilted(0.4, 0.0))

    (transform,) = robot.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == frames
    assert transform.transform.rotation.x == pytest.approx(sign * math.sin(0.2))


async def test_debug_topics_have_the_angles_and_whether_it_stands_still(
    wires: Callable[..., Any],
) -> None:
    """They are published if parameters ask for them."""
    robot = await wires(publish_debug_topics=True)
    await robot.measure()
    await robot.measure(tilted(0.4, 0.0))
    await robot.measure(tilted(0.4, 0.0))

    assert robot.angles[0].x == pytest.approx(0.4)
    assert robot.still == [False, True]


async def test_with_a_magnetometer_both_messages_count(wires: Callable[..., Any]) -> None:
    """Messages with about the same stamp are combined."""
    robot = await wires(use_mag=True)
    for _ in range(2):
        await robot.measure()
        msg = MagneticField(magnetic_field=Vector3(x=0.0, y=0.3, z=-0.4))
        msg.header.stamp.sec, msg.header.stamp.nanosec = 1, robot.count * 10_000_000
        robot.magnetometer.publish(msg)
        await settle()

    (found,) = robot.found
    assert 2 * math.atan2(found.orientation.z, found.orientation.w) == pytest.approx(-math.pi / 2)


async def test_messages_that_cannot_be_used_are_named_and_ignored(
    wires: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Others may publish anything."""
    robot = await wires()
    await robot.measure()
    await robot.measure((math.nan, 0.0, 0.0))
    assert robot.found == []
    await robot.measure()

    assert len(robot.found) == 1
    assert "not finite, is ignored" in caplog.text


async def test_shares_beyond_one_are_named_and_not_used(
    wires: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """With the words of the original."""
    await wires(gain_acc=2.0, bias_alpha=-1.0, constant_dt=-1.0, gain_mag=3.0)

    assert "Invalid gain_acc passed to ComplementaryFilter." in caplog.text
    assert "Invalid bias_alpha passed" in caplog.text
    assert "constant_dt parameter is -1.000000, must be >= 0.0" in caplog.text
    assert "gain_mag" not in caplog.text
