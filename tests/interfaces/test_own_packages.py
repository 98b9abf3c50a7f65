"""The types of packages that aionode does not ship, wherever a program looks for them."""

from __future__ import annotations

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import click
import pytest

from aionode import Node
from aionode.cli import main
from aionode.cli._main import root
from aionode.errors import IdlError
from aionode.idl import definition_text, load_interfaces
from aionode.interfaces import get_interface, interface_names
from tests.support.without_ros import without_ros

GO_TO = """\
# Drive to a place.

float64 x    # in m
float64 tolerance 0.05
---
float64 distance
---
float64 left
"""

LINE = "from aionode.interfaces.robot_interfaces.action import GoTo"


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace with a package of interfaces, not the one that the tests run in."""
    package = tmp_path / "ws" / "src" / "robot_interfaces"
    (package / "action").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>robot_interfaces</name></package>")
    (package / "action" / "GoTo.action").write_text(GO_TO)
    return tmp_path / "ws"


def go_to() -> Any:
    """Return the class, imported as programs do."""
    return importlib.import_module("aionode.interfaces.robot_interfaces.action").GoTo


def test_the_variable_names_folders(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A plain `python program.py` has them, wherever it lies; defaults are kept."""
    monkeypatch.setenv("AIONODE_INTERFACES", str(workspace))

    assert go_to().Goal().tolerance == 0.05


