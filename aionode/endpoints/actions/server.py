"""Action servers: three services and two topics of a node, and the goals between them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar, cast

from aionode._process.concurrency import is_cancelled_task
from aionode._process.recent import Recent
from aionode.clock import perf_ns
from aionode.endpoints.actions._cancel_decision import OWNER_LOST, agrees, ends_for_lost_owner
from aionode.endpoints.actions._client_watch import ClientWatch, announcing
from aionode.endpoints.actions.common import (
    AbortReason,
    ActionEntity,
    awaited,
    checked_client_lost,
    expect_action_type,
    pass_reason,
    seconds_to_ns,
    stamp_ns,
)
from aionode.endpoints.actions.server_goal import ServerGoalHandle
from aionode.endpoints.core.callback_runner import accepts, checked_concurrency, consume
from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.core.node_core import core_of, in_thread_of_node
from aionode.endpoints.core.node_tasks import create_own_task
from aionode.endpoints.stats import CallbackStats
from aionode.engine.causes import CAUSES, Party, add_cause
from aionode.engine.reports.limits import tell_full, tell_rejected
from aionode.engine.rules.early_cancels import EarlyCancels
from aionode.engine.rules.goal import (
    MAX_REJECTIONS,
    CancelCode,
    GoalKey,
    GoalResponse,
    GoalStatus,
    goals_to_cancel,
    is_cancelable,
    lost_id,
    reason_id,
)
from aionode.engine.rules.goal_store import (
    MAX_GOALS,
    AlarmedGoalStore,
    checked_max_goals,
)
from aionode.engine.rules.status_pace import StatusPace
from aionode.errors import CallbackCancelledError, GoalRejected, QueueFullError, brief
from aionode.message import Message, snapshotter, type_name
from aionode.qos import (
    qos_profile_action_status_default,
    qos_profile_default,
    qos_profile_services_default,
)

if TYPE_CHECKING:
    from aionode.endpoints.core.callback_runner import CallbackRunner, OnError
    from aionode.endpoints.core.node_methods import NodeMethods
    from aionode.engine.causes import CauseLog
    from aionode.message import ActionClass
    from aionode.qos import QoSProfile

__all__ = ["ActionServer"]

GoalT = TypeVar("GoalT", bound=Message)
ResultT = TypeVar("ResultT", bound=Message)
FeedbackT = TypeVar("FeedbackT", bound=Message)

UNLIMITED = 2**63 - 1
"""Depth of the queues of goals: `goal_callback` limits their number."""

DRAIN_LIMIT_S = 1.0
"""How long a result waits for the last feedback to be sent, in seconds of real time."""


class ActionServer(ActionEntity, Generic[GoalT, ResultT, FeedbackT]):
    """Executes goals that clients send, reports progress, and can be asked to stop.

    ::

        async def execute(goal_handle):
            for step in range(goal_handle.request.order):
                await work(step)
                goal_handle.publish_feedback(Fibonacci.Feedback(...))
            goal_handle.succeed()
            return Fibonacci.Result(...)

        ActionServer(node, Fibonacci, "fibonacci", execute)

    An accepted cancel request cancels a coroutine. It may clean up in ``except
    asyncio.CancelledError`` and end with ``goal_handle.canceled()`` or `succeed()`; if it lets the
    error through, the goal becomes CANCELED. If the coroutine is cancelled for another reason, such
    as the end of the node, the goal becomes ABORTED. A sync callback has to check
    ``goal_handle.is_cancel_requested`` itself. Like every sync callback it blocks the event loop,
    so run a long one in a thread: ``offload=True``.

    An exception in `execute_callback` aborts the goal. It is logged with its traceback and counted;
    the client gets an empty result and, if it runs aionode, the text of the exception.

    Args:
        node: The node that it belongs to.
        action_type: An action class.
        action_name: Name of the action; relative names are in the node's namespace.
        execute_callback: Called with a `ServerGoalHandle` for each goal; returns the result. Sync
            or async.
        goal_callback: Called with each goal message, one at a time; returns `GoalResponse.ACCEPT`
            or ``REJECT``, or raises `GoalRejected` with a reason, which the client gets if it runs
            aionode. Without it, all goals are accepted. Sync or async.
        handle_accepted_callback: Called with the handle of each accepted goal, after the client has
            been told; should call ``goal_handle.execute()``, then or later. Without it, goals are
            executed at once. Sync or async.
        cancel_callback: Called with the handle of a goal that a client wants to cancel; returns
            `CancelResponse.ACCEPT` or ``REJECT``. Without it, all requests are rejected. Sync or
            async.
        result_timeout: How long a result is kept after the end of its goal, in seconds. With 0 it
            is sent only to clients that asked before the end.
        max_goals: How many goals may be active at once: further ones are rejected without asking
            `goal_callback`, which is logged at most once a second. It also limits the results that
            are kept: the oldest is discarded first, even before `result_timeout`.
        concurrent: True executes all accepted goals at once, False one after the other, a number at
            most that many at once; the others wait as ACCEPTED.
        on_error: What to do with an exception in the other callbacks, once the client has been
            told: ``"log"`` logs it with its traceback, counts it and continues, ``"raise"`` ends
            the node, a function is called with (exception, CallbackContext). The client gets a
            `ServiceError` for a failing `goal_callback` or `cancel_callback`; a failing
            `handle_accepted_callback` aborts the goal.
        offload: Whether to run a sync `execute_callback` in a thread, where it may use its handle.
        on_client_lost: What happens to the goals of a client that is killed, frozen, blocked or cut
            off: ``"cancel"`` cancels them without asking `cancel_callback`; ``"continue"`` lets
            them go on, as in rclpy. The goals of a client that ends properly go on in either case.
            By default lost goals go on as well, unless a gateway sent them for a client that it has
            lost and there is no `cancel_callback`.
        client_lost_sec: The silence after which a client is lost, in seconds; at least 0.03.
            Clients of aionode send three signs of life in this time. Others, such as rclpy's, are
            lost when they leave the graph.
        goal_service_qos_profile: Profile of the goal service.
        result_service_qos_profile: Profile of the result service.
        cancel_service_qos_profile: Profile of the cancel service.
        feedback_pub_qos_profile: Profile of the feedback topic.
        status_pub_qos_profile: Profile of the status topic.

    Attributes:
        action_type: The action type.
        action_name: The full name of the action.
        stats: Counts of the goals: `received` counts those whose execution has started.

    Raises:
        TypeError: an argument has the wrong type, or a callback takes other arguments.
        ValueError: `concurrent`, `on_error`, `result_timeout`, `max_goals`, `on_client_lost` or
            `client_lost_sec` has an invalid value.
        InvalidTopicNameException: `action_name` is invalid (a ValueError).
        EntityDestroyedError: the node was destroyed (a RuntimeError).
    """

    @in_thread_of_node
    def __init__(
        self,
        node: NodeMethods,
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
        max_goals: int = MAX_GOALS,
        concurrent: bool | int = True,
        on_error: OnError = "log",
        offload: bool = False,
        on_client_lost: Literal["cancel", "continue"] | None = None,
        client_lost_sec: float = 3.0,
        goal_service_qos_profile: QoSProfile | int = qos_profile_services_default,
        result_service_qos_profile: QoSProfile | int = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile | int = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile | int = qos_profile_default,
        status_pub_qos_profile: QoSProfile | int = qos_profile_action_status_default,
    ) -> None:
        expect_action_type(action_type, f"action server {action_name}")
        self.action_type = cast("Any", action_type)
        self.action_name = node.resolve_topic_name(action_name)
        super().__init__(f"action server {self.action_name}")
        self.stats = CallbackStats()
        self._clock = node.get_clock()
        self._causes = node.context.causes
        self._node_name = core_of(node).info.fully_qualified_name
        self._time_base = node.context.time_base
        self._callbacks = core_of(node).callbacks
        self._logger = node.get_logger()
        self._when_lost = on_client_lost
        lost_ns = checked_client_lost(on_client_lost, client_lost_sec, self._subject)
        self._concurrent = checked_concurrency(concurrent, self._subject)
        self._offload = offload
        self._checked_result: Callable[[ResultT], ResultT] = snapshotter(self.action_type.Result)
        goals_limit = checked_max_goals(max_goals, self._subject)
        timeout_ns = seconds_to_ns(result_timeout, f"{self._subject}: result_timeout")
        limit_bytes = node.context.network.queue_bytes
        self._goals = AlarmedGoalStore(self._time_base, goals_limit, timeout_ns, limit_bytes)
        self._status_pace = StatusPace(self._send_status, self._goals)
        self._early_cancels = EarlyCancels(self._time_base)
        self._rejections: Recent[bytes, str] = Recent(MAX_REJECTIONS)
        kept: dict[str, Any] = {"keep_all": True, "slice_ns": self._callbacks.slice_ns}
        self._accepted: MessageQueue[Any] = MessageQueue(UNLIMITED, CallbackStats(), **kept)
        self._waiting: MessageQueue[Any] = MessageQueue(UNLIMITED, self.stats, **kept)
        self._hand_over = self._callbacks.make_runner(
            self._call_handle_accepted, self, CallbackStats(), on_error=on_error, offload=False
        )
        self.register_execute_callback(execute_callback)
        self.register_goal_callback(goal_callback)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_cancel_callback(cancel_callback)

        impl = self.action_type.Impl
        hidden = f"{self.action_name}/_action"
        try:
            self._feedback = self._part(
                node.create_publisher(
                    impl.FeedbackMessage, f"{hidden}/feedback", feedback_pub_qos_profile
                )
            )
            self._status = self._part(
                node.create_publisher(
                    impl.GoalStatusMessage, f"{hidden}/status", status_pub_qos_profile
                )
            )

            def serve(srv_type: Any, name: str, callback: Any, profile: Any, **options: Any) -> Any:
                service = f"{hidden}/{name}"
                return self._part(
                    node.create_service(srv_type, service, callback, qos_profile=profile, **options)
                )

            # One at a time, or two goals could both be accepted as "the only one".
            self._send_goal = serve(
                impl.SendGoalService,
                "send_goal",
                self._on_goal,
                goal_service_qos_profile,
                on_error=on_error,
            )
            serve(
                impl.CancelGoalService,
                "cancel_goal",
                self._on_cancel,
                cancel_service_qos_profile,
                on_error=on_error,
            )
            # A request stays pending until its goal ends, so many are pending at once.
            get_result = serve(
                impl.GetResultService,
                "get_result",
                self._on_result,
                announcing(result_service_qos_profile, lost_ns),
                on_error=pass_reason,
                concurrent=True,
            )
        except BaseException:
            self._close_parts()
            raise
        get_result._is_internal = self._is_sign
        self._client_watch = ClientWatch(
            self._send_goal.srv_name, node.graph, self._time_base, lost_ns, self._on_client_lost
        )
        core_of(node).add(self)

    def __repr__(self) -> str:
        active = self._goals.active
        return (
            f"<ActionServer {self.action_name} {type_name(self.action_type)} active={active} "
            f"kept={len(self._goals) - active} received={self.stats.received} "
            f"errors={self.stats.errors}>"
        )

    # Callbacks, as in rclpy

    def register_execute_callback(
        self, execute_callback: Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any]
    ) -> None:
        """Set the function that executes goals from now on.

        Raises:
            TypeError: it cannot be called with a goal handle.
            ValueError: it is a coroutine function, and the server has ``offload=True``.
        """
        self._execute = self._executing(execute_callback)

    def _executing(self, callback: Callable[..., Any]) -> CallbackRunner:
        accepts(callback, 1, subject=self._subject, wanted="(goal_handle)")
        return self._callbacks.make_runner(
            callback, self, self.stats, on_error="log", offload=self._offload
        )

    def register_goal_callback(self, goal_callback: Callable[[GoalT], Any] | None) -> None:
        """Set the function that decides on new goals; None accepts all."""
        if goal_callback is not None:
            accepts(goal_callback, 1, subject=self._subject, wanted="(goal)")
        self._goal_callback = goal_callback

    def register_handle_accepted_callback(
        self,
        handle_accepted_callback: (
            Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None
        ),
    ) -> None:
        """Set the function that handles accepted goals; None executes them at once."""
        if handle_accepted_callback is not None:
            accepts(handle_accepted_callback, 1, subject=self._subject, wanted="(goal_handle)")
        self._handle_accepted_callback = handle_accepted_callback

    def register_cancel_callback(
        self,
        cancel_callback: Callable[[ServerGoalHandle[GoalT, ResultT, FeedbackT]], Any] | None,
    ) -> None:
        """Set the function that decides on cancel requests; None rejects all."""
        if cancel_callback is not None:
            accepts(cancel_callback, 1, subject=self._subject, wanted="(goal_handle)")
        self._cancel_callback = cancel_callback

    # New goals

    def _on_goal(self, request: Any) -> Any:
        """Return the response, or its coroutine if `goal_callback` decides."""
        response = self.action_type.Impl.SendGoalService.Response()
        goal_id = request.goal_id.uuid.tobytes()
        if self._is_refused(goal_id):
            return response
        if why := self._goals.refusal(request.goal):
            tell_full(self._logger, self._subject, why)
            self._rejections.put(goal_id, why)
            return response
        self._client_watch.add(goal_id, self._send_goal._client_gid)
        if self._goal_callback is not None:
            return self._decide(goal_id, request, response)
        self._take_goal(goal_id, request, response)
        return response

    async def _decide(self, goal_id: bytes, request: Any, response: Any) -> Any:
        """Ask `goal_callback`, and return the response."""
        try:
            # It may have to be refused now, because of a request that arrived during the callback.
            if not await self._welcomes(request.goal) or self._is_refused(goal_id):
                return response
        except GoalRejected as rejected:
            tell_rejected(self._logger, self._subject, rejected.reason)
            self._rejections.put(goal_id, rejected.reason)
            return response
        else:
            self._take_goal(goal_id, request, response)
            return response
        finally:
            if not response.accepted:
                self._client_watch.remove(goal_id)

    def _take_goal(self, goal_id: bytes, request: Any, response: Any) -> None:
        """Accept a goal, and queue it: the client is told before it starts."""
        response.accepted = True
        response.stamp = self._clock.now().to_msg()
        goal = self._accept(goal_id, request, response.stamp)
        if self._handle_accepted_callback is None:
            goal.execute()
        else:
            self._accepted.put(goal)

    def _is_refused(self, goal_id: bytes) -> bool:
        """Return whether the goal is already known, or was cancelled before it arrived."""
        return goal_id in self._goals or goal_id in self._early_cancels

    async def _welcomes(self, goal: GoalT) -> bool:
        if self._goal_callback is None:
            return True
        answer = await awaited(self._goal_callback(goal))
        if not isinstance(answer, GoalResponse):
            self._warn(
                f"goal_callback returned {brief(answer)}, not a GoalResponse; the goal is rejected"
            )
        elif answer is GoalResponse.REJECT:
            tell_rejected(self._logger, self._subject)
        return answer is GoalResponse.ACCEPT

    def _accept(
        self, goal_id: bytes, request: Any, stamp: Any
    ) -> ServerGoalHandle[GoalT, ResultT, FeedbackT]:
        # Imported here, because programs without actions never need these messages.
        from aionode.interfaces.action_msgs.msg import GoalInfo

        goal: ServerGoalHandle[GoalT, ResultT, FeedbackT] = ServerGoalHandle(
            self,
            request.goal,
            GoalInfo(goal_id=request.goal_id, stamp=stamp),
            GoalKey(goal_id, stamp_ns(stamp)),
        )
        goal._asked_by = CAUSES.get()[:1]
        self._goals[goal_id] = goal
        self._publish_status()
        return goal

    async def _call_handle_accepted(self, goal: Any) -> None:
        callback = self._handle_accepted_callback
        CAUSES.set(goal._asked_by)
        try:
            if callback is None:
                goal.execute()
            else:
                await awaited(callback(goal))
        except (Exception, asyncio.CancelledError) as error:
            if not is_cancelled_task():
                goal._failed(error)  # otherwise its client would wait forever
            raise

    # Execution

    async def _run(self) -> None:
        """Pass goals to `handle_accepted_callback` and execute them, until cancelled."""
        async with asyncio.TaskGroup() as tasks:
            hand_over = consume(
                self._accepted, lambda _, goal: self._hand_over.run(goal), concurrent=True
            )
            create_own_task(tasks, hand_over)
            inline = self._concurrent is not False
            begin = consume(self._waiting, self._begin, self._concurrent, inline=inline)
            create_own_task(tasks, begin)

    def _enqueue(
        self,
        goal: ServerGoalHandle[GoalT, ResultT, FeedbackT],
        execute_callback: Callable[..., Any] | None,
    ) -> None:
        """Queue `goal` for execution. Used by its handle."""
        runner = None if execute_callback is None else self._executing(execute_callback)
        self._waiting.hand_over((goal, runner))

    def _begin(
        self, entered_ns: int, item: tuple[ServerGoalHandle[Any, Any, Any], CallbackRunner | None]
    ) -> Coroutine[Any, Any, None] | None:
        goal, runner = item
        if not goal.is_active:  # cancelled while it waited
            self.stats.dropped += 1
            return None
        return self._run_goal(entered_ns, goal, runner or self._execute)

    async def _run_goal(
        self, entered_ns: int, goal: ServerGoalHandle[Any, Any, Any], runner: CallbackRunner
    ) -> None:
        if not goal.is_active:  # cancelled before this task started
            self.stats.dropped += 1
            return
        self.stats.received += 1
        self.stats.queue_wait.record(perf_ns() - entered_ns)
        goal._begin()
        try:
            if self._concurrent is not False:  # each goal has a task already
                await self._call_execute(goal, runner)
            else:  # cancelling a goal cancels only its own task
                async with asyncio.TaskGroup() as tasks:
                    create_own_task(tasks, self._call_execute(goal, runner))
        finally:
            if goal.is_active:  # the node stopped before the callback started
                goal._stopped()

    async def _call_execute(
        self, goal: ServerGoalHandle[Any, Any, Any], runner: CallbackRunner
    ) -> None:
        if self._causes is not None:
            self._begin_run(self._causes, goal, runner)
        task = asyncio.current_task()
        assert task is not None  # noqa: S101  # a coroutine runs in one
        task.set_name(f"{self._subject} goal {goal.text}")
        if not self._offload:  # a thread cannot be cancelled; it has to check itself
            goal._run_in(task)
        try:
            goal._returned(await runner.call(goal))
        except asyncio.CancelledError:
            goal._stopped()
            raise
        except Exception as error:  # noqa: BLE001  # logged and counted, and told to the client
            if self.destroyed and isinstance(error, CallbackCancelledError):
                goal._stopped()  # the node is ending: its clock was closed just before this task
                return
            runner.fail(error)
            goal._failed(error)

    def _begin_run(
        self, causes: CauseLog, goal: ServerGoalHandle[Any, Any, Any], runner: CallbackRunner
    ) -> None:
        """Note that the current task executes `goal`, for the request that brought it."""
        party = Party(
            "action server", self._node_name, self.action_name, bytes(16), runner.naming()
        )
        for asked in goal._asked_by:
            entered_ns = asked.entered_ns
            goal._run = causes.begin(party, "goal", asked.gid, asked.sequence, entered_ns)

    def _in_loop(self, action: Callable[..., None], *args: Any) -> None:
        """Run `action` in the event loop; from another thread, wait for it. Used by goal handles.

        Raises:
            Exception: what `action` raised.
        """
        affinity = self._node_affinity
        if affinity is None or self.destroyed or not affinity.is_other_thread():
            action(*args)
        else:
            affinity.wait_for(action, *args)

    # Cancel requests

    async def _on_cancel(self, request: Any) -> Any:
        info = request.goal_info
        asked = GoalKey(info.goal_id.uuid.tobytes(), stamp_ns(info.stamp))
        is_lost = lost_id(asked.goal_id) in self._goals
        if is_lost:
            asked = GoalKey(lost_id(asked.goal_id), 0)
        code, meant = goals_to_cancel([goal._current_key for goal in self._goals.values()], asked)
        response = self.action_type.Impl.CancelGoalService.Response()
        if code is CancelCode.UNKNOWN_GOAL_ID:
            self._early_cancels.note(asked.goal_id)
        refused = False
        for goal_id in meant:
            goal = self._goals.get(goal_id)
            if goal is None or not is_cancelable(goal.status):
                continue  # it ended during the callback for another goal
            if is_lost:
                agreed = ends_for_lost_owner(self._when_lost, self._cancel_callback)
            else:
                agreed = await agrees(self._cancel_callback, goal, self._warn)
            if not agreed:
                refused = True
            elif is_cancelable(goal.status):
                self._client_watch.remove(goal_id)
                goal._cancel(OWNER_LOST if is_lost else "")
                response.goals_canceling.append(goal.info)
        if meant and not response.goals_canceling:
            code = CancelCode.REJECTED if refused else CancelCode.GOAL_TERMINATED
        response.return_code = int(code)
        return response

    def _on_client_lost(self, goal_ids: list[bytes], text: str) -> None:
        """Cancel the goals of a lost client, like an accepted cancel request."""
        ids = ", ".join(goal_id.hex() for goal_id in goal_ids)
        self._warn(f"{text}; cancelling its goal{'s'[: len(goal_ids) > 1]} {ids}")
        for goal_id in goal_ids:
            goal = self._goals.get(goal_id)
            if goal is None:  # not yet decided on
                self._early_cancels.note(goal_id)
            elif is_cancelable(goal.status):
                goal._cancel(text)

    # Results

    def _on_result(self, request: Any) -> Any:
        """Return the response, or its coroutine if the goal has not ended or feedback waits."""
        goal_id = request.goal_id.uuid.tobytes()
        response = self.action_type.Impl.GetResultService.Response()
        goal = self._goals.get(goal_id)
        if goal is None:
            asked_id = reason_id(goal_id)
            ended = self._goals.get(asked_id)
            reason = ended._end_text if ended is not None else self._rejections.get(asked_id)
            if reason:
                raise AbortReason(reason)
            self._client_watch.take(goal_id)
            return response
        if goal._known.is_set() and self._feedback._is_drained():
            return self._with_result(goal, response)
        return self._after_feedback(goal, response)

    async def _after_feedback(self, goal: Any, response: Any) -> Any:
        """Wait until a goal has ended, and send its feedback before its result.

        Clients stop listening once they have the result.
        """
        await goal._known.wait()
        with suppress(TimeoutError):  # a full KEEP_ALL reader must not hold results back
            async with asyncio.timeout(DRAIN_LIMIT_S):
                await self._feedback.drain()
        return self._with_result(goal, response)

    def _with_result(self, goal: Any, response: Any) -> Any:
        """Return `response` with the outcome of `goal`."""
        if goal._run is not None:
            add_cause(goal._run)
        response.status = int(goal.status)
        if goal._result is not None:
            response.result = goal._result
        return response

    def _keep(self, goal: ServerGoalHandle[GoalT, ResultT, FeedbackT]) -> None:
        """Keep the result of an ended goal for `result_timeout`. Used by its handle."""
        goal_id = goal._key.goal_id
        self._client_watch.remove(goal_id)
        if not self.destroyed and goal_id in self._goals:
            self._goals.keep(goal_id)
            if not self._goals.kept_ns:
                self._publish_status()  # before it is discarded

    # Topics

    def _publish_feedback(
        self, goal: ServerGoalHandle[GoalT, ResultT, FeedbackT], feedback: FeedbackT
    ) -> None:
        """Send `feedback` of `goal`. Used by its handle."""
        if not isinstance(feedback, self.action_type.Feedback):
            raise TypeError(
                f"{self._subject}: feedback is a {type(feedback).__name__}; a "
                f"{type_name(self.action_type.Feedback)} is needed"
            )
        if not self.destroyed:
            message = self.action_type.Impl.FeedbackMessage(goal_id=goal.goal_id, feedback=feedback)
            try:
                self._feedback.publish(message)
            except QueueFullError:  # a slow reader must not stop the goal
                return

    def _publish_status(self) -> None:
        """Send the states of all goals soon. Used by goal handles."""
        if not self.destroyed:
            self._status_pace.note_change()

    def _send_status(self) -> None:
        from aionode.interfaces.action_msgs.msg import GoalStatus as GoalStatusMessage

        message = self.action_type.Impl.GoalStatusMessage(
            status_list=[
                GoalStatusMessage(goal_info=goal.info, status=int(goal.status))
                for goal in self._goals.values()
            ]
        )
        with suppress(QueueFullError):  # as above
            self._status.publish(message)
        self._goals.forget_ended()

    def _warn(self, text: str) -> None:
        """Log a mistake in a callback. Used by goal handles."""
        self._logger.warning(f"{self._subject}: {text}")

    # The end

    def _close(self) -> None:
        """Withdraw the server; clients learn at once that their goals are lost."""
        self._status_pace.flush()
        self._close_parts()
        self._client_watch.stop()
        for goal in self._goals.close():
            if goal.status is GoalStatus.ACCEPTED:  # executing goals end with their callbacks
                goal._stopped()
        self._accepted.discard()
        self._waiting.discard()

    def _close_parts(self) -> None:
        for part in self._parts:
            part.destroy()
