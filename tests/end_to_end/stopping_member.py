"""A robot that tests stop: each of its callbacks drives, and stops driving in `finally`.

``python tests/end_to_end/stopping_member.py robot END`` publishes 1.0 on /timer, /thread and /goal
from a coroutine, a callback in a thread and a goal, and 0.0 when these end; it tells ``driving``
and ``stopped``. With END ``signal`` it ends with a signal, with ``destroy`` it destroys its node
when a line comes, with ``leave`` it leaves the node's block then.
``… holder END`` publishes 1.0 on /timer with a lease of a minute, whose stop is 0.0, and tells
``driving`` as soon as the reader hears it over the route that it keeps. Then, with END ``sleep``
and ``loop``, it blocks its event loop, and with ``shield`` it refuses to be cancelled; with
``exit`` it leaves the interpreter when a line comes.
With ``run`` or ``asyncio`` after that, `aionode.run` or `asyncio.run` runs it.
``… commander END`` publishes 1.0 on /timer until a line comes or it is stopped; then it publishes
ten more messages at once, the last of which is 0.0, and does not end: with END ``sleep`` and
``loop`` it blocks its event loop, with ``await`` only its own end.
``… reader`` tells ``TOPIC VALUE`` at each change of what it hears.
"""

from __future__ import annotations

import asyncio
import sys
import threading
from typing import Any

import aionode
from aionode import CancelResponse, Node
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import Float64

TOPICS = ("/timer", "/thread", "/goal")
STEP_SEC = 0.02


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


class Robot(Node):
    """Drives in three ways."""

    def __init__(self) -> None:
        super().__init__("robot", enable_rosout=False, start_parameter_services=False)
        self.speeds = {topic: self.create_publisher(Float64, topic, 10) for topic in TOPICS}
        self.create_timer(0.0, self.drive)
        self.create_timer(0.0, self.drive_in_thread, offload=True)
        self.create_action_server(
            Fibonacci, "/go", self.go, cancel_callback=lambda _goal: CancelResponse.ACCEPT
        )

    async def follow(self, topic: str) -> None:
        """Drive until cancelled, and then stop slowly."""
        publisher = self.speeds[topic]
        try:
            while True:
                publisher.publish(Float64(data=1.0))
                await self.get_clock().sleep(STEP_SEC)
        finally:
            await self.get_clock().sleep(STEP_SEC)
            publisher.publish(Float64(data=0.0))

    async def drive(self) -> None:
        """Drive in a coroutine."""
        await self.follow("/timer")

    def drive_in_thread(self) -> None:
        """Drive in a thread, which has to check for the end itself."""
        publisher = self.speeds["/thread"]
        pause = threading.Event()
        try:
            while not self.destroyed:
                publisher.publish(Float64(data=1.0))
                pause.wait(STEP_SEC)
        finally:
            publisher.publish(Float64(data=0.0))

    async def go(self, _goal: Any) -> Fibonacci.Result:
        """Drive as a goal."""
        await self.follow("/goal")
        return Fibonacci.Result()


def block(how: str) -> None:
    """Block the event loop, after the word ``blocked``."""
    tell("blocked")
    if how == "sleep":
        threading.Event().wait()
    while True:
        pass


class Commander(Node):
    """Drives until told to stop, and then hangs."""

    def __init__(self, end: str) -> None:
        super().__init__("robot", enable_rosout=False, start_parameter_services=False)
        self.speed = self.create_publisher(Float64, "/timer", 20)
        self.how = end
        self.line = asyncio.Event()
        asyncio.get_running_loop().add_reader(sys.stdin, self.on_line)
        self.create_timer(0.0, self.drive)

    def on_line(self) -> None:
        """End the drive."""
        asyncio.get_running_loop().remove_reader(sys.stdin)
        self.line.set()

    async def drive(self) -> None:
        """Drive until a line on stdin, or until cancelled."""
        try:
            while not self.line.is_set():
                self.speed.publish(Float64(data=1.0))
                await self.get_clock().sleep(STEP_SEC)
        finally:
            for value in range(9, -1, -1):
                self.speed.publish(Float64(data=value / 10))
            if self.how != "await":
                block(self.how)
            tell("blocked")
            await asyncio.Event().wait()


async def holder(end: str) -> None:
    """Drive with a lease, and end badly."""
    async with Node("robot", enable_rosout=False, start_parameter_services=False) as node:
        publisher = node.create_publisher(Float64, "/timer", 20)
        await publisher.wait_for_subscribers()
        async with publisher.lease(stop=Float64(data=0.0), ttl_sec=60.0) as lease:
            for _ in range(25):  # while a link takes over
                lease.publish(Float64(data=1.0))
                await node.get_clock().sleep(STEP_SEC)
            tell("driving")
            if end in {"sleep", "loop"}:
                lease.publish(Float64(data=2.0))
                block(end)
            if end == "exit":
                sys.stdin.readline()
                asyncio.get_running_loop().stop()  # the loop ends, and nothing that runs in it
            while True:
                lease.publish(Float64(data=1.0))
                try:
                    await node.get_clock().sleep(STEP_SEC)
                except asyncio.CancelledError:
                    tell("no")


async def robot(end: str) -> None:
    """Drive until the end."""
    lines: asyncio.Queue[str] = asyncio.Queue()
    asyncio.get_running_loop().add_reader(sys.stdin, lambda: lines.put_nowait(sys.stdin.readline()))
    async with Robot() as node:
        client = node.create_action_client(Fibonacci, "/go")
        await client.wait_for_server()
        await client.send_goal(Fibonacci.Goal())
        for publisher in node.speeds.values():
            await publisher.wait_for_subscribers()
        tell("driving")
        await lines.get()
        if end == "destroy":
            node.destroy_node()
            await asyncio.Event().wait()


class Reader(Node):
    """Prints changes."""

    def __init__(self) -> None:
        super().__init__("reader", enable_rosout=False, start_parameter_services=False)
        self.last: dict[str, float] = {}
        for topic in TOPICS:
            self.create_subscription(Float64, topic, lambda msg, it=topic: self.hear(it, msg), 100)

    def hear(self, topic: str, msg: Float64) -> None:
        """Print a changed value."""
        if self.last.get(topic) != msg.data:
            self.last[topic] = msg.data
            tell(topic, msg.data)


if __name__ == "__main__":
    if sys.argv[1] == "reader":
        aionode.run(Reader, args=[])
    elif sys.argv[1:] == ["holder", "exit"]:
        loop = asyncio.new_event_loop()
        kept = [loop.create_task(holder("exit"))]
        loop.run_forever()
    elif sys.argv[1] == "holder" and sys.argv[3] == "asyncio":
        asyncio.run(holder(sys.argv[2]))
    elif sys.argv[1] == "holder":
        aionode.run(lambda: holder(sys.argv[2]), args=[])
    elif sys.argv[1] == "commander":
        aionode.run(lambda: Commander(sys.argv[2]), args=[])
    elif sys.argv[2] == "run":
        aionode.run(Robot, args=[])
    else:
        aionode.run(lambda: robot(sys.argv[2]), args=[])
    tell("stopped")
