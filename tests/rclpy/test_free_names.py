"""Classes of ROS's packages leave the same names to users as the real ones."""

from __future__ import annotations

import importlib
import inspect
import json
import pkgutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from aionode.launch._evaluation import evaluate, new_context
from aionode.launch.plan import Process
from tests.test_free_names import own_names, robots

REAL: dict[tuple[str, str], dict[str, list[str]]] = {
    (entry["package"], entry["class"]): entry
    for entry in map(
        json.loads,
        (Path(__file__).parent / "class_names.jsonl").read_text("utf-8").splitlines(),
    )
}
"""The classes of ROS's packages, by package and name: their bases, and their names."""

NEWER = {
    "_spin_once_impl",
    "configure_nodes_filter",
    "getLatestTime",
    "get_clients_info_by_service",
    "get_servers_info_by_service",
    "is_spinning",
}
"""Names that these classes have gained since."""

OF_ROS = {
    "rclpy": {
        "ActionClient",
        "ActionServer",
        "CallbackGroup",
        "Executor",
        "LifecycleNode",
        "ManagedEntity",
        "MultiThreadedExecutor",
        "MutuallyExclusiveCallbackGroup",
        "Node",
        "ParameterEventHandler",
        "ReentrantCallbackGroup",
        "SimpleManagedEntity",
        "SingleThreadedExecutor",
        "Waitable",
    },
    "tf2_py": {"BufferCore"},
    "tf2_ros": None,
    "message_filters": None,
    "launch": None,
    "launch_ros": None,
}
"""The corresponding packages of ROS; None for everything that the package in ROS has, too."""

NOT_INHERITED = {"LaunchContext", "LaunchService", "ProcessStdin"}
"""Objects that launch creates and passes to subclasses; the last is an event of another kind
there."""

BELOW = {"launch_ros": "launch", "tf2_ros": "tf2_py"}
"""Other packages from which a package takes the bases of its classes."""


def real_names(package: str, name: str) -> set[str]:
    """Return the names that a class of ROS and its bases use."""
    while (package, name) not in REAL:
        if package not in BELOW:
            return set()
        package = BELOW[package]
    entry = REAL[package, name]
    inherited = (real_names(package, base) for base in entry["bases"] if base != name)
    return set(entry["names"]).union(*inherited)


def ours(module: str, name: str) -> Any:
    """Return a subclass of a ROS class, with a robot's own methods."""
    cls = getattr(importlib.import_module(module), name)
    return robots(cls, real_names(module.partition(".")[0], name))


@pytest.fixture
def rclpy(installed: None) -> Iterator[Any]:  # a fixture
    """The rclpy of aionode, initialised."""
    module: Any = importlib.import_module("rclpy")
    module.init()
    yield module
    module.shutdown()


def modules_of(package: str) -> Iterator[Any]:
    """Yield the modules of a package of ROS, as programs import them."""
    top = importlib.import_module(package)
    yield top
    for found in pkgutil.walk_packages(getattr(top, "__path__", []), f"{package}."):
        if not any(part.startswith("_") for part in found.name.split(".")):
            yield importlib.import_module(found.name)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:importing 'qos_event' is deprecated")
@pytest.mark.usefixtures("rclpy")
@pytest.mark.parametrize("package", OF_ROS)
def test_classes_of_ros_take_no_names_that_the_real_ones_leave_free(package: str) -> None:
    """Most robots have a node with their own methods, such as `_init_parameters`."""
    chosen = OF_ROS[package]
    taken: dict[str, set[str]] = {}
    for module in modules_of(package):
        for name, cls in vars(module).items():
            known = (package, name) in REAL and inspect.isclass(cls) and name not in NOT_INHERITED
            if known and (chosen is None or name in chosen) and not issubclass(cls, BaseException):
                taken[name] = own_names(cls) - real_names(package, name) - NEWER

    assert {name: sorted(names) for name, names in taken.items() if names} == {}
    assert taken.keys() >= (chosen or set())
    assert taken


@pytest.mark.usefixtures("rclpy")
def test_a_node_works_whatever_methods_of_its_own_it_has() -> None:
    """Each of these names was one of ours, and such a robot failed in its constructor."""
    robot = ours("rclpy.node", "Node")("robot")
    heard: list[str] = []
    words = importlib.import_module("std_msgs.msg").String
    robot.create_subscription(words, "/words", lambda msg: heard.append(msg.data), 10)
    publisher = robot.create_publisher(words, "/words", 10)
    robot.declare_parameter("speed", 1.0)

    publisher.publish(words(data="hello"))
    importlib.import_module("rclpy").spin_once(robot, timeout_sec=10)
    robot.destroy_node()

    assert heard == ["hello"]


@pytest.mark.usefixtures("rclpy")
def test_a_synchronizer_of_rclpy_works_whatever_methods_of_its_own_it_has() -> None:
    """Programs inherit from it to inspect incoming messages."""
    point = importlib.import_module("geometry_msgs.msg").PointStamped
    inputs = [ours("message_filters", "SimpleFilter")() for _ in range(2)]
    pairs = ours("message_filters", "ApproximateTimeSynchronizer")(inputs, 10, 0.1)
    found: list[tuple[Any, ...]] = []
    pairs.registerCallback(lambda *messages: found.append(messages))

    for each in inputs:
        each.signalMessage(point())

    assert len(found) == 1


@pytest.mark.usefixtures("rclpy")
def test_a_buffer_of_rclpy_works_whatever_methods_of_its_own_it_has() -> None:
    """A robot's buffer may have its own `_lock`."""
    transform = importlib.import_module("geometry_msgs.msg").TransformStamped
    tf2_ros: Any = importlib.import_module("tf2_ros")
    stamped = transform(child_frame_id="b")
    stamped.header.frame_id = "a"
    stamped.transform.rotation.w = 1.0
    buffer = ours("tf2_ros", "Buffer")()

    buffer.set_transform_static(stamped, "me")

    assert buffer.lookup_transform("a", "b", tf2_ros.Time()).child_frame_id == "b"


@pytest.mark.usefixtures("rclpy")
def test_what_launch_files_inherit_from_works_whatever_methods_it_has() -> None:
    """Packages have their own actions, substitutions and handlers."""
    actions: Any = importlib.import_module("launch.actions")
    text = ours("launch.substitutions", "TextSubstitution")(text="x")
    node = ours("launch_ros.actions", "Node")(executable="talker", name=text, respawn=True)
    entities = [
        ours("launch.actions", "DeclareLaunchArgument")("speed", default_value="1"),
        ours("launch.actions", "GroupAction")(
            [node, ours("launch.actions", "ExecuteProcess")(cmd=["echo", text])]
        ),
        ours("launch.actions", "OpaqueFunction")(function=lambda context: []),
        actions.RegisterEventHandler(
            ours("launch.event_handlers", "OnProcessExit")(
                target_action=node, on_exit=[ours("launch.actions", "LogInfo")(msg="over")]
            )
        ),
    ]

    steps = evaluate(entities, new_context("a.launch.py", {}))

    assert [step.argv[0] for step in steps if isinstance(step, Process)] == ["talker", "echo"]
