"""Packages of ROS 2: where a package lies, what it can start, and by which command.

A folder with a ``package.xml`` is a package as it is, without a build; packages that are installed
(AMENT_PREFIX_PATH, or pip in this environment) are found after those of the workspace.
"""

from __future__ import annotations

from aionode._packages._executables import Executable, is_python
from aionode._packages._here import (
    around,
    here,
    package_of_stand_in,
    stand_in,
    use,
    use_stand_ins,
)
from aionode._packages._packages import Packages
from aionode._packages._standard import program_module, remark_on
from aionode._packages._workspace import workspace_of

__all__ = [
    "Executable",
    "Packages",
    "around",
    "here",
    "is_python",
    "package_of_stand_in",
    "program_module",
    "remark_on",
    "stand_in",
    "use",
    "use_stand_ins",
    "workspace_of",
]
