"""Round trips over DDS: aionode with ``transport="rcl"``, and rclpy with its two executors.

The same message (String, 16 bytes) between two processes, one after the other in turns, in the same
run; and a stress of both directions, in which nothing may be lost and the loop must not stall.
Needs an rclpy: ``pip install 'aionode[ros]'``, or a ROS 2 that is sourced.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import resource
import statistics
import subprocess
import sys
import time
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    pass

KINDS = ("rclpy-events", "aionode", "aionode-uvloop", "rclpy-default")
TEXT = "0123456789abcdef"


def main() -> None:
    """Measure, or play one part of a measurement."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=2, help="how often each is measured")
    parser.add_argument("--count", type=int, default=2000, help="tight round trips of each")
    parser.add_argument("--stress", type=float, default=0.0, help="seconds of stress instead")
    parser.add_argument("--part", nargs=3, help=argparse.SUPPRESS)
    options = parser.parse_args()
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
    if options.part:
        kind, role, value = options.part
        play(kind, role, value)
    elif options.stress:
        stress(options.stress)
    else:
        compare(options.rounds, options.count)


def start(kind: str, role: str, value: str = "") -> subprocess.Popen[str]:
    """Start one part in a process of its own."""
    command = [sys.executable, __file__, "--part", kind, role, value]
    pipe = subprocess.PIPE
    return subprocess.Popen(  # noqa: S603  # of this file
        command, stdin=pipe, stdout=pipe, text=True
    )


def compare(rounds: int, count: int) -> None:
    """Print a table of round trips."""
    found: dict[tuple[str, str], list[float]] = {}
    for _ in range(rounds):
        for kind in KINDS:
            echo = start(kind, "echo")
            player = start(kind, "player", str(count))
            output, _ = player.communicate(timeout=120)
            if echo.stdin is not None:
                echo.stdin.close()
            echo.wait(10)
            for line in output.splitlines():
                name, value = line.split()
                found.setdefault((kind, name), []).append(float(value))
    names = list(dict.fromkeys(name for _, name in found))
    print(f"{'':16}" + "".join(f"{name:>22}" for name in names))
    for kind in KINDS:
        cells = []
        for name in names:
            values = found.get((kind, name))
            if not values:
                cells.append(f"{'-':>22}")
                continue
            base = statistics.mean(found[KINDS[0], name])
            mean = statistics.mean(values)
            cells.append(f"{mean:>14.0f} ({mean / base:.2f})")
        print(f"{kind:16}" + "".join(f"{cell:>22}" for cell in cells))


def play(kind: str, role: str, value: str) -> None:
    """Play one part."""
    if role == "stress":
        asyncio.run(stress_part(float(value)))
    elif kind.startswith("rclpy"):
        rclpy_part(kind, role, value)
    elif kind == "aionode-uvloop":
        import uvloop

        uvloop.run(aionode_part(role, value))
    else:
        asyncio.run(aionode_part(role, value))


def report(name: str, times_ns: list[int]) -> None:
    """Print the median of some times."""
    print(f"{name}-p50-us {statistics.median(times_ns) / 1000:.0f}", flush=True)


async def aionode_part(role: str, value: str) -> None:
    """Echo until stdin is closed, or measure."""
    from aionode import Context, Node
    from aionode.interfaces.std_msgs.msg import String

    loop = asyncio.get_running_loop()
    async with Context(transport="rcl") as context, Node(role, context=context) as node:
        if role == "echo":
            pong = node.create_publisher(String, "pong", 10)
            node.create_subscription(String, "ping", pong.publish)
            ended = asyncio.Event()
            loop.add_reader(sys.stdin, ended.set)
            await ended.wait()
            return
        ping = node.create_publisher(String, "ping", 10)
        came = loop.create_future()

        def on_pong(_: Any) -> None:
            came.set_result(None)

        node.create_subscription(String, "pong", on_pong)
        await ping.wait_for_subscribers()
        await node.context.graph.until(lambda: bool(node.count_publishers("/pong")))
        await asyncio.wait([loop.create_future()], timeout=0.5)
        message = String(data=TEXT)
        for name, count, pause_s in (("tight", int(value), 0.0), ("100Hz", 200, 0.01)):
            times = []
            for _ in range(count):
                if pause_s:
                    await asyncio.wait([loop.create_future()], timeout=pause_s)
                came = loop.create_future()
                began = time.perf_counter_ns()
                ping.publish(message)
                await came
                times.append(time.perf_counter_ns() - began)
            report(name, times)


