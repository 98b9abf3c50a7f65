"""The program of one process of a fault case: ``python -m tests.faults.process ROLE``.

ROLE is a `Role` as JSON. Each line on stdin is a `Word`; SIGTERM ends it.
"""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import os
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

import aionode
from aionode import Context, Node
from aionode.engine.transport.zenoh.session.session import close_session, open_router
from aionode.engine.wire import cdr
from aionode.errors import AionodeError, QueueFullError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.rcl_interfaces.msg import ParameterValue
from aionode.interfaces.rcl_interfaces.srv import GetParameters
from aionode.interfaces.std_msgs.msg import String
from aionode.message import type_name
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tests.faults.motion.wheels import NEAR, Wheels, move
from tests.faults.roles import (
    REPORTS_VARIABLE,
    Hear,
    Publish,
    Report,
    Role,
    hear_mark,
    note,
    stream_key,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

__all__ = ["Reporter", "text", "told_by"]

REPORT_S = 0.1
TICK_S = 0.01
LONG_S = 0.02
"""From this gap on, the waits of other threads are examined, which takes a millisecond."""

CALL_LIMIT_S = 1.0
GOAL_LIMIT_S = 3.0
HUNG_S = 2.0
"""How much longer than its limit a call or goal may take: canceling a goal waits 1 s at most."""

PAUSE_S = 0.05
"""Time between two calls of one process, on average."""


def profile(each: Publish | Hear) -> QoSProfile:
    """Return a profile for reliable messages."""
    durability = DurabilityPolicy.TRANSIENT_LOCAL if each.transient else DurabilityPolicy.VOLATILE
    if each.keep_all:
        return QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=durability)
    return QoSProfile(depth=each.depth, durability=durability)


def text(sender: str, number: int, size: int) -> str:
    """Return the text of a message: its sender, its number, and when it was sent."""
    return f"{sender} {os.getpid()} {number} {time.monotonic()} {'x' * size}"


def told_by(endpoint: Any) -> int:
    """Return the number of messages that a publisher or subscription counts as lost."""
    return int(endpoint.stats.dropped) + int(getattr(endpoint.stats, "lost", 0))


class GivenUp(logging.Handler):
    """Counts the messages that links have given up, according to their warnings."""

    def __init__(self) -> None:
        super().__init__()
        self.count = 0
        logging.getLogger("aionode.transport.link").addHandler(self)

    def emit(self, record: logging.LogRecord) -> None:
        """Add the number in a warning."""
        if "dropped the last" in record.msg and isinstance(record.args, tuple):
            self.count += int(record.args[1])  # type: ignore[call-overload]  # a number


class CoreWait:
    """Measures how long the threads of this process were ready to run, but had no core.

    It is always 0 if the system does not report it.
    """

    def __init__(self) -> None:
        self._own = -1
        with suppress(OSError):
            self._own = os.open("/proc/thread-self/schedstat", os.O_RDONLY)
        self._own_s = self._read()
        self._others_s: dict[str, float] = {}
        self.largest_of_others()

    def _read(self) -> float:
        return int(os.pread(self._own, 100, 0).split()[1]) / 1e9 if self._own >= 0 else 0.0

    def own(self) -> float:
        """Return the time of this thread since the last call, in seconds."""
        before_s, self._own_s = self._own_s, self._read()
        return self._own_s - before_s

    def largest_of_others(self) -> float:
        """Return the longest time of any other thread since the last call, in seconds.

        That thread may have held something that this thread waited for, such as the GIL.
        """
        before_s, self._others_s = self._others_s, {}
        for stat in Path("/proc/self/task").glob("*/schedstat"):
            with suppress(OSError):  # the thread has just ended
                if stat.parent.name != str(os.getpid()):
                    self._others_s[stat.parent.name] = int(stat.read_bytes().split()[1]) / 1e9
        waited = (each - before_s.get(name, 0.0) for name, each in self._others_s.items())
        return max(waited, default=0.0)


class Reporter:
    """Collects what a process sees, and reports it."""

    def __init__(self) -> None:
        self.report = Report()
        self.endpoints: list[Any] = []
        self.nodes: Callable[[], list[str]] = list
        self.given_up = GivenUp()
        self.core_wait: CoreWait | None = None

    def hear(self, topic: str, data: str) -> None:
        """Record a message."""
        sender, pid, number, sent_s, _ = data.split(" ", 4)
        ranges = self.report.heard.setdefault(stream_key(topic, sender, int(pid)), [])
        if not note(ranges, int(number)):
            self.report.doubled += 1
        mark = hear_mark(topic, sender)
        self.report.marks[mark] = max(self.report.marks.get(mark, 0.0), float(sent_s))

    def watch(self) -> None:
        """Measure the stalls of the event loop from now on."""
        loop = asyncio.get_running_loop()
        last_s = time.monotonic()
        core_wait = self.core_wait = CoreWait()

        def tick() -> None:
            nonlocal last_s
            now_s = time.monotonic()
            gap_s = now_s - last_s - TICK_S
            own_gap_s = gap_s - core_wait.own()
            if own_gap_s > LONG_S:
                own_gap_s -= core_wait.largest_of_others()
            self.report.gap_s = max(self.report.gap_s, gap_s)
            self.report.own_gap_s = max(self.report.own_gap_s, own_gap_s)
            last_s = now_s
            loop.call_later(TICK_S, tick)

        loop.call_later(TICK_S, tick)

    def tell(self) -> None:
        """Print a report; start over with the gaps and with what the wheels receive."""
        self.report.time_s = time.monotonic()
        self.report.nodes = sorted(self.nodes())
        self.report.told = sum(map(told_by, self.endpoints)) + self.given_up.count
        os.write(int(os.environ[REPORTS_VARIABLE]), msgspec.json.encode(self.report) + b"\n")
        self.report.gap_s = self.report.own_gap_s = 0.0
        self.report.handed = []

    async def go_on(self) -> None:
        """Print reports until cancelled."""
        while True:
            self.tell()
            if self.core_wait is not None:
                self.core_wait.largest_of_others()  # earlier waits do not belong to later gaps
            await asyncio.sleep(REPORT_S)


