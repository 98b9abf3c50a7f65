"""Inference off the event loop: in a thread, or in the program's executor."""

from __future__ import annotations

import asyncio
import inspect
import threading
from concurrent.futures import Executor, Future
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from aionode._process.concurrency import thread_calls

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["InferenceThread", "infer"]

Call = tuple[Future[Any], "Callable[[], Any]"]


class InferenceThread(Executor):
    """One daemon thread, so that a policy that hangs keeps neither block nor program from ending.

    It is always the same thread, as some libraries with a device require.
    """

    def __init__(self) -> None:
        self._calls: SimpleQueue[Call | None] = SimpleQueue()
        threading.Thread(target=self._run, name="aionode-policy", daemon=True).start()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call a function in the thread."""
        future: Future[Any] = Future()
        self._calls.put((future, lambda: fn(*args, **kwargs)))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:  # noqa: ARG002
        """End the thread after the calls already submitted; never wait for it."""
        self._calls.put(None)

    def _run(self) -> None:
        while (call := self._calls.get()) is not None:
            future, work = call
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(work())
            except BaseException as error:  # noqa: BLE001  # the caller raises it
                future.set_exception(error)


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
