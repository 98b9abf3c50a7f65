"""One goal at the client that sent it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Coroutine
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Protocol, Self, TypeVar
from weakref import WeakSet

from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.stats import CallbackStats
from aionode.engine.causes import CAUSES, Run, take
from aionode.engine.rules.goal import GoalStatus
from aionode.message import Message

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.endpoints.client import Exchange
    from aionode.errors import GoalLostError

__all__ = ["ActionResult", "ClientGoalHandle"]

ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)
T = TypeVar("T")

KEPT_FEEDBACK = 100
"""Maximum feedback messages kept for the reader; the oldest is dropped first."""


@dataclass(frozen=True, slots=True)
class ActionResult(Generic[ResultT]):
    """How a goal ended.

    Attributes:
        status: ``SUCCEEDED``, ``CANCELED`` or ``ABORTED``; ``UNKNOWN`` if the server does not know
            the goal, or no longer does.
        result: The result message; an empty one if the server had none.
        error_text: Why the goal was aborted, or canceled by a server that had lost its client;
            empty if no reason was given, or if the server does not run aionode.
    """

    status: GoalStatus
    result: ResultT
    error_text: str = ""


class GoalClient(Protocol):
    """The methods of an `ActionClient` that its goal handles call; described there."""

    action_name: str
    _subject: str

    def _in_future(self, work: Coroutine[Any, Any, T]) -> asyncio.Future[T]: ...
    async def _awaiting(self, goal: Any, wait: Awaitable[T]) -> T: ...
    def _cancel_at_server(self, goal: Any) -> None: ...
    async def _request_cancel(self, goal: Any) -> Any: ...
    def _end_of_wait(self) -> BaseException: ...


class FeedbackIterator(AsyncIterator[FeedbackT]):
    """One loop over the feedback of a goal.

    The loop holds the only reference to it, and drops it on exit. So the goal knows of the loop
    even while the loop body runs, when no task is waiting for the goal.
    """

    def __init__(
        self,
        feedback: AsyncIterator[FeedbackT],
        iterations: WeakSet[FeedbackIterator[Any]],
    ) -> None:
        self._feedback = feedback
        iterations.add(self)

    async def __anext__(self) -> FeedbackT:
        """Wait for feedback: see `ClientGoalHandle`."""
        return await anext(self._feedback)


class ClientGoalHandle(AsyncIterator[FeedbackT], Generic[ResultT, FeedbackT]):
    """A goal that was sent. Created by `ActionClient.send_goal`.

    It is an async iterator of feedback: ``async for feedback in goal`` yields the feedback received
    since the goal was sent (the newest 100 messages are kept), then what follows, and ends when the
    goal ends.

    Cancelling a task that awaits the goal, in `result` or in the iteration, cancels the goal. So
    does destroying the client, or any end of its node, while a task awaits the goal. The cancel
    request is sent at once, and the wait ends without waiting for the answer. The request is
    repeated until the server has answered or is gone; nothing interrupts this, and the node waits
    up to 1 s for the answer before it ends. When the client is destroyed, waiting tasks of the node
    and the body of ``async with node`` get CancelledError. All other tasks get EntityDestroyedError
    (a RuntimeError), whose cause is the error that the node failed with, if any. To cancel only the
    wait, wrap `result` in ``asyncio.shield``. Leaving the iteration with ``break`` does not affect
    the goal, except within ``async with goal:``, which cancels the goal when it is left.

    Attributes:
        goal_id: Its id, as unique_identifier_msgs/msg/UUID.
        stamp: When the server accepted it, as builtin_interfaces/msg/Time.
        status: Its last known state.
        accepted: Whether the server accepted it; False only for handles of `send_goal_async`, since
            `send_goal` raises GoalRejectedError.
        reason: Why the server rejected it, if it runs aionode and said so; else empty.
    """

    def __init__(
        self,
        client: GoalClient,
        goal_id: Any,
        feedback_callback: Callable[[Any], Any] | None,
    ) -> None:
        self.goal_id = goal_id
        self._key = bytes(goal_id.uuid)
        self.stamp: Any = None
        self.status = GoalStatus.UNKNOWN
        self.accepted = False
        self.reason = ""
        self._feedback_callback = feedback_callback
        # The exchange that sends the goal, once started.
        self._sending: Exchange | None = None
        self._asking: Exchange | None = None  # the one that asks for the result, once started
        self._cancel_sent = False  # whether a cancel request is in progress
        self._cancel_requested = False  # whether this client ever sent one
        self._waiting = 0  # number of tasks waiting for the goal
        self._blocks = 0  # number of `async with` blocks it is bound to
        self._iterations: WeakSet[FeedbackIterator[Any]] = WeakSet()
        self._client = client
        self._feedback: MessageQueue[tuple[FeedbackT, tuple[Run, ...]]] = MessageQueue(
            KEPT_FEEDBACK, CallbackStats()
        )
        self._brought_by: tuple[Run, ...] = ()  # the response with its outcome
        self._outcome: ActionResult[ResultT] | None = None
        self._lost: GoalLostError | None = None
        self._ended = asyncio.Event()
        self._feedback_ended = asyncio.Event()

    def __repr__(self) -> str:
        return f"<ClientGoalHandle {self._client.action_name} {self.text} {self.status.name}>"

    @property
    def text(self) -> str:
        """The id in 32 hexadecimal digits."""
        return self._key.hex()

    @property
    def done(self) -> bool:
        """Whether the goal has ended, or was lost with its server."""
        return self._ended.is_set()

    @property
    def _has_server_ended(self) -> bool:
        """Whether the server has reported the end; a lost goal may still be running there."""
        return self._outcome is not None

    @property
    def _is_awaited(self) -> bool:
        """Whether the program awaits the goal, or is in a block or loop bound to it."""
        return self._waiting > 0 or self._blocks > 0 or len(self._iterations) > 0

    async def __aenter__(self) -> Self:
        """Bind the goal to a block: it is cancelled if it has not ended when the block is left.

        The block may be left by an exception, a cancellation, ``break`` or ``return``, or by
        closing an async generator around it, such as the response stream of a web server whose
        client has disconnected. The goal is cancelled as well if its client is destroyed meanwhile.
        """
        self._blocks += 1
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Cancel the goal if it has not ended, without waiting for the answer."""
        self._blocks -= 1
        if not self.done:
            self._client._cancel_at_server(self)

    # To await

    async def result(self) -> ActionResult[ResultT]:
        """Wait for the end of the goal, and return how it ended.

        Any number of tasks may wait; once the goal has ended, every call returns at once.
        Cancelling cancels the goal; see the class.

        Raises:
            GoalLostError: the server went away.
            CancelledError, EntityDestroyedError: the client was destroyed; see the class.
        """
        await self._client._awaiting(self, self._ended.wait())
        for run in self._brought_by:
            take(run)
        self._raise_if_lost()
        if self._outcome is None:
            raise self._client._end_of_wait()
        return self._outcome

    def __aiter__(self) -> AsyncIterator[FeedbackT]:  # noqa: PYI034  # one for each loop
        """Iterate over the feedback; while the loop runs, it counts as waiting for the goal.

        Raises:
            RuntimeError: the goal was sent with a `feedback_callback`, which gets the feedback.
        """
        if self._feedback_callback is not None:
            raise RuntimeError(
                f"{self._client.action_name}: goal {self.text}: its feedback_callback gets the "
                "feedback; to iterate over it, send the goal without one"
            )
        return FeedbackIterator(self, self._iterations)

    async def __anext__(self) -> FeedbackT:
        """Wait for feedback; each message goes to one reader.

        Raises:
            StopAsyncIteration: the goal has ended, and all feedback has been read.
            GoalLostError: the server went away.
            CancelledError, EntityDestroyedError: the client was destroyed; see the class.
        """
        while not self._feedback:
            if self._feedback_ended.is_set():
                self._raise_if_lost()
                if self._outcome is None:
                    raise self._client._end_of_wait()
                raise StopAsyncIteration
            await self._client._awaiting(self, self._feedback.wait())
        feedback, causes = self._feedback.pop()[1]
        for run in causes:
            take(run)
        return feedback

    def _raise_if_lost(self) -> None:
        if self._lost is not None:
            # A copy, since the traceback of an exception grows each time it is raised.
            lost = self._lost
            raise type(lost)(lost.action, lost.goal_id, lost.problem)

    async def cancel(self) -> Any:
        """Ask the server to cancel the goal, and return its answer.

        The goal has not ended by then and may still succeed: `result` returns its outcome. The
        request is repeated until the server has answered. Cancelling stops only the wait for the
        answer, not the request.

        Returns:
            An action_msgs/srv/CancelGoal response. Its ``return_code`` is 0 if the server agreed,
            1 if not, 2 if it does not know the goal, 3 if the goal had ended or was being
            cancelled.

        Raises:
            ServiceError: the server's cancel_callback failed, or the server went away.
            CancelledError, EntityDestroyedError: the client was destroyed; see the class.
        """
        return await self._client._request_cancel(self)

    # The names of rclpy

    def get_result_async(self) -> asyncio.Future[ActionResult[ResultT]]:
        """Return a future of the goal's outcome, as in rclpy: see `result`.

        Its ``result().status`` and ``result().result`` are as in rclpy's response. Cancelling
        the future cancels the goal.

        Raises:
            RuntimeError: no event loop is running.
        """
        return self._client._in_future(self.result())

    def cancel_goal_async(self) -> asyncio.Future[Any]:
        """Ask the server to cancel the goal, and return a future of its answer: see `cancel`.

        Raises:
            RuntimeError: no event loop is running.
        """
        return self._client._in_future(self.cancel())

    # Called by the client

    def _take(self, feedback: FeedbackT) -> None:
        """Queue `feedback` for the reader."""
        self._feedback.put((feedback, CAUSES.get()[:1]))

    def _update_status(self, status: GoalStatus) -> None:
        """Update the state from the status topic; late messages change nothing."""
        self.status = max(self.status, status)

    def _end(
        self,
        outcome: ActionResult[ResultT] | None = None,
        lost: GoalLostError | None = None,
    ) -> None:
        """Set the outcome; with neither argument, the client was destroyed."""
        if not self.done:
            self._outcome = outcome
            self._lost = lost
            if outcome is not None:
                self.status = outcome.status
            self._ended.set()
        if outcome is None:
            self._end_feedback()

    def _end_feedback(self) -> None:
        """End the iteration once all feedback is read, as no more will come."""
        self._feedback_ended.set()
        self._feedback.wake()

    async def _wait_for_feedback(self) -> None:
        """Wait until no more feedback will come."""
        await self._feedback_ended.wait()
