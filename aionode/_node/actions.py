"""The actions of a node: their servers and clients, made of its services and topics."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from aionode.message import Message

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from aionode.action import ActionClient, ActionServer, ServerGoalHandle
    from aionode.endpoints._core.callback_runner import Callbacks, OnError
    from aionode.endpoints._core.entity import Entity
    from aionode.endpoints._core.shutdown import Ending
    from aionode.message import ActionClass

__all__ = ["NodeActions"]

GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)


class NodeActions:
    """The part of `Node` that has actions."""

    _callbacks: Callbacks
    _ending: Ending
    _add: Callable[[Entity], Entity]

    def create_action_server(
        self,
        action_type: ActionClass[GoalT, ResultT, FeedbackT],
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any],
        *,
        goal_callback: Callable[[GoalT], Any] | None = None,
        handle_accepted_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ) = None,
        cancel_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ) = None,
        result_timeout: float = 10.0,
        concurrent: bool | int = True,
        on_error: OnError = "log",
        offload: bool = False,
    ) -> ActionServer[GoalT, ResultT, FeedbackT]:
        """Return a server that executes goals; see `aionode.ActionServer` for all arguments."""
        from aionode.action import ActionServer  # nodes without actions start faster

        return ActionServer(
            self,  # type: ignore[arg-type]  # only Node inherits this
            action_type,
            action_name,
            execute_callback,
            goal_callback=goal_callback,
            handle_accepted_callback=handle_accepted_callback,
            cancel_callback=cancel_callback,
            result_timeout=result_timeout,
            concurrent=concurrent,
            on_error=on_error,
            offload=offload,
        )

    def create_action_client(
        self, action_type: ActionClass[GoalT, ResultT, FeedbackT], action_name: str
    ) -> ActionClient[GoalT, ResultT, FeedbackT]:
        """Return a client that sends goals; see `aionode.ActionClient`."""
        from aionode.action import ActionClient  # as above

        return ActionClient(self, action_type, action_name)  # type: ignore[arg-type]  # as above

    # What entities need that are made of others

    @property
    def callbacks(self) -> Callbacks:
        """How callbacks of this node are run."""
        return self._callbacks

    def add_entity(self, entity: Entity) -> None:
        """Take in an entity that was made elsewhere: start it now or later, destroy it at the end.

        For entities that are made of others, such as an action server.
        """
        self._add(entity)

    def expect_at_end(self, answer: asyncio.Future[Any]) -> None:
        """Let the end of the node wait for `answer`, before it destroys clients; a second at most.

        For action clients, whose requests to cancel goals must arrive.
        """
        self._ending.expect(answer)
