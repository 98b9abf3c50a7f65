"""However a client ends, its waits end, and so do the awaited goals."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import suppress
from typing import Any, NamedTuple

import pytest

from aionode._process.concurrency import checkpoint
from aionode.action import ActionClient, ActionServer, CancelResponse, GoalResponse, GoalStatus
from aionode.clock import perf_ns
from aionode.endpoints.actions.client import LAST_FEEDBACK_S
from aionode.engine.context import Context
from aionode.errors import EntityDestroyedError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.node import Node
from tests.support.actions import Worker, end_of
from tests.support.peers import contexts_over, isolated_environment, quiet_node

Client = ActionClient[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]


class Program:
    """A node with a client, run by its own task, and a server for it.

    Attributes:
        outcomes: What the waits raised.
    """

    def __init__(self, node: Node, server: ActionServer[Any, Any, Any], worker: Worker) -> None:
        self.node = node
        self.server = server
        self.worker = worker
        self.client: Client = node.create_action_client(Fibonacci, "fibonacci")
        self.waits = asyncio.Event()
        self.server_may_decide = asyncio.Event()
        self.outcomes = asyncio.Queue[BaseException]()
        self.body_fails = asyncio.Event()
        self.running = beside(self.run())

    async def run(self) -> None:
        """Run the node until it is destroyed, or its body fails."""
        async with self.node, asyncio.TaskGroup() as tasks:
            failing = tasks.create_task(self.fail())
            await self.node.until_destroyed()
            failing.cancel()

    async def fail(self) -> None:
        """Raise when the test says so."""
        await self.body_fails.wait()
        raise ValueError("no map")

    async def record(self, wait: Wait) -> None:
        """Record the exception that `wait` raises."""
        try:
            await wait(self)
        except (asyncio.CancelledError, EntityDestroyedError) as error:
            self.outcomes.put_nowait(error)
            if isinstance(error, asyncio.CancelledError):
                raise


Wait = Callable[[Program], Coroutine[Any, Any, None]]
Way = Callable[[Program], None]


def beside(work: Any) -> asyncio.Task[Any]:
    """Do something beside the test."""
    return asyncio.ensure_future(work)  # noqa: TID251  # owned by the test


class Ends(NamedTuple):
    """A context and a server, which a program needs."""

    context: Context
    server: ActionServer[Any, Any, Any]
    worker: Worker


@pytest.fixture(params=["local", "link", "zenoh"])
async def ends(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Ends]:
    """A server: in the context of the program, or in one that is connected as processes are."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    async with (
        asyncio.timeout(30),
        contexts_over(request.param) as (context, other),
        quiet_node("serving", other) as serving,
    ):
        worker = Worker()
        server: ActionServer[Any, Any, Any] = serving.create_action_server(
            Fibonacci, "fibonacci", worker, cancel_callback=lambda _goal: CancelResponse.ACCEPT
        )
        yield Ends(context, server, worker)


@pytest.fixture
async def program(ends: Ends) -> AsyncIterator[Program]:
    """A program that runs."""
    node = Node(
        "program", context=ends.context, enable_rosout=False, start_parameter_services=False
    )
    program = Program(node, ends.server, ends.worker)
    await program.client.wait_for_server()
    yield program
    program.running.cancel()
    await asyncio.wait([program.running])
    if not program.running.cancelled():
        program.running.exception()


in_process = pytest.mark.parametrize("ends", ["local"], indirect=True)


# What is awaited


async def send_goal(program: Program) -> None:
    """Await the decision of an undecided server."""

    async def decide(_goal: object) -> GoalResponse:
        program.waits.set()
        await program.server_may_decide.wait()
        return GoalResponse.ACCEPT

    program.server.register_goal_callback(decide)
    await program.client.send_goal(Fibonacci.Goal())


async def call(program: Program) -> None:
    """Await the whole."""
    beside(begun(program))
    await program.client.call(Fibonacci.Goal())


async def call_with_feedback(program: Program) -> None:
    """Await the whole, while a function gets the feedback."""
    beside(begun(program))
    await program.client.call(Fibonacci.Goal(), lambda _message: None)


async def begun(program: Program) -> None:
    """Note that the goal is executed."""
    await program.worker.has_begun.wait()
    program.waits.set()


async def result(program: Program) -> None:
    """Await the result."""
    sent = await program.client.send_goal(Fibonacci.Goal())
    program.waits.set()
    await sent.result()


async def feedback(program: Program) -> None:
    """Await feedback that never comes."""
    sent = await program.client.send_goal(Fibonacci.Goal())
    program.waits.set()
    async for _ in sent:
        pass


async def answer(program: Program) -> None:
    """Await the server's answer to a cancel request, which it has not given."""
    sent = await program.client.send_goal(Fibonacci.Goal())

    async def decide(_goal: object) -> CancelResponse:
        program.waits.set()
        await program.server_may_decide.wait()
        return CancelResponse.ACCEPT

    program.server.register_cancel_callback(decide)
    await sent.cancel()


async def block(program: Program) -> None:
    """Await something else in a block that the goal is bound to."""
    async with await program.client.send_goal(Fibonacci.Goal()) as sent:
        program.waits.set()
        await program.node.until_destroyed()
        await gone(program)
        await sent.result()


async def loop_body(program: Program) -> None:
    """Await something else in the body of the loop over the feedback."""
    sent = await program.client.send_goal(Fibonacci.Goal())
    goal = await program.worker.begun.get()
    program.worker.begun.put_nowait(goal)
    goal.publish_feedback(Fibonacci.Feedback())
    async for _ in sent:
        program.waits.set()
        await program.node.until_destroyed()
        await gone(program)


