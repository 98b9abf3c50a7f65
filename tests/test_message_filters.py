"""Messages of several topics that belong together."""

from __future__ import annotations

import asyncio
import math
import random
from functools import partial
from itertools import product
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Node, Time
from aionode.interfaces.geometry_msgs.msg import PointStamped
from aionode.interfaces.std_msgs.msg import String
from aionode.logging import get_logger
from aionode.message_filters import (
    ApproximateMatcher,
    ApproximateTimeSynchronizer,
    Cache,
    Chain,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
    synchronize,
)
from aionode.testing import settle


def stamped(sec: float) -> PointStamped:
    """Return a message with a stamp, in seconds."""
    message = PointStamped()
    message.header.stamp = Time(nanoseconds=round(sec * 1e9)).to_msg()
    return message


def pairs_of(
    kind: type[TimeSynchronizer], *args: Any
) -> tuple[SimpleFilter, SimpleFilter, list[Any]]:
    """Return two inputs, and the list of what a synchronizer calls back with."""
    left, right = SimpleFilter(), SimpleFilter()
    found: list[Any] = []
    kind([left, right], *args).registerCallback(lambda a, b: found.append((a, b)))
    return left, right, found


def test_equal_stamps_belong_together() -> None:
    """In whichever order they come."""
    left, right, found = pairs_of(TimeSynchronizer, 10)
    one, two = stamped(1), stamped(1)
    right.signalMessage(two)
    left.signalMessage(stamped(0.5))
    left.signalMessage(one)

    assert found == [(one, two)]


def test_scrambled_sequences_are_put_together() -> None:
    """As in ROS 2's own test, each message meets the one with its stamp."""
    left, right, found = pairs_of(ApproximateTimeSynchronizer, 9, 0.1)
    lefts, rights = [stamped(t) for t in range(9)], [stamped(t) for t in range(9)]
    rng = random.Random(0)  # noqa: S311  # a test
    for message in rng.sample(lefts, 9):
        left.signalMessage(message)
    for message in rng.sample(rights, 9):
        right.signalMessage(message)

    stamps = sorted((a.header.stamp.sec, b.header.stamp.sec) for a, b in found)
    assert stamps == [(t, t) for t in range(9)]


def test_the_closest_stamps_are_taken() -> None:
    """0.92 is nearer to 1.0 than 1.09."""
    left, right, found = pairs_of(ApproximateTimeSynchronizer, 10, 0.1)
    near = stamped(0.95)
    for message in (stamped(1.09), near):
        left.signalMessage(message)
    arrival = stamped(1.0)
    right.signalMessage(arrival)

    assert found == [(near, arrival)]


def test_stamps_beyond_the_slop_wait() -> None:
    """They wait until they are pushed out, and counted."""
    left, right = SimpleFilter(), SimpleFilter()
    pairs = ApproximateTimeSynchronizer([left, right], 2, 0.1)
    for t in range(5):
        left.signalMessage(stamped(t))
    right.signalMessage(stamped(10))

    assert pairs.dropped == 3


def test_a_slop_of_zero_pairs_equal_stamps() -> None:
    """It would pair nothing, without a word."""
    left, right, found = pairs_of(ApproximateTimeSynchronizer, 10, 0.0)
    one, two = stamped(1), stamped(1)
    left.signalMessage(one)
    right.signalMessage(stamped(1.000000001))
    right.signalMessage(two)

    assert found == [(one, two)]


@pytest.mark.parametrize("slop", [-0.1, math.nan, math.inf])
def test_a_slop_that_is_no_duration_is_refused(slop: float) -> None:
    """A negative one would pair nothing either."""
    with pytest.raises(ValueError, match=r"slop=.*; it must be 0 or more seconds"):
        ApproximateTimeSynchronizer([SimpleFilter(), SimpleFilter()], 10, slop)


