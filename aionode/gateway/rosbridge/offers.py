"""The ops of rosbridge for services and actions served by the client itself."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.concurrency import checkpoint
from aionode.errors import AionodeError, MessageError, ServiceError
from aionode.gateway.rosbridge.request import full_name, optional_text, text, values
from aionode.gateway.session.encoding.client_json import type_text
from aionode.gateway.session.encoding.values import json_of

if TYPE_CHECKING:
    from aionode.action import ServerGoalHandle
    from aionode.gateway.rosbridge.link import Link
    from aionode.gateway.session.serving import Served

__all__ = ["Offers"]

Op = dict[str, Any]

SUCCEEDED: Final = 4
CANCELED: Final = 5  # as in action_msgs/msg/GoalStatus

MAX_PENDING: Final = 100
"""Number of requests, or goals, that a client may leave unanswered for each of its services."""

CANCEL_SEC: Final = 5.0
"""How long a canceled goal waits for the client's result."""


GONE: Final = "the client that served it has gone, or has stopped serving it"

TURNS: Final = 10
"""The most loop iterations that an error takes from the client to the caller."""


@dataclass
class Offer:
    """A service or action that the client serves.

    Attributes:
        name: Its name, as given by the client.
        type_class: Its class.
        served: The service or action of the session.
        is_closed: Whether it has ended; later requests fail.
        count: Number of requests so far.
        pending: The requests that the client has not answered, by id.
        goals: The goals that it executes, by id.
    """

    name: str
    type_class: Any
    served: Served | None = None
    is_closed: bool = False
    count: int = 0
    pending: dict[str, asyncio.Future[Op]] = field(default_factory=dict)
    goals: dict[str, ServerGoalHandle[Any, Any, Any]] = field(default_factory=dict)

    def ask(self, prefix: str) -> tuple[str, asyncio.Future[Op]]:
        """Return the id of a new request, and a future for its answer.

        Raises:
            ServiceError: too many are unanswered.
        """
        if self.is_closed:
            raise ServiceError(self.name, GONE)
        if len(self.pending) >= MAX_PENDING:
            problem = f"the client that serves it has left {MAX_PENDING} requests unanswered"
            raise ServiceError(self.name, problem)
        self.count += 1
        message_id = f"{prefix}:{self.name}:{self.count}"
        answer: asyncio.Future[Op] = asyncio.get_running_loop().create_future()
        self.pending[message_id] = answer
        return message_id, answer

    async def close(self) -> None:
        """End the service or action; open requests and goals fail."""
        self.is_closed = True
        problem = ServiceError(self.name, GONE)
        for answer in self.pending.values():
            if not answer.done():
                answer.set_exception(problem)
        for _ in range(TURNS):
            await checkpoint()  # callers get an error before the service or action is destroyed
        if self.served is not None:
            self.served.close()


