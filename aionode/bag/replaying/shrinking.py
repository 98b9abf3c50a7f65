"""Finds the shortest piece of a bag with which a test still fails.

The test runs as a separate command with a variable in its environment, which makes `replay` use the
piece instead of the whole bag; no file is written. First, topics are removed, since that shortens
all further runs; then time is cut from both ends; then topics are tried again.
"""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING, Final

import msgspec

from aionode.bag._bag import open as open_bag
from aionode.bag._writer import BagWriter
from aionode.bag.replaying.replay import PIECE_VARIABLE, Piece, whole
from aionode.clock import Time
from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Sequence
    from os import PathLike

__all__ = ["Piece", "fails", "shrink", "write"]

MIN_NS: Final = 10_000_000
"""The finest step by which time is cut, in nanoseconds."""

NO_TESTS: Final = (2, 3, 4, 5)
"""Exit statuses of pytest: interrupted, internal or usage error, or no test run."""


async def shrink(
    path: str | PathLike[str],
    fails: Callable[[Piece], Awaitable[bool]],
    on_piece: Callable[[Piece], None] = lambda _: None,
) -> Piece:
    """Return the shortest piece found for which `fails` is true.

    Args:
        path: The bag.
        fails: Runs the test with a piece, and returns whether it fails.
        on_piece: Called with each shorter piece that still fails.

    Raises:
        BagError: the bag cannot be read, or the test passes with all of it (a ValueError).
    """
    with open_bag(path) as bag:
        piece = whole(bag)
    if not await fails(piece):
        raise BagError(str(path), "the command succeeds with the whole bag", "nothing to shrink")
    search = Search(fails, on_piece, piece)
    before = None
    while before != search.piece:
        before = search.piece
        await search.leave_out_topics()
        await search.cut_end()
        await search.cut_start()
    return search.piece


class Search:
    """The shortest piece so far, and the strategies to find a shorter one.

    Args:
        fails: Whether the test fails with a piece.
        on_piece: Called with each shorter piece.
        piece: A piece with which the test fails.

    Attributes:
        piece: The shortest piece so far.
    """

    def __init__(
        self,
        fails: Callable[[Piece], Awaitable[bool]],
        on_piece: Callable[[Piece], None],
        piece: Piece,
    ) -> None:
        self.piece = piece
        self._fails = fails
        self._on_piece = on_piece

    async def leave_out_topics(self) -> None:
        """Remove as many topics as possible: groups first, then one by one (ddmin)."""
        size = max(1, len(self.piece.topics) // 2)
        while len(self.piece.topics) > 1:
            topics = self.piece.topics
            groups = [topics[at : at + size] for at in range(0, len(topics), size)]
            shorter = False
            for group in groups:
                rest = [topic for topic in self.piece.topics if topic not in group]
                if rest and await self._try(msgspec.structs.replace(self.piece, topics=rest)):
                    shorter = True
            if size == 1 and not shorter:
                return
            size = max(1, min(size, len(self.piece.topics)) // 2)

    async def cut_end(self) -> None:
        """Move the end of the piece as early as possible."""
        passes_ns, fails_ns = self.piece.start_ns, self.piece.end_ns
        while fails_ns - passes_ns > MIN_NS:
            middle_ns = (passes_ns + fails_ns) // 2
            if await self._try(msgspec.structs.replace(self.piece, end_ns=middle_ns)):
                fails_ns = middle_ns
            else:
                passes_ns = middle_ns

    async def cut_start(self) -> None:
        """Move the start of the piece as late as possible, by steps that halve each time."""
        step_ns = (self.piece.end_ns - self.piece.start_ns) // 2
        while step_ns > MIN_NS:
            start_ns = self.piece.start_ns + step_ns
            fits = start_ns < self.piece.end_ns
            if not (
                fits and await self._try(msgspec.structs.replace(self.piece, start_ns=start_ns))
            ):
                step_ns //= 2

    async def _try(self, piece: Piece) -> bool:
        """Adopt a piece if the test fails with it; return whether it does."""
        if not await self._fails(piece):
            return False
        self.piece = piece
        self._on_piece(piece)
        return True


async def fails(command: Sequence[str], piece: Piece, directory: str | None = None) -> bool:
    """Run a command with a piece in its environment; return whether it fails.

    A pytest run that was interrupted, or found no tests, does not count as failing.

    Args:
        command: The command and its arguments.
        piece: The piece.
        directory: Its working directory; by default that of this process.

    Raises:
        FileNotFoundError: there is no such command.
    """
    environment = {**os.environ, PIECE_VARIABLE: msgspec.json.encode(piece).decode()}
    process = await asyncio.create_subprocess_exec(
        *command,
        env=environment,
        cwd=directory,
        stdout=asyncio.subprocess.DEVNULL,
        stderr=asyncio.subprocess.DEVNULL,
    )
    try:
        status = await process.wait()
    except asyncio.CancelledError:
        process.kill()
        await process.wait()
        raise
    return status != 0 and not ("pytest" in " ".join(command) and status in NO_TESTS)


def write(piece: Piece, folder: str | PathLike[str]) -> int:
    """Write a piece as a bag of its own; return its number of messages.

    Raises:
        BagError: the folder already exists (a ValueError).
        BagWriteError: the disk is full or fails (an OSError).
    """
    with open_bag(piece.path) as bag, BagWriter(folder) as writer:
        start, end = Time(nanoseconds=piece.start_ns), Time(nanoseconds=piece.end_ns)
        for record in bag.read(piece.topics, start, end):
            writer.write_record(record)
        return writer.message_count
