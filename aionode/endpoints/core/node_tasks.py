"""The tasks of a node, and the exception for waits whose entity is destroyed."""

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
"""The node whose callback or constructor is running, inherited by the tasks that these start.

A weak reference, as a context may outlive a node.
"""


class NodeTasks:
    """The tasks of one node: those of its callbacks, and the body of its ``async with``.

    A task started by a callback or the constructor is the node's own as well, such as those of
    `asyncio.gather`, `asyncio.shield` or a TaskGroup inside the callback. A task started by the
    body is not: it may belong to a TaskGroup around the node, which would silently drop a
    cancellation.

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
        """Count tasks started from here on as the node's own."""
        OWNER.set(self._ref)

    def enter_body(self) -> None:
        """Record that the current task runs the body of ``async with node``."""
        self._body = asyncio.current_task()

    def context(self) -> Context:
        """Return a context for one of the node's own tasks and the tasks that it starts."""
        context = copy_context()
        context.run(OWNER.set, self._ref)
        return context

    def add(self, task: asyncio.Task[Any]) -> None:
        """Register a task whose failure is the node's failure."""
        task.add_done_callback(self._note_end)

    def _note_end(self, task: asyncio.Task[Any]) -> None:
        if not task.cancelled():
            self.note_error(task.exception())

    def note_error(self, error: BaseException | None) -> None:
        """Record the exception that the node failed with; only the first one counts."""
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
        """Return the exception for the current task, whose wait ended as `subject` was destroyed.

        The node's own tasks end with it, so they are cancelled. Nobody has cancelled any other
        task: there, a CancelledError would end it silently or confuse the TaskGroup around it.
        """
        if self.own_current_task():
            return asyncio.CancelledError(f"{subject}: destroyed")
        destroyed = EntityDestroyedError(subject)
        destroyed.__cause__ = self.error
        return destroyed


def create_own_task(
    tasks: asyncio.TaskGroup, work: Coroutine[Any, Any, T], name: str | None = None
) -> asyncio.Task[T]:
    """Create a task in `tasks` whose failure is the failure of the current task's node."""
    task = tasks.create_task(work, name=name)
    reference = OWNER.get()
    owner = None if reference is None else reference()
    if owner is not None:
        owner.add(task)
    return task