async def test_the_log_names_the_callback_behind_filters(node: Node) -> None:
    """A warning about `SimpleFilter.signalMessage` does not say what to look at."""

    def on_pair(left: PointStamped, right: PointStamped, _tag: str) -> None:
        raise ValueError((left, right))

    left = Subscriber(node, PointStamped, "left")
    right = Subscriber(node, PointStamped, "right")
    TimeSynchronizer([Cache(left), right], 10).registerCallback(partial(on_pair, _tag="a"))

    for each in (left, right):
        name = f"(callback {on_pair.__qualname__})"
        runner = each.sub._runner
        assert runner is not None
        assert runner.subject == f"subscription of {each.sub.topic_name} {name}"


def test_a_message_without_a_header_can_count_with_its_arrival() -> None:
    """If that is asked for; else it is left out."""
    left, right, found = pairs_of(ApproximateTimeSynchronizer, 10, 10.0, True)
    left.signalMessage(String(data="a"))
    right.signalMessage(String(data="b"))
    assert len(found) == 1

    left, right, found = pairs_of(ApproximateTimeSynchronizer, 10, 10.0)
    left.signalMessage(String(data="a"))
    right.signalMessage(String(data="b"))
    assert found == []


def test_a_stamp_before_1970_is_left_out_and_ends_nothing(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Any node can send one; an exception would end the node that listens."""
    own = get_logger("message_filters")  # another test may have made the module's say so once
    monkeypatch.setattr("aionode.message_filters.logger", own)
    left, right, found = pairs_of(TimeSynchronizer, 10)
    wrong = stamped(1)
    wrong.header.stamp.sec = -1
    for message in (wrong, wrong, stamped(1)):
        left.signalMessage(message)
    right.signalMessage(stamped(1))

    assert len(found) == 1
    assert capsys.readouterr().err.count("has a stamp before the year 1970, sec=-1") == 1


def test_a_cache_answers_by_stamp() -> None:
    """Intervals include both ends; the oldest message is pushed out."""
    source = SimpleFilter()
    cache = Cache(source, 5)
    for t in range(6):
        source.signalMessage(stamped(t))

    def seconds(messages: list[Any]) -> list[int]:
        return [message.header.stamp.sec for message in messages]

    assert seconds(cache.getInterval(Time(seconds=2), Time(seconds=3))) == [2, 3]
    assert seconds([cache.getElemAfterTime(Time(seconds=2, nanoseconds=1))]) == [3]
    assert seconds([cache.getElemBeforeTime(Time(seconds=2, nanoseconds=1))]) == [2]
    assert cache.getOldestTime() == Time(seconds=1, clock_type=cache.getOldestTime().clock_type)  # type: ignore[union-attr]  # there is one
    assert seconds([cache.getLast()]) == [5]
    assert cache.getElemAfterTime(Time(seconds=9)) is None


@given(
    st.lists(st.tuples(st.integers(0, 2), st.integers(0, 20)), max_size=25, unique=True),
    st.integers(1, 6),
)
def test_the_matcher_finds_what_trying_all_combinations_finds(
    arrivals: list[tuple[int, int]], slop: int
) -> None:
    """Giving up early changes no result: the plain search in the same order finds the same."""
    matcher = ApproximateMatcher(3, 5, slop / 1e9)
    queues: list[dict[int, tuple[int, int]]] = [{}, {}, {}]
    for index, stamp in arrivals:
        message = (index, stamp)
        found = matcher.add(index, stamp, message)
        queues[index][stamp] = message
        if len(queues[index]) > 5:
            del queues[index][min(queues[index])]
        near = [
            [stamp]
            if other == index
            else sorted((s for s in queue if abs(s - stamp) <= slop), key=lambda s: abs(s - stamp))
            for other, queue in enumerate(queues)
        ]
        expected = []
        for combination in product(*near):
            if stamp in queues[index] and max(combination) - min(combination) < slop:
                expected = [tuple(q.pop(s) for q, s in zip(queues, combination, strict=True))]
                break
        assert found == expected


async def test_a_subscriber_begins_a_chain(node: Node) -> None:
    """Its options are those of a subscription."""
    left = Subscriber(node, PointStamped, "/left", qos_profile=5)
    right = Subscriber(node, PointStamped, "/right")
    found: list[Any] = []
    TimeSynchronizer([left, Cache(right, 3)], 10).registerCallback(lambda *both: found.append(both))
    for topic in ("/left", "/right"):
        node.create_publisher(PointStamped, topic, 10).publish(stamped(1))
    await settle()

    assert found == [(stamped(1), stamped(1))]
    assert left.getTopic() == "/left"


async def test_messages_are_iterated_over_in_pairs(node: Node) -> None:
    """Messages without a partner are passed over."""
    left = node.create_subscription(PointStamped, "/left")
    right = node.create_subscription(PointStamped, "/right")
    to_left = node.create_publisher(PointStamped, "/left", 10)
    to_right = node.create_publisher(PointStamped, "/right", 10)
    for t in (1.0, 2.0, 3.0):
        to_left.publish(stamped(t))
    for t in (1.04, 3.04):
        to_right.publish(stamped(t))
    await settle()
    left.destroy()
    right.destroy()

    pairs = [(a, b) async for a, b in synchronize(left, right, slop=0.05)]

    assert pairs == [(stamped(1), stamped(1.04)), (stamped(3), stamped(3.04))]


async def test_a_cancelled_iteration_loses_nothing(node: Node) -> None:
    """A wait that was given up can be taken up again."""
    left = node.create_subscription(PointStamped, "/left")
    right = node.create_subscription(PointStamped, "/right")
    pairs = synchronize(left, right)
    waiting = asyncio.ensure_future(anext(pairs))  # noqa: TID251  # cancelled below
    node.create_publisher(PointStamped, "/left", 10).publish(stamped(1))
    await settle()
    waiting.cancel()
    await settle()
    node.create_publisher(PointStamped, "/right", 10).publish(stamped(1))

    assert await anext(pairs) == (stamped(1), stamped(1))


def test_fewer_than_two_subscriptions_are_refused() -> None:
    """Nothing could belong to one alone."""
    with pytest.raises(ValueError, match="at least two"):
        synchronize()


# Chains


def test_a_chain_gives_each_filter_the_output_of_the_one_before() -> None:
    """The chain calls back with the output of the last one, once."""
    chain = Chain()
    first, second = Cache(SimpleFilter(), 3), Cache(SimpleFilter(), 3)
    found: list[Any] = []
    chain.registerCallback(found.append)
    messages = [stamped(t) for t in range(3)]

    chain.add(messages[0])
    chain.addFilter(first)
    chain.add(messages[1])
    assert chain.addFilter(second) == 1
    chain.add(messages[2])

    assert found == messages
    assert first.getInterval(Time(), Time(seconds=9)) == messages[1:]
    assert second.getInterval(Time(), Time(seconds=9)) == messages[2:]


async def test_a_chain_begins_with_a_subscriber(node: Node) -> None:
    """It may itself be the input of another filter."""
    subscriber = Subscriber(node, PointStamped, "/points")
    chain = Chain()
    chain.connectInput(subscriber)
    chain.addFilter(Cache(SimpleFilter(), 2))
    last = Cache(chain, 5)

    node.create_publisher(PointStamped, "/points", 10).publish(stamped(1))
    await settle()

    assert last.getLast() == stamped(1)
    assert subscriber.get_publisher_count() == 1


def test_a_filter_that_is_not_in_the_chain_is_a_key_error() -> None:
    """As in ROS 2."""
    chain = Chain()
    cache = Cache(SimpleFilter())
    chain.addFilter(cache)

    assert chain.getFilter(0) is cache
    with pytest.raises(KeyError, match="has 1 filters, but none of index 1"):
        chain.getFilter(1)


def test_messages_that_find_no_partner_are_counted() -> None:
    """Memory stays bounded, and a wrong slop or queue size shows."""
    left = SimpleFilter()
    synchronizer = TimeSynchronizer([left, SimpleFilter()], 3)

    for t in range(10):
        left.signalMessage(stamped(t))

    assert synchronizer.dropped == 7
