"""A gateway that was stalled: commands that waited meanwhile must not move anything."""

from __future__ import annotations

import asyncio
import json
import time  # noqa: TID251  # the loop itself is to stand still
from collections.abc import AsyncIterator, Awaitable
from contextlib import asynccontextmanager
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection

from aionode import Node, Parameter
from aionode.errors import RefusedError
from aionode.gateway import Gateway, Policy
from aionode.gateway._gateway import REFUSALS_PER_SEC, paced
from aionode.gateway.session.standstill import Standstills
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.testing import ManualClock
from tests.gateway.test_broken_connections import PONG, frame, ping_of
from tests.support.gateway_bench import Bench
from tests.support.gateway_server import (
    address,
    drive,
    http_client,
    raw_connect,
    serving,
    session_of,
    upgraded,
)
from tests.support.waiting import until

POLICY = """
[[who]]
name = "local"
loopback = true
[[allow]]
publish = "/cmd_vel"
lease = { ttl_sec = 0.3, max_age_sec = 60.0 }
[[allow]]
see = "/**"
publish = "/**"
"""


def request(speed: float) -> bytes:
    """Return a command over HTTP."""
    body = json.dumps({"linear": {"x": speed}}).encode()
    return (
        b"POST /topics/cmd_vel?type=geometry_msgs/Twist HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        b"Content-Type: application/json\r\nContent-Length: %d\r\n\r\n%s" % (len(body), body)
    )


def listen(gateway: Gateway) -> list[float]:
    """Return the speeds that the wheels receive."""
    got: list[float] = []
    gateway.node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x), 100)
    return got


def stand_still(seconds: float = 0.6) -> None:
    """Block the loop, like a callback of the robot."""
    time.sleep(seconds)


