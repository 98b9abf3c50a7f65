"""`ros2topic.api` and the like: what programs use of the packages behind the command `ros2`."""

from __future__ import annotations

import argparse
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

import rclpy
import ros2action.api
import ros2lifecycle.api
import ros2node.api
import ros2param.api
import ros2pkg.api
import ros2run.api
import ros2service.api
import ros2topic.api
from aionode._packages import use
from rclpy.action import ActionServer
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from ros2cli.helpers import wait_for
from ros2cli.node.direct import DirectNode
from ros2cli.node.strategy import NodeStrategy, add_arguments
from rosidl_generator_py import action_class, message_class, service_class
from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from collections.abc import Iterator

String = message_class("std_msgs/msg/String")
SetBool = service_class("std_srvs/srv/SetBool")
Fibonacci = action_class("example_interfaces/action/Fibonacci")
GetState = service_class("lifecycle_msgs/srv/GetState")
ChangeState = service_class("lifecycle_msgs/srv/ChangeState")
Transitions = service_class("lifecycle_msgs/srv/GetAvailableTransitions")
Transition = message_class("lifecycle_msgs/msg/Transition")

QUICK = SimpleNamespace(spin_time=0.01)


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process without other participants."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)


@pytest.fixture
def asking(alone: None) -> Iterator[Any]:
    """The node of a command, beside a robot's node that a thread spins."""
    with NodeStrategy(QUICK, node_name="asking") as node:
        robot = rclpy.create_node("robot", namespace="/a")
        robot.declare_parameter("speed", 1.5)
        robot.create_publisher(String, "said", 1)
        robot.create_publisher(String, "_hidden", 1)
        robot.create_subscription(String, "heard", lambda _: None, 1)
        robot.create_service(SetBool, "power", lambda _, response: response)
        ActionServer(robot, Fibonacci, "count", lambda _: Fibonacci.Result())
        manage(robot)
        executor = SingleThreadedExecutor()
        executor.add_node(robot)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        yield node
        executor.shutdown()
        thread.join()


def manage(robot: Any) -> None:
    """Give a node the services of a managed one, which is inactive and can become active."""

    def state(_: Any, response: Any) -> Any:
        response.current_state.id = 2
        response.current_state.label = "inactive"
        return response

    def transitions(_: Any, response: Any) -> Any:
        for start, label in ((2, "activate"), (3, "deactivate")):
            described = message_class("lifecycle_msgs/msg/TransitionDescription")()
            described.transition.label = label
            described.start_state.id = start
            described.start_state.label = "inactive" if start == 2 else "active"
            response.available_transitions.append(described)
        return response

    def change(request: Any, response: Any) -> Any:
        response.success = request.transition.label == "activate"
        return response

    robot.create_service(GetState, "~/get_state", state)
    robot.create_service(Transitions, "~/get_available_transitions", transitions)
    robot.create_service(ChangeState, "~/change_state", change)


def test_nodes_and_what_they_have(asking: Any) -> None:
    """As `ros2 node list` and `ros2 node info` show it."""
    api = ros2node.api

    assert api.wait_for_node(asking, "/a/robot")
    assert ("robot", "/a", "/a/robot") in api.get_node_names(node=asking)
    asked: dict[str, Any] = {"node": asking, "remote_node_name": "/a/robot"}
    assert ("/a/said", ["std_msgs/msg/String"]) in api.get_publisher_info(**asked)
    assert "/a/_hidden" not in [each.name for each in api.get_publisher_info(**asked)]
    hidden = api.get_publisher_info(**asked, include_hidden=True)
    assert "/a/_hidden" in [each.name for each in hidden]
    assert [each.name for each in api.get_subscriber_info(**asked)] == ["/a/heard"]
    assert ("/a/power", ["std_srvs/srv/SetBool"]) in api.get_service_server_info(**asked)
    assert api.get_action_server_info(**asked) == [
        ("/a/count", ["example_interfaces/action/Fibonacci"])
    ]
    assert api.get_service_client_info(**asked) == []
    assert api.get_action_client_info(**asked) == []


