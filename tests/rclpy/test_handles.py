"""Handles and the wake-ups of threads: used by several threads, and by signal handlers."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest

import rclpy
from aionode.interfaces.rcl_interfaces.srv import ListParameters
from aionode.interfaces.std_msgs.msg import Int32
from aionode.message import SerializedMessage
from rclpy._impl import destroyable
from rclpy._impl.destroyable import Destroyable, Signal, Wakeup
from rclpy._impl.errors import InvalidHandle
from rclpy.qos import HistoryPolicy, QoSProfile
from tests.support.peers import isolated_environment

TIMES = 20_000

pytestmark = pytest.mark.timeout(60)


@pytest.fixture
def small_queues(monkeypatch: pytest.MonkeyPatch) -> None:
    """Limit what waits in contexts created from now on."""
    monkeypatch.setenv("AIONODE_QUEUE_BYTES", "65536")


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> Iterator[rclpy.Context]:
    """An isolated context."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    context = rclpy.Context()
    rclpy.init(args=[], context=context)
    yield context
    context.try_shutdown()


@contextmanager
def hasty_threads() -> Iterator[None]:
    """Switch threads after nearly each bytecode."""
    interval_s = sys.getswitchinterval()
    sys.setswitchinterval(1e-7)
    try:
        yield
    finally:
        sys.setswitchinterval(interval_s)


def at_once(*works: Callable[[], object]) -> None:
    """Run functions in threads, each many times."""

    def repeat(work: Callable[[], object]) -> None:
        for _ in range(TIMES):
            work()

    threads = [threading.Thread(target=repeat, args=(work,)) for work in works]
    with hasty_threads():
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()


def test_a_signal_loses_no_update_of_another_thread() -> None:
    """An executor whose wake-up is lost would never wake again."""
    signal = Signal()
    mine, others = Wakeup(), [Wakeup() for _ in range(3)]

    def add_and_remove(wakeup: Wakeup) -> None:
        signal.add(wakeup)
        signal.remove(wakeup)

    signal.add(mine)
    at_once(*[lambda each=each: add_and_remove(each) for each in others])

    assert list(signal._wakeups) == [mine]


def test_a_handle_is_destroyed_once_by_its_last_user() -> None:
    """Whether a thread, or a signal handler that interrupts one, requests it."""
    destroyed: list[str] = []

    class Handle(Destroyable):
        def _destroy(self) -> None:
            destroyed.append("destroyed")

    handle = Handle()
    with handle:
        with handle:
            handle.destroy_when_not_in_use()
        assert not destroyed
    handle.destroy_when_not_in_use()

    assert destroyed == ["destroyed"]
    with pytest.raises(InvalidHandle), handle:
        pass
    assert destroyed == ["destroyed"]


def test_a_long_wait_consists_of_several(monkeypatch: pytest.MonkeyPatch) -> None:
    """One wait of the system is limited; that of the program does not end earlier because of it."""
    monkeypatch.setattr(destroyable, "MAX_WAIT_S", 0.001)
    wakeup = Wakeup()
    threading.Timer(0.05, wakeup.wake).start()

    assert wakeup.wait(10.0)


def test_timers_and_time_limits_of_months_can_be_waited_for(context: rclpy.Context) -> None:
    """Systems refuse waits of more than 24 days in one piece."""
    node = rclpy.create_node("patient", context=context)
    executor = rclpy.executors.SingleThreadedExecutor(context=context)
    executor.add_node(node)
    node.create_timer(30 * 86400.0, lambda: None)
    for timeout_sec in (None, 3e6):
        done: rclpy.Future[None] = rclpy.Future()
        threading.Timer(0.05, done.set_result, [None]).start()

        executor.spin_until_future_complete(done, timeout_sec)
        assert done.done()
    threading.Timer(0.05, executor.create_task, [lambda: None]).start()
    executor.spin_once(timeout_sec=3e6)


def test_subscriptions_come_and_go_while_another_thread_publishes(context: rclpy.Context) -> None:
    """The publisher checks each of them, and one that keeps all messages has to have room."""
    node = rclpy.create_node("changing", context=context)
    publisher = node.create_publisher(Int32, "numbers", 10)
    profile = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    stop = threading.Event()
    failures: list[BaseException] = []

    def change() -> None:
        while not stop.is_set():
            made = [node.create_subscription(Int32, "numbers", lambda _: None, profile)]
            made += [node.create_subscription(Int32, "numbers", lambda _: None, profile)]
            for each in made:
                node.destroy_subscription(each)

    def publish() -> None:
        try:
            for _ in range(TIMES // 4):
                publisher.publish(Int32())
        except RuntimeError as error:
            failures.append(error)

    changing = threading.Thread(target=change)
    publishing = threading.Thread(target=publish)
    with hasty_threads():
        changing.start()
        publishing.start()
        publishing.join()
        stop.set()
        changing.join()

    assert failures == []


def test_who_waits_for_room_learns_of_room_that_was_made_before(context: rclpy.Context) -> None:
    """The program may take the last message between the check and the wait, in its own thread."""
    node = rclpy.create_node("full", context=context)
    profile = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    subscription = node.create_subscription(Int32, "numbers", lambda _: None, profile)
    told = threading.Event()
    io = subscription.handle.io

    io.post(lambda: subscription.handle.inbox.when_room(told.set))

    assert told.wait(10.0)


@pytest.mark.usefixtures("small_queues")
def test_the_log_says_once_that_messages_for_a_subscription_are_too_large_together(
    context: rclpy.Context, caplog: pytest.LogCaptureFixture
) -> None:
    """Otherwise nobody learns why messages are missing that the depth would hold."""
    node = rclpy.create_node("node", context=context)
    handle = node.create_subscription(Int32, "heavy", print, 100).handle

    for sequence in range(1, 6):
        handle.inbox.deliver(SerializedMessage(bytes(40_000)), bytes(16), sequence, 0)
    handle.io.call(lambda: None)

    (line,) = [each for each in caplog.messages if "AIONODE_QUEUE_BYTES" in each]
    assert line.startswith("/heavy: over 0.0625 MiB wait")


@pytest.mark.usefixtures("small_queues")
def test_the_log_says_once_that_requests_for_a_service_are_too_large_together(
    context: rclpy.Context, caplog: pytest.LogCaptureFixture
) -> None:
    """As for messages; the clients of the oldest ones are told that these were dropped."""
    node = rclpy.create_node("node", context=context)
    handle: Any = node.create_service(ListParameters, "heavy", print).handle
    dropped: list[int] = []

    for number in range(5):
        message = SimpleNamespace(data=bytes(40_000))
        drop = partial(dropped.append, number)
        handle._requests.serve(SimpleNamespace(message=message, drop=drop))

    (line,) = [each for each in caplog.messages if "AIONODE_QUEUE_BYTES" in each]
    assert line.startswith("/heavy: over 0.0625 MiB wait")
    assert dropped == [0, 1, 2, 3]
