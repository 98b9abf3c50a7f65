"""Everything at once for a long time: nothing may grow, and nothing may be lost uncounted.

One process has a fast publisher that floods a slow reader, a service, an action and a timer of 10
ms; nodes come and go in it, and calls are answered, time out and are cancelled. Other processes
come and go, over links and over Zenoh alone: they receive the flood, call, send goals, abandon
goals, exchange large messages, and end properly or are killed.

After a warm-up and at the end, the guests are sent away and everything that could be left behind is
counted: tasks, descriptors, threads, memory, shared memory, and the entities that a newcomer finds
on the network. The program fails if any of it has grown, or if the messages sent are not those
received, dropped and left.

Run it with ``make soak``, or ``python benchmarks/soak.py --seconds 600``.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import gc
import itertools
import os
import signal
import socket
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

from aionode import Context, Node, run
from aionode.errors import AionodeError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String, UInt8MultiArray
from aionode.qos import DurabilityPolicy, QoSProfile

WARM_UP_SHARE: Final = 0.3
TICK_SEC: Final = 0.01
KEPT: Final = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LARGE_BYTES: Final = 300_000
GUESTS_AT_ONCE: Final = 2
GUEST_SEC: Final = 1.0
LEVEL_LIMIT_SEC: Final = 20.0
"""How long the things of guests may remain after they have gone."""


class Level(NamedTuple):
    """Counts of everything that could be left behind."""

    tasks: int
    descriptors: int
    threads: int
    memory_kb: int
    """Of this process alone: shared memory counts as `segments`."""
    segments: int
    """Pieces of shared memory that this process has mapped."""
    entities: int
    """Nodes and endpoints of the domain."""


ALLOWED: Final = Level(3, 4, 2, 12_000, 4, 0)
"""How much each may grow: calls in progress, and what is first needed late."""


def level(entities: int) -> Level:
    """Return the current level; 0 where the system does not report it."""
    gc.collect()
    me = Path("/proc/self")
    try:
        status = (me / "status").read_text(encoding="utf-8")
        maps = (me / "maps").read_text(encoding="utf-8")
        shared = {line.split()[4] for line in maps.splitlines() if is_shared(line)}
        return Level(
            len(asyncio.all_tasks()),
            len(list((me / "fd").iterdir())),
            int(status.partition("Threads:")[2].split()[0]),
            int(status.partition("RssAnon:")[2].split()[0]),
            len(shared),
            entities,
        )
    except OSError:
        return Level(len(asyncio.all_tasks()), 0, 0, 0, 0, entities)


def is_shared(line: str) -> bool:
    """Return whether a line of ``/proc/self/maps`` is shared memory of links or of Zenoh."""
    return "/memfd:" in line or line.rstrip().endswith((".zenoh", ".zenoh (deleted)"))


class Soak:
    """The work that is done, and its counts."""

    def __init__(self, context: Context) -> None:
        self.context = context
        self.node = node = Node("soak", context=context, callback_budget_ms=1000)
        self.publisher = node.create_publisher(String, "/flood", 10)
        self.subscription = node.create_subscription(String, "/flood", self.read, 10)
        self.large = node.create_publisher(UInt8MultiArray, "/large", 2)
        node.create_subscription(UInt8MultiArray, "/large_back", self.take, 2)
        node.create_service(AddTwoInts, "/add", self.add, concurrent=True)
        node.create_action_server(Fibonacci, "/count", self.count)
        self.client = node.create_client(AddTwoInts, "/add")
        node.create_timer(TICK_SEC, self.tick)
        node.create_timer(0.05, lambda: self.large.publish(LARGE))
        self.invited = asyncio.Event()
        self.guests: set[asyncio.subprocess.Process] = set()
        self.ticks = self.sent = self.calls = self.timeouts = self.cancelled = 0
        self.nodes = self.processes = self.killed = self.goals = self.taken = 0

    def read(self, _msg: String) -> None:
        """Take longer than messages take to arrive."""
        time.sleep(0.0005)

    def take(self, _msg: UInt8MultiArray) -> None:
        """Count a large message."""
        self.taken += 1

    def tick(self) -> None:
        """Count a tick of the timer."""
        self.ticks += 1

    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Answer immediately, or too late if a is negative."""
        if request.a < 0:
            await asyncio.sleep(0.05)
        return AddTwoInts.Response(sum=request.a + request.b)

    async def count(self, goal: Any) -> Fibonacci.Result:
        """Count as far as a goal requests."""
        self.goals += 1
        for number in range(goal.request.order):
            await asyncio.sleep(0.01)
            goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        goal.succeed()
        return Fibonacci.Result(sequence=[goal.request.order])

    async def flood(self) -> None:
        """Publish until cancelled."""
        while True:
            for _ in range(20):
                self.publisher.publish(String(data=f"message {self.sent}"))
                self.sent += 1
            await asyncio.sleep(0.002)

    async def call(self) -> None:
        """Call repeatedly: with an answer, with a time limit that passes, and cancelled."""
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
        """Create nodes with entities, and end them, repeatedly."""
        while True:
            await self.invited.wait()
            async with Node("visitor", context=self.context) as visitor:
                visitor.create_subscription(String, "/flood", lambda _msg: None, 5)
                visitor.create_publisher(String, "/kept", KEPT)
                visitor.create_subscription(String, "/kept", lambda _msg: None, KEPT)
                visitor.create_action_client(Fibonacci, "/count")
                visitor.create_timer(TICK_SEC, lambda: None)
                await asyncio.sleep(0.05)
            self.nodes += 1

    async def invite(self, number: int) -> None:
        """Start processes, one after another, and end them in every way."""
        for turn in itertools.count(number):
            await self.invited.wait()
            guest = await asyncio.create_subprocess_exec(
                sys.executable,
                __file__,
                "--guest",
                env={**os.environ, "AIONODE_LINK": "off" if turn % 2 else "on"},
                start_new_session=True,
                stdout=asyncio.subprocess.PIPE,
            )
            self.guests.add(guest)
            try:
                if guest.stdout is not None:
                    await guest.stdout.readline()  # its node is running
                await asyncio.sleep(GUEST_SEC)
                kill = turn % 3 == 0
                guest.send_signal(signal.SIGKILL if kill else signal.SIGTERM)
                await guest.wait()
                self.killed += kill
            finally:
                if guest.returncode is None:
                    guest.kill()
                self.guests.discard(guest)
            self.processes += 1

    async def level(self) -> Level:
        """End all guests, and return the level once it no longer falls."""
        self.invited.clear()
        while self.guests:  # noqa: ASYNC110 - many set it
            await asyncio.sleep(0.1)
        ends = time.monotonic() + LEVEL_LIMIT_SEC
        last, steady = await self.look(), 0
        while steady < 3 and time.monotonic() < ends:
            await asyncio.sleep(0.5)
            now = await self.look()
            steady = steady + 1 if all(a >= b for a, b in zip(now, last, strict=True)) else 0
            last = Level(*map(min, now, last))
        self.invited.set()
        return last

    async def look(self) -> Level:
        """Return the level, including what a newcomer finds on the network."""
        async with Context() as newcomer, Node("newcomer", context=newcomer) as node:
            graph = node.graph
            entities = len(graph.nodes()) + len(graph.endpoints())
        await asyncio.sleep(0.1)
        return level(entities)

    def lost(self) -> int:
        """Return how many messages are neither received, dropped nor in the queue."""
        stats = self.subscription.stats
        left = self.sent - stats.received - stats.dropped
        return left if left < 0 else max(0, left - self.subscription.qos_profile.depth)


