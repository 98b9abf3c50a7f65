"""Messages in the forms of rosbridge."""

from __future__ import annotations

import base64
import json
import math
from typing import Any

import cbor2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image as Picture

from aionode.engine.wire import cdr
from aionode.errors import MessageError
from aionode.gateway.session.encoding.frames import (
    cbor_frame,
    cbor_raw_frame,
    fragments,
    json_frame,
    png_frame,
)
from aionode.gateway.session.encoding.values import from_json, json_of
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import PointStamped, Twist
from aionode.interfaces.nav_msgs.msg import Path
from aionode.interfaces.sensor_msgs.msg import CameraInfo, Image, LaserScan
from aionode.interfaces.std_msgs.msg import (
    Bool,
    Byte,
    ByteMultiArray,
    Float64,
    Header,
    Int8MultiArray,
    String,
    UInt8MultiArray,
)
from aionode.interfaces.test_msgs.msg import Arrays, UnboundedSequences
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.message import snapshot

NOW_NS = 12 * 10**9 + 34


def in_json(message: Any) -> Any:
    """Return a message as decoded by a client."""
    return json.loads(json_of(snapshot(message)))


def in_cbor(message: Any) -> Any:
    """Return a message as decoded by a client."""
    return cbor2.loads(cbor_frame("/t", snapshot(message)))["msg"]


# JSON to clients


def test_json_has_null_for_what_json_has_not() -> None:
    """NaN and infinities are not JSON: browsers would refuse the whole frame."""
    scan = LaserScan(ranges=[1.5, math.inf, math.nan], angle_min=-math.inf)

    assert in_json(scan)["ranges"] == [1.5, None, None]
    assert in_json(scan)["angle_min"] is None


def test_json_has_bytes_as_base64_text() -> None:
    """Clients read them this way, whether the field has a fixed size or not."""
    assert in_json(Image(data=b"\x00\xff"))["data"] == base64.b64encode(b"\x00\xff").decode()
    uuid = np.arange(16, dtype=np.uint8)
    assert in_json(UUID(uuid=uuid))["uuid"] == base64.b64encode(uuid.tobytes()).decode()


def test_json_has_numbers_for_values_of_type_byte() -> None:
    """A ``byte`` is a number to clients, alone and in sequences, at any depth."""
    assert in_json(Byte(data=b"\x07")) == {"data": 7}
    assert in_json(ByteMultiArray(data=b"\x01\x02"))["data"] == [1, 2]
    assert in_json(UnboundedSequences(byte_values=b"\x01"))["byte_values"] == [1]


def test_json_of_a_decoded_message_is_that_of_the_message() -> None:
    """Messages from the wire have other Python types, such as views of the received bytes."""
    message = Image(data=b"\x01\x02", height=3, header=Header(frame_id="ü"))

    assert json.loads(json_of(cdr.decode(Image, cdr.encode(message)))) == in_json(message)


# CBOR to clients


def test_cbor_has_sequences_of_numbers_as_typed_arrays() -> None:
    """Clients map them to arrays without conversion: RFC 8746, little endian."""
    scan = in_cbor(LaserScan(ranges=[1.5, math.inf]))

    assert scan["ranges"].tag == 85
    assert np.frombuffer(scan["ranges"].value, "<f4").tolist() == [1.5, math.inf]
    assert in_cbor(Int8MultiArray(data=[-1]))["data"] == cbor2.CBORTag(72, b"\xff")
    assert in_cbor(ByteMultiArray(data=b"\x05"))["data"] == cbor2.CBORTag(72, b"\x05")


def test_cbor_has_bytes_as_bytes_and_arrays_of_a_fixed_size_as_lists() -> None:
    """As in rosbridge, and as clients expect."""
    assert in_cbor(UInt8MultiArray(data=b"\x01\x02"))["data"] == b"\x01\x02"
    assert in_cbor(CameraInfo())["k"] == [0.0] * 9
    assert in_cbor(Arrays(bool_values=[True, False, True]))["bool_values"] == [True, False, True]
    assert in_cbor(Byte(data=b"\x07")) == {"data": 7}


def test_cbor_keeps_nan() -> None:
    """Unlike JSON, CBOR has it."""
    assert math.isnan(in_cbor(Float64(data=math.nan))["data"])


@given(st.binary(max_size=70_000), st.integers(0, 2**62))
def test_cbor_raw_has_the_bytes_of_the_message_unchanged(data: bytes, time_ns: int) -> None:
    """The frame is built around them; any decoder can read it."""
    frame = cbor2.loads(bytes(cbor_raw_frame("/t", memoryview(data), time_ns)))

    secs, nsecs = divmod(time_ns, 10**9)
    msg = {"secs": secs, "nsecs": nsecs, "bytes": data}
    assert frame == {"op": "publish", "topic": "/t", "msg": msg}


# png, fragments


@given(st.text(min_size=1, max_size=300))
def test_png_is_a_picture_whose_pixels_are_the_frame(text: str) -> None:
    """Clients draw it, and read its colours as text padded with line ends."""
    import io

    op = json.loads(png_frame(text))
    with Picture.open(io.BytesIO(base64.b64decode(op["data"]))) as picture:
        pixels = picture.convert("RGB").tobytes()

    assert op["op"] == "png"
    assert pixels.decode().rstrip("\n") == text.rstrip("\n")


