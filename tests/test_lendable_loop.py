"""An event loop that other threads may use while its own sleeps."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from aionode.lendable_loop import LendableLoop

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
