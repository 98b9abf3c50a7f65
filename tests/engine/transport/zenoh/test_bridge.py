"""Nodes on DDS, reached through a stand-in for `zenoh-bridge-ros2dds`."""

from __future__ import annotations

import asyncio
import logging
import struct
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.wire import cdr
from aionode.errors import RequestTimeoutError
from aionode.graph import EndpointKind
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rcl_interfaces.msg import ParameterValue
from aionode.interfaces.rcl_interfaces.srv import GetParameters
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.parameter_client import AsyncParameterClient
from tests.support.arrivals import writers_of
from tests.support.bridge import ADD, FAST, HEADER, LATCHED, StandIn, add, stand_in, string
from tests.support.peers import KEEP_ALL, kept, quiet_node, two_contexts
from tests.support.waiting import until

FIB = "example_interfaces/action/Fibonacci"
GOAL_STATUS = "action_msgs/msg/GoalStatusArray"
SUM_OF_2_AND_3 = HEADER + struct.pack("<qq", 2, 3)


@pytest.fixture
async def node() -> AsyncIterator[Node]:
    """A node with only what a test creates on it."""
    async with quiet_node("ours") as running:
        yield running


@pytest.fixture
def bridge(node: Node) -> Iterator[StandIn]:
    """A bridge that has found the node; at the end it must have survived everything sent to it."""
    with stand_in() as found:
        yield found
        assert found.deaths == []


async def texts(subscription: Any, count: int) -> list[str]:
    """Return the texts of the next messages."""
    return [(await subscription.receive()).data for _ in range(count)]


async def publish_until_heard(publish: Callable[[bytes], None], subscription: Any) -> None:
    """Publish until the routes are up, and discard what arrived until then."""
    async with asyncio.TaskGroup() as tasks:
        first = tasks.create_task(subscription.receive())
        while not first.done():
            publish(string("hello"))
            await asyncio.sleep(0.01)  # noqa: TID251  # a bridge's route is not announced
    publish(string("last"))
    while (await subscription.receive()).data != "last":
        pass


# Topics


async def test_messages_of_a_dds_node_arrive_in_order_and_once(node: Node, bridge: StandIn) -> None:
    """The basic guarantee, in this direction."""
    subscription = node.create_subscription(String, "/chatter", None, 100)
    publish = bridge.publisher("/chatter")
    await publish_until_heard(publish, subscription)
    for number in range(50):
        publish(string(str(number)))

    assert await texts(subscription, 50) == [str(number) for number in range(50)]


async def test_a_dds_node_gets_our_messages_in_order_and_once(node: Node, bridge: StandIn) -> None:
    """The basic guarantee, in the other direction."""
    received = bridge.subscribe("/chatter")
    publisher = node.create_publisher(String, "/chatter", 100)
    await publisher.wait_for_subscribers()
    for number in range(50):
        publisher.publish(String(data=str(number)))
    await until(lambda: len(received) >= 50)

    assert received == [string(str(number)) for number in range(50)]


async def test_nothing_is_published_on_a_bridges_key_without_a_dds_subscription(
    node: Node, bridge: StandIn
) -> None:
    """Only topics used behind a bridge cost anything."""
    publisher = node.create_publisher(String, "/chatter", 10)
    await until(lambda: any("§chatter" in one or "/chatter/" in one for one in bridge.announced))

    assert not writers_of(publisher)[-1].active


async def test_what_was_published_before_a_bridge_came_reaches_late_dds_nodes() -> None:
    """Transient local messages are for late joiners, and the bridge may be started last."""
    async with quiet_node("ours") as node:
        publisher = node.create_publisher(String, "/latched", kept(3))
        for number in range(5):
            publisher.publish(String(data=str(number)))
        with stand_in() as bridge:
            received = bridge.subscribe("/latched", qos=LATCHED)
            await until(lambda: len(received) >= 3)

        assert received == [string("2"), string("3"), string("4")]
        assert bridge.deaths == []


async def test_a_late_subscription_gets_what_a_dds_node_has_kept(
    node: Node, bridge: StandIn
) -> None:
    """/tf_static and /robot_description depend on it."""
    publish = bridge.publisher("/latched", qos=LATCHED)
    for number in range(5):
        publish(string(str(number)))
    subscription = node.create_subscription(String, "/latched", None, kept(5))

    assert await texts(subscription, 5) == ["0", "1", "2", "3", "4"]


