"""The program that paints Cartographer's submaps into one map, with a stand-in that serves them."""

from __future__ import annotations

import asyncio
import gzip
import math
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from aionode.errors import CommandError
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.cartographer_ros_msgs.msg import SubmapEntry, SubmapList, SubmapTexture
from aionode.interfaces.cartographer_ros_msgs.srv import SubmapQuery
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion
from aionode.interfaces.nav_msgs.msg import OccupancyGrid
from aionode.interfaces.std_msgs.msg import Header
from aionode.programs._cartographer.canvas import Canvas
from aionode.programs._cartographer.occupancy_grid_node import Flags, OccupancyGridNode, flags_of
from aionode.programs._cartographer.submaps import Submap, placement_of, texture_of
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.programs.conftest import Start
from tests.support.waiting import until

Cells = npt.NDArray[np.uint8]

RESOLUTION = 0.05
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
RANDOM = np.random.default_rng(5)


def pose_at(x: float = 0.0, y: float = 0.0, yaw: float = 0.0, **more: float) -> Pose:
    """Return a pose in the plane."""
    turn = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    for name, value in more.items():
        setattr(turn, name, value)
    return Pose(position=Point(x=x, y=y), orientation=turn)


def texture(cells: Cells, pose: Pose | None = None, /, **more: Any) -> SubmapTexture:
    """Return the message with cells of intensity and opacity."""
    height, width, _ = cells.shape
    given: dict[str, Any] = {
        "cells": gzip.compress(cells.tobytes()),
        "width": width,
        "height": height,
        "resolution": RESOLUTION,
        "slice_pose": pose or pose_at(),
    }
    return SubmapTexture(**given | more)


def submap(cells: Cells, pose: Pose, slice_pose: Pose | None = None) -> Submap:
    """Return a submap at a place."""
    return Submap(placement_of(pose), texture_of(texture(cells, slice_pose), 0))


def uniform(height: int, width: int, intensity: int, opacity: int) -> Cells:
    """Return cells that are all the same."""
    return np.full((height, width, 2), (intensity, opacity), np.uint8)


def painted(*submaps: Submap, resolution: float = RESOLUTION) -> Canvas:
    """Return the map of submaps."""
    canvas = Canvas(submaps, resolution)
    for _ in canvas.strokes():
        pass
    return canvas


def at(canvas: Canvas, x: float, y: float, resolution: float = RESOLUTION) -> int:
    """Return the occupancy of the cell that contains a point."""
    column = math.floor((x - canvas.origin[0]) / resolution)
    row = math.floor((y - canvas.origin[1]) / resolution)
    return int(canvas.occupancy()[row, column])


def percent(intensity: float) -> int:
    """Return the occupancy of an intensity."""
    return math.floor((1 - intensity / 255) * 100 + 0.5)


def place_of(row: float, column: float, x: float, y: float, yaw: float) -> tuple[float, float]:
    """Return where the centre of a cell is: rows go along -x of the slice, columns along -y."""
    along, across = -(row + 0.5) * RESOLUTION, -(column + 0.5) * RESOLUTION
    return (
        x + math.cos(yaw) * along - math.sin(yaw) * across,
        y + math.sin(yaw) * along + math.cos(yaw) * across,
    )


@pytest.mark.parametrize("quarter", range(4))
def test_a_submap_is_painted_cell_by_cell_at_its_place(quarter: int) -> None:
    """Turned by quarters, where no cell is mixed of several."""
    seen = RANDOM.integers(1, 128, (4, 6, 2)).astype(np.uint8)
    seen[..., RANDOM.integers(0, 2)] = 0
    seen[1, 2] = 0
    yaw = quarter * math.pi / 2
    canvas = painted(submap(seen, pose_at(1.0, -2.0, yaw)))

    for row, column in np.ndindex(4, 6):
        intensity, opacity = (int(each) for each in seen[row, column])
        wanted = percent(intensity + round(128 * (255 - opacity) / 255))
        if (row, column) == (1, 2):
            wanted = -1
        assert at(canvas, *place_of(row, column, 1.0, -2.0, yaw)) == wanted
    assert canvas.occupancy().shape == ((16, 14) if quarter % 2 == 0 else (14, 16))
    assert np.count_nonzero(canvas.occupancy() >= 0) == 23


def test_the_pose_of_the_slice_is_relative_to_that_of_the_submap() -> None:
    """The slice is 1 m ahead of a submap that looks along y."""
    canvas = painted(submap(uniform(4, 4, 100, 0), pose_at(2.0, 3.0, math.pi / 2), pose_at(1.0)))

    assert at(canvas, *place_of(2, 2, 2.0, 4.0, math.pi / 2)) == percent(228)
    assert canvas.origin == pytest.approx((2.0 - 5 * RESOLUTION, 3.8 - 5 * RESOLUTION))


