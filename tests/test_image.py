"""Images as numpy arrays and PIL images, with cv_bridge's encodings."""

from __future__ import annotations

import contextlib
import io
import struct
import sys
import tracemalloc
from typing import Any
from unittest import mock

import numpy as np
import numpy.typing as npt
import PIL.Image
import PIL.PngImagePlugin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.wire.cdr import decode, encode
from aionode.errors import MessageError
from aionode.image import (
    compress,
    compress_depth,
    decompress,
    from_numpy,
    from_pil,
    to_numpy,
    to_pil,
)
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import check

HEADER = Header(frame_id="camera")
BGR = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)


@pytest.mark.parametrize(
    ("encoding", "dtype", "channels"),
    [
        ("mono8", np.uint8, 1),
        ("mono16", np.uint16, 1),
        ("rgb8", np.uint8, 3),
        ("bgr8", np.uint8, 3),
        ("rgba8", np.uint8, 4),
        ("bgra16", np.uint16, 4),
        ("8UC1", np.uint8, 1),
        ("8UC3", np.uint8, 3),
        ("16SC1", np.int16, 1),
        ("32SC2", np.int32, 2),
        ("32FC1", np.float32, 1),
        ("64FC10", np.float64, 10),
        ("bayer_rggb8", np.uint8, 1),
        ("bayer_grbg16", np.uint16, 1),
        ("yuv422_yuy2", np.uint8, 2),
    ],
)
def test_each_encoding_comes_back_as_it_was(encoding: str, dtype: type, channels: int) -> None:
    """Through the wire."""
    shape = (2, 3) if channels == 1 else (2, 3, channels)
    pixels: npt.NDArray[Any] = np.arange(6 * channels).reshape(shape).astype(dtype)

    image = decode(Image, encode(from_numpy(pixels, encoding, HEADER)))

    assert (image.height, image.width, image.encoding) == (2, 3, encoding)
    assert image.step == 3 * channels * np.dtype(dtype).itemsize
    assert image.header.frame_id == "camera"
    assert to_numpy(image).dtype == dtype
    assert np.array_equal(to_numpy(image), pixels)


def test_neither_way_copies_pixels() -> None:
    """A camera sends thirty of them in a second; the order of colours is a view as well."""
    image = from_numpy(BGR, "bgr8")

    assert np.shares_memory(np.asarray(image.data), BGR)
    assert np.shares_memory(to_numpy(image), BGR)
    assert np.shares_memory(to_numpy(image, "rgb8"), BGR)
    check(image)


def test_rows_may_be_padded() -> None:
    """`step` says where each begins."""
    rows = b"".join(row.tobytes() + b"\xff" * 7 for row in BGR)

    image = Image(height=2, width=3, encoding="bgr8", step=16, data=rows)

    assert np.array_equal(to_numpy(image), BGR)


def test_a_part_of_an_image_is_put_into_one_piece() -> None:
    """A message must not contain the pixels between its rows."""
    part = from_numpy(BGR[:, 1:], "bgr8")

    assert part.step == 6
    assert np.array_equal(to_numpy(part), BGR[:, 1:])


def test_the_highest_byte_may_be_first() -> None:
    """In what is read, and in what is made."""
    depth = np.array([[1, 256]], ">u2")

    image = from_numpy(depth, "mono16")

    assert image.is_bigendian == 1
    assert to_numpy(image).tolist() == [[1, 256]]


def test_passthrough_takes_the_type_of_opencv() -> None:
    """As cv_bridge does, which cannot know the colours either."""
    assert from_numpy(BGR).encoding == "8UC3"
    assert from_numpy(np.zeros((2, 2), np.float32)).encoding == "32FC1"


