"""``aionode service``."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.cli._nouns.service import call, info
from aionode.cli._support.nouns import SERVICE
from aionode.engine.wire.typehash import type_hash
from aionode.errors import CommandError, ServiceError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.testing import ManualClock, settle

ADD = "example_interfaces/srv/AddTwoInts"


def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    """Answer with the sum."""
    response.sum = request.a + request.b
    return response


@pytest.fixture
async def server(node_factory: Callable[..., Node]) -> Node:
    """A node that adds, without parameter services, so that the list is short."""
    server_node = node_factory("add_server", start_parameter_services=False)
    server_node.create_service(AddTwoInts, "/add_two_ints", add)
    return server_node


async def test_call_prints_request_and_response(tool: Node, server: Node, screen: Any) -> None:
    """The tutorial's output, empty lines included."""
    await call(tool, "/add_two_ints", ADD, values="{a: 42, b: 58}", output=screen.output)

    assert screen.text == (
        "requester: making request: example_interfaces.srv.AddTwoInts_Request(a=42, b=58)\n"
        "\n"
        "response:\n"
        "example_interfaces.srv.AddTwoInts_Response(sum=100)\n"
        "\n"
    )


async def test_json_call_prints_the_response_only(tool: Node, server: Node, screen: Any) -> None:
    """``aionode service call … --json | jq .sum``."""
    await call(tool, "/add_two_ints", ADD, values="{a: 1, b: 2}", output=screen.json_output)

    assert screen.records == [{"sum": 3}]


