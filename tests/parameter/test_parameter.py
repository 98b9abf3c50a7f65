"""Parameters: values, types, ranges, callbacks, events, services."""

from __future__ import annotations

import array
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import parameter
from aionode.errors import (
    AionodeError,
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterFileError,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    RequestRefusedError,
)
from aionode.interfaces.rcl_interfaces import msg, srv
from aionode.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterEvent,
    SetParametersResult,
)
from aionode.message import check
from aionode.parameter import Parameter, ParameterStore, parameter_services

Type = Parameter.Type
OK = SetParametersResult(successful=True, reason="")


def store(**options: Any) -> ParameterStore:
    """Return the parameters of node /ns/node."""
    return ParameterStore("/ns/node", **options)


def set_one(parameters: ParameterStore, name: str, value: object) -> SetParametersResult:
    """Set one parameter."""
    return parameters.set_parameters_atomically([Parameter(name, value=value)])


# Values


@pytest.mark.parametrize(
    ("value", "type_"),
    [
        (None, Type.NOT_SET),
        (True, Type.BOOL),
        (1, Type.INTEGER),
        (1.0, Type.DOUBLE),
        ("a", Type.STRING),
        ([b"a", b"b"], Type.BYTE_ARRAY),
        (b"ab", Type.BYTE_ARRAY),
        ([], Type.BYTE_ARRAY),
        ([True, False], Type.BOOL_ARRAY),
        ([1, 2], Type.INTEGER_ARRAY),
        (array.array("l", [1, 2]), Type.INTEGER_ARRAY),
        ((1.0, 2.0), Type.DOUBLE_ARRAY),
        (array.array("d", [1.0]), Type.DOUBLE_ARRAY),
        (["a", "b"], Type.STRING_ARRAY),
    ],
)
def test_a_value_has_a_type(value: object, type_: parameter.ParameterType) -> None:
    """A bool is not an int, and an empty list is a list of bytes."""
    made = Parameter("a", value=value)

    assert made.type_ is type_
    assert made.value == value
    assert type_.check(value)


def test_numpy_values_are_taken_as_pythons() -> None:
    """They can be compared and written like any others."""
    assert Parameter("a", value=np.array([1, 2])).value == [1, 2]
    assert Parameter("a", value=np.float32(0.5)).type_ is Type.DOUBLE


@pytest.mark.parametrize("value", [[1, 2.0], [True, 1], ["a", b"b"], {}, object(), [[1]], {1}])
def test_a_value_that_no_parameter_holds_is_a_type_error(value: object) -> None:
    """The elements of a list have one type."""
    with pytest.raises(TypeError, match="allowed types"):
        Parameter("a", value=value)


@pytest.mark.parametrize(
    ("type_", "value"),
    [
        (Type.INTEGER, 1.0),
        (Type.INTEGER, True),
        (Type.INTEGER, 2**63),
        (Type.DOUBLE, 1),
        (Type.STRING, b"a"),
        (Type.BYTE_ARRAY, [b"ab"]),
        (Type.INTEGER_ARRAY, [True]),
        (Type.STRING_ARRAY, "ab"),
        (Type.NOT_SET, 1),
        (Type.BOOL, None),
    ],
)
def test_a_value_of_another_type_is_a_value_error(
    type_: parameter.ParameterType, value: object
) -> None:
    """As in rclpy."""
    with pytest.raises(ValueError, match="do not agree"):
        Parameter("a", type_, value)


def test_a_type_must_be_a_type() -> None:
    """As in Parameter("a", 5), with a forgotten keyword."""
    with pytest.raises(TypeError, match="type must be instance of"):
        Parameter("a", 5)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "value", [None, True, -(2**63), 0.5, "ä", [b"a", b"\xff"], [True], [1, 2], [0.5], ["a"], []]
)
def test_a_parameter_survives_its_message(value: object) -> None:
    """To the message and back, and the message is valid."""
    made = Parameter("a.b", value=value)
    message = made.to_parameter_msg()
    check(message)

    assert Parameter.from_parameter_msg(message) == made


def test_a_message_from_the_wire_becomes_pythons_types() -> None:
    """In messages, lists are numpy arrays."""
    message = msg.ParameterValue(type=7, integer_array_value=np.array([1, 2]))

    value = parameter.parameter_value_to_python(message)

    assert value == [1, 2]
    assert all(type(each) is int for each in value)


