"""Leases for commands, in one process: who may publish, and when the stop is sent."""

from __future__ import annotations

import asyncio
import gc
import math
import threading
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import suppress
from typing import Any, TypeVar
from weakref import WeakSet

import pytest

from aionode import CommandLease, Context, MessageInfo, Node, Publisher
from aionode.clock import Clock, ROSClock, Time
from aionode.endpoints.lease import send_stops
from aionode.engine.transport.local import LocalTransport
from aionode.engine.wire import cdr
from aionode.errors import (
    EntityDestroyedError,
    EntityInactiveError,
    InvalidQoSProfileException,
    LeaseExpiredError,
    LeaseHeldError,
    MessageError,
)
from aionode.interfaces.std_msgs.msg import Int8, String
from aionode.lifecycle import LifecycleNode
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from aionode.testing import FaultyTransport, ManualClock, local_context, settle
from tests.support.arrivals import reader_of

T = TypeVar("T")

STOP = Int8(data=0)


class Robot:
    """A publisher of commands, and what the wheels received."""

    def __init__(self, clock: ManualClock, context: Context, node: Node) -> None:
        self.clock = clock
        self.context = context
        self.node = node
        self.got: list[int] = []
        self.wheels = Node("wheels", context=context)
        self.wheels.create_subscription(Int8, "speed", lambda msg: self.got.append(msg.data), 100)
        self.speed: Publisher[Int8] = node.create_publisher(Int8, "speed", 100)

    async def took(self) -> list[int]:
        """Return what the wheels have received."""
        await settle()
        return self.got


@pytest.fixture
async def robot() -> AsyncIterator[Robot]:
    """A robot whose time is set by the test."""
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("commander", context=context) as node:
        robot = Robot(clock, context, node)
        async with robot.wheels:
            yield robot


Body = Callable[[CommandLease[Int8]], Coroutine[Any, Any, None]]


async def hold(publisher: Publisher[Int8], body: Body, **options: Any) -> None:
    """Run `body` in a lease."""
    async with publisher.lease(stop=STOP, **options) as lease:
        await body(lease)


def begin(work: Coroutine[Any, Any, T]) -> asyncio.Task[T]:
    """Start a task, whose end the test waits for."""
    return asyncio.get_running_loop().create_task(work)


async def wait(lease: CommandLease[Int8]) -> None:
    """Publish one command, and then nothing."""
    lease.publish(Int8(data=1))
    await asyncio.Event().wait()


# The end of the block


async def test_the_stop_goes_out_when_the_block_ends(robot: Robot) -> None:
    """Once."""
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1))
    assert await robot.took() == [1, 0]


async def test_the_stop_goes_out_without_a_command(robot: Robot) -> None:
    """Taking the right to command includes defining its end."""
    async with robot.speed.lease(stop=STOP):
        pass
    assert await robot.took() == [0]


async def test_the_stop_goes_out_when_the_holder_is_cancelled(robot: Robot) -> None:
    """As when a browser leaves."""
    holder = begin(hold(robot.speed, wait))
    await settle()
    holder.cancel()
    with pytest.raises(asyncio.CancelledError):
        await holder
    assert await robot.took() == [1, 0]


async def test_the_stop_goes_out_when_the_body_fails(robot: Robot) -> None:
    """The error comes out as it is."""

    async def fail(lease: CommandLease[Int8]) -> None:
        lease.publish(Int8(data=1))
        raise KeyError("motor")

    with pytest.raises(KeyError):
        await hold(robot.speed, fail)
    assert await robot.took() == [1, 0]


async def test_the_stop_goes_out_when_the_block_is_thrown_away(robot: Robot) -> None:
    """Its coroutine is closed, so that nothing can be awaited in it."""
    block = hold(robot.speed, wait)
    block.send(None)
    block.close()
    assert await robot.took() == [1, 0]


async def test_a_lease_ends_with_its_block(robot: Robot) -> None:
    """Keeping a reference to it does not help."""
    async with robot.speed.lease(stop=STOP) as lease:
        assert lease.held
    with pytest.raises(LeaseExpiredError, match="its block has ended"):
        lease.publish(Int8(data=1))
    assert "ended" in repr(lease)
    assert await robot.took() == [0]


# The time to live


