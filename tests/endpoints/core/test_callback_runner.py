"""Around a callback: errors, limits, threads, measurements, fairness."""

from __future__ import annotations

import asyncio
import functools
import os
import pdb  # noqa: T100  # what it looks at is not reported
import re
import sys
import threading
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode._process.processor_waits import ProcessorWaits
from aionode.clock import perf_ns, thread_ns
from aionode.endpoints.core import callback_runner
from aionode.endpoints.core.callback_runner import CallbackContext
from aionode.endpoints.core.thread_time import ThreadTime
from aionode.endpoints.stats import Distribution
from aionode.errors import CallbackCancelledError
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.testing import settle
from tests.support.arrivals import reader_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.endpoints.subscription import Subscription
    from aionode.endpoints.timer import TimerInfo
    from aionode.engine.context import Context


def busy(milliseconds: float) -> None:
    """Keep the loop from running, like a computation."""
    deadline_ns = thread_ns() + round(milliseconds * 1e6)  # time of others is not counted
    while thread_ns() < deadline_ns:
        pass


def listen(node: Node, callback: Any, **options: Any) -> Subscription[Int32]:
    """Return a subscription to numbers, with room for a thousand."""
    return node.create_subscription(Int32, "numbers", callback, 1000, **options)


def send(node: Node, count: int = 1) -> None:
    """Publish the first `count` numbers."""
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(count):
        publisher.publish(Int32(data=number))


# Errors


@pytest.mark.parametrize("kind", ["sync", "async"])
async def test_on_error_log_goes_on_and_shows_the_traceback(
    node: Node, capfd: pytest.CaptureFixture[str], kind: str
) -> None:
    """One bad message does not end the node."""
    heard: list[int] = []

    def sync(msg: Int32) -> None:
        heard.append(msg.data)
        if msg.data == 0:
            raise ValueError("no zero please")

    async def coroutine(msg: Int32) -> None:
        sync(msg)

    subscription = listen(node, sync if kind == "sync" else coroutine, on_error="log")
    send(node, 2)
    await settle()

    assert heard == [0, 1]
    assert subscription.stats.errors == 1
    error = capfd.readouterr().err
    assert "subscription of /numbers (callback" in error
    assert "ValueError: no zero please" in error
    assert "Traceback" in error


async def test_on_error_may_be_a_function(node: Node) -> None:
    """It gets the exception, and where it happened."""
    seen: list[tuple[Exception, CallbackContext]] = []

    def failing(msg: Int32) -> None:
        raise ValueError("boom")

    subscription = listen(node, failing, on_error=lambda exc, where: seen.append((exc, where)))
    send(node)
    await settle()
    ((error, where),) = seen
    assert str(error) == "boom"
    assert where.node == "/node"
    assert where.entity is subscription
    assert "failing" in where.subject


async def test_an_error_function_may_end_the_node(context: Context) -> None:
    """By raising, itself."""

    def escalate(error: Exception, where: CallbackContext) -> None:
        raise RuntimeError("enough") from error

    node = Node("node", context=context)
    listen(node, lambda msg: 1 / 0, on_error=escalate)
    send(node)
    with pytest.raises(ExceptionGroup) as caught:
        await node.run()
    assert caught.group_contains(RuntimeError, match="enough")


async def test_a_cancelled_wait_inside_a_callback_is_an_error_of_the_callback(
    node: Node,
) -> None:
    """A task ended by the cancellation of another would silence its subscription forever."""
    heard: list[int] = []
    seen: list[Exception] = []

    async def callback(msg: Int32) -> None:
        heard.append(msg.data)
        gone: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        gone.cancel()
        await gone

    listen(node, callback, on_error=lambda exc, where: seen.append(exc))
    send(node, 2)
    await settle()
    assert heard == [0, 1]
    assert [type(error) for error in seen] == [CallbackCancelledError] * 2


async def test_a_callback_may_use_asyncio_timeout(node: Node) -> None:
    """The measuring lets cancellation through as asyncio means it."""
    seen: list[str] = []

    async def callback(msg: Int32) -> None:
        try:
            async with asyncio.timeout(0):
                await asyncio.Event().wait()
        except TimeoutError:
            seen.append("timeout")

    listen(node, callback)
    send(node)
    await settle()
    assert seen == ["timeout"]


