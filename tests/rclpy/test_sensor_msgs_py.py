"""`sensor_msgs_py.point_cloud2`, as programs use it."""

from __future__ import annotations

from typing import Any

import numpy as np

from rosidl_generator_py import message_class
from sensor_msgs_py import point_cloud2

Header = message_class("std_msgs/msg/Header")
PointField = message_class("sensor_msgs/msg/PointField")
FIELDS = [
    PointField(name="x", offset=0, datatype=PointField.FLOAT32, count=1),
    PointField(name="y", offset=4, datatype=PointField.FLOAT32, count=1),
]
POINTS = [(1.0, 2.0), (3.0, 4.0)]


def cloud() -> Any:
    """A cloud of two points."""
    return point_cloud2.create_cloud(Header(frame_id="map"), FIELDS, POINTS)


def test_a_cloud_is_made_and_read() -> None:
    """Its message is of the kind that rclpy programs publish."""
    made = cloud()

    assert type(made) is message_class("sensor_msgs/msg/PointCloud2")
    assert made.header.frame_id == "map"
    assert (made.width, made.point_step, len(made.data)) == (2, 8, 16)
    assert point_cloud2.read_points(made)["y"].tolist() == [2.0, 4.0]
    assert point_cloud2.read_points_numpy(made).tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert point_cloud2.read_points_list(made, ["x"])[1].x == 3.0
    assert point_cloud2.dtype_from_fields(made.fields) == np.dtype([("x", "<f4"), ("y", "<f4")])


def test_the_bytes_of_a_cloud_are_not_copied() -> None:
    """A lidar sends some megabytes at a time."""
    made = cloud()
    points = point_cloud2.read_points(made)

    made.data[0:4] = type(made.data)("B", np.float32(9).tobytes())

    assert points["x"][0] == 9.0


def test_a_cloud_of_three_columns_is_made() -> None:
    """The usual one."""
    made = point_cloud2.create_cloud_xyz32(Header(), [(1.0, 2.0, 3.0)])

    assert [field.name for field in made.fields] == ["x", "y", "z"]
