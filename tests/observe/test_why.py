"""What led to a message: every cause that is named is true, and none is missing."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest

from aionode import ActionClient, ActionServer, Context, Node
from aionode._process.concurrency import checkpoint
from aionode.action import CancelResponse
from aionode.engine.cause_reports import CauseQuestion, answer, encoded
from aionode.engine.causes import CauseLog, Party
from aionode.graph import NodeInfo
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Joy
from aionode.interfaces.std_msgs.msg import Header, Int32
from aionode.message import Message
from aionode.message_filters import Subscriber, TimeSynchronizer, synchronize
from aionode.observe import Caused, Why, _causes, to_chains, why
from aionode.testing import local_context, settle
from tests.observe.test_observe import Answering
from tests.support.peers import contexts_over

CALL = AddTwoInts.Request(a=1, b=2)


class Unknown(Message, typename="unknown_msgs/msg/Unknown", by_name=False):
    """A class that is not found by name, as if another process had it."""

    text: str = ""


@asynccontextmanager
async def robot(name: str = "robot") -> AsyncIterator[Node]:
    """A running node of a context that keeps causes."""
    async with (
        Context(transport="local", causes=True) as context,
        Node(name, context=context) as node,
    ):
        yield node


@asynccontextmanager
async def two_nodes(way: str, *names: str) -> AsyncIterator[tuple[Node, Node]]:
    """Two nodes that are connected like those of two processes, which keep causes."""
    async with (
        contexts_over(way, causes=True) as contexts,
        Node(names[0], context=contexts[0]) as one,
        Node(names[1], context=contexts[1]) as other,
    ):
        yield one, other


def names(sent: Caused) -> list[Any]:
    """Return what led to something: callbacks and names in turn; a list for each of several."""
    found: list[Any] = [f"{sent.kind} {sent.name}"]
    branches = []
    for cause in sent.causes:
        branch: list[Any] = [cause.callback.rpartition(".")[2] or f"awaited by {cause.node}"]
        branches.append(branch + (names(cause.source) if cause.source else [cause.party]))
    if len(branches) == 1:
        return found + branches[0]
    return found + branches


async def chain_of(node: Node, name: str) -> list[Any]:
    """Return what led to the latest thing of a name."""
    found = await why(node, name)
    assert len(found.sent) == 1
    return names(found.sent[0])


async def test_a_message_leads_back_to_the_timer() -> None:
    """From callback to callback; each with what it took."""
    async with robot() as node:
        scan, plan = (node.create_publisher(Int32, name, 10) for name in ("scan", "plan"))

        def on_scan(_: Int32) -> None:
            plan.publish(Int32())

        def on_tick() -> None:
            scan.publish(Int32())

        node.create_subscription(Int32, "scan", on_scan)
        planned = node.create_subscription(Int32, "plan")
        node.create_timer(0.01, on_tick)
        await planned.receive()

        assert await chain_of(node, "plan") == [
            "message /plan", "on_scan", "message /scan", "on_tick", "timer",
        ]  # fmt: skip


async def publish_after(work: Callable[[Tools], Any], **options: Any) -> list[Any]:
    """Return what led to a message that a callback sends after some work."""
    async with robot() as node:
        out = node.create_publisher(Int32, "out", 10)
        node.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add")

        async def on_in(_: Int32) -> None:
            await work(Tools(client, lambda: out.publish(Int32())))

        node.create_subscription(Int32, "in", on_in, **options)
        done = node.create_subscription(Int32, "out")
        node.create_publisher(Int32, "in", 10).publish(Int32())
        await done.receive()
        return await chain_of(node, "out")


def add(request: Any) -> Any:
    """Answer a request."""
    return AddTwoInts.Response(sum=request.a + request.b)


class Tools:
    """A client of ``add`` and a publisher, for the callback of a test."""

    def __init__(self, client: Any, publish: Callable[[], None]) -> None:
        self.client = client
        self.publish = publish


FROM_IN = ["on_in", "message /in"]
"""The causes of a message of the callback: one message, which was not sent in a callback."""

BY_ANSWER = ["awaited by /robot", "response /add", "add", "request /add"]


async def in_a_task(tools: Tools) -> None:
    """Publish in a task that the callback has started and awaits."""

    async def later() -> None:
        await checkpoint()
        tools.publish()

    await asyncio.gather(later())


async def in_a_thread(tools: Tools) -> None:
    """Publish in a thread."""
    await asyncio.to_thread(tools.publish)


async def later_in_the_loop(tools: Tools) -> None:
    """Publish in a callback of the event loop."""
    asyncio.get_running_loop().call_later(0.001, tools.publish)


@pytest.mark.parametrize("work", [in_a_task, in_a_thread, later_in_the_loop])
@pytest.mark.parametrize("concurrent", [False, True])
async def test_what_a_callback_starts_is_caused_by_its_message(
    work: Callable[[Tools], Any], concurrent: bool
) -> None:
    """Tasks, threads and callbacks of the loop inherit it, also beside other callbacks."""
    assert await publish_after(work, concurrent=concurrent) == ["message /out", *FROM_IN]


async def test_an_offloaded_callback_has_causes() -> None:
    """Its thread inherits what the callback works on."""
    async with robot() as node:
        out = node.create_publisher(Int32, "out", 10)

        def on_in(_: Int32) -> None:
            out.publish(Int32())

        node.create_subscription(Int32, "in", on_in, offload=True)
        done = node.create_subscription(Int32, "out")
        node.create_publisher(Int32, "in", 10).publish(Int32())
        await done.receive()

        assert await chain_of(node, "out") == ["message /out", *FROM_IN]


async def call(tools: Tools) -> None:
    """Publish after a call."""
    await tools.client.call(CALL)
    tools.publish()


async def gather_calls(tools: Tools) -> None:
    """Publish after calls in two tasks."""
    await asyncio.gather(tools.client.call(CALL), checkpoint())
    tools.publish()


async def call_in_a_group(tools: Tools) -> None:
    """Publish after a call in a task of a group."""
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(tools.client.call(CALL))
    tools.publish()


async def ask_for_a_future(tools: Tools) -> None:
    """Publish after a call in rclpy's words."""
    await tools.client.call_async(CALL)
    tools.publish()