async def test_a_function_that_returns_a_coroutine_is_awaited(node: Node) -> None:
    """A lambda or partial around a coroutine function is not forgotten."""
    heard: list[int] = []

    async def work(msg: Int32) -> None:
        await checkpoint()
        heard.append(msg.data)

    listen(node, functools.partial(work))
    send(node)
    await settle()
    assert heard == [0]


# Concurrency


@pytest.mark.parametrize(("concurrent", "at_once"), [(False, 1), (2, 2), (True, 5)])
async def test_at_most_the_given_number_of_callbacks_runs_at_once(
    node: Node, *, concurrent: bool | int, at_once: int
) -> None:
    """The others wait in the queue, bounded and in order."""
    running: list[int] = []
    gate = asyncio.Event()

    async def callback(msg: Int32) -> None:
        running.append(msg.data)
        await gate.wait()

    subscription = listen(node, callback, concurrent=concurrent)
    send(node, 5)
    await settle()
    assert running == list(range(at_once))
    gate.set()
    await settle()
    assert running == list(range(5))
    assert subscription.stats.received == 5


async def test_a_limited_subscription_drops_in_its_queue(node: Node) -> None:
    """What cannot run yet is bounded by the profile, not by memory."""
    gate = asyncio.Event()

    async def callback(msg: Int32) -> None:
        await gate.wait()

    subscription = node.create_subscription(Int32, "numbers", callback, 3, concurrent=2)
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in range(10):
        publisher.publish(Int32(data=number))
        await settle()
    assert subscription.stats.dropped == 10 - 2 - 3
    gate.set()


# Threads


async def test_offload_runs_a_sync_callback_in_a_thread(node: Node) -> None:
    """The loop stays free while it works."""
    threads: list[threading.Thread] = []
    subscription = listen(
        node, lambda msg: threads.append(threading.current_thread()), offload=True
    )
    send(node)
    await settle()
    assert threads[0] is not threading.main_thread()
    assert subscription.stats.run_time.count == 1
    assert subscription.stats.blocking.max_ns == 0


async def test_offloaded_errors_reach_the_policy(node: Node) -> None:
    """As from any callback."""
    subscription = listen(node, lambda msg: 1 / 0, offload=True, on_error="log")
    send(node)
    await settle()
    assert subscription.stats.errors == 1


async def test_a_coroutine_function_cannot_be_offloaded(node: Node) -> None:
    """Its place is the loop."""

    async def callback(msg: Int32) -> None: ...

    with pytest.raises(ValueError, match=r"await asyncio\.to_thread"):
        listen(node, callback, offload=True)


# Measurements


async def test_a_callback_that_blocks_the_loop_is_reported_once_a_second(
    context: Context, capfd: pytest.CaptureFixture[str]
) -> None:
    """With its name, its topic, the duration, and a remedy."""

    def slow_callback(msg: Int32) -> None:
        busy(3)

    async with Node("node", context=context, callback_budget_ms=2) as node:
        listen(node, slow_callback)
        send(node, 3)
        await settle()

    lines = [line for line in capfd.readouterr().err.splitlines() if "blocked" in line]
    assert len(lines) == 1
    for part in ("slow_callback", "/numbers", "budget 2 ms", "offload=True", "[WARN]", "[node]"):
        assert part in lines[0]


