"""The rover's page, for a browser on this machine; it also switches the battery on and off.

Run it with ``python -m aionode.examples.rover.page``. It needs ``pip install 'aionode[gateway]'``.
"""

from __future__ import annotations

import asyncio
from pathlib import Path

import aionode
from aionode import Node
from aionode.gateway import Gateway, Policy
from aionode.lifecycle import LifecycleManager

__all__ = ["main"]

POLICY = Path(__file__).with_name("policy.toml")


async def main() -> None:
    """Serve the page until Ctrl-C."""
    async with Node("page") as node:
        port = node.declare_parameter("port", 8090).value
        async with (
            LifecycleManager(node, ["/battery"]),
            Gateway(node, Policy.load(POLICY), port=port) as gateway,
        ):
            node.get_logger().info(f"Open http://127.0.0.1:{gateway.port} to drive the rover")
            await asyncio.Event().wait()


if __name__ == "__main__":
    aionode.run(main)
