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

OLDER_S: Final = 0.2
"""Time for which those that have sent no report are asked whether they are there, in seconds."""


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
        told = await self._answers(session, REPORT, timeout_s)
        missing = self._peer_directory.contexts() - told.keys()
        if not missing:
            return {**told}
        # Those without reports answer here, so that only others count as silent; and one that was
        # just found may not have been asked.
        older, again = await asyncio.gather(
            self._answers(session, LINKS, OLDER_S), self._answers(session, REPORT, OLDER_S)
        )
        empty = dict.fromkeys(missing & older.keys(), b"")
        return {**dict.fromkeys(missing), **empty, **told, **again}

    async def _answers(
        self, session: zenoh.Session, what: str, timeout_s: float
    ) -> dict[str, bytes]:
        """Return what each context answers on one of its keys."""
        found: dict[str, bytes] = {}
        ended = asyncio.Event()

        def take(reply: zenoh.Reply | None) -> None:
            if reply is None:
                ended.set()
            elif reply.ok is not None:
                participant = str(reply.ok.key_expr)[len(self._prefix) :].partition("/")[0]
                found[participant] = reply.ok.payload.to_bytes()

        queue = self._state.queue(take)
        session.get(
            self._key("*", what),
            direct(queue.put, lambda: queue.put(None)),
            target=zenoh.QueryTarget.ALL,
            timeout=timeout_s,
            congestion_control=DROP,
            priority=LOOP_PRIORITY,
            allowed_destination=zenoh.Locality.REMOTE,
        )
        await ended.wait()
        return found
