"""Launch files import this as `nav2_common`; a workspace's own takes precedence."""

from __future__ import annotations

from nav2_common import launch as launch

__all__ = ["launch"]
