"""Launch files import this as `launch_yaml`."""

from __future__ import annotations

from launch_yaml import launch_description_sources as launch_description_sources

__all__ = ["launch_description_sources"]