@pytest.mark.parametrize("work", [call, gather_calls, call_in_a_group, ask_for_a_future])
async def test_an_answer_is_a_cause_of_what_follows(work: Callable[[Tools], Any]) -> None:
    """Beside the message; its own cause is the service, which got the request of the callback."""
    assert await publish_after(work) == [
        "message /out",
        FROM_IN,
        [*BY_ANSWER, "on_in", "message /in"],
    ]


async def test_what_another_task_still_works_on_is_no_cause() -> None:
    """Only a task that has ended can have told the callback anything of the answer it got."""
    blocked, published = asyncio.Event(), asyncio.Event()

    async def work(tools: Tools) -> None:
        async def busy() -> None:
            await tools.client.call(CALL)
            blocked.set()
            await published.wait()

        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(busy())
            await blocked.wait()
            tools.publish()
            published.set()

    assert await publish_after(work) == ["message /out", *FROM_IN]


async def test_a_task_keeps_the_message_for_which_it_was_started() -> None:
    """The callback may have gone on to others."""
    async with robot() as node, asyncio.TaskGroup() as tasks:
        out = node.create_publisher(Int32, "out", 10)
        go = asyncio.Event()

        async def later(number: int) -> None:
            await go.wait()
            out.publish(Int32(data=number))

        def on_in(message: Int32) -> None:
            tasks.create_task(later(message.data))

        node.create_subscription(Int32, "in", on_in)
        done = node.create_subscription(Int32, "out")
        publisher = node.create_publisher(Int32, "in", 10)
        for number in (1, 2, 3):
            publisher.publish(Int32(data=number))
        await settle()
        go.set()
        for number in (1, 2, 3):
            assert (await done.receive()).data == number
        log = node.context.causes
        assert log is not None
        sent = [each for each in log.sent if each.party.name == "/out"]
        assert [[run.sequence for run in each.causes] for each in sent] == [[1], [2], [3]]


