"""Values that the codec takes, gives and refuses."""

from __future__ import annotations

import mmap
from decimal import Decimal
from fractions import Fraction
from types import new_class
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.engine.wire import cdr
from aionode.engine.wire.cdr._fallback_decoder import decode_slowly
from aionode.errors import DecodeError, MessageError
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.example_interfaces.msg import WString
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Point, PoseArray, Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, Imu, JointState, LaserScan
from aionode.interfaces.std_msgs.msg import Byte, Header, String
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.message import (
    DEFAULT,
    Array,
    Bounded,
    Message,
    Sequence,
    byte,
    check,
    float32,
    float64,
    int32,
    uint8,
    uint16,
    wstring,
)
from tests.support.strategies import messages

if TYPE_CHECKING:
    from pathlib import Path


class Mixed(Message, typename="test/msg/Mixed"):
    """A field of each form."""

    flag: bool = DEFAULT
    small: uint8 = DEFAULT
    number: int32 = DEFAULT
    real: float64 = DEFAULT
    short: float32 = DEFAULT
    octet: byte = DEFAULT
    text: str = DEFAULT
    label: Bounded[str, 4] = DEFAULT
    point: Point = DEFAULT
    flags: Sequence[bool] = DEFAULT
    octets: Sequence[uint8] = DEFAULT
    few_octets: Sequence[uint8, 3] = DEFAULT
    three_bytes: Array[byte, 3] = DEFAULT
    numbers: Sequence[uint16] = DEFAULT
    reals: Array[float64, 3] = DEFAULT
    few: Sequence[float32, 2] = DEFAULT
    texts: Sequence[str] = DEFAULT
    two_labels: Array[Bounded[str, 4], 2] = DEFAULT
    points: Sequence[Point] = DEFAULT
    two_points: Array[Point, 2] = DEFAULT


# Encoding.


def test_a_string_is_written_with_its_length_and_a_nul() -> None:
    """The example of every description of the format."""
    encoded = cdr.encode(String(data="Hello World: 1"))

    assert encoded.hex() == "000100000f00000048656c6c6f20576f726c643a203100"