def test_a_message_of_an_unknown_type_is_an_error() -> None:
    """Other programs may be faulty."""
    with pytest.raises(RuntimeError, match="unexpected parameter type 77"):
        parameter.parameter_value_to_python(msg.ParameterValue(type=77))
    with pytest.raises(ValueError, match="77"):
        Parameter.from_parameter_msg(msg.Parameter(name="a", value=msg.ParameterValue(type=77)))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("3", 3),
        ("1.0e3", "1.0e3"),
        ("1.0e+3", 1000.0),
        ("[1, 2]", [1, 2]),
        ("[x, y]", ["x", "y"]),
        ("[true, 1]", [1, 1]),
        ("[1, a]", "[1, a]"),
        ("!!int ''", "!!int ''"),
        ("!!timestamp", "!!timestamp"),
        ("{a: 1}", "{a: 1}"),
        ("hello", "hello"),
        ("'7'", "7"),
        ("", ""),
        ("a: b: c", "a: b: c"),
    ],
)
def test_a_text_is_guessed_as_rclpy_does(text: str, value: object) -> None:
    """`param set` takes a text; if it is not another value, it is a string."""
    guessed = parameter.get_parameter_value(text)

    assert parameter.parameter_value_to_python(guessed) == value


def test_a_file_gives_parameter_messages(tmp_path: Path) -> None:
    """As rclpy's function, with nested names and a wildcard."""
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**: {ros__parameters: {a: 1, b: 1}}\n/n: {ros__parameters: {b: 2, c: {d: [1.0]}}}\n"
    )

    plain = parameter.parameter_dict_from_yaml_file(file)
    wild = parameter.parameter_dict_from_yaml_file(
        file, use_wildcard=True, target_nodes=["n"], namespace="x."
    )

    assert {name: each.value.integer_value for name, each in plain.items()} == {"b": 2, "c.d": 0}
    assert list(wild) == ["x.a", "x.b", "x.c.d"]
    assert wild["x.b"].value.integer_value == 2
    with pytest.raises(ParameterFileError, match=r"nothing for \['/other'\], only for"):
        parameter.parameter_dict_from_yaml_file(file, target_nodes=["/other"])


# Declaring


def test_a_declared_parameter_has_its_value_and_type() -> None:
    """`declare_parameter` returns it, `get_parameter` too."""
    parameters = store()

    declared = parameters.declare_parameter("a", 5)

    assert declared == parameters.get_parameter("a") == Parameter("a", Type.INTEGER, 5)
    assert parameters.has_parameter("a")
    assert parameters.get_parameter_type("a") is Type.INTEGER
    assert parameters.describe_parameter("a").type == Type.INTEGER


def test_an_override_wins_unless_ignored() -> None:
    """From the command line, a file or the constructor."""
    parameters = store(overrides={"a": 7, "b": 7})

    assert parameters.declare_parameter("a", 5).value == 7
    assert parameters.declare_parameter("b", 5, ignore_override=True).value == 5


def test_an_override_of_another_type_is_an_error_with_a_hint() -> None:
    """`-p rate:=10` for a double is the classic mistake."""
    parameters = store(overrides={"rate": 10})

    with pytest.raises(InvalidParameterTypeException) as info:
        parameters.declare_parameter("rate", 1.0)

    assert str(info.value) == (
        "Trying to set parameter 'rate' to '10' of type 'INTEGER', expecting type 'DOUBLE' "
        "(write 10.0): rate"
    )
    assert not parameters.has_parameter("rate")


def test_an_empty_list_fits_every_list() -> None:
    """`ids:=[]` has no type of its own."""
    parameters = store(overrides={"ids": []})

    assert parameters.declare_parameter("ids", [1]) == Parameter("ids", Type.INTEGER_ARRAY, [])
    assert set_one(parameters, "ids", [2]).successful
    assert set_one(parameters, "ids", []).successful


def test_a_parameter_is_declared_once() -> None:
    """All names of a list are checked first."""
    parameters = store()
    parameters.declare_parameter("a", 1)

    with pytest.raises(ParameterAlreadyDeclaredException, match=r"\['a'\]"):
        parameters.declare_parameters("", [("b", 1), ("a", 2)])
    assert not parameters.has_parameter("b")


