"""`nav2_simple_commander`, beside servers that stand in for Nav2."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nav2_simple_commander.costmap_2d import PyCostmap2D
from nav2_simple_commander.footprint_collision_checker import FootprintCollisionChecker
from nav2_simple_commander.line_iterator import LineIterator
from tests.support.peers import isolated_environment

PROGRAM = """\
import threading
import time

import aionode.rclpy

aionode.rclpy.install()
import rclpy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from lifecycle_msgs.srv import GetState
from nav2_msgs.action import ComputePathToPose, NavigateToPose, Spin
from nav2_msgs.srv import ClearEntireCostmap, ManageLifecycleNodes
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Nav2(Node):
    def __init__(self):
        super().__init__("nav2")
        self.asked = []
        group = rclpy.callback_groups.ReentrantCallbackGroup()
        options = {"callback_group": group, "cancel_callback": lambda _: CancelResponse.ACCEPT}
        ActionServer(
            self, NavigateToPose, "navigate_to_pose", self.drive, goal_callback=self.fits,
            **options)
        ActionServer(self, Spin, "spin", self.turn, **options)
        ActionServer(self, ComputePathToPose, "compute_path_to_pose", self.plan, **options)
        self.create_service(
            ClearEntireCostmap, "local_costmap/clear_entirely_local_costmap", self.note)
        self.create_service(
            ManageLifecycleNodes, "lifecycle_manager_navigation/manage_nodes", self.manage)
        for name in ("amcl", "bt_navigator"):
            self.create_service(GetState, f"{name}/get_state", self.state)
        self.pose = self.create_publisher(
            PoseWithCovarianceStamped, "amcl_pose",
            rclpy.qos.QoSProfile(depth=1, durability=rclpy.qos.DurabilityPolicy.TRANSIENT_LOCAL))
        self.create_subscription(
            PoseWithCovarianceStamped, "initialpose", self.pose.publish, 10)

    def fits(self, goal):
        return GoalResponse.REJECT if goal.pose.pose.position.x < 0 else GoalResponse.ACCEPT

    def drive(self, handle):
        feedback = NavigateToPose.Feedback(distance_remaining=2.5)
        handle.publish_feedback(feedback)
        handle.succeed()
        return NavigateToPose.Result()

    def turn(self, handle):
        while not handle.is_cancel_requested:
            time.sleep(0.01)
        handle.canceled()
        return Spin.Result()

    def plan(self, handle):
        result = ComputePathToPose.Result()
        if handle.request.planner_id == "none":
            handle.abort()
            return result
        result.path.poses = [handle.request.start, handle.request.goal]
        handle.succeed()
        return result

    def note(self, request, response):
        self.asked.append("clear")
        return response

    def manage(self, request, response):
        self.asked.append(request.command)
        response.success = True
        return response

    def state(self, request, response):
        response.current_state.label = "active"
        return response


rclpy.init()
nav2 = Nav2()
executor = MultiThreadedExecutor(4)
executor.add_node(nav2)
thread = threading.Thread(target=executor.spin)
thread.start()
try:
    navigator = BasicNavigator()
    navigator.waitUntilNav2Active()
    pose = PoseStamped()
    pose.pose.position.x = 1.0
    assert navigator.goToPose(pose)
    while not navigator.isTaskComplete():
        pass
    print(navigator.getResult(), navigator.getFeedback().distance_remaining)
    assert navigator.spin(spin_dist=3)
    assert not navigator.isTaskComplete()
    print(navigator.getResult())
    navigator.cancelTask()
    while not navigator.isTaskComplete():
        pass
    print(navigator.getResult())
    print(len(navigator.getPath(PoseStamped(), pose).poses))
    print(navigator.getPath(PoseStamped(), pose, planner_id="none"))
    navigator.clearLocalCostmap()
    navigator.lifecycleShutdown()
    print(nav2.asked)
    pose.pose.position.x = -1.0
    print(navigator.goToPose(pose))
    navigator.destroyNode()
finally:
    executor.shutdown()
    rclpy.shutdown()
    thread.join()
"""


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(60)
@pytest.mark.one_loop
def test_tasks_are_given_awaited_and_canceled(tmp_path: Path) -> None:
    """As the examples of Nav2 do it: to a pose, a turn that is canceled, and a path."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)

    done = subprocess.run(
        [sys.executable, str(program)],
        env=isolated_environment(),
        capture_output=True,
        text=True,
        check=False,
        timeout=50,
    )

    assert done.stdout.splitlines() == [
        "TaskResult.SUCCEEDED 2.5",
        "TaskResult.UNKNOWN",
        "TaskResult.CANCELED",
        "2",
        "None",
        "['clear', 4]",
        "False",
    ], done.stderr
    assert "Goal to -1.0 0.0 was rejected!" in done.stderr
    assert "Getting path failed with status code: 6" in done.stderr