LARGE: Final = UInt8MultiArray(data=bytes(LARGE_BYTES))


class Guest(Node):
    """The node of a process that comes and goes."""

    def __init__(self) -> None:
        super().__init__(f"guest_{os.getpid()}", callback_budget_ms=1000)
        self.create_subscription(String, "/flood", lambda _msg: None, 5)
        self.create_subscription(UInt8MultiArray, "/large", self.send_back, 2)
        self.back = self.create_publisher(UInt8MultiArray, "/large_back", 2)
        self.adding = self.create_client(AddTwoInts, "/add")
        self.counting = self.create_action_client(Fibonacci, "/count")

    def send_back(self, msg: UInt8MultiArray) -> None:
        """Return a large message."""
        self.back.publish(msg)

    async def work(self) -> None:
        """Call, and send goals; every second one is abandoned."""
        await self.adding.wait_for_service()
        await self.counting.wait_for_server()
        for number in itertools.count():
            with contextlib.suppress(AionodeError, TimeoutError):
                await self.adding.call(AddTwoInts.Request(a=number), timeout_sec=1.0)
                async with asyncio.timeout(0.02 if number % 2 else 1.0):
                    await self.counting.call(Fibonacci.Goal(order=3))


async def be_guest() -> None:
    """Run a guest, until a signal arrives."""
    async with Guest() as guest:
        print("here", flush=True)
        await guest.work()


