"""The page about HTTP, run with curl against a gateway, and a curl that is killed."""

from __future__ import annotations

import asyncio
import re
import shlex
import shutil
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from aionode.action import CancelResponse
from aionode.engine.context import Context
from aionode.gateway import Gateway, Policy
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile

pytestmark = pytest.mark.skipif(shutil.which("curl") is None, reason="curl is not installed")

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "http.md"

POLICY = """
[[who]]
name = "local"
loopback = true
[[allow]]
see = ["/robot", "/gateway"]
subscribe = "/chatter"
publish = "/chatter"
call = "/add_two_ints"
goal = ["/fibonacci", "/wait"]
parameter = "/robot:rate"
"""


class Robot(Node):
    """The robot of the page."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self.cancelled = asyncio.Event()
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_publisher(String, "/chatter", latched).publish(String(data="hello"))
        self.create_service(AddTwoInts, "/add_two_ints", self.add)
        self.create_action_server(Fibonacci, "/fibonacci", self.count)
        self.create_action_server(
            Fibonacci, "/wait", self.wait, cancel_callback=lambda _: CancelResponse.ACCEPT
        )
        self.declare_parameter("rate", 1.5)

    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Return the sum."""
        return AddTwoInts.Response(sum=request.a + request.b)

    def count(self, goal: Any) -> Fibonacci.Result:
        """Give feedback once, and the result shown on the page."""
        goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1])

    async def wait(self, _goal: Any) -> Fibonacci.Result:
        """Wait until cancelled."""
        try:
            await asyncio.Event().wait()
        finally:
            self.cancelled.set()
        return Fibonacci.Result()


@asynccontextmanager
async def robot_of_the_page(context: Context) -> AsyncIterator[tuple[Robot, int]]:
    """Yield the robot, and the port of its gateway."""
    async with (
        Robot(context) as robot,
        Node("gateway", context=context) as node,
        Gateway(node, Policy.parse(POLICY), port=0) as gateway,
    ):
        yield robot, gateway.port


@asynccontextmanager
async def curl(command: str, port: int) -> AsyncIterator[Process]:
    """Yield a running curl, which is killed at the end."""
    words = shlex.split(command.replace(":9090", f":{port}"))
    process = await asyncio.create_subprocess_exec(*words, "--silent", stdout=PIPE)
    try:
        yield process
    finally:
        if process.returncode is None:
            process.kill()
        await process.communicate()


def commands() -> list[tuple[str, str]]:
    """Return the curl commands of the page, and the output of each."""
    found = []
    block = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    for match in block.finditer(PAGE.read_text(encoding="utf-8")):
        for part in re.split(r"^\$ ", match[1], flags=re.MULTILINE)[1:]:
            command, _, printed = part.partition("\n")
            if command.startswith("curl"):
                found.append((command, printed.strip()))
    return found


def without_ids(text: str) -> str:
    """Return a text without the random ids of goals."""
    return re.sub(r"[0-9a-f]{32}", "ID", text)


async def test_curl_prints_what_the_page_shows(aionode_context: Context) -> None:
    """Newcomers type the commands of the page."""
    async with robot_of_the_page(aionode_context) as (_, port):
        shown = commands()
        for command, expected in shown:
            async with curl(command, port) as process:
                assert process.stdout is not None
                if expected:
                    printed = await process.stdout.readexactly(len(expected.encode()))
                else:
                    printed = await process.stdout.read()
            assert without_ids(printed.decode()) == without_ids(expected), command

    assert len(shown) >= 10


async def test_a_curl_that_is_killed_cancels_its_goal(aionode_context: Context) -> None:
    """Motion ends when its client has gone: the kernel tells the gateway that curl has."""
    command = (
        "curl --no-buffer --json '{}' --header 'Accept: text/event-stream' "
        "http://127.0.0.1:9090/actions/wait"
    )
    async with (
        robot_of_the_page(aionode_context) as (robot, port),
        curl(command, port) as process,
    ):
        assert process.stdout is not None
        assert await process.stdout.readline() == b"event: accepted\n"
        assert not robot.cancelled.is_set()

        process.kill()

        await robot.cancelled.wait()
