"""The record of how and why a node ended."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["EndRecord", "NodeEnd", "failure_line", "short_text"]


class NodeEnd(Struct, frozen=True):
    """How a node ended.

    Attributes:
        reason: ``"destroyed"``: `destroy_node` was called, its context was shut down, or the body
            of ``async with`` ended. ``"failed"``: a callback, or that body, raised an exception.
            ``"cancelled"``: the task that ran the node was cancelled.
        error: The exception raised by ``async with`` or `run` if the node failed, else None.
    """

    reason: Literal["destroyed", "failed", "cancelled"]
    error: BaseException | None = None

    def __str__(self) -> str:
        """Return one line, such as ``failed: ValueError: no map``."""
        return self.reason if self.error is None else f"{self.reason}: {short_text(self.error)}"


def short_text(error: BaseException) -> str:
    """Format the type and text of an exception in one line; for a group, those of its members."""
    if isinstance(error, BaseExceptionGroup):
        return "; ".join(short_text(part) for part in error.exceptions)
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def failure_line(error: BaseException) -> str:
    """Format an exception like `short_text`, with the callback of each exception."""
    if isinstance(error, BaseExceptionGroup):
        return "; ".join(failure_line(part) for part in error.exceptions)
    return ", ".join([short_text(error), *getattr(error, "__notes__", ())])


class EndRecord:
    """Records the end of one node, and wakes the tasks that wait for it."""

    def __init__(self, subject: str) -> None:
        self._subject = subject
        self._end: NodeEnd | None = None
        self._known = asyncio.Event()
        self._runs_in: asyncio.Task[object] | None = None

    def begin(self) -> None:
        """Record that the current task runs the node."""
        self._runs_in = asyncio.current_task()

    def note(self, end: NodeEnd) -> None:
        """Record the end and wake the tasks waiting for it; only the first call counts."""
        if self._end is None:
            self._end = end
            self._known.set()

    @contextlib.contextmanager
    def recorded(self, body: BaseException | None) -> Iterator[None]:
        """Record the node's end according to how the ``with`` block, which shuts it down, ends.

        Args:
            body: The exception from the body of the node's ``async with``, if any.
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
        """Wait for the end and return it.

        Raises:
            RuntimeError: called by the task that runs the node, which would wait for itself.
        """
        if self._end is None and self._runs_in is asyncio.current_task():
            raise RuntimeError(
                f"{self._subject}: awaiting ended() inside the node's own `async with` would wait "
                "forever, as the node ends after that block; await it in another task"
            )
        await self._known.wait()
        assert self._end is not None  # noqa: S101  # set before the event
        return self._end


def end_with(error: BaseException | None) -> NodeEnd:
    """Return the end of a node whose ``async with`` raised `error`, or None."""
    if error is None:
        return NodeEnd("destroyed")
    if isinstance(error, asyncio.CancelledError):
        return NodeEnd("cancelled")
    return NodeEnd("failed", error)