def test_a_name_must_not_be_empty() -> None:
    """The only rule for names of parameters."""
    with pytest.raises(InvalidParameterException):
        store().declare_parameter("", 1)


def test_parameters_are_declared_under_a_namespace() -> None:
    """Joined by a dot."""
    declared = store().declare_parameters("group", [("a", 1), ("b", 2.0, ParameterDescriptor())])

    assert [each.name for each in declared] == ["group.a", "group.b"]


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ((), "Invalid parameter tuple length at index 0"),
        (("a", 1, ParameterDescriptor(), 4), "Invalid parameter tuple length"),
        ((5, 1), "First element at index 0"),
        (("a", 1, "descriptor"), "Third element at index 0"),
    ],
)
def test_a_malformed_declaration_is_a_type_error(entry: tuple[Any, ...], says: str) -> None:
    """With its place in the list."""
    with pytest.raises(TypeError, match=says):
        store().declare_parameters("", [entry])


def test_a_parameter_without_value_is_uninitialized_until_it_is_set() -> None:
    """It has a type, and no value yet."""
    parameters = store()
    parameters.declare_parameter("a", Type.INTEGER)

    with pytest.raises(ParameterUninitializedException, match="'a' is not initialized"):
        parameters.get_parameter("a")
    assert parameters.get_parameter_or("a", Parameter("a", value=3)).value == 3
    assert set_one(parameters, "a", 4).successful
    assert parameters.get_parameter("a").value == 4


@pytest.mark.parametrize(
    ("value", "descriptor", "says"),
    [
        (None, ParameterDescriptor(), "default value of type PARAMETER_NOT_SET"),
        (Type.NOT_SET, ParameterDescriptor(), "statically typed of type NOT_SET"),
        (Type.INTEGER, ParameterDescriptor(dynamic_typing=True), "dynamic_typing=True"),
        (1, ParameterDescriptor(integer_range=[IntegerRange(), IntegerRange()]), "2 ranges"),
    ],
)
def test_a_declaration_without_a_usable_type_is_a_value_error(
    value: object, descriptor: ParameterDescriptor, says: str
) -> None:
    """The type must come from somewhere."""
    with pytest.raises(ValueError, match=says):
        store().declare_parameter("a", value, descriptor)


def test_a_name_alone_declares_a_dynamic_parameter_with_a_warning() -> None:
    """Deprecated in rclpy."""
    parameters = store()
    with pytest.warns(UserWarning, match="only providing its name is deprecated"):
        parameters.declare_parameter("a")

    assert parameters.get_parameter("a").type_ is Type.NOT_SET
    assert set_one(parameters, "a", 1).successful
    assert set_one(parameters, "a", "text").successful


def test_a_descriptor_is_copied() -> None:
    """One descriptor may serve several parameters, and be changed afterwards."""
    parameters = store()
    shared = ParameterDescriptor(description="shared")
    parameters.declare_parameters("", [("a", 1, shared), ("b", 1.0, shared)])
    shared.read_only = True
    parameters.describe_parameter("a").read_only = True

    assert parameters.describe_parameter("a").name == "a"
    assert parameters.describe_parameter("b").type == Type.DOUBLE
    assert set_one(parameters, "a", 2).successful


def test_undeclaring_forgets_a_parameter_without_callbacks_or_event() -> None:
    """As in rclpy."""
    events: list[ParameterEvent] = []
    parameters = store()
    parameters.declare_parameter("a", 1)
    parameters.publish = events.append
    parameters.callbacks.add_post_set_parameters_callback(lambda _: events.append(ParameterEvent()))

    parameters.undeclare_parameter("a")

    assert not parameters.has_parameter("a")
    assert events == []
    with pytest.raises(ParameterNotDeclaredException):
        parameters.undeclare_parameter("a")


# Reading


def test_an_undeclared_parameter_is_an_error_unless_allowed() -> None:
    """Where it is allowed, the parameter is not set."""
    with pytest.raises(ParameterNotDeclaredException, match="undeclared parameter") as info:
        store().get_parameter("a")
    assert isinstance(info.value, AionodeError | KeyError)

    allowing = store(allow_undeclared=True)
    assert allowing.get_parameter("a") == Parameter("a")
    assert allowing.get_parameter_type("a") is Type.NOT_SET
    assert allowing.describe_parameter("a") == ParameterDescriptor()