async def gone(program: Program) -> None:
    """Wait until the client is destroyed as well."""
    while not program.client.destroyed:
        await checkpoint()


WAITS: list[Wait] = [send_goal, call, call_with_feedback, result, feedback, answer]


# How the client ends


def a_callback_fails(program: Program) -> None:
    """Raise in a timer."""

    def fail() -> None:
        raise ValueError("no map")

    program.node.create_timer(0.0, fail)


def the_body_fails(program: Program) -> None:
    """Raise in the body of ``async with``."""
    program.body_fails.set()


def the_node_is_destroyed(program: Program) -> None:
    """Call `destroy_node`."""
    program.node.destroy_node()


def the_run_is_cancelled(program: Program) -> None:
    """Cancel the task that runs the node."""
    program.running.cancel()


def the_client_is_destroyed(program: Program) -> None:
    """Destroy only the client."""
    program.client.destroy()


FAILURES: list[Way] = [a_callback_fails, the_body_fails]
WAYS: list[Way] = [
    *FAILURES,
    the_node_is_destroyed,
    the_run_is_cancelled,
    the_client_is_destroyed,
]


async def expect_canceled(program: Program) -> None:
    """Check that the goal ends, if it was started."""
    program.server_may_decide.set()
    with suppress(asyncio.QueueEmpty):
        goal = program.worker.begun.get_nowait()
        assert await end_of(goal) is GoalStatus.CANCELED


@in_process
@pytest.mark.parametrize("leave", WAYS)
@pytest.mark.parametrize("wait", WAITS)
async def test_a_task_of_others_gets_an_error_and_its_goal_is_cancelled(
    program: Program, wait: Wait, leave: Way
) -> None:
    """Nobody has cancelled the task, such as a request of a web server; and the robot must stop."""
    waiting = beside(program.record(wait))
    await program.waits.wait()

    leave(program)
    error = await program.outcomes.get()

    assert isinstance(error, EntityDestroyedError)
    assert error.subject == "action client of /fibonacci"
    assert repr(error.__cause__) == ("ValueError('no map')" if leave in FAILURES else "None")
    await waiting
    await expect_canceled(program)


@pytest.mark.parametrize("wait", [*WAITS, block, loop_body])
async def test_a_goal_that_others_await_ends_when_the_node_fails(
    program: Program, wait: Wait
) -> None:
    """Over every transport; also while its block or loop does something else at the moment."""
    waiting = beside(program.record(wait))
    await program.waits.wait()

    a_callback_fails(program)

    assert isinstance(await program.outcomes.get(), EntityDestroyedError)
    await waiting
    await expect_canceled(program)


@in_process
@pytest.mark.parametrize("leave", WAYS)
@pytest.mark.parametrize("wait", WAITS)
async def test_a_callback_of_the_node_is_cancelled_with_its_goal(
    program: Program, wait: Wait, leave: Way
) -> None:
    """It ends with its node."""
    program.node.create_timer(0.0, lambda: program.record(wait))
    await program.waits.wait()

    leave(program)

    assert isinstance(await program.outcomes.get(), asyncio.CancelledError)
    await expect_canceled(program)


@pytest.mark.parametrize("ends", ["link"], indirect=True)
async def test_the_goals_of_others_end_with_their_context(program: Program) -> None:
    """`Context.shutdown` destroys the nodes."""
    waiting = beside(program.record(result))
    await program.waits.wait()

    program.node.context.shutdown()

    assert isinstance(await program.outcomes.get(), EntityDestroyedError)
    await waiting
    await expect_canceled(program)


@in_process
async def test_a_loop_that_was_left_leaves_its_goal_alone(program: Program) -> None:
    """Nothing depends on the goal after ``break``, so it continues when its client ends."""
    sent = await program.client.send_goal(Fibonacci.Goal())
    goal = await program.worker.begun.get()
    goal.publish_feedback(Fibonacci.Feedback())
    async for _ in sent:
        break

    program.client.destroy()
    program.worker.may_end.set()

    assert await end_of(goal) is GoalStatus.SUCCEEDED


@in_process
async def test_a_node_that_fails_can_still_await_a_goal_in_finally(program: Program) -> None:
    """A goal to return home is one; as in a destroyed node, results arrive until callbacks end."""
    results = asyncio.Queue[Any]()
    begun = asyncio.Event()

    async def drive() -> None:
        try:
            begun.set()
            await asyncio.Event().wait()
        finally:
            results.put_nowait(await program.client.call(Fibonacci.Goal(order=2)))

    program.node.create_timer(0.0, drive)
    await begun.wait()
    program.worker.may_end.set()

    a_callback_fails(program)

    assert list((await results.get()).sequence) == [0, 1, 2]


@pytest.mark.parametrize("ends", ["link"], indirect=True)
async def test_a_client_may_end_when_its_wait_for_late_feedback_does(program: Program) -> None:
    """In one iteration of the loop, after a result from another process."""
    errors: list[dict[str, Any]] = []
    asyncio.get_running_loop().set_exception_handler(lambda _loop, error: errors.append(error))
    program.worker.may_end.set()
    for turns in range(4):  # one of them is the number in which its tasks are cancelled
        client: Client = program.node.create_action_client(Fibonacci, "fibonacci")
        await client.wait_for_server()
        await client.call(Fibonacci.Goal())
        for _ in range(3):  # by then it waits for feedback
            await checkpoint()

        client.destroy()
        for _ in range(turns):
            await checkpoint()
        over_ns = perf_ns() + round(1e9 * LAST_FEEDBACK_S)
        while perf_ns() < over_ns:  # nothing else runs
            pass
        for _ in range(4):
            await checkpoint()

    assert errors == []