@pytest.mark.parametrize(
    ("have", "want", "pixel", "result"),
    [
        ("bgr8", "rgb8", [1, 2, 3], [3, 2, 1]),
        ("rgb8", "bgr8", [1, 2, 3], [3, 2, 1]),
        ("rgba8", "bgra8", [1, 2, 3, 4], [3, 2, 1, 4]),
        ("rgba8", "bgr8", [1, 2, 3, 4], [3, 2, 1]),
        ("bgr8", "rgba8", [1, 2, 3], [3, 2, 1, 255]),
        ("bgr8", "8UC3", [1, 2, 3], [1, 2, 3]),
        ("rgb8", "mono8", [255, 0, 0], 76),
        ("mono8", "rgb8", 7, [7, 7, 7]),
        ("mono16", "bgra16", 7, [7, 7, 7, 65535]),
    ],
)
def test_colours_come_in_the_order_that_is_wanted(
    have: str, want: str, pixel: Any, result: Any
) -> None:
    """Each library assumes its own order."""
    dtype = np.uint16 if "16" in have else np.uint8
    image = from_numpy(np.array([[pixel]], dtype), have)

    assert to_numpy(image, want)[0, 0].tolist() == result


# PIL and compressed images


@pytest.mark.parametrize("mode", ["L", "RGB", "RGBA", "I;16", "F"])
def test_a_pil_image_comes_back_as_it_was(mode: str) -> None:
    """Every mode that has an encoding."""
    picture = PIL.Image.new(mode, (3, 2))

    back = to_pil(from_pil(picture, HEADER))

    assert (back.mode, back.size) == (mode, (3, 2))
    assert back.tobytes() == picture.tobytes()


def test_pil_gets_colours_in_its_order() -> None:
    """Cameras of OpenCV send bgr8, PIL has RGB."""
    image = from_numpy(np.array([[[1, 2, 3]]], np.uint8), "bgr8")

    assert to_pil(image).getpixel((0, 0)) == (3, 2, 1)


def test_a_palette_becomes_colours() -> None:
    """Pictures of the web have one."""
    picture = PIL.Image.new("RGB", (2, 2), (9, 8, 7)).convert(
        "P", palette=PIL.Image.Palette.ADAPTIVE
    )

    assert to_numpy(from_pil(picture))[0, 0].tolist() == [9, 8, 7]


@pytest.mark.parametrize("encoding", ["mono8", "rgb8", "rgba8", "mono16"])
def test_png_loses_nothing(encoding: str) -> None:
    """Depth in 16 bits included."""
    dtype = np.uint16 if encoding == "mono16" else np.uint8
    shape = {"rgb8": (4, 4, 3), "rgba8": (4, 4, 4)}.get(encoding, (4, 4))
    image = from_numpy(np.arange(np.prod(shape)).reshape(shape).astype(dtype), encoding, HEADER)

    compressed = compress(image, "png")

    assert compressed.format == "png"
    assert decompress(compressed) == image


def test_jpeg_is_a_picture_for_browsers() -> None:
    """Smaller than it was, and almost the same."""
    image = from_numpy(np.full((64, 64, 3), 100, np.uint8), "bgr8", HEADER)

    compressed = compress(image, quality=90)

    assert compressed.format == "jpeg"
    assert bytes(compressed.data[:3]) == b"\xff\xd8\xff"
    assert len(compressed.data) < len(image.data) / 4
    assert np.abs(to_numpy(decompress(compressed)).astype(int) - 100).max() < 3


# Mistakes


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"data": b"123"}, r"\.data: 3 bytes, but 2 rows of 9 need 18"),
        ({"step": 8}, r"\.step: 8, but 3 pixels of bgr8 need 9 bytes"),
        ({"encoding": "hsv8"}, r"\.encoding: 'hsv8' is unknown; use one such as mono8"),
    ],
)
def test_an_image_that_contradicts_itself_names_the_field(
    values: dict[str, Any], text: str
) -> None:
    """Messages of other programs are checked before they are read."""
    image = from_numpy(BGR, "bgr8")
    for name, value in values.items():
        setattr(image, name, value)

    with pytest.raises(MessageError, match=text):
        to_numpy(image)


