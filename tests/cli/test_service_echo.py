"""``aionode service echo``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import ActionServer, Node, ServiceIntrospectionState
from aionode.cli._nouns.service import echo
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.testing import ManualClock, settle


@pytest.fixture
async def server(node_factory: Callable[..., Node]) -> Node:
    """A node with a service that is introspected."""
    node = node_factory("add_server")

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response

    service = node.create_service(AddTwoInts, "/add_two_ints", add)
    service.configure_introspection(node.get_clock(), 10, ServiceIntrospectionState.CONTENTS)
    return node


async def echoed(running: Any, tool: Node, server: Node, **options: Any) -> None:
    """Print the events of one call."""
    client = server.create_client(AddTwoInts, "/add_two_ints")
    async with running(echo(tool, "/add_two_ints", **options)):
        await client.call(AddTwoInts.Request(a=2, b=3))
        await settle()


async def test_each_event_is_yaml_and_three_dashes(
    running: Any, tool: Node, server: Node, screen: Any
) -> None:
    """As in ros2: the type of the event by name, and empty lists for missing contents."""
    await echoed(running, tool, server, output=screen.output, no_arr=True)

    first, second, end = screen.text.split("---\n")
    assert first.startswith("info:\n  event_type: REQUEST_RECEIVED\n  stamp:\n    sec: ")
    assert "  client_gid: '<array type: uint8[16]>'\n  sequence_number: 1\n" in first
    assert "event_type: RESPONSE_SENT" in second
    assert end == ""


async def test_contents_are_printed(running: Any, tool: Node, server: Node, screen: Any) -> None:
    """One of the two lists has the message."""
    await echoed(running, tool, server, output=screen.output)

    first, second, _ = screen.text.split("---\n")
    assert first.endswith("sequence_number: 1\nrequest:\n- a: 2\n  b: 3\nresponse: []\n")
    assert second.endswith("sequence_number: 1\nrequest: []\nresponse:\n- sum: 5\n")


async def test_json_is_one_line_for_each_event(
    running: Any, tool: Node, server: Node, screen: Any
) -> None:
    """For programs."""
    await echoed(running, tool, server, output=screen.json_output)

    kinds = [record["info"]["event_type"] for record in screen.records]
    assert kinds == ["REQUEST_RECEIVED", "RESPONSE_SENT"]
    assert screen.records[0]["request"] == [{"a": 2, "b": 3}]


async def test_csv_is_one_line_for_each_event(
    running: Any, tool: Node, server: Node, screen: Any
) -> None:
    """For spreadsheets."""
    await echoed(running, tool, server, output=screen.output, csv=True)

    lines = screen.text.splitlines()
    assert [line.split(",")[0] for line in lines] == ["REQUEST_RECEIVED", "RESPONSE_SENT"]
    assert lines[0].endswith(",1,2,3,")


async def test_once_ends_after_one_event(
    running: Any, tool: Node, server: Node, screen: Any
) -> None:
    """Scripts wait for a call this way."""
    client = server.create_client(AddTwoInts, "/add_two_ints")
    async with running(echo(tool, "/add_two_ints", once=True, output=screen.output)) as task:
        await client.call(AddTwoInts.Request())
        await settle()
        assert task.result() == 0

    assert screen.text.count("---\n") == 1


async def test_a_service_that_is_not_introspected_is_reported(
    running: Any, tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Nothing would ever be printed, and it is not clear why."""
    node_factory("other").create_service(AddTwoInts, "/add", lambda request, response: response)

    async with running(echo(tool, "/add", output=screen.output)):
        pass

    assert "/add has no introspection yet" in screen.errors


async def test_a_timeout_without_events_is_an_error(
    running: Any, tool: Node, server: Node, manual_clock: ManualClock, screen: Any
) -> None:
    """For scripts."""
    async with running(echo(tool, "/add_two_ints", timeout=0.01, output=screen.output)) as task:
        assert await task == 1


async def test_an_unknown_service_is_an_error(tool: Node, server: Node, screen: Any) -> None:
    """With a similar name."""
    with pytest.raises(CommandError, match="Did you mean '/add_two_ints'"):
        await echo(tool, "/add_two_int", output=screen.output)


async def test_the_services_of_an_action_can_be_watched(
    running: Any, tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Their types are part of the action's."""
    node = node_factory("robot")
    server = ActionServer(node, Fibonacci, "/count", lambda goal: Fibonacci.Result())
    server.configure_introspection(node.get_clock(), 10, ServiceIntrospectionState.CONTENTS)
    send = node.create_client(Fibonacci.Impl.SendGoalService, "/count/_action/send_goal")

    async with running(echo(tool, "/count/_action/send_goal", output=screen.json_output)):
        await send.call(Fibonacci.Impl.SendGoalService.Request(goal=Fibonacci.Goal(order=4)))
        await settle()

    assert screen.records[0]["request"][0]["goal"] == {"order": 4}
