"""What the gateway costs beside a bare broadcast of the same bytes by `websockets`.

``python benchmarks/gateway.py`` prints, for each kind of frame, the processor time of one message
to all clients, and the messages that one core can send a second. The clients are in a process of
their own; what they were too slow for is in the last column.
"""

from __future__ import annotations

import argparse
import asyncio
import base64
import json
import sys
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any, NamedTuple

import numpy as np
from websockets.asyncio.client import connect
from websockets.asyncio.server import ServerConnection, broadcast, serve

from aionode.gateway import Gateway, Policy
from aionode.interfaces.sensor_msgs.msg import Image, LaserScan
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import local_context

TOPIC = "/measured"

CLIENTS = """
import asyncio, base64, sys
missing = []
from websockets.asyncio.client import connect

async def client(url, first, count, ready):
    async with connect(url, proxy=None, max_size=None, compression=None) as socket:
        await socket.send(first)
        ready()
        waiting = count
        try:
            while waiting:
                async with asyncio.timeout(3):
                    await socket.recv()
                waiting -= 1
        except TimeoutError:
            pass
        missing.append(waiting)

async def main(url, first, clients, count):
    left = clients
    def ready():
        nonlocal left
        left -= 1
        if not left:
            print("ready", flush=True)
    await asyncio.gather(*(client(url, first, count, ready) for _ in range(clients)))
    print(sum(missing), flush=True)

url, first, clients, count = sys.argv[1:]
asyncio.run(main(url, base64.b64decode(first).decode(), int(clients), int(count)))
"""


class Case(NamedTuple):
    """What is sent.

    Attributes:
        name: For the table.
        message: The message.
        compression: Rosbridge's word for the kind of frame.
        rate_hz: How often it is published.
        number: How many are.
    """

    name: str
    message: Any
    compression: str
    rate_hz: float
    number: int


class Cost(NamedTuple):
    """What a message costs.

    Attributes:
        seconds: Processor time of the server for one message to all clients.
        missing: Which part of the messages the clients did not get.
    """

    seconds: float
    missing: float


SCAN = LaserScan(ranges=np.linspace(0.5, 9.5, 360, dtype=np.float32))
CASES = [
    Case("cbor-raw, text of 100 bytes", String(data="x" * 100), "cbor-raw", 500, 2500),
    Case("cbor-raw, scan of 360 ranges", SCAN, "cbor-raw", 500, 2500),
    Case("cbor-raw, image of 6 MB", Image(data=bytes(6_000_000)), "cbor-raw", 10, 50),
    Case("JSON, text of 100 bytes", String(data="x" * 100), "none", 500, 2500),
    Case("JSON, scan of 360 ranges", SCAN, "none", 200, 1000),
]


async def measure(
    url: str, first: str, clients: int, case: Case, send: Callable[[], Awaitable[None]]
) -> Cost:
    """Return what the messages cost this process."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", CLIENTS, url, base64.b64encode(first.encode()).decode(),
        str(clients), str(case.number), stdout=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout is not None  # noqa: S101  # a pipe
    await process.stdout.readline()
    await asyncio.sleep(0.5)  # the subscriptions of the last ones
    began, at = time.process_time(), time.monotonic()
    for number in range(case.number):
        await send()
        due = at + (number + 1) / case.rate_hz
        await asyncio.sleep(max(due - time.monotonic(), 0))  # measured in real time
    missing = int(await process.stdout.readline())
    taken = time.process_time() - began
    await process.wait()
    return Cost(taken / case.number, missing / case.number / clients)


@asynccontextmanager
async def gateway(case: Case) -> AsyncIterator[tuple[Gateway, Any]]:
    """Yield a gateway, and a publisher of the message."""
    async with (
        local_context() as context,
        Node("gateway", context=context) as node,
        Gateway(node, Policy.default(), port=0) as found,
    ):
        yield found, node.create_publisher(type(case.message), TOPIC, 100)


def subscription(case: Case) -> str:
    """Return the op that subscribes."""
    return json.dumps(
        {"op": "subscribe", "topic": TOPIC, "compression": case.compression, "queue_length": 100}
    )


async def frame_of(case: Case) -> bytes | str:
    """Return the frame that the gateway sends."""
    async with (
        gateway(case) as (found, publisher),
        connect(
            f"ws://127.0.0.1:{found.port}", proxy=None, max_size=None, compression=None
        ) as socket,
    ):
        await socket.send(subscription(case))
        while True:
            publisher.publish(case.message)
            try:
                return await asyncio.wait_for(socket.recv(), 0.2)
            except TimeoutError:
                continue


async def measure_gateway(case: Case, clients: int) -> Cost:
    """Return what a message costs the gateway."""
    async with gateway(case) as (found, publisher):

        async def send() -> None:
            publisher.publish(case.message)

        url = f"ws://127.0.0.1:{found.port}"
        return await measure(url, subscription(case), clients, case, send)


async def measure_bare(case: Case, clients: int, frame: bytes | str) -> Cost:
    """Return what a message costs a broadcast."""
    connected: set[ServerConnection] = set()

    async def handle(socket: ServerConnection) -> None:
        connected.add(socket)
        await socket.wait_closed()

    async with serve(handle, "127.0.0.1", 0, compression=None) as server:

        async def send() -> None:
            broadcast(connected, frame)

        port = next(iter(server.sockets)).getsockname()[1]
        return await measure(f"ws://127.0.0.1:{port}", "subscribe", clients, case, send)


async def main(clients: int, repeats: int) -> None:
    """Measure both in turns, and print the best of each."""
    print(f"{clients} clients; processor time of the server for one message to all of them")
    print(
        f"{'frame':30} {'bare':>10} {'gateway':>10} {'ratio':>6} {'messages/s of a core':>21} lost"
    )
    for case in CASES:
        frame = await frame_of(case)
        bare, ours = [], []
        for _ in range(repeats):
            bare.append(await measure_bare(case, clients, frame))
            ours.append(await measure_gateway(case, clients))
        least, most = min(bare).seconds, min(ours).seconds
        missing = max(each.missing for each in (*bare, *ours))
        print(
            f"{case.name:30} {least * 1e6:7.0f} µs {most * 1e6:7.0f} µs {most / least:5.2f}x "
            f"{1 / most:10.0f} of {1 / least:<7.0f} {missing:7.1%}",
            flush=True,
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=5)
    parser.add_argument("--repeats", type=int, default=2)
    given = parser.parse_args()
    asyncio.run(main(given.clients, given.repeats))
