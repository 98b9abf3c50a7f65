"""The painted map beside one that cairo paints, with the calls of cartographer's submap_painter."""

from __future__ import annotations

import ctypes
import ctypes.util
import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.programs._cartographer.canvas import Canvas
from aionode.programs._cartographer.submaps import Placement, Submap, Texture

FOUND: Final = ctypes.util.find_library("cairo")

pytestmark = pytest.mark.skipif(FOUND is None, reason="libcairo is not installed")

CAIRO: Any = FOUND and ctypes.CDLL(FOUND)

Array = npt.NDArray[Any]
Draw = Callable[[Any, Submap], None]

ARGB32: Final = 0
MOST: Final = 6
"""How far intensities may differ, of 255: cairo weighs neighbours in steps of 1/128."""


class Matrix(ctypes.Structure):
    """An affine map: ``xx``, ``yx``, ``xy``, ``yy``, ``x0``, ``y0``."""

    _fields_ = tuple((name, ctypes.c_double) for name in ("xx", "yx", "xy", "yy", "x0", "y0"))


def call(name: str, *arguments: Any, returns: Any = None) -> Any:
    """Call a function of cairo; ints and floats are C's int and double, others pointers."""
    function = getattr(CAIRO, f"cairo_{name}")
    function.restype = returns
    kinds = {int: ctypes.c_int, float: ctypes.c_double}
    return function(
        *(kinds[type(each)](each) if type(each) in kinds else each for each in arguments)
    )


def pointer(name: str, *arguments: Any) -> Any:
    """Call a function of cairo that returns a pointer."""
    return ctypes.c_void_p(call(name, *arguments, returns=ctypes.c_void_p))


def each_submap(context: Any, submaps: list[Submap], resolution: float, draw: Draw) -> None:
    """Draw submaps at their places."""
    call("scale", context, 1 / resolution, 1 / resolution)
    for submap in submaps:
        (turn, place), (own_turn, own_place) = (
            part.placement.matrices() for part in (submap, submap.texture)
        )
        (a, b, _), (c, d, _), _ = (turn @ own_turn).tolist()
        x, y, _ = (place + turn @ own_place).tolist()
        call("save", context)
        call("transform", context, ctypes.byref(Matrix(c, a, -d, -b, x, -y)))
        call("scale", context, submap.texture.resolution, submap.texture.resolution)
        draw(context, submap)
        call("restore", context)


def painted_by_cairo(submaps: list[Submap], resolution: float) -> tuple[Array, Array]:
    """Return the intensities of a map, and which cells were seen."""
    corners: list[tuple[float, float]] = []
    kept: list[Array] = []

    def measure(context: Any, submap: Submap) -> None:
        height, width, _ = submap.texture.cells.shape
        for column in (0, width):
            for row in (0, height):
                x, y = ctypes.c_double(column), ctypes.c_double(row)
                call("user_to_device", context, ctypes.byref(x), ctypes.byref(y))
                corners.append((x.value, y.value))

    def paint(context: Any, submap: Submap) -> None:
        intensity, opacity, seen = np.moveaxis(submap.texture.cells.astype(np.uint32), -1, 0)
        pixels = np.ascontiguousarray(opacity << 24 | intensity << 16 | seen << 8)
        kept.append(pixels)
        height, width = pixels.shape
        data = ctypes.c_void_p(pixels.ctypes.data)
        picture = pointer("image_surface_create_for_data", data, ARGB32, width, height, 4 * width)
        call("set_source_surface", context, picture, 0.0, 0.0)
        call("paint", context)

    context = pointer("create", pointer("image_surface_create", ARGB32, 1, 1))
    each_submap(context, submaps, resolution, measure)
    low, high = (bound(np.array(corners, np.float32), axis=0) for bound in (np.min, np.max))
    width, height = (int(length) + 10 for length in np.ceil(high - low))
    surface = pointer("image_surface_create", ARGB32, width, height)
    context = pointer("create", surface)
    call("set_source_rgba", context, 0.5, 0.0, 0.0, 1.0)
    call("paint", context)
    call("translate", context, *(float(np.float32(5) - bound) for bound in low))
    each_submap(context, submaps, resolution, paint)
    call("surface_flush", surface)
    assert call("status", context, returns=ctypes.c_int) == 0
    data = call("image_surface_get_data", surface, returns=ctypes.c_void_p)
    whole = ctypes.cast(data, ctypes.POINTER(ctypes.c_uint32))
    pixels = np.ctypeslib.as_array(whole, (height, width)).copy()
    return pixels >> 16 & 255, pixels >> 8 & 255


def flat(x: float, y: float, yaw: float) -> Placement:
    """Return a place in the plane."""
    return Placement((x, y, 0.0), (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))


def random_submap(random: np.random.Generator) -> Submap:
    """Return a submap with all kinds of cells, somewhere."""
    height, width = random.integers(1, 50, 2)
    free = random.integers(-127, 128, (height, width))
    seen = random.random((height, width)) < 0.8
    intensity, opacity = np.maximum(free, 0), np.maximum(-free, free == 0)
    cells = np.dstack((intensity, opacity, np.full_like(free, 255))) * seen[..., None]
    x, y, own_x, own_y = random.uniform(-2, 2, 4)
    yaw, own_yaw = random.uniform(-4, 4, 2)
    texture = Texture(
        1, cells.astype(np.uint8), random.uniform(0.03, 0.12), flat(own_x, own_y, own_yaw)
    )
    return Submap(flat(x, y, yaw), texture)


@settings(max_examples=30)
@given(st.integers(0, 2**32), st.integers(1, 5), st.floats(0.02, 0.3))
def test_submaps_are_painted_as_by_cairo(seed: int, count: int, resolution: float) -> None:
    """At all places and angles, finer and coarser, but for what rounding does."""
    random = np.random.default_rng(seed)
    submaps = [random_submap(random) for _ in range(count)]
    canvas = Canvas(submaps, resolution)
    for _ in canvas.strokes():
        pass
    intensity, seen = painted_by_cairo(submaps, resolution)

    assert canvas.seen.shape == seen.shape
    assert np.abs(canvas.intensity.astype(int) - intensity.astype(int)).max() <= MOST
    known = np.count_nonzero(seen)
    assert np.count_nonzero((canvas.seen > 0) != (seen > 0)) <= 2 + known / 50
