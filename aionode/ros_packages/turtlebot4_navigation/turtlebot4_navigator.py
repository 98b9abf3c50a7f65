"""`turtlebot4_navigation.turtlebot4_navigator`: gives a TurtleBot 4 tasks, and docks it."""

from __future__ import annotations

import math
import select
import sys
from collections.abc import Callable
from enum import IntEnum
from typing import Any, Final

from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from irobot_create_msgs.action import Dock, Undock
from irobot_create_msgs.msg import DockStatus

import rclpy
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.qos import qos_profile_sensor_data, qos_profile_system_default

__all__ = ["TurtleBot4Directions", "TurtleBot4Navigator"]

POLL_SEC: Final = 0.1
EACH: Final = 5
"""One in this many feedback messages is printed."""
LONGEST: Final = Duration(seconds=600.0)
"""The time after which driving to a pose is canceled."""

ENDS: Final = {
    TaskResult.SUCCEEDED: "Goal succeeded!",
    TaskResult.CANCELED: "Goal was canceled!",
    TaskResult.FAILED: "Goal failed!",
}


class TurtleBot4Directions(IntEnum):
    """Directions on a map, in degrees."""

    NORTH = 0
    NORTH_WEST = 45
    WEST = 90
    SOUTH_WEST = 135
    SOUTH = 180
    SOUTH_EAST = 225
    EAST = 270
    NORTH_EAST = 315


