"""The program that finds a robot on a map."""

from __future__ import annotations

import asyncio
import math
import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from aionode import Time
from aionode.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from aionode.interfaces.nav2_msgs.msg import Particle, ParticleCloud
from aionode.interfaces.nav2_msgs.srv import SetInitialPose
from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_srvs.srv import Empty
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.lifecycle import TransitionCallbackReturn
from aionode.programs._amcl.amcl import Amcl, about_z, particles_of, yaw_of
from aionode.programs._amcl.likelihood import Field, Sensor, distances_of
from aionode.programs._amcl.particles import (
    Particles,
    bins_of,
    clusters_of,
    moved_differentially,
    moved_sideways,
)
from aionode.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from aionode.testing import ManualClock, settle
from aionode.tf import StaticTransformBroadcaster, TransformBroadcaster
from tests.programs.conftest import Start
from tests.support.waiting import until

WIDTH, HEIGHT, CELL = 6.0, 4.0, 0.05
NO_NOISE = (0.0,) * 5


def room() -> OccupancyGrid:
    """Return a map of a room of 6 m by 4 m, whose corner is at 0, 0, with a wall around."""
    cells = np.zeros((round(HEIGHT / CELL) + 2, round(WIDTH / CELL) + 2), np.int8)
    cells[[0, -1], :] = cells[:, [0, -1]] = 100
    grid = OccupancyGrid(data=cells.reshape(-1))
    grid.header.frame_id = "map"
    grid.info.height, grid.info.width = cells.shape
    grid.info.resolution = CELL
    grid.info.origin.position.x = grid.info.origin.position.y = -CELL
    return grid


def ranges_at(x: float, y: float, yaw: float, count: int = 181) -> Any:
    """Return what a laser measures in the room, all around."""
    angles = yaw + np.linspace(-math.pi, math.pi, count)
    cosine, sine = np.cos(angles), np.sin(angles)
    with np.errstate(divide="ignore"):
        to_x = np.where(cosine > 0, (WIDTH - x) / cosine, -x / cosine)
        to_y = np.where(sine > 0, (HEIGHT - y) / sine, -y / sine)
    return np.minimum(np.abs(to_x), np.abs(to_y)).astype(np.float32)


def test_distances_are_those_to_the_nearest_obstacle() -> None:
    """Compared with all of them, up to the longest."""
    random = np.random.default_rng(1)
    for shape in ((20, 30), (1, 9), (9, 1)):
        occupied = random.random(shape) < 0.05
        occupied[0, 0] = True
        rows, columns = np.indices(shape)
        true = np.min([np.hypot(rows - i, columns - j) for i, j in np.argwhere(occupied)], axis=0)

        assert distances_of(occupied, 6.0) == pytest.approx(np.minimum(true, 6.0), rel=1e-6)


def test_a_map_without_obstacles_is_as_far_as_it_goes() -> None:
    """Not infinitely far."""
    assert distances_of(np.zeros((3, 4), dtype=bool), 2.0).tolist() == [[2.0] * 4] * 3


def test_beyond_the_map_the_distance_is_the_longest() -> None:
    """On it, that of the cell."""
    field = Field(room(), 2.0)

    found = field.at(np.array([0.01, -1.0, 1.01, math.nan]), np.array([1.0, 1.0, 1.01, 1.0]))

    assert found == pytest.approx([CELL, 2.0, 21 * CELL, 2.0])


def test_random_poses_are_in_free_cells() -> None:
    """All over the map."""
    poses = Field(room(), 2.0).random_poses(500, np.random.default_rng(1))

    assert poses[:, :2].min() > 0.0
    assert (poses[:, 0].max(), poses[:, 1].max()) < (WIDTH, HEIGHT)
    assert poses[:, 0].max() > WIDTH - 0.3


