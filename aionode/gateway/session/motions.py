"""The motions of assistants in progress, so that `stop` can end them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from typing import TYPE_CHECKING

from aionode.clock import S_TO_NS
from aionode.fastapi import watching

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.session import Session

__all__ = ["Motion", "Motions"]


class Motion:
    """The motion that one call commands, until it ends.

    Attributes:
        verb: ``publish`` or ``goal``.
        name: The topic or action.
        type_name: The name of its type.
        identity: The client of the call.
        stopped_by: The name of the client that called `stop`; empty if none did.
        was_cut: Whether it was ended by `stop`, or by its time limit.
        ended: Set when it has ended, and its stop was sent.
    """

    def __init__(self, session: Session, verb: Verb, name: str, type_name: str) -> None:
        self.identity = session.identity
        self.verb = verb
        self.name = name
        self.type_name = type_name
        self.stopped_by = ""
        self.was_cut = False
        self.ended = asyncio.Event()
        self._session = session
        self._cut = asyncio.Event()
        self._began_ns = session.steady_ns()

    def end(self, by: str) -> None:
        """End the motion in the next iteration of the event loop."""
        self.stopped_by = by
        self._cut.set()

    @asynccontextmanager
    async def running(self, seconds: float) -> AsyncIterator[None]:
        """Leave the block after some seconds, or when the motion is ended."""
        self._began_ns = self._session.steady_ns()
        scope = asyncio.timeout(None)

        async def over() -> None:
            async with asyncio.TaskGroup() as tasks:
                waiting = [
                    tasks.create_task(self._cut.wait()),
                    tasks.create_task(self._session.robot.clock.sleep(seconds)),
                ]
                await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
                for task in waiting:
                    task.cancel()

        try:
            async with scope, watching(over, scope):
                yield
        except TimeoutError:
            if not scope.expired():
                raise
            self.was_cut = True

    def seconds(self) -> float:
        """Return how long it has lasted, in seconds."""
        return (self._session.steady_ns() - self._began_ns) / S_TO_NS

    def outcome(self, how: str) -> str:
        """Return how it ended, in words."""
        return f"stopped after {self.seconds():.1f} s: {how}"


class Motions:
    """The motions of the assistants of one robot."""

    def __init__(self) -> None:
        self._motions: dict[Motion, None] = {}

    def __iter__(self) -> Iterator[Motion]:
        """Iterate over the motions."""
        return iter(list(self._motions))

    @contextmanager
    def moving(self, session: Session, verb: Verb, name: str, type_name: str) -> Iterator[Motion]:
        """Register a motion for the duration of the block, so that `stop` can end it."""
        motion = Motion(session, verb, name, type_name)
        self._motions[motion] = None
        try:
            yield motion
        finally:
            del self._motions[motion]
            motion.ended.set()
