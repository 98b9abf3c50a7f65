"""The program of a process that commands motion: ``python -m tests.faults.motion.mover ROLE``.

A line ``move`` on stdin makes it start, or start again; each other line causes trouble:
``fail``, ``exit``, ``sleep SECONDS`` and ``compute SECONDS``; of a policy, see
`tests.faults.motion.policy`.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
import time
from collections.abc import Callable
from typing import Any

import msgspec

import aionode
from aionode import ActionClient, Context, Node, Publisher
from aionode.endpoints.lease import CommandLease
from aionode.errors import LeaseExpiredError
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.test_msgs.action import Fibonacci
from tests.faults.motion.policy import Policy, compute
from tests.faults.motion.wheels import command, profile
from tests.faults.process import Reporter
from tests.faults.roles import Role

__all__: list[str] = []


class MoverNode(Node):
    """The node of a mover, with the publisher or client with which it commands."""

    def __init__(self, role: Role, reporter: Reporter, context: Context) -> None:
        super().__init__(
            role.name, context=context, enable_rosout=False, start_parameter_services=False
        )
        assert role.mover is not None
        self.mover = mover = role.mover
        self.reporter = reporter
        self.client: ActionClient[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback] | None
        self.publisher: Publisher[Twist] | None = None
        self.policy: Policy | None = None
        if mover.asks in {"goal", "goal left"}:
            self.client = self.create_action_client(Fibonacci, mover.topic)
        elif mover.asks in {"policy", "policy apart"}:
            self.policy = Policy(self, mover)
        else:
            self.publisher = self.create_publisher(Twist, mover.topic, profile(mover))
        self.begin = asyncio.Event()
        os.set_blocking(sys.stdin.fileno(), False)
        asyncio.get_running_loop().add_reader(sys.stdin, self.obey)
        reporter.nodes = self.get_node_names
        reporter.report.ready = True

    # Troubles

    def obey(self) -> None:
        """Start, or cause the trouble that a line of stdin names, in a callback of the node."""
        word, _, seconds = sys.stdin.readline().strip().partition(" ")
        troubles: dict[str, Callable[[], None]] = {
            "fail": fail,
            "exit": lambda: os._exit(3),
            "sleep": lambda: time.sleep(float(seconds)),
            "compute": lambda: compute(float(seconds)),
        }
        if word == "move":
            self.begin.set()
        elif word in troubles:
            self.create_timer(0.0, once(troubles[word]))
        elif self.policy is not None and word in self.policy.troubles:
            self.policy.troubles[word](float(seconds))
        else:
            asyncio.get_running_loop().remove_reader(sys.stdin)

    # Motion

    async def move_when_told(self) -> None:
        """Command motion after the line on stdin, until cancelled."""
        await self.begin.wait()
        await self.move()

    async def move(self) -> None:
        """Command motion until cancelled."""
        match self.mover.asks:
            case "lease":
                await self.hold_leases()
            case "publisher":
                await self.publish()
            case "finally":
                assert self.publisher is not None
                try:
                    await self.publish()
                finally:
                    await asyncio.sleep(self.mover.cleans_up_s)
                    self.publisher.publish(Twist())
            case "goal" | "goal left":
                await self.send_goals()
            case "policy" | "policy apart":
                assert self.policy is not None
                await self.policy.move()

    async def publish(self) -> None:
        """Publish commands."""
        assert self.publisher is not None
        await self.publisher.wait_for_subscribers()
        while True:
            self.publisher.publish(command())
            await asyncio.sleep(self.mover.period_s)

    async def hold_leases(self) -> None:
        """Publish commands under a lease; if it expires, under another one on request."""
        assert self.publisher is not None
        await self.publisher.wait_for_subscribers()
        while True:
            lease = self.publisher.lease(stop=Twist(), ttl_sec=self.mover.ttl_sec)
            with contextlib.suppress(LeaseExpiredError):
                async with lease:
                    await self.publish_under(lease)
            self.begin.clear()
            while not self.begin.is_set():  # a program that does not know better
                with contextlib.suppress(LeaseExpiredError):
                    lease.publish(command())
                await asyncio.sleep(self.mover.period_s)

    async def publish_under(self, lease: CommandLease[Twist]) -> None:
        """Publish commands until cancelled, and a few more."""
        try:
            while True:
                lease.publish(command())
                await asyncio.sleep(self.mover.period_s)
        finally:
            ends_s = time.monotonic() + self.mover.cleans_up_s
            while time.monotonic() < ends_s:
                lease.publish(command())
                await asyncio.sleep(self.mover.period_s)

    async def send_goals(self) -> None:
        """Send a goal and wait for its end; then another one on request."""
        assert self.client is not None
        await self.client.wait_for_server()
        while True:
            goal = await self.client.send_goal(Fibonacci.Goal(order=os.getpid()))
            if self.mover.asks == "goal":
                await goal.result()
            self.begin.clear()
            await self.begin.wait()


def fail() -> None:
    """Fail."""
    raise RuntimeError("the sensor is broken")


def once(callback: Callable[[], Any]) -> Callable[[], Any]:
    """Return a callback that runs an action on its first call."""
    left = [callback]
    return lambda: left.pop()() if left else None


# Programs


def by_run(role: Role, reporter: Reporter) -> None:
    """Move in a callback of a node that `aionode.run` runs."""

    async def move() -> None:
        async with Context() as context:
            node = MoverNode(role, reporter, context)
            node.create_timer(0.0, once(node.move_when_told))
            await node.run()

    aionode.run(move, reporter.go_on, args=[])


def by_asyncio(role: Role, reporter: Reporter) -> None:
    """Move in the body of ``async with node``, in a program that handles no signals itself."""

    async def main() -> None:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(reporter.go_on())
            async with Context() as context, MoverNode(role, reporter, context) as node:
                await node.move_when_told()

    asyncio.run(main())


def old_signals() -> None:
    """End at SIGHUP, and at any second signal, without cleanup."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    arrived: list[int] = []
    original = signal.signal

    def set_handler(number: int, handler: object) -> object:
        if number == signal.SIGHUP or not callable(handler):
            return signal.getsignal(number)

        def first_or_last(each: int, frame: object) -> None:
            arrived.append(each)
            if len(arrived) > 1:
                os._exit(128 + each)
            handler(each, frame)

        return original(number, first_or_last)

    signal.signal = set_handler  # type: ignore[assignment]  # for this comparison alone


def main() -> None:
    """Move until stopped."""
    role = msgspec.json.decode(sys.argv[1], type=Role)
    assert role.mover is not None
    if role.mover.old_signals:
        old_signals()
    reporter = Reporter()
    if role.mover.program == "page":
        from tests.faults.motion.gateway import drive  # it needs no node

        drive(role.mover, reporter)
    elif role.mover.program == "uvicorn":
        from tests.faults.motion.web import serve  # what it imports is not everywhere

        serve(role.mover, lambda context: MoverNode(role, reporter, context), reporter.go_on())
    else:
        {"run": by_run, "asyncio": by_asyncio}[role.mover.program](role, reporter)


if __name__ == "__main__":
    main()
