"""One goal at the server that executes it: its feedback, cancellation and end."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from aionode.engine.causes import CAUSES, Run
from aionode.engine.rules.goal import TRANSITIONS, GoalEvent, GoalKey, GoalStatus, next_status
from aionode.errors import GoalTransitionError
from aionode.message import Message

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["ServerGoalHandle"]

GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)

NO_END_TEXT = "execute_callback returned without calling succeed(), abort() or canceled()"
STOPPED_TEXT = "the action server stopped"


class GoalServer(Protocol):
    """The methods of an `ActionServer` that its goal handles call; described there."""

    action_name: str
    destroyed: bool
    _checked_result: Callable[[Any], Any]

    def _in_loop(self, action: Callable[..., None], *args: Any) -> None: ...
    def _enqueue(self, goal: Any, execute_callback: Callable[..., Any] | None) -> None: ...
    def _publish_feedback(self, goal: Any, feedback: Any) -> None: ...
    def _publish_status(self) -> None: ...
    def _warn(self, text: str) -> None: ...
    def _keep(self, goal: Any) -> None: ...


class ServerGoalHandle(Generic[GoalT, ResultT, FeedbackT]):
    """A goal accepted by an action server, as passed to its callbacks.

    An `execute_callback` that runs in a thread (``offload=True``) may use it there.

    Attributes:
        request: The goal message.
        status: The state of the goal.
        info: Id and time of acceptance, as action_msgs/msg/GoalInfo.
    """

    def __init__(
        self,
        server: GoalServer,
        request: GoalT,
        info: Any,
        key: GoalKey,
    ) -> None:
        self.request = request
        self.info = info
        self.status = GoalStatus.ACCEPTED
        self._key = key
        self._server = server
        self._queued = False
        self._running = False
        self._task: asyncio.Task[Any] | None = None
        self._result: ResultT | None = None
        self._error_text = ""  # the reason if it was aborted
        self._cancel_text = ""  # the reason if the server cancels it on its own
        self._known = asyncio.Event()
        self._asked_by: tuple[Run, ...] = ()  # the request that brought it
        self._run: Run | None = None  # its execution

    def __repr__(self) -> str:
        return f"<ServerGoalHandle {self._server.action_name} {self.text} {self.status.name}>"

    @property
    def goal_id(self) -> Any:
        """The id that the client chose, as unique_identifier_msgs/msg/UUID."""
        return self.info.goal_id

    @property
    def text(self) -> str:
        """The id in 32 hexadecimal digits."""
        return self._key.goal_id.hex()

    @property
    def _current_key(self) -> GoalKey:
        """The properties by which cancel requests select this goal."""
        return self._key._replace(status=self.status)

    @property
    def is_active(self) -> bool:
        """Whether the goal has not ended yet."""
        return self.status.is_active

    @property
    def is_cancel_requested(self) -> bool:
        """Whether the goal should be cancelled.

        `cancel_callback` has accepted a request, or the server has lost the goal's client.
        """
        return self.status is GoalStatus.CANCELING

    # For callbacks

    def execute(self, execute_callback: Callable[..., Any] | None = None) -> None:
        """Execute the goal as soon as `concurrent` allows it.

        To be called by `handle_accepted_callback`, now or later; without that callback, goals are
        executed at once.

        Args:
            execute_callback: Called instead of the server's own.

        Raises:
            GoalTransitionError: it is already being executed, or has ended (a RuntimeError).
        """
        self._server._in_loop(self._execute, execute_callback)

    def _execute(self, execute_callback: Callable[..., Any] | None) -> None:
        if self._server.destroyed:
            return
        if self._queued or not self.is_active:
            raise GoalTransitionError(self.text, self.status.name, GoalEvent.EXECUTE.name, [])
        self._queued = True
        self._server._enqueue(self, execute_callback)

    def publish_feedback(self, feedback: FeedbackT) -> None:
        """Send progress of the goal to its client; never blocks the event loop.

        Raises:
            TypeError: `feedback` is not of the action's Feedback type.
            MessageError: a value does not fit its field.
        """
        self._server._in_loop(self._server._publish_feedback, self, feedback)

    def succeed(self, result: ResultT | None = None) -> None:
        """End the goal as SUCCEEDED.

        Args:
            result: The result for the client; if omitted, the one that `execute_callback` returns.

        Raises:
            GoalTransitionError: the goal is not being executed, or has ended (a RuntimeError).
            TypeError: `result` is not of the action's Result type.
            MessageError: a value does not fit its field.
        """
        self._server._in_loop(self._end, GoalEvent.SUCCEED, result)

    def abort(self, result: ResultT | None = None, *, error_text: str = "") -> None:
        """End the goal as ABORTED. See `succeed` for `result` and the errors.

        Args:
            result: The result for the client; if omitted, the one that `execute_callback` returns.
            error_text: The reason, which reaches clients that run aionode.
        """
        self._server._in_loop(self._end, GoalEvent.ABORT, result, error_text)

    def canceled(self, result: ResultT | None = None) -> None:
        """End the goal as CANCELED, which is possible only after an accepted cancel request.

        See `succeed` for `result` and the errors.
        """
        self._server._in_loop(self._end, GoalEvent.CANCELED, result)

    def _end(self, event: GoalEvent, result: ResultT | None, error_text: str = "") -> None:
        if self._server.destroyed:
            # No client can be told any more, but that should not fail a callback that cleans up.
            self.status = TRANSITIONS.get((self.status, event), self.status)
            return
        checked = None if result is None else self._server._checked_result(result)
        self._move(event)
        self._error_text = error_text
        if checked is not None or not self._running:
            self._set_result(checked)

    # For the server

    def _move(self, event: GoalEvent) -> None:
        """Change the state, and publish it.

        Raises:
            GoalTransitionError: `TRANSITIONS` does not allow it.
        """
        self.status = next_status(self.status, event, self.text)
        self._server._publish_status()

    def _begin(self) -> None:
        """Mark the goal as executing, as its callback is about to be called."""
        self._running = True
        if not self.is_cancel_requested:
            self._move(GoalEvent.EXECUTE)

    def _run_in(self, task: asyncio.Task[Any] | None) -> None:
        """Set the task that a cancel request cancels; if there was one already, cancel it.

        In that case the callback runs until its first await, so that it can clean up.
        """
        self._task = task
        if task is not None and self.is_cancel_requested:
            task.cancel()

    @property
    def _end_text(self) -> str:
        """Why it was aborted, or canceled without a request; empty if unknown."""
        return self._cancel_text if self.status is GoalStatus.CANCELED else self._error_text

    def _cancel(self, text: str = "") -> None:
        """Cancel the goal: a request was accepted, or the server does so for the reason `text`."""
        self._cancel_text = text
        if self._run is not None:
            for run in CAUSES.get()[:1]:
                self._run.share(run, None)
        self._move(GoalEvent.CANCEL_GOAL)
        if self._task is not None:
            self._task.cancel(text or None)
        elif self._queued and not self._running:
            self._stopped()  # its callback has not started, so there is nothing to clean up

    def _returned(self, result: ResultT | None) -> None:
        """Handle the result that the callback returned.

        Raises:
            TypeError: it is not of the action's Result type.
            MessageError: a value does not fit its field.
        """
        checked = None if result is None else self._server._checked_result(result)
        if self.is_active:
            self._server._warn(f"goal {self.text}: {NO_END_TEXT}; it counts as aborted")
            self._error_text = NO_END_TEXT
            self._move(GoalEvent.ABORT)
        elif checked is None and not self._known.is_set():
            self._server._warn(
                f"goal {self.text}: execute_callback returned no result, so the client gets an "
                "empty one; `return` a Result, or give it to succeed()"
            )
        self._set_result(checked)

    def _failed(self, error: BaseException) -> None:
        """Handle an exception of the callback: abort the goal, unless it has already ended."""
        if self.is_active:
            self._error_text = f"{type(error).__name__}: {error}"
            if self.status is GoalStatus.ACCEPTED:
                self._move(GoalEvent.EXECUTE)
            self._move(GoalEvent.ABORT)
        self._set_result(None)

    def _stopped(self) -> None:
        """End the goal, as its callback was cancelled, on request or because the server stops."""
        if self.status is GoalStatus.CANCELING:
            self._move(GoalEvent.CANCELED)
        elif self.is_active:
            self._error_text = STOPPED_TEXT
            if self.status is GoalStatus.ACCEPTED:
                self._move(GoalEvent.EXECUTE)
            self._move(GoalEvent.ABORT)
        self._set_result(None)

    def _set_result(self, result: ResultT | None) -> None:
        """Set the result, once; None becomes an empty message at the client."""
        self._running = False
        self._task = None
        if not self._known.is_set():
            self._result = result
            self._known.set()
            self._server._keep(self)
