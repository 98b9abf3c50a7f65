"""Action clients and the goals they send: one suite, by object and over Zenoh."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import AsyncIterator
from typing import Any, NamedTuple

import pytest

from aionode._process.concurrency import checkpoint
from aionode.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    ClientGoalHandle,
    GoalResponse,
    GoalStatus,
)
from aionode.errors import (
    CallbackSignatureError,
    EntityDestroyedError,
    GoalAbortedError,
    GoalCanceledError,
    GoalLostError,
    GoalRejected,
    GoalRejectedError,
    MessageError,
    ServiceError,
    ServiceUnavailableError,
)
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import qos_profile_action_status_default
from aionode.testing import settle
from tests.support.actions import Goal, PlainClient, Worker, end_of, endpoint_count, uuid_of
from tests.support.peers import contexts_over, isolated_environment, quiet_node
from tests.support.spies import returns_of

Client = ActionClient[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
Server = ActionServer[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
Sent = ClientGoalHandle[Fibonacci.Result, Fibonacci.Feedback]


class Ends(NamedTuple):
    """A server and a client that are matched, and the executor of the goals."""

    serving: Node
    asking: Node
    server: Server
    client: Client
    worker: Worker
    requests: list[Goal]
    """A goal is entered for each cancel request."""


@pytest.fixture(params=["local", "zenoh"])
async def ends(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Ends]:
    """Two nodes: in one context, or in two that only Zenoh connects, like two processes."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    async with (
        asyncio.timeout(30),
        contexts_over(request.param) as (first, second),
        quiet_node("serving", first) as serving,
        quiet_node("asking", second) as asking,
    ):
        requests: list[Goal] = []

        def decide(goal: Goal) -> CancelResponse:
            requests.append(goal)
            return CancelResponse.ACCEPT

        worker = Worker()
        server: Server = serving.create_action_server(
            Fibonacci, "fibonacci", worker, cancel_callback=decide
        )
        client: Client = asking.create_action_client(Fibonacci, "fibonacci")
        await client.wait_for_server()
        yield Ends(serving, asking, server, client, worker, requests)


async def begin(ends: Ends, order: int = 5) -> tuple[Sent, Goal]:
    """Send a goal, and return both of its handles once it is executing."""
    sent = await ends.client.send_goal(Fibonacci.Goal(order=order))
    return sent, await ends.worker.begun.get()


async def cancelled(waiting: asyncio.Task[Any]) -> None:
    """Cancel a waiting task, and check that it ends as cancelled."""
    waiting.cancel()
    with pytest.raises(asyncio.CancelledError):
        await waiting


def beside(work: Any) -> asyncio.Task[Any]:
    """Do something beside the test."""
    return asyncio.ensure_future(work)  # noqa: TID251  # owned by the test


async def gone(ends: Ends) -> None:
    """Wait until a server is no longer known."""
    while ends.client.server_is_ready():
        await ends.asking.graph.changed()


# Success


async def test_a_goal_succeeds(ends: Ends) -> None:
    """Sent, accepted, executed, and its result is the server's."""
    sent, goal = await begin(ends)
    assert sent.accepted
    assert bytes(sent.goal_id.uuid) == bytes(goal.goal_id.uuid)
    assert sent.stamp == goal.info.stamp
    ends.worker.may_end.set()

    outcome = await sent.result()

    assert outcome.status is sent.status is GoalStatus.SUCCEEDED
    assert list(outcome.result.sequence) == [0, 1, 2, 3, 4, 5]
    assert outcome.error_text == ""


async def test_call_is_the_whole_in_one(ends: Ends) -> None:
    """For callers that only need the result."""
    ends.worker.may_end.set()

    result = await ends.client.call(Fibonacci.Goal(order=2))

    assert list(result.sequence) == [0, 1, 2]


