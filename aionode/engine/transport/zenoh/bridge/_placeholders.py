"""Placeholders, which cost nothing, for our endpoints until the first bridge is seen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from aionode.engine.transport.base import Registration, Requester, Writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import Call, ReplyTo, SampleInfo, StopSender
    from aionode.graph import EndpointInfo

__all__ = ["Placeholder", "RequesterPlaceholder", "WriterPlaceholder"]

EndpointT = TypeVar("EndpointT", bound=Registration)


class Placeholder(Registration, Generic[EndpointT]):
    """Stands in for one endpoint, which is created when the first bridge is seen.

    Args:
        placeholders: An ordered set that contains this until the endpoint is created or closed.
        make: Creates the endpoint.

    Attributes:
        endpoint: The endpoint, once it is created.
    """

    def __init__(
        self, placeholders: dict[Placeholder[Any], None], make: Callable[[], EndpointT]
    ) -> None:
        self.endpoint: EndpointT | None = None
        self._placeholders = placeholders
        self._make = make
        placeholders[self] = None

    def replace(self) -> None:
        """Create the endpoint, as there is a bridge now."""
        self.endpoint = self._make()

    def close(self) -> None:
        """Withdraw the endpoint, or never create one."""
        self._placeholders.pop(self, None)
        if self.endpoint is not None:
            self.endpoint.close()


class WriterPlaceholder(Placeholder[Writer], Writer):
    """Stands in for a publisher, and is not called for each message until that is created."""

    is_placeholder = True

    def __init__(
        self, placeholders: dict[Placeholder[Any], None], make: Callable[[], Writer]
    ) -> None:
        super().__init__(placeholders, make)
        self._on_replaced: list[Callable[[], None]] = []

    def replace(self) -> None:
        """Create the publisher, and make it used."""
        super().replace()
        self.is_placeholder = False
        for call in self._on_replaced:
            call()

    def when_replaced(self, callback: Callable[[], None]) -> None:
        """Call `callback` once there is a bridge."""
        self._on_replaced.append(callback)

    @property
    def active(self) -> bool:  # type: ignore[override]  # that of the publisher changes
        """Whether a message written now would be used."""
        return self.endpoint is not None and self.endpoint.active

    @property
    def bounded(self) -> bool:  # type: ignore[override]  # as above
        """Whether `has_room` may be false."""
        return self.endpoint is not None and self.endpoint.bounded

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg`."""
        if self.endpoint is not None:
            self.endpoint.write(msg, sequence, source_ns)

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:
        """Return an object that sends the stop of a lease."""
        if self.endpoint is None:
            return super().prepare_stop(stop, is_last)
        return self.endpoint.prepare_stop(stop, is_last)

    def has_room(self) -> bool:
        """Whether another message can wait to be sent."""
        return self.endpoint is None or self.endpoint.has_room()

    def is_drained(self) -> bool:
        """Return whether `drain` would not have to wait."""
        return self.endpoint is None or self.endpoint.is_drained()

    async def drain(self) -> None:
        """Wait until all messages were passed on."""
        if self.endpoint is not None:
            await self.endpoint.drain()

    @property
    def dropped(self) -> int:
        """Number of messages that were dropped on their way."""
        return 0 if self.endpoint is None else self.endpoint.dropped

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return how messages reach `reader`, if they do so through a bridge."""
        return None if self.endpoint is None else self.endpoint.route_of(reader)


class RequesterPlaceholder(Placeholder[Requester], Requester):
    """Stands in for a client."""

    @property
    def servers(self) -> int:
        """Number of matched servers behind bridges."""
        return 0 if self.endpoint is None else self.endpoint.servers

    @property
    def caveat(self) -> str:
        """Why the matched servers may not answer."""
        return "" if self.endpoint is None else self.endpoint.caveat

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send a request; there is a server, and so a bridge."""
        assert self.endpoint is not None  # noqa: S101  # for the type checker
        return self.endpoint.send(request, sample_info, reply_to)
