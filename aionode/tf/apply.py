"""Transform stamped messages to another frame."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from aionode.interfaces.geometry_msgs import msg as geometry
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.tf._arithmetic import Pose, angles_of, composed, from_angles, given_transform, unit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from aionode.interfaces.geometry_msgs.msg import TransformStamped

__all__ = [
    "Pose",
    "angles_of",
    "composed",
    "do_transform",
    "from_angles",
    "given_transform",
    "register_transform",
    "rotation_matrix",
    "transformer_of",
]

MessageT = TypeVar("MessageT")

Matrix = tuple[tuple[float, float, float], ...]

REGISTERED: dict[type[Any], Callable[[Any, Any], Any]] = {}
"""The transform functions registered by programs, by type."""


def register_transform(
    msg_type: type[MessageT], function: Callable[[MessageT, TransformStamped], MessageT]
) -> None:
    """Register the function that transforms messages of a type, for `Buffer.transform`.

    Args:
        msg_type: A class whose objects have a `header`.
        function: Called with a message and the transform from its frame; returns a new message.
    """
    REGISTERED[msg_type] = function


def transformer_of(msg_type: type[Any]) -> Callable[[Any, Any], Any]:
    """Return the transform function for messages of a type.

    Raises:
        TypeError: there is none.
    """
    function = REGISTERED.get(msg_type) or BUILT_IN.get(msg_type)
    if function is None:
        raise TypeError(
            f"{msg_type.__name__}: no function transforms this type; the stamped messages of "
            "geometry_msgs and PointCloud2 are known, for others call "
            "aionode.tf.register_transform"
        )
    return function


def do_transform(stamped: MessageT, transform: TransformStamped) -> MessageT:
    """Transform a stamped message to the target frame of a transform.

    Positions and poses are translated and rotated, vectors such as velocities and forces only
    rotated; covariances and inertia tensors are rotated with them. The header is that of the
    transform.

    Raises:
        TypeError: there is no transform function for this type.
    """
    result: MessageT = transformer_of(type(stamped))(stamped, transform)
    return result


# Parts of messages


def pose_of(transform: TransformStamped) -> Pose:
    """Return the pose of a transform."""
    moved, turned = transform.transform.translation, transform.transform.rotation
    return unit((moved.x, moved.y, moved.z, turned.x, turned.y, turned.z, turned.w))


def moved_by(pose: Pose, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Translate and rotate a point."""
    return composed(pose, (x, y, z, 0.0, 0.0, 0.0, 1.0))[:3]


def turned_by(pose: Pose, vector: geometry.Vector3) -> geometry.Vector3:
    """Rotate a vector."""
    turn = (0.0, 0.0, 0.0, *pose[3:])
    x, y, z = moved_by(turn, vector.x, vector.y, vector.z)
    return geometry.Vector3(x=x, y=y, z=z)


def placed(pose: Pose, inner: geometry.Pose) -> geometry.Pose:
    """Translate and rotate a pose."""
    at, turned = inner.position, inner.orientation
    # An unset message has an all-zero quaternion, which tf2 treats as no rotation.
    w = turned.w or float(not (turned.x or turned.y or turned.z))
    own = (at.x, at.y, at.z, turned.x, turned.y, turned.z, w)
    x, y, z, i, j, k, w = unit(composed(pose, own))
    return geometry.Pose(
        position=geometry.Point(x=x, y=y, z=z),
        orientation=geometry.Quaternion(x=i, y=j, z=k, w=w),
    )


