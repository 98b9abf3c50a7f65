"""Any input is a value, or an error of one line: never a traceback."""

from __future__ import annotations

import time  # noqa: TID251  # CPU time of this process
from typing import Any

import pytest
from click import Command, Context
from click.exceptions import UsageError
from hypothesis import example, given, settings
from hypothesis import strategies as st

from aionode.cli._nouns.param import parameter_value, pattern_from
from aionode.cli._support.error_text import one_line
from aionode.cli._support.field_path import field_of
from aionode.cli._support.follow import filter_from
from aionode.cli._support.options import hertz, natural, positive, seconds, whole
from aionode.cli._support.yaml_messages import Filler, message_from_yaml
from aionode.clock import Time
from aionode.errors import AionodeError, CommandError
from aionode.interfaces.geometry_msgs.msg import PoseArray, TwistStamped
from aionode.interfaces.rcl_interfaces.msg import Parameter
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import Header, Int32, String, UInt8MultiArray

DIGITS = "1" * 5000

PIECES = [
    *"{}[]:,&*!|>-?'\"#%@`~ \n\t.+_0123456789\0\x85\ud800",
    *("data: ", "header: ", "stamp: ", "linear: {x: ", "poses: [", "- ", "? ", ": ", "--- "),
    *("auto", "now", "null", "true", "~", ".nan", "-.inf", "1e400", "0b_", "0x", "1:99", DIGITS),
    *(
        "2020-99-99",
        "12:61:61",
        "!!binary ",
        "!!int ",
        "!!float ",
        "!!timestamp ",
        "!!set ",
        "!!bool ",
        "!!omap ",
        "!!pairs ",
    ),
    *("&a ", "*a", "<<: ", "!!python/object:os.system ", "%YAML 9.9\n", "..."),
]
YAML = st.lists(st.sampled_from(PIECES) | st.text(max_size=4), max_size=12).map("".join)

TYPES = [Header, Image, Int32, Parameter, PoseArray, String, TwistStamped, UInt8MultiArray]


def expect_one_line(error: AionodeError) -> None:
    """Check the printed error."""
    assert 0 < len(one_line(error)) < 1100
    assert "\n" not in one_line(error)


@settings(deadline=None)  # the first example imports numpy
@given(st.sampled_from(TYPES), YAML)
@example(Int32, f"data: {DIGITS}")
@example(Int32, "data: 2020-99-99")
@example(String, "data: " + "[" * 100_000)
@example(String, "data: " + "[" * 90 + "]" * 90)
@example(String, "- " * 100_000)
@example(Header, "&a {stamp: *a}")
@example(String, "data: \udcff")
def test_any_text_is_a_message_or_an_error(msg_type: Any, text: str) -> None:
    """`topic pub`, `service call` and `action send_goal` take any text."""
    for fill in (message_from_yaml, filled):
        try:
            assert isinstance(fill(msg_type, text), msg_type)
        except CommandError as error:
            expect_one_line(error)


def filled(msg_type: Any, text: str) -> Any:
    """Return the message that `topic pub` publishes."""
    return Filler(msg_type, text).message(Time(seconds=1))


@settings(deadline=None)  # the first example imports PyYAML
@given(YAML)
@example(DIGITS)
@example("[" * 5000)
def test_any_text_is_a_value_of_a_parameter_or_an_error(text: str) -> None:
    """`param set` takes any text."""
    try:
        parameter_value(text)
    except CommandError as error:
        expect_one_line(error)


@pytest.mark.parametrize("text", ["1" * 30_000 + "{", "0x" + "1" * 30_000 + "{"])
def test_many_digits_are_parsed_in_linear_time(text: str) -> None:
    """Patterns with two adjacent runs of digits took seconds for 5000 of them."""
    begin_s = time.process_time()

    parameter_value(text)

    assert time.process_time() - begin_s < 2.0


@given(st.lists(st.sampled_from([*"[].-_ ²٣", "poses", "position", "x", "0", DIGITS])).map("".join))
def test_any_path_is_a_field_or_an_error(path: str) -> None:
    """`topic echo --field` takes any text."""
    try:
        field_of(PoseArray(), path)
    except CommandError as error:
        expect_one_line(error)


@given(st.text(max_size=20))
@example("-" * 100_000 + "1")
@example("(" * 10_000)
@example("\0")
@example(DIGITS)
@example("m.data.nope")
@example("m" + ".data" * 5000)
def test_any_filter_is_an_expression_or_an_error(text: str) -> None:
    """`topic echo --filter` and `topic hz --filter` never evaluate a text as a statement."""
    try:
        filter_from(text)
    except CommandError as error:
        expect_one_line(error)


@given(st.text(max_size=20))
@example("a{99999999999999999999}")
@example("(" * 5000)
@example("[[")
@example("(?" + "i" * 100)
def test_any_pattern_is_one_or_an_error(text: str) -> None:
    """`param list --filter` takes any text."""
    try:
        pattern_from(text)
    except CommandError as error:
        expect_one_line(error)


@pytest.mark.parametrize("type_", [hertz, natural, positive, seconds, whole])
@given(text=st.text(max_size=10) | st.floats().map(str) | st.integers().map(str))
@example(text="nan")
@example(text="inf")
@example(text="1e-320")
@example(text=DIGITS)
@example(text="99999999999999999999")
def test_any_number_is_one_that_every_clock_and_queue_can_take(type_: Any, text: str) -> None:
    """This holds for every option that takes a number."""
    try:
        number = type_.convert(text, None, Context(Command("test")))
    except UsageError:
        return

    assert 0 <= number <= 2**31
    assert type_ is not hertz or 1e-9 <= 1 / number <= 1e9