def test_names_must_be_strings() -> None:
    """A parameter object, for example, is refused."""
    with pytest.raises(TypeError, match="must be instances of type str"):
        store().get_parameters([5])  # type: ignore[list-item]
    with pytest.raises(TypeError, match="must be instances of type str"):
        store().get_parameter_types([5])  # type: ignore[list-item]


def listed() -> ParameterStore:
    """Return parameters in groups."""
    parameters = store()
    for name in ("a", "foo", "foo.b", "foo.bar.c", "foobar.d"):
        parameters.declare_parameter(name, 1)
    return parameters


def test_a_group_is_read_by_its_prefix() -> None:
    """The prefix ends at a dot: `foo` does not include `foobar`."""
    assert sorted(listed().get_parameters_by_prefix("foo")) == ["b", "bar.c"]
    assert len(listed().get_parameters_by_prefix("")) == 5


@pytest.mark.parametrize(
    ("prefixes", "depth", "names"),
    [
        ([], 0, ["a", "foo", "foo.b", "foo.bar.c", "foobar.d"]),
        ([], 1, ["a", "foo"]),
        ([], 2, ["a", "foo", "foo.b", "foobar.d"]),
        (["foo"], 0, ["foo", "foo.b", "foo.bar.c"]),
        (["foo"], 1, ["foo", "foo.b"]),
        (["foo.bar", "a"], 1, ["a", "foo.bar.c"]),
        (["none"], 0, []),
    ],
)
def test_names_are_listed_by_prefix_and_depth(
    prefixes: list[str], depth: int, names: list[str]
) -> None:
    """Depth 0 means all levels."""
    assert listed().list_parameters(prefixes, depth).names == names


def test_the_groups_of_listed_names_are_told() -> None:
    """Each is listed once."""
    assert listed().list_parameters([], 0).prefixes == ["foo", "foo.bar", "foobar"]


@pytest.mark.parametrize(
    ("prefixes", "depth", "error"),
    [("foo", 0, TypeError), ([1], 0, TypeError), ([], 1.0, TypeError), ([], -1, ValueError)],
)
def test_listing_checks_its_arguments(prefixes: Any, depth: Any, error: type[Exception]) -> None:
    """As rclpy does."""
    with pytest.raises(error):
        store().list_parameters(prefixes, depth)


# Changing


def test_a_type_stays_as_declared() -> None:
    """Unless its typing is dynamic."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    parameters.declare_parameter("d", 1, ParameterDescriptor(dynamic_typing=True))

    result = set_one(parameters, "a", "text")

    assert not result.successful
    assert result.reason == ("Wrong parameter type, expected 'Type.INTEGER' got 'Type.STRING'")
    assert parameters.get_parameter("a").value == 1
    assert set_one(parameters, "d", "text").successful
    assert parameters.describe_parameter("d").type == Type.STRING


def test_setting_to_not_set_undeclares_a_dynamic_parameter_only() -> None:
    """A static one keeps its value."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    parameters.declare_parameter("d", 1, ParameterDescriptor(dynamic_typing=True))

    refused = set_one(parameters, "a", None)
    assert refused.reason == "Static parameter cannot be undeclared"
    assert set_one(parameters, "d", None).successful
    assert not parameters.has_parameter("d")


def test_a_read_only_parameter_is_set_when_declared_and_never_again() -> None:
    """An override sets it, for example."""
    parameters = store(overrides={"a": 2})
    parameters.declare_parameter("a", 1, ParameterDescriptor(read_only=True))

    result = set_one(parameters, "a", 3)

    assert result.reason == "Trying to set a read-only parameter: a."
    assert parameters.get_parameter("a").value == 2
    with pytest.raises(ParameterImmutableException):
        parameters.undeclare_parameter("a")


def test_undeclared_parameters_may_be_set_where_allowed() -> None:
    """Setting declares them, with dynamic typing."""
    parameters = store(allow_undeclared=True)

    assert set_one(parameters, "a", 1).successful
    assert set_one(parameters, "a", "text").successful


def test_setting_stops_at_an_undeclared_parameter_and_keeps_what_was_set() -> None:
    """They are set one after the other."""
    parameters = store()
    parameters.declare_parameter("a", 1)

    with pytest.raises(ParameterNotDeclaredException, match=r"\['b'\]"):
        parameters.set_parameters([Parameter("a", value=2), Parameter("b", value=2)])
    assert parameters.get_parameter("a").value == 2


