"""The session of one client: each way in makes one, and it asks the policy first."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Self

from aionode.errors import RefusedError
from aionode.gateway.session.calls import SessionCalls
from aionode.gateway.session.graph import SessionGraph
from aionode.gateway.session.refusals import Refusal
from aionode.gateway.session.serving import Served, serve, serve_action
from aionode.gateway.session.topics import SessionTopics

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.gateway.policy.policy import Verb

__all__ = ["Session"]

CHANGED: Final = "the policy has changed"


class Session(SessionTopics, SessionCalls, SessionGraph):
    """All that one client does with the robot, and gives back when it leaves.

    An async context manager. Its end closes the subscriptions, ends the leases of commands, which
    sends their stops, cancels the goals, and ends the services that the client offers.

    All methods raise RefusedError, before they touch the robot, if the policy refuses.

    Attributes:
        identity: Who the client is.
        kind: The way in, for the audit log: ``rosbridge``, ``foxglove``, ``http``.
        credentials: Its evidence of its identity; None if the program made the session itself.
        outbox: The frames that wait for it.
        ended: Set when the client has to leave: the gateway ends, the policy does not know the
            client any more, or another one takes its place.
        end_reason: Why, as the client is told; empty if it is not.
        owner: Who holds the topics that the client commands: the session, which ends the leases
            when it ends, or something that outlives it.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._served: dict[str, Served] = {}
        self._served_types: dict[str, str] = {}

    async def __aenter__(self) -> Self:
        """Begin; nothing of the robot is touched yet."""
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Give everything back: the stops of leases first."""
        try:
            await self._robot.commands.leave(self)
        finally:
            for goal in list(self._goals):
                async with goal:  # its end cancels the goal, and waits for nothing
                    pass
            for subscribed in list(self._subscribed):
                subscribed.close()
            for topic in list(self._published):
                self._give_back(topic)
            for served in list(self._served.values()):
                served.close()
            self.outbox.close()

    # Services and actions of the client

    async def serve(
        self, service: str, type_name: str, answer: Callable[[Any], Awaitable[Any]]
    ) -> Served:
        """Offer a service, which the client answers.

        Args:
            service: The name of the service.
            type_name: The name of its type.
            answer: Called with each request; returns the response message. An exception of it
                reaches the caller of the service as a ServiceError.

        Raises:
            RefusedError: the policy does not allow it, or there are too many.
            InterfaceNotFoundError: nobody knows the type.
            InvalidServiceNameException: the name is invalid (a ValueError).
        """
        service = self.service_name(service)
        make = partial(serve, self._robot.node, service)
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
        make = partial(serve_action, self._robot.node, action)
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
        most = self._limits.advertised
        with self._one_more("advertise", name, "services and actions", self._served, most):
            self.decide("advertise", name, "")
            cls = await find(type_name)
            await self._allow("advertise", name, cls.__ros_type__, None)
            served = make(cls, work, self._limits.calls)
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
        self._robot.audit.note(self.identity, "advertise", name, way=self.kind)
        return served

    # A policy that has changed

    def check_again(self) -> None:
        """End all that the policy, which was read again, does not allow any more.

        A subscription ends by itself, and the client is told. For a call, a goal, a publisher, or a
        service that it offers, the client is disconnected, which ends them as they end with any
        client.
        """
        policy = self._robot.policy
        if self.credentials is not None:
            try:
                self.identity = policy.identify(self.credentials)
            except RefusedError as error:
                self.note_failure(error, "connection")
                self.ended.set()
        self._limits = policy.limits
        self._end_subscriptions()
        held: list[tuple[Verb, str, str]] = [attempt.asked for attempt in self._attempts]
        held += [
            ("publish", topic, publisher.msg_type.__ros_type__)
            for topic, (publisher, _) in self._published.items()
        ]
        held += [("advertise", name, self._served_types[name]) for name in self._served]
        if not all(self.decision(*request).allowed for request in held):
            self.note(Refusal.DISCONNECTED, "connection", f"{CHANGED}, by what it has under way")
            self.ended.set()  # which cancels its goals, and sends the stops of its leases

    def _end_subscriptions(self) -> None:
        """End the subscriptions that the policy does not allow any more."""
        ended = []
        for subscribed in list(self._subscribed):
            topic, type_name = subscribed.topic, subscribed.type_name
            if not self.decision("subscribe", topic, type_name).allowed:
                ended.append(subscribed)
                subscribed.close()
                self._robot.audit.note(
                    self.identity, "subscribe", topic, result=f"ended: {CHANGED}"
                )
                self.note(Refusal.NOT_ALLOWED, f"subscribe {topic}", f"ended: {CHANGED}")
        self.on_policy(ended)
