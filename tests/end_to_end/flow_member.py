"""A participant that sends, reads or serves as fast as it can, and watches its loop.

``python tests/end_to_end/flow_member.py ROLE NAME [COUNT [SIZE]]``. Lines on stdout are ``open``,
``matched``, ``sent N``, ``heard N`` or ``wrong TEXT``, and ``answered N``. A line ``gap`` on stdin
is answered with ``gap MILLISECONDS``, the longest time that the loop stood still since the last
question, and ``count`` with ``count N``; ``pause SECONDS`` stops a reader for that time.
"""

from __future__ import annotations

import asyncio
import sys
import time  # noqa: TID251  # how long the loop stands still is what is tested
from typing import Any

import aionode
from aionode import Node
from aionode._process.concurrency import checkpoint
from aionode.clock import thread_waited_ns
from aionode.errors import AionodeError, QueueFullError
from aionode.interfaces.rcl_interfaces.msg import ParameterValue
from aionode.interfaces.rcl_interfaces.srv import GetParameters
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import HistoryPolicy, QoSProfile

TICK_S = 0.002

asyncio_sleep = asyncio.sleep  # noqa: TID251  # the loop is watched by the machine's own time


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


class Member(Node):
    """A participant that plays its role."""

    def __init__(self, role: str, name: str, count: int, size: int) -> None:
        super().__init__(f"{role}_{name}", enable_rosout=False, start_parameter_services=False)
        self.role = role
        self.topic = name
        self.count = count
        self.text = "x" * size
        self.seen = 0
        self.gap_s = 0.0
        self.pause_s = 0.0
        self.endpoint: Any = getattr(self, f"make_{role}")()

    def profile(self, *, keep_all: bool) -> QoSProfile:
        """Return the profile of a publisher or subscription."""
        if keep_all:
            return QoSProfile(history=HistoryPolicy.KEEP_ALL)
        return QoSProfile(depth=self.count or 10)

    def make_keeper(self) -> Any:
        """A KEEP_ALL publisher, and another one to the same process."""
        self.side = self.create_publisher(String, "side", 10)
        return self.create_publisher(String, self.topic, self.profile(keep_all=True))

    def make_sender(self) -> Any:
        """A KEEP_LAST publisher that can keep everything."""
        return self.create_publisher(String, self.topic, self.profile(keep_all=False))

    make_ticker = make_sender
    make_quitter = make_keeper

    def make_reader(self) -> Any:
        """A KEEP_ALL subscription, and one to the other publisher."""
        self.create_subscription(String, "side", lambda _: None, 10)
        return self.create_subscription(String, self.topic, None, self.profile(keep_all=True))

    def make_lister(self) -> Any:
        """A KEEP_LAST subscription that can keep everything."""
        return self.create_subscription(String, self.topic, None, self.profile(keep_all=False))

    def make_server(self) -> Any:
        """A server."""
        return self.create_service(GetParameters, self.topic, self.get)

    def make_client(self) -> Any:
        """A client that calls continuously, many at once."""
        return self.create_client(GetParameters, self.topic)

    make_caller = make_client

    def get(self, request: GetParameters.Request) -> GetParameters.Response:
        """Answer with the requested size."""
        self.seen += 1
        return GetParameters.Response(values=[ParameterValue(string_value=request.names[0])])

    def request(self) -> GetParameters.Request:
        """Return a request."""
        return GetParameters.Request(names=[self.text])

    def message(self, number: int) -> String:
        """Return the next message."""
        return String(data=f"{number} {self.text}")

    # What each does

    async def work_keeper(self) -> None:
        """Send everything, and wait when there is no room."""
        await self.endpoint.wait_for_subscribers()
        tell("matched")
        for number in range(self.count):
            try:
                self.endpoint.publish(self.message(number))
            except QueueFullError:
                await self.endpoint.drain()
                self.endpoint.publish(self.message(number))
            self.seen += 1
            await checkpoint()
        await self.endpoint.drain()
        tell("sent", self.count, self.endpoint.stats.dropped)

    async def work_quitter(self) -> None:
        """Send everything at once and end."""
        await self.endpoint.wait_for_subscribers()
        for number in range(self.count):
            self.endpoint.publish(self.message(number))
        self.destroy_node()

    async def work_sender(self) -> None:
        """Send everything at once."""
        await self.endpoint.wait_for_subscribers()
        tell("matched")
        for number in range(self.count):
            self.endpoint.publish(self.message(number))
        tell("sent", self.count, self.endpoint.stats.dropped)

    async def work_ticker(self) -> None:
        """Send continuously, two hundred messages a second."""
        while True:
            self.endpoint.publish(self.message(self.seen))
            self.seen += 1
            await asyncio_sleep(0.005)

    async def work_reader(self) -> None:
        """Read everything, and check the order."""
        async for msg in self.endpoint:
            number = int(msg.data.split(" ", 1)[0])
            if number != self.seen:
                tell("wrong", number, "instead of", self.seen)
            self.seen = number + 1
            if self.seen == self.count:
                tell("heard", self.seen)
            if self.pause_s:
                pause_s, self.pause_s = self.pause_s, 0.0
                await asyncio_sleep(pause_s)

    async def work_lister(self) -> None:
        """Count what arrives."""
        async for _ in self.endpoint:
            self.seen += 1
            if self.seen == self.count:
                tell("heard", self.seen)

    async def work_server(self) -> None:
        """Answer by the callback."""

    async def work_client(self) -> None:
        """Keep some hundreds of calls pending, each for a second at most."""
        await self.endpoint.wait_for_service()
        tell("matched")

        async def call_on() -> None:
            while True:
                try:
                    await self.endpoint.call(self.request(), timeout_sec=1.0)
                    self.seen += 1
                except AionodeError:
                    pass

        async with asyncio.TaskGroup() as tasks:
            for _ in range(self.count):
                tasks.create_task(call_on())

    async def work_caller(self) -> None:
        """Call many times at once, and print how each ended."""
        await self.endpoint.wait_for_service()
        tell("matched")
        ends = await asyncio.gather(
            *(self.endpoint.call(self.request()) for _ in range(self.count)),
            return_exceptions=True,
        )
        kinds = [type(end).__name__ for end in ends]
        for kind in sorted(set(kinds)):
            tell("ended", kind, kinds.count(kind))
        tell("answered", len(kinds))

    # What is asked of all

    async def watch(self) -> None:
        """Measure how long the loop stands still; not while its thread waits for a processor."""
        before_s, before_ns = time.perf_counter(), thread_waited_ns() or 0
        while True:
            await asyncio_sleep(TICK_S)
            now_s, now_ns = time.perf_counter(), thread_waited_ns() or 0
            waited_s = (now_ns - before_ns) / 1e9
            self.gap_s = max(self.gap_s, now_s - before_s - waited_s - TICK_S)
            before_s, before_ns = now_s, now_ns
            if self.role == "keeper":
                self.side.publish(self.message(0))

    def obey(self, line: str) -> None:
        """Do what a line of stdin says."""
        word, _, rest = line.strip().partition(" ")
        if word == "gap":
            tell("gap", round(self.gap_s * 1000, 1))
            self.gap_s = 0.0
        elif word == "count":
            tell("count", self.seen)
        elif word == "pause":
            self.pause_s = float(rest)


async def main() -> None:
    """Run one member, until a signal comes."""
    role, name, *numbers = sys.argv[1:]
    count, size = (*(int(number) for number in numbers), 10, 10)[:2]
    member = Member(role, name, count, size)
    async with member:
        tell("open")
        loop = asyncio.get_running_loop()
        loop.add_reader(sys.stdin, lambda: member.obey(sys.stdin.readline()))
        async with asyncio.TaskGroup() as tasks:
            watching = tasks.create_task(member.watch())
            work = tasks.create_task(getattr(member, f"work_{role}")())
            if role == "quitter":
                await work
                watching.cancel()
        loop.remove_reader(sys.stdin)


if __name__ == "__main__":
    aionode.run(main)
    tell("stopped")
