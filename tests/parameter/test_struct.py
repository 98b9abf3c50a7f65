"""Parameters as a class."""

from __future__ import annotations

import dataclasses
from enum import Enum
from typing import Annotated, Any, Literal

import msgspec
import pytest
from msgspec import Meta

from aionode.errors import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterUninitializedException,
)
from aionode.parameter import Parameter, ParameterStore, declare_struct
from aionode.parameter.methods import ParameterMethods


class Colour(Enum):
    """The colour of a light."""

    RED = "red"
    GREEN = "green"


class Camera(msgspec.Struct):
    """A group of parameters."""

    frame: str = "camera"
    rates: list[float] = msgspec.field(default_factory=list)


class Driving(msgspec.Struct):
    """Every kind of field."""

    base: str = "base_link"
    speed: Annotated[float, Meta(ge=0.0, le=2.0, multiple_of=0.1, description="in m/s")] = 0.5
    retries: Annotated[int, Meta(gt=0, lt=10)] = 3
    mode: Literal["manual", "auto"] = "manual"
    colour: Colour = Colour.RED
    enabled: bool = True
    raw: bytes = b"\x01"
    ids: list[int] = msgspec.field(default_factory=lambda: [1, 2])
    camera: Camera = msgspec.field(default_factory=Camera)
    limit: int | None = None
    model: Annotated[str, Meta(extra={"read_only": True})] = "x1"


def store(**overrides: object) -> ParameterMethods:
    """Return the parameters of a node with these overrides."""
    return ParameterMethods(ParameterStore("/node", overrides=overrides))


def set_one(parameters: ParameterMethods, name: str, value: object) -> tuple[bool, str]:
    """Set one parameter."""
    result = parameters.set_parameters_atomically([Parameter(name, value=value)])
    return result.successful, result.reason


def test_each_field_becomes_a_parameter_with_type_and_default() -> None:
    """Groups are joined by a dot."""
    parameters = store()
    driving = declare_struct(parameters, Driving)

    assert {name: each.value for name, each in parameters.get_parameters_by_prefix("").items()} == {
        "base": "base_link",
        "speed": 0.5,
        "retries": 3,
        "mode": "manual",
        "colour": "red",
        "enabled": True,
        "raw": b"\x01",
        "ids": [1, 2],
        "camera.frame": "camera",
        "camera.rates": [],
        "limit": None,
        "model": "x1",
    }
    assert parameters.get_parameter_type("camera.rates") is Parameter.Type.DOUBLE_ARRAY
    assert driving == Driving()


def test_overrides_are_in_the_instance() -> None:
    """It is current from the beginning."""
    driving = declare_struct(
        store(**{"speed": 1.5, "colour": "green", "camera.frame": "front"}), Driving
    )

    assert driving.speed == 1.5
    assert driving.colour is Colour.GREEN
    assert driving.camera.frame == "front"


@pytest.mark.parametrize(
    ("name", "value", "attribute", "expected"),
    [
        ("speed", 1.5, "speed", 1.5),
        ("mode", "auto", "mode", "auto"),
        ("colour", "green", "colour", Colour.GREEN),
        ("raw", [b"a", b"b"], "raw", b"ab"),
        ("ids", [], "ids", []),
        ("limit", 7, "limit", 7),
    ],
)
def test_a_change_of_a_parameter_is_a_change_of_the_field(
    name: str, value: object, attribute: str, expected: object
) -> None:
    """In the field's own type."""
    parameters = store()
    driving = declare_struct(parameters, Driving)

    assert set_one(parameters, name, value) == (True, "")
    assert getattr(driving, attribute) == expected


def test_a_group_is_kept_current_too() -> None:
    """It changes in place, so that references to the group see it."""
    parameters = store()
    camera = declare_struct(parameters, Driving).camera
    set_one(parameters, "camera.rates", [1.0, 2.0])

    assert camera.rates == [1.0, 2.0]


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("speed", 2.5, "out of range"),
        ("speed", 0.55, "not close enough to a valid step"),
        ("speed", 1, "Wrong parameter type, expected 'Type.DOUBLE'"),
        ("retries", 0, "out of range"),
        ("retries", 10, "out of range"),
        ("mode", "fly", "Invalid enum value 'fly'"),
        ("colour", "blue", "Invalid enum value 'blue'"),
        ("model", "x2", "read-only"),
    ],
)
def test_a_value_beyond_the_annotation_is_rejected(name: str, value: object, says: str) -> None:
    """The field keeps its value."""
    parameters = store()
    driving = declare_struct(parameters, Driving)

    successful, reason = set_one(parameters, name, value)

    assert not successful
    assert says in reason
    assert driving == Driving()