@pytest.mark.parametrize("size", [0, 1, 2, 3, 4, 5, 6, 7, 8, 63, 64, 65, 66, 67, 1000])
def test_what_follows_a_text_of_any_length_is_aligned(size: int) -> None:
    """Short texts are packed with what is around them, long ones apart."""
    message = Imu(header=Header(frame_id="x" * size))
    message.linear_acceleration.z = 9.81

    encoded = cdr.encode(message)

    assert len(encoded) == 4 + -(-(12 + size + 1) // 8) * 8 + 37 * 8
    assert cdr.decode(Imu, encoded) == message


def test_no_elements_have_no_gap_before_them() -> None:
    """Alignment belongs to values: an empty sequence of float64 ends with its count."""
    encoded = cdr.encode(JointState(effort=[1.0]))

    assert len(encoded) == 4 + 12 + 4 + 4 + 4 + 4 + 4 + 8


@pytest.mark.parametrize(
    "values",
    [
        {"numbers": [1, 2]},
        {"numbers": (1, 2)},
        {"numbers": np.array([1, 2], np.int64)},
        {"numbers": np.array([1, 2], ">u2")},
        {"numbers": np.array([1, 0, 2, 0], np.uint16)[::2]},
        {"numbers": np.array([2, 1], np.uint16)[::-1]},
        {"numbers": np.array([1, 2], np.uint16).view(np.ma.MaskedArray)},
    ],
    ids=["list", "tuple", "wider", "swapped", "strided", "reversed", "subclass"],
)
def test_an_array_may_be_given_in_any_form(values: dict[str, Any]) -> None:
    """The bytes are the same; readers see an ndarray of the field's dtype."""
    usual = cdr.encode(Mixed(numbers=np.array([1, 2], np.uint16)))

    assert cdr.encode(Mixed(**values)) == usual
    for array in values.values():
        if isinstance(array, np.ndarray):
            array.flags.writeable = False  # then a snapshot shares it, gaps and all
            assert cdr.encode(Mixed(**values)) == usual


@pytest.mark.parametrize(
    "octets",
    [
        bytearray(b"abc"),
        memoryview(b"abc"),
        memoryview(b"axbxc")[::2],
        np.frombuffer(b"abc", np.uint8),
        [97, 98, 99],
    ],
    ids=["bytearray", "memoryview", "strided", "ndarray", "list"],
)
def test_octets_may_be_given_in_any_form(octets: Any) -> None:
    """Whatever holds single bytes is sent as them."""
    usual = cdr.encode(Mixed(octets=b"abc", few_octets=b"abc", three_bytes=b"abc"))

    assert cdr.encode(Mixed(octets=octets, few_octets=octets, three_bytes=octets)) == usual


@pytest.mark.parametrize("kind", [bytes, bytearray, memoryview, "ndarray"])
def test_the_pixels_of_an_image_are_a_piece_without_a_copy(kind: Any) -> None:
    """The piece is a read-only view of the memory that the message holds."""
    pixels = np.arange(60_000).astype(np.uint8)
    data = pixels if kind == "ndarray" else kind(pixels)
    image = Image(height=100, width=200, step=600, data=data)

    pieces = cdr.parts_encoder(Image)(image)

    assert b"".join(pieces) == cdr.encode(image)
    assert len(pieces) == 2
    assert np.shares_memory(np.frombuffer(pieces[1], np.uint8), np.frombuffer(data, np.uint8))
    assert memoryview(pieces[1]).readonly


def test_numbers_are_a_piece_of_single_bytes_without_a_copy() -> None:
    """Elements of any size are counted in bytes, so that lengths of pieces can be added up."""
    ranges = np.arange(5000.0).astype(np.float32)
    scan = LaserScan(ranges=ranges, intensities=np.ones(3, np.float32))

    pieces = cdr.parts_encoder(LaserScan)(scan)

    assert b"".join(pieces) == cdr.encode(scan)
    assert [len(piece) for piece in pieces[1:]] == [20_000, 4 + 12]
    assert np.shares_memory(np.frombuffer(pieces[1], np.float32), ranges)
    assert isinstance(pieces[1], memoryview)
    assert pieces[1].readonly


def test_an_unusual_message_has_pieces_too() -> None:
    """Numbers with gaps between them are copied first."""
    numbers = np.arange(20_000).astype(np.uint16)[::2]
    half: Any = Fraction(1, 2)

    pieces = cdr.parts_encoder(Mixed)(Mixed(numbers=numbers, real=half))

    assert b"".join(pieces) == cdr.encode(Mixed(numbers=numbers, real=0.5))


def test_pieces_of_an_invalid_message_are_refused_as_its_bytes_are() -> None:
    """The reason is the same."""
    misfit: Any = "five"

    with pytest.raises(MessageError, match="number"):
        cdr.parts_encoder(Mixed)(Mixed(number=misfit))


@pytest.mark.parametrize(
    ("cls", "expected"),
    [(Image, True), (Mixed, True), (String, False), (TFMessage, False), (Imu, False)],
)
def test_only_sequences_of_numbers_and_bytes_are_pieces_of_their_own(
    cls: Any, expected: bool
) -> None:
    """All else is made anew for each message."""
    assert cdr.has_views(cls) is expected


def test_an_array_on_disk_is_encoded(tmp_path: Path) -> None:
    """A memmap is an ndarray of another class."""
    array = np.memmap(tmp_path / "numbers", np.uint16, "w+", shape=3)

    assert cdr.encode(Mixed(numbers=array)) == cdr.encode(Mixed(numbers=[0, 0, 0]))


@pytest.mark.parametrize(
    ("field", "given", "usual"),
    [
        ("number", np.int64(5), 5),
        ("real", np.float32(0.5), 0.5),
        ("real", np.float64(0.5), 0.5),
        ("real", 2, 2.0),
        ("short", Fraction(1, 2), 0.5),
        ("flag", np.True_, True),
    ],
)
def test_other_numbers_that_fit_are_encoded(field: str, given: Any, usual: Any) -> None:
    """Every computation with arrays returns numbers of numpy."""
    assert cdr.encode(Mixed(**{field: given})) == cdr.encode(Mixed(**{field: usual}))


class Words(Message, typename="test/msg/Words"):
    """Strings, and after them nothing that is aligned."""

    texts: Sequence[str] = DEFAULT


@pytest.mark.parametrize("size", [0, 1, 2, 3, 4, 62, 63, 64, 65, 66, 5000])
def test_texts_of_any_length_are_written_to_the_byte(size: int) -> None:
    """Padding between them belongs to the next one: after the last there is none."""
    message = Words(texts=["ab", "x" * size])

    encoded = cdr.encode(message)

    assert len(encoded) == 4 + 4 + (4 + 3 + 1) + (4 + size + 1)
    assert cdr.decode(Words, encoded) == message
    assert cdr.decode(Words, encoded) == message


def test_more_bytes_than_a_length_can_say_are_a_message_error() -> None:
    """A message has room for 4 GiB less one; the memory here is never touched."""
    with mmap.mmap(-1, 2**32, prot=mmap.PROT_READ) as huge:
        view: Any = memoryview(huge)
        with pytest.raises(MessageError, match="too large"):
            cdr.encode(Mixed(octets=view))
        view.release()


def test_a_nul_inside_a_text_is_kept() -> None:
    """Readers in C++ and Python get it; only those in C end there."""
    message = String(data="a\0b")

    assert cdr.decode(String, cdr.encode(message)) == message


def test_a_list_that_changes_is_encoded_as_it_is_now() -> None:
    """Strings are remembered from message to message, by value and not by object."""
    message = JointState(name=["a", "b"])
    first = cdr.encode(message)
    message.name[1] = "c"

    assert cdr.decode(JointState, cdr.encode(message)).name == ["a", "c"]
    assert cdr.decode(JointState, first).name == ["a", "b"]


FALLBACK_ERRORS: dict[str, list[Any]] = {
    "flag": [1, 0, "yes", None],
    "small": [-1, 256, True, 1.0, "1", None],
    "number": [2**31, True, 0.5, Decimal(1), np.ones(1)],
    "real": [True, "1.0", Decimal(1), np.ones(1), None, 10**400],
    "short": [1e39, False, Decimal(1)],
    "octet": [b"", b"ab", 5, "a"],
    "text": [b"abc", 5, None, "\ud800"],
    "label": ["abcde", 5],
    "point": [Vector3(), None, Point],
    "flags": [[1, 0], np.ones(2, np.uint8), [True, None]],
    "octets": ["abc", [256], np.ones(2, np.uint16), np.ones((2, 2), np.uint8)],
    "few_octets": [b"abcd"],
    "three_bytes": [b"ab", b"abcd"],
    "numbers": [[-1], [65536], np.array([0.5]), np.array([70000]), "12", b"12", 5],
    "reals": [np.zeros(2), np.zeros((3, 1)), [0.0, 0.0], [0.0, 0.0, "x"]],
    "few": [np.zeros(3, np.float32), [1e39]],
    "texts": ["abc", ["a", b"b"], ["a", "\udc00"], [1], [["a"]]],
    "two_labels": [["a"], ["abcde", ""], ["a", "b", "c"]],
    "points": [[Point(), Vector3()], [None], Point()],
    "two_points": [[Point()], [Point(), Vector3()]],
}


@pytest.mark.parametrize(
    ("field", "misfit"),
    [(field, misfit) for field, several in FALLBACK_ERRORS.items() for misfit in several],
)
def test_a_value_that_does_not_fit_is_refused_as_by_check(field: str, misfit: Any) -> None:
    """Nothing slips through because struct or numpy would take it; the error names the field."""
    message = Mixed(**{field: misfit})

    with pytest.raises(MessageError) as expected:
        check(message)
    with pytest.raises(MessageError) as caught:
        cdr.encode(message)
    assert str(caught.value) == str(expected.value)
    assert caught.value.path.startswith(f"test/msg/Mixed.{field}")


ODD = st.one_of(
    st.integers(-(2**70), 2**70),
    st.floats(),
    st.booleans(),
    st.text(max_size=5),
    st.binary(max_size=4),
    st.none(),
    st.fractions(),
    st.lists(st.one_of(st.integers(0, 300), st.floats(), st.text(max_size=5)), max_size=3),
    st.sampled_from([np.float32(1), np.uint8(1), np.False_, np.zeros(3), np.zeros(2, "u2")]),
    st.sampled_from([Decimal(1), Fraction(1, 2), bytearray(b"abc"), Point(), [Point(), Point()]]),
)


@given(message=messages(Mixed), field=st.sampled_from(list(FALLBACK_ERRORS)), odd=ODD)
@settings(max_examples=settings().max_examples * 3, deadline=None)
def test_encode_and_check_agree_on_what_fits(message: Mixed, field: str, odd: Any) -> None:
    """A message that may be published to this process may be sent to others, and no other."""
    setattr(message, field, odd)
    try:
        check(message)
    except MessageError:
        with pytest.raises(MessageError):
            cdr.encode(message)
    else:
        check(cdr.decode(Mixed, cdr.encode(message)))


def test_an_invalid_value_inside_a_sequence_is_named_with_its_index() -> None:
    """It can be found among thousands."""
    message = PoseArray()
    message.poses = [Point()]  # type: ignore[list-item] # that is what is tested

    with pytest.raises(MessageError, match=r"geometry_msgs/msg/PoseArray\.poses\[0\]"):
        cdr.encode(message)


@pytest.mark.parametrize("wrong", ["text", None, 5, String])
def test_only_messages_are_encoded(wrong: Any) -> None:
    """Anything else is a mistake of the caller."""
    with pytest.raises(TypeError):
        cdr.encode(wrong)


def test_an_encoder_takes_messages_of_its_own_class_only() -> None:
    """The error names both classes."""
    wrong: Any = String()

    with pytest.raises(TypeError, match=r"geometry_msgs/msg/Twist.*std_msgs/msg/String"):
        cdr.encoder(Twist)(wrong)


@pytest.mark.parametrize("wrong", [AddTwoInts, int, "std_msgs/msg/String"])
def test_only_message_classes_have_a_codec(wrong: Any) -> None:
    """A service is encoded by its halves."""
    with pytest.raises(TypeError):
        cdr.decode(wrong, b"\0\1\0\0")
    with pytest.raises(TypeError):
        cdr.encoder(wrong)


def test_the_functions_of_a_class_are_made_once() -> None:
    """Generating them takes a thousand times as long as running them."""
    assert cdr.encoder(String) is cdr.encoder(String)
    assert cdr.parts_encoder(String) is cdr.parts_encoder(String)
    assert cdr.decoder(String) is cdr.decoder(String)


# Decoding.


def test_the_pixels_of_an_image_are_not_copied() -> None:
    """The message holds a view of the bytes that came in."""
    encoded = cdr.encode(Image(height=1080, width=1920, step=5760, data=bytes(6_220_800)))

    image = cdr.decode(Image, encoded)

    assert isinstance(image.data, memoryview)
    assert image.data.obj is encoded
    assert image.data.readonly
    assert len(image.data) == 6_220_800


@pytest.mark.parametrize("memory", [bytes, bytearray, memoryview])
def test_arrays_are_read_only_views_of_the_data(memory: Any) -> None:
    """Without a copy, and so that one reader cannot change what another sees."""
    scan = LaserScan(header=Header(frame_id="laser"), ranges=np.arange(1000.0))
    data = memory(cdr.encode(scan))

    ranges = cdr.decode(LaserScan, data).ranges

    assert np.shares_memory(ranges, np.frombuffer(data, np.uint8))
    assert not ranges.flags.writeable
    assert ranges.dtype == np.float32
    assert ranges.dtype.isnative


def test_data_may_lie_anywhere_in_memory() -> None:
    """A bytearray, a slice of a recording, numbers, and bytes with gaps between them."""
    message = JointState(name=["a", "bc"], position=[1.0, 2.0])
    encoded = cdr.encode(message)
    gaps = bytearray(2 * len(encoded))
    gaps[::2] = encoded

    assert cdr.decode(JointState, bytearray(encoded)) == message
    assert cdr.decode(JointState, memoryview(b"xyz" + encoded)[3:]) == message
    numbers: Any = np.frombuffer(encoded, np.uint8)
    assert cdr.decode(JointState, memoryview(numbers)) == message
    assert cdr.decode(JointState, memoryview(gaps)[::2]) == message


def test_what_follows_a_message_is_not_looked_at() -> None:
    """Some writers send up to eight bytes too many."""
    encoded = cdr.encode(String(data="abc"))

    assert cdr.decode(String, encoded + b"garbage!") == String(data="abc")


def test_a_text_without_nul_and_one_without_length_are_read() -> None:
    """Both occur: Fast-CDR and others read them too."""
    without_nul = b"\0\1\0\0" + b"\x03\0\0\0abc"
    without_length = b"\0\1\0\0" + b"\0\0\0\0"

    assert cdr.decode(String, without_nul) == String(data="abc")
    assert cdr.decode(String, without_length) == String(data="")


def test_a_bool_is_true_if_it_is_not_zero() -> None:
    """In a field and in an array, where numpy would keep the 5."""
    plain = cdr.encode(Mixed(flag=True, flags=[True, False]))
    place = plain.index(b"\2\0\0\0\1\0") + 4
    odd = plain[:4] + b"\7" + plain[5:place] + b"\5" + plain[place + 1 :]

    message = cdr.decode(Mixed, odd)

    assert message.flag is True
    assert message.flags.tolist() == [True, False]
    assert message.flags.view(np.uint8).tolist() == [1, 0]
    assert not message.flags.flags.writeable


def test_texts_that_changed_are_decoded_anew() -> None:
    """The texts of the last message are remembered, for when they come again."""
    one = JointState(header=Header(frame_id="base"), name=["a", "b"])
    other = JointState(header=Header(frame_id="bass"), name=["a", "c"])

    for message in (one, one, other, one, other, other):
        assert cdr.decode(JointState, cdr.encode(message)) == message


def test_a_list_of_texts_belongs_to_its_message() -> None:
    """Changing it changes no other message."""
    encoded = cdr.encode(JointState(name=["a", "b"]))
    cdr.decode(JointState, encoded).name.append("mine")
    cdr.decode(JointState, encoded).name.append("mine")

    assert cdr.decode(JointState, encoded).name == ["a", "b"]


def test_a_known_text_that_is_cut_is_still_an_error() -> None:
    """Only whole texts are remembered."""
    encoded = cdr.encode(String(data="abc\0abc"))
    shorter = cdr.encode(String(data="abc"))
    cdr.decode(String, shorter)

    with pytest.raises(DecodeError):
        cdr.decode(String, encoded[:12])


def test_elements_of_any_size_follow_each_other() -> None:
    """In messages of variable size, each starts where the one before it ended."""
    transforms = TFMessage().transforms
    for number in range(5):
        message = TFMessage(transforms=transforms)
        assert cdr.decode(TFMessage, cdr.encode(message)) == message
        new: Any = cdr.decode(TFMessage, cdr.encode(TFMessage())).transforms
        new = [transform_named("x" * number), *transforms]
        transforms = new


def transform_named(name: str) -> Any:
    """Return a transform into a frame."""
    from aionode.interfaces.geometry_msgs.msg import TransformStamped

    return TransformStamped(header=Header(frame_id="map"), child_frame_id=name)


@pytest.mark.parametrize(
    ("cls", "data", "path", "offset", "problem"),
    [
        (String, "", "", 0, "the encapsulation header"),
        (String, "000100", "", 0, "the encapsulation header"),
        (String, "00070000 00000000", "", 0, "starts with 00 07"),
        (String, "00010000 0500", "data", 4, "the number of bytes of text"),
        (String, "00010000 05000000 616263", "data", 8, "5 bytes of text needed, 3 bytes left"),
        (String, "00010000 ffffffff 616263", "data", 8, "4294967295 bytes"),
        (Byte, "00010000", "data", 4, "1 bytes needed"),
        (Time, "00010000 00000000 0000", "nanosec", 8, "4 bytes needed"),
        (WString, "00010000 02000000 61000000", "data", 8, "2 characters"),
    ],
)
def test_data_that_cannot_be_read_is_named_with_field_and_place(
    cls: type[Message], data: str, path: str, offset: int, problem: str
) -> None:
    """The error carries what a log needs to find a sender that is wrong."""
    with pytest.raises(DecodeError, match=problem) as caught:
        cdr.decode(cls, bytes.fromhex(data))

    assert caught.value.type_name == cls.__ros_type__
    assert caught.value.path == path
    assert caught.value.offset == offset
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("cls", "data", "text"),
    [
        (String, "00010000 07000000 3830 20 b0 43 21 00", "80 \N{REPLACEMENT CHARACTER}C!"),
        (String, "00000000 00000003 61ff00", "a\N{REPLACEMENT CHARACTER}"),
        (String, "00010000 04000000 eda08000", "\N{REPLACEMENT CHARACTER}" * 3),
        (WString, "00010000 02000000 00d80000 61000000", "\N{REPLACEMENT CHARACTER}a"),
        (WString, "00010000 01000000 00001100", "\N{REPLACEMENT CHARACTER}"),
        (WString, "00010000 02000000 00d80000 00f60100", "\N{REPLACEMENT CHARACTER}\U0001f600"),
    ],
)
def test_text_that_is_no_unicode_is_decoded_with_replacements(
    cls: type[Message], data: str, text: str
) -> None:
    """Drivers in C++ send Latin-1 and cut characters in two; rclpy's generated code reads it so."""
    octets = bytes.fromhex(data)

    assert cdr.decode(cls, octets) == cls(data=text)
    assert cdr.decode(cls, memoryview(octets)) == cls(data=text)