def test_names_of_nodes_are_taken_apart() -> None:
    """With a slash before them or without."""
    api = ros2node.api

    assert api.parse_node_name("a/b/c") == ("c", "/a/b", "/a/b/c")
    assert api.parse_node_name("/c") == ("c", "/", "/c")
    assert (api.get_absolute_node_name("c"), api.get_absolute_node_name("")) == ("/c", None)
    assert api.has_duplicates(["a", "b", "a"])


def test_topics_and_their_classes(asking: Any, capsys: pytest.CaptureFixture[str]) -> None:
    """`get_msg_class` is what most programs use of ros2cli."""
    api = ros2topic.api

    assert "/a/said" in api.get_topic_names(node=asking)
    assert "/a/_hidden" not in api.get_topic_names(node=asking)
    assert api.get_msg_class(asking, "a/said") is String
    assert api.get_msg_class(asking, "/nobody") is None
    assert "topic [/nobody] does not appear to be published yet" in capsys.readouterr().out
    with pytest.raises(RuntimeError):
        api.get_msg_class(asking, "/not valid")


def test_services_and_their_classes(asking: Any) -> None:
    """A service that does not exist is an error."""
    api = ros2service.api

    assert "/a/power" in api.get_service_names(node=asking)
    assert api.get_service_class(asking, "/a/power", include_hidden_services=False) is SetBool
    with pytest.raises(RuntimeError, match="Cannot find type for '/nobody'"):
        api.get_service_class(asking, "/nobody", include_hidden_services=False)


def test_actions_and_who_has_them(asking: Any) -> None:
    """As `ros2 action info` shows it."""
    api = ros2action.api

    assert api.get_action_names(node=asking) == ["/a/count"]
    clients, servers = api.get_action_clients_and_servers(node=asking, action_name="/a/count")
    assert (clients, servers) == ([], [("/a/robot", ["example_interfaces/action/Fibonacci"])])


def test_parameters_are_listed_described_set_and_read(asking: Any) -> None:
    """Each by a call that spins the node until the answer is there."""
    api = ros2param.api
    asked: dict[str, Any] = {"node": asking, "node_name": "/a/robot"}

    listed = api.call_list_parameters(**asked)
    assert "speed" in listed.result().result.names
    described = api.call_describe_parameters(**asked, parameter_names=["speed"])
    assert api.get_parameter_type_string(described.descriptors[0].type) == "double"
    changed = [Parameter("speed", value=2.5).to_parameter_msg()]
    assert api.call_set_parameters(**asked, parameters=changed).results[0].successful
    read = api.call_get_parameters(**asked, parameter_names=["speed"])
    assert api.get_value(parameter_value=read.values[0]) == 2.5