async def test_a_result_can_be_awaited_often(ends: Ends) -> None:
    """By several tasks, and again after the end, when the server may have forgotten it."""
    sent, _ = await begin(ends)
    waiting = [beside(sent.result()) for _ in range(3)]
    ends.worker.may_end.set()

    outcomes = [await each for each in waiting]
    ends.server.destroy()

    assert outcomes == [await sent.result()] * 3


async def test_the_status_follows_the_server(ends: Ends, monkeypatch: pytest.MonkeyPatch) -> None:
    """The handle shows what the status topic tells."""
    updated = returns_of(monkeypatch, ClientGoalHandle, "_update_status")
    sent, _ = await begin(ends)
    while sent.status is not GoalStatus.EXECUTING:
        await updated.get()

    ends.worker.may_end.set()
    await sent.result()
    assert sent.done


async def test_a_hundred_goals_at_once_get_their_own_feedback_and_results(ends: Ends) -> None:
    """Nothing is mixed up, and nothing is left in any table."""

    async def go(order: int) -> tuple[list[int], int]:
        sent = await ends.client.send_goal(Fibonacci.Goal(order=order))
        heard = [int(feedback.sequence[0]) async for feedback in sent]
        return heard, int((await sent.result()).result.sequence[-1])

    async def execute(goal: Goal) -> Fibonacci.Result:
        for _ in range(3):
            goal.publish_feedback(Fibonacci.Feedback(sequence=[goal.request.order]))
            await checkpoint()  # lets the others run in between
        goal.succeed()
        return Fibonacci.Result(sequence=[goal.request.order])

    ends.server.register_execute_callback(execute)

    outcomes = await asyncio.gather(*(go(order) for order in range(100)))

    assert outcomes == [([order] * 3, order) for order in range(100)]
    assert "goals=0>" in repr(ends.client)
    assert "active=0 kept=100 " in repr(ends.server)  # the results, for 10 s


# Feedback


async def test_feedback_is_iterated_over_until_the_goal_ends(ends: Ends) -> None:
    """The loop needs no other end."""
    sent, goal = await begin(ends)
    heard = []

    for number in (1, 2, 3):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
    async for feedback in sent:
        heard.append(int(feedback.sequence[0]))
        if heard == [1, 2, 3]:
            ends.worker.may_end.set()

    assert heard == [1, 2, 3]
    assert (await sent.result()).status is GoalStatus.SUCCEEDED


async def test_feedback_from_before_the_iteration_is_kept(ends: Ends) -> None:
    """Including feedback faster than the answer to the goal, and feedback read after the end."""

    async def execute(goal: Goal) -> Fibonacci.Result:
        for number in range(5):
            goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        goal.succeed()
        return Fibonacci.Result()

    ends.server.register_execute_callback(execute)
    sent = await ends.client.send_goal(Fibonacci.Goal())
    await sent.result()

    assert [int(feedback.sequence[0]) async for feedback in sent] == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("ends", ["local"], indirect=True)
async def test_the_newest_hundred_are_kept(ends: Ends) -> None:
    """A client that never reads must not exhaust the memory.

    In one process only: Zenoh may drop some of a burst before it reaches the client.
    """
    sent, goal = await begin(ends)
    for number in range(150):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
    ends.worker.may_end.set()
    await sent.result()
    await settle()  # feedback comes on a topic of its own

    assert [int(feedback.sequence[0]) async for feedback in sent] == list(range(50, 150))


async def test_feedback_of_other_goals_is_not_heard(ends: Ends) -> None:
    """All goals share a topic."""
    one, _ = await begin(ends)
    two, goal = await begin(ends)
    goal.publish_feedback(Fibonacci.Feedback(sequence=[2]))
    ends.worker.may_end.set()

    assert [list(feedback.sequence) async for feedback in two] == [[2]]
    assert [list(feedback.sequence) async for feedback in one] == []


