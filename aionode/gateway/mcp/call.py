"""One call of a tool: its session, and how its client follows its progress."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from typing import TYPE_CHECKING, Any, Final

from mcp.shared.exceptions import MCPError
from mcp_types.version import MODERN_PROTOCOL_VERSIONS

from aionode.clock import S_TO_NS
from aionode.errors import RefusedError
from aionode.fastapi import watching

if TYPE_CHECKING:
    from aionode.gateway._clients import Clients
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.motions import Motion
    from aionode.gateway.session.session import Session

__all__ = ["Call", "ClientGoneError", "while_client_is_there"]

LOOK_SEC: Final = 0.05
"""The time between two checks whether the client is still connected, in seconds."""

PROGRESS_SEC: Final = 0.5
"""The least time between two reports of progress, in seconds."""


class ClientGoneError(asyncio.CancelledError):
    """The client of a call has disconnected: as after a cancellation, there is nobody to answer."""


class Call:
    """One call of a tool.

    Args:
        session: The session of the call, whose end releases everything that it has taken.
        context: The SDK's context of the request.
        clients: All clients of the robot.

    Attributes:
        session: The session.
        clients: All clients of the robot.
        outcome: The outcome of the call, for the audit log.
    """

    def __init__(self, session: Session, context: Any, clients: Clients) -> None:
        self.session = session
        self.clients = clients
        self.outcome = "cancelled"
        self._context = context
        self._reported_ns = -S_TO_NS
        self._progress = 0.0

    @contextmanager
    def moving(self, verb: Verb, name: str, type_name: str) -> Iterator[Motion]:
        """Move something within the block; see `Motions.moving`."""
        with self.clients.motions.moving(self.session, verb, name, type_name) as motion:
            try:
                yield motion
            except asyncio.CancelledError:
                self.outcome = motion.outcome("cancelled")
                raise

    async def sleep(self, seconds: float) -> None:
        """Sleep by the steady clock of the robot."""
        await self.clients.robot.clock.sleep(seconds)

    async def report(self, done: float, total: float | None, text: str) -> None:
        """Report progress to the client, if it has asked for it: at most twice a second.

        A client that does not read, or has gone, delays nothing.
        """
        now_ns = self.session.steady_ns()
        if now_ns - self._reported_ns < PROGRESS_SEC * S_TO_NS or done <= self._progress:
            return
        self._reported_ns, self._progress = now_ns, done
        with suppress(MCPError, TimeoutError):
            async with asyncio.timeout(LOOK_SEC):
                await self._context.session.report_progress(done, total, text)


@asynccontextmanager
async def while_client_is_there(context: Any, call: Call) -> AsyncIterator[None]:
    """Cancel the block when its client disconnects, or when its session ends.

    In protocol revisions before 2026-07-28, a client that disconnects has cancelled nothing, so its
    call would continue; but nobody is left to stop the robot.

    Raises:
        ClientGoneError: the client has disconnected.
        RefusedError: the session has ended, because the gateway is stopping or the policy has
            changed.
    """
    request = context.request
    is_watched = request is not None and context.protocol_version not in MODERN_PROTOCOL_VERSIONS
    scope, session = asyncio.timeout(None), call.session
    is_gone = False

    async def gone() -> None:
        nonlocal is_gone
        if not is_watched:
            await asyncio.Event().wait()
        while not await request.is_disconnected():
            await call.sleep(LOOK_SEC)
        is_gone = True

    try:
        async with scope, watching(gone, scope), watching(session.ended.wait, scope):
            yield
    except TimeoutError:
        if not scope.expired():
            raise
        if is_gone:
            raise ClientGoneError from None
        if session.end_reason:
            raise RefusedError("connection", session.end_reason, "too_many") from None
        reason = "the gateway is stopping, or its policy has changed"
        raise RefusedError("connection", reason, "not_allowed") from None
