"""``aionode topic hz``, ``bw`` and ``delay``, in stepped time."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from click.testing import CliRunner

from aionode import Context, Node, QoSProfile
from aionode.cli._nouns.topic import measure
from aionode.cli._nouns.topic.measure import bw, delay, hz
from aionode.cli._support.session import make_node
from aionode.engine.transport.local import LocalTransport
from aionode.errors import CommandError
from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.geometry_msgs.msg import TwistStamped
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.testing import FaultyTransport, ManualClock, settle


@pytest.fixture
async def talker(node_factory: Callable[..., Node], manual_clock: ManualClock) -> Node:
    """A node that publishes 20 bytes on /chatter, 5 times a second."""
    node = node_factory("talker")
    publisher = node.create_publisher(String, "/chatter", 10)
    node.create_timer(0.2, lambda: publisher.publish(String(data="Hello 00000")))
    await manual_clock.advance(0.05)  # so that no message arrives just when rates are printed
    return node


async def test_hz_prints_the_rate_once_a_second(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """Text and digits are ros2's."""
    async with running(hz(tool, ["/chatter"], output=screen.output)):
        await manual_clock.advance(2.1)

    assert screen.text == (
        "average rate: 5.000\n"
        "\tmin: 0.200s max: 0.200s std dev: 0.00000s window: 4\n"
        "average rate: 5.000\n"
        "\tmin: 0.200s max: 0.200s std dev: 0.00000s window: 9\n"
    )


