"""An aionode node with a node of real rclpy in another process, over DDS."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from aionode.action import ActionServer, CancelResponse, GoalStatus, ServerGoalHandle
from aionode.clock import Duration
from aionode.endpoints.events import (
    IncompatibleTypeInfo,
    MatchedInfo,
    QoSOfferedIncompatibleQoSInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSRequestedIncompatibleQoSInfo,
)
from aionode.engine.context import Context
from aionode.engine.wire.typehash import type_hash
from aionode.errors import ServiceUnavailableError
from aionode.graph import EndpointKind
from aionode.interfaces.std_msgs.msg import String, UInt8MultiArray
from aionode.interfaces.test_msgs.action import Fibonacci
from aionode.interfaces.test_msgs.srv import BasicTypes
from aionode.node import Node
from aionode.node._type_lookup import described
from aionode.parameter import Parameter
from aionode.parameter_client import AsyncParameterClient
from aionode.qos import (
    DurabilityPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from tests.support.ros import ros_domain, ros_missing, ros_peer

if TYPE_CHECKING:
    import subprocess
    from collections.abc import AsyncIterator, Iterator

pytestmark = pytest.mark.skipif(bool(ros_missing()), reason=ros_missing() or "there is a ROS 2")


MOMENT = Duration(nanoseconds=100_000_000)
"""A deadline and a lease, which the peer uses too."""


@pytest.fixture(scope="module")
def peer() -> Iterator[subprocess.Popen[str]]:
    """A process of rclpy."""
    with ros_peer(ros_domain()) as process:
        yield process


@asynccontextmanager
async def our_node(domain_id: int) -> AsyncIterator[Node]:
    """Run the node ``/ours``, once it knows ``/peer``."""
    async with (
        asyncio.timeout(40),
        Context(transport="rcl", domain_id=domain_id) as context,
        Node("ours", context=context) as node,
    ):
        await node.wait_for_node("/peer")
        yield node


@pytest.fixture(autouse=True)
def local(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the tests off the network."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


@pytest.fixture
async def node(peer: subprocess.Popen[str]) -> AsyncIterator[Node]:
    """The node of a test."""
    async with our_node(ros_domain()) as node:
        yield node


async def told(node: Node, command: str) -> str:
    """Return the peer's answer to a command."""
    results = node.create_subscription(String, "/results", None, 100)
    commands = node.create_publisher(String, "/commands", 100)
    await commands.wait_for_subscribers()
    while not results.get_publisher_count():
        await node.graph.changed()
    commands.publish(String(data=command))
    return str((await results.receive()).data)


async def test_messages_travel_in_both_directions(node: Node) -> None:
    """In order, and each once."""
    echoed = node.create_subscription(String, "/echoed", None, 100)
    publisher = node.create_publisher(String, "/to_echo", 100)
    await publisher.wait_for_subscribers()
    while not echoed.get_publisher_count():
        await node.graph.changed()
    for number in range(100):
        publisher.publish(String(data=str(number)))
    assert [(await echoed.receive()).data for _ in range(100)] == [str(n) for n in range(100)]
    assert echoed.stats.lost == 0


async def test_large_messages_travel_in_both_directions(node: Node) -> None:
    """They are sent in another way: from a thread."""
    echoed = node.create_subscription(UInt8MultiArray, "/large_echoed", None, 10)
    publisher = node.create_publisher(UInt8MultiArray, "/large", 10)
    await publisher.wait_for_subscribers()
    while not echoed.get_publisher_count():
        await node.graph.changed()
    data = bytes(range(256)) * 4000
    for _ in range(3):
        publisher.publish(UInt8MultiArray(data=data))
        assert bytes((await echoed.receive()).data) == data


async def test_a_late_subscription_gets_what_was_kept(node: Node) -> None:
    """It gets the last three of five."""
    kept = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    reader = node.create_subscription(String, "/map", None, kept)
    assert [(await reader.receive()).data for _ in range(3)] == ["2", "3", "4"]


async def test_its_service_answers(node: Node) -> None:
    """Even when many calls run at the same time."""
    client = node.create_client(BasicTypes, "/add")
    await client.wait_for_service()
    async with asyncio.TaskGroup() as tasks:
        calls = [
            tasks.create_task(client.call(BasicTypes.Request(int64_value=n))) for n in range(5)
        ]
    assert [call.result().int64_value for call in calls] == [1, 2, 3, 4, 5]


async def test_it_calls_our_service(node: Node) -> None:
    """With its own request."""

    def double(request: Any, response: Any) -> Any:
        response.int64_value = 2 * request.int64_value
        return response

    node.create_service(BasicTypes, "/ours/add", double)
    assert await told(node, "call 7") == "14"


