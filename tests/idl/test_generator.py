"""Writing interfaces as Python modules."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import aionode.interfaces
from aionode.errors import IdlError
from aionode.idl import definition_text, generate, load_interfaces
from aionode.interfaces import get_interface, interface_names, shipped_packages
from aionode.message import constants, fields
from tests.support.without_ros import without_ros

ROOT = Path(aionode.interfaces.__file__).parents[2]
NEWER = {"rosbag2_interfaces"}
"""Packages of the folder beside the repository that aionode has with what Lyrical adds."""

SOURCE = ROOT.parent / "shared" / "interfaces"
"""The definitions that the shipped interfaces are generated from, not in the repository."""

OUTCOMES = "".join(
    f"uint8 TRANSITION_ON_{move}_{outcome}={first + number}\n"
    for first, move in zip(
        range(10, 70, 10),
        ("CONFIGURE", "CLEANUP", "ACTIVATE", "DEACTIVATE", "SHUTDOWN", "ERROR"),
        strict=True,
    )
    for number, outcome in enumerate(("SUCCESS", "FAILURE", "ERROR"))
)
LEVELS = "".join(
    f"uint8 LOG_LEVEL_{name}={10 * number}\n"
    for number, name in enumerate(("UNKNOWN", "DEBUG", "INFO", "WARN", "ERROR", "FATAL"))
)
LATER_CONSTANTS = {
    "lifecycle_msgs/msg/Transition.msg": ("uint8 TRANSITION_CALLBACK_SUCCESS", OUTCOMES),
    "rcl_interfaces/msg/LoggerLevel.msg": ("string name", LEVELS),
}
"""Constants of Jazzy and later that those definitions lack, and the line that they stand before."""

ODD = """\
# What is odd: "quotes" and \\ and \"\"\".
int32 BYTE=1
string ARRAY="it's"
byte byte
string str
bool bool
float64[] sequence
string<=3[2] annotated
float64 nothing nan
uint8[<=9] a_name_so_long_that_the_line_has_to_be_broken [10, 20, 30, 40, 50, 60, 70, 80, 90]
other_msgs/Point[] points_of_another_package
Point own_point
std_msgs/Header header
string[] list
"""


@pytest.fixture
def packages(tmp_path: Path) -> Path:
    """Definitions whose names clash with what generated modules import."""
    for name, text in {
        "odd_msgs/msg/Odd.msg": ODD,
        "odd_msgs/msg/Point.msg": "int8 x\n",
        "odd_msgs/msg/Message.msg": "",
        "odd_msgs/srv/Ask.srv": "# Ask.\nOdd odd\n---\n# The answer.\nbool ok\n",
        "odd_msgs/action/Go.action": "---\nMessage m\n---\n",
        "other_msgs/msg/Point.msg": "float32 x\n",
    }.items():
        file = tmp_path / "definitions" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    return tmp_path / "definitions"


@pytest.fixture
def out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder that Python imports from."""
    folder = tmp_path / "out"
    folder.mkdir()
    monkeypatch.syspath_prepend(str(folder))
    before = set(sys.modules)
    with without_ros():  # in whose processes a package has rosidl's classes
        yield folder
    for name in set(sys.modules) - before:
        if name.startswith(("odd_msgs", "other_msgs", "mine")):
            del sys.modules[name]


def test_generated_modules_define_the_same_types(packages: Path, out: Path) -> None:
    """Whatever their fields are called."""
    generate(packages, out)
    loaded = load_interfaces(packages, reuse=False)
    module = importlib.import_module("odd_msgs.msg")
    service = importlib.import_module("odd_msgs.srv")

    odd = loaded.odd_msgs.msg.Odd
    assert definition_text(module.Odd) == definition_text(odd)
    assert [(f.name, str(f.type)) for f in fields(module.Odd)] == [
        (f.name, str(f.type)) for f in fields(odd)
    ]
    assert constants(module.Odd) == constants(odd)
    assert module.Odd.__doc__ == 'What is odd: "quotes" and \\ and """.'
    assert service.Ask.__doc__ == "Ask."
    assert service.Ask.Response.__doc__ == "The answer."
    assert type(module.Odd().own_point) is module.Point
    assert service.Ask.Request().odd == module.Odd() or True  # NaN is not equal to itself
    assert importlib.import_module("odd_msgs.action").Go.Result().m == module.Message()


