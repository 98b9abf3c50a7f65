"""A policy that moves wheels: chunks of 0.5 s, by an actor of `aionode.learn`."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np

from aionode import Node
from aionode.errors import LeaseExpiredError, StaleError
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.learn import Contract
from tests.faults.motion.words import Mover

__all__ = ["Policy", "compute"]

FPS = 20
CHUNK = 10


class Policy:
    """A policy, and the trouble that it can run into.

    Args:
        node: The node with which it moves and observes.
        mover: Its description.
    """

    def __init__(self, node: Node, mover: Mover) -> None:
        self._node = node
        seen = f"{mover.topic}/seen"
        self._contract = Contract.from_dict(
            {
                "fps": FPS,
                "observations": [
                    {
                        "feature": "observation.state",
                        "topic": seen,
                        "type": "sensor_msgs/msg/JointState",
                        "fields": ["position[0]"],
                        "max_age": 0.2,
                    }
                ],
                "actions": [
                    {
                        "feature": "action",
                        "topic": mover.topic,
                        "type": "geometry_msgs/msg/Twist",
                        "fields": ["linear.x", "linear.y", "angular.x"],
                        "stop": "zero",
                        "lease_sec": mover.ttl_sec,
                    }
                ],
            }
        )
        self._states = node.create_publisher(JointState, seen, 1)
        self._eyes = node.create_timer(1 / FPS, self._show)
        self._trouble: Callable[[], object] | None = None

    @property
    def troubles(self) -> dict[str, Callable[[float], None]]:
        """Functions that cause trouble for some seconds, by keyword."""
        return {
            "hang": lambda seconds: self._run_into(lambda: threading.Event().wait(seconds)),
            "think": lambda seconds: self._run_into(lambda: compute(seconds)),
            "slow": lambda seconds: self._run_into(lambda: time.sleep(seconds), again=True),
            "blind": lambda _: self._eyes.cancel(),
        }

    def _run_into(self, trouble: Callable[[], object], *, again: bool = False) -> None:
        def once() -> None:
            if not again:
                self._trouble = None
            trouble()

        self._trouble = once

    def _show(self) -> None:
        state = JointState(name=["wheel"], position=[0.0])
        state.header.stamp = self._node.get_clock().now().to_msg()
        self._states.publish(state)

    def _answer(self, _seen: dict[str, Any]) -> Any:
        if self._trouble is not None:
            self._trouble()
        now_s = time.monotonic()
        return np.array([(1.0, now_s + step / FPS, os.getpid()) for step in range(1, CHUNK + 1)])

    async def move(self) -> None:
        """Move wheels until cancelled, or until the robot was stopped."""
        with suppress(LeaseExpiredError, StaleError):
            async with self._contract.act(self._node) as actor:
                await actor.run(self._answer)


def compute(seconds: float) -> None:
    """Hold the processor and the GIL."""
    ends_s = time.monotonic() + seconds
    while time.monotonic() < ends_s:
        pass
