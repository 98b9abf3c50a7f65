"""Content filters over every transport: what arrives, and what is not even sent."""

from __future__ import annotations

import asyncio
import base64
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from aionode import Subscription
from aionode.content_filter import ContentFilterOptions
from aionode.engine.wire import cdr
from aionode.errors import ContentFilterError, EntityDestroyedError, MessageError
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from aionode.testing import settle
from tests.support.peers import contexts_over, quiet_node, raw_session

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

DEEP = QoSProfile(depth=1000)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1000)

OVER_FIVE = ContentFilterOptions("data > %0", ["5"])


class Pair(NamedTuple):
    """Two running nodes, and the way messages take from the left one to the right one."""

    left: Node
    right: Node
    route: str


@pytest.fixture(params=["local", "zenoh", "link"])
async def pair(request: pytest.FixtureRequest) -> AsyncIterator[Pair]:
    """Two nodes that know each other."""
    async with (
        asyncio.timeout(30),
        contexts_over(request.param) as (first, second),
        quiet_node("left", first) as left,
        quiet_node("right", second) as right,
    ):
        await left.wait_for_node("/right")
        await right.wait_for_node("/left")
        yield Pair(left, right, request.param)


async def received(subscription: Subscription[Any], last: int) -> list[int]:
    """Return the messages that arrive, up to a number."""
    numbers: list[int] = []
    while not numbers or numbers[-1] != last:
        numbers.append((await subscription.receive()).data)
    return numbers


async def test_only_what_passes_arrives_and_in_order(pair: Pair) -> None:
    """From the first message on, whether or not the publisher knows the filter yet."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()

    for number in range(10):
        publisher.publish(Int32(data=number))

    assert await received(subscription, 9) == [6, 7, 8, 9]
    assert subscription.stats.received == 4


async def test_what_does_not_pass_is_counted_and_not_queued(pair: Pair) -> None:
    """Neither as dropped nor as lost, although the queue has room for only ten messages."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, 10, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()

    for number in (*[1] * 100, 6):
        publisher.publish(Int32(data=number))

    assert await received(subscription, 6) == [6]
    assert subscription.stats.filtered == 100
    assert (subscription.stats.lost, subscription.stats.dropped) == (0, 0)


async def test_the_filter_can_be_changed_and_removed(pair: Pair) -> None:
    """From the next message on, because publishers do not have to learn of it."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()

    subscription.set_content_filter("data < %0", ["0"])
    for number in (7, -5, 8, -6):
        publisher.publish(Int32(data=number))
    assert await received(subscription, -6) == [-5, -6]

    subscription.set_content_filter("", [])
    assert not subscription.is_cft_enabled
    for number in (1, -1, 100):
        publisher.publish(Int32(data=number))
    assert await received(subscription, 100) == [1, -1, 100]


async def test_each_subscription_gets_what_it_wants(pair: Pair) -> None:
    """A subscription without a filter gets everything."""
    low, high, everything = (
        pair.right.create_subscription(
            Int32, "n", None, DEEP, content_filter_options=ContentFilterOptions(expression)
        )
        for expression in ("data < 3", "data > 6", "")
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers(3)

    for number in range(10):
        publisher.publish(Int32(data=number))

    assert await received(high, 9) == [7, 8, 9]
    assert await received(low, 2) == [0, 1, 2]
    assert await received(everything, 9) == list(range(10))


@pytest.mark.parametrize("pair", ["zenoh", "link"], indirect=True)
async def test_filters_that_older_processes_announce_are_ignored(pair: Pair) -> None:
    """Publishers left out messages themselves before filtering moved to subscriptions."""
    subscription = pair.right.create_subscription(Int32, "n", None, DEEP)
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()
    (reader,) = pair.left.get_subscriptions_info_by_topic("/n")
    zid, gid = pair.right.context.participant, bytes(reader.endpoint_gid).hex()
    nothing = base64.urlsafe_b64encode(b'["data = 1000", []]').decode().rstrip("=")

    with raw_session() as session:
        tokens = [
            session.liveliness().declare_token(key)
            for key in (
                f"@aionode/42/{zid}/filter/2/%n/{gid}/{nothing}",
                f"@ros2_lv/42/{session.zid()}/0/0/NN/%/%/older",
            )
        ]
        await pair.left.wait_for_node("/older")
        publisher.publish(Int32(data=1))
        assert await received(subscription, 1) == [1]
        for token in tokens:
            token.undeclare()


async def test_nothing_that_passes_is_lost_when_most_is_left_out(pair: Pair) -> None:
    """With KEEP_ALL, acknowledgements, windows and gaps work although numbers are missing."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, KEEP_ALL, content_filter_options=ContentFilterOptions("data >= 10")
    )
    publisher = pair.left.create_publisher(Int32, "n", KEEP_ALL)
    await publisher.wait_for_subscribers()

    async def publish() -> None:
        for number in range(3000):
            publisher.publish(Int32(data=number if number % 7 == 0 else 0))
            if number % 50 == 0:
                await publisher.drain()
        publisher.publish(Int32(data=3000))

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(publish())
        numbers = [n for n in await received(subscription, 3000) if n != 1000]
    assert numbers == [*(n for n in range(10, 3000) if n % 7 == 0), 3000]
    assert (subscription.stats.dropped, subscription.stats.lost) == (0, 0)