@pytest.mark.parametrize(("multiplies", "ratio"), [(False, 1.6 / 1.1), (True, 6.0)])
def test_a_beam_that_ends_at_a_wall_makes_a_pose_likely(multiplies: bool, ratio: float) -> None:
    """By hand: 0.5 + 0.5/5 = 0.6 at the wall, 0.1 far from it; cubes are added to 1."""
    sensor = Sensor(0.5, 0.5, 0.01, 60, multiplies=multiplies)
    poses = np.array([[1.0, 2.0, math.pi], [3.0, 2.0, math.pi]])

    at_wall, away = sensor.likelihood(poses, np.array([[1.02, 0.0]]), Field(room(), 2.0), 5.0)

    if not multiplies:
        ratio = (1 + 0.6**3) / (1 + 0.1**3)
    assert at_wall / away == pytest.approx(ratio, rel=1e-3)


def test_beams_are_chosen_evenly() -> None:
    """All of them, if there are few."""
    sensor = Sensor(0.5, 0.5, 0.2, 60, multiplies=False)

    assert (sensor.chosen(361).step, sensor.chosen(30).step, sensor.chosen(0).step) == (6, 1, 1)


@pytest.mark.parametrize(
    ("before", "delta", "pose", "after"),
    [
        ((0, 0, 0), (1, 0, 0), (2, 3, math.pi / 2), (2, 4, math.pi / 2)),
        ((0, 0, 0), (-1, 0, 0), (2, 3, 0), (1, 3, 0)),  # backwards
        ((5, 5, 1.0), (0, 0, 0.5), (2, 3, 0), (2, 3, 0.5)),  # on the spot
        ((0, 0, math.pi / 2), (0, 1, 0), (2, 3, 0), (3, 3, 0)),  # in other coordinates
    ],
)
def test_particles_move_as_odometry_does(before: Any, delta: Any, pose: Any, after: Any) -> None:
    """In their own direction; without noise, exactly."""
    for move in (moved_differentially, moved_sideways):
        found = move(
            np.array([pose], dtype=float),
            np.array(before, dtype=float),
            np.array(delta, dtype=float),
            NO_NOISE,
            np.random.default_rng(1),
        )

        assert found[0] == pytest.approx(np.array(after, dtype=float), abs=1e-9)


def test_a_way_makes_particles_uncertain() -> None:
    """The standard deviation is the root of alpha3 times the way."""
    poses = np.zeros((20_000, 3))
    moved = moved_differentially(
        poses, np.zeros(3), np.array([2.0, 0.0, 0.0]), (0, 0, 0.04, 0, 0), np.random.default_rng(1)
    )

    assert moved[:, 0].std() == pytest.approx(0.4, rel=0.05)
    assert moved[:, 1].std() == pytest.approx(0.0)


def particles(**more: Any) -> Particles:
    """Return a cloud."""
    settings: dict[str, Any] = {"least": 100, "most": 2000, "error": 0.05, "z": 0.99} | more
    return Particles(np.random.default_rng(1), **settings)


def test_as_many_particles_are_drawn_as_their_spread_needs() -> None:
    """For ten bins, Fox's formula gives 9 / 0.1 · (1 - 2/81 + √(2/81) · 0.99)³ = 130.2."""
    assert particles().limits(np.array([1, 2, 10, 1000])).tolist() == [2000, 100, 131, 2000]

    cloud = particles()
    cloud.spread(np.repeat(np.arange(10.0), 200)[:, None] * [1.0, 0.0, 0.0])
    cloud.resample(lambda count: np.zeros((count, 3)))
    assert len(cloud.poses) == 132


def test_likely_particles_replace_the_others() -> None:
    """Those without any weight are gone."""
    cloud = particles()
    cloud.spread(np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]]))
    cloud.weigh(np.array([3.0, 1.0, 0.0]))
    assert cloud.weights.tolist() == [0.75, 0.25, 0.0]

    cloud.resample(lambda count: np.zeros((count, 3)))

    assert set(cloud.poses[:, 0]) == {0.0, 1.0}
    assert (cloud.poses[:, 0] == 0.0).mean() == pytest.approx(0.75, abs=0.12)


