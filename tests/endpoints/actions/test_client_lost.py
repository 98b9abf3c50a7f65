"""``on_client_lost``: a robot must not drive on when the owner of its goal is lost."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from contextlib import AsyncExitStack, suppress
from typing import Any

import pytest

from aionode.action import (
    ActionClient,
    ActionServer,
    GoalResponse,
    GoalStatus,
    ServerGoalHandle,
)
from aionode.clock import Alarm
from aionode.endpoints.actions._client_watch import ClientWatch
from aionode.endpoints.actions._life_signs import LifeSigns
from aionode.engine.context import Context
from aionode.errors import GoalCanceledError, ServiceError, ServiceUnavailableError
from aionode.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.node import Node
from aionode.qos import QoSProfile
from aionode.testing import ManualClock, local_context, settle
from tests.support.actions import Goal, PlainClient, Worker, end_of, result_client
from tests.support.peers import isolated_environment

Client = ActionClient[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
Serve = Callable[..., ActionServer[Any, Any, Any]]

LOST_SEC = 3.0


class CountingClock(ManualClock):
    """Counts how often it calls back."""

    wakes = 0

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call `callback` at a time, and count that."""

        def wake() -> None:
            self.wakes += 1
            callback()

        return super().call_at(steady_ns, wake)

    async def wakes_in(self, seconds: float) -> int:
        """Advance by some seconds, and return the number of callbacks meanwhile."""
        before = self.wakes
        await self.advance(seconds)
        return self.wakes - before


@pytest.fixture
def manual_clock() -> CountingClock:
    """The clock of all nodes."""
    return CountingClock()


@pytest.fixture
async def owner(node_factory: Callable[..., Node]) -> Node:
    """The node of a client of plain calls."""
    return node_factory("owner")


@pytest.fixture
def client(owner: Node) -> PlainClient:
    """A client of plain calls, which sends no signs of life by itself."""
    return PlainClient(owner)


@pytest.fixture
def worker() -> Worker:
    """A worker that executes goals until the test lets it end."""
    return Worker()


@pytest.fixture
def serve(node: Node, worker: Worker) -> Serve:
    """Create a server of ``fibonacci`` that refuses to cancel, as only its own decision counts."""

    def make(
        execute: Callable[[Goal], Any] = worker, **options: Any
    ) -> ActionServer[Any, Any, Any]:
        options = {"on_client_lost": "cancel", **options}
        return node.create_action_server(Fibonacci, "fibonacci", execute, **options)

    return make


def expect(goal: Goal, status: GoalStatus) -> None:
    """Compare the state of a goal, which mypy takes for a constant."""
    assert goal.status is status


# Clients that give signs