def grid(width: int, height: int, **costs: int) -> Any:
    """Return a map of free cells of half a metre, but for some."""
    data = [0] * width * height
    for name, cost in costs.items():
        x, y = map(int, name.removeprefix("at_").split("_"))
        data[y * width + x] = cost
    position = SimpleNamespace(x=-1.0, y=2.0)
    info = SimpleNamespace(
        width=width, height=height, resolution=0.5, origin=SimpleNamespace(position=position)
    )
    header = SimpleNamespace(frame_id="map", stamp=7)
    return PyCostmap2D(SimpleNamespace(info=info, header=header, data=data))


def test_a_costmap_has_cells_and_places() -> None:
    """Unknown cells, -1 in the message, are 255."""
    costmap = grid(4, 3, at_1_2=100, at_3_0=-1)

    assert (costmap.getSizeInCellsX(), costmap.getSizeInCellsY()) == (4, 3)
    assert (costmap.getSizeInMetersX(), costmap.getSizeInMetersY()) == (1.75, 1.25)
    assert costmap.getCostXY(1, 2) == costmap.getCostIdx(9) == 100
    assert costmap.getCostXY(3, 0) == 255
    assert costmap.mapToWorld(1, 2) == (-0.25, 3.25)
    assert costmap.worldToMapValidated(-0.25, 3.25) == (1, 2)
    assert costmap.worldToMapValidated(-1.1, 3.0) == (None, None)
    assert costmap.worldToMapValidated(1.0, 3.0) == (None, None)
    costmap.setCost(0, 0, 9)
    assert costmap.getCostXY(0, 0) == np.uint8(9)


def points(line: LineIterator) -> list[tuple[float, float]]:
    """Return the points of a line."""
    found = []
    while line.isValid():
        found.append((line.getX(), line.getY()))
        line.advance()
    return found


@pytest.mark.parametrize(
    ("ends", "step", "expected"),
    [
        ((0, 0, 2, 4), 1.0, [(0, 0), (1, 2), (2, 4)]),
        ((2, 4, 0, 0), 1.5, [(2, 4), (0.5, 1), (0, 0)]),
        ((1, 3, 1, 1), 1.0, [(1, 3), (1, 2), (1, 1)]),
        ((0, 1, 1, 1), 0.5, [(0, 1), (0.5, 1), (1, 1)]),
    ],
)
def test_a_line_is_gone_along_in_steps(
    ends: tuple[float, float, float, float], step: float, expected: list[tuple[float, float]]
) -> None:
    """To its end, whatever its direction."""
    assert points(LineIterator(*ends, step)) == expected


NUMBERS = st.floats(-50, 50)


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS)
def test_a_line_ends(x0: float, y0: float, x1: float, y1: float) -> None:
    """It ends even where floats cannot resolve its steps; the original goes on forever."""
    if (x0, y0) != (x1, y1):
        assert points(LineIterator(x0, y0, x1, y1, 0.5))[0] == (x0, y0)


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        (("0", 0, 1, 1), TypeError, "x0 must be a number"),
        ((0, 0, 1, 1, -1), ValueError, "step_size must be a positive number"),
        ((1, 2, 1, 2), ValueError, "zero length"),
    ],
)
def test_a_line_that_is_none_is_refused(
    arguments: tuple[Any, ...], error: type[Exception], text: str
) -> None:
    """With the texts of Nav2."""
    with pytest.raises(error, match=text):
        LineIterator(*arguments)


def footprint(*corners: tuple[float, float]) -> Any:
    """Return a polygon."""
    return SimpleNamespace(points=[SimpleNamespace(x=x, y=y) for x, y in corners])


SQUARE = footprint((-0.6, -0.6), (0.6, -0.6), (0.6, 0.6), (-0.6, 0.6))


@pytest.mark.usefixtures("installed")
def test_a_footprint_costs_what_its_edges_lie_on() -> None:
    """254 ends the search, as does an edge beyond the map."""
    checker = FootprintCollisionChecker()
    with pytest.raises(ValueError, match="Costmap not specified"):
        checker.footprintCost(SQUARE)

    checker.setCostmap(grid(20, 20, at_5_4=80, at_6_6=90))
    assert checker.footprintCostAtPose(2.0, 5.0, 0.0, SQUARE) == 80.0
    checker.setCostmap(grid(20, 20, at_5_4=-2))
    assert checker.footprintCostAtPose(2.0, 5.0, 0.0, SQUARE) == 254.0
    assert checker.footprintCostAtPose(-1.0, 5.0, 0.0, SQUARE) == 254.0
    assert checker.footprintCostAtPose(5.0, 8.0, 0.8, SQUARE) == 0.0