def test_likelihoods_that_are_none_leave_all_particles_equal() -> None:
    """A message of somebody else must not end the estimate."""
    cloud = particles()
    cloud.spread(np.zeros((2, 3)))
    cloud.weigh(np.array([math.nan, 1.0]))

    assert cloud.weights.tolist() == [0.5, 0.5]


def test_a_robot_that_was_carried_away_is_sought_everywhere() -> None:
    """As far as the particles fit worse than usual: here 0.5 - 0.1 · 0.9 of before, by averages."""
    cloud = particles(slow=0.001, fast=0.5)
    cloud.spread(np.zeros((200, 3)))
    cloud.weigh(np.full(200, 1.0))
    cloud.weigh(np.full(200, 0.2))
    cloud.resample(lambda count: np.full((count, 3), 9.0))

    assert (cloud.poses[:, 0] == 9.0).mean() == pytest.approx(0.4, abs=0.1)


def test_particles_that_touch_are_one_cluster_and_the_heaviest_is_the_estimate() -> None:
    """Not their mean, where the robot surely is not. Boxes may touch by a corner."""
    poses = np.array([[0.1, 0.1, 0.0], [0.6, 0.6, 0.0], [5.0, 0.0, 0.0]])
    assert len(set(clusters_of(bins_of(poses)).tolist())) == 2
    cloud = particles()
    cloud.spread(poses)

    assert cloud.estimate().pose == pytest.approx([0.35, 0.35, 0.0])
    assert cloud.estimate().covariance[0, 0] == pytest.approx(poses[:, 0].var())


@pytest.mark.parametrize("size", [1, 3, 6, 40])
def test_bins_that_touch_each_other_are_a_cluster(size: int) -> None:
    """Directly, or by others in between; at all densities."""
    bins = np.random.default_rng(size).integers(-size, size, (200, 3))
    found = clusters_of(bins)
    expected = np.arange(len(bins))
    touching = (np.abs(bins[:, None] - bins) <= 1).all(axis=2)
    for _ in bins:
        expected = np.where(touching, expected, len(bins)).min(axis=1)

    assert (
        np.unique(np.column_stack([found, expected]), axis=0).shape[0]
        == len(set(found.tolist()))
        == len(set(expected.tolist()))
    )