@pytest.mark.parametrize("kind", ["sync", "async"])
async def test_a_feedback_callback_gets_messages_as_in_rclpy(ends: Ends, kind: str) -> None:
    """The feedback is the field `feedback`; the goal's id is there, too."""
    heard = asyncio.Queue[Any]()

    async def later(message: Any) -> None:
        heard.put_nowait(message)

    async def execute(goal: Goal) -> Fibonacci.Result:
        goal.publish_feedback(Fibonacci.Feedback(sequence=[1]))
        await ends.worker.may_end.wait()
        goal.succeed()
        return Fibonacci.Result()

    ends.server.register_execute_callback(execute)
    calling = beside(
        ends.client.call(
            Fibonacci.Goal(), feedback_callback=heard.put_nowait if kind == "sync" else later
        )
    )
    message = await heard.get()
    ends.worker.may_end.set()
    await calling

    assert list(message.feedback.sequence) == [1]
    assert len(message.goal_id.uuid) == 16


async def test_a_goal_with_a_feedback_callback_cannot_be_iterated_over(ends: Ends) -> None:
    """The iteration would never yield anything."""
    sent = await ends.client.send_goal(Fibonacci.Goal(), lambda _message: None)

    with pytest.raises(RuntimeError, match="its feedback_callback gets the feedback"):
        aiter(sent)


# Other ends


async def test_a_rejected_goal_raises(ends: Ends) -> None:
    """The error names action and goal."""
    ends.server.register_goal_callback(lambda _goal: GoalResponse.REJECT)

    with pytest.raises(
        GoalRejectedError,
        match=r"/fibonacci: goal [0-9a-f]{32} was rejected .*; ROS sends no reason",
    ):
        await ends.client.send_goal(Fibonacci.Goal())
    with pytest.raises(GoalRejectedError):
        await ends.client.call(Fibonacci.Goal())
    assert "goals=0>" in repr(ends.client)


async def test_a_rejected_goal_carries_its_reason(
    ends: Ends, caplog: pytest.LogCaptureFixture
) -> None:
    """The caller can react, and people also find the reason in the server's log."""

    def judge(_goal: Fibonacci.Goal) -> GoalResponse:
        raise GoalRejected("too far: 12 m of at most 5")

    ends.server.register_goal_callback(judge)

    with (
        caplog.at_level(logging.INFO),
        pytest.raises(GoalRejectedError, match=r"was rejected: too far: 12 m of") as error,
    ):
        await ends.client.call(Fibonacci.Goal())
    assert error.value.reason == "too far: 12 m of at most 5"
    assert "goal_callback rejected a goal: too far: 12 m of at most 5" in caplog.text
    handle = await ends.client.send_goal_async(Fibonacci.Goal())
    assert (handle.accepted, handle.reason) == (False, "too far: 12 m of at most 5")
    assert "goals=0>" in repr(ends.client)


async def test_a_goal_callback_that_awaits_rejects_with_a_reason_too(ends: Ends) -> None:
    """Neither its error count nor the node takes that for a failure."""

    async def judge(_goal: Fibonacci.Goal) -> GoalResponse:
        await settle()
        raise GoalRejected("the battery is low")

    ends.server.register_goal_callback(judge)

    with pytest.raises(GoalRejectedError, match="the battery is low"):
        await ends.client.send_goal(Fibonacci.Goal())
    assert ends.server.stats.errors == 0


def test_the_reason_of_a_rejection_is_bounded_text() -> None:
    """A server keeps the newest hundred."""
    assert len(GoalRejected("x" * 10**6).reason) < 1100
    with pytest.raises(TypeError, match="a str is needed"):
        GoalRejected(5)  # type: ignore[arg-type]


async def test_a_server_logs_rejected_goals_once_a_second(
    ends: Ends, caplog: pytest.LogCaptureFixture
) -> None:
    """People look into the log next, and clients must not fill it."""
    ends.server.register_goal_callback(lambda _goal: GoalResponse.REJECT)

    with caplog.at_level(logging.INFO):
        for _ in range(3):
            with pytest.raises(GoalRejectedError):
                await ends.client.call(Fibonacci.Goal())

    (line,) = [text for text in caplog.messages if "rejected" in text]
    assert line == "action server /fibonacci: goal_callback rejected a goal"


