"""Trajectories of joints, and the controller that follows them."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.errors import GoalRejectedError
from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.control_msgs.action import FollowJointTrajectory
from aionode.interfaces.control_msgs.msg import JointTolerance, JointTrajectoryControllerState
from aionode.interfaces.control_msgs.srv import QueryTrajectoryState
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.programs._ros2_control.trajectories.pid import Pid
from aionode.programs._ros2_control.trajectories.splines import Point, Trajectory
from aionode.programs._ros2_control.trajectories.tolerances import violation
from aionode.testing import settle
from tests.programs.ros2_control.conftest import MOVING, Robot

NUMBERS = st.floats(-10, 10)
TYPE = "joint_trajectory_controller/JointTrajectoryController"

OWN = """
mover:
  ros__parameters:
    joints: [lift, left]
    command_interfaces: [{commands}]
    state_interfaces: [position, velocity]
    {more}
"""

WITH_POSITIONS = MOVING.replace(
    '<command_interface name="velocity"/>\n    <state',
    '<command_interface name="velocity"/> <command_interface name="position"/>\n    <state',
)
"""The robot, whose wheels also take positions."""


@given(st.lists(NUMBERS, min_size=6, max_size=6), st.floats(0.1, 5))
def test_a_spline_meets_all_that_is_known_of_both_ends(values: list[float], time: float) -> None:
    """Positions, velocities and accelerations, as numpy solves it."""
    start, end = values[:3], values[3:]
    trajectory = Trajectory([Point(time, [end[0]], [end[1]], [end[2]])])
    trajectory.begin(Point(0.0, [start[0]], [start[1]], [start[2]]), [False])
    powers = np.array(
        [
            [1, 0, 0, 0, 0, 0],
            [0, 1, 0, 0, 0, 0],
            [0, 0, 2, 0, 0, 0],
            [time**n for n in range(6)],
            [n * time ** max(n - 1, 0) for n in range(6)],
            [n * (n - 1) * time ** max(n - 2, 0) for n in range(6)],
        ]
    )
    factors = np.linalg.solve(powers, np.array([*start, *end]))
    middle = trajectory.sample(time / 2)

    expected = [factors @ [(time / 2) ** n for n in range(6)]]
    expected += [factors @ [n * (time / 2) ** max(n - 1, 0) for n in range(6)]]
    assert [middle.positions[0], middle.velocities[0]] == pytest.approx(expected, 1e-6, 1e-6)


def test_what_is_not_known_of_an_end_is_left_open() -> None:
    """With positions alone the way is straight, with velocities it is cubic."""
    straight = Trajectory([Point(2.0, [4.0])])
    straight.begin(Point(0.0, [0.0]), [False])
    cubic = Trajectory([Point(1.0, [1.0], [0.0])])
    cubic.begin(Point(0.0, [0.0]), [False])

    assert list(straight.sample(0.5).positions) == [1.0]
    assert list(straight.sample(0.5).velocities) == [2.0]
    assert list(cubic.sample(0.25).positions) == [pytest.approx(0.15625)]
    assert list(straight.sample(9.0).positions) == [4.0]


def test_without_splines_joints_jump_to_the_next_point() -> None:
    """Once the first point is reached."""
    trajectory = Trajectory([Point(1.0, [1.0]), Point(2.0, [2.0])], splines=False)
    trajectory.begin(Point(0.0, [0.0]), [False])

    assert [trajectory.sample(each).positions[0] for each in (0.5, 1.5)] == [0.0, 2.0]


def test_a_wheel_turns_the_shorter_way() -> None:
    """From 350° to 10° by 20°."""
    trajectory = Trajectory([Point(1.0, [math.radians(10)])])
    trajectory.begin(Point(0.0, [math.radians(350)]), [True])

    assert trajectory.sample(0.5).positions[0] == pytest.approx(0.0, abs=1e-9)


def way(*points: tuple[float, list[float]], joints: tuple[str, ...] = ("lift", "left")) -> Any:
    """Return a trajectory through positions at times."""
    return JointTrajectory(
        joint_names=list(joints),
        points=[
            JointTrajectoryPoint(
                positions=positions,
                time_from_start=Duration(sec=int(time), nanosec=round(time % 1 * 1e9)),
            )
            for time, positions in points
        ],
    )


Move = Callable[..., Any]


@pytest.fixture
def mover(robot: Callable[..., Any], tmp_path: Path) -> Move:
    """Start the controller for the lift and a wheel."""

    async def make(
        more: str = "allow_partial_joints_goal: false", commands: str = "position"
    ) -> Robot:
        file = tmp_path / "mover.yaml"
        file.write_text(OWN.format(more=more, commands=commands))
        bot: Robot = await robot(
            WITH_POSITIONS, **{"mover.type": TYPE, "mover.params_file": str(file)}
        )
        await bot.start("mover")
        return bot

    return make


def states(bot: Robot) -> list[float]:
    """Return where the joints are."""
    return [bot.manager.hardware.states[f"{each}/position"] for each in ("lift", "left")]


async def test_joints_stay_where_they_are_until_there_is_a_trajectory(mover: Move) -> None:
    """They do not jump when the controller is activated."""
    bot = await mover()
    await bot.pass_time(0.05)

    assert states(bot) == [0.25, 0.0]


async def test_joints_follow_a_trajectory_of_the_topic(mover: Move) -> None:
    """In whatever order it names them, with the state told on the way."""
    bot = await mover()
    told = bot.hear(JointTrajectoryControllerState, "mover/controller_state")
    publisher = bot.user.create_publisher(JointTrajectory, "mover/joint_trajectory", 10)
    publisher.publish(way((1.0, [2.0, 1.25]), joints=("left", "lift")))
    await settle()
    await bot.pass_time(0.5)
    assert states(bot) == pytest.approx([0.75, 1.0], abs=0.03)

    await bot.pass_time(0.6)
    assert states(bot) == pytest.approx([1.25, 2.0])
    assert list(told[-1].joint_names) == ["lift", "left"]
    assert list(told[-1].reference.positions) == [1.25, 2.0]


async def test_a_goal_is_reached_with_feedback_on_the_way(mover: Move) -> None:
    """As MoveIt asks for it."""
    bot = await mover()
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")
    goal = await client.send_goal(FollowJointTrajectory.Goal(trajectory=way((1.0, [1.25, 2.0]))))
    await bot.pass_time(0.5)
    feedback = await anext(aiter(goal))
    await bot.pass_time(0.6)
    result = (await goal.result()).result

    assert list(feedback.joint_names) == ["lift", "left"]
    assert (result.error_code, result.error_string) == (0, "Goal successfully reached!")
    assert states(bot) == pytest.approx([1.25, 2.0])


async def test_a_goal_that_is_cancelled_stops_the_joints_on_the_way(mover: Move) -> None:
    """They stay where they are."""
    bot = await mover()
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")
    goal = await client.send_goal(FollowJointTrajectory.Goal(trajectory=way((1.0, [1.25, 2.0]))))
    await bot.pass_time(0.5)
    await goal.cancel()
    await bot.pass_time(1.0)

    assert states(bot) == pytest.approx([0.75, 1.0], abs=0.05)


async def test_another_trajectory_ends_a_goal(mover: Move) -> None:
    """The last one counts."""
    bot = await mover()
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")
    goal = await client.send_goal(FollowJointTrajectory.Goal(trajectory=way((9.0, [1.25, 2.0]))))
    publisher = bot.user.create_publisher(JointTrajectory, "mover/joint_trajectory", 10)
    publisher.publish(way((0.5, [0.0, 0.0])))
    await settle()
    await bot.pass_time(0.6)

    assert "cancelled due to new incoming trajectory" in (await goal.result()).result.error_string
    assert states(bot) == pytest.approx([0.0, 0.0])


async def test_joints_that_leave_their_trajectory_stop(mover: Move) -> None:
    """Something holds the lift: by the goal's tolerances, or the controller's."""
    bot = await mover("constraints: {lift: {trajectory: 5.0}, goal_time: 1.0}")
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")
    bot.manager.hardware.drivers["Bot"].is_deaf = True
    tolerance = JointTolerance(name="lift", position=0.1)
    goal = await client.send_goal(
        FollowJointTrajectory.Goal(trajectory=way((1.0, [1.25, 2.0])), path_tolerance=[tolerance])
    )
    await bot.pass_time(0.5)
    result = (await goal.result()).result

    assert result.error_code == FollowJointTrajectory.Result.PATH_TOLERANCE_VIOLATED
    assert bot.commands["lift/position"] == 0.25


async def test_joints_that_do_not_arrive_in_time_stop(mover: Move) -> None:
    """After the time in the parameters."""
    bot = await mover("constraints: {lift: {goal: 0.1}, goal_time: 1.0}")
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")
    bot.manager.hardware.drivers["Bot"].is_deaf = True
    goal = await client.send_goal(FollowJointTrajectory.Goal(trajectory=way((1.0, [1.25, 2.0]))))
    await bot.pass_time(2.1)
    result = (await goal.result()).result

    assert result.error_code == FollowJointTrajectory.Result.GOAL_TOLERANCE_VIOLATED
    assert "goal_time_tolerance exceeding by 1.0" in result.error_string


@pytest.mark.parametrize(
    ("trajectory", "problem"),
    [
        (way((1.0, [1.0]), joints=("lift",)), "don't match the controller joints"),
        (way((1.0, [1.0, 2.0]), joints=("lift", "ghost")), "don't match the controller joints"),
        (way(), "Empty trajectory received"),
        (way((1.0, [1.0])), "joint_names size (2) and positions (1) at point #0"),
        (way((1.0, [1.0, math.nan])), "positions at point #0 are not all finite"),
        (way((1.0, [1.0, 2.0]), (1.0, [1.0, 2.0])), "points 0 and 1 is not strictly increasing"),
    ],
)
async def test_a_trajectory_that_cannot_be_followed_is_rejected(
    mover: Move, capfd: pytest.CaptureFixture[str], trajectory: Any, problem: str
) -> None:
    """The log says why."""
    bot = await mover()
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")

    with pytest.raises(GoalRejectedError):
        await client.send_goal(FollowJointTrajectory.Goal(trajectory=trajectory))
    assert problem in capfd.readouterr().err


async def test_a_trajectory_may_leave_joints_out_if_it_may(mover: Move) -> None:
    """These joints stay where they are."""
    bot = await mover("allow_partial_joints_goal: true")
    publisher = bot.user.create_publisher(JointTrajectory, "mover/joint_trajectory", 10)
    publisher.publish(way((0.5, [1.0]), joints=("left",)))
    await settle()
    await bot.pass_time(0.6)

    assert states(bot) == pytest.approx([0.25, 1.0])


async def test_velocities_alone_are_regulated_to_the_position(mover: Move) -> None:
    """By the gains of each joint."""
    gains = "gains: {lift: {p: 20.0, ff_velocity_scale: 1.0}, left: {p: 20.0}}"
    bot = await mover(gains, "velocity")
    publisher = bot.user.create_publisher(JointTrajectory, "mover/joint_trajectory", 10)
    publisher.publish(way((0.5, [1.0, 1.0])))
    await settle()
    await bot.pass_time(1.5)

    assert states(bot) == pytest.approx([1.0, 1.0], abs=0.01)


async def test_where_joints_will_be_can_be_asked(mover: Move) -> None:
    """At a time while they move."""
    bot = await mover()
    publisher = bot.user.create_publisher(JointTrajectory, "mover/joint_trajectory", 10)
    publisher.publish(way((1.0, [1.25, 2.0])))
    await settle()
    await bot.pass_time(0.1)
    client = bot.user.create_client(QueryTrajectoryState, "mover/query_state")
    now = bot.user.get_clock().now().to_msg()
    now.sec += 5
    answer = await client.call(QueryTrajectoryState.Request(time=now))

    assert answer.success
    assert list(answer.position) == [1.25, 2.0]


async def test_deactivating_ends_the_goal_and_holds_the_joints(mover: Move) -> None:
    """At their place."""
    bot = await mover()
    client = bot.user.create_action_client(FollowJointTrajectory, "mover/follow_joint_trajectory")
    goal = await client.send_goal(FollowJointTrajectory.Goal(trajectory=way((1.0, [1.25, 2.0]))))
    await bot.pass_time(0.5)
    assert (await bot.switch([], ["mover"])).ok
    await bot.pass_time(0.5)
    result = (await goal.result()).result

    assert "during deactivate transition" in result.error_string
    assert states(bot) == pytest.approx([0.75, 1.0], abs=0.05)


def test_a_joint_that_is_not_measured_yet_spoils_no_later_command() -> None:
    """An integral of NaN would stay NaN."""
    pid = Pid(1.0, 0.5, 0.0, -math.inf, math.inf, 0.0)

    assert pid.output(math.nan, 0.0, 0.01) == 0.0
    assert pid.output(1.0, 0.0, 0.01) == pytest.approx(1.005)


def test_a_joint_that_is_not_measured_is_within_no_tolerance() -> None:
    """Otherwise a goal would succeed that nobody saw reached."""
    assert violation({"lift": (0.1, 0.0, 0.0)}, Point(0.0, [math.nan]))
