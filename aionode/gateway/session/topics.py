"""The topics of a client: its subscriptions and its publishers."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import S_TO_NS, Duration
from aionode.engine.wire import cdr
from aionode.errors import AionodeError, RefusedError
from aionode.gateway.session.base import HAS_WAITED, SessionBase
from aionode.gateway.session.command import check_age
from aionode.gateway.session.encoding.large_json import prepare_json
from aionode.gateway.session.encoding.values import json_of
from aionode.gateway.session.feed import Received
from aionode.gateway.session.pacing import Pacing
from aionode.gateway.session.preparing import Preparing, prepared
from aionode.gateway.session.refusals import Refusal
from aionode.message import Message
from aionode.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Decision, Verb
    from aionode.gateway.session.outbox import Frame
    from aionode.gateway.session.preparing import Prepare

__all__ = ["SessionTopics", "Subscribed"]

PUBLISHED: Final = QoSProfile(
    depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=1)
)
"""For publishers of clients, which publish at once: a subscription within a second gets it."""

COMMANDS: Final = QoSProfile(depth=10)
"""For commands: an old one must not reach a subscription that comes late."""


EVENT: Final = "rcl_interfaces/msg/ParameterEvent"
"""Has values of parameters, of which a client may not see each."""


class Subscribed:
    """A subscription of a client; `close` ends it.

    Attributes:
        topic: The full name of the topic.
        type_name: The name of its type.
        message_class: The class of its messages.
        failed: How many messages had no frame, because they are malformed.
        take: Takes each message of the topic.
    """

    def __init__(
        self,
        session: SessionTopics,
        topic: str,
        message_class: Any,
        frame: Callable[[Received], Frame | None],
        key: Hashable,
        depth: int,
        min_period_sec: float,
        prepare: Prepare | None,
    ) -> None:
        self.topic = topic
        self.message_class = message_class
        self.type_name: str = message_class.__ros_type__
        self.failed = 0
        self._session = session
        session._topics_of[key] = topic
        self._frame = frame
        self._key = key
        self._depth = depth
        self._leave: Callable[[], None] | None = None
        self._preparing: Preparing | None = None
        self._pacing: Pacing | None = None
        self.take = self._deliver
        if prepare is not None:
            on_drop = partial(session._note_slow, key)
            self._preparing = Preparing(session._robot, prepare, self._deliver, depth, on_drop)
            self.take = self._preparing.put
        if min_period_sec:
            period_ns = round(min_period_sec * S_TO_NS)
            self._pacing = Pacing(session._robot.time_base, period_ns, self.take, depth)
            self.take = self._pacing.put
        if self.type_name == EVENT:
            self.take = partial(self._take_seen, self.take)

    @property
    def dropped(self) -> int:
        """The number of messages that were dropped, as encoding them or the client was too slow."""
        unprepared = 0 if self._preparing is None else self._preparing.dropped
        return unprepared + self._session.outbox.dropped.get(self._key, 0)

    def _take_seen(self, take: Callable[[Received], None], received: Received) -> None:
        """Take of an event of parameters what the client may see."""
        try:
            seen = self._session.seen_event(received)
        except AionodeError as error:
            self._note_unreadable(error)
            return
        if seen is not None:
            take(seen)

    def _deliver(self, received: Received) -> None:
        try:
            frame = self._frame(received)
        except (AionodeError, ValueError) as error:
            self._note_unreadable(error)
            return
        if frame is not None:
            self._session.outbox.put(self._key, frame, self._depth)

    def _note_unreadable(self, error: Exception) -> None:
        self.failed += 1
        self._session.note(Refusal.UNREADABLE, f"subscribe {self.topic}", str(error))

    def close(self) -> None:
        """Unsubscribe; frames that wait for the client are dropped."""
        if self._leave is not None:
            self._leave()
            self._leave = None
            for waiting in (self._pacing, self._preparing):
                if waiting is not None:
                    waiting.close()
            self._session._subscribed.pop(self, None)
            self._session._topics_of.pop(self._key, None)
            self._session.outbox.discard(self._key)


def ignore(_: object) -> None:
    """Do nothing."""


class SessionTopics(SessionBase):
    """The part of `Session` that subscribes and publishes.

    Attributes:
        on_policy: Called when the policy has changed, with the subscriptions that it has ended.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.on_policy: Callable[[list[Subscribed]], object] = ignore
        self._subscribed: dict[Subscribed, None] = {}
        self._published: dict[str, tuple[Any, Callable[[], None]]] = {}
        self._counts: dict[str, int] = defaultdict(int)
        self._noted_ns: dict[str, int] = {}

    @property
    def publishes(self) -> bool:
        """Whether the client has advertised or published on a topic."""
        return bool(self._published)

    async def subscribe(
        self,
        topic: str,
        type_name: str | None = None,
        *,
        frame: Callable[[Received], Frame | None],
        key: Hashable,
        depth: int = 10,
        qos: QoSProfile | None = None,
        min_period_sec: float = 0.0,
        prepare: Prepare | None = None,
    ) -> Subscribed:
        """Put each message of a topic into the outbox.

        Args:
            topic: The name of the topic.
            type_name: The name of its type; by default that which the graph shows.
            frame: Returns the client's frame for a message, or None for none.
            key: Which queue of the outbox it waits in.
            depth: How many frames may wait there, and messages for their time.
            qos: The profile; by default the strongest that all publishers offer.
            min_period_sec: The shortest time between two messages, in seconds; of those that come
                faster the newest wait, and the others are left out.
            prepare: Encodes a large message, so that `frame` has little left to do; see
                `Preparing`.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the topic or its type.
            InvalidTopicNameException: the name is invalid (a ValueError).
        """
        topic = self.topic_name(topic)
        most = self._limits.subscriptions
        with self._one_more("subscribe", topic, "subscriptions", self._subscribed, most):
            message_class = await self._type_to("subscribe", topic, type_name)
            await self._allow("subscribe", topic, message_class.__ros_type__, None)
            subscribed = Subscribed(
                self, topic, message_class, frame, key, depth, min_period_sec, prepare
            )
            subscribed._leave = self._robot.feeds.add(topic, message_class, qos, subscribed.take)
            self._subscribed[subscribed] = None
        self._robot.audit.note(self.identity, "subscribe", topic, way=self.kind)
        return subscribed

    async def advertise(
        self, topic: str, type_name: str | None = None, qos: QoSProfile | None = None
    ) -> None:
        """Make a publisher, which others that publish the same share.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the type.
            InvalidTopicNameException: the name is invalid (a ValueError).
        """
        topic = self.topic_name(topic)
        if topic in self._published:
            return
        if topic == self._robot.audit.topic:
            raise self._refused("publish", topic, "the gateway alone writes it", "not_allowed")
        what, most = "topics that it publishes", self._limits.advertised
        with self._one_more("publish", topic, what, self._published, most):
            message_class = await self._type_to("publish", topic, type_name)
            decision = self.decide("publish", topic, message_class.__ros_type__)
            if topic in self._published:  # advertised twice at once
                return
            profile = COMMANDS if decision.lease is not None else qos or PUBLISHED
            make = partial(self._robot.node.create_publisher, message_class, topic, profile)
            key = ("publisher", topic, message_class, str(profile))
            self._published[topic] = self._robot.shared.take(key, make)
        self._robot.audit.note(self.identity, "advertise", topic, way=self.kind)

    async def publish(
        self,
        topic: str,
        values: Message | Mapping[str, Any] | list[Any] | bytes,
        type_name: str | None = None,
        *,
        arrived_ns: int | None = None,
    ) -> None:
        """Publish a message, or a command if the policy says that the topic has commands.

        Args:
            topic: The name of the topic.
            values: The message, its values, or its CDR bytes.
            type_name: The type, if the client has not advertised the topic.
            arrived_ns: When the frame arrived, in nanoseconds of the steady clock; by default when
                that which is handled did.

        Raises:
            RefusedError: the policy does not allow it; another client commands the topic; the
                command is too old.
            MessageError: a value does not fit its field (a ValueError).
            DecodeError: the bytes are no such message (a ValueError).
            InterfaceNotFoundError: nobody knows the type.
        """
        arrived_ns = self.arrival_ns() if arrived_ns is None else arrived_ns
        topic = self.topic_name(topic)
        if topic not in self._published:
            await self.advertise(topic, type_name)
        publisher = self._published[topic][0]
        message = await self.message_of(publisher.msg_type, values)
        decision = await self._allow("publish", topic, message.__ros_type__, message)
        self._check_size("publish", topic, decision, message)
        try:
            await self._send(publisher, decision, message, arrived_ns)
        except RefusedError as error:
            raise self._refused("publish", topic, error.reason, error.code, message) from error
        self._note_published(topic, decision.message)

    async def _send(
        self, publisher: Any, decision: Decision, message: Message, arrived_ns: int
    ) -> None:
        """Publish a message within the limits of the policy, by lease if it says so.

        Raises:
            RefusedError: another client commands the topic; the command is too old.
        """
        lease, commands, topic = decision.lease, self._robot.commands, publisher.topic_name
        if lease is None:
            commands.refuse_if_held(topic, self.owner)
            publisher.publish(decision.message)
            return
        if self.connection is None and arrived_ns <= self._robot.standstills.until_ns:
            raise RefusedError(f"publish {topic}", HAS_WAITED, "too_old")
        if self.is_doubtful or arrived_ns <= self._doubted_ns:
            reason = "it may be from before a silence of the client, which has to answer a ping"
            raise RefusedError(f"publish {topic}", reason, "too_old")
        now_ns = self._robot.node.get_clock().now().nanoseconds
        check_age(topic, message, lease, now_ns=now_ns, arrived_ns=arrived_ns,
                  time_base=self._robot.time_base)  # fmt: skip
        await commands.publish(publisher, self.owner, self.identity, lease, decision.message)

    async def json_of(self, received: Received) -> bytes:
        """Return the JSON of a message of a topic, which is written once for all clients.

        The event loop turns while a large one is written.

        Raises:
            DecodeError: the bytes are no message of its type (a ValueError).
        """
        await prepared(self._robot, prepare_json, received)
        return received.once("json", lambda taken: json_of(taken.message))

    def seen_event(self, received: Received) -> Received | None:
        """Return the event of parameters that the client may see; None without any.

        Raises:
            DecodeError: the bytes are no such event (a ValueError).
        """
        event = received.message
        lists = ("new_parameters", "changed_parameters", "deleted_parameters")
        seen = {
            name: [each for each in getattr(event, name)
                   if self._sees(f"{event.node}:{each.name}", [])]
            for name in lists
        }  # fmt: skip
        if all(len(seen[name]) == len(getattr(event, name)) for name in lists):
            return received
        if not any(seen.values()):
            return None
        raw = cdr.encode(type(event)(stamp=event.stamp, node=event.node, **seen))
        return Received(
            received.topic, received.type_name, received.message_class, raw,
            received.time_ns, received.source_ns,
        )  # fmt: skip

    async def _type_to(self, verb: Verb, topic: str, type_name: str | None) -> Any:
        """Return the class of a topic's messages, if the policy may allow a verb.

        Only then is a type looked up, imported, or asked from a node.

        Raises:
            RefusedError: the policy does not allow it, whatever the type is.
            InterfaceNotFoundError: nobody knows the topic or its type.
        """
        self.decide(verb, topic, "")
        return await self.message_class(type_name or self.type_of(topic, "topic"))

    def dropped(self) -> dict[str, int]:
        """Return how many frames of each topic were dropped, as the client was too slow."""
        counts: dict[str, int] = defaultdict(int)
        for subscribed in self._subscribed:
            counts[subscribed.topic] += subscribed.dropped
        return dict(counts)

    def _note_published(self, topic: str, message: Message) -> None:
        """Write down the publishing: once a second for each topic, with a count."""
        self._counts[topic] += 1
        now_ns = self._robot.time_base.steady_ns()
        if now_ns - self._noted_ns.get(topic, -S_TO_NS) >= S_TO_NS:
            self._noted_ns[topic] = now_ns
            self._robot.audit.note(
                self.identity, "publish", topic, arguments=message,
                count=self._counts.pop(topic), way=self.kind,
            )  # fmt: skip

    async def unadvertise(self, topic: str) -> None:
        """Give a publisher back, and end the lease of its commands, which sends the stop."""
        topic = self.topic_name(topic)
        await self._robot.commands.leave(self.owner, topic)
        self._give_back(topic)

    def _give_back(self, topic: str) -> None:
        published = self._published.pop(topic, None)
        self._counts.pop(topic, None)
        self._noted_ns.pop(topic, None)
        if published is not None:
            published[1]()