def test_mistakes_say_what_fits() -> None:
    """Each names what was given."""
    with pytest.raises(TypeError, match=r"CompressedImage given.*`decompress`"):
        to_numpy(CompressedImage())  # type: ignore[arg-type]  # the mistake
    with pytest.raises(ValueError, match="32FC1 cannot become mono8"):
        to_numpy(from_numpy(np.zeros((1, 1), np.float32)), "mono8")
    with pytest.raises(ValueError, match="4 channels of uint8; bgr8 has 3 of uint8"):
        from_numpy(np.zeros((1, 1, 4), np.uint8), "bgr8")
    with pytest.raises(ValueError, match=r"shape \(3,\)"):
        from_numpy(np.zeros(3, np.uint8))
    with pytest.raises(ValueError, match="from_numpy: int64; use one of uint8"):
        from_numpy(np.zeros((1, 1), np.int64))
    with pytest.raises(ValueError, match="PIL has no mode for 8UC3"):
        to_pil(from_numpy(BGR))
    with pytest.raises(ValueError, match=r"mode CMYK.*convert"):
        from_pil(PIL.Image.new("CMYK", (1, 1)))
    with pytest.raises(ValueError, match="mono16 cannot be written as 'jpeg'"):
        compress(from_numpy(np.zeros((1, 1), np.uint16), "mono16"))
    with pytest.raises(MessageError, match=r"cannot be read as an image.*'png'"):
        decompress(CompressedImage(format="png", data=b"nothing"))


def test_pictures_that_start_a_program_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pillow gives EPS to Ghostscript, and what a robot hears may come from anyone."""
    started: list[object] = []
    monkeypatch.setattr("PIL.EpsImagePlugin.Ghostscript", lambda *given: started.append(given))
    file = io.BytesIO()
    PIL.Image.new("RGB", (2, 2)).save(file, "EPS")

    with pytest.raises(MessageError, match="cannot be read as an image"):
        decompress(CompressedImage(format="jpeg", data=file.getvalue()))

    assert not started


def test_without_pillow_the_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numpy alone needs none."""
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    image = from_numpy(BGR, "bgr8")

    with pytest.raises(ModuleNotFoundError, match="pip install pillow"):
        to_pil(image)


@pytest.mark.parametrize("encoding", ["16UC1", "32FC1"])
def test_compressed_depth_is_read(encoding: str) -> None:
    """As image_transport writes it: millimetres, or the inverse of metres, behind 12 bytes."""
    pixels = np.array([[0, 500], [1000, 2000]], np.uint16)
    file = compress(from_numpy(pixels, "mono16"), "png")
    head = struct.pack("<iff", 0, 4000.0, -500.0)
    message = CompressedImage(format=f"{encoding}; compressedDepth png", data=head + file.data)

    depth = decompress(message)

    expected = pixels if encoding == "16UC1" else [[np.nan, 4.0], [4000 / 1500, 1.6]]
    assert depth.encoding == encoding
    np.testing.assert_allclose(to_numpy(depth), expected, rtol=1e-6)


DEPTHS = st.floats(0.1875, 9.875, width=32)
"""Metres that 16 bits of inverse depth hold with the usual quantization."""


@given(st.lists(DEPTHS, min_size=1, max_size=9))
def test_metres_come_back_from_compressed_depth(metres: list[float]) -> None:
    """As exactly as the quantization says: steps of 1/10100 of inverse metres."""
    image = from_numpy(np.array([metres], np.float32), "32FC1")

    found = to_numpy(decompress(compress_depth(image)))[0]

    assert np.abs(1 / found - 1 / np.array(metres)).max() < 1.2 / 10100


def test_depths_that_cannot_be_told_are_unknown_in_compressed_depth() -> None:
    """Too far or too near, none, or no depth at all: image_transport's overflow is no depth."""
    image = from_numpy(np.array([[10.0, 0.1, 0.0, -1.0, np.nan, np.inf]], np.float32), "32FC1")

    assert np.isnan(to_numpy(decompress(compress_depth(image)))).all()


