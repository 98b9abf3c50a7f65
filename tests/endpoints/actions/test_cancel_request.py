"""If the task that awaits a goal is cancelled, the goal is cancelled, however that happens."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import suppress
from typing import Any, NamedTuple

import anyio
import pytest
from starlette.responses import StreamingResponse

from aionode._process.concurrency import checkpoint
from aionode.action import ActionClient, ActionServer, CancelResponse, GoalResponse, GoalStatus
from aionode.endpoints.actions._cancel_request import CancelRequest
from aionode.endpoints.client import Exchange
from aionode.engine.context import Context
from aionode.engine.rules.early_cancels import EarlyCancels
from aionode.engine.transport.local import LocalTransport
from aionode.errors import ServiceUnavailableError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.node import Node
from aionode.qos import qos_profile_action_status_default
from aionode.testing import FaultyTransport, settle
from tests.support.actions import Goal, Worker, end_of
from tests.support.living import living
from tests.support.peers import contexts_over, isolated_environment, quiet_node
from tests.support.spies import returns_of
from tests.support.waiting import waited_s

Client = ActionClient[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
Server = ActionServer[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]


class Ends(NamedTuple):
    """A server and a client that are matched."""

    serving: Node
    asking: Node
    server: Server
    client: Client
    worker: Worker


@pytest.fixture(params=["local", "link", "zenoh"])
async def ends(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Ends]:
    """Two nodes: in one context, or in two that are connected like two processes."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    async with (
        asyncio.timeout(30),
        contexts_over(request.param) as (first, second),
        quiet_node("serving", first) as serving,
        quiet_node("asking", second) as asking,
    ):
        worker = Worker()
        server: Server = serving.create_action_server(
            Fibonacci, "fibonacci", worker, cancel_callback=lambda _goal: CancelResponse.ACCEPT
        )
        client: Client = asking.create_action_client(Fibonacci, "fibonacci")
        await client.wait_for_server()
        yield Ends(serving, asking, server, client, worker)


def beside(work: Any) -> asyncio.Task[Any]:
    """Do something beside the test."""
    return asyncio.ensure_future(work)  # noqa: TID251  # owned by the test


async def expect_canceled(goal: Goal) -> None:
    """Wait for the end of the goal, and check that a request has ended it."""
    assert await end_of(goal) is GoalStatus.CANCELED


# What a program waits for


async def by_call(client: Client) -> None:
    """Await the whole."""
    await client.call(Fibonacci.Goal())


async def by_result(client: Client) -> None:
    """Await the result."""
    await (await client.send_goal(Fibonacci.Goal())).result()


async def by_feedback(client: Client) -> None:
    """Await feedback that never comes."""
    async for _ in await client.send_goal(Fibonacci.Goal()):
        pass


async def by_block(client: Client) -> None:
    """Await something else while the goal is bound to a block."""
    async with await client.send_goal(Fibonacci.Goal()):
        await asyncio.Event().wait()


# How it is cancelled

Wait = Callable[[Client], Coroutine[Any, Any, None]]


async def when_begun(ends: Ends, call: Callable[[], object]) -> None:
    """Call `call` as soon as the goal is running: how long that takes depends on the machine."""
    await ends.worker.has_begun.wait()
    call()


async def after_timeout(wait: Wait, ends: Ends) -> None:
    """With asyncio's timeout."""
    now_s = asyncio.get_running_loop().time()
    with suppress(TimeoutError):
        async with asyncio.timeout(None) as limit:
            ending = beside(when_begun(ends, lambda: limit.reschedule(now_s)))
            await wait(ends.client)
    await ending


async def after_move_on(wait: Wait, ends: Ends) -> None:
    """With anyio's, which cancels repeatedly until its block is left."""
    now_s = anyio.current_time()
    with anyio.CancelScope() as scope:
        ending = beside(when_begun(ends, lambda: setattr(scope, "deadline", now_s)))
        await wait(ends.client)
    await ending


