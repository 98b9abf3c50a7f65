"""Callbacks that run within the event of a transport: when they do, and what stays the same."""

from __future__ import annotations

import asyncio
import gc
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.clock import perf_ns
from aionode.engine.transport.base import Request, SampleInfo
from aionode.errors import CallbackCancelledError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from aionode.testing import ManualClock, local_context, settle
from tests.support.arrivals import reader_of, serve_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from aionode.endpoints.core.callback_runner import CallbackContext
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.engine.context import Context

MINUTE_NS = 60 * 10**9

place: ContextVar[str] = ContextVar("place", default="nowhere")


def listen(node: Node, callback: Any, **options: Any) -> Subscription[Int32]:
    """Return a subscription to numbers, with room for a thousand."""
    return node.create_subscription(Int32, "numbers", callback, 1000, **options)


def bring(
    subscription: Subscription[Int32], *numbers: int, inline_deadline_ns: int | None = None
) -> None:
    """Deliver `numbers` like a transport within one of its events."""
    if inline_deadline_ns is None:
        inline_deadline_ns = perf_ns() + MINUTE_NS
    for number in numbers:
        reader_of(subscription).deliver(
            Int32(data=number), bytes(16), number, 0, inline_deadline_ns
        )


class Asked(Request):
    """A request for the sum of two and three, which records its answer."""

    def __init__(self) -> None:
        self.message = AddTwoInts.Request(a=2, b=3)
        self.sample_info = SampleInfo(bytes(16), 1, 0)
        self.outcome: list[object] = []

    def reply(self, response: Any) -> None:
        """Record a response."""
        self.outcome.append(response.sum)

    def fail(self, error_type: str, error_text: str) -> None:
        """Record an error."""
        self.outcome.append(f"{error_type}: {error_text}")

    def drop(self) -> None:
        """Record the end without an answer, unless there was one."""
        if not self.outcome:
            self.outcome.append("dropped")


def fail(_: AddTwoInts.Request) -> AddTwoInts.Response:
    """Answer like a handler with a bug."""
    raise ValueError("no sums today")


def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    """Answer like the tutorial's server."""
    response.sum = request.a + request.b
    return response


# When they run


async def test_an_idle_subscription_calls_back_within_the_event(node: Node) -> None:
    """The loop need not iterate once more, for any number of messages."""
    heard: list[int] = []
    subscription = listen(node, lambda msg: heard.append(msg.data))
    await settle()
    bring(subscription, 1, 2)
    assert heard == [1, 2]
    assert subscription.stats.received == 2
    await settle()
    assert heard == [1, 2]


async def test_a_callback_that_wants_the_info_gets_it(node: Node) -> None:
    """As from the queue."""
    heard: list[tuple[int, int]] = []

    def callback(msg: Int32, info: MessageInfo) -> None:
        heard.append((msg.data, info["publication_sequence_number"]))

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 7)
    assert heard == [(7, 7)]


async def test_without_a_time_the_callback_waits_for_its_turn(node: Node) -> None:
    """The caller is in a callback or in `publish`, and must not see other callbacks run."""
    heard: list[int] = []
    subscription = listen(node, lambda msg: heard.append(msg.data))
    await settle()
    bring(subscription, 1, inline_deadline_ns=0)
    assert heard == []
    await settle()
    assert heard == [1]


async def test_a_local_publish_runs_no_callback(node: Node) -> None:
    """Otherwise callbacks would run inside callbacks."""
    heard: list[int] = []
    listen(node, lambda msg: heard.append(msg.data))
    publisher = node.create_publisher(Int32, "numbers", 10)
    await settle()
    publisher.publish(Int32(data=1))
    assert heard == []
    await settle()
    assert heard == [1]


async def test_after_the_time_of_the_event_messages_queue(node: Node) -> None:
    """Slow callbacks would occupy the loop for a whole burst."""
    heard: list[int] = []
    subscription = listen(node, lambda msg: heard.append(msg.data))
    await settle()
    bring(subscription, 1, inline_deadline_ns=perf_ns())
    assert heard == []
    await settle()
    assert heard == [1]


