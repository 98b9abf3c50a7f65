"""The subscription shared by clients."""

from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING, Any

import numpy as np

from aionode.engine.wire import cdr
from aionode.gateway.session import feed as feed_module
from aionode.gateway.session.feed import BESIDE_BYTES, Feed, Received
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import LivelinessPolicy, QoSProfile
from aionode.testing import settle
from tests.support.links import Counting, folder, link_of, two_nodes, writer_of
from tests.support.waiting import until

if TYPE_CHECKING:
    import pytest

    from aionode.node import Node

__all__ = ["folder"]  # a fixture


async def test_a_publisher_that_comes_later_fits_whatever_it_offers(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """A page subscribes to a topic before anybody publishes: that needs no warning."""
    heard: list[Received] = []
    feed = Feed(node, "/words", String, None)
    feed.add(heard.append)
    with caplog.at_level(logging.WARNING):
        for liveliness in (LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC):
            publisher = node.create_publisher(
                String, "/words", QoSProfile(depth=1, liveliness=liveliness)
            )
            await settle()
            publisher.publish(String(data=liveliness.name))
            await settle()
    feed.close()

    assert [received.message.data for received in heard] == ["AUTOMATIC", "MANUAL_BY_TOPIC"]
    assert "incompatible" not in caplog.text


async def test_a_large_message_is_copied_beside_the_loop(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An image of 6 MB would block it for milliseconds; nothing overtakes it meanwhile."""
    threads: list[int] = []

    def noted(raw: Any) -> memoryview:
        threads.append(threading.get_ident())
        return joined(raw)

    joined = feed_module.joined
    monkeypatch.setattr(feed_module, "joined", noted)
    heard: list[Received] = []
    images = [
        Image(data=np.full(size, number, np.uint8))
        for number, size in enumerate((BESIDE_BYTES, 10, BESIDE_BYTES + 1))
    ]
    publisher = node.create_publisher(Image, "/images", 10)
    feed = Feed(node, "/images", Image, None)
    feed.add(heard.append)
    await settle()
    for image in images:
        publisher.publish(image)
    await settle()
    feed.close()

    assert [bytes(received.raw) for received in heard] == [cdr.encode(image) for image in images]
    assert len(threads) == 2
    assert threading.get_ident() not in threads


async def test_a_slow_client_keeps_no_memory_of_a_publisher() -> None:
    """It may wait for a client for long, and a process lends only so much."""
    image = Image(data=bytes(BESIDE_BYTES))
    heard: list[Received] = []
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        publisher = nodes.a.create_publisher(Image, "/images", 10)
        feed = Feed(nodes.b, "/images", Image, None)
        feed.add(heard.append)
        await numbers.go_until(lambda: writer_of(publisher).linked)
        publisher.publish(image)
        await until(lambda: heard)
        await until(lambda: not link_of(nodes.a).lent)
        feed.close()
    assert heard[0].raw == cdr.encode(image)
