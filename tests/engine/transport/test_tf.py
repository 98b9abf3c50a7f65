"""Transforms over every transport, in both directions; late joiners get static ones."""

from __future__ import annotations

from aionode import Time
from aionode.clock import ClockType
from aionode.tf import Buffer, StaticTransformBroadcaster, TransformBroadcaster
from tests.engine.transport.test_contract import Pair, pair
from tests.support.transforms import senders, transform

__all__ = ["pair"]  # the fixture

ROS_PACKAGES = ("tf2_msgs",)
"""Packages that the installed ROS must have."""


async def test_a_late_buffer_has_static_transforms_and_awaits_the_others(pair: Pair) -> None:
    """The sender of both is named."""
    StaticTransformBroadcaster(pair.left).sendTransform(
        [transform("base", "camera"), transform("base", "arm")]
    )
    moving = TransformBroadcaster(pair.left)
    buffer = Buffer(pair.right)
    await buffer.wait_for_transform("camera", "arm", timeout_sec=20.0)
    await moving.pub_tf.wait_for_subscribers()
    for stamp in (1.0, 2.0):
        moving.sendTransform(transform("odom", "base", stamp))
    found = await buffer.wait_for_transform(
        "odom", "camera", Time(seconds=1.5, clock_type=ClockType.ROS_TIME), timeout_sec=20.0
    )
    assert found.transform.translation.x == 2.0
    sender = pair.left.get_fully_qualified_name()
    await pair.right.graph.until(lambda: senders(buffer) == {sender})