async def test_a_goal_without_a_server_names_the_wait_that_action_clients_have(
    ends: Ends, caplog: pytest.LogCaptureFixture
) -> None:
    """An action client has no `wait_for_service`."""
    client = ends.asking.create_action_client(Fibonacci, "unserved")
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(0.01):
            await client.send_goal(Fibonacci.Goal())

    (line,) = [text for text in caplog.messages if "no server is matched" in text]
    assert "wait_for_server() of an action client" in line


async def test_an_id_of_the_caller_is_used_and_rejected_the_second_time(ends: Ends) -> None:
    """The first goal is not disturbed by its double."""
    first = await ends.client.send_goal(Fibonacci.Goal(order=1), goal_uuid=uuid_of(7))

    with pytest.raises(GoalRejectedError, match="00000007 was rejected"):
        await ends.client.send_goal(Fibonacci.Goal(order=2), goal_uuid=uuid_of(7))

    (await ends.worker.begun.get()).publish_feedback(Fibonacci.Feedback(sequence=[1]))
    ends.worker.may_end.set()
    assert [list(feedback.sequence) async for feedback in first] == [[1]]


async def test_an_aborted_goal_tells_why(ends: Ends) -> None:
    """The server's exception reaches the caller, who can act; result() does not raise."""

    async def execute(_goal: Goal) -> Fibonacci.Result:
        raise LookupError("no way to the kitchen")

    ends.server.register_execute_callback(execute)
    sent = await ends.client.send_goal(Fibonacci.Goal())

    outcome = await sent.result()

    assert outcome.status is GoalStatus.ABORTED
    assert outcome.error_text == "LookupError: no way to the kitchen"
    with pytest.raises(
        GoalAbortedError, match="was aborted: LookupError: no way to the kitchen"
    ) as error:
        await ends.client.call(Fibonacci.Goal())
    assert error.value.error_text == outcome.error_text
    assert error.value.result == Fibonacci.Result()


async def test_abort_takes_a_result_and_a_reason(ends: Ends) -> None:
    """A server that gives up properly can report its progress, and the reason."""

    async def execute(goal: Goal) -> None:
        goal.abort(Fibonacci.Result(sequence=[1]), error_text="battery low")

    ends.server.register_execute_callback(execute)

    with pytest.raises(GoalAbortedError, match="was aborted: battery low") as error:
        await ends.client.call(Fibonacci.Goal())
    assert list(error.value.result.sequence) == [1]  # type: ignore[attr-defined]  # a Result


async def test_an_aborted_goal_without_a_reason_has_an_empty_text(ends: Ends) -> None:
    """None is invented."""

    async def execute(goal: Goal) -> Fibonacci.Result:
        goal.abort()
        return Fibonacci.Result()

    ends.server.register_execute_callback(execute)

    assert (await (await ends.client.send_goal(Fibonacci.Goal())).result()).error_text == ""
    with pytest.raises(GoalAbortedError, match="the server gave no reason"):
        await ends.client.call(Fibonacci.Goal())


async def test_a_failing_goal_callback_raises_a_service_error(ends: Ends) -> None:
    """With the type and text of the exception, at once."""

    def fail(_goal: Fibonacci.Goal) -> GoalResponse:
        raise LookupError("no map")

    server = ends.serving.create_action_server(
        Fibonacci, "other", ends.worker, goal_callback=fail, on_error="log"
    )
    client: Client = ends.asking.create_action_client(Fibonacci, "other")
    await client.wait_for_server()

    with pytest.raises(ServiceError, match="LookupError: no map"):
        await client.send_goal(Fibonacci.Goal())
    assert "goals=0>" in repr(client)
    assert "active=0 kept=0 " in repr(server)