def test_text_that_is_no_unicode_is_decoded_in_sequences_and_nested_messages() -> None:
    """The fields before and after it are unchanged."""
    message = JointState(header=Header(frame_id="xyz"), name=["abc", "def"], position=[1.0, 2.0])
    damaged = cdr.encode(message).replace(b"y", b"\xff").replace(b"e", b"\xe9")

    decoded = cdr.decode(JointState, damaged)

    assert decoded.header.frame_id == "x\N{REPLACEMENT CHARACTER}z"
    assert decoded.name == ["abc", "d\N{REPLACEMENT CHARACTER}f"]
    assert list(decoded.position) == [1.0, 2.0]


def test_text_that_is_no_unicode_is_logged_with_its_place(caplog: pytest.LogCaptureFixture) -> None:
    """Once for each tenfold number: who looks for the sender needs the field and the bytes."""

    class Units(Message, typename="test/msg/Units"):
        unit: str = DEFAULT

    octets = b"\0\1\0\0\3\0\0\0\xb0C\0"

    for _ in range(9):
        cdr.decode(Units, octets)

    assert [record.getMessage().partition("; ")[0] for record in caplog.records] == [
        "test/msg/Units.unit: a string is not valid UTF-8: b'\\xb0C'"
    ]


def test_the_path_of_an_error_has_the_index() -> None:
    """The index is that of a sequence, or of what is nested in one."""
    encoded = cdr.encode(JointState(name=["abc", "def"]))
    damaged = encoded[: encoded.index(b"def") + 1]

    with pytest.raises(DecodeError) as caught:
        cdr.decode(JointState, damaged)
    assert caught.value.path == "name[1]"
    assert caught.value.offset == damaged.index(b"d")


