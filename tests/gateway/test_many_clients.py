"""Many clients of a gateway at once, in a process of their own, and one that reads nothing."""

from __future__ import annotations

import asyncio
import json
import sys
from asyncio.subprocess import PIPE

import pytest

from aionode.gateway import Gateway
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from aionode.testing import local_context

pytestmark = [pytest.mark.stress, pytest.mark.timeout(120)]

CLIENTS = """
import asyncio, json, sys
from websockets.asyncio.client import connect

async def client(url, last):
    async with connect(url, proxy=None, compression=None) as socket:
        await socket.send(SUBSCRIPTION)
        got = []
        while not got or got[-1] != last:
            got.append(json.loads(await socket.recv())["msg"]["data"])
            if len(got) == 1:
                print("first", flush=True)
        return got

async def main(url, number, last):
    async with connect(url, proxy=None, compression=None) as idle:
        await idle.send(SUBSCRIPTION)
        idle.transport.pause_reading()
        every = await asyncio.gather(*(client(url, last) for _ in range(number)))
        print(json.dumps([[min(got), len(got), len(set(got))] for got in every]))

SUBSCRIPTION = json.dumps({"op": "subscribe", "topic": "/count", "queue_length": 1000})
asyncio.run(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
"""

NUMBER = 49
HZ = 100.0
COUNT = 300


async def test_49_clients_get_every_message_beside_one_that_reads_nothing() -> None:
    """As a local reader does: a slow client slows nobody."""
    async with (
        local_context() as context,
        Node("robot", context=context) as robot,
        Node("gateway", context=context) as node,
        Gateway(node, port=0) as gateway,
    ):
        publisher = robot.create_publisher(Int32, "/count", 100)
        url = f"ws://127.0.0.1:{gateway.port}"
        child = await asyncio.create_subprocess_exec(
            sys.executable, "-c", CLIENTS, url, str(NUMBER), str(COUNT), stdout=PIPE
        )
        assert child.stdout is not None
        began = 0
        while began < NUMBER:  # what comes before all have subscribed is the number 0
            publisher.publish(Int32())
            try:
                async with asyncio.timeout(0.05):
                    began += await child.stdout.readline() == b"first\n"
            except TimeoutError:
                pass
        rate = robot.create_rate(HZ)
        for number in range(1, COUNT + 1):
            await rate.sleep()
            publisher.publish(Int32(data=number))
        got = json.loads(await child.stdout.readline())
        await child.wait()

    assert len(got) == NUMBER
    assert {tuple(each)[2] for each in got} == {COUNT + 1}
