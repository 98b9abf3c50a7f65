"""The wheels of `examples/wheels.py`, which docs/howto/stopping.md recommends."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable

import pytest

from aionode import Context, Node, Publisher
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.std_msgs.msg import Empty
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.testing import ManualClock, settle
from examples.wheels import Wheels

FORWARD = Twist(linear=Vector3(x=0.2))


class NotedWheels(Wheels):
    """Notes what the motors are told."""

    def __init__(self, context: Context) -> None:
        self.motors: list[float] = []
        super().__init__(context)

    def set_motors(self, speed: float) -> None:
        """Note the speed."""
        self.motors.append(speed)


@pytest.fixture
async def wheels(aionode_context: Context, manual_clock: ManualClock) -> AsyncIterator[NotedWheels]:
    """Running wheels."""
    async with NotedWheels(aionode_context) as wheels:
        await settle()
        yield wheels


@pytest.fixture
async def commands(
    node_factory: Callable[..., Node], manual_clock: ManualClock
) -> Publisher[Twist]:
    """The publisher of commands for the wheels."""
    return node_factory("driver").create_publisher(Twist, "/cmd_vel", 1)


async def test_the_motors_are_stopped_before_anything_else(wheels: NotedWheels) -> None:
    """They may still turn as the process before this one has left them."""
    assert wheels.motors == [0.0]


async def test_the_motors_stop_when_the_commands_stay_out(
    wheels: NotedWheels, commands: Publisher[Twist], manual_clock: ManualClock
) -> None:
    """The next command moves them again."""
    commands.publish(FORWARD)
    await manual_clock.advance(0.31)
    commands.publish(FORWARD)
    await settle()

    assert wheels.motors == [0.0, 0.2, 0.0, 0.2]


async def test_an_emergency_stop_holds_until_it_is_released(
    wheels: NotedWheels, commands: Publisher[Twist], node_factory: Callable[..., Node]
) -> None:
    """Commands that still come move nothing."""
    person = node_factory("person")
    commands.publish(FORWARD)
    person.create_publisher(Empty, "/emergency_stop", 1).publish(Empty())
    commands.publish(FORWARD)
    await settle()
    assert wheels.motors == [0.0, 0.2, 0.0]

    release = person.create_client(Trigger, "/wheels/release")
    assert (await release.call(Trigger.Request())).success
    commands.publish(FORWARD)
    await settle()
    assert wheels.motors == [0.0, 0.2, 0.0, 0.2]


async def test_the_motors_stop_when_their_own_node_fails(
    aionode_context: Context, commands: Publisher[Twist]
) -> None:
    """At once, and not only when the supervisor has made the next one."""
    wheels = NotedWheels(aionode_context)
    running = asyncio.get_running_loop().create_task(wheels.run())
    await settle()
    commands.publish(FORWARD)
    wheels.create_timer(0.0, lambda: 1 / 0)
    with pytest.raises(ExceptionGroup):
        await running

    assert wheels.motors == [0.0, 0.2, 0.0]