class Limits(Message, typename="test/msg/Limits"):
    """Bounds of each kind."""

    label: Bounded[str, 2] = DEFAULT
    wide_label: Bounded[wstring, 2] = DEFAULT
    numbers: Sequence[int32, 2] = DEFAULT
    octets: Sequence[uint8, 2] = DEFAULT
    labels: Sequence[Bounded[str, 2], 2] = DEFAULT
    times: Sequence[Time, 2] = DEFAULT


class NoLimits(Message, typename="test/msg/Limits"):
    """The same without them."""

    label: str = DEFAULT
    wide_label: wstring = DEFAULT
    numbers: Sequence[int32] = DEFAULT
    octets: Sequence[uint8] = DEFAULT
    labels: Sequence[str] = DEFAULT
    times: Sequence[Time] = DEFAULT


@pytest.mark.parametrize(
    ("values", "path"),
    [
        ({"label": "abc"}, "label"),
        ({"wide_label": "abc"}, "wide_label"),
        ({"numbers": [1, 2, 3]}, "numbers"),
        ({"octets": b"abc"}, "octets"),
        ({"labels": ["a", "abc"]}, "labels[1]"),
        ({"labels": ["a", "b", "c"]}, "labels"),
        ({"times": [Time(), Time(), Time()]}, "times"),
    ],
)
def test_more_than_a_bound_allows_is_a_decode_error(values: dict[str, Any], path: str) -> None:
    """A message that a reader gets always matches its definition."""
    encoded = cdr.encode(NoLimits(**values))

    with pytest.raises(DecodeError, match="at most 2 are allowed") as caught:
        cdr.decode(Limits, encoded)
    assert caught.value.path == path


