"""``joint_trajectory_controller``: moves joints along trajectories, from a topic or an action."""

from __future__ import annotations

import asyncio
import math
from dataclasses import dataclass
from typing import Any, Final

from aionode import CancelResponse, GoalResponse, Time
from aionode.errors import CommandError
from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.control_msgs.action import FollowJointTrajectory
from aionode.interfaces.control_msgs.msg import JointTrajectoryControllerState
from aionode.interfaces.control_msgs.srv import QueryTrajectoryState
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.lifecycle import State, TransitionCallbackReturn
from aionode.programs._ros2_control.controller import Controller
from aionode.programs._ros2_control.hardware import Hardware
from aionode.programs._ros2_control.trajectories.check import TrajectoryCheck
from aionode.programs._ros2_control.trajectories.pid import Pid
from aionode.programs._ros2_control.trajectories.splines import Point, Trajectory, shortest_way
from aionode.programs._ros2_control.trajectories.tolerances import Tolerances
from aionode.programs._stamps import nanoseconds

__all__ = ["JointTrajectoryController"]

KINDS: Final = {
    "position": "positions",
    "velocity": "velocities",
    "acceleration": "accelerations",
    "effort": "efforts",
}
"""The field of a point with the values of an interface."""

DEFAULTS: Final[dict[str, Any]] = {
    "joints": [""],
    "command_joints": [""],
    "command_interfaces": [""],
    "state_interfaces": [""],
    "allow_partial_joints_goal": False,
    "open_loop_control": False,
    "interpolate_from_desired_state": False,
    "set_last_command_interface_value_as_state_on_activation": True,
    "action_monitor_rate": 20.0,
    "interpolation_method": "splines",
    "allow_nonzero_velocity_at_trajectory_end": False,
    "cmd_timeout": 0.0,
}

Result = FollowJointTrajectory.Result


@dataclass
class Goal:
    """A goal of the action.

    Attributes:
        handle: Its handle.
        end: How it ends, as an error code and a text.
        told_ns: When feedback was last published.
    """

    handle: Any
    end: asyncio.Future[tuple[int, str]]
    told_ns: int = 0