def test_setting_several_gives_a_result_for_each() -> None:
    """In order; a failure does not stop the rest."""
    parameters = store()
    parameters.declare_parameter("a", 1)

    results = parameters.set_parameters([Parameter("a", value=v) for v in (2, "x", 3)])

    assert [each.successful for each in results] == [True, False, True]
    assert parameters.get_parameter("a").value == 3


def test_setting_atomically_is_all_or_nothing() -> None:
    """Even if a later one is undeclared."""
    parameters = store()
    parameters.declare_parameters("", [("a", 1), ("b", 1)])

    both = [Parameter("a", value=2), Parameter("b", value="x")]
    assert not parameters.set_parameters_atomically(both).successful
    with pytest.raises(ParameterNotDeclaredException):
        parameters.set_parameters_atomically([Parameter("a", value=2), Parameter("c", value=2)])
    assert parameters.get_parameter("a").value == 1


def test_only_parameters_can_be_set() -> None:
    """Their messages cannot."""
    with pytest.raises(TypeError, match="parameter must be instance of"):
        store().set_parameters([msg.Parameter()])  # type: ignore[list-item]


# Ranges


@pytest.mark.parametrize(
    ("low", "high", "step", "value", "fits"),
    [
        (0, 10, 0, 0, True),
        (0, 10, 0, 10, True),
        (0, 10, 0, 5, True),
        (0, 10, 0, -1, False),
        (0, 10, 0, 11, False),
        (10, 0, 0, 5, True),
        (1, 10, 3, 7, True),
        (1, 10, 3, 8, False),
        (1, 9, 3, 9, True),
        (-5, 5, 2, -3, True),
    ],
)
def test_an_int_must_be_in_its_range_and_on_a_step(
    low: int, high: int, step: int, value: int, *, fits: bool
) -> None:
    """Both ends are allowed, in either order; steps count from the lower one."""
    parameters = store()
    limits = IntegerRange(from_value=low, to_value=high, step=step)
    parameters.declare_parameter("a", low, ParameterDescriptor(integer_range=[limits]))

    assert set_one(parameters, "a", value).successful is fits


@pytest.mark.parametrize(
    ("low", "high", "step", "value", "fits"),
    [
        (0.0, 1.0, 0.0, 0.5, True),
        (0.0, 1.0, 0.0, 1.0000001, True),
        (0.0, 1.0, 0.0, 1.001, False),
        (0.0, 1.0, 0.0, math.nan, False),
        (1.0, 0.0, 0.0, 0.5, True),
        (0.0, 1.0, 0.1, 0.3, True),
        (0.0, 1.0, 0.1, 0.35, False),
        (0.0, 1.0, 0.3, 1.0, True),
    ],
)
def test_a_float_must_be_in_its_range_and_near_a_step(
    low: float, high: float, step: float, value: float, *, fits: bool
) -> None:
    """With a relative tolerance of one in a million."""
    parameters = store()
    limits = FloatingPointRange(from_value=low, to_value=high, step=step)
    parameters.declare_parameter("a", low, ParameterDescriptor(floating_point_range=[limits]))

    assert set_one(parameters, "a", value).successful is fits


def test_a_default_out_of_range_is_an_error_with_the_range() -> None:
    """The mistake is found where the parameter is declared."""
    limits = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10)])

    with pytest.raises(InvalidParameterValueException, match="Min: 0, Max: 10, value: 11"):
        store().declare_parameter("a", 11, limits)


def test_a_new_descriptor_keeps_the_value_or_takes_the_alternative() -> None:
    """If neither fits, it is refused."""
    parameters = store()
    parameters.declare_parameter("a", 11)
    limits = IntegerRange(from_value=0, to_value=10)
    limited = ParameterDescriptor(type=int(Type.INTEGER), integer_range=[limits])

    with pytest.raises(InvalidParameterValueException, match="out of range"):
        parameters.set_descriptor("a", limited)
    value = parameters.set_descriptor("a", limited, msg.ParameterValue(type=2, integer_value=9))

    assert value.integer_value == parameters.get_parameter("a").value == 9
    assert not set_one(parameters, "a", 11).successful


