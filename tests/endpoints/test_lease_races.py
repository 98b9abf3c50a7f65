"""The event loop, a thread and signal handlers race for the end of a lease."""

from __future__ import annotations

import asyncio
import random
import signal
import threading
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import pytest

from aionode import CommandLease, Context, Node
from aionode.clock import perf_ns
from aionode.endpoints.core import lease_watch
from aionode.endpoints.lease import send_stops
from aionode.engine.transport.base import StopSender, Writer
from aionode.engine.transport.local import LocalTransport
from aionode.errors import LeaseExpiredError, LeaseHeldError
from aionode.interfaces.std_msgs.msg import Int8

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo

pytestmark = pytest.mark.one_loop

STOP = Int8(data=0)


class Recording(LocalTransport):
    """A transport that records the calls of its writers, in order.

    Attributes:
        told: ``command``, ``stop`` and ``past loop``, each with its number.
    """

    def __init__(self) -> None:
        super().__init__()
        self.told: list[tuple[str, int]] = []

    def create_writer(
        self, endpoint: EndpointInfo, msg_type: type[Any]
    ) -> Writer:  # the topic alone
        """Record the calls of a publisher of commands."""
        if endpoint.name == "/speed":
            return RecordingWriter(self.told)
        return super().create_writer(endpoint, msg_type)


class RecordingWriter(Writer):
    """Records messages slowly, so that another thread runs in between."""

    active = True

    def __init__(self, told: list[tuple[str, int]]) -> None:
        self.told = told

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:  # its number will do
        """Record a command."""
        threading.Event().wait(0.0005)
        self.told.append(("command", sequence))

    def prepare_stop(
        self, stop: Any, is_last: Callable[[], bool]
    ) -> StopSender:  # its number will do
        """Return a sender that records the stop."""
        return RecordingStop(self.told)

    def close(self) -> None:
        """Keep the records."""


class RecordingStop(StopSender):
    """Records the stop."""

    def __init__(self, told: list[tuple[str, int]]) -> None:
        self.told = told

    def send(self, sequence: int, source_ns: int) -> None:  # its number will do
        """Record it, on the loop."""
        self.told.append(("stop", sequence))

    def send_past_loop(self, sequence: int, source_ns: int) -> None:  # the same
        """Record it, in a thread."""
        self.told.append(("past loop", sequence))


def assert_in_order(told: list[tuple[str, int]]) -> str:
    """Check one lease, and return how it ended: commands, then one stop, first past the loop."""
    kinds = [kind for kind, _ in told]
    numbers = [number for _, number in told]
    commands = kinds.count("command")
    assert kinds[:commands] == ["command"] * commands, told
    assert kinds[commands:] in (["stop"], ["past loop", "stop"]), told
    assert len(set(numbers[commands:])) == 1, told
    assert sorted(numbers) == numbers, told
    return kinds[commands]


async def hold(lease: CommandLease[Int8], randomly: random.Random) -> None:
    """Publish, and occasionally block the loop for about the time to live."""
    while True:
        lease.publish(Int8(data=1))
        if randomly.random() < 0.3:
            threading.Event().wait(randomly.uniform(0.001, 0.005))
        await asyncio.sleep(randomly.uniform(0, 0.004))  # noqa: TID251  # real time


async def test_of_loop_and_thread_one_sends_the_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever notices first sends it, and no command follows it."""
    monkeypatch.setattr(lease_watch, "GRACE_NS", 0)
    monkeypatch.setattr(lease_watch, "AGAIN_S", 0.0)
    randomly = random.Random(1)  # noqa: S311  # no secrets
    transport = Recording()
    ends: set[str] = set()
    async with Context(transport=transport) as context, Node("mover", context=context) as node:
        speed = node.create_publisher(Int8, "/speed", 10)
        ends_ns = perf_ns() + 1_000_000_000
        while len(ends) < 2 or perf_ns() < ends_ns:
            transport.told.clear()
            with suppress(LeaseExpiredError):
                async with speed.lease(stop=STOP, ttl_sec=0.003) as lease:
                    await hold(lease, randomly)
            ends.add(assert_in_order(transport.told))
    assert ends == {"stop", "past loop"}


async def test_a_thread_that_sends_all_stops_races_with_commands() -> None:
    """No command follows the stop, and the publisher is refused until the loop has taken over."""
    transport = Recording()
    async with Context(transport=transport) as context, Node("mover", context=context) as node:
        speed = node.create_publisher(Int8, "/speed", 10)
        for turn in range(100):
            transport.told.clear()
            ender = threading.Timer(turn / 1e5, send_stops, (0,))
            with suppress(LeaseExpiredError, LeaseHeldError):
                async with speed.lease(stop=STOP, ttl_sec=60) as lease:
                    ender.start()
                    for _ in range(1000):
                        lease.publish(Int8(data=1))
            ender.join()
            assert_in_order(transport.told)


async def test_a_signal_handler_that_ends_leases_is_followed_by_the_stop() -> None:
    """It runs within `publish`, whose command is completed after it: then the stop is repeated."""
    transport = Recording()
    before = signal.signal(signal.SIGALRM, lambda *_: send_stops(0))
    try:
        async with Context(transport=transport) as context, Node("mover", context=context) as node:
            speed = node.create_publisher(Int8, "/speed", 10)
            for turn in range(1, 100):
                transport.told.clear()
                with suppress(LeaseExpiredError):
                    async with speed.lease(stop=STOP, ttl_sec=60) as lease:
                        signal.setitimer(signal.ITIMER_REAL, turn / 1e5)
                        for _ in range(1000):
                            lease.publish(Int8(data=1))
                assert transport.told[-1][0] == "stop"
                assert transport.told[-1][1] == max(number for _, number in transport.told)
    finally:
        signal.signal(signal.SIGALRM, before)