def test_cells_of_a_turned_submap_are_interpolated() -> None:
    """A slope stays a slope, so each cell is known in advance."""
    slope = uniform(40, 60, 0, 0)
    slope[..., 0] = 2 * np.arange(60) + 1
    yaw = math.radians(30)
    canvas = painted(submap(slope, pose_at(0.3, 0.7, yaw)))
    grid = canvas.occupancy()

    rows, columns = np.mgrid[: grid.shape[0], : grid.shape[1]] + 0.5
    x = canvas.origin[0] + columns * RESOLUTION - 0.3
    y = canvas.origin[1] + rows * RESOLUTION - 0.7
    row = -(math.cos(yaw) * x + math.sin(yaw) * y) / RESOLUTION
    column = -(math.cos(yaw) * y - math.sin(yaw) * x) / RESOLUTION
    inside = (row > 0.5) & (row < 39.5) & (column > 0.5) & (column < 59.5)
    wanted = (1 - (2 * column + 128) / 255) * 100
    far = (row < -0.5) | (row > 40.5) | (column < -0.5) | (column > 60.5)

    assert np.abs(grid - wanted)[inside].max() < 1.0
    assert set(grid[far]) == {-1}
    assert np.count_nonzero(inside) == pytest.approx(39 * 59, abs=60)


def test_a_later_submap_is_painted_over_an_earlier_one() -> None:
    """What makes cells free adds up, and what makes them occupied darkens what was there."""
    free, occupied = uniform(4, 4, 60, 0), uniform(4, 4, 0, 100)
    place = pose_at()
    under, over = submap(free, place), submap(occupied, place)

    assert at(painted(under), -0.1, -0.1) == percent(188)
    assert at(painted(under, under, under), -0.1, -0.1) == percent(255)
    assert at(painted(under, over), -0.1, -0.1) == percent(round(188 * 155 / 255))
    assert at(painted(over, under), -0.1, -0.1) == percent(60 + round(128 * 155 / 255))


def test_a_coarser_map_has_the_mean_of_the_cells() -> None:
    """One cell of the map is four of the submap."""
    cells = uniform(8, 8, 40, 0)
    cells[::2, ::2] = (80, 0)
    canvas = painted(submap(cells, pose_at()), resolution=0.1)

    assert at(canvas, -0.15, -0.15, 0.1) == percent(128 + 50)


@pytest.mark.parametrize("resolution", [5e-324, 1e-200, 1e-9])
def test_a_submap_far_smaller_than_a_cell_has_no_picture(resolution: float) -> None:
    """Nor does it raise an error, whatever its numbers are."""
    small = texture_of(texture(uniform(4, 4, 9, 0), resolution=resolution), 0)
    place = placement_of(pose_at())
    canvas = painted(Submap(place, small), submap(uniform(4, 4, 100, 0), pose_at()))

    assert at(canvas, -0.1, -0.1) == percent(228)


def test_a_submap_seen_from_the_side_has_no_picture() -> None:
    """Its plane is upright."""
    upright = Pose(orientation=Quaternion(y=math.sqrt(0.5), w=math.sqrt(0.5)))
    canvas = painted(submap(uniform(4, 4, 9, 0), upright), submap(uniform(4, 4, 100, 0), pose_at()))

    assert at(canvas, -0.1, -0.1) == percent(228)


def test_only_the_last_submaps_are_painted_anew_if_the_others_have_not_changed() -> None:
    """Cartographer changes the last two with each scan, and a map has hundreds of them."""
    submaps = [
        submap(RANDOM.integers(1, 99, (9, 9, 2)).astype(np.uint8), pose_at(n / 9, n, n))
        for n in range(6)
    ]
    earlier = painted(*submaps)
    submaps[-1] = submap(uniform(9, 9, 3, 9), pose_at(5 / 9, 5, 5))
    canvas = Canvas(submaps, RESOLUTION, earlier.base)

    assert len(list(canvas.strokes())) == 2
    assert np.array_equal(canvas.occupancy(), painted(*submaps).occupancy())


