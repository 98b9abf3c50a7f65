"""Families: classes other than aionode's own that the codec reads and makes."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Callable
from typing import Any

import pytest

from aionode.engine.wire import cdr
from aionode.errors import MessageError
from aionode.interfaces.geometry_msgs.msg import Pose2D, Vector3
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.message import Message, Sequence, fields, float64, int16, int64


class Numbers(Message, typename="test_msgs/msg/Numbers", by_name=False):
    """Sequences of numbers, each after a gap."""

    flags: Sequence[bool]
    small: Sequence[int16]
    real: Sequence[float64]
    none: Sequence[int64]


TYPES: dict[type[Message], type[Any]] = {}


def class_of(cls: type[Message]) -> type[Any]:
    """Return a plain class whose attributes are named as the fields, with ``_`` before."""
    if cls not in TYPES:
        TYPES[cls] = type(cls.__name__, (), {})
    return TYPES[cls]


def constructor(cls: type[Message]) -> Callable[..., Any]:
    """Return what makes an object of such a class."""
    names = [f"_{field.name}" for field in fields(cls)]

    def make(*values: Any) -> Any:
        made = class_of(cls)()
        vars(made).update(zip(names, values, strict=True))
        return made

    return make


def adopt(other: Any) -> Message:
    """Return such an object without nested messages as a message of aionode."""
    cls = next(own for own, one in TYPES.items() if one is type(other))
    return cls(**{name.removeprefix("_"): value for name, value in vars(other).items()})


FAMILY = cdr.MessageFamily(class_of, constructor, adopt, prefix="_")


@pytest.mark.parametrize("order", ["little", "big"])
def test_objects_of_the_family_are_made(order: str) -> None:
    """Nested ones too, and by the fallback decoder as well."""
    data = cdr.encode(LaserScan(ranges=[1.0], angle_min=0.5))
    if order == "big":
        data = b"\0\0\0\0" + bytes(60)

    made: Any = cdr.decoder(LaserScan, FAMILY)(data)

    assert type(made) is class_of(LaserScan)
    assert type(vars(made)["_header"]).__name__ == "Header"
    assert vars(made)["_angle_min"] == (0.5 if order == "little" else 0.0)


def test_objects_of_the_family_are_encoded() -> None:
    """The bytes are those of aionode's message of the same values, in parts as well."""
    own = LaserScan(ranges=[1.0, 2.0])
    made: Any = cdr.decoder(LaserScan, FAMILY)(cdr.encode(own))

    assert cdr.encoder(LaserScan, FAMILY)(made) == cdr.encode(own)
    assert b"".join(cdr.parts_encoder(LaserScan, FAMILY)(made)) == cdr.encode(own)


@pytest.mark.parametrize(("order", "header"), [("<", b"\0\1\0\0"), (">", b"\0\0\0\0")])
def test_sequences_of_numbers_are_memoryviews_for_a_family_without_arrays(
    order: str, header: bytes
) -> None:
    """By either decoder, and as native numbers whatever the order of their bytes."""
    numbers = struct.pack(f"{order}I2?2xI3h2xI2dI", 2, True, False, 3, -1, 2, 3, 2, 0.5, -2.0, 0)

    made: Any = cdr.decoder(Numbers, cdr.PLAIN)(header + numbers)

    assert [one.tolist() for one in (made.flags, made.small, made.real, made.none)] == [
        [True, False],
        [-1, 2, 3],
        [0.5, -2.0],
        [],
    ]


def test_an_array_of_python_is_encoded() -> None:
    """Its memory is what is sent."""
    own = LaserScan(ranges=[1.0, 2.0])
    made: Any = cdr.decoder(LaserScan, FAMILY)(cdr.encode(own))
    made._ranges = array("f", [1.0, 2.0])

    assert cdr.encoder(LaserScan, FAMILY)(made) == cdr.encode(own)


def test_unusual_values_are_adopted() -> None:
    """What aionode accepts is encoded, and the rest refused with its errors."""
    usual: Any = cdr.decoder(Vector3, FAMILY)(cdr.encode(Vector3(x=1.0)))
    usual._x = True

    with pytest.raises(MessageError, match=r"geometry_msgs/msg/Vector3.x: True \(bool\)"):
        cdr.encoder(Vector3, FAMILY)(usual)


def test_a_message_of_another_class_is_not_taken_for_one_of_the_family() -> None:
    """A class is known by its identity, not by its fields."""
    other = constructor(Pose2D)(1.0, 2.0, 3.0)

    with pytest.raises(TypeError):
        cdr.encoder(Vector3, FAMILY)(other)