async def soak(seconds: float) -> list[str]:
    """Run everything for some time, and return the failures."""
    async with Context() as context:
        work = Soak(context)
        async with work.node, asyncio.TaskGroup() as tasks:
            doing = [work.flood(), work.call(), work.come_and_go()]
            doing += [work.invite(number) for number in range(GUESTS_AT_ONCE)]
            running = [tasks.create_task(each) for each in doing]
            work.invited.set()
            await asyncio.sleep(seconds * WARM_UP_SHARE)
            before = await work.level()
            await asyncio.sleep(seconds * (1 - WARM_UP_SHARE))
            after = await work.level()
            lost = work.lost()
            for task in running:
                task.cancel()
    print(
        f"{seconds:g} s: {work.sent} sent, {work.subscription.stats.dropped} dropped, "
        f"{work.calls} calls, {work.timeouts} timed out, {work.cancelled} cancelled, "
        f"{work.goals} goals, {work.taken} large messages, {work.nodes} nodes and "
        f"{work.processes} processes came and went, {work.killed} of them killed, "
        f"{work.ticks} ticks"
    )
    problems = [f"{lost} messages were neither received, dropped nor left"] if lost else []
    for name, old, new, allowed in zip(Level._fields, before, after, ALLOWED, strict=True):
        print(f"{name:12} {old:8} -> {new:8}  {new - old:+}")
        if new - old > allowed:
            problems.append(f"{name} grew by {new - old}; {allowed} is the limit")
    return problems


@contextlib.contextmanager
def apart() -> Iterator[None]:
    """Isolate this process and its guests from everything else on the machine."""
    with contextlib.ExitStack() as until_all_are_found:
        held = [until_all_are_found.enter_context(socket.socket()) for _ in range(4)]
        for one in held:
            one.bind(("127.0.0.1", 0))
        ports = [one.getsockname()[1] for one in held]
    with tempfile.TemporaryDirectory(prefix="soak-") as folder:
        os.environ["AIONODE_MEETING_PORTS"] = ",".join(map(str, ports[:3]))
        os.environ["AIONODE_ROUTER_PORT"] = str(ports[3])
        os.environ["XDG_RUNTIME_DIR"] = folder
        yield


def main() -> None:
    """Soak, and exit with status 1 if anything was wrong."""
    parser = argparse.ArgumentParser(description="Everything at once for a long time.")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long (default 10)")
    parser.add_argument("--guest", action="store_true", help="be a process that comes and goes")
    options = parser.parse_args()
    if options.guest:
        run(be_guest, args=[])
        return
    with apart():
        problems = asyncio.run(soak(options.seconds))
    sys.exit("\n".join(problems) or 0)


if __name__ == "__main__":
    main()
