"""The reader's end of reliable delivery over a lossy transport; a state machine without I/O.

A reader has a `WriterProxy` for each writer that has sent it a HEARTBEAT; before that, messages are
delivered as they arrive. `stateful_writer` describes the protocol; the terms are RTPS's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Protocol

from aionode._process.recent import Recent
from aionode.engine.transport.reliability.limits import NEVER, OVERHEAD_BYTES
from aionode.engine.transport.reliability.submessage import SubmessageKind
from aionode.engine.transport.reliability.writer_proxy import ProxyOutput, WriterProxy

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.reliability.submessage import Submessage

__all__ = ["ReaderOutput", "StatefulReader"]

REMEMBERED_WRITERS: Final = 1_024
"""Number of writers whose state a reader remembers."""

GONE_TICKS: Final = 300
"""After this many ticks (15 s), messages of an unannounced writer are no longer expected.

Ticks, not time: while this process is frozen or stalled, it sees no announcements.
"""


class ReaderOutput(ProxyOutput, Protocol):
    """The output of a `StatefulReader`, and its view of other arrivals."""

    def item_of(self, submessage: Submessage) -> Any:
        """Return the message of a DATA submessage, in the form that `accept` gets."""

    def participant_of(self, writer: bytes) -> str:
        """Return the context that announces a writer; empty if none does."""

    def has_arrivals(self) -> bool:
        """Return whether messages have arrived that the reader has not received yet."""

    def receive_arrivals(self) -> None:
        """Deliver them to the reader."""

    def malformed(self) -> None:
        """Report a submessage without a valid sender."""


class StatefulReader:
    """A reader's view of all its writers; the term is RTPS's.

    Args:
        gid: The id of the reader.
        output: Sends submessages and accepts messages.
        now_ns: A monotonic clock with an arbitrary epoch.
        span: Maximum number of messages that later ones wait for; more are skipped, as a KEEP_LAST
            reader would drop them anyway.
        has_history: Whether the reader gets earlier messages in another way, as a transient local
            one does.

    Attributes:
        proxies: The writers that have sent a HEARTBEAT, by gid.
    """

    __slots__ = ("_gid", "_has_history", "_last", "_now_ns", "_output", "_span", "proxies")

    def __init__(
        self,
        gid: bytes,
        output: ReaderOutput,
        now_ns: Callable[[], int],
        span: int = NEVER,
        *,
        has_history: bool = False,
    ) -> None:
        self.proxies: dict[bytes, WriterProxy] = {}
        # The last sequence number of each writer without a proxy; no writer is in both.
        self._last: Recent[bytes, int] = Recent(REMEMBERED_WRITERS)
        self._gid = gid
        self._output = output
        self._now_ns = now_ns
        self._span = span
        self._has_history = has_history

    def clear(self) -> None:
        """Forget the proxies: nothing arrives any more."""
        self.proxies.clear()

    def receive_early(self, writer: bytes, sequence: int) -> bool:
        """Record a message of a writer without a proxy; return whether to deliver it.

        The history of a transient local writer may contain it again.
        """
        if self._has_history and 0 < sequence <= self._last.get(writer, 0):
            return False
        self._last.put(writer, sequence)
        return True

    def receive(self, submessage: Submessage) -> bool:
        """Handle a HEARTBEAT, GAP or DATA of a writer; return whether to call `tick`."""
        proxy = self.proxies.get(submessage.writer)
        if submessage.kind is SubmessageKind.HEARTBEAT:
            proxy = self._receive_heartbeat(proxy, submessage)
        elif proxy is not None and submessage.kind is SubmessageKind.GAP:
            proxy.gap(submessage.first, submessage.last)
        elif proxy is not None and submessage.kind is SubmessageKind.DATA:
            item, size = self._output.item_of(submessage), len(submessage.rest) + OVERHEAD_BYTES
            proxy.receive(submessage.first, item, size, is_resent=True)
        return proxy is not None and proxy.lacks

    def _receive_heartbeat(
        self, proxy: WriterProxy | None, heartbeat: Submessage
    ) -> WriterProxy | None:
        """Return the proxy of its sender, if there is one now."""
        if proxy is not None and self._is_left_to_history(proxy, heartbeat):
            del self.proxies[proxy.gid]
            self._last.put(proxy.gid, proxy.delivered)
            proxy = None
        if proxy is None:
            proxy = self._add_proxy(heartbeat)
            if proxy is None:
                return None
        elif proxy.participant.encode() != heartbeat.rest:
            proxy.participant = self._participant_of(heartbeat) or proxy.participant
        if (
            heartbeat.first > proxy.next
        ):  # older messages may have arrived, but not been received yet
            self._output.receive_arrivals()
        # While messages wait to be received, missing ones cannot be determined.
        ask = not self._output.has_arrivals()
        proxy.heartbeat(heartbeat.first, heartbeat.last, ask=ask)
        return proxy

    def _is_left_to_history(self, proxy: WriterProxy, heartbeat: Submessage) -> bool:
        """Return whether the writer has forgotten this reader.

        Messages published in the meantime are then sent as to a late reader.
        """
        return self._has_history and proxy.next < heartbeat.first and not proxy.lacks

    def _add_proxy(self, heartbeat: Submessage) -> WriterProxy | None:
        """Return a new proxy for the sender of a HEARTBEAT; None if that is malformed."""
        gid = heartbeat.writer
        if self._has_history and self._last.get(gid, 0) < heartbeat.first - 1:
            return None  # the history is still to come
        participant = self._participant_of(heartbeat)
        if not participant:
            self._output.malformed()
            return None
        if len(self.proxies) >= REMEMBERED_WRITERS:  # forget the one that was silent for longest
            del self.proxies[min(self.proxies, key=lambda gid: self.proxies[gid].heard_ns)]
        delivered = self._last.pop(gid, 0)
        proxy = self.proxies[gid] = WriterProxy(
            gid,
            participant,
            self._gid,
            self._output,
            self._now_ns,
            first=max(heartbeat.first, delivered + 1),
            span=self._span,
            delivered=delivered,
        )
        return proxy

    def _participant_of(self, heartbeat: Submessage) -> str:
        """Return the context of a HEARTBEAT's sender; empty if malformed.

        The announced one takes precedence: a lie could keep a writer waiting for acknowledgements.
        """
        participant = self._output.participant_of(heartbeat.writer)
        if participant:
            return participant
        participant = heartbeat.rest.decode(errors="replace")
        return participant if participant.isalnum() else ""  # it becomes part of an address

    def tick(self) -> bool:
        """Ask again for what is missing; return whether to call again."""
        again = False
        for proxy in list(self.proxies.values()):
            if not proxy.lacks or self._output.participant_of(proxy.gid):
                proxy.absent_ticks = 0
            else:
                proxy.absent_ticks += 1
                if proxy.absent_ticks >= GONE_TICKS:
                    proxy.give_up()
            if proxy.lacks:
                again = True
                if not self._output.has_arrivals():
                    proxy.remind()
        return again
