"""Launch files that name missing packages."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from aionode._packages import use_stand_ins
from aionode.errors import LaunchFileError
from aionode.launch import Plan
from aionode.launch.plan import Process

if TYPE_CHECKING:
    from tests.launch.conftest import Files

FILE = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import OnProcessExit
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    share = get_package_share_directory("tb3_sim")
    rviz = Node(package="rviz2", executable="rviz2", arguments=["-d", share + "/x.rviz"])
    return LaunchDescription([
        rviz,
        IncludeLaunchDescription(os.path.join(share, "launch", "sim.launch.py")),
        IncludeLaunchDescription([FindPackageShare("tb3_sim"), "/launch/other.launch.py"]),
        RegisterEventHandler(OnProcessExit(target_action=rviz, on_exit=[LogInfo(msg="over")])),
        ComposableNodeContainer(
            name="c", namespace="", package="rclcpp_components", executable="component_container",
            composable_node_descriptions=[ComposableNode(package="x", plugin="x::Y")]),
        TimerAction(period=1.0, actions=[Node(package="tf2_ros", executable="tf2_other")]),
        Node(package="rviz2", executable="rviz2"),
        ExecuteProcess(cmd=["echo", "started"]),
    ])
"""


@pytest.fixture(autouse=True)
def without_stand_ins(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Without a sourced ROS 2, and without stand-ins afterwards."""
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    yield
    use_stand_ins(wanted=False)


def records(files: Files, text: str = FILE) -> list[dict[str, Any]]:
    """Return what a file starts without its missing parts."""
    return list(Plan(files.write("a.launch.py", text), skip_missing=True).records())


def test_what_needs_a_missing_package_is_left_out_and_the_rest_is_started(files: Files) -> None:
    """A robot drives even if nobody watches it in RViz."""
    found = records(files)

    assert [each["argv"] for each in found if "argv" in each] == [["echo", "started"]]


def test_each_missing_package_is_one_warning_with_what_was_left_out(files: Files) -> None:
    """With its description, if aionode knows one."""
    logs = [each["log"] for each in records(files) if "log" in each and not each["when"]]

    assert len([text for text in logs if "'rviz2'" in text]) == 1
    rviz, sim, container, monitor, waiting = logs
    assert rviz.startswith("package 'rviz2' is missing: it is a graphical tool of ROS 2 in C++")
    assert rviz.count("a.launch.py:") == 2
    assert sim.startswith("package 'tb3_sim' is missing; left out: IncludeLaunchDescription (")
    assert sim.count("a.launch.py:") == 2
    assert "ComposableNode(plugin='my_robot.nodes:Driver')" in container
    assert monitor.startswith("package 'tf2_ros' has no executable 'tf2_other' here; left out:")
    assert waiting == "the exit of rviz2 never comes: that is left out"


def test_without_the_option_the_first_of_them_is_an_error_that_says_what_it_is(
    files: Files,
) -> None:
    """Nothing is started then, as for any mistake in a file."""
    text = FILE.replace('get_package_share_directory("tb3_sim")', '"/share"')
    text = text.replace('package="rviz2", executable="rviz2"', 'package="gz_sim", executable="gz"')

    with pytest.raises(LaunchFileError, match=r"'gz_sim': not found in .* it is the simulator"):
        _ = Plan(files.write("a.launch.py", text)).steps


def test_a_missing_module_adds_nothing_to_a_list(files: Files) -> None:
    """As where a launch file imports the arguments of a driver's own launch file."""
    text = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess
import rs_launch

def generate_launch_description():
    driver = [ExecuteProcess(cmd=["driver"])]
    return LaunchDescription(
        rs_launch.declared() + rs_launch.more() + driver + rs_launch.others()
    )
"""
    assert [each["argv"] for each in records(files, text) if "argv" in each] == [["driver"]]


WINDOWS = """
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import OnProcessExit
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    driver = ExecuteProcess(cmd=["driver"])
    return LaunchDescription([
        Node(package="rviz2", executable="rviz2", on_exit=[Shutdown()],
             arguments=["-d", [FindPackageShare("not_there"), "/view.rviz"]]),
        Node(package="rqt_robot_monitor", executable="rqt_robot_monitor"),
        Node(package="image_view", executable="image_view"),
        ExecuteProcess(cmd=["/opt/plotjuggler -n"], shell=True),
        TimerAction(period=1.0, actions=[Node(package="rviz2", executable="rviz2")]),
        RegisterEventHandler(OnProcessExit(target_action=driver, on_exit=[
            Node(package="rqt_graph", executable="rqt_graph")])),
        driver,
    ])
"""


def planned(files: Files, text: str) -> list[dict[str, Any]]:
    """Return what a file starts, where nothing is skipped on request."""
    return list(Plan(files.write("a.launch.py", text)).records())


def test_windows_that_are_not_here_are_left_out_without_being_asked(files: Files) -> None:
    """No robot depends on one: its other programs start, on a computer without a screen too."""
    found = planned(files, WINDOWS)

    assert [each["argv"] for each in found if "argv" in each] == [["driver"]]
    logs = [each["log"] for each in found if "log" in each and not each["when"]]
    assert [text.split("'")[1] for text in logs] == [
        *("rviz2", "rqt_robot_monitor", "image_view", "plotjuggler", "rqt_graph"),
    ]
    assert all("the page of `aionode gateway`, or Foxglove" in text for text in logs)


def test_a_file_of_nothing_but_windows_is_refused(files: Files) -> None:
    """Otherwise it would end at once, and its user would not know what to do instead."""
    text = WINDOWS.replace("        driver,\n", "").replace(
        'TimerAction(period=1.0, actions=[Node(package="rviz2", executable="rviz2")]),', ""
    )

    with pytest.raises(LaunchFileError, match=r"only graphical tools .*: rviz2, rqt_robot_monitor"):
        planned(files, text)


def test_only_the_windows_of_a_package_are_left_out(files: Files) -> None:
    """image_view has programs that save images as well."""
    text = WINDOWS.replace('executable="image_view"', 'executable="image_saver"')

    with pytest.raises(LaunchFileError, match="package 'image_view': not found"):
        planned(files, text)


def test_a_window_that_is_installed_is_started(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A sourced ROS 2 has such windows."""
    program = Path(files.write("bin/plotjuggler", "#!/bin/sh\n"))
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent), prepend=os.pathsep)

    found = planned(files, WINDOWS.replace("/opt/plotjuggler -n", "plotjuggler -n"))

    assert [each["argv"] for each in found if "argv" in each] == [["plotjuggler -n"], ["driver"]]