@pytest.mark.parametrize(
    ("wrong", "error"),
    [(String(), TypeError), (Fibonacci.Goal(order=2**40), MessageError)],
)
async def test_a_wrong_goal_is_refused_where_it_is_sent(
    ends: Ends, wrong: Any, error: type[Exception]
) -> None:
    """Nothing is sent."""
    with pytest.raises(error):
        await ends.client.send_goal(wrong)
    assert "goals=0>" in repr(ends.client)


# Cancelling


async def test_cancel_returns_the_answer_of_the_server(ends: Ends) -> None:
    """The goal has not ended yet; the result tells how it did."""
    sent, _ = await begin(ends)

    response = await sent.cancel()

    assert response.return_code == response.ERROR_NONE
    assert [bytes(each.goal_id.uuid) for each in response.goals_canceling] == [
        bytes(sent.goal_id.uuid)
    ]
    assert (await sent.result()).status is GoalStatus.CANCELED


async def test_a_refused_cancel_request_says_so(ends: Ends) -> None:
    """The goal continues."""
    ends.server.register_cancel_callback(None)
    sent, goal = await begin(ends)

    response = await sent.cancel()

    assert response.return_code == response.ERROR_REJECTED
    assert goal.status is GoalStatus.EXECUTING


async def test_a_goal_that_has_ended_cannot_be_cancelled(ends: Ends) -> None:
    """The code says that it was too late."""
    ends.worker.may_end.set()
    sent, _ = await begin(ends)
    await sent.result()

    assert (await sent.cancel()).return_code == 3


async def test_a_goal_that_another_client_cancelled_raises_in_call(ends: Ends) -> None:
    """call() can report it in no other way; the error has the partial result."""
    other = PlainClient(ends.asking)
    calling = beside(ends.client.call(Fibonacci.Goal()))
    await ends.worker.begun.get()

    assert (await other.cancel(0))[0] == 0

    with pytest.raises(GoalCanceledError, match="was canceled") as error:
        await calling
    assert error.value.result == Fibonacci.Result()


async def wait_by_result(ends: Ends) -> None:
    """Await the result."""
    await (await ends.client.send_goal(Fibonacci.Goal())).result()


async def wait_by_call(ends: Ends) -> None:
    """Await the whole."""
    await ends.client.call(Fibonacci.Goal())


async def wait_by_feedback(ends: Ends) -> None:
    """Await feedback that never comes."""
    async for _ in await ends.client.send_goal(Fibonacci.Goal()):
        pass


@pytest.mark.parametrize("wait", [wait_by_result, wait_by_call, wait_by_feedback])
async def test_cancelling_an_awaiter_cancels_the_goal(ends: Ends, wait: Any) -> None:
    """A robot does not drive on because its program was stopped; one request is enough."""
    waiting = beside(wait(ends))
    goal = await ends.worker.begun.get()

    await cancelled(waiting)

    await end_of(goal)
    assert ends.requests == [goal]
    assert goal.status is GoalStatus.CANCELED


async def test_a_timeout_cancels_the_goal(ends: Ends) -> None:
    """The limits of asyncio work as for anything that is awaited."""
    sent, goal = await begin(ends)

    with pytest.raises(TimeoutError):
        async with asyncio.timeout(0.01):
            await sent.result()

    await end_of(goal)
    assert ends.requests == [goal]


async def test_several_awaiters_of_a_goal_send_one_request(ends: Ends) -> None:
    """A second request would be answered with an error."""
    sent, goal = await begin(ends)
    waiting = [beside(sent.result()) for _ in range(3)]
    await checkpoint()  # lets them begin
    for each in waiting:
        each.cancel()
    await asyncio.wait(waiting)

    assert all(each.cancelled() for each in waiting)
    await end_of(goal)
    assert ends.requests == [goal]


async def test_cancelling_a_shielded_wait_leaves_the_goal_alone(ends: Ends) -> None:
    """For observers of a goal that must not influence it."""
    sent, goal = await begin(ends)
    result = beside(sent.result())
    waiting = beside(asyncio.wait_for(asyncio.shield(result), 10))
    await checkpoint()  # lets it begin

    await cancelled(waiting)
    ends.worker.may_end.set()

    assert (await result).status is GoalStatus.SUCCEEDED
    assert ends.requests == []
    assert goal.status is GoalStatus.SUCCEEDED


