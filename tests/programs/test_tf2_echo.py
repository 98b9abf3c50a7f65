"""The program that prints a transform."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from aionode.programs._tf2.echo import Echo, text_of
from aionode.testing import ManualClock, settle
from aionode.tf import TransformBroadcaster
from aionode.tf._arithmetic import from_angles
from tests.programs.conftest import Start
from tests.support.peers import isolated_environment
from tests.support.transforms import transform

QUARTER = math.sqrt(0.5)


def turned(x: float, y: float, z: float, w: float) -> TransformStamped:
    """Return a transform with a rotation, 1.5 s after the epoch."""
    stamped = TransformStamped(
        transform=Transform(
            translation=Vector3(x=1.0, y=2.0, z=-0.5), rotation=Quaternion(x=x, y=y, z=z, w=w)
        )
    )
    stamped.header.stamp.sec = 1
    stamped.header.stamp.nanosec = 500_000_000
    return stamped


def test_a_transform_is_printed_as_in_the_original() -> None:
    """Scripts read it."""
    assert text_of(turned(0.0, 0.0, QUARTER, QUARTER)) == (
        "At time 1.500000000\n"
        "- Translation: [1.000, 2.000, -0.500]\n"
        "- Rotation: in Quaternion [0.000, 0.000, 0.707, 0.707]\n"
        "- Rotation: in RPY (radian) [0.000, -0.000, 1.571]\n"
        "- Rotation: in RPY (degree) [0.000, -0.000, 90.000]\n"
        "- Matrix:\n"
        "  0.000 -1.000  0.000  1.000\n"
        "  1.000  0.000  0.000  2.000\n"
        "  0.000  0.000  1.000 -0.500\n"
        "  0.000  0.000  0.000  1.000\n"
    )


@pytest.mark.parametrize("angles", [(0.1, 0.2, 0.3), (-1.0, 1.5, -3.0), (3.0, -1.2, 2.0)])
def test_angles_are_those_of_the_quaternion(angles: tuple[float, float, float]) -> None:
    """To the digits that are printed."""
    text = text_of(turned(*from_angles(*angles)))

    assert f"(radian) [{', '.join(f'{angle:.3f}' for angle in angles)}]" in text


async def test_it_waits_for_the_first_transform_and_then_prints_at_its_rate(
    manual_clock: ManualClock,
    start: Start,
    node_factory: Callable[..., Any],
    capsys: pytest.CaptureFixture[str],
) -> None:
    """It says what it waits for."""
    texts: list[str] = []
    start(Echo, ("odom", "base"), 2.0, texts.append)
    await manual_clock.advance(1.1)
    assert "Waiting for transform odom ->  base: " in capsys.readouterr().err

    node: Node = node_factory("robot")
    broadcaster = TransformBroadcaster(node)
    broadcaster.sendTransform(transform("odom", "base", 1.0, (1.0, 2.0, 3.0)))
    await settle()
    await manual_clock.advance(2.0)
    assert len(texts) == 4
    assert "- Translation: [1.000, 2.000, 3.000]" in texts[-1]


@pytest.mark.processes
@pytest.mark.parametrize(
    ("words", "status", "text"),
    [
        (["odom"], 1, "Usage: tf2_echo source_frame target_frame [echo_rate]"),
        (["a", "b", "fast"], 2, "Failed to convert rate argument 'fast' to a floating-point"),
        (["a", "b", "1.0foo"], 3, "Failed to convert rate argument '1.0foo' to a floating-point"),
    ],
)
def test_arguments_that_do_not_fit_are_refused(words: list[str], status: int, text: str) -> None:
    """With the status of the original."""
    from tests.support.fork_server import run

    done = run(
        ["-m", "aionode.programs", "tf2_ros", "tf2_echo", *words],
        env={**os.environ, **isolated_environment()},
        timeout=50,
    )

    assert done.returncode == status
    assert text in done.stdout + done.stderr