async def test_a_task_that_reads_is_caused_by_what_it_has_read() -> None:
    """The latest message of each subscription that it reads."""
    async with robot() as node:
        left, right = (node.create_subscription(Int32, name) for name in ("left", "right"))
        out = node.create_publisher(Int32, "out", 10)
        for name in ("left", "right"):
            publisher = node.create_publisher(Int32, name, 10)
            publisher.publish(Int32())
            publisher.publish(Int32())
        for _ in range(2):
            await left.receive()
            await right.receive()
        out.publish(Int32())

        (sent,) = (await why(node, "out")).sent
        assert names(sent) == [
            "message /out",
            ["awaited by /robot", "message /left"],
            ["awaited by /robot", "message /right"],
        ]
        assert [cause.source.sequence for cause in sent.causes if cause.source] == [2, 2]


def joy(second: int) -> Joy:
    """Return a message with a stamp."""
    message = Joy(header=Header())
    message.header.stamp.sec = second
    return message


@pytest.mark.parametrize("way", ["callback", "iterator"])
async def test_a_synchronizer_has_two_causes(way: str) -> None:
    """Both messages, each with what led to it."""
    async with robot() as node:
        out = node.create_publisher(Int32, "out", 10)
        left, right = (node.create_publisher(Joy, name, 10) for name in ("left", "right"))

        def on_pair(_: Joy, __: Joy) -> None:
            out.publish(Int32())

        if way == "callback":
            filters = [Subscriber(node, Joy, name) for name in ("left", "right")]
            TimeSynchronizer(filters, 10).registerCallback(on_pair)
        else:
            pairs = synchronize(
                *(node.create_subscription(Joy, name) for name in ("left", "right"))
            )
        done = node.create_subscription(Int32, "out")
        left.publish(joy(1))
        left.publish(joy(2))
        right.publish(joy(2))
        if way == "iterator":
            on_pair(*await anext(pairs))
        await done.receive()

        (sent,) = (await why(node, "out")).sent
        found = {
            (cause.source.name, cause.source.sequence) for cause in sent.causes if cause.source
        }
        assert found == {("/left", 2), ("/right", 1)}


async def test_a_timer_that_a_callback_started_leads_to_it() -> None:
    """Created or reset by it."""
    async with robot() as node:
        out = node.create_publisher(Int32, "out", 10)

        def on_tick() -> None:
            timer.cancel()
            out.publish(Int32())

        timer = node.create_timer(0.001, on_tick, autostart=False)

        def on_in(_: Int32) -> None:
            timer.reset()

        node.create_subscription(Int32, "in", on_in)
        done = node.create_subscription(Int32, "out")
        node.create_publisher(Int32, "in", 10).publish(Int32())
        await done.receive()

        assert await chain_of(node, "out") == [
            "message /out", "on_tick", "timer timer of 0.001 s", *FROM_IN,
        ]  # fmt: skip


async def test_a_silence_is_a_cause() -> None:
    """A stop that on_silence sends is not caused by a message."""
    async with robot() as node:
        out = node.create_publisher(Int32, "out", 10)

        def stop() -> None:
            out.publish(Int32())

        node.create_subscription(Int32, "in", lambda _: None, on_silence=stop, silence_sec=0.02)
        done = node.create_subscription(Int32, "out")
        node.create_publisher(Int32, "in", 10).publish(Int32())
        await done.receive()

        (sent,) = (await why(node, "out")).sent
        assert [(cause.party, cause.name) for cause in sent.causes] == [("silence", "/in")]


@asynccontextmanager
async def with_action(one: Node, other: Node) -> AsyncIterator[ActionClient[Any, Any, Any]]:
    """A server that waits for its end, and a client of it."""

    async def execute(goal: Any) -> Any:
        goal.publish_feedback(Fibonacci.Feedback())
        try:
            if not goal.request.order:
                await asyncio.Event().wait()
        except asyncio.CancelledError:
            stop.publish(Int32())
            raise
        goal.succeed()
        return Fibonacci.Result()

    stop = one.create_publisher(Int32, "stop", 10)
    ActionServer(one, Fibonacci, "fib", execute, cancel_callback=lambda _: CancelResponse.ACCEPT)
    client = ActionClient(other, Fibonacci, "fib")
    await client.wait_for_server()
    yield client