async def test_a_goal_is_canceled_when_its_client_falls_silent(
    serve: Serve,
    client: PlainClient,
    worker: Worker,
    manual_clock: ManualClock,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Three seconds after the last sign, whatever `cancel_callback` says; this is logged."""
    asked: list[Goal] = []
    serve(cancel_callback=asked.append)
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    await manual_clock.advance(LOST_SEC - 0.001)
    expect(goal, GoalStatus.EXECUTING)
    await manual_clock.advance(0.001)

    assert worker.cancelled == [goal]
    expect(goal, GoalStatus.CANCELED)
    assert asked == []
    (record,) = (each for each in caplog.records if "is lost" in each.getMessage())
    assert record.getMessage() == (
        "action server /fibonacci: its client /owner is lost: no sign of it for 3 s; cancelling "
        f"its goal {goal.text}"
    )


async def test_each_sign_gives_a_client_more_time(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """Two of three signs may be late or lost."""
    serve()
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    for _ in range(10):
        await manual_clock.advance(LOST_SEC - 0.001)
        await client.sign()

    expect(goal, GoalStatus.EXECUTING)


async def test_the_time_can_be_chosen(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """For an arm, half a second may be long."""
    serve(client_lost_sec=0.6)
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    await manual_clock.advance(0.599)
    expect(goal, GoalStatus.EXECUTING)
    await manual_clock.advance(0.001)
    expect(goal, GoalStatus.CANCELED)


async def test_goals_go_on_by_default(
    serve: Serve, client: PlainClient, owner: Node, worker: Worker, manual_clock: ManualClock
) -> None:
    """As in rclpy."""
    serve(on_client_lost="continue")
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    await manual_clock.advance(3600)
    owner.destroy_node()
    await settle()

    expect(goal, GoalStatus.EXECUTING)


async def test_an_offloaded_callback_sees_that_its_client_is_lost(
    serve: Serve, client: PlainClient, manual_clock: ManualClock
) -> None:
    """As after a cancel request that was accepted."""
    running, told = threading.Event(), threading.Event()

    def execute(goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
        running.set()
        while not goal.is_cancel_requested:
            told.wait(0.01)
        goal.canceled()
        return Fibonacci.Result()

    serve(execute, offload=True)
    await client.send()
    await client.sign()
    result = asyncio.ensure_future(client.result())  # noqa: TID251  # owned by the test
    await asyncio.to_thread(running.wait)
    for seconds in (LOST_SEC + 1.0, 2 * LOST_SEC + 1.0):
        manual_clock._move(int(seconds * 1e9))  # `advance` would wait for the thread
        await asyncio.sleep(0.02)  # noqa: TID251

    assert (await result).status == GoalStatus.CANCELED


async def test_a_goal_that_waits_for_its_turn_is_canceled_without_being_executed(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """Being accepted suffices: nobody waits for it any more."""
    server = serve(concurrent=False)
    await client.send(1)
    await client.send(2)
    await client.sign(2)
    await worker.begun.get()

    await manual_clock.advance(LOST_SEC)

    assert (await client.result(2)).status == GoalStatus.CANCELED
    assert server.stats.received == 1


async def test_a_goal_that_was_handed_over_is_canceled_when_it_is_executed(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """As after a cancel request that was accepted."""
    kept: list[Goal] = []
    serve(handle_accepted_callback=kept.append)
    await client.send()
    await client.sign()
    await manual_clock.advance(LOST_SEC)
    assert kept[0].is_cancel_requested

    kept[0].execute()
    await settle()

    assert kept[0].status is GoalStatus.CANCELED


async def test_only_the_goals_of_the_lost_client_end(
    serve: Serve,
    client: PlainClient,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """All of them, with one line in the log."""
    server = serve()
    other = PlainClient(node_factory("other"))
    for number in (1, 2):
        await client.send(number)
        await client.sign(number)
    await other.send(3)
    await other.sign(3)

    await manual_clock.advance(LOST_SEC - 1.0)
    await other.sign(3)
    await manual_clock.advance(1.0)

    statuses = [(await client.result(number)).status for number in (1, 2)]
    assert statuses == [GoalStatus.CANCELED, GoalStatus.CANCELED]
    assert "active=1 kept=2 " in repr(server)
    assert len(caplog.records) == 1
    assert "cancelling its goals 0" in caplog.text


async def test_a_client_that_leaves_its_goal_on_purpose_is_not_lost(
    serve: Serve, client: PlainClient, owner: Node, worker: Worker, manual_clock: ManualClock
) -> None:
    """It has announced that."""
    serve()
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    await client.leave()
    owner.destroy_node()
    await manual_clock.advance(3600)

    expect(goal, GoalStatus.EXECUTING)


# Clients without signs, such as rclpy's


async def test_a_client_without_signs_is_lost_when_it_leaves_the_graph(
    serve: Serve,
    client: PlainClient,
    owner: Node,
    worker: Worker,
    manual_clock: ManualClock,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Nothing else reports it."""
    serve()
    await client.send()
    goal = await worker.begun.get()
    await manual_clock.advance(3600)
    expect(goal, GoalStatus.EXECUTING)

    owner.destroy_node()
    await settle()

    expect(goal, GoalStatus.CANCELED)
    assert "its client /owner is lost: it is not in the graph; cancelling" in caplog.text


def client_of(name: str, gid: bytes, *, over_rcl: bool = False) -> EndpointInfo:
    """Return a client of the service that takes goals, as the graph has it."""
    return EndpointInfo(
        EndpointKind.CLIENT,
        NodeInfo(name, 0, name, "/", over_rcl=over_rcl),
        0,
        "/fibonacci/_action/send_goal",
        "",
        "",
        QoSProfile(depth=10),
        gid,
    )


Lost = list[list[bytes]]
"""The goals whose client was lost, together."""


@pytest.fixture
def lost() -> Lost:
    """The goals whose clients `watch` has missed."""
    return []


@pytest.fixture
def graph() -> Graph:
    """The graph of `watch`."""
    return Graph()


@pytest.fixture
def watch(graph: Graph, lost: Lost, manual_clock: ManualClock) -> Iterator[ClientWatch]:
    """A watch of the clients of goals, without a server."""
    watch = ClientWatch(
        "/fibonacci/_action/send_goal",
        graph,
        manual_clock,
        int(LOST_SEC * 1e9),
        lambda goal_ids, _text: lost.append(goal_ids),
    )
    yield watch
    watch.stop()


async def test_a_client_over_dds_may_be_found_after_its_goal(
    watch: ClientWatch, graph: Graph, lost: Lost, manual_clock: ManualClock
) -> None:
    """A goal is often faster than the graph; its client has not gone, and must be missed later."""
    # Their gids in the graph are not those that their requests have.
    first = client_of("first", b"1" * 16, over_rcl=True)
    second = client_of("second", b"2" * 16, over_rcl=True)
    watch.add(b"goal", b"x" * 16)

    graph.add_endpoint(first)
    graph.add_endpoint(second)
    await manual_clock.advance(10.0)
    graph.remove_endpoint(first)
    await settle()
    assert lost == []  # the goal may be that of the second one

    graph.remove_endpoint(second)
    await settle()
    assert lost == [[b"goal"]]


async def test_another_client_may_leave(
    serve: Serve, client: PlainClient, node_factory: Callable[..., Node], worker: Worker
) -> None:
    """The goal is not its own."""
    serve()
    other = node_factory("other")
    PlainClient(other)
    await client.send()
    goal = await worker.begun.get()

    other.destroy_node()
    await settle()

    expect(goal, GoalStatus.EXECUTING)


async def test_a_client_that_goes_before_its_goal_is_decided_on_loses_it(
    serve: Serve,
    client: PlainClient,
    owner: Node,
    worker: Worker,
    manual_clock: CountingClock,
) -> None:
    """It must not start to drive for nobody."""
    may_decide = asyncio.Event()

    async def decide(_goal: object) -> GoalResponse:
        await may_decide.wait()
        return GoalResponse.ACCEPT

    serve(goal_callback=decide)
    request = asyncio.ensure_future(client.send())  # noqa: TID251  # owned by the test
    await settle()

    owner.destroy_node()
    await settle()
    may_decide.set()
    await settle()

    assert worker.begun.empty()
    assert await manual_clock.wakes_in(3600) == 0  # nothing is watched
    request.cancel()


@pytest.mark.parametrize("answer", [GoalResponse.REJECT, ValueError("no")])
async def test_no_goal_is_watched_that_is_not_accepted(
    serve: Serve,
    client: PlainClient,
    manual_clock: CountingClock,
    answer: GoalResponse | ValueError,
) -> None:
    """Whether they are rejected, or their callback fails."""

    def decide(_goal: object) -> GoalResponse:
        if isinstance(answer, ValueError):
            raise answer
        return answer

    serve(goal_callback=decide)
    with suppress(ServiceError):
        await client.send()

    assert await manual_clock.wakes_in(3600) == 0


async def test_a_client_that_is_found_later_than_its_goal_is_not_lost(
    watch: ClientWatch, graph: Graph, lost: Lost, manual_clock: ManualClock
) -> None:
    """Its entry in the graph may arrive by another route than its request."""
    client = client_of("owner", b"1" * 16)
    watch.add(b"goal", client.gid)

    await manual_clock.advance(LOST_SEC - 0.001)
    graph.add_endpoint(client)
    await manual_clock.advance(3600)

    assert lost == []


async def test_a_client_that_is_never_found_is_lost(
    watch: ClientWatch, lost: Lost, manual_clock: ManualClock
) -> None:
    """It has gone while its goal was queued."""
    watch.add(b"goal", b"1" * 16)

    await manual_clock.advance(LOST_SEC - 0.001)
    assert lost == []
    await manual_clock.advance(0.001)
    assert lost == [[b"goal"]]


# A server that was stalled


async def test_a_server_that_stood_still_waits_before_it_judges(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """The client was silent for as long as the server was stalled."""
    serve()
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    await manual_clock.jump(70.0)
    await manual_clock.advance(LOST_SEC - 0.001)
    expect(goal, GoalStatus.EXECUTING)
    await manual_clock.advance(0.001)
    expect(goal, GoalStatus.CANCELED)


async def test_a_server_that_stood_still_goes_on_with_a_client_that_is_alive(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """Its signs of life have waited."""
    serve()
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    await manual_clock.jump(70.0)
    for _ in range(4):
        await manual_clock.advance(1.0)
        await client.sign()

    expect(goal, GoalStatus.EXECUTING)


async def test_a_server_that_stood_still_gives_those_time_that_have_left_the_graph(
    serve: Serve, client: PlainClient, owner: Node, worker: Worker, manual_clock: ManualClock
) -> None:
    """Its own connections were cut meanwhile, so everyone has left; they come back."""
    serve()
    await client.send()
    goal = await worker.begun.get()

    await manual_clock.jump(70.0)
    owner.destroy_node()
    await manual_clock.advance(LOST_SEC - 0.001)
    expect(goal, GoalStatus.EXECUTING)
    await manual_clock.advance(0.001)
    expect(goal, GoalStatus.CANCELED)


async def test_a_server_that_is_always_late_finds_a_lost_client_all_the_same(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: ManualClock
) -> None:
    """A callback that repeatedly blocks for a second must not keep the robot driving."""
    serve()
    await client.send()
    await client.sign()
    goal = await worker.begun.get()

    for _ in range(5):
        await manual_clock.jump(1.8)

    expect(goal, GoalStatus.CANCELED)


# What it costs


async def test_no_goal_is_watched_that_has_ended_or_never_was(
    serve: Serve, client: PlainClient, worker: Worker, manual_clock: CountingClock
) -> None:
    """Nothing wakes a server without goals."""
    worker.may_end.set()
    serve(result_timeout=0)
    for number in range(100):
        await client.send(number)
        await client.sign(number)
        await client.sign(number + 1000)
    await settle()
    await manual_clock.advance(0.001)

    assert await manual_clock.wakes_in(3600) == 0


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"on_client_lost": "abort"}, 'on_client_lost=.abort. is unknown; use "cancel" or'),
        ({"client_lost_sec": 0.02}, "client_lost_sec=0.02; it must be at least 0.03 s"),
        ({"client_lost_sec": float("inf")}, "must be finite"),
    ],
)
async def test_a_wrong_choice_is_refused(serve: Serve, options: dict[str, Any], text: str) -> None:
    """The error comes where the choice was made."""
    with pytest.raises(ValueError, match=text):
        serve(**options)


