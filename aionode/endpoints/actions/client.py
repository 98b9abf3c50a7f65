"""Action clients: send goals, and follow their progress and results."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from aionode._process.later import DelayedCalls
from aionode.endpoints.actions._cancel_request import CancelRequest, is_rejected, warner
from aionode.endpoints.actions._life_signs import LifeSigns
from aionode.endpoints.actions.client_goal import ActionResult, ClientGoalHandle
from aionode.endpoints.actions.common import ActionEntity, expect_action_type, uuid_message
from aionode.endpoints.core.callback_runner import accepts, consume
from aionode.endpoints.core.entity import EndStage
from aionode.endpoints.core.future import Futures, asks
from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.core.node_core import core_of, in_thread_of_node
from aionode.endpoints.stats import CallbackStats
from aionode.engine.causes import CAUSES, Party
from aionode.engine.rules.goal import GoalStatus, reason_id
from aionode.errors import (
    GoalAbortedError,
    GoalCanceledError,
    GoalLostError,
    GoalRejectedError,
    RequestTimeoutError,
    ServiceError,
    ServiceUnavailableError,
)
from aionode.graph import EndpointKind
from aionode.message import Message, checker, type_name
from aionode.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)

if TYPE_CHECKING:
    from aionode.endpoints.core.node_methods import NodeMethods
    from aionode.message import ActionClass

__all__ = ["ActionClient", "send_for_others"]

T = TypeVar("T")
GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)

ANSWER_LIMIT_S = 1.0
"""Timeout for an answer that should come at once, in seconds of real time."""

UNLIMITED = 2**63 - 1

LAST_FEEDBACK_S = 0.02
"""Time to wait for feedback after a result from another process, in seconds.