async def test_a_keep_all_subscription_hears_a_dds_node(node: Node, bridge: StandIn) -> None:
    """Its messages reach the queue in another way."""
    subscription = node.create_subscription(String, "/chatter", None, KEEP_ALL)
    publish = bridge.publisher("/chatter")
    await publish_until_heard(publish, subscription)
    publish(string("one"))

    assert await texts(subscription, 1) == ["one"]


async def test_a_second_subscription_can_end_without_the_first(node: Node, bridge: StandIn) -> None:
    """A bridge ends the route with one token of a key, even if other subscriptions remain."""
    first = node.create_subscription(String, "/chatter", None, 10)
    second = node.create_subscription(String, "/chatter", None, 5)
    publish = bridge.publisher("/chatter")
    await publish_until_heard(publish, first)
    second.destroy()
    await until(lambda: sum("/MS/chatter/" in one for one in bridge.seen) == 1)
    publish(string("after"))

    assert await texts(first, 1) == ["after"]
    assert sum("/MS/chatter/" in one for one in bridge.announced) == 1


async def test_each_message_is_heard_once_with_a_bridge_and_peers(bridge: StandIn) -> None:
    """Two contexts beside a bridge have two keys for one topic, and both subscribe to both."""
    dds = bridge.subscribe("/chatter")
    publish = bridge.publisher("/chatter")
    async with (
        two_contexts() as (first, second),
        quiet_node("a", first) as a,
        quiet_node("b", second) as b,
    ):
        publisher = a.create_publisher(String, "/chatter", 100)
        own = a.create_subscription(String, "/chatter", None, 100)
        other = b.create_subscription(String, "/chatter", None, 100)
        await publisher.wait_for_subscribers(3)
        await publish_until_heard(publish, own)
        await publish_until_heard(publish, other)
        dds.clear()
        for number in range(20):
            publisher.publish(String(data=str(number)))
        publish(string("dds"))
        await until(lambda: len(dds) >= 20)
        heard = [await numbers_and_dds(one) for one in (own, other)]

    expected = sorted([*map(str, range(20)), "dds"])
    assert [sorted(one) for one in heard] == [expected, expected]
    assert dds == [string(str(number)) for number in range(20)]


async def numbers_and_dds(subscription: Any) -> list[str]:
    """Return the messages after the greetings, until there are 21 and for a moment longer."""
    found: list[str] = []
    with suppress(TimeoutError):
        while True:
            async with asyncio.timeout(5 if len(found) < 21 else 0.1):
                text = (await subscription.receive()).data
            if text not in {"hello", "last"}:
                found.append(text)
    return found


# Services


async def test_a_dds_server_answers(node: Node, bridge: StandIn) -> None:
    """With a request that has a header, and no attachment that DDS would have to know."""
    bridge.serve("/add_two_ints", ADD, add)
    client = node.create_client(AddTwoInts, "/add_two_ints")
    assert await client.wait_for_service(timeout_sec=5)

    assert (await client.call(AddTwoInts.Request(a=2, b=3), timeout_sec=5)).sum == 5
    assert bridge.served == [SUM_OF_2_AND_3]


async def test_a_dds_client_gets_one_answer(node: Node, bridge: StandIn) -> None:
    """A bridge's requests have their own attachment, and there the last answer counts."""
    node.create_service(
        AddTwoInts, "/add_two_ints", lambda q, a: AddTwoInts.Response(sum=q.a + q.b)
    )
    await until(lambda: any("/SS/add_two_ints/" in one for one in bridge.announced))
    answers = await asyncio.to_thread(bridge.call, "/add_two_ints", SUM_OF_2_AND_3)

    assert answers == [HEADER + struct.pack("<q", 5)]


async def test_a_handler_that_fails_sends_a_dds_client_nothing(node: Node, bridge: StandIn) -> None:
    """DDS has no error replies, and an error would be taken for an answer."""

    def fail(_: AddTwoInts.Request) -> AddTwoInts.Response:
        raise ValueError("no")

    node.create_service(AddTwoInts, "/add_two_ints", fail)
    await until(lambda: any("/SS/add_two_ints/" in one for one in bridge.announced))

    assert await asyncio.to_thread(bridge.call, "/add_two_ints", SUM_OF_2_AND_3) == []