def test_fragments_are_not_made_without_number() -> None:
    """A client may request fragments of one character of an image of millions."""
    assert len(list(fragments("x" * 5_000_000, 1, "7"))) == 1000


@given(st.text(min_size=1, max_size=100), st.integers(1, 120))
def test_fragments_together_are_the_frame(text: str, size: int) -> None:
    """A frame that fits is unchanged."""
    parts = list(fragments(text, size, "7"))

    if len(text) <= size:
        assert parts == [text]
    else:
        ops = [json.loads(part) for part in parts]
        assert "".join(op["data"] for op in ops) == text
        assert [(op["id"], op["num"], op["total"]) for op in ops] == [
            ("7", num, len(ops)) for num in range(len(ops))
        ]


# JSON from clients


def test_bytes_may_be_base64_text_or_a_list() -> None:
    """Both are in use."""
    for data in ("AP8=", [0, 255]):
        assert bytes(from_json(Image, {"data": data}, NOW_NS).data) == b"\x00\xff"
    uuid = from_json(UUID, {"uuid": base64.b64encode(bytes(range(16))).decode()}, NOW_NS)
    assert uuid.uuid.tolist() == list(range(16))


def test_text_that_is_not_base64_is_an_error_that_names_the_field() -> None:
    """The client learns which of its fields is wrong."""
    with pytest.raises(MessageError, match=r"sensor_msgs/msg/Image\.data: not base64"):
        from_json(Image, {"data": "?"}, NOW_NS)


@pytest.mark.parametrize(
    "stamp", ["now", {"sec": 12, "nanosec": 34}, {"secs": 12, "nsecs": 34}, [12, 34]]
)
def test_a_time_has_all_forms_that_clients_send(stamp: object) -> None:
    """The names of ROS 1 and ROS 2, and ``now``."""
    sent = {"header": {"stamp": stamp}}

    assert from_json(PointStamped, sent, NOW_NS).header.stamp == Time(sec=12, nanosec=34)


def test_a_header_without_a_stamp_is_stamped() -> None:
    """Clients whose clock differs from the robot's leave that to rosbridge."""
    sent = {"header": {"frame_id": "map"}}

    header = from_json(PointStamped, sent, NOW_NS).header
    assert header == Header(stamp=Time(sec=12, nanosec=34), frame_id="map")
    assert from_json(PointStamped, {}, NOW_NS).header == Header()


def test_each_header_without_a_stamp_is_stamped() -> None:
    """The headers of a goal's pose and of a path's poses count, as in rosbridge."""
    sent = {
        "header": {"frame_id": "map"},
        "poses": [
            {"header": {"frame_id": "map"}},
            {"header": {"stamp": {"sec": 1}}},
            {"header": []},
            {},
        ],
    }

    path = from_json(Path, sent, NOW_NS)

    now = Time(sec=12, nanosec=34)
    assert path.header.stamp == now
    assert [pose.header.stamp for pose in path.poses] == [now, Time(sec=1), now, Time()]


def test_a_header_that_is_the_message_is_stamped() -> None:
    """Its type decides, not the name of a field."""
    assert from_json(Header, {"frame_id": "map"}, NOW_NS).stamp == Time(sec=12, nanosec=34)


def test_null_is_no_number() -> None:
    """JavaScript writes it for NaN, which would reach the wheels; rosbridge refuses it, too."""
    with pytest.raises(MessageError, match=r"data: None .*needs a float"):
        from_json(Float64, {"data": None}, NOW_NS)
    with pytest.raises(MessageError, match=r"ranges\[1\]: None"):
        from_json(LaserScan, {"ranges": [1, None]}, NOW_NS)


def test_values_may_come_in_the_order_of_the_fields() -> None:
    """Service requests are often lists."""
    sent = [[1.0, 0, 0], {"z": 2}]

    twist = from_json(Twist, sent, NOW_NS)
    assert (twist.linear.x, twist.angular.z) == (1.0, 2.0)
    with pytest.raises(MessageError, match="2 values in a list for 1 fields"):
        from_json(String, ["a", "b"], NOW_NS)


def test_an_unknown_field_is_an_error() -> None:
    """A typing error must not become a message of defaults."""
    with pytest.raises(MessageError, match=r"linear\.forward: no such field"):
        from_json(Twist, {"linear": {"forward": 1}}, NOW_NS)


@pytest.mark.parametrize("values", [None, "text", 3, [[None]], {"data": {"data": 1}}])
def test_what_is_no_message_is_an_error(values: object) -> None:
    """No JSON value may raise anything else: anybody may send it."""
    with pytest.raises(MessageError):
        from_json(Bool, values, NOW_NS)


def test_a_message_survives_the_way_to_a_client_and_back() -> None:
    """A browser may publish what it receives."""
    image = Image(data=b"\x00\x01", width=2, header=Header(stamp=Time(sec=3), frame_id="camera"))

    values = json.loads(json_frame("/image", snapshot(image)))["msg"]

    assert from_json(Image, values, NOW_NS) == image