@pytest.mark.parametrize("way", ["local", "link", "zenoh"])
async def test_an_action_has_causes_both_ways(way: str) -> None:
    """The goal, its feedback, its result and its cancellation, also between processes."""
    async with two_nodes(way, "server", "client") as (one, other):
        out = other.create_publisher(Int32, "out", 10)
        ended = asyncio.Event()
        async with with_action(one, other) as client:

            async def on_in(message: Int32) -> None:
                goal = await client.send_goal(Fibonacci.Goal(order=message.data))
                if not message.data:
                    await anext(goal)
                    out.publish(Int32())
                    await goal.cancel()
                await goal.result()
                if message.data:
                    out.publish(Int32())
                ended.set()

            other.create_subscription(Int32, "in", on_in)
            stopped = other.create_subscription(Int32, "stop")
            go = other.create_publisher(Int32, "in", 10)
            go.publish(Int32(data=1))
            await ended.wait()
            goal = await chain_of(other, "fib")
            (result,) = (await why(other, "out")).sent
            ended.clear()
            go.publish(Int32(data=0))
            await stopped.receive()
            await ended.wait()
            (feedback,) = (await why(other, "out")).sent
            (cancelled,) = (await why(other, "stop")).sent

    assert goal == ["goal /fib", *FROM_IN]
    brought = names(result)[-1]
    assert brought[:2] == ["awaited by /client", "response /fib/_action/get_result"]
    assert ["execute", "goal /fib", *FROM_IN] in [each for each in brought if type(each) is list]
    told = names(feedback)[-1]
    assert told[:4] == [
        "_on_feedback", "message /fib/_action/feedback", "execute", "goal /fib",
    ]  # fmt: skip
    assert names(cancelled)[1][:2] == ["execute", "goal /fib"]
    assert names(cancelled)[2][:2] == ["_on_cancel", "request /fib/_action/cancel_goal"]


async def test_a_result_does_not_lead_back_to_the_goal_before() -> None:
    """Although the client handles all of them in one place."""
    async with robot() as node, with_action(node, node) as client:
        out = node.create_publisher(Int32, "out", 10)

        async def send_and_tell() -> None:
            goal = await client.send_goal(Fibonacci.Goal(order=1))
            await goal.result()
            out.publish(Int32())

        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(send_and_tell())
        first = await chain_of(node, "out")
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(send_and_tell())
        second = await chain_of(node, "out")

    assert second == first


@pytest.mark.parametrize("way", ["link", "zenoh"])
async def test_a_chain_goes_through_processes(way: str) -> None:
    """Each tells what it knows; the times are by the clock of each."""
    async with two_nodes(way, "slam", "planner") as (slam, planner):
        mapped = slam.create_publisher(Int32, "map", 10)
        driven = planner.create_publisher(Int32, "drive", 10)

        def on_scan(message: Int32) -> None:
            mapped.publish(message)

        def on_map(message: Int32) -> None:
            driven.publish(message)

        slam.create_subscription(Int32, "scan", on_scan)
        planner.create_subscription(Int32, "map", on_map)
        done = slam.create_subscription(Int32, "drive")
        scan = planner.create_publisher(Int32, "scan", 10)
        await scan.wait_for_subscribers()
        await mapped.wait_for_subscribers()
        await driven.wait_for_subscribers()
        scan.publish(Int32())
        await done.receive()

        found = await why(slam, "drive")

    assert names(found.sent[0]) == [
        "message /drive", "on_map", "message /map", "on_scan", "message /scan",
    ]  # fmt: skip
    assert found == Why("drive", found.sent)
    ages = []
    sent: Caused | None = found.sent[0]
    while sent is not None:
        ages.append(sent.ago_ns or 0)
        sent = sent.causes[0].source if sent.causes else None
    assert ages == sorted(ages)


async def test_who_keeps_no_causes_is_named_with_the_remedy() -> None:
    """By default nothing is kept, as it makes messages dearer."""
    async with Node("robot", context=local_context()) as node:
        node.create_publisher(Int32, "out", 10).publish(Int32())
        found = await why(node, "out")

    assert node.context.causes is None
    assert to_chains(found).splitlines() == [
        "/out (robot, keeps no causes)",
        "/robot: no causes are kept: start it with AIONODE_CAUSES=1, or with Context(causes=True)",
    ]


