"""`turtlebot4_navigation`, beside a base and servers that stand in for a robot's."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from pathlib import Path

PROGRAM = """\
import threading

import aionode.rclpy

aionode.rclpy.install()
import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from irobot_create_msgs.action import Dock, Undock
from irobot_create_msgs.msg import DockStatus
from nav2_msgs.action import FollowWaypoints, NavigateToPose
from nav2_msgs.srv import ClearEntireCostmap
from rclpy.action import ActionServer, GoalResponse
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from turtlebot4_navigation.turtlebot4_navigator import TurtleBot4Directions, TurtleBot4Navigator


class Robot(Node):
    def __init__(self):
        super().__init__("robot")
        self.docked = True
        self.group = rclpy.callback_groups.ReentrantCallbackGroup()
        self.status = self.create_publisher(DockStatus, "dock_status", qos_profile_sensor_data)
        self.create_timer(0.02, self.tell)
        for cls, name in ((Dock, "dock"), (Undock, "undock")):
            self.serve(cls, name, self.move, goal_callback=self.fits)
        self.serve(NavigateToPose, "navigate_to_pose", self.drive)
        self.serve(FollowWaypoints, "follow_waypoints", self.refuse)
        for place in ("local", "global"):
            self.create_service(
                ClearEntireCostmap,
                f"{place}_costmap/clear_entirely_{place}_costmap",
                lambda request, response: response)

    def serve(self, cls, name, execute, **options):
        ActionServer(self, cls, name, execute, callback_group=self.group, **options)

    def tell(self):
        self.status.publish(DockStatus(is_docked=self.docked))

    def fits(self, goal):
        wanted = isinstance(goal, Dock.Goal)
        return GoalResponse.REJECT if wanted == self.docked else GoalResponse.ACCEPT

    def move(self, handle):
        self.docked = isinstance(handle.request, Dock.Goal)
        handle.succeed()
        return Dock.Result() if self.docked else Undock.Result()

    def drive(self, handle):
        handle.succeed()
        return NavigateToPose.Result()

    def refuse(self, handle):
        handle.abort()
        return FollowWaypoints.Result()


rclpy.init()
robot = Robot()
executor = MultiThreadedExecutor(num_threads=4)
executor.add_node(robot)
thread = threading.Thread(target=executor.spin)
thread.start()
try:
    navigator = TurtleBot4Navigator()
    print("docked", navigator.getDockedStatus())
    navigator.dock()
    navigator.undock()
    print("undocked", navigator.undock_status, robot.docked)
    pose = navigator.getPoseStamped([1, 2.5], TurtleBot4Directions.WEST)
    print(pose.header.frame_id, pose.pose.position.y, round(pose.pose.orientation.z, 3))
    navigator.startToPose(pose)
    navigator.startFollowWaypoints([pose])
    navigator.dock()
    print("docked", navigator.dock_status, robot.docked)
    robot.create_timer(
        0.1, lambda: estimates.publish(PoseWithCovarianceStamped()), callback_group=robot.group)
    estimates = robot.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)
    print("ready", flush=True)
    path = navigator.createPath()
    print("path", len(path) > 0, path and path[0].header.frame_id)
    navigator.destroy_node()
finally:
    executor.shutdown()
    rclpy.shutdown()
    thread.join()
"""


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(60)
@pytest.mark.one_loop
def test_a_robot_docks_undocks_and_drives(tmp_path: Path) -> None:
    """As the tutorials do it; a goal that is refused is said, and not waited for."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    with subprocess.Popen(
        [sys.executable, str(program)],
        env=isolated_environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as running:
        assert running.stdin is not None
        assert running.stdout is not None
        assert running.stderr is not None
        seen = []
        while (line := running.stdout.readline()) != "ready\n":
            assert line, running.stderr.read()
            seen.append(line.strip())
        while "Pose added" not in (line := running.stderr.readline()):
            assert line
            seen.append(line.partition("[basic_navigator]: ")[2].strip())
        running.stdin.write("\n")
        running.stdin.close()
        rest = running.stdout.read()

    assert seen[:4] == ["docked True", "undocked 4 False", "map 2.5 0.707", "docked 4 True"]
    assert rest == "path True map\n"
    for said in ("Dock goal rejected", "Undock succeeded", "Goal succeeded!", "Goal failed!"):
        assert said in seen
