"""Convert PointCloud2 messages to numpy arrays and back, with the names of sensor_msgs_py.

Where possible an array is a view of the message's own bytes, and read-only if they are, as in a
received message; copy it to change it.
"""

from __future__ import annotations

import math
from collections import namedtuple
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured

from aionode.errors import MessageError
from aionode.interfaces.sensor_msgs.msg import PointCloud2, PointField

if TYPE_CHECKING:
    import numpy.typing as npt

    from aionode.interfaces.std_msgs.msg import Header

__all__ = [
    "create_cloud",
    "create_cloud_xyz32",
    "dtype_from_fields",
    "fields_from_dtype",
    "read_points",
    "read_points_list",
    "read_points_numpy",
]

DTYPES: dict[int, str] = {
    PointField.INT8: "i1",
    PointField.UINT8: "u1",
    PointField.INT16: "i2",
    PointField.UINT16: "u2",
    PointField.INT32: "i4",
    PointField.UINT32: "u4",
    PointField.FLOAT32: "f4",
    PointField.FLOAT64: "f8",
}
DATATYPES = {dtype: datatype for datatype, dtype in DTYPES.items()}

SUBJECT = "sensor_msgs/msg/PointCloud2"


# Fields and types


def dtype_from_fields(
    fields: Iterable[PointField], point_step: int | None = None, *, is_bigendian: bool = False
) -> np.dtype[Any]:
    """Return the numpy dtype of one point.

    A field of several numbers becomes an array; one without a name is called ``unnamed_field_``
    followed by its index.

    Args:
        fields: The fields of a point.
        point_step: The bytes from one point to the next; by default up to the end of the last
            field.
        is_bigendian: Whether numbers are big-endian.

    Raises:
        MessageError: two fields have one name, a field has an unknown type, or a point exceeds
            `point_step` (a ValueError).
    """
    order = ">" if is_bigendian else "<"
    names: list[str] = []
    formats: list[Any] = []
    offsets: list[int] = []
    end = 0
    for number, field in enumerate(fields):
        path = f"{SUBJECT}.fields[{number}]"
        name = field.name or f"unnamed_field_{number}"
        if name in names:
            raise MessageError(
                f"{path}.name", f"{name!r} is used twice; each field needs a name of its own"
            )
        if field.datatype not in DTYPES:
            raise MessageError(
                f"{path}.datatype", f"{field.datatype} is unknown; use a constant of PointField"
            )
        dtype = np.dtype(order + DTYPES[field.datatype])
        formats.append(dtype if field.count <= 1 else (dtype, (field.count,)))
        names.append(name)
        offsets.append(field.offset)
        end = max(end, field.offset + dtype.itemsize * max(1, field.count))
    if point_step is not None and end > point_step:
        raise MessageError(
            f"{SUBJECT}.point_step", f"{point_step}, but its fields need {end} bytes"
        )
    size = end if point_step is None else point_step
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})


def fields_from_dtype(dtype: npt.DTypeLike) -> list[PointField]:
    """Return the fields that describe a structured dtype, at its offsets.

    Raises:
        TypeError: `dtype` is not structured, or contains anything but integers of 8 to 32 bits,
            float32 and float64.
    """
    dtype = np.dtype(dtype)
    if dtype.names is None:
        raise TypeError(
            f"{dtype}: not structured; use a dtype such as [('x', 'f4'), ('y', 'f4'), ('z', 'f4')]"
        )
    fields = []
    for name in dtype.names:
        part, offset = dtype.fields[name][:2]  # type: ignore[index]  # a type with names has fields
        kind = part.base.str[1:]
        if kind not in DATATYPES:
            fitting = ", ".join(np.dtype(known_dtype).name for known_dtype in DATATYPES)
            raise TypeError(
                f"{name}: {part.base.name} is not a type of a PointField; use one of {fitting}"
            )
        count = int(np.prod(part.shape, dtype=int))
        fields.append(PointField(name=name, offset=offset, datatype=DATATYPES[kind], count=count))
    return fields


