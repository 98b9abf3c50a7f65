"""A program that uses a robot like a model's client, but follows a script instead of a model.

``python -m tests.support.scripted_model CONFIG`` reads the settings that such clients read.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from pathlib import Path
from typing import Any

import mcp

__all__ = ["main"]


async def main(config: str) -> None:
    """Look for the ball, drive towards it, and stop."""
    server = json.loads(Path(config).read_text(encoding="utf-8"))["mcpServers"]["robot"]
    parameters = mcp.StdioServerParameters(
        command=server["command"], args=server["args"], env={**os.environ, **server["env"]}
    )
    async with mcp.Client(parameters) as client:
        await call(client, "look")
        ahead = {"topic": "/cmd_vel", "message": {"linear": {"x": 0.4}}, "seconds": 2}
        await call(client, "move", **ahead)
        await call(client, "stop")


async def call(client: Any, tool: str, **arguments: Any) -> None:
    """Call a tool.

    Raises:
        RuntimeError: it has failed.
    """
    answered = await client.call_tool(tool, arguments)
    if answered.is_error:
        raise RuntimeError(f"{tool}: {answered.content}")


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1]))
