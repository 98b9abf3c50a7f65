"""A talker falls silent and wakes up again; the listener follows its liveliness.

Run it with ``python -m aionode.examples.quality_of_service.liveliness``. With ``--policy
automatic`` the talker's node asserts its liveliness by itself, so it is alive until it ends.
"""

from __future__ import annotations

import argparse
import asyncio
from functools import partial

import aionode
from aionode import (
    Duration,
    LivelinessPolicy,
    Node,
    Publisher,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSProfile,
    Subscription,
)
from aionode.interfaces.std_msgs.msg import String

__all__ = ["application", "main", "watch_listener", "watch_talker"]


async def watch_talker(publisher: Publisher[String]) -> None:
    """Print the liveliness events of the talker."""
    async for event in publisher.events:
        if isinstance(event, QoSLivelinessLostInfo):
            print(f"talker:   liveliness lost, {event.total_count} times so far", flush=True)


async def watch_listener(subscription: Subscription[String]) -> None:
    """Print the liveliness events of the listener's publishers."""
    async for event in subscription.events:
        if isinstance(event, QoSLivelinessChangedInfo):
            print(
                f"listener: alive {event.alive_count} ({event.alive_count_change:+}), "
                f"not alive {event.not_alive_count} ({event.not_alive_count_change:+})",
                flush=True,
            )


async def application(lease_ms: int, policy: str) -> None:
    """Publish, stay silent for two leases, assert liveliness without a message, and end."""
    profile = QoSProfile(
        depth=10,
        liveliness=LivelinessPolicy.get_from_short_key(policy),
        liveliness_lease_duration=Duration(seconds=lease_ms / 1000),
    )
    async with Node("qos_talker") as talker, Node("qos_listener") as listener:
        subscription = listener.create_subscription(String, "qos_chatter", None, profile)
        publisher = talker.create_publisher(String, "qos_chatter", profile)
        clock = talker.get_clock()
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(watch_talker(publisher))
            tasks.create_task(watch_listener(subscription))
            print("publish", flush=True)
            publisher.publish(String(data="Talker says 1"))
            await clock.sleep(2 * lease_ms / 1000)
            print("assert liveliness", flush=True)
            publisher.assert_liveliness()
            await clock.sleep(lease_ms / 2000)
            print("end of the talker", flush=True)
            publisher.destroy()
            await clock.sleep(lease_ms / 2000)
            subscription.destroy()  # its events end with it


def main() -> None:
    """Run the application until it is done, or until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("lease", type=int, nargs="?", default=400, help="in milliseconds")
    parser.add_argument(
        "--policy", choices=["automatic", "manual_by_topic"], default="manual_by_topic"
    )
    options, _ = parser.parse_known_args()
    aionode.run(partial(application, options.lease, options.policy))


if __name__ == "__main__":
    main()
