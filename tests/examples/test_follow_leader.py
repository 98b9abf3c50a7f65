"""A follower arm does what a leader arm does; the test moves the time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode import Node
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.testing import settle
from examples.learn.follow_leader import Teleoperator

if TYPE_CHECKING:
    import pytest

    from aionode import Context
    from aionode.testing import ManualClock


class Arms:
    """A leader that is moved by hand, and what its follower was told."""

    def __init__(self, clock: ManualClock, node: Node) -> None:
        self.clock = clock
        self.told: list[tuple[float, ...]] = []
        self.joints = node.create_publisher(JointState, "/leader/joint_states", 1)
        node.create_subscription(JointState, "/arm/command", self.take, 10)

    def take(self, command: JointState) -> None:
        """Note a command."""
        told = dict(zip(command.name, command.position, strict=True))
        self.told.append((round(told["shoulder"], 3), round(told["elbow"], 3)))

    async def move(self, shoulder: float, elbow: float) -> None:
        """Move the leader, whose joints have an order of their own, for a thirtieth of a second."""
        self.joints.publish(JointState(name=["elbow", "shoulder"], position=[elbow, shoulder]))
        await self.clock.advance(1 / 30)


async def test_the_follower_goes_where_the_leader_is_within_its_limits(
    aionode_context: Context, manual_clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """By the names of the joints; and it holds still while the leader is silent, then goes on."""
    async with Node("arms", context=aionode_context) as node:
        arms = Arms(manual_clock, node)
        async with Teleoperator():
            await settle()
            for step in range(5):
                await arms.move(0.1 * step, 1.0)
            assert arms.told == [(round(0.1 * step, 3), 1.0) for step in range(5)]

            await arms.move(9.0, -9.0)
            assert arms.told[-1] == (1.5, 0.0)

            before = len(arms.told)
            await manual_clock.advance(2.0)
            assert arms.told[before:] == [(1.5, 0.0)]
            assert "The leader is silent: " in caplog.text

            await arms.move(0.2, 0.3)
            assert arms.told[-1] == (0.2, 0.3)