def test_a_program_starts_without_the_terminal_that_is_not_here(files: Files) -> None:
    """Its window would only show what the log shows as well."""
    text = WINDOWS.replace('cmd=["driver"]', 'cmd=["driver"], prefix="/no/xterm -e"')

    found = planned(files, text)

    assert [each["argv"] for each in found if "argv" in each] == [["driver"]]
    assert any("its terminal '/no/xterm' is missing" in each.get("log", "") for each in found)


def test_what_is_wrong_otherwise_stays_an_error(files: Files) -> None:
    """A misspelt option is not a missing package."""
    text = FILE.replace('"echo", "started"', '"echo"], shel=["x"')

    with pytest.raises(LaunchFileError, match="has no 'shel'"):
        records(files, text)


CONTAINER = """
from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer, LoadComposableNodes
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    return LaunchDescription([
        ComposableNodeContainer(
            name="c", namespace="", package="rclcpp_components", executable="component_container",
            composable_node_descriptions=[
                ComposableNode(package="joy", plugin="joy::Joy"),
                ComposableNode(package="image_proc", plugin="image_proc::RectifyNode", name="eye"),
                ComposableNode(package="topic_tools", plugin="topic_tools::RelayNode", name="r",
                               parameters=[{"input_topic": "chatter"}]),
            ]),
    ])
"""


def test_of_a_container_the_nodes_stay_that_aionode_has(files: Files) -> None:
    """The others are named, with their descriptions."""
    found = records(files, CONTAINER)

    plugins = [each["plugin"] for each in found if "plugin" in each]
    assert plugins == [
        "aionode.programs._joy.joy_node:JoyNode",
        "aionode.programs._topic_tools.relay:Relay",
    ]
    (log,) = (each["log"] for each in found if "log" in each)
    assert log.startswith("package 'image_proc' is missing: it is a set of image processing")
    assert "left out: image_proc::RectifyNode (" in log


