"""Content filters over every transport: what arrives, and what is not even sent."""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Publisher, Subscription
from aionode.content_filter import ContentFilterOptions, compile_filter
from aionode.engine.transport import content_filters
from aionode.engine.transport.content_filters import (
    ContentFilters,
    filter_from_text,
    filter_token,
    text_of_filter,
)
from aionode.engine.wire import cdr
from aionode.errors import ContentFilterError, EntityDestroyedError, MessageError
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from aionode.testing import settle
from tests.support.peers import Collector, contexts_over, quiet_node, raw_session

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

DEEP = QoSProfile(depth=1000)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1000)

OVER_FIVE = ContentFilterOptions("data > %0", ["5"])


class Pair(NamedTuple):
    """Two running nodes, and how messages get from the left one to the right one."""

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
    """Return what arrives, up to a number."""
    numbers: list[int] = []
    while not numbers or numbers[-1] != last:
        numbers.append((await subscription.receive()).data)
    return numbers


async def until_known(pair: Pair, publisher: Publisher[Int32], unwanted: int = 0) -> None:
    """Publish what is not wanted, until the publisher knows and does not send it any more."""
    await publisher.wait_for_subscribers()
    while pair.route == "link" and set(publisher.stats.routes.values()) != {"link"}:
        publisher.publish(Int32(data=1000))  # the hand-over takes place while messages flow
        await pair.left.get_clock().sleep(0.005)
    before = publisher.stats.filtered
    while pair.route != "local" and publisher.stats.filtered == before:
        publisher.publish(Int32(data=unwanted))
        await pair.left.get_clock().sleep(0.005)


async def test_only_what_passes_arrives_and_in_order(pair: Pair) -> None:
    """From the first message on, whether the publisher knows the filter yet or not."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers()

    for number in range(10):
        publisher.publish(Int32(data=number))

    assert await received(subscription, 9) == [6, 7, 8, 9]
    assert subscription.stats.received == 4


async def test_what_is_not_wanted_is_not_sent(pair: Pair) -> None:
    """The publisher leaves it out, and within a process nothing is queued."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await until_known(pair, publisher)
    publisher.publish(Int32(data=2000))
    await received(subscription, 2000)
    sent, arrived = publisher.stats.filtered, subscription.stats.filtered

    for number in range(100):
        publisher.publish(Int32(data=number % 10))
    publisher.publish(Int32(data=3000))

    numbers = await received(subscription, 3000)
    assert numbers == [6, 7, 8, 9] * 10 + [3000]
    not_sent = publisher.stats.filtered - sent
    assert (not_sent, subscription.stats.filtered - arrived) == (
        (0, 60) if pair.route == "local" else (60, 0)
    )
    assert (subscription.stats.lost, subscription.stats.dropped) == (0, 0)
    assert publisher.stats.dropped == 0