class Offers:
    """The services and actions of one client.

    Args:
        link: The way to the client.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self._session = link.session
        self._services: dict[str, Offer] = {}
        self._actions: dict[str, Offer] = {}

    # Services

    async def advertise_service(self, op: Op) -> None:
        """Serve a service by asking the client; an earlier service of that name ends."""
        service, type_name = text(op, "service"), type_text(text(op, "type"), "srv")
        self._session.rights.decide("advertise", self._session.service_name(service), "")
        await withdraw(self._services, full_name(service))
        offer = Offer(service, await self._session.service_class(type_name))
        answer = partial(self._answer, offer)
        offer.served = await self._session.serve(service, type_name, answer)
        self._services[full_name(service)] = offer

    async def unadvertise_service(self, op: Op) -> None:
        """End a service; its open requests fail."""
        if not await withdraw(self._services, full_name(text(op, "service"))):
            raise MessageError("unadvertise_service.service", f"{op['service']} is not advertised")

    async def _answer(self, offer: Offer, request: Any) -> Any:
        """Return the response of the client.

        Raises:
            ServiceError: the client reports a failure, or leaves.
            MessageError: its answer is no
                such response.
        """
        message_id, answer = offer.ask("service_request")
        call = {"op": "call_service", "id": message_id, "service": offer.name}
        self._link.send(call | {"args": msgspec.Raw(json_of(request))})
        try:
            op = await answer
            if op.get("result") is False:
                told = op.get("values")
                problem = (
                    told if isinstance(told, str) and told else "the client reported a failure"
                )
                raise ServiceError(offer.name, problem)
            return await self._message(offer.type_class.Response, op)
        except MessageError as error:
            self._link.fail(error, op)
            raise
        finally:
            del offer.pending[message_id]

    async def service_response(self, op: Op) -> None:
        """Handle the client's answer to a request."""
        self._deliver(self._services, "service", op)

    # Actions

    async def advertise_action(self, op: Op) -> None:
        """Serve an action by asking the client; an earlier action of that name ends."""
        action, type_name = text(op, "action"), type_text(text(op, "type"), "action")
        self._session.rights.decide("advertise", self._session.topic_name(action), "")
        await withdraw(self._actions, full_name(action))
        offer = Offer(action, await self._session.action_class(type_name))
        execute = partial(self._execute, offer, type_name)
        offer.served = await self._session.serve_action(action, type_name, execute)
        self._actions[full_name(action)] = offer

    async def unadvertise_action(self, op: Op) -> None:
        """End an action; its open goals are aborted."""
        if not await withdraw(self._actions, full_name(text(op, "action"))):
            raise MessageError("unadvertise_action.action", f"{op['action']} is not advertised")

    async def _execute(
        self, offer: Offer, type_name: str, goal: ServerGoalHandle[Any, Any, Any]
    ) -> Any:
        """Execute a goal at the client, and return its result."""
        try:
            message_id, answer = offer.ask("action_goal")
        except ServiceError as error:
            self._link.fail(error, what="send_action_goal")
            goal.abort(error_text=str(error))
            return offer.type_class.Result()
        offer.goals[message_id] = goal
        sent = {"op": "send_action_goal", "id": message_id, "action": offer.name}
        args = msgspec.Raw(json_of(goal.request))
        self._link.send(sent | {"action_type": type_name, "args": args, "feedback": True})
        try:
            op = await self._result(offer, goal, message_id, answer)
            return await self._ended(offer, goal, op)
        except (AionodeError, TimeoutError) as error:
            self._link.fail(error, what=f"goal {offer.name}")
            if goal.is_active:
                goal.abort(
                    error_text=str(error) or f"canceled, without a result within {CANCEL_SEC:g} s"
                )
            return offer.type_class.Result()
        finally:
            del offer.pending[message_id], offer.goals[message_id]

    async def _result(
        self,
        offer: Offer,
        goal: ServerGoalHandle[Any, Any, Any],
        message_id: str,
        answer: asyncio.Future[Op],
    ) -> Op:
        """Wait for the client's result; if the goal is canceled, notify the client first."""
        try:
            return await asyncio.shield(answer)
        except asyncio.CancelledError:
            cancel = {"op": "cancel_action_goal", "id": message_id, "action": offer.name}
            self._link.send(cancel)
            if not goal.is_cancel_requested:
                raise  # the server is stopping: nobody waits for a result
            async with asyncio.timeout(CANCEL_SEC):
                return await answer

    async def _ended(self, offer: Offer, goal: ServerGoalHandle[Any, Any, Any], op: Op) -> Any:
        """Set the state that the client reports for a goal, and return its result."""
        if op.get("result") is False:
            told = op.get("values")
            goal.abort(
                error_text=told if isinstance(told, str) else "the client reported a failure"
            )
            return offer.type_class.Result()
        result = await self._message(offer.type_class.Result, op)
        status = op.get("status")
        if status == SUCCEEDED:
            goal.succeed()
        elif status == CANCELED and goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return result

    async def action_feedback(self, op: Op) -> None:
        """Publish the client's feedback for a goal."""
        offer = self._offer(self._actions, "action", op)
        goal = offer.goals.get(text(op, "id"))
        if goal is None:
            raise MessageError("action_feedback.id", f"no goal {op['id']} is in progress")
        goal.publish_feedback(await self._message(offer.type_class.Feedback, op))

    async def action_result(self, op: Op) -> None:
        """Handle the client's result of a goal."""
        self._deliver(self._actions, "action", op)

    # Both

    async def _message(self, cls: Any, op: Op) -> Any:
        return await self._session.message_of(cls, values(op, "values"))

    def _offer(self, offers: dict[str, Offer], kind: str, op: Op) -> Offer:
        """Return the client's service or action that an op refers to."""
        offer = offers.get(full_name(text(op, kind)))
        if offer is None:
            raise MessageError(f"{op['op']}.{kind}", f"{op[kind]} is not advertised by this client")
        return offer

    def _deliver(self, offers: dict[str, Offer], kind: str, op: Op) -> None:
        """Pass an answer to the request that waits for it."""
        offer = self._offer(offers, kind, op)
        message_id = optional_text(op, "id")
        if message_id is None and len(offer.pending) == 1:
            (message_id,) = offer.pending  # older clients answer without an id
        answer = offer.pending.get(message_id or "")
        if answer is None or answer.done():
            raise MessageError(f"{op['op']}.id", f"no request {message_id} is waiting")
        answer.set_result(op)

    async def close(self) -> None:
        """End everything when the client has gone."""
        for offers in (self._services, self._actions):
            for name in list(offers):
                await withdraw(offers, name)


async def withdraw(offers: dict[str, Offer], name: str) -> bool:
    """End the service or action of a name, and return whether there was one."""
    offer = offers.pop(name, None)
    if offer is not None:
        await offer.close()
    return offer is not None
