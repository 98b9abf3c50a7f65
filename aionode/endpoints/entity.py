"""What all entities of a node have in common: an owner, a task, and an end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.errors import EntityDestroyedError

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Coroutine
    from typing import Any

__all__ = ["Entity"]


class Entity:
    """Base of everything that a node creates.

    The node starts `run` in its TaskGroup, at once if it runs already, or when it begins to.
    Destroying an entity cancels that task and gives the entity back to its node.
    """

    def __init__(self, subject: str) -> None:
        self.subject = subject
        self.destroyed = False
        self._task: asyncio.Task[None] | None = None
        self._on_destroy: Callable[[Entity], None] | None = None

    def adopt(self, on_destroy: Callable[[Entity], None]) -> None:
        """Name the owner, who is told of the end. Called once, by the node."""
        self._on_destroy = on_destroy

    def start(self, tasks: asyncio.TaskGroup) -> None:
        """Begin to work, in a task of `tasks`. Called by the node."""
        work = self.run()
        if work is not None:
            try:
                self._task = tasks.create_task(work, name=self.subject)
            except RuntimeError:
                # The node is failing already; it will destroy the entity in a moment.
                work.close()
                raise

    def run(self) -> Coroutine[Any, Any, None] | None:
        """Return the work of the entity as a coroutine; None where there is none."""
        return None

    def destroy(self) -> None:
        """End the entity: it sends, receives and calls nothing any more. Twice is allowed."""
        if self.destroyed:
            return
        self.destroyed = True
        if self._task is not None:
            self._task.cancel()
        self.close()
        if self._on_destroy is not None:
            self._on_destroy(self)

    def close(self) -> None:
        """Release what the entity holds; called once, by `destroy`."""

    def refuse_if_destroyed(self, action: str = "used") -> None:
        """Raise EntityDestroyedError after `destroy`."""
        if self.destroyed:
            raise EntityDestroyedError(self.subject, action)