class Process:
    """A node that plays its role."""

    def __init__(self, role: Role) -> None:
        self.role = role
        self.reporter = Reporter()
        self.report = self.reporter.report
        self.quiet = asyncio.Event()
        self.publishes = asyncio.Event()
        self.publishes.set()

    async def run(self) -> None:
        """Play the role until SIGTERM."""
        os.set_blocking(sys.stdin.fileno(), False)
        asyncio.get_running_loop().add_reader(sys.stdin, self.obey)
        if not (self.role.wheels or self.role.moves):  # for those, other times are measured
            self.reporter.watch()
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self.reporter.go_on())
            if self.role.control:
                self.report.ready = True
            elif self.role.router:
                await self.route()
            else:
                await self.be_node()

    def obey(self) -> None:
        """Execute the command in a line of stdin."""
        word = sys.stdin.readline().strip()
        if word == "pause":
            self.publishes.clear()
        elif word == "go on":
            self.publishes.set()
        elif word == "join":
            self.join()
        elif word == "near":
            self.wheels.distance = NEAR
        else:
            asyncio.get_running_loop().remove_reader(sys.stdin)
            self.publishes.set()
            self.quiet.set()

    async def route(self) -> None:
        """Run as a router."""
        session = await open_router(
            [self.role.router], [self.role.connect] * bool(self.role.connect)
        )
        self.report.ready = True
        try:
            await asyncio.Event().wait()
        finally:
            await asyncio.shield(close_session(session))

    async def be_node(self) -> None:
        """Run as a node."""
        role = self.role
        async with (
            Context() as context,
            Node(
                role.name,
                context=context,
                enable_rosout=False,
                start_parameter_services=bool(role.parameter_size),
            ) as node,
        ):
            self.offer(node)
            self.reporter.nodes = node.get_node_names
            self.report.ready = True
            self.reporter.tell()  # now: a pipe that is not read may block a noisy process forever
            work: list[Coroutine[Any, Any, None]] = [
                *(self.publish(node, each) for each in role.publish),
                *(move(node, wheel) for wheel in role.moves),
            ]
            if role.call:
                work += [self.call(node) for _ in range(role.callers)]
            if role.send:
                work.append(self.send(node))
            if role.noisy:
                work.append(shout(node))
            if role.fork:
                work.append(fork(self.report))
            if role.curious:
                work.append(look_up(node))
            if role.gateway:
                work.append(serve_clients(node))
            async with asyncio.TaskGroup() as tasks:
                for each_work in work:
                    tasks.create_task(each_work)
                if not any(each.count for each in role.publish):
                    await asyncio.Event().wait()
        # Only reached by processes that end after a number of messages.
        asyncio.get_running_loop().call_soon(os.kill, os.getpid(), 15)

    def offer(self, node: Node) -> None:
        """Create subscriptions, servers and wheels."""
        role = self.role
        if role.parameter_size:
            node.declare_parameter("large", "x" * role.parameter_size)
        for each in role.hear:
            self.hear(node, each)
        if role.serve:
            node.create_service(GetParameters, role.serve, answer)
        if role.act:
            node.create_action_server(Fibonacci, role.act, count)
        self.wheels = Wheels(node, self.report, self.reporter.tell)
        if not role.joins:
            self.join()

    def join(self) -> None:
        """Let the wheels obey."""
        for wheel in self.role.wheels:
            self.wheels.attach(wheel)

    def hear(self, node: Node, hear: Hear) -> None:
        """Subscribe."""
        paused = False

        async def take(msg: String) -> None:
            nonlocal paused
            self.reporter.hear(hear.topic, msg.data)
            if hear.block_s:
                time.sleep(hear.block_s)  # noqa: ASYNC251 - the loop is to be busy
            if hear.slow_s:
                await asyncio.sleep(hear.slow_s)
            if hear.pause_s and not paused and int(msg.data.split(" ", 3)[2]) >= 50:
                paused = True
                await asyncio.sleep(hear.pause_s)

        self.reporter.endpoints.append(
            node.create_subscription(String, hear.topic, take, profile(hear))
        )

    async def publish(self, node: Node, publish: Publish) -> None:
        """Publish until told to be quiet, or until the last message was sent."""
        publisher = node.create_publisher(String, publish.topic, profile(publish))
        self.reporter.endpoints.append(publisher)
        await publisher.wait_for_subscribers(publish.readers)
        key = stream_key(publish.topic, self.role.name, os.getpid())
        number = 1
        while not self.quiet.is_set() and (not publish.count or number <= publish.count):
            try:
                publisher.publish(String(data=text(self.role.name, number, publish.size)))
            except QueueFullError:
                await publisher.drain()
                continue
            self.report.sent[key] = number
            number += 1
            if publish.period_s or number % 50 == 0:
                await asyncio.sleep(publish.period_s)
            await self.publishes.wait()
        if publish.count:
            await publisher.drain()

    async def attempt(
        self, mark: str, limit_s: float, work: Callable[[], Coroutine[Any, Any, object]]
    ) -> None:
        """Await something, and record how it ends."""
        began_s = time.monotonic()
        self.report.calls += 1
        try:
            await work()
        except (AionodeError, TimeoutError):
            self.report.failed += 1
        else:
            self.report.marks[mark] = began_s
        if time.monotonic() - began_s > limit_s + HUNG_S:
            self.report.hung += 1

    async def call(self, node: Node) -> None:
        """Call the service repeatedly."""
        client = node.create_client(GetParameters, self.role.call)
        request = GetParameters.Request(names=["x" * self.role.size])
        while not self.quiet.is_set():
            if not await client.wait_for_service(timeout_sec=1.0):
                continue
            await self.attempt(
                "call",
                CALL_LIMIT_S,
                lambda: client.call(request, timeout_sec=CALL_LIMIT_S),
            )
            await asyncio.sleep(PAUSE_S * self.role.callers)

    async def send(self, node: Node) -> None:
        """Send goals repeatedly."""
        client = node.create_action_client(Fibonacci, self.role.send)

        async def goal() -> None:
            async with asyncio.timeout(GOAL_LIMIT_S):
                await client.call(Fibonacci.Goal(order=3))

        while not self.quiet.is_set():
            if await client.wait_for_server(timeout_sec=1.0):
                await self.attempt("goal", GOAL_LIMIT_S, goal)


