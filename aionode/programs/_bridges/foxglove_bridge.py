"""``foxglove_bridge foxglove_bridge``: the gateway, where Foxglove looks for it."""

from __future__ import annotations

from functools import partial
from typing import Final

import aionode
from aionode.programs._bridges.bridge import Original, serve

__all__ = ["ORIGINAL", "main"]

ORIGINAL: Final = Original(
    "foxglove_bridge",
    8765,
    {
        "client_topic_whitelist": [".*"],
        "param_whitelist": [".*"],
        "service_whitelist": [".*"],
        "topic_whitelist": [".*"],
        "tls": False,
    },
)


def main() -> None:
    """Serve clients until Ctrl-C."""
    aionode.run(partial(serve, ORIGINAL))