# Reading


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,  # the signatures of sensor_msgs_py
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> npt.NDArray[Any]:
    """Return the points as a structured array: ``points["x"]``.

    The points are copied only for `skip_nans` and `uvs`, and to join rows with padding;
    ``reshape_organized_cloud=True`` keeps them as rows.

    Args:
        cloud: The message.
        field_names: Which fields to return; by default all.
        skip_nans: Whether to leave out points with a NaN field; a cloud marked as dense is not
            searched.
        uvs: Which points to return, as indexes or as pairs of column and row.
        reshape_organized_cloud: Whether a cloud of several rows becomes an array of two dimensions.

    Raises:
        TypeError: `cloud` is not a PointCloud2.
        MessageError: its data does not match its fields and size (a ValueError).
        ValueError: it has no such field, or `skip_nans` would leave gaps in rows.
    """
    if not isinstance(cloud, PointCloud2):
        raise TypeError(f"read_points: {type(cloud).__name__} given; a {SUBJECT} is needed")
    points = rows_of(cloud)
    if field_names is not None:
        names = points.dtype.names or ()
        unknown = [name for name in field_names if name not in names]
        if unknown:
            raise ValueError(f"{SUBJECT}: no field {unknown[0]!r}; it has {', '.join(names)}")
        points = points[list(field_names)]
    keep_rows = reshape_organized_cloud and cloud.height > 1
    if keep_rows and (skip_nans or uvs is not None):
        raise ValueError(
            "read_points: reshape_organized_cloud keeps every point, but skip_nans and uvs leave "
            "some out; use one of them"
        )
    if not keep_rows:
        points = points.reshape(-1)
    if uvs is not None:
        points = points[numbers_of(uvs, cloud.width)]
    if skip_nans and not cloud.is_dense:
        points = points[~has_nan(points)]
    return points


def rows_of(cloud: PointCloud2) -> npt.NDArray[Any]:
    """Return all points as an array of rows, a view of the bytes of the message."""
    dtype = dtype_from_fields(cloud.fields, cloud.point_step, is_bigendian=cloud.is_bigendian)
    shape = (cloud.height, cloud.width)
    if not (cloud.height and cloud.width):
        return np.empty(shape, dtype)
    row = cloud.width * cloud.point_step
    # Many drivers do not set the step of a single row, and nothing depends on it.
    step = row if cloud.height == 1 else cloud.row_step
    if step < row:
        raise MessageError(
            f"{SUBJECT}.row_step",
            f"{step}, but {cloud.width} points of {cloud.point_step} bytes need {row}",
        )
    data = memoryview(cloud.data)
    needed = step * (cloud.height - 1) + row
    if data.nbytes < needed:
        raise MessageError(
            f"{SUBJECT}.data",
            f"{data.nbytes} bytes, but {cloud.height} rows of {cloud.width} points need {needed}",
        )
    return np.ndarray(shape, dtype, buffer=data, strides=(step, cloud.point_step))


def numbers_of(uvs: Iterable[Any], width: int) -> npt.NDArray[Any]:
    """Return the indexes of points given as indexes or as pairs of column and row."""
    chosen = np.asarray(uvs if isinstance(uvs, np.ndarray) else list(uvs))
    if chosen.ndim == 2 and chosen.shape[1] == 2:
        return np.asarray(chosen[:, 1] * width + chosen[:, 0])
    return chosen.astype(int) if chosen.size == 0 else chosen


def has_nan(points: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    """Return for each point whether any of its numbers is NaN."""
    has_nan = np.zeros(points.shape, bool)
    for name in points.dtype.names or ():
        values = points[name]
        if values.dtype.kind == "f":
            missing = np.isnan(values)
            has_nan |= (
                missing if missing.ndim == 1 else missing.any(axis=tuple(range(1, values.ndim)))
            )
    return has_nan


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,  # the signatures of sensor_msgs_py
    uvs: Iterable[Any] | None = None,
    reshape_organized_cloud: bool = False,
) -> npt.NDArray[Any]:
    """Return points whose fields share a type as a plain array with one column per field.

    The points are not copied if the fields are adjacent. See `read_points` for the arguments.

    Raises:
        TypeError, MessageError, ValueError: as `read_points`.
        ValueError: the fields have different types.
    """
    points = read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    parts = [points.dtype[name].base for name in points.dtype.names or ()]
    if any(part != parts[0] for part in parts):
        kinds = ", ".join(
            f"{n} {p.name}" for n, p in zip(points.dtype.names or (), parts, strict=True)
        )
        raise ValueError(
            f"{SUBJECT}: its fields are of different types ({kinds}); choose some of one type with "
            "field_names, or use read_points"
        )
    return np.asarray(structured_to_unstructured(points))


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,  # the signatures of sensor_msgs_py
    uvs: Iterable[Any] | None = None,
) -> list[Any]:
    """Return the points as a list of named tuples: convenient for a few points, slow for many.

    See `read_points` for the arguments and the errors.
    """
    points = read_points(cloud, field_names, skip_nans, uvs)
    point = namedtuple("Point", points.dtype.names or ())  # type: ignore[misc]  # noqa: PYI024  # known at run time
    return [point._make(values) for values in points.tolist()]


