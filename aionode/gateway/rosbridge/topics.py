"""The ops of rosbridge for topics."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import Duration
from aionode.errors import AionodeError, MessageError
from aionode.gateway.rosbridge.request import id_of, number, profile, text, values
from aionode.gateway.session.delivery.outbox import LongFrame
from aionode.gateway.session.encoding.client_json import type_text
from aionode.gateway.session.encoding.frames import (
    Fragmented,
    cbor_frame,
    cbor_raw_frame,
    json_frame,
    long_json_frame,
    png_frame,
    png_frame_in_turns,
)
from aionode.gateway.session.encoding.large_json import pieces_of
from aionode.gateway.session.encoding.values import json_of
from aionode.gateway.session.refusals import Refusal
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from aionode.gateway.rosbridge.link import Link
    from aionode.gateway.session.delivery.outbox import Frame
    from aionode.gateway.session.delivery.preparing import Prepare
    from aionode.gateway.session.delivery.subscribed import Subscribed
    from aionode.gateway.session.feed import Received

__all__ = ["Topics"]

Op = dict[str, Any]

COMPRESSIONS: Final = ("none", "png", "cbor", "cbor-raw")
"""In ascending order: a client's subscription uses the highest that any of its ids requests."""

DEFAULT_DEPTH: Final = 100
"""Messages per topic that wait for a client without a ``queue_length``; with a ``throttle_rate``
only the newest waits, since it is late already."""

PUBLISHER_DEPTH: Final = 100

MAX_IDS: Final = 64
"""Number of ids that a client may use for one topic."""

LATCH_SEC: Final = 1.0
"""How long a message waits for subscriptions that appear after it, unless latched: a client that
advertises and publishes at once reaches subscriptions that are just being matched."""


@dataclass(frozen=True)
class Wish:
    """How a client wants to receive a topic, for one id of its subscriptions.

    Attributes:
        type_name: The type, or None for that of the topic.
        period_sec: The shortest time between messages, in seconds.
        depth: Maximum number of messages that wait.
        fragment_size: The longest frame, in characters; 0 for any.
        compression: One of `COMPRESSIONS`.
        qos: The profile, or None for one that fits the publishers.
    """

    type_name: str | None
    period_sec: float
    depth: int
    fragment_size: float
    compression: str
    qos: QoSProfile | None


def wish_of(op: Op) -> Wish:
    """Return the wish in a ``subscribe`` op.

    Raises:
        MessageError: a field is invalid.
    """
    compression = text(op, "compression", "none")
    if compression not in COMPRESSIONS:
        fitting = ", ".join(COMPRESSIONS)
        raise MessageError("subscribe.compression", f"{compression!r}; use one of {fitting}")
    period_sec = number(op, "throttle_rate") / 1000
    return Wish(
        type_text(text(op, "type", ""), "msg") or None,
        period_sec,
        int(number(op, "queue_length")) or (1 if period_sec else DEFAULT_DEPTH),
        number(op, "fragment_size"),
        compression,
        profile(op, QoSProfile(depth=10)),
    )


def combined(wishes: list[Wish]) -> Wish:
    """Combine the wishes of a client's ids: the fastest, the longest queue, the newest QoS."""
    return Wish(
        next((wish.type_name for wish in wishes if wish.type_name is not None), None),
        min(wish.period_sec for wish in wishes),
        max(wish.depth for wish in wishes),
        min((wish.fragment_size for wish in wishes if wish.fragment_size), default=0),
        max((wish.compression for wish in wishes), key=COMPRESSIONS.index),
        next((wish.qos for wish in reversed(wishes) if wish.qos is not None), None),
    )


@dataclass
class View:
    """The messages of one topic in the form that one client gets."""

    wish: Wish
    subscribed: Subscribed
    queue: int


