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


class Vector3(Message, typename="geometry_msgs/msg/Vector3"):
    """Vector3."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


class Accel(Message, typename="geometry_msgs/msg/Accel"):
    """Accel."""

    linear: Vector3 = DEFAULT
    angular: Vector3 = DEFAULT


class AccelStamped(Message, typename="geometry_msgs/msg/AccelStamped"):
    """AccelStamped."""

    header: Header = DEFAULT
    accel: Accel = DEFAULT


class AccelWithCovariance(Message, typename="geometry_msgs/msg/AccelWithCovariance"):
    """AccelWithCovariance."""

    accel: Accel = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class AccelWithCovarianceStamped(Message, typename="geometry_msgs/msg/AccelWithCovarianceStamped"):
    """AccelWithCovarianceStamped."""

    header: Header = DEFAULT
    accel: AccelWithCovariance = DEFAULT


class Inertia(Message, typename="geometry_msgs/msg/Inertia"):
    """Inertia."""

    m: float64 = 0.0
    com: Vector3 = DEFAULT
    ixx: float64 = 0.0
    ixy: float64 = 0.0
    ixz: float64 = 0.0
    iyy: float64 = 0.0
    iyz: float64 = 0.0
    izz: float64 = 0.0


class InertiaStamped(Message, typename="geometry_msgs/msg/InertiaStamped"):
    """InertiaStamped."""

    header: Header = DEFAULT
    inertia: Inertia = DEFAULT


class Point(Message, typename="geometry_msgs/msg/Point"):
    """Point."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


class Point32(Message, typename="geometry_msgs/msg/Point32"):
    """Point32."""

    x: float32 = 0.0
    y: float32 = 0.0
    z: float32 = 0.0


class PointStamped(Message, typename="geometry_msgs/msg/PointStamped"):
    """PointStamped."""

    header: Header = DEFAULT
    point: Point = DEFAULT


class Polygon(Message, typename="geometry_msgs/msg/Polygon"):
    """Polygon."""

    points: Annotated[list[Point32], Sequence[Point32]] = DEFAULT


class PolygonInstance(Message, typename="geometry_msgs/msg/PolygonInstance"):
    """PolygonInstance."""

    polygon: Polygon = DEFAULT
    id: int64 = 0


class PolygonInstanceStamped(Message, typename="geometry_msgs/msg/PolygonInstanceStamped"):
    """PolygonInstanceStamped."""

    header: Header = DEFAULT
    polygon: PolygonInstance = DEFAULT


class PolygonStamped(Message, typename="geometry_msgs/msg/PolygonStamped"):
    """PolygonStamped."""

    header: Header = DEFAULT
    polygon: Polygon = DEFAULT


class Quaternion(Message, typename="geometry_msgs/msg/Quaternion"):
    """Quaternion."""

    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


class Pose(Message, typename="geometry_msgs/msg/Pose"):
    """Pose."""

    position: Point = DEFAULT
    orientation: Quaternion = DEFAULT


class Pose2D(Message, typename="geometry_msgs/msg/Pose2D"):
    """Pose2D."""

    x: float64 = 0.0
    y: float64 = 0.0
    theta: float64 = 0.0


class PoseArray(Message, typename="geometry_msgs/msg/PoseArray"):
    """PoseArray."""

    header: Header = DEFAULT
    poses: Annotated[list[Pose], Sequence[Pose]] = DEFAULT


class PoseStamped(Message, typename="geometry_msgs/msg/PoseStamped"):
    """PoseStamped."""

    header: Header = DEFAULT
    pose: Pose = DEFAULT


class PoseWithCovariance(Message, typename="geometry_msgs/msg/PoseWithCovariance"):
    """PoseWithCovariance."""

    pose: Pose = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class PoseWithCovarianceStamped(Message, typename="geometry_msgs/msg/PoseWithCovarianceStamped"):
    """PoseWithCovarianceStamped."""

    header: Header = DEFAULT
    pose: PoseWithCovariance = DEFAULT


class QuaternionStamped(Message, typename="geometry_msgs/msg/QuaternionStamped"):
    """QuaternionStamped."""

    header: Header = DEFAULT
    quaternion: Quaternion = DEFAULT


class Transform(Message, typename="geometry_msgs/msg/Transform"):
    """Transform."""

    translation: Vector3 = DEFAULT
    rotation: Quaternion = DEFAULT


class TransformStamped(Message, typename="geometry_msgs/msg/TransformStamped"):
    """TransformStamped."""

    header: Header = DEFAULT
    child_frame_id: str = ""
    transform: Transform = DEFAULT


class Twist(Message, typename="geometry_msgs/msg/Twist"):
    """Twist."""

    linear: Vector3 = DEFAULT
    angular: Vector3 = DEFAULT


class TwistStamped(Message, typename="geometry_msgs/msg/TwistStamped"):
    """TwistStamped."""

    header: Header = DEFAULT
    twist: Twist = DEFAULT


class TwistWithCovariance(Message, typename="geometry_msgs/msg/TwistWithCovariance"):
    """TwistWithCovariance."""

    twist: Twist = DEFAULT
    covariance: Annotated[Floats, Array[float64, 36]] = DEFAULT


class TwistWithCovarianceStamped(Message, typename="geometry_msgs/msg/TwistWithCovarianceStamped"):
    """TwistWithCovarianceStamped."""

    header: Header = DEFAULT
    twist: TwistWithCovariance = DEFAULT


class Vector3Stamped(Message, typename="geometry_msgs/msg/Vector3Stamped"):
    """Vector3Stamped."""

    header: Header = DEFAULT
    vector: Vector3 = DEFAULT


class VelocityStamped(Message, typename="geometry_msgs/msg/VelocityStamped"):
    """VelocityStamped."""

    header: Header = DEFAULT
    body_frame_id: str = ""
    reference_frame_id: str = ""
    velocity: Twist = DEFAULT


class Wrench(Message, typename="geometry_msgs/msg/Wrench"):
    """Wrench."""

    force: Vector3 = DEFAULT
    torque: Vector3 = DEFAULT


class WrenchStamped(Message, typename="geometry_msgs/msg/WrenchStamped"):
    """WrenchStamped."""

    header: Header = DEFAULT
    wrench: Wrench = DEFAULT
