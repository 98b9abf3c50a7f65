"""The package that launch files import as `moveit_configs_utils`; a workspace's comes first."""

from __future__ import annotations

from moveit_configs_utils.moveit_configs_builder import MoveItConfigs, MoveItConfigsBuilder

__all__ = ["MoveItConfigs", "MoveItConfigsBuilder"]
