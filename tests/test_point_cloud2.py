"""Point clouds as numpy arrays, in the words of sensor_msgs_py."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from aionode.engine.wire.cdr import decode, encode
from aionode.errors import MessageError
from aionode.interfaces.sensor_msgs.msg import PointCloud2, PointField
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import check
from aionode.point_cloud2 import (
    create_cloud,
    create_cloud_xyz32,
    dtype_from_fields,
    fields_from_dtype,
    read_points,
    read_points_list,
    read_points_numpy,
)

XYZ = np.arange(12, dtype=np.float32).reshape(4, 3)
HEADER = Header(frame_id="lidar")
LIDAR = np.dtype(
    {
        "names": ["x", "y", "z", "intensity", "ring"],
        "formats": ["<f4", "<f4", "<f4", "<f4", "<u2"],
        "offsets": [0, 4, 8, 16, 20],
        "itemsize": 24,
    }
)


def field(name: str, offset: int, datatype: int = PointField.FLOAT32, count: int = 1) -> PointField:
    """Return a field of a point."""
    return PointField(name=name, offset=offset, datatype=datatype, count=count)


def test_a_cloud_of_coordinates_comes_back_as_it_was() -> None:
    """The usual cloud, through the wire."""
    cloud = decode(PointCloud2, encode(create_cloud_xyz32(HEADER, XYZ)))

    assert (cloud.height, cloud.width, cloud.point_step, cloud.row_step) == (1, 4, 12, 48)
    assert cloud.header.frame_id == "lidar"
    assert np.array_equal(read_points_numpy(cloud), XYZ)
    assert list(read_points(cloud)["y"]) == [1.0, 4.0, 7.0, 10.0]


def test_neither_way_copies_coordinates() -> None:
    """A cloud of a lidar is a megabyte, ten times a second."""
    cloud = create_cloud_xyz32(HEADER, XYZ)

    assert np.shares_memory(np.asarray(cloud.data), XYZ)
    assert np.shares_memory(read_points(cloud), XYZ)
    assert np.shares_memory(read_points_numpy(cloud), XYZ)
    check(cloud)


def test_a_structured_array_keeps_its_layout() -> None:
    """With the gaps that SSE wants; no copy either."""
    points = np.zeros(3, LIDAR)
    points["ring"] = [7, 8, 9]

    cloud = create_cloud(HEADER, None, points)

    assert cloud.point_step == 24
    assert [(f.name, f.offset, f.datatype) for f in cloud.fields] == [
        ("x", 0, 7),
        ("y", 4, 7),
        ("z", 8, 7),
        ("intensity", 16, 7),
        ("ring", 20, 4),
    ]
    assert np.shares_memory(np.asarray(cloud.data), points)
    assert read_points(cloud).dtype == LIDAR
    assert list(read_points(cloud)["ring"]) == [7, 8, 9]


def test_an_organized_cloud_has_rows() -> None:
    """As from a depth camera."""
    cloud = create_cloud_xyz32(HEADER, XYZ.reshape(2, 2, 3))

    assert (cloud.height, cloud.width, cloud.row_step) == (2, 2, 24)
    assert read_points(cloud).shape == (4,)
    assert read_points(cloud, reshape_organized_cloud=True).shape == (2, 2)
    assert read_points_numpy(cloud, reshape_organized_cloud=True).shape == (2, 2, 3)


def test_rows_may_be_padded() -> None:
    """`row_step` says where each begins."""
    rows = b"".join(XYZ[i : i + 2].tobytes() + b"\xff" * 8 for i in (0, 2))
    cloud = create_cloud_xyz32(HEADER, XYZ.reshape(2, 2, 3))
    cloud.row_step, cloud.data = 32, rows

    assert np.array_equal(read_points_numpy(cloud), XYZ)
    points = read_points(cloud, reshape_organized_cloud=True)
    assert points.base is not None
    assert list(points["x"][1]) == [6.0, 9.0]


def test_a_single_row_needs_no_row_step() -> None:
    """Many drivers leave it out."""
    cloud = create_cloud_xyz32(HEADER, XYZ)
    cloud.row_step = 0

    assert np.array_equal(read_points_numpy(cloud), XYZ)


def test_the_highest_byte_may_be_first() -> None:
    """Values are right, and the bytes are not turned in the message."""
    cloud = create_cloud_xyz32(HEADER, XYZ)
    cloud.is_bigendian, cloud.data = True, XYZ.astype(">f4").tobytes()

    assert np.array_equal(read_points_numpy(cloud), XYZ)
    assert np.array_equal(read_points_numpy(cloud), XYZ)


def test_points_without_all_numbers_are_left_out_on_request() -> None:
    """Unless the cloud says that there are none; then no point is checked."""
    points = XYZ.copy()
    points[1, 2] = np.nan
    cloud = create_cloud_xyz32(HEADER, points)

    assert len(read_points(cloud)) == 4
    assert list(read_points(cloud, skip_nans=True)["x"]) == [0.0, 6.0, 9.0]
    assert len(read_points(cloud, ["x", "y"], skip_nans=True)) == 4
    cloud.is_dense = True
    assert len(read_points(cloud, skip_nans=True)) == 4


def test_some_fields_in_any_order() -> None:
    """The result is still a view."""
    cloud = create_cloud_xyz32(HEADER, XYZ)

    assert np.array_equal(read_points_numpy(cloud, ["z", "x"]), XYZ[:, [2, 0]])
    assert np.shares_memory(read_points(cloud, ["z", "x"]), XYZ)


@pytest.mark.parametrize("uvs", [[3, 0], np.array([3, 0]), [(1, 1), (0, 0)]])
def test_some_points_by_number_or_by_column_and_row(uvs: Any) -> None:
    """Numbers as in sensor_msgs_py, pairs as its documentation says."""
    cloud = create_cloud_xyz32(HEADER, XYZ.reshape(2, 2, 3))

    assert list(read_points(cloud, uvs=uvs)["x"]) == [9.0, 0.0]
    assert len(read_points(cloud, uvs=[])) == 0


def test_a_few_points_as_tuples() -> None:
    """Both ways."""
    fields = [field("x", 0), field("rgb", 4, PointField.UINT32)]

    cloud = create_cloud(HEADER, fields, [(1.5, 0xFF0000), (2.5, 0x0000FF)])

    points = read_points_list(cloud)
    assert [(p.x, p.rgb) for p in points] == [(1.5, 0xFF0000), (2.5, 0x0000FF)]


def test_a_field_may_hold_several_numbers() -> None:
    """Normals and histograms are examples."""
    fields = [field("id", 0, PointField.UINT8), field("normal", 4, count=3)]

    cloud = create_cloud(HEADER, fields, [[1, 0.0, 0.5, 1.0]], step=20)

    assert cloud.point_step == 20
    assert read_points(cloud)["normal"].tolist() == [[0.0, 0.5, 1.0]]
    assert fields_from_dtype(dtype_from_fields(fields, 20)) == fields


def test_points_of_another_type_are_converted() -> None:
    """float64 is what numpy makes by itself; columns of tables are often out of order."""
    table = np.array([(2.0, 1.0)], [("y", "f8"), ("x", "f8")])

    cloud = create_cloud(HEADER, [field("x", 0), field("y", 4)], table)

    assert read_points_numpy(cloud).tolist() == [[1.0, 2.0]]
    assert np.array_equal(read_points_numpy(create_cloud_xyz32(HEADER, XYZ.astype(float))), XYZ)
    assert np.array_equal(read_points_numpy(create_cloud_xyz32(HEADER, XYZ.tolist())), XYZ)


@pytest.mark.parametrize("points", [[], np.zeros((0, 3), np.float32)])
def test_an_empty_cloud_is_a_cloud(points: Any) -> None:
    """As from a lidar in fog."""
    cloud = create_cloud_xyz32(HEADER, points)

    assert (cloud.width, len(cloud.data)) == (0, 0)
    assert len(read_points(cloud)) == 0
    assert read_points_numpy(cloud).shape == (0, 3)


def test_received_points_are_read_only() -> None:
    """They are the bytes that all readers share."""
    cloud = decode(PointCloud2, encode(create_cloud_xyz32(HEADER, XYZ)))

    with pytest.raises(ValueError, match="read-only"):
        read_points(cloud)["x"] = 0.0


def broken(**values: Any) -> PointCloud2:
    """Return a cloud that contradicts itself."""
    cloud = create_cloud_xyz32(HEADER, XYZ.reshape(2, 2, 3))
    for name, value in values.items():
        setattr(cloud, name, value)
    return cloud


@pytest.mark.parametrize(
    ("cloud", "text"),
    [
        (broken(data=b"123"), r"\.data: 3 bytes, but 2 rows of 2 points need 48"),
        (broken(row_step=8), r"\.row_step: 8, but 2 points of 12 bytes need 24"),
        (broken(point_step=8), r"\.point_step: 8, but its fields need 12"),
        (broken(fields=[field("x", 0, 42)]), r"fields\[0\]\.datatype: 42 is unknown"),
        (broken(fields=[field("x", 0), field("x", 4)]), r"fields\[1\]\.name: 'x' is used twice"),
    ],
)
def test_a_cloud_that_contradicts_itself_names_the_field(cloud: PointCloud2, text: str) -> None:
    """Messages of other programs are checked before they are read."""
    with pytest.raises(MessageError, match=text):
        read_points(cloud)


def test_mistakes_say_what_fits() -> None:
    """Each names what was given."""
    cloud = create_cloud(HEADER, None, np.zeros(1, LIDAR))
    with pytest.raises(TypeError, match="ndarray given"):
        read_points(XYZ)  # type: ignore[arg-type]  # the mistake
    with pytest.raises(ValueError, match="no field 'rgb'; it has x, y, z, intensity, ring"):
        read_points(cloud, ["rgb"])
    with pytest.raises(ValueError, match=r"different types.*ring uint16.*field_names"):
        read_points_numpy(cloud)
    with pytest.raises(ValueError, match="reshape_organized_cloud keeps every point"):
        read_points(broken(), skip_nans=True, reshape_organized_cloud=True)
    with pytest.raises(TypeError, match="needs a structured array"):
        create_cloud(HEADER, None, XYZ)
    with pytest.raises(ValueError, match=r"shape \(4, 2\).*must be 3"):
        create_cloud_xyz32(HEADER, XYZ[:, :2])
    with pytest.raises(ValueError, match="the points have no 'x'; they have ring"):
        create_cloud(HEADER, [field("x", 0)], np.zeros(1, LIDAR)[["ring"]])
    with pytest.raises(TypeError, match="id: int64 is not a type of a PointField"):
        fields_from_dtype([("id", "i8")])
