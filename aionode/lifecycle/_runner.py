"""Runs the transitions of one managed node, one at a time, always ending in a defined state.

Whatever the outcome of a transition, the node is in a primary state afterwards::

    the callback returns SUCCESS, FAILURE or ERROR    according to the table in `states`
    it returns anything else, or raises               as for ERROR, with the exception
    it is canceled: its task, `cancel`, a timeout     as for FAILURE, at once
    something that it awaits is canceled              as for ERROR, with `CallbackCancelledError`

ERROR leads through `errorprocessing`, in which `on_error` runs; if that is canceled or raises, the
node is finalized. Nothing is awaited between the end of a callback and the next state, so no
cancellation can intervene.
"""

from __future__ import annotations

import asyncio
import inspect
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from aionode._process.concurrency import is_cancelled_task
from aionode._process.tracebacks import traceback_text
from aionode.engine.rules.lifecycle_states import (
    ACTIVE,
    ERROR_PROCESSING,
    StateMachine,
    TransitionCallbackReturn,
)
from aionode.errors import CallbackCancelledError, TransitionError
from aionode.lifecycle._entities import enabled_of, settle_entities

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.rules.lifecycle_states import State, Transition
    from aionode.engine.rules.managed_entity import ManagedEntity
    from aionode.lifecycle._events import EventSource
    from aionode.logging import RcutilsLogger

__all__ = ["LifecycleEvent", "TransitionRunner"]

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE
ERROR = TransitionCallbackReturn.ERROR


@dataclass(frozen=True, slots=True)
class LifecycleEvent:
    """A state change or progress report of a managed node.

    Attributes:
        state: The state of the node now.
        start: The state it was in before; the same as `state` for progress.
        transition: Label of the transition that was requested.
        progress: The text the callback reported; empty for a state change.
        fraction: How much of the transition is done, from 0 to 1, if the callback reported it.
        error: The exception that made the transition fail.
    """

    state: State
    start: State
    transition: str
    progress: str = ""
    fraction: float | None = None
    error: Exception | None = None


