"""Runs the transitions of one managed node: one at a time, awaited, and always to a defined state.

However a transition ends, the node is in a primary state afterwards::

    the callback returns SUCCESS, FAILURE or ERROR    as the table of `states` says
    it returns anything else, or raises               as ERROR, with the exception
    it is canceled: its task, `cancel`, a timeout     as FAILURE, at once

ERROR leads through `errorprocessing`, in which `on_error` runs; whatever ends that early counts as
its failure, and the node is finalized. Between the end of a callback and the next state nothing is
awaited, so that no cancellation can come in between.
"""

from __future__ import annotations

import asyncio
import inspect
import traceback
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from aionode.errors import TransitionError
from aionode.lifecycle._managed import SimpleManagedEntity
from aionode.lifecycle._states import (
    ACTIVE,
    ERROR_PROCESSING,
    StateMachine,
    TransitionCallbackReturn,
)

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

    from aionode.lifecycle._managed import ManagedEntity
    from aionode.lifecycle._states import State, Transition
    from aionode.logging import RcutilsLogger

__all__ = ["LifecycleEvent", "TransitionRunner"]

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE
ERROR = TransitionCallbackReturn.ERROR

KEPT_EVENTS = 100
"""How many events wait for a slow reader; one more pushes out the oldest."""


@dataclass(frozen=True, slots=True)
class LifecycleEvent:
    """Something that happened to a managed node.

    Attributes:
        state: The state of the node now.
        start: The state it was in before; the same as `state` for progress.
        transition: Label of the transition that was requested.
        progress: What the callback reported; empty for a change of state.
        fraction: How much of the transition is done, from 0 to 1, if the callback said so.
        error: The exception that made the transition fail.
    """

    state: State
    start: State
    transition: str
    progress: str = ""
    fraction: float | None = None
    error: Exception | None = None


