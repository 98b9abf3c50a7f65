"""The program that publishes images in another form."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from aionode.errors import CommandError
from aionode.image import from_numpy, to_numpy
from aionode.interfaces.sensor_msgs.msg import CompressedImage, Image
from aionode.interfaces.std_msgs.msg import Header
from aionode.programs._camera.republish import Republisher, compressed, topic_of, uncompressed
from aionode.testing import settle
from tests.programs.conftest import Start

GRADIENT: npt.NDArray[np.uint8] = (
    np.linspace(0, 255, 20 * 30 * 3).reshape(20, 30, 3).astype(np.uint8)
)


def picture(encoding: str = "bgr8") -> Image:
    """Return an image of a camera."""
    return from_numpy(GRADIENT, encoding, Header(frame_id="camera"))


class Viewer:
    """A camera, and a subscription to its pictures."""

    def __init__(self, node: Any) -> None:
        self.node = node
        self.seen: list[Any] = []

    def look(self, kind: Any, topic: str) -> Any:
        """Subscribe to a topic."""
        return self.node.create_subscription(kind, topic, self.seen.append)

    async def show(self, kind: Any, topic: str, *images: Any) -> list[Any]:
        """Publish images, and return what is received."""
        publisher = self.node.create_publisher(kind, topic, 10)
        await settle()
        for image in images:
            publisher.publish(image)
            await settle()
        return self.seen


@pytest.fixture
async def viewer(node_factory: Callable[..., Any]) -> Viewer:
    """Return a camera and a viewer."""
    return Viewer(node_factory("viewer"))


async def test_raw_images_become_compressed_ones(start: Start, viewer: Viewer) -> None:
    """All transports are there by default; the format is as compressed_image_transport says it."""
    start(Republisher)
    viewer.look(CompressedImage, "out/compressed")
    (seen,) = await viewer.show(Image, "in", picture())

    assert seen.format == "bgr8; jpeg compressed bgr8"
    assert seen.header.frame_id == "camera"
    again = uncompressed(seen)
    assert again.encoding == "bgr8"
    assert np.abs(to_numpy(again).astype(int) - GRADIENT).max() < 20


async def test_depths_become_compressed_ones(start: Start, viewer: Viewer) -> None:
    """With the format and parameters of compressed_depth_image_transport."""
    start(Republisher, "raw", "compressedDepth", **{"out.compressedDepth.depth_max": 3.0})
    viewer.look(CompressedImage, "out/compressedDepth")
    depth = from_numpy(np.array([[1.0, 2.5, 3.5]], np.float32), "32FC1", Header(frame_id="eye"))
    (seen,) = await viewer.show(Image, "in", depth)

    assert seen.format == "32FC1; compressedDepth png"
    assert seen.header.frame_id == "eye"
    found = to_numpy(uncompressed(seen))[0]
    assert found[:2] == pytest.approx([1.0, 2.5], rel=1e-3)
    assert np.isnan(found[2])


async def test_colours_are_no_depths(
    start: Start, viewer: Viewer, capsys: pytest.CaptureFixture[str]
) -> None:
    """A listener to compressedDepth of a colour camera gets an error; other transports go on."""
    start(Republisher)
    viewer.look(CompressedImage, "out/compressedDepth")
    viewer.look(Image, "out")
    (seen,) = await viewer.show(Image, "in", picture())

    assert seen.encoding == "bgr8"
    assert "bgr8 is not for depths; use 16UC1, mono16 or 32FC1" in capsys.readouterr().err


async def test_compressed_images_become_raw_ones(start: Start, viewer: Viewer) -> None:
    """With the arguments of older launch files."""
    start(Republisher, "compressed", "raw")
    viewer.look(Image, "out")
    small = compressed(picture("rgb8"), "png", 95, 3)
    (seen,) = await viewer.show(CompressedImage, "in/compressed", small)

    assert seen.encoding == "rgb8"
    assert np.array_equal(to_numpy(seen), GRADIENT)


async def test_nothing_is_received_while_nobody_looks(start: Start, viewer: Viewer) -> None:
    """A camera may then stand still, or its network be free."""
    node = start(Republisher)
    publisher = viewer.node.create_publisher(Image, "in", 10)
    await settle()
    assert publisher.get_subscription_count() == 0

    looking = viewer.look(Image, "out")
    await settle()
    assert publisher.get_subscription_count() == 1
    looking.destroy()
    await settle()
    assert publisher.get_subscription_count() == 0
    assert node.input is None


async def test_format_and_quality_are_parameters(start: Start, viewer: Viewer) -> None:
    """Under the names of the original."""
    start(Republisher, out_transport="compressed", **{"out.compressed.format": "png"})
    viewer.look(CompressedImage, "out/compressed")
    (seen,) = await viewer.show(Image, "in", picture())

    assert seen.format == "bgr8; png compressed bgr8"
    assert np.array_equal(to_numpy(uncompressed(seen)), GRADIENT)


@pytest.mark.parametrize(
    ("encoding", "channels", "back"),
    [("mono8", 1, "mono8"), ("rgba8", 4, "rgba8"), ("bgra8", 4, "bgra8")],
)
def test_images_come_back_in_their_encoding(encoding: str, channels: int, back: str) -> None:
    """Grey images stay grey; JPEG has no alpha channel, so it is opaque again."""
    pixels: npt.NDArray[np.uint8] = np.full((8, 8, channels), 255, np.uint8).squeeze()

    found = uncompressed(compressed(from_numpy(pixels, encoding), "jpeg", 95, 3))

    assert found.encoding == back
    assert np.abs(to_numpy(found).astype(int) - pixels).max() < 5


async def test_an_image_that_cannot_be_written_is_said_once(
    start: Start, viewer: Viewer, capsys: pytest.CaptureFixture[str]
) -> None:
    """The others go on."""
    start(Republisher)
    viewer.look(CompressedImage, "out/compressed")
    wrong = from_numpy(GRADIENT[..., 0], "bayer_rggb8")
    seen = await viewer.show(Image, "in", wrong, wrong, picture())

    assert len(seen) == 1
    assert capsys.readouterr().err.count("an image is skipped: ") == 1


async def test_a_rule_may_name_the_topic_or_its_base(
    start: Start, node_factory: Callable[..., Any]
) -> None:
    """Launch files have both forms."""
    from aionode import Node

    own = Node("own", cli_args=["--ros-args", "-r", "in/compressed:=/camera/small"])
    base = Node("base", cli_args=["--ros-args", "-r", "in:=/camera/image"])
    try:
        assert topic_of(own, "in", "compressed") == "/camera/small"
        assert topic_of(base, "in", "compressed") == "/camera/image/compressed"
        assert topic_of(base, "in", "raw") == "/camera/image"
    finally:
        own.destroy_node()
        base.destroy_node()


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("in_transport", "theora", "in_transport is 'theora', which is not available here"),
        ("out.compressed.format", "tiff", "'tiff'; use jpeg or png"),
        ("out.compressedDepth.format", "rvl", "'rvl'; use png"),
    ],
)
async def test_what_there_is_not_is_refused(start: Start, name: str, value: str, text: str) -> None:
    """The error says what is available."""
    with pytest.raises(CommandError, match=text):
        start(Republisher, **{name: value})
