"""Placeholders for our endpoints until the first bridge is seen, which cost nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.transport.base import ReaderRegistration, Registration, Requester, Writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.content_filter import ContentFilterOptions
    from aionode.graph import EndpointInfo
    from aionode.transport.base import Call, ReplyTo, SampleInfo, StopSender

__all__ = ["ReaderStub", "RequesterStub", "Stub", "WriterStub"]

MadeT = TypeVar("MadeT", bound=Registration)


class Stub(Registration, Generic[MadeT]):
    """Stands for one endpoint, which is made when the first bridge is seen.

    Args:
        stubs: Where to be until the endpoint is made or closed; an ordered set.
        make: Makes the endpoint.

    Attributes:
        made: The endpoint, once it is made.
    """

    def __init__(self, stubs: dict[Stub[Any], None], make: Callable[[], MadeT]) -> None:
        self.made: MadeT | None = None
        self._stubs = stubs
        self._make = make
        stubs[self] = None

    def replace(self) -> None:
        """Make the endpoint: there is a bridge."""
        self.made = self._make()

    def close(self) -> None:
        """Withdraw the endpoint, or make none."""
        self._stubs.pop(self, None)
        if self.made is not None:
            self.made.close()


class WriterStub(Stub[Writer], Writer):
    """Stands for a publisher, which is not asked for each message until it is made."""

    dormant = True

    def __init__(self, stubs: dict[Stub[Any], None], make: Callable[[], Writer]) -> None:
        super().__init__(stubs, make)
        self._on_wake: list[Callable[[], None]] = []

    def replace(self) -> None:
        """Make the publisher, and have it used."""
        super().replace()
        self.dormant = False
        for wake in self._on_wake:
            wake()

    def when_awake(self, callback: Callable[[], None]) -> None:
        """Call `callback` when there is a bridge."""
        self._on_wake.append(callback)

    @property
    def active(self) -> bool:  # type: ignore[override]  # that of the publisher changes
        """Whether a message written now would be used."""
        return self.made is not None and self.made.active

    @property
    def bounded(self) -> bool:  # type: ignore[override]  # as above
        """Whether `has_room` may be false."""
        return self.made is not None and self.made.bounded

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg`."""
        if self.made is not None:
            self.made.write(msg, sequence, source_ns)

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:
        """Return what sends the stop of a lease."""
        if self.made is None:
            return super().prepare_stop(stop, is_last)
        return self.made.prepare_stop(stop, is_last)

    def has_room(self) -> bool:
        """Whether one more message can wait to be sent."""
        return self.made is None or self.made.has_room()

    async def drain(self) -> None:
        """Wait until all messages were handed on."""
        if self.made is not None:
            await self.made.drain()

    @property
    def dropped(self) -> int:
        """Number of messages that were dropped on their way."""
        return 0 if self.made is None else self.made.dropped

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return how messages reach `reader`, if they do so through a bridge."""
        return None if self.made is None else self.made.route_of(reader)


class ReaderStub(Stub[ReaderRegistration], ReaderRegistration):
    """Stands for a subscription."""

    def set_content_filter(self, content_filter: ContentFilterOptions) -> None:
        """Do nothing: DDS nodes behind a bridge learn of no filter."""


class RequesterStub(Stub[Requester], Requester):
    """Stands for a client."""

    @property
    def servers(self) -> int:
        """Number of matched servers behind bridges."""
        return 0 if self.made is None else self.made.servers

    @property
    def caveat(self) -> str:
        """Why the matched servers may not answer."""
        return "" if self.made is None else self.made.caveat

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send a request; there is a server, and so a bridge."""
        assert self.made is not None  # noqa: S101  # for the type checker
        return self.made.send(request, sample_info, reply_to)
