"""Packages of ROS 2: where a package lies, what it can start, and by which command.

A folder with a ``package.xml`` is a package as it is, without a build; packages that are installed
(AMENT_PREFIX_PATH, or pip in this environment) are found after those of the workspace.
"""

from __future__ import annotations

from aionode._packages._executables import Executable, is_python
from aionode._packages._here import around, here, use
from aionode._packages._packages import Packages
from aionode._packages._standard import program_module
from aionode._packages._workspace import workspace_of

__all__ = [
    "Executable",
    "Packages",
    "around",
    "here",
    "is_python",
    "program_module",
    "use",
    "workspace_of",
]
