"""Round trips over DDS: aionode with ``transport="rcl"``, and rclpy with its two executors.

The same message (String, 16 bytes) goes to an echo in another process and back. All processes run
all the time and are measured in turns of a fraction of a second, so that other load affects all of
them. With ``--stress``, messages go in both directions as fast as they are read: nothing may be
lost, and the loop must not stall. Both take a minute and a half: ``python benchmarks/rcl.py
--seconds 60``, ``python benchmarks/rcl.py --stress --seconds 60``. They need an rclpy: ``pip
install 'aionode[ros]'``, or a sourced ROS 2.
"""

from __future__ import annotations

import argparse
import asyncio
import importlib.util
import json
import os
import resource
import select
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

KINDS = ("rclpy-events", "aionode", "aionode-uvloop", "rclpy-default")
PLAN = (("tight", 100, 0.0), ("100Hz", 20, 0.01))  # name, round trips, pause in seconds
TEXT = "0123456789abcdef"
FIRST_S = 0.2  # after which the first message is sent again
LIMIT_S = 180.0  # of one turn, on a busy machine


def main() -> None:
    """Measure, or run one part of a measurement."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=40.0, help="how long to measure")
    parser.add_argument("--stress", action="store_true", help="stress both directions instead")
    parser.add_argument("--part", nargs="+", help=argparse.SUPPRESS)
    options = parser.parse_args()
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
    if options.part:
        play(*options.part)
    elif importlib.util.find_spec("rclpy") is None:
        print("skipped: rclpy is not installed here; on Linux x86-64: pip install 'aionode[ros]'")
    elif options.stress:
        stress(options.seconds)
    else:
        compare(options.seconds)


def start(*part: str) -> subprocess.Popen[str]:
    """Start one part in its own process."""
    command = [sys.executable, "-W", "ignore", __file__, "--part", *part]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)  # noqa: S603  # this file


def ask(part: subprocess.Popen[str], question: str) -> Any:
    """Return a part's answer to a line."""
    if part.stdin is None or part.stdout is None:
        raise RuntimeError("the part has no pipes")
    part.stdin.write(question + "\n")
    part.stdin.flush()
    if not select.select([part.stdout], [], [], LIMIT_S)[0]:
        raise TimeoutError(f"no answer to {question!r} from {part.args!r}")
    return json.loads(part.stdout.readline())


def compare(seconds: float) -> None:
    """Print a table of round trips."""
    echoes = [start("echo", kind) for kind in KINDS]
    players = {kind: start("player", kind) for kind in KINDS}
    try:
        turns, times = measure(players, seconds)
    finally:
        for part in (*echoes, *players.values()):
            end(part)
    print(f"{turns} turns; medians in µs, in parentheses as parts of {KINDS[0]}'s")
    print(f"{'':16}" + "".join(f"{name:>22}" for name, _, _ in PLAN))
    for kind in KINDS:
        cells = []
        for name, _, _ in PLAN:
            base, own = (statistics.median(times[one, name]) for one in (KINDS[0], kind))
            cells.append(f"{own / 1e3:>14.0f} ({own / base:.2f})")
        print(f"{kind:16}" + "".join(f"{cell:>22}" for cell in cells))


def measure(
    players: Mapping[str, subprocess.Popen[str]], seconds: float
) -> tuple[int, dict[tuple[str, str], list[int]]]:
    """Return how many turns each player had, and its round trips in ns by player and name."""
    for player in players.values():
        ask(player, "0 0 0")  # until it has found its echo
    for player in players.values():
        ask(player, f"tight {PLAN[0][1]} 0")  # the first turn is for warming up
    times: dict[tuple[str, str], list[int]] = {}
    turns = 0
    ends = time.perf_counter() + seconds
    while time.perf_counter() < ends:
        turns += 1
        for name, count, pause_s in PLAN:
            for kind, player in players.items():
                found = ask(player, f"{name} {count} {pause_s}")
                times.setdefault((kind, name), []).extend(found)
    return turns, times


def end(part: subprocess.Popen[str]) -> None:
    """Close the pipe of a part, and wait for its end."""
    if part.stdin is not None:
        part.stdin.close()
    try:
        part.wait(10)
    except subprocess.TimeoutExpired:
        part.kill()


def play(role: str, kind: str) -> None:
    """Run one part."""
    if role == "stress":
        asyncio.run(stress_part(float(kind)))
    elif role == "idle":
        asyncio.run(idle_part(float(kind)))
    elif kind.startswith("rclpy"):
        rclpy_part(role, kind)
    elif kind == "aionode-uvloop":
        import uvloop

        uvloop.run(aionode_part(role, kind))
    else:
        asyncio.run(aionode_part(role, kind))


