"""Tests as a user writes them, quoted in docs/howto/testing.md."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode import Context, Node
from aionode.engine.transport.local import LocalTransport
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.testing import FaultyTransport, ManualClock, settle

if TYPE_CHECKING:
    from collections.abc import Callable


class WordCounter(Node):
    """Publishes on /count how many words each message of /text has."""

    def __init__(self, **options: Any) -> None:
        super().__init__("word_counter", **options)
        self.publisher = self.create_publisher(Int32, "/count", 10)
        self.subscription = self.create_subscription(String, "/text", self.count, 10)

    def count(self, msg: String) -> None:
        """Count the words of one message."""
        self.publisher.publish(Int32(data=len(msg.data.split())))


class Heart(Node):
    """Beats once a second."""

    def __init__(self, **options: Any) -> None:
        super().__init__("heart", **options)
        self.beats: list[float] = []
        self.create_timer(1.0, self.beat)

    def beat(self) -> None:
        """Record the time of a beat."""
        self.beats.append(self.get_clock().now().nanoseconds / 1e9)


async def test_the_counter_counts_what_it_hears(
    aionode_context: Context, node_factory: Callable[..., Node]
) -> None:
    """Words are separated by blanks."""
    tester = node_factory("tester")
    counts: list[int] = []
    tester.create_subscription(Int32, "/count", lambda msg: counts.append(msg.data))
    text = tester.create_publisher(String, "/text", 10)

    async with WordCounter(context=aionode_context):
        text.publish(String(data="one two three"))
        await settle()

    assert counts == [3]


async def test_the_heart_beats_once_a_second(
    aionode_context: Context, manual_clock: ManualClock
) -> None:
    """The first beat comes after one period; the test takes no time at all."""
    async with Heart(context=aionode_context) as heart:
        await manual_clock.advance(3.5)

    assert heart.beats == [1.0, 2.0, 3.0]


async def test_a_stalled_heart_beats_once(
    aionode_context: Context, manual_clock: ManualClock
) -> None:
    """Missed beats are left out, and the grid is kept."""
    async with Heart(context=aionode_context) as heart:
        await manual_clock.jump(3.5)
        await manual_clock.advance(1.0)

    assert heart.beats == [3.5, 4.0]


async def test_messages_get_lost_on_a_bad_network() -> None:
    """Half of them, and the same half in each run of the test."""
    network = FaultyTransport(LocalTransport(), drop=0.5, seed=1)
    async with Context(transport=network) as context, Node("tester", context=context) as tester:
        heard: list[int] = []
        tester.create_subscription(Int32, "/count", lambda msg: heard.append(msg.data), 100)
        publisher = tester.create_publisher(Int32, "/count", 10)

        for number in range(100):
            publisher.publish(Int32(data=number))
        await settle()

    assert 30 < len(heard) < 70
    assert heard == sorted(heard)