# Callbacks and events


def recording(parameters: ParameterStore) -> list[str]:
    """Record in which order things happen."""
    log: list[str] = []

    def note(word: str, answer: Any) -> Callable[[list[Parameter]], Any]:
        def callback(changed: list[Parameter]) -> Any:
            log.append(word)
            return changed if answer is list else answer

        return callback

    parameters.callbacks.add_pre_set_parameters_callback(note("pre", list))
    parameters.callbacks.add_on_set_parameters_callback(note("on", OK))
    parameters.callbacks.add_post_set_parameters_callback(note("post", None))
    parameters.publish = lambda _: log.append("event")
    return log


def test_callbacks_run_before_and_after_the_change_and_its_event() -> None:
    """In this order: pre, on, event, post."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    log = recording(parameters)

    set_one(parameters, "a", 2)

    assert log == ["pre", "on", "event", "post"]


def test_declaring_does_not_call_the_pre_callbacks() -> None:
    """There is nothing to modify yet."""
    parameters = store()
    log = recording(parameters)

    parameters.declare_parameter("a", 1)

    assert log == ["on", "event", "post"]


def test_the_newest_callback_runs_first() -> None:
    """This holds for each kind of callback."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    log: list[int] = []

    def numbered(number: int) -> Callable[[list[Parameter]], SetParametersResult]:
        def callback(changed: list[Parameter]) -> SetParametersResult:
            log.append(number)
            return OK

        return callback

    for number in (1, 2):
        parameters.callbacks.add_on_set_parameters_callback(numbered(number))
    set_one(parameters, "a", 2)

    assert log == [2, 1]


def test_a_pre_callback_may_change_and_add_parameters() -> None:
    """Everything in its list is set at once."""
    parameters = store()
    parameters.declare_parameters("", [("a", 1), ("b", 1)])
    events: list[ParameterEvent] = []
    parameters.publish = events.append
    parameters.callbacks.add_pre_set_parameters_callback(
        lambda changed: [*changed, Parameter("b", value=9), Parameter("a", value=8)]
    )

    assert set_one(parameters, "a", 2).successful

    assert (parameters.get_parameter("a").value, parameters.get_parameter("b").value) == (8, 9)
    assert [each.name for each in events[0].changed_parameters] == ["a", "b"]


def test_a_pre_callback_may_stop_a_change() -> None:
    """By returning an empty list."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    parameters.callbacks.add_pre_set_parameters_callback(lambda _: [])

    result = set_one(parameters, "a", 2)

    assert result.reason == (
        "parameter list cannot be empty, this might be due to pre_set_parameters_callback "
        "modifying the original parameters list."
    )
    assert parameters.get_parameter("a").value == 1


def test_a_rejection_changes_nothing_and_its_reason_is_given() -> None:
    """The first rejection counts; later callbacks are not called."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    log = recording(parameters)
    parameters.callbacks.add_on_set_parameters_callback(
        lambda _: SetParametersResult(successful=False, reason="no")
    )

    result = set_one(parameters, "a", 2)

    assert (result.successful, result.reason) == (False, "no")
    assert parameters.get_parameter("a").value == 1
    assert log == ["pre"]


def test_a_rejection_when_declaring_is_an_error() -> None:
    """The parameter stays undeclared."""
    parameters = store()
    parameters.callbacks.add_on_set_parameters_callback(
        lambda _: SetParametersResult(successful=False, reason="no")
    )

    with pytest.raises(InvalidParameterValueException, match=r"value \(1\).*Reason: no: a"):
        parameters.declare_parameter("a", 1)
    assert not parameters.has_parameter("a")


