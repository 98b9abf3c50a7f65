"""Helpers for tests of actions: a controllable server, and a client made of plain calls."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode.action import GoalStatus, ServerGoalHandle
from aionode.engine.rules.goal import alive_id, left_id
from aionode.interfaces.action_msgs.msg import GoalInfo, GoalStatusArray
from aionode.interfaces.action_msgs.srv import CancelGoal
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.unique_identifier_msgs.msg import UUID
from aionode.qos import qos_profile_action_status_default
from tests.support.waiting import until

if TYPE_CHECKING:
    from aionode.endpoints.client import Client
    from aionode.node import Node

__all__ = ["Goal", "PlainClient", "Worker", "end_of", "endpoint_count", "result_client", "uuid_of"]

Goal = ServerGoalHandle[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
Impl = Fibonacci.Impl


def uuid_of(number: int) -> UUID:
    """Return the id made from a number."""
    return UUID(uuid=list(number.to_bytes(16, "big")))


def endpoint_count(node: Node) -> int:
    """Return how many endpoints and timers a node has, including those of its actions."""
    return sum(
        len([*entities])
        for entities in (
            node.publishers,
            node.subscriptions,
            node.services,
            node.clients,
            node.timers,
        )
    )


async def end_of(goal: Goal) -> GoalStatus:
    """Wait until the server has ended a goal, and return its status."""
    await until(lambda: not goal.is_active)
    return goal.status


def result_client(node: Node) -> Client[Any, Any]:
    """Return the client with which a node's action client requests results and sends life signs."""
    (client,) = [each for each in node.clients if each.srv_name.endswith("/get_result")]
    return client


class Worker:
    """An `execute_callback` that ends when the test allows it."""

    def __init__(self) -> None:
        self.begun: asyncio.Queue[Goal] = asyncio.Queue()
        self.has_begun = asyncio.Event()
        self.may_end = asyncio.Event()
        self.cancelled: list[Goal] = []

    async def __call__(self, goal: Goal) -> Fibonacci.Result:
        """Wait for `may_end`, then succeed with the sequence 0 … order."""
        self.begun.put_nowait(goal)
        self.has_begun.set()
        try:
            await self.may_end.wait()
        except asyncio.CancelledError:
            self.cancelled.append(goal)
            raise
        goal.succeed()
        return Fibonacci.Result(sequence=list(range(goal.request.order + 1)))


class PlainClient:
    """A client made of plain services and topics, as an independent program would be."""

    def __init__(self, node: Node, action: str = "fibonacci") -> None:
        hidden = f"{action}/_action"
        self._goals = node.create_client(Impl.SendGoalService, f"{hidden}/send_goal")
        self._cancels = node.create_client(CancelGoal, f"{hidden}/cancel_goal")
        self._results = node.create_client(Impl.GetResultService, f"{hidden}/get_result")
        self.feedback = node.create_subscription(Impl.FeedbackMessage, f"{hidden}/feedback")
        self.statuses: list[dict[int, int]] = []
        node.create_subscription(
            GoalStatusArray,
            f"{hidden}/status",
            self._on_status,
            qos_profile_action_status_default,
        )

    async def _on_status(self, msg: GoalStatusArray) -> None:
        self.statuses.append(
            {number_of(each.goal_info.goal_id): each.status for each in msg.status_list}
        )

    async def send(self, number: int = 1, order: int = 5) -> Any:
        """Send a goal; return the response."""
        return await self._goals.call(
            Impl.SendGoalService.Request(goal_id=uuid_of(number), goal=Fibonacci.Goal(order=order))
        )

    async def result(self, number: int = 1) -> Any:
        """Request a result; return the response."""
        return await self._results.call(Impl.GetResultService.Request(goal_id=uuid_of(number)))

    async def sign(self, number: int = 1) -> None:
        """Send a sign of life, as an aionode client does regularly."""
        await self._tell(alive_id(bytes(uuid_of(number).uuid)))

    async def leave(self, number: int = 1) -> None:
        """Announce that the goal continues without its client."""
        await self._tell(left_id(bytes(uuid_of(number).uuid)))

    async def _tell(self, asked_id: bytes) -> None:
        uuid = UUID(uuid=list(asked_id))
        answer = await self._results.call(Impl.GetResultService.Request(goal_id=uuid))
        assert answer.status == 0  # as for any goal that does not exist

    async def cancel(self, number: int = 1, stamp: Time | None = None) -> tuple[int, list[int]]:
        """Request cancelling; return the code and the numbers of the goals."""
        info = GoalInfo(goal_id=uuid_of(number), stamp=stamp or Time())
        response = await self._cancels.call(CancelGoal.Request(goal_info=info))
        return response.return_code, [number_of(each.goal_id) for each in response.goals_canceling]


def number_of(goal_id: UUID) -> int:
    """Return the number from which an id was made."""
    return int.from_bytes(bytes(goal_id.uuid), "big")
