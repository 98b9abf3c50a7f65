"""`launch.frontend.entity`."""

from __future__ import annotations

from launch.frontend.parser import Entity

__all__ = ["Entity"]
