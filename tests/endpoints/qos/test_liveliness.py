"""The liveliness of publishers: by their process, and by topic."""

from __future__ import annotations

import asyncio

import pytest

from aionode._process.concurrency import checkpoint
from aionode.clock import Duration
from aionode.endpoints.events import (
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    SubscriptionEventCallbacks,
)
from aionode.engine.rules.liveliness import PublisherLiveliness
from aionode.errors import EntityDestroyedError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import LivelinessPolicy, QoSProfile
from aionode.testing import settle
from tests.endpoints.qos.conftest import Pair, next_of, waiting
from tests.support.arrivals import writers_of
from tests.support.spies import returns_of

LEASE = Duration(seconds=1)
MANUAL = QoSProfile(
    depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=LEASE
)
AUTOMATIC = MANUAL.replace(liveliness=LivelinessPolicy.AUTOMATIC)


@pytest.fixture
def asserted(monkeypatch: pytest.MonkeyPatch) -> asyncio.Queue[None]:
    """Return a list that grows with each assertion that a subscription receives."""
    return returns_of(monkeypatch, PublisherLiveliness, "note_assertion")


async def advance(pair: Pair, asserted: asyncio.Queue[None]) -> None:
    """Let so much time pass that the publisher asserts its liveliness, and wait for an assertion.

    It may be one that was sent before: less than the lease passes from one to the next even if that
    comes at the start of this time, and the next at the end of the following one.
    """
    while not asserted.empty():
        asserted.get_nowait()
    await pair.clock.advance(0.4)
    await asserted.get()


ALIVE = QoSLivelinessChangedInfo(1, 0, 1, 0)
NOT_ALIVE = QoSLivelinessChangedInfo(0, 1, -1, 1)


async def test_a_publisher_comes_to_life_with_its_first_message_and_loses_it_in_silence(
    pair: Pair,
) -> None:
    """Manual by topic: its messages are signs of life. Both ends learn of the silence."""
    publisher, subscription = await pair.joined(MANUAL, MANUAL)
    lost, changed = publisher.events, subscription.events
    await pair.clock.advance(3)
    assert waiting(changed, QoSLivelinessChangedInfo) == []
    await pair.send(publisher, subscription)
    assert await next_of(changed, QoSLivelinessChangedInfo) == ALIVE
    await pair.clock.advance(0.9)
    await pair.send(publisher, subscription)
    await pair.clock.advance(0.9)
    assert waiting(changed, QoSLivelinessChangedInfo) == []
    assert waiting(lost, QoSLivelinessLostInfo) == []
    await pair.clock.advance(3)
    assert waiting(changed, QoSLivelinessChangedInfo) == [NOT_ALIVE]
    assert waiting(lost, QoSLivelinessLostInfo) == [QoSLivelinessLostInfo(1, 1)]


async def test_an_assertion_is_a_sign_of_life(pair: Pair) -> None:
    """Without a message, and also for one that was given up."""
    publisher, subscription = await pair.joined(MANUAL, MANUAL)
    changed = subscription.events
    publisher.assert_liveliness()
    assert await next_of(changed, QoSLivelinessChangedInfo) == ALIVE
    await pair.clock.advance(1)
    assert await next_of(changed, QoSLivelinessChangedInfo) == NOT_ALIVE
    publisher.assert_liveliness()
    assert await next_of(changed, QoSLivelinessChangedInfo) == QoSLivelinessChangedInfo(1, 0, 1, -1)
    await pair.clock.advance(1)
    assert waiting(publisher.events, QoSLivelinessLostInfo)[-1].total_count == 2


async def test_the_lease_of_the_subscription_decides_what_it_hears(pair: Pair) -> None:
    """It may request less than what is offered, as over Fast DDS."""
    publisher, subscription = await pair.joined(
        MANUAL, MANUAL.replace(liveliness_lease_duration=Duration(seconds=2))
    )
    publisher.assert_liveliness()
    assert await next_of(subscription.events, QoSLivelinessChangedInfo) == ALIVE
    await pair.clock.advance(1.5)
    assert waiting(publisher.events, QoSLivelinessLostInfo) == [QoSLivelinessLostInfo(1, 1)]
    assert waiting(subscription.events, QoSLivelinessChangedInfo) == []
    await pair.clock.advance(0.5)
    assert waiting(subscription.events, QoSLivelinessChangedInfo) == [NOT_ALIVE]


