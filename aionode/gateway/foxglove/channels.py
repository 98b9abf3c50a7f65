"""The channels and services announced to a client of Foxglove's protocol."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from aionode.bag.files.types import definition_of
from aionode.errors import AionodeError, MessageError
from aionode.gateway.foxglove import frames

if TYPE_CHECKING:
    from aionode.gateway.session.delivery.outbox import Frame
    from aionode.gateway.session.delivery.subscribed import Subscribed
    from aionode.gateway.session.feed import Received
    from aionode.gateway.session.session import Session

__all__ = ["Channels"]

DEPTH: Final = 100
"""Messages of a channel that may wait for the client; the outbox limits their bytes."""

MAX_QUESTIONS: Final = 8
"""Types requested from other nodes at a time."""

WARNING: Final = 1


class Named(NamedTuple):
    """A topic or service with one of its types."""

    name: str
    type_name: str


class Channels:
    """The channels and services announced to one client, and its subscriptions.

    A channel is announced with its definition; it is subscribed to when the client asks for it.

    Args:
        session: The session of the client.
        time_ns: Returns the time of a message that arrives now, in nanoseconds since 1970.
    """

    def __init__(self, session: Session, time_ns: Callable[[Received], int]) -> None:
        self._session = session
        self._time_ns = time_ns
        self._last_id = 0
        self._topics: dict[Named, int] = {}
        self._services: dict[Named, int] = {}
        self._names: dict[int, Named] = {}
        self._subscriptions: dict[int, tuple[int, Subscribed]] = {}
        self._unknown: set[str] = set()
        self._news: dict[tuple[str, str], list[dict[str, Any]]] = {}

    # News for the client

    async def announce(self) -> None:
        """Tell the client about topics and services that are new or gone."""
        topics = everyone(self._session.graph.topics())
        services = everyone(self._session.graph.services())
        self._withdraw(self._topics, topics, "unadvertise", "channelIds")
        self._withdraw(self._services, services, "unadvertiseServices", "serviceIds")
        room = asyncio.Semaphore(MAX_QUESTIONS)
        async with asyncio.TaskGroup() as tasks:
            for named in sorted(topics - set(self._topics)):
                tasks.create_task(self._announce(named, room, self._channel))
            for named in sorted(services - set(self._services)):
                tasks.create_task(self._announce(named, room, self._offer))

    def _withdraw(self, known: dict[Named, int], now: set[Named], op: str, field: str) -> None:
        gone = [known.pop(named) for named in set(known) - now]
        if not gone:
            return
        for channel in gone:
            del self._names[channel]
        self.unsubscribe(
            [number for number, (channel, _) in self._subscriptions.items() if channel in gone]
        )
        self._session.outbox.send(frames.op_frame(op, {field: sorted(gone)}))

    async def _announce(
        self, named: Named, room: asyncio.Semaphore, announce: Callable[[Named], Awaitable[None]]
    ) -> None:
        """Tell the client about one topic or service, as soon as its type is known."""
        try:
            async with room:
                await announce(named)
        except (AionodeError, TimeoutError) as error:
            self._warn(named, error)

    def _new_id(self, named: Named) -> int:
        self._last_id += 1
        self._names[self._last_id] = named
        return self._last_id

    def _warn(self, named: Named, error: Exception) -> None:
        """Log once per type that no node describes it."""
        if named.type_name in self._unknown:
            return
        self._unknown.add(named.type_name)
        self._session.rights.note_failure(error, f"{named.name} is left out")
        text = f"{named.name} is not announced: {str(error) or 'no node describes its type'}"
        status = {"level": WARNING, "message": text, "id": named.type_name}
        self._session.outbox.send(frames.op_frame("status", status))

    async def _channel(self, named: Named) -> None:
        described = schema(named.type_name, await self._session.message_class(named.type_name))
        channel_id = self._topics[named] = self._new_id(named)
        channel = {"id": channel_id, "topic": named.name, **described}
        self._tell("advertise", "channels", channel)

    async def _offer(self, named: Named) -> None:
        cls = await self._session.service_class(named.type_name)
        described = {
            part.lower(): schema(f"{named.type_name}_{part}", getattr(cls, part))
            for part in ("Request", "Response")
        }
        service_id = self._services[named] = self._new_id(named)
        service = {"id": service_id, "name": named.name, "type": named.type_name, **described}
        self._tell("advertiseServices", "services", service)

    def _tell(self, op: str, field: str, item: dict[str, Any]) -> None:
        """Send a new channel or service, in one frame with the others of this loop iteration.

        In a large system, one frame for each would exceed the limit of what may wait for the
        client.
        """
        if not self._news:
            asyncio.get_running_loop().call_soon(self._send_news)
        self._news.setdefault((op, field), []).append(item)

    def _send_news(self) -> None:
        for (op, field), items in self._news.items():
            self._session.outbox.send(frames.op_frame(op, {field: items}))
        self._news.clear()

    def service(self, service_id: int) -> Named:
        """Return the service that was announced to the client with this id.

        Raises:
            MessageError: there is none.
        """
        named = self._names.get(service_id)
        if named is None or named not in self._services:
            raise MessageError("call", f"service {service_id} does not exist any more")
        return named

    # Subscriptions of the client

    async def subscribe(self, subscription_id: int, channel_id: int) -> None:
        """Send the messages of a channel to the client, from now on.

        Raises:
            MessageError: there is no such channel, or the id is in use.
            RefusedError: the policy refuses it.
        """
        named = self._names.get(channel_id)
        if named is None or named not in self._topics:
            raise MessageError("subscribe", f"channel {channel_id} does not exist any more")
        if subscription_id in self._subscriptions:
            raise MessageError("subscribe", f"subscription id {subscription_id} is in use")

        def frame(received: Received) -> Frame:
            return frames.message_frame(subscription_id, self._time_ns(received), received.raw)

        subscribed = await self._session.subscribe(
            named.name,
            named.type_name,
            frame=frame,
            key=("foxglove", subscription_id),
            depth=DEPTH,
        )
        self._subscriptions[subscription_id] = (channel_id, subscribed)

    def tell_ended(self, ended: list[Subscribed]) -> None:
        """Tell the client which of its subscriptions a change of policy has ended."""
        for subscription_id, (_, subscribed) in list(self._subscriptions.items()):
            if subscribed in ended:
                del self._subscriptions[subscription_id]
                text = f"{subscribed.topic}: the policy has ended the subscription"
                status = {"level": WARNING, "message": text, "id": f"ended {subscribed.topic}"}
                self._session.outbox.send(frames.op_frame("status", status))

    def unsubscribe(self, subscription_ids: Iterable[int]) -> None:
        """End subscriptions; unknown ones have already ended with their channel."""
        for number in list(subscription_ids):
            if number in self._subscriptions:
                self._subscriptions.pop(number)[1].close()


def everyone(types: dict[str, list[str]]) -> set[Named]:
    """Yield each name with each of its types."""
    return {Named(name, kind) for name, kinds in types.items() for kind in kinds}


def schema(type_name: str, cls: Any) -> dict[str, Any]:
    """Return how messages of a class are encoded, as Foxglove describes it."""
    return {
        "encoding": "cdr",
        "schemaName": type_name,
        "schemaEncoding": "ros2msg",
        "schema": definition_of(cls),
    }
