"""``aionode topic pub``."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.follow import Follower
from aionode.cli._support.yaml_messages import Filler
from aionode.errors import CommandError
from aionode.message import to_json
from aionode.qos import qos_profile_default

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.endpoints.publisher import Publisher
    from aionode.node import Node
    from aionode.qos import QoSProfile

__all__ = ["pub"]


async def pub(
    node: Node,
    topic_name: str,
    message_type: str,
    *,
    output: Output,
    values: str = "{}",
    rate: float = 1.0,
    print_nth: int = 1,
    times: int = 0,
    wait_for: int = 0,
    max_wait_s: float | None = None,
    keep_alive_s: float = 0.1,
    qos: QoSProfile | None = None,
) -> None:
    """Publish a message repeatedly and print what is published.

    Args:
        node: The command's node.
        topic_name: Name of the topic.
        message_type: ROS name of its type.
        output: Where to print.
        values: The message in YAML.
        rate: Publishing rate, in Hz.
        print_nth: Print every n-th message; 0 prints none.
        times: Number of messages; 0 publishes until cancelled.
        wait_for: Number of subscriptions to wait for first.
        max_wait_s: Maximum time to wait for them, in seconds; None is unlimited.
        keep_alive_s: How long to keep the node alive after the last message, in seconds.
        qos: Profile of the publisher.

    Raises:
        CommandError: the type or values are invalid, or too few subscriptions appeared.
        InvalidTopicNameException: the name is invalid.
    """
    name = node.resolve_topic_name(topic_name)
    msg_type = await lookup.topic_type(node, name, message_type)
    assert msg_type is not None  # noqa: S101  # a type was given
    filler = Filler(msg_type, values)
    publisher: Publisher[Any] = node.create_publisher(msg_type, name, qos or qos_profile_default)
    await wait_for_subscriptions(publisher, wait_for, max_wait_s, output)
    output.text("publisher: beginning loop")
    follower = Follower(node)
    count = 0

    def publish() -> None:
        nonlocal count
        msg = filler.message(node.get_clock().now())
        count += 1
        if print_nth and count % print_nth == 0:
            if output.json:
                output.json_line(to_json(msg))
            else:
                output.text(f"publishing #{count}: {msg!r}\n")
        publisher.publish(msg)
        if count == times:
            timer.cancel()
            follower.finish()

    timer = node.create_timer(1.0 / rate, publish, on_error=follower.fail)
    publish()
    await follower.finished()
    await publisher.drain()
    await node.get_clock().sleep(keep_alive_s)


async def wait_for_subscriptions(
    publisher: Publisher[Any],
    wanted: int,
    max_wait_s: float | None,
    output: Output,
) -> None:
    """Wait until `wanted` subscriptions match.

    Raises:
        CommandError: fewer matched within `max_wait_s`.
    """
    if publisher.get_subscription_count() >= wanted:
        return
    text = f"Waiting for at least {wanted} matching subscription(s)..."
    output.progress(text)
    try:
        with output.waiting(text):
            async with asyncio.timeout(max_wait_s):
                await publisher.wait_for_subscribers(wanted)
    except TimeoutError:
        raise CommandError(
            f"Timed out waiting for subscribers of '{publisher.topic_name}': expected {wanted}, "
            f"but only got {publisher.get_subscription_count()} in {max_wait_s:g} s; "
            "use --wait-matching-subscriptions 0 to publish without waiting"
        ) from None