async def test_a_goal_is_cancelled_also_when_the_node_ends_next(ends: Ends) -> None:
    """Ctrl-C in a program: its main task is cancelled, and leaves the node at once."""

    async def program() -> None:
        async with Node("program", context=ends.asking.context) as node:
            client = node.create_action_client(Fibonacci, "fibonacci")
            await client.wait_for_server()
            await client.call(Fibonacci.Goal())

    running = beside(program())
    goal = await ends.worker.begun.get()

    await cancelled(running)

    assert ends.requests == [goal]


async def test_cancelling_after_the_end_sends_nothing(ends: Ends) -> None:
    """There is nothing to cancel."""
    ends.worker.may_end.set()
    sent, _ = await begin(ends)
    await sent.result()

    async def look_again() -> None:
        await sent.result()
        await asyncio.Event().wait()

    await cancelled(beside(look_again()))

    assert ends.requests == []


async def test_a_server_that_keeps_silent_does_not_keep_a_cancelled_task(ends: Ends) -> None:
    """A cancelled task must end at once, independent of the request."""
    never = asyncio.Event()

    async def decide(_goal: Goal) -> CancelResponse:
        asked.set()
        await never.wait()
        return CancelResponse.REJECT

    asked = asyncio.Event()
    ends.server.register_cancel_callback(decide)
    sent, _ = await begin(ends)
    waiting = beside(sent.result())
    await checkpoint()  # lets it begin

    await cancelled(waiting)

    await asked.wait()


# Servers that come and go


async def test_a_server_is_ready_with_all_its_parts(ends: Ends) -> None:
    """Half a server answers half of the calls."""
    client: Client = ends.asking.create_action_client(Fibonacci, "partial")
    impl = Fibonacci.Impl

    def never(_request: Any) -> Any:
        raise NotImplementedError

    for srv_type, name in (
        (impl.SendGoalService, "send_goal"),
        (impl.CancelGoalService, "cancel_goal"),
        (impl.GetResultService, "get_result"),
    ):
        ends.serving.create_service(srv_type, f"partial/_action/{name}", never)
    ends.serving.create_publisher(impl.FeedbackMessage, "partial/_action/feedback", 10)
    await ends.asking.graph.until(
        lambda: ends.asking.count_publishers("/partial/_action/feedback") > 0
    )

    assert not client.server_is_ready()
    assert not await client.wait_for_server(timeout_sec=0.01)

    ends.serving.create_publisher(
        impl.GoalStatusMessage, "partial/_action/status", qos_profile_action_status_default
    )
    assert await client.wait_for_server(timeout_sec=10)


async def test_a_destroyed_server_loses_its_goals_at_once(ends: Ends) -> None:
    """A clear error for everyone who waits, in every way."""
    sent, _ = await begin(ends)
    calling = beside(ends.client.call(Fibonacci.Goal()))
    await ends.worker.begun.get()
    iterating = beside(anext(sent))
    await checkpoint()  # lets them begin

    ends.server.destroy()

    for waiting in (sent.result(), calling, iterating):
        with pytest.raises(GoalLostError, match="the server went away before it ended"):
            await waiting
    assert "goals=0>" in repr(ends.client)


async def test_a_stopping_node_loses_its_goals_at_once(ends: Ends) -> None:
    """The same as when only the server is destroyed."""
    sent, _ = await begin(ends)

    ends.serving.destroy_node()

    with pytest.raises(GoalLostError):
        await sent.result()