async def test_a_silent_holder_loses_the_lease(robot: Robot) -> None:
    """First the stop is sent, then the block is cancelled."""
    order: list[object] = []

    async def note(lease: CommandLease[Int8]) -> None:
        try:
            await wait(lease)
        finally:
            order.append(await robot.took())

    holder = begin(hold(robot.speed, note, ttl_sec=0.3))
    await robot.clock.advance(0.299)
    assert await robot.took() == [1]
    await robot.clock.advance(0.001)
    with pytest.raises(LeaseExpiredError, match=r"nothing was published for 0\.3 s"):
        await holder
    assert order == [[1, 0]]


async def test_the_time_to_live_counts_from_the_first_command(robot: Robot) -> None:
    """Before it, nothing moves."""

    async def rest(_: CommandLease[Int8]) -> None:
        await asyncio.Event().wait()

    holder = begin(hold(robot.speed, rest))
    await robot.clock.advance(10)
    assert not holder.done()
    holder.cancel()


async def test_each_command_begins_the_time_to_live_anew(robot: Robot) -> None:
    """A holder that continues to command keeps the lease."""
    async with robot.speed.lease(stop=STOP, ttl_sec=0.3) as lease:
        for number in range(1, 6):
            lease.publish(Int8(data=number))
            await robot.clock.advance(0.29)
    assert await robot.took() == [1, 2, 3, 4, 5, 0]


async def test_a_command_that_comes_too_late_is_not_sent(robot: Robot) -> None:
    """Publishing compares the time itself: the loop may not have noticed yet."""

    async def late(lease: CommandLease[Int8]) -> None:
        lease.publish(Int8(data=1))
        robot.clock.stall(0.3)
        lease.publish(Int8(data=2))

    with pytest.raises(LeaseExpiredError):
        await hold(robot.speed, late, ttl_sec=0.3)
    assert await robot.took() == [1, 0]


class FreezingClock(ManualClock):
    """Time in which a process is frozen once, right after it reads the time.

    Attributes:
        frozen_s: For how long.
        readings: How many readings there are until then; none is counted at 0.
    """

    frozen_s = 5.0
    readings = 0

    def system_ns(self) -> int:
        """Return the time, and perhaps freeze."""
        return self._frozen_after(super().system_ns())

    def steady_ns(self) -> int:
        """Return the time, and perhaps freeze."""
        return self._frozen_after(super().steady_ns())

    def _frozen_after(self, now_ns: int) -> int:
        if self.readings:
            self.readings -= 1
            if not self.readings:
                self.stall(self.frozen_s)
        return now_ns


@pytest.mark.parametrize("readings", [1, 2, 3, 4])
async def test_a_holder_that_is_frozen_while_it_publishes_loses_the_lease(readings: int) -> None:
    """A command in the middle is stamped as from before, so that wheels that stopped ignore it."""
    clock = FreezingClock()
    stamps: list[int] = []

    def turn(msg: Int8, info: MessageInfo) -> None:
        if msg.data:
            stamps.append(info["source_timestamp"])

    async with local_context(clock=clock) as context, Node("commander", context=context) as node:
        node.create_subscription(Int8, "speed", turn, 100)
        speed = node.create_publisher(Int8, "speed", 100)

        async def body(lease: CommandLease[Int8]) -> None:
            lease.publish(Int8(data=1))
            clock.readings = readings
            with suppress(LeaseExpiredError):
                lease.publish(Int8(data=2))
            clock.readings = 0
            assert not lease.held
            lease.publish(Int8(data=3))

        began_ns = clock.system_ns()
        with pytest.raises(LeaseExpiredError):
            await hold(speed, body)
        await settle()
        assert set(stamps) == {began_ns}


async def test_a_holder_that_swallows_the_refusal_is_cancelled(robot: Robot) -> None:
    """Its block ends at the next await."""

    async def stubborn(lease: CommandLease[Int8]) -> None:
        lease.publish(Int8(data=1))
        robot.clock.stall(0.3)
        while True:
            try:
                lease.publish(Int8(data=2))
            except LeaseExpiredError:
                await asyncio.Event().wait()

    with pytest.raises(LeaseExpiredError):
        await hold(robot.speed, stubborn, ttl_sec=0.3)
    assert asyncio.current_task().cancelling() == 0  # type: ignore[union-attr]  # there is one
    assert await robot.took() == [1, 0]


