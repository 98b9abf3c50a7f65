"""Action servers, driven by plain service calls like any program on the network may send."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.action import ActionServer, CancelResponse, GoalResponse, GoalStatus
from aionode.errors import (
    CallbackSignatureError,
    EntityDestroyedError,
    GoalTransitionError,
    MessageError,
    ServiceError,
    ServiceUnavailableError,
)
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import KEEP_ALL_DEPTH, HistoryPolicy, QoSProfile
from aionode.testing import ManualClock, local_context, settle
from tests.support.actions import Goal, Impl, PlainClient, Worker, endpoint_count

Serve = Callable[..., ActionServer[Any, Any, Any]]

NONE, REJECTED, UNKNOWN_GOAL_ID, GOAL_TERMINATED = range(4)


def yes(_goal: Goal) -> CancelResponse:
    """Accept a cancel request."""
    return CancelResponse.ACCEPT


@pytest.fixture
def client(node: Node) -> PlainClient:
    """A client of plain calls in the node of the server."""
    return PlainClient(node)


@pytest.fixture
def worker() -> Worker:
    """A worker that executes goals until the test lets it end."""
    return Worker()


@pytest.fixture
def serve(node: Node, worker: Worker) -> Serve:
    """Create a server of ``fibonacci`` that cancels whatever it is asked to."""

    def make(
        execute: Callable[[Goal], Any] = worker, **options: Any
    ) -> ActionServer[Any, Any, Any]:
        options = {"cancel_callback": yes, **options}
        return node.create_action_server(Fibonacci, "fibonacci", execute, **options)

    return make


# Accepting


async def test_a_goal_is_accepted_with_the_time_of_the_server(
    manual_clock: ManualClock, serve: Serve, client: PlainClient
) -> None:
    """Cancelling by time needs one clock, and that is the server's."""
    serve()
    await manual_clock.advance(12.5)

    response = await client.send()

    assert response.accepted
    assert response.stamp == Time(sec=12, nanosec=500_000_000)


async def test_a_goal_callback_sees_the_goal_and_may_reject_it(
    serve: Serve, client: PlainClient
) -> None:
    """Impossible goals are better rejected than aborted."""
    serve(
        goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 10 else GoalResponse.REJECT
    )

    assert (await client.send(1, order=9)).accepted
    assert not (await client.send(2, order=10)).accepted


async def test_a_goal_callback_may_be_a_coroutine(serve: Serve, client: PlainClient) -> None:
    """It may have to call another service."""

    async def decide(_goal: Fibonacci.Goal) -> GoalResponse:
        await checkpoint()
        return GoalResponse.REJECT

    serve(goal_callback=decide)

    assert not (await client.send()).accepted


async def test_a_rejected_goal_is_not_kept(serve: Serve, client: PlainClient) -> None:
    """No client will ask for it."""
    server = serve(goal_callback=lambda _goal: GoalResponse.REJECT)

    await client.send()

    assert "active=0 kept=0 " in repr(server)
    assert (await client.result()).status == GoalStatus.UNKNOWN


async def test_a_goal_callback_that_answers_nonsense_rejects(
    serve: Serve, client: PlainClient, caplog: pytest.LogCaptureFixture
) -> None:
    """True looks like yes, but as in rclpy only ACCEPT is; the log says what was returned."""
    serve(goal_callback=lambda _goal: True)

    assert not (await client.send()).accepted
    assert "goal_callback returned True, not a GoalResponse" in caplog.text


async def test_a_failing_goal_callback_tells_the_client(serve: Serve, client: PlainClient) -> None:
    """It does not wait for an answer that never comes."""

    def fail(_goal: Fibonacci.Goal) -> GoalResponse:
        raise LookupError("no map")

    serve(goal_callback=fail)

    with pytest.raises(ServiceError, match="LookupError: no map"):
        await client.send()


