"""The audit log: one line of JSON for each action of a client, and for each refusal."""

from __future__ import annotations

import asyncio
import json
import os
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.concurrency import run_in_thread
from aionode.clock import S_TO_NS
from aionode.gateway.session.encoding.client_json import shown
from aionode.interfaces.std_msgs.msg import String
from aionode.message import Message, fields

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Identity
    from aionode.node import Node

__all__ = ["Audit"]

MAX_WAITING: Final = 1000
"""Number of lines that may wait for the disk; further ones are only counted."""

MAX_TEXT: Final = 500
"""The longest text of the arguments in a line, in characters."""

REFUSALS_PER_SEC: Final = 20
"""Refusals of one client per second that are written: futile requests must not fill the disk."""

MAX_REFUSALS: Final = 200
"""Refusals of all clients per second that are written."""

MAX_LEVELS: Final = 20
"""How many levels of nested arguments are written."""


class Audit:
    """Writes the actions of clients to a file, and to the topic ``~/audit`` of the gateway's node.

    Args:
        node: The gateway's node.
        path: The file, to which lines are appended; empty for none.

    Attributes:
        topic: The full name of its topic.
        lost: Number of lines not written, because the disk was slow or there were too many.
    """

    def __init__(self, node: Node, path: str = "") -> None:
        self.lost = 0
        self._path = Path(path) if path else None
        self._publisher = node.create_publisher(String, "~/audit", 100)
        self.topic = self._publisher.topic_name
        self._node = node
        self._lines: deque[str] = deque()
        self._filled = asyncio.Event()
        self._time_base = node.context.time_base
        self._second = 0
        self._refusals: Counter[Identity] = Counter()  # in this second
        self._refused = 0

    def use_file(self, path: str) -> None:
        """From now on append to another file, including the lines that wait; empty for none."""
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
            name: The topic, service, action or parameter.
            arguments: What it sent, which is shortened.
            result: ``ok``, or why it was refused or failed.
            duration_ns: How long it took, in nanoseconds.
            more: Further keys.
        """
        if "code" in more and self._is_one_too_many(identity):
            self.lost += 1
            return
        line: dict[str, Any] = {
            "time": round(self._time_base.system_ns() / 1e9, 6),
            "who": identity.name,
            "address": identity.address,
            "action": action,
            "name": name[:MAX_TEXT],
            "result": result[:MAX_TEXT],
        }
        if arguments is not None:
            line["arguments"] = shortened(arguments)
        if duration_ns is not None:
            line["duration_ms"] = round(duration_ns / 1e6, 3)
        self._put(printable(msgspec.json.encode(line | more).decode()))

    def _is_one_too_many(self, identity: Identity) -> bool:
        """Count a refusal, and return whether it is too many for its client, or for all clients."""
        second = self._time_base.steady_ns() // S_TO_NS
        if second != self._second:
            self._second, self._refused = second, 0
            self._refusals.clear()
        self._refused += 1
        self._refusals[identity] += 1
        return self._refused > MAX_REFUSALS or self._refusals[identity] > REFUSALS_PER_SEC

    def _put(self, line: str) -> None:
        if not self._publisher.destroyed:
            self._publisher.publish(String(data=line))
        if self._path is None:
            return
        if len(self._lines) >= MAX_WAITING:
            self.lost += 1
            return
        self._lines.append(line)
        self._filled.set()

    async def run(self) -> None:
        """Append lines to the file, in a thread, until cancelled; then write the rest."""
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
        """Stop publishing."""
        with suppress(RuntimeError):
            self._publisher.destroy()


def append(path: Path, text: str) -> None:
    """Append a text to a file that only its owner can read."""

    def opened(name: str, flags: int) -> int:
        return os.open(name, flags, 0o600)

    with open(path, "a", encoding="utf-8", opener=opened) as file:  # has no opener
        file.write(text)


def printable(line: str) -> str:
    """Return a line of JSON with all unprintable characters escaped.

    JSON itself allows characters that move the cursor of a terminal, or reverse the order of
    others.
    """
    if line.isprintable():
        return line
    return "".join(char if char.isprintable() else json.dumps(char)[1:-1] for char in line)


def shortened(arguments: Any) -> str:
    """Return the beginning of a client's arguments; the rest costs nothing."""
    text = ""
    for part in parts_of(arguments):
        text += part
        if len(text) > MAX_TEXT:
            break
    return text[:MAX_TEXT]


def parts_of(value: Any, level: int = 0) -> Iterator[str]:
    """Yield the text of a value piece by piece; pieces that nobody wants are not made."""
    if level > MAX_LEVELS:
        yield "..."
    elif isinstance(value, Message):
        members = ((f"{field.name}=", getattr(value, field.name)) for field in fields(type(value)))
        yield from joined(f"{value.__ros_type__.replace('/', '.')}(", members, ")", level)
    elif isinstance(value, Mapping):
        items = ((f"{shown(key)}: ", part) for key, part in value.items())
        yield from joined("{", items, "}", level)
    elif isinstance(value, list | tuple):
        yield from joined("[", (("", part) for part in value), "]", level)
    elif hasattr(value, "tolist") and hasattr(value, "__len__"):  # an array of numbers
        yield from parts_of(value[:MAX_TEXT].tolist(), level)
    elif isinstance(value, str | bytes | bytearray | memoryview):
        piece = value[:MAX_TEXT]
        yield repr(bytes(piece) if isinstance(piece, memoryview) else piece)
    else:
        yield shown(value)


def joined(
    opening: str, items: Iterable[tuple[str, Any]], closing: str, level: int
) -> Iterator[str]:
    """Yield the text of several values, each after a label."""
    yield opening
    for number, (label, item) in enumerate(items):
        yield f", {label}" if number else label
        yield from parts_of(item, level + 1)
    yield closing