def matrix_of(pose: Pose) -> Matrix:
    """Return the rotation of a pose as rows of a matrix."""
    turn = (0.0, 0.0, 0.0, *pose[3:])
    columns = [moved_by(turn, *axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    return tuple(zip(*columns, strict=True))


def rotation_matrix(rotation: geometry.Quaternion) -> Matrix:
    """Convert a quaternion to the rows of a matrix that rotates column vectors."""
    whole = geometry.Transform(rotation=rotation)
    return matrix_of(pose_of(geometry.TransformStamped(transform=whole)))


def turned_tensor(rotation: Matrix, tensor: Sequence[Sequence[float]]) -> list[list[float]]:
    """Return R T Rᵀ."""
    half = [[sum(row[n] * tensor[n][m] for n in range(3)) for m in range(3)] for row in rotation]
    return [[sum(half_row[n] * row[n] for n in range(3)) for row in rotation] for half_row in half]


def turned_covariance(pose: Pose, numbers: Iterable[float]) -> list[float]:
    """Rotate each of the four blocks of a 6x6 covariance, as in tf2."""
    covariance = list(numbers)
    rotation = matrix_of(pose)
    result = [0.0] * 36
    for top in (0, 3):
        for left in (0, 3):
            block = [[covariance[(top + r) * 6 + left + c] for c in range(3)] for r in range(3)]
            for r, row in enumerate(turned_tensor(rotation, block)):
                for c, number in enumerate(row):
                    result[(top + r) * 6 + left + c] = float(number)
    return result


# Whole messages


def point(msg: geometry.PointStamped, by: TransformStamped) -> geometry.PointStamped:
    """Transform a point."""
    x, y, z = moved_by(pose_of(by), msg.point.x, msg.point.y, msg.point.z)
    return geometry.PointStamped(header=by.header, point=geometry.Point(x=x, y=y, z=z))


def vector(msg: geometry.Vector3Stamped, by: TransformStamped) -> geometry.Vector3Stamped:
    """Rotate a vector."""
    return geometry.Vector3Stamped(header=by.header, vector=turned_by(pose_of(by), msg.vector))


def quaternion(msg: geometry.QuaternionStamped, by: TransformStamped) -> geometry.QuaternionStamped:
    """Rotate an orientation."""
    whole = placed(pose_of(by), geometry.Pose(orientation=msg.quaternion))
    return geometry.QuaternionStamped(header=by.header, quaternion=whole.orientation)


def pose(msg: geometry.PoseStamped, by: TransformStamped) -> geometry.PoseStamped:
    """Transform a pose."""
    return geometry.PoseStamped(header=by.header, pose=placed(pose_of(by), msg.pose))


def pose_with_covariance(
    msg: geometry.PoseWithCovarianceStamped, by: TransformStamped
) -> geometry.PoseWithCovarianceStamped:
    """Transform a pose with its covariance."""
    frame = pose_of(by)
    return geometry.PoseWithCovarianceStamped(
        header=by.header,
        pose=geometry.PoseWithCovariance(
            pose=placed(frame, msg.pose.pose),
            covariance=turned_covariance(frame, msg.pose.covariance),
        ),
    )


def transform(msg: geometry.TransformStamped, by: TransformStamped) -> geometry.TransformStamped:
    """Transform another transform; its child frame is kept."""
    at, turned = msg.transform.translation, msg.transform.rotation
    whole = placed(
        pose_of(by),
        geometry.Pose(position=geometry.Point(x=at.x, y=at.y, z=at.z), orientation=turned),
    )
    x, y, z = whole.position.x, whole.position.y, whole.position.z
    return geometry.TransformStamped(
        header=by.header,
        child_frame_id=msg.child_frame_id,
        transform=geometry.Transform(
            translation=geometry.Vector3(x=x, y=y, z=z), rotation=whole.orientation
        ),
    )


def moved_polygon(frame: Pose, polygon: geometry.Polygon) -> geometry.Polygon:
    """Transform the points of a polygon."""
    moved = [moved_by(frame, point.x, point.y, point.z) for point in polygon.points]
    return geometry.Polygon(points=[geometry.Point32(x=x, y=y, z=z) for x, y, z in moved])


def polygon(msg: geometry.PolygonStamped, by: TransformStamped) -> geometry.PolygonStamped:
    """Transform a polygon."""
    return geometry.PolygonStamped(
        header=by.header, polygon=moved_polygon(pose_of(by), msg.polygon)
    )


def polygon_instance(
    msg: geometry.PolygonInstanceStamped, by: TransformStamped
) -> geometry.PolygonInstanceStamped:
    """Transform a polygon; its id is kept."""
    return geometry.PolygonInstanceStamped(
        header=by.header,
        polygon=geometry.PolygonInstance(
            polygon=moved_polygon(pose_of(by), msg.polygon.polygon), id=msg.polygon.id
        ),
    )


def turned_twist(frame: Pose, twist: geometry.Twist) -> geometry.Twist:
    """Rotate a velocity, which remains that of the same point."""
    return geometry.Twist(
        linear=turned_by(frame, twist.linear), angular=turned_by(frame, twist.angular)
    )


def twist(msg: geometry.TwistStamped, by: TransformStamped) -> geometry.TwistStamped:
    """Rotate a velocity."""
    return geometry.TwistStamped(header=by.header, twist=turned_twist(pose_of(by), msg.twist))


def twist_with_covariance(
    msg: geometry.TwistWithCovarianceStamped, by: TransformStamped
) -> geometry.TwistWithCovarianceStamped:
    """Rotate a velocity and its covariance."""
    frame = pose_of(by)
    return geometry.TwistWithCovarianceStamped(
        header=by.header,
        twist=geometry.TwistWithCovariance(
            twist=turned_twist(frame, msg.twist.twist),
            covariance=turned_covariance(frame, msg.twist.covariance),
        ),
    )


def velocity(msg: geometry.VelocityStamped, by: TransformStamped) -> geometry.VelocityStamped:
    """Rotate the velocity of one frame relative to another."""
    return geometry.VelocityStamped(
        header=by.header,
        body_frame_id=msg.body_frame_id,
        reference_frame_id=msg.reference_frame_id,
        velocity=turned_twist(pose_of(by), msg.velocity),
    )


def turned_accel(frame: Pose, accel: geometry.Accel) -> geometry.Accel:
    """Rotate an acceleration."""
    return geometry.Accel(
        linear=turned_by(frame, accel.linear), angular=turned_by(frame, accel.angular)
    )


def accel(msg: geometry.AccelStamped, by: TransformStamped) -> geometry.AccelStamped:
    """Rotate an acceleration."""
    return geometry.AccelStamped(header=by.header, accel=turned_accel(pose_of(by), msg.accel))


def accel_with_covariance(
    msg: geometry.AccelWithCovarianceStamped, by: TransformStamped
) -> geometry.AccelWithCovarianceStamped:
    """Rotate an acceleration and its covariance."""
    frame = pose_of(by)
    return geometry.AccelWithCovarianceStamped(
        header=by.header,
        accel=geometry.AccelWithCovariance(
            accel=turned_accel(frame, msg.accel.accel),
            covariance=turned_covariance(frame, msg.accel.covariance),
        ),
    )


def wrench(msg: geometry.WrenchStamped, by: TransformStamped) -> geometry.WrenchStamped:
    """Rotate a force and a torque, like tf2; they remain those of the same point."""
    frame = pose_of(by)
    return geometry.WrenchStamped(
        header=by.header,
        wrench=geometry.Wrench(
            force=turned_by(frame, msg.wrench.force), torque=turned_by(frame, msg.wrench.torque)
        ),
    )


def inertia(msg: geometry.InertiaStamped, by: TransformStamped) -> geometry.InertiaStamped:
    """Transform the center of mass, and rotate the tensor about it."""
    frame, body = pose_of(by), msg.inertia
    x, y, z = moved_by(frame, body.com.x, body.com.y, body.com.z)
    tensor = turned_tensor(
        matrix_of(frame),
        [
            [body.ixx, body.ixy, body.ixz],
            [body.ixy, body.iyy, body.iyz],
            [body.ixz, body.iyz, body.izz],
        ],
    )
    return geometry.InertiaStamped(
        header=by.header,
        inertia=geometry.Inertia(
            m=body.m,
            com=geometry.Vector3(x=x, y=y, z=z),
            ixx=tensor[0][0],
            ixy=tensor[0][1],
            ixz=tensor[0][2],
            iyy=tensor[1][1],
            iyz=tensor[1][2],
            izz=tensor[2][2],
        ),
    )


def point_cloud(msg: PointCloud2, by: TransformStamped) -> PointCloud2:
    """Transform x, y and z of all points; other fields are kept.

    Raises:
        ValueError: the cloud lacks one of the three fields.
    """
    return cloud_transformer()(msg, by)


@cache
def cloud_transformer() -> Callable[[PointCloud2, TransformStamped], PointCloud2]:
    """Return the function for clouds; numpy is imported on first use."""
    from aionode.tf._cloud import transformed_cloud

    return transformed_cloud


BUILT_IN: dict[type[Any], Callable[[Any, Any], Any]] = {
    geometry.PointStamped: point,
    geometry.Vector3Stamped: vector,
    geometry.QuaternionStamped: quaternion,
    geometry.PoseStamped: pose,
    geometry.PoseWithCovarianceStamped: pose_with_covariance,
    geometry.TransformStamped: transform,
    geometry.PolygonStamped: polygon,
    geometry.PolygonInstanceStamped: polygon_instance,
    geometry.TwistStamped: twist,
    geometry.TwistWithCovarianceStamped: twist_with_covariance,
    geometry.VelocityStamped: velocity,
    geometry.AccelStamped: accel,
    geometry.AccelWithCovarianceStamped: accel_with_covariance,
    geometry.WrenchStamped: wrench,
    geometry.InertiaStamped: inertia,
    PointCloud2: point_cloud,
}