async def test_a_cancellation_of_others_passes(robot: Robot) -> None:
    """It is not mistaken for that of the time to live, even in the same loop iteration."""
    holder = begin(hold(robot.speed, wait, ttl_sec=0.3))
    await robot.clock.advance(0.1)

    def cancel() -> None:
        holder.cancel()

    robot.clock.call_at(robot.clock.steady_ns() + 200_000_000, cancel)
    await robot.clock.advance(0.2)
    with pytest.raises(asyncio.CancelledError):
        await holder
    assert await robot.took() == [1, 0]


async def test_a_timeout_around_the_lease_works(robot: Robot) -> None:
    """Both cancel the block; each raises its own error."""
    with pytest.raises(TimeoutError) as raised:
        async with asyncio.timeout(0.01):
            await hold(robot.speed, wait)
    assert not isinstance(raised.value, LeaseExpiredError)
    assert await robot.took() == [1, 0]


async def test_an_error_of_the_body_is_not_hidden(robot: Robot) -> None:
    """It may say more than that the time is over."""

    async def fail(lease: CommandLease[Int8]) -> None:
        try:
            await wait(lease)
        finally:
            raise KeyError("motor")

    holder = begin(hold(robot.speed, fail, ttl_sec=0.3))
    await robot.clock.advance(0.3)
    with pytest.raises(KeyError):
        await holder


async def test_the_publisher_is_free_after_the_stop(robot: Robot) -> None:
    """A holder that cleans up for long does not prevent the next one from commanding."""
    cleaned = asyncio.Event()

    async def slow(lease: CommandLease[Int8]) -> None:
        try:
            await wait(lease)
        finally:
            await cleaned.wait()

    holder = begin(hold(robot.speed, slow, ttl_sec=0.3))
    await robot.clock.advance(0.3)
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=2))
    cleaned.set()
    with pytest.raises(LeaseExpiredError):
        await holder
    assert await robot.took() == [1, 0, 2, 0]


# Another clock


async def simulated(robot: Robot, clock: Clock) -> asyncio.Task[None]:
    """Begin a lease that counts with `clock`."""
    holder = begin(hold(robot.speed, wait, ttl_sec=0.3, clock=clock))
    await settle()
    return holder


def show(clock: ROSClock, seconds: float) -> None:
    """Set simulated time."""
    clock.set_ros_time_override(Time(nanoseconds=round(seconds * 1e9)))


async def test_simulated_time_counts(robot: Robot) -> None:
    """A slow simulation leaves the holder more time."""
    clock = ROSClock(time_base=robot.clock)
    clock.set_ros_time_active(True)
    holder = await simulated(robot, clock)
    for step in range(29):
        show(clock, step / 100)
        await robot.clock.advance(0.1)
    assert await robot.took() == [1]
    show(clock, 0.3)
    with pytest.raises(LeaseExpiredError):
        await holder
    assert await robot.took() == [1, 0]


async def test_a_clock_that_stands_still_ends_the_lease(robot: Robot) -> None:
    """Its publisher may be lost, and with it the only measure of silence."""
    clock = ROSClock(time_base=robot.clock)
    clock.set_ros_time_active(True)
    holder = await simulated(robot, clock)
    await robot.clock.advance(0.3)
    with pytest.raises(LeaseExpiredError):
        await holder


async def test_a_clock_that_jumps_back_lengthens_nothing(robot: Robot) -> None:
    """Time that has passed has passed, even if a recording starts again."""
    clock = ROSClock(time_base=robot.clock)
    clock.set_ros_time_active(True)
    show(clock, 5)
    holder = await simulated(robot, clock)
    for seconds in (5.2, 1, 1.05):
        show(clock, seconds)
        await robot.clock.advance(0.01)
    assert not holder.done()
    show(clock, 1.1)
    with pytest.raises(LeaseExpiredError):
        await holder


def watching() -> list[threading.Thread]:
    """Return the thread that watches leases, if there is one."""
    return [thread for thread in threading.enumerate() if thread.name == "aionode-lease"]


async def test_a_lease_leaves_its_clock_alone_afterwards(robot: Robot) -> None:
    """A clock lives longer than the leases of a day."""
    clock = robot.node.get_clock()
    leases = WeakSet[CommandLease[Int8]]()

    async def note(lease: CommandLease[Int8]) -> None:
        leases.add(lease)

    for _ in range(3):
        await hold(robot.speed, note, clock=clock)
    for thread in watching():  # its frame may still name the last one
        await asyncio.to_thread(thread.join, 10)
    await robot.clock.advance(1)  # past the cancelled alarms
    gc.collect()
    assert not leases


