"""Stands in for the drivers of small robots, for programs from the robots' own repositories to try.

``python -m tests.programs.small_robots`` runs until Ctrl-C: a flight controller behind the
uXRCE-DDS agent (PX4) and one behind MAVROS, an arm of Universal Robots, and a Create 3, as under a
TurtleBot 4. Each answers what a first program asks of it, and logs what it was told.
"""

from __future__ import annotations

import asyncio
from typing import Any

import aionode
from aionode import Node
from aionode.action import ActionServer, ServerGoalHandle
from aionode.interfaces.control_msgs.action import FollowJointTrajectory
from aionode.interfaces.irobot_create_msgs.action import DriveDistance, Undock
from aionode.interfaces.mavros_msgs.msg import State
from aionode.interfaces.mavros_msgs.srv import CommandBool, SetMode
from aionode.interfaces.px4_msgs.msg import OffboardControlMode, TrajectorySetpoint, VehicleStatus
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

__all__ = ["Arm", "Create3", "FlightController", "Mavros"]

FROM_PX4 = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
"""How the agent publishes, and what it subscribes with."""
TO_PX4 = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class FlightController(Node):
    """PX4 behind its agent: armed and in offboard mode while commanded to be."""

    def __init__(self, **options: Any) -> None:
        super().__init__("px4", **options)
        self.setpoints = 0
        self.status = self.create_publisher(VehicleStatus, "/fmu/out/vehicle_status", FROM_PX4)
        self.create_subscription(
            OffboardControlMode, "/fmu/in/offboard_control_mode", self.stay, TO_PX4
        )
        self.create_subscription(
            TrajectorySetpoint, "/fmu/in/trajectory_setpoint", self.fly, TO_PX4
        )

    def stay(self, _mode: OffboardControlMode) -> None:
        """Report that it flies as commanded."""
        self.status.publish(
            VehicleStatus(
                arming_state=VehicleStatus.ARMING_STATE_ARMED,
                nav_state=VehicleStatus.NAVIGATION_STATE_OFFBOARD,
            )
        )

    def fly(self, setpoint: TrajectorySetpoint) -> None:
        """Count a setpoint, and log the first one."""
        self.setpoints += 1
        if self.setpoints == 1:
            self.get_logger().info(f"PX4 flies to {[float(x) for x in setpoint.position]}")


class Mavros(Node):
    """MAVROS: a mode, and whether the motors are armed."""

    def __init__(self, **options: Any) -> None:
        super().__init__("mavros", **options)
        self.state = State(connected=True, mode="STABILIZED")
        self.states = self.create_publisher(State, "/mavros/state", 10)
        self.create_service(CommandBool, "/mavros/cmd/arming", self.arm)
        self.create_service(SetMode, "/mavros/set_mode", self.set_mode)
        self.create_timer(0.1, lambda: self.states.publish(self.state))

    def arm(self, request: CommandBool.Request) -> CommandBool.Response:
        """Arm or disarm."""
        self.state.armed = request.value
        self.get_logger().info(f"MAVROS: armed is {request.value}")
        return CommandBool.Response(success=True)

    def set_mode(self, request: SetMode.Request) -> SetMode.Response:
        """Change the mode."""
        self.state.mode = request.custom_mode
        self.get_logger().info(f"MAVROS: the mode is {request.custom_mode}")
        return SetMode.Response(mode_sent=True)


class Arm(Node):
    """An arm under ros2_control, which reaches the end of a trajectory at once."""

    def __init__(self, **options: Any) -> None:
        super().__init__("controller_manager", **options)
        for name in ("joint_trajectory_controller", "scaled_joint_trajectory_controller"):
            ActionServer(self, FollowJointTrajectory, f"/{name}/follow_joint_trajectory", self.move)

    def move(self, handle: ServerGoalHandle[Any, Any, Any]) -> FollowJointTrajectory.Result:
        """Follow a trajectory."""
        trajectory = handle.request.trajectory
        self.get_logger().info(
            f"the arm ends at {[float(x) for x in trajectory.points[-1].positions]}"
        )
        handle.succeed()
        return FollowJointTrajectory.Result(error_code=FollowJointTrajectory.Result.SUCCESSFUL)


class Create3(Node):
    """A Create 3 on its dock."""

    def __init__(self, **options: Any) -> None:
        super().__init__("motion_control", **options)
        ActionServer(self, Undock, "/undock", self.undock)
        ActionServer(self, DriveDistance, "/drive_distance", self.drive)

    def undock(self, handle: ServerGoalHandle[Any, Any, Any]) -> Undock.Result:
        """Leave the dock."""
        self.get_logger().info("the Create 3 leaves its dock")
        handle.succeed()
        return Undock.Result(is_docked=False)

    def drive(self, handle: ServerGoalHandle[Any, Any, Any]) -> DriveDistance.Result:
        """Drive ahead."""
        self.get_logger().info(f"the Create 3 drives {handle.request.distance} m")
        handle.succeed()
        result = DriveDistance.Result()
        result.pose.pose.position.x = handle.request.distance
        return result


async def main() -> None:
    """Run all of them until Ctrl-C."""
    async with FlightController(), Mavros(), Arm(), Create3():
        await asyncio.Event().wait()


if __name__ == "__main__":
    aionode.run(main)