async def test_a_request_is_served_once_with_a_bridge_and_peers(bridge: StandIn) -> None:
    """A client that also asks DDS reaches the queryable that peers have for DDS clients."""
    served: list[int] = []

    def count(request: AddTwoInts.Request) -> AddTwoInts.Response:
        served.append(request.a)
        return AddTwoInts.Response(sum=request.a + request.b)

    bridge.serve("/add_two_ints", ADD, add)
    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as a,
        quiet_node("client", second) as b,
    ):
        a.create_service(AddTwoInts, "/add_two_ints", count)
        client = b.create_client(AddTwoInts, "/add_two_ints")
        await until(lambda: b.graph.count(EndpointKind.SERVER, "/add_two_ints") == 2)
        for number in range(5):
            assert (await client.call(AddTwoInts.Request(a=number, b=1))).sum == number + 1
        await until(lambda: (len(served), len(bridge.served)) == (5, 5))

    assert served == [0, 1, 2, 3, 4]


async def test_a_call_that_fast_dds_leaves_unanswered_names_the_way_out(
    node: Node, bridge: StandIn, caplog: pytest.LogCaptureFixture
) -> None:
    """The service is listed and matched, so a mere time-out would mislead users."""
    bridge.publisher("/chatter", qos=FAST)
    bridge.serve("/add_two_ints", ADD, lambda _: None)
    client = node.create_client(AddTwoInts, "/add_two_ints")
    with caplog.at_level(logging.WARNING):
        assert await client.wait_for_service(timeout_sec=5)
        while "Fast DDS" not in caplog.text:
            assert await client.wait_for_service(timeout_sec=5)
            await checkpoint()
        assert await client.wait_for_service(timeout_sec=5)
        assert await client.wait_for_service(timeout_sec=5)
    with pytest.raises(RequestTimeoutError, match=r"rmw_cyclonedds_cpp.*AIONODE_TRANSPORT=rcl"):
        await client.call(AddTwoInts.Request(), timeout_sec=0.05)

    warnings = [r.getMessage() for r in caplog.records if "Fast DDS" in r.getMessage()]
    assert len(warnings) == 1


async def test_an_action_server_on_fast_dds_is_warned_of(
    node: Node, bridge: StandIn, caplog: pytest.LogCaptureFixture
) -> None:
    """Its goals are requests, and would wait forever."""
    bridge.publisher("/chatter", qos=FAST)
    token = bridge.announce("AS", "/fib", FIB)
    client = node.create_action_client(Fibonacci, "/fib")
    await node.graph.until(lambda: node.graph.count(EndpointKind.PUBLISHER, "/chatter") > 0)
    with caplog.at_level(logging.WARNING):
        assert await client.wait_for_server(timeout_sec=5)
    token.undeclare()

    assert sum("rmw_cyclonedds_cpp" in r.getMessage() for r in caplog.records) == 1


async def test_a_client_on_cyclone_has_no_caveat(
    node: Node, bridge: StandIn, caplog: pytest.LogCaptureFixture
) -> None:
    """The warning is only for robots that need it."""
    bridge.publisher("/chatter")
    bridge.serve("/add_two_ints", ADD, add)
    client = node.create_client(AddTwoInts, "/add_two_ints")
    with caplog.at_level(logging.WARNING):
        await client.wait_for_service()

    assert "Fast DDS" not in caplog.text


# Actions and parameters


