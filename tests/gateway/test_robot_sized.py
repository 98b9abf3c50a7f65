"""Messages of the size that robots use: they pass, and larger ones are refused with a log line."""

from __future__ import annotations

import json
import logging
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from aionode.errors import PolicyFileError
from aionode.gateway import Limits, Policy
from aionode.interfaces.nav_msgs.msg import Path
from aionode.interfaces.nav_msgs.srv import GetPlan, SetMap
from aionode.interfaces.std_msgs.msg import UInt8MultiArray
from aionode.interfaces.std_srvs.srv import Trigger
from tests.support.gateway_bench import Bench
from tests.support.gateway_server import raw_connect, serving
from tests.support.rosbridge import RosbridgeClient, rosbridge_client
from tests.support.waiting import until

POSE = {
    "header": {"frame_id": "map"},
    "pose": {"position": {"x": 1.25}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}},
}


def lines(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings of the gateway."""
    return [each.getMessage() for each in caplog.records if each.levelno == logging.WARNING]


@pytest.mark.slow
async def test_a_path_of_2000_poses_arrives(caplog: pytest.LogCaptureFixture) -> None:
    """A planner has more; rosbridge accepts 10 MB."""
    got: list[Path] = []
    async with (
        serving(Policy.default(allow_write=True)) as gateway,
        raw_connect(gateway, "/", {}, []) as page,
    ):
        gateway.node.create_subscription(Path, "/plan", got.append, 1)
        message = {"poses": [POSE] * 2000}
        op = {"op": "publish", "topic": "/plan", "type": "nav_msgs/Path", "msg": message}
        await page.send(json.dumps(op))
        await until(lambda: got)

    assert len(got[0].poses) == 2000
    assert not lines(caplog)


async def test_eight_megabytes_arrive() -> None:
    """As base64, such as a map or a picture."""
    got: list[UInt8MultiArray] = []
    async with (
        serving(Policy.default(allow_write=True)) as gateway,
        raw_connect(gateway, "/", {}, []) as page,
    ):
        gateway.node.create_subscription(UInt8MultiArray, "/bytes", got.append, 1)
        op = {"op": "publish", "topic": "/bytes", "type": "std_msgs/UInt8MultiArray"}
        await page.send(json.dumps({**op, "msg": {"data": "AAAA" * 2_000_000}}))
        await until(lambda: got)

    assert len(got[0].data) == 6_000_000


async def test_a_call_with_many_objects_is_answered() -> None:
    """With its response, or with the reason."""
    async with (
        serving(Policy.default(allow_write=True)) as gateway,
        raw_connect(gateway, "/", {}, []) as page,
    ):
        gateway.node.create_service(GetPlan, "/plan", lambda _: GetPlan.Response())
        gateway.node.create_service(SetMap, "/map", lambda _: SetMap.Response(success=True))
        call = {"op": "call_service", "id": 1, "service": "/map"}
        await page.send(json.dumps({**call, "args": {"map": {"data": [0] * 20_000}}}))
        assert json.loads(await page.recv())["result"] is True
        await page.send(json.dumps({**call, "args": {"map": [[]] * 110_000}}))
        answer = json.loads(await page.recv())

    assert (answer["id"], answer["result"]) == (1, False)
    assert "objects and lists, at most 100000 are allowed by frame_parts" in answer["values"]


async def test_a_frame_that_is_too_large_is_in_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Its client only sees that the connection has ended."""
    limits = Limits(frame_bytes=1000)
    policy = Policy.default(limits=limits)
    async with serving(policy) as gateway, raw_connect(gateway, "/", {}, []) as page:
        await page.send("x" * 2000)
        with pytest.raises(ConnectionClosed):
            await page.recv()
        await until(lambda: not gateway.stats.sessions)
        assert gateway.stats.refusals == {"too_large": 1}

    (line,) = lines(caplog)
    assert "frame: at most 1000 bytes are allowed by frame_bytes; the connection has ended" in line


# Time limits of calls


@pytest.fixture
async def slow(bench: Bench) -> Bench:
    """Return a gateway beside a service that answers after 7 s."""

    async def answer(_: Any) -> Any:
        await bench.node.get_clock().sleep(7.0)
        return Trigger.Response(success=True)

    bench.node.create_service(Trigger, "/slow", answer)
    await bench.advance(0.1)
    return bench


async def answered(bench: Bench, page: RosbridgeClient, seconds: float, **fields: Any) -> bool:
    """Call the service, and return whether it succeeded within some seconds."""
    page.send("call_service", service="/slow", **fields)
    await bench.advance(0.01)
    for _ in range(round(seconds * 2)):
        await bench.advance(0.5)
    return bool((await page.receive())["result"])


async def test_a_service_may_take_seven_seconds(slow: Bench) -> None:
    """Clients such as roslibpy and ros-mcp send no time limit."""
    async with rosbridge_client(slow.robot) as page:
        assert await answered(slow, page, 8.0)


@pytest.mark.parametrize(
    ("limits", "fields"),
    [
        (Limits(call_sec=0.2), {}),
        (Limits(longest_call_sec=0.2), {}),
        (Limits(longest_call_sec=0.2), {"timeout": 60.0}),
        (Limits(longest_call_sec=0.2), {"timeout": -1}),
        (Limits(longest_call_sec=0.2), {"timeout": 0}),
        (Limits(), {"timeout": 0.2}),
    ],
)
async def test_a_policy_says_how_long_calls_wait(
    slow: Bench, limits: Limits, fields: dict[str, float]
) -> None:
    """By default, and at most."""
    slow.robot.policy = Policy.default(allow_write=True, limits=limits)
    async with rosbridge_client(slow.robot) as page:
        assert not await answered(slow, page, 6.0, **fields)


def test_limits_are_given_as_text() -> None:
    """By the command's option, for a gateway without a policy."""
    limits = Limits().with_given(["call_sec=60", "frame_bytes=20_000_000"])

    assert (limits.call_sec, limits.frame_bytes) == (60.0, 20_000_000)
    assert limits.clients == Limits().clients


@pytest.mark.parametrize("text", ["frame_bytes", "speed=1", "clients=many", "clients=0", "=1"])
def test_an_invalid_limit_is_refused(text: str) -> None:
    """The error lists the limits."""
    with pytest.raises(ValueError, match=r"one of clients, frame_bytes|not a valid|above 0"):
        Limits().with_given([text])


def test_a_limit_of_nothing_is_a_mistake_in_the_file() -> None:
    """With it, no client could do anything."""
    with pytest.raises(PolicyFileError, match="use a number above 0"):
        Policy.parse("[limits]\ncall_sec = 0")
