# Values that do not fit are the point of this file:
# mypy: disable-error-code="arg-type, list-item"
"""Which values fit a field, and what readers of a message get."""

from __future__ import annotations

import array
import enum
import fractions
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies

from aionode.errors import MessageError
from aionode.interfaces.geometry_msgs.msg import Point, Polygon, Pose, Quaternion, Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, Imu, JointState, LaserScan
from aionode.interfaces.std_msgs.msg import (
    Bool,
    Byte,
    ByteMultiArray,
    Char,
    Float32,
    Float64,
    Int8,
    Int32MultiArray,
    String,
    UInt8,
    UInt8MultiArray,
    UInt64,
    UInt64MultiArray,
)
from aionode.interfaces.test_msgs.msg import Arrays, BoundedSequences, UnboundedSequences
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import (
    DEFAULT,
    Array,
    Bounded,
    Message,
    check,
    checker,
    snapshot,
    snapshotter,
)
from tests.support.strategies import any_messages


class Texts(Message, typename="tutorial/msg/Texts"):
    """Strings with a bound."""

    one: Bounded[str, 10] = ""
    three: Array[Bounded[str, 10], 3] = DEFAULT


class Color(enum.IntEnum):
    """A number with a name."""

    RED = 3


class Word(enum.StrEnum):
    """A string with a name."""

    HI = "hi"