def test_compressed_depth_is_written_as_image_transport_writes_it() -> None:
    """Its header, quantization and truncation, computed by its code for 1 m, 2.5 m and 10 m."""
    image = from_numpy(np.array([[1.0, 2.5, 9.99]], np.float32), "32FC1", Header(frame_id="eye"))
    message = compress_depth(image)

    assert message.format == "32FC1; compressedDepth png"
    assert message.header.frame_id == "eye"
    assert struct.unpack_from("<iff", message.data) == (0, 10100.0, -1009.0)
    picture = decompress(CompressedImage(format="png", data=bytes(message.data)[12:]))
    assert to_numpy(picture).tolist() == [[9091, 3031, 2]]


@pytest.mark.parametrize("encoding", ["16UC1", "mono16"])
def test_millimetres_stay_as_they_are_up_to_the_greatest_depth(encoding: str) -> None:
    """Beyond it they are 0, which is unknown."""
    image = from_numpy(np.array([[0, 1500, 3000, 3001]], np.uint16), encoding)
    message = compress_depth(image, depth_max=3.0)

    assert message.format == f"{encoding}; compressedDepth png"
    assert to_numpy(decompress(message)).tolist() == [[0, 1500, 3000, 0]]


def test_colours_are_no_depth() -> None:
    """The error says what is."""
    with pytest.raises(ValueError, match="bgr8 is not for depths; use 16UC1, mono16 or 32FC1"):
        compress_depth(from_numpy(BGR, "bgr8"))


def rvl(width: int, height: int, pixels: list[int]) -> bytes:
    """Compress depths as image_transport's RVL does, number by number."""
    nibbles: list[int] = []

    def write(number: int) -> None:
        while True:
            rest = number >> 3
            nibbles.append(number & 7 | 8 * (rest > 0))
            number = rest
            if not number:
                return

    at, before = 0, 0
    while at < len(pixels):
        start = at
        while at < len(pixels) and not pixels[at]:
            at += 1
        write(at - start)
        start = at
        while at < len(pixels) and pixels[at]:
            at += 1
        write(at - start)
        for pixel in pixels[start:at]:
            delta = pixel - before
            write(delta << 1 if delta >= 0 else (-delta << 1) - 1)
            before = pixel
    nibbles += [0] * (-len(nibbles) % 8)
    text = "".join(f"{nibble:x}" for nibble in nibbles)
    words = [int(text[i : i + 8], 16) for i in range(0, len(text), 8)]
    return struct.pack(f"<II{len(words)}I", width, height, *words)


@given(st.lists(st.one_of(st.just(0), st.integers(0, 65535)), min_size=1, max_size=60))
def test_rvl_is_read_as_it_was_written(pixels: list[int]) -> None:
    """Without loss: runs of unknown depths, and large steps in both directions, in all blocks."""
    data = bytes(12) + rvl(len(pixels), 1, pixels)

    with mock.patch("aionode.image.BLOCK_BYTES", 4):
        read = decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=data))

    assert (read.encoding, to_numpy(read).tolist()) == ("16UC1", [pixels])


def test_rvl_of_metres_is_inverse_depth() -> None:
    """As with PNG, 32 bits are decoded from 16."""
    data = struct.pack("<iff", 1, 10100.0, -1009.0) + rvl(2, 2, [0, 9091, 1, 0])

    read = to_numpy(decompress(CompressedImage(format="32FC1; compressedDepth rvl", data=data)))

    assert read.shape == (2, 2)
    assert np.isnan(read[0, 0])
    assert read[0, 1] == np.float32(10100.0) / np.float32(9091 + 1009)