async def test_call_repeats_at_a_rate(
    running: Any, tool: Node, server: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """It does so until Ctrl-C."""
    async with running(call(tool, "/add_two_ints", ADD, rate=10.0, output=screen.output)):
        await manual_clock.advance(0.35)

    assert screen.text.count("response:") == 4


async def test_call_waits_for_the_service_and_says_so(
    running: Any, tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The server is often started later than the client."""
    async with running(call(tool, "/add_two_ints", ADD, output=screen.output)) as task:
        assert screen.text == "waiting for service to become available...\n"
        node_factory("late").create_service(AddTwoInts, "/add_two_ints", add)
        await settle()
        assert task.done()

    assert "response:" in screen.text


async def test_waiting_says_what_may_be_meant(tool: Node, server: Node, screen: Any) -> None:
    """ros2 waits forever without saying what is missing."""
    with pytest.raises(CommandError, match=r"No server of '/add_two_int' appeared within 0\.001 s"):
        await call(tool, "/add_two_int", ADD, timeout=0.001, output=screen.output)

    assert screen.errors == "No server of '/add_two_int' yet. Did you mean '/add_two_ints'?\n"


@pytest.mark.parametrize(
    ("service_type", "values", "says"),
    [
        ("example_interfaces/srv/AddTwo", "{}", "did you mean example_interfaces/srv/AddTwoInts?"),
        ("std_msgs/msg/String", "{}", "not a service"),
        ("std_srvs/srv/Empty", "{}", f"'/add_two_ints' has type {ADD}, not std_srvs/srv/Empty"),
        (ADD, "{c: 42}", "Failed to populate field: example_interfaces/srv/AddTwoInts_Request.c"),
        (ADD, "{a: 1.5}", "AddTwoInts_Request.a: 1.5"),
        (ADD, "{a: [", "not valid YAML"),
    ],
)
async def test_what_does_not_fit_is_refused_before_the_call(
    service_type: str, values: str, says: str, tool: Node, server: Node, screen: Any
) -> None:
    """The error names what was given and what is expected."""
    with pytest.raises(CommandError) as raised:
        await call(tool, "/add_two_ints", service_type, values=values, output=screen.output)

    assert says in str(raised.value)
    assert screen.text == ""


async def test_a_failing_handler_is_an_error_with_its_text(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The command ends at once, with the text of the server."""

    def fail(request: Any, response: Any) -> Any:
        raise ValueError("no such number")

    server = node_factory("server")
    server.create_service(AddTwoInts, "/add", fail, on_error=lambda error, context: None)

    with pytest.raises(ServiceError, match="/add: ValueError: no such number"):
        await call(tool, "/add", ADD, output=screen.output)


async def test_list_prints_names_and_types(tool: Node, server: Node, screen: Any) -> None:
    """Every node also serves its type descriptions."""
    await SERVICE.list_names(tool, types=True, output=screen.output)

    assert screen.text == (
        "/add_server/get_type_description [type_description_interfaces/srv/GetTypeDescription]\n"
        "/add_two_ints [example_interfaces/srv/AddTwoInts]\n"
    )


async def test_a_service_that_only_has_clients_is_listed(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """As `ros2 service list` lists it; `info` says that nobody serves it."""
    asking = node_factory("asking", start_parameter_services=False)
    asking.create_client(AddTwoInts, "/add_two_ints")

    await info(tool, "/add_two_ints", output=screen.output)

    assert SERVICE.types_by_name(tool)["/add_two_ints"] == [ADD]
    assert screen.text == f"Type: {ADD}\nClients count: 1\nServices count: 0\n"


async def test_info_prints_type_and_counts(tool: Node, server: Node, screen: Any) -> None:
    """The command's own client does not count."""
    tool.create_client(AddTwoInts, "/add_two_ints")

    await info(tool, "/add_two_ints", output=screen.output)

    assert screen.text == f"Type: {ADD}\nClients count: 0\nServices count: 1\n"


async def test_type_and_find_are_inverse(tool: Node, server: Node, screen: Any) -> None:
    """From a name to its type, and back."""
    await SERVICE.print_type(tool, "/add_two_ints", output=screen.output)
    await SERVICE.find(tool, ADD, output=screen.output)
    await SERVICE.find(tool, ADD, count=True, output=screen.output)

    assert screen.text == f"{ADD}\n/add_two_ints\n1\n"


async def test_verbose_info_describes_clients_and_servers(
    tool: Node, server: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """In the lines that rclpy of Lyrical makes of one endpoint; a client is one over Zenoh."""
    user = node_factory("user", namespace="/team")
    user.create_client(AddTwoInts, "/add_two_ints")

    await info(tool, "/add_two_ints", verbose=True, output=screen.output)

    text = re.sub(r"GID: [0-9a-f.]+", "GID: …", screen.text)
    begin = (
        f"Type: {ADD}\n"
        "Clients count: 1\n"
        "Node name: user\n"
        "Node namespace: /team\n"
        f"Service type: {ADD}\n"
        f"Service type hash: {type_hash(AddTwoInts)}\n"
        "Endpoint type: CLIENT\n"
        "Endpoint count: 1\n"
        "GID: …\n"
        "QoS profile:\n"
        "  Reliability: RELIABLE\n"
    )
    assert text.startswith(begin)
    assert "\n\nServices count: 1\nNode name: add_server\nNode namespace: /\n" in text


async def test_verbose_info_as_a_record_has_every_endpoint(
    tool: Node, server: Node, screen: Any
) -> None:
    """With its profile and times in nanoseconds, as that of a topic."""
    await info(tool, "/add_two_ints", verbose=True, output=screen.json_output)
    await info(tool, "/add_two_ints", output=screen.json_output)

    detailed, short = screen.records
    assert detailed["clients"] == []
    assert detailed["servers"][0]["node"] == "/add_server"
    assert detailed["servers"][0]["qos"]["reliability"] == "reliable"
    assert (short["clients"], short["servers"]) == (0, 1)


@pytest.mark.parametrize("verb", [info, SERVICE.print_type])
async def test_an_unknown_service_is_named(
    verb: Callable[..., Any], tool: Node, server: Node, screen: Any
) -> None:
    """The error suggests a similar name."""
    with pytest.raises(CommandError, match="Unknown service '/add'"):
        await verb(tool, "/add", output=screen.output)