class World:
    """A robot in the room: its odometry, its laser, and what the program says."""

    def __init__(self, node: Any, clock: ManualClock, program: Amcl) -> None:
        self.node, self.clock, self.program = node, clock, program
        self.scans = node.create_publisher(LaserScan, "scan", 10)
        self.initial = node.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)
        self.maps = node.create_publisher(
            OccupancyGrid, "map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )
        self.broadcaster = TransformBroadcaster(node)
        self.poses: list[PoseWithCovarianceStamped] = []
        self.transforms: list[TransformStamped] = []
        self.clouds: list[ParticleCloud] = []
        node.create_subscription(PoseWithCovarianceStamped, "amcl_pose", self.poses.append)
        node.create_subscription(
            ParticleCloud, "particle_cloud", self.clouds.append, qos_profile_sensor_data
        )
        node.create_subscription(
            TFMessage,
            "/tf",
            lambda msg: self.transforms.extend(
                each for each in msg.transforms if each.header.frame_id == "map"
            ),
        )
        laser = TransformStamped(child_frame_id="laser")
        laser.header.frame_id = "base_footprint"
        laser.transform.translation.x, laser.transform.rotation = 0.1, about_z(0.0)
        StaticTransformBroadcaster(node).sendTransform(laser)

    def stamp(self) -> Any:
        """Return the time."""
        return self.node.get_clock().now().to_msg()

    async def scan(
        self, x: float, y: float, yaw: float, odom: tuple[float, float, float], **more: Any
    ) -> None:
        """Publish the odometry, and a scan where the robot is."""
        await self.clock.advance(0.1)
        await self.move(odom)
        await self.look(x, y, yaw, **more)

    async def move(self, odom: tuple[float, float, float]) -> None:
        """Publish the odometry."""
        moved = TransformStamped(child_frame_id="base_footprint")
        moved.header.frame_id, moved.header.stamp = "odom", self.stamp()
        moved.transform.translation.x, moved.transform.translation.y = odom[:2]
        moved.transform.rotation = about_z(odom[2])
        self.broadcaster.sendTransform(moved)
        await settle()

    async def look(self, x: float, y: float, yaw: float, **more: Any) -> None:
        """Publish a scan where the robot is."""
        ranges = ranges_at(x + 0.1 * math.cos(yaw), y + 0.1 * math.sin(yaw), yaw)
        msg = LaserScan(
            angle_min=-math.pi,
            angle_increment=2 * math.pi / 180,
            range_max=12.0,
            ranges=ranges,
        )
        msg.header.frame_id, msg.header.stamp = "laser", self.stamp()
        for name, value in more.items():
            setattr(msg, name, value)
        self.scans.publish(msg)
        await settle()

    def pose(self, x: float, y: float, yaw: float, frame: str = "map") -> Any:
        """Return an initial pose, which may be 0.2 m and 0.1 rad off."""
        msg = PoseWithCovarianceStamped()
        msg.header.frame_id, msg.header.stamp = frame, self.stamp()
        msg.pose.pose.position.x, msg.pose.pose.position.y = x, y
        msg.pose.pose.orientation = about_z(yaw)
        msg.pose.covariance[[0, 7, 35]] = 0.04, 0.04, 0.01
        return msg

    async def begin(self, x: float, y: float, yaw: float, frame: str = "map") -> None:
        """Say where the robot is."""
        self.initial.publish(self.pose(x, y, yaw, frame))
        await settle()

    async def call(self, kind: Any, name: str, **fields: Any) -> Any:
        """Call a service."""
        return await self.node.create_client(kind, name).call(kind.Request(**fields))


@pytest.fixture
def world(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the program, with its map."""

    async def make(*, activates: bool = True, **parameters: Any) -> World:
        await manual_clock.advance(100.0)
        program = start(Amcl, **{"random_seed": 1} | parameters)
        result = World(node_factory("robot"), manual_clock, program)
        await program.trigger_configure()
        result.maps.publish(room())
        await settle()
        while program.field is None:
            await settle()
        if activates:
            await program.trigger_activate()
        return result

    return make


def place_of(msg: PoseWithCovarianceStamped) -> tuple[float, float, float]:
    """Return x, y and the heading."""
    return (
        msg.pose.pose.position.x,
        msg.pose.pose.position.y,
        yaw_of(msg.pose.pose.orientation),
    )


@pytest.mark.parametrize("model", ["likelihood_field", "likelihood_field_prob"])
async def test_scans_correct_where_the_robot_is_said_to_be(
    world: Callable[..., Any], model: str
) -> None:
    """It is said to be 0.25 m off; each model finds it, by scans of a robot that stands."""
    it = await world(laser_model_type=model)
    await it.begin(2.2, 1.35, 0.35)
    for _ in range(15):
        await it.call(Empty, "request_nomotion_update")
        await it.scan(2.0, 1.5, 0.3, (0.0, 0.0, 0.0))

    assert place_of(it.poses[-1]) == pytest.approx((2.0, 1.5, 0.3), abs=0.06)
    assert it.poses[-1].pose.covariance[0] < it.poses[0].pose.covariance[0]
    assert len(it.poses) == 15


async def test_a_scan_waits_for_the_odometry_of_its_time(world: Callable[..., Any]) -> None:
    """It is often published a little later."""
    it = await world()
    await it.begin(2.0, 1.5, 0.0)
    await it.move((0.0, 0.0, 0.0))
    await it.clock.advance(0.1)
    await it.look(2.0, 1.5, 0.0)
    assert it.poses == []

    await it.clock.advance(0.1)
    await it.move((0.0, 0.0, 0.0))
    assert len(it.poses) == 1


async def test_the_transform_corrects_the_odometry(world: Callable[..., Any]) -> None:
    """The robot is at 2.0, 1.5 of the map and at 1.0, 0.0 of its odometry, and looks aside."""
    it = await world(set_initial_pose=True, **{"initial_pose.x": 2.0, "initial_pose.y": 1.5})
    for _ in range(10):
        await it.call(Empty, "request_nomotion_update")
        await it.scan(2.0, 1.5, 0.0, (1.0, 0.0, 0.0))

    transform = it.transforms[-1]
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    place = transform.transform.translation
    assert (place.x, place.y) == pytest.approx((1.0, 1.5), abs=0.06)
    ahead = Time.from_msg(transform.header.stamp) - it.node.get_clock().now()
    assert ahead.nanoseconds == 10**9


async def test_a_robot_that_moves_is_followed(world: Callable[..., Any]) -> None:
    """Its odometry believes in a tenth more than it drives."""
    it = await world(set_initial_pose=True, **{"initial_pose.x": 1.0, "initial_pose.y": 2.0})
    for step in range(13):
        await it.scan(1.0 + 0.3 * step, 2.0, 0.0, (0.33 * step, 0.0, 0.0))

    assert place_of(it.poses[-1]) == pytest.approx((4.6, 2.0, 0.0), abs=0.15)


async def test_a_robot_that_stands_needs_no_scans(world: Callable[..., Any]) -> None:
    """Its transform is repeated, so that others have one of the present."""
    it = await world()
    await it.begin(2.0, 1.5, 0.0)
    for _ in range(3):
        await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0))

    assert len(it.poses) == 1
    assert len(it.transforms) == 3
    assert len({each.header.stamp.nanosec for each in it.transforms}) == 3


async def test_without_an_initial_pose_nothing_is_said(
    world: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """But that it is needed."""
    it = await world()
    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0))

    assert (it.poses, it.transforms) == ([], [])
    assert "Please set the initial pose" in caplog.text


async def test_messages_of_particles_are_made_in_a_thread(
    world: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of 100,000 particles take half a second, and of 2000, the default, 8 ms."""
    threads: list[int] = []

    def watched(rows: Any) -> list[Particle]:
        threads.append(threading.get_ident())
        return particles_of(rows)

    monkeypatch.setattr("aionode.programs._amcl.amcl.particles_of", watched)
    it = await world()
    await it.call(Empty, "reinitialize_global_localization")
    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0))

    assert threads
    assert threading.get_ident() not in threads


