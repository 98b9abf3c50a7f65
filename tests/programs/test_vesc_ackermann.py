"""The programs between the commands of a car and its VESC."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.ackermann_msgs.msg import AckermannDrive, AckermannDriveStamped
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.std_msgs.msg import Float64, Header
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.interfaces.vesc_msgs.msg import VescState, VescStateStamped
from aionode.programs._vesc.ackermann_to_vesc_node import AckermannToVesc
from aionode.programs._vesc.vesc_to_odom_node import VescToOdom
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

SPEED_GAIN = 4614.0
GAINS: dict[str, Any] = {
    "speed_to_erpm_gain": SPEED_GAIN,
    "speed_to_erpm_offset": 100.0,
    "steering_angle_to_servo_gain": -1.2135,
    "steering_angle_to_servo_offset": 0.5304,
}
CAR: dict[str, Any] = GAINS | {"wheelbase": 0.25}
STEP_SEC = 0.02


class Driver:
    """Commands, and hears what reaches the VESC."""

    def __init__(self, node: Node) -> None:
        self.erpms: list[float] = []
        self.servos: list[float] = []
        self.publisher = node.create_publisher(AckermannDriveStamped, "ackermann_cmd", 10)
        node.create_subscription(
            Float64, "commands/motor/speed", lambda msg: self.erpms.append(msg.data)
        )
        node.create_subscription(
            Float64, "commands/servo/position", lambda msg: self.servos.append(msg.data)
        )

    async def drive(self, speed: float, angle: float) -> None:
        """Command a speed and a steering angle."""
        drive = AckermannDrive(speed=speed, steering_angle=angle)
        self.publisher.publish(AckermannDriveStamped(drive=drive))
        await settle()


@pytest.fixture
async def driver(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Driver:
    """Start the program that converts commands."""
    await manual_clock.advance(100.0)
    start(AckermannToVesc, **GAINS)
    driver = Driver(node_factory("driver"))
    await settle()
    return driver


async def test_a_command_becomes_electrical_rpm_and_a_servo_position(driver: Driver) -> None:
    """By gain and offset."""
    await driver.drive(2.0, 0.25)

    assert driver.erpms == [2.0 * SPEED_GAIN + 100.0]
    assert driver.servos == [0.25 * -1.2135 + 0.5304]


async def test_commands_that_stop_coming_stop_the_motor(
    driver: Driver, manual_clock: ManualClock
) -> None:
    """The original leaves that to the VESC."""
    await driver.drive(2.0, 0.25)
    await manual_clock.advance(0.4)
    await settle()

    assert driver.erpms[-1] == 100.0
    assert len(driver.servos) == 1


@pytest.mark.parametrize(("speed", "angle"), [(math.nan, 0.0), (math.inf, 0.0), (1.0, math.nan)])
async def test_a_command_that_is_no_number_stops_the_motor(
    driver: Driver, speed: float, angle: float
) -> None:
    """The car does not go on as before, and does not steer to nowhere."""
    await driver.drive(2.0, 0.25)
    await driver.drive(speed, angle)

    assert driver.erpms[1:] == [100.0]
    assert len(driver.servos) == 1


class Car:
    """A car that measures, and what is heard of its odometry."""

    def __init__(self, node: Node) -> None:
        self.odoms: list[Odometry] = []
        self.transforms: list[Any] = []
        self.servo = node.create_publisher(Float64, "sensors/servo_position_command", 10)
        self.state = node.create_publisher(VescStateStamped, "sensors/core", 10)
        node.create_subscription(Odometry, "odom", self.odoms.append)
        node.create_subscription(
            TFMessage, "/tf", lambda msg: self.transforms.extend(msg.transforms)
        )
        self.now_ns = 10**18

    async def steer(self, angle: float) -> None:
        """Say where the front wheels are steered to."""
        self.servo.publish(Float64(data=angle * -1.2135 + 0.5304))
        await settle()

    async def measure(self, speed: float, after_sec: float = STEP_SEC) -> None:
        """Measure a speed, some time after the last one."""
        self.now_ns += round(after_sec * 1e9)
        stamp = Time(sec=self.now_ns // 10**9, nanosec=self.now_ns % 10**9)
        state = VescState(speed=speed * SPEED_GAIN + 100.0)
        self.state.publish(VescStateStamped(header=Header(stamp=stamp), state=state))
        await settle()

    @property
    def at(self) -> tuple[float, float, float]:
        """Where the car is: x, y and its direction."""
        pose = self.odoms[-1].pose.pose
        return (
            pose.position.x,
            pose.position.y,
            math.remainder(2.0 * math.atan2(pose.orientation.z, pose.orientation.w), 2 * math.pi),
        )


CarOf = Callable[..., Any]


@pytest.fixture
def car(start: Start, node_factory: Callable[..., Any]) -> CarOf:
    """Start the program that computes odometry."""

    async def make(**parameters: Any) -> Car:
        start(VescToOdom, **CAR | parameters)
        car = Car(node_factory("car"))
        await settle()
        return car

    return make


async def test_a_car_that_steers_drives_an_arc(car: CarOf) -> None:
    """Of the radius ``wheelbase / tan(angle)``, but for the length of a step."""
    measured = await car()
    speed, angle, steps = 1.5, 0.2, 200
    await measured.steer(angle)
    for _ in range(steps + 1):
        await measured.measure(speed)

    radius = 0.25 / math.tan(angle)
    turned = speed / radius * steps * STEP_SEC
    x, y, yaw = measured.at
    step = speed * STEP_SEC
    assert yaw == pytest.approx(math.remainder(turned, 2 * math.pi), abs=1e-6)
    assert math.dist((x, y), (radius * math.sin(turned), radius * (1 - math.cos(turned)))) < step
    # Steps begin in the direction before they turn: exactly the sum of a geometric series.
    each = turned / steps
    ratio = math.sin(turned / 2) / math.sin(each / 2) * step
    assert x == pytest.approx(ratio * math.cos((turned - each) / 2), abs=1e-6)
    assert y == pytest.approx(ratio * math.sin((turned - each) / 2), abs=1e-6)


async def test_a_car_that_drives_forward_is_seen_to_drive_forward(car: CarOf) -> None:
    """The odometry has the sign of the commands; the original negates it, f1tenth/vesc#34."""
    measured = await car(use_servo_cmd_to_calc_angular_velocity=False)
    await measured.measure(1.0)
    await measured.measure(1.0, 2.0)

    assert measured.at == pytest.approx((2.0, 0.0, 0.0))
    assert measured.odoms[-1].twist.twist.linear.x == pytest.approx(1.0)


