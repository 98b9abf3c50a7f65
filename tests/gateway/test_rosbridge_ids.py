"""Ids of rosbridge clients: any JSON value, repeated unchanged."""

from __future__ import annotations

import json
from typing import Any

import pytest

from aionode.gateway.session.robot import Robot
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.node import Node
from aionode.testing import settle
from tests.support.rosbridge import RosbridgeClient, rosbridge_client

IDS: list[Any] = [7, 0, -1, 2.5, 2**70, True, False, "7", "", 'é \\ "quoted"', [1, "a"], {"n": 1}]


@pytest.fixture
async def server(node: Node) -> Node:
    """Return a node with a service and an action."""
    node.create_service(Trigger, "/ask", lambda _: Trigger.Response(success=True))

    async def execute(goal: Any) -> Any:
        goal.publish_feedback(Fibonacci.Feedback(sequence=[1]))
        goal.succeed()
        return Fibonacci.Result(sequence=[1])

    node.create_action_server(Fibonacci, "/count", execute)
    await settle()
    return node


@pytest.mark.parametrize("given", IDS, ids=repr)
async def test_an_answer_has_the_id_of_its_call(
    server: Node, client: RosbridgeClient, given: Any
) -> None:
    """JavaScript numbers its calls, and waits for the answer to each."""
    client.send("call_service", service="/ask", id=given)
    answer = await client.receive()

    assert (answer["op"], answer["result"], answer["id"]) == ("service_response", True, given)
    client.send("call_service", service="/none", id=given)
    answer = await client.receive()
    assert (answer["op"], answer["result"], answer["id"]) == ("service_response", False, given)


@pytest.mark.parametrize("given", IDS, ids=repr)
async def test_feedback_and_result_have_the_id_of_their_goal(
    server: Node, client: RosbridgeClient, given: Any
) -> None:
    """Otherwise nobody could tell to which goal they belong."""
    fields = {"action": "/count", "action_type": "example_interfaces/Fibonacci", "feedback": True}
    client.send("send_action_goal", id=given, **fields)
    answers = [await client.receive() for _ in range(2)]

    assert [(each["op"], each["id"]) for each in answers] == [
        ("action_feedback", given), ("action_result", given),
    ]  # fmt: skip
    client.send("cancel_action_goal", id=given, action="/count")
    status = await client.receive()
    assert (status["op"], status["id"]) == ("status", given)


@pytest.mark.parametrize("given", [7, "7"])
async def test_a_number_and_its_text_are_two_ids(
    node: Node, client: RosbridgeClient, given: object
) -> None:
    """As in JSON: one does not end what the other began."""
    topic = {"topic": "/words", "type": "std_msgs/String"}
    other = "7" if given == 7 else 7
    client.send("subscribe", id=given, **topic)
    client.send("unsubscribe", id=other, topic="/words")
    status = await client.receive()
    assert "is not subscribed with this id" in status["msg"]
    assert status["id"] == other
    client.send("advertise", id=given, **topic)
    client.send("unadvertise", id=other, topic="/words")
    assert (await client.receive())["id"] == other
    assert node.count_subscribers("/words") == 1
    client.send("unsubscribe", id=given, topic="/words")
    client.send("unadvertise", id=given, topic="/words")
    await settle()
    assert node.count_subscribers("/words") == 0
    assert not client.session.publishes


LOST: list[dict[str, object]] = [
    {"op": "call_service", "id": 7},
    {"op": "call_service", "id": 7, "service": 5},
    {"op": "call_service", "id": 7, "service": "/ask", "args": [[]] * 200_000},
    {"op": "call_service", "id": 7, "service": "/ask", "fragment_size": "a"},
    {"op": "call_service", "id": 7, "service": "/" + "a" * 2000},
    {"op": "send_action_goal", "id": 7},
    {"op": "send_action_goal", "id": 7, "action": "/count", "args": [[]] * 200_000},
    {"op": "send_action_goal", "id": 7, "action": "/count", "action_type": 5},
]


@pytest.mark.parametrize("op", LOST, ids=lambda op: json.dumps(op)[:70])
async def test_every_call_and_goal_is_answered(robot: Robot, op: dict[str, object]) -> None:
    """Even an invalid one: its client waits, and has not requested statuses."""
    async with rosbridge_client(robot) as page:
        page.send_frame(json.dumps(op))
        answer = await page.receive()

    assert answer["op"] in {"service_response", "action_result"}
    assert (answer["id"], answer["result"]) == (7, False)
    assert isinstance(answer["values"], str)
