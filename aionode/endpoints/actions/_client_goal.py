"""One goal at the client that sent it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar

from aionode.endpoints._core.message_queue import MessageQueue
from aionode.endpoints.actions._goal import GoalStatus
from aionode.endpoints.stats import CallbackStats
from aionode.message import Message

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.endpoints.actions._client import ActionClient
    from aionode.endpoints.client import Exchange
    from aionode.errors import GoalLostError

__all__ = ["ActionResult", "ClientGoalHandle"]

ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)

KEPT_FEEDBACK = 100
"""How much feedback waits for a reader; the newest stays."""


@dataclass(frozen=True, slots=True)
class ActionResult(Generic[ResultT]):
    """How a goal ended.

    Attributes:
        status: ``SUCCEEDED``, ``CANCELED`` or ``ABORTED``; ``UNKNOWN`` if the server does not know
            the goal, or does not know it any more.
        result: The result message; an empty one where the server had none.
        error_text: Why the goal was aborted; empty if nobody said so, or if the server is not one
            of aionode.
    """

    status: GoalStatus
    result: ResultT
    error_text: str = ""


class ClientGoalHandle(AsyncIterator[FeedbackT], Generic[ResultT, FeedbackT]):
    """A goal that was sent. Made by `ActionClient.send_goal`.

    It is an async iterator of feedback: ``async for feedback in goal`` yields what has come since
    the goal was sent (the newest 100 are kept) and what comes, and ends when the goal has.

    Cancelling a task that awaits the goal, in `result` or in the iteration, cancels the goal. The
    request is sent at once, and CancelledError goes on without waiting for the answer; the request
    is sent again until the server has answered, or is gone, whatever is cancelled meanwhile. The
    node does not end before the answer, for up to 1 s. So does destroying the client, or its node,
    while a task awaits the goal. To give up only the wait, put ``asyncio.shield`` around `result`;
    leaving the iteration with ``break`` has no effect on the goal, unless it is in
    ``async with goal:``, which cancels the goal when it is left.

    Attributes:
        goal_id: Its id, as unique_identifier_msgs/msg/UUID.
        stamp: When the server accepted it, as builtin_interfaces/msg/Time.
        status: Its state, as far as the server has told.
        accepted: Whether the server accepted it; False only from `send_goal_async`, since
            `send_goal` raises GoalRejectedError.
    """

    def __init__(
        self,
        client: ActionClient[Any, ResultT, FeedbackT],
        goal_id: Any,
        feedback_callback: Callable[[Any], Any] | None,
    ) -> None:
        self.goal_id = goal_id
        self.stamp: Any = None
        self.status = GoalStatus.UNKNOWN
        self.accepted = False
        self.feedback_callback = feedback_callback
        self.sending: Exchange | None = None
        self.withdrawn = False
        self.waiting = 0
        self._client = client
        self._feedback: MessageQueue[FeedbackT] = MessageQueue(KEPT_FEEDBACK, CallbackStats())
        self._outcome: ActionResult[ResultT] | None = None
        self._lost: GoalLostError | None = None
        self._ended = asyncio.Event()
        self._heard_out = asyncio.Event()

    def __repr__(self) -> str:
        return f"<ClientGoalHandle {self._client.action_name} {self.text} {self.status.name}>"

    @property
    def text(self) -> str:
        """The id in 32 hexadecimal digits."""
        return self.key.hex()

    @property
    def key(self) -> bytes:
        """The id in 16 bytes."""
        return bytes(self.goal_id.uuid)

    @property
    def done(self) -> bool:
        """Whether it is known how the goal ended."""
        return self._ended.is_set()

    @property
    def is_known_to_have_ended(self) -> bool:
        """Whether the server has told how the goal ended; one that was lost may go on there."""
        return self._outcome is not None

    async def __aenter__(self) -> Self:
        """Bind the goal to a block: one that has not ended when the block is left is cancelled.

        However it is left: by an exception, a cancellation, ``break`` or ``return``, or by the end
        of an async generator around it, such as the stream of a web server whose client has gone.
        """
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Cancel the goal if it has not ended, without waiting for the answer."""
        if not self.done:
            self._client.withdraw(self)

    # What a caller awaits

    async def result(self) -> ActionResult[ResultT]:
        """Wait for the end of the goal, and return how it ended.

        Any number of tasks may wait, and later calls return the same at once. Cancelling cancels
        the goal, see the class.

        Raises:
            GoalLostError: the server went away.
            CancelledError: the client was destroyed.
        """
        await self._client.awaiting(self, self._ended.wait())
        self._raise_if_lost()
        if self._outcome is None:
            raise asyncio.CancelledError(f"{self._client.subject}: destroyed")
        return self._outcome

    def __aiter__(self) -> Self:
        """Iterate over the feedback.

        Raises:
            RuntimeError: the goal was sent with a `feedback_callback`, which gets it.
        """
        if self.feedback_callback is not None:
            raise RuntimeError(
                f"{self._client.action_name}: goal {self.text}: its feedback_callback gets the "
                "feedback; to iterate over it, send the goal without one"
            )
        return self

    async def __anext__(self) -> FeedbackT:
        """Wait for feedback; each goes to one reader.

        Raises:
            StopAsyncIteration: the goal has ended, and all feedback was read.
            GoalLostError: the server went away.
            CancelledError: the client was destroyed.
        """
        while not self._feedback:
            if self._heard_out.is_set():
                self._raise_if_lost()
                if self._outcome is None:
                    raise asyncio.CancelledError(f"{self._client.subject}: destroyed")
                raise StopAsyncIteration
            await self._client.awaiting(self, self._feedback.wait())
        return self._feedback.pop()[1]

    def _raise_if_lost(self) -> None:
        if self._lost is not None:
            # A copy, because the traceback of an exception grows each time that it is raised.
            lost = self._lost
            raise type(lost)(lost.action, lost.goal_id, lost.problem)

    async def cancel(self) -> Any:
        """Ask the server to cancel the goal, and return its answer.

        The goal has not ended then, and may still succeed: `result` tells. The request is sent
        again until the server has answered. Cancelling gives up the answer, not the request.

        Returns:
            An action_msgs/srv/CancelGoal response: ``return_code`` is 0 if the server agreed, 1 if
            not, 2 if it does not know the goal, 3 if the goal had ended or was being cancelled.

        Raises:
            ServiceError: the server's cancel_callback failed, or the server went away.
            EntityDestroyedError: the client was destroyed (a RuntimeError).
        """
        return await self._client.cancel_goal(self)

    # The names of rclpy

    def get_result_async(self) -> asyncio.Future[ActionResult[ResultT]]:
        """Return how the goal ends as a future, as in rclpy: see `result`.

        Its ``result().status`` and ``result().result`` are those of rclpy's response. Cancelling
        the future cancels the goal.

        Raises:
            RuntimeError: no event loop runs.
        """
        return self._client.in_future(self.result())

    def cancel_goal_async(self) -> asyncio.Future[Any]:
        """Ask the server to cancel the goal; return its answer as a future, see `cancel`.

        Raises:
            RuntimeError: no event loop runs.
        """
        return self._client.in_future(self.cancel())

    # What the client does

    def take(self, feedback: FeedbackT) -> None:
        """Keep `feedback` for a reader."""
        self._feedback.put(feedback)

    def tell(self, status: GoalStatus) -> None:
        """Take what the status topic tells; news that come late change nothing."""
        self.status = max(self.status, status)

    def end(
        self,
        outcome: ActionResult[ResultT] | None = None,
        lost: GoalLostError | None = None,
    ) -> None:
        """Take how the goal ended; neither means that the client was destroyed."""
        if not self.done:
            self._outcome = outcome
            self._lost = lost
            if outcome is not None:
                self.status = outcome.status
            self._ended.set()
        if outcome is None:
            self.end_feedback()

    def end_feedback(self) -> None:
        """End the iteration: no feedback will come any more."""
        self._heard_out.set()
        self._feedback.wake()

    async def heard_out(self) -> None:
        """Wait until no feedback will come any more."""
        await self._heard_out.wait()
