"""Subscriptions, each with two ways from every publisher."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import DecodeError, FrameError
from aionode.message import fields
from aionode.qos import ReliabilityPolicy, keeps_all
from aionode.transport.base import Registration, SampleInfo
from aionode.transport.ipc._protocol import Handover, Kind, Route, can_link
from aionode.wire import cdr

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo
    from aionode.transport.base import Reader
    from aionode.transport.ipc._connection import Connection
    from aionode.transport.ipc._manager import LinkManager
    from aionode.transport.ipc._protocol import Frame
    from aionode.wire.cdr import Data

__all__ = ["IpcReader", "RemotePublisher", "ZenohFilter", "may_be_large"]

WINDOW: Final = 1_000
"""How many messages a KEEP_ALL reader lets a publisher send ahead of what it has used."""

MAX_FULL: Final = 50_000
"""How many messages wait here for room: those ahead, and what a publisher sends when it ends."""

CONFIRM_MESSAGES: Final = 64
CONFIRM_BYTES: Final = 1 << 16
"""After so many messages, or bytes, a reader says what it has."""

ZENOH_LATE_S: Final = 0.1
"""How long a reader that holds messages waits for the other way to say anything more."""

RECOVERY_S: Final = 0.5
"""The same where something is sent again: to a KEEP_ALL reader, or after a link has ended, when the
other process has to notice.
"""

GONE_S: Final = 10.0
"""How long a publisher that has gone is remembered: what it sent may come over Zenoh as well."""


class ZenohFilter:
    """What Zenoh delivers to in place of the subscription: it leaves out what the link brings."""

    def __init__(self, reader: Reader) -> None:
        self.endpoint = reader.endpoint
        self.raw = reader.raw
        self.reject = reader.reject
        self.wait_for_room = reader.wait_for_room
        self.when_room = reader.when_room
        self.remote_publishers: dict[bytes, RemotePublisher] = {}
        self._deliver = reader.deliver
        self._has_room = reader.has_room

    def deliver(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int = 0) -> None:
        """Take a message that came over Zenoh."""
        remote_publisher = self.remote_publishers.get(sample_info.gid)
        if remote_publisher is None:
            self._deliver(msg, sample_info, inline_deadline_ns)
        else:
            remote_publisher.from_zenoh(msg, sample_info, inline_deadline_ns)

    def has_room(self) -> bool:
        """Whether a message can be taken without losing one that should be kept."""
        return self._has_room() and not any(
            remote_publisher.full for remote_publisher in self.remote_publishers.values()
        )


class RemotePublisher:
    """One subscription and one publisher of another process."""

    def __init__(self, manager: LinkManager, reader: IpcReader, publisher: EndpointInfo) -> None:
        self.reader = reader
        self.publisher = publisher.gid
        self.participant = publisher.node.participant
        self.connection: Connection | None = None
        # What a KEEP_ALL reader has no room for yet.
        self.full: deque[tuple[Any, SampleInfo]] = deque()
        patient = keeps_all(reader.endpoint.qos)
        self.handover = Handover(self._deliver_patiently if patient else reader.deliver)
        self._deliver = reader.deliver
        self._patient = patient
        self._manager = manager
        self._decode = reader.decoder()
        self._window = WINDOW if patient else 0
        reliable = ReliabilityPolicy.RELIABLE
        self._confirms = (
            reader.endpoint.qos.resolved().reliability is reliable
            and publisher.qos.resolved().reliability is reliable
        )
        self._used = 0
        self._used_bytes = 0
        self._waiting_for_room = False
        self._looking = False
        self._moved = False

    @property
    def gid(self) -> bytes:
        """Of the subscription."""
        return self.reader.gid

    def open(self, connection: Connection) -> None:
        """Ask for the publisher's messages over `connection`."""
        self.connection = connection
        self._used = self._used_bytes = 0
        connection.send(Kind.OPEN, self._window, self.publisher, self.gid, int(self._confirms))

    def opened(self, sequence: int) -> None:
        """Note from where on they come."""
        self.handover.opened(sequence)
        self._after()

    def from_zenoh(self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int) -> None:
        """Take a message that came over Zenoh."""
        handover = self.handover
        if handover.route is Route.ZENOH:
            handover.from_zenoh(msg, sample_info, inline_deadline_ns)
            return
        self._moved = True
        before = handover.route
        handover.from_zenoh(msg, sample_info, inline_deadline_ns)
        if handover.route is not before or handover.waits:
            self._after()

    def from_retransmit(self, payload: Data, one: Frame) -> None:
        """Take what a broken link left unsaid."""
        try:
            msg = self._decode(payload)
        except DecodeError as error:
            self.reader.reject(error)
            return
        self._moved = True
        self.handover.from_retransmit(msg, SampleInfo(one.gid, one.sequence, one.source_ns, True))
        self._after()

    def retransmit_done(self) -> None:
        """Note that this was all."""
        self.handover.retransmit_done()
        self._after()

    def from_link(self, payload: Data, one: Frame, inline_deadline_ns: int) -> None:
        """Take a message that came over the link."""
        try:
            msg = self._decode(payload)
        except DecodeError as error:
            self.reader.reject(error)
            return
        sample_info = SampleInfo(one.gid, one.sequence, one.source_ns, True)
        handover = self.handover
        if handover.steady and not self._patient:  # what `from_link` does, in fewer calls
            if one.sequence > handover.last:
                handover.last = one.sequence
                self._deliver(msg, sample_info, inline_deadline_ns)
        else:
            if len(self.full) >= MAX_FULL:
                name = self.reader.endpoint.name
                raise FrameError(f"{name}: {MAX_FULL} messages ahead of what was allowed")
            before = handover.route
            # It may be held for a while, and it is now that it has arrived.
            sample_info = SampleInfo(
                one.gid, one.sequence, one.source_ns, True, self._manager.now_ns()
            )
            handover.from_link(msg, sample_info, inline_deadline_ns)
            if handover.route is not before or handover.waits:
                self._after()
        if self._confirms:
            self._used += 1
            self._used_bytes += len(payload)
            if self._used >= CONFIRM_MESSAGES or self._used_bytes >= CONFIRM_BYTES or one.in_shm:
                self._confirm()

    def _after(self) -> None:
        """Say that the way has changed, or look again soon for what is waited for."""
        handover = self.handover
        if handover.route is Route.IPC and self.connection is not None:
            self.connection.send(Kind.SWITCHED, 0, self.publisher, self.gid)
            self._confirm()
        elif handover.waits and not self._looking:
            self._look_later()

    def _look_later(self) -> None:
        self._looking = True
        self._moved = False
        # What a KEEP_ALL reader waits for comes for certain, perhaps sent once more.
        patient = self._patient or self.handover.route is Route.RECOVERING
        self._manager.later(RECOVERY_S if patient else ZENOH_LATE_S, self._look_again)

    def _look_again(self) -> None:
        """Wait no longer if nothing has come all the while."""
        self._looking = False
        handover = self.handover
        if not handover.waits:
            return
        if self._moved:
            self._look_later()
            return
        handover.switch()
        handover.finish()
        self._after()

    def _deliver_patiently(
        self, msg: Any, sample_info: SampleInfo, inline_deadline_ns: int
    ) -> None:
        """Give a KEEP_ALL reader a message as soon as it has room for it."""
        if self.full or not self.reader.has_room():
            self.full.append((msg, sample_info))
            self._wait_for_room()
        else:
            self._deliver(msg, sample_info, inline_deadline_ns)

    def _wait_for_room(self) -> None:
        if not self._waiting_for_room:
            self._waiting_for_room = True
            self.reader.when_room(self._look_for_room)

    def _look_for_room(self) -> None:
        self._waiting_for_room = False
        full = self.full
        while full and self.reader.has_room():
            self._deliver(*full.popleft(), 0)
        if full:
            self._wait_for_room()
        else:
            self._confirm()

    def _confirm(self) -> None:
        """Say what is here, unless a KEEP_ALL reader has no room for it, or it is still held."""
        if self._used and self.connection is not None and not self.full:
            if self.handover.route is not Route.IPC:
                return
            used, self._used, self._used_bytes = self._used, 0, 0
            last = self.handover.last
            self.connection.send(Kind.CREDIT, used, self.publisher, self.gid, last)

    def gone(self) -> None:
        """Note that the publisher has said its last over the link; Zenoh may still be behind.

        What is held until Zenoh has brought what came before it is waited for as ever. Copies that
        Zenoh brings afterwards are left out, for `GONE_S`.
        """
        if self.handover.waits:
            self._after()
        else:
            self.handover.finish()
            self._confirm()  # or the publisher's process keeps it until the link ends
        self._manager.later(GONE_S, self._forget)

    def _forget(self) -> None:
        self._manager.forget(self)
        self.reader.remote_publishers.pop(self.publisher, None)

    def broken(self) -> None:
        """Take Zenoh again."""
        self.connection = None
        self.handover.broken()
        self._after()


