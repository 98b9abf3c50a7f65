"""Services and actions over rosbridge, called and served by a client."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import Coroutine
from typing import Any, TypeVar

import pytest

from aionode.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    GoalStatus,
    ServerGoalHandle,
)
from aionode.errors import ServiceError
from aionode.gateway.policy.policy import Policy
from aionode.gateway.session.robot import Robot
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.node import Node
from aionode.testing import settle
from tests.support.rosbridge import RosbridgeClient, rosbridge_client

T = TypeVar("T")

ADD = "example_interfaces/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"


def start(work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
    """Start something that continues while the test does other things."""
    return asyncio.get_running_loop().create_task(work)


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    """Answer a request."""
    return AddTwoInts.Response(sum=request.a + request.b)


# Services that a client calls


async def test_a_call_may_have_no_arguments(client: RosbridgeClient, node: Node) -> None:
    """Null means no arguments in rosbridge, whereas a null message is refused."""
    node.create_service(AddTwoInts, "/add", add)

    client.send("call_service", service="/add", args=None)

    assert (await client.receive())["values"] == {"sum": 0}


@pytest.mark.parametrize("args", [{"a": 1, "b": 2}, [1, 2]])
@pytest.mark.parametrize("service", ["/add", "add"])
async def test_a_call_is_answered(
    client: RosbridgeClient, node: Node, args: object, service: str
) -> None:
    """With its id and name, even if values come in order."""
    node.create_service(AddTwoInts, "/add", add)

    client.send("call_service", service=service, args=args, id="c1", type="any/Thing")

    assert await client.receive() == {
        "op": "service_response",
        "service": service,
        "values": {"sum": 3},
        "result": True,
        "id": "c1",
    }


@pytest.mark.slow
async def test_an_answer_is_in_fragments_if_the_client_asks(client: RosbridgeClient) -> None:
    """For this call only: another one is answered in one piece."""
    service = "/rosapi/interfaces"
    client.send("call_service", service=service, id="c1", fragment_size=10_000)
    client.send("call_service", service=service, id="c2")

    parts, whole = await client.receive(), await client.receive()

    assert {part["id"] for part in parts} == {"c1"}
    answer = json.loads("".join(part["data"] for part in parts))
    assert answer["values"] == whole["values"]


async def test_the_id_may_be_part_of_the_name(client: RosbridgeClient, node: Node) -> None:
    """As written by the first clients of rosbridge."""
    node.create_service(AddTwoInts, "/add", add)

    client.send("call_service", service="/add#7", args={})

    answer = await client.receive()
    assert (answer["service"], answer["id"]) == ("/add", "7")


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"service": "/none"}, "/none"),
        ({"service": "/add", "args": {"a": "x"}}, "AddTwoInts_Request.a"),
        ({"service": "/add", "args": "x"}, "call_service.args"),
        ({"service": "/add", "timeout": "soon"}, "call_service.timeout"),
        ({"service": "/add", "timeout": math.nan}, "call_service: timeout"),
        ({"service": "/rosapi/nothing"}, "no such service"),
        ({"service": "a b"}, "a b"),
    ],
)
async def test_a_call_that_fails_is_answered(
    client: RosbridgeClient, node: Node, fields: dict[str, Any], told: str
) -> None:
    """Whatever the reason, even for a client that has not requested statuses."""
    node.create_service(AddTwoInts, "/add", add)

    client.send("call_service", id="c1", **fields)

    answer = await client.receive()
    assert (answer["op"], answer["result"], answer["id"]) == ("service_response", False, "c1")
    assert told in answer["values"]


async def test_a_refused_call_is_answered(robot: Robot, node: Node) -> None:
    """In rosbridge, a client whose call no glob allows waits forever."""
    node.create_service(AddTwoInts, "/add", add)
    robot.policy = Policy.default()
    async with rosbridge_client(robot) as client:
        answer = await client.call("/add", a=1)

    assert answer["result"] is False
    assert "refused" in answer["values"]


async def test_calls_do_not_wait_for_each_other(client: RosbridgeClient, node: Node) -> None:
    """A service that takes long must not delay the others."""
    may_end = asyncio.Event()

    async def slowly(request: AddTwoInts.Request) -> AddTwoInts.Response:
        await may_end.wait()
        return add(request)

    node.create_service(AddTwoInts, "/slow", slowly)
    node.create_service(AddTwoInts, "/add", add)
    client.send("call_service", service="/slow", id="slow")
    client.send("call_service", service="/add", id="fast")

    assert (await client.receive())["id"] == "fast"
    may_end.set()
    assert (await client.receive())["id"] == "slow"


# Services that a client serves


async def test_a_client_serves_the_robot(client: RosbridgeClient, node: Node) -> None:
    """Its answer is the response; the id identifies the request."""
    client.send("advertise_service", service="/sum", type=ADD)
    caller = node.create_client(AddTwoInts, "/sum")
    await caller.wait_for_service()
    call = start(caller.call(AddTwoInts.Request(a=1, b=2)))

    request = await client.receive()
    assert (request["op"], request["args"]) == ("call_service", {"a": 1, "b": 2})
    assert request["id"] == "service_request:/sum:1"
    answer = {"service": "/sum", "id": request["id"], "result": True}
    client.send("service_response", values={"sum": 3}, **answer)

    assert (await call).sum == 3


@pytest.mark.parametrize(
    ("answer", "told"),
    [
        ({"result": False, "values": "out of paper"}, "out of paper"),
        ({"result": False}, "reported a failure"),
        ({"result": True, "values": {"summ": 1}}, "did you mean 'sum'"),
        ({"result": True, "values": "text"}, "use an object"),
        ({"result": True, "values": None}, "use an object"),
    ],
)
async def test_a_client_that_fails_to_serve_tells_the_caller(
    client: RosbridgeClient, node: Node, answer: dict[str, Any], told: str
) -> None:
    """In rosbridge, the caller waits forever if roslibjs sends a text or nothing."""
    client.send("advertise_service", service="/sum", type=ADD)
    caller = node.create_client(AddTwoInts, "/sum")
    await caller.wait_for_service()
    call = start(caller.call(AddTwoInts.Request()))
    request = await client.receive()

    client.send("service_response", service="/sum", id=request["id"], **answer)

    with pytest.raises(ServiceError, match=told):
        await call


@pytest.mark.parametrize("way", ["leave", "unadvertise", "again"])
async def test_a_request_to_a_client_that_goes_fails(robot: Robot, node: Node, way: str) -> None:
    """In rosbridge, it gets an empty response, as if all were well."""
    caller = node.create_client(AddTwoInts, "/sum")
    async with rosbridge_client(robot) as client:
        client.send("advertise_service", service="/sum", type=ADD)
        await caller.wait_for_service()
        call = start(caller.call(AddTwoInts.Request()))
        await client.receive()
        if way == "unadvertise":
            client.send("unadvertise_service", service="/sum")
        elif way == "again":
            client.send("advertise_service", service="/sum", type=ADD)
        else:
            client.leave()

        with pytest.raises(ServiceError):
            await call


async def test_a_client_finds_the_service_that_it_has_just_advertised(
    client: RosbridgeClient, node: Node
) -> None:
    """Its ops about one name are executed in order, even if it advertised the name before."""
    for number in range(3):
        client.send("advertise_service", service="/sum", type=ADD)
        client.send("call_service", service="/sum", args=[number, 2], id=f"c{number}")
        request = await client.receive()
        assert request["args"]["a"] == number
        answer = {"service": "/sum", "id": request["id"], "values": {"sum": number + 2}}
        client.send("service_response", result=True, **answer)
        assert (await client.receive())["values"] == {"sum": number + 2}
        client.send("unadvertise_service", service="/sum")


async def test_one_client_cannot_answer_for_another(robot: Robot, node: Node) -> None:
    """The ids of requests are easy to guess; each client has its own."""
    caller = node.create_client(AddTwoInts, "/sum")
    async with rosbridge_client(robot) as server, rosbridge_client(robot) as other:
        server.send("advertise_service", service="/sum", type=ADD)
        await caller.wait_for_service()
        call = start(caller.call(AddTwoInts.Request()))
        request = await server.receive()
        answer = {"service": "/sum", "id": request["id"], "result": True}
        other.send("set_level", level="error")
        other.send("service_response", values={"sum": 666}, **answer)
        assert "not advertised by this client" in (await other.receive())["msg"]
        server.send("service_response", values={"sum": 3}, **answer)

        assert (await call).sum == 3


# Goals that a client sends


async def count(goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
    """Execute a goal: one of order 99 never ends, a negative one is aborted."""
    goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
    if goal.request.order == 99:
        await asyncio.Event().wait()
    if goal.request.order < 0:
        goal.abort()
        return Fibonacci.Result(sequence=[-1])
    goal.succeed()
    return Fibonacci.Result(sequence=[0, 1, 1])


def accept(goal: object) -> CancelResponse:
    """Accept every request to cancel."""
    return CancelResponse.ACCEPT


def goal_of(order: int) -> dict[str, Any]:
    """Return the fields of an op that sends a goal."""
    return {
        "action": "/fibonacci",
        "action_type": FIBONACCI,
        "args": {"order": order},
        "feedback": True,
        "id": "g1",
    }


@pytest.mark.parametrize(("order", "status"), [(3, 4), (-1, 6)])
async def test_a_goal_is_answered_with_feedback_and_result(
    client: RosbridgeClient, node: Node, order: int, status: int
) -> None:
    """An aborted goal has a result, too, and its status says so."""
    ActionServer(node, Fibonacci, "/fibonacci", count, cancel_callback=accept)
    await settle()

    client.send("send_action_goal", **goal_of(order))

    feedback = {"op": "action_feedback", "action": "/fibonacci", "id": "g1"}
    assert await client.receive() == feedback | {"values": {"sequence": [0, 1]}}
    result = await client.receive()
    assert (result["op"], result["status"], result["result"]) == ("action_result", status, True)
    assert result["values"]["sequence"] == ([0, 1, 1] if order > 0 else [-1])


async def test_a_goal_is_canceled_by_its_id(client: RosbridgeClient, node: Node) -> None:
    """Its result has the status 5."""
    ActionServer(node, Fibonacci, "/fibonacci", count, cancel_callback=accept)
    await settle()
    client.send("send_action_goal", **goal_of(99))
    assert (await client.receive())["op"] == "action_feedback"

    client.send("cancel_action_goal", action="/fibonacci", id="g1")

    result = await client.receive()
    assert (result["op"], result["status"], result["id"]) == ("action_result", 5, "g1")


async def test_the_goals_of_a_client_end_with_it(robot: Robot, node: Node) -> None:
    """Motion ends when its client has gone; in rosbridge it continues."""
    seen: list[ServerGoalHandle[Any, Any, Any]] = []

    async def watched(goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
        seen.append(goal)
        return await count(goal)

    ActionServer(node, Fibonacci, "/fibonacci", watched, cancel_callback=accept)
    await settle()
    async with rosbridge_client(robot) as client:
        client.send("send_action_goal", **goal_of(99))
        await client.receive()

    await settle()
    assert [goal.status for goal in seen] == [GoalStatus.CANCELED]


async def test_a_goal_that_fails_is_answered(client: RosbridgeClient, node: Node) -> None:
    """No server, a rejected goal, a wrong type, an id in use: each has its text."""
    for fields, told in (
        ({"action": "/none", "action_type": FIBONACCI}, "no action server"),
        ({"action": "/none"}, "/none"),
        ({"action": "/none", "action_type": FIBONACCI, "args": {"x": 1}}, "no such field"),
    ):
        client.send("send_action_goal", id="g2", **fields)
        result = await client.receive()
        assert (result["op"], result["result"], result["status"]) == ("action_result", False, 0)
        assert told in result["values"]


async def test_a_goal_can_be_canceled_before_it_is_accepted(
    client: RosbridgeClient, node: Node
) -> None:
    """Then it is withdrawn, and its client learns that no result will come."""
    is_asked, may_decide = asyncio.Event(), asyncio.Event()
    executed: list[object] = []

    async def decide(goal: object) -> GoalResponse:
        is_asked.set()
        await may_decide.wait()
        return GoalResponse.ACCEPT

    ActionServer(node, Fibonacci, "/fibonacci", executed.append, goal_callback=decide)
    await settle()
    client.send("send_action_goal", **goal_of(3))
    await is_asked.wait()

    client.send("cancel_action_goal", action="/fibonacci", id="g1")

    result = await client.receive()
    assert (result["op"], result["result"], result["id"]) == ("action_result", False, "g1")
    may_decide.set()
    await settle()
    assert not executed


async def test_a_rejected_goal_is_answered(client: RosbridgeClient, node: Node) -> None:
    """The client does not wait for a result that never comes."""
    ActionServer(node, Fibonacci, "/fibonacci", count, goal_callback=lambda _: GoalResponse.REJECT)
    await settle()

    client.send("send_action_goal", **goal_of(3))

    result = await client.receive()
    assert (result["op"], result["result"], result["id"]) == ("action_result", False, "g1")
    assert "rejected" in result["values"]


async def test_goals_of_one_client_have_their_own_ids(client: RosbridgeClient, node: Node) -> None:
    """One is canceled, and everything else continues; an id in use is refused."""
    ActionServer(node, Fibonacci, "/fibonacci", count, cancel_callback=accept)
    await settle()
    for order, message_id in ((99, "long"), (99, "long"), (3, "short")):
        client.send("send_action_goal", **goal_of(order) | {"id": message_id, "feedback": False})

    refused, short = await client.receive(), await client.receive()
    assert (refused["id"], refused["result"]) == ("long", False)
    assert (short["id"], short["status"]) == ("short", 4)
    client.send("cancel_action_goal", action="/fibonacci", id="long")
    canceled = await client.receive()
    assert (canceled["id"], canceled["status"]) == ("long", 5)


# Actions that a client serves


def served(node: Node, order: int = 3) -> tuple[Any, Any]:
    """Return the client of an action, and a goal for it."""
    return ActionClient(node, Fibonacci, "/count"), Fibonacci.Goal(order=order)


async def test_a_client_executes_goals(client: RosbridgeClient, node: Node) -> None:
    """Feedback and result are those of the client."""
    client.send("advertise_action", action="/count", type=FIBONACCI)
    caller, goal = served(node)
    await caller.wait_for_server()
    handle = await caller.send_goal(goal)
    sent = await client.receive()
    assert (sent["op"], sent["args"], sent["action"]) == (
        "send_action_goal",
        {"order": 3},
        "/count",
    )
    answer = {"action": "/count", "id": sent["id"]}
    client.send("action_feedback", values={"sequence": [0]}, **answer)
    assert (await anext(aiter(handle))).sequence.tolist() == [0]

    client.send("action_result", values={"sequence": [0, 1]}, status=4, result=True, **answer)

    result = await handle.result()
    assert (result.status, result.result.sequence.tolist()) == (GoalStatus.SUCCEEDED, [0, 1])


@pytest.mark.parametrize(
    ("answer", "status"),
    [
        ({"result": False}, GoalStatus.ABORTED),
        ({"result": True, "status": 6, "values": {}}, GoalStatus.ABORTED),
        ({"result": True, "status": 4, "values": {"x": 1}}, GoalStatus.ABORTED),
    ],
)
async def test_a_goal_that_the_client_does_not_reach_is_aborted(
    client: RosbridgeClient, node: Node, answer: dict[str, Any], status: GoalStatus
) -> None:
    """The same holds if the client's answer is not a result, or empty, as from roslibjs."""
    client.send("advertise_action", action="/count", type=FIBONACCI)
    caller, goal = served(node)
    await caller.wait_for_server()
    handle = await caller.send_goal(goal)
    sent = await client.receive()

    client.send("action_result", action="/count", id=sent["id"], **answer)

    assert (await handle.result()).status is status