async def test_a_raw_subscription_is_filtered(pair: Pair) -> None:
    """Its messages are decoded for the filter, and delivered as bytes."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, raw=True, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()

    for number in (3, 8):
        publisher.publish(Int32(data=number))

    assert cdr.decode(Int32, await subscription.receive()).data == 8


async def test_a_late_subscription_gets_what_passes_of_the_history(pair: Pair) -> None:
    """A transient local publisher keeps everything, as the next reader may have no filter."""
    profile = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = pair.left.create_publisher(Int32, "n", profile)
    for number in range(10):
        publisher.publish(Int32(data=number))

    subscription = pair.right.create_subscription(
        Int32, "n", None, profile, content_filter_options=OVER_FIVE
    )

    assert await received(subscription, 9) == [6, 7, 8, 9]


async def test_an_invalid_message_is_reported_by_publish(pair: Pair) -> None:
    """A filter that cannot compare a value must not drop the message silently."""
    pair.right.create_subscription(Int32, "n", None, DEEP, content_filter_options=OVER_FIVE)
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()

    with pytest.raises(MessageError, match="data"):
        publisher.publish(Int32(data="many"))  # type: ignore[arg-type]


# In one process: arguments


async def test_a_filter_is_described_as_in_rclpy(node: Node) -> None:
    """With `is_cft_enabled`, `get_content_filter` and `set_content_filter`."""
    subscription = node.create_subscription(Int32, "n", content_filter_options=OVER_FIVE)

    assert subscription.is_cft_enabled
    assert subscription.get_content_filter() == OVER_FIVE
    subscription.set_content_filter("data = 1", [])
    assert subscription.get_content_filter() == ContentFilterOptions("data = 1", [])
    assert not node.create_subscription(Int32, "n").is_cft_enabled


async def test_a_filter_that_does_not_fit_is_refused(node: Node) -> None:
    """When it is set; the previous filter stays."""
    with pytest.raises(ContentFilterError, match="has no field 'date'"):
        node.create_subscription(
            Int32, "n", content_filter_options=ContentFilterOptions("date = 1")
        )
    assert node.count_subscribers("n") == 0
    subscription = node.create_subscription(Int32, "n", content_filter_options=OVER_FIVE)
    with pytest.raises(ContentFilterError, match="%1 has no value"):
        subscription.set_content_filter("data = %1", ["1"])
    assert subscription.get_content_filter() == OVER_FIVE
    subscription.destroy()
    with pytest.raises(EntityDestroyedError):
        subscription.set_content_filter("", [])


async def test_a_callback_is_called_with_what_passes(node: Node) -> None:
    """With its info, whose number is that of the publisher."""
    heard: list[tuple[str, int]] = []
    node.create_subscription(
        String,
        "words",
        lambda msg, info: heard.append((msg.data, info["publication_sequence_number"])),
        content_filter_options=ContentFilterOptions("data LIKE %0", ["'a%'"]),
    )
    publisher = node.create_publisher(String, "words", 10)
    for word in ("apple", "pear", "apricot"):
        publisher.publish(String(data=word))
    await settle()

    assert heard == [("apple", 1), ("apricot", 3)]
