"""Sending from a thread."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator

import pytest

from aionode.settle import one_turn
from aionode.transport.sender import Outlet, Sender, end_all
from aionode.transport.wakeup import Wakeup


@pytest.fixture
async def sender() -> AsyncIterator[Sender]:
    """A sender that wakes the running loop."""
    wakeup = Wakeup()
    wakeup.open(asyncio.get_running_loop())
    yield Sender("test-sender", wakeup)
    wakeup.close()


def blocked(outlet: Outlet) -> threading.Event:
    """Have the thread wait for the returned event."""
    began, gate = threading.Event(), threading.Event()

    def wait() -> None:
        began.set()
        gate.wait()

    outlet.put(wait)
    began.wait()
    return gate


async def test_sends_happen_in_order_and_drain_waits_for_them(sender: Sender) -> None:
    """Order is what a topic promises."""
    sent: list[int] = []
    outlet = sender.outlet(1000, keep_all=True)
    for n in range(100):
        outlet.put(lambda n=n: sent.append(n))  # type: ignore[misc]  # a default is no argument
    await outlet.drain()

    assert sent == list(range(100))
    assert len(outlet) == 0
    await sender.flush()


async def test_a_full_queue_that_keeps_all_has_no_room(sender: Sender) -> None:
    """The publisher is told, and nothing is lost."""
    outlet = sender.outlet(3, keep_all=True)
    gate = blocked(outlet)
    outlet.put(lambda: None)
    assert outlet.has_room()
    outlet.put(lambda: None)
    assert not outlet.has_room()

    gate.set()
    await outlet.drain()
    assert outlet.has_room()
    await sender.flush()


async def test_a_full_queue_that_keeps_the_last_drops_its_oldest(sender: Sender) -> None:
    """A slow link gets the newest image, not a long queue of old ones."""
    sent: list[int] = []
    outlet = sender.outlet(2, keep_all=False)
    gate = blocked(outlet)
    for n in range(10):
        outlet.put(lambda n=n: sent.append(n))  # type: ignore[misc]  # a default is no argument
    gate.set()
    await outlet.drain()

    assert sent == [8, 9]
    assert outlet.dropped == 8
    await sender.flush()


async def test_the_loop_goes_on_while_a_send_blocks(sender: Sender) -> None:
    """That is what the thread is for."""
    outlet = sender.outlet(2, keep_all=True)
    gate = blocked(outlet)
    drained = asyncio.get_running_loop().create_task(outlet.drain())
    for _ in range(100):
        await one_turn()
    assert not drained.done()

    gate.set()
    await drained
    await sender.flush()


async def test_a_flushed_sender_has_no_thread_and_starts_another_when_needed(
    sender: Sender,
) -> None:
    """A closed context leaves no thread, and may be opened again."""
    outlet = sender.outlet(2, keep_all=True)
    for _ in range(2):
        outlet.put(lambda: None)
        await sender.flush()
        assert len(outlet) == 0
    for thread in threading.enumerate():
        if thread.name == "test-sender":
            thread.join()


async def test_an_abandoned_queue_sends_nothing_more_and_counts_it(sender: Sender) -> None:
    """At the end of a publisher whose readers take nothing."""
    lost: list[int] = []
    outlet = sender.outlet(10, keep_all=True, lost=lost.append)
    gate = blocked(outlet)
    sent: list[int] = []
    for n in range(5):
        outlet.put(lambda n=n: sent.append(n))  # type: ignore[misc]  # a default is no argument
    outlet.abandon()
    gate.set()
    await outlet.drain()

    assert sent == []
    assert lost == [5]
    await sender.flush()


async def test_the_end_of_the_process_waits_for_a_send_and_lets_none_begin(sender: Sender) -> None:
    """A thread that comes back from Zenoh while the interpreter ends aborts the process."""
    outlet = sender.outlet(10, keep_all=True)
    gate = blocked(outlet)
    sent: list[int] = []
    outlet.put(lambda: sent.append(1))
    threading.Timer(0.05, gate.set).start()
    end_all()

    assert sent == []
    assert "test-sender" not in [thread.name for thread in threading.enumerate()]
