"""Warnings about names that should be unique, where ROS 2 says nothing."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from aionode import ActionServer, Context, Node
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.message import type_name
from aionode.qos import qos_profile_services_default


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    """Answer a request."""
    return AddTwoInts.Response(sum=request.a + request.b)


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings so far."""
    return [record.getMessage() for record in caplog.records if record.levelname == "WARNING"]


def remote_server(name: str, node: str, number: int = 1) -> EndpointInfo:
    """Return a server of another process."""
    return EndpointInfo(
        EndpointKind.SERVER,
        NodeInfo("abc", number, node, "/"),
        number,
        name,
        type_name(AddTwoInts),
        type_hash(AddTwoInts),
        qos_profile_services_default,
        bytes([number]) * 16,
    )


async def test_two_nodes_of_one_name_are_reported_once(
    node_factory: Callable[..., Node], caplog: pytest.LogCaptureFixture
) -> None:
    """They are not reported again for each of the services that every node has."""
    node_factory("camera")
    assert warnings(caplog) == []

    node_factory("camera")

    (text,) = warnings(caplog)
    assert text.startswith("there are two nodes named /camera: this one, and one in this program.")
    assert text.endswith("-r __node:=camera_2")


async def test_a_node_of_another_process_with_the_same_name_is_reported(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """Whichever of the two is seen second; a pair of other processes is theirs to report."""
    context.graph.add_node(NodeInfo("abc", 0, "node", "/"))
    context.graph.add_node(NodeInfo("abc", 1, "other", "/"))
    context.graph.add_node(NodeInfo("def", 1, "other", "/"))

    (text,) = warnings(caplog)
    assert "two nodes named /node: this one, and one in another process (Zenoh id abc)" in text
    assert len(context.graph.nodes_named("/other")) == 2


async def test_a_node_that_follows_one_of_its_name_is_not_reported(
    context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """A supervisor restarts nodes."""
    for _ in range(2):
        async with Node("camera", context=context):
            pass

    assert warnings(caplog) == []


async def test_two_servers_of_one_service_are_reported(
    node: Node, node_factory: Callable[..., Node], caplog: pytest.LogCaptureFixture
) -> None:
    """With both nodes and what becomes of a request."""
    node.create_service(AddTwoInts, "/add", add)
    assert warnings(caplog) == []

    node_factory("other").create_service(AddTwoInts, "/add", add)

    (text,) = warnings(caplog)
    assert text.startswith("service /add has two servers, in /other and /node: each request")


async def test_two_servers_of_one_node_are_reported(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """A service that is created twice by mistake."""
    node.create_service(AddTwoInts, "/add", add)
    node.create_service(AddTwoInts, "/add", add)

    (text,) = warnings(caplog)
    assert "service /add has two servers, in /node and /node" in text


async def test_a_client_reports_two_servers_of_other_processes(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """They may be nodes of ROS 2, which say nothing."""
    for number, name in enumerate(("one", "two"), start=1):
        context.graph.add_endpoint(remote_server("/add", name, number))
    assert warnings(caplog) == []

    node.create_client(AddTwoInts, "/add")

    (text,) = warnings(caplog)
    assert text.startswith("service /add has two servers, in /one and /two")


async def test_a_server_that_appears_is_reported_to_a_client(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """The client knew one server when it was created."""
    context.graph.add_endpoint(remote_server("/add", "one", 1))
    node.create_client(AddTwoInts, "/add")

    context.graph.add_endpoint(remote_server("/add", "two", 2))

    (text,) = warnings(caplog)
    assert text.startswith("service /add has two servers, in /one and /two")


async def test_two_servers_of_one_action_are_reported_once(
    node: Node, node_factory: Callable[..., Node], caplog: pytest.LogCaptureFixture
) -> None:
    """An action has three services, but it is one action."""
    ActionServer(node, Fibonacci, "/count", lambda goal: Fibonacci.Result())

    ActionServer(node_factory("other"), Fibonacci, "/count", lambda goal: Fibonacci.Result())

    (text,) = warnings(caplog)
    assert text.startswith("action /count has two servers, in /other and /node")
