"""Tests of an event loop that other threads may use while its own thread sleeps."""

from __future__ import annotations

import asyncio
import gc
import os
import queue
import signal
import socket
import sys
import threading
import weakref
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import pytest

from aionode._process.concurrency import running_loop as current_loop
from aionode._process.lendable_loop import LendableLoop, Readers
from aionode.clock import MachineTime, perf_ns

PATIENCE_S = 10.0

SetHandler = Callable[[Callable[..., Any]], Any]

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
    """Run it in a task."""
    work()


def test_a_loop_that_is_borrowed_does_nothing() -> None:
    """Only the borrower may use what belongs to the loop's thread."""
    done = threading.Event()
    with running_loop() as loop:
        borrow(loop)
        loop.call_soon_threadsafe(done.set)

        assert not done.wait(0.05)
        loop.give_back()
        assert done.wait(PATIENCE_S)


def test_a_loop_that_works_is_not_lent() -> None:
    """The borrower does not wait for it either, but hands its work over in another way."""
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
    """Two threads that send at the same time cannot use it together."""
    with running_loop() as loop:
        borrow(loop)

        assert not loop.borrow()
        loop.give_back()


def test_the_borrowed_loop_is_the_running_one() -> None:
    """The loop's code asks for it, even if the borrower's thread runs another loop."""
    with running_loop() as loop:

        async def main() -> None:
            own = asyncio.get_running_loop()
            borrow(loop)
            borrowed = current_loop()
            loop.give_back()
            assert borrowed is loop
            assert current_loop() is own

        asyncio.run(main())


def test_a_loop_in_debug_mode_is_not_lent() -> None:
    """In debug mode it checks that only its own thread uses it."""
    with running_loop(debug=True) as loop:
        assert not any(loop.borrow() for _ in range(10_000))


def test_giving_back_a_loop_that_was_closed_meanwhile_has_no_effect() -> None:
    """A thread may still be sending while its context is shut down."""
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
    """Return two connected sockets."""
    here, there = socket.socketpair()
    with here, there:
        yield here, there


def readers_of(loop: LendableLoop) -> Readers:
    """Return the descriptors of a loop, or skip the test."""
    if loop.readers is None:
        pytest.skip("this system has no epoll")
    return loop.readers


def begin(readers: Readers) -> None:
    """Wait in place of the loop once it does not read itself."""
    for _ in range(10_000):
        if readers.begin():
            return
        threading.Event().wait(0.001)
    pytest.fail("the loop reads all the time")


class Sleeper:
    """A thread that waits until a function returns True."""

    def __init__(self, is_woken: Callable[[], bool]) -> None:
        self.rouse: Callable[[], None] | None = None
        self.is_woken = is_woken

    def take(self, blocking: bool) -> bool:
        """Return whether it was woken."""
        assert not blocking
        return self.is_woken()


def ends_after(duration_s: float) -> float:
    """Return the time when that will have passed."""
    return MachineTime().steady_ns() + duration_s * 1e9


def watch(loop: LendableLoop, sock: socket.socket) -> queue.Queue[int]:
    """Read a socket in a loop; put the thread that does it into the queue each time."""
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
    """The loop itself reads before and afterwards."""
    here, there = pair
    with running_loop() as loop:
        readers, read = readers_of(loop), watch(loop, here)
        there.send(b"before")
        assert read.get(timeout=PATIENCE_S) != threading.get_ident()

        begin(readers)
        there.send(b"meanwhile")
        assert readers.read(Sleeper(lambda: not read.empty()), ends_after(PATIENCE_S), [])
        readers.end()
        assert read.get() == threading.get_ident()

        there.send(b"afterwards")
        assert read.get(timeout=PATIENCE_S) != threading.get_ident()


def test_one_thread_waits_in_place_of_the_loop() -> None:
    """A second thread waits in its own way."""
    with running_loop() as loop:
        readers = readers_of(loop)

        assert readers.begin()
        assert not readers.begin()
        readers.end()
        assert readers.begin()
        readers.end()


