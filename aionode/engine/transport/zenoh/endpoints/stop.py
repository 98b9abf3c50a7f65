"""The stop of a lease on Zenoh."""

from __future__ import annotations

import logging
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Protocol

import zenoh

from aionode.clock import perf_ns
from aionode.engine.transport.base import StopSender
from aionode.engine.transport.zenoh.connections.handlers import BULK_BYTES, reason
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr

if TYPE_CHECKING:
    from collections.abc import Callable

    from zenoh import ext

    from aionode.clock import SilenceAlarm
    from aionode.engine.transport.reliability.stateful_writer import StatefulWriter
    from aionode.engine.transport.send_thread import SendQueue, SendThread

__all__ = ["ZenohStop"]

logger = logging.getLogger("aionode.transport.zenoh")

REPEAT_NS: Final = 200_000_000
"""Time for which a stop is put again, with the same number, for readers that do not
acknowledge: Zenoh drops messages that do not fit into its queue, and tells nobody.
"""


class StoppableWriter(Protocol):
    """The members of a `ZenohWriter` that the stop of a lease needs."""

    gid: bytes
    active: bool
    used_bulk: bool
    _transient: bool
    _stop: ZenohStop | None
    _key: str
    _publisher: zenoh.Publisher | ext.AdvancedPublisher | None
    _history: StatefulWriter | None
    _expiry: SilenceAlarm | None
    _large: SendQueue
    _blocking: SendQueue | None
    _blocking_thread: SendThread

    def _keep_early(self, sequence: int, payload: bytes, extra: bytes) -> None: ...
    def _abandon_queues(self) -> None: ...
    def _has_unacknowledging(self) -> bool: ...
    def _send_blocking(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None: ...
    def _watch(self) -> None: ...
    def _put_blocking(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None: ...
    def _send(
        self, publisher: zenoh.Publisher | ext.AdvancedPublisher, payload: bytes, extra: bytes
    ) -> None: ...


class ZenohStop(StopSender):
    """Sends the stop of a lease to the readers of other contexts.

    Small messages are put at once, as the commands before it were; large ones by the thread for
    them, which has a priority of its own. A reader that acknowledges gets it for certain: the
    history keeps it. To the others it is put again for a while.

    Args:
        writer: The publisher.
        stop: The message.
        is_last: Whether nothing was published since; else it is not put again.
    """

    def __init__(self, writer: StoppableWriter, stop: Any, is_last: Callable[[], bool]) -> None:
        self._writer = writer
        self._payload = cdr.encoder(type(stop))(stop)
        self._is_last = is_last
        self._extra = b""  # once it was sent
        self._ends_ns = 0  # when it is put no more
        self._past = 0  # its number, once it was sent past the loop
        # Whether a large message was published since: only behind it nothing is overtaken.
        writer.used_bulk = len(self._payload) >= BULK_BYTES

    @property
    def is_repeated(self) -> bool:
        """Whether it is to be put again now."""
        return perf_ns() < self._ends_ns and self._is_last()

    def send(self, sequence: int, source_ns: int) -> None:
        """Send it, or keep for those who ask again what was sent past the loop."""
        writer, history = self._writer, self._writer._history
        is_past = self._past == sequence
        if not is_past:
            if not writer.active:
                return
            self._begin(sequence, source_ns)
        if writer._publisher is None:
            writer._keep_early(sequence, self._payload, self._extra)
            return
        writer._abandon_queues()
        # Past the loop, it was put past what is kept for late readers.
        put = self._no_more if is_past and not writer._transient else self._put
        if history is None:
            put(self._payload, self._extra)
        else:
            history.write_stop(sequence, self._payload, self._extra, put)
        if writer._expiry is not None:
            writer._expiry.note()
        if writer._has_unacknowledging():
            writer._stop = self
        writer._watch()

    def tick(self) -> ZenohStop | None:
        """Put it again, if that is still due; return what to call next time."""
        if not self.is_repeated:
            return None
        self.repeat()
        return self

    def _begin(self, sequence: int, source_ns: int) -> None:
        self._extra = attachment.pack(sequence, source_ns, self._writer.gid)
        self._ends_ns = perf_ns() + REPEAT_NS

    def _no_more(self, payload: bytes, extra: bytes) -> None:
        """Do nothing: it was put past the loop."""

    def _put(self, payload: bytes, extra: bytes) -> None:
        """Put it where the last message was put."""
        writer = self._writer
        blocking, publisher = writer._blocking, writer._publisher
        if (blocking is not None or writer._transient) and publisher is not None:
            if blocking is not None and len(blocking):
                self.repeat()  # its thread waits for a slow reader, the others do not
            writer._put_blocking(publisher, payload, extra)
        elif writer.used_bulk and publisher is not None:
            writer._large.put(partial(writer._send, publisher, payload, extra), len(payload))
        else:
            self.repeat()

    def send_past_loop(self, sequence: int, source_ns: int) -> None:
        """Put it, and tell the readers that acknowledge to wait for nothing before it.

        The loop could not send again what they lack.
        """
        self._past = sequence
        self._begin(sequence, source_ns)
        self.repeat()
        writer = self._writer
        if writer._transient and writer._publisher is not None:
            # Such a stop is not kept for late readers, who would get the last command.
            keep = partial(writer._send_blocking, writer._publisher, self._payload, self._extra)
            writer._blocking_thread.submit_past_loop(keep)
        if writer._history is not None:
            writer._history.announce_only(sequence)

    def repeat(self) -> None:
        """Put it at once, with the priority of the messages before it."""
        writer = self._writer
        publisher = writer._publisher
        if publisher is None:
            return
        try:
            if writer.used_bulk or writer._transient:
                writer._send(publisher, self._payload, self._extra)
            else:
                publisher.put(self._payload, attachment=self._extra)
        except zenoh.ZError as error:  # the session was closed meanwhile
            logger.debug("%s: not sent: %s", writer._key, reason(error))
