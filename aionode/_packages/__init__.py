"""ROS 2 packages: where they are, which executables they have, and how to start them.

A folder with a ``package.xml`` is a package as is, without a build; installed packages
(AMENT_PREFIX_PATH, or pip in this environment) are looked up after those of the workspace.
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
from aionode._packages._parameter_modules import ParameterModule, parameter_modules
from aionode._packages._standard import (
    is_terminal,
    is_window,
    program_module,
    remark_on,
    standard_packages,
)
from aionode._packages._starters import is_starter_file, starter_file, tools_on_path
from aionode._packages._workspace import package_of, workspace_of

__all__ = [
    "Executable",
    "Packages",
    "ParameterModule",
    "around",
    "here",
    "is_python",
    "is_starter_file",
    "is_terminal",
    "is_window",
    "package_of",
    "package_of_stand_in",
    "parameter_modules",
    "program_module",
    "remark_on",
    "stand_in",
    "standard_packages",
    "starter_file",
    "tools_on_path",
    "use",
    "use_stand_ins",
    "workspace_of",
]
