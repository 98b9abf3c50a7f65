"""A real ROS 2 on rmw_zenoh beside the tests: its router, one node of it, and its command line.

`make live` runs these tests; without a sourced ROS 2 that has rmw_zenoh_cpp they are skipped.
AIONODE_LIVE_PYTHON and AIONODE_LIVE_ROS2 name other commands for its Python and its command line.
"""

from __future__ import annotations

import os
import secrets
import shlex
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

PEER = Path(__file__).with_name("ros_peer.py")
ROUTER_PORT = 7447
WAIT_S = 30.0

Run = Callable[..., str]


def find_ros() -> tuple[list[str], list[str], str]:
    """Return the commands of ROS 2's Python and command line, and why they cannot be used."""
    python = shlex.split(os.environ.get("AIONODE_LIVE_PYTHON", "python3"))
    ros2 = shlex.split(os.environ.get("AIONODE_LIVE_ROS2", "ros2"))
    if "AIONODE_LIVE_PYTHON" in os.environ:
        return python, ros2, ""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    if not any(prefixes) or shutil.which(ros2[0]) is None:
        return python, ros2, "no ROS 2 is sourced: source /opt/ros/<distribution>/setup.bash"
    if not any(Path(prefix, "share", "rmw_zenoh_cpp").is_dir() for prefix in prefixes):
        return python, ros2, "no rmw_zenoh_cpp: apt install ros-$ROS_DISTRO-rmw-zenoh-cpp"
    return python, ros2, ""


PYTHON, ROS2, MISSING = find_ros()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Skip these tests without a ROS 2 that they can use."""
    for item in items:
        if MISSING and item.nodeid.startswith("tests/live/"):
            item.add_marker(pytest.mark.skip(reason=MISSING))


@pytest.fixture(scope="session")
def environment() -> dict[str, str]:
    """The environment of all processes: a domain of its own, and Zenoh as the middleware."""
    return {
        **os.environ,
        "ROS_DOMAIN_ID": str(1 + secrets.randbelow(99)),
        "RMW_IMPLEMENTATION": "rmw_zenoh_cpp",
        "PYTHONUNBUFFERED": "1",
        "RUST_LOG": "error",  # Zenoh writes its warnings to the standard output
    }


@pytest.fixture(scope="session", autouse=True)
def _joined(environment: dict[str, str]) -> Iterator[None]:
    """Let the nodes of the tests join the same domain, at the default ports."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", environment["ROS_DOMAIN_ID"])
        for name in ("AIONODE_MEETING_PORTS", "AIONODE_ROUTER_PORT"):
            patch.delenv(name, raising=False)
            environment.pop(name, None)
        yield


@contextmanager
def running(command: list[str], environment: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    """Start a program, and end it with Ctrl-C."""
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process
            process.send_signal(signal.SIGINT)
            process.wait(WAIT_S)
        finally:
            process.kill()


@pytest.fixture(scope="session")
def router(environment: dict[str, str]) -> Iterator[None]:
    """The router of this machine; ROS 2's own is started if there is none."""
    with socket.socket() as probe:
        if probe.connect_ex(("127.0.0.1", ROUTER_PORT)) == 0:
            yield
            return
    with running([*ROS2, "run", "rmw_zenoh_cpp", "rmw_zenohd"], environment) as process:
        assert process.stdout is not None
        assert any(line.startswith("Started Zenoh router") for line in process.stdout)
        yield


@pytest.fixture(scope="session")
def peer(environment: dict[str, str], router: None) -> Iterator[subprocess.Popen[str]]:
    """The node of ROS 2 that all tests share."""
    with running([*PYTHON, str(PEER)], environment) as process:
        assert process.stdout is not None
        assert "running\n" in process.stdout
        yield process


@pytest.fixture(scope="session")
def ros2(environment: dict[str, str]) -> Run:
    """Run a command of ros2's, and return what it prints."""
    return runner(ROS2, environment)


@pytest.fixture(scope="session")
def aionode(environment: dict[str, str]) -> Run:
    """Run a command of aionode's, and return what it prints."""
    own = {name: value for name, value in environment.items() if name != "PYTHONPATH"}
    root = str(Path(__file__).parents[2])
    return runner([sys.executable, "-m", "aionode"], own | {"PYTHONPATH": root})


def runner(command: list[str], environment: dict[str, str]) -> Run:
    """Return a function that runs a command with further arguments."""

    def run(*arguments: str) -> str:
        return subprocess.run(
            [*command, *arguments],
            env=environment,
            capture_output=True,
            text=True,
            timeout=WAIT_S,
            check=False,
        ).stdout

    return run