async def by_a_task_group(wait: Wait, ends: Ends) -> None:
    """Frameworks built on anyio do so, such as those for tools of language models."""
    async with anyio.create_task_group() as tasks:
        tasks.start_soon(wait, ends.client)
        await ends.worker.has_begun.wait()
        tasks.cancel_scope.cancel()


async def cancelled_twice(wait: Wait, ends: Ends) -> None:
    """Twice in a row, as with two Ctrl-C."""
    task = beside(wait(ends.client))
    await ends.worker.has_begun.wait()
    task.cancel()
    await checkpoint()  # between the two
    task.cancel()
    await asyncio.wait([task])


async def by_leaving_the_node(wait: Wait, ends: Ends) -> None:
    """Ctrl-C in a program: its task is cancelled, twice, and leaves the node at once."""

    async def program() -> None:
        async with Node("program", context=ends.asking.context) as node:
            client: Client = node.create_action_client(Fibonacci, "fibonacci")
            await client.wait_for_server()
            await wait(client)

    task = beside(program())
    await ends.worker.has_begun.wait()
    task.cancel()
    await checkpoint()  # between the two
    task.cancel()
    await asyncio.wait([task])


WAITS = [by_call, by_result, by_feedback, by_block]
CANCELS = [
    after_timeout,
    after_move_on,
    by_a_task_group,
    cancelled_twice,
    by_leaving_the_node,
]


@pytest.mark.parametrize("cancel", CANCELS)
@pytest.mark.parametrize("wait", WAITS)
async def test_a_goal_ends_however_its_task_is_cancelled(
    ends: Ends, wait: Wait, cancel: Callable[[Wait, Ends], Coroutine[Any, Any, None]]
) -> None:
    """A robot must not drive on when the program that sent it has given up."""
    await cancel(wait, ends)

    await expect_canceled(await ends.worker.begun.get())


async def leave(body: AsyncIterator[str], begun: asyncio.Event) -> None:
    """Stream `body` to a browser that leaves after `begun`."""

    async def receive() -> dict[str, Any]:
        await begun.wait()
        return {"type": "http.disconnect"}

    async def send(message: Any) -> None:
        if message.get("body") == b"stuck":
            begun.set()
            await asyncio.Event().wait()

    scope = {"type": "http", "asgi": {"spec_version": "2.3"}}
    await StreamingResponse(body)(scope, receive, send)


async def test_a_browser_that_leaves_a_stream_of_feedback_ends_the_goal(ends: Ends) -> None:
    """Starlette cancels the stream while it waits for feedback."""
    begun = asyncio.Event()

    async def stream() -> AsyncIterator[str]:
        yield "begin"
        goal = await ends.client.send_goal(Fibonacci.Goal())
        begun.set()
        async for feedback in goal:
            yield str(feedback)

    await leave(stream(), begun)

    await expect_canceled(await ends.worker.begun.get())


async def test_a_browser_that_leaves_while_it_reads_ends_a_goal_in_a_block(ends: Ends) -> None:
    """Then no task awaits the goal: the stream is closed where it yields.

    Python's garbage collector closes it, since Starlette leaves a cancelled stream to that.
    """

    async def stream() -> AsyncIterator[str]:
        async with await ends.client.send_goal(Fibonacci.Goal()) as goal:
            yield "stuck"
            async for feedback in goal:
                yield str(feedback)

    await leave(stream(), asyncio.Event())
    gc.collect()

    await expect_canceled(await ends.worker.begun.get())


async def test_a_block_leaves_a_goal_alone_that_has_ended(ends: Ends) -> None:
    """Nothing is left to cancel."""
    requests = living(CancelRequest)
    ends.worker.may_end.set()
    async with await ends.client.send_goal(Fibonacci.Goal()) as goal:
        outcome = await goal.result()

    assert outcome.status is GoalStatus.SUCCEEDED
    assert living(CancelRequest) <= requests


async def test_a_request_goes_on_when_the_awaiter_of_its_answer_is_cancelled(ends: Ends) -> None:
    """In ``finally``, under a limit that has passed, nothing can be awaited."""
    sent = await ends.client.send_goal(Fibonacci.Goal())
    goal = await ends.worker.begun.get()

    with anyio.CancelScope() as scope:
        scope.cancel()
        await sent.cancel()

    await expect_canceled(goal)