def test_a_large_rvl_picture_is_read_and_a_bomb_is_not() -> None:
    """A few bytes stand for any number of unknown depths."""
    unknown = bytes(12) + rvl(640, 480, [0] * (640 * 480))
    assert not to_numpy(
        decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=unknown))
    ).any()
    bomb = bytes(12) + struct.pack("<II", 65535, 65535) + unknown[20:]
    with pytest.raises(MessageError, match="not an RVL picture"):
        decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=bomb))


@pytest.mark.parametrize("side", [1, 2000], ids=["long", "without progress"])
def test_rvl_takes_no_more_memory_than_its_picture_needs(side: int) -> None:
    """Bytes after a picture, and runs of no pixels at all, are not unpacked as a whole."""
    data = bytes(12) + struct.pack("<II", side, side) + bytes(1 << 20)
    tracemalloc.start()
    try:
        with pytest.raises(MessageError, match="not an RVL picture"):
            decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=data))
        assert tracemalloc.get_traced_memory()[1] < 40 << 20
    finally:
        tracemalloc.stop()


@pytest.mark.slow
def test_many_short_runs_of_rvl_take_no_more_memory_than_their_picture() -> None:
    """Hostile data have one for every pixel, and a number for every nibble."""
    runs = bytes.fromhex("1110") * (1 << 17)  # no depth, depth, its difference; then depth alone
    data = bytes(12) + struct.pack("<II", 1 << 9, 3 << 8) + runs
    tracemalloc.start()
    try:
        with contextlib.suppress(MessageError):
            decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=data))
        assert tracemalloc.get_traced_memory()[1] < 16 << 20
    finally:
        tracemalloc.stop()


def test_rvl_of_another_size_than_wanted_is_not_decoded() -> None:
    """As of the other formats."""
    data = bytes(12) + struct.pack("<II", 2000, 2000) + bytes(8)
    with pytest.raises(MessageError, match="2000 by 2000 pixels; 640 by 480 are expected"):
        decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=data), (640, 480))


@given(st.binary(max_size=80), st.integers(0, 9), st.integers(0, 9))
def test_damaged_rvl_is_one_error(data: bytes, width: int, height: int) -> None:
    """Otherwise it is a picture of the size that it claims."""
    whole = bytes(12) + struct.pack("<II", width, height) + data
    try:
        read = decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=whole))
    except MessageError:
        return
    assert (read.width, read.height) == (width, height)


@pytest.mark.parametrize("data", [b"", b"short", bytes(12), bytes(12) + b"RVL", bytes(40)])
def test_compressed_depth_without_a_picture_is_an_error(data: bytes) -> None:
    """The error has the format that the message gives."""
    with pytest.raises(MessageError, match="compressedDepth rvl"):
        decompress(CompressedImage(format="16UC1; compressedDepth rvl", data=data))


def test_depth_of_eight_bits_is_an_error() -> None:
    """It would be a guess in which unit it is."""
    file = compress(from_numpy(np.zeros((2, 2), np.uint8), "mono8"), "png")

    with pytest.raises(MessageError, match="16 bits"):
        decompress(CompressedImage(format="16UC1; compressedDepth", data=bytes(12) + file.data))


def test_a_picture_of_another_size_than_wanted_is_not_decoded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its file is small, and its pixels would take any amount of memory."""
    file = compress(from_numpy(np.zeros((400, 500), np.uint8), "mono8"), "png")
    assert decompress(file, (500, 400)).width == 500
    monkeypatch.delattr(PIL.PngImagePlugin.PngImageFile, "load_prepare")
    with pytest.raises(MessageError, match="500 by 400 pixels; 640 by 480 are expected"):
        decompress(file, (640, 480))


def test_a_picture_that_is_too_large_to_be_meant_is_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A small file can have any number of pixels: Pillow's limit holds."""
    file = compress(from_numpy(np.zeros((9, 9), np.uint8), "mono8"), "png")
    monkeypatch.setattr(PIL.Image, "MAX_IMAGE_PIXELS", 40)

    with pytest.raises(MessageError, match="decompression bomb"):
        decompress(file)
