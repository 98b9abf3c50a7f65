"""Hardware behind topics: commands go out under a lease, and states come in."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.programs._ros2_control.topic_system import TTL_SEC
from aionode.testing import settle
from tests.programs.ros2_control.conftest import Robot, urdf

PLUGIN = "topic_based_ros2_control/TopicBasedSystem"

ARM = urdf(PLUGIN, joint_commands_topic="/out", joint_states_topic="/in")
"""The robot, whose joints take velocities as well."""

ONLY_POSITIONS = ARM.replace('<command_interface name="velocity"/>', "")


async def say(bot: Robot, *names: str, **values: Any) -> None:
    """Say where joints are."""
    publisher = bot.user.create_publisher(JointState, "/in", 10)
    publisher.publish(JointState(name=list(names), **values))
    await settle()
    await bot.pass_time(0.02)


async def drive(bot: Robot, speed: float) -> None:
    """Command the base."""
    publisher = bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10)
    publisher.publish(TwistStamped(twist=Twist(linear=Vector3(x=speed))))
    await settle()


def speeds(msgs: list[Any]) -> list[float]:
    """Return the velocities of the left wheel."""
    return [msg.velocity[list(msg.name).index("left")] for msg in msgs]


async def test_states_come_from_a_topic(robot: Callable[..., Any]) -> None:
    """The states include those of a joint that mimics another."""
    bot = await robot(ARM)
    await say(bot, "lift", "left", "unknown", position=[0.5, 3.0, 1.0], velocity=[0.0, 2.0, 1.0])
    states = bot.manager.hardware.states

    assert states["lift/position"] == 0.5
    assert states["grip/position"] == pytest.approx(0.35)
    assert (states["left/position"], states["left/velocity"]) == (3.0, 2.0)


async def test_turns_are_summed_if_the_states_are_wrapped(robot: Callable[..., Any]) -> None:
    """As some simulators have them."""
    bot = await robot(urdf(PLUGIN, joint_states_topic="/in", sum_wrapped_joint_states="true"))
    for angle in (3.0, -3.0, 0.0, 3.0):
        await say(bot, "left", position=[angle])

    assert bot.manager.hardware.states["left/position"] == pytest.approx(3.0 + 2 * math.pi)


async def test_positions_are_commanded_until_the_joints_are_there(
    robot: Callable[..., Any],
) -> None:
    """Nothing is repeated afterwards."""
    bot = await robot(ONLY_POSITIONS)
    out = bot.hear(JointState, "/out")
    await say(bot, "lift", position=[0.25])
    await bot.start("arm")
    bot.user.create_publisher(Float64MultiArray, "arm/commands", 10).publish(
        Float64MultiArray(data=[0.5])
    )
    await settle()
    await bot.pass_time(0.05)
    assert out[-1].position[list(out[-1].name).index("lift")] == 0.5

    await say(bot, "lift", position=[0.5])
    out.clear()
    await bot.pass_time(0.1)
    assert out == []


async def test_velocities_are_repeated_and_stop_with_their_controller(
    robot: Callable[..., Any],
) -> None:
    """The wheels would turn on."""
    bot = await robot(ARM, base="cmd_vel_timeout: 0.0")
    out = bot.hear(JointState, "/out")
    await say(bot, "left", "right", position=[0.0, 0.0])
    await bot.start("base")
    await drive(bot, 0.5)
    await bot.pass_time(0.1)
    assert len(out) > 5
    assert speeds(out)[-1] == pytest.approx(5.0)

    assert (await bot.switch([], ["base"])).ok
    await bot.pass_time(0.02)
    assert speeds(out)[-1] == 0.0


async def test_hardware_that_is_deactivated_is_stopped(robot: Callable[..., Any]) -> None:
    """The stop is the last command."""
    bot = await robot(ARM, base="cmd_vel_timeout: 0.0")
    out = bot.hear(JointState, "/out")
    await say(bot, "left", "right", position=[0.0, 0.0])
    await bot.start("base")
    await drive(bot, 0.5)
    await bot.pass_time(0.1)
    bot.manager.hardware.set_state("Bot", State.PRIMARY_STATE_INACTIVE)
    await settle()
    await bot.pass_time(0.1)

    assert speeds(out)[-2:] == [pytest.approx(5.0), 0.0]


async def test_controllers_that_are_not_updated_any_more_stop_the_wheels(
    robot: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the lease, whatever they commanded last."""
    bot = await robot(ARM, base="cmd_vel_timeout: 0.0")
    out = bot.hear(JointState, "/out")
    await say(bot, "left", "right", position=[0.0, 0.0])
    await bot.start("base")
    await drive(bot, 0.5)
    await bot.pass_time(0.1)
    monkeypatch.setattr(bot.manager.hardware, "write", lambda: None)
    await bot.pass_time(TTL_SEC + 0.1)

    assert speeds(out)[-2:] == [pytest.approx(5.0), 0.0]


async def test_nobody_but_the_manager_changes_the_state_of_a_controller(
    robot: Callable[..., Any],
) -> None:
    """The wheels would go on: the manager renews the lease, and only it takes interfaces back."""
    bot = await robot(ARM)
    await bot.start("base")

    assert not [
        name for name, _ in bot.user.get_service_names_and_types() if "/base/change" in name
    ]


async def test_what_a_controller_moved_stops_when_its_interfaces_are_taken_back(
    robot: Callable[..., Any],
) -> None:
    """Whatever the controller did at its end."""
    bot = await robot(ARM)
    await bot.start("base")
    await drive(bot, 0.5)
    await bot.pass_time(0.05)
    assert bot.commands["left/velocity"] > 0

    bot.manager.hardware.release("base")

    assert bot.commands["left/velocity"] == 0.0


async def test_a_command_from_the_future_does_not_put_the_timeout_off(
    robot: Callable[..., Any],
) -> None:
    """The clock of a teleoperation machine may be ahead."""
    bot = await robot(ARM)
    await bot.start("base")
    publisher = bot.user.create_publisher(TwistStamped, "base/cmd_vel", 10)
    command = TwistStamped(twist=Twist(linear=Vector3(x=0.5)))
    now = bot.manager.get_clock().now().nanoseconds + 60 * 10**9
    command.header.stamp.sec, command.header.stamp.nanosec = divmod(now, 10**9)
    publisher.publish(command)
    await settle()
    await bot.pass_time(0.05)
    assert bot.commands["left/velocity"] > 0

    for _ in range(10):
        await bot.pass_time(0.1)

    assert bot.commands["left/velocity"] == 0.0


async def test_wheels_that_are_not_measured_yet_spoil_no_odometry(
    robot: Callable[..., Any],
) -> None:
    """The driver may come after the spawner."""
    bot = await robot(ARM)
    odometry = bot.hear(Odometry, "base/odom")
    await bot.start("base")
    await bot.pass_time(0.1)
    await say(bot, "left", "right", position=[0.0, 0.0], velocity=[0.0, 0.0])
    for _ in range(5):
        await bot.pass_time(0.1)

    assert odometry[-1].pose.pose.position.x == 0.0
