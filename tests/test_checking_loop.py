"""The loop of tests finds what asyncio's debug mode finds, and records no stacks."""

from __future__ import annotations

import asyncio
import functools
from typing import TYPE_CHECKING

import pytest

from tests.support.checking_loop import CheckingLoop

if TYPE_CHECKING:
    from collections.abc import Callable


async def forget() -> None:
    """Do nothing, and that only if awaited."""


async def leave_out_an_await() -> None:
    """Create a coroutine that nobody awaits."""
    forget()  # type: ignore[unused-coroutine]


async def call_from_a_thread() -> None:
    """Use the loop from a thread that is not its own."""
    await asyncio.to_thread(asyncio.get_running_loop().call_soon, print)


async def make_a_future() -> asyncio.Future[None]:
    """Return a future of the running loop."""
    return asyncio.get_running_loop().create_future()


def test_a_foreign_thread_is_refused() -> None:
    """Without the check, the loop would not wake up, or break now and then."""
    with (
        asyncio.Runner(debug=False, loop_factory=CheckingLoop) as runner,
        pytest.raises(RuntimeError, match="Non-thread-safe operation"),
    ):
        runner.run(call_from_a_thread())


def test_a_forgotten_coroutine_is_reported_with_where_it_was_created() -> None:
    """Without the place, the report names a coroutine only."""
    with (
        asyncio.Runner(debug=False, loop_factory=CheckingLoop) as runner,
        pytest.warns(RuntimeWarning, match=r"never awaited\n(.*\n)*.*leave_out_an_await"),
    ):
        runner.run(leave_out_an_await())


class Caller:
    """An object with a coroutine method."""

    async def call(self) -> None:
        """Do nothing."""


@pytest.mark.parametrize("function", [forget, functools.partial(forget), Caller().call])
def test_a_coroutine_function_is_no_callback(function: Callable[[], None]) -> None:
    """The loop would call it, and nobody would await the coroutine."""
    with (
        asyncio.Runner(debug=False, loop_factory=CheckingLoop) as runner,
        pytest.raises(TypeError, match=r"coroutines cannot be used with call_soon\(\)"),
    ):
        runner.get_loop().call_soon(function)


def test_futures_record_no_stack() -> None:
    """Recording stacks takes most of the time of many tests."""
    with asyncio.Runner(debug=False, loop_factory=CheckingLoop) as runner:
        assert "created at" not in repr(runner.run(make_a_future()))
