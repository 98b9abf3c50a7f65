"""Every kind of callback, and every exception with a special meaning in Python.

`CancelledError` and `StopIteration` end tasks and generators where they are raised on purpose;
raised by a callback they are errors like any other. `KeyboardInterrupt` and `SystemExit` end the
program.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future as ThreadFuture
from typing import Any

import pytest

from aionode.action import ActionClient, ActionServer, GoalStatus
from aionode.endpoints.events import PublisherEventCallbacks
from aionode.errors import ServiceError, TransitionError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import Int32
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.lifecycle import LifecycleNode, TransitionCallbackReturn
from aionode.node import Node
from aionode.testing import local_context, settle

LIMIT_S = 5.0
"""How long something that has to happen may take, in seconds."""


def take_the_result_of_a_cancelled_future() -> None:
    """Raise `CancelledError`, as happens by mistake."""
    future: ThreadFuture[None] = ThreadFuture()
    future.cancel()
    try:
        future.result()
    except BaseException as error:
        raise asyncio.CancelledError from error


def take_from_an_empty_iterator() -> None:
    """Raise `StopIteration`, as happens by mistake."""
    next(iter(()))


MISTAKES = (take_the_result_of_a_cancelled_future, take_from_an_empty_iterator)


class Failing:
    """A callback of one of three kinds that fails at its first call, and counts its calls."""

    def __init__(self, kind: str, mistake: Callable[[], None], result: Any = None) -> None:
        self.kind = kind
        self.calls = 0
        self._mistake = mistake
        self._result = result

    def _called(self, *args: Any) -> Any:
        self.calls += 1
        if self.calls == 1:
            self._mistake()
        return self._result(*args) if callable(self._result) else self._result

    def function(self) -> Callable[..., Any]:
        """Return the callback."""

        def sync(*args: Any) -> Any:
            return self._called(*args)

        async def coroutine(*args: Any) -> Any:
            return self._called(*args)

        return coroutine if self.kind == "async" else sync

    @property
    def options(self) -> dict[str, Any]:
        """The options with which the entity is created."""
        return {"offload": True} if self.kind == "offload" else {}


@pytest.fixture(params=["sync", "async", "offload"])
def kind(request: pytest.FixtureRequest) -> str:
    """How the callback runs."""
    kind: str = request.param
    return kind


@pytest.fixture(params=MISTAKES, ids=["CancelledError", "StopIteration"])
def mistake(request: pytest.FixtureRequest) -> Callable[[], None]:
    """How it fails."""
    mistake: Callable[[], None] = request.param
    return mistake


async def test_a_subscription_goes_on_with_the_next_message(
    node: Node, kind: str, mistake: Callable[[], None]
) -> None:
    """It also takes those queued behind the first one, without `settle` in between."""
    failing = Failing(kind, mistake)
    subscription = node.create_subscription(
        Int32, "numbers", one_argument(failing), 10, on_error="log", **failing.options
    )
    publisher = node.create_publisher(Int32, "numbers", 10)

    for _ in range(2):
        publisher.publish(Int32())
        publisher.publish(Int32())
        await settle()

    assert (failing.calls, subscription.stats.errors) == (4, 1)


async def test_a_timer_goes_on_with_the_next_period(
    node: Node, kind: str, mistake: Callable[[], None], manual_clock: Any
) -> None:
    """A control loop that silently stood still would leave the robot driving."""
    failing = Failing(kind, mistake)
    timer = node.create_timer(1.0, no_argument(failing), on_error="log", **failing.options)
    for _ in range(3):
        await manual_clock.advance(1.0)
        await settle()

    assert (failing.calls, timer.stats.errors) == (3, 1)


async def test_a_service_answers_with_the_error_and_then_the_next_request(
    node: Node, kind: str, mistake: Callable[[], None]
) -> None:
    """Otherwise it would stay in the graph, and answer nobody."""
    failing = Failing(kind, mistake, Trigger.Response(success=True))
    node.create_service(Trigger, "switch", one_argument(failing), **failing.options)
    client = node.create_client(Trigger, "switch")

    async with asyncio.timeout(LIMIT_S):
        with pytest.raises(ServiceError):
            await client.call(Trigger.Request())
        assert (await client.call(Trigger.Request())).success


@pytest.mark.parametrize("place", ["goal_callback", "handle_accepted_callback", "execute_callback"])
async def test_an_action_server_goes_on_with_the_next_goal(
    node: Node, place: str, kind: str, mistake: Callable[[], None]
) -> None:
    """The client of the first goal learns of the failure."""
    if kind == "offload":
        pytest.skip("only execute_callback runs in a thread, as the callback of a service does")
    from aionode.action import GoalResponse

    results = {
        "goal_callback": GoalResponse.ACCEPT,
        "handle_accepted_callback": lambda goal: goal.execute(),
        "execute_callback": lambda goal: goal.succeed() or Fibonacci.Result(),
    }
    failing = Failing(kind, mistake, results[place])
    callbacks = {"execute_callback": results["execute_callback"], place: one_argument(failing)}
    ActionServer(node, Fibonacci, "count", **callbacks)  # type: ignore[arg-type]  # by their names
    client = ActionClient(node, Fibonacci, "count")
    await client.wait_for_server()

    async with asyncio.timeout(LIMIT_S):
        if place == "goal_callback":
            with pytest.raises(ServiceError):
                await client.send_goal(Fibonacci.Goal())
        else:
            first = await client.send_goal(Fibonacci.Goal())
            assert (await first.result()).status is GoalStatus.ABORTED
        second = await client.send_goal(Fibonacci.Goal())
        assert (await second.result()).status is GoalStatus.SUCCEEDED


async def fails(node: Node) -> None:
    """Run a node until it fails."""
    with pytest.raises(ExceptionGroup):
        await asyncio.wait_for(node.run(), LIMIT_S)


async def test_an_event_callback_fails_its_node(node: Node, mistake: Callable[[], None]) -> None:
    """It does so like that of a subscription, and never silently."""
    failing = Failing("sync", mistake)
    own = Node("watcher", context=node.context)
    events = PublisherEventCallbacks(matched=one_argument(failing))
    own.create_publisher(Int32, "numbers", 10, event_callbacks=events)
    node.create_subscription(Int32, "numbers", None, 10)

    await fails(own)

    assert failing.calls == 1


async def test_a_transition_fails(mistake: Callable[[], None]) -> None:
    """The failure is reported, as for any error of ``on_configure``."""

    class Managed(LifecycleNode):
        def on_configure(self, state: Any) -> TransitionCallbackReturn:
            mistake()
            return TransitionCallbackReturn.SUCCESS

    async with local_context() as context, Managed("managed", context=context) as managed:
        with pytest.raises(TransitionError, match="cannot configure"):
            await managed.trigger_configure()


async def test_an_error_function_that_fails_itself_fails_the_node(
    node: Node, mistake: Callable[[], None]
) -> None:
    """Nobody is left who could handle it."""
    own = Node("watcher", context=node.context)

    def on_error(error: Exception, _: object) -> None:
        mistake()

    own.create_subscription(Int32, "numbers", lambda _: 1 / 0, 10, on_error=on_error)
    node.create_publisher(Int32, "numbers", 10).publish(Int32())

    await fails(own)


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("entity", ["subscription", "timer", "service"])
def test_the_end_of_the_program_goes_through(
    entity: str, error: type[BaseException], kind: str
) -> None:
    """Whatever `on_error` says: a callback may end the program like any other code."""

    def end(*_: object) -> None:
        raise error

    failing = Failing(kind, end)

    async def main() -> None:
        async with local_context() as context, Node("node", context=context) as node:
            callback = one_argument(failing)
            if entity == "subscription":
                node.create_subscription(
                    Int32, "n", callback, 10, on_error="log", **failing.options
                )
                node.create_publisher(Int32, "n", 10).publish(Int32())
            elif entity == "timer":
                tick = no_argument(failing)
                node.create_timer(0.0, tick, on_error="log", **failing.options)
            else:
                node.create_service(Trigger, "switch", callback, **failing.options)
                await node.create_client(Trigger, "switch").call(Trigger.Request())
            await asyncio.Event().wait()

    with pytest.raises(error):
        asyncio.run(main())


def one_argument(failing: Failing) -> Callable[[Any], Any]:
    """Return the callback with one parameter."""
    callback = failing.function()

    async def coroutine(item: Any) -> Any:
        return await callback(item)

    def sync(item: Any) -> Any:
        return callback(item)

    return coroutine if failing.kind == "async" else sync


def no_argument(failing: Failing) -> Callable[[], Any]:
    """Return the callback without a parameter."""
    callback = failing.function()

    async def coroutine() -> Any:
        return await callback()

    def sync() -> Any:
        return callback()

    return coroutine if failing.kind == "async" else sync
