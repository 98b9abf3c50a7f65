"""Launch files import this as `launch_xml`."""

from __future__ import annotations

from launch_xml import launch_description_sources as launch_description_sources

__all__ = ["launch_description_sources"]