@pytest.fixture
def comparing(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[threading.Event, threading.Event]]:
    """Let scans be compared with the map only when the second event is set; the first tells."""
    began, may_end = threading.Event(), threading.Event()
    likelihood = Sensor.likelihood

    def slow(*arguments: Any) -> Any:
        began.set()
        assert may_end.wait(10)
        return likelihood(*arguments)

    monkeypatch.setattr(Sensor, "likelihood", slow)
    yield began, may_end
    may_end.set()


async def test_particles_that_are_replaced_meanwhile_are_not_weighed(
    world: Callable[..., Any], comparing: tuple[threading.Event, threading.Event]
) -> None:
    """Scans are compared with the map in a thread, as this takes a second for 100,000 particles."""
    began, may_end = comparing
    it = await world()
    await it.call(Empty, "reinitialize_global_localization")
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0)))
        await until(began.is_set)
        it.program.on_global_localization(None, Empty.Response())
        poses = it.program.particles.poses
        may_end.set()

    assert it.program.particles.poses is poses
    assert it.poses == []


async def test_global_localization_spreads_particles_over_a_map(
    world: Callable[..., Any],
) -> None:
    """Whoever looks sees all of them."""
    it = await world()
    await it.call(Empty, "reinitialize_global_localization")
    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0))

    x = [particle.pose.position.x for particle in it.clouds[-1].particles]
    assert len(x) > 1000
    assert max(x) - min(x) > 4.0


async def test_an_initial_pose_before_the_activation_is_kept(world: Callable[..., Any]) -> None:
    """By the service as well as by the topic."""
    it = await world(activates=False)
    await it.call(SetInitialPose, "set_initial_pose", pose=it.pose(2.0, 1.5, 0.0))
    await it.program.trigger_activate()
    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0))

    assert place_of(it.poses[-1]) == pytest.approx((2.0, 1.5, 0.0), abs=0.1)


