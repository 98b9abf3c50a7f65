"""Linux cameras and video files, read by PyAV."""

from __future__ import annotations

import threading
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from aionode.errors import CommandError

__all__ = ["FORMATS", "Format", "Frame", "Video", "check_device", "name_of", "text_in"]


SYSTEM: Final = Path("/sys/class/video4linux")
"""Where Linux describes the devices of cameras."""


class Format(NamedTuple):
    """How pixels are read, and how they are published.

    Attributes:
        v4l2: The format requested from a camera, by ffmpeg's name; empty for any.
        av: The format to which ffmpeg converts them.
        encoding: ROS's name for that format.
    """

    v4l2: str
    av: str
    encoding: str


FORMATS: Final = {
    "yuyv": Format("yuyv422", "yuyv422", "yuv422_yuy2"),
    "yuyv2rgb": Format("yuyv422", "rgb24", "rgb8"),
    "uyvy": Format("uyvy422", "yuyv422", "yuv422"),
    "uyvy2rgb": Format("uyvy422", "rgb24", "rgb8"),
    "mjpeg": Format("mjpeg", "rgb24", "rgb8"),
    "mjpeg2rgb": Format("mjpeg", "rgb24", "rgb8"),
    "rgb8": Format("rgb24", "rgb24", "rgb8"),
    "mono8": Format("gray", "gray", "mono8"),
    "mono16": Format("gray16le", "gray16le", "mono16"),
}
"""Pixel formats, by the names of usb_cam."""


JPEG: Final = ("rgb8", "bgr8", "rgba8", "bgra8", "mono8")
"""The encodings that are compressed as they are."""


class Frame(NamedTuple):
    """A picture.

    Attributes:
        pixels: Its pixels.
        encoding: Their encoding.
        jpeg: The picture as JPEG, if the camera sent it that way and in this size.
        picture: The picture as PyAV has it.
    """

    pixels: npt.NDArray[Any]
    encoding: str
    jpeg: bytes | None
    picture: Any

    def for_jpeg(self) -> tuple[npt.NDArray[Any], str]:
        """Return pixels that JPEG can hold, and their encoding."""
        if self.encoding in JPEG:
            return self.pixels, self.encoding
        kind, encoding = ("gray", "mono8") if self.encoding == "mono16" else ("rgb24", "rgb8")
        height, width = self.pixels.shape[:2]
        return self.picture.reformat(width=width, height=height, format=kind).to_ndarray(), encoding


def check_device(path: str, *, may_come_later: bool = False) -> None:
    """Refuse a camera that cannot be read, or that does not exist and may not come later.

    Raises:
        CommandError: There is no such camera, or PyAV or Pillow is not installed.
    """
    if not may_come_later and not Path(path).exists():
        there = sorted(str(each) for each in Path("/dev").glob("video*"))
        raise CommandError(
            f"video_device {path!r} does not exist; cameras here: {', '.join(there) or 'none'}; "
            "the path of a video file works as well"
        )
    if find_spec("av") is None or find_spec("PIL") is None:
        raise CommandError(
            "cameras are read by PyAV and their pictures compressed by Pillow, and one of them is "
            "not installed: pip install 'aionode[camera]'"
        )


def name_of(path: str) -> str:
    """Return the name of a camera, as reported by its driver, or of a file."""
    return text_in(SYSTEM / Path(path).resolve().name / "name") or Path(path).stem


def text_in(file: Path) -> str:
    """Return the text of a file; empty if there is none."""
    return file.read_text(encoding="utf-8").strip() if file.is_file() else ""


class Video:
    """An open camera or file. Its methods block, so they belong in a thread.

    Args:
        path: The device, or the file of a video.
        format_: How pixels are read, and how they are published.
        size: Width and height, to which files are scaled; zeros for those of the camera or file.
        rate: The number of pictures per second requested from a camera.

    Raises:
        OSError: It cannot be opened.
    """

    def __init__(self, path: str, format_: Format, size: tuple[int, int], rate: float) -> None:
        import av

        self.format = format_
        self.size = size
        self.is_camera = Path(path).resolve().is_relative_to("/dev")
        width, height = size
        options = {
            "input_format": format_.v4l2,
            "video_size": f"{width}x{height}" if width else "",
            "framerate": f"{rate:g}",
        }
        wanted = {name: value for name, value in options.items() if value}
        given = {"format": "v4l2", "options": wanted} if self.is_camera else {}
        opening: Any = av.open
        self.failures = (av.error.FFmpegError, IndexError)
        try:
            self.container = opening(path, **given)
            self.stream = self.container.streams.video[0]
        except self.failures as error:
            raise OSError(f"not a readable video ({error})") from None
        self.is_jpeg = self.stream.codec_context.name == "mjpeg"
        self.packets = self.container.demux(self.stream)
        self.waiting: list[tuple[Any, bytes | None]] = []
        self.reading = threading.Lock()  # FFmpeg crashes if it is closed while it is reading
        self.is_closing = False

    def read(self) -> Frame | None:
        """Return the next picture; None at the end of a file.

        Raises:
            OSError: The camera is gone, the file is damaged, or its pictures have no such format.
        """
        try:
            with self.reading:
                return self.next_frame()
        finally:
            if self.is_closing:
                self.close()

    def next_frame(self) -> Frame | None:
        """Return the next picture, like `read`."""
        while not self.waiting:
            try:
                packet = next(self.packets, None)
                pictures = [] if packet is None else packet.decode()
            except self.failures as error:
                raise OSError(f"no more pictures ({error})") from None
            if packet is None:
                return None
            data = bytes(packet) if self.is_jpeg and packet.size else None
            self.waiting = [(picture, data) for picture in pictures]
        picture, data = self.waiting.pop(0)
        own = (picture.width, picture.height)
        width, height = self.size if any(self.size) else own
        if (width, height) != own:
            data = None
        if self.format.av == "yuyv422" and (width % 2 or height % 2):
            raise OSError(
                f"pictures of {width} x {height} pixels cannot be {self.format.encoding}, which "
                "needs even numbers; choose another size or format"
            )
        found = picture.reformat(width=width, height=height, format=self.format.av)
        pixels = found.to_ndarray()
        if self.format.encoding == "yuv422":
            pixels = np.ascontiguousarray(pixels.reshape(height, width, 2)[..., ::-1])
        return Frame(pixels, self.format.encoding, data, picture)

    def close(self) -> None:
        """Close it, from any thread: at once, or as soon as the last reader has finished."""
        self.is_closing = True
        if self.reading.acquire(blocking=False):
            try:
                self.container.close()
            finally:
                self.reading.release()
