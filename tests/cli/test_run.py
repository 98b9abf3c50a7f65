"""``aionode run``: finding the node classes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from aionode.cli._main import main
from aionode.cli._support.programs import Programs, module_of
from aionode.errors import CommandError, ExecutableNotFoundError, PackageNotFoundError
from aionode.system.node_source import node_maker
from tests.support.without_ros import without_ros

SOURCE = """
from aionode import Node

class Talker(Node):
    def __init__(self):
        super().__init__("talker")

class Listener(Node):
    def __init__(self):
        super().__init__("listener")

def make():
    return Talker()

NUMBER = 5
"""


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file with two node classes."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr("sys.argv", ["aionode"])
    file = tmp_path / "cli_run_nodes.py"
    file.write_text(SOURCE)
    return file


@pytest.mark.parametrize("source", ["cli_run_nodes", "cli_run_nodes.py"])
@pytest.mark.parametrize("name", ["Talker", "make"])
def test_a_class_or_function_is_found_in_a_module_or_file(
    source: str, name: str, program: Path
) -> None:
    """Installed, or in the current folder."""
    maker = node_maker(f"{source}:{name}")

    assert callable(maker)
    assert maker.__name__ == name


@pytest.mark.parametrize(
    ("spec", "says"),
    [
        ("cli_run_nodes:Nope", "nothing of that name in cli_run_nodes; its node classes: Talker"),
        ("cli_run_nodes:NUMBER", "neither a node class nor a function"),
        (
            "cli_run_nodes",
            "give a class, as cli_run_nodes:NAME; its node classes: Talker, Listener",
        ),
        ("no_such_module:Talker", "no module no_such_module here"),
        ("nope.py:Talker", "no file nope.py here"),
        (":Talker", "no module; expected MODULE:CLASS"),
    ],
)
def test_what_cannot_be_run_is_explained(spec: str, says: str, program: Path) -> None:
    """The error names what was given and what is expected."""
    with pytest.raises(CommandError) as raised:
        node_maker(spec)

    assert says in str(raised.value)


def test_a_module_that_needs_a_missing_one_names_that(tmp_path: Path) -> None:
    """The missing module is not the one that was asked for."""
    file = tmp_path / "cli_run_broken.py"
    file.write_text("import no_such_thing\n")

    with pytest.raises((CommandError, ModuleNotFoundError), match="no_such_thing"):
        node_maker(f"{file}:Talker")


def test_classes_and_arguments_are_separated(
    program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Everything after --ros-args goes to the nodes."""
    ran: list[Any] = []

    def run(*nodes: Any, args: list[str]) -> None:
        ran.append(([node.__name__ for node in nodes], args))

    monkeypatch.setattr("aionode.runner.run", run)

    status = main(
        ["run", "cli_run_nodes:Talker", "cli_run_nodes:Listener", "--ros-args", "-p", "a:=1"]
    )

    assert status == 0
    assert ran == [(["Talker", "Listener"], ["--ros-args", "-p", "a:=1"])]


RUNS_ITSELF = (
    SOURCE
    + """
import asyncio
import sys

class Brief(Node):
    def __init__(self):
        super().__init__("brief")
        print("made with", sys.argv[1:])

    async def run(self):
        async with self:
            pass

{}
"""
)