def test_without_the_option_a_plugin_that_is_missing_is_an_error_that_says_what_it_is(
    files: Files,
) -> None:
    """Rather than that the container is missing, since having it would not help."""
    with pytest.raises(
        LaunchFileError, match=r"'image_proc': not found in .* it is a set of image"
    ):
        _ = Plan(files.write("a.launch.py", CONTAINER)).steps


def test_the_plugins_that_need_a_container_are_named(files: Files) -> None:
    """Of nodes that aionode has, the container is not missed."""
    text = CONTAINER.replace("image_proc", "robot_camera")

    with pytest.raises(
        LaunchFileError,
        match=r"'rclcpp_components': .*; it is needed for robot_camera::RectifyNode; ",
    ):
        _ = Plan(files.write("a.launch.py", text)).steps


def test_a_container_of_nodes_that_aionode_has_needs_no_process(files: Files) -> None:
    """A container of Python classes needs none either."""
    text = CONTAINER.replace(
        'ComposableNode(package="image_proc", plugin="image_proc::RectifyNode", name="eye"),', ""
    )
    found = list(Plan(files.write("a.launch.py", text)).records())

    assert [each["plugin"] for each in found if "plugin" in each] == [
        "aionode.programs._joy.joy_node:JoyNode",
        "aionode.programs._topic_tools.relay:Relay",
    ]
    assert not any("argv" in each for each in found)


MODULES = """
import sys
try:
    import colour_of_the_robot
except ImportError:
    colour_of_the_robot = None
from moveit_configs_elsewhere import MoveItConfigsBuilder
from moveit_configs_elsewhere.launches import generate_demo_launch, Settings
from launch import LaunchDescription
from launch.actions import ExecuteProcess, OpaqueFunction
from launch_ros.actions import Node


class Mine(Settings):
    value: int = 1


def later(context):
    from settings_of_the_robot import speed
    return [ExecuteProcess(cmd=["echo", str(speed)])]


def generate_launch_description():
    config = MoveItConfigsBuilder("panda").robot_description(file_path="x").to_moveit_configs()
    others = [generate_demo_launch(config), *config.nodes]
    mine = Mine(value=2)
    return LaunchDescription([
        ExecuteProcess(cmd=["echo", str(colour_of_the_robot)]),
        Node(package="tf2_ros", executable="static_transform_publisher", name="tf",
             arguments=["0", "0", "0", "0", "0", "0", "a", "b"]),
        Node(package="tf2_ros", executable="static_transform_publisher",
             parameters=[config.robot_description], name=mine.name),
        OpaqueFunction(function=later),
        *others,
    ])
"""


def test_what_is_made_by_a_module_that_is_not_there_is_left_out(files: Files) -> None:
    """Many launch files begin with imports of a package's helpers, for some of their nodes."""
    found = records(files, MODULES)

    started = [each["argv"] for each in found if "argv" in each]
    assert started[0] == ["echo", "None"], "an import that may fail does fail"
    assert [argv[-1] for argv in started[1:]] == ["__node:=tf"]
    helpers, settings = (each["log"] for each in found if "log" in each)
    file = files.folder / "a.launch.py"
    assert helpers == (
        "package 'moveit_configs_elsewhere' is missing; left out: static_transform_publisher "
        f"({file}:31), moveit_configs_elsewhere.launches.generate_demo_launch() ({file}:25)"
    )
    assert settings.startswith("package 'settings_of_the_robot' is missing; left out: Opaque")


def test_a_file_whose_description_comes_from_a_module_that_is_not_there_starts_nothing(
    files: Files,
) -> None:
    """Files written by MoveIt's assistant are like this."""
    text = """
def generate_launch_description():
    from moveit_configs_elsewhere.launches import generate_rsp_launch
    return generate_rsp_launch("panda")
"""
    (log,) = records(files, text)
    assert log["log"].startswith("package 'moveit_configs_elsewhere' is missing; left out:")

    with pytest.raises(LaunchFileError, match="no module moveit_configs_elsewhere"):
        Plan(files.write("a.launch.py", text))


def test_a_name_that_aionode_does_not_have_stays_an_error(files: Files) -> None:
    """The package exists; leaving things out would hide a mistake."""
    text = "from launch.acions import Node\n"

    with pytest.raises(LaunchFileError, match="launch"):
        records(files, text)


