"""The end of a node, step by step: callbacks first, and last what they may still need."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode.endpoints._core.entity import EndStage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.endpoints._core.callback_runner import Callbacks
    from aionode.endpoints._core.entity import Entity

__all__ = ["Ending"]

NOTICE_S = 0.3
"""After how long the log says what the end of a node waits for, in seconds of the machine."""

CALLBACKS_S = 5.0
"""How long the end of a node waits for its callbacks."""

ANSWERS_S = 1.0
"""How long it waits for the servers whose goals it cancels."""


class Ending:
    """Ends a node so that its callbacks can clean up.

    Whatever calls callbacks is destroyed at once, and the callbacks are cancelled. Publishers,
    clients and the clock live until these have ended: a robot is stopped in ``finally``.

    Args:
        entities: Those of the node, in the order of their creation; a destroyed one leaves them.
        callbacks: How they are run; knows those that have not ended.
        leave: Called when everything is destroyed; ends what belongs to the node itself.
    """

    def __init__(
        self, entities: Iterable[Entity], callbacks: Callbacks, leave: Callable[[], None]
    ) -> None:
        self._entities = entities
        self._callbacks = callbacks
        self._leave = leave
        self._stage = 0
        self._begun = False
        self._running: set[asyncio.Future[Any]] = set()
        self._answers: set[asyncio.Future[Any]] = set()

    def watch(self, task: asyncio.Task[None]) -> None:
        """Do not go on from the first step before `task` is done: it runs callbacks."""
        self._hold(task, self._running)

    def expect(self, answer: asyncio.Future[Any]) -> None:
        """Do not destroy clients before `answer` is done: it is that of a request to stop."""
        self._hold(answer, self._answers)

    def _hold(self, future: asyncio.Future[Any], among: set[asyncio.Future[Any]]) -> None:
        def done(future: asyncio.Future[Any]) -> None:
            among.discard(future)
            self._go_on()

        among.add(future)
        future.add_done_callback(done)

    def begin(self) -> None:
        """Destroy what calls callbacks; what is left follows as soon as it may."""
        self._begun = True
        self._destroy(EndStage.CALLBACKS)
        self._go_on()

    def _destroy(self, stage: EndStage) -> None:
        self._stage = stage + 1
        for entity in reversed(list(self._entities)):
            if entity.stage <= stage:
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
        """Return when everything has ended, after some seconds at most.

        What it waits for long is named in the log. What has not ended then is cancelled once more,
        and loses its publishers and clients.
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
