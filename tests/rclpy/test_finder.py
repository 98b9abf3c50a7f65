"""Imports of rclpy's programs: packages of ROS, from aionode."""

from __future__ import annotations

import importlib
import logging
import pickle
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import aionode.rclpy
from aionode.errors import IdlError
from aionode.rclpy import _finder
from rosidl_generator_py import message_class
from tests.support.without_ros import without_ros

WORDS = """\
uint8 MANY = 100
std_msgs/Header header
string[] words
Score[<=3] scores
"""


@pytest.fixture
def words(tmp_path: Path) -> Path:
    """A folder of two packages, as a workspace or as installed."""
    share = tmp_path / "share"
    for package, name, text in (
        ("find_words_msgs", "Words", WORDS.replace("Score", "find_score_msgs/Score")),
        ("find_score_msgs", "Score", "float32 value 0.5\n"),
    ):
        (share / package / "msg").mkdir(parents=True)
        (share / package / "msg" / f"{name}.msg").write_text(text)
    return tmp_path


@pytest.mark.usefixtures("installed")
def test_message_packages_are_there() -> None:
    """The import at the top of every program."""
    module = importlib.import_module("std_msgs.msg")

    assert module.String is message_class("std_msgs/msg/String")
    assert {"String", "Header"} <= set(dir(module))
    assert "String" in module.__all__


@pytest.mark.usefixtures("installed")
def test_the_modules_of_a_message_package_need_no_import() -> None:
    """In ROS they are loaded as soon as another message is created from theirs."""
    package = importlib.import_module("std_msgs")

    assert package.msg.Bool is message_class("std_msgs/msg/Bool")
    with pytest.raises(AttributeError, match="module 'std_msgs' has no attribute 'srv'"):
        _ = package.srv


@pytest.mark.usefixtures("installed")
def test_the_module_of_one_message_is_there() -> None:
    """Rosbridge and pickle import it by the name that the class reports."""
    module = importlib.import_module("std_msgs.msg._multi_array_layout")

    assert module.MultiArrayLayout is message_class("std_msgs/msg/MultiArrayLayout")
    assert type(module.MultiArrayLayout) is module.Metaclass_MultiArrayLayout


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("cv_bridge", "CvBridge"),
        ("cv_bridge.core", "CvBridgeError"),
        ("cv_bridge.boost.cv_bridge_boost", "cvtColor2"),
        ("diagnostic_updater", "Updater"),
        ("message_filters", "ApproximateTimeSynchronizer"),
        ("ros2_numpy", "numpify"),
        ("rosbag2_py", "SequentialReader"),
        ("ros2_numpy.point_cloud2", "pointcloud2_to_xyz_array"),
        ("ros2_numpy.transformations", "quaternion_from_euler"),
        ("tf_transformations", "euler_from_quaternion"),
    ],
)
def test_small_packages_beside_rclpy_are_there(module: str, name: str) -> None:
    """Most programs of robots import one of them."""
    assert callable(getattr(importlib.import_module(module), name))


@pytest.mark.usefixtures("installed")
def test_the_parts_of_services_and_actions_are_there() -> None:
    """Some programs import them by their full names."""
    service = importlib.import_module("std_srvs.srv")
    action = importlib.import_module("example_interfaces.action._fibonacci")

    assert service.SetBool_Request is service.SetBool.Request
    assert action.Fibonacci_Goal is action.Fibonacci.Goal


@pytest.mark.usefixtures("installed")
def test_an_import_of_everything_brings_the_parts_of_services() -> None:
    """As of the modules that rosidl generates."""
    names: dict[str, Any] = {}
    exec("from std_srvs.srv import *", names)  # noqa: S102

    assert names["SetBool_Request"] is names["SetBool"].Request


