"""``aionode tf``, and what ``aionode doctor`` reports about transforms."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from typing import Any

import click
import pytest

from aionode import Context, Node
from aionode.cli._nouns.doctor import doctor
from aionode.cli._nouns.doctor.transforms import LISTEN_S
from aionode.cli._nouns.tf import (
    echo,
    echo_text,
    list_frames,
    send_static,
    static_transform,
    tree,
)
from aionode.cli._nouns.tf.tree import FrameEdge, as_svg, as_text
from aionode.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from aionode.testing import ManualClock, settle
from aionode.tf import Buffer, StaticTransformBroadcaster, TransformBroadcaster
from aionode.tf.apply import angles_of, matrix_of, pose_of
from tests.support.transforms import transform

NUMBERS: dict[str, float | None] = dict.fromkeys(
    ("x", "y", "z", "qx", "qy", "qz", "qw", "roll", "pitch", "yaw")
)


def test_echo_prints_as_tf2_echo() -> None:
    """Including the nanoseconds, which tf2_echo does not pad with zeros."""
    received = transform("map", "base", 12.000005, (1.0, -2.0, 0.5), yaw=math.pi / 2)
    assert echo_text(received) == (
        "At time 12.5000\n"
        "- Translation: [1.000, -2.000, 0.500]\n"
        "- Rotation: in Quaternion [0.000, 0.000, 0.707, 0.707]\n"
        "- Rotation: in RPY (radian) [0.000, -0.000, 1.571]\n"
        "- Rotation: in RPY (degree) [0.000, -0.000, 90.000]\n"
        "- Matrix:\n"
        "  0.000 -1.000  0.000  1.000\n"
        "  1.000  0.000  0.000 -2.000\n"
        "  0.000  0.000  1.000  0.500\n"
        "  0.000  0.000  0.000  1.000"
    )


def test_angles_at_the_poles_have_no_yaw() -> None:
    """At the poles, roll and yaw rotate about the same axis."""
    half = math.sqrt(0.5)
    upwards = transform("a", "b", 1.0, rotation=(0.0, half, 0.0, half))
    assert angles_of(matrix_of(pose_of(upwards))) == pytest.approx((0, math.pi / 2, 0))


async def test_echo_waits_says_why_and_then_prints(
    tool: Node, node_factory: Callable[..., Node], screen: Any, running: Any
) -> None:
    """At once when the transform is available, and then at the rate."""
    sender = node_factory("sender")
    async with running(echo(tool, "map", "base", 50.0, output=screen.json_output)):
        TransformBroadcaster(sender).sendTransform(transform("map", "base", 3.0))
        for _ in range(50):
            await tool.get_clock().sleep(0.01)
            if len(screen.text.splitlines()) > 1:
                break
    first = screen.records[0]
    assert (first["parent"], first["child"], first["sec"]) == ("map", "base", 3)
    assert first["translation"] == [1.0, 0.0, 0.0]


async def test_tree_and_list_show_what_is_sent(screen: Any) -> None:
    """With rate, age and broadcaster; static transforms have neither rate nor age."""
    clock = ManualClock()
    context = Context(transport="local", clock=clock)
    async with (
        Node("sender", context=context) as sender,
        Node("_tool", context=context) as tool,
        asyncio_task(tree(tool, output=screen.output, listen_s=2.0)) as work,
    ):
        StaticTransformBroadcaster(sender).sendTransform(transform("base", "camera"))
        broadcaster = TransformBroadcaster(sender)
        began = sender.get_clock().now_ns() / 1e9
        for step in range(20):
            broadcaster.sendTransform(transform("odom", "base", began + 0.1 * step))
            await clock.advance(0.1)
        await clock.advance(0.1)
        await work
    assert screen.text == (
        "odom\n└── base        10.5 Hz, 0.100 s old, /sender\n    └── camera  static, /sender\n"
    )


def asyncio_task(work: Any) -> Any:
    """Return a context manager in which a coroutine runs as a task."""
    import asyncio
    from contextlib import asynccontextmanager

    @asynccontextmanager
    async def run() -> Any:
        task = asyncio.get_running_loop().create_task(work)
        await settle()
        try:
            yield task
        finally:
            task.cancel()

    return run()


async def test_list_prints_each_frame_once(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Sorted, including frames that are only parents."""
    StaticTransformBroadcaster(node_factory("sender")).sendTransform(
        [transform("base", "camera"), transform("base", "arm")]
    )
    await list_frames(tool, output=screen.output, listen_s=0.05)
    assert screen.text == "arm\nbase\ncamera\n"


async def test_the_transforms_of_one_robot_of_a_fleet_are_shown(
    tool: Node, node_factory: Callable[..., Node], screen: Any, running: Any
) -> None:
    """Robots that remap /tf into their namespaces would be invisible otherwise."""
    rules = ["--ros-args", "-r", "/tf:=tf", "-r", "/tf_static:=tf_static"]
    robot = node_factory("state", namespace="robot7", cli_args=rules)
    StaticTransformBroadcaster(robot).sendTransform(transform("base", "camera"))
    await list_frames(tool, output=screen.output, namespace="robot7", listen_s=0.05)
    await tree(tool, output=screen.output, namespace="/robot7/", listen_s=0.05)
    await tree(tool, output=screen.output, namespace="robot8", listen_s=0.05)
    assert screen.text == (
        "base\ncamera\n"
        "base\n└── camera  static, /robot7/state\n"
        "no transforms on /robot8/tf or /robot8/tf_static\n"
    )
    async with running(
        echo(tool, "base", "camera", 50.0, output=screen.json_output, namespace="robot7")
    ):
        await settle()
    assert '"child":"camera"' in screen.text