async def test_what_follows_a_queued_message_queues_too(node: Node) -> None:
    """Order matters more than an iteration of the loop."""
    heard: list[int] = []
    subscription = listen(node, lambda msg: heard.append(msg.data))
    await settle()
    bring(subscription, 1, inline_deadline_ns=0)
    bring(subscription, 2)
    assert heard == []
    await settle()
    assert heard == [1, 2]
    bring(subscription, 3)
    assert heard == [1, 2, 3]


async def test_a_message_that_comes_during_a_callback_is_next(node: Node) -> None:
    """It is queued, and so are later ones."""
    heard: list[int] = []

    def callback(msg: Int32) -> None:
        if msg.data == 1:
            bring(subscription, 2)
        heard.append(msg.data)

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1, 3)
    assert heard == [1]
    await settle()
    assert heard == [1, 2, 3]


@pytest.mark.parametrize("options", [{"concurrent": True}, {"concurrent": 2}, {"offload": True}])
async def test_callbacks_with_a_task_or_a_thread_of_their_own_queue(
    node: Node, options: dict[str, Any]
) -> None:
    """The user asked for them to run beside the loop's events."""
    heard: list[int] = []
    subscription = listen(node, lambda msg: heard.append(msg.data), **options)
    await settle()
    bring(subscription, 1)
    assert len(reader_of(subscription)) == 1
    await settle()
    assert heard == [1]


async def test_coroutine_functions_queue(node: Node) -> None:
    """They need a task: that of the consumer; so do objects with an async `__call__`."""
    heard: list[int] = []

    class Listener:
        async def __call__(self, msg: Int32) -> None:
            heard.append(msg.data)

    subscription = listen(node, Listener())
    await settle()
    bring(subscription, 1)
    assert len(reader_of(subscription)) == 1
    await settle()
    assert heard == [1]


async def test_before_the_node_runs_messages_queue(context: Context) -> None:
    """No callback runs before its node runs."""
    heard: list[int] = []
    node = Node("node", context=context)
    subscription = listen(node, lambda msg: heard.append(msg.data))
    bring(subscription, 1)
    assert heard == []
    async with node:
        await settle()
        assert heard == [1]


# Turns of the queue


def tell_task(node: Node) -> tuple[list[object], Subscription[Int32]]:
    """Return a subscription, and the list of the tasks that its callback runs in."""
    tasks: list[object] = []
    return tasks, listen(node, lambda _: tasks.append(asyncio.current_task()))


async def test_a_queued_message_wakes_no_task(node: Node) -> None:
    """The loop calls back, which saves the step of a task for each message of the same process."""
    tasks, subscription = tell_task(node)
    await settle()
    bring(subscription, 1, 2, inline_deadline_ns=0)
    assert tasks == []
    await settle()
    assert tasks == [None, None]


async def test_where_a_test_sets_the_time_a_task_calls() -> None:
    """Otherwise what the callback schedules would not follow the clock."""
    async with local_context(clock=ManualClock()) as context, Node("node", context=context) as node:
        tasks, subscription = tell_task(node)
        await settle()
        bring(subscription, 1, inline_deadline_ns=0)
        await settle()
    assert isinstance(tasks[0], asyncio.Task)


async def test_others_run_between_slow_callbacks_of_a_queue(node: Node) -> None:
    """A turn ends after a millisecond, and the next one comes after what else is ready."""
    order: list[object] = []

    def callback(msg: Int32) -> None:
        order.append(msg.data)
        ends_ns = perf_ns() + 2_000_000
        while perf_ns() < ends_ns:
            pass
        asyncio.get_running_loop().call_soon(order.append, "another")

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1, 2, inline_deadline_ns=0)
    await settle()
    assert order == [1, "another", 2, "another"]


async def test_a_callback_may_publish_to_itself(node: Node) -> None:
    """What it queues is handled in the same turn, or after an inline call."""
    heard: list[int] = []

    def callback(msg: Int32) -> None:
        heard.append(msg.data)
        if msg.data % 10 < 3:
            bring(subscription, msg.data + 1, inline_deadline_ns=0)

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1, inline_deadline_ns=0)
    await settle()
    bring(subscription, 11)
    assert heard == [1, 2, 3, 11]
    await settle()
    assert heard == [1, 2, 3, 11, 12, 13]


