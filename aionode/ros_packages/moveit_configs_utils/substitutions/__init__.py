"""`moveit_configs_utils.substitutions`: robot descriptions made at launch."""

from __future__ import annotations

from moveit_configs_utils.substitutions.xacro import Xacro

__all__ = ["Xacro"]