async def test_a_new_server_does_not_know_the_goals_of_the_old_one(ends: Ends) -> None:
    """A restarted server does not take goals over."""
    sent, _ = await begin(ends)
    ends.server.destroy()
    with pytest.raises(GoalLostError):
        await sent.result()
    await gone(ends)
    ends.serving.create_action_server(Fibonacci, "fibonacci", ends.worker)
    await ends.client.wait_for_server()

    assert (await sent.cancel()).return_code == 2
    ends.worker.may_end.set()
    assert list((await ends.client.call(Fibonacci.Goal(order=1))).sequence) == [0, 1]


async def test_a_forgotten_goal_is_unknown(ends: Ends) -> None:
    """Without time to keep it, a result can be gone before its request; that is not an error."""
    server = ends.serving.create_action_server(Fibonacci, "other", ends.worker)
    client: Client = ends.asking.create_action_client(Fibonacci, "other")
    await client.wait_for_server()
    client._result_request = lambda _: Client._result_request(client, uuid_of(404))  # type: ignore[assignment,method-assign]  # asks for a goal that was forgotten

    sent = await client.send_goal(Fibonacci.Goal())

    assert (await sent.result()).status is GoalStatus.UNKNOWN
    with pytest.raises(GoalLostError, match="does not know it any more"):
        await client.call(Fibonacci.Goal())
    server.destroy()


async def test_no_task_waits_for_the_result_of_a_goal(ends: Ends) -> None:
    """A client that sends many goals has one task for all of them."""
    sent = [(await begin(ends))[0] for _ in range(3)]
    await settle()

    names = [getattr(task.get_coro(), "__qualname__", "") for task in asyncio.all_tasks()]

    assert not any(each.done for each in sent)
    assert [name for name in names if name.startswith("ActionClient.")] == ["ActionClient._run"]


# The client's own end


async def test_a_destroyed_client_ends_its_waits_and_what_they_wait_for(ends: Ends) -> None:
    """Nothing of the client is left, and goals that tasks awaited are cancelled."""
    sent, goal = await begin(ends)
    call = ends.client.call(Fibonacci.Goal())
    waiting = [beside(each) for each in (sent.result(), anext(sent), call)]
    called = await ends.worker.begun.get()
    other: Client = ends.asking.create_action_client(Fibonacci, "unserved")
    waiting.append(beside(other.wait_for_server()))
    await checkpoint()  # lets them begin
    before = endpoint_count(ends.asking)

    ends.client.destroy()
    ends.client.destroy()
    other.destroy()

    for each in waiting:
        with pytest.raises(EntityDestroyedError):
            await each
    await end_of(goal)
    await end_of(called)
    await ends.asking.graph.until(lambda: endpoint_count(ends.asking) == before - 10)
    assert ends.requests == [goal, called]
    with pytest.raises(EntityDestroyedError):
        await ends.client.send_goal(Fibonacci.Goal())
    with pytest.raises(EntityDestroyedError):
        await ends.client.wait_for_server()


async def test_a_goal_that_no_task_awaits_outlives_its_client(ends: Ends) -> None:
    """It was left to run on purpose."""
    sent, goal = await begin(ends)

    ends.client.destroy()
    await gone_from(ends.serving)
    ends.worker.may_end.set()

    assert await end_of(goal) is GoalStatus.SUCCEEDED
    assert ends.requests == []
    with pytest.raises(EntityDestroyedError):
        await sent.result()


async def gone_from(serving: Node) -> None:
    """Wait until the server's side no longer knows a client."""
    while serving.count_clients("/fibonacci/_action/cancel_goal"):
        await serving.graph.changed()


async def test_a_stopping_node_cancels_the_goals_that_it_awaits(ends: Ends) -> None:
    """Ctrl-C in a program whose callback awaits a goal: the robot stops, too."""
    node = Node("program", context=ends.asking.context)

    async def drive() -> None:
        client: Client = node.create_action_client(Fibonacci, "fibonacci")
        await client.wait_for_server()
        await client.call(Fibonacci.Goal())

    node.create_timer(0.0, drive)
    running = beside(node.run())
    goal = await ends.worker.begun.get()

    node.destroy_node()
    await running

    assert await end_of(goal) is GoalStatus.CANCELED
    assert ends.requests == [goal]