@pytest.mark.parametrize("last_line", ["aionode.run(Brief)", "asyncio.run(Brief().run())"])
@pytest.mark.parametrize("name", ["", ":Brief"])
def test_a_file_that_runs_its_nodes_itself_runs_once(
    last_line: str, name: str, program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A beginner's file has no guard: importing it runs it."""
    program.with_name("cli_run_itself.py").write_text(
        "import aionode\n" + RUNS_ITSELF.format(last_line)
    )
    sys.modules.pop("cli_run_itself", None)

    status = main(["run", f"cli_run_itself.py{name}", "--ros-args", "-p", "a:=1"])

    assert status == 0
    assert capsys.readouterr().out == "made with ['--ros-args', '-p', 'a:=1']\n"


def test_a_file_that_runs_its_nodes_itself_is_refused_beside_others(
    program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Otherwise the others would silently have waited for its end."""
    file = program.with_name("cli_run_itself.py")
    file.write_text("import aionode\n" + RUNS_ITSELF.format("aionode.run(Brief)"))
    sys.modules.pop("cli_run_itself", None)

    assert main(["run", "cli_run_itself.py", "cli_run_nodes.py:Talker"]) == 1

    assert 'let it run them only `if __name__ == "__main__":`' in capsys.readouterr().err


def test_an_option_before_the_arguments_is_an_error(
    program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Otherwise it would be taken for the name of a module."""
    status = main(["run", "cli_run_nodes:Talker", "-p", "a:=1"])

    assert status == 2
    assert "No such option '-p': arguments of nodes follow --ros-args." in capsys.readouterr().err


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A workspace, which is the current folder, with a package of rclpy and of aionode."""
    package = tmp_path / "src" / "my_robot"
    (package / "my_robot").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_robot</name></package>")
    (package / "setup.cfg").write_text(
        "[options.entry_points]\nconsole_scripts =\n  mover = my_robot.mover:main\n"
    )
    (package / "my_robot" / "__init__.py").write_text("")
    (package / "my_robot" / "mover.py").write_text("import rclpy\n\n\ndef main(): ...\n")
    (package / "my_robot" / "cli_run_nodes_of_package.py").write_text(SOURCE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.path", list(sys.path))
    return tmp_path


def test_a_package_and_its_executable_are_a_program(workspace: Path) -> None:
    """As with `ros2 run`, but without a build; the rest are its own arguments."""
    command = Programs(None).command(["my_robot", "mover", "-x", "--ros-args"])

    package = workspace / "src" / "my_robot"
    assert command is not None
    assert command[1:] == [
        *("-m", "aionode.rclpy", "--workspace", str(package.parent)),
        *("--path", str(package), "-m", "my_robot.mover:main", "-x", "--ros-args"),
    ]


@pytest.mark.parametrize(
    ("args", "module"),
    [
        (["my_robot", "mover", "-x"], "aionode.rclpy"),
        (["src/my_robot/my_robot/mover.py", "-x"], "aionode.rclpy"),
        (["demo_nodes_py", "talker", "-x"], "aionode.programs"),
    ],
)
@pytest.mark.usefixtures("workspace")
def test_a_program_in_python_is_a_module_with_arguments(args: list[str], module: str) -> None:
    """It is executed at once, in the process of the command."""
    found = module_of(args)

    assert found is not None
    assert (found[0], found[-1]) == (module, "-x")


@pytest.mark.parametrize(
    "args",
    [
        [],
        ["--help"],
        ["--rclpy", "src/my_robot/my_robot/mover.py"],
        ["my_robot.mover:main"],
        ["my_robot", "movre"],
        ["my_robto", "mover"],
        ["src/my_robot/my_robot/cli_run_nodes_of_package.py"],
        ["missing.py"],
    ],
)
@pytest.mark.usefixtures("workspace")
def test_what_is_no_program_in_python_is_left_to_the_command_line(args: list[str]) -> None:
    """It parses options, and it reports errors."""
    assert module_of(args) is None


@pytest.mark.parametrize("place", [".", "src", "src/my_robot", "src/my_robot/my_robot"])
def test_a_function_of_a_program_of_rclpy_runs_as_one(
    place: str, workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wherever the user is in the workspace, rather than as a function that creates a node."""
    monkeypatch.chdir(workspace / place)

    command = Programs(None).command(["my_robot.mover:main", "fast"])

    package = str(workspace / "src" / "my_robot")
    assert command is not None
    assert command[3:] == ["--path", package, "-m", "my_robot.mover:main", "fast"]


def test_classes_of_nodes_are_found_in_packages(workspace: Path) -> None:
    """A package whose nodes have moved to aionode starts as before."""
    specs = ["my_robot.cli_run_nodes_of_package:Talker"]

    assert Programs(None).command(specs) is None
    folders = Programs(None).module_folders(specs)
    assert folders == [str(workspace / "src" / "my_robot")]


@pytest.mark.parametrize(
    ("args", "error", "says"),
    [
        (["my_robto", "mover"], PackageNotFoundError, "did you mean my_robot?"),
        (
            ["teleop_twist_keybord", "x"],
            PackageNotFoundError,
            "did you mean teleop_twist_keyboard?",
        ),
        (["my_robot", "movre"], ExecutableNotFoundError, "did you mean mover?"),
        (["my_robot"], CommandError, "give an executable of this package: mover"),
        (["my_robot", "-x"], CommandError, "give an executable of this package: mover"),
    ],
)
@pytest.mark.usefixtures("workspace")
def test_an_executable_that_is_missing_is_named(
    args: list[str], error: type[Exception], says: str
) -> None:
    """With a similar name."""
    with pytest.raises(error) as caught:
        Programs(None).command(args)

    assert says in str(caught.value)


@pytest.mark.parametrize(
    "line",
    [
        "import rosbag2_py",
        "from tf2_ros import Buffer",
        "__import__('importlib').import_module('rclpy')",
    ],
)
def test_a_program_that_needs_ros_is_told_by_which_option_it_runs(
    line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In one line, if its text does not show that it is a program of rclpy."""
    program = tmp_path / "needs_ros.py"
    program.write_text(line)

    with without_ros():
        assert main(["run", str(program)]) == 1

    (text,) = capsys.readouterr().err.splitlines()
    assert text.endswith(f"`aionode run --rclpy {program}`")
