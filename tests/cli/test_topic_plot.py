"""``aionode topic plot``: charts of Braille, pictures and records."""

from __future__ import annotations

import asyncio
import math
import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import DurabilityPolicy, QoSProfile, Time, bag
from aionode.cli._nouns.topic.measure import QOS
from aionode.cli._nouns.topic.plot import plot
from aionode.cli._support import braille
from aionode.cli._support.braille import Line, chart
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_msgs.msg import Float64, String

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from aionode import Node
    from aionode.testing import ManualClock

PNG = b"\x89PNG\r\n"
S = 10**9


@pytest.fixture
async def wheels(node_factory: Callable[..., Node], manual_clock: ManualClock) -> Node:
    """A node that publishes a sine and a constant, ten times a second."""
    node = node_factory("wheels")
    command = node.create_publisher(Twist, "/cmd_vel", 10)
    level = node.create_publisher(Float64, "/level", 10)
    count = 0

    def tick() -> None:
        nonlocal count
        count += 1
        message = Twist()
        message.linear.x = math.sin(count / 5)
        command.publish(message)
        level.publish(Float64(data=0.5))

    node.create_timer(0.1, tick)
    await manual_clock.advance(0.01)
    return node


@pytest.mark.usefixtures("wheels")
async def test_a_chart_of_each_field_is_printed_at_the_end(
    running: Any, tool: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """If the output is not a terminal, Ctrl-C prints what has arrived."""
    async with running(plot(tool, ["/cmd_vel.linear.x", "/level.data"], output=screen.output)):
        await manual_clock.advance(3.05)

    first, second = screen.text.split("/cmd_vel.linear.x: ")
    assert "└-10 s" in first
    assert sum(first.count(chr(0x2800 + dots)) for dots in range(1, 256)) > 20
    assert "/level.data: 0.5" in second


@pytest.mark.slow
@pytest.mark.usefixtures("wheels")
async def test_it_ends_after_a_duration_with_a_picture(
    running: Any, tool: Node, manual_clock: ManualClock, screen: Any, tmp_path: Path
) -> None:
    """A topic that nobody publishes does not delay it."""
    file = tmp_path / "plot.png"
    fields = ["/cmd_vel.linear.x", "/nothing.data"]
    doing = plot(tool, fields, output=screen.output, duration=0.5, png=str(file))
    async with running(doing) as task:
        await manual_clock.advance(2.05)
        await task

    assert file.read_bytes().startswith(PNG)
    assert f"{file}: written" in screen.errors


@pytest.mark.usefixtures("wheels")
async def test_each_value_is_a_record_for_programs(
    running: Any, tool: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """With its time, topic and field; no chart."""
    async with running(plot(tool, ["/level.data"], output=screen.json_output)):
        await manual_clock.advance(1.05)

    assert screen.records[0] | {"time_ns": 0} == {
        "time_ns": 0, "topic": "/level", "field": "data", "value": 0.5
    }  # fmt: skip


@pytest.mark.parametrize(
    ("field", "problem"),
    [
        ("/cmd_vel", "give topic and field"),
        (".data", "give topic and field"),
        ("/cmd_vel.", "give topic and field"),
        ("/cmd_vel.linear.w", "no 'w' in it; geometry_msgs/msg/Vector3 has x, y, z"),
        ("/cmd_vel.linear", "is not a number"),
    ],
)
@pytest.mark.usefixtures("wheels")
async def test_what_cannot_be_plotted_is_named(
    tool: Node, manual_clock: ManualClock, running: Any, screen: Any, field: str, problem: str
) -> None:
    """With the valid options."""
    with pytest.raises(CommandError, match=problem):
        await asyncio.gather(plot(tool, [field], output=screen.output), manual_clock.advance(1.0))


@pytest.mark.slow
async def test_messages_that_are_not_drawn_are_counted(
    wheels: Node, tool: Node, manual_clock: ManualClock, running: Any, screen: Any
) -> None:
    """A topic may be faster than the terminal."""
    fast = wheels.create_publisher(Float64, "/fast", 10)
    async with running(plot(tool, ["/fast.data"], output=screen.output)):
        await fast.wait_for_subscribers(1)
        for number in range(QOS.depth + 7):
            fast.publish(Float64(data=float(number)))
        await manual_clock.advance(0.1)

    assert "7 messages arrived too fast to be drawn" in screen.errors


async def test_a_text_is_no_number(
    node_factory: Callable[..., Node], tool: Node, screen: Any
) -> None:
    """Even one that could be parsed as a number."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node_factory("talker").create_publisher(String, "/text", latched)

    async def talk() -> None:
        await publisher.wait_for_subscribers(1)
        publisher.publish(String(data="7"))

    with pytest.raises(CommandError, match="name a number"):
        await asyncio.gather(plot(tool, ["/text.data"], output=screen.output), talk())


async def test_an_array_is_no_number(
    node_factory: Callable[..., Node], tool: Node, screen: Any
) -> None:
    """Although those of NumPy have `__float__`, which fails unless there is one element."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node_factory("laser").create_publisher(LaserScan, "/scan", latched)

    async def measure() -> None:
        await publisher.wait_for_subscribers(1)
        publisher.publish(LaserScan(ranges=[1.0, 2.0]))

    with pytest.raises(CommandError, match=re.escape("float32[] is not a number; name a number")):
        await asyncio.gather(plot(tool, ["/scan.ranges"], output=screen.output), measure())
    assert screen.errors == ""  # one has arrived


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A bag of ten seconds with ranges."""
    path = tmp_path / "run"
    with bag.BagWriter(path) as writer:
        for second in range(11):
            scan = LaserScan(ranges=[float(second), 1.0])
            writer.write_message("/scan", scan, Time(seconds=second))
    return path


@pytest.mark.slow
async def test_a_recording_is_plotted_as_a_whole(
    tool: Node, screen: Any, recording: Path, tmp_path: Path
) -> None:
    """From its first value to its last, whatever the window is."""
    file = tmp_path / "a.png"
    await plot(
        tool, ["/scan.ranges[0]"], output=screen.output, bag_path=str(recording), png=str(file)
    )

    assert "/scan.ranges[0]: 10" in screen.text
    assert "└-10 s" in screen.text
    assert file.read_bytes().startswith(PNG)


async def test_a_topic_that_a_recording_has_not_is_named(
    tool: Node, screen: Any, recording: Path
) -> None:
    """With those that it contains."""
    with pytest.raises(CommandError, match="it has no topic /odom; it has: /scan"):
        await plot(tool, ["/odom.x"], output=screen.output, bag_path=str(recording))


async def test_a_picture_without_a_folder_is_refused_at_once(tool: Node, screen: Any) -> None:
    """The error does not come after minutes of collecting data."""
    with pytest.raises(CommandError, match="there is no folder"):
        await plot(tool, ["/a.b"], output=screen.output, png="/nowhere/at/all.png")


@given(
    points=st.lists(st.tuples(st.integers(0, 10 * S), st.floats()), max_size=30),
    width=st.integers(1, 120),
    height=st.integers(1, 40),
)
def test_any_numbers_are_drawn_within_their_space(
    points: list[tuple[int, float]], width: int, height: int
) -> None:
    """They may be none, equal, infinite, or the largest possible ones."""
    line = Line("name")
    line.points.extend(points)
    pieces = chart([line, line], width=width, height=height, start_ns=0, end_ns=10 * S)
    rows = "".join(text for text, _ in pieces).split("\n")

    assert len(rows) == max(height, 6)
    assert all(len(row) <= max(width, 20) for row in rows)


def test_a_line_rises_from_the_lower_left_to_the_upper_right() -> None:
    """As one line, without gaps."""
    line = Line("name")
    line.points.extend([(0, 0.0), (S, 1.0)])
    pieces = chart([line], width=20, height=12, start_ns=0, end_ns=S)
    rows = [row[10:] for row in "".join(text for text, _ in pieces).split("\n")[:10]]
    ink = [[at for at, char in enumerate(row) if char not in "\u2800 "] for row in rows]

    assert ink[0][-1] == 9
    assert ink[-1][0] == 0
    assert all(ink)


@given(
    values=st.lists(st.floats(width=32), min_size=1, max_size=300), keep_ns=st.none() | st.just(50)
)
def test_a_long_line_keeps_its_extremes_and_its_end(
    values: list[float], keep_ns: int | None
) -> None:
    """A recording is shown whole however long it is, in bounded memory."""
    line = Line("name", keep_ns)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(braille, "MAX_POINTS", 16)
        for time_ns, value in enumerate(values):
            line.add(time_ns, value)
            assert len(line.points) <= 16

    shown = values if keep_ns is None else values[-keep_ns - 1 :]
    finite = [value for value in shown if math.isfinite(value)]
    kept = [value for _, value in line.points]
    assert list(line.points) == sorted(line.points, key=lambda point: point[0])
    assert repr(kept[-1]) == repr(values[-1])
    assert not finite or {min(finite), max(finite)} <= set(kept)