@pytest.mark.usefixtures("installed")
def test_messages_can_be_pickled() -> None:
    """They are sent to other processes by multiprocessing, or stored in files."""
    message = message_class("std_msgs/msg/Header")(frame_id="map")

    assert pickle.loads(pickle.dumps(message)) == message  # noqa: S301 (its own)


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("module", "name"),
    [("rclpy.node", "Node"), ("tf2_ros.buffer", "Buffer"), ("launch.event", "Event")],
)
def test_classes_are_defined_where_ros_has_them(module: str, name: str) -> None:
    """Tracebacks show it, and pickles; no module has a second name."""
    found = getattr(importlib.import_module(module), name)

    assert found.__module__ == module
    assert [each for each in sys.modules if each.endswith(f".{module}")] == []


@pytest.mark.parametrize("name", ["Node", "node", "init"])
def test_the_names_of_rclpy_are_not_those_of_what_installs_it(name: str) -> None:
    """`import aionode.rclpy as rclpy` has an error that says what to write."""
    with pytest.raises(AttributeError, match=r"call aionode.rclpy.install\(\), then import"):
        getattr(aionode.rclpy, name)


@pytest.mark.parametrize(
    "statement",
    [
        "from aionode.rclpy.node import Node",
        "from aionode.rclpy import init",
        "import aionode.rclpy.qos",
    ],
)
def test_imports_of_rclpys_names_from_what_installs_it_say_where_they_are(
    statement: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Programs written for the first versions have them, and a reader may guess them."""
    finder = aionode.rclpy.MisplacedNames()  # another test may have restored sys.meta_path
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path, finder])

    with pytest.raises(ModuleNotFoundError, match=r"call aionode.rclpy.install\(\), then import"):
        exec(statement)  # noqa: S102  # a text of this file


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("rclpy.nothing", "No module named 'rclpy.nothing'"),
        ("std_msgs.srv", "No module named 'std_msgs.srv'"),
        ("std_msgs.msg._nothing", "No module named 'std_msgs.msg._nothing'"),
        ("no_such_msgs", "No module named 'no_such_msgs'"),
    ],
)
def test_what_is_not_there_is_missed_as_usual(name: str, problem: str) -> None:
    """Programs try imports, and fall back to others."""
    with pytest.raises(ModuleNotFoundError) as caught:
        importlib.import_module(name)

    assert str(caught.value) == problem


@pytest.mark.usefixtures("installed")
def test_a_class_that_is_not_there_is_missed_as_usual() -> None:
    """The error of the import statement is Python's."""
    module = importlib.import_module("std_msgs.msg")

    with pytest.raises(AttributeError, match=r"module 'std_msgs\.msg' has no attribute 'Strin'"):
        _ = module.Strin


@pytest.mark.usefixtures("installed")
def test_messages_of_a_folder_need_no_build(words: Path) -> None:
    """A workspace's packages are available as soon as its folder is named."""
    aionode.rclpy.install(interfaces=[words])

    module = importlib.import_module("find_words_msgs.msg")

    message = module.Words(words=["a"], scores=[message_class("find_score_msgs/msg/Score")()])
    assert message.MANY == 100
    assert message.scores[0].value == 0.5
    assert type(message.header) is message_class("std_msgs/msg/Header")


@pytest.mark.usefixtures("installed")
def test_folders_of_messages_are_read_when_they_are_used(tmp_path: Path) -> None:
    """Their order does not matter, and an invalid definition affects nothing else."""
    write_message(tmp_path / "one/late_words_msgs/msg/Words.msg", "late_score_msgs/Score best\n")
    write_message(tmp_path / "one/late_words_msgs/msg/Lost.msg", "no_such_msgs/Thing thing\n")
    write_message(tmp_path / "one/late_words_msgs/msg/Broken.msg", "what is this?\n")
    write_message(tmp_path / "two/late_score_msgs/msg/Score.msg", "float32 value 0.5\n")
    aionode.rclpy.install(interfaces=[tmp_path / "one", tmp_path / "two"])

    module = importlib.import_module("late_words_msgs.msg")

    assert module.Words().best.value == 0.5
    with pytest.raises(IdlError, match=r"Lost\.msg:1:1: no message type 'no_such_msgs/Thing'"):
        _ = module.Lost
    with pytest.raises(IdlError, match=r"Broken\.msg:1"):
        _ = module.Broken
    assert type(module.Words().best) is message_class("late_score_msgs/msg/Score")


@pytest.mark.usefixtures("installed")
def test_the_first_of_two_equal_names_wins_with_a_warning(tmp_path: Path) -> None:
    """Copies of the same text do not count: a workspace has its source and its installation."""
    write_message(tmp_path / "one/twice_msgs/msg/Words.msg", "int8 first\n")
    write_message(tmp_path / "two/twice_msgs/msg/Words.msg", "int8 second\n")
    write_message(tmp_path / "two/same_msgs/msg/Words.msg", "int8 same\n")
    write_message(tmp_path / "three/same_msgs/msg/Words.msg", "int8 same\n")
    aionode.rclpy.install(interfaces=[tmp_path / name for name in ("one", "two", "three")])

    with pytest.warns(
        RuntimeWarning, match="twice_msgs/msg/Words is defined in .*one.*two"
    ) as seen:
        module = importlib.import_module("twice_msgs.msg")

    assert len(seen) == 1
    assert module.Words().get_fields_and_field_types() == {"first": "int8"}


@pytest.mark.usefixtures("installed")
def test_an_installed_package_may_use_messages_of_a_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folder is named for the one package that the sourced workspace lacks."""
    write_message(tmp_path / "share/outer_msgs/msg/Words.msg", "inner_msgs/Score best\n")
    write_message(tmp_path / "named/inner_msgs/msg/Score.msg", "float32 value 0.5\n")
    write_message(tmp_path / "named/inner_msgs/msg/Broken.msg", "what is this?\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    aionode.rclpy.install(interfaces=[tmp_path / "named"])

    module = importlib.import_module("outer_msgs.msg")

    assert type(module.Words().best) is message_class("inner_msgs/msg/Score")


@pytest.mark.usefixtures("installed")
def test_packages_of_the_workspace_need_no_build(tmp_path: Path) -> None:
    """Neither their Python modules nor their messages, which use one another."""
    for name in ("ws_words_msgs", "ws_score_msgs", "ws_robot"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<name>{name}</name>")
    write_message(tmp_path / "src/ws_words_msgs/msg/Words.msg", "ws_score_msgs/Score best\n")
    write_message(tmp_path / "src/ws_score_msgs/msg/Score.msg", "float32 value 0.5\n")
    robot = tmp_path / "src" / "ws_robot" / "ws_robot"
    robot.mkdir()
    (robot / "__init__.py").write_text("")
    (robot / "tools.py").write_text("from ws_words_msgs.msg import Words\n")
    aionode.rclpy.install(workspace=tmp_path)

    module = importlib.import_module("ws_robot.tools")

    assert module.Words().best.value == 0.5
    with pytest.raises(ModuleNotFoundError, match="No module named 'ws_nothing'"):
        importlib.import_module("ws_nothing")


def write_message(file: Path, text: str) -> None:
    """Write a definition."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


@pytest.mark.usefixtures("installed")
def test_installed_packages_need_no_build(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """AMENT_PREFIX_PATH leads to them, and their dependencies are loaded first."""
    for package, name, text in (
        ("share_words_msgs", "Words", "share_score_msgs/Score best\n"),
        ("share_score_msgs", "Score", "float32 value 0.5\n"),
    ):
        folder = tmp_path / "share" / package / "msg"
        folder.mkdir(parents=True)
        (folder / f"{name}.msg").write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))

    module = importlib.import_module("share_words_msgs.msg")

    assert module.Words().best.value == 0.5


