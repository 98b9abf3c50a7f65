"""The calls and goals of a client."""

from __future__ import annotations

import math
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import asynccontextmanager, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import AionodeError, MessageError, ServiceError
from aionode.gateway.session.base import SessionBase
from aionode.graph import EndpointKind
from aionode.message import Message
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Verb

__all__ = ["SessionCalls"]

SERVER_SEC: Final = 1.0
"""Time for which a call or goal waits for its server, in seconds."""

ACTION_PARTS: Final = ("/_action/send_goal", "/_action/get_result", "/_action/cancel_goal")
SETTERS: Final = ("SetParameters", "SetParametersAtomically")
READERS: Final = ("GetParameters", "GetParameterTypes", "DescribeParameters")
LISTER: Final = "ListParameters"
PARAMETERS: Final = "rcl_interfaces/srv/"
"""The types of the parameter services, of which a node may have remapped the names."""


class SessionCalls(SessionBase):
    """The part of `Session` that calls services and sends goals."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._attempts: dict[Attempt, None] = {}
        self._goals: set[Any] = set()

    # Services

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

        Cancelling it drops the call on both sides, as `Client.call` says.

        Args:
            service: The name of the service.
            values: The request, its values by name or in order, or its CDR bytes.
            type_name: The type; by default that which the graph shows.
            timeout_sec: The longest wait for the response, in seconds; None waits for ever.
            arrived_ns: As for `publish`.

        Raises:
            RefusedError: the policy does not allow it; there are too many calls at once; it may
                have waited while the gateway stood still.
            ServiceError: there is no server, or its handler failed.
            RequestTimeoutError: `timeout_sec` has passed (a TimeoutError).
            MessageError: a value does not fit its field (a ValueError).
            InterfaceNotFoundError: nobody knows the service or its type.
        """
        arrived_ns = self.arrival_ns() if arrived_ns is None else arrived_ns
        service = self.service_name(service)
        with self._one_call("call", service):
            self._decide_call(service, "")
            cls = await self.service_class(type_name or self.type_of(service, "service"))
            request = await self.message_of(cls.Request, values)
            verb, name = self._decide_call(service, cls.__ros_type__, request)
            decision = await self._allow(verb, name, cls.__ros_type__, request)
            self._check_size(verb, name, decision, request)
            make = partial(self._robot.node.create_client, cls, service)
            with self._attempt("call", service, cls, decision.message, make) as attempt:
                attempt.asked = (verb, name, cls.__ros_type__)
                if not await attempt.client.wait_for_service(SERVER_SEC):
                    raise ServiceError(service, "there is no server")
                if verb == "call":  # a goal may be cancelled at any time
                    self._check_waited(verb, name, arrived_ns)
                response = await attempt.client.call(decision.message, timeout_sec)
                attempt.result = "ok"
        if cls.__ros_type__ == f"{PARAMETERS}{LISTER}":
            return self._listed(self._nodes_of(service), response)
        return response

    def wait_sec(self, wanted_sec: float | None) -> float:
        """Return for how long a call of the client waits for its response, in seconds.

        Args:
            wanted_sec: What the client wants; None if it does not say.
        """
        limits = self._limits
        return min(limits.call_sec if wanted_sec is None else wanted_sec, limits.longest_call_sec)

    def _decide_call(self, service: str, type_name: str, request: Any = None) -> tuple[Verb, str]:
        """Return the verb and the name that a call counts as: it may be part of a goal.

        Raises:
            RefusedError: the policy does not allow it.
        """
        for part in ACTION_PARTS:
            if service.endswith(part):
                action = service.removesuffix(part)
                if part == ACTION_PARTS[0]:
                    raise self._refused(
                        "call", service, "send goals as goals, which end with the client",
                        "not_allowed",
                    )  # fmt: skip
                self.decide("goal", action, "")
                return "goal", action
        self.decide("call", service, type_name)
        part = type_name.removeprefix(PARAMETERS) if type_name.startswith(PARAMETERS) else ""
        for node in self._nodes_of(service) if part and request is not None else ():
            if part in SETTERS:
                for message in request.parameters:
                    self._decide_in_a_call(node, message)
            elif part in READERS:
                self._check_seen(node, request.names)
        return "call", service

    def _nodes_of(self, service: str) -> list[str]:
        """Return the nodes whose parameters a service is about: by its name, and by who has it."""
        servers = self._robot.node.graph.endpoints(EndpointKind.SERVER, name=service)
        named = service.rpartition("/")[0]
        return sorted({named, *(server.node.fully_qualified_name for server in servers)})

    def _listed(self, nodes: list[str], response: Any) -> Any:
        """Return a list of parameters without those that the client may not see."""
        result = response.result
        names = [
            name for name in result.names
            if all(self._sees(f"{node}:{name}", []) for node in nodes)
        ]  # fmt: skip
        prefixes = [
            prefix for prefix in result.prefixes
            if any(name.startswith(f"{prefix}.") for name in names)
        ]  # fmt: skip
        return type(response)(result=type(result)(names=names, prefixes=prefixes))

    def _decide_in_a_call(self, node: str, message: Any) -> None:
        """Refuse a parameter in a call if the rule for it does more than to allow it."""
        try:
            given = Parameter.from_parameter_msg(message)
        except (RuntimeError, ValueError) as error:
            raise MessageError("parameters", str(error)) from error
        rule = self.decide("parameter", f"{node}:{given.name}", "").rule
        has_more = rule is not None and (rule.ask or rule.rate_hz < math.inf)
        if has_more or self._decide_parameter(node, given) is not given:
            raise self._refused(
                "parameter", f"{node}:{given.name}", "set it as a parameter, not by a call",
                "not_allowed",
            )  # fmt: skip

    # Actions

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
            type_name: The type; by default that which the graph shows.
            arrived_ns: As for `publish`.

        Raises:
            RefusedError: the policy does not allow it; there are too many goals at once; it may
                have waited while the gateway stood still.
            ServiceError: there is no server.
            GoalRejectedError: the server rejected it.
            MessageError: a value does not fit its field (a ValueError).
            InterfaceNotFoundError: nobody knows the action or its type.
        """
        arrived_ns = self.arrival_ns() if arrived_ns is None else arrived_ns
        action = self.topic_name(action)
        with self._one_call("goal", action):
            self.decide("goal", action, "")
            cls = await self.action_class(type_name or self.type_of(action, "action"))
            goal = await self.message_of(cls.Goal, values)
            decision = await self._allow("goal", action, cls.__ros_type__, goal)
            self._check_size("goal", action, decision, goal)
            make = partial(self._robot.owners.create_action_client, cls, action)
            with self._attempt("goal", action, cls, decision.message, make) as attempt:
                if not await attempt.client.wait_for_server(SERVER_SEC):
                    raise ServiceError(action, "there is no action server")
                self._check_waited("goal", action, arrived_ns)
                goal_id = self._robot.owners.new_goal(self.identity, self.kind)
                handle = await attempt.client.send_goal(decision.message, goal_uuid=goal_id)
                self._goals.add(handle)
                try:
                    async with handle:
                        yield handle
                finally:
                    self._goals.discard(handle)
                    attempt.result = handle.status.name.lower()

    @contextmanager
    def _attempt(
        self, verb: Verb, name: str, cls: Any, message: Any, make: Callable[[], Any]
    ) -> Iterator[Attempt]:
        """Send a call or goal within the block, and write down its result.

        Args:
            verb: ``call`` or ``goal``.
            name: The service or action.
            cls: Its type.
            message: The request or goal.
            make: Makes the client that sends it, which sessions share.
        """
        client, give_back = self._robot.shared.take((verb, name, cls), make)
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
            self._robot.audit.note(
                self.identity, verb, name, arguments=message, result=attempt.result,
                duration_ns=self.steady_ns() - began_ns, way=self.kind,
            )  # fmt: skip


class Attempt:
    """A call or goal under way.

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