# What else ends it


async def test_a_destroyed_publisher_sends_the_stop_last(robot: Robot) -> None:
    """Its holder may be anyone, and gets an error when it publishes."""
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1))
        robot.speed.destroy()
        assert await robot.took() == [1, 0]
        with pytest.raises(EntityDestroyedError):
            lease.publish(Int8(data=2))


async def test_a_destroyed_node_sends_the_stop_at_once(robot: Robot) -> None:
    """Its callbacks may take seconds to unwind; the robot must not drive meanwhile."""
    slow = asyncio.Event()

    async def unwind(_: String) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            await slow.wait()

    robot.node.create_subscription(String, "slow", unwind)
    robot.node.create_publisher(String, "slow", 10).publish(String())
    await settle()
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1))
        robot.node.destroy_node()
        assert await robot.took() == [1, 0]
        with pytest.raises(EntityDestroyedError, match="node /commander"):
            lease.publish(Int8(data=2))
    slow.set()


async def test_a_context_that_shuts_down_sends_the_stop(robot: Robot) -> None:
    """It destroys its nodes."""
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1))
        robot.node.create_subscription(Int8, "speed", lambda msg: robot.got.append(msg.data))
        await settle()
        robot.got.clear()
        robot.wheels.destroy_node = lambda: None  # type: ignore[method-assign]  # it listens on
        robot.context.shutdown()
        del robot.wheels.destroy_node
        assert 0 in await robot.took()


@pytest.mark.parametrize("concurrent", [False, True])
async def test_a_node_that_fails_sends_the_stop_at_once(concurrent: bool) -> None:
    """The holder is somebody else's task, and the node's body unwinds slowly."""
    unwound = asyncio.Event()
    got: list[int] = []
    async with local_context() as context, Node("wheels", context=context) as wheels:
        wheels.create_subscription(Int8, "speed", lambda msg: got.append(msg.data), 100)
        node = Node("commander", context=context)
        speed = node.create_publisher(Int8, "speed", 10)

        async def fail(_: String) -> None:
            raise OSError

        async def live() -> None:
            async with node:
                try:
                    await asyncio.Event().wait()
                finally:
                    await unwound.wait()

        node.create_subscription(String, "fail", fail, concurrent=concurrent)
        news = wheels.create_publisher(String, "fail", 10)
        running = begin(live())
        await settle()
        holder = begin(hold(speed, wait, ttl_sec=60))
        await settle()
        news.publish(String())
        await settle()

        assert got == [1, 0]
        assert not holder.done()
        holder.cancel()
        unwound.set()
        with pytest.raises(ExceptionGroup):
            await running


async def test_a_managed_publisher_sends_the_stop_before_it_is_disabled() -> None:
    """A lease is for active nodes."""
    got: list[int] = []
    async with local_context() as context, Node("wheels", context=context) as wheels:
        wheels.create_subscription(Int8, "speed", lambda msg: got.append(msg.data), 100)
        async with LifecycleNode("commander", context=context) as node:
            speed = node.create_lifecycle_publisher(Int8, "speed", 10)
            with pytest.raises(EntityInactiveError):
                await speed.lease(stop=STOP).__aenter__()
            await node.trigger_configure()
            await node.trigger_activate()
            async with speed.lease(stop=STOP) as lease:
                lease.publish(Int8(data=1))
                with pytest.raises(LeaseHeldError):
                    speed.publish(Int8(data=3))
                await node.trigger_deactivate()
                await settle()
                assert got == [1, 0]
                with pytest.raises(EntityInactiveError):
                    lease.publish(Int8(data=2))
            assert speed.discarded == 0


async def test_all_stops_can_be_sent_from_a_thread(robot: Robot) -> None:
    """As for a second Ctrl-C; the leases have expired then."""
    assert not send_stops(0)

    async def wait_for_thread(lease: CommandLease[Int8]) -> None:
        lease.publish(Int8(data=1))
        assert await asyncio.to_thread(send_stops, 0)
        await asyncio.Event().wait()

    with pytest.raises(LeaseExpiredError, match="the process was about to end"):
        await hold(robot.speed, wait_for_thread)
    assert await robot.took() == [1, 0]


# A stop for each command