async def test_its_action_server_executes_goals(node: Node) -> None:
    """With feedback and result."""
    client = node.create_action_client(Fibonacci, "/fibonacci")
    await client.wait_for_server()
    goal = await client.send_goal(Fibonacci.Goal(order=6))
    assert list((await goal.result()).result.sequence) == [0, 1, 1, 2, 3, 5]


async def test_its_action_server_cancels_goals(node: Node) -> None:
    """Including a goal that would run forever."""
    client = node.create_action_client(Fibonacci, "/fibonacci")
    await client.wait_for_server()
    goal = await client.send_goal(Fibonacci.Goal(order=0))
    await goal.cancel()
    assert (await goal.result()).status is GoalStatus.CANCELED


async def execute(goal: ServerGoalHandle[Any, Any, Any]) -> Any:
    """Execute a goal; one of order 0 runs until it is cancelled."""
    if goal.request.order == 0:
        await asyncio.Event().wait()
    goal.succeed()
    return Fibonacci.Result(sequence=list(range(goal.request.order)))


async def test_it_sends_goals_to_our_action_server(node: Node) -> None:
    """Status 4 is success."""
    ActionServer(node, Fibonacci, "/ours/fibonacci", execute)
    assert await told(node, "goal 3") == "(4, [0, 1, 2])"


async def test_it_cancels_goals_of_our_action_server(node: Node) -> None:
    """Status 5 is canceled."""
    ActionServer(
        node,
        Fibonacci,
        "/ours/fibonacci",
        execute,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
    )
    assert await told(node, "cancel 0") == "5"


async def test_its_parameters_are_read_and_set(node: Node) -> None:
    """It has the services for it anyway."""
    client = AsyncParameterClient(node, "/peer")
    await client.wait_for_services()
    (result,) = await client.set_parameters([Parameter("speed", value=2.5)])
    assert result.successful
    (value,) = await client.get_parameters(["speed"])
    assert value.value == 2.5


async def test_it_sets_our_parameters(node: Node) -> None:
    """It calls our services."""
    node.declare_parameter("speed", 1.0)
    assert await told(node, "speed 3.5") == "True"
    assert node.get_parameter("speed").value == 3.5


async def test_its_endpoints_are_in_the_graph(node: Node) -> None:
    """With node, type, hash and QoS; history and depth are unknown over DDS."""
    while not node.count_publishers("/map"):
        await node.graph.changed()
    (found,) = node.get_publishers_info_by_topic("/map")
    assert (found.node_name, found.topic_type) == ("peer", "std_msgs/msg/String")
    assert found.topic_type_hash.startswith("RIHS01_df668c740482bbd4")
    assert found.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    while ("/add", ["test_msgs/srv/BasicTypes"]) not in node.get_service_names_and_types():
        await node.graph.changed()


# QoS events


async def event_of(stream: Any, kind: type[Any], **wanted: object) -> Any:
    """Return the next event of a kind with some given values."""
    async for event in stream:
        if isinstance(event, kind) and all(
            getattr(event, name) == value for name, value in wanted.items()
        ):
            return event
    raise AssertionError("the stream has ended")


async def test_a_publisher_hears_that_its_subscription_is_matched(node: Node) -> None:
    """The graph shows the match."""
    publisher = node.create_publisher(String, "/to_echo", 10)
    event = await event_of(publisher.events, MatchedInfo)
    assert (event.current_count, event.current_count_change) == (1, 1)


async def test_what_its_publisher_does_not_offer_is_an_event(node: Node) -> None:
    """The event names the policy, and there is no match."""
    wanted = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    reader = node.create_subscription(String, "/chatter", None, wanted)
    event = await event_of(reader.events, QoSRequestedIncompatibleQoSInfo)
    assert event.last_policy_kind is QoSPolicyKind.DURABILITY
    assert reader.get_publisher_count() == 0


async def test_what_its_subscription_asks_in_vain_is_an_event(node: Node) -> None:
    """The same in the opposite direction."""
    offered = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = node.create_publisher(String, "/to_echo", offered)
    event = await event_of(publisher.events, QoSOfferedIncompatibleQoSInfo)
    assert event.last_policy_kind is QoSPolicyKind.RELIABILITY
    assert publisher.get_subscription_count() == 0


async def test_another_type_is_an_event(node: Node) -> None:
    """When both use the same topic."""
    reader = node.create_subscription(UInt8MultiArray, "/chatter", None, 10)
    event = await event_of(reader.events, IncompatibleTypeInfo)
    assert event.total_count == 1


