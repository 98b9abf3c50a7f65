"""Runs a launch file with ROS 2's own launch: ``python -m aionode.launch FILE NAME:=VALUE``.

Modules that ROS 2's launch needs and that are not installed, such as `rclpy`, are aionode's.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType

from aionode.rclpy import install

__all__ = ["main"]


class InstalledLaunch(MetaPathFinder):
    """Finds the installed modules of launch instead of aionode's."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a module of launch; None for all others."""
        package = fullname.partition(".")[0]
        if package.startswith("launch") or package == "ament_index_python":
            return PathFinder.find_spec(fullname, path, target)
        return None


def main() -> int:
    """Run the file; return its exit status."""
    path, *arguments = sys.argv[1:]
    install(prefer_ros=True)
    sys.meta_path.insert(0, InstalledLaunch())
    launch = import_module("launch")
    sources = import_module("launch.launch_description_sources")
    pairs = [tuple(argument.split(":=", 1)) for argument in arguments]
    include = launch.actions.IncludeLaunchDescription(
        sources.AnyLaunchDescriptionSource(path), launch_arguments=pairs
    )
    service = launch.LaunchService(argv=arguments)
    service.include_launch_description(launch.LaunchDescription([include]))
    return int(service.run())


if __name__ == "__main__":
    sys.exit(main())
