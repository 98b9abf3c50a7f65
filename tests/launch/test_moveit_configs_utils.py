"""Launch files of robots with MoveIt, with the parameters of such a robot's package.

moveit2 8fcb5d2 gives the same for the packages of moveit_resources (compared manually).
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from aionode.errors import LaunchFileError

if TYPE_CHECKING:
    from tests.launch.conftest import Files

PACKAGE = {
    "package.xml": "<package><name>arm_moveit_config</name></package>",
    ".setup_assistant": """
        moveit_setup_assistant_config:
          urdf: {package: arm_description, relative_path: urdf/arm.xacro, xacro_args: "hand:=true"}
          srdf: {relative_path: config/arm.srdf}
        """,
    "config/arm.srdf": """\
        <robot name="arm">
          <virtual_joint name="to_world" type="fixed" parent_frame="world" child_link="base"/>
        </robot>
        """,
    "config/kinematics.yaml": "arm: {kinematics_solver: kdl}",
    "config/joint_limits.yaml": "joint_limits: {j1: {max_velocity: 2.0}}",
    "config/pilz_cartesian_limits.yaml": "cartesian_limits: {max_trans_vel: 1.0}",
    "config/moveit_controllers.yaml": """
        moveit_simple_controller_manager: {controller_names: [arm_controller]}
        """,
    "config/chomp_planning.yaml": "planning_plugins: [own]",
}
URDF = """\
<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro">
  <xacro:arg name="hand" default="false"/>
  <link name="base"/>
  <xacro:if value="$(arg hand)"><link name="hand"/></xacro:if>