class TurtleBot4Navigator(BasicNavigator):
    """A `BasicNavigator` that docks, and waits for what it starts."""

    def __init__(self) -> None:
        super().__init__()
        self.is_docked: bool | None = None
        self.creating_path = False
        self.new_pose: Any = None
        self.create_subscription(
            DockStatus, "dock_status", self._dockCallback, qos_profile_sensor_data
        )
        self.create_subscription(
            PoseWithCovarianceStamped,
            "initialpose",
            self._poseEstimateCallback,
            qos_profile_system_default,
        )
        self.undock_action_client: Any = ActionClient(self, Undock, "undock")
        self.dock_action_client: Any = ActionClient(self, Dock, "dock")
        self.undock_result_future: Any = None
        self.dock_result_future: Any = None
        self.undock_goal_handle: Any = None
        self.dock_goal_handle: Any = None
        self.undock_status: int | None = None
        self.dock_status: int | None = None

    def destroy_node(self) -> None:
        """Destroy the clients of actions, and the node."""
        self.undock_action_client.destroy()
        self.dock_action_client.destroy()
        super().destroy_node()

    def getPoseStamped(self, position: Any, rotation: float) -> Any:
        """Return a pose on the map.

        Args:
            position: Its x and y in metres.
            rotation: The angle to the left of the map's x axis, in degrees.
        """
        pose = self.stampPose(PoseStamped().pose)
        pose.pose.position.x, pose.pose.position.y = map(float, position[:2])
        half = math.radians(rotation) / 2
        pose.pose.orientation.z = math.sin(half)
        pose.pose.orientation.w = math.cos(half)
        return pose

    def stampPose(self, pose: Any) -> Any:
        """Return a pose in the frame of the map, with the current time."""
        stamped = PoseStamped(pose=pose)
        stamped.header.frame_id = "map"
        stamped.header.stamp = self.get_clock().now().to_msg()
        return stamped

    def createPath(self) -> list[Any]:
        """Return the poses published on /initialpose until Enter is pressed in the terminal."""
        poses: list[Any] = []
        self.new_pose = None
        self.creating_path = True
        self.info("Creating a path. Press Enter to finish.")
        self.info('Use the "2D Pose Estimate" tool in Rviz to add a pose to the path.')
        while self.creating_path:
            rclpy.spin_once(self, timeout_sec=POLL_SEC)
            if self.new_pose is not None:
                self.info("Pose added.")
                poses.append(self.stampPose(self.new_pose))
                self.new_pose = None
                self.clearAllCostmaps()
            if select.select([sys.stdin], [], [], 0)[0]:
                sys.stdin.readline()
                self.creating_path = False
        if poses:
            self.info("Path created.")
        for index, each in enumerate(poses):
            place, turn = each.pose.position, each.pose.orientation
            self.info(
                f"Pose {index} [x,y]=[{place.x:.3f},{place.y:.3f}]"
                f"[x,y,z,w]=[{turn.x:.3f},{turn.y:.3f},{turn.z:.3f},{turn.w:.3f}]"
            )
        return poses

    def _poseEstimateCallback(self, msg: Any) -> None:
        if self.creating_path:
            self.new_pose = msg.pose.pose

    def _dockCallback(self, msg: Any) -> None:
        self.is_docked = msg.is_docked

    def getDockedStatus(self) -> bool:
        """Wait until the base says whether it is docked, and return that."""
        rclpy.spin_once(self, timeout_sec=POLL_SEC)
        while self.is_docked is None:
            rclpy.spin_once(self, timeout_sec=POLL_SEC)
        return self.is_docked

    def undock(self) -> None:
        """Leave the dock, and wait until that is done."""
        self.info("Undocking...")
        self.undock_send_goal()
        while not self.isUndockComplete():
            pass

    def undock_send_goal(self) -> None:
        """Start to leave the dock."""
        client = self.undock_action_client
        self.undock_goal_handle = self._sent(client, Undock.Goal(), "Undock")
        self.undock_result_future = self._result_of(self.undock_goal_handle)

    def isUndockComplete(self) -> bool:
        """Wait for 0.1 s, and return whether undocking has ended, or has not been started."""
        if not self._is_over(self.undock_result_future):
            return False
        if self.undock_result_future is not None:
            self.undock_status = self.undock_result_future.result().status
            self._say_end(self.undock_status, "Undock")
        return True

    def dock(self) -> None:
        """Drive onto the dock that the base sees, and wait until that is done."""
        self.info("Docking...")
        self.dock_send_goal()
        while not self.isDockComplete():
            pass

    def dock_send_goal(self) -> None:
        """Start to drive onto the dock that the base sees."""
        self.dock_goal_handle = self._sent(self.dock_action_client, Dock.Goal(), "Dock")
        self.dock_result_future = self._result_of(self.dock_goal_handle)

    def isDockComplete(self) -> bool:
        """Wait for 0.1 s, and return whether docking has ended, or has not been started."""
        if not self._is_over(self.dock_result_future):
            return False
        if self.dock_result_future is not None:
            self.dock_status = self.dock_result_future.result().status
            self._say_end(self.dock_status, "Dock")
        return True

    def _sent(self, client: Any, goal: Any, what: str) -> Any:
        client.wait_for_server()
        future = client.send_goal_async(goal)
        rclpy.spin_until_future_complete(self, future)
        handle = future.result()
        if not handle.accepted:
            self.error(f"{what} goal rejected")
        return handle

    def _result_of(self, handle: Any) -> Any:
        return handle.get_result_async() if handle.accepted else None

    def _is_over(self, result: Any) -> bool:
        if result is not None:
            rclpy.spin_until_future_complete(self, result, timeout_sec=POLL_SEC)
        return result is None or result.done()

    def _say_end(self, status: int | None, what: str) -> None:
        if status == GoalStatus.STATUS_SUCCEEDED:
            self.info(f"{what} succeeded")
        else:
            self.info(f"Goal failed with status code: {status}")

    def startToPose(self, pose: Any) -> None:
        """Drive to a pose, print how long it takes, and wait for the end."""
        self.goToPose(pose)
        self._follow(self._print_arrival)

    def startThroughPoses(self, poses: Any) -> None:
        """Drive through several poses, print how long it takes, and wait for the end."""
        self.goThroughPoses(poses)
        self._follow(self._print_arrival)

    def startFollowWaypoints(self, poses: Any) -> None:
        """Drive to one pose after another, print which is next, and wait for the end."""
        self.followWaypoints(poses)

        def show(feedback: Any) -> None:
            next_one = feedback.current_waypoint + 1
            print(f"Executing current waypoint: {next_one}/{len(poses):<5}", end="\r")

        self._follow(show)

    def _follow(self, show: Callable[[Any], None]) -> None:
        """Show every fifth feedback until the task ends, and log how it ended."""
        looks = 0
        while not self.isTaskComplete():
            looks += 1
            feedback = self.getFeedback()
            if feedback and looks % EACH == 0:
                show(feedback)
        self.info(ENDS.get(self.getResult(), "Goal has an invalid return status!"))

    def _print_arrival(self, feedback: Any) -> None:
        left = Duration.from_msg(feedback.estimated_time_remaining).nanoseconds / 1e9
        print(f"Estimated time of arrival: {left:.0f}{' seconds.':<20}", end="\r")
        if Duration.from_msg(feedback.navigation_time) > LONGEST:
            self.cancelTask()
