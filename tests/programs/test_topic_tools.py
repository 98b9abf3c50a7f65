"""The programs of topic_tools: a topic of any type goes on to another one."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_msgs.msg import Float64, Header, String
from aionode.programs._topic_tools.delay import Delay
from aionode.programs._topic_tools.demux import SERVICES as DEMUX_SERVICES
from aionode.programs._topic_tools.demux import Demux
from aionode.programs._topic_tools.drop import Drop
from aionode.programs._topic_tools.mux import SERVICES, Mux
from aionode.programs._topic_tools.relay import Relay
from aionode.programs._topic_tools.relay_field import RelayField
from aionode.programs._topic_tools.relay_field import parser as relay_field_parser
from aionode.programs._topic_tools.throttle import Throttle
from aionode.programs._topic_tools.transform import Transform, chosen_qos, parser
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Bench:
    """A node that publishes on the input, and what arrives at the output."""

    def __init__(self, node: Node, clock: ManualClock) -> None:
        self.node = node
        self.clock = clock
        self.heard: list[str] = []

    def listen(self, topic: str) -> None:
        """Note the texts of a topic."""
        self.node.create_subscription(String, topic, lambda msg: self.heard.append(msg.data))

    async def say(self, publisher: Any, *texts: str) -> list[str]:
        """Publish texts, and return what has arrived."""
        for text in texts:
            publisher.publish(String(data=text))
            await settle()
        return self.heard


@pytest.fixture
async def bench(manual_clock: ManualClock, node_factory: Callable[..., Any]) -> Bench:
    """Return a bench in the context of the programs."""
    return Bench(node_factory("bench"), manual_clock)


@pytest.fixture
def ready(manual_clock: ManualClock) -> Callable[[], Awaitable[None]]:
    """Let programs find publishers, as they do ten times a second."""

    async def wait() -> None:
        await manual_clock.advance(0.25)
        await settle()

    return wait


async def test_a_relay_publishes_what_it_receives(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """Only publishers know the type, and the output topic has the suffix."""
    publisher = bench.node.create_publisher(String, "chatter", 10)
    start(Relay, "chatter")
    bench.listen("chatter_relay")
    await ready()

    assert await bench.say(publisher, "a", "b") == ["a", "b"]


async def test_a_relay_has_the_qos_of_the_publishers(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """A latched topic stays latched; the relay does not offer what one publisher does not."""
    bench.node.create_publisher(String, "map", LATCHED).publish(String(data="floor"))
    node = start(Relay, input_topic="map", output_topic="floor_plan")
    await ready()
    late: list[str] = []
    bench.node.create_subscription(String, "floor_plan", lambda m: late.append(m.data), LATCHED)
    await ready()

    assert late == ["floor"]
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    bench.node.create_publisher(String, "map", best_effort)
    await ready()
    (info,) = node.get_publishers_info_by_topic("floor_plan")
    assert info.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert info.qos_profile.durability is DurabilityPolicy.VOLATILE


async def test_a_lazy_relay_listens_only_while_it_is_heard(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """A camera that nobody watches costs nothing."""
    publisher = bench.node.create_publisher(String, "chatter", 10)
    start(Relay, "chatter", "out", lazy=True)
    await ready()

    assert publisher.get_subscription_count() == 0
    bench.listen("out")
    await ready()
    assert publisher.get_subscription_count() == 1


async def test_a_relay_does_not_hear_itself(start: Start) -> None:
    """One message would come again without end."""
    with pytest.raises(CommandError, match="input and output are the same topic"):
        start(Relay, "chatter", "/chatter")


@pytest.mark.parametrize("kind", [Relay, Delay, Drop, Throttle, Mux])
async def test_a_program_without_a_topic_says_which_parameter_it_needs(
    start: Start, kind: type[Node]
) -> None:
    """It would wait forever."""
    with pytest.raises(CommandError, match=r"parameter 'input_topics?' is required"):
        start(kind)


async def test_drop_leaves_out_the_first_x_of_y_messages(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """As the original counts them."""
    publisher = bench.node.create_publisher(String, "chatter", 10)
    start(Drop, "chatter", "1", "3")
    bench.listen("chatter_drop")
    await ready()

    assert await bench.say(publisher, *"abcdef") == ["b", "c", "e", "f"]


async def test_throttle_lets_as_many_messages_through_as_the_rate_says(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]], manual_clock: ManualClock
) -> None:
    """Messages in between are dropped."""
    publisher = bench.node.create_publisher(String, "chatter", 10)
    start(Throttle, "messages", "chatter", "2")
    bench.listen("chatter_throttle")
    await ready()
    for at in range(20):
        await bench.say(publisher, str(at))
        await manual_clock.advance(0.1)

    assert len(bench.heard) == 4


async def test_throttle_lets_as_many_bytes_through_as_the_window_says(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]], manual_clock: ManualClock
) -> None:
    """The message that passes the limit is the last of the window."""
    publisher = bench.node.create_publisher(String, "chatter", 10)
    start(Throttle, "bytes", "chatter", "100", "1.0", "out")
    bench.listen("out")
    await ready()

    assert len(await bench.say(publisher, *(["x" * 52] * 5))) == 2  # of 61 bytes each
    await manual_clock.advance(1.1)
    assert len(await bench.say(publisher, "x")) == 3


async def test_a_throttle_of_an_unknown_kind_is_refused(start: Start) -> None:
    """The original runs on, and does nothing."""
    with pytest.raises(CommandError, match="Unknown throttle type: 'often'; use messages or bytes"):
        start(Throttle, input_topic="chatter", throttle_type="often")


async def test_delay_publishes_each_message_later(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]], manual_clock: ManualClock
) -> None:
    """In their order, each after the same time."""
    publisher = bench.node.create_publisher(String, "chatter", 10)
    start(Delay, "chatter", "0.5")
    bench.listen("chatter_delay")
    await ready()
    await bench.say(publisher, "a")
    await manual_clock.advance(0.2)
    await bench.say(publisher, "b")

    await manual_clock.advance(0.2)
    await settle()
    assert bench.heard == []
    await manual_clock.advance(0.1)
    await settle()
    assert bench.heard == ["a"]
    await manual_clock.advance(0.2)
    await settle()
    assert bench.heard == ["a", "b"]


async def test_mux_publishes_the_input_that_is_selected(
    bench: Bench,
    start: Start,
    ready: Callable[[], Awaitable[None]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first at the beginning; services change that, as those of the original."""
    one = bench.node.create_publisher(String, "one", 10)
    two = bench.node.create_publisher(String, "two", 10)
    start(Mux, "out", "one", "two")
    bench.listen("out")
    await ready()
    clients = {
        name: bench.node.create_client(kind, f"/mux/{name}") for name, kind in SERVICES.items()
    }

    async def ask(name: str, **request: str) -> Any:
        answer = await clients[name].call(SERVICES[name].Request(**request))
        await ready()
        return answer

    await bench.say(one, "a")
    await bench.say(two, "b")
    assert (await ask("select", topic="/two")).prev_topic == "one"
    await bench.say(one, "c")
    await bench.say(two, "d")
    assert not (await ask("delete", topic="two")).success
    assert (await ask("select", topic="__none")).success
    await bench.say(two, "e")
    assert not (await ask("select", topic="three")).success
    assert (await ask("add", topic="three")).success
    assert not (await ask("add", topic="three")).success
    monkeypatch.setattr("aionode.programs._topic_tools.mux.MAX_TOPICS", 3)
    assert not (await ask("add", topic="four")).success
    assert (await ask("delete", topic="one")).success
    assert list((await ask("list")).topics) == ["two", "three"]
    assert bench.heard == ["a", "d"]


