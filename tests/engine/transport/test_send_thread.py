"""Sending from a separate thread."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import threading
from collections.abc import AsyncIterator

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.send_thread import SendQueue, SendThread, end_all


@pytest.fixture
async def send_thread() -> AsyncIterator[SendThread]:
    """A sender that wakes the running loop."""
    waker = LoopWaker()
    waker.open(asyncio.get_running_loop())
    yield SendThread("test-sender", waker)
    waker.close()


def blocked(send_queue: SendQueue) -> threading.Event:
    """Make the thread wait for the returned event."""
    began, gate = threading.Event(), threading.Event()

    def wait() -> None:
        began.set()
        gate.wait()

    send_queue.put(wait)
    began.wait()
    return gate


async def test_sends_happen_in_order_and_drain_waits_for_them(send_thread: SendThread) -> None:
    """A topic guarantees order."""
    sent: list[int] = []
    send_queue = send_thread.send_queue(1000, keep_all=True)
    for n in range(100):
        send_queue.put(lambda n=n: sent.append(n))  # type: ignore[misc]  # only a default
    await send_queue.drain()

    assert sent == list(range(100))
    assert len(send_queue) == 0
    await send_thread.flush()


async def test_a_full_queue_that_keeps_all_has_no_room(send_thread: SendThread) -> None:
    """The publisher is told, and no message is lost."""
    send_queue = send_thread.send_queue(3, keep_all=True)
    gate = blocked(send_queue)
    send_queue.put(lambda: None)
    assert send_queue.has_room()
    send_queue.put(lambda: None)
    assert not send_queue.has_room()

    gate.set()
    await send_queue.drain()
    assert send_queue.has_room()
    await send_thread.flush()


async def test_a_full_queue_that_keeps_the_last_drops_its_oldest(send_thread: SendThread) -> None:
    """Over a slow link the newest image arrives, rather than a long queue of old ones."""
    sent: list[int] = []
    send_queue = send_thread.send_queue(2, keep_all=False)
    gate = blocked(send_queue)
    for n in range(10):
        send_queue.put(lambda n=n: sent.append(n))  # type: ignore[misc]  # only a default
    gate.set()
    await send_queue.drain()

    assert sent == [8, 9]
    assert send_queue.dropped == 8
    await send_thread.flush()


async def test_the_loop_goes_on_while_a_send_blocks(send_thread: SendThread) -> None:
    """This is the purpose of the thread."""
    send_queue = send_thread.send_queue(2, keep_all=True)
    gate = blocked(send_queue)
    drained = asyncio.get_running_loop().create_task(send_queue.drain())
    for _ in range(100):
        await checkpoint()
    assert not drained.done()

    gate.set()
    await drained
    await send_thread.flush()


async def test_a_flushed_sender_has_no_thread_and_starts_another_when_needed(
    send_thread: SendThread,
) -> None:
    """A closed context leaves no thread behind, and may be reopened."""
    send_queue = send_thread.send_queue(2, keep_all=True)
    for _ in range(2):
        send_queue.put(lambda: None)
        await send_thread.flush()
        assert len(send_queue) == 0
    for thread in threading.enumerate():
        if thread.name == "test-sender":
            thread.join()


async def test_an_abandoned_queue_sends_nothing_more_and_counts_it(send_thread: SendThread) -> None:
    """This happens at the end of a publisher whose readers do not read."""
    lost: list[int] = []
    send_queue = send_thread.send_queue(10, keep_all=True, lost=lost.append)
    gate = blocked(send_queue)
    sent: list[int] = []
    for n in range(5):
        send_queue.put(lambda n=n: sent.append(n))  # type: ignore[misc]  # only a default
    send_queue.abandon()
    gate.set()
    await send_queue.drain()

    assert sent == []
    assert lost == [5]
    await send_thread.flush()


async def test_jobs_run_in_the_calling_thread_when_no_thread_can_be_started(
    send_thread: SendThread, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While the interpreter shuts down, another thread's loop may still have messages to send."""

    def refuse(_: threading.Thread) -> None:
        raise RuntimeError("can't create new thread at interpreter shutdown")

    monkeypatch.setattr(threading.Thread, "start", refuse)
    send_queue = send_thread.send_queue(10, keep_all=True)
    threads: list[threading.Thread] = []
    send_queue.put(lambda: threads.append(threading.current_thread()))
    await send_queue.drain()
    await send_thread.flush()

    assert threads == [threading.current_thread()]


async def test_the_end_of_the_process_waits_for_a_send_and_lets_none_begin(
    send_thread: SendThread,
) -> None:
    """A thread that returns from Zenoh while the interpreter exits would abort the process."""
    send_queue = send_thread.send_queue(10, keep_all=True)
    gate = blocked(send_queue)
    sent: list[int] = []
    send_queue.put(lambda: sent.append(1))
    threading.Timer(0.05, gate.set).start()
    end_all()

    assert sent == []
    assert "test-sender" not in [thread.name for thread in threading.enumerate()]


def test_a_process_that_exits_waits_for_the_send_that_a_thread_is_in() -> None:
    """Exiting while a thread is inside Zenoh would abort the process (SIGABRT)."""
    program = """
import os, threading, time
from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.send_thread import SendThread

began = threading.Event()

def send():
    began.set()
    time.sleep(0.2)
    os.write(1, b"sent")

SendThread("test-sender", LoopWaker()).submit(send)
began.wait()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, check=False)

    assert (done.returncode, done.stdout, done.stderr) == (0, b"sent", b"")


def test_a_process_that_exits_waits_for_a_thread_that_a_daemon_has_started() -> None:
    """The thread is then a daemon too, and Python would exit while it is inside Zenoh."""
    program = """
import os, threading, time
from aionode.engine.transport.send_thread import start_thread

def close():
    time.sleep(0.2)
    os.write(1, b"closed")

daemon = threading.Thread(
    target=lambda: start_thread(threading.Thread(target=close)), daemon=True
)
daemon.start()
daemon.join()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, check=False)

    assert (done.returncode, done.stdout, done.stderr) == (0, b"closed", b"")
