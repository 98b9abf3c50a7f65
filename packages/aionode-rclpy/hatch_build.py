"""Puts aionode's Python packages of ROS, which lie beside this folder, into the distribution."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class RosPackages(BuildHookInterface[Any]):
    """Adds what is in `aionode/ros_packages`; an sdist has it in ``src``."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the packages, unless this is an unpacked sdist, or an editable installation."""
        folder = Path(self.root).parents[1] / "aionode" / "ros_packages"
        if not folder.is_dir() or version == "editable":
            return
        above = "src/" if self.target_name == "sdist" else ""
        for package in folder.iterdir():
            if package.name != "__pycache__":
                build_data["force_include"][str(package)] = above + package.name
