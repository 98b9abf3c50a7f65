"""How and why a node ended."""

from __future__ import annotations

import asyncio
import contextlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["EndRecord", "NodeEnd", "short_text"]


@dataclass(frozen=True, slots=True)
class NodeEnd:
    """How a node ended.

    Attributes:
        reason: ``"destroyed"``: `destroy_node` was called, its context was shut down, or the block
            of ``async with`` was left. ``"failed"``: a callback, or that block, raised.
            ``"cancelled"``: the task that ran it was cancelled from outside.
        error: What came out of ``async with`` or `run` if it failed, else None.
    """

    reason: Literal["destroyed", "failed", "cancelled"]
    error: BaseException | None = None

    def __str__(self) -> str:
        """Return it in one line: ``failed: ValueError: no map``."""
        return self.reason if self.error is None else f"{self.reason}: {short_text(self.error)}"


def short_text(error: BaseException) -> str:
    """Return type and text of an error in one line; of a group, those of its parts."""
    if isinstance(error, BaseExceptionGroup):
        return "; ".join(short_text(part) for part in error.exceptions)
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


class EndRecord:
    """Records the end of one node, for those who wait for it."""

    def __init__(self, subject: str) -> None:
        self._subject = subject
        self._end: NodeEnd | None = None
        self._known = asyncio.Event()
        self._runs_in: asyncio.Task[object] | None = None

    def begin(self) -> None:
        """Note that this task runs the node."""
        self._runs_in = asyncio.current_task()

    def note(self, end: NodeEnd) -> None:
        """Tell of the end; the first counts."""
        if self._end is None:
            self._end = end
            self._known.set()

    @contextlib.contextmanager
    def recorded(self, body: BaseException | None) -> Iterator[None]:
        """Note how this block ends, which waits for the last of the node.

        Args:
            body: What the node's ``async with`` block raised.
        """
        error = body
        try:
            yield
        except BaseException as raised:
            error = raised
            raise
        finally:
            self.note(end_with(error))

    async def wait(self) -> NodeEnd:
        """Return the end once it is there.

        Raises:
            RuntimeError: the task that runs the node would wait for itself.
        """
        if self._end is None and self._runs_in is asyncio.current_task():
            raise RuntimeError(
                f"{self._subject}: ended() inside its own `async with` would wait for itself, as "
                "the node ends with that block; await it in another task, or leave the block"
            )
        await self._known.wait()
        assert self._end is not None  # noqa: S101  # set before the event
        return self._end


def end_with(error: BaseException | None) -> NodeEnd:
    """Return the end of a node out of which `error` came."""
    if error is None:
        return NodeEnd("destroyed")
    if isinstance(error, asyncio.CancelledError):
        return NodeEnd("cancelled")
    return NodeEnd("failed", error)