class TransitionRunner:
    """The state of one node, and the transition in progress.

    Args:
        node: Full name of the node, for errors.
        logger: Logs exceptions of callbacks, with their traceback.
        callback: Returns the callback for the label of a transition, or for ``"error"``. It is
            called with the state and the exception, and may return an awaitable.
        publish: Called with the old and the new state at each change.
        events: Receives state changes and progress.

    Attributes:
        machine: The current state.
        entities: The managed entities, in the order in which they were added.
    """

    def __init__(
        self,
        node: str,
        logger: RcutilsLogger,
        callback: Callable[[str], Callable[[State, Exception | None], Any]],
        publish: Callable[[State, State], None],
        events: EventSource[LifecycleEvent],
    ) -> None:
        self.machine = StateMachine()
        self.entities: list[ManagedEntity] = []
        self._node = node
        self._logger = logger
        self._callback = callback
        self._publish = publish
        self._label = ""  # of the current transition, or of the last one
        self._error: Exception | None = None  # why it failed
        self._scope: asyncio.Timeout | None = None  # expires to cancel the running callback
        self._wanted = FAILURE  # the result of a callback that `cancel` cancels
        self._shutdowns_waiting = 0
        self._idle = asyncio.Event()  # set while no transition is in progress
        self._idle.set()
        self._events = events

    # Transitions

    async def trigger(self, label: str) -> TransitionCallbackReturn:
        """Make the transition `label`, and return the result of its callback.

        Raises:
            TransitionError: it is not available in this state, or the callback raised.
        """
        transition = self.find(label)
        if transition is None:
            available = ", ".join(self._available_labels()) or "none"
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

    def find(self, label: str = "", transition_id: int = 0) -> Transition | None:
        """Return an available transition, as `StateMachine.find` does.

        While a shutdown waits for a transition to end, nothing else is available: otherwise a
        caller that retries as soon as a transition fails would overtake the shutdown.
        """
        transition = self.machine.find(label, transition_id)
        return transition if transition and transition.label in self._available_labels() else None

    def _available_labels(self) -> list[str]:
        labels = [transition.label for transition in self.machine.available()]
        return [label for label in labels if label == "shutdown" or not self._shutdowns_waiting]

    async def make_way_for_shutdown(self) -> None:
        """Cancel the running callback, if any, as a failure, and wait until the node is idle."""
        self._shutdowns_waiting += 1
        try:
            self.cancel(FAILURE)
            await self.wait_idle()
        finally:
            self._shutdowns_waiting -= 1

    async def run(self, transition: Transition) -> TransitionCallbackReturn:
        """Make an available transition, and return the result of its callback.

        Cancelling cancels the callback, and the node enters the state to which a failure leads.
        """
        start = self.machine.state
        enabled = enabled_of(self.entities)
        self._label = transition.label
        self._error = None
        self._idle.clear()
        self._move(lambda: self.machine.begin(transition))
        try:
            result = await self._call(transition.label, start)
            if self.machine.state == ERROR_PROCESSING:
                await self._call("error", start)
        finally:
            is_active = self.machine.state == ACTIVE
            settle_entities(self.entities, enabled, start, is_active=is_active)
            self._idle.set()
        return result

    async def _call(self, name: str, start: State) -> TransitionCallbackReturn:
        """Run a callback, and move to the next state according to its result."""
        result = FAILURE
        self._wanted = FAILURE
        try:
            async with asyncio.timeout(None) as self._scope:
                returned = self._callback(name)(start, self._error)
                if inspect.isawaitable(returned):
                    returned = await returned
            result = self._checked(name, returned)
        except asyncio.CancelledError as lost:
            if is_cancelled_task():
                self._logger.warning(f"on_{name} was canceled")
                raise
            # Something that the callback awaited was cancelled, not this task.
            error = CallbackCancelledError(f"{self._node}: on_{name}")
            error.__cause__ = lost
            self._fail(name, error)
            result = ERROR
        except Exception as error:  # noqa: BLE001  # passed to the log, on_error and the caller
            if self._is_own_timeout(error):
                self._logger.warning(f"on_{name} was canceled by a request")
                result = self._wanted
            else:
                self._fail(name, error)
                result = ERROR
        finally:
            self._scope = None
            self._move(lambda: self.machine.finish(result))
        return result

    def _is_own_timeout(self, error: Exception) -> bool:
        """Whether `cancel` cancelled the callback, which then raised nothing else."""
        return (
            isinstance(error, TimeoutError)
            and isinstance(error.__cause__, asyncio.CancelledError)
            and self._scope is not None
            and self._scope.expired()
        )

    def _checked(self, name: str, returned: object) -> TransitionCallbackReturn:
        """Return the result of a callback; raise TypeError if it is not one."""
        if isinstance(returned, TransitionCallbackReturn):
            return returned
        raise TypeError(
            f"on_{name} returned {returned!r}; return TransitionCallbackReturn.SUCCESS, FAILURE "
            "or ERROR"
        )

    def _fail(self, name: str, error: Exception) -> None:
        self._logger.error(f"on_{name} failed:\n{traceback_text(error)}".rstrip())
        self._error = error

    def cancel(self, result: TransitionCallbackReturn) -> None:
        """Cancel the running callback, if any, and use `result` as its result.

        A callback that catches the cancellation and returns keeps its own result.
        """
        if self._scope is not None and not self._scope.expired():
            self._wanted = result
            self._scope.reschedule(0.0)  # in the past: takes effect in the loop's next iteration

    async def wait_idle(self) -> None:
        """Wait until no transition is in progress."""
        await self._idle.wait()

    # Events

    def _move(self, move: Callable[[], None]) -> None:
        start = self.machine.state
        move()
        state = self.machine.state
        self._publish(start, state)
        self._events.emit(LifecycleEvent(state, start, self._label, error=self._error))

    def report(self, progress: str, fraction: float | None) -> None:
        """Report the progress of a transition to readers of events."""
        state = self.machine.state
        self._events.emit(LifecycleEvent(state, state, self._label, progress, fraction))