def test_a_parameter_file_is_loaded(
    asking: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The outcome of each parameter is printed."""
    file = tmp_path / "params.yaml"
    file.write_text("/a/robot:\n  ros__parameters:\n    speed: 3.0\n")

    ros2param.api.load_parameter_file(
        node=asking, node_name="/a/robot", parameter_file=str(file), use_wildcard=False
    )

    assert capsys.readouterr().out == "Set parameter speed successful\n"


def test_of_a_parameter_file_only_the_section_of_the_node_is_loaded(
    asking: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Files usually have those of several nodes."""
    file = tmp_path / "params.yaml"
    file.write_text(
        "/a/other:\n  ros__parameters:\n    size: 1\n    speed: 7.0\n"
        "/a/robot:\n  ros__parameters:\n    speed: 3.0\n"
    )

    ros2param.api.load_parameter_file(
        node=asking, node_name="/a/robot", parameter_file=str(file), use_wildcard=False
    )

    assert capsys.readouterr().out == "Set parameter speed successful\n"


def test_managed_nodes_are_asked_and_changed(asking: Any) -> None:
    """Several at a time, in dicts by the nodes' names."""
    api = ros2lifecycle.api

    assert [each.full_name for each in api.get_node_names(node=asking)] == ["/a/robot"]
    states = api.call_get_states(node=asking, node_names=["/a/robot"])
    assert states["/a/robot"].label == "inactive"
    open_ones = api.call_get_available_transitions(node=asking, states=states)
    assert [each.transition.label for each in open_ones["/a/robot"]] == ["activate"]
    everything = api.call_get_available_transitions(node=asking, states={"/a/robot": None})
    assert len(everything["/a/robot"]) == 2
    wanted = {"/a/robot": Transition(label="activate")}
    assert api.call_change_states(node=asking, transitions=wanted) == {"/a/robot": True}


def test_a_profile_has_the_policies_that_options_name() -> None:
    """Beside those of its preset; a latched one keeps at least one message."""
    make = ros2topic.api.qos_profile_from_short_keys

    profile = make("sensor_data", durability="transient_local", depth=7)
    assert (profile.depth, profile.durability) == (7, DurabilityPolicy.TRANSIENT_LOCAL)
    assert profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert make("sensor_data").durability is DurabilityPolicy.VOLATILE
    assert make("system_default", durability="transient_local").depth == 1


def test_options_of_commands_are_parsed() -> None:
    """The options are those of the node and of a profile."""
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    ros2topic.api.add_qos_arguments(parser, "publish", "default")

    found = parser.parse_args(["--spin-time", "2", "-s", "--qos-reliability", "best_effort"])

    assert (found.spin_time, found.use_sim_time, found.no_daemon) == (2.0, True, False)
    assert (found.qos_profile, found.qos_reliability) == ("default", "best_effort")
    assert ros2topic.api.positive_int("3") == 3
    with pytest.raises(argparse.ArgumentTypeError):
        ros2topic.api.positive_float("0")


def test_a_node_for_a_command_begins_and_ends_rclpy(alone: None) -> None:
    """Its name is hidden, and its attributes are those of a node."""
    with DirectNode(QUICK) as node:
        assert node.get_name().startswith("_ros2cli_")
        assert ros2node.api.get_node_names(node=node) == []
    assert not rclpy.ok()
    with pytest.raises(RuntimeError):
        node.get_name()


def test_what_is_waited_for_has_a_limit() -> None:
    """The condition is checked once more at the end."""
    answers = iter([False, False, True])

    assert wait_for(lambda: next(answers), -1, period=0.001)
    assert not wait_for(lambda: False, 0.0, period=0.001)


@pytest.mark.processes
def test_executables_of_a_package_that_is_not_built_can_be_run(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """They are functions of its setup.py: a file starts each, with aionode's rclpy."""
    package = tmp_path / "robot"
    (package / "robot").mkdir(parents=True)
    (package / "robot/__init__.py").touch()
    (package / "robot/say.py").write_text(
        "import sys\ndef main():\n    import rclpy\n    print(rclpy.__name__, sys.argv[1:])\n"
        "    return 3\n"
    )
    (package / "package.xml").write_text(
        "<package format='3'><name>robot</name><version>1.0.0</version>"
        "<export><build_type>ament_python</build_type></export></package>"
    )
    (package / "setup.py").write_text(
        "from setuptools import setup\nsetup(name='robot', packages=['robot'], "
        "entry_points={'console_scripts': ['say = robot.say:main']})\n"
    )
    use(tmp_path)

    path = ros2run.api.get_executable_path(package_name="robot", executable_name="say")
    assert path is not None
    status = ros2run.api.run_executable(path=path, argv=["a b", "c"])

    out = capfd.readouterr().out
    assert "rclpy ['a b', 'c']" in out
    assert (status, "Process exited with failure 3" in out) == (3, True)
    assert ros2run.api.get_executable_path(package_name="robot", executable_name="no") is None
    with pytest.raises(ros2pkg.api.PackageNotFound):
        ros2pkg.api.get_executable_paths(package_name="nothing")


def test_a_standard_program_has_a_file_that_starts_it() -> None:
    """As launch files of laser scanners ask for `tf2_ros`'s publisher of transforms."""
    path = ros2run.api.get_executable_path(
        package_name="tf2_ros", executable_name="static_transform_publisher"
    )
    assert path is not None

    done = subprocess.run(
        [path, "--no-such-argument"], capture_output=True, text=True, check=False, timeout=30
    )

    assert "static_transform_publisher" in path
    assert done.returncode != 0
    assert done.stderr
    assert sys.executable in Path(path).read_text(encoding="utf-8")
