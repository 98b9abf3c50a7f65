"""The stop of a lease over Zenoh is repeated for readers that do not acknowledge."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from aionode import Context, Node
from aionode.clock import perf_ns
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.endpoints.stop import REPEAT_NS
from aionode.errors import LeaseExpiredError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.endpoints.publisher import Publisher

BEST_EFFORT = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
STOP = Int32(data=-1)


class Wheels:
    """A subscription that does not acknowledge, as in ROS 2, and a publisher of commands."""

    def __init__(self, left: Node, right: Node) -> None:
        self.left = left
        self.got: list[tuple[int, int]] = []
        right.create_subscription(Int32, "speed", self.take, BEST_EFFORT)
        self.commands: Publisher[Int32] = left.create_publisher(Int32, "speed", 100)

    def take(self, msg: Int32, info: Any) -> None:
        """Note a message and its number."""
        self.got.append((msg.data, info["publication_sequence_number"]))

    async def drive(self) -> None:
        """Publish one command in a lease."""
        async with self.commands.lease(stop=STOP) as lease:
            lease.publish(Int32(data=1))

    async def wait(self, seconds: float) -> None:
        """Let real time pass."""
        await self.left.get_clock().sleep(seconds)


@asynccontextmanager
async def wheels() -> AsyncIterator[tuple[Wheels, AsyncExitStack]]:
    """Two nodes in contexts of their own, and what leaves the mover's."""
    async with Context(link=False) as here, AsyncExitStack() as mover:
        right = await mover.enter_async_context(Node("right", context=here))
        there = await mover.enter_async_context(Context(link=False))
        left = await mover.enter_async_context(Node("left", context=there))
        both = Wheels(left, right)
        await both.commands.wait_for_subscribers()
        while not both.got:
            both.commands.publish(Int32(data=0))
            await both.wait(0.02)
        both.got.clear()
        yield both, mover


async def test_it_is_put_again_with_the_same_number_for_a_while() -> None:
    """Zenoh may silently drop what does not fit into its queue."""
    async with wheels() as (both, _):
        await both.drive()
        await both.wait(0.6)
        stops = [each for each in both.got if each[0] == STOP.data]
        assert both.got == [both.got[0], *stops]
        assert 2 <= len(stops) <= 6
        assert len(set(stops)) == 1


async def test_it_is_not_put_again_behind_another_message() -> None:
    """The next holder is driving by then."""
    async with wheels() as (both, _):
        await both.drive()
        both.commands.publish(Int32(data=2))
        await both.wait(0.4)
        assert [data for data, _ in both.got] == [1, STOP.data, 2]


async def test_a_destroyed_publisher_still_puts_it_again() -> None:
    """The end of the process waits for that, and no longer."""
    async with wheels() as (both, _):
        await both.drive()
        both.commands.destroy()
        await both.wait(0.4)
        assert len([data for data, _ in both.got if data == STOP.data]) >= 2
        context = both.left.context
        began_ns = perf_ns()
        both.left.destroy_node()
        await context.transports[1].close()
        assert perf_ns() - began_ns < REPEAT_NS + 1_000_000_000


async def test_a_late_reader_gets_the_stop_of_a_blocked_loop() -> None:
    """Wheels that join a transient local topic meanwhile do not begin with the last command."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

    async def first_of_late_reader() -> int:
        async with Context(link=False) as context, Node("late", context=context) as late:
            while not lease.is_sent:
                await late.get_clock().sleep(0.01)
            return (await anext(late.create_subscription(Int32, "speed", None, latched))).data

    async with Context(link=False) as context, Node("left", context=context) as left:
        lease = left.create_publisher(Int32, "speed", latched).lease(stop=STOP, ttl_sec=0.05)

        async def drive() -> None:
            async with lease:
                lease.publish(Int32(data=1))
                with ThreadPoolExecutor(1) as thread:  # the loop stands still until it has heard
                    heard.append(thread.submit(asyncio.run, first_of_late_reader()).result(20))

        heard: list[int] = []
        with pytest.raises(LeaseExpiredError):
            await drive()

    assert heard == [STOP.data]


@pytest.mark.parametrize("drops", [0, 1])
async def test_a_stop_that_is_dropped_once_arrives(
    monkeypatch: pytest.MonkeyPatch, drops: int
) -> None:
    """What Zenoh drops for 0.1 s does not keep the robot driving."""
    async with wheels() as (both, _):
        (writer,) = [one for one in both.commands._all_writers if isinstance(one, ZenohWriter)]
        monkeypatch.setattr(writer.sender, "publisher", Dropping(writer.sender.publisher, drops))
        await both.drive()
        await both.wait(0.4)
        assert both.got[-1][0] == STOP.data


class Dropping:
    """A Zenoh publisher that loses the first stops."""

    def __init__(self, inner: Any, drops: int) -> None:
        self._inner = inner
        self._drops = drops + 1  # and the command

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send, or not."""
        self._drops -= 1
        if self._drops < 0:
            self._inner.put(payload, attachment=attachment)

    def undeclare(self) -> None:
        """Withdraw it."""
        self._inner.undeclare()