def rclpy_part(kind: str, role: str, value: str) -> None:  # noqa: C901  # callbacks
    """Echo until stdin is closed, or measure."""
    import threading

    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.experimental.events_executor import EventsExecutor
    from std_msgs.msg import String

    rclpy.init()
    node = rclpy.create_node(role)
    executor: Any = EventsExecutor() if kind == "rclpy-events" else SingleThreadedExecutor()
    executor.add_node(node)
    if role == "echo":
        pong = node.create_publisher(String, "pong", 10)
        node.create_subscription(String, "ping", pong.publish, 10)

        def wait() -> None:
            sys.stdin.read()
            os._exit(0)

        threading.Thread(target=wait, daemon=True).start()
        executor.spin()
        return
    ping = node.create_publisher(String, "ping", 10)
    plan = [("tight", int(value), 0.0), ("100Hz", 200, 0.01)]
    message = String(data=TEXT)
    times: list[int] = []
    state: dict[str, Any] = {"began": 0, "timer": None}

    def send() -> None:
        if state["timer"] is not None:
            state["timer"].cancel()
        state["began"] = time.perf_counter_ns()
        ping.publish(message)

    def on_pong(_: Any) -> None:
        times.append(time.perf_counter_ns() - state["began"])
        name, count, pause_s = plan[0]
        if len(times) == count:
            report(name, times)
            times.clear()
            plan.pop(0)
            if not plan:
                os._exit(0)
            pause_s = plan[0][2]
        if not pause_s:
            send()
        elif state["timer"] is None:
            state["timer"] = node.create_timer(pause_s, send)
        else:
            state["timer"].reset()

    node.create_subscription(String, "pong", on_pong, 10)
    while not (node.count_publishers("/pong") and ping.get_subscription_count()):
        time.sleep(0.01)
    time.sleep(0.5)
    send()
    executor.spin()


# Stress


def stress(seconds: float) -> None:
    """Print what came of messages in both directions between two processes."""
    parts = [start("aionode", "stress", str(seconds)) for _ in range(2)]
    for part in parts:
        output, _ = part.communicate(timeout=seconds + 60)
        print(output, end="")


async def stress_part(seconds: float) -> None:
    """Publish as fast as the other side reads, and read; print what came and what was slow."""
    from aionode import Context, Node
    from aionode.interfaces.std_msgs.msg import UInt8MultiArray
    from aionode.qos import HistoryPolicy, QoSProfile

    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    loop = asyncio.get_running_loop()
    async with (
        Context(transport="rcl") as context,
        Node(f"n{os.getpid()}", context=context) as node,
    ):
        writer = node.create_publisher(UInt8MultiArray, "stress", keep_all)
        reader = node.create_subscription(UInt8MultiArray, "stress", None, keep_all)
        last: dict[bytes, int] = {}
        wrong = received = 0
        gaps: list[float] = []

        def watch(before: float) -> None:
            now = time.perf_counter()
            gaps.append(now - before)
            loop.call_soon(loop.call_later, 0.001, watch, time.perf_counter())

        async def read() -> None:
            nonlocal wrong, received
            async for msg in reader:
                data = bytes(msg.data)
                sender, number = data[:4], int.from_bytes(data[4:12], "little")
                wrong += number != last.get(sender, -1) + 1
                last[sender] = number
                received += 1

        async with asyncio.TaskGroup() as tasks:
            reading = tasks.create_task(read())
            await writer.wait_for_subscribers(2)
            await asyncio.wait([loop.create_future()], timeout=1.0)
            own = os.getpid().to_bytes(4, "little")
            ends, number, rss = time.perf_counter() + seconds, 0, 0
            loop.call_soon(watch, time.perf_counter())
            while time.perf_counter() < ends:
                size = 100_000 if number % 1000 == 999 else 100
                writer.publish(
                    UInt8MultiArray(data=own + number.to_bytes(8, "little") + bytes(size))
                )
                number += 1
                if number % 50 == 0:
                    await writer.drain()
                if number == 5000:
                    rss = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            await writer.drain()
            await asyncio.wait([loop.create_future()], timeout=3.0)
            reading.cancel()
        growth = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - rss) / 1024
        gaps.sort()
        print(
            f"sent {number}, received {received} from {len(last)}, out of order or lost {wrong}, "
            f"last {sorted(last.values())}, "
            f"loop gap p99 {gaps[len(gaps) * 99 // 100] * 1e3:.1f} ms, "
            f"max {gaps[-1] * 1e3:.1f} ms, growth {growth:.1f} MB",
            flush=True,
        )


if __name__ == "__main__":
    main()
