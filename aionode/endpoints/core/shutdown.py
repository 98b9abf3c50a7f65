"""The staged shutdown of a node: callbacks first, and last what they may still need."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode.endpoints.core.entity import EndStage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.endpoints.core.callback_runner import Callbacks
    from aionode.endpoints.core.entity import Entity

__all__ = ["Shutdown"]

NOTICE_S = 0.3
"""Seconds of real time after which the log says what a shutdown is waiting for."""

CALLBACKS_S = 5.0
"""How long the shutdown of a node waits for its callbacks."""

ANSWERS_S = 1.0
"""How long the shutdown of a node waits for the servers whose goals it cancels."""


class Shutdown:
    """Ends a node so that its callbacks can clean up.

    Entities with callbacks are destroyed at once, and their callbacks cancelled. Publishers,
    clients and the clock stay until the callbacks have ended, so that ``finally`` can stop a robot.

    Args:
        entities: The entities of the node, oldest first; destroyed ones are removed.
        callbacks: How the node runs callbacks; knows those still running.
        leave: Called when everything is destroyed; ends the node itself.
    """

    def __init__(
        self, entities: Iterable[Entity], callbacks: Callbacks, leave: Callable[[], None]
    ) -> None:
        self._entities = entities
        self._callbacks = callbacks
        self._leave = leave
        self._stage = 0
        self._begun = False
        # Pending tasks that run callbacks, and pending answers to cancel requests.
        self._running: set[asyncio.Future[Any]] = set()
        self._answers: set[asyncio.Future[Any]] = set()

    def watch(self, task: asyncio.Task[None]) -> None:
        """Make the first step wait for `task`, which runs callbacks."""
        self._hold(task, self._running)

    def postpone(self, entity: Entity, stage: EndStage) -> None:
        """Destroy `entity` in `stage`, later than its own; the first step does not wait for it."""
        entity._stage = stage
        if entity._task is not None:
            self._running.discard(entity._task)

    def expect(self, answer: asyncio.Future[Any]) -> None:
        """Keep the clients until `answer` to a cancel request is done."""
        self._hold(answer, self._answers)

    def _hold(self, future: asyncio.Future[Any], among: set[asyncio.Future[Any]]) -> None:
        def done(future: asyncio.Future[Any]) -> None:
            among.discard(future)
            self._go_on()

        among.add(future)
        future.add_done_callback(done)

    def begin(self) -> None:
        """Destroy the entities with callbacks; the others follow in later stages."""
        self._begun = True
        self._destroy(EndStage.CALLBACKS)
        self._go_on()

    def _destroy(self, stage: EndStage) -> None:
        self._stage = stage + 1
        for entity in reversed(list(self._entities)):
            if entity._stage <= stage:
                entity.destroy()

    def _go_on(self) -> None:
        if not self._begun or self._running:
            return
        if self._stage == EndStage.GOALS:
            self._destroy(EndStage.GOALS)
        if self._stage == EndStage.LAST and not self._answers:
            self._destroy(EndStage.LAST)
            self._leave()

    async def wait(self) -> None:
        """Wait until everything has ended, at most `CALLBACKS_S` plus `ANSWERS_S`.

        Callbacks that take long to end are named in the log. Those still running after the limit
        are cancelled once more, and lose their publishers and clients.
        """
        logger = self._callbacks.logger
        if self._running:
            await asyncio.wait(set(self._running), timeout=NOTICE_S)
        if self._running:
            logger.warning(f"the node ends, and waits up to {CALLBACKS_S:g} s for {self._names()}")
            await asyncio.wait(set(self._running), timeout=CALLBACKS_S - NOTICE_S)
        if self._running:
            logger.error(
                f"the node ends without {self._names()}, which was told to end {CALLBACKS_S:g} s "
                "ago and has not; publishers and clients are destroyed now"
            )
            for task in list(self._running):
                task.cancel()
            self._running.clear()
            self._go_on()
        if self._answers:
            await asyncio.wait(set(self._answers), timeout=ANSWERS_S)
        if self._answers:
            logger.warning(
                f"the node ends, and requests to cancel goals were not answered in {ANSWERS_S:g} s"
            )
            self._answers.clear()
            self._go_on()

    def _names(self) -> str:
        return ", ".join(sorted(map(str, self._callbacks.waiting))) or "its callbacks"
