"""Topics as clients receive them: one subscription for all, and each message encoded once."""

from __future__ import annotations

from collections import deque
from collections.abc import Awaitable, Callable, Hashable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from aionode._process.concurrency import run_in_thread
from aionode.endpoints.core.subscription_reader import size_of_raw
from aionode.endpoints.events import SubscriptionEventCallbacks
from aionode.engine.wire import cdr
from aionode.graph import EndpointKind
from aionode.node import parts_subscription
from aionode.qos import (
    DurabilityPolicy,
    QoSProfile,
    ReliabilityPolicy,
    best_available_for_subscription,
    qos_profile_best_available,
)

if TYPE_CHECKING:
    from aionode.endpoints.core.subscription_reader import Parts
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["Feed", "Feeds", "Received"]

T = TypeVar("T")

DEPTH: Final = 100
"""The depth of subscriptions: the loop may be busy for some milliseconds."""

UNDEMANDING: Final = QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
"""The QoS while there is no publisher, compatible with anything that the first one may offer."""

MAX_LATCHED: Final = 100
"""Number of messages of each transient local publisher to keep for late clients."""

MAX_LATCHED_BYTES: Final = 32 << 20
"""Most bytes of these messages, though the last one is always kept."""

BESIDE_BYTES: Final = 1 << 20
"""Size from which a message is copied in a thread: at once, it would block the loop for long."""


class Received:
    """A message of a topic, shared by all clients: decoded once, and encoded once for each format.

    Attributes:
        topic: The full name of its topic.
        type_name: The name of its type.
        message_class: The class of its messages.
        time_ns: When it arrived, in nanoseconds since 1970.
        source_ns: When it was published, in nanoseconds since 1970; 0 if unknown.
        raw: Its CDR bytes, with their header, in memory of this process.
    """

    __slots__ = ("_kinds", "_message", "message_class", "raw", "source_ns", "time_ns", "topic",
                 "type_name")  # fmt: skip

    def __init__(
        self,
        topic: str,
        type_name: str,
        message_class: type,
        raw: bytes | memoryview,
        time_ns: int,
        source_ns: int = 0,
    ) -> None:
        self.topic = topic
        self.type_name = type_name
        self.message_class = message_class
        self.raw = raw
        self.time_ns = time_ns
        self.source_ns = source_ns
        self._message: Any = None
        self._kinds: dict[Hashable, Any] = {}

    @property
    def message(self) -> Any:
        """The message, decoded on first use.

        Raises:
            DecodeError: the bytes are not a message of that type.
        """
        if self._message is None:
            self._message = cdr.decode(self.message_class, self.raw)
        return self._message

    def has(self, key: Hashable) -> bool:
        """Return whether `once` has a result for a key."""
        return key in self._kinds

    def once(self, key: Hashable, make: Callable[[Received], T]) -> T:
        """Return the result of `make`, which is called only once per key.

        Args:
            key: The kind of encoding.
            make: Returns the encoding.
        """
        try:
            encoded: T = self._kinds[key]
        except KeyError:
            encoded = self._kinds[key] = make(self)
        return encoded


Taker = Callable[[Received], None]


