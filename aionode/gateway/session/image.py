"""Images as pictures for browsers: JPEG by Pillow, and compressed images as they are."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from aionode import image
from aionode.errors import MessageError
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image

if TYPE_CHECKING:
    from aionode.gateway.session.feed import Received

__all__ = ["BOUNDARY", "IMAGE_TYPES", "Picture", "part_of", "picture_of"]

IMAGE_TYPES: Final = {"sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"}
"""The messages that are also answered as pictures."""

BOUNDARY: Final = "picture"
"""The line between the pictures of a stream (multipart/x-mixed-replace, also called MJPEG)."""

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


async def picture_of(received: Received) -> Picture:
    """Return the picture of an image, which is encoded once for all clients, in a thread.

    Raises:
        MessageError: the data is too short, or nothing that browsers show (a ValueError).
        ValueError: JPEG cannot hold the image, such as one of 16 bits.
        ModuleNotFoundError: Pillow, which encodes it, is not installed.
    """
    outcome = await asyncio.shield(received.once("picture", encoding))
    if isinstance(outcome, Exception):
        raise outcome
    return outcome


def encoding(received: Received) -> asyncio.Future[Picture | Exception]:
    """Begin to encode an image; the future is shared, so it returns an error instead of raising."""
    loop = asyncio.get_running_loop()
    return loop.run_in_executor(None, encoded, received.message)


def encoded(message: Image | CompressedImage) -> Picture | Exception:
    """Return the picture of an image, or why there is none."""
    try:
        if isinstance(message, CompressedImage):
            return passed(message)
        if message.encoding in {"rgba8", "bgra8"}:  # JPEG has no alpha channel
            message = image.from_numpy(image.to_numpy(message, "rgb8"), "rgb8")
        return Picture("image/jpeg", image.compress(message).data)
    except (ValueError, ModuleNotFoundError) as error:
        return error


def passed(message: CompressedImage) -> Picture:
    """Return a compressed image as it is."""
    beginning = bytes(memoryview(message.data)[:8])
    for magic, media_type in BEGINNINGS.items():
        if beginning.startswith(magic):
            return Picture(media_type, message.data)
    raise MessageError(
        "sensor_msgs/msg/CompressedImage.data",
        f"no picture that browsers show; its format is given as {message.format!r}; JPEG, PNG and "
        "WebP fit",
    )


def part_of(picture: Picture) -> bytes:
    """Return a picture as one part of a stream."""
    head = (
        f"--{BOUNDARY}\r\nContent-Type: {picture.media_type}\r\n"
        f"Content-Length: {len(picture.data)}\r\n\r\n"
    )
    return b"".join((head.encode(), picture.data, b"\r\n"))