class JointTrajectoryController(Controller):
    """Follows the last trajectory of `~/joint_trajectory` or `~/follow_joint_trajectory`.

    Without a trajectory, when one is cancelled, and when the joints deviate too far from it, the
    joints stay where they are.
    """

    def __init__(self, name: str, hardware: Hardware, **options: Any) -> None:
        super().__init__(name, hardware, **options)
        self.given = {
            key: self.declare_parameter(key, each).value for key, each in DEFAULTS.items()
        }
        self.joints = [each for each in self.given["joints"] if each]
        self.gains = {joint: Pid.declared(self, joint) for joint in self.joints}
        self.usual = Tolerances.declared(self, self.joints)
        known = self.hardware.description.robot.joints
        self.wraps = [each in known and known[each].kind == "continuous" for each in self.joints]
        self.tolerances = self.usual
        self.trajectory: Trajectory | None = None
        self.start_ns = 0
        self.is_holding = True
        self.goal: Goal | None = None
        self.desired: Point | None = None
        self.create_lifecycle_subscription(
            JointTrajectory, "~/joint_trajectory", self.on_trajectory, 10
        )
        self.states = self.create_publisher(
            JointTrajectoryControllerState, "~/controller_state", 10
        )
        self.create_action_server(
            FollowJointTrajectory,
            "~/follow_joint_trajectory",
            self.execute,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
        )
        self.create_service(QueryTrajectoryState, "~/query_state", self.query)

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Check the parameters.

        Raises:
            CommandError: A parameter is invalid.
        """
        chosen = {
            key: [each for each in self.given[key] if each]
            for key in ("command_joints", "command_interfaces", "state_interfaces")
        }
        if not self.joints:
            raise CommandError("parameter 'joints' is empty; name the joints to move")
        self.movers = chosen["command_joints"] or self.joints
        if len(self.movers) != len(self.joints):
            raise CommandError(
                "parameter 'command_joints' differs in length from 'joints'; passive joints are "
                "not supported"
            )
        for key in ("command_interfaces", "state_interfaces"):
            if not chosen[key] or not set(chosen[key]) <= set(KINDS):
                raise CommandError(
                    f"parameter '{key}' is {chosen[key]}; choose from {', '.join(KINDS)}"
                )
        if "position" not in chosen["state_interfaces"]:
            raise CommandError("parameter 'state_interfaces' lacks position; add it")
        self.outputs, self.inputs = chosen["command_interfaces"], chosen["state_interfaces"]
        self.command_names = [f"{each}/{kind}" for kind in self.outputs for each in self.movers]
        self.state_names = [f"{each}/{kind}" for kind in self.inputs for each in self.joints]
        # A velocity or an effort alone does not lead to a position: a PID corrects the error.
        self.is_regulated = self.outputs in (["velocity"], ["effort"])
        return super().on_configure(state)

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Stay where the joints are, or where they were told to be last."""
        point = self.current()
        last = [self.hardware.commands.get(f"{each}/position", math.nan) for each in self.movers]
        if self.given["set_last_command_interface_value_as_state_on_activation"] and all(
            map(math.isfinite, last)
        ):
            point = Point(0.0, last)
        self.tolerances, self.desired = self.usual, None
        for pid in self.gains.values():
            pid.reset()
        self.hold(point)
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """End the goal, and stay; velocities and efforts end as their interfaces are released."""
        self.end_goal(Result.INVALID_GOAL, "Current goal cancelled during deactivate transition.")
        if "position" in self.outputs:
            for joint, mover in zip(self.joints, self.movers, strict=True):
                self.hardware.commands[f"{mover}/position"] = self.hardware.states[
                    f"{joint}/position"
                ]
        self.trajectory = None
        return super().on_deactivate(state)

    def current(self) -> Point:
        """Return where the joints are."""
        values = {
            KINDS[kind]: [self.hardware.states[f"{each}/{kind}"] for each in self.joints]
            for kind in self.inputs
        }
        return Point(0.0, **values)

    def hold(self, point: Point) -> None:
        """Stay at a point."""
        self.trajectory = Trajectory([Point(0.0, point.positions)])
        self.start_ns = 0
        self.is_holding = True

    def problem(self, msg: JointTrajectory) -> str:
        """Return why a trajectory cannot be followed; empty if it can."""
        if self.lifecycle_state.label != "active":
            return "Can't accept new action goals. Controller is not running."
        check = TrajectoryCheck(
            self.joints,
            self.given["allow_partial_joints_goal"],
            "effort" in self.outputs,
            self.given["allow_nonzero_velocity_at_trajectory_end"],
        )
        return check.problem(msg, self.get_clock().now().nanoseconds)

    def follow(self, msg: JointTrajectory) -> None:
        """Follow a trajectory from the next update on."""
        here = (self.desired or self.current()).complete()
        places = {name: index for index, name in enumerate(msg.joint_names)}

        def ordered(given: Any, others: Any) -> list[float]:
            """Return values in the order of the joints; others stay where they are."""
            if not len(given):
                return []
            return [
                float(given[places[joint]]) if joint in places else float(other)
                for joint, other in zip(self.joints, others, strict=True)
            ]

        zeros = [0.0] * len(self.joints)
        self.trajectory = Trajectory(
            [
                Point(
                    nanoseconds(each.time_from_start) / 1e9,
                    ordered(each.positions, here.positions),
                    ordered(each.velocities, zeros),
                    ordered(each.accelerations, zeros),
                    ordered(each.effort, zeros),
                )
                for each in msg.points
            ],
            splines=self.given["interpolation_method"] != "none",
        )
        self.start_ns = nanoseconds(msg.header.stamp)
        self.is_holding = False

    def on_trajectory(self, msg: JointTrajectory) -> None:
        """Follow a trajectory in place of another one."""
        if problem := self.problem(msg):
            self.get_logger().error(problem)
            return
        self.end_goal(Result.INVALID_GOAL, "Current goal cancelled due to new incoming trajectory.")
        self.tolerances = self.usual
        self.follow(msg)

    def on_goal(self, goal: FollowJointTrajectory.Goal) -> GoalResponse:
        """Accept a goal that can be followed."""
        self.get_logger().info("Received new action goal")
        if problem := self.problem(goal.trajectory):
            self.get_logger().error(problem)
            return GoalResponse.REJECT
        self.get_logger().info("Accepted new action goal")
        return GoalResponse.ACCEPT

    def on_cancel(self, _handle: Any) -> CancelResponse:
        """Accept every request to stop."""
        self.get_logger().info("Got request to cancel goal")
        return CancelResponse.ACCEPT

    async def execute(self, handle: Any) -> FollowJointTrajectory.Result:
        """Follow the trajectory of a goal, in place of another one."""
        self.end_goal(Result.INVALID_GOAL, "Current goal cancelled due to new incoming action.")
        goal = self.goal = Goal(handle, asyncio.get_running_loop().create_future())
        self.tolerances, problem = self.usual.of_goal(handle.request)
        if problem:
            self.get_logger().error(problem)
        self.follow(handle.request.trajectory)
        try:
            code, text = await goal.end
        except asyncio.CancelledError:
            if self.goal is goal:
                self.goal = None
                self.hold(self.current())
            raise
        result = Result(error_code=code, error_string=text)
        if code == Result.SUCCESSFUL:
            handle.succeed()
        else:
            handle.abort(error_text=text)
        return result

    def end_goal(self, code: int, text: str) -> None:
        """End the goal, if there is one."""
        goal, self.goal = self.goal, None
        if goal is not None and not goal.end.done():
            goal.end.set_result((code, text))

    def update(self, now: Time, period_sec: float) -> None:
        """Move the joints along the trajectory, unless they have deviated too far from it."""
        trajectory = self.trajectory
        if trajectory is None:
            return
        here = self.current()
        is_first = not trajectory.has_begun
        if is_first:
            self.start_ns = self.start_ns or now.nanoseconds
        passed = (now.nanoseconds - self.start_ns) / 1e9
        if is_first:
            is_open = (
                self.given["open_loop_control"] or self.given["interpolate_from_desired_state"]
            )
            start = self.desired if is_open and self.desired is not None else here
            trajectory.begin(
                Point(passed, start.positions, start.velocities, start.accelerations), self.wraps
            )
        desired = trajectory.sample(passed)
        error = self.error(here, desired)
        if self.is_left(trajectory, passed, error, is_first=is_first):
            self.hold(here)
        else:
            self.command(trajectory.sample(passed + period_sec), error, period_sec)
        self.tell(now, here, desired, error)

    def is_left(
        self, trajectory: Trajectory, passed: float, error: Point, *, is_first: bool
    ) -> bool:
        """Return whether joints are too far from the trajectory; end a goal that is over."""
        if self.is_holding:
            return False
        late = passed - trajectory.end_sec
        logger = self.get_logger()
        if (late < 0 or is_first) and (problem := self.tolerances.on_the_way(error)):
            logger.warning(f"Aborted due to state tolerance violation: {problem}")
            text = "Aborted due to path tolerance violation"
            self.end_goal(Result.PATH_TOLERANCE_VIOLATED, text)
            return True
        if late < 0:
            return False
        problem = self.tolerances.at_the_end(error)
        if not problem:
            if self.goal is not None:
                logger.info("Goal reached, success!")
                self.is_holding = True
            self.end_goal(Result.SUCCESSFUL, "Goal successfully reached!")
        elif 0 < self.tolerances.goal_time_sec < late:
            text = f"Aborted due to goal_time_tolerance exceeding by {late:f} seconds"
            logger.warning(f"{text}: {problem}")
            self.end_goal(Result.GOAL_TOLERANCE_VIOLATED, text)
            return True
        timeout = self.given["cmd_timeout"]
        if timeout > self.usual.goal_time_sec and late > timeout:
            logger.warning("Aborted due to command timeout")
            return True
        return False

    def error(self, here: Point, desired: Point) -> Point:
        """Return how far the joints are from where they are to be."""

        def missing(kind: str) -> list[float]:
            found = getattr(here, kind)
            return [a - b for a, b in zip(getattr(desired, kind), found, strict=False)]

        positions = [
            shortest_way(is_at, to) if is_endless else to - is_at
            for is_at, to, is_endless in zip(
                here.positions, desired.positions, self.wraps, strict=True
            )
        ]
        return Point(0.0, positions, missing("velocities"), missing("accelerations"))

    def command(self, wanted: Point, error: Point, period_sec: float) -> None:
        """Write the commands for the next period."""
        for kind in self.outputs:
            values = list(getattr(wanted, KINDS[kind]))
            if self.is_regulated:
                speeds = error.velocities or [0.0] * len(values)
                values = [
                    pid.forward * speed
                    + (effort if kind == "effort" else 0.0)
                    + pid.output(position_error, speed_error, period_sec)
                    for pid, speed, effort, position_error, speed_error in zip(
                        self.gains.values(),
                        wanted.velocities,
                        wanted.efforts,
                        error.positions,
                        speeds,
                        strict=True,
                    )
                ]
            names = (f"{each}/{kind}" for each in self.movers)
            self.hardware.commands |= dict(zip(names, values, strict=True))
        self.desired = wanted

    def tell(self, now: Time, here: Point, desired: Point, error: Point) -> None:
        """Publish the state, and feedback of the goal."""
        goal = self.goal
        if self.states.get_subscription_count():
            state = JointTrajectoryControllerState(
                joint_names=self.joints,
                reference=message(desired),
                feedback=message(here),
                error=message(error),
                output=message(self.desired or here),
                speed_scaling_factor=1.0,
            )
            state.header.stamp = now.to_msg()
            self.states.publish(state)
        rate = self.given["action_monitor_rate"]
        if goal is None or (now.nanoseconds - goal.told_ns) * rate < 1e9:
            return
        goal.told_ns = now.nanoseconds
        feedback = FollowJointTrajectory.Feedback(
            joint_names=self.joints,
            desired=message(desired),
            actual=message(here),
            error=message(error),
        )
        feedback.header.stamp = now.to_msg()
        goal.handle.publish_feedback(feedback)

    def query(
        self, request: QueryTrajectoryState.Request, response: QueryTrajectoryState.Response
    ) -> QueryTrajectoryState.Response:
        """Return the desired state of the joints at a time."""
        trajectory = self.trajectory
        if self.lifecycle_state.label != "active" or trajectory is None or not self.start_ns:
            response.message = "Can't sample trajectory. Controller is not active."
            return response
        point = trajectory.sample((nanoseconds(request.time) - self.start_ns) / 1e9)
        response.success = True
        response.name = self.joints
        response.position = list(point.positions)
        response.velocity = list(point.velocities)
        response.acceleration = list(point.accelerations)
        return response


def message(point: Point) -> JointTrajectoryPoint:
    """Return a point as a message."""
    whole, rest = divmod(round(point.time_sec * 1e9), 10**9)
    return JointTrajectoryPoint(
        positions=list(point.positions),
        velocities=list(point.velocities),
        accelerations=list(point.accelerations),
        effort=list(point.efforts),
        time_from_start=Duration(sec=whole, nanosec=rest),
    )
