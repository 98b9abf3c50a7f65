"""A policy that moves wheels: chunks of 0.5 s, by an actor of `aionode.learn`."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
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
        self._executor: ProcessPoolExecutor | None = None
        self._process = 0
        if mover.asks == "policy apart":
            self._executor = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"))
            self._process = self._executor.submit(os.getpid).result()

    @property
    def troubles(self) -> dict[str, Callable[[float], None]]:
        """Functions that cause trouble for some seconds, by keyword."""
        return {
            "hang": lambda seconds: self._run_into(lambda: threading.Event().wait(seconds)),
            "think": lambda seconds: self._run_into(lambda: compute(seconds)),
            "slow": lambda seconds: self._run_into(lambda: time.sleep(seconds), again=True),
            "blind": lambda _: self._eyes.cancel(),
            "kill": lambda _: os.kill(self._process, signal.SIGKILL),
            "freeze": self._freeze,
        }

    def _freeze(self, seconds: float) -> None:
        os.kill(self._process, signal.SIGSTOP)
        asyncio.get_running_loop().call_later(seconds, os.kill, self._process, signal.SIGCONT)

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
        return chunk(os.getpid())

    async def move(self) -> None:
        """Move wheels until cancelled, or until the robot was stopped."""
        answer = self._answer if self._executor is None else answer_apart
        with suppress(LeaseExpiredError, StaleError, BrokenProcessPool):
            async with self._contract.act(self._node) as actor:
                await actor.run(answer, executor=self._executor)


def answer_apart(_seen: dict[str, Any]) -> Any:
    """Answer in another process, in the name of the one that moves the wheels."""
    return chunk(os.getppid())


def chunk(by: int) -> Any:
    """Return commands that contain their time and process."""
    now_s = time.monotonic()
    return np.array([(1.0, now_s + step / FPS, by) for step in range(1, CHUNK + 1)])


def compute(seconds: float) -> None:
    """Hold the processor and the GIL."""
    ends_s = time.monotonic() + seconds
    while time.monotonic() < ends_s:
        pass
