"""A robot that can be moved, an assistant, and clients in this process and over HTTP."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any, Final

import mcp

from aionode.action import ActionServer
from aionode.gateway import Assistant, Gateway, Policy
from aionode.gateway.session.arrivals import HAS_WAITED
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import SetBool
from aionode.node import Node
from aionode.testing import local_context, settle

__all__ = ["POLICY", "Base", "Bench", "bench_of"]

POLICY: Final = """
[[who]]
name = "model"
loopback = true

[[who]]
name = "other"
token = "of-another"

[[allow]]
see = "/**"
subscribe = "/**"

[[allow]]
publish = "/cmd_vel"
fields = { "linear.x" = { min = -0.5, max = 0.5 } }
lease = { ttl_sec = 0.3 }

[[allow]]
publish = "/says"

[[allow]]
call = "/switch"
goal = "/count"
parameter = "/base:*"
"""


class Base(Node):
    """A robot that records its commands, with a service, an action, a parameter and a text."""

    def __init__(self, **options: Any) -> None:
        super().__init__("base", **options)
        self.commands: list[float] = []
        self.heard: list[str] = []
        self.switched: list[bool] = []
        self.goals: list[str] = []
        self.has_commands = asyncio.Event()
        self.speed = self.declare_parameter("speed", 0.5)
        self.create_subscription(Twist, "/cmd_vel", self.obey, 10)
        self.create_subscription(String, "/says", lambda text: self.heard.append(text.data), 10)
        self.text = self.create_publisher(String, "/text", 10)
        self.create_service(SetBool, "/switch", self.switch)
        self.counting = ActionServer(self, Fibonacci, "/count", self.count)

    def obey(self, command: Twist) -> None:
        """Note a command."""
        self.commands.append(command.linear.x)
        self.has_commands.set()

    def switch(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Note a call."""
        self.switched.append(request.data)
        response.success, response.message = True, "x" * 100_000 if request.data else "off"
        return response

    async def count(self, handle: Any) -> Fibonacci.Result:
        """Count until the goal is cancelled, and record its end; an order of 0 ends at once."""
        self.goals.append("begun")
        self.has_commands.set()
        try:
            number = 0
            while number < handle.request.order:
                handle.publish_feedback(Fibonacci.Feedback(sequence=[number]))
                await self.pause(0.02)
                number += 1
            handle.succeed()
            self.goals.append("done")
            return Fibonacci.Result(sequence=[number])
        except asyncio.CancelledError:
            self.goals.append("cancelled")
            raise

    async def pause(self, seconds: float) -> None:
        """Wait by the node's clock."""
        await self.get_clock().sleep(seconds)


class Client(mcp.Client):
    """A client that sends a call again if it may have waited while the gateway was stalled.

    On a busy computer, any call may have; a refused one was not carried out.

    Attributes:
        repeats: How often it has done so.
    """

    repeats = 0

    async def call_tool(self, *arguments: Any, **options: Any) -> Any:
        """Call a tool."""
        while True:
            result: Any = await super().call_tool(*arguments, **options)
            if not result.is_error or HAS_WAITED not in result.content[0].text:
                return result
            self.repeats += 1


class Bench:
    """A robot, what serves it, and clients.

    Attributes:
        base: The robot.
        served: The assistant or gateway.
        clients: Its clients.
        audit: The lines of the audit log.
    """

    def __init__(self, base: Base, served: Assistant | Gateway, tasks: asyncio.TaskGroup) -> None:
        self.base = base
        self.served = served
        self.clients = served.clients
        self.audit: list[dict[str, Any]] = []
        self.closing = asyncio.Event()
        self._tasks = tasks
        base.create_subscription(
            String, "/mcp/audit", lambda line: self.audit.append(json.loads(line.data)), 1000
        )

    async def connect(self, mode: str = "auto", **options: Any) -> Any:
        """Return a client that stays connected until the test ends.

        It runs in a task of its own, since its context has to be left in the task that entered it.
        """
        connected: asyncio.Future[Any] = asyncio.get_running_loop().create_future()

        async def stay() -> None:
            made = Client(self.target(), mode=mode, **options)
            async with made as client:
                connected.set_result(client)
                await self.closing.wait()

        self._tasks.create_task(stay())
        return await connected

    def target(self) -> Any:
        """Return the target to which a client connects."""
        if isinstance(self.served, Gateway):
            return f"http://127.0.0.1:{self.served.port}/mcp"
        return self.served.server

    def use(self, policy: str) -> None:
        """Apply another policy."""
        self.clients.use_policy(Policy.parse(policy))


@asynccontextmanager
async def bench_of(
    policy: str = POLICY, *, over_http: bool = False, **options: Any
) -> AsyncIterator[Bench]:
    """Yield a robot with an assistant, in this process or over HTTP."""
    async with (
        local_context() as context,
        Base(context=context) as base,
        Node("mcp", context=context) as node,
        AsyncExitStack() as serving,
    ):
        rules = Policy.parse(policy)
        served: Assistant | Gateway
        if over_http:
            served = await serving.enter_async_context(
                Gateway(node, rules, port=0, mcp=True, **options)
            )
        else:
            served = await serving.enter_async_context(Assistant(node, rules, **options))
        async with asyncio.TaskGroup() as tasks:
            bench = Bench(base, served, tasks)
            await settle()
            try:
                yield bench
            finally:
                bench.closing.set()
