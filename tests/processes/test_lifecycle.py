"""Managed nodes, as a program sees them that knows only the wire format."""

from __future__ import annotations

import asyncio
import sys
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

import pytest

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import Int32
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from tests.processes.process import ROOT

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE
ERROR = TransitionCallbackReturn.ERROR

PEER = str(Path(__file__).with_name("lifecycle_peer.py"))


class Scripted(LifecycleNode):
    """Its callbacks return what a list says, in this order, and then SUCCESS."""

    def __init__(self, name: str, context: Context, **scripts: list[Any]) -> None:
        super().__init__(name, context=context)
        self.scripts = scripts

    async def follow(self, name: str) -> TransitionCallbackReturn:
        """Do what the list says next."""
        script = self.scripts.get(name, [])
        outcome = script.pop(0) if script else SUCCESS
        if isinstance(outcome, Exception):
            raise outcome
        if outcome is None:
            await asyncio.Event().wait()  # until it is canceled
        return outcome

    async def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Follow the script."""
        return await self.follow("configure")

    async def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Follow the script."""
        super().on_activate(state)
        return await self.follow("activate")

    async def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Follow the script."""
        super().on_deactivate(state)
        return await self.follow("deactivate")

    async def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Follow the script."""
        return await self.follow("cleanup")

    async def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        """Follow the script."""
        return await self.follow("shutdown")

    async def on_error(
        self, state: State, error: Exception | None = None
    ) -> TransitionCallbackReturn:
        """Follow the script."""
        return await self.follow("error")


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


@pytest.mark.timeout(60)
async def test_a_program_of_another_kind_manages_nodes() -> None:
    """Every transition, error and refusal, with states, events and what is available."""
    async with AsyncExitStack() as stack:
        context = await stack.enter_async_context(Context())
        for node in (
            Scripted(
                "managed",
                context,
                configure=[FAILURE, ERROR, OSError("no camera"), None, SUCCESS],
                activate=[FAILURE],
                deactivate=[FAILURE, SUCCESS, ERROR],
                cleanup=[FAILURE],
                error=[SUCCESS, SUCCESS, FAILURE],
            ),
            Scripted("from_unconfigured", context),
            Scripted("from_inactive", context, shutdown=[FAILURE]),
            Scripted("from_active", context, shutdown=[ERROR]),
        ):
            await stack.enter_async_context(node)

        assert (await output_of_peer("all")).endswith("done\n")


@pytest.mark.timeout(60)
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
