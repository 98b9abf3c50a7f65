"""Messages as plain values, JSON and YAML."""

from __future__ import annotations

import contextlib
import json
import math
from collections.abc import Callable

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from aionode.errors import MessageError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.geometry_msgs.msg import Polygon, Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, Imu, JointState
from aionode.interfaces.std_msgs.msg import (
    ByteMultiArray,
    Empty,
    Float32,
    Float64,
    Header,
    Int8,
    String,
)
from aionode.message import (
    Message,
    from_builtins,
    from_json,
    from_yaml,
    to_builtins,
    to_json,
    to_yaml,
)
from tests.support.strategies import any_messages

TWIST = """\
linear:
  x: 0.0
  y: 0.0
  z: 0.0
angular:
  x: 0.0
  y: 0.0
  z: 0.0
"""


def test_plain_values_are_dicts_lists_and_numbers() -> None:
    """All that json or yaml can print; a byte is a number."""
    status = DiagnosticStatus(level=DiagnosticStatus.WARN, values=[KeyValue(key="a", value="b")])

    assert to_builtins(DiagnosticArray(status=[status]))["status"] == [
        {
            "level": 1,
            "name": "",
            "message": "",
            "hardware_id": "",
            "values": [{"key": "a", "value": "b"}],
        }
    ]
    assert to_builtins(Image(data=b"\x01\x02"))["data"] == [1, 2]
    assert to_builtins(JointState(position=np.array([1.5])))["position"] == [1.5]


def test_yaml_is_what_ros2_topic_echo_prints() -> None:
    """Lists have the indent of their key, as recorded from ROS 2."""
    assert to_yaml(Twist()) == TWIST
    assert to_yaml(Fibonacci.Feedback(sequence=[0, 1])) == "sequence:\n- 0\n- 1\n"
    assert to_yaml(String(data="Hello 46")) == "data: Hello 46\n"
    assert to_yaml(Empty()) == "{}\n"


def test_yaml_keeps_long_strings_on_one_line_and_letters_as_they_are() -> None:
    """Grep can find them."""
    text = "é " * 100 + "漢"

    assert to_yaml(String(data=text)) == f"data: {text}\n"


def test_yaml_in_flow_style_is_one_line() -> None:
    """As `ros2 topic echo --flow-style` prints it."""
    assert to_yaml(Vector3(x=1.5), flow_style=True) == "{x: 1.5, y: 0.0, z: 0.0}\n"


def test_json_is_one_line() -> None:
    """One record for each line of output."""
    assert to_json(Vector3(x=1.5)) == '{"x":1.5,"y":0.0,"z":0.0}'


def test_nan_and_infinity_have_words() -> None:
    """JSON lacks them, and null would not tell which one it was."""
    message = JointState(position=[math.nan, math.inf, -math.inf])

    assert json.loads(to_json(message))["position"] == ["NaN", "Infinity", "-Infinity"]
    assert from_json(JointState, to_json(message)).position[1:].tolist() == [math.inf, -math.inf]
    assert "- .nan\n- .inf\n- -.inf" in to_yaml(message)
    assert math.isnan(from_yaml(Float32, to_yaml(Float32(data=math.nan))).data)
    assert math.isnan(from_json(Float32, to_json(Float32(data=math.nan))).data)


def test_what_is_left_out_has_its_default() -> None:
    """As in `ros2 topic pub /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 1.5}}"`."""
    assert from_yaml(Twist, "{linear: {x: 1.5}}") == Twist(linear=Vector3(x=1.5))
    assert from_yaml(Twist, "") == Twist()
    assert from_builtins(Header, {"stamp": {"sec": 3}}).stamp.sec == 3


def test_numbers_that_yaml_reads_as_text_are_understood_for_floats() -> None:
    """YAML 1.1 wants a dot and a sign in 1.0e+5."""
    assert from_yaml(Float64, "data: 1e5").data == 1e5
    assert from_yaml(JointState, "position: [1e-3, 2]").position.tolist() == [0.001, 2.0]


def test_arrays_are_taken_as_they_are() -> None:
    """A program that has arrays need not convert them to lists."""
    values = np.array([1.0, 2.0])

    assert from_builtins(JointState, {"position": values}).position is values
    assert bytes(from_builtins(Image, {"data": b"ab"}).data) == b"ab"


def test_the_arrays_of_a_new_message_can_be_changed() -> None:
    """Nobody else refers to them."""
    message = from_builtins(JointState, {"position": [1, 2]})
    message.position[0] = 5

    assert message.position.tolist() == [5.0, 2.0]