async def test_transform_publishes_what_an_expression_makes_of_messages(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """The example of its documentation: the norm of an orientation."""
    words = [
        *("/imu", "--field", "orientation", "/norm", "std_msgs/Float64"),
        "std_msgs.msg.Float64(data=numpy.sqrt(numpy.sum(numpy.array([m.x, m.y, m.z, m.w]))))",
        *("--import", "std_msgs", "numpy"),
    ]
    publisher = bench.node.create_publisher(Imu, "imu", 10)
    start(Transform, parser().parse_args(words))
    norms: list[float] = []
    bench.node.create_subscription(Float64, "norm", lambda msg: norms.append(msg.data))
    await ready()
    imu = Imu()
    imu.orientation.w, imu.orientation.x = 3.0, 1.0
    publisher.publish(imu)
    await settle()

    assert norms == [2.0]


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ([], (5, ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE)),
        (["--qos-depth", "2"], (2, ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)),
        (["--qos-profile", "services_default", "--qos-history", "keep_last"],
         (10, ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE)),
        (["--qos-reliability", "reliable", "--qos-durability", "transient_local"],
         (5, ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)),
    ],
)  # fmt: skip
def test_options_give_the_qos_of_transform(options: list[str], expected: Any) -> None:
    """Without any it is that of the publishers; with one, the rest is of sensor_data."""
    given = parser().parse_args(["/a", "/b", "std_msgs/String", "m", *options])

    found = chosen_qos(given, [QoSProfile(depth=1)])

    assert (found.depth, found.reliability, found.durability) == expected


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["/a", "/b", "std_msgs/String", "m +"], "Wrong expression: m \\+"),
        (["/a", "/b", "std_msgs/String", "m", "-i", "no_such"], "Failed to import module: no_such"),
        (["/a", "/b", "std_msgs/String", "m", "--field", "."], "Invalid field value"),
    ],
)
async def test_what_is_no_expression_is_refused_at_the_start(
    start: Start, words: list[str], text: str
) -> None:
    """The error does not come with the first message."""
    with pytest.raises(CommandError, match=text):
        start(Transform, parser().parse_args(words))


