"""The futures that rclpy's ``*_async`` methods return for the results of an entity's work."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Generator
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    from types import TracebackType

    from aionode.endpoints.core.entity import Entity

__all__ = ["Futures", "Unasked", "asks"]

P = ParamSpec("P")
T = TypeVar("T")


class Futures:
    """Runs work of one entity in tasks of its node, and returns the results as futures.

    Work submitted before the node runs starts with the node. `close` ends unfinished work like a
    wait of the task that submitted it.

    Args:
        entity: The entity.
    """

    def __init__(self, entity: Entity) -> None:
        self._entity = entity
        self._subject = entity._subject
        self._tasks: asyncio.TaskGroup | None = None
        self._closed = False
        # Unfinished futures, with their work until it is started.
        self._open: dict[asyncio.Future[Any], Coroutine[Any, Any, Any] | None] = {}
        # Those among them that the node's own tasks asked for.
        self._own: set[asyncio.Future[Any]] = set()

    def begin(self, work: Coroutine[Any, Any, T]) -> asyncio.Future[T]:
        """Return a future for the result of `work`; cancelling the future cancels the work.

        Raises:
            RuntimeError: no event loop is running that could complete the future.
        """
        try:
            future: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        except RuntimeError as error:
            work.close()
            raise RuntimeError(
                f"{self._subject}: a future needs the event loop, and none runs; ask in a callback "
                "or a coroutine, or give the class of the node to aionode.run, which makes the "
                "node in the loop"
            ) from error
        self._open[future] = work
        node_tasks = self._entity._node_tasks
        if node_tasks is not None and node_tasks.own_current_task():
            self._own.add(future)
        future.add_done_callback(self._forget)
        if self._closed:
            self._end(future)
        elif self._tasks is not None:
            self._start(future)
        return future

    def start(self, tasks: asyncio.TaskGroup) -> None:
        """Start all submitted work, and from now on new work at once; called when the node runs."""
        self._tasks = tasks
        for future in list(self._open):
            self._start(future)

    def close(self) -> None:
        """End all unfinished work, and from now on new work at once."""
        self._closed = True
        for future in list(self._open):
            self._end(future)

    def _end(self, future: asyncio.Future[Any]) -> None:
        """Cancel `future`, or set EntityDestroyedError on it; either ends its work."""
        if future in self._own:
            future.cancel(f"{self._subject}: destroyed")
        elif not future.done():
            future.set_exception(self._entity._destroyed_error())
            future.exception()  # mark it retrieved: perhaps nobody awaits it any more

    def _start(self, future: asyncio.Future[Any]) -> None:
        work = self._open[future]
        assert work is not None  # noqa: S101  # nothing is started twice
        assert self._tasks is not None  # noqa: S101  # the node runs
        self._open[future] = None
        outcome = self._complete(future, work)
        try:
            task = self._tasks.create_task(outcome, name=f"{self._subject}: future")
        except RuntimeError:  # the node is already failing
            outcome.close()
            work.close()
            self._end(future)
            return
        future.add_done_callback(lambda _: task.cancel())

    async def _complete(self, future: asyncio.Future[T], work: Coroutine[Any, Any, T]) -> None:
        """Await `work`, and set its result or its exception on `future`."""
        try:
            outcome = await work
        except asyncio.CancelledError:
            self._end(future)  # the node is failing, unless the future was cancelled
            raise
        except Exception as error:  # noqa: BLE001  # raised where the future is awaited
            if not future.done():
                future.set_exception(error)
        else:
            if not future.done():
                future.set_result(outcome)

    def _forget(self, future: asyncio.Future[Any]) -> None:
        self._own.discard(future)
        work = self._open.pop(future)
        if work is not None:
            work.close()


class Unasked(Coroutine[Any, Any, T]):
    """A coroutine returning a bool that raises if its truth is tested without an await.

    Programs for rclpy contain ``while not client.wait_for_service(timeout_sec=1.0):``. A plain
    coroutine is truthy, so that loop would end at once, as if the service were available.
    """

    __slots__ = ("_name", "_work")

    def __init__(self, work: Coroutine[Any, Any, T], name: str) -> None:
        self._work = work
        self._name = name

    def __repr__(self) -> str:
        return f"<{self._name}(), not awaited>"

    def __bool__(self) -> bool:
        """Raise an error, as the await is missing.

        Raises:
            TypeError: always.
        """
        self._work.close()
        raise TypeError(
            f"{self._name}() was not awaited, so there is no answer yet; write "
            f"`await ...{self._name}(...)`, as in `while not await "
            f"...{self._name}(timeout_sec=1.0):`; in a constructor, which cannot await, leave it "
            "to the coroutine or callback that needs the answer"
        )

    def __await__(self) -> Generator[Any, Any, T]:
        return self._work.__await__()

    def send(self, value: Any) -> Any:
        """Resume the coroutine."""
        return self._work.send(value)

    def throw(self, typ: Any, val: Any = None, tb: TracebackType | None = None) -> Any:
        """Raise an error in the coroutine."""
        return self._work.throw(typ) if val is None else self._work.throw(typ, val, tb)

    def close(self) -> None:
        """End the coroutine."""
        self._work.close()


def asks(
    method: Callable[P, Coroutine[Any, Any, T]],
) -> Callable[P, Coroutine[Any, Any, T]]:
    """Make the coroutine of `method` raise if tested without an await; see `Unasked`."""

    @wraps(method)
    def asking(*args: P.args, **kwargs: P.kwargs) -> Coroutine[Any, Any, T]:
        return Unasked(method(*args, **kwargs), method.__name__)

    return asking
