"""Classes from type descriptions, which may be anything that another process sends."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.wire import cdr
from aionode.engine.wire._type_description import description_message
from aionode.engine.wire.described_type import action_from_descriptions, type_from_description
from aionode.engine.wire.typehash import type_hash
from aionode.errors import InterfaceNotFoundError, TypeDescriptionError
from aionode.interfaces import get_action, get_interface
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.type_description_interfaces.msg import (
    Field,
    FieldType,
    IndividualTypeDescription,
    TypeDescription,
)
from aionode.message import (
    DEFAULT,
    Array,
    Bounded,
    Message,
    Sequence,
    ServiceType,
    byte,
    float64,
    int32,
    wstring,
)

MESSAGE, INT32, STRING, ARRAY, BOUNDED = 1, 6, 17, 48, 96


class Words(Message, typename="tutorial/msg/Words"):
    """A type with all kinds of fields."""

    header: Header = DEFAULT
    text: str = ""
    bounded: Bounded[str, 7] = ""
    wide: wstring = ""
    one: byte = b"\x00"
    scores: Sequence[float64] = DEFAULT
    few: Sequence[int32, 3] = DEFAULT
    nine: Array[float64, 9] = DEFAULT
    names: Sequence[Bounded[str, 5], 2] = DEFAULT
    stamps: Sequence[Header] = DEFAULT


class Reverse(ServiceType, typename="tutorial/srv/Reverse"):
    """A service of the user's own."""

    class Request(Message):
        """The text to reverse."""

        text: str = ""

    class Response(Message):
        """The reversed text."""

        text: str = ""


def part(name: str, *fields: tuple[str, int, int, str]) -> IndividualTypeDescription:
    """Return the description of one type, from name, type id, capacity and nested type name."""
    return IndividualTypeDescription(
        type_name=name,
        fields=[
            Field(name=field, type=FieldType(type_id=kind, capacity=size, nested_type_name=nested))
            for field, kind, size, nested in fields
        ],
    )


def tower(levels: int, width: int = 1) -> TypeDescription:
    """Return a type of types of types, each used `width` times by the one above."""
    parts = [
        part(f"a/msg/T{n}", *((f"f{w}", MESSAGE, 0, f"a/msg/T{n + 1}") for w in range(width)))
        for n in range(levels)
    ]
    last = part(f"a/msg/T{levels}", ("x", INT32, 0, ""))
    return TypeDescription(
        type_description=parts[0], referenced_type_descriptions=[*parts[1:], last]
    )


def one_field(kind: int, size: int, nested: str = "") -> TypeDescription:
    """Return a type with one field."""
    return TypeDescription(type_description=part("a/msg/T", ("x", kind, size, nested)))


@pytest.mark.parametrize(
    "cls",
    [
        Words,
        Reverse,
        AddTwoInts,
        *map(get_interface, ("std_msgs/msg/Empty", "sensor_msgs/msg/PointCloud2")),
        *map(get_interface, ("rcl_interfaces/msg/ParameterEvent", "std_srvs/srv/Empty")),
    ],
)
def test_a_class_made_of_a_description_has_the_same_hash(cls: Any) -> None:
    """The type hash decides whether two endpoints communicate."""
    made = type_from_description(description_message(cls))

    assert type_hash(made) == type_hash(cls)


@pytest.mark.parametrize("name", ["Defaults", "Arrays", "BoundedSequences", "Strings", "WStrings"])
def test_a_class_made_of_a_description_has_the_same_defaults(name: str) -> None:
    """A message of defaults commands the same, whoever makes it."""
    cls: Any = get_interface(f"test_msgs/msg/{name}")
    made = type_from_description(description_message(cls))

    assert cdr.encode(made()) == cdr.encode(cls())


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (INT32, "many"),
        (INT32, "2147483648"),
        (11, "0.05 m"),
        (15, "maybe"),
        (INT32 + 144, "5"),
        (INT32 + 144, "(1, 'x')"),
        (INT32 + 144, "[" * 10_000),
    ],
)
def test_a_default_that_does_not_fit_is_an_error(kind: int, text: str) -> None:
    """To leave it out would send another value than the node expects."""
    description = one_field(kind, 0)
    description.type_description.fields[0].default_value = text

    with pytest.raises(TypeDescriptionError):
        type_from_description(description)