@pytest.mark.parametrize("changed", [0, 3, 5])
def test_what_has_moved_is_painted_anew(changed: int) -> None:
    """Also if it is the last submap that makes the map larger."""
    submaps = [submap(uniform(9, 9, 20 + n, 0), pose_at(n / 9, n / 9, n)) for n in range(6)]
    earlier = painted(*submaps)
    submaps[changed] = submap(uniform(9, 9, 50, 0), pose_at(-2.0, -3.0))
    canvas = Canvas(submaps, RESOLUTION, earlier.base)

    assert len(list(canvas.strokes())) == 6
    assert np.array_equal(canvas.occupancy(), painted(*submaps).occupancy())


def test_a_map_with_fewer_submaps_is_not_painted_twice() -> None:
    """Nothing that Cartographer has deleted, or painted already, is in what the next map needs."""
    submaps = [submap(uniform(9, 9, 20 + n, 0), pose_at()) for n in range(6)]
    fewer = Canvas(submaps[:4], RESOLUTION, painted(*submaps).base)
    list(fewer.strokes())
    canvas = Canvas(submaps[:3], RESOLUTION, fewer.base)
    list(canvas.strokes())

    assert np.array_equal(canvas.occupancy(), painted(*submaps[:3]).occupancy())


def test_a_stroke_of_a_map_with_larger_cells_paints_fewer_of_them() -> None:
    """Each is the mean of many cells of the submap, and Ctrl-C waits for a stroke."""
    coarse = Canvas([submap(uniform(1280, 1280, 1, 0), pose_at())], 16 * RESOLUTION)
    counts = [np.count_nonzero(coarse.seen) for _ in coarse.strokes()]

    assert max(np.diff([0, *counts])) * 17 * 17 <= 1 << 20


PLAIN = uniform(4, 4, 10, 0)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"width": 5}, "its gzip data has 32 bytes; 5 x 4 cells need 40"),
        ({"height": 3}, "its gzip data has more than 24 bytes; 4 x 3 cells need 24"),
        ({"width": -4, "height": -4}, "it has -4 x -4 cells; at most"),
        ({"width": 2**31 - 1, "height": 2**31 - 1}, "it has 2147483647 x 2147483647 cells"),
        ({"cells": b"no gzip"}, "its cells are not gzip data"),
        ({"cells": b""}, "its gzip data has 0 bytes"),
        ({"cells": gzip.compress(PLAIN.tobytes())[:-9]}, "its gzip data has"),
        ({"resolution": 0.0}, "its resolution is 0.0"),
        ({"resolution": math.nan}, "its resolution is nan"),
        ({"resolution": math.inf}, "its resolution is inf"),
        ({"slice_pose": pose_at(math.nan)}, "its position is not finite"),
        ({"slice_pose": pose_at(w=math.inf)}, "its orientation is not a rotation"),
        ({"slice_pose": Pose(orientation=Quaternion(w=0.0))}, "its orientation is not a rotation"),
    ],
)
def test_what_is_no_submap_is_refused(given: dict[str, Any], text: str) -> None:
    """With one error, whoever answers the service."""
    with pytest.raises(ValueError, match=text):
        texture_of(texture(PLAIN, **given), 0)


def test_cells_are_unpacked_no_further_than_needed() -> None:
    """32 MB of zeros have a thousandth as gzip."""
    bomb = gzip.compress(bytes(1 << 25), 1)
    tracemalloc.start()
    try:
        with pytest.raises(ValueError, match="more than 32 bytes"):
            texture_of(texture(PLAIN, cells=bomb), 0)
        assert tracemalloc.get_traced_memory()[1] < 1 << 22
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("x", [1e5, 1e30, 1.7e308])
def test_a_map_that_would_be_too_large_is_refused(x: float) -> None:
    """Two submaps far apart need all cells in between."""
    near, far = submap(PLAIN, pose_at()), submap(PLAIN, pose_at(x))

    with pytest.raises(ValueError, match=r"the submaps need a map of .* cells; at most 67108864"):
        Canvas([near, far], RESOLUTION)