@pytest.mark.parametrize("kind", ["pre", "on"])
def test_a_callback_that_returns_nothing_is_a_type_error(kind: str) -> None:
    """A ``return`` was forgotten."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    getattr(parameters.callbacks, f"add_{kind}_set_parameters_callback")(lambda _: None)

    with pytest.raises(TypeError, match=f"what the {kind}-set callback .* returns must be"):
        set_one(parameters, "a", 2)


@pytest.mark.parametrize("kind", ["pre", "on", "post"])
def test_what_cannot_be_called_is_no_callback(kind: str) -> None:
    """The mistake is reported when it is added, not at the first change."""
    with pytest.raises(TypeError, match="Callback must be callable, got 3"):
        getattr(store().callbacks, f"add_{kind}_set_parameters_callback")(3)


def test_a_removed_callback_is_not_called() -> None:
    """It cannot be removed twice."""
    parameters = store()
    log: list[object] = []
    for kind in ("pre", "on", "post"):
        add = getattr(parameters.callbacks, f"add_{kind}_set_parameters_callback")
        remove = getattr(parameters.callbacks, f"remove_{kind}_set_parameters_callback")
        add(log.append)
        remove(log.append)
        with pytest.raises(ValueError, match="not in list"):
            remove(log.append)
    parameters.declare_parameter("a", 1)

    assert log == []


def test_a_change_is_one_event_with_new_changed_and_deleted() -> None:
    """It also has the node's full name."""
    parameters = store(allow_undeclared=True)
    parameters.declare_parameter("changed", 1)
    parameters.declare_parameter("deleted", 1, ParameterDescriptor(dynamic_typing=True))
    parameters.declare_parameter("uninitialized", Type.INTEGER)
    events: list[ParameterEvent] = []
    parameters.publish = events.append

    parameters.set_parameters_atomically(
        [
            Parameter("new", value=1),
            Parameter("uninitialized", value=1),
            Parameter("changed", value=2),
            Parameter("deleted"),
        ]
    )

    (event,) = events
    assert event.node == "/ns/node"
    assert [each.name for each in event.new_parameters] == ["new", "uninitialized"]
    assert [each.name for each in event.changed_parameters] == ["changed"]
    assert [each.name for each in event.deleted_parameters] == ["deleted"]
    check(event)


