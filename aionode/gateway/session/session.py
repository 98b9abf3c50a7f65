"""The session of one client: each protocol creates one, and it asks the policy first."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import (
    AsyncIterator,
    Awaitable,
    Callable,
    Hashable,
    Iterator,
    Mapping,
)
from contextlib import asynccontextmanager, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Self

from aionode._process.concurrency import run_in_thread
from aionode.clock import S_TO_NS, Duration
from aionode.errors import AionodeError, RefusedError, ServiceError
from aionode.gateway.session.arrivals import Arrivals
from aionode.gateway.session.calls import decide_call, seen_response
from aionode.gateway.session.command import check_age
from aionode.gateway.session.delivery.outbox import Outbox
from aionode.gateway.session.delivery.preparing import prepared
from aionode.gateway.session.delivery.subscribed import Subscribed
from aionode.gateway.session.encoding.client_json import is_large
from aionode.gateway.session.encoding.large_json import prepare_json
from aionode.gateway.session.encoding.values import json_of
from aionode.gateway.session.graph import GraphView
from aionode.gateway.session.messages import as_message, large_message
from aionode.gateway.session.parameters import NodeParameters
from aionode.gateway.session.refusals import Refusal
from aionode.gateway.session.rights import Rights
from aionode.gateway.session.serving import Served, serve, serve_action
from aionode.message import Message
from aionode.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.gateway.policy.identity import Credentials, Identity
    from aionode.gateway.policy.policy import Decision, Verb
    from aionode.gateway.session.command import Owner
    from aionode.gateway.session.delivery.outbox import Frame
    from aionode.gateway.session.delivery.preparing import Prepare
    from aionode.gateway.session.feed import Received
    from aionode.gateway.session.robot import Robot

__all__ = ["Session"]

CHANGED: Final = "the policy has changed"

SERVER_SEC: Final = 1.0
"""How long a call or goal waits for its server, in seconds."""

PUBLISHED: Final = QoSProfile(
    depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=1)
)
"""For publishers of clients, which publish at once: a subscription within a second still gets
it."""

COMMANDS: Final = QoSProfile(depth=10)
"""For commands: an old one must not reach a subscription that is created later."""


class Session:
    """Everything that one client does with the robot, and releases when it leaves.

    An async context manager. On exit it closes the subscriptions, ends the leases of commands,
    which sends their stops, cancels the goals, and ends the services that the client offers.

    All methods raise RefusedError, before they touch the robot, if the policy refuses.

    Args:
        robot: The robot, as shared by all sessions of a gateway.
        identity: Who the client is.
        kind: The protocol, for the audit log: ``rosbridge``, ``foxglove``, ``http``, ``mcp``.
        credentials: The evidence of its identity; None if the program creates the session itself.

    Attributes:
        robot: The robot.
        kind: The protocol.
        credentials: The evidence of the client's identity.
        rights: Who the client is, what it may do, and what it was refused.
        arrivals: The arrival times of the client's frames, and whether they may be old.
        graph: The graph as the client may see it.
        parameters: The parameters of nodes.
        outbox: The frames that wait for the client.
        ended: Set when the client has to leave: the gateway is stopping, the policy no longer knows
            the client, or another client takes its place.
        end_reason: The reason given to the client; empty for none.
        owner: The holder of the topics that the client commands: the session, which ends the leases
            when it ends, or something that outlives it.
        on_policy: Called when the policy has changed, with the subscriptions that it has ended.
    """

    def __init__(
        self, robot: Robot, identity: Identity, kind: str, credentials: Credentials | None = None
    ) -> None:
        self.robot = robot
        self.kind = kind
        self.credentials = credentials
        self.rights = Rights(robot, identity, kind)
        self.arrivals = Arrivals(robot, self.rights)
        self.graph = GraphView(robot, self.rights)
        self.parameters = NodeParameters(robot, self.rights, self.arrivals, self.graph)
        self.outbox = Outbox(self.rights.limits.queued_bytes)
        self.outbox.on_drop, self.outbox.on_overflow = self._note_slow, self._note_overflow
        self.ended = asyncio.Event()
        self.end_reason = ""
        self.owner: Owner = self
        self.on_policy: Callable[[list[Subscribed]], object] = ignore
        self._subscribed: dict[Subscribed, None] = {}
        self._topics_of: dict[Hashable, str] = {}  # by the keys of queues in the outbox
        # By topic: the publisher, the function that releases it, and the count since the last audit
        # line.
        self._published: dict[str, tuple[Any, Callable[[], None]]] = {}
        self._counts: dict[str, int] = defaultdict(int)
        self._noted_ns: dict[str, int] = {}
        self._attempts: dict[Attempt, None] = {}
        self._goals: dict[Any, tuple[str, str]] = {}
        self._served: dict[str, Served] = {}
        self._served_types: dict[str, str] = {}

    @property
    def identity(self) -> Identity:
        """Who the client is."""
        return self.rights.identity

    @property
    def way(self) -> str:
        """How the client is connected, for `Owner`."""
        return self.kind

    def doubt(self, *, stood_still: bool = False) -> None:
        """Refuse commands until the client responds; see `Arrivals.doubt`."""
        self.arrivals.doubt(stood_still=stood_still)

    def end(self, reason: str) -> None:
        """End the session, and tell the client why."""
        self.end_reason = reason
        self.rights.note(Refusal.DISCONNECTED, "connection", reason)
        self.ended.set()

    def _note_slow(self, key: Hashable) -> None:
        topic = self._topics_of.get(key, str(key))
        reason = "messages are dropped: it reads more slowly than they arrive"
        self.rights.note(Refusal.SLOW, topic, reason)

    def _note_overflow(self) -> None:
        reason = "it does not read the answers to its requests"
        self.rights.note(Refusal.DISCONNECTED, "connection", reason)

    async def __aenter__(self) -> Self:
        """Start; the robot is not touched yet."""
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Release everything, the stops of leases first."""
        try:
            await self.robot.commands.leave(self)
        finally:
            for goal in list(self._goals):
                async with goal:  # its end cancels the goal, without waiting
                    pass
            for subscribed in list(self._subscribed):
                subscribed.close()
            for topic in list(self._published):
                self._give_back(topic)
            for served in list(self._served.values()):
                served.close()
            self.outbox.close()

    # Names and types

    async def message_class(self, type_name: str) -> Any:
        """Return the class of a message type, from this program or as described by a node.

        Raises:
            InterfaceNotFoundError: nobody knows it.
        """
        return await self.robot.find_type(type_name, "msg")

    async def service_class(self, type_name: str) -> Any:
        """Return the class of a service type; see `message_class`."""
        return await self.robot.find_type(type_name, "srv")

    async def action_class(self, type_name: str) -> Any:
        """Return the class of an action type; see `message_class`."""
        return await self.robot.find_type(type_name, "action")

    async def message_of(
        self, cls: Any, values: Message | Mapping[str, Any] | list[Any] | bytes
    ) -> Any:
        """Return a message of a class; see `as_message`.

        A large one is created in a thread, one at a time, as that takes up to a second. It may not
        take more memory than a frame of a client: in JSON, a large message is quickly written.
        """
        clock = self.robot.node.get_clock()
        if isinstance(values, Message) or not is_large(values):
            return as_message(cls, values, clock)
        async with self.robot.making:
            return await run_in_thread(
                large_message, cls, values, clock, self.rights.limits.frame_bytes
            )

    def now_ns(self) -> int:
        """Return the time of the node's clock, which may be simulated, in nanoseconds."""
        return self.robot.node.get_clock().now().nanoseconds

    def steady_ns(self) -> int:
        """Return the time of the steady clock in nanoseconds, for `arrived_ns` of `publish`."""
        return self.robot.time_base.steady_ns()

    def topic_name(self, name: str) -> str:
        """Return the full name of a topic or action, as the node resolves it.

        Raises:
            InvalidTopicNameException: it is invalid (a ValueError).
        """
        return self._settled(self.robot.node.resolve_topic_name, name)

    def service_name(self, name: str) -> str:
        """Return the full name of a service, as the node resolves it.

        Raises:
            InvalidServiceNameException: it is invalid (a ValueError).
        """
        return self._settled(self.robot.node.resolve_service_name, name)

    def _settled(self, resolve: Callable[[str], str], name: str) -> str:
        """Return the name that an endpoint will get, for which the policy is asked."""
        full = resolve(name)
        if resolve(full) != full:  # two remap rules, one after the other
            raise RefusedError(name, f"the gateway's node remaps {full} once more")
        return full

    # Topics

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
            type_name: The name of its type; by default the one in the graph.
            frame: Returns the client's frame for a message, or None for none.
            key: The queue of the outbox that it waits in.
            depth: How many frames may wait there, and how many messages may wait for their time.
            qos: The profile; by default the strongest that all publishers offer.
            min_period_sec: The shortest time between two messages, in seconds; of those that arrive
                faster the newest wait, and the others are omitted.
            prepare: Encodes a large message, so that `frame` has little left to do; see
                `Preparing`.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the topic or its type.
            InvalidTopicNameException: the name is invalid (a ValueError).
        """
        topic = self.topic_name(topic)
        limit = self.rights.limits.subscriptions
        with self.rights.one_more("subscribe", topic, "subscriptions", self._subscribed, limit):
            message_class = await self._type_to("subscribe", topic, type_name)
            await self.rights.allow("subscribe", topic, message_class.__ros_type__, None)
            subscribed = Subscribed(
                self.robot, self.rights, self.outbox, topic, message_class, frame=frame, key=key,
                depth=depth, min_period_sec=min_period_sec, prepare=prepare,
                on_close=self._forget,
            )  # fmt: skip
            subscribed.open(qos)
            self._subscribed[subscribed] = None
            self._topics_of[key] = topic
        self.robot.audit.note(self.identity, "subscribe", topic, way=self.kind)
        return subscribed

    def _forget(self, subscribed: Subscribed) -> None:
        """Forget a closed subscription."""
        self._subscribed.pop(subscribed, None)
        self._topics_of.pop(subscribed.key, None)

    async def advertise(
        self, topic: str, type_name: str | None = None, qos: QoSProfile | None = None
    ) -> None:
        """Create a publisher, shared with other clients that publish the same.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the type.
            InvalidTopicNameException: the name is invalid (a ValueError).
        """
        topic = self.topic_name(topic)
        if topic in self._published:
            return
        if topic == self.robot.audit.topic:
            raise self.rights.refusal("publish", topic, "only the gateway writes it", "not_allowed")
        what, limit = "topics that it publishes", self.rights.limits.advertised
        with self.rights.one_more("publish", topic, what, self._published, limit):
            message_class = await self._type_to("publish", topic, type_name)
            decision = self.rights.decide("publish", topic, message_class.__ros_type__)
            if topic in self._published:  # advertised twice at the same time
                return
            profile = COMMANDS if decision.lease is not None else qos or PUBLISHED
            make = partial(self.robot.node.create_publisher, message_class, topic, profile)
            key = ("publisher", topic, message_class, str(profile))
            self._published[topic] = self.robot.shared.take(key, make)
        self.robot.audit.note(self.identity, "advertise", topic, way=self.kind)

    def publisher(self, topic: str) -> Any:
        """Return the publisher of a topic that the client has advertised."""
        return self._published[self.topic_name(topic)][0]

    async def publish(
        self,
        topic: str,
        values: Message | Mapping[str, Any] | list[Any] | bytes,
        type_name: str | None = None,
        *,
        arrived_ns: int | None = None,
    ) -> None:
        """Publish a message, or a command if the policy says that the topic carries commands.

        Args:
            topic: The name of the topic.
            values: The message, its values, or its CDR bytes.
            type_name: The type, if the client has not advertised the topic.
            arrived_ns: When the frame arrived, in nanoseconds of the steady clock; by default that
                of the current frame.

        Raises:
            RefusedError: the policy does not allow it; another client commands the topic; the
                command is too old.
            MessageError: a value does not fit its field (a ValueError).
            DecodeError: the bytes are not such a message (a ValueError).
            InterfaceNotFoundError: nobody knows the type.
        """
        arrived_ns = self.arrivals.arrival_ns() if arrived_ns is None else arrived_ns
        topic = self.topic_name(topic)
        if topic not in self._published:
            await self.advertise(topic, type_name)
        publisher = self._published[topic][0]
        message = await self.message_of(publisher.msg_type, values)
        decision = await self.rights.allow("publish", topic, message.__ros_type__, message)
        self.rights.check_size("publish", topic, decision, message)
        try:
            await self._send(publisher, decision, message, arrived_ns)
        except RefusedError as error:
            raise self.rights.refusal(
                "publish", topic, error.reason, error.code, message
            ) from error
        self._note_published(topic, decision.message)

    async def _send(
        self, publisher: Any, decision: Decision, message: Message, arrived_ns: int
    ) -> None:
        """Publish a message within the limits of the policy, by lease if it says so.

        Raises:
            RefusedError: another client commands the topic; the command is too old.
        """
        lease, commands, topic = decision.lease, self.robot.commands, publisher.topic_name
        if lease is None:
            commands.refuse_if_held(topic, self.owner)
            publisher.publish(decision.message)
            return
        self.arrivals.check_command(f"publish {topic}", arrived_ns)
        now_ns = self.robot.node.get_clock().now().nanoseconds
        check_age(topic, message, lease, now_ns=now_ns, arrived_ns=arrived_ns,
                  time_base=self.robot.time_base)  # fmt: skip
        await commands.publish(publisher, self.owner, self.identity, lease, decision.message)

    async def json_of(self, received: Received) -> bytes:
        """Return the JSON of a message of a topic, written once for all clients.

        The event loop runs while a large one is written.

        Raises:
            DecodeError: the bytes are not a message of its type (a ValueError).
        """
        await prepared(self.robot, prepare_json, received)
        return received.once("json", lambda taken: json_of(taken.message))

    async def _type_to(self, verb: Verb, topic: str, type_name: str | None) -> Any:
        """Return the class of a topic's messages, if the policy may allow a verb.

        Only then is a type looked up, imported, or requested from a node.

        Raises:
            RefusedError: the policy does not allow it, whatever the type is.
            InterfaceNotFoundError: nobody knows the topic or its type.
        """
        self.rights.decide(verb, topic, "")
        return await self.message_class(type_name or self.graph.type_of(topic, "topic"))

    def dropped(self) -> dict[str, int]:
        """Return how many frames of each topic were dropped because the client was too slow."""
        counts: dict[str, int] = defaultdict(int)
        for subscribed in self._subscribed:
            counts[subscribed.topic] += subscribed.dropped
        return dict(counts)

    def _note_published(self, topic: str, message: Message) -> None:
        """Record publishing in the audit log: once a second for each topic, with a count."""
        self._counts[topic] += 1
        now_ns = self.robot.time_base.steady_ns()
        if now_ns - self._noted_ns.get(topic, -S_TO_NS) >= S_TO_NS:
            self._noted_ns[topic] = now_ns
            self.robot.audit.note(
                self.identity, "publish", topic, arguments=message,
                count=self._counts.pop(topic), way=self.kind,
            )  # fmt: skip

    async def unadvertise(self, topic: str) -> None:
        """Release a publisher, and end the lease of its commands, which sends the stop."""
        topic = self.topic_name(topic)
        await self.robot.commands.leave(self.owner, topic)
        self._give_back(topic)

    def _give_back(self, topic: str) -> None:
        published = self._published.pop(topic, None)
        self._counts.pop(topic, None)
        self._noted_ns.pop(topic, None)
        if published is not None:
            published[1]()

    # Calls and goals

    async def call(
        self,
        service: str,
        values: Message | Mapping[str, Any] | list[Any] | bytes,
        *,
        type_name: str | None = None,
        timeout_sec: float | None = 5.0,
        arrived_ns: int | None = None,
    ) -> Any:
        """Call a service, and return the response message.

        Cancelling drops the call on both sides; see `Client.call`.

        Args:
            service: The name of the service.
            values: The request, its values by name or in order, or its CDR bytes.
            type_name: The type; by default the one in the graph.
            timeout_sec: The longest wait for the response, in seconds; None waits forever.
            arrived_ns: As for `publish`.

        Raises:
            RefusedError: the policy does not allow it; there are too many calls at once; it may
                have waited while the gateway was stalled.
            ServiceError: there is no server, or its handler failed.
            RequestTimeoutError: `timeout_sec` has passed (a TimeoutError).
            MessageError: a value does not fit its field (a ValueError).
            InterfaceNotFoundError: nobody knows the service or its type.
        """
        arrived_ns = self.arrivals.arrival_ns() if arrived_ns is None else arrived_ns
        service = self.service_name(service)
        with self.rights.one_call("call", service):
            decide_call(self.rights, self.robot, service, "")
            cls = await self.service_class(type_name or self.graph.type_of(service, "service"))
            request = await self.message_of(cls.Request, values)
            verb, name = decide_call(self.rights, self.robot, service, cls.__ros_type__, request)
            decision = await self.rights.allow(verb, name, cls.__ros_type__, request)
            self.rights.check_size(verb, name, decision, request)
            make = partial(self.robot.node.create_client, cls, service)
            with self._attempt("call", service, cls, decision.message, make) as attempt:
                attempt.asked = (verb, name, cls.__ros_type__)
                if not await attempt.client.wait_for_service(SERVER_SEC):
                    raise ServiceError(service, "there is no server")
                if verb == "call":  # a goal may be cancelled at any time
                    self.arrivals.check_waited(verb, name, arrived_ns)
                response = await attempt.client.call(decision.message, timeout_sec)
                attempt.result = "ok"
        return seen_response(self.rights, self.robot, service, response)

    def wait_sec(self, wanted_sec: float | None) -> float:
        """Return how long a call of the client waits for its response, in seconds.

        Args:
            wanted_sec: The time requested by the client; None for none.
        """
        limits = self.rights.limits
        return min(limits.call_sec if wanted_sec is None else wanted_sec, limits.longest_call_sec)

    @property
    def goals(self) -> Mapping[Any, tuple[str, str]]:
        """The goals of the client that have not ended, with the names of action and type."""
        return self._goals

    @property
    def has_goals(self) -> bool:
        """Whether goals of the client have not ended."""
        return bool(self._goals)

    @asynccontextmanager
    async def goal(
        self,
        action: str,
        values: Message | Mapping[str, Any] | list[Any],
        *,
        type_name: str | None = None,
        arrived_ns: int | None = None,
    ) -> AsyncIterator[Any]:
        """Send a goal; leaving the block cancels the goal if it has not ended.

        Yields:
            The `ClientGoalHandle`: iterate over it for feedback, and await its `result`.

        Args:
            action: The name of the action.
            values: The goal, or its values by name or in order.
            type_name: The type; by default the one in the graph.
            arrived_ns: As for `publish`.

        Raises:
            RefusedError: the policy does not allow it; there are too many goals at once; it may
                have waited while the gateway was stalled.
            ServiceError: there is no server.
            GoalRejectedError: the server rejected it.
            MessageError: a value does not fit its field (a ValueError).
            InterfaceNotFoundError: nobody knows the action or its type.
        """
        arrived_ns = self.arrivals.arrival_ns() if arrived_ns is None else arrived_ns
        action = self.topic_name(action)
        with self.rights.one_call("goal", action):
            self.rights.decide("goal", action, "")
            cls = await self.action_class(type_name or self.graph.type_of(action, "action"))
            goal = await self.message_of(cls.Goal, values)
            decision = await self.rights.allow("goal", action, cls.__ros_type__, goal)
            self.rights.check_size("goal", action, decision, goal)
            make = partial(self.robot.owners.create_action_client, cls, action)
            with self._attempt("goal", action, cls, decision.message, make) as attempt:
                if not await attempt.client.wait_for_server(SERVER_SEC):
                    raise ServiceError(action, "there is no action server")
                self.arrivals.check_waited("goal", action, arrived_ns)
                goal_id = self.robot.owners.new_goal(self.identity, self.kind)
                handle = await attempt.client.send_goal(decision.message, goal_uuid=goal_id)
                self._goals[handle] = (action, cls.__ros_type__)
                try:
                    async with handle:
                        yield handle
                finally:
                    self._goals.pop(handle, None)
                    attempt.result = handle.status.name.lower()

    @contextmanager
    def _attempt(
        self, verb: Verb, name: str, cls: Any, message: Any, make: Callable[[], Any]
    ) -> Iterator[Attempt]:
        """Send a call or goal within the block, and record its result.

        Args:
            verb: ``call`` or ``goal``.
            name: The service or action.
            cls: Its type.
            message: The request or goal.
            make: Creates the client that sends it, which sessions share.
        """
        client, give_back = self.robot.shared.take((verb, name, cls), make)
        attempt = Attempt(client, (verb, name, cls.__ros_type__))
        self._attempts[attempt] = None
        began_ns = self.steady_ns()
        try:
            yield attempt
        except AionodeError as error:
            attempt.result = f"failed: {error}"
            raise
        finally:
            del self._attempts[attempt]
            give_back()
            self.robot.audit.note(
                self.identity, verb, name, arguments=message, result=attempt.result,
                duration_ns=self.steady_ns() - began_ns, way=self.kind,
            )  # fmt: skip

    # Services and actions of the client

    async def serve(
        self, service: str, type_name: str, answer: Callable[[Any], Awaitable[Any]]
    ) -> Served:
        """Offer a service, which the client answers.

        Args:
            service: The name of the service.
            type_name: The name of its type.
            answer: Called with each request; returns the response message. The caller of the
                service gets an exception as a ServiceError.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the type.
            InvalidServiceNameException: the name is invalid (a ValueError).
        """
        service = self.service_name(service)
        make = partial(serve, self.robot.node, service)
        return await self._offer(service, self.service_class, type_name, make, answer)

    async def serve_action(
        self, action: str, type_name: str, execute: Callable[[Any], Awaitable[Any]]
    ) -> Served:
        """Offer an action, whose goals the client executes.

        Args:
            action: The name of the action.
            type_name: The name of its type.
            execute: Called with the `ServerGoalHandle` of each goal; returns the result message.
                It is cancelled when the goal is. An exception aborts the goal with its text.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the type.
            InvalidTopicNameException: the name is invalid (a ValueError).
        """
        action = self.topic_name(action)
        make = partial(serve_action, self.robot.node, action)
        return await self._offer(action, self.action_class, type_name, make, execute)

    async def _offer(
        self,
        name: str,
        find: Callable[[str], Awaitable[Any]],
        type_name: str,
        make: Callable[..., Served],
        work: Callable[[Any], Awaitable[Any]],
    ) -> Served:
        """Offer a service or action; its type is looked up if the policy may allow it."""
        limit = self.rights.limits.advertised
        with self.rights.one_more("advertise", name, "services and actions", self._served, limit):
            self.rights.decide("advertise", name, "")
            cls = await find(type_name)
            await self.rights.allow("advertise", name, cls.__ros_type__, None)
            served = make(cls, work, self.rights.limits.calls)
            return self._keep(name, cls.__ros_type__, served)

    def _keep(self, name: str, type_name: str, served: Served) -> Served:
        """Keep a service or action until the client leaves; an older one of the same name ends."""
        older = self._served.pop(name, None)
        if older is not None:
            older.close()
        self._served[name] = served
        self._served_types[name] = type_name
        served.on_close = lambda: (
            self._served.pop(name, None) if (self._served.get(name) is served) else None
        )
        self.robot.audit.note(self.identity, "advertise", name, way=self.kind)
        return served

    # Changes of the policy

    def check_again(self) -> None:
        """End everything that a new version of the policy no longer allows.

        A subscription ends alone, and the client is notified. For a call, a goal, a publisher or a
        service that it offers, the client is disconnected, which ends them in the usual way.
        """
        policy = self.robot.policy
        if self.credentials is not None:
            try:
                self.rights.identity = policy.identify(self.credentials)
            except RefusedError as error:
                self.rights.note_failure(error, "connection")
                self.ended.set()
        self._end_subscriptions()
        held: list[tuple[Verb, str, str]] = [attempt.asked for attempt in self._attempts]
        held += [
            ("publish", topic, publisher.msg_type.__ros_type__)
            for topic, (publisher, _) in self._published.items()
        ]
        held += [("advertise", name, self._served_types[name]) for name in self._served]
        if not all(self.rights.decision(*request).allowed for request in held):
            self.rights.note(
                Refusal.DISCONNECTED,
                "connection",
                f"{CHANGED}, and no longer allows what the client does",
            )
            self.ended.set()  # which cancels its goals, and sends the stops of its leases

    def _end_subscriptions(self) -> None:
        """End the subscriptions that the policy no longer allows."""
        ended = []
        for subscribed in list(self._subscribed):
            topic, type_name = subscribed.topic, subscribed.type_name
            if not self.rights.decision("subscribe", topic, type_name).allowed:
                ended.append(subscribed)
                subscribed.close()
                self.robot.audit.note(self.identity, "subscribe", topic, result=f"ended: {CHANGED}")
                self.rights.note(Refusal.NOT_ALLOWED, f"subscribe {topic}", f"ended: {CHANGED}")
        self.on_policy(ended)


class Attempt:
    """A call or goal in progress.

    Attributes:
        client: Sends it.
        asked: The verb, the name and the type for the policy, which is asked again when it
            changes.
        result: Its result, for the audit log.
    """

    def __init__(self, client: Any, asked: tuple[Verb, str, str]) -> None:
        self.client = client
        self.asked = asked
        self.result = "cancelled"


def ignore(_: object) -> None:
    """Do nothing."""