def print_nothing() -> None:
    """Take no argument."""


async def test_a_feedback_callback_is_looked_at_when_the_goal_is_sent(ends: Ends) -> None:
    """The mistake is reported where it was made."""
    with pytest.raises(CallbackSignatureError, match="must take"):
        await ends.client.send_goal(Fibonacci.Goal(), print_nothing)  # type: ignore[arg-type]  # the mistake


async def test_something_else_than_an_action_is_refused(ends: Ends) -> None:
    """The text shows what fits."""
    with pytest.raises(TypeError, match="not an action class"):
        ends.asking.create_action_client(String, "fibonacci")  # type: ignore[arg-type]  # the mistake


async def test_texts_say_what_they_are_about(ends: Ends) -> None:
    """Each is one line, for logs and debuggers."""
    sent, goal = await begin(ends)

    assert repr(ends.client) == (
        "<ActionClient /fibonacci example_interfaces/action/Fibonacci goals=1>"
    )
    assert repr(ends.server) == (
        "<ActionServer /fibonacci example_interfaces/action/Fibonacci "
        "active=1 kept=0 received=1 errors=0>"
    )
    assert repr(goal) == f"<ServerGoalHandle /fibonacci {sent.text} EXECUTING>"
    assert repr(sent).startswith(f"<ClientGoalHandle /fibonacci {sent.text} ")


async def test_a_client_that_cannot_be_made_leaves_nothing(ends: Ends) -> None:
    """Its parts are created one after another, and the last may be refused."""
    before = endpoint_count(ends.asking)

    with pytest.raises(TypeError):
        ActionClient(ends.asking, Fibonacci, "other", status_sub_qos_profile="no profile")  # type: ignore[arg-type]  # the mistake

    assert endpoint_count(ends.asking) == before


async def halves(ends: Ends, *names: str) -> tuple[Client, dict[str, Any]]:
    """Return a client, and a server of only these services, which accepts every goal."""
    impl = Fibonacci.Impl

    def accept(_request: Any) -> Any:
        return impl.SendGoalService.Response(accepted=True)

    def fail(_request: Any) -> Any:
        raise LookupError("out of memory")

    offers: dict[str, tuple[Any, Any]] = {
        "send_goal": (impl.SendGoalService, accept),
        "get_result": (impl.GetResultService, fail),
    }
    services = {
        name: ends.serving.create_service(
            offers[name][0], f"half/_action/{name}", offers[name][1], on_error="log"
        )
        for name in names
    }
    client: Client = ends.asking.create_action_client(Fibonacci, "half")
    await ends.asking.graph.until(lambda: ends.asking.count_services("/half/_action/send_goal") > 0)
    return client, services


async def test_a_server_that_cannot_tell_a_result_loses_the_goal(ends: Ends) -> None:
    """The error holds what the server said."""
    client, _ = await halves(ends, "send_goal", "get_result")

    sent = await client.send_goal(Fibonacci.Goal())

    with pytest.raises(GoalLostError, match=r"could not tell its result.*out of memory"):
        await sent.result()


async def test_a_server_that_goes_before_it_was_found_whole_loses_the_goal(ends: Ends) -> None:
    """The client waits for the other half as long as there is the first."""
    client, services = await halves(ends, "send_goal")
    sent = await client.send_goal(Fibonacci.Goal())
    waiting = beside(sent.result())
    await checkpoint()  # lets it begin
    assert not waiting.done()

    services["send_goal"].destroy()

    with pytest.raises(GoalLostError, match="the server went away"):
        await waiting


async def test_cancelling_a_goal_whose_server_has_gone_is_an_error_at_once(ends: Ends) -> None:
    """A request without a server would wait forever."""
    sent, _ = await begin(ends)
    ends.server.destroy()
    await gone(ends)

    with pytest.raises(ServiceUnavailableError):
        await sent.cancel()