async def test_tree_speaks_the_languages_of_graphviz_and_browsers(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """It also writes JSON."""
    StaticTransformBroadcaster(node_factory("sender")).sendTransform(transform("base", "arm"))
    await tree(tool, output=screen.output, dot=True, listen_s=0.05)
    assert screen.text.startswith('digraph G {\n"base" -> "arm"[label="Broadcaster: /sender')
    await tree(tool, output=screen.output, svg=True, listen_s=0.05)
    assert "</svg>" in screen.text
    screen.stdout.truncate(0)
    screen.stdout.seek(0)
    await tree(tool, output=screen.json_output, listen_s=0.05)
    assert screen.records[0]["broadcaster"] == "/sender"


def edge(parent: str, child: str, *, static: bool = False) -> FrameEdge:
    """Return a transform of a tree."""
    return FrameEdge(child, parent, static, "/n", 0.0 if static else 10.0, 0.5)


def test_a_loop_and_foreign_names_do_no_harm_to_a_picture() -> None:
    """Others name the frames."""
    edges = [edge("a", "b"), edge("b", "a"), edge("<x>", "y&", static=True)]
    assert as_text(edges).splitlines()[0] == "<x>"
    assert "b" in as_text(edges)
    picture = as_svg(edges)
    assert "<x>" not in picture
    assert "&lt;x&gt;" in picture
    assert as_svg([]).endswith("</svg>\n")
    assert as_text([]) == ""


async def test_static_publishes_until_it_is_stopped(
    tool: Node, node_factory: Callable[..., Node], screen: Any, running: Any
) -> None:
    """With the options of static_transform_publisher."""
    buffer = Buffer(node_factory("node"))
    options = NUMBERS | {"x": 1.0, "yaw": math.pi / 2}
    async with running(send_static(tool, "base", "camera", output=screen.output, **options)):
        received = await buffer.wait_for_transform("base", "camera", timeout_sec=5.0)
    assert received.transform.translation.x == 1.0
    assert received.transform.rotation.z == pytest.approx(math.sqrt(0.5))
    assert screen.text == (
        "Spinning until stopped - publishing transform from 'base' to 'camera'\n"
    )


@pytest.mark.parametrize(
    ("frames", "numbers", "text"),
    [
        (("a", "b"), {"qw": 1.0, "yaw": 1.0}, "not both"),
        (("a", "b"), {"qx": 1.0, "qw": 1.0}, "length 1"),
        (("a", "a"), {}, "must be different"),
        (("", "a"), {}, "must be different"),
    ],
)
def test_static_refuses_what_every_buffer_would_refuse(
    frames: tuple[str, str], numbers: dict[str, float | None], text: str
) -> None:
    """The sender learns of it, rather than only the log of each receiver."""
    with pytest.raises(click.UsageError, match=text):
        static_transform(*frames, NUMBERS | numbers)


@pytest.fixture
def diagnose(tool: Node, manual_clock: ManualClock, screen: Any) -> Callable[..., Awaitable[int]]:
    """Run the doctor, which listens for some time of the manual clock."""

    async def run(**options: Any) -> int:
        async with asyncio.TaskGroup() as tasks:
            diagnosis = tasks.create_task(doctor(tool, output=screen.output, **options))
            while not diagnosis.done():
                await manual_clock.advance(LISTEN_S)
        return diagnosis.result()

    return run


async def test_doctor_says_why_a_transform_is_missing(
    diagnose: Callable[..., Awaitable[int]],
    manual_clock: ManualClock,
    node_factory: Callable[..., Node],
    screen: Any,
) -> None:
    """tf2's reason, unconnected trees, old stamps, and a similar name."""
    sender = node_factory("sender")
    TransformBroadcaster(sender)
    static = StaticTransformBroadcaster(sender)
    static.sendTransform([transform("map", "odom"), transform("base_link", "camera")])
    assert await diagnose(transform=("map", "camera")) == 1
    assert (
        "problem: transform from [camera] to [map]: Could not find a connection between 'map' and "
        "'camera'" in screen.text
    )
    assert "2 unconnected trees (roots: base_link, map)" in screen.text
    await diagnose(transform=("map", "base_lnk"))
    assert "Did you mean 'base_link'?" in screen.text
    broadcaster = TransformBroadcaster(sender)
    stale = transform("odom", "base_link", 1.0)
    sender.create_timer(0.05, lambda: broadcaster.sendTransform(stale))
    await manual_clock.advance(10.0)
    await diagnose()
    assert "base_link: its transform in odom is " in screen.text


async def test_doctor_does_not_compare_simulated_stamps_with_this_clock(
    diagnose: Callable[..., Awaitable[int]],
    manual_clock: ManualClock,
    node_factory: Callable[..., Node],
    screen: Any,
) -> None:
    """With a simulation, all of them would look years old."""
    sender = node_factory("sender")
    sender.create_publisher(ClockMsg, "/clock", 10)
    broadcaster = TransformBroadcaster(sender)
    simulated = transform("odom", "base_link", 1.0)
    sender.create_timer(0.05, lambda: broadcaster.sendTransform(simulated))
    await manual_clock.advance(10.0)
    await diagnose(transform=("odom", "base_link"))
    assert "s old" not in screen.text
    assert "0 problem(s)" in screen.text
