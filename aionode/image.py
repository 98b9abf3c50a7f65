"""Convert Image and CompressedImage messages to numpy arrays and PIL images, and back.

`to_numpy` is cv_bridge's ``imgmsg_to_cv2``, and `from_numpy` its ``cv2_to_imgmsg``; the arrays have
OpenCV's layout, and the encodings are those of cv_bridge. Where possible an array is a view of the
message's own bytes, and read-only if they are, as in a received message; copy it to change it.
`to_pil`, `from_pil`, `compress` and `decompress` need Pillow.
"""

from __future__ import annotations

import io
import re
import struct
from array import array
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode.errors import MessageError
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image
from aionode.interfaces.std_msgs.msg import Header

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import ModuleType

    import numpy.typing as npt
    from PIL.Image import Image as PILImage

__all__ = [
    "compress",
    "compress_depth",
    "decompress",
    "encoding_of",
    "from_numpy",
    "from_pil",
    "to_numpy",
    "to_pil",
]

DEPTH_HEAD: Final = struct.Struct("<iff")
"""The header that compressedDepth puts before its picture: a format and the depth quantization."""

FORMATS: Final = ("BMP", "JPEG", "PNG", "TIFF", "WEBP")
"""The formats of compressed images. Pillow reads many more, EPS by starting Ghostscript."""

RVL_HEAD: Final = struct.Struct("<II")
"""The width and height before an RVL picture."""
MAX_PIXELS: Final = 2**23
"""Maximum pixels of an RVL picture, as a few bytes can stand for any number of zeros; no depth
camera has as many pixels.
"""
MAX_NIBBLES: Final = 9
"""Maximum nibbles of a number: enough for `MAX_PIXELS` zeros."""
BLOCK_BYTES: Final = 2**16
"""How many bytes of RVL are unpacked at a time."""

COLORS = {"mono": "m", "rgb": "rgb", "bgr": "bgr", "rgba": "rgba", "bgra": "bgra"}
"""The channels of colour encodings, one letter each."""

YUV = {"yuv422", "yuv422_yuy2", "uyvy", "yuyv"}
"""Encodings with two bytes per pixel, in which pairs of pixels share their colour."""

OPENCV_TYPES = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}

PIL_ENCODINGS = {"L": "mono8", "RGB": "rgb8", "RGBA": "rgba8", "I;16": "mono16", "F": "32FC1"}


def encoding_of(encoding: str) -> tuple[np.dtype[Any], int]:
    """Return the dtype of a channel and the number of channels of a pixel.

    The known encodings are ``mono``, ``rgb``, ``bgr``, ``rgba`` and ``bgra`` with 8 and 16 bits,
    OpenCV's types such as ``8UC3`` and ``32FC1``, the Bayer patterns such as ``bayer_rggb8``,
    ``yuv422`` and ``yuv422_yuy2``.

    Raises:
        MessageError: the encoding is unknown (a ValueError).
    """
    if match := re.fullmatch(r"(mono|rgba?|bgra?)(8|16)", encoding):
        return np.dtype(f"uint{match[2]}"), len(COLORS[match[1]])
    if match := re.fullmatch(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([1-9]\d*))?", encoding):
        return np.dtype(OPENCV_TYPES[match[1]]), int(match[2] or 1)
    if match := re.fullmatch(r"bayer_(?:rggb|bggr|gbrg|grbg)(8|16)", encoding):
        return np.dtype(f"uint{match[1]}"), 1
    if encoding in YUV:
        return np.dtype(np.uint8), 2
    raise MessageError(
        "sensor_msgs/msg/Image.encoding",
        f"{encoding!r} is unknown; use one such as mono8, rgb8, bgr8, rgba8, mono16, 8UC3, 32FC1, "
        "bayer_rggb8 or yuv422",
    )


def colors_of(encoding: str) -> str:
    """Return the letters of the colour channels, such as ``bgr``; empty if there are none."""
    match = re.fullmatch(r"(mono|rgba?|bgra?)(8|16)", encoding)
    return COLORS[match[1]] if match else ""


# numpy


