"""The base of all entities of a node: an owner, a task, and an end.

Names with an underscore are for the node and subclasses, and the functions for other parts of
aionode; the rest is for users.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from aionode.errors import EntityDestroyedError

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Coroutine
    from typing import Any

    from aionode.endpoints.core.node_tasks import NodeTasks
    from aionode.engine.loop_affinity import LoopAffinity

__all__ = ["EndStage", "Entity", "end_lease", "end_of_wait", "refuse_if_destroyed"]


class EndStage(IntEnum):
    """The steps in which a node ends; in each, its entities are destroyed, newest first.

    Attributes:
        CALLBACKS: Entities with callbacks, which are cancelled; the next step waits for them to
            end.
        GOALS: Entities that cancel goals; the next step waits for the servers' answers.
        LAST: What callbacks may use until their end: publishers, clients, rates.
    """

    CALLBACKS = 0
    GOALS = 1
    LAST = 2


class Entity:
    """Base of everything that a node creates.

    The node starts `_run` in its TaskGroup: at once if it is running, otherwise when it starts.
    Destroying an entity cancels that task and removes the entity from its node.

    Args:
        subject: What it is, for errors and logs, such as ``publisher of /chatter``.
        stage: When it is destroyed as its node ends.

    Attributes:
        destroyed: Whether it was destroyed.
    """

    def __init__(self, subject: str, stage: EndStage = EndStage.CALLBACKS) -> None:
        self._subject = subject
        self._stage = stage
        self.destroyed = False
        self._task: asyncio.Task[None] | None = None
        self._on_destroy: Callable[[Entity], None] | None = None
        self._node_affinity: LoopAffinity | None = None
        self._node_tasks: NodeTasks | None = None

    def _adopt(
        self, on_destroy: Callable[[Entity], None], affinity: LoopAffinity, node_tasks: NodeTasks
    ) -> None:
        """Set what is called on destruction, and in which loop; the node calls this once.

        `node_tasks` knows which tasks are the node's own.
        """
        self._on_destroy = on_destroy
        self._node_affinity = affinity
        self._node_tasks = node_tasks

    def _start(self, tasks: asyncio.TaskGroup) -> asyncio.Task[None] | None:
        """Start `_run` as a task of `tasks`; return the task, or None if there is no work."""
        work = self._run()
        if work is not None:
            context = None if self._node_tasks is None else self._node_tasks.context()
            try:
                self._task = tasks.create_task(work, name=self._subject, context=context)
            except RuntimeError:
                # The node is already failing; it is about to destroy the entity.
                work.close()
                raise
            if self._node_tasks is not None:
                self._node_tasks.add(self._task)
        return self._task

    def _run(self) -> Coroutine[Any, Any, None] | None:
        """Return the work of the entity as a coroutine, or None."""
        return None

    def destroy(self) -> None:
        """End the entity: it sends, receives and calls nothing any more. May be called twice.

        It may be called in any thread. Outside the thread of the node's event loop it blocks until
        the loop has done it.
        """
        if self.destroyed:
            return
        affinity = self._node_affinity
        if affinity is not None and affinity.is_other_thread():
            affinity.wait_for(self.destroy)
            return
        self.destroyed = True
        # A failed callback has already cancelled the others; cancelling again would interrupt their
        # `finally` blocks.
        if self._task is not None and not self._task.cancelling():
            self._task.cancel()
        self._close()
        if self._on_destroy is not None:
            self._on_destroy(self)

    def _end_lease(self, refusal: Callable[[], Exception]) -> None:
        """Send the stop of an open lease; its `publish` then raises what `refusal` returns."""

    def _close(self) -> None:
        """Release what the entity holds; called once, by `destroy`."""

    def _end_of_wait(self) -> asyncio.CancelledError | EntityDestroyedError:
        """Return the exception for the current task, whose wait was ended by `destroy`."""
        if self._node_tasks is None:
            return EntityDestroyedError(self._subject)
        return self._node_tasks.end_of_wait(self._subject)

    def _destroyed_error(self, action: str = "") -> EntityDestroyedError:
        """Return the error for uses of the destroyed entity, caused by the node's error if any."""
        error = EntityDestroyedError(self._subject, action)
        if self._node_tasks is not None:
            error.__cause__ = self._node_tasks.error
        return error

    def _refuse_if_destroyed(self, action: str = "") -> None:
        """Raise EntityDestroyedError after `destroy`."""
        if self.destroyed:
            raise self._destroyed_error(action)


def refuse_if_destroyed(entity: Entity, action: str = "") -> None:
    """Raise EntityDestroyedError after `destroy`."""
    entity._refuse_if_destroyed(action)


def end_of_wait(entity: Entity) -> asyncio.CancelledError | EntityDestroyedError:
    """Return the exception for the current task, whose wait was ended by `destroy`."""
    return entity._end_of_wait()


def end_lease(entity: Entity, refusal: Callable[[], Exception]) -> None:
    """Send the stop of an open lease; its `publish` then raises what `refusal` returns."""
    entity._end_lease(refusal)
