"""The programs while time is simulated and the simulator is silent."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.turtlesim.msg import Pose
from aionode.programs._command_mux.twist_mux import TwistMux
from aionode.programs._diagnostics.aggregator_node import Aggregator
from aionode.programs._lifecycle_manager import Manager
from aionode.programs._teleop_twist_keyboard import Teleop
from aionode.programs._topic_tools.relay import Relay
from aionode.programs._turtlesim.node import TurtleSim
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start


@pytest.mark.parametrize(
    ("program", "parameters", "kind", "topic"),
    [
        (TurtleSim, {}, Pose, "turtle1/pose"),
        (TwistMux, {"topics.a.topic": "a", "topics.a.timeout": 0.5, "topics.a.priority": 9},
         DiagnosticArray, "/diagnostics"),
        (Manager, {"node_names": ["map"]}, DiagnosticArray, "/diagnostics"),
        (Aggregator, {}, DiagnosticArray, "/diagnostics_agg"),
    ],
)  # fmt: skip
async def test_programs_show_themselves_before_the_first_simulated_time(
    start: Start,
    node_factory: Callable[..., Any],
    manual_clock: ManualClock,
    program: Any,
    parameters: dict[str, Any],
    kind: Any,
    topic: str,
) -> None:
    """The originals use wall timers: diagnostics of a robot whose simulator hangs are wanted."""
    heard: list[Any] = []
    start(program, use_sim_time=True, **parameters)
    node_factory("watcher").create_subscription(kind, topic, heard.append)
    await settle()

    await manual_clock.advance(2.5)
    await settle()

    assert len(heard) >= 2


async def test_keys_drive_while_simulated_time_stands_still(
    start: Start, node_factory: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """The lease runs in real time, so its command has to be repeated in real time as well."""
    heard: list[float] = []
    node_factory("wheels").create_subscription(
        Twist, "cmd_vel", lambda msg: heard.append(msg.linear.x)
    )
    shown: list[str] = []
    teleop = start(Teleop, shown.append, use_sim_time=True)
    async with asyncio.TaskGroup() as tasks:
        task = tasks.create_task(teleop.twists.drive())
        await settle()
        teleop.press("i")
        for _ in range(20):
            await manual_clock.advance(0.1)
            await settle()

        assert set(heard) == {0.5}
        assert not shown
        task.cancel()


async def test_topics_are_found_while_simulated_time_stands_still(
    start: Start, node_factory: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """A robot whose simulator is paused has such topics."""
    heard: list[str] = []
    node = node_factory("talker")
    publisher = node.create_publisher(String, "chatter", 10)
    node.create_subscription(String, "chatter_relay", lambda msg: heard.append(msg.data))
    start(Relay, "chatter", use_sim_time=True)
    await manual_clock.advance(0.25)
    await settle()

    publisher.publish(String(data="hello"))
    await settle()

    assert heard == ["hello"]
