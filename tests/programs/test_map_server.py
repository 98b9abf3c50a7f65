"""The program that publishes a map from a file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from aionode.interfaces.nav2_msgs.srv import LoadMap
from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.nav_msgs.srv import GetMap
from aionode.lifecycle import TransitionCallbackReturn
from aionode.programs._map_server.map_file import ROWS, MapImageError, MapYamlError, load_map
from aionode.programs._map_server.map_server import MapServer
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import settle
from tests.programs.conftest import Start

YAML = """
image: {image}
resolution: 0.05
origin: [-1.0, 2.0, {yaw}]
negate: {negate}
occupied_thresh: 0.65
free_thresh: 0.25
{more}
"""

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

Make = Callable[..., Path]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Write a map of gray values."""

    def write(
        pixels: Any = ((0, 255), (128, 254)),
        image: str = "a.pgm",
        more: str = "",
        negate: int = 0,
        yaw: float = 0.0,
    ) -> Path:
        Image.fromarray(np.array(pixels, np.uint8)).save(tmp_path / image)
        file = tmp_path / f"{image}.yaml"
        file.write_text(YAML.format(image=image, more=more, negate=negate, yaw=yaw))
        return file

    return write


def test_the_upper_row_of_a_picture_is_the_last_one_of_a_map(make: Make) -> None:
    """Dark is occupied, bright is free, and what is between is unknown."""
    grid = load_map(make(yaw=np.pi))

    assert list(grid.data) == [-1, 0, 100, 0]
    assert (grid.info.width, grid.info.height) == (2, 2)
    assert grid.info.resolution == pytest.approx(0.05)
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == (-1.0, 2.0)
    assert grid.info.origin.orientation.z == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("more", "negate", "cells"),
    [
        ("", 1, [-1, 100, 0, 100]),
        ("mode: scale", 0, [62, 0, 100, 0]),
        ("mode: raw", 0, [-1, -1, 0, -1]),
    ],
)
def test_modes_and_the_meaning_of_dark_are_those_of_the_file(
    make: Make, more: str, negate: int, cells: list[int]
) -> None:
    """As in Nav2."""
    assert list(load_map(make(more=more, negate=negate)).data) == cells


def test_what_is_transparent_is_unknown_in_the_mode_scale(make: Make) -> None:
    """In a picture with such a channel."""
    pixels = [[(0, 0, 0, 255), (0, 0, 0, 0)]]

    assert list(load_map(make(pixels, "a.png", more="mode: scale")).data) == [100, -1]


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("resolution: 0.05", "", "'resolution' is None; use a width above 0"),
        ("[-1.0, 2.0, 0.0]", "[1.0]", r"'origin' is \[1.0\]; use a list of three numbers"),
        ("negate: 0", "negate: x", "'negate' is 'x'; use 0 or 1"),
        ("free_thresh: 0.25", "mode: sharp", "'free_thresh' is None"),
        ("image: a.pgm", "- a", "a.pgm.yaml: "),
    ],
)
def test_a_file_that_cannot_be_used_says_why(make: Make, old: str, new: str, problem: str) -> None:
    """Somebody wrote it by hand."""
    file = make()
    file.write_text(file.read_text().replace(old, new))

    with pytest.raises(MapYamlError, match=problem):
        load_map(file)


def test_a_picture_that_is_missing_is_named(make: Make, tmp_path: Path) -> None:
    """It is beside the file, unless its path is absolute."""
    file = make()
    (tmp_path / "a.pgm").unlink()

    with pytest.raises(MapImageError, match=r"a\.pgm"):
        load_map(file)


async def test_a_map_is_published_for_whoever_comes_late(
    make: Make, start: Start, node_factory: Callable[..., Any]
) -> None:
    """Once the node is active; before, requests get none."""
    server = start(MapServer, yaml_filename=str(make()), frame_id="house")
    user = node_factory("user")
    client = user.create_client(GetMap, "/map_server/map")
    assert await server.trigger_configure() is TransitionCallbackReturn.SUCCESS
    assert not (await client.call(GetMap.Request())).map.data.size
    assert await server.trigger_activate() is TransitionCallbackReturn.SUCCESS
    heard: list[OccupancyGrid] = []
    user.create_subscription(OccupancyGrid, "map", heard.append, LATCHED)
    await settle()

    assert heard[-1].header.frame_id == "house"
    assert list((await client.call(GetMap.Request())).map.data) == [-1, 0, 100, 0]


async def test_another_map_is_loaded_on_request(
    make: Make, start: Start, node_factory: Callable[..., Any]
) -> None:
    """A map that does not exist is not loaded."""
    server = start(MapServer)
    user = node_factory("user")
    assert await server.trigger_configure() is TransitionCallbackReturn.SUCCESS
    assert await server.trigger_activate() is TransitionCallbackReturn.SUCCESS
    heard: list[OccupancyGrid] = []
    user.create_subscription(OccupancyGrid, "map", heard.append, LATCHED)
    client = user.create_client(LoadMap, "/map_server/load_map")
    missing = await client.call(LoadMap.Request(map_url="/nowhere.yaml"))
    found = await client.call(LoadMap.Request(map_url=str(make())))
    await settle()

    assert missing.result == LoadMap.Response.RESULT_INVALID_MAP_METADATA
    assert found.result == LoadMap.Response.RESULT_SUCCESS
    assert list(heard[-1].data) == list(found.map.data) == [-1, 0, 100, 0]


async def test_a_map_that_cannot_be_read_is_not_configured(
    start: Start, capfd: pytest.CaptureFixture[str]
) -> None:
    """Nav2's manager then says that the robot has no map."""
    server = start(MapServer, yaml_filename="/nowhere.yaml")

    assert await server.trigger_configure() is TransitionCallbackReturn.FAILURE
    assert "Failed to load map yaml file: /nowhere.yaml" in capfd.readouterr().err


def test_a_picture_for_which_pillow_would_start_a_program_is_refused(make: Make) -> None:
    """Any node may have a map loaded; Pillow reads EPS with Ghostscript."""
    with pytest.raises(MapImageError, match="cannot identify"):
        load_map(make(image="a.eps"))


def test_a_map_of_more_rows_than_are_converted_at_once_is_whole(make: Make) -> None:
    """In their order."""
    pixels = np.zeros((2 * ROWS + 1, 1), np.uint8)
    pixels[ROWS] = 255
    cells = np.asarray(load_map(make(pixels)).data)

    assert np.flatnonzero(cells == 0).tolist() == [ROWS]
    assert len(cells) == len(pixels)
