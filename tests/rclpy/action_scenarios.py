"""Actions in the differential tests: ``action_scenarios.py [name …]``, like `scenarios.py`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from scenarios import PATIENCE_S, Trace, attempt, main, scene, until
from test_msgs.action import Fibonacci
from unique_identifier_msgs.msg import UUID

import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future


class Counting:
    """An action server and its client, in a node that the scene spins."""

    def __init__(self, trace: Trace, **options: Any) -> None:
        self.trace = trace
        self.node = rclpy.create_node("counting")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        options = {"execute_callback": self.execute, **options}
        self.server = ActionServer(self.node, Fibonacci, "count", **options)
        self.client = ActionClient(self.node, Fibonacci, "count")
        trace("server", self.client.wait_for_server(timeout_sec=PATIENCE_S))

    def execute(self, goal: Any) -> Any:
        """Count, and succeed."""
        self.tell("execute", goal)
        goal.publish_feedback(Fibonacci.Feedback(sequence=[goal.request.order]))
        goal.succeed()
        self.tell("succeeded", goal)
        return Fibonacci.Result(sequence=[1, goal.request.order])

    def tell(self, what: str, goal: Any) -> None:
        """Trace the state of a goal at the server."""
        self.trace(what, goal.status, goal.is_active, goal.is_cancel_requested)

    def result_of(self, future: Any) -> Any:
        """Spin until a future is done."""
        self.executor.spin_until_future_complete(future, timeout_sec=PATIENCE_S)
        return future.result()

    def until(self, condition: Callable[[], Any]) -> None:
        """Spin until a condition holds."""
        until(condition, lambda: self.executor.spin_once(timeout_sec=0.05))

    def send(self, order: int, **options: Any) -> Any:
        """Send a goal, and return the server's answer."""
        return self.result_of(self.client.send_goal_async(Fibonacci.Goal(order=order), **options))

    def end(self, goal: Any) -> None:
        """Trace the result of a goal."""
        response = self.result_of(goal.get_result_async())
        self.until(lambda: goal.status == response.status)
        self.trace("result", response.status, list(response.result.sequence), goal.status)


@scene
def a01_a_goal_from_its_request_to_its_result(trace: Trace) -> None:
    counting = Counting(trace)
    heard: list[Any] = []
    goal = counting.send(4, feedback_callback=heard.append)
    trace("goal", goal.accepted, bytes(goal.goal_id.uuid) != bytes(16), goal.stamp.sec > 0)
    counting.until(lambda: heard)
    counting.end(goal)
    trace("feedback", list(heard[0].feedback.sequence), heard[0].goal_id == goal.goal_id)
    counting.end(goal)  # as often as requested
    trace("repr", repr(goal).partition(" ")[0], repr(goal).rpartition(", ")[2])
    answer = counting.result_of(goal.cancel_goal_async())
    trace("cancelled too late", answer.return_code, len(answer.goals_canceling))


@scene
def a02_goals_are_refused(trace: Trace) -> None:
    def decide(goal: Any) -> Any:
        return {1: GoalResponse.ACCEPT, 2: GoalResponse.REJECT}.get(goal.order, "neither")

    counting = Counting(trace, goal_callback=decide)
    for order in (1, 2, 3):
        trace(order, counting.send(order).accepted)
    id_ = UUID(uuid=list(range(16)))
    for _ in range(2):  # the same id again
        trace("own id", counting.send(1, goal_uuid=id_).accepted)
    attempt(trace, "goal", lambda: counting.client.send_goal_async(Fibonacci.Result()))
    attempt(trace, "handle", lambda: counting.client._cancel_goal_async("none"))


@scene
def a03_goals_are_cancelled_if_the_server_agrees(trace: Trace) -> None:
    may_end: Future[Any] = Future()
    begun: list[Any] = []

    async def execute(goal: Any) -> Any:
        begun.append(goal)
        counting.tell("execute", goal)
        await may_end
        counting.tell("may end", goal)
        if goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.succeed()
        return Fibonacci.Result(sequence=[goal.request.order])

    def decide(goal: Any) -> CancelResponse:
        return CancelResponse.ACCEPT if goal.request.order == 2 else CancelResponse.REJECT

    counting = Counting(trace, execute_callback=execute, cancel_callback=decide)
    goals = [counting.send(order) for order in (1, 2)]
    counting.until(lambda: len(begun) == 2)
    for goal in goals:
        answer = counting.result_of(goal.cancel_goal_async())
        same = [info.goal_id == goal.goal_id for info in answer.goals_canceling]
        trace("cancel", answer.return_code, same)
    may_end.set_result(None)
    for goal in goals:
        counting.end(goal)


@scene
def a04_callbacks_that_fail_or_forget_to_end_abort_their_goal(trace: Trace) -> None:
    def execute(goal: Any) -> Any:
        if goal.request.order == 1:
            raise LookupError("on purpose")
        if goal.request.order == 2:
            goal.abort()
        return Fibonacci.Result(sequence=[goal.request.order])

    counting = Counting(trace, execute_callback=execute)
    for order in (1, 2, 3):
        counting.end(counting.send(order))


@scene
def a05_a_goal_is_kept_and_executed_later(trace: Trace) -> None:
    kept: list[Any] = []
    counting = Counting(trace, handle_accepted_callback=kept.append)
    goal = counting.send(5)
    counting.until(lambda: kept)
    counting.tell("kept", kept[0])
    for method in (kept[0].succeed, kept[0].abort, kept[0].canceled):
        attempt(trace, method.__name__, method)
    kept[0].execute()
    counting.end(goal)
    for method in (kept[0].succeed, kept[0].abort, kept[0].canceled):
        attempt(trace, method.__name__, method)
    attempt(trace, "feedback", lambda: kept[0].publish_feedback("none"))
    trace("equal", kept[0] == kept[0], kept[0] == "none")
    kept[0].destroy()
    counting.tell("destroyed", kept[0])
    attempt(trace, "destroyed", kept[0].succeed)


@scene
def a06_a_result_is_forgotten_after_its_time(trace: Trace) -> None:
    counting = Counting(trace, result_timeout=0)
    goal = counting.send(6)
    counting.until(lambda: not counting.server._goal_handles)
    response = counting.result_of(goal.get_result_async())
    trace("forgotten", response.status, list(response.result.sequence))
    counting.client.destroy()
    counting.server.destroy()


if __name__ == "__main__":
    main()