async def test_automatic_liveliness_needs_no_message(
    pair: Pair, asserted: asyncio.Queue[None]
) -> None:
    """The node's event loop asserts it while the node runs."""
    publisher, subscription = await pair.joined(AUTOMATIC, AUTOMATIC)
    changed = subscription.events
    assert await next_of(changed, QoSLivelinessChangedInfo) == ALIVE
    for _ in range(8):
        await advance(pair, asserted)
    assert waiting(changed, QoSLivelinessChangedInfo) == []
    assert waiting(publisher.events, QoSLivelinessLostInfo) == []


async def test_a_process_that_hangs_is_not_alive(
    pair: Pair, asserted: asyncio.Queue[None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its token stays for ten seconds over Zenoh, but its assertions stop at once."""
    publisher, subscription = await pair.joined(AUTOMATIC, AUTOMATIC)
    changed = subscription.events
    assert await next_of(changed, QoSLivelinessChangedInfo) == ALIVE
    await advance(pair, asserted)
    for writer in writers_of(publisher):
        monkeypatch.setattr(writer, "assert_liveliness", lambda: None)
    heard: list[QoSLivelinessChangedInfo] = []
    while not heard:  # assertions that were sent before may still come, and renew the lease
        await pair.clock.advance(1)
        heard = waiting(changed, QoSLivelinessChangedInfo)
    assert heard[0] == NOT_ALIVE


async def test_a_publisher_that_goes_is_not_counted_any_more(pair: Pair) -> None:
    """It counts neither as alive nor as not alive."""
    publisher, subscription = await pair.joined(AUTOMATIC, AUTOMATIC)
    changed = subscription.events
    assert await next_of(changed, QoSLivelinessChangedInfo) == ALIVE
    publisher.destroy()
    assert await next_of(changed, QoSLivelinessChangedInfo) == QoSLivelinessChangedInfo(0, 0, -1, 0)


async def test_a_publisher_that_goes_without_being_alive_is_not_counted_either(pair: Pair) -> None:
    """The count of those that are not alive falls."""
    publisher, subscription = await pair.joined(MANUAL, MANUAL)
    changed = subscription.events
    publisher.assert_liveliness()
    assert await next_of(changed, QoSLivelinessChangedInfo) == ALIVE
    await pair.clock.advance(1)
    assert await next_of(changed, QoSLivelinessChangedInfo) == NOT_ALIVE
    publisher.destroy()
    assert await next_of(changed, QoSLivelinessChangedInfo) == QoSLivelinessChangedInfo(0, 0, 0, -1)


async def test_a_publisher_that_goes_before_its_first_sign_is_no_change(pair: Pair) -> None:
    """It was neither alive nor not alive."""
    publisher, subscription = await pair.joined(MANUAL, MANUAL)
    publisher.destroy()
    await pair.listener.graph.until(lambda: subscription.get_publisher_count() == 0)
    assert waiting(subscription.events, QoSLivelinessChangedInfo) == []


async def test_without_a_lease_a_publisher_lives_while_it_is_there(pair: Pair) -> None:
    """DDS counts a matched publisher without a limit as alive."""
    got: list[QoSLivelinessChangedInfo] = []
    publisher, _ = await pair.joined(
        10, 10, subscription_events=SubscriptionEventCallbacks(liveliness=got.append)
    )
    await settle()
    assert got == [ALIVE]
    publisher.destroy()
    await pair.listener.graph.until(lambda: not pair.listener.count_publishers("n"))
    await settle()
    assert got == [ALIVE, QoSLivelinessChangedInfo(0, 0, -1, 0)]


async def test_a_destroyed_publisher_asserts_nothing(pair: Pair) -> None:
    """It publishes nothing either."""
    publisher = pair.talker.create_publisher(Int32, "n", MANUAL)
    publisher.destroy()
    with pytest.raises(EntityDestroyedError, match="assert liveliness"):
        publisher.assert_liveliness()


async def test_a_message_that_does_not_pass_the_filter_is_a_sign_of_life(pair: Pair) -> None:
    """The publisher sends it for that reason, though it could omit it."""
    publisher, subscription = await pair.joined(MANUAL, MANUAL)
    changed = subscription.events
    await pair.send(publisher, subscription)
    subscription.set_content_filter("data > 1000", [])
    for count in (1, 2, 3):
        await pair.clock.advance(0.9)
        publisher.publish(Int32(data=0))
        while subscription.stats.filtered < count:
            await checkpoint()

    assert waiting(changed, QoSLivelinessChangedInfo) == [ALIVE]
    await pair.clock.advance(3)
    assert waiting(changed, QoSLivelinessChangedInfo) == [NOT_ALIVE]
