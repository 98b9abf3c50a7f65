"""Heartbeats, gaps and repeated messages, which a reliable publisher sends to single readers."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from aionode.transport.zenoh._delivery import BULK_BYTES
from aionode.transport.zenoh._handlers import BULK_PRIORITY
from aionode.wire import _acknack as acknack
from aionode.wire import _attachment as attachment
from aionode.wire._acknack import SubmessageKind
from aionode.wire._key_expression import Side

if TYPE_CHECKING:
    from aionode.transport.zenoh._reliability import Entry, ReaderProxy
    from aionode.transport.zenoh._session_state import SessionState

__all__ = ["SubmessageSender"]


class SubmessageSender:
    """The part of a publisher that sends submessages.

    Attributes:
        state: The state of the session.
        gid: The publisher.
    """

    state: SessionState
    gid: bytes
    _key: str  # of the topic
    _listens = False  # whether acknowledgements are heard

    def listen(self) -> None:
        """Hear the acknowledgements of readers; to be called before anything is sent to them."""
        if not self._listens:
            self._listens = True
            self.state.acknowledgements.listen(self._key, Side.SUBSCRIPTIONS)

    def unlisten(self) -> None:
        """Hear them no more."""
        if self._listens:
            self._listens = False
            self.state.acknowledgements.unlisten(self._key, Side.SUBSCRIPTIONS)

    def heartbeat(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Send a reader a HEARTBEAT; any thread may."""
        self._send_submessage(
            SubmessageKind.HEARTBEAT, reader, first, last, self.state.participant.encode()
        )

    def gap(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Send a reader a GAP."""
        self._send_submessage(SubmessageKind.GAP, reader, first, last)

    def resend(self, reader: ReaderProxy, entry: Entry) -> None:
        """Send a message again to one reader."""
        fields = attachment.unpack_fields(entry.attachment)
        source_ns = 0 if fields is None else fields[1]
        self._send_submessage(SubmessageKind.DATA, reader, entry.sequence, source_ns, entry.payload)

    def _send_submessage(
        self, kind: SubmessageKind, reader: ReaderProxy, first: int, last: int, rest: bytes = b""
    ) -> None:
        data = acknack.pack(kind, self.gid, reader.gid, first, last, rest)
        key = acknack.submessage_key(self._key, Side.PUBLISHERS, reader.participant)
        acknowledgements = self.state.acknowledgements
        if len(data) < BULK_BYTES:
            acknowledgements.send(key, data)
        else:  # Zenoh sends it in fragments, each of which may wait
            self.state.bulk.submit(partial(acknowledgements.send_now, key, data, BULK_PRIORITY))