# aionode's clients


@pytest.fixture
async def asking(owner: Node, serve: Serve) -> Client:
    """A client of aionode, and a server that wants its signs."""
    serve()
    client: Client = owner.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server()
    return client


def signs_of(client: Client) -> LifeSigns:
    """Return what gives the signs of a client."""
    return client._signs


async def test_a_client_gives_three_signs_in_the_time(
    asking: Client, owner: Node, worker: Worker, manual_clock: CountingClock
) -> None:
    """As long as it has a goal; then nothing wakes it."""
    goal = await asking.send_goal(Fibonacci.Goal())
    await settle()
    calls = result_client(owner).stats.calls

    await manual_clock.advance(30.5)
    assert result_client(owner).stats.calls - calls == 30
    assert (await worker.begun.get()).status is GoalStatus.EXECUTING

    worker.may_end.set()
    await goal.result()
    await manual_clock.advance(60.0)  # the server forgets the result
    assert await manual_clock.wakes_in(60.0) == 0


async def test_a_server_that_wants_no_signs_gets_none(
    serve: Serve, owner: Node, manual_clock: ManualClock
) -> None:
    """A goal costs one call for its result, as in ROS."""
    serve(on_client_lost="continue")
    client: Client = owner.create_action_client(Fibonacci, "fibonacci")
    await client.wait_for_server()
    await client.send_goal(Fibonacci.Goal())
    await manual_clock.advance(60.0)

    assert result_client(owner).stats.calls == 1