def may_be_large(msg_type: type[Any]) -> bool:
    """Whether messages hold numbers or bytes without a bound, at any depth."""
    types = [field.type for field in fields(msg_type)]
    return any(
        may_be_large(type_.nested)
        if type_.nested is not None
        else type_.container == "unbounded" and type_.kind not in ("string", "wstring")
        for type_ in types
    )


class IpcReader(Registration):
    """A subscription with its inlets, one for each publisher that it hears over a link.

    Args:
        manager: The links of this context.
        msg_type: Its messages.
        reader: Where they go.
        zenoh_filter: What Zenoh delivers to.
        zenoh: Its other way.
    """

    def __init__(
        self,
        manager: LinkManager,
        msg_type: type[Any],
        reader: Reader,
        zenoh_filter: ZenohFilter,
        zenoh: Registration,
    ) -> None:
        self.endpoint = reader.endpoint
        self.deliver = reader.deliver
        self.reject = reader.reject
        self.has_room = reader.has_room
        self.when_room = reader.when_room
        self._raw = reader.raw
        self._msg_type = msg_type
        self._manager = manager
        self._zenoh_filter = zenoh_filter
        self._zenoh = zenoh
        # Others know it by its token, which may say more than the graph does (`CPU_BACKEND`).
        self.gid: bytes = getattr(zenoh, "gid", self.endpoint.gid)
        manager.readers[self.gid] = self

    def decoder(self) -> Callable[[Data], Any]:
        """Return what makes its messages of bytes."""
        return bytes if self._raw else cdr.decoder(self._msg_type)

    @property
    def remote_publishers(self) -> dict[bytes, RemotePublisher]:
        """By the publisher's gid."""
        return self._zenoh_filter.remote_publishers

    def meet(self, publisher: EndpointInfo, connection: Connection) -> None:
        """Ask for the messages of `publisher`, if that was not done yet."""
        if not can_link(publisher) or not self.endpoint.matches(publisher):
            return
        remote_publisher = self.remote_publishers.get(publisher.gid)
        if remote_publisher is None:
            remote_publisher = self.remote_publishers[publisher.gid] = RemotePublisher(
                self._manager, self, publisher
            )
        if remote_publisher.connection is None:
            self._manager.listen(remote_publisher, connection)
            remote_publisher.open(connection)

    def close(self) -> None:
        """Withdraw the subscription."""
        self._manager.readers.pop(self.gid, None)
        self._zenoh.close()
        for remote_publisher in self.remote_publishers.values():
            if remote_publisher.connection is not None:
                remote_publisher.connection.send(
                    Kind.CLOSE, 0, remote_publisher.publisher, remote_publisher.gid
                )
            self._manager.forget(remote_publisher)
        self.remote_publishers.clear()
