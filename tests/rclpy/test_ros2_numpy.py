"""`ros2_numpy`, as programs use it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import ros2_numpy
from rclpy.serialization import serialize_message
from ros2_numpy import point_cloud2, transformations
from rosidl_generator_py import message_class

Image = message_class("sensor_msgs/msg/Image")
MapMetaData = message_class("nav_msgs/msg/MapMetaData")
OccupancyGrid = message_class("nav_msgs/msg/OccupancyGrid")
Point = message_class("geometry_msgs/msg/Point")
PointCloud2 = message_class("sensor_msgs/msg/PointCloud2")
PointField = message_class("sensor_msgs/msg/PointField")
Pose = message_class("geometry_msgs/msg/Pose")
Quaternion = message_class("geometry_msgs/msg/Quaternion")
String = message_class("std_msgs/msg/String")
Time = message_class("builtin_interfaces/msg/Time")
Transform = message_class("geometry_msgs/msg/Transform")
Vector3 = message_class("geometry_msgs/msg/Vector3")

UPSIDE_DOWN = dict(zip("xyzw", transformations.quaternion_from_euler(math.pi, 0, 0), strict=True))
COLOURED = [("x", "f4"), ("y", "f4"), ("z", "f4"), ("r", "u1"), ("g", "u1"), ("b", "u1")]


@pytest.mark.parametrize(("cls", "last"), [(Point, 1.0), (Vector3, 0.0)])
def test_coordinates_are_arrays(cls: type[Any], last: float) -> None:
    """Points move with their frame, vectors only rotate with it."""
    message = cls(x=1.0, y=2.0, z=3.0)
    plain = ros2_numpy.numpify(message)
    homogeneous = ros2_numpy.numpify(message, hom=True)

    assert plain.tolist() == [1.0, 2.0, 3.0]
    assert homogeneous.tolist() == [1.0, 2.0, 3.0, last]
    assert ros2_numpy.msgify(cls, plain) == message
    assert ros2_numpy.msgify(cls, homogeneous) == message
    assert ros2_numpy.msgify(cls, np.array([plain, plain])).tolist() == [message, message]


def test_a_point_is_divided_by_its_fourth_coordinate() -> None:
    """A vector with one is refused."""
    assert ros2_numpy.msgify(Point, np.array([2, 4, 6, 2])) == Point(x=1.0, y=2.0, z=3.0)
    with pytest.raises(AssertionError):
        ros2_numpy.msgify(Vector3, np.array([0, 0, 0, 1]))


@pytest.mark.parametrize(
    "message",
    [
        Transform(translation=Vector3(x=1.0, y=2.0, z=3.0), rotation=Quaternion(**UPSIDE_DOWN)),
        Pose(position=Point(x=1.0, y=2.0, z=3.0), orientation=Quaternion(**UPSIDE_DOWN)),
    ],
)
def test_transforms_and_poses_are_matrices(message: Any) -> None:
    """Several of them are an array of matrices."""
    matrix = ros2_numpy.numpify(message)

    assert np.allclose(matrix @ [0, 0, 1, 1], [1.0, 2.0, 2.0, 1.0])
    back = ros2_numpy.msgify(type(message), matrix)
    assert np.allclose(ros2_numpy.numpify(back), matrix)
    assert ros2_numpy.msgify(type(message), np.array([[matrix] * 3] * 2)).shape == (2, 3)


@pytest.mark.parametrize(
    ("encoding", "dtype", "channels"),
    [("rgb8", "u1", 3), ("mono8", "u1", None), ("mono16", ">u2", None), ("mono16", "<u2", None)],
)
def test_an_image_is_the_same_after_a_message(
    encoding: str, dtype: str, channels: int | None
) -> None:
    """The order of bytes is that of the array."""
    shape = (4, 6) if channels is None else (4, 6, channels)
    image = np.random.default_rng(0).integers(0, 256, shape).astype(dtype)

    message = ros2_numpy.msgify(Image, image, encoding=encoding)

    assert bool(message.is_bigendian) == (dtype == ">u2")
    assert np.array_equal(ros2_numpy.numpify(message), image)


@pytest.mark.parametrize(
    ("encoding", "shape", "dtype"),
    [
        ("mono8", (2, 2, 3), "u1"),
        ("mono8", (2, 2), "f4"),
        ("rgb8", (2, 2, 3), "f4"),
        ("rgb8", (2, 2), "u1"),
        ("rgb8", (2,), "u1"),
        ("nothing", (2, 2), "u1"),
    ],
)
def test_an_array_that_is_no_such_image_is_refused(
    encoding: str, shape: tuple[int, ...], dtype: str
) -> None:
    """Nothing is converted unless requested."""
    with pytest.raises(TypeError):
        ros2_numpy.msgify(Image, np.zeros(shape, dtype), encoding=encoding)


@pytest.mark.parametrize(
    "message",
    [
        Image(encoding="rgb8", height=9, width=9, step=27),
        Image(encoding="rgb8", height=9, width=9, step=27, data=bytes(242)),
        PointCloud2(height=1, width=5, point_step=4, row_step=20),
    ],
)
def test_a_message_with_too_little_data_is_refused(message: Any) -> None:
    """No peer is trusted; numpy does not check the size of an empty buffer."""
    with pytest.raises(TypeError, match="its size needs"):
        ros2_numpy.numpify(message)


def test_unknown_cells_of_a_map_are_masked() -> None:
    """Means and sums then ignore them."""
    cells = np.full((3, 4), -1, np.int8)
    cells[1, 1:3] = 100

    message = ros2_numpy.msgify(OccupancyGrid, cells)
    back = ros2_numpy.numpify(message)

    assert (message.info.height, message.info.width) == (3, 4)
    assert back[0, 0] is np.ma.masked
    assert back.mean() == 100


def test_a_map_can_be_sent_after_it_was_an_array() -> None:
    """Its values have to be of the type that a message has."""
    before = OccupancyGrid(info=MapMetaData(width=3, height=3), data=[0, 0, 0, 0, -1, 0, 0, 0, 0])

    after = ros2_numpy.msgify(OccupancyGrid, ros2_numpy.numpify(before))

    assert serialize_message(after) == serialize_message(before)


def test_fields_are_the_type_of_a_point() -> None:
    """Padding bytes have names that no field has."""
    fields = [
        PointField(name="x", offset=0, count=1, datatype=PointField.FLOAT32),
        PointField(name="normal", offset=8, count=3, datatype=PointField.FLOAT32),
    ]

    listed = ros2_numpy.numpify(fields, point_step=24)

    assert np.dtype(listed).itemsize == 24
    assert [name for name, _ in listed if not name.startswith("__")] == ["x", "normal"]
    dtype = np.dtype([("x", "f4"), ("normal", "f4", (3,))])
    made = ros2_numpy.msgify(PointField, dtype, plural=True)
    assert [(one.name, one.offset, one.count) for one in made] == [("x", 0, 1), ("normal", 4, 3)]


def test_a_cloud_is_the_same_after_a_message() -> None:
    """A single row of points has no row dimension."""
    points = np.zeros(5, COLOURED)
    points["x"] = np.arange(5)

    message = ros2_numpy.msgify(PointCloud2, points, stamp=Time(sec=3), frame_id="map")

    assert (message.header.stamp.sec, message.header.frame_id) == (3, "map")
    assert (message.height, message.width, message.point_step, message.row_step) == (1, 5, 15, 75)
    assert message.is_dense
    assert np.array_equal(ros2_numpy.numpify(message), points)
    assert ros2_numpy.numpify(message, squeeze=False).shape == (1, 5)


def test_points_of_the_other_byte_order_keep_their_values() -> None:
    """The fields of a cloud do not specify the byte order."""
    points = np.array([(1.5, 2), (-3.0, 4)], [("x", ">f4"), ("id", "<u2")])

    message = ros2_numpy.msgify(PointCloud2, points)

    assert ros2_numpy.numpify(message).tolist() == points.tolist()


def test_points_that_are_not_finite_are_left_out() -> None:
    """A depth camera has no distance for some pixels."""
    points = np.zeros((2, 2), COLOURED)
    points["z"] = [[1, 2], [np.nan, 4]]
    message = ros2_numpy.msgify(PointCloud2, points)

    assert not message.is_dense
    assert point_cloud2.pointcloud2_to_xyz_array(message)[:, 2].tolist() == [1, 2, 4]
    assert point_cloud2.pointcloud2_to_xyz_array(message, remove_nans=False).shape == (2, 2, 3)


def test_colours_are_packed_into_one_field_and_taken_out_again() -> None:
    """As in PCL."""
    points = np.zeros(2, COLOURED)
    points["r"], points["g"], points["b"] = 1, 2, 3

    packed = point_cloud2.merge_rgb_fields(points)

    assert packed.dtype.names == ("x", "y", "z", "rgb")
    assert packed["rgb"].view(np.uint32).tolist() == [0x010203] * 2
    assert np.array_equal(point_cloud2.split_rgb_field(packed), points)


def test_what_has_no_converter_is_refused() -> None:
    """None stands for no message."""
    assert ros2_numpy.numpify(None) is None
    with pytest.raises(ValueError, match="String cannot be converted; "):
        ros2_numpy.numpify(String())
    with pytest.raises(ValueError, match="empty"):
        ros2_numpy.numpify([])
    with pytest.raises(ValueError, match="String cannot be created"):
        ros2_numpy.msgify(String, np.zeros(3))


def test_the_functions_beside_those_of_tf_transformations() -> None:
    """The package's module `transformations` has these as well."""
    half_turn = transformations.quaternion_from_euler(0, 0, math.pi)

    assert transformations.quaternion_real([1, 2, 3, 4]) == 4
    assert transformations.quaternion_imag([1, 2, 3, 4]).tolist() == [1, 2, 3]
    assert transformations.is_same_quaternion(half_turn, [-value for value in half_turn])
    assert transformations.vector_product([2, 0, 0], [0, 3, 0]).tolist() == [0, 0, 6]
    assert transformations.angle_between_vectors([1, 0], [-2, 0]) == pytest.approx(math.pi)
    assert transformations.angle_between_vectors([1, 0], [-2, 0], directed=False) == 0
