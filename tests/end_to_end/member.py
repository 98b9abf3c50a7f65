"""A participant for tests: publishes its name fifty times a second, and prints what it receives.

``python tests/end_to_end/member.py NAME``. It prints ``started``, ``open``, ``heard NAME``,
``gone NAME`` when a node leaves the graph, ``sum N`` or ``error TYPE: TEXT`` for a call, and
``stopped``. A line ``call N`` on stdin calls /add_NAME of the member N.
"""

from __future__ import annotations

import asyncio
import sys

import aionode
from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


class Member(Node):
    """One of a group."""

    def __init__(self, name: str) -> None:
        super().__init__(name, enable_rosout=False, start_parameter_services=False)
        self.heard: set[str] = set()
        self.publisher = self.create_publisher(String, "/hello", 10)
        self.create_subscription(String, "/hello", self.hear, 100)
        self.create_service(AddTwoInts, f"/add_{name}", self.add)
        self.create_timer(0.02, lambda: self.publisher.publish(String(data=name)))

    def hear(self, msg: String) -> None:
        """Print each new name."""
        if msg.data not in self.heard:
            self.heard.add(msg.data)
            tell("heard", msg.data)

    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Answer, or never if the sum is negative."""
        if request.a + request.b < 0:
            tell("asked")
            await asyncio.Event().wait()
        return AddTwoInts.Response(sum=request.a + request.b)

    async def call(self, name: str, number: int) -> None:
        """Call another member."""
        client = self.create_client(AddTwoInts, f"/add_{name}")
        await client.wait_for_service()
        try:
            tell("sum", (await client.call(AddTwoInts.Request(a=number))).sum)
        except aionode.errors.AionodeError as error:
            tell("error", f"{type(error).__name__}:", error)

    async def obey(self) -> None:
        """Execute the lines of stdin."""
        lines: asyncio.Queue[str] = asyncio.Queue()
        loop = asyncio.get_running_loop()
        loop.add_reader(sys.stdin, lambda: lines.put_nowait(sys.stdin.readline()))
        async with asyncio.TaskGroup() as tasks:
            while words := (await lines.get()).split():
                tasks.create_task(self.call(words[1], int(words[2])))
            loop.remove_reader(sys.stdin)

    async def watch(self) -> None:
        """Print which nodes leave the graph."""
        before: set[str] = set()
        while True:
            now = {node.name for node in self.graph.nodes()}
            for name in before - now:
                tell("gone", name)
            before = now
            await self.graph.changed()


async def main() -> None:
    """Run one member, until a signal comes."""
    member = Member(sys.argv[1])
    tell("started")
    async with member:
        tell("open")
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(member.obey())
            tasks.create_task(member.watch())


if __name__ == "__main__":
    aionode.run(main)
    tell("stopped")