async def test_an_action_server_survives_a_failing_goal_callback(
    node: Node, serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """A bad goal is an error of its client; the next goal is decided on as usual."""

    def decide(goal: Fibonacci.Goal) -> GoalResponse:
        if goal.order < 0:
            raise ValueError("no such order")
        return GoalResponse.ACCEPT

    serve(goal_callback=decide)
    with pytest.raises(ServiceError, match="ValueError: no such order"):
        await client.send(1, order=-1)

    assert (await client.send(2)).accepted
    assert node.is_running
    worker.may_end.set()


async def test_an_id_that_is_known_already_is_rejected(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """One id is one goal: while it runs, and while its result is kept."""
    serve()
    assert (await client.send(1)).accepted

    assert not (await client.send(1)).accepted
    worker.may_end.set()
    await client.result(1)
    assert not (await client.send(1)).accepted


async def test_an_id_is_rejected_that_came_while_its_twin_was_decided_on(
    node: Node, serve: Serve, client: PlainClient
) -> None:
    """Simultaneous requests must not evade the rule."""
    server = serve()
    decisions: list[Fibonacci.Goal] = []

    async def decide(goal: Fibonacci.Goal) -> GoalResponse:
        decisions.append(goal)
        if len(decisions) == 1:
            request = Fibonacci.Impl.SendGoalService.Request(goal=goal)
            assert (await server._on_goal(request)).accepted
        return GoalResponse.ACCEPT

    server.register_goal_callback(decide)

    assert not (await client.send(0)).accepted
    assert len(decisions) == 2


# Handing over


async def test_the_client_is_told_before_the_goal_is_handed_over(
    serve: Serve, client: PlainClient
) -> None:
    """Simple clients would ignore feedback of a goal that they do not know as accepted."""
    handed_over: list[Goal] = []
    serve(handle_accepted_callback=handed_over.append)

    await client.send()

    assert handed_over == []
    await settle()
    assert len(handed_over) == 1


async def test_a_handed_over_goal_waits_until_it_is_executed(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """A server that does one goal at a time keeps the others, with the status ACCEPTED."""
    kept: list[Goal] = []
    serve(handle_accepted_callback=kept.append)
    await client.send()
    await settle()

    assert kept[0].status is GoalStatus.ACCEPTED
    assert worker.begun.empty()

    kept[0].execute()
    assert (await worker.begun.get()).status is GoalStatus.EXECUTING


async def test_a_goal_is_executed_once(serve: Serve, client: PlainClient) -> None:
    """A second call is a mistake in the server, also before the first had its turn."""
    kept: list[Goal] = []
    serve(handle_accepted_callback=kept.append)
    await client.send()
    await settle()
    kept[0].execute()

    with pytest.raises(GoalTransitionError, match="EXECUTE while ACCEPTED"):
        kept[0].execute()
    await settle()
    with pytest.raises(GoalTransitionError, match="EXECUTE while EXECUTING"):
        kept[0].execute()


async def test_a_goal_can_be_executed_by_a_callback_of_its_own(
    serve: Serve, client: PlainClient
) -> None:
    """As in rclpy: execute() takes one."""

    def other(goal: Goal) -> Fibonacci.Result:
        goal.succeed()
        return Fibonacci.Result(sequence=[42])

    serve(handle_accepted_callback=lambda goal: goal.execute(other))
    await client.send()

    assert list((await client.result()).result.sequence) == [42]


async def test_a_failing_handle_accepted_callback_aborts_the_goal(
    serve: Serve, client: PlainClient
) -> None:
    """Its client would wait forever otherwise."""

    async def fail(_goal: Goal) -> None:
        raise LookupError("no room")

    serve(handle_accepted_callback=fail)
    await client.send()

    assert (await client.result()).status == GoalStatus.ABORTED


# Executing


async def test_a_goal_succeeds_with_what_the_callback_returns(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The usual way."""
    worker.may_end.set()
    serve()
    await client.send(order=3)

    response = await client.result()

    assert response.status == GoalStatus.SUCCEEDED
    assert list(response.result.sequence) == [0, 1, 2, 3]


@pytest.mark.parametrize("ending", ["succeed", "abort"])
async def test_a_result_can_be_given_with_the_end(
    serve: Serve, client: PlainClient, ending: str
) -> None:
    """Then it is sent at once, even if the callback continues with its cleanup."""
    cleaned = asyncio.Event()

    async def execute(goal: Goal) -> None:
        getattr(goal, ending)(Fibonacci.Result(sequence=[7]))
        await cleaned.wait()

    serve(execute)
    await client.send()

    response = await client.result()

    assert response.status == {"succeed": 4, "abort": 6}[ending]
    assert list(response.result.sequence) == [7]
    cleaned.set()


async def test_a_sync_callback_executes_goals_too(serve: Serve, client: PlainClient) -> None:
    """As in rclpy's tutorial."""

    def execute(goal: Goal) -> Fibonacci.Result:
        goal.succeed()
        return Fibonacci.Result(sequence=[1])

    serve(execute)
    await client.send()

    assert (await client.result()).status == GoalStatus.SUCCEEDED


async def test_an_exception_aborts_the_goal_and_is_logged(
    serve: Serve, client: PlainClient, caplog: pytest.LogCaptureFixture
) -> None:
    """The client gets an end and an empty result, the log the traceback; the node continues."""

    async def execute(_goal: Goal) -> Fibonacci.Result:
        raise LookupError("no such sequence")

    server = serve(execute)
    await client.send()

    response = await client.result()

    assert response.status == GoalStatus.ABORTED
    assert len(response.result.sequence) == 0
    assert "Traceback" in caplog.text
    assert "LookupError: no such sequence" in caplog.text
    assert server.stats.errors == 1


async def test_a_callback_that_sets_no_end_aborts_its_goal(
    serve: Serve, client: PlainClient, caplog: pytest.LogCaptureFixture
) -> None:
    """As in rclpy: a warning, ABORTED, and the result that was returned."""

    async def execute(_goal: Goal) -> Fibonacci.Result:
        return Fibonacci.Result(sequence=[1])

    serve(execute)
    await client.send()

    response = await client.result()

    assert response.status == GoalStatus.ABORTED
    assert list(response.result.sequence) == [1]
    assert "without calling succeed(), abort() or canceled()" in caplog.text


async def test_a_forgotten_return_is_warned_about(
    serve: Serve, client: PlainClient, caplog: pytest.LogCaptureFixture
) -> None:
    """The goal has succeeded, so the client gets an empty result."""

    async def execute(goal: Goal) -> None:
        goal.succeed()

    serve(execute)
    await client.send()

    assert (await client.result()).status == GoalStatus.SUCCEEDED
    assert "returned no result" in caplog.text


@pytest.mark.parametrize(
    ("wrong", "error"),
    [(String(), TypeError), (Fibonacci.Result(sequence=[2**40]), MessageError)],
)
async def test_a_wrong_result_is_refused_before_the_goal_ends(
    serve: Serve, client: PlainClient, wrong: Any, error: type[Exception]
) -> None:
    """The callback learns of its mistake while it can still act."""
    caught: list[Exception] = []

    async def execute(goal: Goal) -> Fibonacci.Result:
        try:
            goal.succeed(wrong)
        except error as exception:
            caught.append(exception)
        goal.succeed()
        return Fibonacci.Result(sequence=[1])

    serve(execute)
    await client.send()

    assert list((await client.result()).result.sequence) == [1]
    assert len(caught) == 1


async def test_a_wrong_result_that_is_returned_counts_as_an_exception(
    serve: Serve, client: PlainClient, caplog: pytest.LogCaptureFixture
) -> None:
    """It cannot be sent, so it is logged; the state that was set stays."""

    async def execute(goal: Goal) -> String:
        goal.succeed()
        return String()

    serve(execute)
    await client.send()

    response = await client.result()

    assert response.status == GoalStatus.SUCCEEDED
    assert len(response.result.sequence) == 0
    assert "TypeError" in caplog.text


async def test_an_end_is_final(serve: Serve, client: PlainClient) -> None:
    """Ending a goal twice is a mistake in the callback."""
    caught: list[GoalTransitionError] = []

    async def execute(goal: Goal) -> Fibonacci.Result:
        goal.succeed()
        with pytest.raises(GoalTransitionError) as error:
            goal.abort()
        caught.append(error.value)
        return Fibonacci.Result()

    serve(execute)
    await client.send()

    assert (await client.result()).status == GoalStatus.SUCCEEDED
    assert (caught[0].status, caught[0].event) == ("SUCCEEDED", "ABORT")


async def test_a_goal_cannot_be_canceled_without_a_request(
    serve: Serve, client: PlainClient
) -> None:
    """canceled() without a request would surprise the client."""

    async def execute(goal: Goal) -> Fibonacci.Result:
        with pytest.raises(GoalTransitionError):
            goal.canceled()
        goal.abort()
        return Fibonacci.Result()

    serve(execute)
    await client.send()

    assert (await client.result()).status == GoalStatus.ABORTED


async def test_a_hundred_goals_run_at_once(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The default is no limit; each client gets its own result."""
    server = serve()
    await asyncio.gather(*(client.send(number, order=number) for number in range(1, 101)))
    for _ in range(100):
        assert (await worker.begun.get()).status is GoalStatus.EXECUTING

    worker.may_end.set()
    responses = await asyncio.gather(*(client.result(number) for number in range(1, 101)))

    assert [response.result.sequence[-1] for response in responses] == list(range(1, 101))
    assert server.stats.received == 100


async def test_no_more_goals_run_at_once_than_allowed(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The others wait, as ACCEPTED, in the order in which they came."""
    serve(concurrent=2)
    for number in (1, 2, 3):
        await client.send(number)
    await settle()

    assert worker.begun.qsize() == 2
    assert client.statuses[-1] == {1: 2, 2: 2, 3: 1}

    worker.may_end.set()
    assert (await client.result(3)).status == GoalStatus.SUCCEEDED


# Threads


async def test_an_offloaded_callback_uses_its_handle_in_the_thread(
    serve: Serve, client: PlainClient
) -> None:
    """Blocking callbacks of rclpy work unchanged: feedback, the end, and mistakes."""

    def execute(goal: Goal) -> Fibonacci.Result:
        goal.publish_feedback(Fibonacci.Feedback(sequence=[1]))
        with pytest.raises(TypeError):
            goal.publish_feedback(String())  # type: ignore[arg-type]  # the mistake
        goal.succeed()
        return Fibonacci.Result(sequence=[1, 2])

    serve(execute, offload=True)
    await client.send()

    assert list((await client.result()).result.sequence) == [1, 2]
    assert list((await client.feedback.receive()).feedback.sequence) == [1]


async def test_an_offloaded_callback_sees_that_it_is_to_stop(
    serve: Serve, client: PlainClient
) -> None:
    """A thread cannot be cancelled, and the goal is not over before it has stopped."""
    loop, begun = asyncio.get_running_loop(), asyncio.Event()

    def execute(goal: Goal) -> Fibonacci.Result:
        loop.call_soon_threadsafe(begun.set)
        while not goal.is_cancel_requested:
            pass
        goal.canceled()
        return Fibonacci.Result(sequence=[9])

    serve(execute, offload=True)
    await client.send()
    await begun.wait()

    assert await client.cancel() == (NONE, [1])
    response = await client.result()
    assert (response.status, list(response.result.sequence)) == (GoalStatus.CANCELED, [9])


# Cancelling


async def test_an_accepted_request_cancels_the_callback(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """If it lets CancelledError propagate, its goal ends as CANCELED."""
    serve()
    await client.send()
    goal = await worker.begun.get()

    assert await client.cancel() == (NONE, [1])
    assert (await client.result()).status == GoalStatus.CANCELED
    assert worker.cancelled == [goal]


@pytest.mark.parametrize(("ending", "status"), [("canceled", 5), ("succeed", 4), ("abort", 6)])
async def test_a_cancelled_callback_decides_how_its_goal_ends(
    serve: Serve, client: PlainClient, ending: str, status: int
) -> None:
    """It may clean up, or may have been almost done."""
    begun = asyncio.Event()

    async def execute(goal: Goal) -> Fibonacci.Result:
        begun.set()
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            assert goal.is_cancel_requested
            getattr(goal, ending)()
        return Fibonacci.Result(sequence=[5])

    serve(execute)
    await client.send()
    await begun.wait()
    await client.cancel()

    response = await client.result()

    assert (response.status, list(response.result.sequence)) == (status, [5])


async def test_a_shielded_callback_finishes_its_work(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """Shielded work is not interrupted, and the goal may succeed in spite of the request."""
    begun, may_end = asyncio.Event(), asyncio.Event()

    async def work() -> list[int]:
        await may_end.wait()
        return [1, 2, 3]

    async def execute(goal: Goal) -> Fibonacci.Result:
        async with asyncio.TaskGroup() as tasks:
            task = tasks.create_task(work())
            begun.set()
            try:
                sequence = await asyncio.shield(task)
            except asyncio.CancelledError:
                sequence = await task
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    serve(execute)
    await client.send()
    await begun.wait()
    assert await client.cancel() == (NONE, [1])
    may_end.set()

    assert (await client.result()).status == GoalStatus.SUCCEEDED


async def test_nothing_is_cancelled_by_default(
    node: Node, worker: Worker, client: PlainClient
) -> None:
    """As in rclpy: a server declares that it can stop by a cancel_callback."""
    node.create_action_server(Fibonacci, "fibonacci", worker)
    await client.send()
    goal = await worker.begun.get()

    assert await client.cancel() == (REJECTED, [])
    assert goal.status is GoalStatus.EXECUTING


async def test_a_cancel_callback_that_answers_nonsense_rejects(
    serve: Serve, client: PlainClient, caplog: pytest.LogCaptureFixture
) -> None:
    """Only ACCEPT is yes."""
    serve(cancel_callback=lambda _goal: True)
    await client.send()

    assert await client.cancel() == (REJECTED, [])
    assert "cancel_callback returned True" in caplog.text


async def test_a_goal_that_ends_while_it_is_decided_on_is_terminated(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """A slow cancel_callback may be overtaken; nothing invalid happens."""

    async def decide(_goal: Goal) -> CancelResponse:
        worker.may_end.set()
        await client.result()
        return CancelResponse.ACCEPT

    serve(cancel_callback=decide)
    await client.send()
    await worker.begun.get()

    assert await client.cancel() == (GOAL_TERMINATED, [])


async def test_a_failing_cancel_callback_tells_the_client(
    serve: Serve, client: PlainClient
) -> None:
    """The goal continues."""

    def fail(_goal: Goal) -> CancelResponse:
        raise LookupError("which one?")

    serve(cancel_callback=fail)
    await client.send()

    with pytest.raises(ServiceError, match="LookupError: which one"):
        await client.cancel()


async def test_a_goal_after_its_end_and_an_unknown_one_cannot_be_cancelled(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The codes tell the two apart."""
    worker.may_end.set()
    serve()
    await client.send()
    await client.result()

    assert await client.cancel(1) == (GOAL_TERMINATED, [])
    assert await client.cancel(2) == (UNKNOWN_GOAL_ID, [])


async def test_a_goal_that_waits_for_its_turn_is_canceled_at_once(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """Nothing was begun, so there is nothing to clean up, and its callback is never called."""
    server = serve(concurrent=False)
    await client.send(1)
    await client.send(2)

    assert await client.cancel(2) == (NONE, [2])
    assert (await client.result(2)).status == GoalStatus.CANCELED

    worker.may_end.set()
    await client.result(1)
    await settle()
    assert (server.stats.received, server.stats.dropped) == (1, 1)


async def test_a_goal_cancelled_before_it_was_executed_shows_it_to_its_callback(
    serve: Serve, client: PlainClient
) -> None:
    """As in rclpy, where a callback checks first; if it waits nevertheless, it is cancelled."""
    kept: list[Goal] = []
    seen: list[bool] = []

    async def execute(goal: Goal) -> Fibonacci.Result:
        seen.append(goal.is_cancel_requested)
        await asyncio.Event().wait()
        return Fibonacci.Result()

    serve(execute, handle_accepted_callback=kept.append)
    await client.send()
    assert await client.cancel() == (NONE, [1])
    assert kept[0].status is GoalStatus.CANCELING

    kept[0].execute()

    assert (await client.result()).status == GoalStatus.CANCELED
    assert seen == [True]


async def test_a_sync_callback_of_a_goal_cancelled_before_ends_it_itself(
    serve: Serve, client: PlainClient
) -> None:
    """Deferred goals of rclpy are executed like this."""
    kept: list[Goal] = []

    def execute(goal: Goal) -> Fibonacci.Result:
        goal.canceled()
        return Fibonacci.Result(sequence=[3])

    serve(execute, handle_accepted_callback=kept.append)
    await client.send()
    await client.cancel()
    kept[0].execute()

    response = await client.result()
    assert (response.status, list(response.result.sequence)) == (GoalStatus.CANCELED, [3])


@pytest.mark.parametrize(
    ("number", "stamp", "meant"),
    [
        pytest.param(2, None, [2], id="one"),
        pytest.param(0, None, [1, 2, 3], id="all"),
        pytest.param(0, Time(sec=2), [1, 2], id="up to a time"),
        pytest.param(3, Time(sec=1), [1, 3], id="up to a time, and one"),
    ],
)
async def test_one_request_can_mean_several_goals(
    manual_clock: ManualClock,
    serve: Serve,
    worker: Worker,
    client: PlainClient,
    number: int,
    stamp: Time | None,
    meant: list[int],
) -> None:
    """The four forms of CancelGoal, on goals accepted after 1, 2 and 3 s."""
    serve()
    for each in (1, 2, 3):
        await manual_clock.advance(1.0)
        await client.send(each)
    await settle()

    assert await client.cancel(number, stamp) == (NONE, meant)
    await settle()
    assert len(worker.cancelled) == len(meant)


async def test_each_goal_of_a_request_is_decided_on_alone(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """Only those that may be cancelled are listed; none is skipped."""
    serve(
        cancel_callback=lambda goal: (
            CancelResponse.ACCEPT if goal.request.order % 2 else CancelResponse.REJECT
        )
    )
    for number in range(1, 7):
        await client.send(number, order=number)

    assert await client.cancel(0) == (NONE, [1, 3, 5])


async def test_cancelling_all_where_there_is_nothing_is_no_error(
    serve: Serve, client: PlainClient
) -> None:
    """A request to stop everything includes goals that have not started."""
    serve()

    assert await client.cancel(0) == (NONE, [])


# Results


async def test_every_request_for_a_result_is_answered(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """Including those that arrived before the end, and any number of them."""
    serve()
    await client.send()
    early = [asyncio.ensure_future(client.result()) for _ in range(3)]  # noqa: TID251  # beside
    await settle()
    assert not any(each.done() for each in early)

    worker.may_end.set()

    assert [(await each).status for each in early] == [4, 4, 4]
    assert (await client.result()).status == GoalStatus.SUCCEEDED


async def test_a_result_is_kept_for_the_timeout_and_no_longer(
    manual_clock: ManualClock, serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """Counted from the end of the goal; then nothing of it is left."""
    server = serve(result_timeout=10)
    await client.send()
    await manual_clock.advance(60)
    worker.may_end.set()
    await settle()

    await manual_clock.advance(9.999)
    assert (await client.result()).status == GoalStatus.SUCCEEDED
    await manual_clock.advance(0.001)
    assert (await client.result()).status == GoalStatus.UNKNOWN
    assert "active=0 kept=0 " in repr(server)


async def test_results_are_kept_ten_seconds_by_default(
    manual_clock: ManualClock, serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """As in rclpy."""
    worker.may_end.set()
    server = serve()
    await asyncio.gather(*(client.send(number) for number in range(1, 101)))
    await settle()

    await manual_clock.advance(9)
    assert "active=0 kept=100 " in repr(server)
    await manual_clock.advance(1)
    assert "active=0 kept=0 " in repr(server)


async def test_without_a_timeout_only_earlier_requests_get_a_result(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """0 keeps nothing, as in rcl."""
    server = serve(result_timeout=0)
    await client.send()
    early = asyncio.ensure_future(client.result())  # noqa: TID251  # beside the test
    await settle()

    worker.may_end.set()

    assert (await early).status == GoalStatus.SUCCEEDED
    assert (await client.result()).status == GoalStatus.UNKNOWN
    assert "active=0 kept=0 " in repr(server)


@pytest.mark.parametrize("wrong", [-1, float("inf"), float("nan")])
async def test_a_timeout_that_is_no_time_is_refused(serve: Serve, wrong: float) -> None:
    """As rcl refuses a negative one."""
    with pytest.raises(ValueError, match="result_timeout"):
        serve(result_timeout=wrong)


async def test_a_result_may_be_reused_by_the_callback(serve: Serve, client: PlainClient) -> None:
    """The given result is copied, as in publish()."""
    result = Fibonacci.Result(sequence=[1])

    async def execute(goal: Goal) -> Fibonacci.Result:
        goal.succeed(result)
        result.sequence = [2]
        return result

    serve(execute)
    await client.send()

    assert list((await client.result()).result.sequence) == [1]


# Feedback and status


async def test_feedback_bears_the_id_of_its_goal(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """All goals of a server share one topic."""
    serve()
    await client.send(1)
    await client.send(2)
    first, second = await worker.begun.get(), await worker.begun.get()

    second.publish_feedback(Fibonacci.Feedback(sequence=[2]))
    first.publish_feedback(Fibonacci.Feedback(sequence=[1]))

    got = [await client.feedback.receive() for _ in range(2)]
    assert [(int(each.goal_id.uuid[-1]), list(each.feedback.sequence)) for each in got] == [
        (2, [2]),
        (1, [1]),
    ]


async def test_feedback_of_another_type_is_refused(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The text names both types."""
    serve()
    await client.send()
    goal = await worker.begun.get()

    with pytest.raises(
        TypeError, match="is a String; a example_interfaces/action/Fibonacci_Feedback is needed"
    ):
        goal.publish_feedback(String())  # type: ignore[arg-type]  # the mistake


async def test_a_result_waits_for_feedback_that_has_no_room_yet(worker: Worker) -> None:
    """Clients stop listening once they have the result, though not for a reader that is stuck."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    async with local_context() as context, Node("node", context=context) as node:
        node.create_action_server(Fibonacci, "fibonacci", worker)
        client = PlainClient(node)
        await client.send()
        goal = await worker.begun.get()
        topic = client.feedback.topic_name
        slow = node.create_subscription(Impl.FeedbackMessage, topic, None, keep_all)
        feedback = Fibonacci.Feedback()
        for _ in range(KEEP_ALL_DEPTH):
            goal.publish_feedback(feedback)
        worker.may_end.set()
        await settle()
        result = asyncio.ensure_future(client.result())  # noqa: TID251  # beside the test
        await settle()
        assert not result.done()

        await slow.receive()

        assert (await result).status == GoalStatus.SUCCEEDED


async def test_the_status_topic_tells_each_change_of_all_goals(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The whole list each time, kept results included."""
    serve()
    await client.send(1)
    await worker.begun.get()
    await settle()
    await client.send(2)
    await worker.begun.get()
    await settle()
    await client.cancel(2)
    await client.result(2)
    await settle()

    assert [*client.statuses[0]] == [1]
    assert client.statuses[-1] == {1: 2, 2: 5}


async def test_late_subscriptions_get_the_newest_status(
    node: Node, serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """A tool that starts now sees the current goals."""
    serve()
    await client.send()
    await worker.begun.get()

    late = PlainClient(node)
    await settle()

    assert late.statuses == [{1: 2}]


# The whole server


async def test_stats_tell_how_goals_were_executed(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """An action server is measured as every other entity."""
    worker.may_end.set()
    server = serve()
    await client.send(1)
    await client.send(2)
    await client.result(2)

    assert (server.stats.received, server.stats.errors, server.stats.dropped) == (2, 0, 0)
    assert server.stats.queue_wait.count == server.stats.run_time.count == 2
    assert server.stats.blocking.max_ns <= server.stats.run_time.max_ns


async def test_a_server_has_the_endpoints_that_ros_gives_it(node: Node, serve: Serve) -> None:
    """Three services and two topics, and nothing besides."""
    serve()

    names = {
        endpoint.name: endpoint.type_name
        for endpoint in node.graph.endpoints()
        if "_action" in endpoint.name
    }

    assert names == {
        "/fibonacci/_action/send_goal": "example_interfaces/action/Fibonacci_SendGoal",
        "/fibonacci/_action/get_result": "example_interfaces/action/Fibonacci_GetResult",
        "/fibonacci/_action/cancel_goal": "action_msgs/srv/CancelGoal",
        "/fibonacci/_action/feedback": "example_interfaces/action/Fibonacci_FeedbackMessage",
        "/fibonacci/_action/status": "action_msgs/msg/GoalStatusArray",
    }


async def test_a_destroyed_server_leaves_nothing_behind(
    node: Node, serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """Its clients are notified at once, its callbacks are cancelled, its tables are empty."""
    before = endpoint_count(node)
    server = serve()
    await client.send()
    goal = await worker.begun.get()
    waiting = asyncio.ensure_future(client.result())  # noqa: TID251  # beside the test
    await settle()

    server.destroy()
    server.destroy()

    with pytest.raises(ServiceUnavailableError):
        await waiting
    await settle()
    assert worker.cancelled == [goal]
    assert goal.status is GoalStatus.ABORTED
    assert "active=0 kept=0 " in repr(server)
    assert endpoint_count(node) == before


async def test_a_stopping_node_aborts_its_goals() -> None:
    """There was no cancel request; accepted goals that have not started are aborted too."""
    worker = Worker()
    kept: list[Goal] = []

    async with local_context() as context, Node("node", context=context) as node:
        node.create_action_server(Fibonacci, "one", worker)
        node.create_action_server(Fibonacci, "two", worker, handle_accepted_callback=kept.append)
        await PlainClient(node, "one").send()
        await PlainClient(node, "two").send()
        await settle()
        goal = await worker.begun.get()

    assert goal.status is GoalStatus.ABORTED
    assert kept[0].status is GoalStatus.ABORTED


async def test_a_callback_may_clean_up_when_the_server_is_gone(
    serve: Serve, client: PlainClient
) -> None:
    """Ending a goal after its server is gone raises nothing."""
    begun = asyncio.Event()
    cleaned: list[Goal] = []

    async def execute(goal: Goal) -> Fibonacci.Result:
        begun.set()
        try:
            await asyncio.Event().wait()
        finally:
            goal.publish_feedback(Fibonacci.Feedback())
            goal.canceled()
            goal.abort()
            cleaned.append(goal)
        return Fibonacci.Result()

    server = serve(execute)
    await client.send()
    await begun.wait()
    server.destroy()
    await settle()

    assert [goal.status for goal in cleaned] == [GoalStatus.ABORTED]


async def test_goals_wait_for_the_node_to_run() -> None:
    """A server may be created in a constructor, long before there is a loop."""
    async with local_context() as context, Node("asking", context=context) as asking:
        node = Node("serving", context=context)
        worker = Worker()
        worker.may_end.set()
        node.create_action_server(Fibonacci, "fibonacci", worker)
        client = PlainClient(asking)
        sending = asyncio.ensure_future(client.send())  # noqa: TID251  # beside the test
        await settle()
        assert not sending.done()

        async with node:
            assert (await sending).accepted
            assert (await client.result()).status == GoalStatus.SUCCEEDED


@pytest.mark.parametrize("wrong", [String, 3, None])
async def test_something_else_than_an_action_is_refused(node: Node, wrong: Any) -> None:
    """The text shows what fits."""
    with pytest.raises(
        TypeError, match=r"not an action class; use one such as aionode\.interfaces"
    ):
        node.create_action_server(wrong, "fibonacci", lambda _goal: None)


async def test_callbacks_are_looked_at_when_the_server_is_made(node: Node, serve: Serve) -> None:
    """A mistake is reported where it was made, and nothing of the server remains."""
    before = endpoint_count(node)

    with pytest.raises(CallbackSignatureError, match=r"must take \(goal_handle\)"):
        serve(lambda: None)
    with pytest.raises(CallbackSignatureError, match=r"must take \(goal\)"):
        serve(goal_callback=lambda: None)
    with pytest.raises(TypeError):
        serve(cancel_callback=3)

    assert endpoint_count(node) == before


async def test_a_destroyed_node_refuses_a_server(node: Node) -> None:
    """As everything else."""
    node.destroy_node()

    with pytest.raises(EntityDestroyedError):
        node.create_action_server(Fibonacci, "fibonacci", lambda _goal: None)


async def test_a_server_that_cannot_be_made_leaves_nothing(node: Node) -> None:
    """Its parts are created one after another, and one of them may be refused."""
    before = endpoint_count(node)

    with pytest.raises(TypeError):
        ActionServer(node, Fibonacci, "other", yes, result_service_qos_profile="no profile")  # type: ignore[arg-type]  # the mistake

    assert endpoint_count(node) == before


async def test_a_goal_is_aborted_whose_node_stops_before_its_callback_began(
    serve: Serve, client: PlainClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its turn had come, and the end came first."""
    goals: list[Goal] = []
    server = serve(handle_accepted_callback=goals.append)
    await client.send()
    await settle()
    begin = goals[0]._begin

    def begin_and_end() -> None:
        begin()
        server.destroy()

    monkeypatch.setattr(goals[0], "_begin", begin_and_end)
    goals[0].execute()
    await settle()

    assert goals[0].status is GoalStatus.ABORTED


async def test_goals_go_on_beside_a_reader_that_does_not_read(
    node: Node, serve: Serve, worker: Worker, client: PlainClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full KEEP_ALL subscription of a tool must neither delay nor abort what a robot does."""
    monkeypatch.setattr("aionode.qos._profile.KEEP_ALL_DEPTH", 3)
    monkeypatch.setattr("aionode.endpoints.actions.server.DRAIN_LIMIT_S", 0.01)
    serve()
    node.create_subscription(
        Fibonacci.Impl.FeedbackMessage,
        "fibonacci/_action/feedback",
        qos_profile=QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=3),
    )
    await client.send()
    goal = await worker.begun.get()
    for _ in range(10):
        goal.publish_feedback(Fibonacci.Feedback())
    worker.may_end.set()

    assert (await client.result()).status == GoalStatus.SUCCEEDED


async def test_a_handed_over_goal_is_executed_if_the_callback_was_taken_back(
    serve: Serve, worker: Worker, client: PlainClient
) -> None:
    """The callback may be replaced between a goal's acceptance and its turn."""
    server = serve(handle_accepted_callback=lambda _goal: None)
    hand_over = server._hand_over.callback

    def replace_first(goal: Goal) -> Any:
        server.register_handle_accepted_callback(None)
        return hand_over(goal)

    server._hand_over.callback = replace_first
    await client.send()

    assert (await worker.begun.get()).status is GoalStatus.EXECUTING
