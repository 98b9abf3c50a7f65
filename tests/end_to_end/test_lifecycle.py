"""Managed nodes, as seen by a program that knows only the wire format."""

from __future__ import annotations

import asyncio
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from aionode import Context, Node
from aionode.interfaces.lifecycle_msgs.srv import ChangeState
from aionode.interfaces.std_msgs.msg import Int32
from aionode.lifecycle import (
    LifecycleManager,
    LifecycleNode,
    State,
    TransitionCallbackReturn,
)
from tests.end_to_end.process import ROOT, Process

PEER = str(Path(__file__).with_name("lifecycle_peer.py"))


class Scripted(LifecycleNode):
    """Each callback follows the script under its name, and succeeds by default.

    Attributes:
        script: The keyword for what a callback does, by its name.
        calls: Each callback that was called, with the state it got.
    """

    def __init__(self, name: str, context: Context) -> None:
        super().__init__(name, context=context, enable_rosout=False, start_parameter_services=False)
        self.script: dict[str, str] = {}
        self.calls: list[str] = []

    async def follow(self, name: str, state: State) -> Any:
        """Follow the script for a callback."""
        self.calls.append(f"{name}:{state.label}")
        does = self.script.get(name, "SUCCESS")
        if does in TransitionCallbackReturn.__members__:
            return TransitionCallbackReturn[does]
        if does == "NONE":
            return None
        if does == "RAISE":
            raise OSError("no camera")
        forever: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        if does == "LOSE":
            forever.cancel()
        try:
            await forever
        except asyncio.CancelledError as error:
            if does == "KEEP":
                return TransitionCallbackReturn.SUCCESS
            if does == "SPOIL":
                raise OSError("the camera does not close") from error
            raise

    async def on_configure(self, state: State) -> Any:
        """Follow the script."""
        return await self.follow("configure", state)

    async def on_activate(self, state: State) -> Any:
        """Follow the script."""
        super().on_activate(state)
        return await self.follow("activate", state)

    async def on_deactivate(self, state: State) -> Any:
        """Follow the script."""
        super().on_deactivate(state)
        return await self.follow("deactivate", state)

    async def on_cleanup(self, state: State) -> Any:
        """Follow the script."""
        return await self.follow("cleanup", state)

    async def on_shutdown(self, state: State) -> Any:
        """Follow the script."""
        return await self.follow("shutdown", state)

    async def on_error(self, state: State, error: Exception | None = None) -> Any:
        """Follow the script."""
        return await self.follow("error", state)


class Stage(Node):
    """Runs one managed node at a time, as the program requests."""

    def __init__(self, context: Context, group: asyncio.TaskGroup) -> None:
        super().__init__("stage", context=context)
        self.group = group
        self.replaced = asyncio.Event()
        self.managed: Scripted | None = None
        self.create_service(ChangeState, "~/prepare", self.prepare)
        self.create_service(ChangeState, "~/check_calls", self.check_calls)

    async def host(self, managed: Scripted, runs: asyncio.Event) -> None:
        """Run a managed node until another one takes its place."""
        async with managed:
            self.replaced.clear()
            runs.set()
            await self.replaced.wait()

    async def prepare(
        self, request: ChangeState.Request, response: ChangeState.Response
    ) -> ChangeState.Response:
        """Replace the node by one with a name (``node=name``), or set a script for it."""
        words = dict(word.split("=") for word in request.transition.label.split())
        name = words.pop("node", None)
        if name is not None:
            self.replaced.set()
            self.managed = Scripted(name, self.context)
            runs = asyncio.Event()
            self.group.create_task(self.host(self.managed, runs))
            await runs.wait()
        assert self.managed is not None
        self.managed.script = words
        self.managed.calls.clear()
        response.success = True
        return response

    def check_calls(
        self, request: ChangeState.Request, response: ChangeState.Response
    ) -> ChangeState.Response:
        """Answer whether these callbacks were called."""
        assert self.managed is not None
        response.success = " ".join(self.managed.calls) == request.transition.label
        return response


async def output_of_peer(*arguments: str) -> str:
    """Run the program to its end, and return what it printed."""
    program = await asyncio.create_subprocess_exec(
        sys.executable,
        PEER,
        *arguments,
        cwd=ROOT,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
    )
    try:
        text = (await program.communicate())[0].decode()
    finally:
        if program.returncode is None:
            program.kill()
            await program.wait()
    assert program.returncode == 0, text
    return text


@pytest.mark.slow
@pytest.mark.one_loop
@pytest.mark.timeout(120)
async def test_a_program_of_another_kind_manages_nodes() -> None:
    """Every transition, error and refusal, with states, events and what is available."""
    async with (
        Context() as context,
        asyncio.TaskGroup() as group,
        Stage(context, group) as stage,
    ):
        assert (await output_of_peer("all")).endswith("done\n")
        stage.replaced.set()


@pytest.mark.slow
@pytest.mark.timeout(120)
async def test_no_transition_is_lost_or_stuck_while_topics_flow() -> None:
    """Hundreds of requests from another process, between the messages of a busy topic."""
    heard = 0

    def count(_: Int32) -> None:
        nonlocal heard
        heard += 1

    async with (
        Context() as context,
        Scripted("managed", context) as managed,
        Node("talker", context=context) as talker,
    ):
        managed.create_lifecycle_subscription(Int32, "/numbers", count)
        publisher = talker.create_publisher(Int32, "/numbers", 10)
        talker.create_timer(0.001, lambda: publisher.publish(Int32()))

        text = await output_of_peer("400")

        assert text.endswith("done\n")
        assert managed.lifecycle_state.label == "unconfigured"
        assert heard > 0
        assert publisher.stats.published > heard


CAMERA = """
import aionode
from aionode.lifecycle import LifecycleNode

class Camera(LifecycleNode):
    def __init__(self):
        super().__init__("camera")

    def on_activate(self, state):
        print("active", flush=True)
        return super().on_activate(state)

aionode.run(Camera)
"""


@pytest.mark.one_loop
@pytest.mark.timeout(120)
@pytest.mark.parametrize("link", ["on", "off"])
async def test_a_managed_node_that_is_killed_and_started_again_gets_its_state_back(
    link: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program such as systemd restarts it: the manager only sees it leave and return."""
    monkeypatch.setenv("AIONODE_LINK", link)
    kinds: asyncio.Queue[str] = asyncio.Queue()

    async def read(manager: LifecycleManager) -> None:
        async for event in manager.events():
            await kinds.put(event.kind)

    async with (
        Context() as context,
        Node("manager", context=context) as node,
        asyncio.TaskGroup() as group,
    ):
        manager = LifecycleManager(node, ["/camera"], timeout_sec=30.0, restore=True)
        group.create_task(read(manager))
        with Process("-c", CAMERA) as camera:
            async with manager, asyncio.timeout(60):
                camera.send(signal.SIGKILL)
                assert await kinds.get() == "lost"
                with Process("-c", CAMERA) as other:
                    assert [await kinds.get(), await kinds.get()] == ["returned", "restored"]
                    assert await manager.get_state("/camera") == "active"
                    other.stop()
                    assert await kinds.get() == "lost"