async def test_the_stop_is_that_of_the_last_command(robot: Robot) -> None:
    """An arm holds the position that it got last; a later change of the object is not sent."""
    async with robot.speed.lease(stop=None) as lease:
        for value in (1, 2):
            command = Int8(data=value)
            lease.publish(command, stop=command)
            command.data = 9
    assert await robot.took() == [1, 2, 2]


async def test_a_stop_remains_until_a_command_brings_another(robot: Robot) -> None:
    """A command without one changes nothing."""
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1), stop=cdr.encode(Int8(data=5)))
        lease.publish(Int8(data=2))
    assert await robot.took() == [1, 2, 5]


async def test_nothing_is_sent_without_a_stop_before_the_first_command(robot: Robot) -> None:
    """Nothing is numbered, so no subscription counts a lost message."""
    async with robot.speed.lease(stop=None):
        await robot.clock.advance(1.0)
    assert await robot.took() == []
    assert robot.speed.stats.published == 0


async def test_a_first_command_without_any_stop_is_refused(robot: Robot) -> None:
    """Nothing could end what it moves."""
    async with robot.speed.lease(stop=None) as lease:
        with pytest.raises(ValueError, match="no stop yet; pass stop="):
            lease.publish(Int8(data=1))
    assert await robot.took() == []


@pytest.mark.parametrize(("data", "stop"), [(300, 3), (3, 300)])
async def test_a_command_that_is_refused_leaves_the_stop_as_it_was(
    robot: Robot, data: int, stop: int
) -> None:
    """Whichever of the two does not fit its field, neither is sent."""
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1), stop=Int8(data=2))
        with pytest.raises(MessageError):
            lease.publish(Int8(data=data), stop=Int8(data=stop))
    assert await robot.took() == [1, 2]


async def test_another_thread_may_bring_the_stop(robot: Robot) -> None:
    """As it may publish."""
    async with robot.speed.lease(stop=None) as lease:
        await asyncio.to_thread(lease.publish, Int8(data=1), Int8(data=2))
    assert await robot.took() == [1, 2]


# Who may publish


async def test_only_the_lease_publishes_while_it_is_held(robot: Robot) -> None:
    """Even with a bound method kept from before; afterwards the publisher works as before."""
    publish = robot.speed.publish
    async with robot.speed.lease(stop=STOP) as lease:
        for _ in range(2):
            with pytest.raises(LeaseHeldError):
                publish(Int8(data=5))
            lease.publish(Int8(data=1))
    publish(Int8(data=2))
    assert await robot.took() == [1, 1, 0, 2]
    assert robot.speed.stats.published == 4


async def test_a_second_lease_is_refused(robot: Robot) -> None:
    """This is known at once, and the first one is not disturbed."""
    async with robot.speed.lease(stop=STOP) as lease:
        with pytest.raises(LeaseHeldError):
            await robot.speed.lease(stop=STOP).__aenter__()
        lease.publish(Int8(data=1))
    assert await robot.took() == [1, 0]


async def test_another_publisher_of_the_topic_is_not_affected(robot: Robot) -> None:
    """There is no arbitration between publishers."""
    other = robot.node.create_publisher(Int8, "speed", 10)
    async with robot.speed.lease(stop=STOP):
        other.publish(Int8(data=7))
        async with other.lease(stop=STOP) as lease:
            lease.publish(Int8(data=8))
    assert await robot.took() == [7, 8, 0, 0]


async def test_a_lease_is_entered_once(robot: Robot) -> None:
    """Each has one stop."""
    lease = robot.speed.lease(stop=STOP)
    with pytest.raises(RuntimeError, match="async with"):
        lease.publish(Int8(data=1))
    async with lease:
        pass
    with pytest.raises(RuntimeError, match="entered once"):
        await lease.__aenter__()
    assert await robot.took() == [0]


async def test_another_thread_may_publish(robot: Robot) -> None:
    """As with `Publisher.publish`."""
    async with robot.speed.lease(stop=STOP) as lease:
        await asyncio.to_thread(lease.publish, Int8(data=1))
    assert await robot.took() == [1, 0]


async def test_a_block_in_another_loop_holds_a_lease(robot: Robot) -> None:
    """A web server's thread; its block is cancelled in its own loop."""
    ended: list[type[BaseException]] = []

    def serve() -> None:
        try:
            asyncio.run(hold(robot.speed, wait, ttl_sec=0.3))
        except LeaseExpiredError as error:
            ended.append(type(error))

    thread = begin(asyncio.to_thread(serve))
    while not robot.got:
        await settle()
    await robot.clock.advance(0.3)
    await thread
    assert ended == [LeaseExpiredError]
    assert await robot.took() == [1, 0]


