"""Handing calls from other threads to the event loop."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from functools import partial

import pytest

from aionode._process.concurrency import SLICE_NS, checkpoint
from aionode.clock import perf_ns
from aionode.engine.transport import loop_waker
from aionode.engine.transport.loop_waker import LoopWaker, MessageArrivals, ThreadsafeQueue


@pytest.fixture(params=["eventfd", "socketpair"])
async def woken(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[LoopWaker]:
    """A waker of the running loop, in each of its two variants."""
    if request.param == "socketpair":
        monkeypatch.delattr(os, "eventfd", raising=False)
    elif not hasattr(os, "eventfd"):
        pytest.skip("only Linux has eventfd")
    woken = LoopWaker()
    woken.open(asyncio.get_running_loop())
    yield woken
    woken.close()


def in_thread(*calls: Callable[[], None]) -> None:
    """Make calls in another thread, and wait for them."""

    def run() -> None:
        for call in calls:
            call()

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()


async def test_what_a_thread_puts_is_handled_on_the_loop_in_order(woken: LoopWaker) -> None:
    """A topic guarantees order, and callbacks may run only in the loop's thread."""
    taken: list[tuple[int, int]] = []
    done = asyncio.Event()

    def take(item: int) -> None:
        taken.append((item, threading.get_ident()))
        if item == 999:
            done.set()

    queue = ThreadsafeQueue(woken, take)
    in_thread(*(partial(queue.put, n) for n in range(1000)))
    await done.wait()

    assert taken == [(n, threading.get_ident()) for n in range(1000)]


async def test_a_burst_wakes_the_loop_once(
    woken: LoopWaker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A system call for each message would cost more than the message itself."""
    wakes = 0
    wake = woken._wake
    taken: list[int] = []
    queue = ThreadsafeQueue(woken, taken.append)

    def count() -> None:
        nonlocal wakes
        wakes += 1
        wake()

    await drained(woken)
    monkeypatch.setattr(woken, "_wake", count)
    in_thread(*(partial(queue.put, n) for n in range(500)))
    await drained(woken)

    assert wakes == 1
    assert len(taken) == 500


async def test_other_callbacks_run_in_between(
    woken: LoopWaker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A timer still fires, however much arrives."""
    clock: Iterator[int] = iter(range(0, 10**12, SLICE_NS))
    # # each time is one slice later
    monkeypatch.setattr(loop_waker, "perf_ns", lambda: next(clock))
    order: list[str] = []

    def take(item: int) -> None:
        order.append(str(item))
        if item == 0:
            asyncio.get_running_loop().call_soon(order.append, "other")

    queue = ThreadsafeQueue(woken, take)
    for n in range(3 * loop_waker.SLICE_ITEMS):
        queue.put(n)
    await drained(woken)

    assert order.index("other") == loop_waker.SLICE_ITEMS


async def test_a_busy_queue_lets_the_others_have_their_turn(woken: LoopWaker) -> None:
    """A flood on one topic does not delay another."""
    order: list[str] = []
    busy = ThreadsafeQueue[None](woken, lambda _: order.append("busy"))
    calm = ThreadsafeQueue[None](woken, lambda _: order.append("calm"))
    for _ in range(10 * loop_waker.SLICE_ITEMS):
        busy.put(None)
    calm.put(None)
    await drained(woken)

    assert order.index("calm") == loop_waker.SLICE_ITEMS


async def test_a_full_queue_drops_its_oldest(woken: LoopWaker) -> None:
    """Memory stays limited while the loop is busy."""
    taken: list[int] = []
    queue = ThreadsafeQueue(woken, taken.append, limit=3)
    in_thread(*(partial(queue.put, n) for n in range(10)))
    await drained(woken)

    assert taken == [7, 8, 9]


async def test_what_arrives_while_closed_waits_for_the_next_opening(woken: LoopWaker) -> None:
    """A context may be reopened, and nothing is written to a closed descriptor meanwhile."""
    taken: list[int] = []
    queue = ThreadsafeQueue(woken, taken.append)
    woken.close()
    in_thread(partial(queue.put, 1))
    await checkpoint()
    assert taken == []

    woken.open(asyncio.get_running_loop())
    await drained(woken)
    assert taken == [1]


async def test_a_handler_that_fails_does_not_stop_the_rest(woken: LoopWaker) -> None:
    """The loop reports the error, and other handlers continue."""
    reported: list[object] = []
    taken: list[int] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, what: reported.append(what))

    def take(item: int) -> None:
        if item == 1:
            raise ValueError(item)
        taken.append(item)

    queue = ThreadsafeQueue(woken, take)
    in_thread(*(partial(queue.put, n) for n in range(4)))
    await drained(woken)
    await drained(woken)

    assert taken == [0, 2, 3]
    assert len(reported) == 1