async def test_a_service_that_is_found_later_than_its_goal_gets_signs(
    asking: Client,
    owner: Node,
    worker: Worker,
    monkeypatch: pytest.MonkeyPatch,
    manual_clock: ManualClock,
) -> None:
    """Its entry in the graph may arrive later than the answer of the other service."""
    with monkeypatch.context() as not_found:
        not_found.setattr(owner.graph, "endpoints", lambda *_, **__: [])
        await asking.send_goal(Fibonacci.Goal())
    owner.graph.changes += 1  # it is found
    goal = await worker.begun.get()
    calls = result_client(owner).stats.calls

    await manual_clock.advance(60.0)

    expect(goal, GoalStatus.EXECUTING)
    assert result_client(owner).stats.calls > calls


async def test_a_sign_that_could_not_be_delivered_is_given_again_soon(
    asking: Client, owner: Node, manual_clock: ManualClock
) -> None:
    """The server learns only from the first one that the client sends signs of life."""
    await asking.send_goal(Fibonacci.Goal())
    (sign,) = signs_of(asking)._goals.values()
    assert sign is not None
    sign.fail(ServiceUnavailableError("/fibonacci/_action/get_result"))
    await settle()
    calls = result_client(owner).stats.calls

    await manual_clock.advance(0.021)

    assert result_client(owner).stats.calls - calls == 1


