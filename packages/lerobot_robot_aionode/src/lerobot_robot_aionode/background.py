"""A node in a thread of its own, as LeRobot's loops are not async."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from abc import ABC, abstractmethod
from concurrent.futures import Future, wait
from typing import TYPE_CHECKING, Any, TypeVar

from aionode import Context, Node

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

__all__ = ["Background"]

T = TypeVar("T")

LOOK_S = 0.5
"""How often a thread that waits for an answer looks whether the node has ended."""


class Background(ABC):
    """A node that lives in its own thread between `start` and `stop`.

    Args:
        name: The name of the node.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[None] | None = None
        self._ready: Future[None] = Future()
        self._failure: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name=f"aionode-{name}", daemon=True)

    @property
    def is_running(self) -> bool:
        """Whether it was started, and has not ended."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Start it, and wait until it is ready.

        Raises:
            Exception: what it failed with.
        """
        self._thread.start()
        try:
            self._ready.result()
        except BaseException:
            self.stop()
            raise

    def stop(self) -> None:
        """End it, and wait until it has ended."""
        if self._loop is not None and self._task is not None:
            with contextlib.suppress(RuntimeError):  # its loop has ended by itself
                self._loop.call_soon_threadsafe(self._task.cancel)
        self._thread.join()

    def ask(self, question: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Return what a coroutine function returns in its loop.

        Raises:
            ConnectionError: the node has ended.
            Exception: what the function raised.
        """
        answer = self._asked(question)
        while answer is not None and self.is_running:
            if wait([answer], LOOK_S).done:
                break
        if answer is None or not answer.done() or answer.cancelled():
            self._thread.join()  # then it is known why
            raise ConnectionError(
                f"{self._name}: its node has ended; connect again"
            ) from self._failure
        return answer.result()

    def _asked(self, question: Callable[[], Coroutine[Any, Any, T]]) -> Future[T] | None:
        """Return the future of an answer; None if the loop has ended."""
        if not self.is_running or self._loop is None:
            return None
        asked = question()
        try:
            return asyncio.run_coroutine_threadsafe(asked, self._loop)
        except RuntimeError:  # it has ended meanwhile
            asked.close()
            return None

    def _run(self) -> None:
        try:
            asyncio.run(self._main())
        except BaseException as error:  # noqa: BLE001  # `start` or `ask` raises it
            self._failure = error
            if not self._ready.done():
                self._ready.set_exception(error)

    async def _main(self) -> None:
        self._loop, self._task = asyncio.get_running_loop(), asyncio.current_task()
        async with Context() as context, Node(self._name, context=context) as node:
            await self.live(node, lambda: self._ready.set_result(None))

    @abstractmethod
    async def live(self, node: Node, ready: Callable[[], None]) -> None:
        """Do its work until cancelled; call `ready` once it can be asked."""