In Zenoh a reply may overtake earlier samples: of 100 goals that sent feedback just before their
end, for 3 to 7 it arrived after the result, by less than a millisecond.
"""

TURNS_FOR_FEEDBACK = 10
"""Iterations of the loop in which feedback that has arrived may leave its queue."""

FEEDBACK_QOS = QoSProfile(depth=1000)
"""All goals share one feedback queue, with room for the feedback of ten goals."""


class ActionClient(ActionEntity, Generic[GoalT, ResultT, FeedbackT]):
    """Sends goals to an action server. Works while its node runs.

    ::

        client = ActionClient(node, Fibonacci, "fibonacci")
        await client.wait_for_server()
        result = await client.call(Fibonacci.Goal(order=5))      # all in one, or step by step

        goal = await client.send_goal(Fibonacci.Goal(order=5))
        async for feedback in goal:
            ...
        outcome = await goal.result()

    Args:
        node: The node that it belongs to.
        action_type: An action class.
        action_name: Name of the action; relative names are in the node's namespace.
        goal_service_qos_profile: Profile of the goal service.
        result_service_qos_profile: Profile of the result service.
        cancel_service_qos_profile: Profile of the cancel service.
        feedback_sub_qos_profile: Profile of the feedback topic.
        status_sub_qos_profile: Profile of the status topic.

    Attributes:
        action_type: The action type.
        action_name: The full name of the action.

    Raises:
        TypeError: an argument has the wrong type.
        InvalidTopicNameException: `action_name` is invalid (a ValueError).
        EntityDestroyedError: the node was destroyed (a RuntimeError).
    """

    @in_thread_of_node
    def __init__(
        self,
        node: NodeMethods,
        action_type: ActionClass[GoalT, ResultT, FeedbackT],
        action_name: str,
        *,
        goal_service_qos_profile: QoSProfile | int = qos_profile_services_default,
        result_service_qos_profile: QoSProfile | int = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile | int = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile | int = FEEDBACK_QOS,
        status_sub_qos_profile: QoSProfile | int = qos_profile_action_status_default,
    ) -> None:
        expect_action_type(action_type, f"action client of {action_name}")
        self.action_type = cast("Any", action_type)
        self.action_name = node.resolve_topic_name(action_name)
        super().__init__(f"action client of {self.action_name}", EndStage.GOALS)
        self._check = checker(self.action_type.Goal)
        self._graph = node.graph
        self._participant = node.context.participant
        self._new_uuid = node.context.new_uuid
        self._causes = node.context.causes
        self._node_name = core_of(node).info.fully_qualified_name
        # Goals by id, from sending until their end.
        self._goals: dict[bytes, ClientGoalHandle[ResultT, FeedbackT]] = {}
        # Accepted goals, and again when their results have arrived: see `_follow`.
        self._accepted: MessageQueue[Any] = MessageQueue(
            UNLIMITED, CallbackStats(), keep_all=True, slice_ns=node.context.time_base.slice_ns
        )
        # One for each task that waits for an answer; set when the client is destroyed.
        self._waits: dict[asyncio.Future[None], None] = {}  # ordered, to wake them in order
        self._futures = Futures(self)
        self._cancel_requests: dict[CancelRequest, None] = {}  # those in progress
        self._expect_at_end = core_of(node).shutdown.expect
        self._delayed = DelayedCalls()  # the ends of goals' feedback
        self._sends_for_others = False  # such as clients of a gateway; see `lost_id`
        self._tell_goes_on = warner(node.get_logger(), self._subject)

        impl = self.action_type.Impl
        hidden = f"{self.action_name}/_action"
        try:
            self._send_goal = self._part(
                node.create_client(
                    impl.SendGoalService,
                    f"{hidden}/send_goal",
                    qos_profile=goal_service_qos_profile,
                )
            )
            self._cancel_goal = self._part(
                node.create_client(
                    impl.CancelGoalService,
                    f"{hidden}/cancel_goal",
                    qos_profile=cancel_service_qos_profile,
                )
            )
            self._get_result = self._part(
                node.create_client(
                    impl.GetResultService,
                    f"{hidden}/get_result",
                    qos_profile=result_service_qos_profile,
                )
            )
            self._feedback = self._part(
                node.create_subscription(
                    impl.FeedbackMessage,
                    f"{hidden}/feedback",
                    self._on_feedback,
                    feedback_sub_qos_profile,
                )
            )
            self._status = self._part(
                node.create_subscription(
                    impl.GoalStatusMessage,
                    f"{hidden}/status",
                    self._on_status,
                    status_sub_qos_profile,
                )
            )
            self._get_result._is_internal = self._is_sign
            self._signs = LifeSigns(self._get_result, node.graph, node.context.time_base)
        except BaseException:
            for part in self._parts:
                part.destroy()
            raise
        core_of(node).add(self)

    def __repr__(self) -> str:
        return (
            f"<ActionClient {self.action_name} {type_name(self.action_type)} "
            f"goals={len(self._goals)}>"
        )

    # The server

    def server_is_ready(self) -> bool:
        """Return whether a server is matched now, with its three services and two topics."""
        return bool(
            self._send_goal.service_is_ready()
            and self._cancel_goal.service_is_ready()
            and self._get_result.service_is_ready()
            and self._feedback.get_publisher_count() > 0
            and self._status.get_publisher_count() > 0
        )

    @asks
    async def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until a server is matched.

        Args:
            timeout_sec: The longest wait in seconds; None waits forever.

        Returns:
            True once a server is matched, False if none was within `timeout_sec`.

        Raises:
            EntityDestroyedError: the client was already destroyed, or was destroyed during the wait
                (a RuntimeError); see `ClientGoalHandle`.
            CancelledError: as for EntityDestroyedError, in a task of the node.
        """
        self._refuse_if_destroyed()
        try:
            async with asyncio.timeout(timeout_sec):
                while not self.server_is_ready():
                    await self._change()
        except TimeoutError:
            return self.server_is_ready()
        self._send_goal._tell_caveat()
        return True

    async def _change(self) -> None:
        """Wait until endpoints of this action appear or disappear.

        Raises:
            CancelledError, EntityDestroyedError: as `_kept`.
        """
        clients = (self._send_goal, self._cancel_goal, self._get_result)
        wait = self._graph.changed(
            *(client.srv_name for client in clients),
            self._feedback.topic_name,
            self._status.topic_name,
        )
        try:
            await self._kept(wait)
        finally:
            wait.cancel()

    # Goals

    async def call(
        self,
        goal: GoalT,
        feedback_callback: Callable[[Any], Any] | None = None,
    ) -> ResultT:
        """Send `goal`, wait for its end, and return the result message.

        Cancelling it, for example by `asyncio.timeout`, cancels the goal; see `ClientGoalHandle`.

        Args:
            goal: An instance of ``action_type.Goal``.
            feedback_callback: Called with each feedback message, as in rclpy: the feedback itself
                is in its field ``feedback``. Sync or async.

        Raises:
            GoalRejectedError: the server rejected the goal; carries the reason, if known.
            GoalAbortedError: the server aborted the goal; carries the reason, if known.
            GoalCanceledError: the goal was canceled by a request of another client, or by the
                server because it had lost this one; carries the reason, if known.
            GoalLostError: the server went away, or no longer knows the goal.
            TypeError, MessageError, ServiceError, EntityDestroyedError, CancelledError: as
                `send_goal`.
        """
        handle = await self.send_goal(goal, feedback_callback)
        outcome = await handle.result()
        if feedback_callback is not None:
            await handle._wait_for_feedback()
        if outcome.status is GoalStatus.SUCCEEDED:
            return outcome.result
        if outcome.status is GoalStatus.CANCELED:
            raise GoalCanceledError(
                self.action_name, handle.text, outcome.result, outcome.error_text
            )
        if outcome.status is GoalStatus.ABORTED:
            raise GoalAbortedError(
                self.action_name, handle.text, outcome.result, outcome.error_text
            )
        raise GoalLostError(self.action_name, handle.text, "the server does not know it any more")

    async def send_goal(
        self,
        goal: GoalT,
        feedback_callback: Callable[[Any], Any] | None = None,
        goal_uuid: Any = None,
    ) -> ClientGoalHandle[ResultT, FeedbackT]:
        """Send `goal`, and return its handle once the server has accepted it.

        Without a server there is no answer, so use `wait_for_server` first, or limit the wait with
        `asyncio.timeout`. Cancelling cancels the goal, even if the server accepts it later.

        Args:
            goal: An instance of ``action_type.Goal``; it may be changed once the call has started.
            feedback_callback: Called with each feedback message, as in rclpy: the feedback itself
                is in its field ``feedback``. Sync or async. The first call may come before this
                returns. Without it, iterate over the handle.
            goal_uuid: The id as unique_identifier_msgs/msg/UUID; by default a random one.

        Raises:
            GoalRejectedError: the server rejected the goal; carries the reason, if known.
            TypeError: `goal` is of another type.
            MessageError: a value does not fit its field.
            ServiceError: the server's goal_callback failed, or the server went away.
            EntityDestroyedError: the client was already destroyed, or was destroyed during the wait
                (a RuntimeError); see `ClientGoalHandle`.
            CancelledError: as for EntityDestroyedError, in a task of the node.
        """
        handle = await self._send(goal, feedback_callback, goal_uuid)
        if not handle.accepted:
            raise GoalRejectedError(self.action_name, handle.text, handle.reason)
        return handle

    def send_goal_async(
        self,
        goal: GoalT,
        feedback_callback: Callable[[Any], Any] | None = None,
        goal_uuid: Any = None,
    ) -> asyncio.Future[ClientGoalHandle[ResultT, FeedbackT]]:
        """Send `goal`, and return a future of its handle, as in rclpy.

        For a rejected goal the handle's `accepted` is False, as in rclpy. Otherwise see
        `send_goal`, and `Client.call_async` for the future.

        Raises:
            EntityDestroyedError: the client was destroyed (a RuntimeError).
            RuntimeError: no event loop is running.
        """
        self._refuse_if_destroyed("send goal")
        return self._futures.begin(self._send(goal, feedback_callback, goal_uuid))

    def _in_future(self, work: Coroutine[Any, Any, T]) -> asyncio.Future[T]:
        """Return a future for the result of `work`. Used by goal handles."""
        return self._futures.begin(work)

    def _start(self, tasks: asyncio.TaskGroup) -> asyncio.Task[None] | None:
        """Send the goals that were submitted before the node ran."""
        task = super()._start(tasks)
        self._futures.start(tasks)
        return task

    async def _send(
        self, goal: GoalT, feedback_callback: Callable[[Any], Any] | None, goal_uuid: Any
    ) -> ClientGoalHandle[ResultT, FeedbackT]:
        self._refuse_if_destroyed("send goal")
        self._check(goal)
        if feedback_callback is not None:
            accepts(feedback_callback, 1, subject=self._subject, wanted="(feedback_message)")
        if goal_uuid is None:
            goal_uuid = uuid_message(self._new_uuid())
        handle: ClientGoalHandle[ResultT, FeedbackT] = ClientGoalHandle(
            self, goal_uuid, feedback_callback
        )
        # Registered first, as feedback may arrive before the answer.
        self._goals.setdefault(handle._key, handle)
        try:
            handle._sending = self._send_goal._begin(
                self.action_type.Impl.SendGoalService.Request(goal_id=handle.goal_id, goal=goal)
            )
            self._note_goal(handle)
            # It continues if the caller is cancelled, so that `CancelRequest` gets the answer.
            response = await self._awaiting(handle, self._kept(handle._sending.answer))
        except BaseException:
            self._forget(handle)
            raise
        self._send_goal._note_answer(handle._sending)
        handle._sending.cancel()  # already answered
        if not response.accepted:
            self._forget(handle)
            handle.reason = await self._told(handle)
            handle._end(lost=GoalLostError(self.action_name, handle.text, "the server rejected it"))
            return handle
        handle.accepted = True
        handle.stamp = response.stamp
        handle._update_status(GoalStatus.ACCEPTED)
        self._signs.add(handle._key)
        self._accepted.hand_over(handle)
        return handle

    def _note_goal(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> None:
        """Note what caused a goal; it is identified like the request that brings it."""
        if self._causes is not None and goal._sending is not None:
            gid = self._send_goal._endpoint.gid
            party = Party("action client", self._node_name, self.action_name, gid)
            self._causes.note("goal", party, goal._sending.sequence, goal=goal._key)

    def _forget(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> None:
        if self._goals.get(goal._key) is goal:
            del self._goals[goal._key]
            self._signs.remove(goal._key)

    async def _kept(self, answer: asyncio.Future[T]) -> T:
        """Wait for `answer`, which stays pending if the wait ends first.

        Raises:
            CancelledError: the task was cancelled, or the client was destroyed during the wait and
                the task is one of the node's own.
            EntityDestroyedError: the client was destroyed during the wait of another task.
        """
        wait: asyncio.Future[None] = asyncio.get_running_loop().create_future()

        def end(_: object) -> None:
            if not wait.done():
                wait.set_result(None)

        answer.add_done_callback(end)
        self._waits[wait] = None
        try:
            await wait
        finally:
            self._waits.pop(wait, None)
            answer.remove_done_callback(end)
        if self.destroyed:
            raise self._end_of_wait()
        return answer.result()

    async def _awaiting(self, goal: ClientGoalHandle[ResultT, FeedbackT], wait: Awaitable[T]) -> T:
        """Return the result of `wait`; if cancelled, cancel `goal` as well. Used by its handle."""
        goal._waiting += 1
        try:
            return await wait
        except asyncio.CancelledError:
            if not (self.destroyed or goal.done):
                self._cancel_at_server(goal)
            raise
        finally:
            goal._waiting -= 1

    def _cancel_at_server(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> None:
        """Start cancelling `goal` at the server, without waiting. Used by its handle."""
        if goal._sending is not None and not goal._sending.calls:
            goal._sending.cancel()  # no server can have received it
        elif not goal._cancel_sent:
            goal._cancel_sent = True  # one request is enough, however many tasks wait

            def answered(answer: asyncio.Future[Any]) -> None:
                goal._cancel_sent = False
                if is_rejected(answer):
                    self._tell_goes_on(goal.text)

            request = self._begin_to_cancel(goal, lost=self._sends_for_others)
            request.answer.add_done_callback(answered)

    def _begin_to_cancel(self, goal: Any, *, lost: bool = False) -> CancelRequest:
        goal._cancel_requested = True
        request = CancelRequest(self._cancel_goal, goal, self._on_cancel_answered, lost=lost)
        self._cancel_requests[request] = None
        self._expect_at_end(request.answer)
        return request

    def _on_cancel_answered(self, request: CancelRequest) -> None:
        self._cancel_requests.pop(request, None)
        self._close_parts_after_destroy()

    def _close_parts_after_destroy(self) -> None:
        if self.destroyed:
            self._close_parts()

    async def _request_cancel(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> Any:
        """Ask the server to cancel `goal`. Used by its handle."""
        self._refuse_if_destroyed("cancel goal")
        if not self._cancel_goal.service_is_ready():  # it was ready before, so it has gone
            raise ServiceUnavailableError(self._cancel_goal.srv_name)
        return await self._kept(self._begin_to_cancel(goal).answer)

    # Messages of the server

    def _on_feedback(self, message: Any) -> Any:
        goal = self._goals.get(message.goal_id.uuid.tobytes())
        if goal is None:
            return None  # another client's, or late
        if goal._feedback_callback is not None:
            return goal._feedback_callback(message)
        goal._take(message.feedback)
        return None

    def _on_status(self, message: Any) -> None:
        if not self._goals:
            return
        for status in message.status_list:
            goal = self._goals.get(status.goal_info.goal_id.uuid.tobytes())
            if goal is not None:
                goal._update_status(GoalStatus(status.status))

    async def _run(self) -> None:
        """Wait for the results of all goals, until the client is destroyed.

        A failing node cancels its tasks at once, but destroys its action clients only after its
        callbacks have ended. Until then this task continues, as for a destroyed node.
        """
        try:
            await consume(self._accepted, self._follow, concurrent=True, inline=True)
        except asyncio.CancelledError:
            if self.destroyed or self._node_tasks is None or self._node_tasks.error is None:
                raise
            task = asyncio.current_task()
            assert task is not None  # noqa: S101  # this is a coroutine
            task.uncancel()
        self._accepted.discard()
        for goal in self._goals.values():
            if goal.accepted:
                self._accepted.put(goal)
        await consume(self._accepted, self._follow, concurrent=True, inline=True)

    def _follow(
        self, _entered_ns: int, goal: ClientGoalHandle[ResultT, FeedbackT]
    ) -> Coroutine[Any, Any, None] | None:
        """Ask for the result of an accepted goal, or take it; return the rest to await, if any.

        No task waits for the result: its arrival queues the goal again.
        """
        asking = goal._asking
        if self.destroyed:
            return None
        CAUSES.set(())  # those of the goal before, as the calls for all goals share one context
        if asking is None:
            if not self._get_result.service_is_ready():
                return self._ask_later(goal)
            self._ask_for_result(goal)
            return None
        if not asking.answer.done():
            return None  # `_run` has queued all goals again
        self._get_result._note_answer(asking)
        error = asking.answer.exception()
        asking.cancel()  # already answered
        if error is not None:
            self._lose(goal, error)
            return None
        goal._brought_by = CAUSES.get()[-1:]
        response = asking.answer.result()
        status = GoalStatus(response.status)
        if self._may_have_reason(goal, status):
            return self._end_with_reason(goal, status, response.result)
        self._end_goal(goal, ActionResult(status, response.result))
        return None

    async def _ask_later(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> None:
        try:
            await self._until_askable()
        except ServiceUnavailableError as error:
            self._lose(goal, error)
        else:
            self._ask_for_result(goal)

    def _ask_for_result(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> None:
        self._signs.add(goal._key)  # perhaps the service was discovered late
        goal._asking = self._get_result._begin(self._result_request(goal.goal_id))
        goal._asking.answer.add_done_callback(lambda _: self._accepted.hand_over(goal))

    def _result_request(self, goal_id: Any) -> Any:
        return self.action_type.Impl.GetResultService.Request(goal_id=goal_id)

    def _lose(self, goal: ClientGoalHandle[ResultT, FeedbackT], error: BaseException) -> None:
        problem = "the server went away before it ended"
        if not isinstance(error, ServiceUnavailableError):
            problem = f"the server could not tell its result ({error})"
        goal._end(lost=GoalLostError(self.action_name, goal.text, problem))
        self._forget(goal)

    async def _end_with_reason(
        self, goal: ClientGoalHandle[ResultT, FeedbackT], status: GoalStatus, result: ResultT
    ) -> None:
        self._end_goal(goal, ActionResult(status, result, await self._told(goal)))

    def _end_goal(
        self, goal: ClientGoalHandle[ResultT, FeedbackT], outcome: ActionResult[ResultT]
    ) -> None:
        """Set the outcome of a goal, and expect the feedback that the result has overtaken."""
        goal._end(outcome)
        if outcome.status is not GoalStatus.UNKNOWN and self._is_remote():
            self._delayed.add(LAST_FEEDBACK_S, partial(self._hear_out, goal))
        else:
            self._hear_out(goal)

    def _hear_out(
        self, goal: ClientGoalHandle[ResultT, FeedbackT], turns: int = TURNS_FOR_FEEDBACK
    ) -> None:
        """End the feedback of a goal once what has arrived was handled."""
        if turns and self._feedback._reader.waiting:
            asyncio.get_running_loop().call_soon(self._hear_out, goal, turns - 1)
            return
        goal._end_feedback()
        self._forget(goal)

    def _is_remote(self) -> bool:
        """Return whether a server of another process may have executed the goal."""
        servers = self._graph.endpoints(EndpointKind.SERVER, name=self._get_result.srv_name)
        return any(server.node.participant != self._participant for server in servers)

    async def _until_askable(self) -> None:
        """Wait for the server's result service, which may be discovered after its goal service.

        Raises:
            ServiceUnavailableError: the server has gone since it accepted the goal.
        """
        while not self._get_result.service_is_ready():
            if not self._send_goal.service_is_ready():
                raise ServiceUnavailableError(self._get_result.srv_name)
            await self._change()

    def _may_have_reason(
        self, goal: ClientGoalHandle[ResultT, FeedbackT], status: GoalStatus
    ) -> bool:
        """Return whether the server may know why it ended `goal`."""
        is_own_wish = status is GoalStatus.CANCELED and goal._cancel_requested
        return status in (GoalStatus.ABORTED, GoalStatus.CANCELED) and not is_own_wish

    async def _told(self, goal: ClientGoalHandle[ResultT, FeedbackT]) -> str:
        """Return why the server rejected or ended `goal`, if it runs aionode and knows; else ""."""
        if not self._get_result.service_is_ready():
            return ""
        try:
            request = self._result_request(uuid_message(reason_id(goal._key)))
            await self._get_result.call(request, ANSWER_LIMIT_S)
        except ServiceError as error:
            return error.error_text if error.error_type == "AbortReason" else ""
        except RequestTimeoutError:
            return ""
        return ""

    # The end

    def _close(self) -> None:
        """Withdraw the client, end its waits, and cancel the goals that tasks are awaiting.

        Other goals continue at the server, which is told so.
        """
        for goal in self._goals.values():
            if goal._is_awaited and not goal.done:
                self._cancel_at_server(goal)
        for request in list(self._cancel_requests):
            request.end_with_answer()
        for wait in self._waits:
            if not wait.done():
                wait.set_result(None)
        self._futures.close()
        for answer in self._signs.leave(self._close_parts_after_destroy):
            self._expect_at_end(answer)
        self._close_parts()
        self._delayed.cancel()
        goals, self._goals = self._goals, {}
        for goal in goals.values():
            if goal._asking is not None:
                goal._asking.cancel()
            goal._end()

    def _close_parts(self) -> None:
        """Destroy all parts except those still needed to cancel or leave goals."""
        needed: list[object] = []
        if self._cancel_requests:
            needed += [self._send_goal, self._cancel_goal]
        if self._signs.is_leaving:  # a server could mistake the end of the first for a loss
            needed += [self._send_goal, self._get_result]
        for part in self._parts:
            if part not in needed:
                part.destroy()


def send_for_others(
    client: ActionClient[Any, Any, Any], tell_goes_on: Callable[[str], None]
) -> None:
    """Mark the goals of a client as sent for others, who may be lost while it stays.

    Args:
        client: The action client, such as one of a gateway; see `lost_id`.
        tell_goes_on: Called with the id of a goal whose server refuses to cancel it.
    """
    client._sends_for_others = True
    client._tell_goes_on = tell_goes_on
