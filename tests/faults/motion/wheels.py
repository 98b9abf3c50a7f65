"""The process of a fault case that has the wheels of robots."""

from __future__ import annotations

import asyncio
import importlib
import os
import time
from collections.abc import Callable
from typing import Any

from aionode import CancelResponse, Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.test_msgs.action import Fibonacci
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.faults.motion.words import Handed, Mover, What, Wheel
from tests.faults.roles import Report

__all__ = ["NEAR", "Wheels", "command", "move", "profile"]

STEP_S = 0.05
"""How often a goal moves the wheels."""

FAR, NEAR = 1.0, 0.03
"""Distances of a target."""


def own(kind: str, name: str) -> Any:
    """Return a type of a package that only wheels and their movers have."""
    return getattr(importlib.import_module(f"aionode.interfaces.minibot_interfaces.{kind}"), name)


def profile(each: Mover | Wheel) -> QoSProfile:
    """Return the profile of commands; of kept ones, only the last counts."""
    if each.transient:
        return QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return QoSProfile(depth=10)


def command() -> Twist:
    """Return a command to move, with its sender and time."""
    return Twist(linear=Vector3(x=1.0, y=time.monotonic()), angular=Vector3(x=float(os.getpid())))


async def move(node: Node, wheel: Wheel) -> None:
    """Move wheels until cancelled."""
    if wheel.action:
        approach = own("action", "Approach") if wheel.has_defaults else None
        client = node.create_action_client(approach or Fibonacci, wheel.topic)
        await client.wait_for_server()
        if approach is None:
            await client.call(Fibonacci.Goal(order=os.getpid()))
        else:
            await client.call(approach.Goal(by=os.getpid(), tolerance=0.0))
    drive = own("msg", "Drive") if wheel.has_defaults else None
    publisher = node.create_publisher(drive or Twist, wheel.topic, profile(wheel))
    while True:
        publisher.publish(command() if drive is None else drive(by=os.getpid()))
        await asyncio.sleep(STEP_S)


class Wheels:
    """The wheels of a process.

    Args:
        node: Its node.
        report: Records what they receive.
        tell: Called when they are told to stop, so that the harness learns it at once.

    Attributes:
        distance: How far their target is.
    """

    def __init__(self, node: Node, report: Report, tell: Callable[[], None]) -> None:
        self.distance = FAR
        self._node = node
        self._report = report
        self._tell = tell

    def attach(self, wheel: Wheel) -> None:
        """Make a wheel obey."""
        if wheel.has_defaults:
            (self._approach if wheel.action else self._drive)(wheel.topic)
        else:
            (self._serve if wheel.action else self._subscribe)(wheel)

    def _note(self, topic: str, what: What, by: int = 0, sent_s: float = 0.0) -> None:
        self._report.handed.append(Handed(topic, what, time.monotonic(), by, sent_s))
        if what != "move":
            asyncio.get_running_loop().call_soon(self._tell)

    def _subscribe(self, wheel: Wheel) -> None:
        options: dict[str, Any] = {}
        if wheel.silence_sec:
            options = {
                "on_silence": lambda: self._note(wheel.topic, "silence"),
                "silence_sec": wheel.silence_sec,
            }

        def take(msg: Twist) -> None:
            what: What = "stop" if msg.linear.x == 0.0 else "move"
            self._note(wheel.topic, what, int(msg.angular.x), msg.linear.y)

        self._node.create_subscription(Twist, wheel.topic, take, profile(wheel), **options)

    def _serve(self, wheel: Wheel) -> None:
        options: dict[str, Any] = {}
        if wheel.lost_sec:
            options = {"on_client_lost": "cancel", "client_lost_sec": wheel.lost_sec}
        elif wheel.continues:
            options = {"on_client_lost": "continue"}
        if wheel.accepts:
            options["cancel_callback"] = lambda _: CancelResponse.ACCEPT

        async def drive(goal: Any) -> Fibonacci.Result:
            by = int(goal.request.order)
            try:
                while True:
                    self._note(wheel.topic, "move", by, time.monotonic())
                    goal.publish_feedback(Fibonacci.Feedback(sequence=[1]))
                    await asyncio.sleep(STEP_S)
            finally:
                self._note(wheel.topic, "stop", by)

        self._node.create_action_server(
            Fibonacci,
            wheel.topic,
            drive,
            **options,
        )

    def _approach(self, topic: str) -> None:
        approach = own("action", "Approach")

        async def drive(goal: Any) -> Any:
            by = goal.request.by
            try:
                while self.distance > goal.request.tolerance:
                    self._note(topic, "move", by, time.monotonic())
                    await asyncio.sleep(STEP_S)
            finally:
                self._note(topic, "stop", by)
            goal.succeed()
            return approach.Result()

        self._node.create_action_server(approach, topic, drive)

    def _drive(self, topic: str) -> None:
        end: asyncio.TimerHandle | None = None

        def take(msg: Any) -> None:
            nonlocal end
            if end is not None:
                end.cancel()
                end = None
            self._note(topic, "move" if msg.speed else "stop", msg.by)
            if msg.for_sec:
                loop = asyncio.get_running_loop()
                end = loop.call_later(msg.for_sec, self._note, topic, "stop")

        self._node.create_subscription(own("msg", "Drive"), topic, take, 10)