@pytest.mark.parametrize(
    ("words", "flags", "ignored"),
    [
        ([], Flags(), []),
        (["-resolution", "0.1", "-publish_period_sec", "2"], Flags(0.1, 2.0), []),
        (["--resolution=0.1"], Flags(0.1), []),
        (["-noinclude_frozen_submaps"], Flags(include_frozen_submaps=False), []),
        (["-include_unfrozen_submaps=false"], Flags(include_unfrozen_submaps=False), []),
        (["-include_frozen_submaps", "false"], Flags(), []),
        (["-v=1", "-logtostderr", "word"], Flags(), ["v", "logtostderr"]),
        (["-occupancy_grid_topic", "grid", "--", "-x"], Flags(), ["occupancy_grid_topic"]),
    ],
)
def test_flags_are_written_as_in_gflags(words: list[str], flags: Flags, ignored: list[str]) -> None:
    """With one dash or two; a switch has a value only behind an equals sign."""
    assert flags_of(words) == (flags, ignored)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["-resolution"], "-resolution has no value"),
        (["-resolution", "fine"], "-resolution is 'fine'; use a number from 0.001"),
        (["-resolution=nan"], "-resolution is 'nan'"),
        (["-publish_period_sec=1e9"], "'1e9'; use a number from 0.001 to 100000"),
        (["-publish_period_sec", "0"], "-publish_period_sec is '0'"),
        (["-include_frozen_submaps=maybe"], "'maybe'; use true or false"),
        (["-noinclude_frozen_submaps", "-noinclude_unfrozen_submaps"], "makes no sense"),
    ],
)
def test_a_flag_that_does_not_fit_is_refused(words: list[str], text: str) -> None:
    """The error says what is valid."""
    with pytest.raises(CommandError, match=text):
        flags_of(words)


class Cartographer:
    """Serves submaps, and lists them."""

    def __init__(self, node: Any) -> None:
        self.submaps: dict[int, SubmapTexture] = {}
        self.asked: list[int] = []
        self.versions: dict[int, int] = {}
        self.is_silent = False
        self.publisher = node.create_publisher(SubmapList, "submap_list", 10)
        node.create_service(SubmapQuery, "submap_query", self.serve, concurrent=True)
        self.maps: asyncio.Queue[OccupancyGrid] = asyncio.Queue()
        node.create_subscription(OccupancyGrid, "map", self.maps.put_nowait, LATCHED)

    async def serve(self, request: Any, response: Any) -> Any:
        """Answer with a submap."""
        self.asked.append(request.submap_index)
        if self.is_silent:
            await asyncio.get_running_loop().create_future()
        if request.submap_index not in self.submaps:
            response.status.code, response.status.message = 5, "none\nsuch"
            return response
        response.submap_version = self.versions.get(request.submap_index, 0)
        response.textures = [self.submaps[request.submap_index]]
        return response

    def list(self, **poses: Pose) -> None:
        """List submaps; those whose name begins with f are frozen."""
        entries = [
            SubmapEntry(
                submap_index=int(name[1:]),
                submap_version=self.versions.get(int(name[1:]), 0),
                pose=pose,
                is_frozen=name[0] == "f",
            )
            for name, pose in poses.items()
        ]
        header = Header(frame_id="map", stamp=Time(sec=len(entries)))
        self.publisher.publish(SubmapList(header=header, submap=entries))

    async def next_map(self, count: int) -> OccupancyGrid:
        """Return the next map of a list with a number of submaps."""
        async with asyncio.timeout(20):
            while True:
                found = await self.maps.get()
                if found.header.stamp.sec == count:
                    return found


@pytest.fixture
async def cartographer(node_factory: Callable[..., Any]) -> Cartographer:
    """Return a stand-in for cartographer_node."""
    return Cartographer(node_factory("cartographer_node"))


def known(grid: OccupancyGrid) -> set[int]:
    """Return the occupancies in a map, without the unknown ones."""
    return set(np.asarray(grid.data).tolist()) - {-1}


FAST = Flags(publish_period_sec=0.1)
"""A submap has to be answered within this time, which is short for a busy machine."""


async def test_the_map_has_the_frame_and_the_time_of_the_list(
    start: Start, cartographer: Cartographer
) -> None:
    """It is published again and again, and a submap is fetched once for each version."""
    cartographer.submaps = {0: texture(uniform(4, 6, 100, 0))}
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at(1.0, 2.0))
    grid, _ = await cartographer.next_map(1), await cartographer.next_map(1)

    assert (grid.header.frame_id, grid.info.map_load_time.sec) == ("map", 1)
    assert (grid.info.width, grid.info.height) == (14, 16)
    assert grid.info.resolution == pytest.approx(0.05)
    assert grid.info.origin.position.x == pytest.approx(1.0 - 9 * 0.05)
    assert grid.info.origin.position.y == pytest.approx(2.0 - 11 * 0.05)
    assert known(grid) == {percent(228)}
    assert cartographer.asked == [0]


async def test_a_late_subscription_gets_the_last_map_only(
    start: Start, cartographer: Cartographer, node_factory: Callable[..., Any]
) -> None:
    """Earlier ones would be tens of megabytes that it draws for a moment."""
    cartographer.submaps = {0: texture(PLAIN), 1: texture(PLAIN)}
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at())
    await cartographer.next_map(1)
    cartographer.list(a0=pose_at(), a1=pose_at())
    await cartographer.next_map(2)
    late: list[int] = []
    latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node_factory("late").create_subscription(
        OccupancyGrid, "map", lambda msg: late.append(msg.header.stamp.sec), latched
    )
    await until(lambda: bool(late))

    assert late[0] == 2


