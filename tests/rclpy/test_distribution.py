"""The distribution aionode-rclpy, which puts the names of ROS's packages on the path."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from aionode.interfaces import shipped_packages
from aionode.rclpy._finder import ALIASES, rclpy_of_ros

ROOT = Path(__file__).parents[2]
DISTRIBUTION = ROOT / "packages" / "aionode-rclpy"

PROGRAM = """\
import std_msgs
from std_msgs.msg import String
from geometry_msgs.msg._twist import Twist
import rclpy.{module}
import rosidl_runtime_py

import aionode.rclpy
assert rclpy is aionode.rclpy
assert type(Twist().linear).__module__ == "geometry_msgs.msg._vector3"
print(rosidl_runtime_py.message_to_yaml(String(data="hi")), end="")
"""


def test_it_has_every_package_that_aionode_supplies() -> None:
    """A package without a line here could be imported only after another one."""
    packages = {path.name for path in (DISTRIBUTION / "src").iterdir()}

    assert packages == shipped_packages() | set(ALIASES)


def test_its_packages_do_one_thing() -> None:
    """Everything else is in aionode, so that both need no release at the same time."""
    sources = {path.read_text() for path in (DISTRIBUTION / "src").glob("*/__init__.py")}
    codes = {"\n".join(map(ast.unparse, ast.parse(source).body[1:])) for source in sources}

    assert codes == {"from aionode.rclpy._finder import provide\nprovide(__name__)"}


@pytest.mark.timeout(180)
@pytest.mark.skipif(find_spec("hatchling") is None, reason="hatchling, which builds it, is missing")
def test_a_program_runs_with_its_wheel(tmp_path: Path) -> None:
    """By ``python program.py``, with nothing but the wheel on the path."""
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=DISTRIBUTION, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("aionode_rclpy-*.whl")
    program = tmp_path / "program.py"
    program.write_text(PROGRAM.format(module="_program"))

    done = subprocess.run(
        [sys.executable, str(program)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join((str(wheel), str(ROOT)))},
    )

    assert (done.stdout, done.stderr) == ("data: hi\n", "")


def test_it_is_not_taken_for_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    """`install` says which rclpy is used only where there are two."""
    monkeypatch.syspath_prepend(DISTRIBUTION / "src")

    assert rclpy_of_ros() is None
