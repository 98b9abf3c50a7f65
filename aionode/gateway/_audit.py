"""The audit log: one line of JSON for each action of a client, and for each refusal."""

from __future__ import annotations

import asyncio
from collections import deque
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._concurrency import run_in_thread
from aionode.interfaces.std_msgs.msg import String

if TYPE_CHECKING:
    from aionode.gateway._identity import Identity
    from aionode.node import Node

__all__ = ["Audit"]

MOST_WAITING: Final = 1000
"""How many lines may wait for the disk; further ones are counted, and not written."""

MOST_TEXT: Final = 500
"""The longest text of the arguments of one line, in characters."""

REFUSALS_PER_SEC: Final = 20
"""How many refusals are written a second: a client that asks in vain must not fill the disk."""


class Audit:
    """Writes what clients do to a file, and to the topic ``~/audit`` of the gateway's node.

    Args:
        node: The gateway's node.
        path: The file, to which lines are appended; empty for none.

    Attributes:
        lost: How many lines were not written, because the disk was slow or there were too many.
    """

    def __init__(self, node: Node, path: str = "") -> None:
        self.lost = 0
        self._path = Path(path) if path else None
        self._publisher = node.create_publisher(String, "~/audit", 100)
        self._node = node
        self._lines: deque[str] = deque()
        self._filled = asyncio.Event()
        self._second = 0
        self._refusals = 0

    def use_file(self, path: str) -> None:
        """Append to another file from now on, also what waits; empty for none."""
        self._path = Path(path) if path else None

    def note(
        self,
        identity: Identity,
        action: str,
        name: str,
        *,
        arguments: Any = None,
        result: str = "ok",
        duration_ns: int | None = None,
        **more: Any,
    ) -> None:
        """Write one line.

        Args:
            identity: Who.
            action: What it did, such as ``call``.
            name: With which topic, service, action or parameter.
            arguments: What it sent, which is shortened.
            result: ``ok``, or why it was refused or failed.
            duration_ns: How long it took, in nanoseconds.
            more: Further keys.
        """
        now = self._node.get_clock().now().nanoseconds
        is_refusal = "code" in more
        if is_refusal and self._are_too_many(now // 1_000_000_000):
            self.lost += 1
            return
        line: dict[str, Any] = {
            "time": round(now / 1e9, 6),
            "who": identity.name,
            "address": identity.address,
            "action": action,
            "name": name[:MOST_TEXT],
            "result": result[:MOST_TEXT],
        }
        if arguments is not None:
            line["arguments"] = repr(arguments)[:MOST_TEXT]
        if duration_ns is not None:
            line["duration_ms"] = round(duration_ns / 1e6, 3)
        self._put(msgspec.json.encode(line | more).decode())

    def _are_too_many(self, second: int) -> bool:
        if second != self._second:
            self._second, self._refusals = second, 0
        self._refusals += 1
        return self._refusals > REFUSALS_PER_SEC

    def _put(self, line: str) -> None:
        if not self._publisher.destroyed:
            self._publisher.publish(String(data=line))
        if self._path is None:
            return
        if len(self._lines) >= MOST_WAITING:
            self.lost += 1
            return
        self._lines.append(line)
        self._filled.set()

    async def run(self) -> None:
        """Append lines to the file, in a thread, until it is cancelled; the rest then as well."""
        try:
            while True:
                await self._filled.wait()
                self._filled.clear()
                await self._write()
        finally:
            await self._write()

    async def _write(self) -> None:
        lines = [self._lines.popleft() for _ in range(len(self._lines))]
        if not lines or self._path is None:
            return
        try:
            await run_in_thread(append, self._path, "".join(f"{line}\n" for line in lines))
        except OSError as error:
            self.lost += len(lines)
            self._node.get_logger().error(
                f"audit log {self._path}: {error.strerror}; free the disk, or name another file"
            )

    def close(self) -> None:
        """Publish no more."""
        with suppress(RuntimeError):
            self._publisher.destroy()


def append(path: Path, text: str) -> None:
    """Append a text to a file that only its owner can read."""
    is_new = not path.exists()
    with path.open("a", encoding="utf-8") as file:
        if is_new:
            path.chmod(0o600)
        file.write(text)
