"""NaN, infinities and null instead of numbers: what a client may not send to the robot."""

from __future__ import annotations

import asyncio
import json
import math
import struct
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from typing import Any

import pytest
from websockets.asyncio.client import connect
from websockets.typing import Subprotocol

from aionode.engine.context import Context
from aionode.engine.wire import cdr
from aionode.errors import RefusedError
from aionode.gateway import Gateway, Policy
from aionode.gateway.policy.field_limits import OutOfLimitsError, check_finite
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from aionode.interfaces.nav_msgs.srv import GetPlan
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_msgs.msg import Float64, Header
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.interfaces.turtlesim.action import RotateAbsolute
from aionode.node import Node
from aionode.testing import settle
from tests.support.gateway_bench import Bench
from tests.support.http_client import http_client
from tests.support.ways_in import Ask, until, way_in

TWIST = "geometry_msgs/msg/Twist"
RULES = {
    "a lease": f"[[allow]]\npublish = '/**'\ntype = '{TWIST}'\nlease = {{ ttl_sec = 60 }}\n",
    "a lease and fields": (
        "[[allow]]\npublish = '/**'\nlease = { ttl_sec = 60 }\n"
        "fields = { 'linear.x' = { min = -1, max = 1, outside = 'clamp' } }\n"
    ),
    "neither": "[[allow]]\npublish = '/**'\n",
}


