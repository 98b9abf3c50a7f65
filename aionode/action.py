"""Actions: goals that take time, report their progress, and can be cancelled.

A server::

    async def drive(goal_handle):
        for part in route_to(goal_handle.request.pose):
            await go_along(part)
            goal_handle.publish_feedback(Drive.Feedback(distance_left=part.rest))
        goal_handle.succeed()
        return Drive.Result(arrived=True)

    node.create_action_server(Drive, "drive", drive)

and a client::

    client = node.create_action_client(Drive, "drive")
    goal = await client.send_goal(Drive.Goal(pose=kitchen))
    async for feedback in goal:
        print(feedback.distance_left)
    print((await goal.result()).status)

The errors of goals are here too: `GoalRejectedError`, `GoalAbortedError`, `GoalCanceledError` and
`GoalLostError`.
"""

from __future__ import annotations

from aionode.endpoints.actions.client import ActionClient
from aionode.endpoints.actions.client_goal import ActionResult, ClientGoalHandle
from aionode.endpoints.actions.server import ActionServer
from aionode.endpoints.actions.server_goal import ServerGoalHandle
from aionode.engine.rules.goal import CancelResponse, GoalResponse, GoalStatus
from aionode.errors import (
    GoalAbortedError,
    GoalCanceledError,
    GoalError,
    GoalLostError,
    GoalRejected,
    GoalRejectedError,
    GoalTransitionError,
)

__all__ = [
    "ActionClient",
    "ActionResult",
    "ActionServer",
    "CancelResponse",
    "ClientGoalHandle",
    "GoalAbortedError",
    "GoalCanceledError",
    "GoalError",
    "GoalLostError",
    "GoalRejected",
    "GoalRejectedError",
    "GoalResponse",
    "GoalStatus",
    "GoalTransitionError",
    "ServerGoalHandle",
]
