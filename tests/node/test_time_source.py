"""Tests of simulated time: nodes that follow /clock."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from aionode.clock import ClockType, Time
from aionode.engine.context import Context
from aionode.errors import TimeSourceChangedError
from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from aionode.node import Node
from aionode.parameter import Parameter
from aionode.qos import QoSProfile
from aionode.testing import ManualClock, settle

if TYPE_CHECKING:
    from collections.abc import Callable


async def test_simulated_time_follows_the_clock_topic(context: Context, node: Node) -> None:
    """It stands at 0 until the first tick, and timers wait for it."""
    ticks: list[int] = []
    options = {"parameter_overrides": [Parameter("use_sim_time", value=True)]}
    async with Node("sim", context=context, **options) as sim:  # type: ignore[arg-type]  # one of many options
        clock = sim.get_clock()
        assert clock.now() == Time(clock_type=ClockType.ROS_TIME)
        sim.create_timer(1.0, lambda: ticks.append(clock.now().nanoseconds))
        source = node.create_publisher(ClockMsg, "/clock", QoSProfile(depth=1))
        for second in (0, 1, 2):
            source.publish(ClockMsg(clock=TimeMsg(sec=second)))
            await settle()
    assert ticks == [1_000_000_000, 2_000_000_000]


async def test_simulated_time_can_be_switched_on_and_off(node: Node) -> None:
    """Pending sleeps get an error, since the source of time has changed."""
    sleeping = asyncio.get_running_loop().create_task(node.get_clock().sleep(999))
    await settle()
    node.set_parameters([Parameter("use_sim_time", value=True)])
    with pytest.raises(TimeSourceChangedError):
        await sleeping
    assert node.get_clock().ros_time_is_active
    node.set_parameters([Parameter("use_sim_time", value=False)])
    assert not node.get_clock().ros_time_is_active
    assert node.count_subscribers("/clock") == 0


async def test_a_node_that_was_given_simulated_time_while_it_ran_ends_at_once(
    context: Context, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its end waits for callbacks; the one that follows /clock continues until they have ended."""
    async with Node("sim", context=context) as sim:
        sim.set_parameters([Parameter("use_sim_time", value=True)])
        await settle()

    assert "the node ends" not in capsys.readouterr().err


async def test_a_callback_sleeps_in_finally_on_simulated_time_that_was_set_while_it_ran(
    context: Context, node: Node
) -> None:
    """A robot may need a second of simulated time to come to rest."""
    slept: list[int] = []
    source = node.create_publisher(ClockMsg, "/clock", QoSProfile(depth=1))

    async with Node("sim", context=context) as sim:

        async def drive() -> None:
            try:
                await asyncio.Event().wait()
            finally:
                await sim.get_clock().sleep(1.0)
                slept.append(sim.get_clock().now_ns())

        sim.create_timer(0.0, drive)
        sim.set_parameters([Parameter("use_sim_time", value=True)])
        source.publish(ClockMsg(clock=TimeMsg(sec=1)))
        await settle()
        sim.destroy_node()
        await settle()
        source.publish(ClockMsg(clock=TimeMsg(sec=2)))

    assert slept == [2_000_000_000]


async def test_use_sim_time_must_be_true_or_false(node: Node) -> None:
    """A typo must not freeze a robot."""
    (result,) = node.set_parameters([Parameter("use_sim_time", value="yes")])
    assert not result.successful


@pytest.mark.parametrize(
    "wrong", [TimeMsg(sec=-1), TimeMsg(nanosec=10**9), TimeMsg(nanosec=2**32 - 1)]
)
async def test_a_clock_message_that_holds_no_time_is_counted(
    node: Node,
    node_factory: Callable[..., Node],
    wrong: TimeMsg,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Any node can publish on /clock; an invalid message must not end nodes that follow it."""
    sim = node_factory("sim", parameter_overrides=[Parameter("use_sim_time", value=True)])
    source = node.create_publisher(ClockMsg, "/clock", QoSProfile(depth=10))
    for clock in (TimeMsg(sec=1), wrong, wrong, TimeMsg(sec=2)):
        source.publish(ClockMsg(clock=clock))
        await settle()

    assert sim.is_running
    assert sim.get_clock().now() == Time(seconds=2, clock_type=ClockType.ROS_TIME)
    (subscription,) = sim.subscriptions
    assert subscription.stats.errors == 2
    assert capsys.readouterr().err.count("/clock: ignored an invalid time") == 1


async def test_the_log_says_it_if_nobody_publishes_simulated_time(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Otherwise the node would silently stand still; a simulator may need some seconds to start."""
    clock = ManualClock()
    options = {"parameter_overrides": [Parameter("use_sim_time", value=True)]}
    context = Context(transport="local", clock=clock)
    async with Node("sim", context=context, **options):  # type: ignore[arg-type]  # one of many options
        await clock.advance(4.9)
        assert caplog.messages == []
        await clock.advance(600)

    (said,) = caplog.messages
    assert "use_sim_time is true, and nobody publishes /clock" in said
    assert "aionode bag play --clock" in said


async def test_the_log_names_who_publishes_no_simulated_time(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A simulator that starts paused is an example."""
    clock = ManualClock()
    context = Context(transport="local", clock=clock)
    async with Node("sim", context=context) as sim, Node("gazebo", context=context) as gazebo:
        sim.set_parameters([Parameter("use_sim_time", value=True)])
        gazebo.create_publisher(ClockMsg, "/clock", QoSProfile(depth=1))
        await clock.advance(6)

    assert ["/gazebo has published no time on /clock" in text for text in caplog.messages] == [True]


@pytest.mark.parametrize("switched_off", [True, False])
async def test_nothing_is_said_of_simulated_time_that_comes_or_is_not_wanted(
    caplog: pytest.LogCaptureFixture, *, switched_off: bool
) -> None:
    """A first time of 0 counts as one."""
    clock = ManualClock()
    context = Context(transport="local", clock=clock)
    async with Node("sim", context=context) as sim, Node("gazebo", context=context) as gazebo:
        source = gazebo.create_publisher(ClockMsg, "/clock", QoSProfile(depth=1))
        sim.set_parameters([Parameter("use_sim_time", value=True)])
        if switched_off:
            sim.set_parameters([Parameter("use_sim_time", value=False)])
        else:
            source.publish(ClockMsg())
        await clock.advance(600)

    assert caplog.messages == []