def test_a_failed_change_is_no_event() -> None:
    """Nothing has changed."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    events: list[ParameterEvent] = []
    parameters.publish = events.append
    set_one(parameters, "a", "x")

    assert events == []


# Services


def call(parameters: ParameterStore, name: str, request: Any) -> Any:
    """Call one of the services, and check that its response can be sent."""
    service = next(each for each in parameter_services(parameters) if each.name == name)
    response = service.callback(request, service.srv_type.Response())
    check(response)
    return response


def test_there_are_six_services_with_rcls_names() -> None:
    """`ros2 param` calls them."""
    services = {each.name: each.srv_type for each in parameter_services(store())}

    assert services == {
        "describe_parameters": srv.DescribeParameters,
        "get_parameters": srv.GetParameters,
        "get_parameter_types": srv.GetParameterTypes,
        "list_parameters": srv.ListParameters,
        "set_parameters": srv.SetParameters,
        "set_parameters_atomically": srv.SetParametersAtomically,
    }


@pytest.mark.parametrize(
    ("name", "request_"),
    [
        ("describe_parameters", srv.DescribeParameters.Request(names=["a"] * 10_001)),
        ("get_parameters", srv.GetParameters.Request(names=["a"] * 10_001)),
        ("get_parameter_types", srv.GetParameterTypes.Request(names=["a"] * 10_001)),
        ("list_parameters", srv.ListParameters.Request(prefixes=["a"] * 10_001)),
        ("set_parameters", srv.SetParameters.Request(parameters=[msg.Parameter()] * 10_001)),
        (
            "set_parameters_atomically",
            srv.SetParametersAtomically.Request(parameters=[msg.Parameter()] * 10_001),
        ),
    ],
)
def test_a_request_with_more_names_than_any_node_has_is_refused(name: str, request_: Any) -> None:
    """A small request with one name forty thousand times took 2.3 GB to answer."""
    parameters = store()
    parameters.declare_parameter("a", "x")

    with pytest.raises(RequestRefusedError, match=r"has 10001 names, at most (10000|2000) fit"):
        call(parameters, name, request_)


@pytest.mark.parametrize("value", ["x" * 100_000, ["x" * 100] * 1000, [0.0] * 12_500])
def test_an_answer_of_many_megabytes_is_refused(value: Any) -> None:
    """One name may be asked for again and again, and a value may be long."""
    parameters = store()
    parameters.declare_parameter("a", value)
    some, many = (srv.GetParameters.Request(names=["a"] * count) for count in (160, 170))

    assert len(call(parameters, "get_parameters", some).values) == 160
    with pytest.raises(RequestRefusedError, match="at most 16777216 fit into an answer"):
        call(parameters, "get_parameters", many)


def test_many_prefixes_are_looked_up_and_not_gone_through() -> None:
    """Comparing ten thousand prefixes with a thousand names would block the loop for seconds."""
    parameters = store()
    for number in range(1000):
        parameters.declare_parameter(f"group{number}.inner.value", number)
    request = srv.ListParameters.Request(
        prefixes=[*(f"other{number}" for number in range(9_998)), "group7", "group8.inner"], depth=2
    )

    result = call(parameters, "list_parameters", request).result

    assert result.names == ["group7.inner.value", "group8.inner.value"]


def test_services_read_declared_parameters() -> None:
    """Values, types, descriptors and names."""
    parameters = store()
    parameters.declare_parameter("g.a", 5, ParameterDescriptor(description="five"))
    names = ["g.a"]

    values = call(parameters, "get_parameters", srv.GetParameters.Request(names=names)).values
    types = call(
        parameters, "get_parameter_types", srv.GetParameterTypes.Request(names=names)
    ).types
    descriptors = call(
        parameters, "describe_parameters", srv.DescribeParameters.Request(names=names)
    ).descriptors
    result = call(parameters, "list_parameters", srv.ListParameters.Request(depth=0)).result

    assert values[0].integer_value == 5
    assert list(types) == [2]
    assert descriptors[0].description == "five"
    assert (result.names, result.prefixes) == (["g.a"], ["g"])


@pytest.mark.parametrize(
    ("name", "request_type", "field"),
    [
        ("get_parameters", srv.GetParameters.Request, "values"),
        ("get_parameter_types", srv.GetParameterTypes.Request, "types"),
        ("describe_parameters", srv.DescribeParameters.Request, "descriptors"),
    ],
)
def test_one_undeclared_name_makes_the_whole_answer_empty(
    name: str, request_type: Any, field: str
) -> None:
    """As in rclpy."""
    parameters = store()
    parameters.declare_parameter("a", 1)

    response = call(parameters, name, request_type(names=["a", "missing"]))

    assert len(getattr(response, field)) == 0


def test_setting_through_the_service_never_raises() -> None:
    """An undeclared name or an unknown type is reported in its own result."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    messages = [
        Parameter("missing", value=1).to_parameter_msg(),
        msg.Parameter(name="a", value=msg.ParameterValue(type=77)),
        Parameter("a", value=2).to_parameter_msg(),
    ]

    each = call(parameters, "set_parameters", srv.SetParameters.Request(parameters=messages))
    at_once = call(
        parameters,
        "set_parameters_atomically",
        srv.SetParametersAtomically.Request(parameters=messages[:1]),
    )

    assert [result.successful for result in each.results] == [False, False, True]
    assert "undeclared parameter(s): ['missing']" in each.results[0].reason
    assert not at_once.result.successful
    assert parameters.get_parameter("a").value == 2


# Laws

values = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(max_size=5),
    st.lists(st.binary(min_size=1, max_size=1), max_size=3),
    st.lists(st.booleans(), min_size=1, max_size=3),
    st.lists(st.integers(-(2**63), 2**63 - 1), min_size=1, max_size=3),
    st.lists(st.floats(allow_nan=False), min_size=1, max_size=3),
    st.lists(st.text(max_size=3), min_size=1, max_size=3),
)


@given(values)
def test_every_value_survives_its_message(value: object) -> None:
    """To the message and back."""
    made = Parameter("a", value=value)

    assert Parameter.from_parameter_msg(made.to_parameter_msg()) == made


names = st.sampled_from(["a", "b", "c"])


@given(st.lists(st.tuples(names, values), max_size=12))
def test_a_store_changes_exactly_as_its_results_say(changes: list[tuple[str, object]]) -> None:
    """A successful change is what is read; a failed one changes nothing."""
    parameters = store()
    parameters.declare_parameter("a", 1)
    parameters.declare_parameter("b", 1.0, ParameterDescriptor(dynamic_typing=True))
    for name, value in changes:
        before = parameters.get_parameters_by_prefix("")
        try:
            done = set_one(parameters, name, value).successful
        except ParameterNotDeclaredException:
            done = False
        after = parameters.get_parameters_by_prefix("")
        if not done:
            assert after == before
        elif value is None:
            assert name not in after
        else:
            assert after[name].value == value
