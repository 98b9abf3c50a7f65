"""A robot and its clients' sessions in one process, with time controlled by a test."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from aionode.engine.context import Context
from aionode.gateway import Identity, Policy, Session
from aionode.gateway.session.audit import Audit
from aionode.gateway.session.robot import Robot
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import ManualClock, local_context, settle


class Bench:
    """A node of the robot, a gateway without a server, and its clients."""

    def __init__(self, clock: ManualClock, context: Context, node: Node, robot: Robot) -> None:
        self.clock = clock
        self.context = context
        self.node = node
        self.robot = robot
        self.lines: list[str] = []

    def allow(self, policy: str) -> None:
        """Apply a policy, given as the text of its file."""
        self.robot.policy = Policy.parse(policy)

    def session(self, name: str = "guest", *groups: str, kind: str = "test") -> Session:
        """Return the session of a client."""
        return Session(self.robot, Identity(name, frozenset(groups), "127.0.0.1"), kind)

    async def advance(self, seconds: float) -> None:
        """Advance the time."""
        await self.clock.advance(seconds)
        await settle()


@asynccontextmanager
async def bench_of_gateway() -> AsyncIterator[Bench]:
    """Yield a gateway that allows everything."""
    clock = ManualClock()
    async with (
        local_context(clock=clock) as context,
        Node("robot", context=context) as node,
        Node("gateway", context=context) as own,
        asyncio.TaskGroup() as tasks,
    ):
        audit = Audit(own)
        robot = Robot(own, Policy.default(allow_write=True), audit, tasks)
        made = Bench(clock, context, node, robot)

        def note(line: Any) -> None:
            made.lines.append(line.data)

        node.create_subscription(String, "/gateway/audit", note, 1000)
        yield made
        robot.close()
