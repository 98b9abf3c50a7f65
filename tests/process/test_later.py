"""Tests of scheduled calls."""

from __future__ import annotations

import asyncio

from aionode._process.later import DelayedCalls, Later


async def test_one_call_waits_at_a_time() -> None:
    """The next request replaces the waiting one, and may be made by the call itself."""
    later, calls, called = Later(), [], asyncio.Event()

    def second() -> None:
        calls.append("second")
        if len(calls) == 1:
            later.call(0.0, second)
        else:
            called.set()

    later.call(0.0, lambda: calls.append("first"))
    later.call(0.0, second)
    await called.wait()

    assert (calls, later.waits) == (["second", "second"], False)


async def test_what_is_cancelled_is_not_called() -> None:
    """Closing something leaves no call behind."""
    later, called = Later(), asyncio.Event()
    later.call(0.0, called.set)
    later.cancel()
    asyncio.get_running_loop().call_later(0.0, later.call, 0.0, called.set)
    assert not later.waits

    await called.wait()
    assert not later.waits


async def test_calls_that_are_cancelled_together_are_not_called() -> None:
    """What has run, or is cancelled, is not kept."""
    delayed, calls, called = DelayedCalls(), [], asyncio.Event()
    delayed.add(0.0, lambda: calls.append("before"))
    delayed.add(0.0, called.set)
    await called.wait()

    delayed.add(0.0, lambda: calls.append("cancelled"))
    delayed.add(0.0, lambda: calls.append("cancelled too"))
    delayed.cancel()
    called.clear()
    delayed.add(0.0, called.set)
    await called.wait()

    assert calls == ["before"]
