"""Clients of the gateway as installed by users: `make rosbridge-clients` downloads them.

Without AIONODE_ROSLIB (the file ``RosLib.js`` of npm's roslib), AIONODE_ROSLIBPY (a Python that has
roslibpy and ros-mcp) and AIONODE_FOXGLOVE (a ``node_modules`` with @foxglove/ws-protocol and ws)
the tests are skipped.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.support.chromium import CHROMIUM, chromium
from tests.support.web_server import web_server

HERE = Path(__file__).parent


@contextmanager
def robot_process(*origins: str) -> Iterator[str]:
    """Yield the port of a robot's gateway, in a process of its own."""
    command = [sys.executable, str(HERE / "robot.py"), "0", *origins]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as robot:
        assert robot.stdout is not None
        try:
            yield robot.stdout.readline().strip()
        finally:
            robot.terminate()


@pytest.fixture
def port() -> Iterator[str]:
    """Yield the port of a robot's gateway."""
    with robot_process() as port:
        yield port


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
    """Programs of Node use this library."""
    subprocess.run(["node", HERE / "roslib_node.mjs", port, roslib], check=True, timeout=50)


@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
async def test_roslib_of_npm_in_a_browser(roslib: str) -> None:
    """Pages use this library: here a page of another origin, which the policy lists."""
    modules = next(each for each in Path(roslib).parents if each.name == "node_modules")
    files = {
        "/page": HERE / "roslib_page.html",
        "/roslib_checks.mjs": HERE / "roslib_checks.mjs",
        "/node_modules/": modules,
    }
    async with web_server(files) as web, chromium() as browser:
        with robot_process(f"http://localhost:{web}") as port:
            page = await browser.open(f"http://localhost:{web}/page?port={port}")
            failed = await page.until("window.failed", patience_sec=50)

    assert failed == {}, "\n".join(failed.values())


def test_roslibpy(roslibpy: str, port: str) -> None:
    """Python programs without ROS use this library."""
    subprocess.run([roslibpy, HERE / "roslibpy_checks.py", port], check=True, timeout=50)


@pytest.mark.timeout(180)
def test_ros_mcp(roslibpy: str, port: str) -> None:
    """Agents use this server of tools."""
    subprocess.run([roslibpy, HERE / "ros_mcp_checks.py", port], check=True, timeout=170)


@pytest.mark.processes
@pytest.mark.parametrize(
    "subprotocol",
    [pytest.param("foxglove.websocket.v1", marks=pytest.mark.slow), "foxglove.sdk.v1"],
)
def test_ws_protocol_of_npm(port: str, subprotocol: str) -> None:
    """Foxglove, Lichtblick and programs of Node use this library."""
    modules = given("AIONODE_FOXGLOVE")
    program = HERE / "foxglove_checks.mjs"
    subprocess.run(["node", program, port, modules, subprotocol], check=True, timeout=50)