async def test_a_deadline_that_it_misses_is_an_event(node: Node) -> None:
    """The deadline counts from its last message."""
    wanted = QoSProfile(depth=1, deadline=MOMENT)
    reader = node.create_subscription(String, "/hurried", None, wanted)
    while not reader.get_publisher_count():
        await node.graph.changed()
    assert await told(node, "hurry once") == "once"
    assert (await reader.receive()).data == "once"
    await event_of(reader.events, QoSRequestedDeadlineMissedInfo)


async def test_it_sees_the_events_of_our_publisher(node: Node) -> None:
    """Match, liveliness, deadline, the end of a lease, an assertion, and the publisher's end."""
    events = node.create_subscription(String, "/events", None, 1000)
    while not events.get_publisher_count():
        await node.graph.changed()
    offered = QoSProfile(
        depth=1,
        deadline=MOMENT,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=MOMENT,
    )

    async def until_told(*wanted: str) -> None:
        missing = set(wanted)
        while missing:
            missing.discard((await events.receive()).data)

    beat = node.create_publisher(String, "/ours/beat", offered)
    await beat.wait_for_subscribers()
    await until_told("matched 1")
    beat.publish(String(data="one"))
    await until_told("alive 1", "message", "deadline", "alive 0")
    beat.assert_liveliness()
    await until_told("alive 1")
    beat.destroy()
    await until_told("matched 0")


async def test_it_is_told_of_a_publisher_that_offers_too_little(node: Node) -> None:
    """A publisher of rclpy causes the same event."""
    events = node.create_subscription(String, "/events", None, 1000)
    while not events.get_publisher_count():
        await node.graph.changed()
    node.create_publisher(String, "/ours/beat", 10)
    while not (found := (await events.receive()).data).startswith("incompatible"):
        pass
    assert found.endswith(("_DEADLINE", "_LIVELINESS"))


# Types


async def test_it_describes_its_types(node: Node) -> None:
    """A class generated from the description has the hash that the graph shows."""
    while not node.count_publishers("/chatter"):
        await node.graph.changed()
    users = node.graph.endpoints(EndpointKind.PUBLISHER, name="/chatter")
    while not node.graph.count(EndpointKind.SERVER, "/peer/get_type_description"):
        await node.graph.changed()
    made = await described(node, "std_msgs/msg/String", users, [])
    assert made is not None
    assert made is not String
    assert type_hash(made) == type_hash(String)


async def test_it_asks_for_our_types(node: Node) -> None:
    """Tools that lack the types do this."""
    node.create_publisher(String, "/ours/text", 10)
    assert await told(node, "described std_msgs/msg/String") == "(True, ['data'])"


# Ends


@pytest.mark.one_loop
async def test_a_process_that_ends_cleanly_ends_its_calls_at_once() -> None:
    """Its node leaves the graph too, long before its lease of 20 s ends."""
    alone = ros_domain(50)
    with ros_peer(alone) as process:
        async with our_node(alone) as node:
            client = node.create_client(BasicTypes, "/silent")
            await client.wait_for_service()
            call = asyncio.get_running_loop().create_task(client.call(BasicTypes.Request()))
            await asyncio.wait([call], timeout=0.5)
            assert process.stdin is not None
            process.stdin.close()
            async with asyncio.timeout(10):
                with pytest.raises(ServiceUnavailableError):
                    await call
                while client.service_is_ready() or "peer" in node.get_node_names():
                    await node.graph.changed()


async def test_it_learns_at_once_that_our_context_ends(node: Node) -> None:
    """Its node leaves the graph, long before its lease of 20 s ends."""
    async with (
        Context(transport="rcl", domain_id=ros_domain()) as context,
        Node("leaver", context=context),
    ):
        assert await told(node, "knows leaver") == "known"
    async with asyncio.timeout(10):
        assert await told(node, "leaves leaver") == "gone"


@pytest.mark.one_loop
@pytest.mark.stress
async def test_a_killed_process_ends_its_calls_when_its_lease_ends() -> None:
    """Fast DDS has a lease of 20 s."""
    alone = ros_domain(50)
    with ros_peer(alone) as process:
        async with our_node(alone) as node:
            client = node.create_client(BasicTypes, "/silent")
            await client.wait_for_service()
            call = asyncio.get_running_loop().create_task(client.call(BasicTypes.Request()))
            await asyncio.wait([call], timeout=0.5)
            process.kill()
            with pytest.raises(ServiceUnavailableError):
                await call
