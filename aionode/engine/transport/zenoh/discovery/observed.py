"""Queries of tools to all contexts: what each counts, and which do not answer."""

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
    from collections.abc import Callable, Collection, Mapping

    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.discovery.peer_directory import ZenohPeerDirectory

__all__ = ["Observed"]

logger = logging.getLogger("aionode.transport.zenoh")

LINKS: Final = "links"
"""The end of a key on which contexts without reports answer too."""

OLDER_S: Final = 0.2
"""How long contexts that have sent no report are asked whether they are alive, in seconds."""

MAX_BYTES: Final = 64 << 20
"""Maximum size of all answers to one query that are kept, in bytes."""

ANSWER_BYTES: Final = 1000
"""The memory that an answer takes besides its payload, in bytes."""


class Observed:
    """Answers queries of tools in other processes, and sends such queries; idle otherwise.

    Attributes:
        answers: The functions that answer, by the end of the key that is queried.
    """

    def __init__(self, state: SessionState, peer_directory: ZenohPeerDirectory) -> None:
        self.answers: Mapping[str, Callable[[bytes], bytes]] = {}
        self._state = state
        self._peer_directory = peer_directory
        self._prefix = f"@aionode/{state.domain_id}/"
        self._queries = state.queue(self._take_query)
        self._answering = SendThread("aionode-report", state.waker)
        self._declared: list[Any] = []

    def start(self, session: zenoh.Session) -> None:
        """Answer from now on."""
        with translated("reports"):
            for what in self.answers:
                key = self._key(self._state.participant, what)
                self._declared.append(session.declare_queryable(key, direct(self._queries.put)))

    def stop(self) -> None:
        """Stop answering."""
        self._answering.abandon()
        declared, self._declared = self._declared, []
        for each in declared:
            each.undeclare()
        self._queries.clear()

    def _key(self, participant: str, what: str) -> str:
        return f"{self._prefix}{participant}/{what}"

    def _take_query(self, query: zenoh.Query) -> None:
        """Answer from a thread, as the tool that asks may be stalled."""
        asked = str(query.key_expr).rpartition("/")[2]
        payload = query.payload
        question = b"" if payload is None else payload.to_bytes()
        answers = {
            self._key(self._state.participant, what): tell(question)
            for what, tell in self.answers.items()
            if asked == what
        }

        def answer() -> None:
            try:
                with query:
                    for key, told in answers.items():
                        query.reply(key, told)
            except zenoh.ZError as error:  # the session was closed meanwhile
                logger.debug("%s: not answered: %s", asked, reason(error))

        self._answering.submit(answer)

    async def ask(
        self, what: str, question: bytes, timeout_s: float, participants: Collection[str] | None
    ) -> dict[str, bytes | None]:
        """Return what other contexts of the domain answer; see `Transport.observe`."""
        session = self._state.session
        if session is None:
            return {}
        # Contexts without links have only the token of acknowledgements.
        asked = self._peer_directory.contexts() | self._state.acknowledgements.present
        keys = [self._key("*", what)]
        if participants is not None:
            asked = set(participants)
            keys = [self._key(participant, what) for participant in sorted(asked)]
        told = await self._all_answers(session, keys, timeout_s, question)
        missing = asked - told.keys()
        if not missing:
            return {**told}
        # Contexts that do not know the query answer here, so that only others count as silent; and
        # one that was just found may not have been asked.
        older, again = await asyncio.gather(
            self._all_answers(session, [self._key("*", LINKS)], OLDER_S),
            self._all_answers(session, keys, OLDER_S, question),
        )
        empty = dict.fromkeys(missing & older.keys(), b"")
        return {**dict.fromkeys(missing), **empty, **told, **again}

    async def _all_answers(
        self, session: zenoh.Session, keys: list[str], timeout_s: float, question: bytes = b""
    ) -> dict[str, bytes]:
        """Return what each context answers on several keys."""
        found: dict[str, bytes] = {}
        for answers in await asyncio.gather(
            *(self._answers(session, key, timeout_s, question) for key in keys)
        ):
            found |= answers
        return found

    async def _answers(
        self, session: zenoh.Session, key: str, timeout_s: float, question: bytes
    ) -> dict[str, bytes]:
        """Return what each context answers on one key; one that is too large counts as none."""
        found: dict[str, bytes] = {}
        room = MAX_BYTES
        ended = asyncio.Event()

        def take(reply: zenoh.Reply | None) -> None:
            nonlocal room
            if reply is None:
                ended.set()
            elif reply.ok is not None and len(reply.ok.payload) + ANSWER_BYTES <= room:
                room -= len(reply.ok.payload) + ANSWER_BYTES
                participant = str(reply.ok.key_expr)[len(self._prefix) :].partition("/")[0]
                found[participant] = reply.ok.payload.to_bytes()

        queue = self._state.queue(take)
        session.get(
            key,
            direct(queue.put, lambda: queue.put(None)),
            target=zenoh.QueryTarget.ALL,
            payload=question,
            timeout=timeout_s,
            congestion_control=DROP,
            priority=LOOP_PRIORITY,
            allowed_destination=zenoh.Locality.REMOTE,
        )
        await ended.wait()
        return found
