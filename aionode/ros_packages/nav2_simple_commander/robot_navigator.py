"""`nav2_simple_commander.robot_navigator`: gives Nav2 tasks, and waits for them."""

from __future__ import annotations

from enum import Enum
from typing import Any, Final

from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration as DurationMsg
from geometry_msgs.msg import Point, PoseStamped, PoseWithCovarianceStamped
from lifecycle_msgs.srv import GetState
from nav2_msgs import action, srv

import rclpy
from rclpy.action import ActionClient
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

__all__ = ["BasicNavigator", "TaskResult"]

ACTIONS: Final = {
    "nav_through_poses_client": ("NavigateThroughPoses", "navigate_through_poses"),
    "nav_to_pose_client": ("NavigateToPose", "navigate_to_pose"),
    "follow_waypoints_client": ("FollowWaypoints", "follow_waypoints"),
    "follow_gps_waypoints_client": ("FollowGPSWaypoints", "follow_gps_waypoints"),
    "follow_path_client": ("FollowPath", "follow_path"),
    "compute_path_to_pose_client": ("ComputePathToPose", "compute_path_to_pose"),
    "compute_path_through_poses_client": (
        "ComputePathThroughPoses",
        "compute_path_through_poses",
    ),
    "smoother_client": ("SmoothPath", "smooth_path"),
    "spin_client": ("Spin", "spin"),
    "backup_client": ("BackUp", "backup"),
    "drive_on_heading_client": ("DriveOnHeading", "drive_on_heading"),
    "assisted_teleop_client": ("AssistedTeleop", "assisted_teleop"),
    "docking_client": ("DockRobot", "dock_robot"),
    "undocking_client": ("UndockRobot", "undock_robot"),
}
"""The type and the name of the action of each client."""

SERVICES: Final = {
    "change_maps_srv": ("LoadMap", "map_server/load_map"),
    "clear_costmap_global_srv": (
        "ClearEntireCostmap",
        "global_costmap/clear_entirely_global_costmap",
    ),
    "clear_costmap_local_srv": (
        "ClearEntireCostmap",
        "local_costmap/clear_entirely_local_costmap",
    ),
    "clear_costmap_except_region_srv": (
        "ClearCostmapExceptRegion",
        "local_costmap/clear_costmap_except_region",
    ),
    "clear_costmap_around_robot_srv": (
        "ClearCostmapAroundRobot",
        "local_costmap/clear_costmap_around_robot",
    ),
    "clear_costmap_around_pose_srv": (
        "ClearCostmapAroundPose",
        "local_costmap/clear_costmap_around_pose",
    ),
    "get_costmap_global_srv": ("GetCostmap", "global_costmap/get_costmap"),
    "get_costmap_local_srv": ("GetCostmap", "local_costmap/get_costmap"),
}
"""The type and the name of the service of each client."""

POLL_SEC: Final = 0.1
ASK_SEC: Final = 1.0


