"""Definitions in OMG's IDL: what ``.msg`` files describe, in the other language of rosidl."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.wire.typehash import type_hash
from aionode.errors import IdlError
from aionode.idl import define, load_interfaces
from aionode.message import constants, fields

POSE = """// generated from rosidl_adapter/resource/msg.idl.em
// with input from demo/msg/Pose.msg
// generated code does not contain a copyright notice

#include "builtin_interfaces/msg/Time.idl"
#include "geometry_msgs/msg/Point.idl"

module demo {
  module msg {
    typedef double double__9[9];
    typedef geometry_msgs::msg::Point geometry_msgs__msg__Point;
    module Pose_Constants {
      @verbatim (language="comment", text="How many; at most.")
      const int32 LIMIT = 0x10;
      const string NAME = "a \\"b\\"";
      const boolean ON = TRUE;
    };
    /* A pose
       with more. */
    @verbatim (language="comment", text=
      "A pose." "\\n"
      "In m.")
    struct Pose {
      builtin_interfaces::msg::Time stamp;

      @unit (value="m")
      geometry_msgs::msg::Point position;
      sequence<geometry_msgs::msg::Point, 3> way;
      double__9 covariance;
      @default (value=-0.5)
      double x, y;
      @default (value="(1, 2)")
      sequence<uint8> data;
      @default (value="up")
      string<10> state;
      sequence<string<5>, 4> words;
      wstring wide;
      octet part;
      boolean is_on;
      unsigned long long count;
      long small[3];
    };
  };
};
"""
AS_MSG = """int32 LIMIT=16
string NAME=a "b"
bool ON=true
builtin_interfaces/Time stamp
geometry_msgs/Point position
geometry_msgs/Point[<=3] way
float64[9] covariance
float64 x -0.5
float64 y -0.5
uint8[] data [1, 2]
string<=10 state "up"
string<=5[<=4] words
wstring wide
byte part
bool is_on
uint64 count
int32[3] small
"""


def test_a_structure_is_the_message_that_its_msg_file_describes() -> None:
    """The tools of rosidl make the one of the other."""
    made: Any = define("demo/msg/Pose", POSE, encoding="ros2idl")
    same: Any = define("demo/msg/Pose", AS_MSG)
    assert fields(made) == fields(same)
    assert constants(made) == constants(same)
    assert type_hash(made) == type_hash(same)
    assert made.__doc__ == "A pose.\nIn m."


def test_idl_files_of_a_folder_are_loaded(tmp_path: Path) -> None:
    """Packages may have them in place of .msg, .srv and .action files."""
    for kind, text in {
        "msg": POSE,
        "srv": "module demo { module srv { struct Add_Request { long a; }; struct Add_Response "
        "{ uint8 structure_needs_at_least_one_member; }; }; };",
        "action": "module demo { module action { struct Go_Goal { long a; }; struct Go_Result "
        "{ long b; }; struct Go_Feedback { demo::msg::Pose at; }; }; };",
    }.items():
        (tmp_path / "demo" / kind).mkdir(parents=True)
        name = {"msg": "Pose", "srv": "Add", "action": "Go"}[kind]
        (tmp_path / "demo" / kind / f"{name}.idl").write_text(text)
    loaded: Any = load_interfaces(tmp_path)
    assert sorted(loaded) == ["demo/action/Go", "demo/msg/Pose", "demo/srv/Add"]
    assert loaded.demo.srv.Add.Request(a=3).a == 3
    assert fields(loaded.demo.srv.Add.Response) == ()
    assert loaded.demo.action.Go.Feedback().at == loaded.demo.msg.Pose()


def test_a_msg_file_is_taken_before_the_idl_file_that_was_made_of_it(tmp_path: Path) -> None:
    """An installed package has both, and comments are in the first."""
    (tmp_path / "demo" / "msg").mkdir(parents=True)
    (tmp_path / "demo" / "msg" / "Pose.idl").write_text(POSE)
    (tmp_path / "demo" / "msg" / "Pose.msg").write_text("int32 mine\n")
    assert [f.name for f in fields(load_interfaces(tmp_path)["demo/msg/Pose"])] == ["mine"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("struct A { sequence<sequence<long>> x; };", "no sequences of sequences"),
        ("typedef long m[3]; struct A { m x[2]; };", "no arrays of arrays"),
        ("enum E { X }; struct A { E x; };", "'enum' is not module"),
        ("struct A { long x; long x; };", "'x' is already defined"),
        ("struct A { long x };", "'}' where ';' was expected"),
        ("struct A { long x;", "the end where"),
        ("struct A { sequence<long, 0> x; };", "is not a valid size"),
        ("struct A { sequence<long, N> x; };", "is not a known value"),
        ('struct A { @default(value="(1,") sequence<long> x; };', "is not a list of values"),
        ("struct A { @default(value=300) octet x; };", "0 to 255"),
        ("struct A { Other x; };", "no message type"),
        ("const Other X = 5; struct A { long x; };", "cannot have values here"),
        ("struct A { @default(value=5) Other x; };", "cannot have values here"),
        ("typedef long m[2]; const m X = 5; struct A { long x; };", "must be a single value"),
        ("struct B { long x; };", "there is no struct demo::msg::A"),
        ("struct A { long 5x; };", "where a name was expected"),
        ("struct A { long ~x; };", "where a name was expected"),
        ("} struct A { long x; };", "where"),
        ("struct A { long x; }; $", "is not a token of IDL"),
    ],
)
def test_what_ros_does_not_have_is_named_with_its_place(
    text: str, problem: str, tmp_path: Path
) -> None:
    """IDL has more than rosidl takes."""
    (tmp_path / "demo" / "msg").mkdir(parents=True)
    file = tmp_path / "demo" / "msg" / "A.idl"
    file.write_text(f"module demo {{ module msg {{\n{text}\n}}; }};")
    with pytest.raises(IdlError, match=problem) as caught:
        load_interfaces(tmp_path)
    assert str(caught.value).startswith(str(file))


@pytest.mark.parametrize(
    "text",
    [
        "sequence<" * 100_000,
        "module a {" * 100_000,
        "struct A { @a(" * 50_000,
        'struct A { string x; }; @v(text="' + '\\"' * 100_000,
        "const long X = " + "9" * 5000 + ";",
        "struct A {" + "long a[" * 100_000,
        "/*" * 300_000,
        "x" * 2_000_000,
    ],
)
def test_text_that_is_made_to_cost_much_is_refused_soon(text: str) -> None:
    """A recording brings it, and a program that only lists topics reads it."""
    with pytest.raises(IdlError):
        define("demo/msg/A", text, encoding="ros2idl")


@given(
    st.lists(
        st.sampled_from(
            [
                "module",
                "struct",
                "typedef",
                "const",
                "sequence",
                "<",
                ">",
                "{",
                "}",
                "(",
                ")",
                "[",
                "]",
                ";",
                ",",
                "=",
                "::",
                "@",
                "a",
                "A",
                "long",
                "3",
                "'x'",
                '"y"',
                "string",
                "demo",
                "msg",
                "#include",
                "//x",
                "/*",
                "*/",
                "unsigned",
                "double",
                "-",
            ]
        ),
        max_size=40,
    )
)
def test_any_words_are_a_definition_or_an_error_with_its_place(words: list[str]) -> None:
    """One error, and no other."""
    text = f"module demo {{ module msg {{ struct A {{ long x; }}; {' '.join(words)}"
    with contextlib.suppress(IdlError):
        define("demo/msg/A", text, encoding="ros2idl")