@pytest.mark.parametrize("wrong", ["text", None, 5])
def test_only_bytes_are_decoded(wrong: Any) -> None:
    """Anything else is a mistake of the caller, not of a sender."""
    with pytest.raises(TypeError):
        cdr.decode(String, wrong)


# Wide strings.


def test_a_wide_string_is_written_as_characters_of_four_bytes() -> None:
    """As both DDS vendors of Jazzy do: the number of characters, and no NUL."""
    assert cdr.encode(WString(data="cé")).hex() == "000100000200000063000000e9000000"


def test_a_character_beyond_16_bits_is_a_pair_as_in_ros() -> None:
    """ROS holds wide strings as UTF-16, so two characters of four bytes are sent."""
    robot = WString(data="a\N{ROBOT FACE}")
    encoded = cdr.encode(robot)

    assert encoded.hex() == "0001000003000000" + "61000000" + "3ed80000" + "16dd0000"
    assert cdr.decode(WString, encoded) == robot


def test_a_whole_character_beyond_16_bits_is_read_too() -> None:
    """Writers that hold them as UTF-32 send one."""
    encoded = bytes.fromhex("0001000001000000" + "16f90100")

    assert cdr.decode(WString, encoded) == WString(data="\N{ROBOT FACE}")


class WideWords(Message, typename="test/msg/WideWords"):
    """Several of them."""

    texts: Sequence[wstring] = DEFAULT


