"""Everything at once for a long time: nothing may grow, nothing may be lost uncounted.

A fast publisher floods a slow reader, services are called, time out and are cancelled, nodes come
and go, and a timer of 10 ms ticks through all of it. After a warm-up the memory of the process is
noted; the program fails if it has grown at the end, or if what was sent is not what was received,
dropped and left.

Run it with ``make soak``, or ``python benchmarks/soak.py --seconds 600``.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import gc
import sys
import time
from pathlib import Path
from typing import Final

from aionode import Context, Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String

ALLOWED_GROWTH_KB: Final = 4_000
WARM_UP_SHARE: Final = 0.25
TICK_SEC: Final = 0.01
PAGE_KB: Final = 4


def resident_kb() -> int:
    """Return the memory of this process in kB; 0 where the system does not tell."""
    gc.collect()
    try:
        return int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]) * PAGE_KB
    except OSError:
        return 0


class Soak:
    """What is done, and what is counted."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.node = Node("soak", context=context)
        self.publisher = self.node.create_publisher(String, "/flood", 10)
        self.subscription = self.node.create_subscription(String, "/flood", self.read, 10)
        self.node.create_service(AddTwoInts, "/add", self.add, concurrent=True)
        self.client = self.node.create_client(AddTwoInts, "/add")
        self.node.create_timer(TICK_SEC, self.tick)
        self.ticks = self.sent = self.calls = self.timeouts = self.cancelled = self.nodes = 0

    def read(self, _msg: String) -> None:
        """Take longer than messages take to come."""
        time.sleep(0.0005)

    def tick(self) -> None:
        """Count a tick of the timer."""
        self.ticks += 1

    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Answer at once, or too late where a is negative."""
        if request.a < 0:
            await asyncio.sleep(0.05)
        return AddTwoInts.Response(sum=request.a + request.b)

    async def flood(self) -> None:
        """Publish without end."""
        while True:
            for _ in range(20):
                self.publisher.publish(String(data=f"message {self.sent}"))
                self.sent += 1
            await asyncio.sleep(0.002)

    async def call(self) -> None:
        """Call without end: with an answer, with a time limit that passes, and cancelled."""
        while True:
            await self.client.call(AddTwoInts.Request(a=self.calls, b=1))
            self.calls += 1
            with contextlib.suppress(TimeoutError):
                await self.client.call(AddTwoInts.Request(a=-1), timeout_sec=0.01)
            self.timeouts += 1
            cancelled = asyncio.get_running_loop().create_task(
                self.client.call(AddTwoInts.Request(a=-1))
            )
            await asyncio.sleep(0.001)
            cancelled.cancel()
            await asyncio.wait([cancelled])
            self.cancelled += 1

    async def come_and_go(self) -> None:
        """Make nodes with entities, and end them, without end."""
        while True:
            async with Node("guest", context=self.context) as guest:
                guest.create_subscription(String, "/flood", lambda _msg: None, 5)
                guest.create_timer(TICK_SEC, lambda: None)
                await asyncio.sleep(0.05)
            self.nodes += 1

    def lost(self) -> int:
        """Return how many messages are neither received, dropped nor in the queue."""
        stats = self.subscription.stats
        left = self.sent - stats.received - stats.dropped
        return left if left < 0 else max(0, left - self.subscription.qos_profile.depth)


async def soak(seconds: float) -> list[str]:
    """Do all of it for some time, and return what was wrong."""
    async with Context(transport="local") as context:
        work = Soak(context)
        async with work.node, asyncio.TaskGroup() as tasks:
            running = [
                tasks.create_task(each) for each in (work.flood(), work.call(), work.come_and_go())
            ]
            await asyncio.sleep(seconds * WARM_UP_SHARE)
            before_kb = resident_kb()
            await asyncio.sleep(seconds * (1 - WARM_UP_SHARE))
            grown_kb = resident_kb() - before_kb
            lost = work.lost()
            for task in running:
                task.cancel()
    print(
        f"{seconds:g} s: {work.sent} sent, {work.subscription.stats.dropped} dropped, "
        f"{work.calls} calls, {work.timeouts} timed out, {work.cancelled} cancelled, "
        f"{work.nodes} nodes came and went, {work.ticks} of {seconds / TICK_SEC:.0f} ticks; "
        f"memory {before_kb} kB, {grown_kb:+} kB since the warm-up"
    )
    problems = []
    if grown_kb > ALLOWED_GROWTH_KB:
        problems.append(f"memory grew by {grown_kb} kB; {ALLOWED_GROWTH_KB} kB is the limit")
    if lost:
        problems.append(f"{lost} messages were neither received, dropped nor left")
    return problems


def main() -> None:
    """Soak, and exit with status 1 if anything was wrong."""
    parser = argparse.ArgumentParser(description="Everything at once for a long time.")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long (default 10)")
    problems = asyncio.run(soak(parser.parse_args().seconds))
    sys.exit("\n".join(problems) or 0)


if __name__ == "__main__":
    main()
