"""`launch.frontend`: XML and YAML launch files, and a program's own substitutions in them."""

from __future__ import annotations

from launch.frontend import expose as expose
from launch.frontend.expose import expose_action, expose_substitution
from launch.frontend.parser import Entity, InvalidFrontendLaunchFileError, Parser
from launch.utilities import type_utils as type_utils

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "type_utils",
]
