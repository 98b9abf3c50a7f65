"""The event loop and thread of a context, for calls from other threads."""

from __future__ import annotations

import asyncio
import contextlib
from concurrent.futures import Future
from functools import partial, wraps
from threading import get_ident
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["LoopAffinity", "in_loop_thread", "in_thread_of_node"]

ResultT = TypeVar("ResultT")
MethodT = TypeVar("MethodT", bound="Callable[..., Any]")

PATIENCE_S = 1.0
"""Time between two checks by a waiting thread whether the event loop has been closed."""


class LoopAffinity:
    """The event loop that the nodes of a context run in.

    Attributes:
        thread: The thread of that loop; 0 while the context is not open.
    """

    __slots__ = ("_loop", "thread")

    def __init__(self) -> None:
        self.thread = 0
        self._loop: asyncio.AbstractEventLoop | None = None

    def attach(self) -> None:
        """Record the running loop and its thread as those of the context."""
        self._loop = asyncio.get_running_loop()
        self.thread = get_ident()

    def detach(self) -> None:
        """Forget them: the context is closed."""
        self._loop = None
        self.thread = 0

    def is_other_thread(self) -> bool:
        """Return whether the context works in a thread other than this one.

        Not while its loop stands still, between two calls of `run_until_complete`: nothing else
        runs then, and a thread that waited for the loop might wait for ever.
        """
        if self.thread in (0, get_ident()):
            return False
        return self._loop is not None and self._loop.is_running()

    def call(self, action: Callable[[], object]) -> None:
        """Run `action` in the loop's thread: at once if this is it, else soon."""
        loop = self._loop
        if loop is None or self.thread == get_ident():
            action()
            return
        with contextlib.suppress(RuntimeError):  # the loop was closed, and with it the context
            loop.call_soon_threadsafe(action)

    def wait_for(self, action: Callable[..., ResultT], *args: Any) -> ResultT:
        """Run `action` in the loop's thread, and return its result. From other threads only.

        Raises:
            Exception: what `action` raised.
            RuntimeError: the loop was closed.
        """
        loop = self._loop
        if loop is None:
            return action(*args)
        done: Future[ResultT] = Future()

        def act() -> None:
            try:
                result = action(*args)
            except Exception as error:  # noqa: BLE001  # raised in the calling thread
                done.set_exception(error)
            else:
                done.set_result(result)

        loop.call_soon_threadsafe(act)
        while True:
            try:
                return done.result(PATIENCE_S)
            except TimeoutError:
                if done.done():
                    raise  # it is what `action` raised
                if loop.is_closed():
                    raise RuntimeError("the event loop of the node was closed") from None


def in_loop_thread(method: MethodT) -> MethodT:
    """Have a method of a node run in the thread of the node's loop, and its caller wait for it.

    Entities are created there, as the graph, the transports and Zenoh's session know no locks.
    """

    @wraps(method)
    def call(self: Any, *args: Any, **options: Any) -> Any:
        affinity: LoopAffinity = self._Node__affinity
        if affinity.is_other_thread():
            return affinity.wait_for(partial(method, self, *args, **options))
        return method(self, *args, **options)

    return call  # type: ignore[return-value]  # it has the same signature


def in_thread_of_node(constructor: MethodT) -> MethodT:
    """Have a constructor, whose first argument is a node, run in the thread of the node's loop."""

    @wraps(constructor)
    def construct(self: Any, node: Any, *args: Any, **options: Any) -> None:
        affinity: LoopAffinity = node._Node__affinity
        if affinity.is_other_thread():
            affinity.wait_for(partial(constructor, self, node, *args, **options))
        else:
            constructor(self, node, *args, **options)

    return construct  # type: ignore[return-value]  # it has the same signature
