"""Frames of Foxglove's protocol: the bytes are those in the protocol's own tests."""

from __future__ import annotations

import json
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.errors import MessageError
from aionode.gateway.foxglove import frames
from aionode.gateway.session.encoding.parameters import parameter_of
from aionode.parameter import Parameter, ParameterType

NOT_SET = ParameterType.NOT_SET


def test_a_message_has_its_subscription_and_time_in_front() -> None:
    """Clients find the channel by the id of their subscription."""
    frame = frames.message_frame(30, 1234, memoryview(b"data"))

    assert frame == b"\x01\x1e\0\0\0\xd2\x04\0\0\0\0\0\0data"


def test_a_time_is_nine_bytes() -> None:
    """The opcode and nanoseconds."""
    assert frames.time_frame(1_234_567_890) == b"\x02\xd2\x02\x96\x49\0\0\0\0"


def test_a_response_names_its_call_and_encoding() -> None:
    """A client may have several calls in progress."""
    call = frames.ServiceCall(10, 12, "json", memoryview(b""))

    assert frames.response_frame(call, b"{}") == b"\x03\x0a\0\0\0\x0c\0\0\0\x04\0\0\0json{}"


def test_a_state_of_playback_answers_its_request() -> None:
    """By the id of the request, the client distinguishes its own seek from another's."""
    frame = frames.playback_frame(frames.PAUSED, 12345, 1.0, did_seek=True, request_id="i-am")

    assert frame == b"\x05\x01\x39\x30\0\0\0\0\0\0\0\0\x80\x3f\x01\x04\0\0\0i-am"


def test_a_message_of_a_client_is_not_copied() -> None:
    """It may be an image."""
    frame = b"\x01\x01\0\0\0payload"

    assert frames.binary_of(frame) == frames.ClientMessage(1, memoryview(b"payload"))


def test_a_call_has_its_encoding() -> None:
    """Requests are CDR or JSON."""
    frame = b"\x02\x01\0\0\0\x02\0\0\0\x03\0\0\0cdrrequest"

    assert frames.binary_of(frame) == frames.ServiceCall(1, 2, "cdr", memoryview(b"request"))


@pytest.mark.parametrize(("has_seek", "seek_ns"), [(1, 100_500_000_000), (0, None)])
def test_a_seek_is_optional(has_seek: int, seek_ns: int | None) -> None:
    """Its bytes are present in any case."""
    head = struct.pack("<BBfBQI", 3, 0, 1.5, has_seek, 100_500_000_000, 7)

    assert frames.binary_of(head + b"some-id") == frames.PlaybackRequest(
        paused=False, rate=1.5, seek_ns=seek_ns, request_id="some-id"
    )


@given(st.binary(max_size=40))
def test_any_bytes_are_a_frame_or_refused(data: bytes) -> None:
    """A client may send anything."""
    try:
        frames.binary_of(data)
    except MessageError as error:
        assert "frame" in str(error)  # noqa: PT017  # most examples raise, not all


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"op":"reboot"}', '{"op":"subscribe"}', "[" * 100_000, "\ud800",
     '{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}'],
)  # fmt: skip
def test_other_text_is_refused(text: str) -> None:
    """The error becomes a status for the client."""
    with pytest.raises(MessageError, match="frame"):
        frames.op_of(text, 5000)


def test_an_op_may_have_fields_that_are_new() -> None:
    """Newer clients send more fields."""
    text = '{"op":"subscribe","subscriptions":[{"id":1,"channelId":2,"new":3}],"newer":4}'

    op = frames.op_of(text, 5000)

    assert isinstance(op, frames.Subscribe)
    assert [(wish.id, wish.channel_id) for wish in op.subscriptions] == [(1, 2)]


def test_an_op_of_the_server_has_its_name_in_front() -> None:
    """Its fields are those of the protocol."""
    text = frames.op_frame("unadvertise", {"channelIds": [1]})

    assert json.loads(text) == {"op": "unadvertise", "channelIds": [1]}


@pytest.mark.parametrize(
    ("parameter", "shown"),
    [
        (Parameter("p", value=5), {"value": 5}),
        (Parameter("p", value=5.0), {"value": 5.0, "type": "float64"}),
        (Parameter("p", value=[1.0, 2.5]), {"value": [1.0, 2.5], "type": "float64_array"}),
        (Parameter("p", value="text"), {"value": "text"}),
        (Parameter("p", value=[b"\x01", b"\xff"]), {"value": "Af8=", "type": "byte_array"}),
        (Parameter("p"), {}),
    ],
    ids=lambda value: None,
)
def test_a_parameter_is_restored_unchanged(parameter: Parameter, shown: dict[str, object]) -> None:
    """The hints tell floats from integers, and bytes from texts."""
    assert frames.shown_parameter("/n.p", parameter) == {"name": "/n.p", **shown}
    given_back = parameter_of("p", shown.get("value"), NOT_SET, shown.get("type"))  # type: ignore[arg-type]

    assert given_back == parameter


@pytest.mark.parametrize(
    ("value", "now", "expected"),
    [
        (2, ParameterType.DOUBLE, 2.0),
        ([1, 2.5], ParameterType.DOUBLE_ARRAY, [1.0, 2.5]),
        ([], ParameterType.STRING_ARRAY, []),
        ([3.5, 4], ParameterType.NOT_SET, [3.5, 4.0]),
        (True, ParameterType.DOUBLE, True),
    ],
)
def test_a_number_takes_the_type_that_the_parameter_has(
    value: object, now: ParameterType, expected: object
) -> None:
    """JavaScript writes 2.0 as 2, and the node would refuse an integer."""
    parameter = parameter_of("p", value, now)

    assert parameter.value == expected
    assert type(parameter.value) is type(expected)
    assert now is NOT_SET or parameter.type_ in {now, ParameterType.BOOL}


@pytest.mark.parametrize(
    ("value", "hint"),
    [({"a": 1}, None), ([1, "a"], None), ("?", "byte_array"), ("x", "float64"), (1 << 70, None)],
)
def test_a_value_that_no_parameter_has_is_refused(value: object, hint: str | None) -> None:
    """The client is told which one."""
    with pytest.raises(MessageError, match="p"):
        parameter_of("p", value, NOT_SET, hint)