@pytest.mark.parametrize("deadline_ns", [0, None], ids=["in a turn", "inline"])
async def test_what_waits_behind_a_rest_is_handled_after_it(
    node: Node, deadline_ns: int | None
) -> None:
    """The consumer takes over, and the loop calls back again once it waits."""
    heard: list[str] = []

    async def work(msg: Int32) -> None:
        await checkpoint()
        heard.append(f"end {msg.data}")

    def callback(msg: Int32) -> object:
        heard.append(f"call {msg.data}")
        return work(msg) if msg.data == 1 else None

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1, 2, inline_deadline_ns=deadline_ns)
    await settle()
    bring(subscription, 3, inline_deadline_ns=deadline_ns)
    await settle()
    assert heard == ["call 1", "end 1", "call 2", "call 3"]


async def test_a_message_queued_before_the_end_is_dropped(node: Node) -> None:
    """Its turn is planned, and finds the consumer cancelled."""
    heard: list[int] = []
    subscription = listen(node, lambda msg: heard.append(msg.data))
    await settle()
    bring(subscription, 1, inline_deadline_ns=0)
    subscription.destroy()
    await settle()
    assert heard == []
    assert subscription.stats.dropped == 1


# What stays the same


async def test_callbacks_are_measured(node: Node) -> None:
    """The statistics are the same for queued and inline callbacks."""
    subscription = listen(node, lambda _: None)
    await settle()
    bring(subscription, 1, 2)
    stats = subscription.stats
    assert stats.queue_wait.count == stats.run_time.count == stats.blocking.count == 2
    assert 0 < stats.run_time.max_ns == stats.blocking.max_ns


async def test_lost_messages_are_counted(node: Node) -> None:
    """By their numbers, as before the queue."""
    subscription = listen(node, lambda _: None)
    await settle()
    bring(subscription, 1, 4)
    assert subscription.stats.lost == 2


async def test_a_slow_callback_is_reported(
    node_factory: Callable[..., Node],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It blocks the loop just the same."""
    monkeypatch.setattr("aionode.endpoints.core.thread_time.thread_waited_ns", lambda: 0)
    node = node_factory("slow", callback_budget_ms=1e-6)
    subscription = listen(node, lambda _: None)
    await settle()
    bring(subscription, 1)
    assert "blocked the event loop" in capfd.readouterr().err


async def test_callbacks_run_in_the_context_of_their_node(context: Context) -> None:
    """In the context of the transport's event, context variables would have other values."""
    seen: list[str] = []
    place.set("node")
    async with Node("node", context=context) as node:
        subscription = listen(node, lambda _: seen.append(place.get()))
        await settle()
        place.set("transport")
        bring(subscription, 1)
    assert seen == ["node"]


# Errors


async def test_an_error_ends_the_node(context: Context) -> None:
    """The consumer raises it, not the transport's event."""

    def fail(msg: Int32) -> None:
        raise ValueError(f"no {msg.data} please")

    node = Node("node", context=context)
    subscription = listen(node, fail)

    async def transport() -> None:
        await settle()
        bring(subscription, 1, 2)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(transport())
        with pytest.raises(ExceptionGroup) as caught:
            await node.run()
    assert caught.group_contains(ValueError, match="no 1 please")
    assert not caught.group_contains(ValueError, match="no 2 please")
    assert subscription.stats.errors == 1


async def test_on_error_log_goes_on_at_once(node: Node, capfd: pytest.CaptureFixture[str]) -> None:
    """Nothing is left for the consumer."""
    heard: list[int] = []

    def callback(msg: Int32) -> None:
        heard.append(msg.data)
        raise ValueError("no numbers please")

    subscription = listen(node, callback, on_error="log")
    await settle()
    bring(subscription, 1, 2)
    assert heard == [1, 2]
    assert subscription.stats.errors == 2
    assert "ValueError: no numbers please" in capfd.readouterr().err


async def test_on_error_may_be_a_function(node: Node) -> None:
    """It is called within the event too."""
    seen: list[tuple[Exception, CallbackContext]] = []
    subscription = listen(
        node, lambda _: 1 / 0, on_error=lambda error, where: seen.append((error, where))
    )
    await settle()
    bring(subscription, 1)
    ((error, where),) = seen
    assert isinstance(error, ZeroDivisionError)
    assert where.entity is subscription


async def test_a_keyboard_interrupt_goes_through(node: Node) -> None:
    """It ends the program, and no entity may hold it back."""
    heard: list[int] = []

    def callback(msg: Int32) -> None:
        if msg.data == 1:
            raise KeyboardInterrupt
        heard.append(msg.data)

    subscription = listen(node, callback)
    await settle()
    with pytest.raises(KeyboardInterrupt):
        bring(subscription, 1)
    bring(subscription, 2)
    assert heard == [2]


# Awaitable results


async def test_what_a_callback_returns_is_awaited_before_the_next_message(node: Node) -> None:
    """By the consumer, in order."""
    heard: list[str] = []

    async def work(msg: Int32) -> None:
        heard.append(f"begin {msg.data}")
        await checkpoint()
        heard.append(f"end {msg.data}")

    subscription = listen(node, lambda msg: work(msg))  # noqa: PLW0108  # not known to be async
    await settle()
    bring(subscription, 1, 2)
    assert len(reader_of(subscription)) == 1
    await settle()
    assert heard == ["begin 1", "end 1", "begin 2", "end 2"]
    assert subscription.stats.run_time.count == 2


async def test_an_error_of_what_is_awaited_is_one_of_the_callback(node: Node) -> None:
    """Including a foreign cancellation."""
    seen: list[Exception] = []

    def callback(_: Int32) -> Awaitable[None]:
        gone: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        gone.cancel()
        return gone

    subscription = listen(node, callback, on_error=lambda error, _: seen.append(error))
    await settle()
    bring(subscription, 1)
    await settle()
    assert [type(error) for error in seen] == [CallbackCancelledError]


async def test_a_coroutine_that_cannot_be_awaited_any_more_is_closed(node: Node) -> None:
    """A coroutine that never started would be reported by Python, far from its cause."""
    begun: list[int] = []

    async def work(msg: Int32) -> None:
        begun.append(msg.data)

    coroutines: list[Any] = []

    def callback(msg: Int32) -> Awaitable[None]:
        coroutine = work(msg)
        coroutines.append(coroutine)
        return coroutine

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1)
    subscription.destroy()
    await settle()
    gc.collect()
    assert begun == []
    assert [coroutine.cr_frame for coroutine in coroutines] == [None]