@pytest.mark.parametrize("data", ["ffffffff", "02000000 01000000 61000000 02000000 62000000"])
def test_wide_strings_that_are_not_there_are_a_decode_error(data: str) -> None:
    """More are announced than there are bytes, or the last one is cut."""
    message = WideWords(texts=["a", "bc", ""])
    assert cdr.decode(WideWords, cdr.encode(message)) == message

    with pytest.raises(DecodeError, match="texts"):
        cdr.decode(WideWords, bytes.fromhex("00010000" + data))


# Unusual types.


def made(name: str, annotations: dict[str, Any]) -> Any:
    """Return a message class with these fields."""
    return new_class(
        name,
        (Message,),
        {"typename": f"test/msg/{name}"},
        lambda namespace: namespace.update(__annotations__=annotations),
    )


def test_a_message_may_be_nested_a_hundred_times() -> None:
    """No definition makes the generated code too deep for Python."""
    cls: Any = Time
    for depth in range(100):
        cls = made(f"Level{depth}", {"before": uint8, "inner": cls, "after": str})

    message = cls(after="outer")

    assert cdr.decode(cls, cdr.encode(message)) == message
    assert decode_slowly(cls, memoryview(cdr.encode(message))) == message


def test_no_name_of_a_class_gets_into_the_generated_code() -> None:
    """Names of types and fields are checked; what a class is called in Python is not."""
    cls: Any = type(Message)
    odd = cls("x(); import os", (Message,), {"__annotations__": {"a": str}}, typename="test/msg/X")

    assert cdr.decode(odd, cdr.encode(odd(a="b"))) == odd(a="b")


def test_a_message_may_have_a_thousand_fields() -> None:
    """More than Python once allowed as arguments of a call."""
    cls = made("Large", {f"f{number}": (float64, str)[number % 2] for number in range(999)})
    message = cls(f998=0.5, f1="a")

    assert cdr.decode(cls, cdr.encode(message)) == message


@pytest.mark.slow
def test_definitions_that_double_at_each_level_make_little_code() -> None:
    """Nested messages are only unfolded while they are small."""
    cls: Any = Time
    for depth in range(12):
        cls = made(f"Twice{depth}", {"one": cls, "two": cls})

    message = cls()

    assert len(cdr.encode(message)) == 4 + 2**12 * 8
    assert cdr.decode(cls, cdr.encode(message)) == message
