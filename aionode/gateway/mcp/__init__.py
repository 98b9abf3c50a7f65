"""An assistant for the robot: tools of the Model Context Protocol, limited by the policy."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.gateway.mcp.http import McpOverHttp

__all__ = ["McpOverHttp"]

__getattr__ = imported_on_first_use(__name__, {"McpOverHttp": "http"}, "mcp")
