"""What the gateway costs compared with a bare broadcast of the same bytes by `websockets`.

``python benchmarks/gateway.py`` prints, for each kind of frame, the processor time of sending one
message to all clients, and the number of messages that one core can send per second. The clients
run in a separate process; the last column shows what they were too slow for.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import logging
import sys
import time
from asyncio.subprocess import PIPE
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from statistics import median
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

READER = Path(__file__).parent / "gateway_parts" / "reader.py"


class Case(NamedTuple):
    """A kind of message to send.

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
    """The cost of a message.

    Attributes:
        seconds: Processor time of the server for one message to all clients.
        missing: Which part of the messages the clients did not get.
    """

    seconds: float
    missing: float


SCAN = LaserScan(ranges=np.linspace(0.5, 9.5, 360, dtype=np.float32))
CASES = [
    Case("cbor-raw, text of 100 bytes", String(data="x" * 100), "cbor-raw", 500, 500),
    Case("cbor-raw, scan of 360 ranges", SCAN, "cbor-raw", 500, 500),
    Case("cbor-raw, image of 6 MB", Image(data=bytes(6_000_000)), "cbor-raw", 10, 10),
    Case("JSON, text of 100 bytes", String(data="x" * 100), "none", 500, 500),
    Case("JSON, scan of 360 ranges", SCAN, "none", 200, 200),
]


async def measure(port: int, clients: int, case: Case, send: Callable[[], Awaitable[None]]) -> Cost:
    """Return the cost of the messages in this process."""
    options = {
        "port": port, "clients": clients, "count": case.number, "wait_sec": 3.0,
        "subscribe": subscription(case),
    }  # fmt: skip
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-S", READER, json.dumps(options), stdin=PIPE, stdout=PIPE
    )
    assert process.stdout is not None  # noqa: S101  # a pipe
    await process.stdout.readline()
    await asyncio.sleep(0.5)  # the subscriptions of the last ones
    began, at = time.process_time(), time.monotonic()
    for number in range(case.number):
        await send()
        due = at + (number + 1) / case.rate_hz
        await asyncio.sleep(max(due - time.monotonic(), 0))  # measured in real time
    missing = sum(each for (each,) in json.loads(await process.stdout.readline()))
    taken = time.process_time() - began
    await process.communicate(b"")
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


def subscription(case: Case) -> dict[str, Any]:
    """Return the subscribe op."""
    return {
        "op": "subscribe", "topic": TOPIC, "compression": case.compression, "queue_length": 100,
    }  # fmt: skip


async def frame_of(case: Case) -> bytes | str:
    """Return the frame that the gateway sends."""
    async with (
        gateway(case) as (found, publisher),
        connect(
            f"ws://127.0.0.1:{found.port}", proxy=None, max_size=None, compression=None
        ) as socket,
    ):
        await socket.send(json.dumps(subscription(case)))
        while True:
            publisher.publish(case.message)
            try:
                return await asyncio.wait_for(socket.recv(), 0.2)
            except TimeoutError:
                continue


async def measure_gateway(case: Case, clients: int) -> Cost:
    """Return the cost of a message in the gateway."""
    async with gateway(case) as (found, publisher):

        async def send() -> None:
            publisher.publish(case.message)

        return await measure(found.port, clients, case, send)


async def measure_bare(case: Case, clients: int, frame: bytes | str) -> Cost:
    """Return the cost of a message in a broadcast."""
    connected: set[ServerConnection] = set()

    async def handle(socket: ServerConnection) -> None:
        connected.add(socket)
        await socket.wait_closed()

    async with serve(handle, "127.0.0.1", 0, compression=None) as server:

        async def send() -> None:
            broadcast(connected, frame)

        port = next(iter(server.sockets)).getsockname()[1]
        return await measure(port, clients, case, send)


async def main(clients: int, repeats: int, only: str) -> None:
    """Measure both in turns; print their medians, and those of the ratios of neighbouring turns."""
    print(f"{clients} clients; processor time of the server for one message to all of them")
    print(
        f"{'frame':30} {'bare':>10} {'gateway':>10} {'ratio':>6} {'messages/s of a core':>21} lost"
    )
    for case in (each for each in CASES if only in each.name):
        frame = await frame_of(case)
        bare, ours = [], []
        for _ in range(repeats):
            bare.append(await measure_bare(case, clients, frame))
            ours.append(await measure_gateway(case, clients))
        least, most = (median(each.seconds for each in costs) for costs in (bare, ours))
        ratio = median(b.seconds / a.seconds for a, b in zip(bare, ours, strict=True))
        missing = max(each.missing for each in (*bare, *ours))
        print(
            f"{case.name:30} {least * 1e6:7.0f} µs {most * 1e6:7.0f} µs {ratio:5.2f}x "
            f"{1 / most:10.0f} of {1 / least:<7.0f} {missing:7.1%}",
            flush=True,
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=5)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--only", default="", help="a part of the names of cases")
    given = parser.parse_args()
    logging.disable(logging.WARNING)  # this machine may be busy
    asyncio.run(main(given.clients, given.repeats, given.only))
