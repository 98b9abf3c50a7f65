"""``image_transport republish``: publishes images in another form, such as compressed."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.util import find_spec
from typing import Any, Final

import aionode
from aionode import Node, Parameter, Publisher, PublisherEventCallbacks, Subscription
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.image import compress, compress_depth, decompress, from_numpy, to_numpy
from aionode.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
)
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image

__all__ = ["Republisher", "compressed", "main", "topic_of", "uncompressed"]

INPUTS: Final[dict[str, Any]] = {
    "raw": Image,
    "compressed": CompressedImage,
    "compressedDepth": CompressedImage,
}
"""The transports that can be read, and their message types."""

OUTPUTS: Final = INPUTS
"""The transports that can be written."""

FORMATS: Final = ("jpeg", "png")

QUALITY: Final = "out.compressed.jpeg_quality"
LEVEL: Final = "out.compressed.png_level"
FORMAT: Final = "out.compressed.format"

DEPTH: Final = "out.compressedDepth."
"""The prefix of the parameters of depth."""


def topic_of(node: Node, base: str, transport: str) -> str:
    """Return the topic of a transport: a remapping of it precedes one of the base topic."""
    if transport == "raw":
        return node.resolve_topic_name(base)
    own = node.resolve_topic_name(f"{base}/{transport}")
    if own != node.resolve_topic_name(f"{base}/{transport}", only_expand=True):
        return own
    return f"{node.resolve_topic_name(base)}/{transport}"


def compressed(image: Image, format_: str, quality: int, level: int) -> CompressedImage:
    """Return an image as JPEG or PNG; its format names both encodings, as in ROS.

    Raises:
        ValueError: The format cannot hold the colours of the image.
    """
    encoding = image.encoding
    if format_ == "jpeg" and encoding in ("rgba8", "bgra8"):
        image = from_numpy(to_numpy(image, "rgb8"), "rgb8", image.header)
    options = {"quality": quality} if format_ == "jpeg" else {"compress_level": level}
    found = compress(image, format_, **options)
    target = "" if encoding.startswith(("mono", "8U", "16U")) else "bgr8"
    found.format = f"{encoding}; {format_} compressed {target}"
    return found


def uncompressed(image: CompressedImage) -> Image:
    """Return an image as it was before compression; ``bgr8`` if that is unknown.

    Raises:
        ValueError: Its data cannot be read.
    """
    found = decompress(image)
    if found.encoding not in ("rgb8", "rgba8"):
        return found
    encoding, said, _ = image.format.partition(";")
    wanted = encoding if said and encoding in ("rgb8", "rgba8", "bgra8") else "bgr8"
    return from_numpy(to_numpy(found, wanted), wanted, image.header)


class Republisher(Node):
    """Republishes `in` on `out`, in one transport or in all, while `out` has subscriptions.

    Args:
        *words: The transport of the input, then that of the output, as in older launch files.

    Raises:
        CommandError: A transport is unknown, or a parameter is invalid.
    """

    def __init__(self, *words: str) -> None:
        names = ("in_transport", "out_transport")
        given = [Parameter(name, value=word) for name, word in zip(names, words, strict=False)]
        super().__init__("image_republisher", parameter_overrides=given)
        self.source = self.chosen("in_transport", "raw", list(INPUTS))
        wanted = self.chosen("out_transport", "", ["", *OUTPUTS])
        transports = [wanted] if wanted else list(OUTPUTS)
        if (self.source, *transports) != ("raw", "raw") and find_spec("PIL") is None:
            raise CommandError(
                "compressed images need Pillow, which is not installed: pip install pillow"
            )
        self.topic = topic_of(self, "in", self.source)
        self.warned = ""
        self.format = "jpeg"
        if "compressed" in transports:
            self.declare_compression()
        if "compressedDepth" in transports:
            self.declare_depth()
        self.input: Subscription[Any] | None = None
        events = PublisherEventCallbacks(matched=self.on_matched)
        self.outputs: dict[str, Publisher[Any]] = {
            transport: self.create_publisher(
                OUTPUTS[transport], topic_of(self, "out", transport), 10, event_callbacks=events
            )
            for transport in transports
        }

    def chosen(self, name: str, usual: str, fits: Sequence[str]) -> str:
        """Return the transport set by a parameter."""
        transport: str = self.declare_parameter(name, usual).value
        self.get_logger().info(f"The '{name}' parameter is set to: {transport}")
        if transport not in fits:
            known = ", ".join(each for each in fits if each)
            raise CommandError(f"{name} is {transport!r}, which is not available here; use {known}")
        return transport

    def declare_compression(self) -> None:
        """Declare the parameters of compression."""
        for name, usual, most in ((QUALITY, 95, 100), (LEVEL, 3, 9)):
            limits = IntegerRange(from_value=int(name == QUALITY), to_value=most, step=1)
            self.declare_parameter(name, usual, ParameterDescriptor(integer_range=[limits]))
        self.format = self.declare_parameter(FORMAT, "jpeg").value
        if self.format not in FORMATS:
            raise CommandError(f"{FORMAT} is {self.format!r}; use {' or '.join(FORMATS)}")

    def declare_depth(self) -> None:
        """Declare how depths are compressed."""
        format_ = self.declare_parameter(f"{DEPTH}format", "png").value
        if format_ != "png":
            raise CommandError(f"{DEPTH}format is {format_!r}; use png; RVL can only be read")
        for name, usual, most in (("depth_max", 10.0, 100.0), ("depth_quantization", 100.0, 150.0)):
            metres = FloatingPointRange(from_value=1.0, to_value=most)
            described = ParameterDescriptor(floating_point_range=[metres])
            self.declare_parameter(f"{DEPTH}{name}", usual, described)
        levels = IntegerRange(from_value=0, to_value=9, step=1)
        described = ParameterDescriptor(integer_range=[levels])
        self.declare_parameter(f"{DEPTH}png_level", 3, described)

    def on_matched(self, _info: object) -> None:
        """Subscribe while there are subscriptions."""
        is_wanted = any(each.get_subscription_count() for each in self.outputs.values())
        if is_wanted and self.input is None:
            self.input = self.create_subscription(
                INPUTS[self.source], self.topic, self.on_image, 10, offload=True
            )
        elif not is_wanted and self.input is not None:
            self.input.destroy()
            self.input = None

    def on_image(self, given: Image | CompressedImage) -> None:
        """Publish an image in each form that has subscriptions; in a thread."""
        listened = {
            transport: each
            for transport, each in self.outputs.items()
            if each.get_subscription_count()
        }
        for transport, output in listened.items():
            try:
                image = self.converted(given, transport)
            except ValueError as error:
                if str(error) != self.warned:
                    self.get_logger().error(f"an image is skipped: {error}")
                self.warned = str(error)
                continue
            if not output.destroyed:
                output.publish(image)

    def converted(self, given: Image | CompressedImage, transport: str) -> Image | CompressedImage:
        """Return an image in the form of a transport."""
        if self.source == transport:
            return given
        image = uncompressed(given) if isinstance(given, CompressedImage) else given
        if transport == "raw":
            return image
        if transport == "compressed":
            return compressed(image, self.format, self.value(QUALITY), self.value(LEVEL))
        return compress_depth(
            image,
            depth_max=self.value(f"{DEPTH}depth_max"),
            depth_quantization=self.value(f"{DEPTH}depth_quantization"),
            compress_level=self.value(f"{DEPTH}png_level"),
        )

    def value(self, name: str) -> Any:
        """Return the value of a parameter."""
        return self.get_parameter(name).value


def main() -> None:
    """Run the node until Ctrl-C."""
    words = remove_ros_args(sys.argv)[1:3]
    aionode.run(lambda: Republisher(*words))
