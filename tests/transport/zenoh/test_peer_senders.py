"""Requests and replies towards peers of which any may be frozen."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator
from functools import partial

import pytest

from aionode.transport._loop_waker import LoopWaker
from aionode.transport.zenoh._peer_senders import ALLOWANCE_BYTES, PeerSenders


@pytest.fixture
async def peers() -> AsyncIterator[PeerSenders]:
    """PeerSenders whose threads wake the running loop."""
    waker = LoopWaker()
    waker.open(asyncio.get_running_loop())
    peers = PeerSenders(waker)
    yield peers
    for send_thread in peers.send_threads():
        await send_thread.flush()
    waker.close()


class Sent:
    """Where each job ran."""

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


async def test_a_peer_that_answers_is_sent_to_from_the_loop(peers: PeerSenders) -> None:
    """A thread between would cost latency."""
    sent = Sent()
    for _ in range(10_000):
        peers.send(("a",), 100, sent)
        peers.heard("a")
    assert sent.direct == 10_000


async def test_a_peer_that_gives_no_sign_of_life_is_sent_to_from_a_thread(
    peers: PeerSenders,
) -> None:
    """What the loop has sent by then fits into the queues between, so it never waits."""
    sent = Sent()
    for _ in range(1000):
        peers.send(("a",), 1_000, sent)
    assert sent.direct * 1_000 <= ALLOWANCE_BYTES
    (send_thread,) = peers.send_threads()
    await send_thread.flush()
    assert len(sent.threads) == 1000


async def test_a_peer_that_hangs_holds_up_no_other(peers: PeerSenders) -> None:
    """Each has its own thread; and while that is busy the loop sends nothing there either."""
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
