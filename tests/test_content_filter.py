"""Filters over the fields of messages."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.content_filter import compile_filter
from aionode.errors import ContentFilterError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from aionode.interfaces.geometry_msgs.msg import PoseStamped
from aionode.interfaces.sensor_msgs.msg import Imu, JointState
from aionode.interfaces.std_msgs.msg import Bool, Int32, String


def passes(message: Any, expression: str, *parameters: str) -> bool:
    """Whether a message passes a filter."""
    return compile_filter(type(message), expression, parameters)(message)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("data = 5", True),
        ("data <> 5", False),
        ("data != 5", False),
        ("data > 4", True),
        ("data >= 6", False),
        ("data < 5.5", True),
        ("5 = data", True),
        ("data = 0x5", True),
        ("data = +5", True),
        ("data BETWEEN 1 AND 5", True),
        ("data NOT BETWEEN 1 AND 5", False),
        ("NOT data = 5", False),
        ("not (data > 7 or data < 3) and data = 5", True),
        ("data = 1 AND data = 2 OR data = 5", True),
        ("data = 5 OR data = 1 AND data = 2", True),
        ("NOT data = 1 AND data = 5", True),
        ("data = data", True),
    ],
)
def test_numbers_are_compared(expression: str, expected: bool) -> None:
    """NOT binds more tightly than AND, and AND more tightly than OR."""
    assert passes(Int32(data=5), expression) is expected


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("data = 'it''s'", None),
        (r"data = 'it\'s 100% done'", True),
        ("data LIKE 'it%'", True),
        ("data like '%done'", True),
        ("data LIKE 'it_s%'", True),
        ("data LIKE 'it'", False),
        ("data > 'a'", True),
        ("data BETWEEN 'a' AND 'z'", True),
    ],
)
def test_texts_are_compared(expression: str, expected: bool | None) -> None:
    """LIKE knows % for any text, and _ for one character."""
    if expected is None:
        with pytest.raises(ContentFilterError):
            passes(String(data="it's"), expression)
    else:
        assert passes(String(data="it's 100% done"), expression) is expected


def test_parameters_stand_for_literals() -> None:
    """As rclpy gives them: texts, a text among them in quotes."""
    assert passes(Int32(data=5), "data BETWEEN %0 AND %1", "-30", "100.0")
    assert passes(String(data="on"), "data = %0", "'on'")
    assert passes(Bool(data=True), "data = %0", "TRUE")


def test_nested_fields_and_elements_are_named() -> None:
    """A predicate over elements that a message does not have is false."""
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.pose.position.x = 1.5
    assert passes(pose, "header.frame_id = 'map' AND pose.position.x > 1")
    imu = Imu()
    imu.orientation_covariance[0] = -1
    assert passes(imu, "orientation_covariance[0] = -1")
    joints = JointState(name=["arm"], position=[0.5])
    assert passes(joints, "name[0] = 'arm' AND position[0] < 1.0")
    assert not passes(joints, "position[3] < 1.0")
    assert not passes(joints, "name[3] LIKE '%'")
    assert not passes(joints, "name[3] <> name[0]")
    array = DiagnosticArray(status=[DiagnosticStatus(values=[KeyValue(key="t", value="9")])])
    assert passes(array, "status[0].values[0].key = 't'")


@pytest.mark.parametrize(
    ("expression", "parameters", "problem"),
    [
        ("", (), "expected a field or a literal, got the end"),
        ("data", (), "expected a comparison such as = or <, got the end"),
        ("data = ", (), "expected a field or a literal"),
        ("data = 5 6", (), "expected AND, OR or the end, got 6"),
        ("(data = 5", (), r"expected \), got the end"),
        ("speed = 5", (), "std_msgs/msg/Int32 has no field 'speed'; it has: data"),
        ("data.x = 5", (), "data has no fields"),
        ("data[0] = 5", (), r"only arrays and sequences have \[0\]"),
        ("data = 'a'", (), "data is a number, 'a' a text"),
        ("data = TRUE", (), "data is a number, true a truth"),
        ("data LIKE 'a'", (), "LIKE takes a string field"),
        ("5 = 5", (), "compares no field"),
        ("5 BETWEEN 1 AND 9", (), "BETWEEN takes a field"),
        ("data = %1", ("5",), "%1 has no value: 1 parameters given"),
        ("data = %0", ("five",), "%0 is 'five', not a literal"),
        ("data = %0", ("5 6",), "%0 is '5 6', not a literal"),
        ("data ? 5", (), r"'\? 5' is not understood \(at character 6\)"),
        ("data = 5" + " AND data = 5", ("1",) * 101, "at most 100 fit"),
        ("(" * 60 + "data = 5" + ")" * 60, (), "nested more than 50 deep"),
    ],
)
def test_what_cannot_be_used_is_named(
    expression: str, parameters: tuple[str, ...], problem: str
) -> None:
    """When the filter is set, not when a message comes."""
    with pytest.raises(ContentFilterError, match=problem):
        compile_filter(Int32, expression, parameters)


def test_true_and_false_have_no_order() -> None:
    """Only = and <> fit."""
    assert passes(Bool(data=True), "data <> FALSE")
    with pytest.raises(ContentFilterError, match="true and false have no order"):
        compile_filter(Bool, "data > FALSE")


def test_whole_messages_cannot_be_compared() -> None:
    """The text says what can."""
    with pytest.raises(ContentFilterError, match="name a number, a string or a bool in it"):
        compile_filter(PoseStamped, "pose = 5")


def test_a_parameter_that_is_no_text_is_refused() -> None:
    """As in rclpy, parameters are texts."""
    with pytest.raises(TypeError, match="%0: 5 is not a string"):
        compile_filter(Int32, "data = %0", [5])  # type: ignore[list-item]  # what is tested


@given(st.text(alphabet="data =<>!()'%_.5xeANDORTLIKE[]\\ \n", max_size=60))
def test_any_text_is_a_filter_or_one_error(expression: str) -> None:
    """Never another exception, and a filter answers for every message."""
    try:
        accept = compile_filter(Int32, expression)
    except ContentFilterError:
        return
    assert accept(Int32(data=5)) in {True, False}


numbers = st.integers(-3, 3)


@given(
    st.recursive(
        st.tuples(st.sampled_from(["=", "<>", "<", "<=", ">", ">="]), numbers),
        lambda inner: (
            st.tuples(st.sampled_from(["AND", "OR"]), inner, inner)
            | st.tuples(st.just("NOT"), inner)
        ),
        max_leaves=12,
    ),
    numbers,
)
def test_a_filter_says_what_python_says(tree: Any, value: int) -> None:
    """The same condition, written in both languages."""

    def written(node: Any, equals: str, differs: str) -> str:
        match node:
            case ("NOT", inner):
                return f"not ({written(inner, equals, differs)})"
            case (("AND" | "OR") as word, left, right):
                return (
                    f"({written(left, equals, differs)}) {word.lower()} "
                    f"({written(right, equals, differs)})"
                )
            case (symbol, number):
                return f"data {({'=': equals, '<>': differs}).get(symbol, symbol)} {number}"
        raise AssertionError(node)

    expected = eval(written(tree, "==", "!="), {"data": value})  # noqa: S307  # the test's own text

    assert passes(Int32(data=value), written(tree, "=", "<>")) == expected


def test_a_byte_is_a_number() -> None:
    """Though a scalar byte is bytes of length 1 in Python, as in rclpy."""
    status = DiagnosticStatus(level=b"\x02")

    assert passes(status, "level = 2")
    assert passes(status, "level > 1")
    assert not passes(status, "level = 1")


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [("%a%b%", True), ("%b%a_b", True), ("a%", True), ("%a", False), ("%%", True), ("_%_", True)],
)
def test_several_wildcards_match_as_in_sql(pattern: str, expected: bool) -> None:
    """Each `%` takes as little as it can, which finds a match wherever there is one."""
    assert passes(String(data="aab ab axb"), f"data LIKE '{pattern}'") is expected


@pytest.mark.timeout(10)
def test_a_pattern_with_many_wildcards_takes_no_time() -> None:
    """A pattern of regular expressions would keep the loop busy for hours."""
    assert not passes(String(data="a" * 5000), f"data LIKE '{'%a' * 40}%b'")


@given(st.text("ab_", max_size=6), st.text("ab%_", max_size=8))
def test_like_agrees_with_a_plain_definition(text: str, pattern: str) -> None:
    """Taking each part where it is found first loses no match."""

    def like(text: str, pattern: str) -> bool:
        if not pattern:
            return not text
        if pattern[0] == "%":
            return any(like(text[n:], pattern[1:]) for n in range(len(text) + 1))
        return bool(text) and pattern[0] in ("_", text[0]) and like(text[1:], pattern[1:])

    assert passes(String(data=text), f"data LIKE '{pattern}'") is like(text, pattern)


def test_a_number_of_a_thousand_digits_is_refused() -> None:
    """As what it is, an expression that cannot be used."""
    with pytest.raises(ContentFilterError, match="expected a field or a literal"):
        passes(Int32(), f"data = {'9' * 5000}")