@pytest.mark.parametrize(
    ("message", "value"),
    [
        (Int8(data=-128), -128),
        (Int8(data=np.int64(5)), 5),
        (UInt64(data=2**64 - 1), 2**64 - 1),
        (UInt8(data=Color.RED), 3),
        (Char(data=255), 255),
        (Float64(data=1), 1.0),
        (Float64(data=np.float32(0.5)), 0.5),
        (Float64(data=fractions.Fraction(1, 4)), 0.25),
        (Float32(data=3.4028234e38), 3.4028234e38),
        (Float32(data=math.inf), math.inf),
        (Bool(data=np.True_), True),
        (Byte(data=bytearray(b"\x07")), b"\x07"),
        (String(data="é漢"), "é漢"),
        (String(data=Word.HI), "hi"),
        (String(data=np.str_("hi")), "hi"),
    ],
)
def test_what_means_the_same_is_taken_in_one_form(message: Message, value: object) -> None:
    """Readers see Python's own int, float, bool, bytes and str."""
    seen = snapshot(message).data  # type: ignore[attr-defined] # all have it

    assert seen == value
    assert type(seen) is type(value)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Int8(data=300), "std_msgs/msg/Int8.data: 300, int8 holds -128 to 127"),
        (UInt64(data=-1), "std_msgs/msg/UInt64.data: -1, uint64 holds 0 to 18446744073709551615"),
        (Int8(data=10**5000), "std_msgs/msg/Int8.data: a huge number, int8 holds -128 to 127"),
        (
            Float64(data=10**5000),
            "std_msgs/msg/Float64.data: a huge number, too large for a float64",
        ),
        (Char(data=256), "std_msgs/msg/Char.data: 256, char holds 0 to 255"),
        (Int8(data=True), "std_msgs/msg/Int8.data: True (bool), needs an int"),
        (Int8(data=1.0), "std_msgs/msg/Int8.data: 1.0 (float), needs an int"),
        (Int8(data=None), "std_msgs/msg/Int8.data: None (NoneType), needs an int"),
        (Bool(data=1), "std_msgs/msg/Bool.data: 1 (int), needs a bool"),
        (Float64(data="1"), "std_msgs/msg/Float64.data: '1' (str), needs a float"),
        (Float64(data=False), "std_msgs/msg/Float64.data: False (bool), needs a float"),
        (Float32(data=1e39), "std_msgs/msg/Float32.data: 1e+39, too large for a float32"),
        (String(data=5), "std_msgs/msg/String.data: 5 (int), needs a str"),
        (String(data=b"hi"), "std_msgs/msg/String.data: b'hi' (bytes), needs a str"),
        (
            String(data="a\ud800"),
            "std_msgs/msg/String.data: half a surrogate pair at index 1, which UTF-8 cannot encode",
        ),
        (
            Byte(data=5),
            "std_msgs/msg/Byte.data: 5 (int), needs bytes of length 1; write bytes([5])",
        ),
        (Byte(data=b""), "std_msgs/msg/Byte.data: 0 bytes, needs 1"),
        (
            Texts(one="x" * 11),
            "tutorial/msg/Texts.one: 11 characters, at most 10 fit",
        ),
        (
            Texts(three=["a", "b", "c" * 11]),
            "tutorial/msg/Texts.three[2]: 11 characters, at most 10 fit",
        ),
        (
            Imu(orientation_covariance=np.zeros(8)),
            "sensor_msgs/msg/Imu.orientation_covariance: 8 elements, needs 9",
        ),
        (
            BoundedSequences(int8_values=[1, 2, 3, 4]),
            "test_msgs/msg/BoundedSequences.int8_values: 4 elements, at most 3 fit",
        ),
        (
            JointState(name=["a", "b", "c", 4]),
            "sensor_msgs/msg/JointState.name[3]: 4 (int), needs a str",
        ),
        (JointState(name="abc"), "sensor_msgs/msg/JointState.name: 'abc' (str), needs a list"),
        (
            Polygon(points=[Vector3()]),
            (
                "geometry_msgs/msg/Polygon.points[0]: geometry_msgs/msg/Vector3, needs "
                "geometry_msgs/msg/Point32"
            ),
        ),
        (
            Arrays(basic_types_values=[]),
            "test_msgs/msg/Arrays.basic_types_values: 0 elements, needs 3",
        ),
        (
            Pose(position=Point(y="up")),
            "geometry_msgs/msg/Pose.position.y: 'up' (str), needs a float",
        ),
        (
            Pose(orientation=None),
            (
                "geometry_msgs/msg/Pose.orientation: None (NoneType), needs "
                "geometry_msgs/msg/Quaternion"
            ),
        ),
        (
            Int32MultiArray(data=[0, 2**31]),
            (
                "std_msgs/msg/Int32MultiArray.data[1]: 2147483648, int32 holds -2147483648 to "
                "2147483647"
            ),
        ),
        (
            Int32MultiArray(data=np.array([0, 2**40])),
            (
                "std_msgs/msg/Int32MultiArray.data[1]: 1099511627776, int32 holds -2147483648 to "
                "2147483647"
            ),
        ),
        (
            Int32MultiArray(data=np.array([1.0])),
            "std_msgs/msg/Int32MultiArray.data: an array of float64, needs int32",
        ),
        (
            Int32MultiArray(data=[1, True]),
            "std_msgs/msg/Int32MultiArray.data[1]: True (bool), needs an int",
        ),
        (
            Int32MultiArray(data=np.zeros((2, 2), np.int32)),
            "std_msgs/msg/Int32MultiArray.data: an array of 2 dimensions, needs 1",
        ),
        (
            Int32MultiArray(data="12"),
            "std_msgs/msg/Int32MultiArray.data: '12' (str), needs a list or a numpy array",
        ),
        (
            LaserScan(ranges=np.array([1.0, 1e300])),
            "sensor_msgs/msg/LaserScan.ranges[1]: 1e+300, too large for a float32",
        ),
        (
            UInt64MultiArray(data=np.array([-1])),
            "std_msgs/msg/UInt64MultiArray.data[0]: -1, uint64 holds 0 to 18446744073709551615",
        ),
        (
            Image(data="abc"),
            "sensor_msgs/msg/Image.data: 'abc' (str), needs bytes-like or a list of int",
        ),
        (Image(data=[1, 256]), "sensor_msgs/msg/Image.data[1]: 256, uint8 holds 0 to 255"),
        (
            Image(data=np.zeros((2, 2), np.uint8)),
            ("sensor_msgs/msg/Image.data: 2 dimensions, needs 1; use .reshape(-1) or .tobytes()"),
        ),
        (
            Image(data=np.zeros(2)),
            "sensor_msgs/msg/Image.data: a ndarray of format 'd', needs single bytes ('B')",
        ),
        (
            UUID(uuid=b"x" * 16),
            (
                "unique_identifier_msgs/msg/UUID.uuid: b'xxxxxxxxxxxxxxxx' (bytes), needs a list "
                "or a numpy array"
            ),
        ),
    ],
    ids=lambda value: None if isinstance(value, str) else type(value).__name__,
)
def test_an_invalid_value_is_named_with_its_path_and_what_fits(message: Message, text: str) -> None:
    """The error suffices to fix the mistake without a debugger."""
    for validate in (snapshot, check):
        with pytest.raises(MessageError) as caught:
            validate(message)
        assert str(caught.value) == text


