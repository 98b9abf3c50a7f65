"""The stand-ins for small robots answer as their first programs expect it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from aionode import Node
from aionode.action import ActionClient
from aionode.interfaces.control_msgs.action import FollowJointTrajectory
from aionode.interfaces.irobot_create_msgs.action import DriveDistance
from aionode.interfaces.mavros_msgs.msg import State
from aionode.interfaces.mavros_msgs.srv import CommandBool, SetMode
from aionode.interfaces.px4_msgs.msg import OffboardControlMode, TrajectorySetpoint, VehicleStatus
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.testing import settle
from tests.programs.small_robots import FROM_PX4, TO_PX4, Arm, Create3, FlightController, Mavros

Factory = Callable[..., Any]


async def test_px4_flies_while_commanded_to(node_factory: Factory) -> None:
    """With the QoS of its agent: best effort, and transient local from it."""
    flown: FlightController = node_factory(FlightController)
    pilot: Node = node_factory("pilot")
    seen: list[VehicleStatus] = []
    pilot.create_subscription(VehicleStatus, "/fmu/out/vehicle_status", seen.append, TO_PX4)
    mode = pilot.create_publisher(OffboardControlMode, "/fmu/in/offboard_control_mode", FROM_PX4)
    to = pilot.create_publisher(TrajectorySetpoint, "/fmu/in/trajectory_setpoint", FROM_PX4)
    async with flown, pilot:
        await settle()
        mode.publish(OffboardControlMode(position=True))
        to.publish(TrajectorySetpoint(position=[1.0, 0.0, -5.0]))
        await settle()

        assert seen[-1].arming_state == VehicleStatus.ARMING_STATE_ARMED
        assert flown.setpoints == 1


async def test_mavros_arms_and_changes_its_mode(node_factory: Factory) -> None:
    """By its services; the state says what has come of it."""
    mavros: Mavros = node_factory(Mavros)
    pilot: Node = node_factory("pilot")
    arm = pilot.create_client(CommandBool, "/mavros/cmd/arming")
    change = pilot.create_client(SetMode, "/mavros/set_mode")
    states = pilot.create_subscription(State, "/mavros/state")
    async with mavros, pilot:
        assert (await change.call(SetMode.Request(custom_mode="OFFBOARD"))).mode_sent
        assert (await arm.call(CommandBool.Request(value=True))).success
        state = await states.receive()
        while not state.armed:
            state = await states.receive()

    assert (state.connected, state.mode) == (True, "OFFBOARD")


async def test_an_arm_follows_a_trajectory(node_factory: Factory) -> None:
    """Under the name of ros2_control's controller."""
    arm: Arm = node_factory(Arm)
    client: Node = node_factory("client")
    name = "/scaled_joint_trajectory_controller/follow_joint_trajectory"
    async with arm, client:
        points = [JointTrajectoryPoint(positions=[0.0, -1.57])]
        goal = FollowJointTrajectory.Goal(trajectory=JointTrajectory(points=points))
        handle = await ActionClient(client, FollowJointTrajectory, name).send_goal(goal)
        result = await handle.result()

    assert result.result.error_code == FollowJointTrajectory.Result.SUCCESSFUL


async def test_a_create_3_drives(node_factory: Factory) -> None:
    """By the action of its base."""
    base: Create3 = node_factory(Create3)
    client: Node = node_factory("client")
    async with base, client:
        drive = ActionClient(client, DriveDistance, "/drive_distance")
        result = await (await drive.send_goal(DriveDistance.Goal(distance=0.5))).result()

    assert result.result.pose.pose.position.x == 0.5
