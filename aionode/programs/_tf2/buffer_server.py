"""``tf2_ros buffer_server``: looks up transforms for other programs."""

from __future__ import annotations

import aionode
from aionode import Duration, Node
from aionode.tf import Buffer, BufferServer

__all__ = ["TransformServer", "main"]


class TransformServer(Node):
    """Serves the action `tf2_buffer_server`; `buffer_size` seconds of transforms are kept."""

    def __init__(self) -> None:
        super().__init__("tf_buffer")
        size = self.declare_parameter("buffer_size", 120.0).value
        self.buffer = Buffer(self, cache_time=Duration(nanoseconds=int(size * 1e9)))
        BufferServer(self.buffer, self)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(TransformServer)
