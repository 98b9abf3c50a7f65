"""Messages of geometry_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Array, Floats, Message, Sequence, float32, float64, int64

__all__ = [
    "Accel",
    "AccelStamped",
    "AccelWithCovariance",
    "AccelWithCovarianceStamped",
    "Inertia",
    "InertiaStamped",
    "Point",
    "Point32",
    "PointStamped",
    "Polygon",
    "PolygonInstance",
    "PolygonInstanceStamped",
    "PolygonStamped",
    "Pose",
    "Pose2D",
    "PoseArray",
    "PoseStamped",
    "PoseWithCovariance",
    "PoseWithCovarianceStamped",
    "Quaternion",
    "QuaternionStamped",
    "Transform",
    "TransformStamped",
    "Twist",
    "TwistStamped",
    "TwistWithCovariance",
    "TwistWithCovarianceStamped",
    "Vector3",
    "Vector3Stamped",
    "VelocityStamped",
    "Wrench",
    "WrenchStamped",
]


class Point(Message, typename="geometry_msgs/msg/Point"):
    """A point in space: coordinates in m."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


class Quaternion(Message, typename="geometry_msgs/msg/Quaternion"):
    """A rotation as a quaternion of length 1; by default, no rotation."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


class Pose(Message, typename="geometry_msgs/msg/Pose"):
    """Where something is, in m, and how it is turned, as a unit quaternion."""

    position: Point = DEFAULT
    orientation: Quaternion = DEFAULT


class PoseStamped(Message, typename="geometry_msgs/msg/PoseStamped"):
    """A pose, with its time and coordinate frame."""

    header: Header = DEFAULT
    pose: Pose = DEFAULT


class Vector3(Message, typename="geometry_msgs/msg/Vector3"):
    """A direction with a length, in a unit that depends on its use; a position is a Point."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


class Transform(Message, typename="geometry_msgs/msg/Transform"):
    """From one coordinate frame to another: `translation` in m, `rotation` as a unit quaternion."""

    translation: Vector3 = DEFAULT
    rotation: Quaternion = DEFAULT


class Twist(Message, typename="geometry_msgs/msg/Twist"):
    """A velocity: what ``/cmd_vel`` carries.

    Attributes:
        linear: In m/s; x is forward, y to the left, z up.
        angular: In rad/s, about the same axes; a positive z turns left.
    """

    linear: Vector3 = DEFAULT
    angular: Vector3 = DEFAULT


class PointStamped(Message, typename="geometry_msgs/msg/PointStamped"):
    """A point, in m, with its time and coordinate frame."""

    header: Header = DEFAULT
    point: Point = DEFAULT


class TransformStamped(Message, typename="geometry_msgs/msg/TransformStamped"):
    """Where the frame `child_frame_id` is, seen from the frame of the header, at the header's time.

    Attributes:
        header: Time, and the parent frame.
        child_frame_id: The frame that is placed.
        transform: Takes coordinates of the child frame to those of the parent frame, in m.
    """

    header: Header = DEFAULT
    child_frame_id: str = ""
    transform: Transform = DEFAULT


class TwistStamped(Message, typename="geometry_msgs/msg/TwistStamped"):
    """A velocity, in m/s and rad/s, with its time and coordinate frame."""

    header: Header = DEFAULT
    twist: Twist = DEFAULT


class Wrench(Message, typename="geometry_msgs/msg/Wrench"):
    """What pushes and turns a body: `force` in N, `torque` in N·m."""

    force: Vector3 = DEFAULT
    torque: Vector3 = DEFAULT


class WrenchStamped(Message, typename="geometry_msgs/msg/WrenchStamped"):
    """Force and torque, in N and N·m, with its time and coordinate frame."""

    header: Header = DEFAULT
    wrench: Wrench = DEFAULT


class Pose2D(Message, typename="geometry_msgs/msg/Pose2D"):
    """Where something is in a plane: `x` and `y` in m, `theta` in rad, counterclockwise."""

    x: float64 = 0.0
    y: float64 = 0.0
    theta: float64 = 0.0


class Accel(Message, typename="geometry_msgs/msg/Accel"):
    """Acceleration: `linear` in m/s², `angular` in rad/s²."""

    linear: Vector3 = DEFAULT
    angular: Vector3 = DEFAULT


class AccelStamped(Message, typename="geometry_msgs/msg/AccelStamped"):
    """Acceleration, in m/s² and rad/s², with its time and coordinate frame."""

    header: Header = DEFAULT
    accel: Accel = DEFAULT