def to_numpy(image: Image, desired_encoding: str = "passthrough") -> npt.NDArray[Any]:
    """Return the pixels as an array of rows, columns and, with several channels, channels.

    The pixels are copied only to convert between grey and colour, or to add an alpha channel. Row
    padding and a different order of colours need no copy.

    Args:
        image: The message.
        desired_encoding: The order of colours, such as ``bgr8`` (OpenCV) or ``rgb8``;
            ``passthrough`` keeps that of the message. The bit depth cannot be changed.

    Raises:
        TypeError: `image` is not an Image.
        MessageError: its data is too short for its size, or its encoding is unknown (a ValueError).
        ValueError: it cannot be converted to `desired_encoding`.
    """
    if not isinstance(image, Image):
        raise TypeError(
            f"to_numpy: {type(image).__name__} given; a sensor_msgs/msg/Image is needed, and "
            "`decompress` makes one of a CompressedImage"
        )
    pixels = pixels_of(image)
    if desired_encoding in ("passthrough", image.encoding):
        return pixels
    return converted(pixels, image.encoding, desired_encoding)


def pixels_of(image: Image) -> npt.NDArray[Any]:
    """Return the pixels unconverted, as a view of the message's bytes."""
    dtype, channels = encoding_of(image.encoding)
    dtype = dtype.newbyteorder(">" if image.is_bigendian else "<")
    shape = (image.height, image.width, channels)
    pixel = dtype.itemsize * channels
    row = image.width * pixel
    if image.height and image.step < row:
        raise MessageError(
            "sensor_msgs/msg/Image.step",
            f"{image.step}, but {image.width} pixels of {image.encoding} need {row} bytes",
        )
    data = memoryview(image.data)
    needed = image.step * (image.height - 1) + row if image.height else 0
    if data.nbytes < needed:
        raise MessageError(
            "sensor_msgs/msg/Image.data",
            f"{data.nbytes} bytes, but {image.height} rows of {image.step} need {needed}",
        )
    if not (image.height and row):
        pixels = np.empty(shape, dtype)
    else:
        strides = (image.step, pixel, dtype.itemsize)
        pixels = np.ndarray(shape, dtype, buffer=data, strides=strides)
    return pixels[:, :, 0] if channels == 1 else pixels


def converted(pixels: npt.NDArray[Any], encoding: str, desired: str) -> npt.NDArray[Any]:
    """Convert pixels to another order of colours."""
    have, want = colors_of(encoding), colors_of(desired)
    dtype, channels = encoding_of(desired)
    if encoding_of(encoding) == (dtype, channels) and not (have and want):
        return pixels  # another name for the same layout, as 8UC3 for bgr8
    if not (have and want) or dtype != encoding_of(encoding)[0]:
        raise ValueError(
            f"to_numpy: {encoding} cannot become {desired}: only the order of colours can change "
            "here, not the number of bits; use passthrough and convert with OpenCV or numpy"
        )
    if want == "m":
        red, green, blue = (
            pixels[..., have.index(channel)].astype(np.float32) for channel in "rgb"
        )
        return np.asarray(np.round(0.299 * red + 0.587 * green + 0.114 * blue).astype(dtype))
    if have == "m":
        colors = np.repeat(pixels[..., np.newaxis], 3, axis=2)
        return with_alpha(colors, dtype) if "a" in want else colors
    colors = pixels[..., :3] if want[:3] == have[:3] else pixels[..., 2::-1]
    if "a" not in want:
        return colors
    if "a" not in have:
        return with_alpha(colors, dtype)
    return np.concatenate([colors, pixels[..., 3:]], axis=2)


def with_alpha(colors: npt.NDArray[Any], dtype: np.dtype[Any]) -> npt.NDArray[Any]:
    """Add an opaque alpha channel."""
    opaque = np.full((*colors.shape[:2], 1), np.iinfo(dtype).max, dtype)
    return np.concatenate([colors, opaque], axis=2)


def from_numpy(
    pixels: npt.NDArray[Any], encoding: str = "passthrough", header: Header | None = None
) -> Image:
    """Make an image from an array of rows, columns and, where there are several, channels.

    A contiguous array is not copied but referenced by the message, so do not change it before the
    message is published, which takes a snapshot.

    Args:
        pixels: The array, with the encoding's dtype.
        encoding: The pixel format: ``bgr8`` for an OpenCV image, ``rgb8``, ``mono8``, ``32FC1``;
            ``passthrough`` uses OpenCV's type, such as ``8UC3``, which does not say what the
            channels are.
        header: The time of exposure and the frame of the camera.

    Raises:
        TypeError: `pixels` is not an array.
        MessageError: `encoding` is unknown (a ValueError).
        ValueError: the array has a different type or shape than `encoding` says.
    """
    if not isinstance(pixels, np.ndarray):
        raise TypeError(f"from_numpy: {type(pixels).__name__} given; a numpy.ndarray is needed")
    if pixels.ndim not in {2, 3}:
        raise ValueError(
            f"from_numpy: an array of shape {pixels.shape}; use (rows, columns) or (rows, columns, "
            "channels)"
        )
    height, width = pixels.shape[:2]
    channels = 1 if pixels.ndim == 2 else pixels.shape[2]
    if encoding == "passthrough":
        types = {name: short for short, name in OPENCV_TYPES.items()}
        if pixels.dtype.name not in types:
            raise ValueError(f"from_numpy: {pixels.dtype.name}; use one of {', '.join(types)}")
        encoding = f"{types[pixels.dtype.name]}C{channels}"
    dtype, wanted = encoding_of(encoding)
    if (pixels.dtype.newbyteorder("="), channels) != (dtype, wanted):
        raise ValueError(
            f"from_numpy: {channels} channels of {pixels.dtype.name}; {encoding} has {wanted} of "
            f"{dtype.name}"
        )
    pixels = np.ascontiguousarray(pixels)
    return Image(
        header=Header() if header is None else header,
        height=height,
        width=width,
        encoding=encoding,
        is_bigendian=int(pixels.dtype.str[0] == ">"),
        step=width * channels * dtype.itemsize,
        data=pixels.reshape(-1).view(np.uint8).data if pixels.size else b"",
    )