@pytest.mark.processes
def test_a_command_that_looks_for_a_package_that_is_not_there_is_left_out(files: Files) -> None:
    """One is xacro, for a description that includes another package's."""
    pytest.importorskip("xacro")
    files.write(
        "robot.urdf.xacro",
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="$(find create3)/urdf/create3.urdf.xacro"/></robot>',
    )
    text = """
from launch import LaunchDescription
from launch.substitutions import Command, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node

def generate_launch_description():
    file = PathJoinSubstitution([ThisLaunchFileDir(), "robot.urdf.xacro"])
    return LaunchDescription([
        Node(package="robot_state_publisher", executable="robot_state_publisher",
             parameters=[{"robot_description": Command(["xacro ", file])}]),
    ])
"""
    (log,) = records(files, text)
    assert log["log"].startswith("package 'create3' is missing; left out:")


def test_a_node_is_left_out_whose_parameters_are_in_a_package_that_is_not_there(
    files: Files,
) -> None:
    """Without them it would be a different node from the intended one."""
    text = """
import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    file = os.path.join(get_package_share_directory("nowhere"), "config", "twist_mux.yaml")
    return LaunchDescription([
        Node(package="twist_mux", executable="twist_mux", parameters=[file]),
    ])
"""
    (log,) = records(files, text)
    assert log["log"].startswith("package 'nowhere' is missing; left out: twist_mux")


@pytest.mark.parametrize(
    "builder",
    [
        "MoveItConfigsBuilder('arm').trajectory_execution('a.yaml').to_moveit_configs()",
        "ParameterBuilder('arm_moveit_config').yaml('a.yaml')",
    ],
)
def test_a_node_is_left_out_whose_parameters_are_built_of_a_package_that_is_not_there(
    files: Files, builder: str
) -> None:
    """The package is named, not the helper that looks for it."""
    text = f"""
from launch import LaunchDescription
from launch_param_builder import ParameterBuilder
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder

def generate_launch_description():
    config = {builder}
    return LaunchDescription([
        Node(package="twist_mux", executable="twist_mux", parameters=[config.to_dict()]),
        Node(package="twist_mux", executable="twist_mux"),
    ])
"""
    log, started = records(files, text)

    assert log["log"].startswith("package 'arm_moveit_config' is missing; left out: twist_mux")
    assert "twist_mux" in started["argv"]


def test_a_launch_file_that_is_made_of_a_package_that_is_not_there_starts_nothing(
    files: Files,
) -> None:
    """As most of those in the package of a robot with MoveIt."""
    text = """
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_rsp_launch

def generate_launch_description():
    return generate_rsp_launch(MoveItConfigsBuilder("arm").to_moveit_configs())
"""
    (log,) = records(files, text)
    assert log["log"].startswith("package 'arm_moveit_config' is missing; left out: robot_state")


def test_code_that_cannot_handle_what_a_missing_module_gives_it_is_left_out(files: Files) -> None:
    """Code that joins texts is such code; the error names the module, not the stand-in."""
    text = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess, OpaqueFunction
from robot_utils import read_argument

def suffix(arm):
    return "_".join(["config", arm])

def setup(context):
    return [ExecuteProcess(cmd=["driver", suffix(read_argument("arm"))])]

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup), ExecuteProcess(cmd=["echo"])])
"""
    log, started = records(files, text)

    assert log["log"].startswith(
        "package 'robot_utils' is missing; left out: OpaqueFunction(setup)"
    )
    assert started["argv"] == ["echo"]


def test_a_mistake_beside_a_missing_module_stays_an_error(files: Files) -> None:
    """It would go unnoticed, if it were left out."""
    text = """
from launch import LaunchDescription
from launch.actions import OpaqueFunction
from robot_utils import read_argument

def setup(context):
    arm = read_argument("arm")
    return "_".join(["config", 1])

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
"""
    with pytest.raises(LaunchFileError, match="expected str instance, int found"):
        records(files, text)


INCLUDES = """
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import LaunchConfiguration
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    return LaunchDescription([
        {include}
        ExecuteProcess(cmd=["driver", LaunchConfiguration("address")]),
        ExecuteProcess(cmd=["echo"]),
    ])