class Robot(Node):
    """A robot that keeps what it is told."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self.told: list[Any] = []
        self.create_subscription(Twist, "/cmd_vel", self.told.append, 10)
        self.create_subscription(LaserScan, "/scan", self.told.append, 10)
        self.create_service(GetPlan, "/plan", self._plan)
        self.create_action_server(RotateAbsolute, "/rotate", self._rotate)
        self.declare_parameter("speed", 0.0)

    def _plan(self, request: Any) -> Any:
        self.told.append(request)
        return GetPlan.Response()

    def _rotate(self, goal: Any) -> Any:
        self.told.append(goal.request)
        goal.succeed()
        return RotateAbsolute.Result()


@pytest.fixture
async def robot(context: Context) -> AsyncIterator[Robot]:
    """Yield the robot."""
    async with Robot(context) as robot:
        yield robot


@pytest.fixture
async def gateway(context: Context, robot: Robot) -> AsyncIterator[Gateway]:
    """Yield a gateway with which programs of this host may do everything."""
    async with AsyncExitStack() as stack:
        node = await stack.enter_async_context(Node("gateway", context=context))
        policy = Policy.default(allow_write=True)
        yield await stack.enter_async_context(Gateway(node, policy, port=0))


ASKS = {
    "a command": ("publish", "/cmd_vel", TWIST, {"linear": {"x": "NaN"}}),
    "an infinite one": ("publish", "/cmd_vel", TWIST, {"angular": {"z": "-Infinity"}}),
    "a request": ("call", "/plan", "nav_msgs/srv/GetPlan", {"tolerance": "Infinity"}),
    "a goal": ("goal", "/rotate", "turtlesim/action/RotateAbsolute", {"theta": "NaN"}),
}


@pytest.mark.parametrize("ask", ASKS)
@pytest.mark.parametrize("way", ["rosbridge", "http", "events", "foxglove"])
async def test_a_number_that_is_not_finite_is_refused(
    gateway: Gateway, robot: Robot, way: str, ask: str
) -> None:
    """A controller would pass it on to the motors, whatever sent it."""
    verb, name, type_name, values = ASKS[ask]
    if (way, verb) == ("foxglove", "goal") or (way == "events" and verb != "goal"):
        return  # these protocols have none
    async with way_in(way, gateway.port, {}) as client:
        answer = await client.do(Ask(verb, name, type_name, values, lambda: bool(robot.told)))

    assert "only finite numbers" in answer.refusal
    assert robot.told == []


@pytest.mark.parametrize("rules", RULES)
async def test_neither_the_bytes_of_a_command_hide_it_nor_a_policy_without_fields(
    bench: Bench, rules: str
) -> None:
    """Raw CDR has not been parsed as JSON; ``clamp`` would turn an infinity into full speed."""
    got: list[Twist] = []
    bench.node.create_subscription(Twist, "/cmd_vel", got.append)
    bench.allow(RULES[rules])
    async with bench.session() as session:
        for value in (math.nan, math.inf, -math.inf):
            for command in (Twist(linear=Vector3(x=value)), Twist(angular=Vector3(y=value))):
                with pytest.raises(RefusedError, match=r"\.[xy] is -?(nan|inf)") as refused:
                    await session.publish("/cmd_vel", bytes(cdr.encode(command)), TWIST)
                assert refused.value.code == "out_of_limits"
    await settle()

    assert got == []


async def test_numbers_in_arrays_and_nested_messages_count(bench: Bench) -> None:
    """A trajectory contains them in arrays of messages in an array."""
    point = JointTrajectoryPoint(positions=[0.0, 1.0], velocities=[0.0, math.nan])
    async with bench.session() as session:
        with pytest.raises(RefusedError, match=r"points\.velocities is nan"):
            await session.publish(
                "/arm", JointTrajectory(points=[JointTrajectoryPoint(), point]),
                "trajectory_msgs/msg/JointTrajectory",
            )  # fmt: skip


def test_a_text_that_says_null_is_no_number() -> None:
    """Numbers are first searched for in JSON, where they are null."""
    for text in ("null", "\udcff"):
        check_finite(TwistStamped(header=Header(frame_id=text)))
        with pytest.raises(OutOfLimitsError, match=r"twist\.linear\.x is nan"):
            check_finite(
                TwistStamped(header=Header(frame_id=text), twist=Twist(linear=Vector3(x=math.nan)))
            )


async def test_a_scan_may_have_infinities_unless_it_commands(bench: Bench) -> None:
    """In a scan they mean that nothing reflects (REP 117); under a lease a message is a command."""
    got: list[LaserScan] = []
    bench.node.create_subscription(LaserScan, "/scan", got.append)
    scan = LaserScan(ranges=[1.0, math.inf, math.nan])
    async with bench.session() as session:
        await session.publish("/scan", scan, "sensor_msgs/msg/LaserScan")
        bench.allow("[[allow]]\npublish = '/**'\nlease = {}\n")
        with pytest.raises(RefusedError, match="ranges is inf"):
            await session.publish("/scan", scan, "sensor_msgs/msg/LaserScan")
    await settle()

    assert len(got) == 1


async def test_a_policy_may_let_them_pass(bench: Bench) -> None:
    """A PX4 set point marks unset fields with NaN."""
    got: list[float] = []
    bench.node.create_subscription(Float64, "/set_point", lambda msg: got.append(msg.data))
    bench.allow("[[allow]]\npublish = '/set_point'\nfinite = false\n")
    async with bench.session() as session:
        await session.publish("/set_point", Float64(data=math.inf), "std_msgs/msg/Float64")
    await settle()

    assert got == [math.inf]


async def test_a_parameter_is_finite(gateway: Gateway, robot: Robot) -> None:
    """By itself, and in a call of the service that sets parameters."""
    value = {"name": "speed", "value": {"type": 3, "double_value": "Infinity"}}
    call = ("call", "/robot/set_parameters", "rcl_interfaces/srv/SetParameters")
    for way in ("rosbridge", "http", "foxglove"):
        async with way_in(way, gateway.port, {}) as client:
            answer = await client.do(Ask(*call, {"parameters": [value]}, lambda: False))
            assert "only finite numbers" in answer.refusal
    async with http_client(gateway.port) as client:
        json_type = {"Content-Type": "application/json"}
        path = "/parameters/robot/speed"
        answered = await client.put(path, content=b"Infinity", headers=json_type)

    assert answered.status_code == 422, answered.text
    assert robot.get_parameter("speed").value == 0.0


NULL = {"linear": {"x": None}}


async def test_null_moves_nothing_over_a_websocket(gateway: Gateway, robot: Robot) -> None:
    """``JSON.stringify`` turns NaN into null; the command after it is the first that arrives."""
    url = f"ws://127.0.0.1:{gateway.port}"
    async with connect(url, proxy=None) as page:
        await page.send(json.dumps({"op": "set_level", "level": "error"}))
        op = {"op": "publish", "topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
        await page.send(json.dumps({**op, "msg": NULL}))
        async with asyncio.timeout(20):
            assert "linear.x: None (NoneType), needs a float" in await page.recv()
    async with connect(url, proxy=None, subprotocols=[Subprotocol("foxglove.sdk.v1")]) as app:
        channel = {"id": 1, "topic": "/cmd_vel", "encoding": "json", "schemaName": TWIST}
        await app.send(json.dumps({"op": "advertise", "channels": [channel]}))
        for values in (NULL, {"linear": {"x": 1.0}}):
            await app.send(struct.pack("<BI", 1, 1) + json.dumps(values).encode())
        await until(lambda: robot.told)

    assert robot.told[0].linear.x == 1.0


async def test_null_moves_nothing_over_http(gateway: Gateway, robot: Robot) -> None:
    """In a command, a request and a goal."""
    async with http_client(gateway.port) as client:
        answers = [
            await client.post(f"/topics/cmd_vel?type={TWIST}", json=NULL),
            await client.post("/services/plan", json={"tolerance": None}),
            await client.post("/actions/rotate", json={"theta": None}),
        ]

    assert [(each.status_code, each.json()["code"]) for each in answers] == [
        (400, "invalid_message")
    ] * 3
    assert robot.told == []
