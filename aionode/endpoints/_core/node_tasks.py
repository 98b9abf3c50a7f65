"""Which tasks are a node's own, and how a wait ends whose entity is destroyed."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import WeakKeyDictionary

from aionode.errors import EntityDestroyedError

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

__all__ = ["NodeTasks", "create_own_task"]

T = TypeVar("T")

OWNERS: WeakKeyDictionary[asyncio.Task[Any], NodeTasks] = WeakKeyDictionary()


class NodeTasks:
    """The tasks of one node: those that run its callbacks, and the body of its ``async with``.

    Tasks that a callback or the body starts are not the node's, since it does not wait for them.

    Args:
        on_failure: Called as soon as the node fails.

    Attributes:
        error: The exception that the node failed with; None until it fails.
    """

    def __init__(self, on_failure: Callable[[], None] | None = None) -> None:
        self.error: BaseException | None = None
        self._on_failure = on_failure
        self._body: asyncio.Task[Any] | None = None

    def enter_body(self) -> None:
        """Record that the current task runs the body of ``async with node``."""
        self._body = asyncio.current_task()

    def add(self, task: asyncio.Task[Any]) -> None:
        """Count `task` among the node's own; if it fails, the node has failed."""
        OWNERS[task] = self
        task.add_done_callback(self._note_end)

    def _note_end(self, task: asyncio.Task[Any]) -> None:
        if not task.cancelled():
            self.note_error(task.exception())

    def note_error(self, error: BaseException | None) -> None:
        """Record the exception that the node fails with; only the first one counts."""
        if self.error is not None or isinstance(error, asyncio.CancelledError):
            return
        while isinstance(error, BaseExceptionGroup) and len(error.exceptions) == 1:
            error = error.exceptions[0]
        self.error = error
        if error is not None and self._on_failure is not None:
            self._on_failure()

    def own_current_task(self) -> bool:
        """Return whether the current task is one of the node's own."""
        task = asyncio.current_task()
        return task is not None and (task is self._body or OWNERS.get(task) is self)

    def end_of_wait(self, subject: str) -> asyncio.CancelledError | EntityDestroyedError:
        """Return what the current task raises when a wait ends because `subject` was destroyed.

        A task of the node ends with it, so it is cancelled. Nobody has cancelled any other task: a
        CancelledError there would end it without a word, or confuse the TaskGroup around it.
        """
        if self.own_current_task():
            return asyncio.CancelledError(f"{subject}: destroyed")
        destroyed = EntityDestroyedError(subject)
        destroyed.__cause__ = self.error
        return destroyed


def create_own_task(
    tasks: asyncio.TaskGroup, work: Coroutine[Any, Any, T], name: str | None = None
) -> asyncio.Task[T]:
    """Return a new task of `tasks`, which belongs to the same node as the current task."""
    task = tasks.create_task(work, name=name)
    current = asyncio.current_task()
    owner = None if current is None else OWNERS.get(current)
    if owner is not None:
        owner.add(task)
    return task