def test_the_workspace_needs_no_variable(workspace: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As `aionode run` finds packages, notebooks, tests and commands find types."""
    monkeypatch.chdir(workspace)

    assert get_interface("robot_interfaces/action/GoTo") is go_to()
    assert interface_names("robot_interfaces") == ("robot_interfaces/action/GoTo",)


def test_a_program_finds_the_workspace_that_it_lies_in(workspace: Path, tmp_path: Path) -> None:
    """Wherever it is started, and without any command of aionode."""
    program = workspace / "src" / "program.py"
    program.write_text(f"{LINE}\nprint(GoTo.Goal().tolerance)\n")
    environ = {name: value for name, value in os.environ.items() if name != "AIONODE_INTERFACES"}

    done = subprocess.run(
        [sys.executable, str(program)],
        cwd=tmp_path,
        env=environ,
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.stdout == "0.05\n", done.stderr


OWN_RELEASE = """\
import sys
import aionode.rclpy

aionode.rclpy.install()
from px4_msgs.msg import VehicleStatus as Theirs
from aionode.interfaces.px4_msgs.msg import VehicleStatus
from aionode.interfaces import interface_names
from aionode.message import fields

print([field.name for field in fields(VehicleStatus)], interface_names("px4_msgs"))
print(list(Theirs.get_fields_and_field_types()))
"""


@pytest.mark.processes
@pytest.mark.parametrize("named", [False, True])
def test_the_release_that_a_robot_has_comes_before_the_shipped_one(
    workspace: Path, tmp_path: Path, named: bool
) -> None:
    """PX4 and others change their messages between releases, and a robot has its sources."""
    package = (tmp_path / "other" if named else workspace / "src") / "px4_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>px4_msgs</name></package>")
    (package / "msg/VehicleStatus.msg").write_text("uint64 timestamp\nuint8 of_release\n")
    program = (tmp_path if named else workspace / "src") / "program.py"
    program.write_text(OWN_RELEASE)
    folders = {"AIONODE_INTERFACES": str(package)} if named else {}

    done = subprocess.run(
        [sys.executable, str(program)],
        cwd=tmp_path,
        env={**os.environ, "AIONODE_INTERFACES": "", **folders},
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.stdout.splitlines() == [
        "['timestamp', 'of_release'] ('px4_msgs/msg/VehicleStatus',)",
        "['timestamp', 'of_release']",
    ], done.stderr


def test_a_loaded_folder_replaces_the_shipped_release(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As an import after `load_interfaces` gives what was loaded for packages not shipped."""
    import aionode.interfaces

    package = workspace / "src" / "octomap_msgs"
    (package / "srv").mkdir(parents=True)
    (package / "srv/GetOctomap.srv").write_text("string name\n---\n")
    for module in ("", ".msg", ".srv"):
        monkeypatch.delitem(sys.modules, f"aionode.interfaces.octomap_msgs{module}", raising=False)
    monkeypatch.delattr(aionode.interfaces, "octomap_msgs", raising=False)

    loaded = load_interfaces(package)["octomap_msgs/srv/GetOctomap"]

    assert importlib.import_module("aionode.interfaces.octomap_msgs.srv").GetOctomap is loaded
    for module in ("", ".msg", ".srv"):
        sys.modules.pop(f"aionode.interfaces.octomap_msgs{module}", None)
    delattr(aionode.interfaces, "octomap_msgs")


def test_a_package_that_is_nowhere_says_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The import fails in the user's program, which knows nothing of folders."""
    monkeypatch.chdir(tmp_path)

    with pytest.raises(ModuleNotFoundError, match="AIONODE_INTERFACES=FOLDER, or --interfaces"):
        go_to()


def test_a_folder_of_the_variable_that_is_missing_is_named(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It must not keep a program from its other folders."""
    monkeypatch.setenv("AIONODE_INTERFACES", os.pathsep.join(("/missing", str(workspace))))

    with pytest.warns(RuntimeWarning, match="AIONODE_INTERFACES: /missing: no such folder"):
        assert go_to().Goal().tolerance == 0.05


def test_a_definition_that_is_not_valid_refuses_its_own_type_alone(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folder of a workspace has types that nobody asks for."""
    package = workspace / "src/robot_interfaces"
    (package / "msg").mkdir()
    (package / "action/Bad.action").write_text("nothing\n")
    (package / "msg/Old.msg").write_text("time stamp\n")
    (package / "msg/UsesOld.msg").write_text("Old old\n")
    (package / "msg/Wide.msg").write_bytes(b"\xff\xfe")
    os.mkfifo(package / "msg/Pipe.msg")
    monkeypatch.setenv("AIONODE_INTERFACES", str(workspace))

    assert go_to().Goal().tolerance == 0.05
    module = importlib.import_module("aionode.interfaces.robot_interfaces.msg")
    for name, problem in (
        ("Old", "did you mean builtin_interfaces/Time"),
        ("UsesOld", "did you mean builtin_interfaces/Time"),
        ("Wide", r"Wide\.msg.*not UTF-8"),
    ):
        with pytest.raises(IdlError, match=problem):
            get_interface(f"robot_interfaces/msg/{name}")
        with pytest.raises(IdlError, match=problem):
            getattr(module, name)


def test_a_file_whose_name_is_no_type_is_named(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The user would look for the type in vain."""
    (workspace / "src/robot_interfaces/action/go_back.action").write_text(GO_TO)
    monkeypatch.setenv("AIONODE_INTERFACES", str(workspace))

    with pytest.warns(RuntimeWarning, match="'go_back' is not a valid type name.* it is not used"):
        assert go_to().Goal().tolerance == 0.05


async def test_a_class_of_rclpy_is_refused_with_the_line_to_write(node: Node) -> None:
    """Both classes have the same name, and the import looks like ROS's."""
    theirs: Any = type("GoTo", (), {"__module__": "robot_interfaces.action._go_to"})

    with pytest.raises(TypeError, match=f"use aionode's own: `{LINE}`"):
        node.create_action_client(theirs, "go_to")


def test_run_names_the_line_for_an_import_of_ros(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """The module does not exist in a program of aionode, but its types do."""
    program = workspace / "src" / "own_packages_native.py"
    program.write_text("from robot_interfaces.action import GoTo\nimport aionode\n")
    monkeypatch.setattr("sys.path", list(sys.path))

    with without_ros():
        assert main(["run", str(program)]) == 1

    assert f"`{LINE}`" in capfd.readouterr().err


@pytest.mark.parametrize("options", [[], ["--interfaces", "src"]])
def test_show_prints_the_file_of_a_package(
    options: list[str],
    workspace: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """As `ros2 interface show` does: each comment once, where it stands."""
    monkeypatch.chdir(workspace)

    assert main(["interface", "show", *options, "robot_interfaces/action/GoTo"]) == 0

    assert capfd.readouterr().out == GO_TO


def test_the_comment_at_the_top_of_an_action_is_printed_once(workspace: Path) -> None:
    """It describes the action, and stands in the part of the goal."""
    loaded = load_interfaces(workspace)["robot_interfaces/action/GoTo"]

    assert definition_text(loaded, comments="outer").count("Drive to a place.") == 1


def commands(group: click.Group, path: tuple[str, ...] = ()) -> dict[str, click.Command]:
    """Return the commands of a group and of its groups, by their words."""
    found: dict[str, click.Command] = {}
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        found[" ".join((*path, name))] = command
        if isinstance(command, click.Group):
            found |= commands(command, (*path, name))
    return found


MEET_TYPES = re.compile(
    "run|launch|gateway|gateway types|doctor|topic (echo|pub|hz|bw|delay)|service (call|echo)|"
    "action send_goal|interface (list|show|package|packages|proto)|bag (record|play|burst)"
)


def test_every_command_that_meets_types_takes_folders() -> None:
    """The same option everywhere: nobody has to know which command needs it."""
    without = [
        name
        for name, command in commands(root).items()
        if MEET_TYPES.fullmatch(name)
        and not any(param.name == "interfaces" for param in command.params)
    ]

    assert without == []