class Topics:
    """The subscriptions and publishers of one client.

    Args:
        link: The way to the client.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self._session = link.session
        self._wishes: dict[str, dict[str | None, Wish]] = {}
        self._views: dict[str, View] = {}
        self._advertised: dict[str, set[str | None]] = {}
        self._fragmented = 0
        self._session.on_policy = self._tell_ended

    async def advertise(self, op: Op) -> None:
        """Create a publisher for the client."""
        topic = self._session.topic_name(text(op, "topic"))
        type_name = type_text(text(op, "type"), "msg")
        await self._advertise(topic, type_name, op)
        ids, message_id = self._advertised.setdefault(topic, set()), id_of(op)
        refuse_more(ids, message_id, "advertise.id")
        ids.add(message_id)

    async def unadvertise(self, op: Op) -> None:
        """Withdraw the topic advertised with one id, or with all ids."""
        topic, message_id = self._session.topic_name(text(op, "topic")), id_of(op)
        ids = self._advertised.get(topic)
        if ids is None or (message_id is not None and message_id not in ids):
            raise MessageError("unadvertise.topic", f"{topic} is not advertised with this id")
        ids.discard(message_id)
        if message_id is None or not ids:
            del self._advertised[topic]
            await self._session.unadvertise(topic)

    async def publish(self, op: Op, arrived_ns: int | None = None) -> None:
        """Publish a message; a topic that is not advertised is now advertised with its type."""
        topic = self._session.topic_name(text(op, "topic"))
        type_name = type_text(text(op, "type", ""), "msg") or None
        if topic not in self._advertised:
            await self._advertise(topic, type_name, op)
            self._advertised[topic] = {None}
        message = values(op, "msg")
        await self._session.publish(topic, message, type_name, arrived_ns=arrived_ns)

    async def _advertise(self, topic: str, type_name: str | None, op: Op) -> None:
        """Create a publisher, unless no subscription of the topic could receive from it.

        Raises:
            RefusedError: the policy does not allow it.
            MessageError: the topic has another type.
        """
        self._session.rights.decide("publish", topic, "")
        types = self._session.graph.types_of(topic, "topic")
        if types and type_name is not None and type_name not in types:
            problem = f"{topic} has the type {', '.join(types)}, not {type_name}"
            raise MessageError(f"{op['op']}.type", problem)
        await self._session.advertise(topic, type_name, publisher_profile(op))

    async def subscribe(self, op: Op) -> None:
        """Send the client the messages of a topic.

        Each op subscribes anew, so that a client's second one also gets the messages that
        publishers keep for late subscriptions.
        """
        topic, message_id = text(op, "topic"), id_of(op)
        earlier = self._wishes.get(topic, {})
        refuse_more(earlier, message_id, "subscribe.id")
        wishes = earlier | {message_id: wish_of(op)}
        await self._open(topic, combined(list(wishes.values())))
        self._wishes[topic] = wishes

    async def unsubscribe(self, op: Op) -> None:
        """End one id of a subscription, or all ids of a topic."""
        topic, message_id = text(op, "topic"), id_of(op)
        wishes = self._wishes.get(topic)
        if wishes is None or (message_id is not None and message_id not in wishes):
            raise MessageError("unsubscribe.topic", f"{topic} is not subscribed with this id")
        left = {key: wish for key, wish in wishes.items() if message_id not in {None, key}}
        if not left:
            del self._wishes[topic]
            self._views.pop(topic).subscribed.close()
            return
        wish = combined(list(left.values()))
        if wish != self._views[topic].wish:
            await self._open(topic, wish)
        self._wishes[topic] = left

    async def _open(self, topic: str, wish: Wish) -> None:
        """Subscribe to a topic; the client's earlier subscription then ends."""
        earlier = self._views.get(topic)
        # The end of the earlier subscription empties its queue, so the new one uses another queue.
        queue = 0 if earlier is None else 1 - earlier.queue
        subscribed = await self._session.subscribe(
            topic,
            wish.type_name,
            frame=self._frames(topic, wish),
            prepare=prepare_of(wish.compression, topic),
            key=("rosbridge", topic, queue),
            depth=wish.depth,
            qos=wish.qos,
            min_period_sec=wish.period_sec,
        )
        self._views[topic] = View(wish, subscribed, queue)
        if earlier is not None:
            earlier.subscribed.close()

    def _tell_ended(self, ended: list[Subscribed]) -> None:
        """Tell the client which topics a changed policy no longer allows."""
        for topic, view in list(self._views.items()):
            if view.subscribed in ended:
                del self._views[topic], self._wishes[topic]
                self._link.status("error", f"subscribe: the policy has ended {topic}")

    def _frames(self, topic: str, wish: Wish) -> Callable[[Received], Frame | None]:
        """Return a function that encodes a message as a frame, once for equal wishes."""
        kind = ("rosbridge", wish.compression, topic)
        make = partial(frame_of, wish.compression, topic)

        def frame(received: Received) -> Frame | None:
            try:
                encoded = received.once(kind, make)
            except AionodeError as error:  # a peer sent bytes that are not a message of the type
                self._session.rights.note(Refusal.UNREADABLE, f"subscribe {topic}", str(error))
                self._link.status("error", f"subscribe: {error}")
                return None
            return self._fragments(encoded, wish) if wish.fragment_size else encoded

        return frame

    def _fragments(self, frame: Frame, wish: Wish) -> Frame:
        """Return a frame that is sent in fragments, if it is text."""
        if isinstance(frame, bytes) or (isinstance(frame, LongFrame) and not frame.is_text):
            return frame
        self._fragmented += 1
        return Fragmented.of(str(frame), max(int(wish.fragment_size), 1), str(self._fragmented))


