"""Messages that take long to encode delay nobody: they are encoded while the event loop runs."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.wire import cdr
from aionode.gateway.session.delivery.preparing import LARGE_BYTES, Preparing
from aionode.gateway.session.delivery.waiting import MAX_BYTES
from aionode.gateway.session.encoding.frames import png_frame, png_frame_in_turns
from aionode.gateway.session.encoding.large_json import SLICE_BYTES, SLICE_ITEMS, json_in_turns
from aionode.gateway.session.encoding.values import json_of
from aionode.gateway.session.feed import Received
from aionode.gateway.session.robot import Robot
from aionode.interfaces.geometry_msgs.msg import Point32, Polygon
from aionode.interfaces.sensor_msgs.msg import Image, LaserScan
from aionode.interfaces.std_msgs.msg import ByteMultiArray, String
from aionode.message import snapshot
from aionode.node import Node
from aionode.testing import settle
from tests.support.rosbridge import RosbridgeClient, rosbridge_client

Make = Callable[..., Node]

OCTETS = np.arange(3 * SLICE_BYTES + 5, dtype=np.uint32).astype(np.uint8)
LARGE = [
    Image(height=1, encoding="rgb8", data=OCTETS),
    Image(encoding="rgb8", data=OCTETS.tobytes()),
    LaserScan(ranges=np.linspace(0.5, np.nan, 3 * SLICE_ITEMS + 1, dtype=np.float32)),
    Polygon(points=[Point32(x=0.5 * i) for i in range(2 * SLICE_ITEMS + 2)]),
    ByteMultiArray(data=[bytes([i % 256]) for i in range(2 * SLICE_ITEMS + 3)]),
]


async def turns_during(work: Awaitable[Any]) -> tuple[Any, int]:
    """Return the result of some work, and the number of loop iterations meanwhile."""
    turns = 0

    async def count() -> None:
        nonlocal turns
        while True:
            await checkpoint()
            turns += 1

    async with asyncio.TaskGroup() as tasks:
        counting = tasks.create_task(count())
        result = await work
        counting.cancel()
    return result, turns


@pytest.mark.parametrize("message", LARGE, ids=lambda message: type(message).__name__)
async def test_json_of_a_large_message_is_written_while_the_loop_turns(message: Any) -> None:
    """The result is the same as when written at once, even of what a decoder returns."""
    taken = snapshot(message)
    received = cdr.decode(type(message), cdr.encode(taken))

    written, turns = await turns_during(json_in_turns(taken))

    assert b"".join(written) == json_of(taken) == b"".join(await json_in_turns(received))
    assert turns >= 2


async def test_a_png_of_long_text_is_compressed_beside_the_loop() -> None:
    """This takes most of a second for an image."""
    text = json.dumps({"data": "xyz" * 100_000})

    made, turns = await turns_during(png_frame_in_turns(text))

    assert str(made) == png_frame(text)
    assert turns >= 1


def received_of(message: Any) -> Received:
    """Return a message like a feed."""
    return Received("/t", message.__ros_type__, type(message), cdr.encode(message), 0)


class Slow:
    """Encodes messages as slowly as a test wants, and records what is delivered."""

    def __init__(self, robot: Robot, depth: int = 10) -> None:
        self.go_on = asyncio.Event()
        self.delivered: list[str] = []
        self.failures: list[Exception] = []  # raised instead of deliveries, one each
        self.preparing = Preparing(robot, self.prepare, self.deliver, depth)

    async def prepare(self, _: Received) -> None:
        """Encode a message."""
        await self.go_on.wait()

    def deliver(self, received: Received) -> None:
        """Take a message that is encoded."""
        if self.failures:
            raise self.failures.pop()
        self.delivered.append(received.message.data[:1])

    def put(self, letter: str, size: int = LARGE_BYTES) -> None:
        """Let a message arrive."""
        self.preparing.put(received_of(String(data=letter * size)))


async def test_a_small_message_does_not_overtake_a_large_one(robot: Robot) -> None:
    """Clients get the messages of a topic in order."""
    slow = Slow(robot)
    slow.put("a", 10)
    slow.put("b")
    slow.put("c", 10)
    assert slow.delivered == ["a"]

    slow.go_on.set()
    await settle()

    assert slow.delivered == ["a", "b", "c"]


@pytest.mark.parametrize(("depth", "size"), [(2, LARGE_BYTES), (10, MAX_BYTES // 2 - 100)])
async def test_what_waits_to_be_encoded_is_bounded(robot: Robot, depth: int, size: int) -> None:
    """In number and in bytes; the newest are kept, and drops are counted."""
    slow = Slow(robot, depth)
    slow.put("a", size)
    await settle()  # it is being encoded now
    for letter in "bcde":
        slow.put(letter, size)
    slow.go_on.set()
    await settle()

    assert slow.delivered == ["a", "d", "e"]
    assert slow.preparing.dropped == 2


async def test_a_message_that_cannot_be_encoded_ends_nothing(robot: Robot) -> None:
    """The gateway, whose task encodes it, goes on, and so do the messages after it."""
    slow = Slow(robot)
    slow.go_on.set()
    slow.failures.append(RuntimeError("no memory"))
    slow.put("a")
    slow.put("b")
    await settle()

    assert slow.delivered == ["b"]
    assert slow.preparing.dropped == 1


@pytest.mark.parametrize("compression", ["none", "png"])
async def test_a_large_message_is_written_once_for_all_clients(
    robot: Robot, client: RosbridgeClient, node: Node, compression: str, monkeypatch: Any
) -> None:
    """Beside the loop, which keeps running, and in order with later messages."""
    written = []

    async def count(message: Any) -> list[bytes]:
        written.append(message)
        return await json_in_turns(message)

    monkeypatch.setattr("aionode.gateway.session.encoding.large_json.json_in_turns", count)
    publisher = node.create_publisher(Image, "/image", 10)
    async with rosbridge_client(robot) as other:
        for each in (client, other):
            each.send("subscribe", topic="/image", compression=compression)
        await settle()
        publisher.publish(Image(height=1, data=bytes(LARGE_BYTES + 1)))
        publisher.publish(Image(height=2))
        got = [[await each.receive() for _ in range(2)] for each in (client, other)]

    assert len(written) == 1
    for ops in got:
        if compression == "none":
            assert [op["msg"]["height"] for op in ops] == [1, 2]
        assert {op["op"] for op in ops} == {"png" if compression == "png" else "publish"}


async def test_what_waits_for_a_client_is_dropped_when_it_leaves(robot: Robot, node: Node) -> None:
    """Nothing is encoded that nobody receives."""
    publisher = node.create_publisher(Image, "/image", 10)
    async with rosbridge_client(robot) as client:
        client.send("subscribe", topic="/image")
        await settle()
        async with robot.turn:
            publisher.publish(Image(data=bytes(LARGE_BYTES + 1)))
            await settle()
            client.leave()
            await settle()
        await settle()

        assert client.session.outbox.sent == 0
