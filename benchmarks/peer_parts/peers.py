"""The peers: each sends a word or a block to another process, and reports what arrives.

The measurements are the same for all of them, and are in `stations.py`. A peer whose modules are
not installed raises `ImportError` when it is opened.
"""

from __future__ import annotations

import array
import asyncio
import json
import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Final

__all__ = ["MODULES", "PEERS", "Peer"]

ROOM: Final = 50_000  # depth of queues: a whole burst
SIDES: Final = {"ping": ("there", "back"), "echo": ("back", "there")}


class Peer(ABC):
    """One end of a conversation. `hear` is called with each word, and with "" for a block.

    Args:
        side: ``"ping"``, ``"echo"``, or ``"both"`` for what has one process only.
        place: A folder for sockets, and a free port.
        loop_name: ``"asyncio"`` or ``"uvloop"``.
    """

    alone = False  # whether both ends are in one process

    def __init__(self, side: str, place: tuple[str, int], loop_name: str) -> None:
        self.side = side
        self.folder, self.port = place
        self.loop_name = loop_name
        self.hear: Callable[[str], object] = lambda _: None
        self.says, self.hears = SIDES.get(side, SIDES["ping"])

    @abstractmethod
    def open(self) -> None:
        """Start; return when the other end has been found."""

    @abstractmethod
    def say(self, word: str) -> None:
        """Send a word of some 23 characters."""

    def say_block(self, block: bytes) -> None:
        """Send a block of any size."""
        raise NotImplementedError

    @abstractmethod
    def run(self, until: Callable[[], bool]) -> None:
        """Run callbacks until `until`, which is called after each of them, or `wake`, is true."""

    def soon(self, call: Callable[[], object]) -> None:
        """Call a function, within the event loop if there is one."""
        call()

    @abstractmethod
    def wake(self) -> None:
        """End `run`, from a callback."""

    @abstractmethod
    def rest(self, seconds: float) -> None:
        """Let time pass."""

    @abstractmethod
    def every(self, seconds: float, call: Callable[[], object]) -> Callable[[], object]:
        """Call periodically; return a function that ends it."""

    def call(self) -> Any:
        """Return an awaitable answer of a service at the other end."""
        raise NotImplementedError

    def calls_per_s(self, count: int) -> float:
        """Return how many calls per second one caller makes."""
        raise NotImplementedError


class LoopPeer(Peer):
    """A peer on an asyncio event loop."""

    def open(self) -> None:
        """Start on a new event loop."""
        factory = None
        if self.loop_name == "uvloop":
            import uvloop

            factory = uvloop.new_event_loop
        self.loop = factory() if factory else asyncio.new_event_loop()
        asyncio.set_event_loop(self.loop)
        self._done: asyncio.Future[None] = self.loop.create_future()
        self.loop.run_until_complete(self.begin())

    @abstractmethod
    async def begin(self) -> None:
        """Do the work of `open` in the loop."""

    def run(self, until: Callable[[], bool]) -> None:
        """Run the loop."""
        if not until():
            self._done = self.loop.create_future()
            self.loop.run_until_complete(self._done)

    def soon(self, call: Callable[[], object]) -> None:
        """Call it within the loop."""
        self.loop.call_soon(call)

    def wake(self) -> None:
        """End `run`."""
        if not self._done.done():
            self._done.set_result(None)

    def rest(self, seconds: float) -> None:
        """Let the loop run."""
        self.loop.run_until_complete(asyncio.sleep(seconds))

    def every(self, seconds: float, call: Callable[[], object]) -> Callable[[], object]:
        """Call by a timer of the loop, without drift."""
        handle: asyncio.TimerHandle

        def fire(due_s: float) -> None:
            nonlocal handle
            call()
            handle = self.loop.call_at(due_s + seconds, fire, due_s + seconds)

        first_s = self.loop.time() + seconds
        handle = self.loop.call_at(first_s, fire, first_s)
        return lambda: handle.cancel()  # noqa: PLW0108  # of the latest one

    def calls_per_s(self, count: int) -> float:
        """Return how many calls per second one coroutine makes."""

        async def caller() -> float:
            began = time.perf_counter()
            for _ in range(count):
                await self.call()
            return count / (time.perf_counter() - began)

        return self.loop.run_until_complete(caller())