@pytest.mark.parametrize(
    ("x", "frame", "text"),
    [
        (1.0, "moon\x1b[2J", r'Ignoring initial pose in frame "moon\x1b[2J"; initial poses must'),
        (math.nan, "map", "Received initialpose message is malformed. Rejecting."),
    ],
)
async def test_an_initial_pose_that_cannot_be_used_is_named(
    world: Callable[..., Any], x: float, frame: str, text: str, caplog: pytest.LogCaptureFixture
) -> None:
    """Names of others are shown escaped."""
    it = await world()
    await it.begin(x, 1.0, 0.0, frame)

    assert text in caplog.text
    assert not it.program.is_known


async def test_a_pose_that_may_be_anywhere_is_none(
    world: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """With the variance of a joker, the particles would be beyond all numbers."""
    it = await world()
    msg = it.pose(2.0, 1.5, 0.0)
    msg.pose.covariance[0] = 1e308
    it.initial.publish(msg)
    await settle()

    assert "Received initialpose message is malformed. Rejecting." in caplog.text
    assert not it.program.is_known


@pytest.mark.parametrize(
    "broken",
    [
        {"range_max": 0.0},
        {"range_max": math.nan},
        {"header": LaserScan().header},
    ],
)
async def test_scans_that_cannot_be_used_are_ignored(
    world: Callable[..., Any], broken: dict[str, Any]
) -> None:
    """The next one counts again."""
    it = await world()
    await it.begin(2.0, 1.5, 0.0)
    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0), **broken)
    assert it.poses == []

    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0))

    assert len(it.poses) == 1


@pytest.mark.parametrize("ranges", [[], [math.nan] * 20, [math.inf] * 20, [-1.0] * 20])
async def test_beams_without_an_end_say_nothing(world: Callable[..., Any], ranges: Any) -> None:
    """The robot stays where it was said to be."""
    it = await world()
    await it.begin(2.0, 1.5, 0.0)
    await it.scan(2.0, 1.5, 0.0, (0.0, 0.0, 0.0), ranges=np.array(ranges, np.float32))

    assert place_of(it.poses[-1]) == pytest.approx((2.0, 1.5, 0.0), abs=0.1)


@pytest.mark.parametrize(("more", "corner"), [(1, 0.0), (0, math.nan), (0, 1e300)])
async def test_a_map_that_is_none_is_rejected(
    world: Callable[..., Any], more: int, corner: float, caplog: pytest.LogCaptureFixture
) -> None:
    """The one before stays."""
    it = await world()
    before = it.program.field
    broken = room()
    broken.info.width += more
    broken.info.origin.position.x = corner
    it.maps.publish(broken)
    await settle()

    assert it.program.field is before
    assert "Received map message is malformed. Rejecting." in caplog.text


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"laser_model_type": "beam"}, "laser_model_type is 'beam', which is not here; use like"),
        ({"robot_model_type": "snake"}, "robot_model_type is 'snake'; use nav2_amcl::Differential"),
        ({"min_particles": 0}, "min_particles is 0 and max_particles 2000; use numbers above 0"),
        ({"sigma_hit": 0.0}, "sigma_hit is 0.0; use a number above 0"),
        ({"initial_pose.yaw": math.nan}, "initial_pose.yaw is nan; use a number from -1e+06 to"),
        ({"transform_tolerance": math.nan}, "transform_tolerance is nan; use seconds from 0 to"),
        ({"alpha3": -1.0}, "alpha1 to alpha5 must be 0 or more"),
    ],
)
async def test_parameters_that_do_not_fit_end_the_configuration(
    start: Start, parameters: dict[str, Any], text: str, caplog: pytest.LogCaptureFixture
) -> None:
    """As for other managed nodes."""
    program = start(Amcl, **parameters)

    assert await program.trigger_configure() is TransitionCallbackReturn.FAILURE
    assert text in caplog.text