def test_modules_in_a_package_import_each_other_from_there(packages: Path, out: Path) -> None:
    """Generated code may live inside of a robot's own package."""
    (out / "mine").mkdir()
    (out / "mine" / "__init__.py").touch()
    generate(packages, out / "mine")

    odd = importlib.import_module("mine.odd_msgs.msg").Odd
    assert fields(odd)[7].type.nested is importlib.import_module("mine.other_msgs.msg").Point


@pytest.mark.checks
def test_generated_modules_pass_the_tools(
    packages: Path, out: Path, pytestconfig: pytest.Config
) -> None:
    """Formatted as ruff leaves it, and accepted by mypy --strict."""
    generate(packages, out)
    config = ("--config", str(ROOT / "pyproject.toml"))
    run = [sys.executable, "-m"]

    for command in (
        [*run, "ruff", "format", "--check", *config, str(out / "other_msgs")],
        [*run, "ruff", "check", *config, "--select", "F,I,UP,RUF022", str(out)],
        [
            *run,
            "mypy",
            "--strict",
            "--config-file",
            "",
            "--cache-dir",
            str(pytestconfig.cache.mkdir("mypy")),
            str(out / "odd_msgs"),
            str(out / "other_msgs"),
        ],
    ):
        done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=out)
        assert done.returncode == 0, done.stdout + done.stderr


def test_docstrings_are_kept_when_the_definition_has_no_comment(packages: Path, out: Path) -> None:
    """They are edited where they are read."""
    generate(packages, out)
    file = out / "other_msgs" / "msg.py"
    file.write_text(file.read_text().replace('"""Point."""', '"""A place, in m."""'))

    generate(packages, out)

    assert '"""A place, in m."""' in file.read_text()


def test_the_files_written_are_returned(packages: Path, out: Path) -> None:
    """For the command line to print."""
    written = {str(file.relative_to(out)) for file in generate(packages, out)}

    assert {"odd_msgs/__init__.py", "odd_msgs/msg.py", "odd_msgs/srv.py"} <= written
    assert all((out / name).is_file() for name in written)


def test_nothing_is_written_if_a_definition_is_wrong(packages: Path, out: Path) -> None:
    """A half-written package would only be noticed later, by another user."""
    (packages / "other_msgs" / "msg" / "Bad.msg").write_text("nope x")

    with pytest.raises(IdlError):
        generate(packages, out)
    assert list(out.iterdir()) == []


@pytest.mark.slow
@pytest.mark.skipif(not SOURCE.is_dir(), reason="ROS 2's definitions are not beside the repository")
def test_the_shipped_modules_are_what_the_generator_writes(tmp_path: Path) -> None:
    """They are not edited by hand, except for docstrings."""
    copy = tmp_path / "aionode" / "interfaces"
    shipped = ROOT / "aionode" / "interfaces"
    shutil.copytree(shipped, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "aionode" / "__init__.py").touch()

    definitions = tmp_path / "definitions"
    packages = shipped_packages()
    beside = {name for name in packages - NEWER if (SOURCE / name).is_dir()}  # the folder has more
    for package in beside:
        shutil.copytree(SOURCE / package, definitions / package, copy_function=shutil.copyfile)
    for name, (before, constants_) in LATER_CONSTANTS.items():
        file = definitions / name
        file.write_text(file.read_text().replace(before, constants_ + before, 1))

    own = tmp_path / "own"
    others = packages - beside
    for name in [name for package in others for name in interface_names(package)]:
        file = own.joinpath(*name.split("/")).with_suffix(f".{name.split('/')[1]}")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(definition_text(get_interface(name)))

    written = generate(definitions, copy)
    for package in others:
        written += generate(own / package, copy)

    assert {file.parent.name for file in written} == packages
    for file in written:
        assert file.read_text() == (shipped / file.relative_to(copy)).read_text(), file