def test_an_action_is_made_of_the_descriptions_of_its_parts() -> None:
    """Nodes describe the services and the feedback of an action, not the action itself."""
    impl = Fibonacci.Impl
    parts = (impl.SendGoalService, impl.GetResultService, impl.FeedbackMessage)

    made = action_from_descriptions(Fibonacci.__ros_type__, *map(description_message, parts))

    assert type_hash(made) == type_hash(Fibonacci)


def test_a_described_class_is_not_found_by_its_name() -> None:
    """Another process must not decide what a name means in this one."""
    type_from_description(TypeDescription(type_description=part("foreign/msg/T")))
    described = action_from_descriptions(
        "foreign/action/A",
        *(
            TypeDescription(type_description=part(f"foreign/action/A_{half}"))
            for half in ("Goal", "Result", "Feedback")
        ),
    )

    assert described.Goal() == described.Goal()
    for get, name in ((get_interface, "foreign/msg/T"), (get_action, "foreign/action/A")):
        with pytest.raises(InterfaceNotFoundError):
            get(name)


@pytest.mark.parametrize(
    ("description", "problem"),
    [
        (tower(30, width=2), "a new .* takes .* at most 64 MiB are allowed"),
        (tower(51), "nested more than 50 deep"),
        (tower(1000), "1001 types, at most 1000 are allowed"),
        (one_field(INT32 + ARRAY, 2**37), "elements; 1 to 4294967295 are allowed"),
        (one_field(INT32 + ARRAY, 2**64 - 1), "elements; 1 to 4294967295 are allowed"),
        (one_field(INT32 + ARRAY, 2**31), "at most 64 MiB are allowed"),
        (one_field(STRING + ARRAY, 2**21), "at most 64 MiB are allowed"),
        (one_field(INT32 + ARRAY, 0), "has 0 elements"),
        (one_field(INT32 + BOUNDED, 2**40), "elements; 1 to 4294967295 are allowed"),
        (one_field(MESSAGE, 0, "a/msg/T"), "'a/msg/T' contains itself"),
        (one_field(MESSAGE, 0, "a/msg/U"), "lacks the type 'a/msg/U'"),
        (one_field(14, 0), "unknown type id 14"),
        (one_field(255, 0), "unknown type id 255"),
        (
            TypeDescription(
                type_description=part("a/msg/T", *((f"f{n}", 2, 0, "") for n in range(10_001)))
            ),
            "10001 fields, at most 10000 are allowed",
        ),
        (TypeDescription(type_description=part("a/msg/T", ("x;y", 2, 0, ""))), "not a valid"),
        (TypeDescription(type_description=part("\x1b[31m", ("x", 2, 0, ""))), "not a valid"),
    ],
)
def test_a_description_beyond_the_limits_is_refused(
    description: TypeDescription, problem: str
) -> None:
    """The description decides what a new message costs here, so it is measured first."""
    with pytest.raises(TypeDescriptionError, match=problem) as raised:
        type_from_description(description)

    assert "\x1b" not in str(raised.value)


@pytest.mark.slow
def test_types_in_types_are_walked_once_each() -> None:
    """Twelve levels of two fields are four thousand paths, but only twelve types."""
    made = type_from_description(tower(12, width=2))

    assert cdr.has_views(made) is False
    assert cdr.has_buffers(made) is False
    assert len(cdr.encode(made())) == 4 + 4 * 2**12


type_ids = st.sampled_from([0, 1, 2, 6, 12, 17, 21, 49, 54, 97, 102, 113, 145, 150, 161, 255])
names = st.sampled_from(["a/msg/T", "a/msg/U", "a/msg/V", "", "x", "a/srv/S_Request"])
described_fields = st.tuples(
    st.sampled_from(["x", "y_z", "class", "", "_", "é"]),
    type_ids,
    st.sampled_from([0, 1, 3, 2**20, 2**32, 2**64 - 1]),
    names,
)
descriptions = st.lists(
    st.builds(lambda name, fields: part(name, *fields), names, st.lists(described_fields)),
    min_size=1,
    max_size=4,
)


@given(descriptions)
def test_any_description_is_a_class_or_one_error(parts: list[IndividualTypeDescription]) -> None:
    """Whatever a node answers, the asker learns a type or the reason why not."""
    description = TypeDescription(type_description=parts[0], referenced_type_descriptions=parts[1:])
    try:
        made = type_from_description(description)
    except TypeDescriptionError:
        return
    for half in (made.Request, made.Response) if issubclass(made, ServiceType) else (made,):
        assert cdr.decode(half, cdr.encode(half())) == half()