async def test_the_client_is_told_of_a_canceled_goal(client: RosbridgeClient, node: Node) -> None:
    """Its result is then that of the canceled goal."""
    client.send("advertise_action", action="/count", type=FIBONACCI)
    caller, goal = served(node)
    await caller.wait_for_server()
    handle = await caller.send_goal(goal)
    sent = await client.receive()
    canceling = start(handle.cancel())

    cancel = await client.receive()
    assert (cancel["op"], cancel["id"]) == ("cancel_action_goal", sent["id"])
    answer = {"action": "/count", "id": sent["id"], "status": 5, "result": True}
    client.send("action_result", values={"sequence": [7]}, **answer)

    result = await handle.result()
    await canceling
    assert (result.status, result.result.sequence.tolist()) == (GoalStatus.CANCELED, [7])


@pytest.mark.parametrize("way", ["leave", "unadvertise"])
async def test_the_goals_of_a_client_that_goes_are_aborted(
    robot: Robot, node: Node, way: str
) -> None:
    """Nobody executes them any more."""
    caller, goal = served(node)
    async with rosbridge_client(robot) as client:
        client.send("advertise_action", action="/count", type=FIBONACCI)
        await caller.wait_for_server()
        handle = await caller.send_goal(goal)
        await client.receive()
        if way == "unadvertise":
            client.send("unadvertise_action", action="/count")
            assert (await handle.result()).status is GoalStatus.ABORTED

    assert (await handle.result()).status is GoalStatus.ABORTED