async def drained(woken: LoopWaker) -> None:
    """Wait until everything queued before has been handled."""
    last = asyncio.Event()
    ThreadsafeQueue[None](woken, lambda _: last.set()).put(None)
    await last.wait()
    while woken._ready:
        await checkpoint()


async def test_a_queue_may_be_cleared_by_what_it_calls(woken: LoopWaker) -> None:
    """A callback may run from there and destroy its subscription."""
    reported: list[object] = []
    taken: list[int] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, what: reported.append(what))

    def take(item: int) -> None:
        taken.append(item)
        queue.clear()

    queue = ThreadsafeQueue(woken, take)
    in_thread(*(partial(queue.put, n) for n in range(3)))
    await drained(woken)
    assert taken == [0]
    in_thread(partial(queue.put, 3))
    await drained(woken)
    assert taken == [0, 3]
    assert reported == []


async def test_callbacks_may_run_for_a_slice_of_time(
    woken: LoopWaker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The slice is computed once per event, and ends with it."""
    seen: list[int] = []
    lanes = [
        ThreadsafeQueue[int](woken, lambda _: seen.append(woken.inline_deadline_ns))
        for _ in range(2)
    ]
    monkeypatch.setattr(loop_waker, "SLICE_NS", 10**12)  # # no pause of the machine lasts that long
    before_ns = perf_ns()
    in_thread(*(partial(queue.put, 0) for queue in lanes * 2))
    await drained(woken)
    assert len(set(seen)) == 1
    assert before_ns + 10**12 <= seen[0] <= perf_ns() + 10**12
    assert woken.inline_deadline_ns == 0


# Messages


class Arrivals:
    """Byte strings sent from a thread as messages, and their outcomes."""

    def __init__(self, waker: LoopWaker, limit: int, limit_bytes: int) -> None:
        self.taken: list[bytes] = []
        self.dropped = 0
        self.queue: MessageArrivals[bytes] = MessageArrivals(
            waker, self.taken.append, limit, limit_bytes, len, self.drop
        )

    def drop(self, count: int) -> None:
        """Count dropped messages."""
        self.dropped += count

    async def until_empty(self) -> None:
        """Let the loop handle everything."""
        while len(self.queue):
            await checkpoint()


async def test_messages_beyond_the_bytes_of_a_queue_are_dropped_and_counted(
    woken: LoopWaker,
) -> None:
    """A loop that was busy for some seconds used to hold gigabytes of them."""
    arrivals = Arrivals(woken, 10_000, 1_000_000)
    messages = [bytes([number]) * 100_000 for number in range(200)]
    in_thread(*(partial(arrivals.queue.put, message) for message in messages))

    assert sum(map(len, messages[: len(arrivals.queue)])) <= 1_000_000 + 8 * 100_000
    await arrivals.until_empty()

    assert arrivals.taken == messages[:8] + messages[-10:]
    assert arrivals.dropped == 182


async def test_one_message_waits_whatever_its_size(woken: LoopWaker) -> None:
    """The limit applies to queues, not to a single message."""
    arrivals = Arrivals(woken, 10_000, 1_000)
    large = bytes(100_000)
    in_thread(*(partial(arrivals.queue.put, message) for message in [b""] * 8 + [large]))
    await arrivals.until_empty()

    assert arrivals.taken == [b""] * 8 + [large]
    assert arrivals.dropped == 0


async def test_messages_of_one_thread_stay_in_order_while_others_are_taken(
    woken: LoopWaker,
) -> None:
    """Some have a size and some do not, and the loop takes from both at the same time."""
    arrivals = Arrivals(woken, 100_000, 1 << 30)
    messages = [number.to_bytes(4, "big") for number in range(20_000)]

    def put_all() -> None:
        for message in messages:
            arrivals.queue.put(message)

    thread = threading.Thread(target=put_all)
    thread.start()
    while len(arrivals.taken) < len(messages):
        await checkpoint()
    thread.join()

    assert arrivals.taken == messages


async def test_messages_beyond_their_number_push_out_the_oldest(woken: LoopWaker) -> None:
    """As in all of these queues; the publisher retransmits them, or the numbers show the gap."""
    arrivals = Arrivals(woken, 20, 1 << 30)
    messages = [number.to_bytes(4, "big") for number in range(100)]
    in_thread(*(partial(arrivals.queue.put, message) for message in messages))
    arrivals.queue.take_all()

    assert arrivals.taken == messages[:8] + messages[-20:]
    assert arrivals.dropped == 0