class Queue(LoopPeer):
    """A bare `asyncio.Queue` in one process, one hop there and one back."""

    alone = True

    async def begin(self) -> None:
        """Start a reader for each of two queues."""
        self.there: asyncio.Queue[str] = asyncio.Queue()
        self.back: asyncio.Queue[str] = asyncio.Queue()
        self.tasks = [
            asyncio.ensure_future(self.read(self.there, self.back.put_nowait)),
            asyncio.ensure_future(self.read(self.back, lambda word: self.hear(word))),  # noqa: PLW0108  # set later
        ]

    async def read(self, queue: asyncio.Queue[str], take: Callable[[str], object]) -> None:
        """Pass on what arrives."""
        while True:
            take(await queue.get())

    def say(self, word: str) -> None:
        """Put it into the queue."""
        self.there.put_nowait(word)


class Socket(LoopPeer, asyncio.Protocol):
    """A bare Unix socket: a length, and as many bytes."""

    async def begin(self) -> None:
        """Listen, or connect."""
        self.rest_of = bytearray()
        path = f"{self.folder}/bare"
        if self.side == "echo":
            await self.loop.create_unix_server(lambda: self, path)
            return
        while not os.path.exists(path):  # noqa: ASYNC110, PTH110, ASYNC240  # nothing tells
            await asyncio.sleep(0.01)
        await self.loop.create_unix_connection(lambda: self, path)

    def connection_made(self, transport: Any) -> None:
        """Keep the transport."""
        self.transport = transport
        transport.set_write_buffer_limits(1 << 26)

    def data_received(self, data: bytes) -> None:
        """Split it into messages."""
        pieces = self.rest_of
        pieces += data
        begin, end = 0, len(pieces)
        while end - begin >= 4:
            size = int.from_bytes(pieces[begin : begin + 4], "little")
            if end - begin < 4 + size:
                break
            self.hear(bytes(pieces[begin + 4 : begin + 4 + size]).decode() if size < 100 else "")
            begin += 4 + size
        del pieces[:begin]

    def say(self, word: str) -> None:
        """Write it."""
        data = word.encode()
        self.transport.write(len(data).to_bytes(4, "little") + data)

    def say_block(self, block: bytes) -> None:
        """Write it."""
        self.transport.write(len(block).to_bytes(4, "little"))
        self.transport.write(block)


class Aionode(LoopPeer):
    """aionode: nodes, messages, callbacks, over a link."""

    link = True

    async def begin(self) -> None:
        """Start a node, and wait for the other one."""
        from aionode import Context, Node
        from aionode.interfaces.example_interfaces.srv import AddTwoInts
        from aionode.interfaces.std_msgs.msg import String, UInt8MultiArray

        first = self.port + 2
        os.environ["AIONODE_ROUTER_PORT"] = str(self.port + 1)
        os.environ["AIONODE_MEETING_PORTS"] = f"{first},{first + 1},{first + 2}"
        os.environ["XDG_RUNTIME_DIR"] = self.folder
        self.String, self.Block, self.Add = String, UInt8MultiArray, AddTwoInts
        context = Context(transport="local") if self.alone else Context(link=self.link)
        self.node = Node(self.side, context=context)
        await self.node.__aenter__()
        self.words = self.node.create_publisher(String, self.says, ROOM)
        self.node.create_subscription(String, self.hears, lambda msg: self.hear(msg.data), ROOM)
        if self.alone:
            answers = self.node.create_publisher(String, self.hears, ROOM)
            self.node.create_subscription(String, self.says, answers.publish, ROOM)
        self.blocks = self.node.create_publisher(UInt8MultiArray, f"{self.says}_block", 10)
        self.node.create_subscription(
            UInt8MultiArray, f"{self.hears}_block", lambda _: self.hear(""), 10
        )
        if self.side == "echo":
            self.node.create_service(AddTwoInts, "add", lambda _: AddTwoInts.Response(sum=3))
            return
        self.client = self.node.create_client(AddTwoInts, "add")
        await self.words.wait_for_subscribers()
        if not self.alone:
            await self.client.wait_for_service()
            await self.blocks.wait_for_subscribers()
            while self.link and "zenoh" in "".join(self.words.stats.routes.values()):
                self.words.publish(String(data="dust"))
                await asyncio.sleep(0.05)

    def say(self, word: str) -> None:
        """Publish it."""
        self.words.publish(self.String(data=word))

    def say_block(self, block: bytes) -> None:
        """Publish it."""
        self.blocks.publish(self.Block(data=block))

    def every(self, seconds: float, call: Callable[[], object]) -> Callable[[], object]:
        """Call by a timer of the node."""
        return self.node.create_timer(seconds, call).destroy

    def call(self) -> Any:
        """Call the service."""
        return self.client.call(self.Add.Request(a=1, b=2))