def next_turn() -> tuple[int, float] | None:
    """Return the round trips and the pause of the next turn; None at the end."""
    line = sys.stdin.readline()
    if not line:
        return None
    _, count, pause_s = line.split()
    return int(count), float(pause_s)


def tell(answer: object) -> None:
    """Answer a question of the parent."""
    print(json.dumps(answer), flush=True)


async def aionode_part(role: str, kind: str) -> None:
    """Echo until stdin is closed, or measure when told."""
    from aionode import Context, Node
    from aionode.interfaces.std_msgs.msg import String

    topic = kind.replace("-", "_")
    loop = asyncio.get_running_loop()
    async with (
        Context(transport="rcl") as context,
        Node(f"{role}_{topic}", context=context) as node,
    ):
        if role == "echo":
            pong = node.create_publisher(String, f"{topic}_pong", 10)
            node.create_subscription(String, f"{topic}_ping", pong.publish)
            await asyncio.to_thread(sys.stdin.read)
            return
        ping = node.create_publisher(String, f"{topic}_ping", 10)
        times: list[int] = []
        began, count = 0, 1
        pause_s = 0.0
        ended = loop.create_future()

        def send() -> None:
            nonlocal began
            began = time.perf_counter_ns()
            ping.publish(message)

        def on_pong(_: Any) -> None:
            if ended.done():  # by another answer to the first pings
                return
            times.append(time.perf_counter_ns() - began)
            if len(times) == count:
                ended.set_result(None)
            elif pause_s:
                loop.call_later(pause_s, send)
            else:
                send()

        node.create_subscription(String, f"{topic}_pong", on_pong)
        message = String(data=TEXT)
        while not ended.done():  # until the echo has found this process
            send()
            await asyncio.wait([ended], timeout=FIRST_S)
        while (turn := await asyncio.to_thread(next_turn)) is not None:
            count, pause_s = turn
            times.clear()
            if count:
                ended = loop.create_future()
                send()
                await ended
            tell(times)


def rclpy_part(role: str, kind: str) -> None:
    """Echo until stdin is closed, or measure when told."""
    from std_msgs.msg import String

    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.experimental.events_executor import EventsExecutor
    from rclpy.task import Future

    topic = kind.replace("-", "_")
    rclpy.init()
    node = rclpy.create_node(f"{role}_{topic}")
    executor: Any = EventsExecutor() if kind == "rclpy-events" else SingleThreadedExecutor()
    executor.add_node(node)
    if role == "echo":
        pong = node.create_publisher(String, f"{topic}_pong", 10)
        node.create_subscription(String, f"{topic}_ping", pong.publish, 10)
        threading.Thread(target=end_with_stdin, daemon=True).start()
        executor.spin_until_future_complete(Future(executor=executor), timeout_sec=3600.0)
        return
    ping = node.create_publisher(String, f"{topic}_ping", 10)
    message = String(data=TEXT)
    times: list[int] = []
    began, count, pause_s = 0, 1, 0.0
    ended: Future[None] = Future(executor=executor)

    def send() -> None:
        nonlocal began
        timer.cancel()
        began = time.perf_counter_ns()
        ping.publish(message)

    def on_pong(_: Any) -> None:
        if ended.done():  # by another answer to the first pings
            return
        times.append(time.perf_counter_ns() - began)
        if len(times) == count:
            ended.set_result(None)
        elif pause_s:
            timer.reset()
        else:
            send()

    timer = node.create_timer(0.01, send)
    timer.cancel()
    node.create_subscription(String, f"{topic}_pong", on_pong, 10)
    while not ended.done():  # until the echo has found this process
        send()
        executor.spin_until_future_complete(ended, timeout_sec=FIRST_S)
    while (turn := next_turn()) is not None:
        count, pause_s = turn
        times.clear()
        if count:
            ended = Future(executor=executor)
            send()
            executor.spin_until_future_complete(ended, timeout_sec=LIMIT_S)
        tell(times)
    os._exit(0)  # EventsExecutor may keep its node alive


def end_with_stdin() -> None:
    """End the process when stdin is closed."""
    sys.stdin.read()
    os._exit(0)


# Stress


def stress(seconds: float) -> None:
    """Print the results of messages in both directions between two processes.

    A third process, whose loop does nothing, shows which stalls are the machine's.
    """
    parts = [start("stress", str(seconds)), start("stress", str(seconds))]
    idle = start("idle", str(seconds))
    for part in (*parts, idle):
        output, _ = part.communicate(timeout=seconds + 90)
        print(output, end="")