class TaskResult(Enum):
    """How a task ended."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


RESULTS: Final = {
    GoalStatus.STATUS_SUCCEEDED: TaskResult.SUCCEEDED,
    GoalStatus.STATUS_ABORTED: TaskResult.FAILED,
    GoalStatus.STATUS_CANCELED: TaskResult.CANCELED,
}


class BasicNavigator(Node):
    """Gives Nav2 one task at a time; a method spins the node for as long as it waits."""

    def __init__(self, node_name: str = "basic_navigator", namespace: str = "") -> None:
        super().__init__(node_name=node_name, namespace=namespace)
        self.initial_pose = PoseStamped()
        self.initial_pose.header.frame_id = "map"
        self.initial_pose_received = False
        self.goal_handle: Any = None
        self.result_future: Any = None
        self.feedback: Any = None
        self.status: int | None = None
        for attribute, (kind, name) in ACTIONS.items():
            setattr(self, attribute, ActionClient(self, getattr(action, kind), name))
        for attribute, (kind, name) in SERVICES.items():
            setattr(self, attribute, self.create_client(getattr(srv, kind), name))
        latched = QoSProfile(
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
            reliability=ReliabilityPolicy.RELIABLE,
            history=HistoryPolicy.KEEP_LAST,
            depth=1,
        )
        self.localization_pose_sub = self.create_subscription(
            PoseWithCovarianceStamped, "amcl_pose", self._amclPoseCallback, latched
        )
        self.initial_pose_pub = self.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)

    def destroyNode(self) -> None:
        """Destroy the node."""
        self.destroy_node()

    def destroy_node(self) -> None:
        """Destroy the clients of actions, and the node."""
        for attribute in ACTIONS:
            getattr(self, attribute).destroy()
        super().destroy_node()

    def setInitialPose(self, initial_pose: Any) -> None:
        """Tell the localization where the robot is."""
        self.initial_pose_received = False
        self.initial_pose = initial_pose
        self._setInitialPose()

    # Tasks: each returns whether Nav2 accepted it

    def goThroughPoses(self, poses: Any, behavior_tree: str = "") -> bool:
        """Drive through several poses without stopping."""
        goal = action.NavigateThroughPoses.Goal(poses=poses, behavior_tree=behavior_tree)
        self.info(f"Navigating with {len(poses)} goals....")
        return self._begin("nav_through_poses_client", goal, f"Goal with {len(poses)} poses")

    def goToPose(self, pose: Any, behavior_tree: str = "") -> bool:
        """Drive to a pose."""
        where = f"{pose.pose.position.x} {pose.pose.position.y}"
        goal = action.NavigateToPose.Goal(pose=pose, behavior_tree=behavior_tree)
        self.info(f"Navigating to goal: {where}...")
        return self._begin("nav_to_pose_client", goal, f"Goal to {where}")

    def followWaypoints(self, poses: Any) -> bool:
        """Drive to one pose after another, and carry out the task of each."""
        self.info(f"Following {len(poses)} goals....")
        goal = action.FollowWaypoints.Goal(poses=poses)
        what = f"Following {len(poses)} waypoints request"
        return self._begin("follow_waypoints_client", goal, what)

    def followGpsWaypoints(self, gps_poses: Any) -> bool:
        """Drive to one place on earth after another."""
        self.info(f"Following {len(gps_poses)} gps goals....")
        goal = action.FollowGPSWaypoints.Goal(gps_poses=gps_poses)
        what = f"Following {len(gps_poses)} gps waypoints request"
        return self._begin("follow_gps_waypoints_client", goal, what)

    def spin(self, spin_dist: float = 1.57, time_allowance: int = 10) -> bool:
        """Turn on the spot by an angle."""
        self.info(f"Spinning to angle {spin_dist}....")
        goal = action.Spin.Goal(
            target_yaw=float(spin_dist), time_allowance=DurationMsg(sec=time_allowance)
        )
        return self._begin("spin_client", goal, "Spin request")

    def backup(
        self, backup_dist: float = 0.15, backup_speed: float = 0.025, time_allowance: int = 10
    ) -> bool:
        """Drive backwards."""
        self.info(f"Backing up {float(backup_dist)} m at {backup_speed} m/s....")
        goal = action.BackUp.Goal(
            target=Point(x=float(backup_dist)),
            speed=float(backup_speed),
            time_allowance=DurationMsg(sec=time_allowance),
        )
        return self._begin("backup_client", goal, "Backup request")

    def driveOnHeading(
        self, dist: float = 0.15, speed: float = 0.025, time_allowance: int = 10
    ) -> bool:
        """Drive straight ahead."""
        self.info(f"Drive {float(dist)} m on heading at {speed} m/s....")
        goal = action.DriveOnHeading.Goal(
            target=Point(x=float(dist)),
            speed=float(speed),
            time_allowance=DurationMsg(sec=time_allowance),
        )
        return self._begin("drive_on_heading_client", goal, "Drive On Heading request")

    def assistedTeleop(self, time_allowance: int = 30) -> bool:
        """Start teleoperation in which Nav2 stops the robot before obstacles."""
        self.info("Wait for handling the request...")
        goal = action.AssistedTeleop.Goal(time_allowance=DurationMsg(sec=time_allowance))
        return self._begin("assisted_teleop_client", goal, "Assisted Teleop request")

    def followPath(self, path: Any, controller_id: str = "", goal_checker_id: str = "") -> bool:
        """Drive along a path."""
        self.info("Executing path...")
        goal = action.FollowPath.Goal(
            path=path, controller_id=controller_id, goal_checker_id=goal_checker_id
        )
        return self._begin("follow_path_client", goal, "Follow path")

    def dockRobotByPose(self, dock_pose: Any, dock_type: str, nav_to_dock: bool = True) -> bool:
        """Drive to a dock that is at a pose, and dock."""
        self.info(f"Docking at pose: {dock_pose}...")
        goal = action.DockRobot.Goal(
            use_dock_id=False,
            dock_pose=dock_pose,
            dock_type=dock_type,
            navigate_to_staging_pose=nav_to_dock,
        )
        return self._begin("docking_client", goal, "Docking request")

    def dockRobotByID(self, dock_id: str, nav_to_dock: bool = True) -> bool:
        """Drive to a dock that Nav2 knows, and dock."""
        self.info(f"Docking at dock ID: {dock_id}...")
        goal = action.DockRobot.Goal(
            use_dock_id=True, dock_id=dock_id, navigate_to_staging_pose=nav_to_dock
        )
        return self._begin("docking_client", goal, "Docking request")

    def undockRobot(self, dock_type: str = "") -> bool:
        """Leave the dock."""
        self.info(f"Undocking from dock of type: {dock_type}...")
        goal = action.UndockRobot.Goal(dock_type=dock_type)
        return self._begin("undocking_client", goal, "Undocking request")

    def cancelTask(self) -> None:
        """Request that Nav2 cancel the task, and wait until it agrees."""
        self.info("Canceling current task.")
        if self.result_future:
            rclpy.spin_until_future_complete(self, self.goal_handle.cancel_goal_async())

    def isTaskComplete(self) -> bool:
        """Wait for 0.1 s, and return whether the task has ended; True without a task."""
        if not self.result_future:
            return True
        rclpy.spin_until_future_complete(self, self.result_future, timeout_sec=POLL_SEC)
        if not self.result_future.result():
            return False
        self.status = self.result_future.result().status
        if self.status == GoalStatus.STATUS_SUCCEEDED:
            self.debug("Task succeeded!")
        else:
            self.debug(f"Task with failed with status code: {self.status}")
        return True

    def getFeedback(self) -> Any:
        """Return the newest feedback of the task; None before the first."""
        return self.feedback

    def getResult(self) -> TaskResult:
        """Return how the task ended."""
        return RESULTS.get(self.status, TaskResult.UNKNOWN)

    def waitUntilNav2Active(self, navigator: str = "bt_navigator", localizer: str = "amcl") -> None:
        """Wait until Nav2 runs, and knows where the robot is."""
        if localizer != "robot_localization":  # which is not a managed node
            self._waitForNodeToActivate(localizer)
        if localizer == "amcl":
            self._waitForInitialPose()
        self._waitForNodeToActivate(navigator)
        self.info("Nav2 is ready for use!")

    # Paths, maps and costmaps

    def getPath(self, start: Any, goal: Any, planner_id: str = "", use_start: bool = False) -> Any:
        """Return a path to a pose; None if there is none."""
        self.info("Getting path...")
        request = action.ComputePathToPose.Goal(
            start=start, goal=goal, planner_id=planner_id, use_start=use_start
        )
        return self._path("compute_path_to_pose_client", request, "Get path", "Getting path")

    def getPathThroughPoses(
        self, start: Any, goals: Any, planner_id: str = "", use_start: bool = False
    ) -> Any:
        """Return a path through several poses; None if there is none."""
        self.info("Getting path...")
        request = action.ComputePathThroughPoses.Goal(
            start=start, goals=goals, planner_id=planner_id, use_start=use_start
        )
        client = "compute_path_through_poses_client"
        return self._path(client, request, "Get path", "Getting path")

    def smoothPath(
        self,
        path: Any,
        smoother_id: str = "",
        max_duration: float = 2.0,
        check_for_collision: bool = False,
    ) -> Any:
        """Return a smoother path; None if there is none."""
        self.info("Smoothing path...")
        request = action.SmoothPath.Goal(
            path=path,
            max_smoothing_duration=Duration(seconds=max_duration).to_msg(),
            smoother_id=smoother_id,
            check_for_collisions=check_for_collision,
        )
        return self._path("smoother_client", request, "Smooth path", "Smoothing path")

    def changeMap(self, map_filepath: str) -> None:
        """Request that the map server load another map."""
        response = self._ask("change_maps_srv", srv.LoadMap.Request(map_url=map_filepath))
        if response.result != srv.LoadMap.Response.RESULT_SUCCESS:
            self.error("Change map request failed!")
        else:
            self.info("Change map request was successful!")

    def clearAllCostmaps(self) -> None:
        """Clear both costmaps."""
        self.clearLocalCostmap()
        self.clearGlobalCostmap()

    def clearLocalCostmap(self) -> None:
        """Clear the local costmap."""
        self._ask("clear_costmap_local_srv", srv.ClearEntireCostmap.Request())

    def clearGlobalCostmap(self) -> None:
        """Clear the global costmap."""
        self._ask("clear_costmap_global_srv", srv.ClearEntireCostmap.Request())

    def clearCostmapExceptRegion(self, reset_distance: float) -> None:
        """Clear the local costmap except near the robot."""
        request = srv.ClearCostmapExceptRegion.Request(reset_distance=reset_distance)
        self._ask("clear_costmap_except_region_srv", request)

    def clearCostmapAroundRobot(self, reset_distance: float) -> None:
        """Clear the local costmap near the robot."""
        request = srv.ClearCostmapAroundRobot.Request(reset_distance=reset_distance)
        self._ask("clear_costmap_around_robot_srv", request)

    def clearCostmapAroundPose(self, pose: Any, reset_distance: float) -> None:
        """Clear the local costmap near a pose."""
        request = srv.ClearCostmapAroundPose.Request(pose=pose, reset_distance=reset_distance)
        self._ask("clear_costmap_around_pose_srv", request)

    def getGlobalCostmap(self) -> Any:
        """Return the global costmap."""
        return self._ask("get_costmap_global_srv", srv.GetCostmap.Request()).map

    def getLocalCostmap(self) -> Any:
        """Return the local costmap."""
        return self._ask("get_costmap_local_srv", srv.GetCostmap.Request()).map

    def lifecycleStartup(self) -> None:
        """Request that the lifecycle managers start their nodes."""
        self.info("Starting up lifecycle nodes based on lifecycle_manager.")
        self._manage("Starting up", srv.ManageLifecycleNodes.Request.STARTUP)
        self.info("Nav2 is ready for use!")

    def lifecycleShutdown(self) -> None:
        """Request that the lifecycle managers shut down their nodes."""
        self.info("Shutting down lifecycle nodes based on lifecycle_manager.")
        self._manage("Shutting down", srv.ManageLifecycleNodes.Request.SHUTDOWN)

    def info(self, msg: str) -> None:
        """Log a text."""
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        """Log a warning."""
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        """Log an error."""
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        """Log a detail."""
        self.get_logger().debug(msg)

    def _begin(self, attribute: str, goal: Any, what: str, *, feedback: bool = True) -> bool:
        """Send a goal, and return whether it was accepted."""
        client, kind = getattr(self, attribute), ACTIONS[attribute][0]
        self.debug(f"Waiting for '{kind}' action server")
        while not client.wait_for_server(timeout_sec=ASK_SEC):
            self.info(f"'{kind}' action server not available, waiting...")
        future = client.send_goal_async(goal, self._feedbackCallback if feedback else None)
        rclpy.spin_until_future_complete(self, future)
        self.goal_handle = future.result()
        if not self.goal_handle.accepted:
            self.error(f"{what} was rejected!")
            return False
        self.status = None
        self.result_future = self.goal_handle.get_result_async()
        return True

    def _path(self, attribute: str, goal: Any, what: str, doing: str) -> Any:
        """Return the path of an action's result; None if it fails."""
        if not self._begin(attribute, goal, what, feedback=False):
            return None
        rclpy.spin_until_future_complete(self, self.result_future)
        self.status = self.result_future.result().status
        if self.status != GoalStatus.STATUS_SUCCEEDED:
            self.warn(f"{doing} failed with status code: {self.status}")
            return None
        return self.result_future.result().result.path

    def _ask(self, attribute: str, request: Any) -> Any:
        """Return the response of a service, once it is there."""
        return self._call(getattr(self, attribute), SERVICES[attribute][1], request)

    def _call(self, client: Any, name: str, request: Any) -> Any:
        """Return the response of a service, once it is there."""
        while not client.wait_for_service(timeout_sec=ASK_SEC):
            self.info(f"{name} service not available, waiting...")
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        return future.result()

    def _manage(self, doing: str, command: int) -> None:
        """Send a command to each lifecycle manager."""
        for name, kinds in self.get_service_names_and_types():
            if kinds[0] == "nav2_msgs/srv/ManageLifecycleNodes":
                self.info(f"{doing} {name}")
                client = self.create_client(srv.ManageLifecycleNodes, name)
                self._call(client, name, srv.ManageLifecycleNodes.Request(command=command))
                self.destroy_client(client)

    def _waitForNodeToActivate(self, node_name: str) -> None:
        """Wait until a managed node is active."""
        self.debug(f"Waiting for {node_name} to become active..")
        name = f"{node_name}/get_state"
        client = self.create_client(GetState, name)
        while (state := self._call(client, name, GetState.Request()).current_state.label) != (
            "active"
        ):
            self.debug(f"Result of get_state: {state}")
            rclpy.spin_once(self, timeout_sec=ASK_SEC)
        self.destroy_client(client)

    def _waitForInitialPose(self) -> None:
        """Tell the localization where the robot is until it answers."""
        while not self.initial_pose_received:
            self.info("Setting initial pose")
            self._setInitialPose()
            self.info("Waiting for amcl_pose to be received")
            rclpy.spin_once(self, timeout_sec=ASK_SEC)

    def _amclPoseCallback(self, msg: Any) -> None:  # only its arrival counts
        """Note that the localization knows where the robot is."""
        self.initial_pose_received = True

    def _feedbackCallback(self, msg: Any) -> None:
        """Note the newest feedback."""
        self.feedback = msg.feedback

    def _setInitialPose(self) -> None:
        """Publish where the robot is."""
        msg = PoseWithCovarianceStamped()
        msg.pose.pose = self.initial_pose.pose
        msg.header = self.initial_pose.header
        self.info("Publishing Initial Pose")
        self.initial_pose_pub.publish(msg)