async def test_a_future_that_cannot_be_awaited_any_more_is_cancelled(node: Node) -> None:
    """As it would be if the wait had begun."""
    futures: list[asyncio.Future[None]] = []

    def callback(_: Int32) -> Awaitable[None]:
        futures.append(asyncio.get_running_loop().create_future())
        return futures[-1]

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1)
    subscription.destroy()
    await settle()
    assert [future.cancelled() for future in futures] == [True]


# The end


@pytest.mark.parametrize("deadline_ns", [0, None], ids=["in a turn", "inline"])
async def test_a_callback_may_destroy_its_subscription(node: Node, deadline_ns: int | None) -> None:
    """Messages that wait, or that the event still delivers, are not accepted."""
    heard: list[int] = []

    def callback(msg: Int32) -> None:
        heard.append(msg.data)
        node.destroy_subscription(subscription)

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1, 2, inline_deadline_ns=deadline_ns)
    await settle()
    assert heard == [1]


@pytest.mark.parametrize("deadline_ns", [0, None], ids=["in a turn", "inline"])
async def test_an_error_after_destroying_ends_the_node_all_the_same(
    context: Context, deadline_ns: int | None
) -> None:
    """The cancelled consumer still has to raise it."""

    def callback(_: Int32) -> None:
        subscription.destroy()
        raise ValueError("and now this")

    node = Node("node", context=context)
    subscription = listen(node, callback)

    async def transport() -> None:
        await settle()
        bring(subscription, 1, inline_deadline_ns=deadline_ns)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(transport())
        with pytest.raises(ExceptionGroup) as caught:
            await node.run()
    assert caught.group_contains(ValueError, match="and now this")


async def test_a_callback_may_destroy_its_node(node_factory: Callable[..., Node]) -> None:
    """Nothing more is called, and the node ends as if destroyed from outside."""
    heard: list[int] = []
    node = node_factory("brief")

    def callback(msg: Int32) -> None:
        heard.append(msg.data)
        node.destroy_node()

    subscription = listen(node, callback)
    await settle()
    bring(subscription, 1, 2)
    await settle()
    bring(subscription, 3)
    assert heard == [1]
    assert subscription.destroyed


