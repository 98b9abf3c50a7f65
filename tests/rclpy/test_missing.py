"""The errors about a missing package of ROS."""

from __future__ import annotations

import tomllib
from importlib import import_module
from pathlib import Path

import pytest

from aionode.rclpy.missing import advice, missing_modules

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("module", "part"),
    [
        ("my_robot_msgs.msg", "--interfaces FOLDER"),
        ("my_robot_interfaces", "--interfaces FOLDER"),
        ("plansys2_msgs.srv", "--interfaces FOLDER"),
        ("launch_testing.actions", "fixtures for pytest"),
        ("ros2doctor.api", "PYTHONPATH"),
        ("rqt_gui_py", "where ROS 2 is installed"),
        ("rospy", "ROS 1"),
        ("tf2_kdl", "tf_transformations"),
    ],
)
def test_a_known_package_has_its_own_way(module: str, part: str) -> None:
    """Messages need definitions, Python packages their source, and the rest a replacement."""
    text = advice(module)

    assert text is not None
    assert text.startswith(module.partition(".")[0])
    assert part in text


@pytest.mark.parametrize(
    ("module", "extra", "distribution"),
    [
        ("cv2", "opencv", "opencv-python-headless"),
        ("scipy.spatial", "desktop", "scipy"),
        ("serial", "serial", "pyserial"),
        ("xacro", "xacro", "xacro"),
    ],
)
def test_what_an_extra_brings_is_said_with_its_name(
    module: str, extra: str, distribution: str
) -> None:
    """One command, whose extra exists and installs the module."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

    assert f"pip install 'aionode[{extra}]'" in (advice(module) or "")
    assert any(line.startswith(distribution) for line in project["optional-dependencies"][extra])


def test_nothing_is_said_about_other_modules() -> None:
    """They are not ROS's, and pip's own error is better."""
    assert advice("flask") is None
    assert advice("helper") is None


def test_a_module_of_a_package_that_aionode_has_is_told_apart() -> None:
    """Getting the package from elsewhere would not help."""
    text = advice("rclpy.nothing", frozenset({"rclpy"}))

    assert text is not None
    assert text.startswith("rclpy is from aionode here, which does not have rclpy.nothing")


def failed(module: str) -> ModuleNotFoundError:
    """The exception of an import."""
    with pytest.raises(ModuleNotFoundError) as raised:
        import_module(module)
    return raised.value


def test_missing_modules_are_found_where_a_traceback_shows_them() -> None:
    """In causes, in exceptions being handled, and in groups; each once."""
    cause, handled, part = map(failed, ("no_cause_msgs", "no_context_msgs", "no_part_msgs"))
    above = RuntimeError("above")
    above.__cause__ = cause
    later = RuntimeError("later")
    later.__context__ = handled

    group = ExceptionGroup("all", [above, later, part, part])

    assert missing_modules(group) == ["no_cause_msgs", "no_context_msgs", "no_part_msgs"]


def test_what_a_traceback_does_not_show_is_not_missing() -> None:
    """``raise … from None`` says that the import does not matter."""
    error = RuntimeError("another reason")
    error.__context__ = failed("no_context_msgs")
    error.__suppress_context__ = True

    assert missing_modules(error) == []
