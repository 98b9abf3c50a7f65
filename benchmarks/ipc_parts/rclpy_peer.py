"""The same round trips with rclpy, where it is installed."""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from contextlib import AsyncExitStack
from typing import Final

from benchmarks.ipc_parts.common import RCLPY, TEXT, Child, Run, child
from benchmarks.ipc_parts.round_trips import Player

RCLPY_S: Final = 600.0
"""Longer than a measurement, which has its own limit."""


class RclpyBall:
    """A process with rclpy, which plays with another one."""

    def __init__(self, player: Child) -> None:
        self._player = player

    async def play(self, count: int, pause_s: float) -> list[int]:
        """Return the times of some round trips in nanoseconds, with a sleep before each."""
        times: list[int] = await self._player.ask(f"{count} {pause_s}")
        return times


def rclpy_process(part: str) -> None:
    """Play, or echo, until stdin is closed."""
    import std_msgs.msg

    import rclpy  # from a ROS installation, like the next ones
    from rclpy.experimental.events_executor import (
        EventsExecutor,
    )
    from rclpy.task import Future

    rclpy.init()
    node = rclpy.create_node(part.replace("-", "_"))
    executor = EventsExecutor()
    executor.add_node(node)
    message = std_msgs.msg.String(data=TEXT)
    if part == "rclpy-echo":
        pongs = node.create_publisher(std_msgs.msg.String, "rclpy_pong", 10)
        node.create_subscription(std_msgs.msg.String, "rclpy_ping", pongs.publish, 10)
        print('"ready"', flush=True)
        threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
        # Without a limit it uses a whole core and calls nothing.
        executor.spin_until_future_complete(Future(), timeout_sec=RCLPY_S)
        return
    pings = node.create_publisher(std_msgs.msg.String, "rclpy_ping", 10)
    times: list[int] = []
    left, began_ns = 0, 0
    done: Future[None] = Future()

    def throw() -> None:
        nonlocal began_ns
        began_ns = time.perf_counter_ns()
        pings.publish(message)

    def back(_: object) -> None:
        nonlocal left
        times.append(time.perf_counter_ns() - began_ns)
        left -= 1
        if left:
            throw()
        else:
            done.set_result(None)

    def go(count: int) -> None:
        nonlocal left, done
        left, done = count, Future()
        throw()
        executor.spin_until_future_complete(done, timeout_sec=RCLPY_S)

    node.create_subscription(std_msgs.msg.String, "rclpy_pong", back, 10)
    while not (pings.get_subscription_count() and node.count_publishers("rclpy_pong")):
        time.sleep(0.1)
    print('"ready"', flush=True)
    for line in sys.stdin:
        count, pause_s = line.split()
        times.clear()
        if float(pause_s):
            for _ in range(int(count)):
                time.sleep(float(pause_s))
                go(1)
        else:
            go(int(count))
        print(json.dumps(times), flush=True)


def has_rclpy() -> bool:
    """Return whether rclpy and its events executor can be imported here."""
    try:
        import rclpy.experimental.events_executor  # noqa: F401
    except ImportError:
        return False
    return True


async def rclpy_ball(place: Run, stack: AsyncExitStack) -> dict[str, Player]:
    """Return rclpy's ball, if rclpy is installed."""
    if not has_rclpy():
        return {}
    await stack.enter_async_context(child("rclpy-echo", place))
    return {RCLPY: RclpyBall(await stack.enter_async_context(child("rclpy-ping", place)))}
