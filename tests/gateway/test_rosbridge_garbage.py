"""A rosbridge client that sends garbage harms only itself."""

from __future__ import annotations

import json
import math
import random
from typing import Any

import pytest

from aionode.gateway.session.robot import Robot
from tests.support.rosbridge import RosbridgeClient, rosbridge_client

OPS = (
    "action_feedback action_result advertise advertise_action advertise_service auth call_service "
    "cancel_action_goal fragment publish send_action_goal service_response set_level subscribe "
    "unadvertise unadvertise_action unadvertise_service unsubscribe nonsense"
)

FIELDS = (
    "topic service action type action_type id msg args values data num total level status result "
    "feedback timeout throttle_rate queue_length queue_size fragment_size compression qos latch"
)

NAMES = ("/t", "t", "/s", "/a", "/rosapi/topics", "rosapi/get_param", "a b", "", "/x" * 400, "~")
TYPES = ("std_msgs/String", "std_srvs/Trigger", "example_interfaces/action/Fibonacci", "x/y/z")

NESTED: Any = []
for _ in range(300):
    NESTED = [NESTED]

JUNK: tuple[Any, ...] = (
    *NAMES,
    *TYPES,
    None,
    True,
    -1,
    0,
    3,
    10**30,
    1e300,
    math.nan,
    -math.inf,
    [],
    {},
    NESTED,
    ["x"] * 100,
    {"data": "x"},
    {"data": NESTED},
    {"depth": 10**30},
    {"reliability": NESTED},
    "\ud800",
    "x" * 5000,
)


def op_of_chance(chance: random.Random) -> str:
    """Return a random op with fields that may or may not make sense."""
    op: dict[str, Any] = {
        "op": chance.choice(OPS.split()),
        "topic": "/t",
        "service": "/s",
        "action": "/a",
    }
    op["type"] = op["action_type"] = chance.choice(TYPES)
    for _ in range(chance.randrange(4)):
        op[chance.choice(FIELDS.split())] = chance.choice(JUNK)
    return json.dumps(op)


@pytest.mark.parametrize("seed", range(4))
async def test_random_ops_harm_nobody(robot: Robot, client: RosbridgeClient, seed: int) -> None:
    """They do not even harm their sender: every failure is answered."""
    chance = random.Random(seed)  # noqa: S311  # no secret
    async with rosbridge_client(robot) as wild:
        wild.send("set_level", level="info")
        for _ in range(300):
            wild.send_frame(op_of_chance(chance))
        wild.send("call_service", service="/rosapi/get_ros_version", id="still there")
        while (await wild.receive()).get("id") != "still there":
            pass

    assert (await client.call("/rosapi/get_ros_version"))["result"] is True


@pytest.mark.parametrize("field", ["msg", "topic", "type", "qos", "queue_size"])
async def test_no_depth_of_nesting_harms(client: RosbridgeClient, field: str) -> None:
    """The decoder refuses some values and just accepts others: errors show both."""
    for depth in range(400, 1100, 20):
        nested = "[" * depth + "]" * depth
        op = '{"op": "publish", "topic": "/t", "type": "std_msgs/String", "%s": %s}'
        client.send_frame(op % (field, nested))
        assert (await client.receive())["op"] == "status"