class AionodeZenoh(Aionode):
    """The same over Zenoh."""

    link = False


class AionodeInProcess(Aionode):
    """The same within one process."""

    alone = True


class Zenoh(LoopPeer):
    """zenoh-python, with one `call_soon_threadsafe` for each message."""

    async def begin(self) -> None:
        """Open a session that is linked only to the other one."""
        import zenoh

        config = zenoh.Config()
        endpoint = f"tcp/127.0.0.1:{self.port}"
        listens = self.side == "echo"
        for key, value in {
            "listen/endpoints": [endpoint] if listens else ["tcp/127.0.0.1:0"],
            "connect/endpoints": [] if listens else [endpoint],
            "scouting/multicast/enabled": False,
        }.items():
            config.insert_json5(key, json.dumps(value))
        self.session = zenoh.open(config)
        self.publisher = self.session.declare_publisher(
            self.says, congestion_control=zenoh.CongestionControl.BLOCK
        )
        self.listen()
        while self.side == "ping" and not self.matches():  # noqa: ASYNC110  # nothing tells
            await asyncio.sleep(0.05)

    def matches(self) -> bool:
        """Return whether there is another end."""
        status: Any = self.publisher.matching_status
        return bool(status.matching)

    def listen(self) -> None:
        """Subscribe."""
        self.subscriber = self.session.declare_subscriber(
            self.hears, lambda sample: self.loop.call_soon_threadsafe(self.take, sample)
        )

    def take(self, sample: Any) -> None:
        """Pass it on."""
        data = sample.payload.to_bytes()
        self.hear(data.decode() if len(data) < 100 else "")

    def say(self, word: str) -> None:
        """Put it into the queue."""
        self.publisher.put(word.encode())

    def say_block(self, block: bytes) -> None:
        """Put it into the queue."""
        self.publisher.put(block)


class AsyncioForRobotics(Zenoh):
    """asyncio-for-robotics over Zenoh: a subscriber that a coroutine reads."""

    def listen(self) -> None:
        """Subscribe, and read."""
        from asyncio_for_robotics.zenoh import Sub  # type: ignore[import-not-found]

        subscriber = Sub(self.hears, self.session)

        async def read() -> None:
            async for sample in subscriber.listen_reliable(queue_size=ROOM):
                self.take(sample)

        self.task = self.loop.create_task(read())


class ZeroMq(LoopPeer):
    """pyzmq's asyncio sockets, a pair over a Unix socket."""

    async def begin(self) -> None:
        """Bind or connect, and read."""
        import zmq.asyncio  # type: ignore[import-not-found]

        self.context = zmq.asyncio.Context()
        self.socket = self.context.socket(zmq.PAIR)
        self.socket.set_hwm(ROOM)
        address = f"ipc://{self.folder}/zmq"
        (self.socket.bind if self.side == "echo" else self.socket.connect)(address)

        async def read() -> None:
            while True:
                data = await self.socket.recv()
                self.hear(data.decode() if len(data) < 100 else "")

        self.task = self.loop.create_task(read())

    def say(self, word: str) -> None:
        """Send it."""
        self.socket.send(word.encode())

    def say_block(self, block: bytes) -> None:
        """Send it."""
        self.socket.send(block)


class CycloneDds(LoopPeer):
    """cyclonedds-python: a listener in its thread, and one `call_soon_threadsafe` for each call."""

    async def begin(self) -> None:
        """Create writers and readers on this host's loopback."""
        from benchmarks.peer_parts import dds

        self.ends = dds.Ends(self.port, self.says, self.hears, self.arrived, ROOM)
        while self.side == "ping" and not self.ends.matched:  # noqa: ASYNC110  # nothing tells
            await asyncio.sleep(0.05)

    def arrived(self) -> None:
        """Process arrivals in the loop; called in a thread of DDS."""
        self.loop.call_soon_threadsafe(self.take)

    def take(self) -> None:
        """Pass on arrivals."""
        for word in self.ends.take():
            self.hear(word)

    def say(self, word: str) -> None:
        """Write it."""
        self.ends.say(word)

    def say_block(self, block: bytes) -> None:
        """Write it."""
        self.ends.say_block(block)


