"""Inference off the event loop: in a thread, or in the program's executor."""

from __future__ import annotations

import asyncio
import inspect
from typing import TYPE_CHECKING, Any

from aionode._process.concurrency import thread_calls

if TYPE_CHECKING:
    from collections.abc import Callable
    from concurrent.futures import Executor

__all__ = ["infer"]


async def infer(policy: Callable[..., Any], executor: Executor, *args: Any) -> Any:
    """Return a policy's answer; cancelling abandons a call that hangs.

    Args:
        policy: A function, called by the executor, or a coroutine function, which is awaited.
        executor: Where it runs.
        args: The arguments of the call.
    """
    if inspect.iscoroutinefunction(policy):
        return await policy(*args)
    loop = asyncio.get_running_loop()
    calls, ended = thread_calls(loop), loop.create_future()
    calls.add(ended)  # tests that step the clock wait for this
    try:
        return await loop.run_in_executor(executor, policy, *args)
    finally:
        calls.discard(ended)
        ended.set_result(None)