# PIL and compressed images


def pillow() -> ModuleType:
    """Import PIL.Image; the error says how to install it."""
    try:
        import PIL.Image
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            "aionode.image: PIL images and compressed ones need Pillow; pip install pillow",
            name="PIL",
        ) from error
    return PIL.Image


def to_pil(image: Image) -> PILImage:
    """Return an image as a PIL image of mode ``L``, ``RGB``, ``RGBA``, ``I;16`` or ``F``.

    Raises:
        TypeError, MessageError: as `to_numpy`.
        ValueError: PIL has no mode for it, or its encoding does not name the channels (``8UC3``).
        ModuleNotFoundError: Pillow is not installed.
    """
    modes = {encoding: mode for mode, encoding in PIL_ENCODINGS.items()}
    modes |= {"8UC1": "L", "8U": "L", "16UC1": "I;16", "32F": "F"}
    wanted = {"bgr8": "rgb8", "bgra8": "rgba8"}.get(image.encoding, "passthrough")
    pixels = to_numpy(image, wanted)
    mode = modes.get(image.encoding if wanted == "passthrough" else wanted)
    if mode is None:
        raise ValueError(
            f"to_pil: PIL has no mode for {image.encoding}, only for {', '.join(modes)}, bgr8 and "
            "bgra8; use to_numpy, which takes every encoding, and PIL.Image.fromarray"
        )
    native = np.ascontiguousarray(pixels, pixels.dtype.newbyteorder("="))
    picture: PILImage = pillow().frombuffer(
        mode, (image.width, image.height), native.tobytes(), "raw", mode, 0, 1
    )
    return picture


def from_pil(picture: PILImage, header: Header | None = None) -> Image:
    """Make a message from a PIL image; palette and two-colour images are converted.

    Raises:
        ValueError: the image has a mode other than ``L``, ``RGB``, ``RGBA``, ``I;16``, ``F``,
            ``1`` and ``P``.
    """
    converting = {"1": "L", "P": "RGBA" if "transparency" in picture.info else "RGB"}
    if picture.mode in converting:
        picture = picture.convert(converting[picture.mode])
    if picture.mode not in PIL_ENCODINGS:
        raise ValueError(
            f"from_pil: mode {picture.mode} has no encoding; convert it to one of "
            f"{', '.join(PIL_ENCODINGS)}, as with picture.convert('RGB')"
        )
    return from_numpy(np.asarray(picture), PIL_ENCODINGS[picture.mode], header)


def compress(image: Image, format: str = "jpeg", **options: Any) -> CompressedImage:  # noqa: A002  # the field's name
    """Compress an image to a file format; the header is kept.

    Args:
        image: The image.
        format: ``jpeg`` (lossy), ``png`` (lossless), or another that Pillow can write.
        options: Pillow's options for this format, such as ``quality=90``.

    Raises:
        TypeError, MessageError, ValueError, ModuleNotFoundError: as `to_pil`.
        ValueError: the format is unknown, or cannot hold the image, as JPEG cannot hold 16 bits.
    """
    picture = to_pil(image)
    file = io.BytesIO()
    try:
        picture.save(file, format=format, **options)
    except (KeyError, OSError) as error:
        raise ValueError(
            f"compress: {image.encoding} cannot be written as {format!r} ({error}); jpeg holds "
            "mono8, rgb8 and bgr8, png all but 32FC1"
        ) from error
    return CompressedImage(header=image.header, format=format, data=file.getvalue())