@pytest.mark.usefixtures("installed")
def test_python_modules_beside_messages_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A package may have both; only its messages come from aionode."""
    (tmp_path / "share" / "mixed_msgs" / "msg").mkdir(parents=True)
    (tmp_path / "share" / "mixed_msgs" / "msg" / "Score.msg").write_text("float32 value\n")
    (tmp_path / "mixed_msgs").mkdir()
    (tmp_path / "mixed_msgs" / "__init__.py").write_text("")
    (tmp_path / "mixed_msgs" / "tools.py").write_text("ANSWER = 42\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    monkeypatch.syspath_prepend(tmp_path)

    assert importlib.import_module("mixed_msgs.tools").ANSWER == 42
    assert importlib.import_module("mixed_msgs.msg").Score().value == 0.0


def test_another_rclpy_that_is_imported_is_not_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program with classes of both would fail later, in unhelpful places."""
    other = ModuleType("rclpy")
    other.__file__ = "/opt/ros/rclpy/__init__.py"
    monkeypatch.setitem(sys.modules, "rclpy", other)

    with pytest.raises(ImportError, match=r"/opt/ros/rclpy/__init__.py is imported already"):
        aionode.rclpy.install()


@pytest.fixture
def ros(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An installed rclpy that is not aionode's."""
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").write_text("NAME = 'of ROS'\n")
    monkeypatch.syspath_prepend(tmp_path)
    return tmp_path / "rclpy"


def test_an_installed_rclpy_is_not_passed_over_in_silence(
    ros: Path, caplog: pytest.LogCaptureFixture, capsys: pytest.CaptureFixture[str]
) -> None:
    """Users who also have ROS 2 see which of the two runs."""
    with without_ros():
        aionode.rclpy.install()

    assert f"the rclpy of aionode, not that of ROS ({ros})" in caplog.text + capsys.readouterr().err


def test_an_installed_rclpy_can_be_preferred(
    ros: Path, caplog: pytest.LogCaptureFixture, capsys: pytest.CaptureFixture[str]
) -> None:
    """Tests of a package run with ROS if it is installed, and with aionode elsewhere."""
    with without_ros(), caplog.at_level(logging.INFO):
        aionode.rclpy.install(prefer_ros=True)
        assert _finder.FINDER not in sys.meta_path

    assert f"using the rclpy of ROS ({ros})" in caplog.text + capsys.readouterr().err


def test_aionode_itself_imports_none_of_this() -> None:
    """Only rclpy programs pay for it."""
    program = "import aionode, sys; print([name for name in sys.modules if 'rclpy' in name])"

    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )

    assert done.stdout.strip() == "[]"


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("module", "name"), [("rclpy.executors", "Lock"), ("rclpy.node", "time"), ("tf2_ros", "sleep")]
)
def test_what_modules_import_of_python_itself_is_not_theirs(module: str, name: str) -> None:
    """No public program was seen to use it from there; it can be imported from Python."""
    with pytest.raises(AttributeError, match=f"module '{module}' has no attribute '{name}'"):
        getattr(importlib.import_module(module), name)


@pytest.mark.usefixtures("installed")
def test_a_time_of_tf2_is_one_of_rclpy() -> None:
    """A message of that name is imported by other modules."""
    tf2_ros, time = map(importlib.import_module, ("tf2_ros", "rclpy.time"))

    assert tf2_ros.Time is time.Time


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("launch.actions.execute_process", "ExecuteProcess"),
        ("launch.actions.group_action", "GroupAction"),
        ("launch.actions.timer_action", "TimerAction"),
        ("launch.actions.shutdown_action", "Shutdown"),
        ("launch_ros.actions.set_ros_log_dir", "SetROSLogDir"),
        ("launch.utilities.perform_substitutions_impl", "perform_substitutions"),
    ],
)
def test_a_class_of_launch_has_a_module_of_its_own(module: str, name: str) -> None:
    """As in ROS, where each class and function is in a file named after it."""
    assert callable(getattr(importlib.import_module(module), name))
