"""The stop of a lease on Zenoh."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any, Final, Protocol

from aionode.clock import perf_ns
from aionode.engine.transport.base import StopSender
from aionode.engine.transport.zenoh.connections.handlers import BULK_BYTES
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.reliability.stateful_writer import StatefulWriter
    from aionode.engine.transport.zenoh.endpoints.sender import ZenohSender

__all__ = ["ZenohStop"]

logger = logging.getLogger("aionode.transport.zenoh")

REPEAT_NS: Final = 200_000_000
"""How long a stop is repeated, with the same number, for readers that do not acknowledge: Zenoh
silently drops messages that do not fit into its queue.
"""


class StoppableWriter(Protocol):
    """The members of a `ZenohWriter` used by the stop of a lease."""

    gid: bytes
    active: bool
    sender: ZenohSender
    history: StatefulWriter | None

    def keep_early(self, sequence: int, payload: bytes, extra: bytes) -> None:
        """Keep a message for late readers until the session is open."""

    def watch_stop(self, stop: ZenohStop) -> None:
        """Call `tick` regularly while there may be readers that do not acknowledge."""


class ZenohStop(StopSender):
    """Sends the stop of a lease to the readers of other contexts.

    Small messages are sent immediately, like the commands before it; large ones by the thread for
    them, which has a priority of its own. A reader that acknowledges is certain to get it, as the
    history keeps it. For the others it is repeated for a while.

    Args:
        writer: The publisher.
        stop: The message.
        is_last: Whether nothing was published since; otherwise it is not repeated.
    """

    def __init__(self, writer: StoppableWriter, stop: Any, is_last: Callable[[], bool]) -> None:
        self._writer = writer
        self._payload = cdr.encoder(type(stop))(stop)
        self._is_last = is_last
        self._extra = b""  # set once it was sent
        self._ends_ns = 0  # when to stop repeating it
        self._past = 0  # its number, once it was sent while the loop was blocked
        # Whether a large message is on its way or was published since: only behind it, nothing is
        # overtaken.
        sender = writer.sender
        sender.used_bulk = len(self._payload) >= BULK_BYTES or len(sender.large) > 0

    @property
    def is_repeated(self) -> bool:
        """Whether it should be repeated now."""
        return perf_ns() < self._ends_ns and self._is_last()

    def send(self, sequence: int, source_ns: int) -> None:
        """Send it, or keep it for readers that missed it while the loop was blocked."""
        writer, sender, history = self._writer, self._writer.sender, self._writer.history
        is_past = self._past == sequence
        if not is_past:
            if not writer.active:
                return
            self._begin(sequence, source_ns)
        if sender.publisher is None:
            writer.keep_early(sequence, self._payload, self._extra)
            return
        sender.abandon()
        # If sent while the loop was blocked, it bypassed what is kept for late readers.
        put = self._no_more if is_past and not sender.transient else sender.put_stop
        if history is None:
            put(self._payload, self._extra)
        else:
            history.write_stop(sequence, self._payload, self._extra, put)
        if sender.expiry is not None:
            sender.expiry.note()
        writer.watch_stop(self)

    def tick(self) -> ZenohStop | None:
        """Send it again, if that is still due; return what to call next time."""
        if not self.is_repeated:
            return None
        self.repeat()
        return self

    def _begin(self, sequence: int, source_ns: int) -> None:
        self._extra = attachment.pack(sequence, source_ns, self._writer.gid)
        self._ends_ns = perf_ns() + REPEAT_NS

    def _no_more(self, payload: bytes, extra: bytes) -> None:
        """Do nothing: it was sent while the loop was blocked."""

    def send_past_loop(self, sequence: int, source_ns: int) -> None:
        """Send it, and tell acknowledging readers not to wait for anything before it.

        The loop could not resend what they lack.
        """
        self._past = sequence
        self._begin(sequence, source_ns)
        self.repeat()
        # Zenoh does not keep such a stop, and late readers would get the last command.
        self._writer.sender.keep_past_loop(self._payload, self._extra)
        if self._writer.history is not None:
            self._writer.history.announce_only(sequence)

    def repeat(self) -> None:
        """Send it immediately, with the priority of the messages before it."""
        self._writer.sender.put_now(self._payload, self._extra)