@pytest.mark.parametrize("kind", ["sync", "async"])
@pytest.mark.parametrize(
    ("load", "waited_ns", "said"),
    [
        (
            0.5,
            0,
            r"Its thread ran for 0\.0 ms and waited for the rest \(a lock, I/O or a sleep\)\. ",
        ),
        (
            99.0,
            0,
            r"Its thread ran for 0\.0 ms and waited for the rest \(a lock, I/O or a sleep\)\. ",
        ),
        (
            99.0,
            None,
            r"sleep, or for a processor: the load is 99\.0 on \d+ cores\)\. Move the work",
        ),
    ],
)
async def test_a_report_says_if_the_thread_did_not_run(
    context: Context,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
    load: float,
    waited_ns: int | None,
    said: str,
) -> None:
    """Where the system does not say who kept it from running, the load is a hint."""
    monkeypatch.setattr("os.getloadavg", lambda: (load, load, load))
    monkeypatch.setattr("aionode.endpoints.core.thread_time.thread_waited_ns", lambda: waited_ns)
    # What the test itself runs before the callback would count: there was no callback before it.
    monkeypatch.setattr("aionode.endpoints.core.thread_time.thread_ns", lambda: 0)

    def wait(msg: Int32) -> None:
        threading.Event().wait(0.02)

    async def wait_async(msg: Int32) -> None:
        wait(msg)

    async with Node("node", context=context, callback_budget_ms=10) as node:
        listen(node, wait if kind == "sync" else wait_async)
        send(node)
        await settle()

    assert re.search(said, capfd.readouterr().err)


