"""A late subscription receives only the messages that are still valid.

Run it with ``python -m aionode.examples.quality_of_service.lifespan``, and with a lifespan in
milliseconds for another: ``lifespan 1000 --publish-count 10 --subscribe-after 800``.
"""

from __future__ import annotations

import argparse
import asyncio
from functools import partial

import aionode
from aionode import DurabilityPolicy, Duration, Node, QoSProfile
from aionode.interfaces.std_msgs.msg import String

__all__ = ["application", "main"]

PERIOD_SEC = 0.25


async def application(lifespan_ms: int, publish_count: int, subscribe_after_ms: int) -> None:
    """Publish some messages, subscribe, and receive those that have not expired."""
    profile = QoSProfile(
        depth=publish_count,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        lifespan=Duration(seconds=lifespan_ms / 1000),
    )
    async with Node("qos_talker") as talker, Node("qos_listener") as listener:
        publisher = talker.create_publisher(String, "qos_chatter", profile)
        rate = talker.create_rate(1 / PERIOD_SEC)
        for number in range(publish_count):
            print(f"Publishing: {number}", flush=True)
            publisher.publish(String(data=f"Talker says {number}"))
            await rate.sleep()
        await talker.get_clock().sleep(subscribe_after_ms / 1000)

        subscription = listener.create_subscription(
            String, "qos_chatter", None, profile.replace(lifespan=Duration())
        )
        try:
            async with asyncio.timeout(PERIOD_SEC):
                async for msg in subscription:
                    print(f"I heard: {msg.data}", flush=True)
        except TimeoutError:
            stats = subscription.stats
            print(f"{stats.received} were valid, {stats.expired} had expired", flush=True)


def main() -> None:
    """Run the application until it is done, or until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("lifespan", type=int, nargs="?", default=1500, help="in milliseconds")
    parser.add_argument("--publish-count", type=int, default=8)
    parser.add_argument("--subscribe-after", type=int, default=300, help="in milliseconds")
    options, _ = parser.parse_known_args()
    aionode.run(
        partial(application, options.lifespan, options.publish_count, options.subscribe_after)
    )


if __name__ == "__main__":
    main()
