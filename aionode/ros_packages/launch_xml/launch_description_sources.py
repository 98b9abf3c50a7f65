"""`launch_xml.launch_description_sources`."""

from __future__ import annotations

from launch.launch_description_sources import XMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource"]
