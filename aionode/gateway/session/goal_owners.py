"""Tracks the owners of the goals that the gateway has sent, to report goals that outlive them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from aionode._process.recent import Recent

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Identity
    from aionode.gateway.session.audit import Audit
    from aionode.node import Node

__all__ = ["GoalOwners"]

MAX_GOALS: Final = 10_000
"""Number of goals whose owners are remembered; the newest ones."""

WARN_SEC: Final = 1.0
"""The time between two warnings, in seconds; the audit log has a line for each goal."""

GOES_ON: Final = "cancel was rejected: the goal goes on"


class Owned(NamedTuple):
    """The client for whom a goal was sent, and its protocol."""

    identity: Identity
    way: str


class GoalOwners:
    """Creates the action clients that send goals on behalf of the gateway's clients.

    A goal is cancelled when its owner leaves or is lost. A ROS server without a cancel callback
    rejects that, and the goal continues; this is then reported in the log and the audit log.

    Args:
        node: The node of the gateway.
        audit: The audit log.
    """

    def __init__(self, node: Node, audit: Audit) -> None:
        self._node = node
        self._audit = audit
        self._owned: Recent[str, Owned] = Recent(MAX_GOALS)  # by the id of the goal

    def create_action_client(self, action_type: Any, action: str) -> Any:
        """Return a client of an action that sends goals for others."""
        from aionode.endpoints.actions.client import send_for_others  # few clients send goals

        client = self._node.create_action_client(action_type, action)
        send_for_others(client, partial(self._tell_goes_on, action))
        return client

    def new_goal(self, identity: Identity, way: str) -> Any:
        """Return the id for a goal that a client is about to send."""
        from aionode.interfaces.unique_identifier_msgs.msg import UUID  # few clients send goals

        goal_id = self._node.context.new_uuid()
        self._owned.put(goal_id.hex(), Owned(identity, way))
        return UUID(uuid=list(goal_id))

    def _tell_goes_on(self, action: str, goal_id: str) -> None:
        owned = self._owned.pop(goal_id, None)
        who = "its client" if owned is None else owned.identity.name
        self._node.get_logger().warning(
            f"gateway: {action}: {who} has left, and {GOES_ON} ({goal_id}); give its server "
            "a cancel callback that accepts",
            throttle_duration_sec=WARN_SEC,
        )
        if owned is not None:
            self._audit.note(
                owned.identity, "cancel", action, result=GOES_ON, way=owned.way, goal_id=goal_id
            )
