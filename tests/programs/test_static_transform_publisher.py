"""The program that publishes one transform."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode.errors import CommandError
from aionode.programs._static_transform_publisher import Given, StaticTransformPublisher
from aionode.testing import settle
from aionode.tf import Buffer
from tests.programs.conftest import Start

QUARTER = math.sqrt(0.5)


def given(args: str) -> Given:
    """Return what arguments say."""
    return Given.of(args.split())


@pytest.mark.parametrize(
    ("args", "translation", "rotation"),
    [
        ("--frame-id a --child-frame-id b", (0, 0, 0), (0, 0, 0, 1)),
        ("--x 1 --z -2e-1 --frame-id a --child-frame-id b", (1, 0, -0.2), (0, 0, 0, 1)),
        (
            f"--yaw {math.pi / 2} --child-frame-id b --frame-id a --y 3",
            (0, 3, 0),
            (0, 0, QUARTER, QUARTER),
        ),
        (
            f"--qx {QUARTER} --qw {QUARTER} --frame-id a --child-frame-id b",
            (0, 0, 0),
            (QUARTER, 0, 0, QUARTER),
        ),
        (f"1 2 3 {math.pi / 2} 0 0 a b", (1, 2, 3), (0, 0, QUARTER, QUARTER)),
        (f"1 2 3 0 0 {math.pi / 2} a b", (1, 2, 3), (QUARTER, 0, 0, QUARTER)),
        ("1 2 -3 0 1 0 0 a b", (1, 2, -3), (0, 1, 0, 0)),
    ],
)
def test_both_styles_of_arguments_say_a_transform(
    args: str, translation: tuple[float, ...], rotation: tuple[float, ...]
) -> None:
    """Old launch files have values by their places: yaw stands before pitch and roll."""
    found = given(args)

    assert found.translation == pytest.approx(translation)
    assert found.rotation == pytest.approx(rotation)
    assert (found.frame_id, found.child_frame_id) == ("a", "b")


@pytest.mark.parametrize(
    ("args", "text"),
    [
        ("", "Frame id must not be empty"),
        ("--frame-id a", "Child frame id must not be empty"),
        ("--frame-id", "Not enough arguments for --frame-id"),
        ("--x one --frame-id a --child-frame-id b", "Failed to parse --x argument as float"),
        ("--x nan --frame-id a --child-frame-id b", "Failed to parse --x argument as float"),
        (
            "--yaw 1 --qw 1 --frame-id a --child-frame-id b",
            "Cannot specify both quaternion and Euler rotations",
        ),
        ("one 0 0 0 0 0 a b", "Failed to parse x argument as float"),
        ("a b", "Extra unparsed arguments on command-line"),
        ("--x 1 0 0 0 0 0 0 a b", r"Cannot specify both new-style \(flags\) and old-style"),
    ],
)
def test_arguments_that_say_none_are_refused_in_the_words_of_tf2_ros(args: str, text: str) -> None:
    """A frame that is nowhere is looked for in the wrong place."""
    with pytest.raises(ValueError, match=text):
        given(args)


async def test_late_subscribers_receive_the_transform(
    node_factory: Callable[..., Any],
) -> None:
    """The parameters say what it is."""
    node = node_factory(StaticTransformPublisher, given("1 2 3 0 0 0 a b"))
    await settle()

    buffer = Buffer(node_factory("late"))
    await settle()

    found = buffer.lookup_transform("a", "b").transform.translation
    assert (found.x, found.y, found.z) == (1.0, 2.0, 3.0)
    assert node.get_parameter("translation.y").value == 2.0
    assert node.get_parameter("child_frame_id").value == "b"
    assert node.describe_parameter("frame_id").read_only


async def test_a_frame_is_not_its_own_parent(aionode_context: Any) -> None:
    """Listeners would refuse it without a word."""
    with pytest.raises(CommandError, match="child_frame_id cannot equal frame_id"):
        StaticTransformPublisher(given("--frame-id a --child-frame-id a"))


async def test_the_parameters_of_a_node_in_a_container_are_its_transform(
    start: Start, node_factory: Callable[..., Any]
) -> None:
    """There are no arguments there; the defaults are those of tf2_ros."""
    start(
        StaticTransformPublisher, **{"translation.z": 0.5, "frame_id": "a", "child_frame_id": "b"}
    )
    buffer = Buffer(node_factory("listener"))
    await settle()

    found = buffer.lookup_transform("a", "b").transform
    assert (found.translation.z, found.rotation.w) == (0.5, 1.0)