</robot>
"""


@pytest.fixture
def arm(files: Files) -> Files:
    """Write the two packages of a robot."""
    for name, text in PACKAGE.items():
        files.write(f"src/arm_moveit_config/{name}", text)
    files.write(
        "src/arm_description/package.xml", "<package><name>arm_description</name></package>"
    )
    files.write("src/arm_description/urdf/arm.xacro", URDF)
    return files


def planned(files: Files, description: str, **arguments: str) -> list[dict[str, Any]]:
    """Return what a launch file of the package starts."""
    return files.plan(
        "src/arm_moveit_config/launch/a.launch.py",
        f"""
        import json
        from launch import LaunchDescription
        from launch.actions import *
        from launch.substitutions import *
        from launch_ros.actions import Node
        from moveit_configs_utils import MoveItConfigsBuilder
        from moveit_configs_utils.launches import *

        def generate_launch_description():
            return {description}
        """,
        **arguments,
    )


def parameters(files: Files, builder: str) -> dict[str, Any]:
    """Return the parameters collected by a builder."""
    shown = f"LaunchDescription([LogInfo(msg=json.dumps({builder}.to_dict()))])"
    (record,) = planned(files, shown)
    found: dict[str, Any] = json.loads(record["log"])
    return found


def test_the_package_of_a_robot_gives_moveits_parameters(arm: Files) -> None:
    """From the files written by the Setup Assistant, with its xacro arguments."""
    found = parameters(arm, "MoveItConfigsBuilder('arm')")

    assert 'link name="hand"' in found["robot_description"]
    assert "virtual_joint" in found["robot_description_semantic"]
    assert found["robot_description_kinematics"] == {"arm": {"kinematics_solver": "kdl"}}
    assert found["robot_description_planning"] == {
        "joint_limits": {"j1": {"max_velocity": 2.0}},
        "cartesian_limits": {"max_trans_vel": 1.0},
    }
    assert found["moveit_simple_controller_manager"] == {"controller_names": ["arm_controller"]}
    assert found["moveit_manage_controllers"] is True
    assert found["publish_planning_scene"] is True


def test_planners_are_those_of_the_package_before_those_of_moveit(arm: Files) -> None:
    """A robot replaces the parameters of one planner, and keeps the others."""
    found = parameters(arm, "MoveItConfigsBuilder('arm')")

    assert sorted(found["planning_pipelines"]) == [
        "chomp",
        "ompl",
        "pilz_industrial_motion_planner",
        "stomp",
    ]
    assert found["default_planning_pipeline"] == "ompl"
    assert found["chomp"] == {"planning_plugins": ["own"]}
    assert found["ompl"]["planning_plugins"] == ["ompl_interface/OMPLPlanner"]
    assert found["ompl"]["planner_configs"]["RRT"] == {
        "type": "geometric::RRT",
        "range": 0.0,
        "goal_bias": 0.05,
    }
    assert len(found["ompl"]["planner_configs"]) == 24


def test_planners_are_set_up_for_the_distribution(
    arm: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    """MoveIt of Humble reads other parameters, and has no STOMP."""
    monkeypatch.setenv("ROS_DISTRO", "humble")
    found = parameters(arm, "MoveItConfigsBuilder('arm')")

    assert found["ompl"]["planning_plugin"] == "ompl_interface/OMPLPlanner"
    assert "stomp" not in found["planning_pipelines"]


@pytest.mark.parametrize(
    ("call", "names", "default"),
    [
        ("planning_pipelines(load_all=False)", ["chomp"], "chomp"),
        ("planning_pipelines(pipelines=['stomp', 'ompl'])", ["stomp", "ompl"], "ompl"),
        ("planning_pipelines('stomp', ['ompl', 'stomp'])", ["ompl", "stomp"], "stomp"),
    ],
)
def test_planners_can_be_chosen(arm: Files, call: str, names: list[str], default: str) -> None:
    """By name, or those for which the package has a file."""
    found = parameters(arm, f"MoveItConfigsBuilder('arm').{call}")

    assert found["planning_pipelines"] == names
    assert found["default_planning_pipeline"] == default


@pytest.mark.parametrize(
    ("call", "part"),
    [
        ("planning_pipelines('chmp')", "'chmp' is none of the pipelines chomp, ompl"),
        ("trajectory_execution()", "a_controllers.yaml, b_controllers.yaml is not clear"),
        ("joint_limits('config/none.yaml')", "none.yaml doesn't exist"),
    ],
)
def test_what_is_not_there_or_not_clear_is_an_error_of_the_launch_file(
    arm: Files, call: str, part: str
) -> None:
    """With what exists."""
    folder = arm.folder / "src/arm_moveit_config/config"
    (folder / "moveit_controllers.yaml").rename(folder / "a_controllers.yaml")
    (folder / "b_controllers.yaml").write_text("{}")

    with pytest.raises(LaunchFileError, match=part):
        parameters(arm, f"MoveItConfigsBuilder('arm').{call}")


def test_arguments_of_xacro_may_be_known_at_launch_only(arm: Files) -> None:
    """A launch argument may say whether there is a hand."""
    builder = (
        "MoveItConfigsBuilder('arm')"
        ".robot_description(mappings={'hand': LaunchConfiguration('hand')})"
    )
    description = (
        "LaunchDescription([DeclareLaunchArgument('hand'), "
        "Node(package='robot_state_publisher', executable='robot_state_publisher', "
        f"parameters=[{builder}.to_moveit_configs().robot_description])])"
    )

    (record,) = planned(arm, description, hand="false")

    text = str(record)
    assert 'link name="base"' in text
    assert 'link name="hand"' not in text


def test_the_launch_files_of_the_setup_assistant_start_what_aionode_has(arm: Files) -> None:
    """Transforms of virtual joints, robot_state_publisher, and spawners of controllers."""
    config = "MoveItConfigsBuilder('arm').to_moveit_configs()"

    (transform,) = planned(arm, f"generate_static_virtual_joint_tfs_launch({config})")
    (publisher,) = planned(arm, f"generate_rsp_launch({config})")

    assert "--frame-id world --child-frame-id base" in " ".join(transform["argv"])
    assert "robot_state_publisher" in publisher["argv"]
    for spawner in planned(arm, f"generate_spawn_controllers_launch({config})"):
        assert "spawner" in spawner["argv"]


@pytest.mark.parametrize(
    ("launch", "package"),
    [
        ("generate_move_group_launch", "moveit_ros_move_group"),
        ("generate_moveit_rviz_launch", "rviz2"),
        ("generate_setup_assistant_launch", "moveit_setup_assistant"),
        ("generate_warehouse_db_launch", "warehouse_ros_mongo"),
    ],
)
def test_the_other_launch_files_name_what_they_need(arm: Files, launch: str, package: str) -> None:
    """They get as far as the C++ program, which aionode does not have."""
    with pytest.raises(LaunchFileError, match=f"{package}('|; use the page)"):
        planned(arm, f"{launch}(MoveItConfigsBuilder('arm').to_moveit_configs())")


def test_a_robot_without_hardware_starts_as_far_as_its_files_say(arm: Files) -> None:
    """The first of these files is that of robot_state_publisher."""
    with pytest.raises(LaunchFileError, match=r"rsp\.launch\.py"):
        planned(arm, "generate_demo_launch(MoveItConfigsBuilder('arm').to_moveit_configs())")
