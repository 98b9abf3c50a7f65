"""`cv_bridge`, as programs use it."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

from cv_bridge import CvBridge, CvBridgeError, cvtColorForDisplay, getCvType
from cv_bridge.boost import cv_bridge_boost
from rosidl_generator_py import message_class

Header = message_class("std_msgs/msg/Header")
Image = message_class("sensor_msgs/msg/Image")
CompressedImage = message_class("sensor_msgs/msg/CompressedImage")

BRIDGE = CvBridge()


def pixels(*shape: int, dtype: str = "uint8") -> Any:
    """An image of random values."""
    return np.random.default_rng(0).integers(0, 255, shape).astype(dtype)


@pytest.mark.parametrize(
    "dtype", ["uint8", "int8", "uint16", "int16", "int32", "float32", "float64"]
)
@pytest.mark.parametrize("channels", [(), (1,), (2,), (3,), (4,), (5,)])
def test_an_image_is_the_same_after_a_message(dtype: str, channels: tuple[int, ...]) -> None:
    """Whatever its type; a single channel has no dimension of its own."""
    image = pixels(4, 6, *channels, dtype=dtype)

    message = BRIDGE.cv2_to_imgmsg(image)
    back = BRIDGE.imgmsg_to_cv2(message)

    assert type(message) is Image
    assert (message.height, message.width) == (4, 6)
    assert message.step * 4 == len(message.data)
    assert back.dtype == image.dtype
    assert np.array_equal(back, image[..., 0] if channels == (1,) else image)


def test_the_encoding_is_that_of_opencv_unless_given() -> None:
    """An array does not show the names of its channels."""
    header = Header(frame_id="camera")

    plain = BRIDGE.cv2_to_imgmsg(pixels(4, 6, 3))
    named = BRIDGE.cv2_to_imgmsg(pixels(4, 6, 3), "bgr8", header)

    assert (plain.encoding, named.encoding, named.header.frame_id) == ("8UC3", "bgr8", "camera")


def test_the_other_order_of_bytes_is_kept_in_the_message_and_undone_in_the_image() -> None:
    """Programs compute with the values."""
    image = pixels(3, 4).astype(">i4")

    message = BRIDGE.cv2_to_imgmsg(image)
    back = BRIDGE.imgmsg_to_cv2(message)

    assert message.is_bigendian
    assert back.dtype.isnative
    assert np.array_equal(back, image)


def test_padding_of_rows_is_left_out() -> None:
    """Cameras pad rows to a multiple of 4 or 16 bytes, which need not be whole pixels."""
    message = Image(encoding="rgb8", height=2, width=1, step=4, data=bytes(range(8)))

    assert BRIDGE.imgmsg_to_cv2(message).tolist() == [[[0, 1, 2]], [[4, 5, 6]]]


def test_the_pixels_are_those_of_the_message() -> None:
    """A camera sends some megabytes at a time."""
    message = BRIDGE.cv2_to_imgmsg(pixels(4, 6, 3), "bgr8")

    BRIDGE.imgmsg_to_cv2(message)[0, 0, 0] = 99

    assert message.data[0] == 99


@pytest.mark.parametrize(
    ("encoding", "desired", "found"),
    [
        ("rgb8", "bgr8", [[[3, 2, 1]]]),
        ("rgb8", "bgra8", [[[3, 2, 1, 255]]]),
        ("bgra8", "rgb8", [[[3, 2, 1]]]),
        ("mono8", "bgr8", [[[1, 1, 1]]]),
        ("mono8", "rgba8", [[[1, 1, 1, 255]]]),
        ("mono8", "mono16", [[257]]),
        ("mono16", "mono8", [[0]]),
        ("rgb16", "bgra8", [[[0, 0, 0, 255]]]),
        ("rgb8", "8UC3", [[[1, 2, 3]]]),
        ("8UC3", "32FC3", [[[1.0, 2.0, 3.0]]]),
        ("32FC1", "8UC1", [[1]]),
        ("bgr8", "bgr8", [[[1, 2, 3]]]),
    ],
)
def test_colours_and_depths_are_converted_without_opencv(
    encoding: str, desired: str, found: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """OpenCV's package is larger than all the rest, and these are the usual conversions."""
    monkeypatch.setitem(sys.modules, "cv2", None)
    dtype, channels = BRIDGE.encoding_to_dtype_with_channels(encoding)
    image = np.array([[[1, 2, 3, 4][:channels]]], dtype=dtype)

    converted = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(image, encoding), desired)

    assert converted.tolist() == found
    assert converted.dtype == BRIDGE.encoding_to_dtype_with_channels(desired)[0]


def test_values_beyond_a_type_are_its_limits() -> None:
    """OpenCV saturates, whereas numpy wraps around; halves are rounded to even."""
    image = np.array([[-5.0, 2.5, 3.5, 300.0, np.nan]], np.float32)

    converted = BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(image), "8UC1")

    assert converted.tolist() == [[0, 2, 4, 255, 0]]


