"""Wheels whose movers are killed, frozen or cut off, and wheels that are frozen themselves."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from typing import TYPE_CHECKING

import pytest

from aionode.clock import MachineTime, SteadyClock
from aionode.engine.context import Context
from aionode.interfaces.std_msgs.msg import Int64
from aionode.node import Node
from tests.end_to_end.process import Process
from tests.end_to_end.silence_member import TOPIC
from tests.support.links import folder
from tests.support.peers import quiet_node, ros_router

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable
    from pathlib import Path

__all__ = ["folder"]  # a fixture

MACHINE = SteadyClock()
now_ns = MachineTime.system_ns
S = 10**9

pytestmark = pytest.mark.one_loop  # which loop waits for the processes is of no interest


class Driven:
    """The commands and stops of the wheels of a node in this process.

    Attributes:
        log: When each command was published, and None for a stop; with the time at which it came.
    """

    def __init__(self, node: Node, silence_sec: float) -> None:
        self.log: list[tuple[int | None, int]] = []
        self._changed = asyncio.Event()
        self.subscription = node.create_subscription(
            Int64,
            TOPIC,
            lambda msg: self._note(msg.data),
            100,
            on_silence=lambda: self._note(None),
            silence_sec=silence_sec,
        )

    def _note(self, published_ns: int | None) -> None:
        self.log.append((published_ns, now_ns()))
        self._changed.set()

    @property
    def stops(self) -> list[int]:
        """When the wheels were stopped."""
        return [at_ns for published_ns, at_ns in self.log if published_ns is None]

    async def until(self, condition: Callable[[], bool]) -> None:
        """Wait until a condition holds; checked whenever something reaches the wheels."""
        while not condition():
            self._changed.clear()
            await self._changed.wait()

    async def moves(self) -> None:
        """Wait for three more commands."""
        count = len(self.log) + 3
        await self.until(lambda: len(self.log) >= count)

    def expect_no_late_command(self) -> None:
        """Expect that nothing published before a stop arrived after it."""
        stopped_ns = 0
        for published_ns, at_ns in self.log:
            if published_ns is None:
                stopped_ns = at_ns
            else:
                assert published_ns >= stopped_ns - S // 1000  # the time that a call takes


@pytest.fixture(params=["link", pytest.param("zenoh", marks=pytest.mark.slow)])
def route(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """The way in which commands reach the wheels."""
    monkeypatch.setenv("AIONODE_LINK", "on" if request.param == "link" else "off")
    return str(request.param)


@pytest.fixture
async def wheels(route: str) -> AsyncIterator[Node]:
    """A node in this process."""
    async with quiet_node("wheels", Context(link=route == "link")) as node:
        yield node


def mover() -> Process:
    """Start a process that commands at 50 Hz."""
    return Process("tests/end_to_end/silence_member.py", "mover")


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
async def test_a_mover_that_ends_stops_the_wheels_soon(
    wheels: Node, number: signal.Signals
) -> None:
    """Within the second in which a lost process may return, whatever the allowed silence."""
    driven = Driven(wheels, 60)
    with mover() as process:
        await driven.moves()
        process.send(number)
        began_ns = now_ns()
        await driven.until(lambda: bool(driven.stops))
    assert (driven.stops[0] - began_ns) / S < 5
    assert len(driven.stops) == 1


async def test_a_mover_that_is_frozen_stops_the_wheels(wheels: Node) -> None:
    """Commands from before are not delivered when it continues; new ones are."""
    driven = Driven(wheels, 2.0)
    with mover() as process:
        await driven.moves()
        process.send(signal.SIGSTOP)
        await driven.until(lambda: bool(driven.stops))
        count = len(driven.log)
        await MACHINE.sleep(1)
        assert len(driven.log) == count
        process.send(signal.SIGCONT)
        await driven.moves()
    driven.expect_no_late_command()


@pytest.mark.slow
async def test_a_frozen_mover_beside_another_is_no_silence(wheels: Node, route: str) -> None:
    """The topic is not silent; when the other one falls silent too, the wheels stop."""
    driven = Driven(wheels, 2.0)
    async with quiet_node("other", Context(link=route == "link")) as other:
        publisher = other.create_publisher(Int64, TOPIC, 10)
        with mover() as process:
            await driven.moves()
            process.send(signal.SIGSTOP)
            for _ in range(50):
                publisher.publish(Int64(data=now_ns()))
                await MACHINE.sleep(0.06)
            assert driven.stops == []
            await driven.until(lambda: bool(driven.stops))
            process.send(signal.SIGCONT)
            await driven.moves()
    driven.expect_no_late_command()


async def test_wheels_that_were_frozen_stop_before_anything_else(route: str) -> None:
    """Their sockets are full of commands from the time in which they were frozen."""
    context = Context(link=route == "link")
    async with quiet_node("mover", context) as node:
        publisher = node.create_publisher(Int64, TOPIC, 10)
        with Process("tests/end_to_end/silence_member.py", "wheels") as process:
            await publisher.wait_for_subscribers()
            await asyncio.gather(command(publisher, 0.5), asyncio.to_thread(drives, process))
            process.send(signal.SIGSTOP)
            await command(publisher, 1.5)
            before = process.rest_so_far()
            resumed_ns = now_ns()
            process.send(signal.SIGCONT)
            await command(publisher, 0.5)
            while not drove_again(log := events(process.rest_so_far()[len(before) :])):
                await command(publisher, 0.1)  # the machine is busy
    at = next(index for index, (word, _) in enumerate(log) if word == "stop")
    stopped_ns = log[at][1]
    # Lines that were written before it was frozen may be read after that.
    assert all(stamp < stopped_ns - S for _, stamp in log[:at])
    assert log[at + 1][0] == "drive"
    # On a busy machine, a command may be sent while it wakes up, and others come late.
    early = [(stamp - resumed_ns) / S for word, stamp in log[at + 1 :] if word == "drive"]
    assert min(early) > 0, early


def events(lines: list[str]) -> list[tuple[str, int]]:
    """Return the commands and stops; other lines are warnings of a loop that was late."""
    return [(words[0], int(words[1])) for line in lines if len(words := line.split()) == 2]


def drove_again(log: list[tuple[str, int]]) -> bool:
    """Return whether wheels have stopped, and driven since."""
    return "stop" in dict(log) and log[-1][0] == "drive"


def drives(process: Process) -> None:
    """Wait until a process drives."""
    process.expect("drive")


async def command(publisher: object, for_s: float) -> None:
    """Publish commands for a while."""
    for _ in range(round(for_s / 0.02)):
        publisher.publish(Int64(data=now_ns()))  # type: ignore[attr-defined]  # it is a Publisher
        await MACHINE.sleep(0.02)


@pytest.mark.slow
async def test_a_router_that_is_restarted_is_no_fault(tmp_path: Path) -> None:
    """Everyone behind it is out of reach, but not gone."""
    config = tmp_path / "client.json5"
    async with contextlib.AsyncExitStack() as stack:
        config.write_text(
            "{mode: 'client', scouting: {multicast: {enabled: false}}, connect: {retry: "
            "{period_init_ms: 50, period_max_ms: 50}, timeout_ms: -1, exit_on_failure: false, "
            f"endpoints: ['tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}']}}}}"
        )
        router = await asyncio.to_thread(ros_router)
        wheels = await stack.enter_async_context(quiet_node("wheels", Context(config=config)))
        other = await stack.enter_async_context(quiet_node("mover", Context(config=config)))
        driven = Driven(wheels, 60)
        publisher = other.create_publisher(Int64, TOPIC, 10)
        await publisher.wait_for_subscribers()
        publisher.publish(Int64(data=now_ns()))
        await driven.until(lambda: bool(driven.log))
        await asyncio.to_thread(router.close)
        await wheels.graph.until(lambda: driven.subscription.get_publisher_count() == 0)
        await MACHINE.sleep(1.5)
        assert driven.stops == []
        router = await asyncio.to_thread(ros_router)
        stack.callback(router.close)
        await wheels.graph.until(lambda: driven.subscription.get_publisher_count() == 1)
        await publisher.wait_for_subscribers()
        publisher.publish(Int64(data=now_ns()))
        await driven.until(lambda: len(driven.log) == 2)
        assert driven.stops == []
