"""`launch.frontend`: substitutions of a program's own in XML and YAML launch files."""

from __future__ import annotations

from launch.frontend import expose as expose
from launch.frontend.expose import expose_action, expose_substitution
from launch.utilities import type_utils as type_utils

__all__ = ["expose_action", "expose_substitution", "type_utils"]