# Making


def create_cloud(
    header: Header,
    fields: Iterable[PointField] | None,
    points: Any,
    step: int | None = None,
) -> PointCloud2:
    """Make a cloud from `points`.

    A structured array that already has the right layout is not copied but referenced by the
    message, so do not change it before the message is published, which takes a snapshot. An array
    that is marked read-only is never copied within the process.

    Args:
        header: The time of the measurement and the frame of the points.
        fields: The fields of a point; None for those of a structured array.
        points: A structured array; an array whose last dimension is the fields; or tuples. With
            one more dimension they are the rows of an organized cloud.
        step: The bytes from one point to the next; by default up to the end of the last field.

    Raises:
        TypeError: `fields` is None, and `points` is not a structured array.
        MessageError: the fields contradict each other or `step` (a ValueError).
        ValueError: `points` has a different number of fields.
    """
    structured = isinstance(points, np.ndarray) and points.dtype.names is not None
    if fields is None:
        if not structured:
            raise TypeError(
                "create_cloud: fields is None, which needs a structured array of points; give the "
                "fields, or an array with a dtype such as [('x', 'f4'), ('y', 'f4'), ('z', 'f4')]"
            )
        step = points.dtype.itemsize if step is None else step
        fields = fields_from_dtype(points.dtype)
    fields = list(fields)
    dtype = dtype_from_fields(fields, step)
    array = arranged(points, dtype)
    if array.ndim > 2:
        raise ValueError(f"create_cloud: {array.ndim} dimensions of points; use 1, or 2 for rows")
    height, width = array.shape if array.ndim == 2 else (1, array.shape[0])
    array = np.ascontiguousarray(array)
    return PointCloud2(
        header=header,
        height=height,
        width=width,
        fields=fields,
        is_bigendian=False,
        point_step=dtype.itemsize,
        row_step=dtype.itemsize * width,
        data=array.reshape(-1).view(np.uint8).data if array.size else b"",
        is_dense=False,
    )


def arranged(points: Any, dtype: np.dtype[Any]) -> npt.NDArray[Any]:
    """Convert points to an array of `dtype`; an array that already is one is returned as is."""
    names = dtype.names or ()
    if isinstance(points, np.ndarray) and points.dtype.names is not None:
        if points.dtype == dtype:
            return points
        missing = [name for name in names if name not in points.dtype.names]
        if missing:
            raise ValueError(
                f"create_cloud: the points have no {missing[0]!r}; they have "
                f"{', '.join(points.dtype.names)}"
            )
        filled = np.zeros(points.shape, dtype)
        for name in names:
            filled[name] = points[name]
        return filled
    array = np.asarray(points if isinstance(points, np.ndarray) else list(points))
    columns = sum(math.prod(dtype[name].shape) for name in names)
    if array.size == 0:
        return np.zeros(array.shape[:-1] if array.ndim > 1 else 0, dtype)
    if array.ndim < 2 or array.shape[-1] != columns:
        raise ValueError(
            f"create_cloud: points of shape {array.shape}; the last dimension must be "
            f"{columns}, one for each number of {', '.join(names)}"
        )
    return np.asarray(unstructured_to_structured(array, dtype))


def create_cloud_xyz32(header: Header, points: Any, step: int | None = None) -> PointCloud2:
    """Make a cloud of points with x, y and z as float32.

    A float32 array with three columns is not copied. See `create_cloud`.
    """
    fields = [
        PointField(name=name, offset=offset, datatype=PointField.FLOAT32, count=1)
        for name, offset in (("x", 0), ("y", 4), ("z", 8))
    ]
    if not (isinstance(points, np.ndarray) and points.dtype.names is not None):
        points = np.asarray(points if isinstance(points, np.ndarray) else list(points), "<f4")
    return create_cloud(header, fields, points, step)
