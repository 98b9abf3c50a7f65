"""Images as pictures for browsers: files encoded by Pillow, and compressed images unchanged."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from aionode import image
from aionode.errors import MessageError
from aionode.gateway.session.encoding.eight_bits import eight_bits
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image

if TYPE_CHECKING:
    from aionode.gateway.session.feed import Received

__all__ = ["BOUNDARY", "IMAGE_TYPES", "Form", "Picture", "part_of", "picture_of"]

IMAGE_TYPES: Final = {"sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"}
"""The message types that can also be answered as pictures."""

BOUNDARY: Final = "picture"
"""The boundary between the pictures of a stream (multipart/x-mixed-replace, also called MJPEG)."""

BEGINNINGS: Final = {
    b"\xff\xd8\xff": "image/jpeg",
    b"\x89PNG\r\n\x1a\n": "image/png",
    b"RIFF": "image/webp",
}
"""The media types that browsers show, by the first bytes of a file."""


@dataclass(frozen=True, slots=True)
class Picture:
    """An image as browsers show it.

    Attributes:
        media_type: The format of the data.
        data: The file.
    """

    media_type: str
    data: bytes | bytearray | memoryview


@dataclass(frozen=True, slots=True)
class Form:
    """The form in which a client wants a picture.

    Attributes:
        media_type: ``image/jpeg`` or ``image/png``; None for either.
        width: The largest width in pixels, 0 for any; the height follows.
        quality: The quality of a JPEG, from 1 to 100; None for the default.
    """

    media_type: str | None = None
    width: int = 0
    quality: int | None = None


async def picture_of(received: Received, form: Form) -> Picture:
    """Return the picture of an image, encoded in a thread once for all clients.

    Raises:
        MessageError: the data is too short, or in no format that browsers show (a ValueError).
        ValueError: the channels of the image are not colours.
        ModuleNotFoundError: Pillow, which encodes it, is not installed.
    """
    outcome = await asyncio.shield(received.once(form, lambda taken: encoding(taken, form)))
    if isinstance(outcome, Exception):
        raise outcome
    return outcome


def encoding(received: Received, form: Form) -> asyncio.Future[Picture | Exception]:
    """Start to encode an image; the future is shared, so it returns an error instead of raising."""
    loop = asyncio.get_running_loop()
    return loop.run_in_executor(None, encoded, received.message, form)


def encoded(message: Image | CompressedImage, form: Form) -> Picture | Exception:
    """Return the picture of an image, or the reason why there is none."""
    try:
        if isinstance(message, CompressedImage):
            if "compressedDepth" not in message.format:  # a header before its file, and 16 bits
                picture = passed(message)
                as_it_is = (Form(), Form(media_type=picture.media_type))
                if form in as_it_is:
                    return picture
            message = image.decompress(message)
        if not (message.width and message.height):
            raise MessageError("sensor_msgs/msg/Image", "it has no pixels")
        return written(eight_bits(message), form)
    except (ValueError, ModuleNotFoundError) as error:
        return error


def written(message: Image, form: Form) -> Picture:
    """Return an eight-bit image as a file."""
    media_type = form.media_type or "image/jpeg"
    if media_type == "image/jpeg" and message.encoding == "rgba8":  # JPEG has no alpha channel
        message = image.from_numpy(image.to_numpy(message, "rgb8"), "rgb8")
    if 0 < form.width < message.width:
        height = max(1, round(message.height * form.width / message.width))
        message = image.from_pil(image.to_pil(message).resize((form.width, height)))
    options = {} if form.quality is None else {"quality": form.quality}
    file = image.compress(message, media_type.removeprefix("image/"), **options)
    return Picture(media_type, file.data)


def passed(message: CompressedImage) -> Picture:
    """Return a compressed image unchanged."""
    beginning = bytes(memoryview(message.data)[:8])
    for magic, media_type in BEGINNINGS.items():
        if beginning.startswith(magic):
            return Picture(media_type, message.data)
    raise MessageError(
        "sensor_msgs/msg/CompressedImage.data",
        f"browsers cannot show its format {message.format!r}; use JPEG, PNG or WebP",
    )


def part_of(picture: Picture) -> bytes:
    """Return a picture as one part of a stream."""
    head = (
        f"--{BOUNDARY}\r\nContent-Type: {picture.media_type}\r\n"
        f"Content-Length: {len(picture.data)}\r\n\r\n"
    )
    return b"".join((head.encode(), picture.data, b"\r\n"))
