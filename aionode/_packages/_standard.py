"""The programs of ROS's own packages that aionode has: the table by which they are found."""

from __future__ import annotations

from typing import Final

from aionode._packages._executables import Executable

__all__ = ["program_module", "standard_executables"]

MODULES: Final[dict[str, dict[str, str]]] = {
    "joint_state_publisher": {"joint_state_publisher": "_joint_state_publisher"},
    "robot_state_publisher": {"robot_state_publisher": "_robot_state_publisher"},
    "tf2_ros": {"static_transform_publisher": "_static_transform_publisher"},
}
"""The module of `aionode.programs` that is an executable, by package and name."""


def program_module(package: str, name: str) -> str | None:
    """Return the name of the module that is an executable of a package, if aionode has it."""
    module = MODULES.get(package, {}).get(name)
    return None if module is None else f"aionode.programs.{module}"


def standard_executables(package: str) -> dict[str, Executable]:
    """Return the programs of aionode that have the names of a package's executables."""
    return {
        name: Executable(package, name, module, is_standard=True)
        for name, module in MODULES.get(package, {}).items()
    }
