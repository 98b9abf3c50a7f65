"""Interfaces of a sourced ROS 2: what is not shipped, and what differs there."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from aionode.engine.wire.typehash import type_hash
from aionode.errors import InterfaceNotFoundError
from aionode.idl import _installed as installed
from aionode.idl._distribution_differences import differences
from aionode.interfaces import get_interface
from aionode.interfaces.sensor_msgs import msg as sensor_msgs
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import fields

HUMBLE_RANGE = differences("humble")["sensor_msgs/msg/Range"]


@pytest.fixture
def share(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The share folder of an installed ROS 2 that is sourced, after one that is empty."""
    path = os.pathsep.join([str(tmp_path / "overlay"), "", str(tmp_path / "ros")])
    monkeypatch.setenv("AMENT_PREFIX_PATH", path)
    before = set(sys.modules)
    yield tmp_path / "ros" / "share"
    for name in set(sys.modules) - before:
        if name.startswith("aionode.interfaces.installed_"):
            del sys.modules[name]


def write(share: Path, typename: str, text: str) -> None:
    """Write a definition where a ROS 2 installs it."""
    package, kind, name = typename.split("/")
    file = share / package / kind / f"{name}.{kind}"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


def get_range(found: dict[str, Any]) -> Any:
    """Return the class of a range."""
    return found["Range"]


def test_a_package_that_is_not_shipped_is_imported(share: Path) -> None:
    """With types of its own, of shipped packages, and of other installed ones."""
    write(share, "installed_a/msg/Point", "float64 x  # m\nstd_msgs/Header header\n")
    write(share, "installed_a/srv/Locate", "installed_b/Name name\n---\nPoint point\n")
    write(share, "installed_b/msg/Name", "string text\n")

    module = importlib.import_module("aionode.interfaces.installed_a.srv")

    point = get_interface("installed_a/msg/Point")
    assert module.Locate.Response().point == point()
    assert module.Locate.Request().name == get_interface("installed_b/msg/Name")()
    assert point().header == Header()
    assert module.__all__ == ["Locate"]


def test_a_shipped_type_that_is_defined_differently_is_replaced(share: Path) -> None:
    """The nodes of that system announce the hash of their own definition."""
    write(share, "sensor_msgs/msg/Range", HUMBLE_RANGE)
    write(share, "sensor_msgs/msg/Imu", "")  # an empty definition is one, too
    write(share, "sensor_msgs/msg/TimeReference", "string source\n")

    found = installed.replaced_types("sensor_msgs", "msg", vars(sensor_msgs))

    assert list(found) == ["Imu", "Range", "TimeReference"]
    assert [field.name for field in fields(get_range(found))][-1] == "range"
    assert type_hash(get_range(found)) != type_hash(sensor_msgs.Range)


def test_a_shipped_type_with_the_same_definition_stays(share: Path) -> None:
    """With its docstrings, and for programs that have imported it already."""
    write(
        share,
        "sensor_msgs/msg/FluidPressure",
        "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n",
    )

    assert installed.replaced_types("sensor_msgs", "msg", vars(sensor_msgs)) == {}


def test_a_broken_definition_is_left_out_with_a_warning(share: Path) -> None:
    """It must not keep a program from the rest of its package."""
    write(share, "installed_c/msg/Broken", "no_such_type x\n")
    write(share, "installed_c/msg/Fine", "bool fine\n")

    with pytest.warns(RuntimeWarning, match=r"installed_c/msg/Broken .* is left out: .*Broken.msg"):
        module = importlib.import_module("aionode.interfaces.installed_c.msg")

    assert module.__all__ == ["Fine"]


def test_a_package_that_is_not_installed_is_not_found(share: Path) -> None:
    """As without a ROS 2."""
    share.mkdir(parents=True)

    with pytest.raises(ModuleNotFoundError, match="installed_d"):
        importlib.import_module("aionode.interfaces.installed_d.msg")
    with pytest.raises(InterfaceNotFoundError, match="installed_d/msg/Name"):
        get_interface("installed_d/msg/Name")


PROGRAM = """
import sys, aionode
from aionode import Node
Node("robot")
opened = []
sys.addaudithook(lambda event, args: opened.append(str(args[0])) if event == "open" else None)
Node("another")
assert not [name for name in opened if name.endswith((".msg", ".srv"))]
from aionode.interfaces.sensor_msgs.msg import Range
print(*Range.__struct_fields__)
"""


@pytest.mark.processes
@pytest.mark.parametrize(
    ("variable", "last"),
    [("ROS_DISTRO", "range"), ("AMENT_PREFIX_PATH", "volume"), ("", "variance")],
)
def test_a_program_imports_what_its_ros_defines(tmp_path: Path, variable: str, last: str) -> None:
    """Under the name under which it would import the shipped type; a node alone reads nothing."""
    write(tmp_path / "share", "sensor_msgs/msg/Range", "float32 range\nfloat32 volume\n")
    value = {"ROS_DISTRO": "humble", "AMENT_PREFIX_PATH": str(tmp_path)}.get(variable, "")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        env={**os.environ, variable or "UNUSED": value},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )

    assert done.stdout.split()[-1:] == [last], done.stderr