async def answer(request: GetParameters.Request) -> GetParameters.Response:
    """Return the text of the request."""
    return GetParameters.Response(values=[ParameterValue(string_value=request.names[0])])


async def count(goal: Any) -> Fibonacci.Result:
    """Count, slowly."""
    for number in range(goal.request.order):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        await asyncio.sleep(0.01)
    goal.succeed()
    return Fibonacci.Result(sequence=[goal.request.order])


async def shout(node: Node) -> None:
    """Log until cancelled."""
    while True:
        node.get_logger().warning("x" * 1000)
        await asyncio.sleep(0.001)


async def serve_clients(node: Node) -> None:
    """Run a gateway."""
    from aionode.gateway import Gateway, Policy, Rule, Who  # few roles have one

    policy = Policy.default(allow_write=True)
    tokens = [Who(name, token=name) for name in ("viewer", "operator", "admin")]
    hidden = Rule(see=f"{node.get_fully_qualified_name()}:large")
    policy = msgspec.structs.replace(policy, who=[*policy.who, *tokens], refuse=[hidden])
    async with Gateway(node, policy, port=0):
        await asyncio.Event().wait()


async def look_up(node: Node) -> None:
    """Look up unknown types of topics until cancelled, as a recorder or a gateway does."""
    while True:
        names = {name for _, types in node.get_topic_names_and_types() for name in types}
        for name in names - {type_name(String)}:
            with suppress(AionodeError):
                found = await node.find_type(name)
                node.create_subscription(found, "/looked_up", print).destroy()
                cdr.encode(found())
        await asyncio.sleep(REPORT_S)


def forked() -> None:
    """Create a node in a forked process; an error is fine too."""

    async def main() -> None:
        async with Node("forked"):
            await asyncio.sleep(0.2)

    with suppress(AionodeError, RuntimeError):
        asyncio.run(main())
    os._exit(0)


async def fork(report: Report) -> None:
    """Fork, and wait for the child; one that hangs or crashes is counted as hung."""
    await asyncio.sleep(0.3)
    child = multiprocessing.get_context("fork").Process(target=forked)
    child.start()
    await asyncio.to_thread(child.join, 5.0)
    if child.exitcode != 0:
        report.hung += 1
        child.kill()


def main() -> None:
    """Run until SIGTERM, and report a last time."""
    role = msgspec.json.decode(sys.argv[1], type=Role)
    logging.captureWarnings(True)
    processes: list[Process] = []

    async def run() -> None:
        processes.append(Process(role))
        await processes[0].run()

    try:
        aionode.run(run, args=[])
    finally:
        for process in processes:
            process.report.last = True
            process.reporter.tell()


if __name__ == "__main__":
    main()
