"""The tasks of a node, and the end of a wait whose entity is destroyed."""

from __future__ import annotations

import asyncio
from contextvars import Context, ContextVar, copy_context
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import ref

from aionode.errors import EntityDestroyedError

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

__all__ = ["OWNER", "NodeTasks", "create_own_task"]

T = TypeVar("T")

OWNER: ContextVar[ref[NodeTasks] | None] = ContextVar("aionode_owner", default=None)
"""The node whose callback or constructor runs, also in the tasks that these start.

It is weak, as a context may outlive a node.
"""


class NodeTasks:
    """The tasks of one node: those of its callbacks, and the body of its ``async with``.

    A task that a callback or the constructor starts is the node's as well, such as those of
    `asyncio.gather`, of `asyncio.shield` and of a TaskGroup in the callback. A task that the body
    starts is not: it may belong to a TaskGroup around the node, which would drop a cancellation
    without a word.

    Args:
        on_failure: Called as soon as the node fails.

    Attributes:
        error: The exception that the node failed with; None until it fails.
    """

    def __init__(self, on_failure: Callable[[], None] | None = None) -> None:
        self.error: BaseException | None = None
        self._on_failure = on_failure
        self._body: asyncio.Task[Any] | None = None
        self._ref = ref(self)

    def enter_constructor(self) -> None:
        """Count the tasks that are started from here on among the node's own."""
        OWNER.set(self._ref)

    def enter_body(self) -> None:
        """Record that the current task runs the body of ``async with node``."""
        self._body = asyncio.current_task()

    def context(self) -> Context:
        """Return a context for a task of the node's own, and for the tasks that it starts."""
        context = copy_context()
        context.run(OWNER.set, self._ref)
        return context

    def add(self, task: asyncio.Task[Any]) -> None:
        """Take `task` for one whose failure is that of the node."""
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
        if OWNER.get() is self._ref:
            return True
        return self._body is not None and asyncio.current_task() is self._body

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
    """Return a new task of `tasks`, whose failure is that of the node of the current task."""
    task = tasks.create_task(work, name=name)
    reference = OWNER.get()
    owner = None if reference is None else reference()
    if owner is not None:
        owner.add(task)
    return task