@pytest.mark.parametrize(
    ("encoding", "desired", "text"),
    [
        (
            "16UC1",
            "mono16",
            "[16UC1] is not a color format. but [mono16] is. The conversion does not make sense",
        ),
        ("8UC3", "32FC1", "[8UC3] and [32FC1] do not have the same number of channel"),
        (
            "bgr8",
            "8UC1",
            (
                "[bgr8] is a color format but [8UC1] is not so they must have the same OpenCV "
                "type, CV_8UC3, CV16UC1 ...."
            ),
        ),
        ("bgr8", "bayer_rggb8", "Unsupported conversion from [bgr8] to [bayer_rggb8]"),
        ("bayer_rggb8", "rgba8", "Unsupported conversion from [bayer_rggb8] to [rgba8]"),
        ("bgr8", "grey", "Unrecognized image encoding [grey]"),
    ],
)
def test_a_conversion_that_makes_no_sense_is_refused_in_the_words_of_cv_bridge(
    encoding: str, desired: str, text: str
) -> None:
    """People search for these lines."""
    dtype, channels = BRIDGE.encoding_to_dtype_with_channels(encoding)
    message = BRIDGE.cv2_to_imgmsg(pixels(2, 2, channels, dtype=dtype), encoding)

    with pytest.raises(CvBridgeError) as raised:
        BRIDGE.imgmsg_to_cv2(message, desired)

    assert str(raised.value) == text


def test_an_image_of_another_type_than_its_encoding_is_refused() -> None:
    """A message that says rgba8 with three channels could not be read."""
    with pytest.raises(
        CvBridgeError, match="encoding specified as rgba8, but image has incompatible type 8UC3"
    ):
        BRIDGE.cv2_to_imgmsg(pixels(2, 2, 3), "rgba8")


@pytest.mark.parametrize("convert", [BRIDGE.cv2_to_imgmsg, BRIDGE.cv2_to_compressed_imgmsg])
def test_only_arrays_are_images(convert: Any) -> None:
    """A list, or the result of an `imread` that found nothing."""
    with pytest.raises(TypeError, match="Your input type is not a numpy array"):
        convert(None)


@pytest.mark.parametrize("data", [b"", bytes(242)])
def test_a_message_with_too_little_data_is_refused(data: bytes) -> None:
    """No peer is trusted; numpy does not check the size of an empty buffer."""
    with pytest.raises(TypeError, match="its size needs 243"):
        BRIDGE.imgmsg_to_cv2(Image(encoding="rgb8", height=9, width=9, step=27, data=data))


def test_encodings_have_the_numbers_of_opencv() -> None:
    """Programs compare them with `cv2.CV_8UC3` and the like."""
    numbers = [getCvType(name) for name in ("8UC1", "8U", "bgr8", "16UC1", "32FC4", "yuv422")]

    assert numbers == [0, 0, 16, 2, 29, 8]
    assert (cv_bridge_boost.CV_MAT_CNWrap(29), cv_bridge_boost.CV_MAT_DEPTHWrap(29)) == (4, 5)
    assert BRIDGE.cvtype_to_name[16] == "8UC3"


def test_what_needs_opencv_says_so_when_it_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    """It does not do so before: most programs only pass images on."""
    monkeypatch.setitem(sys.modules, "cv2", None)

    with pytest.raises(ModuleNotFoundError, match="cv2"):
        BRIDGE.imgmsg_to_cv2(BRIDGE.cv2_to_imgmsg(pixels(2, 2, 3), "bgr8"), "mono8")
    with pytest.raises(ModuleNotFoundError, match="cv2"):
        BRIDGE.cv2_to_compressed_imgmsg(pixels(2, 2, 3))


def test_an_image_for_a_screen_is_scaled_or_coloured() -> None:
    """Depths and labels cannot be seen directly."""
    depths = np.array([[0.0, 1.0, np.inf]], np.float32)
    labels = np.arange(12, dtype=np.int32).reshape(3, 4)

    scaled = cvtColorForDisplay(depths, "32FC1", "mono8", do_dynamic_scaling=True)
    coloured = cvtColorForDisplay(labels, "32SC1", "bgr8")

    assert scaled.tolist() == [[0, 255, 255]]
    assert coloured.dtype == np.uint8
    assert (coloured.min(), coloured.max()) == (0, 255)
    assert len({tuple(colour) for row in coloured.tolist() for colour in row}) == 12
    assert coloured[0, 0].tolist() == [0, 0, 0]


# With OpenCV, where it is installed


@pytest.mark.parametrize("ending", ["jpg", "png", "bmp", "tiff"])
@pytest.mark.parametrize("channels", [(), (3,)])
def test_an_image_is_compressed_and_read_again(ending: str, channels: tuple[int, ...]) -> None:
    """The message has the format of the file extension."""
    pytest.importorskip("cv2")
    image = pixels(8, 8, *channels)

    message = BRIDGE.cv2_to_compressed_imgmsg(image, ending)
    back = BRIDGE.compressed_imgmsg_to_cv2(message)

    assert type(message) is CompressedImage
    assert message.format == ending
    assert (back.shape, back.dtype) == (image.shape, image.dtype)
    assert ending == "jpg" or np.array_equal(back, image)
    assert BRIDGE.compressed_imgmsg_to_cv2(message, "mono8").shape == (8, 8)


def test_data_that_is_no_image_is_refused() -> None:
    """A camera that fails in the middle sends such data."""
    pytest.importorskip("cv2")

    with pytest.raises(CvBridgeError, match="5 bytes of the format 'jpeg' are no image"):
        BRIDGE.compressed_imgmsg_to_cv2(CompressedImage(format="jpeg", data=b"hello"))


@pytest.mark.parametrize("encoding", ["bgr8", "rgba8", "bayer_rggb8", "yuv422", "yuv422_yuy2"])
def test_colours_become_grey_by_opencv(encoding: str) -> None:
    """Its weights and roundings are not numpy's."""
    pytest.importorskip("cv2")
    _, channels = BRIDGE.encoding_to_dtype_with_channels(encoding)
    message = BRIDGE.cv2_to_imgmsg(pixels(4, 4, channels), encoding)

    assert BRIDGE.imgmsg_to_cv2(message, "mono8").shape == (4, 4)
    assert BRIDGE.imgmsg_to_cv2(message, "mono16").dtype == np.uint16