async def test_a_client_that_was_taken_for_lost_learns_why(
    asking: Client, manual_clock: ManualClock
) -> None:
    """When it continues: its goal was canceled without a request."""
    call = asyncio.ensure_future(asking.call(Fibonacci.Goal()))  # noqa: TID251  # owned by the test
    await settle()
    signs_of(asking).stop()  # as if the process were frozen

    await manual_clock.advance(LOST_SEC)

    with pytest.raises(GoalCanceledError, match="no sign of it for 3 s") as caught:
        await call
    assert caught.value.error_text.startswith("its client /owner is lost")


def by_destroying_it(client: Client, _owner: Node) -> None:
    """End the client alone."""
    client.destroy()


def with_its_node(_client: Client, owner: Node) -> None:
    """End the node."""
    owner.destroy_node()


def fail() -> None:
    """Be a callback that raises."""
    raise ValueError("no map")


@pytest.mark.parametrize("end", [by_destroying_it, with_its_node])
async def test_a_client_that_ends_properly_leaves_goals_that_nobody_awaits(
    asking: Client,
    owner: Node,
    worker: Worker,
    manual_clock: ManualClock,
    end: Callable[[Client, Node], None],
) -> None:
    """It was meant to continue."""
    await asking.send_goal(Fibonacci.Goal())
    goal = await worker.begun.get()

    end(asking, owner)
    await manual_clock.advance(3600)

    expect(goal, GoalStatus.EXECUTING)
    assert not [each for each in owner.clients if "fibonacci" in each.srv_name]


async def test_a_node_that_fails_ends_properly(manual_clock: ManualClock) -> None:
    """Its client says which goal it leaves, as one that is destroyed does."""
    worker = Worker()
    async with local_context(clock=manual_clock) as context, Node("s", context=context) as serving:
        serving.create_action_server(Fibonacci, "fibonacci", worker, on_client_lost="cancel")
        owner = Node("owner", context=context)
        client: Client = owner.create_action_client(Fibonacci, "fibonacci")
        running = asyncio.ensure_future(owner.run())  # noqa: TID251  # owned by the test
        await client.wait_for_server()
        await client.send_goal(Fibonacci.Goal())
        goal = await worker.begun.get()

        owner.create_timer(0.0, fail)
        await manual_clock.advance(0.001)
        with pytest.raises(ExceptionGroup):
            await running
        await manual_clock.advance(3600)

        expect(goal, GoalStatus.EXECUTING)


# Between contexts


@pytest.mark.parametrize(
    "link", [True, pytest.param(False, marks=pytest.mark.slow)], ids=["link", "zenoh"]
)
async def test_signs_pass_between_contexts(monkeypatch: pytest.MonkeyPatch, *, link: bool) -> None:
    """A goal lives as long as its client sends signs of life, and ends when they stop."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    worker = Worker()
    async with AsyncExitStack() as stack, asyncio.timeout(30):
        contexts = [await stack.enter_async_context(Context(link=link)) for _ in range(2)]
        serving, asking = [
            await stack.enter_async_context(Node(name, context=context))
            for name, context in zip(("serving", "asking"), contexts, strict=True)
        ]
        serving.create_action_server(
            Fibonacci, "fibonacci", worker, on_client_lost="cancel", client_lost_sec=1.0
        )
        client: Client = asking.create_action_client(Fibonacci, "fibonacci")
        await client.wait_for_server()
        sent = await client.send_goal(Fibonacci.Goal())
        goal = await worker.begun.get()
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(1.5):
                await asyncio.shield(end_of(goal))

        signs_of(client).stop()

        assert (await sent.result()).status is GoalStatus.CANCELED
        assert (await sent.result()).error_text == (
            "its client /asking is lost: no sign of it for 1 s"
        )
