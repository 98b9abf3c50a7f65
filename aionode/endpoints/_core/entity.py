"""What all entities of a node have in common: an owner, a task, and an end."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from aionode.errors import EntityDestroyedError

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Coroutine
    from typing import Any

__all__ = ["EndStage", "Entity"]


class EndStage(IntEnum):
    """The steps in which a node ends; the entities of each are destroyed, the newest first.

    Attributes:
        CALLBACKS: What calls callbacks; they are cancelled, and waited for before the next step.
        GOALS: What cancels goals; the servers' answers are waited for before the next step.
        LAST: What callbacks may use until they have ended: publishers, clients, rates.
    """

    CALLBACKS = 0
    GOALS = 1
    LAST = 2


class Entity:
    """Base of everything that a node creates.

    The node starts `run` in its TaskGroup, at once if it runs already, or when it begins to.
    Destroying an entity cancels that task and gives the entity back to its node.

    Attributes:
        subject: What it is, for errors and logs, such as ``publisher of /chatter``.
        destroyed: Whether it was destroyed.
        stage: When it is destroyed as its node ends.
    """

    def __init__(self, subject: str, stage: EndStage = EndStage.CALLBACKS) -> None:
        self.subject = subject
        self.stage = stage
        self.destroyed = False
        self._task: asyncio.Task[None] | None = None
        self._on_destroy: Callable[[Entity], None] | None = None

    def adopt(self, on_destroy: Callable[[Entity], None]) -> None:
        """Name the owner, who is told of the end. Called once, by the node."""
        self._on_destroy = on_destroy

    def start(self, tasks: asyncio.TaskGroup) -> asyncio.Task[None] | None:
        """Begin to work, in a task of `tasks`, and return that if there is one. For the node."""
        work = self.run()
        if work is not None:
            try:
                self._task = tasks.create_task(work, name=self.subject)
            except RuntimeError:
                # The node is failing already; it will destroy the entity in a moment.
                work.close()
                raise
        return self._task

    def run(self) -> Coroutine[Any, Any, None] | None:
        """Return the work of the entity as a coroutine; None where there is none."""
        return None

    def destroy(self) -> None:
        """End the entity: it sends, receives and calls nothing any more. Twice is allowed."""
        if self.destroyed:
            return
        self.destroyed = True
        # A callback that failed has cancelled the others already; once more would break off what
        # they do in `finally`.
        if self._task is not None and not self._task.cancelling():
            self._task.cancel()
        self._close()
        if self._on_destroy is not None:
            self._on_destroy(self)

    def _close(self) -> None:
        """Release what the entity holds; called once, by `destroy`."""

    def refuse_if_destroyed(self, action: str = "") -> None:
        """Raise EntityDestroyedError after `destroy`."""
        if self.destroyed:
            raise EntityDestroyedError(self.subject, action)