def compress_depth(
    image: Image,
    *,
    depth_max: float = 10.0,
    depth_quantization: float = 100.0,
    compress_level: int = 3,
) -> CompressedImage:
    """Compress a depth image as image_transport's ``compressedDepth`` does; the header is kept.

    Depths of 16 bits stay as they are, in millimetres. Those of 32FC1, in metres, become 16 bits of
    inverse depth, whose steps are finer at close range; those that 16 bits cannot hold become
    unknown.

    Args:
        image: An image of one channel: 16UC1, mono16 or 32FC1.
        depth_max: Depths beyond this, in metres, become unknown.
        depth_quantization: The depth at which the steps of inverse depth are 1 m.
        compress_level: How hard PNG compresses, from 0 to 9.

    Raises:
        ValueError: the image has another encoding.
        MessageError, ModuleNotFoundError: as `to_pil`.
    """
    numerator = offset = np.float32(0)
    pixels = to_numpy(image)
    if image.encoding == "32FC1":
        # In float32, as image_transport computes; not finite where there is no depth.
        numerator = np.float32(depth_quantization) * np.float32(depth_quantization + 1.0)
        offset = np.float32(1.0) - numerator / np.float32(depth_max)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = numerator / pixels + offset
            fits = (pixels < depth_max) & (pixels > 0) & (inverse < 65536.0)
        picture = np.where(fits, inverse, 0).astype(np.uint16)
    elif image.encoding in ("16UC1", "mono16"):
        picture = np.where(pixels <= min(depth_max * 1000.0, 65535.0), pixels, 0).astype(np.uint16)
    else:
        raise ValueError(
            f"compress_depth: {image.encoding} is not for depths; use 16UC1, mono16 or 32FC1"
        )
    png = compress(from_numpy(picture, "mono16"), "png", compress_level=compress_level)
    return CompressedImage(
        header=image.header,
        format=f"{image.encoding}; compressedDepth png",
        data=DEPTH_HEAD.pack(0, numerator, offset) + bytes(png.data),
    )


def decompress(image: CompressedImage, size: tuple[int, int] | None = None) -> Image:
    """Decompress an image to mono8, rgb8, rgba8 or mono16; the header is kept.

    It may be a BMP, JPEG, PNG, TIFF or WebP image. A depth image of image_transport's
    ``compressedDepth`` becomes 16UC1 or 32FC1, as it was; unknown depths are 0 or NaN.

    Args:
        image: The message.
        size: The width and height that it is to have. A few bytes can claim any size, which is
            refused before it takes memory.

    Raises:
        TypeError: `image` is not a CompressedImage.
        MessageError: its data cannot be read, or it has another size (a ValueError).
        ModuleNotFoundError: Pillow is not installed, which RVL does not need.
    """
    if not isinstance(image, CompressedImage):
        raise TypeError(
            f"decompress: {type(image).__name__} given; a sensor_msgs/msg/CompressedImage is needed"
        )
    is_depth = "compressedDepth" in image.format
    data = memoryview(image.data)
    if is_depth and image.format.endswith("compressedDepth rvl"):
        depths = depths_of_rvl(data[DEPTH_HEAD.size :], image.format, size)
        picture = from_numpy(depths, "mono16", image.header)
        return depth_of(picture, DEPTH_HEAD.unpack_from(data), image.format)
    try:
        file = io.BytesIO(data[DEPTH_HEAD.size :] if is_depth else data)
        picture = pillow().open(file, formats=FORMATS)
        check_size(picture.size, size)
        picture.load()
    except (OSError, SyntaxError, pillow().DecompressionBombError) as error:
        raise MessageError(
            "sensor_msgs/msg/CompressedImage.data",
            f"cannot be read as an image ({error}); its format is given as {image.format!r}",
        ) from error
    message = from_pil(picture, image.header)
    return depth_of(message, DEPTH_HEAD.unpack_from(data), image.format) if is_depth else message


def check_size(given: tuple[int, int], wanted: tuple[int, int] | None) -> None:
    """Raise MessageError for a picture that has another width or height than is wanted."""
    if wanted not in (None, given):
        raise MessageError(
            "sensor_msgs/msg/CompressedImage.data",
            f"{given[0]} by {given[1]} pixels; {wanted[0]} by {wanted[1]} are expected",
        )