@pytest.mark.parametrize(
    ("cls", "text", "error"),
    [
        (
            String,
            "dat: hi",
            (
                "std_msgs/msg/String.dat: no such field; did you mean 'data'?; std_msgs/msg/String "
                "has data"
            ),
        ),
        (
            Empty,
            "x: 1",
            "std_msgs/msg/Empty.x: no such field; std_msgs/msg/Empty has no fields",
        ),
        (
            Twist,
            "linear: {q: 1}",
            (
                "geometry_msgs/msg/Twist.linear.q: no such field; geometry_msgs/msg/Vector3 has x, "
                "y, z"
            ),
        ),
        (Int8, "data: 300", "std_msgs/msg/Int8.data: 300, int8 holds -128 to 127"),
        (String, "data: 5", "std_msgs/msg/String.data: 5 (int), needs a str"),
        (
            String,
            "hi",
            "std_msgs/msg/String: 'hi' (str), needs a mapping from field names to values",
        ),
        (
            Polygon,
            "points: [{x: 1}, 5]",
            (
                "geometry_msgs/msg/Polygon.points[1]: 5 (int), needs a mapping from field names to "
                "values"
            ),
        ),
        (
            Polygon,
            "points: 5",
            "geometry_msgs/msg/Polygon.points: 5 (int), needs a list",
        ),
        (
            Imu,
            "orientation_covariance: [0]",
            "sensor_msgs/msg/Imu.orientation_covariance: 1 elements, needs 9",
        ),
        (
            JointState,
            "position: [1, far]",
            "sensor_msgs/msg/JointState.position[1]: 'far' (str), needs a float",
        ),
        (
            DiagnosticStatus,
            "level: 256",
            "diagnostic_msgs/msg/DiagnosticStatus.level: 256, uint8 holds 0 to 255",
        ),
    ],
)
def test_an_invalid_value_is_named_with_its_path(cls: type[Message], text: str, error: str) -> None:
    """From plain values, YAML and JSON alike."""
    data = yaml.safe_load(text)
    readers: list[tuple[Callable[..., Message], object]] = [
        (from_yaml, text),
        (from_builtins, data),
        (from_json, json.dumps(data)),
    ]
    for read, source in readers:
        with pytest.raises(MessageError) as caught:
            read(cls, source)
        assert str(caught.value) == error


@pytest.mark.parametrize("text", ["{", "[1", "{data: 'x}", b"\xff"])
def test_text_that_cannot_be_read_is_a_message_error(text: str | bytes) -> None:
    """The user who typed it gets one line, no traceback."""
    for read in (from_json, from_yaml):
        with pytest.raises(MessageError, match="std_msgs/msg/String"):
            read(String, text)


def test_a_message_that_does_not_fit_is_not_printed() -> None:
    """The same errors hold in both directions."""
    with pytest.raises(MessageError, match=r"std_msgs/msg/Int8\.data: 300"):
        to_json(Int8(data=300))


@given(st.one_of(st.text(max_size=20), st.text("{}[]:,-!&*#'\" \n\t01data", max_size=20)))
def test_no_text_raises_anything_but_a_message_error(text: str) -> None:
    """Texts are typed at a prompt, or come from the network."""
    for read in (from_json, from_yaml):
        with contextlib.suppress(MessageError):
            assert isinstance(read(String, text), String)


@pytest.mark.parametrize("text", ["[" * 100_000, "data: 2001-99-99"])
def test_texts_that_break_a_parser_are_message_errors(text: str) -> None:
    """Values nested too deeply for the stack, or an invalid date."""
    with pytest.raises(MessageError):
        from_yaml(String, text) if ":" in text else from_json(String, text)


@settings(
    max_examples=settings().max_examples * 3 // 2,
    suppress_health_check=list(HealthCheck),
    deadline=None,
)
@given(any_messages())
def test_every_message_survives_plain_values_json_and_yaml(message: Message) -> None:
    """For every type that is shipped."""
    cls = type(message)

    assert from_builtins(cls, to_builtins(message)) == message
    assert from_json(cls, to_json(message)) == message
    assert from_yaml(cls, to_yaml(message)) == message


def test_long_arrays_and_strings_can_be_truncated() -> None:
    """As ``ros2 topic echo`` prints them; an image has megabytes."""
    message = JointState(name=["abcd", "e", "f"], position=[1.0, 2.0])

    plain = to_builtins(message, truncate=2)

    assert (plain["name"], plain["position"]) == (["ab...", "e", "..."], [1.0, 2.0])
    assert plain["header"]["frame_id"] == ""
    assert to_builtins(Image(data=bytes(1000)), truncate=1)["data"] == [0, "..."]


def test_a_negative_limit_is_refused() -> None:
    """Python would count it from the end."""
    with pytest.raises(ValueError, match="truncate: -1 given"):
        to_builtins(String(), truncate=-1)


def test_a_byte_is_a_character_in_yaml() -> None:
    """As ros2 prints it; numbers are accepted as well."""
    message = DiagnosticStatus(level=b"\x02")

    assert 'level: "\\x02"' in to_yaml(message)
    assert from_yaml(DiagnosticStatus, to_yaml(message)) == message
    assert from_yaml(DiagnosticStatus, "{level: 2}") == message
    assert from_yaml(ByteMultiArray, "{data: [1, a]}").data == b"\x01a"
