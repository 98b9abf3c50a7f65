"""Large messages, which a separate thread sends."""

from __future__ import annotations

from aionode.interfaces.std_msgs.msg import UInt8MultiArray
from tests.support.peers import quiet_node, two_contexts

LARGE = UInt8MultiArray(data=bytes(2_000_000))


async def test_what_was_published_before_the_end_of_its_publisher_arrives() -> None:
    """Zenoh's publisher must not be removed while the thread sends through it."""
    async with (
        two_contexts() as (first, second),
        quiet_node("sender", first) as send_thread,
        quiet_node("reader", second) as reader,
    ):
        subscription = reader.create_subscription(UInt8MultiArray, "large", None, 100)
        for _ in range(10):
            publisher = send_thread.create_publisher(UInt8MultiArray, "large", 100)
            await publisher.wait_for_subscribers()
            publisher.publish(LARGE)
            publisher.publish(LARGE)
            publisher.destroy()
            assert len((await subscription.receive()).data) == len(LARGE.data)


async def test_contexts_close_while_large_messages_are_on_their_way() -> None:
    """Without waiting for them."""
    async with (
        two_contexts() as (first, second),
        quiet_node("sender", first) as send_thread,
        quiet_node("reader", second) as reader,
    ):
        reader.create_subscription(UInt8MultiArray, "large", None, 100)
        publisher = send_thread.create_publisher(UInt8MultiArray, "large", 100)
        await publisher.wait_for_subscribers()
        for _ in range(20):
            publisher.publish(LARGE)