def depths_of_rvl(
    data: memoryview,
    format: str,  # noqa: A002  # the field's name
    size: tuple[int, int] | None,
) -> npt.NDArray[np.uint16]:
    """Decode compressedDepth's lossless RVL, which begins with a width and height.

    A number is a sequence of nibbles with three bits each, the lowest first; all but the last have
    the highest bit set. The numbers are: how many pixels are 0, how many of the following are not,
    and for each of these the difference from the one before, with its sign as the lowest bit; and
    so on.

    Raises:
        MessageError: the data end too early, are malformed, or claim too many pixels.
    """
    wrong = MessageError(
        "sensor_msgs/msg/CompressedImage.data",
        f"not an RVL picture of at most {MAX_PIXELS} pixels; its format is given as {format!r}",
    )
    if len(data) < RVL_HEAD.size:
        raise wrong
    width, height = RVL_HEAD.unpack_from(data)
    count = width * height
    if not 0 < count <= MAX_PIXELS:
        raise wrong
    check_size((width, height), size)
    data = data[RVL_HEAD.size : RVL_HEAD.size + 4 * count + 16]  # a pixel has 7 nibbles at most
    words = np.frombuffer(data[: len(data) - len(data) % 4], "<u4").astype(">u4")
    depths = np.zeros(count, np.uint16)
    done = 0  # pixels
    followers = 0  # depths left of the run that began in the previous block
    last = np.uint16(0)
    rest = np.empty(0, np.int32)
    for block in numbers_of_rvl(words.view(np.uint8)):
        if block is None:
            break
        numbers = np.concatenate((rest, block))
        view: Any = memoryview(numbers)  # type: ignore[arg-type]  # an array is a buffer
        held, at = len(numbers), followers
        firsts, lengths = array("i"), array("i", (0, followers))
        left = count - done - followers
        while left > 0 and at + 1 < held:
            zeros, followers = view[at], view[at + 1]
            if zeros + followers == 0 or zeros + followers > left:
                raise wrong
            firsts.append(at)
            lengths.extend((zeros, followers))
            left -= zeros + followers
            at += 2 + followers
        followers = max(at - held, 0)
        lengths[-1] -= followers
        rest = numbers[at:]
        is_delta = np.ones(min(at, held), bool)
        heads = np.array(firsts, np.int32)
        is_delta[heads] = is_delta[heads + 1] = False
        deltas = numbers[: len(is_delta)][is_delta]
        found = last + np.cumsum((deltas >> 1) ^ -(deltas & 1), dtype=np.uint16)
        has_depth = np.repeat(np.arange(len(lengths)) % 2 == 1, lengths)
        depths[done : done + len(has_depth)][has_depth] = found
        done += len(has_depth)
        if done == count:
            return depths.reshape(height, width)
        last = found[-1] if len(found) else last
    raise wrong


def numbers_of_rvl(packed: npt.NDArray[np.uint8]) -> Iterator[npt.NDArray[np.int32] | None]:
    """Yield the numbers that are packed in RVL, and None if one of them is too long.

    It takes a block at a time, as the intermediate arrays are many times as large as the data.
    """
    rest = np.empty(0, np.uint8)
    for begin in range(0, len(packed), BLOCK_BYTES):
        block = packed[begin : begin + BLOCK_BYTES]
        unpacked = np.column_stack((block >> 4, block & 15)).reshape(-1)
        nibbles = np.concatenate((rest, unpacked))
        starts = np.append(0, np.flatnonzero(nibbles < 8) + 1)
        sizes = np.diff(starts)
        rest = nibbles[starts[-1] :]
        if max(sizes.max(initial=0), len(rest)) > MAX_NIBBLES:
            yield None
            return
        if len(sizes):
            place = np.arange(starts[-1]) - np.repeat(starts[:-1], sizes)
            bits = (nibbles[: starts[-1]] & 7).astype(np.int32) << (3 * place).astype(np.int32)
            yield np.add.reduceat(bits, starts[:-1], dtype=np.int32)


def depth_of(picture: Image, head: tuple[int, float, float], format: str) -> Image:  # noqa: A002  # the field's name
    """Return the depths of a compressedDepth picture: 16 bits, or decoded from inverse metres.

    Raises:
        MessageError: the picture does not have 16 bits.
    """
    if picture.encoding != "mono16":
        raise MessageError(
            "sensor_msgs/msg/CompressedImage.data",
            f"a depth of 16 bits was expected, but its picture is {picture.encoding}",
        )
    pixels = to_numpy(picture)
    if not format.startswith("32FC1"):
        return from_numpy(pixels, "16UC1", picture.header)
    _, numerator, offset = head
    inverse = pixels.astype(np.float32) - np.float32(offset)
    with np.errstate(divide="ignore"):
        depth = np.where(pixels == 0, np.float32(np.nan), np.float32(numerator) / inverse)
    return from_numpy(depth.astype(np.float32), "32FC1", picture.header)
