"""The example that makes tools for language models of what a robot offers."""

from __future__ import annotations

from typing import Any

from aionode import Node, ServerGoalHandle
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import local_context
from examples.agent_tools import answer, tools_of


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    """Serve one request."""
    return AddTwoInts.Response(sum=request.a + request.b)


def count(handle: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
    """Execute one goal."""
    handle.succeed()
    return Fibonacci.Result(sequence=[0, 1])


async def test_a_loop_calls_what_the_robot_offers_and_is_told_what_went_wrong() -> None:
    """In words that the next call can be mended from."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    async with Node("robot", context=local_context()) as robot:
        robot.create_service(AddTwoInts, "add", add)
        robot.create_action_server(Fibonacci, "count", count)
        robot.create_publisher(String, "state", latched).publish(String(data="idle"))
        tools = await tools_of(robot)

        assert set(tools) == {"call_add", "do_count", "read_state"}
        schema = tools["call_add"].definition["input_schema"]
        assert set(schema["properties"]) == {"a", "b"}
        added = await answer(tools, {"tool": "call_add", "input": {"a": 1, "b": 2}})
        assert added["value"] == {"sum": 3}
        counted = await answer(tools, {"tool": "do_count", "input": {"order": 2}})
        assert counted["value"] == {"sequence": [0, 1]}
        wrong = await answer(tools, {"tool": "call_add", "input": {"c": 1}})
        assert "AddTwoInts_Request.c: no such field" in wrong["error"]
        assert "call_add" in (await answer(tools, {"tool": "fly"}))["error"]
