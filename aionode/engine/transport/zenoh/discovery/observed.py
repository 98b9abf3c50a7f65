"""Questions of tools to all contexts: what each counts, and who does not answer."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Any, Final

import zenoh

from aionode.engine.transport.send_thread import SendThread
from aionode.engine.transport.zenoh.connections.handlers import (
    DROP,
    LOOP_PRIORITY,
    direct,
    reason,
    translated,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.discovery.peer_directory import ZenohPeerDirectory

__all__ = ["Observed"]

logger = logging.getLogger("aionode.transport.zenoh")

REPORT: Final = "report"
"""The end of the key on which a context tells what it counts."""

LINKS: Final = "links"
"""The end of a key on which contexts without reports answer as well."""


class Observed:
    """Answers tools of other processes, and asks them; does nothing before somebody asks.

    Attributes:
        report: Returns what this context tells; None to tell nothing.
    """

    def __init__(self, state: SessionState, peer_directory: ZenohPeerDirectory) -> None:
        self.report: Callable[[], bytes] | None = None
        self._state = state
        self._peer_directory = peer_directory
        self._prefix = f"@aionode/{state.domain_id}/"
        self._queries = state.queue(self._take_query)
        self._answering = SendThread("aionode-report", state.waker)
        self._declared: Any = None

    def start(self, session: zenoh.Session) -> None:
        """Answer from now on."""
        with translated("reports"):
            self._declared = session.declare_queryable(
                self._key(self._state.participant, REPORT), direct(self._queries.put)
            )

    def stop(self) -> None:
        """Answer no more."""
        self._answering.abandon()
        declared, self._declared = self._declared, None
        if declared is not None:
            declared.undeclare()
        self._queries.clear()

    def _key(self, participant: str, what: str) -> str:
        return f"{self._prefix}{participant}/{what}"

    def _take_query(self, query: zenoh.Query) -> None:
        """Answer, from a thread: the one who asks may be stalled."""
        key = self._key(self._state.participant, REPORT)
        report = b"" if self.report is None else self.report()

        def answer() -> None:
            try:
                with query:
                    query.reply(key, report)
            except zenoh.ZError as error:  # the session was closed meanwhile
                logger.debug("%s: not answered: %s", key, reason(error))

        self._answering.submit(answer)

    async def ask(self, timeout_s: float) -> dict[str, bytes | None]:
        """Return what the other contexts of the domain answer; see `Transport.observe`."""
        session = self._state.session
        if session is None:
            return {}
        told: dict[str, bytes] = {}
        older: dict[str, bytes] = {}
        ended = asyncio.Semaphore(0)

        def take(reply: zenoh.Reply | None) -> None:
            if reply is None:
                ended.release()
            elif reply.ok is not None:
                participant, _, what = str(reply.ok.key_expr)[len(self._prefix) :].partition("/")
                if what == REPORT:
                    told[participant] = reply.ok.payload.to_bytes()
                else:
                    older[participant] = b""

        queue = self._state.queue(take)
        for what in (REPORT, LINKS):
            session.get(
                self._key("*", what),
                direct(queue.put, lambda: queue.put(None)),
                target=zenoh.QueryTarget.ALL,
                timeout=timeout_s,
                congestion_control=DROP,
                priority=LOOP_PRIORITY,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        for _ in range(2):
            await ended.acquire()
        return {**dict.fromkeys(self._peer_directory.contexts()), **older, **told}
