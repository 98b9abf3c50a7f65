"""Bags with a process of real rclpy over DDS: recording its topics, and playing to it."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from aionode import bag
from aionode.clock import Time
from aionode.engine.context import Context
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import QoSProfile, ReliabilityPolicy
from tests.support.ros import ros_domain, ros_missing, ros_peer
from tests.support.waiting import until

if TYPE_CHECKING:
    import subprocess
    from collections.abc import AsyncIterator, Iterator
    from pathlib import Path

WHY_NOT = ros_missing()

pytestmark = pytest.mark.skipif(bool(WHY_NOT), reason=WHY_NOT or "there is a ROS 2")

DOMAIN_OFFSET = 80


@pytest.fixture(scope="module")
def peer() -> Iterator[subprocess.Popen[str]]:
    """A process of rclpy that echoes what it receives on ``/to_echo``."""
    with ros_peer(ros_domain(DOMAIN_OFFSET)) as process:
        yield process


@pytest.fixture(autouse=True)
def local(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the tests off the network."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


@asynccontextmanager
async def our_node() -> AsyncIterator[Node]:
    """Run the node ``/ours``, once it knows ``/peer``."""
    async with (
        asyncio.timeout(60),
        Context(transport="rcl", domain_id=ros_domain(DOMAIN_OFFSET)) as context,
        Node("ours", context=context) as node,
    ):
        await node.wait_for_node("/peer")
        yield node


async def test_the_topics_of_rclpy_are_recorded_in_simulated_time_with_qos_overrides(
    peer: subprocess.Popen[str], tmp_path: Path
) -> None:
    """The bag has its bytes, types and profiles, and also the messages it had latched."""
    overrides = {"/echoed": QoSProfile(depth=7, reliability=ReliabilityPolicy.BEST_EFFORT)}
    async with our_node() as node:
        clock = node.create_publisher(Clock, "/clock", 10)
        words = node.create_publisher(String, "to_echo", 10)
        async with bag.Recorder(
            tmp_path / "run",
            topics=["/echoed", "/map"],
            context=node.context,
            qos=overrides,
            use_sim_time=True,
        ) as recorder:
            await until(lambda: recorder.stats.keys() == {"/echoed", "/map"})
            (subscription,) = [e for e in recorder.node.subscriptions if e.topic_name == "/echoed"]
            assert subscription.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
            await words.wait_for_subscribers()
            clock.publish(Clock(clock=Time(seconds=5).to_msg()))
            await until(lambda: recorder.node.get_clock().now().nanoseconds == 5 * 10**9)
            for number in range(1, 4):
                words.publish(String(data="hello"))
                await until(lambda: recorder.stats["/echoed"].recorded >= number)  # noqa: B023  # here
            await until(lambda: recorder.stats["/map"].recorded >= 3)
    with bag.open(tmp_path / "run") as run:
        echoes = list(run.read("/echoed"))
        assert {each.message.data for each in echoes} == {"hello"}
        assert echoes[-1].time_ns == 5 * 10**9
        assert echoes[-1].publish_time_ns > 10**18, "the publisher's time is the computer's"
        assert [each.message.data for each in run.read("/map")] == ["2", "3", "4"]
        assert run.topics["/echoed"].type_hash.startswith("RIHS01_")


async def test_a_bag_is_played_to_rclpy(peer: subprocess.Popen[str], tmp_path: Path) -> None:
    """It receives the messages in order."""
    texts = [str(number) for number in range(50)]
    with bag.BagWriter(tmp_path / "run") as out:
        for number, text in enumerate(texts):
            out.write_message("/to_echo", String(data=text), Time(nanoseconds=1 + number * 10**6))
    heard: list[str] = []
    done = asyncio.Event()

    def hear(msg: String) -> None:
        heard.append(msg.data)
        if len(heard) == len(texts):
            done.set()

    async with our_node() as node:
        echoed = node.create_subscription(String, "echoed", hear, 100)
        await until(echoed.get_publisher_count)
        async with bag.Player(tmp_path / "run", context=node.context, wait_acked_sec=10) as player:
            (publisher,) = [e for e in player.node.publishers if e.topic_name == "/to_echo"]
            await publisher.wait_for_subscribers()
            assert await player.play()
            await done.wait()
    assert heard == texts
