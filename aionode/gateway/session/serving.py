"""Services and actions that a client offers to the robot."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any

from aionode.gateway.session.messages import as_message

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = ["Served", "serve", "serve_action"]


class Served:
    """A service or action that a client offers; `close` ends it.

    Calls in progress then get an error, and goals in progress are aborted.
    """

    def __init__(self, entity: Any) -> None:
        self._entity = entity
        self.on_close: Callable[[], object] = bool

    def close(self) -> None:
        """End the offer."""
        self._entity.destroy()
        self.on_close()


def serve(
    node: Node, service: str, cls: Any, answer: Callable[[Any], Awaitable[Any]], limit: int
) -> Served:
    """Offer a service whose requests are answered by `answer`, with a concurrency limit."""

    async def handle(request: Any) -> Any:
        return as_message(cls.Response, await answer(request), node.get_clock())

    # The caller gets the error; it is the client's, and does not belong in the robot's log.
    service_server = node.create_service(cls, service, handle, concurrent=limit, on_error=ignore)
    return Served(service_server)


def serve_action(
    node: Node, action: str, cls: Any, execute: Callable[[Any], Awaitable[Any]], limit: int
) -> Served:
    """Offer an action whose goals `execute` executes, with a concurrency limit."""
    from aionode.action import ActionServer, CancelResponse  # few clients offer actions

    async def run(goal: Any) -> Any:
        try:
            return as_message(cls.Result, await execute(goal), node.get_clock())
        except asyncio.CancelledError:
            raise
        except Exception as error:  # noqa: BLE001  # of the client: the goal's client is told
            goal.abort(error_text=str(error))
            return cls.Result()

    action_server = ActionServer(
        node,
        cls,
        action,
        run,
        cancel_callback=lambda _: CancelResponse.ACCEPT,
        max_goals=limit,
        concurrent=True,
        on_error=ignore,
    )
    return Served(action_server)


def ignore(error: Exception, context: object) -> None:  # an OnError
    """Ignore an error of a client, which is reported to the callers."""
