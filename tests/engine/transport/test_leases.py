"""Leases for commands over every transport: the stop is the last message, and arrives once."""

from __future__ import annotations

import asyncio
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

import pytest

from aionode.errors import EntityDestroyedError, LeaseExpiredError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.engine.transport.test_contract import Pair, numbers, pair

if TYPE_CHECKING:
    from aionode.endpoints.publisher import Publisher
    from aionode.endpoints.subscription import Subscription

__all__ = ["pair"]  # the fixture

STOP = -1


class Robot:
    """A publisher of commands, and the subscription that obeys them."""

    def __init__(self, pair: Pair) -> None:
        self.wheels: Subscription[Int32] = pair.right.create_subscription(Int32, "speed", None, 100)
        self.commands: Publisher[Int32] = pair.left.create_publisher(Int32, "speed", 100)

    async def took(self, count: int) -> list[int]:
        """Return the next messages that the wheels get, and check that no more follow."""
        got: list[int] = await numbers(self.wheels, count)
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.3):
                got += await numbers(self.wheels, 1)
        return got


@pytest.fixture
async def robot(pair: Pair) -> Robot:
    """A robot whose two ends know each other."""
    robot = Robot(pair)
    await robot.commands.wait_for_subscribers()
    return robot


async def test_the_stop_is_the_last_message_of_the_block(robot: Robot) -> None:
    """It follows the commands, and comes once."""
    async with robot.commands.lease(stop=Int32(data=STOP)) as lease:
        for number in range(10):
            lease.publish(Int32(data=number))

    assert await robot.took(11) == [*range(10), STOP]


async def test_the_stop_is_the_last_message_of_a_publisher(robot: Robot) -> None:
    """Destroying the publisher does not wait for the end of the block."""
    async with robot.commands.lease(stop=Int32(data=STOP)) as lease:
        lease.publish(Int32(data=1))
        robot.commands.destroy()
        with pytest.raises(EntityDestroyedError):
            lease.publish(Int32(data=2))

        assert await robot.took(2) == [1, STOP]


async def test_the_stop_is_sent_when_the_holder_is_silent(robot: Robot) -> None:
    """The holder's block ends as well, after the stop."""

    async def hold() -> None:
        async with robot.commands.lease(stop=Int32(data=STOP), ttl_sec=0.05) as lease:
            lease.publish(Int32(data=1))
            await asyncio.Event().wait()

    with pytest.raises(LeaseExpiredError):
        await hold()

    assert await robot.took(2) == [1, STOP]


async def test_a_loop_that_was_blocked_sends_nothing_but_the_stop(robot: Robot) -> None:
    """Messages that another thread has sent in the meantime do not come twice."""

    async def hold() -> None:
        async with robot.commands.lease(stop=Int32(data=STOP), ttl_sec=0.05) as lease:
            lease.publish(Int32(data=1))
            threading.Event().wait(0.3)
            with suppress(LeaseExpiredError):
                lease.publish(Int32(data=2))

    with pytest.raises(LeaseExpiredError):
        await hold()

    assert await robot.took(2) == [1, STOP]


async def test_the_next_lease_goes_on(robot: Robot) -> None:
    """Its commands follow the previous lease's stop, which is not repeated after them."""
    for number in (1, 2):
        async with robot.commands.lease(stop=Int32(data=STOP)) as lease:
            lease.publish(Int32(data=number))
    robot.commands.publish(Int32(data=3))

    assert await robot.took(5) == [1, STOP, 2, STOP, 3]


async def test_a_late_joiner_gets_the_stop(pair: Pair) -> None:
    """On a transient local topic, which keeps the last message.

    A publisher over Zenoh hands both to a thread; a reader that joins then gets both, in order.
    """
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    commands = pair.left.create_publisher(Int32, "speed", latched)
    async with commands.lease(stop=Int32(data=STOP)) as lease:
        lease.publish(Int32(data=1))
    late = pair.right.create_subscription(Int32, "speed", None, latched)

    received = await numbers(late, 1)
    if received == [1] and pair.left.context is not pair.right.context:
        received += await numbers(late, 1)
    assert received in ([STOP], [1, STOP])


async def test_a_full_queue_keeps_the_stop(pair: Pair) -> None:
    """It is the newest message; older ones are dropped and counted."""
    wheels = pair.right.create_subscription(Int32, "speed", None, 1)
    commands = pair.left.create_publisher(Int32, "speed", 1)
    await commands.wait_for_subscribers()
    async with commands.lease(stop=Int32(data=STOP)) as lease:
        for number in range(1000):
            lease.publish(Int32(data=number))
    while STOP not in await numbers(wheels, 1):
        pass

    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.3):
            await numbers(wheels, 1)