# Before the goal is accepted


class Doorkeeper:
    """A `goal_callback` that accepts when the test says so."""

    def __init__(self) -> None:
        self.asked = asyncio.Queue[int]()
        self.may_answer = asyncio.Event()

    async def __call__(self, goal: Fibonacci.Goal) -> GoalResponse:
        """Accept, later."""
        self.asked.put_nowait(goal.order)
        await self.may_answer.wait()
        return GoalResponse.ACCEPT


async def test_a_goal_that_is_cancelled_before_the_server_decides_is_never_executed(
    ends: Ends, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The server rejects it, because its client has given up."""
    requests = living(CancelRequest)
    noted = returns_of(monkeypatch, EarlyCancels, "note")
    answered = returns_of(monkeypatch, ends.client, "_on_cancel_answered")
    door = Doorkeeper()
    ends.server.register_goal_callback(door)
    with anyio.move_on_after(5) as scope:
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(ends.client.call, Fibonacci.Goal())
            await door.asked.get()
            scope.cancel()
    await noted.get()
    door.may_answer.set()

    await answered.get()
    assert living(CancelRequest) <= requests
    assert ends.worker.begun.empty()
    assert "active=0 kept=0 " in repr(ends.server)


async def test_a_goal_that_is_cancelled_in_the_queue_of_the_server_is_never_executed(
    ends: Ends, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is queued behind another goal that the server is still deciding on."""
    requests = living(CancelRequest)
    noted = returns_of(monkeypatch, EarlyCancels, "note")
    answered = returns_of(monkeypatch, ends.client, "_on_cancel_answered")
    door = Doorkeeper()
    ends.server.register_goal_callback(door)
    first = beside(ends.client.send_goal(Fibonacci.Goal(order=1)))
    await door.asked.get()
    second = beside(ends.client.send_goal(Fibonacci.Goal(order=2)))
    await checkpoint()  # lets it be sent
    second.cancel()
    await asyncio.wait([second])
    await noted.get()
    door.may_answer.set()

    await first
    await answered.get()
    assert living(CancelRequest) <= requests
    assert (await ends.worker.begun.get()).request.order == 1
    assert ends.worker.begun.empty()
    assert door.asked.empty()


async def test_a_goal_that_another_server_accepts_after_its_cancellation_is_cancelled(
    ends: Ends, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A server other than aionode's says that it does not know the goal, and accepts it later."""
    monkeypatch.setattr(EarlyCancels, "note", lambda *_: None)
    accepted = returns_of(monkeypatch, ends.server, "_accept")
    door = Doorkeeper()
    ends.server.register_goal_callback(door)
    task = beside(ends.client.call(Fibonacci.Goal()))
    await door.asked.get()
    task.cancel()
    await asyncio.wait([task])
    door.may_answer.set()

    await expect_canceled(await accepted.get())


async def test_a_goal_without_a_server_leaves_nothing_behind(ends: Ends) -> None:
    """It was sent to no server, so there is nothing to cancel."""
    requests = living(CancelRequest)
    client: Client = ends.asking.create_action_client(Fibonacci, "unserved")
    exchanges = living(Exchange)
    for _ in range(20):
        with anyio.move_on_after(0.001):
            await client.call(Fibonacci.Goal())

    assert living(CancelRequest) <= requests
    assert living(Exchange) <= exchanges + 1  # the traceback of the last call may have its own


# Lost requests


@pytest.fixture
async def faults() -> AsyncIterator[tuple[FaultyTransport, Ends]]:
    """Two nodes whose requests can be dropped on the way."""
    transport = FaultyTransport(LocalTransport())
    async with (
        asyncio.timeout(30),
        Context(transport=transport) as context,
        Node("serving", context=context) as serving,
        Node("asking", context=context) as asking,
    ):
        worker = Worker()
        server: Server = serving.create_action_server(
            Fibonacci, "fibonacci", worker, cancel_callback=lambda _goal: CancelResponse.ACCEPT
        )
        client: Client = asking.create_action_client(Fibonacci, "fibonacci")
        yield transport, Ends(serving, asking, server, client, worker)


async def test_a_lost_request_is_sent_again(faults: tuple[FaultyTransport, Ends]) -> None:
    """It is sent until the server has answered."""
    transport, ends = faults
    task = beside(ends.client.call(Fibonacci.Goal()))
    goal = await ends.worker.begun.get()
    await settle()

    transport.drop = 1.0
    task.cancel()
    await asyncio.wait([task])
    await settle()
    assert goal.status is GoalStatus.EXECUTING
    transport.drop = 0.0

    await expect_canceled(goal)


async def test_a_node_does_not_end_before_a_lost_request_was_sent_again(
    faults: tuple[FaultyTransport, Ends],
) -> None:
    """Goals cancelled last are cancelled, too."""
    transport, ends = faults

    async def program() -> None:
        async with Node("program", context=ends.asking.context) as node:
            await node.create_action_client(Fibonacci, "fibonacci").call(Fibonacci.Goal())

    task = beside(program())
    goal = await ends.worker.begun.get()
    await settle()
    transport.drop = 1.0
    task.cancel()
    await ends.asking.graph.until(
        lambda: ends.asking.count_clients("/fibonacci/_action/get_result") == 1
    )
    transport.drop = 0.0
    await asyncio.wait([task])

    await expect_canceled(goal)


async def test_a_server_that_has_gone_does_not_hold_up_the_end_of_a_node(ends: Ends) -> None:
    """It cannot answer, and there is nothing to stop."""
    async with Node("program", context=ends.asking.context) as node:
        client: Client = node.create_action_client(Fibonacci, "fibonacci")
        await client.wait_for_server()
        sent = await client.send_goal(Fibonacci.Goal())
        await ends.worker.begun.get()
        ends.server.destroy()
        await node.graph.until(lambda: not client.server_is_ready())

        with pytest.raises(ServiceUnavailableError):
            await sent.cancel()
        began_s, waited_before_s = asyncio.get_running_loop().time(), waited_s()

    took_s = asyncio.get_running_loop().time() - began_s
    assert took_s - (waited_s() - waited_before_s) < 0.9


# A server that rejects


async def test_a_goal_that_goes_on_after_it_was_given_up_is_said(
    ends: Ends, caplog: pytest.LogCaptureFixture
) -> None:
    """The request is sent when nobody waits for its answer any more: it is logged once."""
    ends.server.register_cancel_callback(None)  # as in rclpy by default
    with suppress(TimeoutError):
        async with asyncio.timeout(None) as limit:
            begun = beside(when_begun(ends, lambda: limit.reschedule(0.0)))
            await by_result(ends.client)
    await begun
    while not caplog.records:
        await checkpoint()

    assert "fibonacci: goal " in caplog.text
    assert caplog.text.count("cancel was rejected: the goal goes on") == 1
    ends.server.register_cancel_callback(lambda _: CancelResponse.ACCEPT)


async def test_an_answer_without_the_goal_is_a_rejection(context: Context) -> None:
    """A server of rclpy rejects this way, with the code for success."""
    impl = Fibonacci.Impl
    async with quiet_node("serving", context) as node, quiet_node("asking", context) as asking:
        node.create_service(
            impl.SendGoalService,
            "count/_action/send_goal",
            lambda _: impl.SendGoalService.Response(accepted=True),
        )
        node.create_service(
            impl.CancelGoalService,
            "count/_action/cancel_goal",
            lambda _: impl.CancelGoalService.Response(),
        )
        waiting = asyncio.Event()

        async def wait(_: Any) -> Any:
            await waiting.wait()
            return impl.GetResultService.Response()

        node.create_service(impl.GetResultService, "count/_action/get_result", wait)
        node.create_publisher(impl.FeedbackMessage, "count/_action/feedback", 1)
        status_qos = qos_profile_action_status_default
        node.create_publisher(impl.GoalStatusMessage, "count/_action/status", status_qos)
        client = asking.create_action_client(Fibonacci, "count")
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal())

        assert (await goal.cancel()).return_code == 1
        waiting.set()
