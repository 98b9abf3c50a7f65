"""Tests with an installed ROS 2: whether they can run, and their processes."""

from __future__ import annotations

import functools
import importlib.metadata
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import PathFinder

__all__ = ["gids_of_a_client", "ros_domain", "ros_missing", "ros_peer"]


@functools.cache
def ros_missing(*packages: str) -> str:
    """Return why tests with an installed ROS 2 cannot run here; empty if they can.

    Args:
        packages: The required ROS 2 packages that have no wheels.
    """
    for package in ("rclpy", "std_msgs", "test_msgs"):
        if PathFinder.find_spec(package) is None:
            return (
                f"{package} is not installed: pip install 'aionode[ros]' (Linux x86-64), or source "
                "a ROS 2; see CONTRIBUTING.md"
            )
    for package in packages:
        if PathFinder.find_spec(package) is None:
            return f"{package} is not installed: it has no wheel; source a ROS 2 that has it"
    return ""


def gids_of_a_client() -> int:
    """Return how many gids one client of the installed ROS has in service events.

    In Jazzy, Fast DDS tells the client one and the server another: ros2/rmw, issue 357.
    """
    try:
        return 2 if importlib.metadata.version("rclpy") < "9" else 1
    except importlib.metadata.PackageNotFoundError:
        return 1


def ros_domain(offset: int = 0) -> int:
    """Return a domain for this process alone, below 102, as higher ones have ephemeral ports."""
    return 1 + (os.getpid() + offset) % 100


@contextmanager
def ros_peer(domain_id: int, program: str = "ros_peer") -> Iterator[subprocess.Popen[str]]:
    """Run a program of `tests.support` in a domain; it prints ``ready``, and ends with stdin."""
    environ = {
        **os.environ,
        "ROS_DOMAIN_ID": str(domain_id),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }
    command = [sys.executable, "-W", "ignore", "-m", f"tests.support.{program}"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environ, stdin=pipe, stdout=pipe, text=True) as peer:
        try:
            if peer.stdout is None or peer.stdout.readline() != "ready\n":
                raise RuntimeError("the peer has not started; its output is above")
            yield peer
        finally:
            if peer.stdin is not None:
                peer.stdin.close()
            try:
                peer.wait(5)
            except subprocess.TimeoutExpired:
                peer.kill()
