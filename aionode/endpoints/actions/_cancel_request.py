"""Cancel a goal at its server, independently of the task that asked for it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode._process.later import Later
from aionode._process.restart import doubled
from aionode.endpoints.actions.common import uuid_message
from aionode.engine.rules.goal import CancelCode, lost_id
from aionode.errors import EntityDestroyedError, ServiceError, ServiceUnavailableError

if TYPE_CHECKING:
    from aionode.endpoints.actions.client_goal import ClientGoalHandle
    from aionode.endpoints.client import Client, Exchange
    from aionode.logging import RcutilsLogger

__all__ = ["CancelRequest", "is_rejected", "warner"]

FIRST_RETRY_S = 0.1
MAX_RETRY_S = 5.0
ATTEMPTS = 14
"""Maximum number of requests, sent within 45 s; after that only answers are awaited."""


class CancelRequest:
    """A request to cancel a goal, sent at once and repeated until the server has answered.

    It runs in callbacks of the loop rather than a task, so that no cancellation can stop it. If the
    server has not yet accepted the goal, the request is repeated until it has decided. It also ends
    when the goal has ended. A server that goes away may come back until all attempts are used up.

    Args:
        client: The client of the server's cancel service.
        goal: The goal.
        on_end: Called soon after the end, when nothing is sent any more.
        lost: Whether the goal was sent on behalf of a client that is lost. A server that rejects
            the request is then told so; see `lost_id`.

    Attributes:
        answer: The server's answer, or the error in its place; ServiceUnavailableError as soon as
            no server is matched. Cancelled when the client is destroyed.
    """

    def __init__(
        self,
        client: Client[Any, Any],
        goal: ClientGoalHandle[Any, Any],
        on_end: Callable[[CancelRequest], None],
        *,
        lost: bool = False,
    ) -> None:
        self._loop = asyncio.get_running_loop()
        self.answer: asyncio.Future[Any] = self._loop.create_future()
        # Retrieve the exception, so that asyncio does not report it.
        self.answer.add_done_callback(lambda done: done.cancelled() or done.exception())
        self._client = client
        self._goal = goal
        self._on_end = on_end
        self._is_lost = lost
        self._rejection: Any = None  # its first answer, if it was then told of the loss
        self._request = client.srv_type.Request()
        self._request.goal_info.goal_id = goal.goal_id
        self._attempts = 0
        self._later = Later()
        self._exchanges: list[Exchange] = []
        self._ended = False
        if goal._sending is not None and not goal._sending.answer.done():
            goal._sending.answer.add_done_callback(self._decided)
        self._send()

    def _send(self) -> None:
        """Send the request, and schedule the next one."""
        if self._ended or self._attempts == ATTEMPTS:
            return
        if self._client.destroyed:
            self.end()
            return
        if self._goal._has_server_ended:
            response = self._client.srv_type.Response(return_code=CancelCode.GOAL_TERMINATED)
            self._take_response(response)
            return
        self._later.call(doubled(FIRST_RETRY_S, self._attempts, MAX_RETRY_S), self._send)
        self._attempts += 1
        if self._client.service_is_ready():
            exchange = self._client._begin(self._request)
            self._exchanges.append(exchange)
            exchange.answer.add_done_callback(
                partial(self._take, self._request, self._is_decided())
            )
        else:
            self._fail(ServiceUnavailableError(self._client.srv_name))

    def _take(self, request: Any, decided: bool, answer: asyncio.Future[Any]) -> None:
        """Take the answer to one request.

        It is final if the server had `decided` on the goal when the request was sent; otherwise the
        server may have received the request before it knew the goal.
        """
        if self._ended or request is not self._request:
            return
        error = answer.exception()
        if isinstance(error, EntityDestroyedError):  # the client
            self.end()
        elif isinstance(error, ServiceUnavailableError):
            if not self._client.service_is_ready():
                self._fail(error)
        elif error is not None and self._is_lost:  # the callback failed without a decision
            rejected = self._client.srv_type.Response(return_code=CancelCode.REJECTED)
            self._take_response(rejected)
        elif error is not None:
            self._fail(error)
            self.end()
        elif decided or answer.result().return_code != CancelCode.UNKNOWN_GOAL_ID:
            self._take_response(answer.result())

    def _is_decided(self) -> bool:
        """Return whether the server has accepted or rejected the goal."""
        return self._goal._sending is None or self._goal._sending.answer.done()

    def _decided(self, decision: asyncio.Future[Any]) -> None:
        """Send the request again if the goal has now been accepted; end if it was rejected."""
        if self._ended or decision.cancelled():
            return
        error = decision.exception()
        if isinstance(error, ServiceUnavailableError | EntityDestroyedError):
            return  # the goal may have been accepted and the answer lost
        if error is None and decision.result().accepted:
            self._later.cancel()
            self._attempts = 0
            self._send()
        else:
            unknown = self._client.srv_type.Response(return_code=CancelCode.UNKNOWN_GOAL_ID)
            self._take_response(unknown)

    def _take_response(self, response: Any) -> None:
        if response.return_code == CancelCode.NONE and not response.goals_canceling:
            response.return_code = int(CancelCode.REJECTED)  # rclpy's server rejects like this
        if self._is_lost and response.return_code == CancelCode.REJECTED:
            self._tell_lost(response)
            return
        if self._rejection is not None and response.return_code == CancelCode.UNKNOWN_GOAL_ID:
            response = self._rejection  # it does not support losses
        if not self.answer.done():
            self.answer.set_result(response)
        self.end()

    def _tell_lost(self, rejection: Any) -> None:
        """Ask once more, with the id that says that nobody wants the goal any more."""
        self._is_lost, self._rejection = False, rejection
        self._request = self._client.srv_type.Request()
        self._request.goal_info.goal_id = uuid_message(lost_id(self._goal._key))
        exchanges, self._exchanges = self._exchanges, []
        for exchange in exchanges:
            exchange.cancel()
        self._later.cancel()
        self._attempts = 0
        self._send()

    def _fail(self, error: BaseException) -> None:
        if not self.answer.done():
            self.answer.set_exception(error)

    def end_with_answer(self) -> None:
        """End with the first answer or error: the client is being destroyed."""
        self.answer.add_done_callback(lambda _: self.end())

    def end(self) -> None:
        """Stop sending, and drop the open requests."""
        if self._ended:
            return
        self._ended = True
        self._later.cancel()
        for exchange in self._exchanges:
            exchange.cancel()
        if self._goal._sending is not None:
            self._goal._sending.cancel()
        self.answer.cancel()
        self._loop.call_soon(self._on_end, self)


def is_rejected(answer: asyncio.Future[Any]) -> bool:
    """Return whether the server rejected a cancel request, or its callback failed."""
    if answer.cancelled():
        return False
    error = answer.exception()
    if error is not None:
        return isinstance(error, ServiceError) and not isinstance(error, ServiceUnavailableError)
    return bool(answer.result().return_code == CancelCode.REJECTED)


def warner(logger: RcutilsLogger, subject: str) -> Callable[[str], None]:
    """Return a function that logs that an abandoned goal, given by its id, goes on."""

    def tell_goes_on(goal_id: str) -> None:
        logger.warning(
            f"{subject}: goal {goal_id}: cancel was rejected: the goal goes on; give its server a "
            "cancel_callback that accepts"
        )

    return tell_goes_on