async def test_the_filter_can_be_changed_and_removed(pair: Pair) -> None:
    """What comes after the publisher has learned of it is complete."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await until_known(pair, publisher)

    subscription.set_content_filter("data < %0", ["0"])
    while True:  # until a negative number passes: the new filter is known
        publisher.publish(Int32(data=-1))
        try:
            async with asyncio.timeout(0.05):
                if (await subscription.receive()).data == -1:
                    break
        except TimeoutError:
            pass
    await until_known(pair, publisher, unwanted=7)  # and the one before it is forgotten
    for number in (7, -5, 8, -6):
        publisher.publish(Int32(data=number))
    assert [n for n in await received(subscription, -6) if n != -1] in ([-5, -6], [1000, -5, -6])

    subscription.set_content_filter("", [])
    assert not subscription.is_cft_enabled
    while True:
        publisher.publish(Int32(data=7))
        try:
            async with asyncio.timeout(0.05):
                if (await subscription.receive()).data == 7:
                    break
        except TimeoutError:
            pass
    for number in (1, -1, 100):
        publisher.publish(Int32(data=number))
    assert [n for n in await received(subscription, 100) if n != 7] == [1, -1, 100]


async def test_two_subscriptions_get_what_each_wants(pair: Pair) -> None:
    """The publisher sends what either of them wants."""
    low = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=ContentFilterOptions("data < 3")
    )
    high = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=ContentFilterOptions("data > 6")
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await publisher.wait_for_subscribers(2)
    await until_known(pair, publisher, unwanted=5)

    for number in range(10):
        publisher.publish(Int32(data=number))

    assert [n for n in await received(high, 9) if n < 1000] == [7, 8, 9]
    assert await received(low, 2) == [0, 1, 2]


async def test_a_subscription_without_a_filter_gets_everything(pair: Pair) -> None:
    """Also beside one that has a filter."""
    filtered = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await until_known(pair, publisher)
    everything = pair.right.create_subscription(Int32, "n", None, DEEP)
    await publisher.wait_for_subscribers(2)

    for number in range(5000, 5010):
        publisher.publish(Int32(data=number % 10))
    publisher.publish(Int32(data=9999))

    numbers = await received(everything, 9999)
    assert numbers[-11:] == [*range(10), 9999]
    assert set(await received(filtered, 9999)) <= {6, 7, 8, 9, 1000, 9999}


async def test_nothing_that_passes_is_lost_when_most_is_left_out(pair: Pair) -> None:
    """KEEP_ALL: acknowledgements, windows and gaps work with holes in the numbers."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, KEEP_ALL, content_filter_options=ContentFilterOptions("data >= 10")
    )
    publisher = pair.left.create_publisher(Int32, "n", KEEP_ALL)
    await until_known(pair, publisher)

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
    """A filter that cannot compare its value is no reason to leave it out in silence."""
    pair.right.create_subscription(Int32, "n", None, DEEP, content_filter_options=OVER_FIVE)
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await until_known(pair, publisher)

    with pytest.raises(MessageError, match="data"):
        publisher.publish(Int32(data="many"))  # type: ignore[arg-type]


@pytest.mark.parametrize("pair", ["zenoh"], indirect=True)
async def test_a_reader_that_is_not_announced_gets_everything(pair: Pair) -> None:
    """A plain Zenoh program may subscribe to anything; nothing shows it but its connection."""
    subscription = pair.right.create_subscription(
        Int32, "n", None, DEEP, content_filter_options=OVER_FIVE
    )
    publisher = pair.left.create_publisher(Int32, "n", DEEP)
    await until_known(pair, publisher)
    heard = Collector()

    with raw_session() as session:
        raw = session.declare_subscriber("42/n/**", heard)
        while not heard.items:
            publisher.publish(Int32(data=0))
            await pair.left.get_clock().sleep(0.005)
        raw.undeclare()

    publisher.publish(Int32(data=9))
    assert await received(subscription, 9) == [9]


# In one process: arguments


async def test_a_filter_is_described_as_in_rclpy(node: Node) -> None:
    """`is_cft_enabled`, `get_content_filter`, `set_content_filter`."""
    subscription = node.create_subscription(Int32, "n", content_filter_options=OVER_FIVE)

    assert subscription.is_cft_enabled
    assert subscription.get_content_filter() == OVER_FIVE
    subscription.set_content_filter("data = 1", [])
    assert subscription.get_content_filter() == ContentFilterOptions("data = 1", [])
    assert not node.create_subscription(Int32, "n").is_cft_enabled


async def test_a_filter_that_does_not_fit_is_refused(node: Node) -> None:
    """Where it is given; the filter before it stays."""
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
    """With its info, numbered as it is published."""
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


# How they are announced


def wanted(
    filters: ContentFilters, gids: list[bytes], msg_type: type[Any] = Int32, by: str = "abc"
) -> Callable[[Any], bool] | None:
    """Return what subscriptions of one context want of a topic."""
    return filters.wanted_by("/words", dict.fromkeys(gids, by), msg_type)


def test_an_announced_filter_can_be_read_back() -> None:
    """As text that may be part of a Zenoh key."""
    given = ContentFilterOptions("data LIKE %0 AND 'a/b#?*$' <> data", ["'ä%'"])

    text = text_of_filter(given)

    assert set(text).isdisjoint("/#?*$%=+")
    assert filter_from_text(text) == given