async def test_a_submap_is_fetched_again_when_its_version_has_changed(
    start: Start, cartographer: Cartographer
) -> None:
    """And one that is no longer listed is gone."""
    cartographer.submaps = {0: texture(uniform(4, 4, 100, 0)), 1: texture(uniform(4, 4, 50, 0))}
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at(), a1=pose_at(5.0))
    assert known(await cartographer.next_map(2)) == {percent(228), percent(178)}

    cartographer.submaps[1] = texture(uniform(4, 4, 10, 0))
    cartographer.versions[1] = 3
    cartographer.list(a1=pose_at(5.0))

    assert known(await cartographer.next_map(1)) == {percent(138)}
    assert cartographer.asked == [0, 1, 1]


@pytest.mark.parametrize(
    ("flags", "wanted"),
    [
        (Flags(publish_period_sec=0.02, include_frozen_submaps=False), {percent(228)}),
        (Flags(publish_period_sec=0.02, include_unfrozen_submaps=False), {percent(178)}),
    ],
)
async def test_frozen_submaps_are_those_of_a_map_that_was_loaded(
    start: Start, cartographer: Cartographer, flags: Flags, wanted: set[int]
) -> None:
    """Either they or the others are left out."""
    cartographer.submaps = {0: texture(uniform(4, 4, 100, 0)), 1: texture(uniform(4, 4, 50, 0))}
    start(OccupancyGridNode, flags)
    cartographer.list(a0=pose_at(), f1=pose_at(5.0))

    assert known(await cartographer.next_map(2)) == wanted


async def test_a_submap_that_cannot_be_used_does_not_hide_the_others(
    start: Start, cartographer: Cartographer, capsys: pytest.CaptureFixture[str]
) -> None:
    """In the original, it ends the process or hides the later ones."""
    cartographer.submaps = {
        1: texture(PLAIN, width=7),
        2: texture(PLAIN),
        3: texture(uniform(4, 4, 100, 0)),
    }
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at(), a1=pose_at(), a2=pose_at(math.nan), a3=pose_at())

    assert known(await cartographer.next_map(4)) == {percent(228)}
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 1
    assert r"submap (0, 0): submap_query has none: status 5 'none\nsuch'" in said[0]


async def test_a_submap_whose_new_version_cannot_be_had_stays_as_it_was(
    start: Start, cartographer: Cartographer
) -> None:
    """A hole in the map would be worse."""
    cartographer.submaps = {0: texture(uniform(4, 4, 100, 0))}
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at())
    await cartographer.next_map(1)
    cartographer.submaps[0] = texture(PLAIN, cells=b"")
    cartographer.versions[0] = 1
    cartographer.list(a0=pose_at(), a1=pose_at())

    assert known(await cartographer.next_map(2)) == {percent(228)}


async def test_a_service_that_does_not_answer_holds_nothing_up(
    start: Start, cartographer: Cartographer, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is known is still moved, and the next list asks again."""
    cartographer.submaps = {0: texture(uniform(4, 4, 100, 0)), 1: texture(PLAIN)}
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at())
    before = await cartographer.next_map(1)
    cartographer.is_silent = True
    cartographer.list(a1=pose_at(), a2=pose_at(), a0=pose_at(8.0))
    after = await cartographer.next_map(3)

    assert after.info.origin.position.x - before.info.origin.position.x == pytest.approx(8.0)
    assert cartographer.asked == [0, 1]
    assert "submap_query does not answer" in capsys.readouterr().err

    cartographer.is_silent = False
    cartographer.list(a1=pose_at(), a0=pose_at())
    assert known(await cartographer.next_map(2)) == {percent(238)}


async def test_a_map_that_would_be_too_large_is_said(
    start: Start, cartographer: Cartographer, capsys: pytest.CaptureFixture[str]
) -> None:
    """And the node goes on with the next list."""
    cartographer.submaps = {0: texture(PLAIN), 1: texture(PLAIN)}
    start(OccupancyGridNode, FAST)
    cartographer.list(a0=pose_at(), a1=pose_at(1e9))
    await until(lambda: "no map is published: the submaps need" in capsys.readouterr().err)
    cartographer.list(a0=pose_at())

    assert known(await cartographer.next_map(1)) == {percent(138)}
