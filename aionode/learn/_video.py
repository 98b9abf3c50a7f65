"""Videos of data sets: frames at exactly equal steps, in files in which any reader can seek."""

from __future__ import annotations

import math
import os
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final, Self

import av
import numpy as np

if TYPE_CHECKING:
    from pathlib import Path
    from types import TracebackType

    from aionode.learn._entries import Array

__all__ = ["CODECS", "PixelStats", "VideoWriter", "frame_times", "picture_of", "quantized"]

CODECS: Final[dict[str, tuple[str, str, dict[str, str]]]] = {
    "h264": (
        "libx264",
        "yuv420p",
        # subme=1: a fifth less work, and the same quality in files of the same size
        {"crf": "23", "preset": "veryfast", "bf": "0", "x264-params": "subme=1"},
    ),
    "av1": ("libsvtav1", "yuv420p", {"crf": "30", "preset": "12"}),
    "depth": ("libx265", "gray12le", {"x265-params": "lossless=1:log-level=none:bframes=0"}),
}
"""The encoder, pixel format and options of each codec."""

KEY_FRAMES: Final = 2
"""Every second frame can be decoded by itself: training reads frames in any order."""

DEPTH_MIN, DEPTH_MAX, DEPTH_SHIFT, DEPTH_STEPS = 0.01, 10.0, 3.5, 4095
"""LeRobot's scale of depths: metres, in logarithmic steps of 12 bits."""

SAMPLED: Final = 8
"""Statistics count every eighth pixel of every eighth row, of every fifth picture."""


def quantized(depths: Array) -> Array:
    """Return depths in metres as steps of LeRobot's scale; unknown depths are 0."""
    low, high = math.log(DEPTH_MIN + DEPTH_SHIFT), math.log(DEPTH_MAX + DEPTH_SHIFT)
    known = np.where(np.isfinite(depths), np.maximum(depths, 0), 0)
    share = (np.log(known + np.float32(DEPTH_SHIFT)) - low) / (high - low)
    steps: Array = np.clip(np.rint(share * DEPTH_STEPS), 0, DEPTH_STEPS).astype(np.uint16)
    return steps


def picture_of(pixels: Array) -> Any:
    """Return the video frame of an image: colours, greys, or depths in metres."""
    if pixels.dtype == np.float32:
        steps = quantized(pixels)
        frame = av.VideoFrame(steps.shape[1], steps.shape[0], "gray12le")
        plane = np.frombuffer(memoryview(frame.planes[0]), np.uint16)
        plane.reshape(steps.shape[0], -1)[:, : steps.shape[1]] = steps
        return frame
    return av.VideoFrame.from_ndarray(
        np.ascontiguousarray(pixels), "rgb24" if pixels.ndim == 3 else "gray"
    )


class VideoWriter:
    """Writes images of one size to an MP4 file with a constant frame rate.

    Args:
        path: The file.
        shape: Rows and columns of the images.
        fps: Frames per second.
        codec: ``h264``, ``av1`` or ``depth``.
        threads: Number of threads of the encoder.

    Attributes:
        count: Number of frames so far.
    """

    def __init__(
        self, path: Path, shape: tuple[int, ...], fps: int, codec: str, threads: int = 1
    ) -> None:
        encoder, self.pixels, options = CODECS[codec]
        os.environ.setdefault("SVT_LOG", "1")  # AV1's encoder would print its settings
        self.count = 0
        self._base = Fraction(1, fps)
        self._container = av.open(str(path), "w", format="mp4")
        stream: Any = self._container.add_stream(encoder, rate=fps, options=options)
        stream.height, stream.width = shape[:2]
        stream.pix_fmt = self.pixels
        stream.codec_context.time_base = self._base
        stream.codec_context.gop_size = KEY_FRAMES
        stream.codec_context.thread_count = threads
        self._stream = stream

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            if error is None:
                self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()

    def converted(self, pixels: Array) -> Any:
        """Return the frame of an image in the format of the file."""
        return picture_of(pixels).reformat(format=self.pixels)

    def add(self, frame: Any) -> None:
        """Add a frame that `converted` returned; adding the same one again repeats it."""
        frame.pts, frame.time_base = self.count, self._base
        self._container.mux(self._stream.encode(frame))
        self.count += 1


def frame_times(path: Path) -> list[Fraction]:
    """Return the time of each frame of a file in seconds, in order."""
    with av.open(str(path)) as container:
        return sorted(
            packet.pts * packet.time_base
            for packet in container.demux(video=0)
            if packet.pts is not None
        )


class PixelStats:
    """Counts the pixels of images by channel and value, for exact statistics of a sample."""

    def __init__(self, kind: str) -> None:
        self.is_depth = kind == "depth"
        self.counts = np.zeros((1, DEPTH_STEPS + 1) if self.is_depth else (3, 256), np.int64)
        self.pictures = 0

    def add(self, pixels: Array) -> None:
        """Count an image if it is in the sample."""
        self.pictures += 1
        if self.pictures % 5 != 1:
            return
        sample = pixels[::SAMPLED, ::SAMPLED]
        if self.is_depth:
            sample = quantized(sample)
        size = self.counts.shape[1]
        for channel in range(len(self.counts)):
            values = sample[..., channel] if sample.ndim == 3 else sample
            self.counts[channel] += np.bincount(values.ravel(), minlength=size)

    def statistics(self) -> dict[str, list[Any]]:
        """Return the statistics by name, one value for each channel, in the range 0 to 1.

        Statistics of depths are in metres.
        """
        if self.is_depth:
            low, high = math.log(DEPTH_MIN + DEPTH_SHIFT), math.log(DEPTH_MAX + DEPTH_SHIFT)
            scale = np.exp(np.linspace(low, high, DEPTH_STEPS + 1)) - DEPTH_SHIFT
        else:
            scale = np.arange(256) / 255
        found: dict[str, list[Any]] = {}
        for counts in self.counts:
            for name, value in of_histogram(scale, counts).items():
                found.setdefault(name, []).append([[value]])
        return {**found, "count": [self.pictures]}


def of_histogram(scale: Array, counts: Array) -> dict[str, float]:
    """Return the statistics of values from the number of times that each occurs."""
    total = max(int(counts.sum()), 1)
    there = np.flatnonzero(counts) if counts.any() else np.zeros(1, np.int64)
    mean = float((scale * counts).sum() / total)
    below = np.cumsum(counts) / total
    found = {
        "min": float(scale[there[0]]),
        "max": float(scale[there[-1]]),
        "mean": mean,
        "std": math.sqrt(max(float((scale**2 * counts).sum() / total) - mean**2, 0.0)),
    }
    for percent in (1, 10, 50, 90, 99):
        found[f"q{percent:02d}"] = float(
            scale[min(int((below < percent / 100).sum()), len(scale) - 1)]
        )
    return found
