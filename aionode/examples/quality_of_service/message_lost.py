"""Bursts that are too large for the route between two processes; the listener counts the losses.

Run it with ``python -m aionode.examples.quality_of_service.message_lost``. Two contexts in one
process stand for two processes, because within one context no message is lost.
"""

from __future__ import annotations

import asyncio

import aionode
from aionode import Context, Node, QoSMessageLostInfo, QoSProfile, ReliabilityPolicy, Subscription
from aionode.interfaces.std_msgs.msg import String

__all__ = ["application", "main", "watch"]

BURSTS = 3
BURST = 200
SIZE = 50_000


async def watch(subscription: Subscription[String]) -> None:
    """Print each loss."""
    async for event in subscription.events:
        if isinstance(event, QoSMessageLostInfo):
            print(
                f"lost:      {event.total_count_change} messages, {event.total_count} in all",
                flush=True,
            )


async def application() -> None:
    """Publish bursts without a pause, to a subscription that receives what arrives."""
    profile = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    async with (
        Context() as here,
        Context() as there,
        Node("qos_talker", context=here) as talker,
        Node("qos_listener", context=there) as listener,
        asyncio.TaskGroup() as tasks,
    ):
        subscription = listener.create_subscription(String, "qos_chatter", lambda _: None, profile)
        publisher = talker.create_publisher(String, "qos_chatter", profile)
        await publisher.wait_for_subscribers()
        tasks.create_task(watch(subscription))
        clock = talker.get_clock()
        await clock.sleep(0.3)  # for a link between the two
        for number in range(BURSTS):
            print(f"publish:   burst {number + 1} of {BURST} messages", flush=True)
            for _ in range(BURST):
                publisher.publish(String(data=str(number) * SIZE))
            await clock.sleep(0.3)
            publisher.publish(String(data="the next number shows what is missing"))
            await clock.sleep(0.1)
        print(f"published: {publisher.stats.published}", flush=True)
        print(f"received:  {subscription.stats.received}", flush=True)
        print(f"lost:      {subscription.stats.lost}", flush=True)
        subscription.destroy()  # its events end with it


def main() -> None:
    """Run the application until it is done, or until Ctrl-C."""
    aionode.run(application)


if __name__ == "__main__":
    main()