class Gaps:
    """How late the loop was, repeatedly, in milliseconds.

    Time that the thread waited for a processor, as counted by Linux, is known separately.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._found: list[float] = []
        self._own: list[float] = []
        self._handle: asyncio.TimerHandle | None = None
        self._waited = os.open("/proc/thread-self/schedstat", os.O_RDONLY)

    def _waited_ms(self) -> float:
        """Return how long this thread has waited for a processor."""
        return int(os.pread(self._waited, 100, 0).split()[1]) / 1e6

    def watch(self) -> None:
        """Check every millisecond from now on."""
        self._handle = self._loop.call_later(
            0.001, self._look, time.perf_counter() + 0.001, self._waited_ms()
        )

    def _look(self, due: float, waited_ms: float) -> None:
        late = (time.perf_counter() - due) * 1e3
        self._found.append(late)
        self._own.append(late - (self._waited_ms() - waited_ms))
        self.watch()

    def end(self) -> str:
        """Stop checking, and return the results."""
        if self._handle is not None:
            self._handle.cancel()
        text = []
        for name, values in (("", self._found), ("without waiting for a processor ", self._own)):
            found = sorted(values)
            p99 = found[len(found) * 99 // 100]
            p50 = statistics.median(found)
            text.append(f"{name}p50 {p50:.1f}, p99 {p99:.1f}, max {found[-1]:.1f} ms")
        return f"loop late by {', '.join(text)}"


async def idle_part(seconds: float) -> None:
    """Print how late an idle loop is."""
    gaps = Gaps(asyncio.get_running_loop())
    gaps.watch()
    await asyncio.sleep(seconds)
    print(f"an idle process beside: {gaps.end()}", flush=True)


def resident_kb() -> int:
    """Return the memory that this process has now."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * resource.getpagesize() // 1024


class Stream:
    """Numbered messages of one size in both directions, each of which has to arrive.

    Each size has its own topic: Fast DDS never shrinks the buffers of a topic, so that large
    messages among small ones would make all of them grow.
    """

    def __init__(self, node: Any, size: int) -> None:
        from aionode.interfaces.std_msgs.msg import UInt8MultiArray
        from aionode.qos import HistoryPolicy, QoSProfile

        self._type = UInt8MultiArray
        self._rest = bytes(size)
        self._own = os.getpid().to_bytes(4, "little")
        profile = QoSProfile(history=HistoryPolicy.KEEP_ALL)
        self.publisher = node.create_publisher(UInt8MultiArray, f"stress_{size}", profile)
        self._reader = node.create_subscription(UInt8MultiArray, f"stress_{size}", None, profile)
        self.sent = 0
        self.wrong = 0
        self.last: dict[bytes, int] = {}

    def send(self) -> None:
        """Send one message."""
        data = self._own + self.sent.to_bytes(8, "little") + self._rest
        self.publisher.publish(self._type(data=data))
        self.sent += 1

    async def read(self) -> None:
        """Read, and count messages out of order."""
        async for msg in self._reader:
            data = bytes(msg.data)
            sender, number = data[:4], int.from_bytes(data[4:12], "little")
            self.wrong += number != self.last.get(sender, -1) + 1
            self.last[sender] = number

    def __str__(self) -> str:
        received = {int.from_bytes(key, "little"): number + 1 for key, number in self.last.items()}
        return (
            f"{12 + len(self._rest)} bytes: sent {self.sent}, received {received}, "
            f"out of order or lost {self.wrong}"
        )


async def stress_part(seconds: float) -> None:
    """Publish as fast as the other side reads, and read; print the results and what was slow."""
    from aionode import Context, Node, freeze_objects

    async with (
        Context(transport="rcl") as context,
        Node(f"stress{os.getpid()}", context=context) as node,
    ):
        small, large = streams = Stream(node, 100), Stream(node, 100_000)
        reading = [asyncio.ensure_future(one.read()) for one in streams]
        for one in streams:
            await one.publisher.wait_for_subscribers(2)
        await asyncio.sleep(1.0)
        freeze_objects()  # as `aionode.run` does a second after the start
        gaps = Gaps(asyncio.get_running_loop())
        gaps.watch()
        memory: list[int] = []
        began = time.perf_counter()
        while (now := time.perf_counter() - began) < seconds:
            small.send()
            if small.sent % 1000 == 0:
                large.send()
            if small.sent % 50 == 0:
                for one in streams:
                    await one.publisher.drain()
            if now > seconds * (len(memory) + 1) / 6:
                memory.append(resident_kb())
        for one in streams:
            await one.publisher.drain()
        late = gaps.end()
        before: list[dict[bytes, int]] = []
        while before != [one.last for one in streams]:  # the other side may still send for a while
            before = [dict(one.last) for one in streams]
            await asyncio.sleep(2.0)
        for task in reading:
            task.cancel()
        print(
            f"{os.getpid()}: {small}; {large}; {late}; memory "
            f"{', '.join(f'{one / 1024:.0f}' for one in memory)} MB",
            flush=True,
        )


if __name__ == "__main__":
    main()