class AccelWithCovariance(Message, typename="geometry_msgs/msg/AccelWithCovariance"):
    """Acceleration, in m/s² and rad/s², and how certain it is.

    `covariance` is a 6 by 6 matrix, row by row over x, y, z and the rotations about x, y, z.
    """

    accel: Accel = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class AccelWithCovarianceStamped(Message, typename="geometry_msgs/msg/AccelWithCovarianceStamped"):
    """Acceleration and its covariance, with its time and coordinate frame."""

    header: Header = DEFAULT
    accel: AccelWithCovariance = DEFAULT


class Inertia(Message, typename="geometry_msgs/msg/Inertia"):
    """How the mass of a body is distributed.

    Attributes:
        m: Mass, in kg.
        com: Center of mass, in m.
        ixx, ixy, ixz, iyy, iyz, izz: Inertia tensor about the center of mass, in kg·m²; it is
            symmetric, so six numbers suffice.
    """

    m: float64 = 0.0
    com: Vector3 = DEFAULT
    ixx: float64 = 0.0
    ixy: float64 = 0.0
    ixz: float64 = 0.0
    iyy: float64 = 0.0
    iyz: float64 = 0.0
    izz: float64 = 0.0


class InertiaStamped(Message, typename="geometry_msgs/msg/InertiaStamped"):
    """The inertia of a body, with its time and coordinate frame."""

    header: Header = DEFAULT
    inertia: Inertia = DEFAULT


class Point32(Message, typename="geometry_msgs/msg/Point32"):
    """A point in space, in m, with 32 bits per coordinate: for many points, not for one."""

    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0


class Polygon(Message, typename="geometry_msgs/msg/Polygon"):
    """An area: its corners in order, in m; the last joins the first."""

    points: Annotated[list[Point32], Sequence[Point32]] = DEFAULT


class PolygonInstance(Message, typename="geometry_msgs/msg/PolygonInstance"):
    """A polygon with an id that distinguishes it from others."""

    polygon: Polygon = DEFAULT
    id: int64 = 0


class PolygonInstanceStamped(Message, typename="geometry_msgs/msg/PolygonInstanceStamped"):
    """A polygon with an id, with its time and coordinate frame."""

    header: Header = DEFAULT
    polygon: PolygonInstance = DEFAULT


class PolygonStamped(Message, typename="geometry_msgs/msg/PolygonStamped"):
    """A polygon, in m, with its time and coordinate frame."""

    header: Header = DEFAULT
    polygon: Polygon = DEFAULT


class PoseArray(Message, typename="geometry_msgs/msg/PoseArray"):
    """Several poses of one time and coordinate frame."""

    header: Header = DEFAULT
    poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT


class PoseWithCovariance(Message, typename="geometry_msgs/msg/PoseWithCovariance"):
    """A pose and how certain it is.

    `covariance` is 6 by 6 in m² and rad², row by row over x, y, z and the rotations about x, y, z.
    """

    pose: Pose = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class PoseWithCovarianceStamped(Message, typename="geometry_msgs/msg/PoseWithCovarianceStamped"):
    """A pose and its covariance, with its time and coordinate frame."""

    header: Header = DEFAULT
    pose: PoseWithCovariance = DEFAULT


class QuaternionStamped(Message, typename="geometry_msgs/msg/QuaternionStamped"):
    """A rotation, with its time and coordinate frame."""

    header: Header = DEFAULT
    quaternion: Quaternion = DEFAULT


class TwistWithCovariance(Message, typename="geometry_msgs/msg/TwistWithCovariance"):
    """A velocity, in m/s and rad/s, and how certain it is.

    `covariance` is a 6 by 6 matrix, row by row over x, y, z and the rotations about x, y, z.
    """

    twist: Twist = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class TwistWithCovarianceStamped(Message, typename="geometry_msgs/msg/TwistWithCovarianceStamped"):
    """A velocity and its covariance, with its time and coordinate frame."""

    header: Header = DEFAULT
    twist: TwistWithCovariance = DEFAULT


class Vector3Stamped(Message, typename="geometry_msgs/msg/Vector3Stamped"):
    """A vector, with its time and coordinate frame."""

    header: Header = DEFAULT
    vector: Vector3 = DEFAULT


class VelocityStamped(Message, typename="geometry_msgs/msg/VelocityStamped"):
    """A velocity of one frame seen from another, in m/s and rad/s.

    Attributes:
        header: Time, and the frame in whose axes the velocity is given.
        body_frame_id: What moves.
        reference_frame_id: What it moves relative to.
        velocity: The velocity.
    """

    header: Header = DEFAULT
    body_frame_id: str = ""
    reference_frame_id: str = ""
    velocity: Twist = DEFAULT
