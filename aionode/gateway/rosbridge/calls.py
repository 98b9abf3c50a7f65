"""The rosbridge ops by which a client calls services and sends goals."""

from __future__ import annotations

import asyncio
import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import msgspec

from aionode.engine.rules.goal import CancelCode
from aionode.errors import AionodeError, MessageError, ServiceError
from aionode.gateway.rosbridge import rosapi as _rosapi
from aionode.gateway.rosbridge.link import raw_id
from aionode.gateway.rosbridge.request import id_of, number, text, values
from aionode.gateway.session.encoding.client_json import type_text
from aionode.gateway.session.encoding.values import json_of

if TYPE_CHECKING:
    from aionode.action import ClientGoalHandle
    from aionode.gateway.rosbridge.link import Link
    from aionode.gateway.session.lanes import Lanes

__all__ = ["Calls"]

Op = dict[str, Any]


@dataclass
class Goal:
    """A goal of the client, from the op that sends it to its result."""

    action: str
    task: asyncio.Task[None] | None = None
    handle: ClientGoalHandle[Any, Any] | None = None
    is_withdrawn: bool = False


class Calls:
    """The calls and goals of one client, each of which is answered.

    Args:
        link: The way to the client.
        lanes: The tasks of the client.
    """

    def __init__(self, link: Link, lanes: Lanes) -> None:
        self._link = link
        self._lanes = lanes
        self._session = link.session
        self._goals: dict[object, Goal] = {}

    # Services

    async def call_service(self, op: Op, arrived_ns: int) -> None:
        """Start a call; the client continues meanwhile."""
        name, _, old_id = text(op, "service").partition("#")  # as in rosbridge 1
        if old_id and op.get("id") is None:
            op["id"] = old_id
        answer = {"op": "service_response", "service": name, "id": raw_id(op)}
        self._lanes.start(partial(self._call, op, name, answer, arrived_ns))

    async def _call(self, op: Op, service: str, answer: Op, arrived_ns: int) -> None:
        try:
            size = number(op, "fragment_size")
            values_ = await self._values(op, service, arrived_ns)
            result = {"values": values_, "result": True}
        except (AionodeError, TimeoutError) as error:
            self._link.fail(error, op)
        else:
            self._link.send(answer | result, size)

    async def _values(self, op: Op, service: str, arrived_ns: int) -> Any:
        args = values(op, "args")
        of_rosapi = service.removeprefix("/").removeprefix("rosapi/")
        if service.removeprefix("/") != of_rosapi:
            return await _rosapi.answer(self._session, of_rosapi, args)
        timeout = op.get("timeout")
        if timeout != timeout:  # noqa: PLR0124  # NaN, which would put the loop's timers in disorder
            raise MessageError("call_service: timeout", "NaN; use a number of seconds")
        wanted = None if timeout is None else math.inf  # the same as none, like values not above 0
        if not is_negative(timeout):
            wanted = number(op, "timeout") or wanted
        response = await self._session.call(
            service, args, timeout_sec=self._session.wait_sec(wanted), arrived_ns=arrived_ns
        )
        return msgspec.Raw(json_of(response))

    # Actions

    async def send_action_goal(self, op: Op, arrived_ns: int) -> None:
        """Start a goal; its feedback and its result follow.

        Raises:
            MessageError: another goal with the same id is in progress, or there are too many.
        """
        action, message_id = text(op, "action"), id_of(op)
        goal = Goal(action)
        key = message_id if message_id is not None else object()
        answer = {"op": "action_result", "action": action, "id": raw_id(op)}
        if key in self._goals:
            problem = f"{message_id} is in use by another goal; use another id"
            raise MessageError("send_action_goal.id", problem)
        self._goals[key] = goal
        try:
            work = partial(self._pursue, op, goal, answer, key, arrived_ns)
            goal.task = self._lanes.start(work)
        except MessageError:
            del self._goals[key]
            raise

    async def _pursue(self, op: Op, goal: Goal, answer: Op, key: object, arrived_ns: int) -> None:
        """Send a goal, pass on its feedback, and answer with its result."""
        try:
            await self._pursued(op, goal, answer, arrived_ns)
        except (AionodeError, TimeoutError) as error:
            self._link.fail(error, op)
        except asyncio.CancelledError:
            if not goal.is_withdrawn:
                raise
            problem = f"{goal.action}: canceled before the server accepted it"
            self._link.send(answer | {"values": problem, "status": 0, "result": False})
        finally:
            self._goals.pop(key, None)

    async def _pursued(self, op: Op, goal: Goal, answer: Op, arrived_ns: int) -> None:
        type_name = type_text(text(op, "action_type", ""), "action") or None
        size = number(op, "fragment_size")
        async with self._session.goal(
            goal.action, values(op, "args"), type_name=type_name, arrived_ns=arrived_ns
        ) as handle:
            goal.handle = handle
            if op.get("feedback"):
                async for feedback in handle:
                    told = {"values": msgspec.Raw(json_of(feedback))}
                    self._link.send(answer | {"op": "action_feedback"} | told)
            ended = await handle.result()
        result = {
            "values": msgspec.Raw(json_of(ended.result)),
            "status": int(ended.status),
            "result": True,
        }
        self._link.send(answer | result, size)

    async def cancel_action_goal(self, op: Op) -> None:
        """Cancel a goal by its id; without an id, all goals that the client sent to the action.

        Raises:
            MessageError: the client has no such goal.
        """
        action, message_id = text(op, "action"), id_of(op)
        goals = [
            goal
            for key, goal in self._goals.items()
            if same_name(goal.action, action) and message_id in {None, key}
        ]
        if not goals:
            problem = f"no goal with this id is in progress; {action} may have ended it"
            raise MessageError("cancel_action_goal.id", problem)
        for goal in goals:
            if goal.handle is not None:
                self._lanes.start(partial(self._cancel, op, goal.handle))
            elif goal.task is not None:
                goal.is_withdrawn = True
                goal.task.cancel()

    async def _cancel(self, op: Op, handle: ClientGoalHandle[Any, Any]) -> None:
        """Cancel a goal; later ops about the action do not wait for the answer."""
        try:
            answer = await handle.cancel()
        except (AionodeError, TimeoutError) as error:
            self._link.fail(error, op)
        else:
            if answer.return_code == CancelCode.REJECTED:
                problem = "cancel was rejected: the goal goes on"
                self._link.fail(ServiceError(op["action"], problem), op)


def same_name(name: str, other: str) -> bool:
    """Return whether two names are equal apart from the leading slash, which clients may omit."""
    return name.removeprefix("/") == other.removeprefix("/")


def is_negative(timeout: object) -> bool:
    """Return whether a client's time limit is below 0, which means no limit."""
    return isinstance(timeout, int | float) and timeout < 0