class Rclpy(Peer):
    """rclpy with its default executor, on the configured middleware."""

    events = False

    def open(self) -> None:
        """Start a node, and wait for the other one."""
        from std_msgs.msg import String, UInt8MultiArray

        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.task import Future

        try:
            from example_interfaces.srv import AddTwoInts  # type: ignore[import-not-found]
        except ImportError:  # PyPI has no other service
            from test_msgs.srv import BasicTypes as AddTwoInts
        os.environ["ROS_DOMAIN_ID"] = str(self.port % 100 + 1)
        rclpy.init()
        self.String, self.Block, self.Add, self.Future = String, UInt8MultiArray, AddTwoInts, Future
        self.node = rclpy.create_node(self.side)
        if self.events:
            from rclpy.experimental.events_executor import (
                EventsExecutor,
            )

            self.executor: Any = EventsExecutor()
        else:
            self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.done: Future[None] = Future()
        self.words = self.node.create_publisher(String, self.says, ROOM)
        self.node.create_subscription(String, self.hears, lambda msg: self.hear(msg.data), ROOM)
        self.blocks = self.node.create_publisher(UInt8MultiArray, f"{self.says}_block", 10)
        self.node.create_subscription(
            UInt8MultiArray, f"{self.hears}_block", lambda _: self.hear(""), 10
        )
        if self.side == "echo":
            self.service = self.node.create_service(AddTwoInts, "add", lambda _, response: response)
            return
        self.client = self.node.create_client(AddTwoInts, "add")
        self.client.wait_for_service()
        while not (self.words.get_subscription_count() and self.node.count_publishers(self.hears)):
            time.sleep(0.05)

    def run(self, until: Callable[[], bool]) -> None:
        """Spin. Without a limit, the events executor takes a whole core and calls nothing."""
        if not until():
            self.done = self.Future()
            self.executor.spin_until_future_complete(self.done, timeout_sec=600)

    def wake(self) -> None:
        """End `run`."""
        if not self.done.done():
            self.done.set_result(None)

    def rest(self, seconds: float) -> None:
        """Sleep, or let timers fire for longer."""
        if seconds < 0.1:
            time.sleep(seconds)
        else:
            self.executor.spin_until_future_complete(self.Future(), timeout_sec=seconds)

    def every(self, seconds: float, call: Callable[[], object]) -> Callable[[], object]:
        """Call by a timer of the node."""
        timer = self.node.create_timer(seconds, call)
        return lambda: self.node.destroy_timer(timer)

    def say(self, word: str) -> None:
        """Publish it."""
        self.words.publish(self.String(data=word))

    def say_block(self, block: bytes) -> None:
        """Publish it."""
        self.blocks.publish(self.Block(data=array.array("B", block)))

    def calls_per_s(self, count: int) -> float:
        """Return how many calls per second are answered, one after another."""
        began = time.perf_counter()
        for _ in range(count):
            future = self.client.call_async(self.Add.Request())
            self.executor.spin_until_future_complete(future, timeout_sec=60)
        return count / (time.perf_counter() - began)


class RclpyEvents(Rclpy):
    """The same with its events executor, which is written in C++."""

    events = True


PEERS: Final[dict[str, type[Peer]]] = {
    "bare queue, in process": Queue,
    "aionode, in process": AionodeInProcess,
    "bare Unix socket": Socket,
    "aionode, link": Aionode,
    "aionode, Zenoh": AionodeZenoh,
    "zenoh-python": Zenoh,
    "asyncio-for-robotics": AsyncioForRobotics,
    "pyzmq": ZeroMq,
    "cyclonedds-python": CycloneDds,
    "rclpy, default executor": Rclpy,
    "rclpy, events executor": RclpyEvents,
}

MODULES: Final = {
    "bare queue, in process": "asyncio",
    "aionode, in process": "aionode.node",
    "bare Unix socket": "asyncio",
    "aionode, link": "aionode.node, aionode.transport.zenoh, aionode.transport.link",
    "aionode, Zenoh": "aionode.node, aionode.transport.zenoh",
    "zenoh-python": "zenoh",
    "asyncio-for-robotics": "asyncio_for_robotics.zenoh",
    "pyzmq": "zmq.asyncio",
    "cyclonedds-python": "cyclonedds.domain",
    "rclpy, default executor": "rclpy.executors, std_msgs.msg",
    "rclpy, events executor": "rclpy.experimental.events_executor, std_msgs.msg",
}
"""The modules that a program of each peer imports."""
