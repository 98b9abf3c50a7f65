"""How well a policy drives that takes its time: ``.venv/bin/python benchmarks/learn_policy.py``.

A policy that follows a curve of ±1 rad/s answers observations at 30 Hz in a thread, and the wheels
compare each command with the curve at its arrival. It prints, for latencies and chunks, what was
sent in four seconds, the periods without an action, and the mean and the largest error.
"""

from __future__ import annotations

import asyncio
import math
import time
from typing import Any

import numpy as np

from aionode import Context, Node
from aionode.errors import LeaseExpiredError, PolicyTooSlowError, StaleError
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.learn import Contract

FPS = 30
SECONDS = 4.0
CASES = ((0.01, 16), (0.12, 16), (0.3, 21), (0.3, 16), (0.7, 16))
"""Seconds of latency, and actions of a chunk."""

CONTRACT = Contract.from_dict({
    "fps": FPS,
    "observations": [
        {
            "feature": "observation.state",
            "topic": "/joint_states",
            "type": "sensor_msgs/msg/JointState",
            "fields": ["position[0]"],
        }
    ],
    "actions": [
        {
            "feature": "action",
            "topic": "/cmd_vel",
            "type": "geometry_msgs/msg/Twist",
            "fields": ["angular.z"],
            "stop": "zero",
            "lease_sec": 0.2,
        }
    ],
})  # fmt: skip


def curve(time_s: float) -> float:
    """Return what the policy wants at a time, in rad/s."""
    return math.sin(1.2 * time_s)


async def drive(latency_s: float, length: int) -> str:
    """Let the policy drive, and return a row of the table."""
    errors: list[float] = []
    async with (
        Context() as context,
        Node("robot", context=context) as node,
        Node("wheels", context=context) as wheels,
    ):
        began_s = time.monotonic()
        joints = node.create_publisher(JointState, "/joint_states", 1)

        def show() -> None:
            state = JointState(name=["time"], position=[time.monotonic() - began_s])
            state.header.stamp = node.get_clock().now().to_msg()
            joints.publish(state)

        def take(command: Twist) -> None:
            errors.append(abs(command.angular.z - curve(time.monotonic() - began_s)))

        def policy(seen: dict[str, Any]) -> Any:
            time.sleep(latency_s)
            since_s = float(seen["observation.state"][0])
            return np.array([[curve(since_s + step / FPS)] for step in range(1, length + 1)])

        node.create_timer(1 / FPS, show)
        wheels.create_subscription(Twist, "/cmd_vel", take, 100)
        ended = ""
        try:
            async with CONTRACT.act(node) as actor, asyncio.timeout(SECONDS + latency_s):
                stats = actor.stats
                await actor.run(policy)
        except (LeaseExpiredError, PolicyTooSlowError, StaleError) as error:
            ended = f"; {type(error).__name__}"
        except TimeoutError:
            ended = ""
    found = errors[1:-1]  # the first applies since up to a period, the last one stops
    shown = f"{sum(found) / len(found):.4f} / {max(found):.3f} rad/s" if found else "none"
    return (
        f"| {latency_s * 1e3:.0f} ms | {length / FPS:.2f} s | {stats.sent} | {stats.underruns} "
        f"| {shown}{ended} |"
    )


async def main() -> None:
    """Print the table."""
    print("| latency | chunk | sent in 4 s | underruns | error, mean / max |")
    print("| --- | --- | --- | --- | --- |")
    for latency_s, length in CASES:
        print(await drive(latency_s, length), flush=True)


if __name__ == "__main__":
    asyncio.run(main())