# The stop itself


async def test_the_stop_is_that_of_the_beginning(robot: Robot) -> None:
    """Changing the object afterwards does not change the stop."""
    stop = Int8(data=3)
    async with robot.speed.lease(stop=stop):
        stop.data = 100
    assert await robot.took() == [3]


async def test_the_stop_may_be_given_as_bytes(robot: Robot) -> None:
    """Published messages may be, too."""
    async with robot.speed.lease(stop=cdr.encode(Int8(data=4))) as lease:
        lease.publish(cdr.encode(Int8(data=5)))
    assert await robot.took() == [5, 4]


@pytest.mark.parametrize(
    ("stop", "error"), [(Int8(data=1000), MessageError), (String(), TypeError)]
)
async def test_a_stop_that_does_not_fit_is_refused_at_the_beginning(
    robot: Robot, stop: Any, error: type[Exception]
) -> None:
    """At the end it would be too late. The publisher is not held."""
    with pytest.raises(error):
        await robot.speed.lease(stop=stop).__aenter__()
    robot.speed.publish(Int8(data=1))
    assert await robot.took() == [1]


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"ttl_sec": 0}, ValueError),
        ({"ttl_sec": -1}, ValueError),
        ({"ttl_sec": math.inf}, ValueError),
        ({"ttl_sec": math.nan}, ValueError),
        ({"ttl_sec": True}, TypeError),
        ({"ttl_sec": "0.3"}, TypeError),
        ({"clock": 3}, TypeError),
    ],
)
async def test_arguments_that_do_not_fit_are_refused(
    robot: Robot, options: Any, error: type[Exception]
) -> None:
    """The error comes where they are given."""
    with pytest.raises(error, match="lease of /speed"):
        robot.speed.lease(stop=STOP, **options)


async def test_a_keep_all_publisher_has_no_leases(robot: Robot) -> None:
    """Its stop might have to wait for a slow reader."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
    with pytest.raises(InvalidQoSProfileException):
        robot.node.create_publisher(Int8, "all", keep_all).lease(stop=STOP)


async def test_a_transient_local_publisher_of_a_lease_keeps_one_message(robot: Robot) -> None:
    """A late subscription would get old commands before the stop."""
    latched = [
        QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL) for depth in (1, 2)
    ]
    one, two = (robot.node.create_publisher(Int8, f"kept{qos.depth}", qos) for qos in latched)

    assert not one.lease(stop=STOP).held
    with pytest.raises(InvalidQoSProfileException, match="needs depth 1 with TRANSIENT_LOCAL"):
        two.lease(stop=STOP)


async def test_a_full_keep_all_subscription_gets_the_stop(robot: Robot) -> None:
    """As soon as it has room, behind the commands that it keeps."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
    reader = robot.node.create_subscription(Int8, "speed", None, keep_all)
    reader_of(reader).depth = 2
    async with robot.speed.lease(stop=STOP) as lease:
        lease.publish(Int8(data=1))
        lease.publish(Int8(data=2))
    got = [(await reader.receive()).data for _ in range(3)]
    assert got == [1, 2, 0]


async def test_a_stop_is_not_held_back_behind_a_message_that_never_comes() -> None:
    """In a network that reorders, it is the last message."""
    transport = FaultyTransport(LocalTransport(), reorder=1.0)
    async with Context(transport=transport) as context, Node("one", context=context) as node:
        reader = node.create_subscription(Int8, "speed", None, 10)
        speed = node.create_publisher(Int8, "speed", 10)
        async with speed.lease(stop=STOP) as lease:
            lease.publish(Int8(data=1))
        assert [(await reader.receive()).data for _ in range(2)] == [1, 0]


async def test_the_watching_thread_exists_only_while_a_lease_is_open(robot: Robot) -> None:
    """A library leaves no thread behind."""
    for ending in watching():  # of the test before
        await asyncio.to_thread(ending.join, 10)
    assert not watching()
    async with robot.speed.lease(stop=STOP):
        other = robot.node.create_publisher(Int8, "other", 10)
        async with other.lease(stop=STOP):
            (thread,) = watching()
        assert thread.is_alive()
    await asyncio.to_thread(thread.join, 10)
    assert not watching()