@pytest.mark.parametrize(
    ("values", "dtype"),
    [
        ([1, 2], np.int32),
        ((1, 2), np.int32),
        (range(1, 3), np.int32),
        (array.array("i", [1, 2]), np.int32),
        (np.array([1, 2], np.int64), np.int32),
        (np.array([1, 2], np.uint8), np.int32),
        (np.array([1, 2], ">i4"), np.int32),
        (np.array([1, 2], object), np.int32),
        ([Color.RED, np.int8(2)], np.int32),
    ],
    ids=lambda value: type(value).__name__,
)
def test_numbers_come_in_many_containers(values: object, dtype: type) -> None:
    """Readers always see an array of the field's dtype."""
    seen = snapshot(Int32MultiArray(data=values)).data

    assert isinstance(seen, np.ndarray)
    assert seen.dtype == dtype
    assert seen.tolist() == [int(value) for value in values]  # type: ignore[attr-defined] # all are


def test_float_arrays_take_ints_and_keep_nan_and_infinity() -> None:
    """Values are rounded to 32 bits as usual, and infinity stays infinity."""
    seen = snapshot(LaserScan(ranges=[1, 0.5, math.inf], intensities=np.array([math.nan, 2.0])))

    assert seen.ranges.tolist() == [1.0, 0.5, math.inf]
    assert seen.intensities.dtype == np.float32
    assert math.isnan(seen.intensities[0])


def test_an_empty_array_of_any_dtype_fits() -> None:
    """`np.array([])` is of float64, which is never intended."""
    assert snapshot(Int32MultiArray(data=np.array([]))).data.dtype == np.int32
    assert snapshot(Image(data=np.array([]))).data == b""


@pytest.mark.parametrize(
    "values",
    [b"ab", bytearray(b"ab"), memoryview(b"ab"), [97, 98], np.frombuffer(b"ab", np.uint8)],
    ids=lambda value: type(value).__name__,
)
def test_bytes_come_in_many_containers(values: object) -> None:
    """Readers see bytes-like objects."""
    seen = snapshot(UInt8MultiArray(data=values)).data

    assert isinstance(seen, bytes | memoryview)
    assert bytes(seen) == b"ab"


def test_a_list_of_bytes_is_taken_as_in_rclpy() -> None:
    """Rclpy holds byte[] in a list of bytes of length 1."""
    assert bytes(snapshot(ByteMultiArray(data=[b"a", b"b"])).data) == b"ab"


def test_a_snapshot_shares_nothing_that_can_change() -> None:
    """The publisher may use its object again at once."""
    position, data, name = np.array([1.0]), bytearray(b"a"), ["x"]
    joints, image = JointState(name=name, position=position), Image(data=data)
    twist = Twist()

    taken, taken_image, taken_twist = snapshot(joints), snapshot(image), snapshot(twist)
    position[0], data[0], name[0], twist.linear.x = 2, 98, "y", 5.0

    assert taken.position.tolist() == [1.0]
    assert taken.name == ["x"]
    assert bytes(taken_image.data) == b"a"
    assert taken_twist.linear.x == 0.0


def test_a_snapshot_shares_what_cannot_change() -> None:
    """Big images and clouds are not copied if they are bytes or marked read-only."""
    data, position = b"x" * 100, np.zeros(100)
    position.flags.writeable = False

    assert snapshot(Image(data=data)).data is data
    assert snapshot(JointState(position=position)).position is position
    view = memoryview(data)
    assert snapshot(Image(data=view)).data.obj is data  # type: ignore[union-attr] # a view


