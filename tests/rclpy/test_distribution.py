"""The distribution aionode-rclpy, which puts the names of ROS's packages on the path."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from aionode.interfaces import shipped_packages
from aionode.rclpy._finder import FOLDER, SUPPLIED, rclpy_of_ros

ROOT = Path(__file__).parents[2]
DISTRIBUTION = ROOT / "packages" / "aionode-rclpy"

pytestmark = pytest.mark.skipif(
    find_spec("hatchling") is None, reason="hatchling, which builds it, is missing"
)

PROGRAM = """\
import rclpy.node
import std_msgs
from std_msgs.msg import String
from geometry_msgs.msg._twist import Twist
import rosidl_runtime_py

assert ".whl" in rclpy.__file__
assert type(Twist().linear).__module__ == "geometry_msgs.msg._vector3"
print(rosidl_runtime_py.message_to_yaml(String(data="hi")), end="")

import sys
import aionode.rclpy
aionode.rclpy.install()
import rclpy.executors, tf2_ros.buffer
for name in ("rclpy.node", "rclpy.executors", "tf2_ros.buffer"):
    assert [each for each in sys.modules if each.endswith(name)] == [name], name
"""


def built(target: str, source: Path, folder: Path) -> Path:
    """Return the wheel or sdist that is built of a source."""
    build = [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", str(folder)]
    subprocess.run(build, cwd=source, check=True, capture_output=True)
    (file,) = folder.iterdir()
    return file


def files_in(wheel: Path) -> set[str]:
    """Return the names of the files in Python."""
    with zipfile.ZipFile(wheel) as archive:
        return {name for name in archive.namelist() if name.endswith(".py")}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built in the repository."""
    return built("wheel", DISTRIBUTION, tmp_path_factory.mktemp("wheel"))


def test_it_has_every_package_that_aionode_supplies(wheel: Path) -> None:
    """A package that it lacks could only be imported after another one."""
    packages = {name.partition("/")[0] for name in files_in(wheel)}

    assert packages == shipped_packages() | SUPPLIED


def test_its_message_packages_do_one_thing() -> None:
    """Their contents are in aionode, so that both need no release at the same time."""
    sources = {path.read_text() for path in (DISTRIBUTION / "src").glob("*/__init__.py")}
    codes = {"\n".join(map(ast.unparse, ast.parse(source).body[1:])) for source in sources}

    assert codes == {"from aionode.rclpy._finder import provide\nprovide(__name__)"}


@pytest.mark.slow
@pytest.mark.timeout(180)
def test_a_wheel_of_its_sdist_has_the_same_files(wheel: Path, tmp_path: Path) -> None:
    """The sdist is built elsewhere, without aionode's repository beside it."""
    (tmp_path / "built").mkdir()
    sdist = built("sdist", DISTRIBUTION, tmp_path / "built")
    shutil.unpack_archive(sdist, tmp_path / "source", filter="data")
    (source,) = (tmp_path / "source").iterdir()
    (tmp_path / "again").mkdir()

    assert files_in(built("wheel", source, tmp_path / "again")) == files_in(wheel)


@pytest.mark.slow
def test_a_program_runs_with_its_wheel(wheel: Path, tmp_path: Path) -> None:
    """By ``python program.py``; with `install` as well, each module still exists once."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)

    done = subprocess.run(
        [sys.executable, str(program)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": os.pathsep.join((str(wheel), str(ROOT)))},
    )

    assert (done.stdout, done.stderr) == ("data: hi\n", "")


def test_it_is_not_taken_for_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    """`install` only says which rclpy is used if there are two."""
    monkeypatch.syspath_prepend(FOLDER)

    assert rclpy_of_ros() is None