async def test_a_node_that_fails_runs_no_callback(context: Context) -> None:
    """Its consumers are cancelled before its entities are destroyed."""
    heard: list[int] = []
    node = Node("node", context=context)
    subscription = listen(node, lambda msg: heard.append(msg.data))
    failing = node.create_subscription(Int32, "others", lambda _: 1 / 0)

    async def transport() -> None:
        await settle()
        bring(failing, 1)
        await checkpoint()  # the consumer raises
        await checkpoint()  # the task group cancels the others
        bring(subscription, 1)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(transport())
        with pytest.raises(ExceptionGroup):
            await node.run()
    assert heard == []


# Services


async def test_an_idle_service_answers_within_the_event(node: Node) -> None:
    """With the response of a sync handler."""
    service = node.create_service(AddTwoInts, "sums", add)
    await settle()
    request = Asked()
    serve_of(service)(request, perf_ns() + MINUTE_NS)
    assert request.outcome == [5]
    assert service.stats.received == service.stats.run_time.count == 1


async def test_a_handler_of_the_request_alone_answers_within_the_event(node: Node) -> None:
    """Either signature will do."""
    service = node.create_service(
        AddTwoInts, "sums", lambda request: AddTwoInts.Response(sum=request.a)
    )
    await settle()
    request = Asked()
    serve_of(service)(request, perf_ns() + MINUTE_NS)
    assert request.outcome == [2]


async def test_without_a_time_a_request_waits_for_its_turn(node: Node) -> None:
    """The client may be in a callback of the same process."""
    service = node.create_service(AddTwoInts, "sums", add)
    await settle()
    requests = [Asked(), Asked()]
    serve_of(service)(requests[0])
    serve_of(service)(requests[1], perf_ns() + MINUTE_NS)
    assert [request.outcome for request in requests] == [[], []]
    await settle()
    assert [request.outcome for request in requests] == [[5], [5]]


async def test_a_failing_handler_tells_the_client_at_once(node: Node) -> None:
    """A node that continues does so without its consumer."""
    service = node.create_service(AddTwoInts, "sums", fail, on_error="log")
    await settle()
    request = Asked()
    serve_of(service)(request, perf_ns() + MINUTE_NS)
    assert request.outcome == ["ValueError: no sums today"]
    assert service.stats.errors == 1


async def test_a_failing_handler_ends_its_node(context: Context) -> None:
    """Through the consumer, as from the queue, if `on_error` says so."""
    node = Node("node", context=context)
    service = node.create_service(AddTwoInts, "sums", fail, on_error="raise")
    request = Asked()

    async def transport() -> None:
        await settle()
        serve_of(service)(request, perf_ns() + MINUTE_NS)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(transport())
        with pytest.raises(ExceptionGroup) as caught:
            await node.run()
    assert caught.group_contains(ValueError, match="no sums")
    assert request.outcome == ["ValueError: no sums today"]


async def test_a_handler_that_raises_a_cancellation_answers_with_an_error(node: Node) -> None:
    """Its client is not left waiting."""

    def handler(_: AddTwoInts.Request) -> AddTwoInts.Response:
        raise asyncio.CancelledError

    service = node.create_service(AddTwoInts, "sums", handler)
    await settle()
    request = Asked()
    serve_of(service)(request, perf_ns() + MINUTE_NS)
    (outcome,) = request.outcome
    assert str(outcome).startswith("CallbackCancelledError: service /sums")


async def test_what_a_handler_returns_is_awaited(node: Node) -> None:
    """By the consumer, which then answers."""

    async def work(request: AddTwoInts.Request) -> AddTwoInts.Response:
        await checkpoint()
        return AddTwoInts.Response(sum=request.a + request.b)

    service = node.create_service(AddTwoInts, "sums", lambda request: work(request))  # noqa: PLW0108  # not known to be async
    await settle()
    request = Asked()
    serve_of(service)(request, perf_ns() + MINUTE_NS)
    assert request.outcome == []
    await settle()
    assert request.outcome == [5]


async def test_a_request_that_was_given_up_is_not_served(node: Node) -> None:
    """No client waits for the answer."""
    service = node.create_service(AddTwoInts, "sums", add)
    await settle()
    request = Asked()
    request.cancelled = True
    serve_of(service)(request, perf_ns() + MINUTE_NS)
    assert request.outcome == ["dropped"]
    assert service.stats.dropped == 1
