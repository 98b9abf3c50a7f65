"""The text of a definition makes the same class again."""

from __future__ import annotations

from types import new_class
from typing import ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.idl import define, definition_text
from aionode.interfaces import get_interface
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.message import (
    DEFAULT,
    Array,
    Bounded,
    Interface,
    Message,
    Sequence,
    byte,
    constants,
    fields,
    float64,
    int32,
    type_name,
)
from tests.support.strategies import shipped_types


def parts(cls: type[Interface]) -> list[type[Message]]:
    """Return the messages of an interface."""
    if issubclass(cls, Message):
        return [cls]
    halves = ("Request", "Response", "Goal", "Result", "Feedback")
    return [getattr(cls, half) for half in halves if hasattr(cls, half)]


@pytest.mark.slow
def test_the_text_of_every_shipped_type_makes_it_again() -> None:
    """What `aionode interface show` prints can be built."""
    for name in shipped_types():
        cls = get_interface(name)
        again = define(name, definition_text(cls))

        assert again is not cls
        assert type_name(again) == name
        for one, other in zip(parts(cls), parts(again), strict=True):
            assert fields(one) == fields(other), name
            assert constants(one) == constants(other), name


def test_a_service_is_printed_as_ros2_interface_show_does() -> None:
    """As recorded from ROS 2."""
    assert definition_text(AddTwoInts) == "int64 a\nint64 b\n---\nint64 sum\n"


def test_types_of_other_packages_have_their_package() -> None:
    """Types of the same package have none."""
    assert definition_text(TwistStamped) == "std_msgs/Header header\nTwist twist\n"


def test_nested_text_shows_what_fields_consist_of() -> None:
    """Indented by tabs, as ros2 interface show does."""
    assert definition_text(Twist, nested=True) == (
        "Vector3 linear\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
        "Vector3 angular\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
    )


def test_a_class_written_by_hand_has_a_text() -> None:
    """For example to show it to a C++ developer."""

    class Words(Message, typename="tutorial/msg/Words"):
        LEVEL: ClassVar[byte] = b"\x02"
        NAME: ClassVar[str] = 'a "b"\n'

        text: Bounded[str, 10] = "hi"
        matrix: Array[float64, 2] = (1, 0.5)
        flags: Sequence[bool, 3] = DEFAULT
        many: Sequence[int32] = DEFAULT

    text = definition_text(Words)

    assert text == (
        'byte LEVEL=2\nstring NAME="a \\"b\\"\\u000a"\nstring<=10 text "hi"\n'
        "float64[2] matrix [1.0, 0.5]\nbool[<=3] flags\nint32[] many\n"
    )
    assert fields(define("tutorial/msg/Words", text)) == fields(Words)
    assert constants(define("tutorial/msg/Words", text)) == constants(Words)


@given(
    st.text(st.characters(exclude_categories=["Cs"]), min_size=1),
    st.floats(allow_nan=False),
    st.lists(st.text(st.characters(exclude_categories=["Cs"]), max_size=4), min_size=1, max_size=3),
)
def test_every_default_survives_its_text(text: str, number: float, words: list[str]) -> None:
    """Quotes, control characters, infinities: all of them."""
    body = {
        "__annotations__": {"text": str, "number": float64, "words": Sequence[str]},
        "text": text,
        "number": number,
        "words": words,
    }
    options = {"typename": "tutorial/msg/Words"}
    class_ = new_class("Words", (Message,), options, lambda space: space.update(body))
    again = define("tutorial/msg/Words", definition_text(class_))

    assert fields(again) == fields(class_)