async def test_a_publisher_that_has_sent_nothing_is_reported_as_such() -> None:
    """What it sends is kept however old it is, so nothing can have been forgotten."""
    async with robot() as node:
        node.create_publisher(Int32, "out", 10)
        found = await why(node, "out")

    assert to_chains(found) == "/out (robot, has sent nothing yet)"


async def test_what_a_description_needed_is_no_cause() -> None:
    """The command line asks for the type of an action before it sends a goal."""
    async with robot() as node, Node("other", context=node.context) as other:
        publisher = other.create_publisher(Unknown, "unknown", 1)
        out = node.create_publisher(Int32, "out", 10)

        async def on_in(_: Int32) -> None:
            await node.find_type("unknown_msgs/msg/Unknown")
            out.publish(Int32())

        node.create_subscription(Int32, "in", on_in)
        done = node.create_subscription(Int32, "out")
        other.create_publisher(Int32, "in", 10).publish(Int32())
        await done.receive()

        assert await chain_of(node, "out") == ["message /out", "on_in", "message /in"]
        publisher.destroy()


async def test_a_long_list_of_causes_is_asked_for_in_several_questions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A process answers a bounded number of keys, and the others counted as forgotten."""
    monkeypatch.setattr(_causes, "MAX_TOLD", 1)
    async with two_nodes("local", "one", "two") as (one, two):
        inputs = [one.create_publisher(Int32, name, 10) for name in ("in_a", "in_b", "in_c")]
        taken = [two.create_subscription(Int32, name) for name in ("in_a", "in_b", "in_c")]
        out = two.create_publisher(Int32, "out", 10)
        for publisher, subscription in zip(inputs, taken, strict=True):
            await publisher.wait_for_subscribers()
            publisher.publish(Int32())
            await subscription.receive()
        out.publish(Int32())
        found = await why(two, "out")

    assert [cause.source.unknown for cause in found.sent[0].causes if cause.source] == ["", "", ""]


async def test_nobody_reveals_what_another_has_sent() -> None:
    """A context that lies could replace what is true."""
    log = CauseLog()
    transport = Answering({})
    async with (
        Context(transport=transport, causes=True) as context,
        Node("robot", context=context) as node,
    ):
        publisher = node.create_publisher(Int32, "out", 10)
        log.note("message", Party("publisher", "/liar", "/out", publisher._endpoint.gid), 1)
        lie = encoded(answer(log, "d4", CauseQuestion("/out")))
        transport.answers["d4"] = lie
        node.graph.add_node(NodeInfo("d4", 1, "liar", "/"))
        publisher.publish(Int32())
        found = await why(node, "out")

    assert [each.node for each in found.sent] == ["/robot"]


def test_a_name_of_another_process_forges_no_line() -> None:
    """Its answer may contain any text, such as a new line with the name of another node."""
    lie = Caused("message", "/out\n/other: no answer", "/node", "00", 1, 0, unknown="forgotten")

    assert to_chains(Why("out", [lie])).splitlines() == [
        "/out\\n/other: no answer (node, no longer kept) 0 us ago"
    ]


async def test_contexts_that_cannot_report_are_named_and_the_others_are_included() -> None:
    """Frozen and older processes, and answers in another form or in another's name."""
    other = encoded(answer(CauseLog(), "d4", CauseQuestion()))
    transport = Answering({"a1": None, "b2": b"", "c3": b"\xff", "d4": other, "e5": other})
    async with (
        Context(transport=transport, causes=True) as context,
        Node("robot", context=context) as node,
    ):
        for participant, name in (
            ("a1", "frozen"),
            ("b2", "older"),
            ("c3", "newer"),
            ("e5", "lies"),
        ):
            node.graph.add_node(NodeInfo(participant, 1, name, "/"))
        node.create_publisher(Int32, "out", 10).publish(Int32())
        found = await why(node, "out")

    assert names(found.sent[0]) == ["message /out"]
    assert (found.silent, found.older) == ({"a1": ["/frozen"]}, {"b2": ["/older"]})
    assert found.unreadable == {"c3": ["/newer"], "e5": ["/lies"]}
    assert to_chains(found).splitlines()[1:] == [
        "/frozen: no answer",
        "/older: an older version of aionode, which keeps no causes",
        "/newer: an answer that this version cannot read",
        "/lies: an answer that this version cannot read",
    ]