class TransitionRunner:
    """The state of one node, and the transition under way.

    Args:
        node: Full name of the node, for errors.
        logger: Where exceptions of callbacks go, with their traceback.
        callback: Returns what to call for a transition, given its label, or ``"error"``; it takes
            the state and the exception, and may return an awaitable.
        publish: Called with the old and the new state at each change.

    Attributes:
        machine: The state.
        entities: The managed entities, in the order in which they were added.
    """

    def __init__(
        self,
        node: str,
        logger: RcutilsLogger,
        callback: Callable[[str], Callable[[State, Exception | None], Any]],
        publish: Callable[[State, State], None],
    ) -> None:
        self.machine = StateMachine()
        self.entities: list[ManagedEntity] = []
        self._node = node
        self._logger = logger
        self._callback = callback
        self._publish = publish
        self._label = ""
        self._error: Exception | None = None
        # The callback that runs, and the result that whoever cancels it wants.
        self._scope: asyncio.Timeout | None = None
        self._wanted = FAILURE
        self._idle = asyncio.Event()
        self._idle.set()
        self._readers: set[EventQueue] = set()

    # Transitions

    async def trigger(self, label: str) -> TransitionCallbackReturn:
        """Make the transition `label`, and return the result of its callback.

        Raises:
            TransitionError: it is not available in this state, or the callback raised.
        """
        transition = self.machine.find(label)
        if transition is None:
            available = ", ".join(one.label for one in self.machine.available()) or "none"
            raise TransitionError(
                self._node, label, str(self.machine.state), f"available are: {available}"
            )
        result = await self.run(transition)
        if self._error is not None:
            error = self._error
            raise TransitionError(
                self._node, label, str(self.machine.state), f"{type(error).__name__}: {error}"
            ) from error
        return result

    async def run(self, transition: Transition) -> TransitionCallbackReturn:
        """Make an available transition, and return the result of its callback.

        Cancelling ends the callback, and the node is where a failure leads.
        """
        start = self.machine.state
        enabled = self._enabled()
        self._label = transition.label
        self._error = None
        self._idle.clear()
        self._move(lambda: self.machine.begin(transition))
        try:
            result = await self._call(transition.label, start)
            if self.machine.state == ERROR_PROCESSING:
                await self._call("error", start)
        finally:
            self._settle_entities(start, enabled)
            self._idle.set()
        return result

    async def _call(self, name: str, start: State) -> TransitionCallbackReturn:
        """Run a callback, and leave the transition state as its result says."""
        result = FAILURE
        self._wanted = FAILURE
        try:
            async with asyncio.timeout(None) as self._scope:
                returned = self._callback(name)(start, self._error)
                if inspect.isawaitable(returned):
                    returned = await returned
            result = self._checked(name, returned)
        except asyncio.CancelledError:
            self._logger.warning(f"on_{name} was canceled")
            raise
        except Exception as error:  # noqa: BLE001  # goes to the log, to on_error and to the caller
            if self._scope is not None and self._scope.expired():
                self._logger.warning(f"on_{name} was canceled by a request")
                result = self._wanted
            else:
                self._fail(name, error)
                result = ERROR
        finally:
            self._scope = None
            self._move(lambda: self.machine.finish(result))
        return result

    def _checked(self, name: str, returned: object) -> TransitionCallbackReturn:
        """Return what a callback returned, if it is a result."""
        if isinstance(returned, TransitionCallbackReturn):
            return returned
        raise TypeError(
            f"on_{name} returned {returned!r}; return TransitionCallbackReturn.SUCCESS, FAILURE "
            "or ERROR"
        )

    def _fail(self, name: str, error: Exception) -> None:
        self._logger.error(
            f"on_{name} failed:\n{''.join(traceback.format_exception(error))}".rstrip()
        )
        self._error = error

    def cancel(self, result: TransitionCallbackReturn) -> None:
        """Cancel the callback that runs, with a result in place of its own; else do nothing.

        A callback that catches the cancellation and returns has its own result.
        """
        if self._scope is not None and not self._scope.expired():
            self._wanted = result
            self._scope.reschedule(0.0)  # the past: at the next turn of the loop

    async def wait_idle(self) -> None:
        """Wait until no transition is under way."""
        await self._idle.wait()

    # Entities

    def _enabled(self) -> list[SimpleManagedEntity]:
        return [
            entity
            for entity in self.entities
            if isinstance(entity, SimpleManagedEntity) and entity.is_activated
        ]

    def _settle_entities(self, start: State, enabled: list[SimpleManagedEntity]) -> None:
        """Let entities be enabled in the active state only, however the transition ended."""
        if self.machine.state != ACTIVE:
            for entity in reversed(self._enabled()):
                entity.on_deactivate(start)
        elif start == ACTIVE:  # a deactivation that failed half-way
            for entity in enabled:
                if not entity.is_activated:
                    entity.on_activate(start)

    # Events

    def _move(self, move: Callable[[], None]) -> None:
        start = self.machine.state
        move()
        state = self.machine.state
        self._publish(start, state)
        self._tell(LifecycleEvent(state, start, self._label, error=self._error))

    def report(self, progress: str, fraction: float | None) -> None:
        """Tell readers of events how far a transition is."""
        state = self.machine.state
        self._tell(LifecycleEvent(state, state, self._label, progress, fraction))

    def _tell(self, event: LifecycleEvent) -> None:
        for reader in self._readers:
            reader.put(event)

    async def events(self) -> AsyncIterator[LifecycleEvent]:
        """Iterate over what happens from the first step of the iteration on."""
        reader = EventQueue()
        self._readers.add(reader)
        try:
            while True:
                yield await reader.get()
        finally:
            self._readers.discard(reader)


class EventQueue:
    """Events for one reader; a full queue drops its oldest."""

    def __init__(self) -> None:
        self._events: deque[LifecycleEvent] = deque(maxlen=KEPT_EVENTS)
        self._filled = asyncio.Event()

    def put(self, event: LifecycleEvent) -> None:
        """Add an event."""
        self._events.append(event)
        self._filled.set()

    async def get(self) -> LifecycleEvent:
        """Wait for the next event and take it."""
        while not self._events:
            self._filled.clear()
            await self._filled.wait()
        return self._events.popleft()