@pytest.mark.slow
async def test_hz_is_right_at_ten_kilohertz(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """The time of arrival counts, not that of processing."""
    fast = node_factory("fast")
    publisher = fast.create_publisher(String, "/fast", 10)
    fast.create_timer(0.0001, lambda: publisher.publish(String()))

    async with running(hz(tool, ["/fast"], output=screen.json_output)):
        await manual_clock.advance(1.05)

    assert screen.records[0]["rate_hz"] == pytest.approx(10_000, rel=1e-6)


async def test_hz_prints_nothing_without_messages(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """An outdated rate is not repeated."""
    async with running(hz(tool, ["/chatter"], output=screen.output)):
        await manual_clock.advance(1.1)
        talker.destroy_node()
        await manual_clock.advance(3.0)

    assert screen.text.count("average rate") <= 2


async def test_hz_takes_the_window_into_account(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """The rate is that of the newest messages."""
    async with running(hz(tool, ["/chatter"], window=3, output=screen.output)):
        await manual_clock.advance(2.1)

    assert screen.text.rstrip().endswith("window: 3")


async def test_hz_of_several_topics_is_a_table(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """One row for each topic, in ros2's columns."""
    other = talker.create_publisher(String, "/other", 10)
    talker.create_timer(0.15, lambda: other.publish(String()))

    async with running(hz(tool, ["/chatter", "/other"], output=screen.output)):
        await manual_clock.advance(1.05)

    assert screen.text == (
        "Subscribed to [/chatter]\n"
        "Subscribed to [/other]\n"
        " topic      rate   min_delta   max_delta   std_dev   window\n"
        "===========================================================\n"
        "/chatter   5.000   0.200       0.200       0.00000   4     \n"
        "/other     6.667   0.150       0.150       0.00000   5     \n\n"
    )


async def test_hz_has_a_row_for_a_silent_topic(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """Otherwise it looks as if it had not been requested."""
    talker.create_publisher(String, "/silent", 10)

    async with running(hz(tool, ["/silent", "/chatter"], output=screen.output)):
        await manual_clock.advance(1.05)

    assert screen.text.endswith(
        "/silent    -       -           -           -         -     \n"
        "/chatter   5.000   0.200       0.200       0.00000   4     \n\n"
    )


async def test_hz_does_not_wait_for_a_topic_that_nobody_has(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """ros2 measures none until all exist."""
    async with running(hz(tool, ["/late", "/chatter"], output=screen.json_output)):
        await manual_clock.advance(1.05)
        late, chatter = screen.records
        publisher = talker.create_publisher(String, "/late", 10)
        talker.create_timer(0.1, lambda: publisher.publish(String()))
        await manual_clock.advance(2.0)

    assert chatter["rate_hz"] == pytest.approx(5.0)
    assert (late["rate_hz"], late["min_s"], late["window"]) == (0.0, None, 0)
    assert screen.records[-2]["rate_hz"] == pytest.approx(10.0)


async def test_hz_shows_that_a_topic_fell_silent(
    running: Any,
    tool: Node,
    talker: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """An old rate would be mistaken for the current one; a slow topic keeps its row."""
    slow = node_factory("slow")
    publisher = slow.create_publisher(String, "/slow", 10)
    slow.create_timer(3.0, lambda: publisher.publish(String()))

    async with running(hz(tool, ["/chatter", "/slow"], output=screen.json_output)):
        await manual_clock.advance(7.0)
        talker.destroy_node()
        await manual_clock.advance(4.0)

    chatter, slowly = screen.records[-2:]
    assert chatter["rate_hz"] == 0.0
    assert slowly["rate_hz"] == pytest.approx(1 / 3)


@pytest.mark.parametrize(
    ("width", "columns"),
    [
        (60, ["topic", "rate", "min_delta", "max_delta", "std_dev", "window"]),
        (59, ["topic", "rate", "min_delta", "max_delta", "std_dev"]),
        (50, ["topic", "rate", "min_delta", "max_delta"]),
        (35, ["topic", "rate", "min_delta"]),
        (20, ["topic", "rate"]),
    ],
)
def test_a_narrow_terminal_drops_columns(width: int, columns: list[str]) -> None:
    """The names of topics and the rates stay whole."""
    rows = [("/chatter", "5.000", "0.200", "0.200", "0.00000", "4"), ("/b", *measure.SILENT)]

    text = measure.fitted_table(measure.HZ_HEADER, rows, width)

    assert max(map(len, text.splitlines())) < width
    assert [word for word in measure.HZ_HEADER if word in text] == columns
    assert re.search(r"/chatter +5\.000", text)


async def test_hz_counts_only_what_the_filter_lets_through(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """Messages are decoded then, as the filter inspects them."""
    counter = node_factory("counter")
    publisher = counter.create_publisher(String, "/count", 10)
    texts = iter(range(1000))
    counter.create_timer(0.1, lambda: publisher.publish(String(data=str(next(texts)))))

    work = hz(tool, ["/count"], filter_text="int(m.data) % 2 == 0", output=screen.json_output)
    async with running(work):
        await manual_clock.advance(1.05)

    assert screen.records[0]["rate_hz"] == pytest.approx(5.0)


async def test_it_waits_for_a_topic_and_says_so(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """The type is known when the first publisher appears."""
    async with running(bw(tool, ["/late"], output=screen.output)):
        assert screen.text == "WARNING: topic [/late] does not appear to be published yet\n"
        node_factory("late").create_publisher(String, "/late", 1)
        await settle()
        assert screen.text.endswith("Subscribed to [/late]\n")


async def test_bw_prints_bytes_per_second_and_sizes(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """CDR with its header, as sent: 4 + 4 + 11 + 1 bytes."""
    async with running(bw(tool, ["/chatter"], output=screen.output)):
        await manual_clock.advance(1.0)

    assert screen.text == (
        "Subscribed to [/chatter]\n"
        "100 B/s from 5 messages\n"
        "\tMessage size mean: 20 B min: 20 B max: 20 B\n"
    )


async def test_bw_of_several_topics_is_a_table(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """In the columns of ros2 in Lyrical, with a row for a silent topic, too."""
    talker.create_publisher(String, "/silent", 10)

    async with running(bw(tool, ["/chatter", "/silent"], output=screen.output)):
        await manual_clock.advance(1.05)

    assert screen.text == (
        "Subscribed to [/chatter]\n"
        "Subscribed to [/silent]\n"
        " topic     bandwidth   window   mean   min    max \n"
        "==================================================\n"
        "/chatter   100 B/s     5        20 B   20 B   20 B\n"
        "/silent    -           -        -      -      -   \n\n"
    )


async def test_bw_of_several_topics_is_a_record_for_each(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """A silent one has no bandwidth, and no sizes."""
    talker.create_publisher(String, "/silent", 10)

    async with running(bw(tool, ["/chatter", "/silent"], output=screen.json_output)):
        await manual_clock.advance(1.05)

    chatter, silent = screen.records
    assert chatter["bytes_per_s"] == pytest.approx(100.0)
    assert (silent["bytes_per_s"], silent["mean_bytes"], silent["window"]) == (0.0, None, 0)


@pytest.mark.parametrize("verb", [hz, bw])
async def test_all_topics_are_those_of_now(
    running: Any, tool: Node, talker: Node, manual_clock: ManualClock, screen: Any, verb: Any
) -> None:
    """This is like --all of ros2 in Lyrical, which prints their number."""
    talker.create_publisher(String, "/other", 10)

    async with running(verb(tool, [], every=True, output=screen.output)):
        await manual_clock.advance(1.05)

    topics = ("/chatter", "/other", "/parameter_events", "/rosout")
    first, *subscribed = screen.text.splitlines()[: 1 + len(topics)]
    assert first == "Subscribing to all 4 available topics..."
    assert subscribed == [f"Subscribed to [{name}]" for name in topics]


@pytest.mark.parametrize("verb", ["hz", "bw"])
@pytest.mark.parametrize(
    ("arguments", "problem"), [([], "--all measures all topics"), (["/a", "--all"], "not both")]
)
def test_names_or_all_topics_are_needed(verb: str, arguments: list[str], problem: str) -> None:
    """The network is not queried before."""
    done = CliRunner().invoke(measure.measuring, [verb, *arguments])

    assert done.exit_code == 2
    assert problem in done.output


async def test_delay_prints_the_age_by_the_header(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """Half a second old on arrival."""
    await manual_clock.advance(10.05)
    camera = node_factory("camera")
    publisher = camera.create_publisher(TwistStamped, "/stamped", 10)

    def publish() -> None:
        now = camera.get_clock().now().nanoseconds - 500_000_000
        stamp = Header()
        stamp.stamp.sec, stamp.stamp.nanosec = divmod(now, 1_000_000_000)
        publisher.publish(TwistStamped(header=stamp))

    camera.create_timer(0.3, publish)
    async with running(delay(tool, "/stamped", output=screen.output)):
        await manual_clock.advance(1.05)

    assert screen.text == (
        "average delay: 0.500\n\tmin: 0.500s max: 0.500s std dev: 0.00000s window: 3\n"
    )


async def test_what_comes_while_publishers_are_connected_is_not_counted(
    node_factory: Callable[..., Node], manual_clock: ManualClock, running: Any, screen: Any
) -> None:
    """Connecting delays messages, which then arrive in a burst: 39 Hz were shown instead of 30."""
    network = FaultyTransport(LocalTransport(), drop=1.0)
    context = Context(transport=[LocalTransport(), network], clock=manual_clock)
    tool = node_factory("tool", context=context)
    publisher = node_factory("burst", context=context).create_publisher(String, "/burst", 10)

    async with running(hz(tool, ["/burst"], output=screen.json_output)):
        for wait_s in (0.1, 0.15, 0.0, 0.0, 0.1, 0.2, 0.2):
            await manual_clock.advance(wait_s)
            publisher.publish(String())
        await manual_clock.advance(0.5)

    assert [record["rate_hz"] for record in screen.records] == [pytest.approx(5.0)]


@pytest.mark.parametrize("stamp", [TimeMsg(sec=-1), TimeMsg(nanosec=4_000_000_000)])
async def test_a_stamp_that_is_no_time_is_a_delay_nevertheless(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
    stamp: TimeMsg,
) -> None:
    """The command reports the difference from any stamp that a driver may write."""
    publisher = node_factory("camera").create_publisher(TwistStamped, "/stamped", 10)

    async with running(delay(tool, "/stamped", output=screen.json_output)):
        now_ns = tool.get_clock().now().nanoseconds
        publisher.publish(TwistStamped(header=Header(stamp=stamp)))
        await manual_clock.advance(1.05)

    expected_s = now_ns / 1e9 - stamp.sec - stamp.nanosec / 1e9
    assert screen.records[0]["delay_s"] == pytest.approx(expected_s)


async def test_delay_needs_a_header(tool: Node, talker: Node, screen: Any) -> None:
    """ros2 fails at the first message, with a traceback."""
    with pytest.raises(CommandError, match="std_msgs/msg/String has no field header"):
        await delay(tool, "/chatter", output=screen.output)


async def test_hz_says_when_messages_came_too_fast(
    running: Any,
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    monkeypatch: pytest.MonkeyPatch,
    screen: Any,
) -> None:
    """A rate that is too low has to be marked as such."""
    monkeypatch.setattr(measure, "QOS", QoSProfile(depth=2))
    publisher = node_factory("burst").create_publisher(String, "/burst", 10)

    async with running(hz(tool, ["/burst"], output=screen.output)):
        for _ in range(5):
            publisher.publish(String())
        await manual_clock.advance(1.05)

    assert screen.errors == (
        "3 messages arrived too fast to be counted: the real rates are higher\n"
    )


async def test_delay_is_that_of_the_simulation_if_asked(
    running: Any,
    aionode_context: Context,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """A simulated stamp cannot be compared with this machine's clock."""
    simulator = node_factory("simulator")
    clock = simulator.create_publisher(Clock, "/clock", 1)
    publisher = simulator.create_publisher(TwistStamped, "/stamped", 10)
    async with (
        make_node(aionode_context, use_sim_time=True) as tool,
        running(delay(tool, "/stamped", output=screen.json_output)),
    ):
        clock.publish(Clock(clock=TimeMsg(sec=100)))
        await settle()
        publisher.publish(TwistStamped(header=Header(stamp=TimeMsg(sec=98))))
        await settle()
        clock.publish(Clock(clock=TimeMsg(sec=102)))
        await manual_clock.advance(1.0)

    assert screen.records[0]["delay_s"] == 2.0
