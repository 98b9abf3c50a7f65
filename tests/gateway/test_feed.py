"""The subscription shared by clients."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from aionode.gateway.session.feed import Feed, Received
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import LivelinessPolicy, QoSProfile
from aionode.testing import settle

if TYPE_CHECKING:
    import pytest

    from aionode.node import Node


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
