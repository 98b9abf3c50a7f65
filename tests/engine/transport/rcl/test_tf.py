"""Transforms between an aionode node and a node of real rclpy in another process, over DDS."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from aionode.engine.context import Context
from aionode.node import Node
from aionode.tf import Buffer, StaticTransformBroadcaster, TransformBroadcaster
from tests.support.ros import ros_domain, ros_missing, ros_peer
from tests.support.transforms import senders, transform

if TYPE_CHECKING:
    import subprocess
    from collections.abc import AsyncIterator

WHY_NOT = ros_missing("tf2_msgs")

pytestmark = pytest.mark.skipif(bool(WHY_NOT), reason=WHY_NOT or "there is a ROS 2 with tf2_msgs")


@pytest.fixture(autouse=True)
def local(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the tests off the network."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


@asynccontextmanager
async def our_node(domain_id: int) -> AsyncIterator[Node]:
    """Run the node ``/ours``."""
    async with (
        asyncio.timeout(40),
        Context(transport="rcl", domain_id=domain_id) as context,
        Node("ours", context=context) as node,
    ):
        yield node


async def until_told(peer: subprocess.Popen[str], *wanted: str) -> None:
    """Return when the peer has printed all given lines."""
    missing = set(wanted)
    while missing:
        assert peer.stdout is not None
        line = await asyncio.to_thread(peer.stdout.readline)
        assert line, f"the peer has ended; it has not said {missing}"
        missing.discard(line.strip())


async def test_a_late_buffer_has_the_static_transforms_of_rclpy_and_hears_the_others() -> None:
    """Their sender is named; for other transforms the buffer waits a moment."""
    domain_id = ros_domain(70)
    with ros_peer(domain_id, "ros_tf_peer"):
        async with our_node(domain_id) as node:
            buffer = Buffer(node)
            static = await buffer.wait_for_transform("peer_arm", "peer_camera")
            assert static.transform.translation.x == -1.0
            await buffer.wait_for_transform("peer_map", "peer_camera")
            now = node.get_clock().now()
            found = await buffer.wait_for_transform("peer_map", "peer_camera", now)
            assert found.transform.translation.x == 3.0
            await node.graph.until(lambda: senders(buffer) == {"/tf_peer"})


async def test_a_late_node_of_rclpy_gets_our_static_transforms_and_hears_the_others() -> None:
    """Including those of several calls, which late joiners get as one message."""
    domain_id = ros_domain(71)
    async with our_node(domain_id) as node:
        static = StaticTransformBroadcaster(node)
        static.sendTransform(transform("base", "camera", translation=(2.0, 0.0, 0.0)))
        static.sendTransform(transform("base", "arm", translation=(3.0, 0.0, 0.0)))
        moving = TransformBroadcaster(node)
        with ros_peer(domain_id, "ros_tf_peer") as peer:
            await until_told(peer, "/tf_static base camera 2.0", "/tf_static base arm 3.0")
            await moving.pub_tf.wait_for_subscribers()
            moving.sendTransform(transform("map", "base"))
            await until_told(peer, "/tf map base 1.0")
