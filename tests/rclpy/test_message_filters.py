"""`message_filters`, as programs of rclpy use it."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from threading import Barrier, Thread
from types import SimpleNamespace
from typing import Any

import pytest

import message_filters
import rclpy
from aionode.clock import ClockType
from rclpy.time import Time
from rosidl_generator_py import message_class
from tests.support.peers import isolated_environment

Header = message_class("std_msgs/msg/Header")
PointStamped = message_class("geometry_msgs/msg/PointStamped")
String = message_class("std_msgs/msg/String")
TimeMsg = message_class("builtin_interfaces/msg/Time")


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A node of rclpy, without other participants."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    rclpy.init(args=[])
    yield rclpy.create_node("filters")
    rclpy.try_shutdown()


def stamped(sec: float) -> Any:
    """A message with a stamp."""
    whole = int(sec)
    stamp = TimeMsg(sec=whole, nanosec=round((sec - whole) * 1e9))
    return PointStamped(header=Header(stamp=stamp))


def collected(filter_: Any) -> list[tuple[Any, ...]]:
    """The list of a filter's output."""
    found: list[tuple[Any, ...]] = []
    filter_.registerCallback(lambda *messages: found.append(messages))
    return found


@pytest.mark.usefixtures("node")
def test_a_stamp_before_1970_is_left_out() -> None:
    """Any node can send one; an exception would end the executor."""
    source = message_filters.SimpleFilter()
    found = collected(message_filters.Cache(source))

    source.signalMessage(PointStamped(header=Header(stamp=TimeMsg(sec=-1))))
    source.signalMessage(stamped(1))

    assert len(found) == 1


def test_messages_of_one_stamp_come_together(node: Any) -> None:
    """From topics, by a subscriber that needs no QoS."""
    inputs = [message_filters.Subscriber(node, PointStamped, name) for name in ("left", "right")]
    found = collected(message_filters.TimeSynchronizer(inputs, 10))
    publishers = [node.create_publisher(PointStamped, name, 10) for name in ("left", "right")]

    for publisher, sec in zip((*publishers, publishers[1]), (2, 1, 2), strict=True):
        publisher.publish(stamped(sec))
    for _ in range(3):
        rclpy.spin_once(node, timeout_sec=5.0)

    assert found == [(stamped(2), stamped(2))]
    assert inputs[0].getTopic() == "left"
    assert inputs[0].topic_name == "/left"
    assert inputs[0].node is node


def test_any_order_of_arrival_gives_the_same_pairs() -> None:
    """As long as the queues are long enough."""
    inputs = [message_filters.SimpleFilter(), message_filters.SimpleFilter()]
    found = collected(message_filters.TimeSynchronizer(inputs, 9))

    for one in inputs:
        for sec in random.Random(0).sample(range(9), 9):  # noqa: S311
            one.signalMessage(stamped(sec))

    assert sorted(left.header.stamp.sec for left, right in found if left == right) == list(range(9))


def test_messages_that_are_near_enough_come_together() -> None:
    """The slop is in seconds, and exclusive."""
    inputs = [message_filters.SimpleFilter(), message_filters.SimpleFilter()]
    found = collected(message_filters.ApproximateTimeSynchronizer(inputs, 5, 0.1))

    for left, right in ((1.0, 1.05), (2.0, 2.1), (3.0, 2.95)):
        inputs[0].signalMessage(stamped(left))
        inputs[1].signalMessage(stamped(right))

    assert found == [(stamped(1.0), stamped(1.05)), (stamped(3.0), stamped(2.95))]


def test_messages_without_a_stamp_have_the_time_of_their_arrival() -> None:
    """If the program allows it; otherwise they are left out."""
    for allowed, count in ((True, 1), (False, 0)):
        inputs = [message_filters.SimpleFilter(), message_filters.SimpleFilter()]
        synchronizer = message_filters.ApproximateTimeSynchronizer(inputs, 5, 60.0, allowed)
        found = collected(synchronizer)

        for one in inputs:
            one.signalMessage(String())

        assert len(found) == count


def test_a_cache_answers_in_times_of_rclpy() -> None:
    """They can be compared with those of a clock."""
    cache = message_filters.Cache(message_filters.SimpleFilter(), 5)
    for sec in range(6):
        cache.add(stamped(sec))

    assert cache.getOldestTime() == Time(seconds=1, clock_type=ClockType.ROS_TIME)
    assert type(cache.getLastestTime()) is Time
    assert len(cache.getInterval(Time(seconds=2), Time(seconds=3.5))) == 2
    assert cache.getElemAfterTime(Time(seconds=2.5)) == stamped(3)
    assert cache.getElemBeforeTime(Time(seconds=2.5)) == stamped(2)
    assert cache.getLast() == stamped(5)


def test_a_stamp_may_be_a_time_of_rclpy() -> None:
    """Programs pass their own messages."""
    cache = message_filters.Cache(message_filters.SimpleFilter(), 5)

    cache.add(SimpleNamespace(header=SimpleNamespace(stamp=Time(seconds=3))))

    assert cache.getLastestTime() == Time(seconds=3)


@pytest.mark.parametrize(
    "make",
    [
        message_filters.TimeSynchronizer,
        lambda inputs, size: message_filters.ApproximateTimeSynchronizer(inputs, size, 0.1),
    ],
)
def test_inputs_in_two_threads_lose_no_pair(make: Callable[..., Any]) -> None:
    """As in the callbacks of a multi-threaded executor."""
    inputs = [message_filters.SimpleFilter(), message_filters.SimpleFilter()]
    found = collected(make(inputs, 500))
    start = Barrier(2)

    def feed(one: Any) -> None:
        start.wait()
        for sec in range(500):
            one.signalMessage(stamped(sec))

    threads = [Thread(target=feed, args=(one,)) for one in inputs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    assert len(found) == 500


def test_a_callback_may_give_the_next_message() -> None:
    """In the same thread, while the synchronizer is at work."""
    inputs = [message_filters.SimpleFilter(), message_filters.SimpleFilter()]
    synchronizer = message_filters.TimeSynchronizer(inputs, 5)
    found = collected(synchronizer)

    def give(left: Any, _: Any) -> None:
        if left == stamped(1):
            for one in inputs:
                one.signalMessage(stamped(2))

    synchronizer.registerCallback(give)

    for one in inputs:
        one.signalMessage(stamped(1))

    assert found == [(stamped(1), stamped(1)), (stamped(2), stamped(2))]