async def test_a_goal_goes_to_a_dds_server(node: Node, bridge: StandIn) -> None:
    """The five parts of an action share one token, but each has its own key."""
    status = bridge.publisher("/fib/_action/status", GOAL_STATUS, LATCHED)
    feedback = bridge.publisher("/fib/_action/feedback", f"{FIB}_FeedbackMessage")
    goals: list[bytes] = []

    def accept(request: bytes) -> bytes:
        goals.append(request[4:20])
        return HEADER + struct.pack("<?3xiI", True, 1, 0)

    def result(request: bytes) -> bytes:
        feedback(HEADER + request[4:20] + struct.pack("<I2i", 2, 0, 1))
        status(HEADER + struct.pack("<I", 0))
        return HEADER + struct.pack("<b3xI3i", 4, 3, 0, 1, 1)

    bridge.serve("/fib/_action/send_goal", "", accept, kind="")
    bridge.serve("/fib/_action/cancel_goal", "", lambda _: None, kind="")
    bridge.serve("/fib/_action/get_result", "", result, kind="")
    token = bridge.announce("AS", "/fib", FIB)
    client = node.create_action_client(Fibonacci, "/fib")
    assert await client.wait_for_server(timeout_sec=5)
    handle = await client.send_goal(Fibonacci.Goal(order=3))
    outcome = await handle.result()
    token.undeclare()

    assert list(outcome.result.sequence) == [0, 1, 1]
    assert len(goals) == 1
    assert sum("/AC/fib/" in one for one in bridge.announced) == 1
    assert not [one for one in bridge.announced if "_action" in one]


async def test_a_dds_client_has_a_goal_executed(node: Node, bridge: StandIn) -> None:
    """As `ros2 action send_goal` on the robot does."""

    async def execute(goal: Any) -> Any:
        goal.succeed()
        return Fibonacci.Result(sequence=list(range(goal.request.order)))

    node.create_action_server(Fibonacci, "/fib", execute)
    await until(lambda: any("/AS/fib/" in one for one in bridge.announced))
    goal_id = bytes(range(16))
    (accepted,) = await asyncio.to_thread(
        bridge.call, "/fib/_action/send_goal", HEADER + goal_id + struct.pack("<i", 3)
    )
    (outcome,) = await asyncio.to_thread(bridge.call, "/fib/_action/get_result", HEADER + goal_id)

    assert accepted[4] == 1
    assert outcome == HEADER + struct.pack("<b3xI3i", 4, 3, 0, 1, 2)
    assert not [one for one in bridge.announced if "_action" in one]


async def test_parameters_of_a_dds_node_are_read(node: Node, bridge: StandIn) -> None:
    """Its six services work like any others."""
    for name in (
        "get_parameter_types",
        "set_parameters",
        "set_parameters_atomically",
        "describe_parameters",
        "list_parameters",
    ):
        type_name = "rcl_interfaces/srv/" + name.title().replace("_", "")
        bridge.serve(f"/talker/{name}", type_name, lambda _: None)
    answer = cdr.encode(GetParameters.Response(values=[ParameterValue(type=2, integer_value=7)]))
    bridge.serve("/talker/get_parameters", "rcl_interfaces/srv/GetParameters", lambda _: answer)
    client = AsyncParameterClient(node, "/talker")
    assert await client.wait_for_services(timeout_sec=5)
    (parameter,) = await client.get_parameters(["count"])

    assert parameter.value == 7


async def test_a_dds_node_reads_our_parameters(bridge: StandIn) -> None:
    """DDS does not list our node, but does list its services."""
    async with Node("tuned", context=Context(), enable_rosout=False) as tuned:
        tuned.declare_parameter("count", 7)
        await until(lambda: any("/SS/tuned§get_parameters/" in one for one in bridge.announced))
        request = cdr.encode(GetParameters.Request(names=["count"]))
        (answer,) = await asyncio.to_thread(bridge.call, "/tuned/get_parameters", request)

    assert cdr.decode(GetParameters.Response, answer).values[0].integer_value == 7


# The graph


async def test_a_topic_has_the_type_and_qos_of_its_token(node: Node, bridge: StandIn) -> None:
    """`aionode topic info` shows these."""
    bridge.publisher("/chatter", qos=":0:1:0,7")
    await node.graph.until(lambda: node.graph.count(EndpointKind.PUBLISHER, "/chatter") > 0)
    (found,) = node.graph.endpoints(EndpointKind.PUBLISHER, name="/chatter")

    assert found.type_name == "std_msgs/msg/String"
    assert str(found.qos.reliability.short_key) == "best_effort"
    assert str(found.qos.durability.short_key) == "transient_local"
    assert found.qos.depth == 7
    assert found.node.fully_qualified_name == "/zenoh_bridge_ros2dds"
    assert found.node.bridged


