"""Calls from threads that are not the event loop's."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest

from aionode.engine import loop_affinity
from aionode.engine.loop_affinity import LoopAffinity
from aionode.errors import EntityDestroyedError, MessageError, QueueFullError
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import HistoryPolicy, QoSProfile
from aionode.testing import settle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.node import Node


async def test_an_offloaded_callback_publishes_what_it_computed(node: Node) -> None:
    """This is why callbacks are offloaded; threads may only call `call_soon_threadsafe`."""
    heard: list[str] = []
    node.create_subscription(String, "out", lambda msg: heard.append(msg.data))
    out = node.create_publisher(String, "out", 10)
    node.create_subscription(String, "in", out.publish, offload=True)
    source = node.create_publisher(String, "in", 10)
    for text in "abc":
        source.publish(String(data=text))
    await settle()
    assert heard == ["a", "b", "c"]


async def test_a_thread_gets_the_error_of_its_message(node: Node) -> None:
    """As in the thread of the loop."""
    await settle()
    publisher = node.create_publisher(String, "words", 10)
    with pytest.raises(MessageError, match=r"String\.data"):
        await asyncio.to_thread(publisher.publish, String(data=5))  # type: ignore[arg-type]


async def test_a_thread_cannot_fill_the_loop_with_messages(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It waits until each is taken, so the same limits apply."""
    monkeypatch.setattr("aionode.qos._profile.KEEP_ALL_DEPTH", 2)
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL, depth=1)
    await settle()
    node.create_subscription(String, "words", qos_profile=keep_all)
    publisher = node.create_publisher(String, "words", 10)

    def flood() -> None:
        for _ in range(3):
            publisher.publish(String())

    with pytest.raises(QueueFullError):
        await asyncio.to_thread(flood)
    assert publisher.stats.published == 2


async def test_a_thread_ends_a_node_that_runs(node_factory: Callable[..., Node]) -> None:
    """The loop is woken for it."""
    node = node_factory()
    await settle()
    with ThreadPoolExecutor(1) as pool:
        pool.submit(node.destroy_node).result()
    await settle()
    assert node.destroyed
    with pytest.raises(EntityDestroyedError):
        node.create_publisher(String, "words", 10)


def test_without_a_running_loop_calls_are_made_at_once() -> None:
    """A node can be set up and destroyed without a loop."""
    done: list[str] = []
    nowhere = LoopAffinity()
    nowhere.call(lambda: done.append("call"))
    nowhere.wait_for(done.append, "wait")
    assert done == ["call", "wait"]


def test_a_thread_does_not_wait_for_a_loop_that_was_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A loop may be closed before it executes the last call of a thread."""
    monkeypatch.setattr(loop_affinity, "PATIENCE_S", 0.0)
    loop = asyncio.new_event_loop()
    place = LoopAffinity()

    async def attach() -> None:
        place.attach()

    loop.run_until_complete(attach())
    with ThreadPoolExecutor(1) as pool:
        waits = pool.submit(place.wait_for, print)
        loop.call_soon(loop.stop)
        loop.close()
        with pytest.raises(RuntimeError, match="closed"):
            waits.result()
        pool.submit(place.call, lambda: pytest.fail("the loop is closed")).result()