@pytest.fixture
def processor(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """How long the thread has waited for a processor, set by the test, and the counts."""
    now = SimpleNamespace(waited_ns=0, waits=ProcessorWaits())
    monkeypatch.setattr(
        "aionode.endpoints.core.thread_time.thread_waited_ns", lambda: now.waited_ns
    )
    monkeypatch.setattr(callback_runner, "WAITS", now.waits)
    return now


@pytest.mark.usefixtures("high_load")
@pytest.mark.parametrize("kind", ["sync", "async"])
async def test_a_wait_for_a_processor_is_counted_and_not_reported_as_blocking(
    context: Context, caplog: pytest.LogCaptureFixture, processor: SimpleNamespace, kind: str
) -> None:
    """Work moved off the loop would wait as well; so few milliseconds are worth no line."""

    def starved(msg: Int32) -> None:
        threading.Event().wait(0.03)
        processor.waited_ns += 1_000_000_000  # more than it can take here

    async def starved_async(msg: Int32) -> None:
        starved(msg)

    async with Node("node", context=context, callback_budget_ms=10) as node:
        listen(node, starved if kind == "sync" else starved_async)
        send(node, 3)
        await settle()

    assert "blocked" not in caplog.text
    assert processor.waits.count == 3
    assert processor.waits.total_ns >= 90e6
    assert "wait for a processor" not in caplog.text


async def test_a_sleep_beside_a_wait_for_a_processor_is_reported(
    context: Context, capfd: pytest.CaptureFixture[str], processor: SimpleNamespace
) -> None:
    """The figure only contains what the program can fix."""

    def sleepy(msg: Int32) -> None:
        began_ns = perf_ns()
        threading.Event().wait(0.2)
        processor.waited_ns += perf_ns() - began_ns - 40_000_000

    async with Node("node", context=context, callback_budget_ms=10) as node:
        listen(node, sleepy)
        send(node)
        await settle()

    found = re.search(r"blocked the event loop for (\d+\.\d) ms", capfd.readouterr().err)
    assert found is not None
    assert 30 < float(found[1]) < 150  # a busy machine adds to it


@pytest.fixture
def high_load(monkeypatch: pytest.MonkeyPatch) -> None:
    """Raise the load of the machine beyond what its cores can handle."""
    monkeypatch.setattr(os, "getloadavg", lambda: (1000.0, 0.0, 0.0))


@pytest.mark.usefixtures("high_load")
def test_waits_are_reported_once_a_minute(caplog: pytest.LogCaptureFixture) -> None:
    """Including everything since the last line, and not before it is a hundredth of a minute."""
    waits = ProcessorWaits()

    for second in range(90):
        waits.note(20_000_000, second * 1_000_000_000)

    first, second_line = [text for text in caplog.messages if "wait for a processor" in text]
    assert ": 30 since the last such line, 600 ms in all; the load is 1000.0 on" in first
    assert ": 60 since the last such line, 1200 ms in all" in second_line
    assert (waits.count, waits.longest_ns) == (90, 20_000_000)


def test_short_waits_are_not_reported(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Many or long ones are, also at a low load: a process may be bound to a busy core."""
    monkeypatch.setattr(os, "getloadavg", lambda: (0.5, 0.0, 0.0))
    waits = ProcessorWaits()

    for minute in range(5):
        waits.note(20_000_000, minute * 60_000_000_000)
    assert not caplog.messages
    waits.note(600_000_000, 300_000_000_000)

    (line,) = caplog.messages
    assert ": 6 since the last such line, 700 ms in all; the load is 0.5 on" in line
    assert "more than they can run" not in line


def test_a_callback_that_somebody_debugs_is_not_reported() -> None:
    """The developer knows that it stands still."""

    class Debugger(pdb.Pdb):
        def trace(self, *_: object) -> None:
            pass

    before = sys.gettrace()
    sys.settrace(Debugger().trace)
    try:
        is_debugged = callback_runner.is_debugged(20_000_000, 19_000_000)
    finally:
        sys.settrace(before)

    assert is_debugged


def test_a_long_stop_at_a_breakpoint_is_taken_for_one() -> None:
    """After the debugger has let the program continue, only the time shows it."""
    assert callback_runner.is_debugged(5_000_000_000, 1_000_000)
    assert not callback_runner.is_debugged(5_000_000_000, 4_900_000_000)
    assert not callback_runner.is_debugged(50_000_000, 1_000_000)


async def test_a_report_of_a_computation_does_not_speak_of_waiting() -> None:
    """It had the processor: only moving the work helps; nor does one without a reading."""
    assert callback_runner.advice(10_000_000, 9_000_000).startswith("Move the work off the loop")
    assert callback_runner.advice(10_000_000, None).startswith("Move the work off the loop")


def test_a_reading_of_another_thread_says_nothing() -> None:
    """A node may be created in one thread and run in another."""
    readings: list[ThreadTime] = []
    thread = threading.Thread(target=lambda: readings.append(ThreadTime()))
    thread.start()
    thread.join()
    assert readings[0].ran_ns() is None
    readings[0].read(perf_ns())
    assert readings[0].ran_ns() is not None


async def test_an_async_callback_is_measured_between_its_waits(
    context: Context, capfd: pytest.CaptureFixture[str]
) -> None:
    """Waiting is not blocking: only the longest stretch counts."""

    async def callback(msg: Int32) -> None:
        busy(1)
        await checkpoint()
        busy(4)
        await checkpoint()

    async with Node("node", context=context, callback_budget_ms=1000) as node:
        subscription = listen(node, callback)
        send(node)
        await settle()
    stats = subscription.stats
    assert 4e6 <= stats.blocking.max_ns <= stats.run_time.max_ns
    assert stats.run_time.max_ns >= 5e6
    assert "blocked" not in capfd.readouterr().err


async def test_queue_wait_is_the_time_between_arrival_and_callback(node: Node) -> None:
    """The time that a message waits while an earlier one is processed."""
    subscription = listen(node, lambda msg: busy(2))
    send(node, 2)
    await settle()
    assert subscription.stats.queue_wait.count == 2
    assert subscription.stats.queue_wait.max_ns >= 2e6


@pytest.mark.parametrize("value", [0, 1, 15, 16, 17, 1000, 123_456_789, 10**12])
def test_percentiles_are_within_three_percent(value: int) -> None:
    """A distribution of one value is that value."""
    distribution = Distribution()
    distribution.record(value)
    assert distribution.max_ns == value
    assert distribution.p50_ns == pytest.approx(value, rel=0.035, abs=1)


def test_percentiles_of_a_spread() -> None:
    """The median is in the middle, p99 near the top, and memory does not grow with the count."""
    distribution = Distribution()
    for value in range(1, 100_001):
        distribution.record(value)
    assert distribution.count == 100_000
    assert distribution.p50_ns == pytest.approx(50_000, rel=0.04)
    assert distribution.p99_ns == pytest.approx(99_000, rel=0.04)
    assert len(distribution._buckets) < 300  # what grows is the subject


def test_an_empty_distribution_is_zero() -> None:
    """It can be printed before anything happened."""
    assert "count=0, p50_ns=0, p99_ns=0, max_ns=0" in repr(Distribution())


# Fairness


async def test_a_full_queue_lets_others_run_in_between(node: Node) -> None:
    """A callback that is always ready does not occupy the loop."""
    order: list[str] = []
    reader_of(listen(node, lambda msg: order.append("topic"))).slice_ns = 0
    send(node, 10)

    async def other() -> None:
        for _ in range(5):
            await checkpoint()
            order.append("other")

    await other()
    await settle()
    first_half = order[:8]
    assert "topic" in first_half
    assert first_half.count("other") >= 2


async def test_a_reader_of_a_full_queue_lets_others_run(node: Node) -> None:
    """An `async for` whose body never waits would otherwise keep the loop."""
    reader = node.create_subscription(Int32, "numbers", qos_profile=2000)
    send(node, 1000)
    turns = 0

    async def other() -> None:
        nonlocal turns
        while True:
            await checkpoint()
            turns += 1

    task = asyncio.get_running_loop().create_task(other())
    for _ in range(1000):
        await reader.receive()
        busy(0.02)
    task.cancel()
    assert turns >= 5


async def test_a_flooded_subscription_does_not_starve_a_timer(context: Context) -> None:
    """A 10 ms timer keeps firing beside a topic that is faster than its sync callback.

    Each call of the timer may wait for the callback that runs when it becomes due, and for one more
    iteration of the loop with its slice of the queue. Counted in callbacks and not in milliseconds:
    on a busy machine callbacks take longer, but no more of them come first, and no more of them fit
    into the 10 ms between two calls, none of which is left out.
    """
    done = asyncio.Event()
    begun_ns: list[int] = []
    came_first: list[int] = []
    came_between: list[int] = []
    sent = 0

    async with Node("node", context=context) as node:
        clock = node.get_clock()
        publisher = node.create_publisher(String, "flood", 10)

        def slow(msg: String) -> None:
            begun_ns.append(clock.now().nanoseconds)
            busy(1.5)

        def tick(info: TimerInfo) -> None:
            due_ns = info.expected_call_time.nanoseconds
            came_first.append(sum(each > due_ns for each in begun_ns))
            came_between.append(len(begun_ns))
            begun_ns.clear()
            if len(came_first) == 20:
                done.set()

        async def flood() -> None:
            nonlocal sent
            while not done.is_set():
                for _ in range(5):
                    publisher.publish(String())
                    sent += 1
                await checkpoint()

        subscription = node.create_subscription(String, "flood", slow, 10)
        node.create_timer(0.01, tick)
        await flood()
        await settle()
        stats = subscription.stats

    assert stats.received + stats.dropped == sent
    assert stats.dropped > 0
    assert max(came_first) <= 2
    assert max(came_between) <= 10 / 1.5 + 2


def test_callbacks_take_their_arguments_by_position() -> None:
    """Keyword-only parameters do not count."""

    def callback(msg: object, *, extra: int = 0) -> None: ...

    chosen: Callable[..., int] = callback_runner.accepts
    assert chosen(callback, 1, 2, subject="x", wanted="(message)") == 1


class _Forms:
    """Functions of every form, as methods."""

    def plain(self, one: object) -> None: ...
    def default(self, one: object, two: object = None) -> None: ...
    def positional(self, one: object, /) -> None: ...
    def any_number(self, *more: object) -> None: ...
    def keyword(self, one: object, *, two: object = None) -> None: ...
    def required(self, one: object, *, two: object) -> None: ...
    def nothing(self) -> None: ...


@pytest.mark.parametrize("form", [name for name in vars(_Forms) if not name.startswith("_")])
@pytest.mark.parametrize("bound", [True, False])
def test_what_a_function_accepts_is_what_its_signature_says(form: str, bound: bool) -> None:
    """Most functions are looked at without making a signature, which takes 20 times as long."""
    callback = getattr(_Forms() if bound else _Forms, form)

    def call(*_: object, **__: object) -> None: ...

    # A wrapper with the signature of the function, which is looked at by its signature only.
    wrapper = functools.update_wrapper(call, callback)

    def found(callback: Callable[..., object]) -> int | None:
        try:
            return callback_runner.accepts(callback, 2, 1, subject="it", wanted="(one)")
        except TypeError:
            return None

    assert found(callback) == found(wrapper)
