"""The functions of `ros2 run`."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from ros2pkg.api import PackageNotFound, get_executable_paths

__all__ = [
    "ExecutableNameCompleter",
    "MultipleExecutables",
    "get_executable_path",
    "run_executable",
]

ROS2RUN_MSG_PREFIX = "[ros2run]:"


class MultipleExecutables(Exception):  # noqa: N818  # ROS's name
    """A package has several executables with the same name."""

    def __init__(self, paths: Iterable[str]) -> None:
        super().__init__(*paths)
        self.paths = paths


def get_executable_path(*, package_name: str, executable_name: str) -> str | None:
    """Return the file of an executable of a package; None if there is none with this name.

    Raises:
        PackageNotFound: There is no such package.
        MultipleExecutables: It has several.
    """
    found = [
        path
        for path in get_executable_paths(package_name=package_name)
        if Path(path).name == executable_name
    ]
    if len(found) > 1:
        raise MultipleExecutables(found)
    return found[0] if found else None


def run_executable(*, path: str, argv: list[str], prefix: list[str] | None = None) -> int:
    """Run a program until it ends, even after Ctrl-C, and return its exit status.

    Args:
        path: Its file.
        argv: Its arguments.
        prefix: A command to run it with, such as ``["gdb", "--args"]``.
    """
    process = subprocess.Popen([*(prefix or []), path, *argv])  # noqa: S603  # the caller's
    while process.returncode is None:
        with suppress(KeyboardInterrupt):  # the program receives the signal as well
            process.wait()
    status = process.returncode
    if -status in signal.valid_signals():
        print(ROS2RUN_MSG_PREFIX, signal.strsignal(-status))
    elif status:
        print(ROS2RUN_MSG_PREFIX, f"Process exited with failure {status}")
    return status


class ExecutableNameCompleter:
    """Returns the executables of a package, for an argument of a command.

    Args:
        package_name_key: The argument that names the package.
    """

    def __init__(self, *, package_name_key: str | None = None) -> None:
        self.package_name_key = package_name_key

    def __call__(self, prefix: str, parsed_args: Any, **kwargs: Any) -> list[str]:
        """Return the names."""
        package = getattr(parsed_args, self.package_name_key or "")
        try:
            return [Path(path).name for path in get_executable_paths(package_name=package)]
        except PackageNotFound:
            return []