def test_arrays_of_a_snapshot_are_read_only() -> None:
    """Several readers share them."""
    taken = snapshot(JointState(position=np.zeros(2), velocity=[1.0]))

    for values in (taken.position, taken.velocity):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0


@settings(suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(
    data=strategies.data(),
    field=strategies.sampled_from(
        ["bool", "int8", "int16", "uint32", "int64", "float32", "float64"]
    ),
    step=strategies.sampled_from([1, 2, 3, -1, -2]),
    count=strategies.integers(0, 20),
)
def test_a_snapshot_of_any_array_has_its_values_and_no_memory_of_it(
    data: strategies.DataObject, field: str, step: int, count: int
) -> None:
    """For every type, including empty, strided and reversed arrays."""
    dtype = np.dtype(field)
    memory = np.frombuffer(data.draw(strategies.binary(min_size=60 * 8, max_size=60 * 8)), np.uint8)
    values = (memory[:60] & 1).astype(bool) if field == "bool" else memory.view(dtype)[:60].copy()
    given_array = values[::step][:count]
    assert given_array.flags.writeable

    taken = snapshot(UnboundedSequences(**{f"{field}_values": given_array}))
    copy = getattr(taken, f"{field}_values")

    assert copy.dtype == dtype
    assert copy.tobytes() == given_array.tobytes()
    assert not copy.flags.writeable
    assert not np.shares_memory(copy, values)


def test_a_snapshot_of_a_masked_array_keeps_its_values() -> None:
    """`tobytes` would fill in masked values."""
    masked = np.ma.MaskedArray([1.0, 2.0], mask=[False, True])
    taken = snapshot(JointState(position=masked))

    assert np.asarray(taken.position).tolist() == [1.0, 2.0]
    assert not taken.position.flags.writeable


def test_an_array_that_is_not_contiguous_is_copied_in_order() -> None:
    """A column of a matrix is a valid sequence of numbers."""
    matrix = np.arange(6.0).reshape(3, 2)

    assert snapshot(JointState(position=matrix[:, 1])).position.tolist() == [1.0, 3.0, 5.0]


def test_a_check_copies_and_changes_nothing() -> None:
    """It only validates; lists stay lists."""
    message = JointState(position=[1, 2])

    check(message)

    assert message.position == [1, 2]


def test_an_object_of_another_class_is_a_type_error_with_both_names() -> None:
    """A Twist passed to a publisher of String is a bug, not a value that does not fit."""
    for make in (snapshotter, checker):
        with pytest.raises(TypeError, match="std_msgs/msg/String: got geometry_msgs/msg/Twist"):
            make(String)(Twist())
        with pytest.raises(TypeError, match=r"got 'hi' \(str\), needs an object of std_msgs"):
            make(String)("hi")


def test_two_classes_of_one_name_are_told_apart_by_their_modules() -> None:
    """Otherwise the error would say: got String, needs String."""

    class Other(Message, typename="std_msgs/msg/String"):
        data: str = ""

    with pytest.raises(TypeError, match=r"aionode\.interfaces\.std_msgs\.msg\.String"):
        snapshotter(String)(Other())


def test_functions_are_made_once_for_each_class() -> None:
    """Generating code costs milliseconds, calling it less than a microsecond."""
    assert snapshotter(Quaternion) is snapshotter(Quaternion)
    assert checker(Quaternion) is checker(Quaternion)


def test_something_that_is_no_message_class_is_a_type_error() -> None:
    """The error says so, instead of an obscure one from inside."""
    with pytest.raises(TypeError, match="not a message class"):
        snapshotter(int)  # type: ignore[type-var] # the point of the test


@settings(
    max_examples=settings().max_examples * 3 // 2,
    suppress_health_check=list(HealthCheck),
    deadline=None,
)
@given(any_messages())
def test_a_snapshot_of_any_message_equals_it(message: Message) -> None:
    """For every type that is shipped."""
    check(message)
    taken = snapshot(message)

    assert taken == message
    assert snapshot(taken) == taken
