"""Reading definitions: what is understood, and where an error points."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.errors import IdlError
from aionode.idl import define
from aionode.idl._definition import MemberText, TypeText
from aionode.idl._parser import parse
from aionode.message import documentation


def members(text: str) -> tuple[MemberText, ...]:
    """Return the members of one message."""
    return parse("tutorial/msg/Words", text).parts[0].members


def only(text: str) -> MemberText:
    """Return the one member of a message."""
    (member,) = members(text)
    return member


@pytest.mark.parametrize(
    ("text", "type_"),
    [
        ("int32 x", TypeText("int32")),
        ("string<=10 x", TypeText("string", 10)),
        ("wstring x", TypeText("wstring")),
        ("float64[9] x", TypeText("float64", None, "array", 9)),
        ("float64[] x", TypeText("float64", None, "unbounded")),
        ("byte[<=3] x", TypeText("byte", None, "bounded", 3)),
        ("string<=10[<=3] x", TypeText("string", 10, "bounded", 3)),
        ("Point x", TypeText("Point")),
        ("geometry_msgs/Point[2] x", TypeText("geometry_msgs/Point", None, "array", 2)),
        ("geometry_msgs/msg/Point x", TypeText("geometry_msgs/msg/Point")),
    ],
)
def test_every_type_is_understood(text: str, type_: TypeText) -> None:
    """All forms of rosidl."""
    assert only(text).type == type_


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("int32 x", None),
        ("int32 x -5", -5),
        ("int32 x 0x1F", 31),
        ("int32 x 007", 7),
        ("uint8 x 255 # full", 255),
        ("float32 x 1", 1.0),
        ("float64 x -1.5e3", -1500.0),
        ("bool x true", True),
        ("bool x 0", False),
        ("byte x 50", b"2"),
        ("char x 100", 100),
        ('string x "a # b"  # c', "a # b"),
        ("string x 'it\\'s'", "it's"),
        (r'string x "a\nb\t\"\\\x41\u00e9\101"', 'a\nb\t"\\AéA'),
        (r'string x "\q"', "\\q"),
        ("string x hello world # not this", "hello world"),
        ('string x ""', ""),
        ('wstring x "漢"', "漢"),
        ("int8[3] x [0, 127, -128]", (0, 127, -128)),
        ("int8[] x []", ()),
        ("byte[<=3] x [0, 1, 255]", (0, 1, 255)),
        ("bool[2] x [true, False]", (True, False)),
        ('string[3] x ["", "a, ]b", \'c\']', ("", "a, ]b", "c")),
        ("string[] x [a, b]", ("a", "b")),
    ],
)
def test_every_default_is_understood(text: str, value: object) -> None:
    """In the form that a field of the type holds."""
    found = only(text).value

    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("int32 LIMIT=5", 5),
        ("int32 LIMIT = -5 # lowest", -5),
        ("byte OK=0", b"\x00"),
        ("string NAME=hello world", "hello world"),
        ('string NAME = "a # b"', "a # b"),
        ("string NAME=", ""),
        ("float32 PI_2=1.57", 1.57),
    ],
)
def test_constants_are_told_from_fields(text: str, value: object) -> None:
    """By the equals sign."""
    found = only(text)

    assert found.constant
    assert found.value == value


def test_comments_and_empty_lines_define_nothing() -> None:
    """Comments at the top become the docstring, and those at a member say what it is."""
    text = "# What it is.\n#\n# More.\n\n# still\nint32 x  # about x\n# about y\n\n  int32 y\t\r\n"
    found = parse("tutorial/msg/Words", text).parts[0]

    assert [member.name for member in found.members] == ["x", "y"]
    assert found.comment == "What it is.\n\nMore."
    assert [member.comment for member in found.members] == ["still about x", ""]


def test_services_and_actions_have_parts() -> None:
    """Separated by three dashes."""
    service = parse("tutorial/srv/Add", "int64 a\n--- # answer\nint64 sum\n")
    action = parse("tutorial/action/Walk", "---\n---\n")

    assert [len(part.members) for part in service.parts] == [1, 1]
    assert [len(part.members) for part in action.parts] == [0, 0, 0]


@pytest.mark.parametrize(
    ("text", "line", "column", "problem"),
    [
        ("int32", 1, 6, "the name is missing; write 'int32 some_name'"),
        ("int33 x", 1, 1, "'int33' is not a type; did you mean int32?"),
        ("\n  Int32[ x", 2, 8, "'[' does not belong to a type"),
        ("9 x", 1, 1, "'9' is not a type; a line begins with a type"),
        ("int32 X", 1, 7, "'X' is not a valid field name; use lower-case letters"),
        ("int32 a__b", 1, 7, "'a__b' is not a valid field name"),
        ("int32 from", 1, 7, "'from' is a Python keyword"),
        ("int32 x=5", 1, 7, "'x' is not a valid constant name; use upper-case letters"),
        ("int32 X=", 1, 9, "the value of X is missing"),
        ("int32[2] X=[1, 2]", 1, 12, "a constant must be a single value, not an array"),
        ("int8 x 300", 1, 8, "300, int8 holds -128 to 127"),
        ("int8 x 1.5", 1, 8, "'1.5' is not a valid int8"),
        ("bool x yes", 1, 8, "'yes' is not a bool; write true or false"),
        ("float32 x 1e39", 1, 11, "1e+39, too large for a float32"),
        ("int8[3] x [1, 2]", 1, 11, "2 elements, needs 3"),
        ("int8[<=1] x [1, 2]", 1, 13, "2 elements, at most 1 fit"),
        ("int8[2] x [1, 200]", 1, 11, "element [1]: 200, int8 holds -128 to 127"),
        ("int8[2] x [1, b]", 1, 14, "'b' is not a valid int8"),
        ("int8[2] x 1", 1, 11, "'1' is not a list; write the default of an array like [1, 2, 3]"),
        ("int8[2] x [1,,2]", 1, 14, "an element is missing before this character"),
        ('string x "abc', 1, 10, 'the quote " is not closed'),
        ("string<=2 x abc", 1, 13, "3 characters, at most 2 fit"),
        ("string<=0 x", 1, 9, "a bound is at least 1"),
        ("int32<=3 x", 1, 6, "only strings have a bound, not int32"),
        ("int32[0] x", 1, 7, "a size or bound is a number of at least 1"),
        ("int32[<=] x", 1, 9, "a size or bound is a number of at least 1"),
        ("int32[3 x", 1, 6, "'[' does not belong to a type"),
        ("Point x 5", 1, 9, "a nested message cannot have a default; remove '5'"),
        ("int32 a\n\nint32 a", 3, 7, "'a' is already defined on line 1"),
    ],
)
def test_an_error_points_at_the_character_and_says_what_fits(
    text: str, line: int, column: int, problem: str
) -> None:
    """An editor can jump there."""
    with pytest.raises(IdlError) as caught:
        parse("tutorial/msg/Words", text, "msg/Words.msg")

    error = caught.value
    assert (error.file, error.line, error.column) == ("msg/Words.msg", line, column)
    assert error.problem.startswith(problem)
    assert str(error).startswith(f"msg/Words.msg:{line}:{column}: {problem}")


@pytest.mark.parametrize(
    ("typename", "text", "problem"),
    [
        ("tutorial/srv/Add", "int64 a", "1 part(s); this kind of file has Request and Response"),
        ("tutorial/msg/Words", "---", "2 part(s); this kind of file has one message, without"),
        ("tutorial/action/Walk", "---", "2 part(s); this kind of file has Goal and Result and"),
    ],
)
def test_the_number_of_parts_has_to_fit_the_kind(typename: str, text: str, problem: str) -> None:
    """A forgotten separator is the usual reason."""
    with pytest.raises(IdlError) as caught:
        parse(typename, text)

    assert caught.value.problem.startswith(problem)
    assert str(caught.value).startswith(f"{typename}: ")


LINE = st.text(
    st.sampled_from(list("int328 stringboolx<=[]0159.,-#'\"\\/_= \tABPoint")), max_size=30
)


@given(st.lists(st.one_of(LINE, st.text(max_size=20)), max_size=4).map("\n".join))
def test_no_text_raises_anything_but_an_idl_error(text: str) -> None:
    """Definitions come from other people's repositories and from recordings."""
    try:
        members(text)
    except IdlError as error:
        assert error.line <= text.count("\n") + 1  # noqa: PT017 (it may well be readable)


def test_comments_of_fields_are_kept() -> None:
    """They say what a field means, and its unit: to tools, and to those who read the schema."""
    text = """\
# A cell.

# The heat of it,
# in degrees.
float32 heat
int8 n  # of the row
string label "a # b"   # as printed

# A remark about nothing.

bool full
int8 LIMIT=3 # not of a field
"""
    cell = define("tutorial/msg/CommentedCell", text)

    assert documentation(cell) == (
        "A cell.",
        {"heat": "The heat of it, in degrees.", "n": "of the row", "label": "as printed"},
    )
    assert documentation(define("tutorial/msg/Plain", "int8 n # of the row"))[1] == {
        "n": "of the row"
    }