async def test_tools_see_which_node_has_a_topic(node: Node, bridge: StandIn) -> None:
    """Tokens do not say, but the bridge does when asked."""
    bridge.nodes["0110" + "0" * 28 + "/robot/talker"] = {
        "publishers": [{"name": "/chatter", "type": "std_msgs/msg/String"}]
    }
    bridge.publisher("/chatter")
    await node.graph.until(lambda: node.graph.count(EndpointKind.PUBLISHER, "/chatter") > 0)
    for transport in node.context.transports:
        await transport.all_known(1.0)
    (found,) = node.graph.endpoints(EndpointKind.PUBLISHER, name="/chatter")

    assert found.node.fully_qualified_name == "/robot/talker"


async def test_parameter_services_tell_their_node(node: Node, bridge: StandIn) -> None:
    """Most nodes are therefore known without asking the bridge."""
    bridge.serve("/talker/get_parameters", "rcl_interfaces/srv/GetParameters", lambda _: None)
    await node.graph.until(lambda: bool(node.graph.nodes_named("/talker")))
    bridge.end("server /talker/get_parameters")
    await node.graph.until(lambda: not node.graph.nodes_named("/talker"))


async def test_the_tokens_of_other_peers_are_no_bridge(node: Node) -> None:
    """A peer of a bridge announces itself as we do; only a bridge has a bridge token."""
    with stand_in() as one:
        one.token.undeclare()
        await asyncio.to_thread(one.publisher, "/chatter")
        with stand_in(first=False) as other:
            await asyncio.to_thread(other.publisher, "/words")
            await node.graph.until(lambda: node.graph.count(EndpointKind.PUBLISHER, "/words") > 0)

    assert node.graph.count(EndpointKind.PUBLISHER, "/chatter") == 0


async def test_nothing_is_declared_for_bridges_without_one(node: Node) -> None:
    """A process without a bridge pays nothing for it."""
    node.create_subscription(String, "/chatter", None, 10)
    node.create_publisher(String, "/words", kept(1)).publish(String(data="kept"))
    with stand_in() as silent:
        silent.token.undeclare()
        await until(lambda: len(silent.session.info.transports()) > 0)

        assert silent.seen == set()


async def test_publishers_ask_nothing_for_bridges_until_there_is_one(node: Node) -> None:
    """Most programs never see a bridge, and the loop over the writers runs for each message."""
    publisher = node.create_publisher(String, "/chatter", 10)
    without = len(writers_of(publisher))
    with stand_in() as bridge:
        received = bridge.subscribe("/chatter")
        await publisher.wait_for_subscribers()
        publisher.publish(String(data="word"))
        await until(lambda: received)

        assert len(writers_of(publisher)) == without + 1
        assert bridge.deaths == []


async def test_what_was_destroyed_before_a_bridge_came_is_not_announced(node: Node) -> None:
    """It would become an endpoint on DDS that nobody serves."""
    for one in (
        node.create_publisher(String, "/gone", 10),
        node.create_subscription(String, "/gone", None, 10),
        node.create_client(AddTwoInts, "/gone_add"),
        node.create_service(AddTwoInts, "/gone_add", lambda _: AddTwoInts.Response()),
    ):
        one.destroy()
    node.create_publisher(String, "/there", 10)
    with stand_in() as bridge:
        await until(lambda: any("/MP/there/" in one for one in list(bridge.announced)))

        assert not [one for one in bridge.seen if "gone" in one]


# Namespaces, restarts


def names_seen(bridge: StandIn) -> list[str]:
    """Return the names of endpoints that a bridge has seen announced."""
    return [parts[4] for one in bridge.seen if len(parts := one.split("/")) > 4]


async def test_a_bridge_with_a_namespace_carries_what_is_below_it(node: Node) -> None:
    """Anything announced outside it would be listed on DDS, but its messages would go nowhere."""
    with stand_in("/bot1") as bridge:
        publish = bridge.publisher("/chatter")
        subscription = node.create_subscription(String, "/bot1/chatter", None, 100)
        node.create_subscription(String, "/bot10/chatter", None, 10)
        node.create_subscription(String, "/chatter", None, 10)
        await publish_until_heard(publish, subscription)
        received = bridge.subscribe("/words")
        publisher = node.create_publisher(String, "/bot1/words", 10)
        await publisher.wait_for_subscribers()
        publisher.publish(String(data="word"))
        await until(lambda: received)

        assert received == [string("word")]
        announced = {"bot1§chatter", "bot1§words"}
        await until(lambda: {*names_seen(bridge)} >= announced)
        assert {*names_seen(bridge)} == announced
        assert bridge.deaths == []


