"""Stamped messages in another frame."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from aionode import Node
from aionode.interfaces.geometry_msgs import msg as geometry
from aionode.interfaces.sensor_msgs.msg import PointCloud2
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.message import DEFAULT, Message, float64
from aionode.point_cloud2 import create_cloud_xyz32, read_points_numpy
from aionode.tf import Buffer, do_transform, register_transform
from tests.support.transforms import parts, transform

QUARTER = transform("map", "base", 5.0, (10.0, 0.0, 0.0), yaw=math.pi / 2)
"""Turns x into y, and moves by 10 along x."""

HEADER = Header(frame_id="base")
VECTOR = geometry.Vector3(x=1.0, y=2.0, z=3.0)
POINT = geometry.Point(x=1.0, y=2.0, z=3.0)
COVARIANCE = [float(n + 1) if n == m else 0.0 for n in range(6) for m in range(6)]
TURNED_COVARIANCE = [
    float((2, 1, 3, 5, 4, 6)[n]) if n == m else 0.0 for n in range(6) for m in range(6)
]


def xyz(value: Any) -> tuple[float, float, float]:
    """Return three components."""
    return value.x, value.y, value.z


TURNED = pytest.approx((-2, 1, 3))
MOVED = pytest.approx((8, 1, 3))


def test_vectors_are_turned_and_points_are_moved_as_well() -> None:
    """A velocity has a direction, but no position."""
    assert xyz(do_transform(geometry.PointStamped(header=HEADER, point=POINT), QUARTER).point) == (
        MOVED
    )
    vector = do_transform(geometry.Vector3Stamped(header=HEADER, vector=VECTOR), QUARTER)
    assert xyz(vector.vector) == TURNED
    assert vector.header == QUARTER.header
    twist = geometry.Twist(linear=VECTOR, angular=VECTOR)
    for found in (
        do_transform(geometry.TwistStamped(twist=twist), QUARTER).twist,
        do_transform(geometry.VelocityStamped(velocity=twist), QUARTER).velocity,
        do_transform(
            geometry.AccelStamped(accel=geometry.Accel(linear=VECTOR, angular=VECTOR)), QUARTER
        ).accel,
    ):
        assert xyz(found.linear) == TURNED
        assert xyz(found.angular) == TURNED
    wrench = do_transform(
        geometry.WrenchStamped(wrench=geometry.Wrench(force=VECTOR, torque=VECTOR)), QUARTER
    ).wrench
    assert xyz(wrench.force) == TURNED
    assert xyz(wrench.torque) == TURNED


def test_poses_and_transforms_are_moved_and_turned() -> None:
    """Their orientation turns as well."""
    pose = geometry.Pose(position=POINT)
    half = math.sqrt(0.5)
    found = do_transform(geometry.PoseStamped(header=HEADER, pose=pose), QUARTER).pose
    assert xyz(found.position) == MOVED
    assert (found.orientation.z, found.orientation.w) == pytest.approx((half, half))
    turned = do_transform(
        geometry.QuaternionStamped(quaternion=geometry.Quaternion(w=1.0)), QUARTER
    )
    assert (turned.quaternion.z, turned.quaternion.w) == pytest.approx((half, half))
    again = do_transform(transform("base", "camera", 1.0, (1.0, 2.0, 3.0)), QUARTER)
    assert parts(again) == pytest.approx((8, 1, 3, 0, 0, half, half))
    assert (again.header.frame_id, again.child_frame_id) == ("map", "camera")


def test_covariances_turn_with_their_axes() -> None:
    """Each block of three by three, as in tf2."""
    for msg_type, field in (
        (geometry.PoseWithCovarianceStamped, "pose"),
        (geometry.TwistWithCovarianceStamped, "twist"),
        (geometry.AccelWithCovarianceStamped, "accel"),
    ):
        msg: Any = msg_type()
        getattr(msg, field).covariance = COVARIANCE
        found = getattr(do_transform(msg, QUARTER), field).covariance
        assert list(found) == pytest.approx(TURNED_COVARIANCE)


def test_polygons_and_inertia() -> None:
    """Points are stored in 32 bits; the tensor stays relative to the center of mass."""
    polygon = geometry.Polygon(points=[geometry.Point32(x=1.0, y=2.0, z=3.0)])
    found = do_transform(geometry.PolygonStamped(polygon=polygon), QUARTER).polygon
    assert xyz(found.points[0]) == MOVED
    instance = do_transform(
        geometry.PolygonInstanceStamped(polygon=geometry.PolygonInstance(polygon=polygon, id=7)),
        QUARTER,
    ).polygon
    assert xyz(instance.polygon.points[0]) == MOVED
    assert instance.id == 7
    body = geometry.Inertia(m=2.0, com=VECTOR, ixx=1.0, iyy=2.0, izz=3.0)
    inertia = do_transform(geometry.InertiaStamped(inertia=body), QUARTER).inertia
    assert xyz(inertia.com) == MOVED
    assert (inertia.m, inertia.ixx, inertia.iyy, inertia.izz) == pytest.approx((2, 2, 1, 3))


def test_the_points_of_a_cloud_move_and_other_fields_stay() -> None:
    """The header gets the new frame but, as in tf2, keeps the cloud's stamp."""
    cloud = create_cloud_xyz32(Header(frame_id="base"), [(1, 2, 3), (0, 0, 0)])
    found = do_transform(cloud, QUARTER)
    np.testing.assert_allclose(read_points_numpy(found), [(8, 1, 3), (10, 0, 0)], rtol=0, atol=1e-6)
    assert found.header == Header(frame_id="map")
    assert (found.width, found.height, found.row_step) == (2, 1, cloud.row_step)
    assert np.array_equal(read_points_numpy(cloud), [(1, 2, 3), (0, 0, 0)])
    with pytest.raises(ValueError, match="no field x, y, z"):
        do_transform(PointCloud2(), QUARTER)


async def test_a_buffer_transforms_what_is_known_or_registered(node: Node) -> None:
    """It waits for the transform first."""

    class Marker(Message, typename="my_msgs/msg/Marker"):
        """A user's type: a new class for each run, since the process keeps what is registered."""

        header: Header = DEFAULT
        x: float64 = 0.0

    buffer = Buffer(node)
    buffer.set_transform_static(QUARTER, "test")
    point = geometry.PointStamped(header=HEADER, point=POINT)
    assert xyz((await buffer.transform(point, "map")).point) == MOVED
    full = await buffer.transform_full(point, "map", HEADER.stamp, "map")
    assert xyz(full.point) == MOVED

    with pytest.raises(TypeError, match="Marker: no function transforms this type"):
        await buffer.transform(Marker(header=HEADER), "map")
    register_transform(Marker, lambda msg, by: Marker(header=by.header, x=msg.x + 1))
    assert (await buffer.transform(Marker(header=HEADER, x=1.0), "map")).x == 2.0
    with pytest.raises(TypeError, match="String"):
        await buffer.transform(String(), "map")