async def test_demux_publishes_on_the_output_that_is_selected(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """It may be none; topics are added while it runs, and the selected one stays."""
    publisher = bench.node.create_publisher(String, "in", 10)
    start(Demux, "in", "one", "two")
    one = bench.node.create_subscription(String, "one", lambda msg: bench.heard.append(msg.data))
    bench.node.create_subscription(String, "two", lambda msg: bench.heard.append(msg.data * 2))
    ask = {
        name: bench.node.create_client(kind, f"/demux/{name}")
        for name, kind in DEMUX_SERVICES.items()
    }
    types = {name: kind.Request for name, kind in DEMUX_SERVICES.items()}
    await ready()
    assert await bench.say(publisher, "a") == ["a"]

    chosen = await ask["select"].call(types["select"](topic="/two"))
    assert (chosen.success, chosen.prev_topic) == (True, "one")
    await ready()
    assert await bench.say(publisher, "b") == ["a", "bb"]
    assert not (await ask["delete"].call(types["delete"](topic="two"))).success
    assert not (await ask["select"].call(types["select"](topic="four"))).success
    assert (await ask["add"].call(types["add"](topic="three"))).success
    assert (await ask["list"].call(types["list"]())).topics == ["one", "two", "three"]

    assert (await ask["select"].call(types["select"](topic="__none"))).success
    await ready()
    assert await bench.say(publisher, "c") == ["a", "bb"]
    assert one.get_publisher_count() == 0


async def test_demux_needs_an_output(start: Start) -> None:
    """It would publish nowhere."""
    with pytest.raises(CommandError, match="parameter 'output_topics' is required"):
        start(Demux)


async def test_relay_field_fills_a_message_with_expressions(
    bench: Bench, start: Start, ready: Callable[[], Awaitable[None]]
) -> None:
    """A value that is not an expression is a text, and a stamp may be now."""
    publisher = bench.node.create_publisher(String, "in", 10)
    words = ["in", "out", "std_msgs/msg/Header", "{stamp: now, frame_id: m.data + '_frame'}"]
    heard: list[Header] = []
    start(RelayField, relay_field_parser().parse_args(words))
    bench.node.create_subscription(Header, "out", heard.append)
    await ready()
    await bench.say(publisher, "arm")

    assert heard == [Header(stamp=bench.node.get_clock().now().to_msg(), frame_id="arm_frame")]


@pytest.mark.parametrize("expression", ["m.data", "{a: [", "[1]"])
async def test_relay_field_needs_fields(start: Start, expression: str) -> None:
    """The original fails at the first message."""
    words = ["in", "out", "std_msgs/msg/Header", expression]
    with pytest.raises(CommandError, match="Wrong expression"):
        start(RelayField, relay_field_parser().parse_args(words))
