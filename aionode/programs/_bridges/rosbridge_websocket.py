"""``rosbridge_server rosbridge_websocket``: the gateway, where rosbridge would listen."""

from __future__ import annotations

from functools import partial
from typing import Final

import aionode
from aionode.programs._bridges.bridge import Original, serve

__all__ = ["ORIGINAL", "main"]

ORIGINAL: Final = Original(
    "rosbridge_websocket",
    9090,
    {"params_glob": "", "services_glob": "", "topics_glob": "", "ssl": False},
)


def main() -> None:
    """Serve clients until Ctrl-C."""
    aionode.run(partial(serve, ORIGINAL))
