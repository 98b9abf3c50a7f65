"""The graph wakes those that wait for a change, and no others."""

from __future__ import annotations

import asyncio
from typing import Any

from aionode.action import ServerGoalHandle
from aionode.graph import EndpointInfo, EndpointKind, Graph, NodeInfo, Offered
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import Int32
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.lifecycle import LifecycleNode
from aionode.node import Node
from aionode.qos import QoSProfile
from aionode.testing import local_context, settle


def node_info(name: str) -> NodeInfo:
    """Return a node of another context."""
    return NodeInfo("a1", 0, name, "/")


def endpoint_info(participant: str, kind: EndpointKind, number: int) -> EndpointInfo:
    """Return an endpoint of a context, on one topic."""
    node = NodeInfo(participant, 0, "n", "/")
    gid = f"{participant}{number}".encode().ljust(16)
    return EndpointInfo(
        kind, node, number, "/t", "std_msgs/msg/Int32", "", QoSProfile(depth=1), gid
    )


def test_the_endpoints_of_its_own_context_are_found_among_all() -> None:
    """Each new endpoint of another context is compared with these only."""
    graph = Graph("own")
    subscription = endpoint_info("own", EndpointKind.SUBSCRIPTION, 1)
    publisher = endpoint_info("own", EndpointKind.PUBLISHER, 2)
    other = endpoint_info("a1", EndpointKind.PUBLISHER, 3)
    for endpoint in (subscription, publisher, other):
        graph.add_endpoint(endpoint)

    assert graph.own() == [subscription, publisher]
    assert graph.own_opposites(other) == [subscription]
    assert graph.opposites(subscription) == [publisher, other]


def test_an_endpoint_of_its_own_context_is_found_until_it_is_removed() -> None:
    """The middleware may have given it another gid meanwhile."""
    graph = Graph("own")
    subscription = endpoint_info("own", EndpointKind.SUBSCRIPTION, 1)
    other = endpoint_info("a1", EndpointKind.PUBLISHER, 2)
    graph.add_endpoint(subscription)
    graph.identify(subscription, b"another".ljust(16))

    assert graph.own_opposites(other) == [subscription]
    graph.remove_endpoint(subscription)
    assert graph.own() == graph.own_opposites(other) == []


async def test_a_wait_for_a_name_is_not_ended_by_changes_of_others() -> None:
    """In a large system, each wait would look again at every change of anything."""
    graph = Graph()
    looked = 0

    def is_there() -> bool:
        nonlocal looked
        looked += 1
        return bool(graph.nodes_named("/wanted"))

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(graph.until(is_there, "/wanted"))
        for number in range(10):
            await settle()
            graph.add_node(node_info(f"other_{number}"))
        await settle()
        graph.add_node(node_info("wanted"))

    assert looked == 2


async def test_a_wait_for_several_names_ends_with_any_of_them_and_leaves_nothing() -> None:
    """An action client waits for five names at once."""
    graph = Graph()
    wait = graph.changed("/one", "/two")
    cancelled = graph.changed("/three")
    graph.add_node(node_info("two"))
    cancelled.cancel()
    await wait
    await settle()

    assert cancelled.cancelled()
    assert graph._waiters == {}


async def test_a_wait_without_a_name_ends_with_any_change() -> None:
    """As `node.graph.changed()` has always done."""
    graph = Graph()
    wait = graph.changed()
    graph.add_node(node_info("any"))
    await wait


async def test_a_client_that_waits_for_a_service_does_not_look_at_new_topics() -> None:
    """Waiting for the last of many nodes would otherwise cost the square of their number."""
    async with Node("n", context=local_context()) as node, asyncio.TaskGroup() as tasks:
        client = node.create_client(Trigger, "wanted")
        asked = 0
        is_ready = client.service_is_ready

        def count() -> bool:
            nonlocal asked
            asked += 1
            return is_ready()

        client.service_is_ready = count  # type: ignore[method-assign]  # to count
        tasks.create_task(client.wait_for_service())
        for number in range(5):
            await settle()
            node.create_publisher(Int32, f"t{number}", 10)
        await settle()
        node.create_service(Trigger, "wanted", lambda _, response: response)

    assert asked == 2


async def test_what_is_offered_is_without_infrastructure_and_hidden_nodes() -> None:
    """In a small robot, nine of ten services are those that every node has."""
    context = local_context()
    robot = Node("base", context=context)
    tool = Node("_tool", context=context)
    async with robot, tool:
        robot.create_publisher(Int32, "count", 1)
        robot.create_service(Trigger, "reset", lambda _: Trigger.Response(success=True))
        robot.create_client(Trigger, "elsewhere")
        robot.create_action_server(Fibonacci, "fibonacci", fibonacci)
        robot.create_service(Trigger, "_debug", lambda _: Trigger.Response())
        tool.create_subscription(Int32, "seen_by_a_tool_alone")
        tool.create_service(Trigger, "of_a_tool", lambda _: Trigger.Response())

        offered, everything = robot.graph.offered(), robot.graph.offered(user_only=False)

    assert offered == Offered(
        nodes=["/base"],
        topics={"/count": ["std_msgs/msg/Int32"]},
        services={"/reset": ["std_srvs/srv/Trigger"]},
        actions={"/fibonacci": ["example_interfaces/action/Fibonacci"]},
    )
    assert everything.nodes == ["/_tool", "/base"]
    assert {"/rosout", "/seen_by_a_tool_alone", "/fibonacci/_action/status"} <= set(
        everything.topics
    )
    assert {"/base/get_parameters", "/_debug", "/of_a_tool"} <= set(everything.services)


async def test_managed_nodes_offer_the_change_of_their_state() -> None:
    """Which states there are at all is a question about the node."""
    async with LifecycleNode("camera", context=local_context()) as node:
        offered = node.graph.offered()

    assert set(offered.services) == {"/camera/change_state", "/camera/get_state"}


def fibonacci(handle: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
    """Execute a goal; none is sent here."""
    handle.succeed()
    return Fibonacci.Result()