def test_no_thread_begins_to_wait_while_the_loop_reads(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """The loop might take the event that is to wake that thread."""
    here, there = pair
    began: queue.Queue[bool] = queue.Queue()

    with running_loop() as loop:
        readers = readers_of(loop)

        def read() -> None:
            here.recv(100)
            began.put(readers.begin())

        borrow(loop)
        loop.add_reader(here.fileno(), read)
        loop.give_back()
        there.send(b"hello")

        assert not began.get(timeout=PATIENCE_S)
        begin(readers)
        readers.end()


@pytest.mark.parametrize("way", ["rouse", "close"])
def test_what_ends_the_wait_in_place_of_the_loop(way: str) -> None:
    """Another thread has something for the waiting one, or the loop has ended."""
    with running_loop() as loop:
        readers = readers_of(loop)
        waits, ended = threading.Event(), threading.Event()
        sleeper = Sleeper(lambda: False)

        def wait() -> None:
            readers.begin()
            waits.set()
            readers.read(sleeper, ends_after(PATIENCE_S), [])
            readers.end()
            ended.set()

        waiter = threading.Thread(target=wait)
        waiter.start()
        waits.wait(PATIENCE_S)
        if way == "rouse":
            sleeper.is_woken = lambda: True
            readers.rouse()
        else:
            loop.call_soon_threadsafe(loop.stop)
            while loop.is_running():
                threading.Event().wait(0.001)
            loop.close()
        assert ended.wait(PATIENCE_S)
        waiter.join()
        if way == "rouse":
            begin(readers)
            readers.end()
        else:
            assert not readers.begin()


def test_rousing_after_the_loop_is_closed_touches_no_other_file() -> None:
    """By then, its descriptor's number may belong to a file of the user."""
    with running_loop() as loop:
        readers = readers_of(loop)
        number = readers._event
    counter = os.eventfd(0, os.EFD_NONBLOCK)  # as a file that takes what is written
    os.dup2(counter, number)
    try:
        readers.rouse()

        with pytest.raises(BlockingIOError):
            os.eventfd_read(number)
    finally:
        os.close(number)
        if counter != number:
            os.close(counter)


def test_the_descriptor_that_rouses_is_closed_by_the_last_one_who_uses_it() -> None:
    """A thread may be about to write while another one closes the loop."""
    with running_loop() as loop:
        readers = readers_of(loop)
        event, rousing = readers._event, readers._rousing
        rousing.append(None)
    os.fstat(event)
    rousing.pop()
    readers.rouse()

    with pytest.raises(OSError, match="Bad file descriptor"):
        os.fstat(event)


def test_a_wait_of_months_is_possible() -> None:
    """The system itself takes at most 24 days."""
    with running_loop() as loop:
        readers = readers_of(loop)
        assert readers.begin()
        readers.rouse()

        calls = iter((False, True))
        assert readers.read(Sleeper(lambda: next(calls)), ends_after(5e6), [])
        readers.end()


def test_a_reader_that_was_removed_is_not_called(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """This holds whoever waits."""
    here, there = pair
    with running_loop() as loop:
        readers, read = readers_of(loop), watch(loop, here)
        borrow(loop)
        assert loop.remove_reader(here)
        assert not loop.remove_reader(here)
        loop.give_back()
        there.send(b"unread")

        assert readers.begin()
        assert not readers.read(Sleeper(lambda: False), ends_after(0.01), [])
        readers.end()
        assert read.empty()


def test_an_exception_of_a_reader_goes_to_the_handler_of_the_loop(
    pair: tuple[socket.socket, socket.socket],
) -> None:
    """As in any loop: the thread that happens to wait is not responsible for it."""
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
        assert readers.read(Sleeper(lambda: bool(handled)), ends_after(PATIENCE_S), [])
        readers.end()

    assert [type(each) for each in handled] == [LookupError]


# What runs between two bytecodes of the thread that holds the loop


class Hold:
    """Holds a loop in one of the two ways, and tries what others may do meanwhile.

    Attributes:
        answers: What `borrow` and `begin` answered to others.
        done: Set by what they have handed to the loop.
    """

    def __init__(self, loop: LendableLoop, way: str) -> None:
        self.loop = loop
        self.readers = readers_of(loop)
        self.way = way
        self.answers: list[bool] = []
        self.done = threading.Event()

    def __enter__(self) -> None:
        if self.way == "begin":
            begin(self.readers)
        borrow(self.loop)

    def __exit__(self, *_: object) -> None:
        self.loop.give_back()
        if self.way == "begin":
            self.readers.end()

    def interrupt(self, *_: object) -> None:
        """Do what a signal handler or a finalizer may do."""
        self.answers.append(self.loop.borrow())
        if self.way == "begin":
            self.answers.append(self.readers.begin())
        self.readers.rouse()
        self.loop.call_soon_threadsafe(self.done.set)


@pytest.fixture
def handler() -> Iterator[SetHandler]:
    """Return a function that sets the handler of SIGUSR1, and restore the former one."""
    if not hasattr(signal, "SIGUSR1"):
        pytest.skip("this system has no SIGUSR1")
    former = signal.getsignal(signal.SIGUSR1)
    yield partial(signal.signal, signal.SIGUSR1)
    signal.signal(signal.SIGUSR1, former)


WAYS = pytest.mark.parametrize("way", ["borrow", "begin"])


@WAYS
def test_a_handler_of_a_signal_may_hand_work_to_a_loop_that_is_held(
    handler: SetHandler, way: str
) -> None:
    """It runs in the thread that holds the loop, so it must not wait for it, and need not."""
    with running_loop() as loop:
        hold = Hold(loop, way)
        handler(hold.interrupt)

        with hold:
            signal.raise_signal(signal.SIGUSR1)
            assert not hold.done.is_set()

        assert hold.done.wait(PATIENCE_S)
        assert not any(hold.answers)


@WAYS
def test_an_exception_out_of_a_handler_leaves_the_loop_to_who_lets_it_go(
    handler: SetHandler, way: str
) -> None:
    """The work is left half done; with a ``finally`` the loop continues, and can be borrowed."""

    def fail(*_: object) -> None:
        raise LookupError

    with running_loop() as loop:
        hold, after = Hold(loop, way), threading.Event()
        handler(fail)

        def work() -> None:
            with hold:
                loop.call_soon(hold.done.set)
                signal.raise_signal(signal.SIGUSR1)
                loop.call_soon(after.set)

        with pytest.raises(LookupError):
            work()

        assert hold.done.wait(PATIENCE_S)
        assert not after.is_set()
        with Hold(loop, way):
            pass


def test_an_exception_before_the_loop_is_given_back_keeps_it_for_ever(
    handler: SetHandler,
) -> None:
    """So the main thread borrows only where no handler may raise; here nothing releases it."""

    def fail(*_: object) -> None:
        raise LookupError

    with running_loop() as loop:
        done = threading.Event()
        handler(fail)

        borrow(loop)
        with pytest.raises(LookupError):
            signal.raise_signal(signal.SIGUSR1)
        loop.call_soon_threadsafe(done.set)

        assert not done.wait(0.05)
        loop.give_back()
        assert done.wait(PATIENCE_S)


@WAYS
def test_a_finalizer_may_hand_work_to_a_loop_that_is_held(way: str) -> None:
    """The collector calls it in any thread, and its exceptions do not propagate."""

    class Garbage:
        def __init__(self, on_end: Callable[[], None]) -> None:
            self.itself = self
            weakref.finalize(self, on_end)

    with running_loop() as loop:
        hold = Hold(loop, way)

        with hold:
            Garbage(hold.interrupt)  # here, as it may be collected at any time from now on
            gc.collect()
            assert hold.answers
            assert not hold.done.is_set()

        assert hold.done.wait(PATIENCE_S)
        assert not any(hold.answers)


# Everything at once


class Work:
    """Represents the work of a loop and its borrowers; notes when two threads work at once."""

    def __init__(self) -> None:
        self.done: Counter[str] = Counter()
        self.longest_pause_ns = 0
        self._last_tick_ns = perf_ns()
        self._one = threading.Lock()

    def do(self, what: str, count: int = 1) -> None:
        """Count something."""
        if not self._one.acquire(blocking=False):
            self.done["collisions"] += 1
            return
        os.sched_yield()  # another thread may run now, if nothing prevents it
        self.done[what] += count
        self._one.release()

    def read(self, sock: socket.socket) -> None:
        """Count what a socket has received."""
        self.do("read", len(sock.recv(64)))

    def counts(self, names: Iterable[str]) -> dict[str, int]:
        """Return how often each thing was done so far."""
        return {name: self.done[name] for name in names}

    def tick(self, loop: LendableLoop) -> None:
        """Note that timers of the loop run, and set the next one."""
        now_ns = perf_ns()
        self.longest_pause_ns = max(self.longest_pause_ns, now_ns - self._last_tick_ns)
        self._last_tick_ns = now_ns
        self.do("ticks")
        loop.call_later(0.001, self.tick, loop)

    def borrow(self, loop: LendableLoop, times: int) -> None:
        """Borrow the loop repeatedly, and give it something to do each time."""
        for _ in range(times):
            borrow(loop)
            self.do("borrowed")
            loop.call_soon(self.do, "soon")
            loop.call_later(0.0, self.do, "later")
            loop.give_back()

    def post(self, loop: LendableLoop, times: int) -> None:
        """Hand over many items, and wake whoever waits in place of the loop."""
        for number in range(times):
            loop.call_soon_threadsafe(self.do, "posted")
            if loop.readers is not None and number % 8 == 0:
                loop.readers.rouse()

    def wait(self, loop: LendableLoop, over: threading.Event) -> None:
        """Wait in place of the loop repeatedly."""
        while loop.readers is not None and not over.is_set():
            if loop.readers.begin():
                loop.readers.read(Sleeper(over.is_set), ends_after(0.02), [])
                loop.readers.end()


def send(sock: socket.socket, times: int) -> None:
    """Send bytes, one at a time."""
    for _ in range(times):
        sock.send(b"x")


@pytest.fixture
def quick_switches() -> Iterator[None]:
    """Make Python switch between threads as often as possible."""
    usual_s = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(usual_s)


@pytest.mark.usefixtures("quick_switches")
@pytest.mark.parametrize("times", [10, pytest.param(2_000, marks=pytest.mark.stress)])
@pytest.mark.timeout(300)
def test_nothing_is_lost_while_threads_borrow_a_busy_loop(times: int) -> None:
    """Timers, sockets and other threads keep it busy, and two threads wait in place of it."""
    work, over = Work(), threading.Event()
    pairs = [socket.socketpair() for _ in range(3)]
    with running_loop() as loop:
        for here, _ in pairs:
            borrow(loop)
            loop.add_reader(here, work.read, here)
            loop.give_back()
        loop.call_soon_threadsafe(work.tick, loop)
        jobs = [
            *[threading.Thread(target=work.borrow, args=(loop, times)) for _ in range(3)],
            *[threading.Thread(target=work.post, args=(loop, times)) for _ in range(3)],
            *[threading.Thread(target=send, args=(there, times)) for _, there in pairs],
        ]
        waiters = [threading.Thread(target=work.wait, args=(loop, over)) for _ in range(2)]
        for thread in (*waiters, *jobs):
            thread.start()
        for thread in jobs:
            thread.join()
        over.set()
        for thread in waiters:
            thread.join()
        # Nobody waits in place of the loop any more: it goes on by itself.
        ticks = work.done["ticks"]
        for _, there in pairs:
            send(there, 1)
        wanted = dict.fromkeys(("borrowed", "soon", "later", "posted"), 3 * times)
        wanted |= {"read": 3 * (times + 1), "collisions": 0}
        ends_ns = perf_ns() + int(PATIENCE_S * 1e9)
        while work.counts(wanted) != wanted or work.done["ticks"] == ticks:
            if perf_ns() > ends_ns:
                break
            threading.Event().wait(0.01)
        for here, _ in pairs:
            loop.call_soon_threadsafe(loop.remove_reader, here)
    for sock in (sock for pair in pairs for sock in pair):
        sock.close()

    assert work.counts(wanted) == wanted
    assert work.done["ticks"] > ticks
    assert work.longest_pause_ns < PATIENCE_S * 1e9