async def answer_pings(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """Answer every ping, as a browser does."""
    while True:
        writer.write(frame(await ping_of(reader), PONG))


@pytest.mark.parametrize("has_lease", [True, False], ids=["a holder", "one without a lease"])
async def test_nothing_that_waited_in_a_standstill_reaches_the_wheels(has_lease: bool) -> None:
    """The page has been released by then; data after the pong was sent after the ping."""
    async with serving(Policy.parse(POLICY)) as gateway:
        got = listen(gateway)
        reader, writer, _ = await upgraded(gateway)
        if has_lease:
            writer.write(frame(drive(1.0).encode()))
            await until(lambda: got == [1.0])
        for _ in range(20):
            writer.write(frame(drive(100.0).encode()))
        stand_still()
        session = session_of(gateway)
        await until(lambda: session.rights.refused == 20)
        async with asyncio.TaskGroup() as tasks:
            # The end of its lease is another reason to ping, and so is each wait of a busy machine.
            answering = tasks.create_task(answer_pings(reader, writer))
            await until(lambda: not session.arrivals.is_doubtful)
            answering.cancel()
        writer.write(frame(drive(2.0).encode()))
        await until(lambda: 2.0 in got)
        writer.close()

    assert 100.0 not in got


@pytest.mark.parametrize("is_new", [True, False], ids=["a new connection", "one that was open"])
async def test_a_request_that_waited_in_a_standstill_moves_nothing(is_new: bool) -> None:
    """HTTP has no ping, so everything is refused for a moment; a program repeats its request."""
    async with serving(Policy.parse(POLICY)) as gateway:
        got = listen(gateway)
        reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
        if not is_new:
            writer.write(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            assert b"200 OK" in await reader.readuntil(b"true}")
        writer.write(request(100.0))
        stand_still()
        answer = await reader.readuntil(b"}")
        assert b" 409 " in answer.splitlines()[0]
        assert json.loads(answer.partition(b"\r\n\r\n")[2])["code"] == "too_old"
        while not got:
            writer.write(request(2.0))
            await reader.readuntil(b"\r\n\r\n")
            await asyncio.sleep(0.02)  # noqa: TID251  # as often as a program sends them
        writer.close()

    assert set(got) <= {2.0, 0.0}


async def test_a_standstill_loses_no_client() -> None:
    """Its client's signs of life have arrived meanwhile, and are read before it counts as lost."""
    limits = "[limits]\nclient_lost_sec = 1.0\n"
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        reader, writer, _ = await upgraded(gateway)
        writer.write(frame(drive(1.0).encode()))
        session = session_of(gateway)
        await until(lambda: session.publishes)
        stand_still(1.3)
        for _ in range(2):
            writer.write(frame(await ping_of(reader), PONG))
        assert not session.ended.is_set()
        writer.close()


async def test_a_late_look_is_a_standstill() -> None:
    """The first check finds it: that of the alarm, or of a frame read in the same iteration."""
    clock = ManualClock()
    found: list[int] = []
    watch = Standstills(clock)
    watch.watch(lambda _: found.append(clock.steady_ns()))
    for _ in range(100):
        await clock.advance(0.03)
    assert found == []
    assert watch.until_ns == -1
    await clock.jump(0.5)  # the alarm checks
    clock.stall(0.5)
    watch.look()  # before the alarm
    assert [round(each / 1e9, 1) for each in found] == [3.5, 4.0]
    assert watch.until_ns > clock.steady_ns()
    assert watch.since_sec() == 0.0
    watch.stop()
    await clock.jump(5.0)
    watch.look()
    assert len(found) == 2


class Connection:
    """A connection that keeps the functions to call with its pongs."""

    def __init__(self) -> None:
        self.asked: list[Any] = []

    def silent_sec(self) -> float:
        """Return how long nothing has arrived."""
        return 0.0

    def has_unread(self) -> bool:
        """Return whether data is waiting."""
        return False

    def ping(self, answered: Any = None) -> None:
        """Keep it."""
        self.asked.append(answered)

    def abort(self) -> None:
        """Do nothing."""


async def receive() -> dict[str, str]:
    """Return a frame at once."""
    return {"type": "websocket.receive"}


async def test_a_client_that_was_not_read_for_a_while_is_doubted(bench: Bench) -> None:
    """Its commands wait in the kernel while the gateway delays it because of refusals."""
    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        session.arrivals.connection = Connection()

        receive_paced = paced(receive, 1000.0, bench.robot, session)
        session.rights.refused = round(REFUSALS_PER_SEC)
        await receive_paced()
        assert not session.arrivals.is_doubtful
        session.rights.refused += 1
        reading = tasks.create_task(receive_paced())
        await bench.advance(1.0)
        await reading
        assert session.arrivals.is_doubtful


async def test_a_driver_who_is_refused_is_read_as_before(bench: Bench) -> None:
    """Another one drives: if it had to wait, its old commands would count once that one ends."""
    async with bench.session() as session:
        receive_paced = paced(receive, 1000.0, bench.robot, session)
        session.rights.refused = session.rights.refused_cheaply = 10 * round(REFUSALS_PER_SEC)
        await receive_paced()  # at a time that stands still


async def test_the_answer_to_an_earlier_ping_leaves_a_later_doubt(bench: Bench) -> None:
    """It may have been in transit for long; data after it may be older than the later doubt."""
    async with bench.session() as session:
        session.arrivals.connection = connection = Connection()
        session.doubt()
        session.doubt()
        first, second = connection.asked
        first()
        assert session.arrivals.is_doubtful
        second()
        assert not session.arrivals.is_doubtful


# Calls, goals and parameters

FREE = """
[[who]]
name = "local"
loopback = true
[[allow]]
see = "/**"
call = "/**"
goal = "/**"
parameter = "/**"
"""

ADD = {"a": 1, "b": 2}
ADD_TYPE = "example_interfaces/AddTwoInts"
SET_PARAM = {"name": "/robot:speed", "value": "2.0"}

OPS: dict[str, dict[str, Any]] = {
    "call": {"op": "call_service", "service": "/add", "args": ADD, "id": "1"},
    "goal": {"op": "send_action_goal", "action": "/arm", "args": {"order": 1}, "id": "1"},
    "parameter": {
        "op": "call_service", "service": "/rosapi/set_param", "args": SET_PARAM, "id": "1",
    },
}  # fmt: skip
REQUESTS: dict[str, tuple[str, str, Any]] = {
    "call": ("POST", "/services/add", ADD),
    "goal": ("POST", "/actions/arm", {"order": 1}),
    "parameter": ("PUT", "/parameters/robot/speed", 2.0),
}


class Deeds:
    """A robot that does what clients request."""

    def __init__(self) -> None:
        self.done: list[str] = []

    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Record a call."""
        self.done.append("call")
        return AddTwoInts.Response(sum=request.a + request.b)

    async def move(self, goal: Any) -> Fibonacci.Result:
        """Record a goal."""
        self.done.append("goal")
        goal.succeed()
        return Fibonacci.Result()

    def set_speed(self, _: list[Parameter]) -> SetParametersResult:
        """Record a parameter."""
        self.done.append("parameter")
        return SetParametersResult(successful=True)


@asynccontextmanager
async def serving_deeds() -> AsyncIterator[tuple[Gateway, Deeds]]:
    """Serve such a robot."""
    deeds = Deeds()
    async with (
        serving(Policy.parse(FREE)) as gateway,
        Node("robot", context=gateway.node.context) as robot,
    ):
        robot.declare_parameter("speed", 1.0)
        robot.add_on_set_parameters_callback(deeds.set_speed)
        robot.create_service(AddTwoInts, "/add", deeds.add)
        robot.create_action_server(Fibonacci, "/arm", deeds.move)
        yield gateway, deeds


async def answer_of(client: ClientConnection) -> dict[str, Any]:
    """Return the answer to an op, ignoring other ops."""
    while True:
        told: dict[str, Any] = json.loads(await client.recv())
        if told.get("op") in {"service_response", "action_result"}:
            return told


@pytest.mark.parametrize("what", OPS)
async def test_what_a_page_asked_for_in_a_standstill_is_not_done(what: str) -> None:
    """An arm that moves seconds after the click, when nobody expects it any more, is dangerous."""
    async with serving_deeds() as (gateway, deeds), raw_connect(gateway, "/", {}, []) as client:
        op = json.dumps(OPS[what])
        await client.send(op)
        await answer_of(client)
        assert deeds.done.pop() == what
        await client.send(op)
        stand_still(1.5)
        told = str(await answer_of(client))
        assert "it may have waited while the gateway was stalled; send it again" in told
        await until(lambda: not session_of(gateway).arrivals.is_doubtful)
        assert deeds.done == []
        await client.send(op)
        await answer_of(client)

    assert deeds.done == [what]


@pytest.mark.parametrize("what", REQUESTS)
async def test_what_a_request_asked_for_in_a_standstill_is_not_done(what: str) -> None:
    """Its program is told to repeat it, and a later request succeeds."""
    method, path, values = REQUESTS[what]
    body = json.dumps(values).encode()
    asked = (
        f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        f"Accept: application/json\r\nContent-Length: {len(body)}\r\n\r\n"
    )
    async with serving_deeds() as (gateway, deeds), http_client() as client:
        reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
        writer.write(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        await reader.readuntil(b"true}")
        writer.write(asked.encode() + body)
        stand_still(1.5)
        answer = await reader.readuntil(b"}")
        assert json.loads(answer.partition(b"\r\n\r\n")[2])["code"] == "too_old"
        assert deeds.done == []
        while not deeds.done:
            await client.request(method, address(gateway, path), json=values)
            await asyncio.sleep(0.02)  # noqa: TID251  # as often as a program sends them
        writer.close()

    assert deeds.done == [what]


async def test_a_call_that_waited_for_a_moment_is_made() -> None:
    """A busy machine delays a loop for that long, and calls are not repeated like commands."""
    async with serving_deeds() as (gateway, deeds), raw_connect(gateway, "/", {}, []) as client:
        await client.send(json.dumps(OPS["call"]))
        stand_still()
        assert (await answer_of(client))["result"]

    assert deeds.done == ["call"]


async def test_a_call_that_waits_when_the_gateway_stands_still_is_not_made(bench: Bench) -> None:
    """It arrived in time, but its service was not there yet."""
    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        session.arrivals.connection = connection = Connection()
        calling = tasks.create_task(refusal_of(session.call("/add", ADD, type_name=ADD_TYPE)))
        await bench.advance(0.1)
        session.doubt(stood_still=True)
        connection.asked[-1]()
        bench.node.create_service(AddTwoInts, "/add", Deeds().add)
        assert (await calling).code == "too_old"


async def test_a_call_after_a_silence_of_its_client_is_made(bench: Bench) -> None:
    """A user who releases a stick and clicks is silent only for a lease's time to live."""
    bench.node.create_service(AddTwoInts, "/add", Deeds().add)
    async with bench.session() as session:
        session.arrivals.connection = Connection()
        session.doubt()
        assert (await session.call("/add", ADD)).sum == 3


async def refusal_of(asking: Awaitable[Any]) -> RefusedError:
    """Return the refusal of something."""
    with pytest.raises(RefusedError) as refused:
        await asking
    return refused.value