def frame_of(compression: str, topic: str, received: Received) -> Frame:
    """Return the frame of a message, under the topic name that the client uses."""
    if compression == "cbor-raw":
        return cbor_raw_frame(topic, received.raw, received.time_ns)
    if compression == "cbor":
        return cbor_frame(topic, received.message)
    frame = json_frame(topic, received.once("json", plain_json))
    return png_frame(frame) if compression == "png" else frame


def prepare_of(compression: str, topic: str) -> Prepare | None:
    """Return a function that encodes large messages; None if encoding takes next to no time."""
    prepared = {"none": prepare_text, "png": prepare_png}.get(compression)
    return None if prepared is None else partial(prepared, topic)


async def prepare_text(topic: str, received: Received) -> None:
    """Encode a large message as a JSON frame."""
    kind = ("rosbridge", "none", topic)
    if not received.has(kind):
        frame = long_json_frame(topic, await pieces_of(received))
        received.once(kind, lambda _: frame)


async def prepare_png(topic: str, received: Received) -> None:
    """Encode a large message as an image; compression takes most of a second."""
    kind = ("rosbridge", "png", topic)
    if not received.has(kind):
        text = str(long_json_frame(topic, await pieces_of(received)))
        frame = await png_frame_in_turns(text)
        received.once(kind, lambda _: frame)


def plain_json(received: Received) -> bytes:
    """Return a message as JSON."""
    return json_of(received.message)


def refuse_more(ids: Collection[str | None], message_id: str | None, field: str) -> None:
    """Refuse one more id of a topic beyond `MAX_IDS`.

    Raises:
        MessageError: the topic has that many ids.
    """
    if message_id not in ids and len(ids) >= MAX_IDS:
        raise MessageError(field, f"the topic already has {MAX_IDS} ids, which is the limit")


def publisher_profile(op: Op) -> QoSProfile:
    """Return the QoS of a publisher that a client requests."""
    depth = int(number(op, "queue_size")) or PUBLISHER_DEPTH
    is_latched = bool(op.get("latch"))
    start = QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=1 if is_latched else min(depth, 10_000),
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        lifespan=Duration() if is_latched else Duration(seconds=LATCH_SEC),
    )
    return profile(op, start) or start