@pytest.mark.parametrize("text", ["", "!", "AAAA", "bnVsbA", "W10", "WzEsMl0", "A" * 5000])
def test_a_damaged_filter_is_ignored(text: str) -> None:
    """It comes from the network: the publisher goes on sending everything."""
    filters = ContentFilters()

    filters.take_token("abc", f"filter/2/%words/{'ab' * 16}/{text}", present=True)

    assert not filters


@given(st.text() | st.binary().map(lambda data: base64.urlsafe_b64encode(data).decode()))
def test_nothing_from_the_network_raises(text: str) -> None:
    """A token may have been declared by any program."""
    filters = ContentFilters()

    for present in (True, False):
        filters.take_token("abc", f"filter/2/%words/{'ab' * 16}/{text}", present=present)
        filters.take_token("abc", f"filter/2/{text}", present=present)
        wanted(filters, [bytes.fromhex("ab" * 16)])

    assert not filters


def test_a_long_filter_is_not_announced() -> None:
    """Keys are no place for kilobytes; the subscription filters for itself."""
    assert text_of_filter(ContentFilterOptions("data = 1 OR " * 1000 + "data = 2")) == ""
    assert text_of_filter(ContentFilterOptions("")) == ""


def test_a_filter_that_does_not_fit_the_type_wants_everything() -> None:
    """The reader knows better which messages it means."""
    filters = ContentFilters()
    gid = bytes(range(16))
    token = filter_token(
        0, "abc", "/words", gid, text_of_filter(ContentFilterOptions("nothing = 1"))
    )

    filters.take_token("abc", token.split("/", 3)[3], present=True)

    assert filters
    assert wanted(filters, [gid]) is None


@pytest.mark.parametrize(
    "token",
    [
        "other/filter/2/%words/{gid}/{text}",
        "abc/filter/2/%other/{gid}/{text}",
        "abc/filter/2/%words/{other}/{text}",
    ],
    ids=["context", "topic", "subscription"],
)
def test_a_filter_counts_only_for_the_subscription_under_whose_key_it_stands(token: str) -> None:
    """One token of another process would else silence a subscription."""
    filters = ContentFilters()
    gid, other = gid_of(1), gid_of(2)
    announced(filters, gid, "data = 1")
    text = text_of_filter(ContentFilterOptions("data = 2 AND data = 3"))
    participant, _, what = token.format(gid=gid.hex(), other=other.hex(), text=text).partition("/")
    filters.take_token(participant, what, present=True)

    wants = wanted(filters, [gid])
    assert wants is not None
    assert [wants(Int32(data=number)) for number in (1, 2)] == [True, False]
    filters.take_token("abc", what, present=False)
    assert wanted(filters, [gid]) is not None


def test_too_many_filters_of_one_context_take_no_place_from_others() -> None:
    """And more than four of one subscription, under another context's key, turn off nothing."""
    filters = ContentFilters()
    announced(filters, gid_of(1), "data = 1")
    for number in range(3_000):
        text = text_of_filter(ContentFilterOptions(f"data = {number}"))
        filters.take_token("liar", f"filter/2/%words/{gid_of(1).hex()}/{text}", present=True)
        filters.take_token("liar", f"filter/2/%words/{gid_of(number).hex()}/{text}", present=True)
    announced(filters, gid_of(2), "data = 2")

    assert wanted(filters, [gid_of(1), gid_of(2)]) is not None


