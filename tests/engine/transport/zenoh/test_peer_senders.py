"""Requests and replies to peers, any of which may be frozen."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator
from functools import partial

import pytest

from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.zenoh.delivery import peer_senders
from aionode.engine.transport.zenoh.delivery.peer_senders import (
    ALLOWANCE_BYTES,
    OVERHEAD_BYTES,
    UNSEEN_BYTES,
    PeerSenders,
)


@pytest.fixture
def full() -> set[str]:
    """Peers whose connections have no room."""
    return set()


@pytest.fixture
async def peers(full: set[str]) -> AsyncIterator[PeerSenders]:
    """PeerSenders whose threads wake the running loop."""
    waker = LoopWaker()
    waker.open(asyncio.get_running_loop())
    peers = PeerSenders(waker, lambda participant: (participant not in full, 0))
    yield peers
    for send_thread in peers.send_threads():
        await send_thread.flush()
    waker.close()


class Sent:
    """The thread in which each job ran."""

    def __init__(self) -> None:
        self.threads: list[threading.Thread] = []

    def __call__(self) -> None:
        """Record the thread."""
        self.threads.append(threading.current_thread())

    @property
    def direct(self) -> int:
        """How many ran on the loop's thread."""
        return self.threads.count(threading.main_thread())


def waited(gate: threading.Event) -> None:
    """Hang until the gate is opened."""
    gate.wait()


async def test_thousands_of_peers_that_read_nothing_share_a_few_threads(
    peers: PeerSenders, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Otherwise whoever announces them could exhaust this process's threads."""
    monkeypatch.setattr(peer_senders, "MAX_THREADS", 3)
    gate, sent = threading.Event(), Sent()
    for number in range(100):
        for job in (partial(waited, gate), sent):
            peers.send([f"invented{number}"], ALLOWANCE_BYTES, job)
    threads = len(peers.send_threads())
    gate.set()
    for send_thread in peers.send_threads():
        await send_thread.flush()

    assert threads <= 3 + peer_senders.SHARED
    assert len(sent.threads) == 100


async def test_a_peer_that_answers_is_sent_to_from_the_loop(peers: PeerSenders) -> None:
    """A thread in between would add latency."""
    sent = Sent()
    for _ in range(10_000):
        peers.send(("a",), 100, sent)
        peers.heard("a")
    assert sent.direct == 10_000


async def test_a_peer_that_gives_no_sign_of_life_is_sent_to_from_a_thread(
    peers: PeerSenders,
) -> None:
    """What the loop has sent until then fits into the queues, so it never waits."""
    sent = Sent()
    for _ in range(1000):
        peers.send(("a",), 1_000, sent)
    assert sent.direct * 1_000 <= ALLOWANCE_BYTES
    (send_thread,) = peers.send_threads()
    await send_thread.flush()
    assert len(sent.threads) == 1000


async def test_a_peer_that_hangs_holds_up_no_other(peers: PeerSenders) -> None:
    """Each has its own thread; while that is busy, the loop sends nothing there either."""
    gate = threading.Event()
    sent = Sent()
    peers.send(("frozen",), 2 * ALLOWANCE_BYTES, partial(waited, gate))
    peers.heard("frozen")
    peers.send(("frozen",), 10, sent)
    peers.send(("frozen", "other"), 10, sent)
    assert sent.direct == 0
    peers.send(("other",), 10, sent)
    assert sent.direct == 1
    gate.set()


async def test_the_threads_of_peers_that_are_done_end(peers: PeerSenders) -> None:
    """A robot that runs for weeks sees many peers in trouble."""
    for name in "abc":
        peers.send((name,), 2 * ALLOWANCE_BYTES, Sent())
        for send_thread in peers.send_threads():
            while send_thread.busy:
                await asyncio.to_thread(lambda: None)
    assert len(peers.send_threads()) == 1


async def test_nothing_is_sent_to_a_peer_that_takes_nothing_until_it_does(
    peers: PeerSenders, full: set[str]
) -> None:
    """Zenoh would wait for it with a lock that the end of the peer's lease needs."""
    full.add("frozen")
    sent = Sent()
    for _ in range(50):
        peers.send(("frozen",), UNSEEN_BYTES // 10, sent)
    assert sent.direct * UNSEEN_BYTES // 10 <= ALLOWANCE_BYTES
    assert len(sent.threads) == sent.direct

    full.clear()
    (send_thread,) = peers.send_threads()
    await send_thread.flush()
    assert len(sent.threads) == 50


async def test_a_thread_looks_now_and_then_whether_its_peer_takes_what_it_sends() -> None:
    """Each check goes through all descriptors of the process."""
    waker = LoopWaker()
    waker.open(asyncio.get_running_loop())
    looks = 0

    def look(_: str) -> tuple[bool, int]:
        nonlocal looks
        looks += 1
        return True, looks * UNSEEN_BYTES

    peers = PeerSenders(waker, look)
    for _ in range(1000):
        peers.send(("slow",), 1000, Sent())
    (send_thread,) = peers.send_threads()
    await send_thread.flush()
    waker.close()

    assert 1 <= looks <= 2 + 1000 * (1000 + OVERHEAD_BYTES) // UNSEEN_BYTES


async def test_a_connection_that_zenoh_had_no_time_to_fill_is_looked_at_again() -> None:
    """It has room, but what was sent before still waits in Zenoh's queue."""
    waker = LoopWaker()
    waker.open(asyncio.get_running_loop())
    seen = iter([(True, 0), (False, 0), (True, 0), (True, 0)])
    peers = PeerSenders(waker, lambda _: next(seen))
    sent = Sent()
    peers.submit("busy", 1, sent)
    (send_thread,) = peers.send_threads()
    await send_thread.flush()
    waker.close()

    assert len(sent.threads) == 1
    assert next(seen, None) is None


async def test_what_waits_for_a_peer_ends_with_the_session(
    peers: PeerSenders, full: set[str]
) -> None:
    """A program that ends does not wait for a frozen peer."""
    full.add("frozen")
    sent = Sent()
    peers.submit("frozen", 1, sent)
    (send_thread,) = peers.send_threads()
    peers.clear()
    await send_thread.flush()
    assert not sent.threads
