"""A node in a thread of its own, as LeRobot's loops are not async."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from abc import ABC, abstractmethod
from concurrent.futures import Future
from typing import TYPE_CHECKING, TypeVar

from aionode import Context, Node

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Background"]

T = TypeVar("T")

ANSWER_S = 5.0
"""How long its loop may take for what LeRobot's thread asks."""


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

    def ask(self, function: Callable[[], T]) -> T:
        """Return what a function returns in its loop.

        Raises:
            ConnectionError: it has ended.
            Exception: what the function raised.
        """
        if not self.is_running or self._loop is None:
            raise ConnectionError(
                f"{self._name}: its node has ended; connect again"
            ) from self._failure
        answer: Future[T] = Future()

        def call() -> None:
            try:
                answer.set_result(function())
            except Exception as error:  # noqa: BLE001  # `result` raises it
                answer.set_exception(error)

        self._loop.call_soon_threadsafe(call)
        return answer.result(ANSWER_S)

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
