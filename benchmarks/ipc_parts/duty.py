"""A publisher of 100 Hz and its reader, each alone in a process."""

from __future__ import annotations

import asyncio
import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import AsyncExitStack, contextmanager
from typing import Any

from aionode import Node
from aionode.interfaces.std_msgs.msg import String
from benchmarks.ipc_parts.common import (
    OVER_LINK,
    OVER_ZENOH,
    PERIOD_S,
    SIZE,
    SOCKET,
    TEXT,
    Child,
    Plan,
    Run,
    child,
    is_linked,
    lines,
)


async def duty(part: str, kind: str, place: Run) -> None:
    """Publish 100 times a second, or read that, for as long as each line of stdin says."""
    count = 0

    def take(_: object = None) -> None:
        nonlocal count
        count += 1

    async with AsyncExitStack() as stack:
        if kind == SOCKET:
            beat = await socket_duty(part, place, take, stack)
        else:
            beat = await node_duty(part, kind, place, take, stack)

        async def work(line: str) -> dict[str, float]:
            nonlocal count
            count = 0
            with beat():
                began, before = time.perf_counter(), time.process_time()
                await asyncio.sleep(float(line))
                used, took = time.process_time() - before, time.perf_counter() - began
            return {"percent": 100 * used / took, "count": count}

        await lines(work)


Beat = Callable[[], Any]  # a context in which messages are sent 100 times a second


@contextmanager
def silence() -> Iterator[None]:
    """Send nothing: this side reads."""
    yield


async def socket_duty(
    part: str, place: Run, take: Callable[..., None], stack: AsyncExitStack
) -> Beat:
    """Return the lower bound: a timer of the loop, and a bare Unix socket."""
    loop = asyncio.get_running_loop()

    class Reader(asyncio.Protocol):
        def data_received(self, data: bytes) -> None:  # noqa: ARG002  # its time counts
            take()

    if part == "reader":
        server = await loop.create_unix_server(Reader, f"{place.folder}/duty")
        stack.callback(server.close)
        return silence
    transport, _ = await loop.create_unix_connection(asyncio.Protocol, f"{place.folder}/duty")
    timer: asyncio.TimerHandle

    def fire(due_s: float) -> None:
        nonlocal timer
        take()
        transport.write(bytes(SIZE))
        timer = loop.call_at(due_s + PERIOD_S, fire, due_s + PERIOD_S)

    @contextmanager
    def beat() -> Iterator[None]:
        nonlocal timer
        due_s = loop.time() + PERIOD_S
        timer = loop.call_at(due_s, fire, due_s)
        yield
        timer.cancel()

    return beat


async def node_duty(
    part: str, kind: str, place: Run, take: Callable[..., None], stack: AsyncExitStack
) -> Beat:
    """Return the cost of a node with everything that users' nodes have."""
    link = kind == OVER_LINK
    context = await stack.enter_async_context(place.context(3 if link else 2, link=link))
    node = await stack.enter_async_context(Node(part, context=context))
    if part == "reader":
        node.create_subscription(String, "beat", take, 10)
        return silence
    publisher = node.create_publisher(String, "beat", 10)
    await publisher.wait_for_subscribers()
    while link and not is_linked(publisher):  # noqa: ASYNC110  # nothing tells
        await asyncio.sleep(PERIOD_S)

    def fire() -> None:
        take()
        publisher.publish(String(data=TEXT))

    @contextmanager
    def beat() -> Iterator[None]:
        timer = node.create_timer(PERIOD_S, fire)
        yield
        timer.destroy()

    return beat


async def duties(place: Run, plan: Plan) -> list[dict[str, Any]]:
    """Return the share of a core that publishers and readers take, in turns."""
    found: dict[str, list[tuple[Any, Any]]] = {}
    async with AsyncExitStack() as stack:

        async def pair_of(kind: str) -> tuple[Child, Child]:
            reader = await stack.enter_async_context(child("reader", place, kind))
            return await stack.enter_async_context(child("publisher", place, kind)), reader

        kinds = (SOCKET, OVER_ZENOH, OVER_LINK)
        pairs = dict(zip(kinds, await asyncio.gather(*map(pair_of, kinds)), strict=True))
        for _ in range(plan.duty_rounds):
            for kind, pair in pairs.items():
                one, other = await asyncio.gather(*(side.ask(str(plan.duty_s)) for side in pair))
                found.setdefault(kind, []).append((one, other))
    return [
        {
            "loop": place.loop,
            "what": kind,
            "publisher_percent": round(statistics.median(o["percent"] for o, _ in both), 2),
            "reader_percent": round(statistics.median(o["percent"] for _, o in both), 2),
            "sent": sum(one["count"] for one, _ in both),
            "received": sum(other["count"] for _, other in both),
        }
        for kind, both in found.items()
    ]
