"""``nav2_amcl amcl``: where a robot is on a map."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any, Final

import numpy as np

import aionode
from aionode import DurabilityPolicy, Duration, QoSProfile, Time
from aionode._process.concurrency import run_in_thread
from aionode.errors import CommandError, TransformException, escaped
from aionode.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
)
from aionode.interfaces.nav2_msgs.msg import Particle, ParticleCloud
from aionode.interfaces.nav2_msgs.srv import SetInitialPose
from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_srvs.srv import Empty
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.programs._amcl.likelihood import Field, Sensor
from aionode.programs._amcl.particles import Particles, moved_differentially, moved_sideways
from aionode.programs._poses import Array, pose_matrix, wrapped
from aionode.programs._stamps import nanoseconds
from aionode.qos import qos_profile_sensor_data
from aionode.tf import Buffer, TransformBroadcaster, rotation_matrix

__all__ = ["Amcl", "main"]

MOTIONS: Final = {
    "nav2_amcl::DifferentialMotionModel": moved_differentially,
    "nav2_amcl::OmniMotionModel": moved_sideways,
}
MODELS: Final = ("likelihood_field", "likelihood_field_prob")
MAX_PARTICLES: Final = 100_000
FARTHEST: Final = 1e6
"""The highest coordinate and covariance of an initial pose, and of the corner of a map."""

MAX_SEC: Final = 1e6
"""The longest time ahead for which a transform is broadcast."""

TELL_SEC: Final = 2.0

DEFAULTS: Final[dict[str, Any]] = {
    **dict.fromkeys(("alpha1", "alpha2", "alpha3", "alpha4", "alpha5"), 0.2),
    "base_frame_id": "base_footprint",
    "global_frame_id": "map",
    "odom_frame_id": "odom",
    "laser_likelihood_max_dist": 2.0,
    "laser_max_range": 100.0,
    "laser_min_range": -1.0,
    "laser_model_type": "likelihood_field",
    "max_beams": 60,
    "do_beamskip": False,
    "max_particles": 2000,
    "min_particles": 500,
    "pf_err": 0.05,
    "pf_z": 0.99,
    "recovery_alpha_fast": 0.0,
    "recovery_alpha_slow": 0.0,
    "resample_interval": 1,
    "robot_model_type": "nav2_amcl::DifferentialMotionModel",
    "random_seed": -1,
    "set_initial_pose": False,
    "always_reset_initial_pose": False,
    **{f"initial_pose.{name}": 0.0 for name in ("x", "y", "z", "yaw")},
    "sigma_hit": 0.2,
    "z_hit": 0.5,
    "z_max": 0.05,
    "z_rand": 0.5,
    "z_short": 0.05,
    "tf_broadcast": True,
    "transform_tolerance": 1.0,
    "first_map_only": False,
    "update_min_a": 0.2,
    "update_min_d": 0.25,
    "scan_topic": "scan",
    "map_topic": "map",
}
"""The parameters of the original that have an effect here."""


class Amcl(LifecycleNode):
    """Compares scans with a map, and publishes where the robot is and how far its odometry is off.

    The topic `initialpose` or the parameter `set_initial_pose` sets where it begins.
    """

    def __init__(self, node_name: str = "amcl", **options: Any) -> None:
        super().__init__(node_name, **options)
        for name, value in DEFAULTS.items():
            self.declare_parameter(name, value)
        self.buffer = Buffer(self)
        self.broadcaster = TransformBroadcaster(self)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pose_output = self.create_lifecycle_publisher(
            PoseWithCovarianceStamped, "amcl_pose", latched
        )
        self.cloud_output = self.create_lifecycle_publisher(
            ParticleCloud, "particle_cloud", qos_profile_sensor_data
        )
        self.field: Field | None = None
        self.is_known = False
        self.is_new = True  # the filter has used no scan since its particles were placed
        self.is_forced = False
        self.count = 0
        self.last: Array = np.zeros(3)  # the pose of the odometry at the last update
        self.pose: PoseWithCovarianceStamped | None = None
        self.waiting: PoseWithCovarianceStamped | None = None
        self.map_to_odom: Array | None = None
        self.entities: list[Any] = []

    def given(self, name: str) -> Any:
        """Return the value of a parameter."""
        return self.get_parameter(name).value

    # Its states

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Read the parameters, and wait for the map."""
        self.get_logger().info("Configuring")
        try:
            self.prepare()
        except CommandError as error:
            self.get_logger().error(str(error))
            return TransitionCallbackReturn.FAILURE
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.entities = [
            self.create_subscription(
                LaserScan, self.given("scan_topic"), self.on_scan, qos_profile_sensor_data
            ),
            self.create_subscription(
                OccupancyGrid, self.given("map_topic"), self.on_map, latched, offload=True
            ),
            self.create_subscription(
                PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 10
            ),
            self.create_service(
                Empty, "reinitialize_global_localization", self.on_global_localization
            ),
            self.create_service(Empty, "request_nomotion_update", self.on_update_request),
            self.create_service(SetInitialPose, "set_initial_pose", self.on_set_initial_pose),
        ]
        return super().on_configure(state)

    def prepare(self) -> None:
        """Make the filter.

        Raises:
            CommandError: A parameter is invalid.
        """
        model, robot = self.given("laser_model_type"), self.given("robot_model_type")
        if model not in MODELS:
            raise CommandError(
                f"laser_model_type is '{model}', which is not here; use {' or '.join(MODELS)}"
            )
        if robot not in MOTIONS:
            raise CommandError(f"robot_model_type is '{robot}'; use {' or '.join(MOTIONS)}")
        least, most = self.given("min_particles"), self.given("max_particles")
        if not 0 < least <= most <= MAX_PARTICLES:
            raise CommandError(
                f"min_particles is {least} and max_particles {most}; use numbers above 0, at most "
                f"{MAX_PARTICLES}"
            )
        self.check_numbers()
        if self.given("do_beamskip"):
            self.get_logger().warning("do_beamskip: beams are not skipped here")
        self.move = MOTIONS[robot]
        self.alpha = [self.given(f"alpha{number}") for number in range(1, 6)]
        self.sensor = Sensor(
            self.given("z_hit"),
            self.given("z_rand"),
            self.given("sigma_hit"),
            self.given("max_beams"),
            multiplies=model == "likelihood_field_prob",
        )
        seed = self.given("random_seed")
        self.random = np.random.default_rng(seed if seed >= 0 else None)
        self.particles = Particles(
            self.random,
            least=least,
            most=most,
            error=self.given("pf_err"),
            z=self.given("pf_z"),
            slow=self.given("recovery_alpha_slow"),
            fast=self.given("recovery_alpha_fast"),
        )
        self.is_new = True

    def check_numbers(self) -> None:
        """Reject numbers that no filter can use.

        Raises:
            CommandError: A parameter is invalid.
        """
        for name in ("laser_likelihood_max_dist", "sigma_hit", "pf_err", "resample_interval"):
            if not 0 < self.given(name) < math.inf:
                raise CommandError(f"{name} is {self.given(name)}; use a number above 0")
        for name in ("x", "y", "z", "yaw"):
            if not abs(value := self.given(f"initial_pose.{name}")) <= FARTHEST:
                raise CommandError(
                    f"initial_pose.{name} is {value}; use a number from {-FARTHEST:g} to "
                    f"{FARTHEST:g}"
                )
        if not 0.0 <= self.given("transform_tolerance") <= MAX_SEC:
            raise CommandError(
                f"transform_tolerance is {self.given('transform_tolerance')}; use seconds from 0 "
                f"to {MAX_SEC:g}"
            )
        if any(not 0 <= self.given(f"alpha{number}") < math.inf for number in range(1, 6)):
            raise CommandError("alpha1 to alpha5 must be 0 or more")

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Begin where the robot is known to be, if it is."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        if self.given("set_initial_pose") and (
            self.pose is None or self.given("always_reset_initial_pose")
        ):
            msg = PoseWithCovarianceStamped()
            msg.header.frame_id = self.given("global_frame_id")
            msg.header.stamp = self.get_clock().now().to_msg()
            at = msg.pose.pose.position
            at.x, at.y, at.z = (self.given(f"initial_pose.{name}") for name in "xyz")
            msg.pose.pose.orientation = about_z(self.given("initial_pose.yaw"))
            msg.pose.covariance[[0, 7, 35]] = 0.5**2, 0.5**2, (math.pi / 12.0) ** 2
            self.place(msg)
        elif self.waiting is not None:
            self.place(self.waiting)
        self.waiting = None
        return result

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Forget everything but the pose."""
        self.get_logger().info("Cleaning up")
        for entity in self.entities:
            entity.destroy()
        self.entities = []
        self.field = None
        self.is_known = False
        self.map_to_odom = None
        return super().on_cleanup(state)

    @property
    def is_active(self) -> bool:
        """Whether scans are used."""
        return self.lifecycle_state.label == "active"

    # What it hears

    def on_map(self, grid: OccupancyGrid) -> None:
        """Use a map; called in a thread, since computing its distances takes a while."""
        if self.field is not None and self.given("first_map_only"):
            return
        info = grid.info
        self.get_logger().info(
            f"Received a {info.width} X {info.height} map @ {info.resolution:.3f} m/pix"
        )
        if grid.header.frame_id != self.given("global_frame_id"):
            self.get_logger().warning(
                f"Frame_id of map received:'{escaped(grid.header.frame_id, one_line=True)}' "
                f"doesn't match global_frame_id:'{self.given('global_frame_id')}'. This could "
                "cause issues with reading published topics"
            )
        is_whole = info.width * info.height == len(grid.data) > 0
        corner = info.origin.position
        is_whole &= abs(corner.x) <= FARTHEST and abs(corner.y) <= FARTHEST
        if not is_whole or not 0.0 < info.resolution < math.inf:
            self.get_logger().error("Received map message is malformed. Rejecting.")
            return
        self.field = Field(grid, self.given("laser_likelihood_max_dist"))

    def on_initial_pose(self, msg: PoseWithCovarianceStamped) -> None:
        """Start again from another pose."""
        self.get_logger().info("initialPoseReceived")
        frame, own = msg.header.frame_id, self.given("global_frame_id")
        at = msg.pose.pose.position
        numbers = [at.x, at.y, yaw_of(msg.pose.pose.orientation), *msg.pose.covariance]
        if not all(abs(number) <= FARTHEST for number in numbers):
            self.get_logger().error("Received initialpose message is malformed. Rejecting.")
        elif frame != own:
            self.get_logger().warning(
                f'Ignoring initial pose in frame "{escaped(frame, one_line=True)}"; initial poses '
                f'must be in the global frame, "{own}"'
            )
        elif not self.is_active:
            self.waiting = msg
            self.get_logger().warning(
                "Received initial pose request, but AMCL is not yet in the active state"
            )
        else:
            self.place(msg)

    def place(self, msg: PoseWithCovarianceStamped) -> None:
        """Spread the particles around a pose, moved as far as the robot has driven since then."""
        base, odom = self.given("base_frame_id"), self.given("odom_frame_id")
        pose = pose_matrix(msg.pose.pose.position, msg.pose.pose.orientation)
        stamp_ns = stamp_of(msg)
        try:
            found = self.buffer.lookup_transform_full_core(
                base, Time(nanoseconds=stamp_ns), base, self.get_clock().now(), odom
            ).transform
            pose = pose @ pose_matrix(found.translation, found.rotation)
        except TransformException as error:
            if self.map_to_odom is not None:
                self.get_logger().warning(f"Failed to transform initial pose in time ({error})")
        mean = [pose[0, 3], pose[1, 3], math.atan2(pose[1, 0], pose[0, 0])]
        self.get_logger().info(
            f"Setting pose ({self.get_clock().now().nanoseconds / 1e9:.6f}): {mean[0]:.3f} "
            f"{mean[1]:.3f} {mean[2]:.3f}"
        )
        given = np.reshape(msg.pose.covariance, (6, 6))
        covariance = np.zeros((3, 3))
        covariance[:2, :2], covariance[2, 2] = given[:2, :2], given[5, 5]
        self.particles.place(mean, covariance)
        self.is_new, self.is_known = True, True

    def on_set_initial_pose(
        self, request: SetInitialPose.Request, response: SetInitialPose.Response
    ) -> SetInitialPose.Response:
        """Start again from another pose."""
        self.on_initial_pose(request.pose)
        return response

    def on_global_localization(self, _request: Any, response: Empty.Response) -> Empty.Response:
        """Start again with particles all over the map."""
        if self.field is None or not len(self.field.free):
            self.get_logger().error("There is no map with free cells yet")
            return response
        self.get_logger().info("Initializing with uniform distribution")
        self.particles.spread(self.field.random_poses(self.particles.most, self.random))
        self.get_logger().info("Global initialisation done!")
        self.is_new, self.is_known = True, True
        return response

    def on_update_request(self, _request: Any, response: Empty.Response) -> Empty.Response:
        """Use the next scan, even if the robot stands still."""
        self.get_logger().info("Requesting no-motion update")
        self.is_forced = True
        return response

    # Scans

    async def on_scan(self, scan: LaserScan) -> None:
        """Use a scan, after the odometry of its time, which may be published later."""
        if self.is_active and self.field is not None:
            with suppress(TransformException):  # looked up, and reported, below
                await self.buffer.wait_for_transform(
                    self.given("odom_frame_id"),
                    scan.header.frame_id,
                    Time(nanoseconds=stamp_of(scan)),
                    timeout_sec=self.given("transform_tolerance"),
                )
        await self.use(scan)

    async def use(self, scan: LaserScan) -> None:
        """Weigh the particles by a scan, if the robot has moved."""
        if not self.is_active:
            return
        if self.field is None:
            self.warn("Waiting for map....")
            return
        base, odom = self.given("base_frame_id"), self.given("odom_frame_id")
        stamp_ns = stamp_of(scan)
        try:
            laser = self.looked_up(base, scan.header.frame_id, 0)
            robot = self.looked_up(odom, base, stamp_ns)
        except TransformException as error:
            self.warn(f"Couldn't determine robot's pose associated with laser scan: {error}")
            return
        pose = np.array([robot[0, 3], robot[1, 3], math.atan2(robot[1, 0], robot[0, 0])])
        delta = pose - self.last
        delta[2] = wrapped(delta[2])
        least = self.given("update_min_d"), self.given("update_min_d"), self.given("update_min_a")
        is_due = self.is_new or self.is_forced or bool((np.abs(delta) > least).any())
        if is_due and not self.is_known:
            self.warn(
                "AMCL cannot publish a pose or update the transform. Please set the initial pose..."
            )
            return
        if is_due and await self.judge(scan, laser, delta):
            self.last, self.is_new, self.is_forced = pose, False, False
            await self.publish(scan, robot)
        elif self.map_to_odom is not None and self.is_active:
            self.broadcast(stamp_ns)

    def looked_up(self, target: str, source: str, time_ns: int) -> Array:
        """Return the matrix from one frame to another at a time; 0 means the latest."""
        found = self.buffer.lookup_transform_core(target, source, Time(nanoseconds=time_ns))
        return pose_matrix(found.transform.translation, found.transform.rotation)

    async def judge(self, scan: LaserScan, laser: Array, delta: Array) -> bool:
        """Move the particles, weigh them by a scan and draw them anew; return whether it was used.

        It is not used if somebody has replaced the particles meanwhile.
        """
        field = self.field
        longest = min(float(scan.range_max), self.given("laser_max_range"))
        if self.given("laser_max_range") <= 0.0:
            longest = float(scan.range_max)
        if not 0.0 < longest < math.inf or field is None:
            self.warn("wrong range_max of laser_scan data. The message could be malformed.")
            return False
        points = self.points_of(scan, laser, longest)
        if not self.is_new:
            self.particles.poses = self.move(
                self.particles.poses, self.last, delta, self.alpha, self.random
            )
        poses = self.particles.poses
        likelihood = await run_in_thread(self.sensor.likelihood, poses, points, field, longest)
        if self.particles.poses is not poses or not self.is_active:
            return False
        self.particles.weigh(likelihood)
        self.count += 1
        if self.count % self.given("resample_interval") == 0:
            anywhere = len(field.free) > 0
            self.particles.resample(
                lambda count: (
                    field.random_poses(count, self.random)
                    if anywhere
                    else self.particles.poses[:count]
                )
            )
        return True

    def points_of(self, scan: LaserScan, laser: Array, longest: float) -> Array:
        """Return where the beams end, in the frame of the robot, even of a laser upside down."""
        chosen = self.sensor.chosen(len(scan.ranges))
        ranges = np.asarray(scan.ranges[chosen], dtype=float)
        numbers = np.arange(*chosen.indices(len(scan.ranges)))
        angles = scan.angle_min + numbers * scan.angle_increment
        shortest = max(float(scan.range_min), self.given("laser_min_range"))
        used = np.isfinite(ranges) & np.isfinite(angles) & (ranges > shortest) & (ranges < longest)
        ranges, angles = ranges[used], angles[used]
        ends = np.column_stack([ranges * np.cos(angles), ranges * np.sin(angles)])
        result: Array = ends @ laser[:2, :2].T + laser[:2, 3]
        return result

    async def publish(self, scan: LaserScan, robot: Array) -> None:
        """Publish where the robot is."""
        estimate = self.particles.estimate()
        x, y, yaw = map(float, estimate.pose)
        msg = PoseWithCovarianceStamped()
        msg.header.frame_id, msg.header.stamp = self.given("global_frame_id"), scan.header.stamp
        msg.pose.pose.position.x, msg.pose.pose.position.y = x, y
        msg.pose.pose.orientation = about_z(yaw)
        covariance = np.zeros((6, 6))
        covariance[:2, :2] = estimate.covariance[:2, :2]
        covariance[5, 5] = estimate.covariance[2, 2]
        msg.pose.covariance = covariance.reshape(-1)
        self.pose = msg
        self.pose_output.publish(msg)
        self.map_to_odom = pose_matrix(msg.pose.pose.position, about_z(yaw)) @ np.linalg.inv(robot)
        self.broadcast(stamp_of(scan))
        await self.publish_cloud()

    async def publish_cloud(self) -> None:
        """Publish the particles, if anybody subscribes to them."""
        if not self.cloud_output.get_subscription_count():
            return
        cloud = ParticleCloud()
        cloud.header.frame_id = self.given("global_frame_id")
        cloud.header.stamp = self.get_clock().now().to_msg()
        rows = np.column_stack([self.particles.poses, self.particles.weights])
        cloud.particles = await run_in_thread(particles_of, rows)  # slow for thousands of them
        self.cloud_output.publish(cloud)

    def broadcast(self, stamp_ns: int) -> None:
        """Broadcast how far the odometry is off, for some time ahead."""
        if self.map_to_odom is None or not self.given("tf_broadcast"):
            return
        until = Time(nanoseconds=stamp_ns) + Duration(
            nanoseconds=int(self.given("transform_tolerance") * 1e9)
        )
        transform = TransformStamped(child_frame_id=self.given("odom_frame_id"))
        transform.header.frame_id, transform.header.stamp = (
            self.given("global_frame_id"),
            until.to_msg(),
        )
        x, y, z = map(float, self.map_to_odom[:3, 3])
        transform.transform.translation = Vector3(x=x, y=y, z=z)
        yaw = math.atan2(self.map_to_odom[1, 0], self.map_to_odom[0, 0])
        transform.transform.rotation = about_z(yaw)
        self.broadcaster.sendTransform(transform)

    def warn(self, text: str) -> None:
        """Warn, but not at every scan."""
        self.get_logger().warning(escaped(text, one_line=True), throttle_duration_sec=TELL_SEC)


def particles_of(rows: Array) -> list[Particle]:
    """Return particles as messages: rows of x, y, heading and weight."""
    found = []
    for x, y, yaw, weight in rows.tolist():
        pose = Pose(position=Point(x=x, y=y), orientation=about_z(yaw))
        found.append(Particle(pose=pose, weight=weight))
    return found


def stamp_of(msg: Any) -> int:
    """Return the stamp of a message in nanoseconds, from 0 on."""
    return max(0, nanoseconds(msg.header.stamp))


def about_z(yaw: float) -> Quaternion:
    """Return a rotation about the vertical."""
    return Quaternion(z=math.sin(yaw / 2.0), w=math.cos(yaw / 2.0))


def yaw_of(rotation: Quaternion) -> float:
    """Return the angle about the vertical."""
    matrix = rotation_matrix(rotation)
    return math.atan2(matrix[1][0], matrix[0][0])


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Amcl)
