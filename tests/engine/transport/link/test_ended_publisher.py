"""Copies over the link and over Zenoh count once, even after the publisher has ended."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from aionode.engine.transport.link import _subscription as subscriptions
from aionode.interfaces.std_msgs.msg import Int32
from tests.support import arrivals
from tests.support.links import folder, manager_of, two_nodes, writer_of
from tests.support.peers import KEEP_ALL

__all__ = ["folder"]  # a fixture


@pytest.mark.parametrize("profile", [KEEP_ALL, 1000], ids=["keep_all", "keep_last"])
async def test_copies_that_zenoh_brings_after_the_end_of_a_publisher_are_left_out(
    profile: Any,
) -> None:
    """Zenoh waits for acknowledgements, and may lag behind the link, which has brought the end."""
    async with asyncio.timeout(20), two_nodes() as nodes:
        subscription = nodes.b.create_subscription(Int32, "n", None, profile)
        publisher = nodes.a.create_publisher(Int32, "n", profile)
        gid = writer_of(publisher).endpoint.gid
        sent = await publish_until_linked(publisher, subscription)
        reader = reader_of(nodes.b)
        publisher.publish(Int32(data=2))
        await subscription.receive()
        publisher.destroy()
        while subscription.get_publisher_count():
            await nodes.b.graph.changed()
        await nodes.b.get_clock().sleep(0.05)  # # the last message over the link

        for number in range(1, sent + 2):
            reader.deliver(Int32(data=number), gid, number, 0)

        assert subscription.stats.received == sent + 1
        assert not arrivals.reader_of(subscription)


async def test_a_publisher_that_has_ended_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise memory would grow for a reader whose publishers come and go."""
    monkeypatch.setattr(subscriptions, "RECOVERY_S", 0.01)
    async with asyncio.timeout(20), two_nodes() as nodes:
        subscription = nodes.b.create_subscription(Int32, "n", None, 10)
        publisher = nodes.a.create_publisher(Int32, "n", 10)
        await publish_until_linked(publisher, subscription)
        reader = reader_of(nodes.b)
        assert len(reader.remote_publishers) == 1

        publisher.destroy()

        while reader.remote_publishers:
            await nodes.a.get_clock().sleep(0.01)


async def publish_until_linked(publisher: Any, subscription: Any) -> int:
    """Publish and receive until the link carries the messages; return how many there were."""
    await publisher.wait_for_subscribers()
    sent = 0
    while not writer_of(publisher).linked:
        publisher.publish(Int32(data=1))
        await subscription.receive()
        sent += 1
    return sent


def reader_of(node: Any) -> Any:
    """Return the transport's side of the only subscription to /n."""
    (reader,) = [each for each in manager_of(node).readers.values() if each.endpoint.name == "/n"]
    return reader