async def test_slow_speeds_are_noise(car: CarOf) -> None:
    """A VESC at rest measures a few revolutions."""
    measured = await car(use_servo_cmd_to_calc_angular_velocity=False)
    await measured.measure(0.04)
    await measured.measure(0.04, 100.0)

    assert measured.at == (0.0, 0.0, 0.0)


async def test_nothing_is_published_before_the_car_was_steered(car: CarOf) -> None:
    """The angle of the wheels is not known."""
    measured = await car()
    await measured.measure(1.0)

    assert measured.odoms == []


async def test_odometry_has_frames_times_and_variances(car: CarOf) -> None:
    """As the original."""
    measured = await car(odom_frame="o", base_frame="b")
    await measured.steer(0.0)
    await measured.measure(1.0)
    odom = measured.odoms[0]

    assert (odom.header.frame_id, odom.child_frame_id) == ("o", "b")
    assert odom.header.stamp == Time(sec=10**9, nanosec=20_000_000)
    assert {at: value for at, value in enumerate(odom.pose.covariance) if value} == {
        0: 0.2, 7: 0.2, 35: 0.4,
    }  # fmt: skip


async def test_the_transform_is_that_of_the_odometry(car: CarOf) -> None:
    """It is broadcast if ``publish_tf`` is true."""
    measured = await car(publish_tf=True)
    await measured.steer(0.3)
    for _ in range(5):
        await measured.measure(1.0)
    transform, pose = measured.transforms[-1], measured.odoms[-1].pose.pose

    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_link")
    assert transform.transform.translation.x == pose.position.x > 0.0
    assert transform.transform.rotation == pose.orientation


async def test_no_transform_is_broadcast_by_default(car: CarOf) -> None:
    """Another node may broadcast it."""
    measured = await car()
    await measured.steer(0.0)
    await measured.measure(1.0)

    assert measured.odoms
    assert not measured.transforms


@pytest.mark.parametrize("speed", [math.nan, math.inf, -math.inf, 1e305])
async def test_a_speed_that_is_none_is_ignored(car: CarOf, speed: float) -> None:
    """One such message would make all later poses NaN."""
    measured = await car()
    await measured.steer(1.2)
    await measured.measure(1.0)
    await measured.measure(speed, 1e6)
    await measured.measure(1.0, -1e6 + STEP_SEC)

    assert len(measured.odoms) == 2
    assert measured.at[0] == pytest.approx(0.02)


async def test_a_steering_angle_that_is_none_is_ignored(car: CarOf) -> None:
    """The last one stays."""
    measured = await car()
    await measured.steer(0.0)
    await measured.steer(math.nan)
    await measured.steer(math.inf)
    await measured.measure(1.0)
    await measured.measure(1.0)

    assert measured.at == pytest.approx((0.02, 0.0, 0.0))


async def test_a_clock_that_is_set_back_does_not_move_the_car(car: CarOf) -> None:
    """It would drive backwards; the time may even be before 1970."""
    measured = await car()
    await measured.steer(0.0)
    await measured.measure(1.0)
    await measured.measure(1.0, -2e9)
    await measured.measure(1.0)

    assert measured.at == pytest.approx((0.02, 0.0, 0.0))


@pytest.mark.parametrize(
    ("program", "changed", "text"),
    [
        (AckermannToVesc, {"speed_to_erpm_gain": None}, "'speed_to_erpm_gain' is missing"),
        (AckermannToVesc, {"speed_to_erpm_gain": math.nan}, "'speed_to_erpm_gain' is nan"),
        (VescToOdom, {"wheelbase": None}, "'wheelbase' is missing"),
        (VescToOdom, {"wheelbase": 0.0}, "'wheelbase' is 0"),
        (VescToOdom, {"speed_to_erpm_gain": 0.0}, "'speed_to_erpm_gain' is 0"),
    ],
)
async def test_parameters_that_do_not_fit_are_named(
    start: Start, program: Any, changed: dict[str, Any], text: str
) -> None:
    """The gains and the wheelbase belong to one car, and have no defaults."""
    given = {name: value for name, value in (CAR | changed).items() if value is not None}
    with pytest.raises(CommandError, match=text):
        start(program, **given)