def test_the_descriptor_tells_others_what_fits() -> None:
    """`param describe` shows it."""
    parameters = store()
    declare_struct(parameters, Driving)

    speed = parameters.describe_parameter("speed")
    assert speed.description == "in m/s"
    assert (speed.floating_point_range[0].from_value, speed.floating_point_range[0].to_value) == (
        0.0,
        2.0,
    )
    retries = parameters.describe_parameter("retries").integer_range[0]
    assert (retries.from_value, retries.to_value) == (1, 9)
    assert parameters.describe_parameter("mode").additional_constraints == "one of auto, manual"
    assert parameters.describe_parameter("model").read_only


def test_an_override_that_does_not_fit_is_an_error() -> None:
    """When the node is made."""
    with pytest.raises(InvalidParameterValueException, match="Invalid enum value 'fly'"):
        declare_struct(store(mode="fly"), Driving)
    with pytest.raises(InvalidParameterTypeException, match=r"write 1\.0"):
        declare_struct(store(speed=1), Driving)


def test_a_failed_declaration_leaves_no_callback_behind() -> None:
    """The next declaration may be valid."""
    parameters = store(mode="fly")
    with pytest.raises(InvalidParameterValueException):
        declare_struct(parameters, Driving)

    assert parameters.declare_parameter("mode", "x", ignore_override=True).value == "x"


def test_the_names_may_have_a_prefix() -> None:
    """A class can then be used twice."""
    parameters = store()
    left = declare_struct(parameters, Camera, "left")
    right = declare_struct(parameters, Camera, "right")
    set_one(parameters, "left.frame", "l")

    assert (left.frame, right.frame) == ("l", "camera")
    with pytest.raises(ParameterAlreadyDeclaredException):
        declare_struct(parameters, Camera, "left")


def test_a_change_is_told_once_with_all_fields_set() -> None:
    """Changes of other parameters are not reported."""
    parameters = store()
    parameters.declare_parameter("other", 1)
    told: list[tuple[str, float]] = []
    declare_struct(parameters, Driving, on_change=lambda now: told.append((now.base, now.speed)))

    parameters.set_parameters_atomically(
        [Parameter("base", value="b"), Parameter("speed", value=1.0)]
    )
    set_one(parameters, "other", 2)

    assert told == [("b", 1.0)]


class Required(msgspec.Struct):
    """A field without a default."""

    serial: str
    camera: Camera


def test_a_field_without_default_needs_an_override() -> None:
    """The error names it."""
    assert declare_struct(store(serial="a1"), Required).serial == "a1"
    with pytest.raises(ParameterUninitializedException, match="serial"):
        declare_struct(store(), Required)


@dataclasses.dataclass
class Plain:
    """A dataclass."""

    gain: Annotated[float, Meta(gt=0.0, description="must be positive")] = 1
    count: Annotated[int, Meta(ge=1, multiple_of=5)] = 5


def test_a_dataclass_serves_as_well() -> None:
    """An int as the default of a float becomes a float."""
    parameters = store()
    plain = declare_struct(parameters, Plain)

    assert parameters.get_parameter("gain").type_ is Parameter.Type.DOUBLE
    assert set_one(parameters, "gain", 0.0) == (
        False,
        "Parameter gain: must be > 0.0, value: 0.0",
    )
    assert set_one(parameters, "count", 7)[0] is False
    assert set_one(parameters, "count", 10)[0] is True
    assert plain == Plain(1.0, 10)


class Frozen(msgspec.Struct, frozen=True):
    """A class whose instances cannot be kept current."""

    a: int = 1


@dataclasses.dataclass(frozen=True)
class FrozenPlain:
    """The same as a dataclass."""

    a: int = 1


class Odd(msgspec.Struct):
    """A field that no parameter holds."""

    table: dict[str, int] = msgspec.field(default_factory=dict)


class Steps(msgspec.Struct):
    """A step without a range."""

    a: Annotated[float, Meta(multiple_of=0.1)] = 0.0


@pytest.mark.parametrize(
    ("struct_type", "says"),
    [
        (Frozen, "Frozen is frozen"),
        (FrozenPlain, "FrozenPlain is frozen"),
        (int, "must be a msgspec.Struct or a dataclass"),
        (Odd, r"Odd.table: no parameter holds .*fields may be bool, int"),
        (Steps, "multiple_of needs ge"),
    ],
)
def test_a_class_that_cannot_be_declared_is_a_type_error(struct_type: type[Any], says: str) -> None:
    """The error says what would be accepted."""
    with pytest.raises(TypeError, match=says):
        declare_struct(store(), struct_type)