class Feed:
    """The subscription to one topic, for all clients with the same requirements."""

    def __init__(
        self, node: Node, topic: str, message_class: Any, profile: QoSProfile | None
    ) -> None:
        self.topic = topic
        self.type_name: str = message_class.__ros_type__
        self.message_class = message_class
        self.received = 0
        self._node = node
        self._wanted = profile
        self._takers: dict[object, Taker] = {}
        self._latched: dict[bytes, deque[Received]] = {}
        self._depths: dict[bytes, int] = {}
        self._offered: dict[bytes, QoSProfile] = {}
        self._subscription: Subscription[Parts] | None = None
        self._unwatch = node.graph.watch(EndpointKind.PUBLISHER, topic, self._note_publisher)
        self._subscribe()

    def add(self, taker: Taker) -> Callable[[], bool]:
        """Call `taker` with each message, starting with those kept for late subscriptions.

        Returns:
            A function that ends this, and returns whether the feed has no takers left.
        """
        key = object()
        self._takers[key] = taker
        for kept in list(self._latched.values()):
            for received in list(kept):
                taker(received)

        def remove() -> bool:
            self._takers.pop(key, None)
            return not self._takers

        return remove

    @property
    def dropped(self) -> int:
        """The number of messages dropped by the subscription, or lost in transit."""
        if self._subscription is None:
            return 0
        return self._subscription.stats.dropped + self._subscription.stats.lost

    def close(self) -> None:
        """Unsubscribe."""
        self._unwatch()
        if self._subscription is not None:
            self._subscription.destroy()
            self._subscription = None

    def _note_publisher(self, publisher: EndpointInfo, present: bool) -> None:
        """Subscribe again if the publishers now offer something else."""
        if present:
            self._offered[publisher.gid] = publisher.qos
        else:
            self._offered.pop(publisher.gid, None)
            self._latched.pop(publisher.gid, None)
        subscription = self._subscription
        if subscription is not None and self._profile() != subscription.qos_profile:
            self._subscribe()

    def _profile(self) -> QoSProfile:
        """Return the strongest profile that matches all publishers; without any, the weakest."""
        if self._wanted is not None:
            return self._wanted
        if not self._offered:
            return UNDEMANDING
        profile = qos_profile_best_available.replace(depth=DEPTH)
        return best_available_for_subscription(profile, self._offered.values())

    def _subscribe(self) -> None:
        if self._subscription is not None:
            self._subscription.destroy()
        # A new publisher's different QoS is not a mistake: the feed subscribes again for it.
        ignore = None if self._wanted is not None else ignore_incompatible_qos
        self._subscription = parts_subscription(
            self._node,
            self.message_class,
            self.topic,
            self._take,
            self._profile(),
            SubscriptionEventCallbacks(incompatible_qos=ignore),
        )

    def _take(self, raw: Parts, info: MessageInfo) -> Awaitable[None] | None:
        """Take a message; the next one waits until a large one is copied, in a thread.

        Its sender may be waiting for the memory, which a client could occupy for long.
        """
        if isinstance(raw, bytes):
            self._accept(raw, info)
        elif size_of_raw(raw) < BESIDE_BYTES:
            self._accept(b"".join(raw) if isinstance(raw, list) else bytes(raw), info)
        else:
            return self._copy_and_accept(raw, info)
        return None

    async def _copy_and_accept(self, raw: Parts, info: MessageInfo) -> None:
        self._accept(await run_in_thread(joined, raw), info)

    def _accept(self, raw: bytes | memoryview, info: MessageInfo) -> None:
        self.received += 1
        received = Received(
            self.topic,
            self.type_name,
            self.message_class,
            raw,
            info["received_timestamp"],
            info["source_timestamp"],
        )
        gid = info["publisher_gid"]
        offered = self._offered.get(gid)
        if offered is not None and offered.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            depth = min(max(offered.depth, 1), MAX_LATCHED)
            kept = self._latched.setdefault(gid, deque(maxlen=depth))
            kept.append(received)
            while len(kept) > 1 and sum(len(older.raw) for older in kept) > MAX_LATCHED_BYTES:
                kept.popleft()
        for taker in tuple(self._takers.values()):
            taker(received)


def joined(raw: Parts) -> memoryview:
    """Return a copy of a message, in one piece.

    It is made by numpy, which lets other threads run meanwhile.
    """
    copy: Any = np.empty(size_of_raw(raw), np.uint8)
    end = 0
    for part in raw if isinstance(raw, list) else [raw]:
        begin, end = end, end + len(part)
        copy[begin:end] = np.frombuffer(part, np.uint8)
    return memoryview(copy).toreadonly()


def ignore_incompatible_qos(info: object) -> None:
    """Keep the warning about incompatible QoS out of the log."""


class Feeds:
    """The feeds of a gateway, by topic, type and profile; each ends with its last client."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._feeds: dict[Hashable, Feed] = {}

    def __iter__(self) -> Any:
        """Iterate over the feeds."""
        return iter(self._feeds.values())

    def add(
        self, topic: str, message_class: Any, profile: QoSProfile | None, taker: Taker
    ) -> Callable[[], None]:
        """Call `taker` with each message of a topic; return a function that ends this."""
        key = (topic, message_class, None if profile is None else str(profile))
        feed = self._feeds.get(key)
        if feed is None:
            feed = self._feeds[key] = Feed(self._node, topic, message_class, profile)
        remove = feed.add(taker)

        def leave() -> None:
            if remove() and self._feeds.get(key) is feed:
                del self._feeds[key]
                feed.close()

        return leave
