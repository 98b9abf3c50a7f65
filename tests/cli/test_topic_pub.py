"""``aionode topic pub``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.cli._nouns.topic import pub
from aionode.errors import CommandError, InvalidTopicNameException
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import ManualClock, settle


@pytest.fixture
async def heard(node_factory: Callable[..., Node]) -> list[Any]:
    """The messages that a node receives on /golden."""
    messages: list[Any] = []
    node_factory("listener").create_subscription(String, "/golden", messages.append)
    return messages


async def test_once_prints_what_ros2_prints(tool: Node, heard: list[Any], screen: Any) -> None:
    """The message is shown as Python would make it."""
    await pub(
        tool,
        "/golden",
        "std_msgs/msg/String",
        values="{data: hi}",
        times=1,
        wait_for=1,
        keep_alive_s=0,
        output=screen.output,
    )
    await settle()

    assert screen.text == (
        "publisher: beginning loop\npublishing #1: std_msgs.msg.String(data='hi')\n\n"
    )
    assert heard == [String(data="hi")]


async def test_a_short_type_name_is_understood(tool: Node, heard: list[Any], screen: Any) -> None:
    """std_msgs/String is the form of ROS 1, and ros2 accepts it."""
    await pub(tool, "/golden", "std_msgs/String", times=1, keep_alive_s=0, output=screen.output)
    await settle()

    assert heard == [String()]


async def test_the_rate_is_kept_on_a_grid(
    running: Any, tool: Node, heard: list[Any], manual_clock: ManualClock, screen: Any
) -> None:
    """ros2 publishes late by the time that printing takes, so that 10 Hz become 9.8."""
    work = pub(tool, "/golden", "std_msgs/msg/String", rate=10.0, output=screen.output)
    async with running(work):
        await manual_clock.advance(1.0)

    assert len(heard) == 11  # the first one at once


async def test_times_ends_after_so_many(
    running: Any, tool: Node, heard: list[Any], manual_clock: ManualClock, screen: Any
) -> None:
    """The node stays for keep-alive seconds, so that slow readers get the last message."""
    work = pub(
        tool, "/golden", "std_msgs/msg/String", times=2, rate=10.0, keep_alive_s=0.1,
        print_nth=2, output=screen.output,
    )  # fmt: skip
    async with running(work) as task:
        await manual_clock.advance(0.1)
        assert not task.done()
        await manual_clock.advance(0.1)
        assert task.done()

    assert len(heard) == 2
    assert screen.text.count("publishing #") == 1


async def test_it_waits_for_subscriptions_and_says_so(
    running: Any, tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Otherwise the only message of --once is lost."""
    heard: list[Any] = []
    work = pub(
        tool, "/golden", "std_msgs/msg/String", times=1, wait_for=1, keep_alive_s=0,
        output=screen.output,
    )  # fmt: skip
    async with running(work) as task:
        assert screen.text == "Waiting for at least 1 matching subscription(s)...\n"
        node_factory("late").create_subscription(String, "/golden", heard.append)
        await settle()
        assert task.done()

    assert heard == [String()]


async def test_a_limited_wait_ends_with_the_numbers(tool: Node, screen: Any) -> None:
    """The error says what was expected, what appeared, and how not to wait."""
    with pytest.raises(CommandError, match=r"expected 1, but only got 0 in 0\.001 s"):
        await pub(
            tool, "/golden", "std_msgs/msg/String", times=1, wait_for=1, max_wait_s=0.001,
            output=screen.output,
        )  # fmt: skip


async def test_auto_and_now_are_the_time_of_publishing(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """Each message has its own time, not that of the first."""
    heard: list[Any] = []
    node_factory("listener").create_subscription(TwistStamped, "/stamped", heard.append)
    work = pub(
        tool, "/stamped", "geometry_msgs/msg/TwistStamped", values="{header: auto}",
        output=screen.output,
    )  # fmt: skip
    async with running(work):
        await manual_clock.advance(2.0)

    seconds = [msg.header.stamp.sec for msg in heard]
    assert [second - seconds[0] for second in seconds] == [0, 1, 2]
    assert seconds[0] == manual_clock.now().seconds_nanoseconds()[0] - 2


async def test_json_prints_the_messages(tool: Node, heard: list[Any], screen: Any) -> None:
    """One record for each message, nothing else."""
    await pub(
        tool, "/golden", "std_msgs/msg/String", values="data: hi", times=1, keep_alive_s=0,
        output=screen.json_output,
    )  # fmt: skip

    assert screen.records == [{"data": "hi"}]


@pytest.mark.parametrize(
    ("type_name", "values", "says"),
    [
        ("std_msgs/msg/Strin", "{}", "The passed message type is invalid: std_msgs/msg/Strin"),
        ("std_msgs/msg/Strin", "{}", "did you mean std_msgs/msg/String?"),
        ("std_srvs/srv/Empty", "{}", "not a message"),
        ("nonsense", "{}", "The passed message type is invalid: nonsense"),
        ("std_msgs/msg/String", "{dat: hi}", "Failed to populate field: std_msgs/msg/String.dat"),
        ("std_msgs/msg/String", "{dat: hi}", "did you mean 'data'?"),
        ("std_msgs/msg/Int8", "{data: 300}", "std_msgs/msg/Int8.data: 300"),
        ("std_msgs/msg/Int8", "{data: 300}", "-128 to 127"),
        ("std_msgs/msg/Int8", "{data: x}", "std_msgs/msg/Int8.data: 'x'"),
        ("geometry_msgs/msg/Twist", "{linear: {x: a}}", "geometry_msgs/msg/Twist.linear.x: 'a'"),
        ("std_msgs/msg/String", "{data: hi", "value is not valid YAML: '{data: hi' at its end"),
        ("std_msgs/msg/String", "a: }", "at line 1, column 4"),
        ("std_msgs/msg/String", "hi", "needs to be a dictionary in YAML format: 'hi' is a str"),
        ("std_msgs/msg/String", "[hi]", "'[hi]' is a list; expected '{data: ...}'"),
    ],
)
async def test_what_does_not_fit_is_refused_before_the_first_message(
    type_name: str, values: str, says: str, tool: Node, screen: Any
) -> None:
    """ros2 publishes 300 as an Int8."""
    with pytest.raises(CommandError) as raised:
        await pub(tool, "/golden", type_name, values=values, times=1, output=screen.output)

    assert says in str(raised.value)
    assert screen.text == ""


async def test_a_bad_name_is_refused(tool: Node, screen: Any) -> None:
    """ros2 shows a traceback."""
    with pytest.raises(InvalidTopicNameException):
        await pub(tool, "bad topic", "std_msgs/msg/String", times=1, output=screen.output)


async def test_a_topic_of_another_type_may_be_published_to(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The type that the user gave is used, and the node reports the mismatch."""
    node_factory("listener").create_subscription(Twist, "/golden", lambda msg: None)

    await pub(tool, "/golden", "std_msgs/msg/String", times=1, keep_alive_s=0, output=screen.output)

    assert "publishing #1" in screen.text
