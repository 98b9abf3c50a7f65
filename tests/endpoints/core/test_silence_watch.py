"""Subscriptions that stop what they drive when their topic falls silent."""

from __future__ import annotations

import asyncio
import threading
import time  # noqa: TID251  # the loop is blocked in real time
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.clock import ROSClock, SteadyClock, Time
from aionode.endpoints.publisher import Publisher
from aionode.engine.context import Context
from aionode.errors import CallbackSignatureError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.lifecycle import LifecycleNode
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from aionode.testing import ManualClock, local_context, settle
from tests.support.arrivals import reader_of

MACHINE = SteadyClock()

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


@pytest.fixture
def clock(manual_clock: ManualClock) -> ManualClock:
    """The time of the context, stepped by the tests."""
    return manual_clock


@pytest.fixture
async def wheels(node_factory: Callable[..., Node]) -> Node:
    """The node that drives."""
    return node_factory("wheels")


@pytest.fixture
async def teleop(node_factory: Callable[..., Node]) -> Node:
    """A node that commands."""
    return node_factory("teleop")


class Driven:
    """The commands that have reached the wheels: their numbers, and ``stop``."""

    def __init__(self) -> None:
        self.log: list[int | str] = []

    def drive(self, msg: Int32) -> None:
        """Take a command."""
        self.log.append(msg.data)

    def stop(self) -> None:
        """Record a silence."""
        self.log.append("stop")


@pytest.fixture
def driven() -> Driven:
    """A log of commands and stops."""
    return Driven()


def send(publisher: Publisher[Int32], *numbers: int) -> None:
    """Publish commands."""
    for number in numbers:
        publisher.publish(Int32(data=number))


async def logged(caplog: pytest.LogCaptureFixture, text: str) -> None:
    """Wait until the log contains something."""
    async with asyncio.timeout(5):
        while text not in caplog.text:
            await MACHINE.sleep(0.001)


# When it is called


