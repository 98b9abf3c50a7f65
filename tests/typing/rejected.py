"""Mistakes that mypy --strict and pyright find: each line that ends in `# error` has one."""

from __future__ import annotations

from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, Imu, JointState
from aionode.interfaces.std_msgs.msg import Bool, Int32, String
from aionode.message import DEFAULT, Bounded, Message, int32, snapshot


class Words(Message, typename="tutorial/msg/Words"):
    """A message written by hand."""

    count: int32 = 0
    short: Bounded[str, 3] = ""
    where: Point = DEFAULT


class Bad(Message, typename="tutorial/msg/Bad"):
    """A default of the wrong type."""

    count: int32 = "three"  # error


def wrong_names() -> None:
    """At construction, reading and writing."""
    String(dat="hi")  # error
    Twist(linear=Vector3(w=1.0))  # error
    Words(number=3)  # error
    message = Twist()
    message.linear.w = 1.0  # error
    print(message.lineal)  # noqa: T201 # error
    AddTwoInts.Request(c=1)  # error
    AddTwoInts.Requst()  # error


def wrong_types() -> None:
    """At construction and writing."""
    String(data=5)  # error
    Int32(data="5")  # error
    Int32(data=5.0)  # error
    Bool(data="yes")  # error
    Words(count="three")  # error
    Words(short=3)  # error
    Words(where=Vector3())  # error
    Pose(position=Vector3())  # error
    message = Int32()
    message.data = "5"  # error
    String("hi")  # error
    text: int = String().data  # error
    print(text)  # noqa: T201


def wrong_arrays() -> None:
    """Elements of the wrong type."""
    Imu(orientation_covariance="zeros")  # error
    Imu(orientation_covariance=["a"] * 9)  # error
    JointState(name="joint")  # error
    JointState(name=[1, 2])  # error
    JointState(position=1.0)  # error
    Image(data="abc")  # error
    message = Imu()
    message.orientation_covariance = 5  # error


def wrong_classes() -> None:
    """A result has the type of what was put in."""
    other: Twist = snapshot(String())  # error
    print(other)  # noqa: T201
