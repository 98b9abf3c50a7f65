"""A package written by `aionode new` runs, and passes its test, unchanged."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from aionode.cli import main
from tests.support.peers import isolated_environment

AIONODE = [sys.executable, "-m", "aionode"]


@pytest.fixture(params=[[], ["--ros"]], ids=["native", "ros"])
def package(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Path:
    """The folder of a new package, in either layout."""
    monkeypatch.chdir(tmp_path)
    assert main(["new", "my_robot", *request.param]) == 0
    return tmp_path / "my_robot"


@pytest.mark.slow
@pytest.mark.processes
def test_a_new_package_passes_its_test(package: Path) -> None:
    """Its message is found without a build, and its node runs on a recording."""
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "src/my_robot"],
        cwd=package,
        env={**os.environ, "PYTEST_ADDOPTS": ""},  # those of this run of tests
        capture_output=True,
        text=True,
        check=False,
    )

    assert "1 passed" in done.stdout, done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.processes
def test_a_new_package_is_launched(package: Path) -> None:
    """With its parameters, and until Ctrl-C."""
    with subprocess.Popen(
        [*AIONODE, "launch", "src/my_robot/launch/robot.launch.py"],
        cwd=package,
        env=isolated_environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as launched:
        assert launched.stdout is not None
        lines = []
        for line in launched.stdout:
            lines.append(line)
            if "counts words of 2 letters or more" in line:
                launched.send_signal(signal.SIGINT)
                break
        lines += launched.stdout

    assert "Traceback" not in "".join(lines)
    assert "shutdown" in "".join(lines)


def test_a_package_of_ros_has_what_colcon_reads(package: Path) -> None:
    """A setup.py with a marker for ament's index, and messages built by CMake only if requested."""
    source = package / "src"
    files = {str(path.relative_to(source)) for path in source.rglob("*")}
    of_ros = {
        "my_robot/setup.py",
        "my_robot/resource/my_robot",
        "my_robot_interfaces/CMakeLists.txt",
    }

    assert files & of_ros == (set() if "my_robot/pyproject.toml" in files else of_ros)
    assert "NAME" not in "".join(path.read_text() for path in package.rglob("*") if path.is_file())


@pytest.mark.parametrize(
    ("name", "problem"),
    [("my-robot", "is not a valid package name; use lower-case"), ("there", "already exists")],
)
def test_a_name_that_does_not_fit_writes_nothing(
    name: str,
    problem: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Existing files are never overwritten."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there").mkdir()

    assert main(["new", name]) != 0

    assert problem in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["there"]
    assert list((tmp_path / "there").iterdir()) == []