async def test_a_bridge_that_has_just_started_is_asked_again_for_its_namespace(node: Node) -> None:
    """It announces itself before it can answer; without the answer, all keys would be wrong."""
    with stand_in("/bot1", joins_late=2) as bridge:
        subscription = node.create_subscription(String, "/bot1/chatter", None, 100)
        node.create_subscription(String, "/chatter", None, 10)
        await publish_until_heard(bridge.publisher("/chatter"), subscription)
        await until(lambda: any("bot1§chatter" in one for one in list(bridge.seen)))

        assert {one.split("/")[4] for one in bridge.seen if len(one.split("/")) > 4} == {
            "bot1§chatter"
        }
        assert node.graph.nodes_named("/bot1/zenoh_bridge_ros2dds")


async def test_two_robots_with_namespaces_are_told_apart(node: Node) -> None:
    """With one bridge for each, on one network."""
    with stand_in("/bot1") as one, stand_in("/bot2", first=False) as two:
        first = node.create_subscription(String, "/bot1/chatter", None, 100)
        second = node.create_subscription(String, "/bot2/chatter", None, 100)
        from_one, from_two = one.publisher("/chatter"), two.publisher("/chatter")
        await publish_until_heard(from_one, first)
        await publish_until_heard(from_two, second)
        from_one(string("1"))
        from_two(string("2"))

        assert await texts(first, 1) == ["1"]
        assert await texts(second, 1) == ["2"]
        assert one.deaths == two.deaths == []


async def test_no_bridge_gets_a_name_that_one_of_another_namespace_takes_for_its_own(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """A bridge compares names with its namespace without the slash, and crashes on a match."""
    with stand_in() as root, stand_in("/bot1", first=False) as one:
        await node.graph.until(lambda: sum(found.bridged for found in node.graph.nodes()) == 2)
        with caplog.at_level(logging.WARNING):
            for topic in ("/bot10/chatter", "/bot1", "/bot12", "/bot1/chatter", "/last"):
                node.create_publisher(String, topic, 10)
        await until(lambda: any("/MP/last/" in found for found in list(one.announced)))

        assert root.deaths == one.deaths == []
        assert any("/MP/bot1§chatter/" in found for found in one.announced)
    assert sum("continue without a slash" in found.getMessage() for found in caplog.records) == 1


async def test_what_a_new_bridge_takes_for_its_own_is_withdrawn(node: Node) -> None:
    """The bridge may have crashed because of it by then, but it starts again."""
    with stand_in() as root:
        node.create_publisher(String, "/bot10/chatter", 10)
        await until(lambda: any("/MP/bot10§chatter/" in found for found in list(root.announced)))
        with stand_in("/bot1", first=False):
            await until(lambda: not any("bot10" in found for found in list(root.announced)))
        with stand_in("/bot1", first=False) as again:
            await node.graph.until(lambda: sum(found.bridged for found in node.graph.nodes()) == 2)

            assert again.deaths == []


async def test_a_bridge_that_comes_back_finds_everything_announced(node: Node) -> None:
    """Restarting the bridge cures most of its problems."""
    subscription = node.create_subscription(String, "/chatter", None, 100)
    with stand_in() as first:
        await publish_until_heard(first.publisher("/chatter"), subscription)
    await node.graph.until(lambda: not node.graph.count(EndpointKind.PUBLISHER, "/chatter"))
    assert not [one for one in node.graph.nodes() if one.bridged]
    with stand_in() as second:
        await publish_until_heard(second.publisher("/chatter"), subscription)

        assert second.deaths == []


async def test_everything_is_withdrawn_when_the_context_closes(bridge: StandIn) -> None:
    """Anything left would be an endpoint on DDS that nobody serves."""
    async with Context() as context, quiet_node("brief", context) as node:
        node.create_subscription(String, "/brief", None, 10)
        node.create_service(AddTwoInts, "/brief_add", lambda _: AddTwoInts.Response())
        await until(lambda: sum("brief" in one for one in bridge.announced) >= 2)
    await until(lambda: not any("brief" in one for one in bridge.announced))
