"""A gateway that stood still: commands that waited meanwhile must move nothing."""

from __future__ import annotations

import asyncio
import json
import time  # noqa: TID251  # the loop itself is to stand still
from typing import Any

import pytest

from aionode.gateway import Gateway, Policy
from aionode.gateway._gateway import REFUSALS_PER_SEC, paced
from aionode.gateway.session.standstill import Standstills
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.testing import ManualClock
from tests.gateway.test_broken_connections import PONG, frame, ping_of
from tests.support.gateway_bench import Bench
from tests.support.gateway_server import drive, serving, session_of, upgraded
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
    """Return the speeds that the wheels get."""
    got: list[float] = []
    gateway.node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x), 100)
    return got


def stand_still(seconds: float = 0.6) -> None:
    """Block the loop, as a callback of the robot does."""
    time.sleep(seconds)


@pytest.mark.parametrize("has_lease", [True, False], ids=["a holder", "one without a lease"])
async def test_nothing_that_waited_in_a_standstill_reaches_the_wheels(has_lease: bool) -> None:
    """The page has let go by then; what comes behind the answer to a ping was sent after it."""
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
        await until(lambda: session.refused == 20)
        for _ in range(1 + has_lease):  # the end of its lease is a reason of its own to ask
            writer.write(frame(await ping_of(reader), PONG))
        await until(lambda: not session.is_doubtful)
        writer.write(frame(drive(2.0).encode()))
        await until(lambda: 2.0 in got)
        writer.close()

    assert 100.0 not in got


@pytest.mark.parametrize("is_new", [True, False], ids=["a new connection", "one that was open"])
async def test_a_request_that_waited_in_a_standstill_moves_nothing(is_new: bool) -> None:
    """HTTP has no ping, so for a moment everything is refused; a program sends it again."""
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
    """The signs of its client have arrived meanwhile, and are heard before it counts as lost."""
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
    """Whoever looks first finds it: the alarm, or who reads a frame in the same turn."""
    clock = ManualClock()
    found: list[int] = []
    watch = Standstills(clock)
    watch.watch(lambda: found.append(clock.steady_ns()))
    for _ in range(100):
        await clock.advance(0.03)
    assert found == []
    assert watch.until_ns == -1
    await clock.jump(0.5)  # the alarm looks
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
    """A connection that keeps what is to be called with the answers to its pings."""

    def __init__(self) -> None:
        self.asked: list[Any] = []

    def silent_sec(self) -> float:
        """Return how long nothing has arrived."""
        return 0.0

    def has_unread(self) -> bool:
        """Return whether something waits."""
        return False

    def ping(self, answered: Any = None) -> None:
        """Keep it."""
        self.asked.append(answered)

    def abort(self) -> None:
        """Close nothing."""


async def receive() -> dict[str, str]:
    """Return a frame at once."""
    return {"type": "websocket.receive"}


async def test_a_client_that_was_not_read_for_a_while_is_doubted(bench: Bench) -> None:
    """Its commands wait in the kernel while the gateway lets it wait for what was refused."""
    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        session.connection = Connection()

        receive_paced = paced(receive, 1000.0, bench.robot, session)
        session.refused = round(REFUSALS_PER_SEC)
        await receive_paced()
        assert not session.is_doubtful
        session.refused += 1
        reading = tasks.create_task(receive_paced())
        await bench.advance(1.0)
        await reading
        assert session.is_doubtful


async def test_a_driver_who_is_refused_is_read_as_before(bench: Bench) -> None:
    """Another one drives: if it had to wait, its old commands would count when that one ends."""
    async with bench.session() as session:
        receive_paced = paced(receive, 1000.0, bench.robot, session)
        session.refused = session.refused_cheaply = 10 * round(REFUSALS_PER_SEC)
        await receive_paced()  # at a time that stands still


async def test_the_answer_to_an_earlier_ping_leaves_a_later_doubt(bench: Bench) -> None:
    """It may have been under way for long; what comes behind it is older than the later doubt."""
    async with bench.session() as session:
        session.connection = connection = Connection()
        session.doubt()
        session.doubt()
        first, second = connection.asked
        first()
        assert session.is_doubtful
        second()
        assert not session.is_doubtful
