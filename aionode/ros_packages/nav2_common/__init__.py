"""The package that launch files import as `nav2_common`; the one of a workspace comes first."""

from __future__ import annotations

from nav2_common import launch as launch

__all__ = ["launch"]
