"""One end of an action for tests, in a process of its own; it prints what happens.

``python tests/end_to_end/action_member.py server`` serves /count and prints ``open``,
``executing`` and ``ended STATUS``; for a word on stdin it prints ``WORD GOALS RESULTS REQUESTS``,
the sizes of its tables. ``… server cancel`` cancels the goals of lost clients. ``… client STEPS``
sends one goal of that many steps and prints ``open``, ``ready``, ``accepted``, ``feedback N``,
``result STATUS TEXT``, ``error TYPE: TEXT``, and ``tables GOALS``. ``… blocked`` sends an endless
goal, prints ``blocks``, and blocks its loop. ``… impatient SECONDS`` calls with an endless goal,
abandons the call after that many seconds, as anyio and web servers do, and ends at once.
"""

from __future__ import annotations

import asyncio
import sys
import time  # noqa: TID251  # to block
from typing import Any

import anyio

import aionode
from aionode import CancelResponse, Node, ServerGoalHandle
from aionode.errors import GoalError
from aionode.interfaces.example_interfaces.action import Fibonacci

STEP_SEC = 0.02
RESULT_TIMEOUT_SEC = 0.2
CLIENT_LOST_SEC = 0.6


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


class Counter(Node):
    """Counts as far as a goal requests; fails on the way to 13."""

    def __init__(self) -> None:
        super().__init__("counter", enable_rosout=False, start_parameter_services=False)
        self.server = self.create_action_server(
            Fibonacci,
            "/count",
            self.count,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
            result_timeout=RESULT_TIMEOUT_SEC,
            on_client_lost="cancel" if sys.argv[2:] == ["cancel"] else "continue",
            client_lost_sec=CLIENT_LOST_SEC,
        )

    async def count(self, goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
        """Count, slowly."""
        tell("executing")
        try:
            for number in range(1, goal.request.order + 1):
                await self.get_clock().sleep(STEP_SEC)
                if number == goal.request.order == 13:
                    raise ValueError("thirteen")
                goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
            goal.succeed()
        except asyncio.CancelledError:
            tell("ended", "CANCELED" if goal.is_cancel_requested else "otherwise")
            raise
        tell("ended", goal.status.name)
        return Fibonacci.Result(sequence=[goal.request.order])

    async def obey(self) -> None:
        """Print the sizes of the tables on request."""
        lines: asyncio.Queue[str] = asyncio.Queue()
        loop = asyncio.get_running_loop()
        loop.add_reader(sys.stdin, lambda: lines.put_nowait(sys.stdin.readline()))
        while word := (await lines.get()).strip():
            server = self.server
            requests = sum(
                len(announced.unanswered)
                for part in server._parts
                for announced in getattr(part, "_announcements", ())
            )
            tell(word, len(server._goals), int(server._goals._alarm is not None), requests)
        loop.remove_reader(sys.stdin)


async def serve() -> None:
    """Run as the server until a signal."""
    async with Counter() as node:
        tell("open")
        await node.obey()


async def ask() -> None:
    """Run as the client of one goal."""
    async with Node("asking", enable_rosout=False, start_parameter_services=False) as node:
        tell("open")
        client = node.create_action_client(Fibonacci, "/count")
        await client.wait_for_server()
        tell("ready")
        goal = await client.send_goal(Fibonacci.Goal(order=int(sys.argv[2])))
        tell("accepted")
        try:
            async for feedback in goal:
                tell("feedback", feedback.sequence[0])
            outcome = await goal.result()
            tell("result", outcome.status.name, outcome.error_text)
        except GoalError as error:
            tell("error", f"{type(error).__name__}:", error)
        tell("tables", len(client._goals))


async def leave() -> None:
    """Run as a client that does not wait for the end of its goal."""
    async with Node("asking", enable_rosout=False, start_parameter_services=False) as node:
        client = node.create_action_client(Fibonacci, "/count")
        await client.wait_for_server()
        with anyio.move_on_after(float(sys.argv[2])):
            await client.call(Fibonacci.Goal(order=100_000))


async def block() -> None:
    """Run as a client whose loop is blocked by a callback."""
    async with Node("asking", enable_rosout=False, start_parameter_services=False) as node:
        client = node.create_action_client(Fibonacci, "/count")
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal(order=100_000))
        await anext(goal)
        tell("blocks")
        time.sleep(20)  # noqa: ASYNC251  # a callback that does so is what is tested


PARTS = {"server": serve, "client": ask, "impatient": leave, "blocked": block}

if __name__ == "__main__":
    aionode.run(PARTS[sys.argv[1]])
    tell("stopped")
