"""An event loop that other threads may use while its own sleeps."""

from __future__ import annotations

import asyncio
import queue
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from aionode.lendable_loop import LendableLoop, Readers

PATIENCE_S = 10.0

pytestmark = pytest.mark.timeout(30)


@contextmanager
def running_loop(*, debug: bool = False) -> Iterator[LendableLoop]:
    """Run a loop in a thread of its own."""
    loop = LendableLoop()
    loop.set_debug(debug)
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    try:
        yield loop
    finally:
        if not loop.is_closed():
            loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


def borrow(loop: LendableLoop) -> None:
    """Borrow the loop once it sleeps."""
    for _ in range(10_000):
        if loop.borrow():
            return
        threading.Event().wait(0.001)
    pytest.fail("the loop never sleeps")


@pytest.mark.parametrize(
    "schedule",
    [
        pytest.param(lambda loop, work: loop.call_soon(work), id="call_soon"),
        pytest.param(lambda loop, work: loop.call_later(0.01, work), id="call_later"),
        pytest.param(lambda loop, work: loop.create_task(do(work)), id="create_task"),
    ],
)
def test_the_loop_does_what_its_borrower_has_scheduled(
    schedule: Callable[[LendableLoop, Callable[[], None]], object],
) -> None:
    """It was asleep without a limit, and nothing else wakes it."""
    done = threading.Event()
    with running_loop() as loop:
        borrow(loop)
        schedule(loop, done.set)
        loop.give_back()

        assert done.wait(PATIENCE_S)


async def do(work: Callable[[], None]) -> None:
    """Do it in a task."""
    work()


def test_a_loop_that_is_borrowed_does_nothing() -> None:
    """What belongs to the thread of the loop is the borrower's alone."""
    done = threading.Event()
    with running_loop() as loop:
        borrow(loop)
        loop.call_soon_threadsafe(done.set)

        assert not done.wait(0.05)
        loop.give_back()
        assert done.wait(PATIENCE_S)


def test_a_loop_that_works_is_not_lent() -> None:
    """The borrower does not wait for it either: it hands its work over in another way."""
    working, go_on = threading.Event(), threading.Event()
    with running_loop() as loop:

        def work() -> None:
            working.set()
            go_on.wait(PATIENCE_S)

        loop.call_soon_threadsafe(work)
        assert working.wait(PATIENCE_S)

        assert not loop.borrow()
        go_on.set()


def test_a_loop_has_one_borrower() -> None:
    """Two threads that send at the same time do not meet in it."""
    with running_loop() as loop:
        borrow(loop)

        assert not loop.borrow()
        loop.give_back()


def test_the_borrowed_loop_is_the_running_one() -> None:
    """Code of the loop asks for it, also where the borrower's thread runs another one."""
    with running_loop() as loop:

        async def main() -> None:
            own = asyncio.get_running_loop()
            borrow(loop)
            borrowed = asyncio.get_running_loop()
            loop.give_back()
            assert borrowed is loop
            assert asyncio.get_running_loop() is own

        asyncio.run(main())


def test_a_loop_in_debug_mode_is_not_lent() -> None:
    """It checks then that only the loop's own thread uses it."""
    with running_loop(debug=True) as loop:
        assert not any(loop.borrow() for _ in range(10_000))


def test_giving_back_a_loop_that_was_closed_meanwhile_has_no_effect() -> None:
    """A thread may still send while its context is shut down."""
    loop = LendableLoop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    borrow(loop)
    loop.call_soon_threadsafe(loop.stop)
    loop.call_soon(lambda: None)
    loop.give_back()
    thread.join()
    loop.close()

    assert not loop.borrow()


# In place of the loop


@pytest.fixture
def pair() -> Iterator[tuple[socket.socket, socket.socket]]:
    """Return two sockets that are connected."""
    here, there = socket.socketpair()
    with here, there:
        yield here, there


def readers_of(loop: LendableLoop) -> Readers:
    """Return the descriptors of a loop, or skip the test."""
    if loop.readers is None:
        pytest.skip("this system has no epoll")
    return loop.readers


def watch(loop: LendableLoop, sock: socket.socket) -> queue.Queue[int]:
    """Read a socket in a loop; each time the queue gets the thread that does it."""
    read: queue.Queue[int] = queue.Queue()

    def take() -> None:
        sock.recv(100)
        read.put(threading.get_ident())

    borrow(loop)
    loop.add_reader(sock.fileno(), take)
    loop.give_back()
    return read


def test_the_thread_that_waits_in_place_of_the_loop_reads(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """And the loop does so before and afterwards."""
    here, there = pair
    with running_loop() as loop:
        readers, read = readers_of(loop), watch(loop, here)
        there.send(b"before")
        assert read.get(timeout=PATIENCE_S) != threading.get_ident()

        assert readers.begin()
        there.send(b"meanwhile")
        while read.empty():
            assert readers.call(readers.wait(PATIENCE_S))
        readers.end()
        assert read.get() == threading.get_ident()

        there.send(b"afterwards")
        assert read.get(timeout=PATIENCE_S) != threading.get_ident()


def test_one_thread_waits_in_place_of_the_loop() -> None:
    """Another one waits in its own way."""
    with running_loop() as loop:
        readers = readers_of(loop)

        assert readers.begin()
        assert not readers.begin()
        readers.end()
        assert readers.begin()
        readers.end()


@pytest.mark.parametrize("way", ["rouse", "close"])
def test_what_ends_the_wait_in_place_of_the_loop(way: str) -> None:
    """Another thread has something for the one that waits, or the loop has ended."""
    with running_loop() as loop:
        readers = readers_of(loop)
        waits, ended = threading.Event(), threading.Event()

        def wait() -> None:
            readers.begin()
            waits.set()
            readers.call(readers.wait(PATIENCE_S))
            readers.end()
            ended.set()

        waiter = threading.Thread(target=wait)
        waiter.start()
        waits.wait(PATIENCE_S)
        if way == "rouse":
            readers.rouse()
        else:
            loop.call_soon_threadsafe(loop.stop)
            while loop.is_running():
                threading.Event().wait(0.001)
            loop.close()
        assert ended.wait(PATIENCE_S)
        waiter.join()
        assert readers.begin() is (way == "rouse")
        if way == "rouse":
            readers.end()


def test_a_reader_that_was_removed_is_not_called(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """Whoever waits."""
    here, there = pair
    with running_loop() as loop:
        readers, read = readers_of(loop), watch(loop, here)
        borrow(loop)
        assert loop.remove_reader(here)
        assert not loop.remove_reader(here)
        loop.give_back()
        there.send(b"unread")

        assert readers.begin()
        assert readers.wait(0.01) == []
        readers.end()
        assert read.empty()


def test_an_exception_of_a_reader_goes_to_the_handler_of_the_loop(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """As in any loop: the thread that happens to wait has nothing to do with it."""
    here, there = pair
    handled: list[object] = []
    with running_loop() as loop:
        readers = readers_of(loop)

        def fail() -> None:
            here.recv(100)
            raise LookupError

        borrow(loop)
        loop.set_exception_handler(lambda _, context: handled.append(context["exception"]))
        loop.add_reader(here, fail)
        loop.give_back()
        assert readers.begin()
        there.send(b"x")
        assert readers.call(readers.wait(PATIENCE_S))
        readers.end()

    assert [type(each) for each in handled] == [LookupError]
