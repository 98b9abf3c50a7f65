"""The programs that estimate where a robot is."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from aionode import Time
from aionode._process.concurrency import checkpoint
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray
from aionode.interfaces.geometry_msgs.msg import (
    AccelWithCovarianceStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Twist,
    TwistWithCovarianceStamped,
    Vector3,
)
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.robot_localization.srv import SetPose, ToggleFilterProcessing
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_srvs.srv import Empty
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.programs._poses import quaternion_of
from aionode.programs._robot_localization.ekf_node import EkfNode
from aionode.programs._robot_localization.filter_node import FilterNode
from aionode.programs._robot_localization.ukf_node import UkfNode
from aionode.testing import ManualClock, settle
from aionode.tf import StaticTransformBroadcaster
from tests.programs.conftest import Start

SIZE = 15
SMALL = 1e-6
TICK = 0.1


def uses(*indices: int) -> list[bool]:
    """Return the configuration of a sensor that measures these values."""
    return [index in indices for index in range(SIZE)]


def diagonal(variance: float, size: int = 6) -> Any:
    """Return a covariance."""
    return np.diag([variance] * size).reshape(-1)


def yaw_of(turn: Any) -> float:
    """Return the angle about the vertical."""
    return math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))


class Robot:
    """The sensors of a robot, and the estimates of the program."""

    def __init__(self, node: Any, clock: ManualClock, program: FilterNode) -> None:
        self.node, self.clock, self.program = node, clock, program
        self.found: list[Odometry] = []
        self.transforms: list[TransformStamped] = []
        self.accelerations: list[Any] = []
        self.statuses: list[Any] = []
        node.create_subscription(Odometry, "odometry/filtered", self.found.append)
        node.create_subscription(
            TFMessage, "/tf", lambda msg: self.transforms.extend(msg.transforms)
        )
        node.create_subscription(
            AccelWithCovarianceStamped, "accel/filtered", self.accelerations.append
        )
        node.create_subscription(
            DiagnosticArray, "/diagnostics", lambda msg: self.statuses.extend(msg.status)
        )
        self.publishers: dict[str, Any] = {}
        self.static = StaticTransformBroadcaster(node)

    def stamp(self, late_sec: float = 0.0) -> Any:
        """Return a time, by default the present."""
        now = self.node.get_clock().now().nanoseconds
        return Time(nanoseconds=now - round(late_sec * 1e9)).to_msg()

    async def send(self, topic: str, msg: Any) -> Odometry | None:
        """Publish a message, and return the estimate after the next update."""
        if topic not in self.publishers:
            self.publishers[topic] = self.node.create_publisher(type(msg), topic, 10)
            await settle()
        self.publishers[topic].publish(msg)
        await settle()
        return await self.tick()

    async def tick(self, seconds: float = TICK) -> Odometry | None:
        """Let time pass, and return the last estimate."""
        await self.clock.advance(seconds)
        await settle()
        return self.found[-1] if self.found else None

    def texts(self, key: str) -> set[str]:
        """Return what the diagnostics have said under a key."""
        return {value.value for each in self.statuses for value in each.values if value.key == key}

    def odometry(
        self,
        x: float = 0.0,
        y: float = 0.0,
        yaw: float = 0.0,
        *,
        speed: float = 0.0,
        turning: float = 0.0,
        frame: str = "odom",
        child: str = "base_link",
        late_sec: float = 0.0,
        variance: float = SMALL,
    ) -> Odometry:
        """Return a message of odometry."""
        msg = Odometry(child_frame_id=child)
        msg.header.frame_id, msg.header.stamp = frame, self.stamp(late_sec)
        msg.pose.pose.position.x, msg.pose.pose.position.y = x, y
        msg.pose.pose.orientation = quaternion_of(0.0, 0.0, yaw)
        msg.twist.twist.linear.x, msg.twist.twist.angular.z = speed, turning
        msg.pose.covariance = msg.twist.covariance = diagonal(variance)
        return msg

    def imu(
        self,
        roll: float = 0.0,
        pitch: float = 0.0,
        yaw: float = 0.0,
        *,
        turning: tuple[float, ...] = (0.0, 0.0, 0.0),
        pushing: tuple[float, ...] = (0.0, 0.0, 0.0),
        frame: str = "base_link",
    ) -> Imu:
        """Return a message of an IMU."""
        msg = Imu(orientation=quaternion_of(roll, pitch, yaw))
        msg.header.frame_id, msg.header.stamp = frame, self.stamp()
        x, y, z = turning
        msg.angular_velocity = Vector3(x=x, y=y, z=z)
        x, y, z = pushing
        msg.linear_acceleration = Vector3(x=x, y=y, z=z)
        msg.orientation_covariance = diagonal(SMALL, 3)
        msg.angular_velocity_covariance = diagonal(SMALL, 3)
        msg.linear_acceleration_covariance = diagonal(SMALL, 3)
        return msg

    def pose(self, x: float, yaw: float = 0.0, frame: str = "odom") -> PoseWithCovarianceStamped:
        """Return a pose."""
        msg = PoseWithCovarianceStamped()
        msg.header.frame_id, msg.header.stamp = frame, self.stamp()
        msg.pose.pose.position.x = x
        msg.pose.pose.orientation = quaternion_of(0.0, 0.0, yaw)
        msg.pose.covariance = diagonal(SMALL)
        return msg

    async def mount(
        self, parent: str, child: str, x: float = 0.0, y: float = 0.0, yaw: float = 0.0
    ) -> None:
        """Say where a frame is."""
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = parent, self.stamp()
        transform.transform.translation = Vector3(x=x, y=y)
        transform.transform.rotation = quaternion_of(0.0, 0.0, yaw)
        self.static.sendTransform(transform)
        await settle()

    async def call(self, kind: Any, name: str, **fields: Any) -> Any:
        """Call a service."""
        client = self.node.create_client(kind, name)
        return await client.call(kind.Request(**fields))


Make = Callable[..., Any]


@pytest.fixture(params=[EkfNode])
def robot(
    manual_clock: ManualClock,
    start: Start,
    node_factory: Callable[..., Any],
    request: pytest.FixtureRequest,
) -> Make:
    """Start the program."""

    async def make(**parameters: Any) -> Robot:
        await manual_clock.advance(100.0)
        given = {"frequency": 1 / TICK, "sensor_timeout": 1.0} | parameters
        program = start(request.param, **given)
        result = Robot(node_factory("sensors"), manual_clock, program)
        await settle()
        return result

    return make


EACH = pytest.mark.parametrize("robot", [EkfNode, UkfNode], indirect=True)


@EACH
async def test_the_first_measurement_is_the_estimate(robot: Make) -> None:
    """With its frames, its stamp and its covariance."""
    it = await robot(odom0="wheels", odom0_config=uses(0, 1, 5))
    msg = it.odometry(1.0, 2.0, 0.5, speed=0.3)

    found = await it.send("wheels", msg)

    assert (found.pose.pose.position.x, found.pose.pose.position.y) == (1.0, 2.0)
    assert yaw_of(found.pose.pose.orientation) == pytest.approx(0.5)
    assert found.twist.twist.linear.x == 0.0
    assert (found.header.frame_id, found.child_frame_id) == ("odom", "base_link")
    assert found.header.stamp == msg.header.stamp
    assert found.pose.covariance[0] == pytest.approx(SMALL)


@EACH
async def test_velocities_add_up_to_a_pose(robot: Make) -> None:
    """At 1 m/s for a second."""
    it = await robot(
        odom0="wheels", odom0_config=uses(6, 11), process_noise_covariance=[1e-6] * SIZE
    )
    for _ in range(11):
        found = await it.send("wheels", it.odometry(speed=1.0))

    assert found.pose.pose.position.x == pytest.approx(1.0, abs=1e-3)


async def test_the_estimate_is_broadcast_as_a_transform(robot: Make) -> None:
    """From the frame of odometry to the robot, some time ahead if wanted."""
    it = await robot(odom0="wheels", odom0_config=uses(0, 5), transform_time_offset=0.5)
    await it.send("wheels", it.odometry(1.0, yaw=0.5))

    (transform,) = it.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_link")
    assert transform.transform.translation.x == 1.0
    assert yaw_of(transform.transform.rotation) == pytest.approx(0.5)
    assert Time.from_msg(transform.header.stamp).nanoseconds == 100_500_000_000


async def test_no_transform_is_broadcast_if_another_program_does(robot: Make) -> None:
    """A frame has one parent."""
    it = await robot(odom0="wheels", odom0_config=uses(0, 5), publish_tf=False)
    await it.send("wheels", it.odometry(1.0))

    assert it.transforms == []


async def test_in_the_world_of_a_map_the_odometry_is_moved(robot: Make) -> None:
    """The robot is at 3 of the map and at 1 of its odometry, which begins at 2 then."""
    it = await robot(world_frame="map", pose0="amcl_pose", pose0_config=uses(0, 1, 5))
    await it.mount("odom", "base_link", 1.0)
    await it.send("amcl_pose", it.pose(3.0, frame="map"))

    (transform,) = it.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    assert transform.transform.translation.x == pytest.approx(2.0)


async def test_on_a_plane_what_leaves_it_is_zero(robot: Make) -> None:
    """Whatever the sensors say."""
    it = await robot(two_d_mode=True, imu0="imu", imu0_config=uses(3, 4, 5))
    found = await it.send("imu", it.imu(0.2, 0.1, 0.5))

    turn = found.pose.pose.orientation
    assert (turn.x, turn.y) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert yaw_of(turn) == pytest.approx(0.5, abs=1e-2)


async def test_a_relative_sensor_begins_at_zero(robot: Make) -> None:
    """Wherever it is."""
    it = await robot(imu0="imu", imu0_config=uses(5), imu0_relative=True)
    await it.send("imu", it.imu(yaw=1.0))
    found = await it.send("imu", it.imu(yaw=1.3))

    assert yaw_of(found.pose.pose.orientation) == pytest.approx(0.3, abs=1e-2)


async def test_a_relative_sensor_begins_with_a_pose_of_numbers(robot: Make) -> None:
    """One that is no number would make all later ones none."""
    it = await robot(odom0="wheels", odom0_config=uses(0), odom0_relative=True)
    await it.send("wheels", it.odometry(math.nan))
    await it.send("wheels", it.odometry(4.0))
    found = await it.send("wheels", it.odometry(5.0))

    assert found.pose.pose.position.x == pytest.approx(1.0, abs=1e-2)


async def test_a_differential_sensor_measures_how_fast_it_moves(robot: Make) -> None:
    """From one pose to the next."""
    it = await robot(odom0="wheels", odom0_config=uses(0, 1, 5), odom0_differential=True)
    await it.send("wheels", it.odometry(5.0, yaw=math.pi / 2))
    found = await it.send("wheels", it.odometry(5.0, 0.05, yaw=math.pi / 2 + 0.02))

    assert found.twist.twist.linear.x == pytest.approx(0.5, abs=1e-3)
    assert found.twist.twist.angular.z == pytest.approx(0.2, abs=1e-3)
    assert found.pose.pose.position.x == pytest.approx(0.0, abs=1e-3)


async def test_a_pose_is_turned_into_the_world(robot: Make) -> None:
    """As are the values that count: y of a camera that looks to the left is -x of the world."""
    it = await robot(pose0="camera", pose0_config=uses(0))
    await it.mount("odom", "camera_world", 1.0, yaw=math.pi / 2)
    found = await it.send("camera", it.pose(2.0, frame="camera_world"))

    assert found.pose.pose.position.x == 0.0
    assert found.pose.pose.position.y == pytest.approx(2.0)


async def test_a_pose_of_another_part_of_the_robot_is_moved_to_its_base(robot: Make) -> None:
    """With `pose_use_child_frame`; the camera is 0.5 m in front."""
    it = await robot(odom0="visual", odom0_config=uses(0, 1, 5), odom0_pose_use_child_frame=True)
    await it.mount("base_link", "camera", 0.5)
    found = await it.send("visual", it.odometry(2.0, yaw=math.pi / 2, child="camera"))

    place = found.pose.pose.position
    assert (place.x, place.y) == pytest.approx((2.0, -0.5))


async def test_a_twist_is_turned_into_the_frame_of_the_robot(robot: Make) -> None:
    """The sensor looks to the left."""
    it = await robot(twist0="flow", twist0_config=uses(6, 7))
    await it.mount("base_link", "flow_link", yaw=math.pi / 2)
    msg = TwistWithCovarianceStamped()
    msg.header.frame_id, msg.header.stamp = "flow_link", it.stamp()
    msg.twist.twist.linear.x, msg.twist.covariance = 1.0, diagonal(SMALL)

    found = await it.send("flow", msg)

    assert found.twist.twist.linear.x == pytest.approx(0.0, abs=1e-9)
    assert found.twist.twist.linear.y == pytest.approx(1.0)


async def test_a_sensor_off_the_centre_moves_when_the_robot_turns(robot: Make) -> None:
    """A quarter of a metre ahead, at 2 rad/s, it moves at 0.5 m/s to the left."""
    it = await robot(imu0="imu", imu0_config=uses(11), twist0="flow", twist0_config=uses(6, 7))
    await it.mount("base_link", "flow_link", 0.25)
    await it.send("imu", it.imu(turning=(0.0, 0.0, 2.0)))
    msg = TwistWithCovarianceStamped()
    msg.header.frame_id, msg.header.stamp = "flow_link", it.stamp()
    msg.twist.twist.linear.y, msg.twist.covariance = 0.5, diagonal(SMALL)

    found = await it.send("flow", msg)

    assert found.twist.twist.linear.y == pytest.approx(0.0, abs=1e-3)


async def test_the_pitch_of_an_imu_that_looks_aside_is_the_roll_of_the_robot(robot: Make) -> None:
    """Its heading is that of the world, less how it is mounted."""
    it = await robot(imu0="imu", imu0_config=uses(3, 4, 5))
    await it.mount("base_link", "imu_link", yaw=math.pi / 2)
    found = await it.send("imu", it.imu(0.0, 0.2, math.pi / 2, frame="imu_link"))

    turn = found.pose.pose.orientation
    roll = math.atan2(2 * (turn.w * turn.x + turn.y * turn.z), 1 - 2 * (turn.x**2 + turn.y**2))
    assert roll == pytest.approx(-0.2)
    assert yaw_of(turn) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("knows_orientation", [True, False])
async def test_gravity_is_taken_away_from_an_acceleration(
    robot: Make, knows_orientation: bool
) -> None:
    """By the orientation of the IMU, or that of the robot."""
    it = await robot(
        imu0="imu",
        imu0_config=uses(12, 13, 14),
        imu0_remove_gravitational_acceleration=True,
        gravitational_acceleration=9.8,
        publish_acceleration=True,
        initial_state=[0.0, 0.0, 0.0, 0.0, 0.3, *[0.0] * 10],
    )
    msg = it.imu(0.0, 0.3, pushing=(-9.8 * math.sin(0.3) + 0.5, 0.0, 9.8 * math.cos(0.3)))
    if not knows_orientation:
        msg.orientation = Quaternion(w=1.0)
        msg.orientation_covariance[0] = -1.0
    await it.send("imu", msg)

    (found,) = it.accelerations
    linear = found.accel.accel.linear
    assert (linear.x, linear.y, linear.z) == pytest.approx((0.5, 0.0, 0.0), abs=1e-9)
    assert found.accel.covariance[0] == pytest.approx(SMALL)


async def test_what_an_imu_does_not_measure_does_not_count(robot: Make) -> None:
    """It says so by -1 in the covariance."""
    it = await robot(imu0="imu", imu0_config=uses(5, 11))
    msg = it.imu(yaw=1.0, turning=(0.0, 0.0, 0.5))
    msg.orientation_covariance[0] = -1.0

    found = await it.send("imu", msg)

    assert yaw_of(found.pose.pose.orientation) == 0.0
    assert found.twist.twist.angular.z == pytest.approx(0.5)


async def test_without_measurements_the_robot_goes_on_in_the_estimate(robot: Make) -> None:
    """After `sensor_timeout`; until then the last one stands."""
    it = await robot(odom0="wheels", odom0_config=uses(6), sensor_timeout=0.45)
    first = await it.send("wheels", it.odometry(speed=1.0))
    assert await it.tick() is first

    for _ in range(4):
        found = await it.tick()

    assert found.pose.pose.position.x == pytest.approx(0.5, abs=1e-6)


async def test_if_wanted_the_estimate_is_always_for_the_present(robot: Make) -> None:
    """Otherwise it is for the last measurement."""
    it = await robot(odom0="wheels", odom0_config=uses(6), predict_to_current_time=True)
    found = await it.send("wheels", it.odometry(speed=1.0))

    assert found.header.stamp == it.stamp()
    assert found.pose.pose.position.x == pytest.approx(0.1)


@pytest.mark.parametrize(("smooths", "x"), [(True, 1.0), (False, 3.0)])
async def test_a_late_measurement_is_used_where_it_belongs(
    robot: Make, smooths: bool, x: float
) -> None:
    """Without smoothing it counts as if it were of the present, as much as the last one."""
    it = await robot(
        odom0="wheels",
        odom0_config=uses(0),
        pose0="camera",
        pose0_config=uses(0),
        smooth_lagged_data=smooths,
        history_length=5.0 if smooths else 0.0,
        process_noise_covariance=[1.0] * SIZE,
        permit_corrected_publication=True,
    )
    await it.send("wheels", it.odometry(1.0))
    await it.send("wheels", it.odometry(1.0))
    late = it.pose(5.0)
    late.header.stamp = it.stamp(0.15)
    await it.send("wheels", it.odometry(1.0))
    found = await it.send("camera", late)

    assert found.pose.pose.position.x == pytest.approx(x, abs=0.01)


async def test_measurements_of_the_future_wait_for_their_time(robot: Make) -> None:
    """The clock of another computer may be ahead."""
    it = await robot(odom0="wheels", odom0_config=uses(0))
    assert await it.send("wheels", it.odometry(1.0, late_sec=-0.35)) is None

    assert await it.tick(0.5) is not None


@pytest.fixture
def most(monkeypatch: pytest.MonkeyPatch) -> int:
    """Let few measurements wait, and return how many."""
    monkeypatch.setattr("aionode.programs._robot_localization.sensors.MAX_QUEUED", 20)
    return 20


async def test_only_so_many_measurements_wait(robot: Make, most: int) -> None:
    """Somebody could fill the memory otherwise."""
    it = await robot(
        odom0="wheels",
        odom0_config=uses(0),
        odom0_queue_size=2 * most,
        print_diagnostics=True,
    )
    publisher = it.node.create_publisher(Odometry, "wheels", 2 * most)
    await settle()
    msg = it.odometry(1.0, late_sec=-50.0)
    for _ in range(most + 5):
        publisher.publish(msg)
    await it.tick(1.2)

    assert len(it.program.queue) == most
    texts = [value.value for each in it.statuses for value in each.values]
    assert any("wait for their time" in text for text in texts)


async def test_a_sensor_whose_clock_is_ahead_keeps_no_other_out(robot: Make, most: int) -> None:
    """It fills the queue that all sensors share."""
    it = await robot(
        odom0="wheels", odom0_config=uses(0), odom0_queue_size=2 * most,
        odom1="other", odom1_config=uses(1),
    )  # fmt: skip
    publisher = it.node.create_publisher(Odometry, "wheels", 2 * most)
    await settle()
    ahead = it.odometry(1.0, late_sec=-50.0)
    for _ in range(most):
        publisher.publish(ahead)
    await settle()
    found = await it.send("other", it.odometry(y=2.0))

    assert found is not None
    assert found.pose.pose.position.y == pytest.approx(2.0, abs=0.01)


async def test_others_have_their_turn_while_many_measurements_are_used(robot: Make) -> None:
    """A thousand take half a second, in which an emergency stop should not wait."""
    it = await robot(odom0="wheels", odom0_config=uses(0), odom0_queue_size=100)
    publisher = it.node.create_publisher(Odometry, "wheels", 100)
    await settle()
    for at in range(50):
        publisher.publish(it.odometry(at / 100, late_sec=1.0 - at / 100))
    await settle()
    left = []
    async with asyncio.TaskGroup() as tasks:
        update = tasks.create_task(it.program.update())
        while not update.done():
            left.append(len(it.program.due))
            await checkpoint()

    assert len(set(left)) > 40


@pytest.mark.parametrize("stamp", [0, -5])
async def test_messages_without_a_time_are_ignored(robot: Make, stamp: int) -> None:
    """Messages with times before 1970 are ignored, too."""
    it = await robot(odom0="wheels", odom0_config=uses(0))
    msg = it.odometry(1.0)
    msg.header.stamp.sec = stamp
    msg.header.stamp.nanosec = 0

    assert await it.send("wheels", msg) is None


async def test_a_message_older_than_the_last_one_is_ignored(robot: Make) -> None:
    """Messages of the same sensor are compared; the diagnostics say so."""
    it = await robot(odom0="wheels", odom0_config=uses(0), print_diagnostics=True)
    await it.send("wheels", it.odometry(1.0))
    found = await it.send("wheels", it.odometry(9.0, late_sec=0.5))
    await it.tick(1.0)

    assert found.pose.pose.position.x == 1.0
    (text,) = it.texts("odom0_pose_timestamp")
    assert text.startswith("The odom0_pose message has a timestamp before that of the previous")


async def test_a_message_of_an_unknown_frame_is_ignored(robot: Make) -> None:
    """The diagnostics show its name escaped, as others may have chosen it."""
    it = await robot(odom0="wheels", odom0_config=uses(0), print_diagnostics=True)
    await it.send("wheels", it.odometry(1.0))
    found = await it.send("wheels", it.odometry(9.0, frame="moon\x1b[2J"))
    await it.tick(1.0)

    assert found.pose.pose.position.x == 1.0
    assert it.texts("odom0_pose_transform") == {
        r"There is no transform from 'moon\x1b[2J' to 'odom'; the odom0_pose message is ignored."
    }


@EACH
async def test_covariances_that_are_no_numbers_are_ignored(robot: Make) -> None:
    """The estimate would consist of nothing else from then on."""
    it = await robot(odom0="wheels", odom0_config=uses(0))
    await it.send("wheels", it.odometry(1.0))
    await it.send("wheels", it.odometry(2.0, variance=math.nan))
    found = await it.send("wheels", it.odometry(3.0))

    assert found.pose.pose.position.x == pytest.approx(3.0, abs=0.01)


@pytest.mark.parametrize(("threshold", "x"), [(1e6, 5.0), (2.0, 0.0)])
async def test_a_pose_far_from_the_estimate_is_rejected(
    robot: Make, threshold: float, x: float
) -> None:
    """By as many standard deviations as the parameter says."""
    it = await robot(odom0="wheels", odom0_config=uses(0), odom0_pose_rejection_threshold=threshold)
    await it.send("wheels", it.odometry(0.0))
    found = await it.send("wheels", it.odometry(5.0))

    assert found.pose.pose.position.x == pytest.approx(x, abs=0.01)


async def test_commands_move_the_estimate_before_sensors_notice(robot: Make) -> None:
    """As fast as the robot accelerates."""
    it = await robot(
        odom0="wheels",
        odom0_config=uses(6),
        use_control=True,
        control_config=[True, False, False, False, False, True],
        control_timeout=2.0,
        acceleration_limits=[0.5, 0.0, 0.0, 0.0, 0.0, 0.5],
        acceleration_gains=[10.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        predict_to_current_time=True,
    )
    await it.send("wheels", it.odometry())
    found = await it.send("cmd_vel", Twist(linear=Vector3(x=1.0)))
    for _ in range(4):
        found = await it.tick()

    assert found.twist.twist.linear.x == pytest.approx(0.25, abs=0.01)


async def test_set_pose_puts_the_robot_elsewhere(robot: Make) -> None:
    """By the topic or the service; it stands still there, and older messages do not count."""
    it = await robot(odom0="wheels", odom0_config=uses(0, 6))
    before = it.odometry(1.0, speed=0.5)
    await it.send("wheels", before)
    found = await it.send("set_pose", it.pose(7.0, 0.5))
    assert found.pose.pose.position.x == 7.0
    assert found.twist.twist.linear.x == 0.0

    found = await it.send("wheels", before)
    assert found.pose.pose.position.x == 7.0
    await it.call(SetPose, "set_pose", pose=it.pose(8.0))
    assert (await it.tick()).pose.pose.position.x == 8.0


async def test_a_pose_in_an_unknown_frame_moves_nobody(
    robot: Make, caplog: pytest.LogCaptureFixture
) -> None:
    """Its name is shown escaped, as others may have chosen it."""
    it = await robot(odom0="wheels", odom0_config=uses(0))
    await it.send("wheels", it.odometry(1.0))
    found = await it.send("set_pose", it.pose(7.0, frame="moon\x1b[2J"))

    assert found.pose.pose.position.x == 1.0
    assert r"no transform from 'moon\x1b[2J' to 'odom'" in caplog.text


async def test_a_pose_that_cannot_be_set_changes_nothing(robot: Make) -> None:
    """Its stamp, which may be in the future, keeps no measurements out."""
    it = await robot(odom0="wheels", odom0_config=uses(0))
    await it.send("wheels", it.odometry(1.0))
    broken = it.pose(math.nan)
    broken.header.stamp.sec += 1000
    await it.send("set_pose", broken)
    found = await it.send("wheels", it.odometry(2.0))

    assert found.pose.pose.position.x == pytest.approx(2.0, abs=1e-2)


async def test_reset_forgets_the_estimate(robot: Make) -> None:
    """The next measurement is the first one."""
    it = await robot(odom0="wheels", odom0_config=uses(0), initial_estimate_covariance=[0.5] * SIZE)
    await it.send("wheels", it.odometry(1.0))
    await it.call(Empty, "reset")
    count = len(it.found)
    await it.tick()
    assert len(it.found) == count

    found = await it.send("wheels", it.odometry(4.0))
    assert found.pose.pose.position.x == 4.0
    assert found.pose.covariance[7] == pytest.approx(0.5)


async def test_toggle_ignores_measurements_for_a_while(robot: Make) -> None:
    """The answer is whether that is a change."""
    it = await robot(odom0="wheels", odom0_config=uses(0), permit_corrected_publication=True)
    await it.send("wheels", it.odometry(1.0))
    off = await it.call(ToggleFilterProcessing, "toggle", on=False)
    again = await it.call(ToggleFilterProcessing, "toggle", on=False)
    found = await it.send("wheels", it.odometry(9.0))

    assert (off.status, again.status) == (True, False)
    assert found.pose.pose.position.x == 1.0


async def test_a_disabled_filter_waits_to_be_enabled(robot: Make) -> None:
    """For robots that are first put somewhere."""
    it = await robot(odom0="wheels", odom0_config=uses(0), disabled_at_startup=True)
    assert await it.send("wheels", it.odometry(1.0)) is None

    await it.call(Empty, "enable")

    assert (await it.tick()).pose.pose.position.x == 1.0


async def test_diagnostics_name_what_nothing_measures(robot: Make) -> None:
    """On a plane, height, roll and pitch need no sensor."""
    it = await robot(
        odom0="wheels",
        odom0_config=uses(0, 11),
        odom1="visual",
        odom1_config=uses(0),
        two_d_mode=True,
        print_diagnostics=True,
    )
    await it.tick(1.2)

    status = next(each for each in it.statuses if each.name.endswith("diagnostic updater"))
    status = [each for each in it.statuses if each.name == status.name][-1]
    values = {value.key: value.value for value in status.values}
    assert set(values) == {"X_configuration", "Y_configuration"}
    assert values["X_configuration"].startswith("2 absolute pose inputs detected for X.")
    assert values["Y_configuration"].startswith("Neither Y nor its velocity is being measured.")
    assert status.message.startswith("Erroneous data or settings detected")


@pytest.mark.parametrize(
    ("parameters", "problem"),
    [
        ({"frequency": 0.0}, "frequency is 0.0; use a number above 0"),
        ({"odom0": "a", "odom0_config": [True]}, "odom0_config has 1 values; use 15"),
        ({"process_noise_covariance": [1.0]}, "Expected a length of 15 or 225, received length 1"),
        (
            {"use_control": True, "control_config": [True] * 6, "acceleration_gains": [1.0]},
            "acceleration_gains has 1 values; use six",
        ),
    ],
)
async def test_parameters_that_cannot_be_used_are_errors(
    robot: Make, parameters: dict[str, Any], problem: str
) -> None:
    """At the start, when somebody looks."""
    with pytest.raises(CommandError, match=problem):
        await robot(**parameters)


@pytest.mark.parametrize("robot", [UkfNode], indirect=True)
async def test_the_unscented_filter_needs_points(robot: Make) -> None:
    """As above."""
    with pytest.raises(CommandError, match="alpha and kappa: "):
        await robot(alpha=0.0)


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"odom_frame": "map"}, "Invalid frame configuration!"),
        ({"history_length": 1.0}, "Filter history interval of 1 specified, but smooth_lagged_data"),
        ({"initial_state": [1.0]}, "Initial state must be of size 15."),
        ({"use_control": True}, "control_config is missing. No control term will be used."),
        ({"odom0": "a"}, "Warning: a is listed as an input topic, but all update variables"),
        (
            {"imu0": "a", "imu0_config": uses(0, 5)},
            "the sensor_msgs/Imu message contains no positional data",
        ),
        (
            {"pose0": "a", "pose0_differential": True, "pose0_relative": True},
            "Both pose0_differential and pose0_relative were set to true. Using differential mode.",
        ),
    ],
)
async def test_what_looks_wrong_in_the_parameters_is_named(
    robot: Make, parameters: dict[str, Any], text: str, caplog: pytest.LogCaptureFixture
) -> None:
    """In the words of the original."""
    await robot(**parameters)

    assert text in caplog.text


async def test_with_a_timeout_messages_wait_for_their_frame(robot: Make) -> None:
    """The transform may come a little later than the message."""
    it = await robot(pose0="camera", pose0_config=uses(0), transform_timeout=0.5)
    assert await it.send("camera", it.pose(2.0, frame="camera_world")) is None

    await it.mount("odom", "camera_world", 1.0)

    assert (await it.tick()).pose.pose.position.x == pytest.approx(3.0)