def test_a_subscription_whose_new_filter_does_not_count_gets_everything(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where others have filled all places, its former filter alone would hide what it wants."""
    monkeypatch.setattr(content_filters, "MAX_FILTERS", 3)
    filters = ContentFilters()
    announced(filters, gid_of(0), "data = 1")
    for number in range(1, 20):
        announced(filters, gid_of(number), "data = 7")
    assert wanted(filters, [gid_of(0)]) is not None

    announced(filters, gid_of(0), "data = 2")

    assert wanted(filters, [gid_of(0)]) is None
    assert filters._counts.total() == 2


def test_a_filter_that_does_not_count_has_no_publisher_look_again() -> None:
    """Any program may declare any number of them, and each look is at all subscriptions."""
    filters = ContentFilters()
    announced(filters, gid_of(1), *(f"data = {number}" for number in range(5)))
    changes = filters.changes

    announced(filters, gid_of(1), "data = 0", "data = 5", "data = 6")
    filters.take_token("abc", f"filter/2/%words/{gid_of(1).hex()}/damaged", present=True)

    assert filters.changes == changes


async def test_publishers_look_once_at_many_filters_of_their_topic() -> None:
    """A look is at all subscriptions: for each of a thousand tokens it would stop the loop."""
    filters = ContentFilters()
    looks: list[set[str]] = []
    filters.on_change.append(lambda topics: looks.append(set(topics)))
    for number in range(100):
        announced(filters, gid_of(number), "data = 1")
    await settle()
    assert len(looks) == 1

    filters.clear()
    await settle()
    assert looks[1] == looks[0]
    assert len(looks[0]) == 1


# What filters of others may cost


def announced(filters: ContentFilters, gid: bytes, *expressions: str) -> None:
    """Announce filters of one subscription."""
    for expression in expressions:
        text = text_of_filter(ContentFilterOptions(expression))
        filters.take_token("abc", f"filter/2/%words/{gid.hex()}/{text}", present=True)


def gid_of(number: int) -> bytes:
    """Return the gid of a subscription."""
    return number.to_bytes(16, "big")


def test_filters_that_cost_too_much_want_everything_for_a_while() -> None:
    """Fifty patterns of 3 kB took a second of the publisher's loop for each message of 10 kB."""
    filters = ContentFilters()
    gids = [gid_of(number) for number in range(50)]
    for number, gid in enumerate(gids):
        announced(filters, gid, f"data LIKE '%{'a' * 2900}_{number}%'")
    wants = wanted(filters, gids, String)
    assert wants is not None

    costly, cheap = String(data="a" * 10_000), String(data="b")

    assert not wants(cheap)
    assert wants(costly)
    assert [wants(cheap) for _ in range(101)] == [True] * 100 + [False]


def test_a_subscription_with_more_filters_than_a_change_needs_wants_everything() -> None:
    """One subscription of another process had 20,000, and each was compiled."""
    filters = ContentFilters()
    announced(filters, gid_of(1), *(f"data = {number}" for number in range(4)))
    assert wanted(filters, [gid_of(1)]) is not None

    announced(filters, gid_of(1), "data = 4")

    assert wanted(filters, [gid_of(1)]) is None


def test_a_publisher_applies_some_filters_and_otherwise_sends_everything() -> None:
    """Each reader filters for itself, so nothing is lost but some bandwidth."""
    filters = ContentFilters()
    gids = [gid_of(number) for number in range(101)]
    for gid in gids:
        announced(filters, gid, "data = 1")

    assert wanted(filters, gids[:100]) is not None
    assert wanted(filters, gids) is None


def test_filters_of_all_others_are_bounded_and_leave_room_when_they_go(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Whatever tokens there are, their texts take 8 MB at most."""
    filters = ContentFilters()
    monkeypatch.setattr(content_filters, "MAX_FILTERS_PER_CONTEXT", 2_000)
    for number in range(2_000):
        announced(filters, gid_of(number), "data = 1")

    announced(filters, gid_of(2_000), "data = 1")
    assert wanted(filters, [gid_of(2_000)]) is None

    text = text_of_filter(ContentFilterOptions("data = 1"))
    filters.take_token("abc", f"filter/2/%words/{gid_of(0).hex()}/{text}", present=False)
    announced(filters, gid_of(2_001), "data = 1")
    assert wanted(filters, [gid_of(2_001)]) is not None


def test_a_filter_is_compiled_once_for_each_type(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each token of any subscription has all publishers ask again what is wanted."""
    compiled: list[str] = []

    def counted(_: Any, expression: str, *args: Any, **options: Any) -> Any:
        compiled.append(expression)
        return compile_filter(Int32, expression, *args, **options)

    monkeypatch.setattr("aionode.engine.transport.content_filters.compile_filter", counted)
    filters = ContentFilters()
    announced(filters, gid_of(1), "data = 1")

    for _ in range(3):
        wanted(filters, [gid_of(1)])

    assert compiled == ["data = 1"]