async def test_a_topic_that_falls_silent_stops_the_wheels_once(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """After `silence_sec`, 0.3 by default, however long the silence lasts."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await clock.advance(0.299)
    assert driven.log == [1]
    await clock.advance(0.001)
    assert driven.log == [1, "stop"]
    await clock.advance(100)
    assert driven.log == [1, "stop"]


async def test_nothing_is_stopped_that_was_never_commanded(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """The first message arms it; a publisher that merely exists does not."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    await clock.advance(100)
    publisher.destroy()
    await clock.advance(100)
    assert driven.log == []


async def test_each_message_begins_the_time_anew(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """Whoever sends it: the silence is that of the topic."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=1)
    publishers = [teleop.create_publisher(Int32, "n", 10) for _ in range(2)]
    for number in range(6):
        send(publishers[number % 2], number)
        await clock.advance(0.9)
    assert driven.log == [0, 1, 2, 3, 4, 5]
    await clock.advance(0.1)
    assert driven.log[-1] == "stop"


async def test_the_next_message_arms_it_again(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """`topic pub -r 1` moves the wheels for 0.3 s in each second."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    for number in range(3):
        send(publisher, number)
        await clock.advance(1)
    assert driven.log == [0, "stop", 1, "stop", 2, "stop"]


async def test_a_message_that_a_filter_rejects_is_none(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """It neither arms nor keeps alive: the callback never sees it."""
    subscription = wheels.create_subscription(
        Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=1
    )
    subscription.set_content_filter("data < 10")
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 10)
    await clock.advance(5)
    assert driven.log == []
    send(publisher, 1)
    await clock.advance(0.5)
    send(publisher, 11)
    await clock.advance(0.5)
    assert driven.log == [1, "stop"]


async def test_a_message_that_was_kept_through_a_silence_moves_nothing(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """Its mover may be blocked or frozen, and the wheels have already stopped."""
    publisher = teleop.create_publisher(Int32, "n", LATCHED)
    await clock.advance(1)  # a message without a time counts as published when it arrives
    send(publisher, 1)
    await clock.advance(0.3)
    subscription = wheels.create_subscription(
        Int32, "n", driven.drive, LATCHED, on_silence=driven.stop
    )
    await clock.advance(1)
    assert driven.log == []
    assert subscription.stats.dropped == 1


async def test_a_message_that_was_kept_since_a_moment_arms_it(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """A late joiner gets the last command, and stops `silence_sec` after it."""
    publisher = teleop.create_publisher(Int32, "n", LATCHED)
    await clock.advance(1)  # a message without a time counts as published when it arrives
    send(publisher, 1)
    await clock.advance(0.2)
    wheels.create_subscription(Int32, "n", driven.drive, LATCHED, on_silence=driven.stop)
    await clock.advance(0.299)
    assert driven.log == [1]
    await clock.advance(0.001)
    assert driven.log == [1, "stop"]
    send(publisher, 2)
    await settle()
    assert driven.log == [1, "stop", 2]


# Publishers that leave


async def test_the_end_of_the_last_publisher_stops_at_once(
    wheels: Node, teleop: Node, driven: Driven
) -> None:
    """Nobody is left who could command."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=60)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await settle()
    publisher.destroy()
    await settle()
    assert driven.log == [1, "stop"]


async def test_another_that_was_heard_lately_goes_on(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """It goes on until it has gone as well, or is silent."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=1)
    publishers = [teleop.create_publisher(Int32, "n", 10) for _ in range(2)]
    send(publishers[0], 1)
    await clock.advance(0.5)
    send(publishers[1], 2)
    await settle()
    publishers[1].destroy()
    await settle()
    assert driven.log == [1, 2]
    publishers[0].destroy()
    await settle()
    assert driven.log == [1, 2, "stop"]


async def test_another_that_was_not_heard_lately_does_not_count(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """A publisher that merely exists steers nothing."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=1)
    publishers = [teleop.create_publisher(Int32, "n", 10) for _ in range(3)]
    send(publishers[0], 1)
    await clock.advance(0.9)
    send(publishers[1], 2)
    await clock.advance(0.2)
    publishers[1].destroy()
    await settle()
    assert driven.log == [1, 2, "stop"]


async def test_the_end_of_one_that_is_not_the_newest_is_no_fault(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """The one that steers now is still there."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=1)
    publishers = [teleop.create_publisher(Int32, "n", 10) for _ in range(2)]
    send(publishers[0], 1)
    send(publishers[1], 2)
    await settle()
    publishers[0].destroy()
    await clock.advance(0.99)
    assert driven.log == [1, 2]


async def test_a_publisher_that_is_made_for_one_message_is_heard(
    wheels: Node, teleop: Node, driven: Driven
) -> None:
    """It has gone before its message is handled: the message is handled first, then the stop."""
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=60)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    publisher.destroy()
    await settle()
    assert driven.log == [1, "stop"]


@pytest.mark.parametrize("is_async", [True, False])
async def test_a_callback_may_end_the_last_publisher(
    wheels: Node, teleop: Node, driven: Driven, is_async: bool
) -> None:
    """Anything it would await after that is cancelled, since it is no longer a command."""
    publisher = teleop.create_publisher(Int32, "n", 10)

    async def move() -> None:
        await checkpoint()
        driven.log.append("moved")

    def begin(msg: Int32) -> Awaitable[None] | None:
        driven.drive(msg)
        if msg.data == 1:
            return None
        publisher.destroy()
        return move()

    async def begin_async(msg: Int32) -> None:
        rest = begin(msg)
        if rest is not None:
            await rest

    drive = begin_async if is_async else begin
    wheels.create_subscription(Int32, "n", drive, on_silence=driven.stop, silence_sec=60)
    send(publisher, 1, 2)
    await settle()
    assert driven.log == [1, 2, "stop"]


# Before the stop


async def test_a_running_callback_is_cancelled_first(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """Its `finally` runs before the stop, so that nothing follows the stop."""

    async def drive(msg: Int32) -> None:
        driven.drive(msg)
        try:
            await asyncio.Event().wait()
        finally:
            driven.log.append("cancelled")

    subscription = wheels.create_subscription(Int32, "n", drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1, 2, 3)
    await clock.advance(0.3)
    assert driven.log == [1, "cancelled", "stop"]
    assert subscription.stats.dropped == 2
    send(publisher, 4)
    await clock.advance(0.3)
    assert driven.log[3:] == [4, "cancelled", "stop"]
    assert not wheels.destroyed


@pytest.mark.parametrize("concurrent", [True, 2])
async def test_all_that_run_at_once_are_cancelled(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven, concurrent: bool | int
) -> None:
    """With `concurrent` there may be several."""

    async def drive(msg: Int32) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            for _ in range(5):
                await checkpoint()
            driven.drive(msg)

    wheels.create_subscription(Int32, "n", drive, on_silence=driven.stop, concurrent=concurrent)
    send(teleop.create_publisher(Int32, "n", 10), 1, 2)
    await clock.advance(0.3)
    assert sorted(driven.log[:2]) == [1, 2]
    assert driven.log[2:] == ["stop"]


async def test_messages_keep_the_time_off_while_a_callback_runs(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """They arrive, though they wait: the topic is not silent."""
    go_on = asyncio.Event()

    async def drive(msg: Int32) -> None:
        driven.drive(msg)
        await go_on.wait()

    wheels.create_subscription(Int32, "n", drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    for number in range(5):
        send(publisher, number)
        await clock.advance(0.2)
    go_on.set()
    await settle()
    assert driven.log == [0, 1, 2, 3, 4]


async def test_a_message_counts_from_its_arrival(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """One that has waited for 0.2 s in the queue leaves 0.1 s."""
    go_on = asyncio.Event()

    async def drive(msg: Int32) -> None:
        driven.drive(msg)
        if msg.data == 1:
            await go_on.wait()

    wheels.create_subscription(Int32, "n", drive, on_silence=driven.stop)
    send(teleop.create_publisher(Int32, "n", 10), 1, 2)
    await clock.advance(0.2)
    go_on.set()
    await clock.advance(0.099)
    assert driven.log == [1, 2]
    await clock.advance(0.001)
    assert driven.log == [1, 2, "stop"]


async def test_a_full_queue_that_keeps_all_is_emptied(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """Its publisher, which waits for room, continues."""

    async def drive(msg: Int32) -> None:
        driven.drive(msg)
        await asyncio.Event().wait()

    subscription = wheels.create_subscription(Int32, "n", drive, KEEP_ALL, on_silence=driven.stop)
    reader_of(subscription).depth = 3  # in place of 10,000
    publisher = teleop.create_publisher(Int32, "n", KEEP_ALL)
    send(publisher, 1)
    await settle()
    send(publisher, 2, 3, 4)
    async with asyncio.TaskGroup() as tasks:
        drained = tasks.create_task(publisher.drain())
        await settle()
        assert not drained.done()
        await clock.advance(0.3)
    assert driven.log == [1, "stop"]
    assert subscription.stats.dropped == 3


async def test_a_callback_in_a_thread_is_waited_for(
    caplog: pytest.LogCaptureFixture, node_factory: Callable[..., Node], driven: Driven
) -> None:
    """It cannot be cancelled; the log says so at once."""
    node = node_factory("wheels")
    go_on = threading.Event()

    def drive(msg: Int32) -> None:
        go_on.wait(10)
        driven.drive(msg)

    node.create_subscription(
        Int32, "n", drive, on_silence=driven.stop, silence_sec=0.2, offload=True
    )
    send(node.create_publisher(Int32, "n", 10), 1, 2)
    await logged(caplog, "runs in a thread, which cannot be cancelled")
    assert driven.log == []
    go_on.set()
    await settle()
    assert driven.log == [1, "stop"]


async def test_a_callback_that_does_not_end_is_named(
    caplog: pytest.LogCaptureFixture, node_factory: Callable[..., Node], driven: Driven
) -> None:
    """The stop waits for it, because it could command until it has ended."""
    node = node_factory("wheels")
    go_on = asyncio.Event()

    async def drive(msg: Int32) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            await go_on.wait()
            driven.drive(msg)

    node.create_subscription(Int32, "n", drive, on_silence=driven.stop, silence_sec=0.2)
    send(node.create_publisher(Int32, "n", 10), 1)
    await logged(caplog, "was cancelled and has not ended")
    assert driven.log == []
    go_on.set()
    await settle()
    assert driven.log == [1, "stop"]


# During and after the stop


async def test_an_async_stop_comes_before_later_messages(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """They wait until it has ended; a silence meanwhile calls it once more."""
    go_on = asyncio.Event()

    async def stop() -> None:
        driven.stop()
        await go_on.wait()
        driven.log.append("stopped")

    wheels.create_subscription(Int32, "n", driven.drive, on_silence=stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await clock.advance(0.3)
    send(publisher, 2)
    await clock.advance(0.2)
    assert driven.log == [1, "stop"]
    go_on.set()
    await settle()
    assert driven.log == [1, "stop", "stopped", 2]
    go_on.clear()
    await clock.advance(0.3)
    send(publisher, 3)
    await clock.advance(0.3)
    go_on.set()
    await settle()
    assert driven.log[4:] == ["stop", "stopped", "stop", "stopped"]


async def test_an_error_of_the_stop_ends_the_node(
    aionode_context: Context, clock: ManualClock
) -> None:
    """As with an error of the callback, the robot is in an unknown state."""

    def stop() -> None:
        raise ZeroDivisionError("no brakes")

    node = Node("wheels", context=aionode_context)
    node.create_subscription(Int32, "n", lambda _: None, on_silence=stop)
    send(node.create_publisher(Int32, "n", 10), 1)
    with pytest.raises(ExceptionGroup) as caught:
        await asyncio.gather(node.run(), clock.advance(0.3))
    [error] = caught.value.exceptions
    assert isinstance(error, ZeroDivisionError)
    assert "on_silence" in str(error.__notes__) or "stop" in str(error.__notes__)


async def test_errors_of_the_stop_follow_the_policy(
    wheels: Node, teleop: Node, clock: ManualClock
) -> None:
    """The policy counts them, and its calls are measured like others."""
    errors: list[Exception] = []

    def stop() -> None:
        raise ZeroDivisionError

    subscription = wheels.create_subscription(
        Int32, "n", lambda _: None, on_silence=stop, on_error=lambda error, _: errors.append(error)
    )
    publisher = teleop.create_publisher(Int32, "n", 10)
    for number in range(2):
        send(publisher, number)
        await clock.advance(0.3)
    assert [type(error) for error in errors] == [ZeroDivisionError] * 2
    assert subscription.stats.errors == 2
    assert subscription.stats.received == 2
    assert subscription.stats.run_time.count == 4


async def test_the_end_of_the_node_is_no_silence(
    aionode_context: Context, clock: ManualClock, driven: Driven
) -> None:
    """Callbacks are cancelled as always, and stop what they drive in ``finally``."""

    async def drive(msg: Int32) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            driven.log.append("cancelled")

    async with Node("wheels", context=aionode_context) as node:
        node.create_subscription(Int32, "n", drive, on_silence=driven.stop)
        send(node.create_publisher(Int32, "n", 10), 1)
        await settle()
    await clock.advance(10)
    assert driven.log == ["cancelled"]


async def test_a_destroyed_subscription_is_never_silent(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """This holds even if the alarm has rung, or the publisher is destroyed with it."""
    subscription = wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await settle()
    subscription.destroy()
    publisher.destroy()
    await clock.advance(10)
    assert driven.log == [1]


async def test_messages_of_before_the_start_are_as_new_as_the_node(
    aionode_context: Context, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """A node that was not running could not have handled them: the time starts with it."""
    node = Node("wheels", context=aionode_context)
    node.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    send(teleop.create_publisher(Int32, "n", 10), 1)
    await clock.advance(10)
    assert driven.log == []
    async with node:
        await clock.advance(0.299)
        assert driven.log == [1]
        await clock.advance(0.001)
        assert driven.log == [1, "stop"]


# A reader that was stalled


@pytest.fixture
async def machine_node(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Node]:
    """A node in the time of the machine, which a callback can block."""
    async with Context(transport="local") as context, Node("wheels", context=context) as node:
        yield node


@pytest.mark.parametrize("another_comes", [True, False])
async def test_a_loop_that_stood_still_stops_before_it_handles_what_is_queued(
    machine_node: Node, driven: Driven, another_comes: bool
) -> None:
    """The messages are older than `silence_sec`, and were not commands for now."""
    subscription = machine_node.create_subscription(
        Int32, "n", driven.drive, on_silence=driven.stop, silence_sec=0.5
    )
    publisher = machine_node.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await settle()
    send(publisher, 2, 3)
    time.sleep(0.51)  # noqa: ASYNC251  # as a callback that blocks
    if another_comes:
        send(publisher, 4)
    await settle()
    assert driven.log[:2] == [1, "stop"]
    assert 2 not in driven.log
    assert 3 not in driven.log
    assert subscription.stats.dropped >= 2


async def test_a_loop_that_was_busy_for_less_has_missed_nothing(
    wheels: Node, clock: ManualClock, driven: Driven
) -> None:
    """What it reads late counts from its publication."""
    subscription = wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    began_ns = clock.now().nanoseconds

    def come(number: int, after_s: float) -> None:
        stamp = began_ns + round(after_s * 1e9)
        reader_of(subscription).deliver(Int32(data=number), b"g" * 16, number, stamp)

    come(1, 0)

    def read_soon() -> None:
        asyncio.get_running_loop().call_soon(come, 2, 0.2)

    clock.call_at(began_ns + 3 * 10**8, read_soon)
    await clock.jump(0.4)
    assert driven.log == [1, 2]
    await clock.advance(0.099)
    assert driven.log == [1, 2]
    await clock.advance(0.001)
    assert driven.log == [1, 2, "stop"]


async def test_a_message_that_a_transport_has_held_counts_from_its_arrival(
    wheels: Node, clock: ManualClock, driven: Driven
) -> None:
    """For example until others before it have come."""
    subscription = wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    arrived_ns = clock.now().nanoseconds - 2 * 10**8
    reader_of(subscription).deliver(Int32(), b"g" * 16, 1, arrived_ns, 0, arrived_ns)
    await clock.advance(0.099)
    assert driven.log == [0]
    await clock.advance(0.001)
    assert driven.log == [0, "stop"]


class Suspending(ManualClock):
    """A machine whose steady clock stands still while it is suspended."""

    def __init__(self) -> None:
        super().__init__(Time(seconds=1000))
        self.lasting = ManualClock(Time(seconds=1000))

    def through_suspend(self) -> ManualClock:
        """Return the time that keeps running."""
        return self.lasting


async def test_a_host_that_was_suspended_has_been_silent(driven: Driven) -> None:
    """Its steady clock has stood still, but the world has not."""
    clock = Suspending()
    async with local_context(clock=clock) as context, Node("wheels", context=context) as node:
        node.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
        send(node.create_publisher(Int32, "n", 10), 1)
        await clock.lasting.advance(0.3)
        assert driven.log == [1, "stop"]


# By another clock


async def test_simulated_time_measures_the_silence(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """A simulation at a tenth of the speed has a tenth of the silence; one that stops is silent."""
    simulated = ROSClock(time_base=clock)
    simulated.set_ros_time_active(True)
    simulated.set_ros_time_override(Time(seconds=100))
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, clock=simulated)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    for step in range(1, 11):
        await clock.advance(0.25)
        simulated.set_ros_time_override(Time(seconds=100 + step * 0.025))
    assert driven.log == [1]
    await clock.advance(0.25)
    simulated.set_ros_time_override(Time(seconds=101))
    await settle()
    assert driven.log == [1, "stop"]
    send(publisher, 2)
    await clock.advance(0.3)
    assert driven.log == [1, "stop", 2, "stop"]


async def test_a_message_comes_too_late_after_a_jump_of_simulated_time(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """Only simulated time has passed, and that is what counts."""
    simulated = ROSClock(time_base=clock)
    simulated.set_ros_time_active(True)
    wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, clock=simulated)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await settle()
    simulated.set_ros_time_override(Time(seconds=1))
    send(publisher, 2)
    await settle()
    assert driven.log == [1, "stop"]


async def test_a_clock_of_the_machine_is_the_steady_one(
    wheels: Node, teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """Without a simulation, the node's own clock has no other purpose."""
    for one in (wheels.get_clock(), SteadyClock(time_base=clock)):
        wheels.create_subscription(Int32, "n", driven.drive, on_silence=driven.stop, clock=one)
    send(teleop.create_publisher(Int32, "n", 10), 1)
    await clock.advance(0.3)
    assert driven.log == [1, 1, "stop", "stop"]


# Managed subscriptions


async def test_a_managed_subscription_is_watched_while_active(
    node_factory: Callable[..., Any], teleop: Node, clock: ManualClock, driven: Driven
) -> None:
    """In other states messages are discarded, and whoever deactivates it says what stops."""
    node: LifecycleNode = node_factory(LifecycleNode, "wheels")
    node.create_lifecycle_subscription(Int32, "n", driven.drive, on_silence=driven.stop)
    publisher = teleop.create_publisher(Int32, "n", 10)
    send(publisher, 1)
    await clock.advance(1)
    await node.trigger_configure()
    await node.trigger_activate()
    await clock.advance(1)
    assert driven.log == []
    send(publisher, 2)
    await clock.advance(0.2)
    await node.trigger_deactivate()
    await clock.advance(1)
    send(publisher, 3)
    await clock.advance(1)
    assert driven.log == [2]
    await node.trigger_activate()
    send(publisher, 4)
    await clock.advance(0.3)
    assert driven.log == [2, 4, "stop"]


# Arguments


@pytest.mark.parametrize("silence_sec", [0, -1, float("nan"), float("inf"), 1e-10, 1e300])
def test_a_silence_has_a_length(node: Node, silence_sec: float) -> None:
    """Positive and finite: a watch that never fires, or always, protects nobody."""
    with pytest.raises(ValueError, match=r"silence_sec=.*; it must be positive and finite"):
        node.create_subscription(
            Int32, "n", print, on_silence=lambda: None, silence_sec=silence_sec
        )


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ({"silence_sec": "1"}, "silence_sec='1'; a number of seconds"),
        ({"silence_sec": True}, "silence_sec=True; a number of seconds"),
        ({"clock": 3}, "clock is 3; give a clock"),
        ({"on_silence": 3}, "on_silence: 3 is not callable"),
        ({"on_silence": None, "silence_sec": 1}, "there is no on_silence"),
        ({"on_silence": None, "clock": SteadyClock()}, "there is no on_silence"),
        ({"callback": None}, "there is no callback"),
    ],
)
def test_what_makes_no_silence_is_refused(node: Node, arguments: dict[str, Any], text: str) -> None:
    """Any argument without effect is refused, since someone relies on it."""
    given = {"callback": print, "on_silence": lambda: None} | arguments
    with pytest.raises(TypeError, match=text):
        node.create_subscription(Int32, "n", given.pop("callback"), **given)


def test_what_is_refused_leaves_nothing_behind(node: Node) -> None:
    """A subscription that was never created watches no publisher."""
    with pytest.raises(ValueError, match="silence_sec"):
        node.create_subscription(Int32, "n", print, on_silence=lambda: None, silence_sec=0)
    assert not node.graph._watchers
    assert node.subscriptions == []


def test_a_stop_takes_no_arguments(node: Node) -> None:
    """This is reported when it is given, not when the robot has to stop."""
    with pytest.raises(CallbackSignatureError, match=r"on_silence"):
        node.create_subscription(Int32, "n", print, on_silence=lambda msg: msg)  # type: ignore[misc, arg-type]
