"""`launch_yaml.launch_description_sources`."""

from __future__ import annotations

from launch.launch_description_sources import YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