"""


def test_what_needs_an_argument_that_a_missing_file_declares_is_left_out(files: Files) -> None:
    """A launch file may read the arguments of those that it includes."""
    include = 'IncludeLaunchDescription([FindPackageShare("simulator"), "/a.launch.py"]),'
    log, started = records(files, INCLUDES.format(include=include))

    assert log["log"].startswith("package 'simulator' is missing; left out: IncludeLaunch")
    assert "ExecuteProcess" in log["log"]
    assert started["argv"] == ["echo"]


def test_an_unknown_argument_stays_an_error_if_all_files_are_here(files: Files) -> None:
    """Nothing can have declared it."""
    with pytest.raises(LaunchFileError, match="'address' does not exist here"):
        records(files, INCLUDES.format(include=""))


def test_a_file_that_is_included_and_is_not_here_is_left_out(files: Files) -> None:
    """It may belong to a submodule or a build that is missing, and the file itself is named."""
    text = FILE.replace('get_package_share_directory("tb3_sim")', '"/nowhere"')
    logs = [each["log"] for each in records(files, text) if "log" in each]

    assert any(
        log.startswith("file '/nowhere/launch/sim.launch.py' is missing; left out: IncludeLaunch")
        for log in logs
    )
    with pytest.raises(LaunchFileError, match=r"sim\.launch\.py, which cannot be read"):
        _ = Plan(files.write("a.launch.py", text)).steps


def test_code_that_runs_a_program_that_is_not_installed_is_left_out(files: Files) -> None:
    """One creates an environment for a node."""
    text = """
import subprocess
from launch import LaunchDescription
from launch.actions import ExecuteProcess, OpaqueFunction

def setup(context):
    subprocess.run(["no-such-program", "sync"], check=True)

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup), ExecuteProcess(cmd=["echo"])])
"""
    log, started = records(files, text)

    assert log["log"].startswith("program 'no-such-program' is missing; left out: OpaqueFunction")
    assert started["argv"] == ["echo"]
    with pytest.raises(LaunchFileError, match="no-such-program"):
        _ = Plan(files.write("a.launch.py", text)).steps


def test_a_file_that_code_cannot_open_stays_an_error(files: Files) -> None:
    """It is not a program."""
    text = """
from launch import LaunchDescription
from launch.actions import OpaqueFunction

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=lambda context: open("/nowhere.yaml"))])
"""
    with pytest.raises(LaunchFileError, match=r"nowhere\.yaml"):
        records(files, text)


PREFIX = """
import os
from launch import LaunchDescription
from launch.actions import *

at_top = os.environ["AMENT_PREFIX_PATH"]

def setup(context):
    return [ExecuteProcess(cmd=["in-function", os.environ["AMENT_PREFIX_PATH"]])]

def generate_launch_description():
    share = ":".join(os.path.join(p, "share") for p in os.getenv("AMENT_PREFIX_PATH").split(":"))
    return LaunchDescription([
        ExecuteProcess(cmd=["at-top", at_top, share]), OpaqueFunction(function=setup),
        ResetEnvironment(), ExecuteProcess(cmd=["last"]),
    ])
"""


def test_a_launch_file_can_read_where_packages_are_installed(files: Files) -> None:
    """It expects a sourced ROS 2, which sets the variable."""
    top, function, _ = records(files, PREFIX)

    assert top["argv"] == ["at-top", sys.prefix, f"{sys.prefix}/share"]
    assert function["argv"] == ["in-function", sys.prefix]


def test_what_is_started_is_not_told_that_ros_is_sourced(files: Files) -> None:
    """Programs would look there for its message types."""
    found = Plan(files.write("a.launch.py", PREFIX)).steps

    assert all("AMENT_PREFIX_PATH" not in step.env for step in found if isinstance(step, Process))
    assert "AMENT_PREFIX_PATH" not in os.environ


def test_each_place_where_packages_are_is_named_once(files: Files) -> None:
    """Also the one that launch files can read."""
    text = """
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([Node(package="nowhere", executable="a")])
"""
    with pytest.raises(LaunchFileError) as raised:
        _ = Plan(files.write("a.launch.py", text)).steps

    assert str(raised.value).count(sys.prefix) == 1
