"""The causes of a message across processes, one of which keeps none and one is suspended."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
from pathlib import Path
from typing import Any

import pytest

from aionode.interfaces.std_msgs.msg import Int32
from aionode.observe import Caused, Why, why
from tests.support.fork_server import start
from tests.support.peers import isolated_environment, quiet_node

PATIENCE_S = 30.0
"""Time in which processes find each other, in seconds."""

RELAY = """
import sys

import aionode
from aionode.interfaces.std_msgs.msg import Int32


class Relay(aionode.Node):
    def __init__(self):
        name, source, target = sys.argv[1:]
        super().__init__(name)
        self.out = self.create_publisher(Int32, target, 10)
        self.create_subscription(Int32, source, self.on_message, 10)

    def on_message(self, message):
        self.out.publish(message)


aionode.run(Relay)
"""
"""Publishes what it gets."""


def chain(sent: Caused) -> list[str]:
    """Return the chain of sent items, the last first, and why the rest is unknown."""
    found = [f"{sent.name} {sent.unknown}".strip()]
    for cause in sent.causes:
        found += [cause.callback, *(chain(cause.source) if cause.source else [])]
    return found


async def asked(node: Any, name: str, wanted: list[str], keep_nothing: tuple[str, ...] = ()) -> Why:
    """Return the answer for a name once its chain is as expected, or else the last answer.

    The nodes that keep nothing have answered, too: a busy one may be too late for an answer.
    """
    found = Why(name)
    try:
        async with asyncio.timeout(PATIENCE_S):
            while not (
                found.sent
                and chain(found.sent[0]) == wanted
                and {*keep_nothing} <= {name for names in found.not_kept.values() for name in names}
            ):
                found = await why(node, name)
    except TimeoutError:
        pass
    return found


@pytest.mark.one_loop
@pytest.mark.parametrize("link", ["on", "off"])
async def test_a_chain_goes_through_three_processes(
    link: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over links and over Zenoh; a process that keeps no causes, or is suspended, is named."""
    environment = {**isolated_environment(), "AIONODE_LINK": link}
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("AIONODE_CAUSES", "1")
    program = tmp_path / "relay.py"
    program.write_text(RELAY)

    def relay(*arguments: str, causes: str = "1") -> Any:
        return start(
            [str(program), *arguments],
            env={**os.environ, "AIONODE_CAUSES": causes},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    relays = [
        relay("slam", "scan", "map"),
        relay("planner", "map", "drive"),
        relay("mute", "scan", "muted", causes="0"),
    ]
    try:
        async with quiet_node("driver") as node:
            scan = node.create_publisher(Int32, "scan", 10)
            heard = asyncio.Event()
            driven = node.create_subscription(Int32, "drive", lambda _: heard.set())
            muted = node.create_subscription(Int32, "muted")
            async with asyncio.timeout(PATIENCE_S):
                await scan.wait_for_subscribers(2)
                await node.graph.until(
                    lambda: (
                        node.count_subscribers("/map") == 1 and driven.get_publisher_count() == 1
                    )
                )
                while not heard.is_set():  # until all have found each other
                    scan.publish(Int32())
                    await node.get_clock().sleep(0.05)
                await muted.receive()
            whole = ["/drive", "Relay.on_message", "/map", "Relay.on_message", "/scan"]
            before = await asked(node, "/drive", whole, ("/mute",))
            nothing = await asked(node, "/muted", ["/muted not kept"])
            relays[0].send_signal(signal.SIGSTOP)
            stopped = await asked(node, "/drive", [*whole[:2], "/map silent"])
    finally:
        for each in relays:
            each.send_signal(signal.SIGCONT)
            each.kill()
            each.wait()

    assert chain(before.sent[0]) == whole
    assert list(before.not_kept.values()) == [["/mute"]]
    assert chain(nothing.sent[0]) == ["/muted not kept"]
    assert chain(stopped.sent[0]) == [*whole[:2], "/map silent"]
    assert list(stopped.silent.values()) == [["/slam"]]
