"""The changes of the transform between two frames, one at a time."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode.tf._walk import ancestors

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.tf._arithmetic import Pose
    from aionode.tf._node_buffer_core import NodeBufferCore

__all__ = ["Changes"]


class Changes:
    """Iterates over the latest transform between two frames; see `Buffer.follow`."""

    def __init__(self, buffer: NodeBufferCore, target: str, source: str) -> None:
        self._buffer = buffer
        self._target = target
        self._source = source
        self._last: tuple[Pose, int] | None = None

    def __aiter__(self) -> AsyncIterator[TransformStamped]:
        """Iterate until the node of the buffer is destroyed."""
        return self

    async def __anext__(self) -> TransformStamped:
        """Wait for a transform that differs from the last one. Cancelling loses nothing."""
        buffer = self._buffer
        while not buffer._BufferCore__entity.destroyed:
            latest = buffer._BufferCore__latest_pose(self._target, self._source)
            if latest is not None and latest != self._last:
                self._last = latest
                pose, stamp_ns = latest
                return buffer._BufferCore__message(self._target, self._source, pose, stamp_ns)
            await self._change()
        raise StopAsyncIteration

    async def _change(self) -> None:
        """Wait until a frame on the path has new data."""
        buffer = self._buffer
        changed: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        tree = buffer._BufferCore__frames
        frames = {*ancestors(tree, self._source), *ancestors(tree, self._target)}
        for frame in frames:
            buffer._BufferCore__followers.setdefault(frame, {})[changed] = None
        try:
            await changed
        finally:
            for frame in frames:
                waiting = buffer._BufferCore__followers.get(frame)
                if waiting is not None:
                    waiting.pop(changed, None)
                    if not waiting:
                        del buffer._BufferCore__followers[frame]
