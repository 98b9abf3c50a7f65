"""Clients of rosbridge as their users install them: `make rosbridge-clients` fetches and runs them.

Without AIONODE_ROSLIB (the file ``RosLib.js`` of npm's roslib) and AIONODE_ROSLIBPY (a Python that
has roslibpy) the tests are skipped.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

HERE = Path(__file__).parent


@pytest.fixture
def port() -> Iterator[str]:
    """Yield the port of a robot's gateway, in a process of its own."""
    command = [sys.executable, str(HERE / "robot.py"), "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as robot:
        assert robot.stdout is not None
        yield robot.stdout.readline().strip()
        robot.terminate()


def given(variable: str) -> str:
    """Return what an environment variable names, or skip the test."""
    path = os.environ.get(variable)
    if not path:
        pytest.skip(f"{variable} is not set: make rosbridge-clients")
    return path


@pytest.fixture
def roslib() -> str:
    """Return the file of npm's roslib."""
    return given("AIONODE_ROSLIB")


@pytest.fixture
def roslibpy() -> str:
    """Return a Python that has roslibpy."""
    return given("AIONODE_ROSLIBPY")


def test_roslib_of_npm(roslib: str, port: str) -> None:
    """Pages use this library."""
    subprocess.run(["node", HERE / "roslib_checks.mjs", port, roslib], check=True, timeout=50)


def test_roslibpy(roslibpy: str, port: str) -> None:
    """Python programs without ROS use this library."""
    subprocess.run([roslibpy, HERE / "roslibpy_checks.py", port], check=True, timeout=50)
