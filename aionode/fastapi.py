"""FastAPI and Starlette: cancel routes when their browser leaves, stop motion at a signal.

It needs ``pip install fastapi``, or Starlette alone::

    from aionode.fastapi import stopping_at_signals, until_disconnected


    @contextlib.asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with Node("web") as node, stopping_at_signals(node):
            app.state.node = node
            yield


    @app.post("/drive")
    async def drive(request: Request, distance: float) -> str:
        async with until_disconnected(request):
            await robot.call(Drive.Goal(distance=distance))
        return "arrived"
"""

from __future__ import annotations

import asyncio
import contextlib
import signal
import threading
from typing import TYPE_CHECKING, Any, Final

from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from aionode._process.sudden_end import is_sending
from aionode.endpoints.lease import send_stops
from aionode.supervisor import Supervisor

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Callable
    from types import FrameType

    from starlette.requests import Request

    from aionode.node import Node

__all__ = ["stopping_at_signals", "until_disconnected"]

CLIENT_CLOSED_REQUEST: Final = 499
"""The status that nginx logs for a request whose client has closed the connection."""

SIGQUIT: Final[int | None] = getattr(signal, "SIGQUIT", None)
SIGNALS: Final[tuple[int, ...]] = (signal.SIGINT, signal.SIGTERM, *([SIGQUIT] if SIGQUIT else []))
"""The signals that end web servers; gunicorn's workers get SIGQUIT on Ctrl-C."""

LATER_SEC: Final = 1.0
"""How long after the start of the application the handlers are installed again, in seconds."""

CLEANUP_SEC: Final = 0.15
"""How long routes may clean up after a signal before the nodes are destroyed, in seconds."""


class Routes:
    """The blocks of `until_disconnected` that are open in this process.

    Attributes:
        all_done: Set while no block is open.
        begun: Called when a block begins.
    """

    def __init__(self) -> None:
        self.reset()

    def add(self, scope: asyncio.Timeout) -> None:
        """Record the start of a block."""
        if self.begun is not None:
            self.begun()
        self._scopes.add(scope)
        self.all_done.clear()

    def remove(self, scope: asyncio.Timeout) -> None:
        """Record the end of a block."""
        self._scopes.discard(scope)
        if not self._scopes:
            self.all_done.set()

    def is_ending(self) -> bool:
        """Return whether a signal has cancelled them, so that new blocks are cancelled too."""
        return self._is_ending

    def reset(self) -> None:
        """Allow blocks again, for another application in this process, on a loop of its own."""
        self._scopes: set[asyncio.Timeout] = set()
        self._is_ending = False
        self.begun: Callable[[], None] | None = None
        self.all_done = asyncio.Event()  # waiting for one binds it to a loop
        self.all_done.set()

    def end(self) -> None:
        """Cancel all blocks."""
        self._is_ending = True
        for scope in self._scopes:
            cancel(scope)


def cancel(scope: asyncio.Timeout) -> None:
    """Cancel a block in the loop's next iteration, unless it is already being cancelled."""
    if not scope.expired():
        scope.reschedule(0.0)


routes = Routes()


@contextlib.asynccontextmanager
async def stopping_at_signals(*nodes: Node | Supervisor[Any]) -> AsyncIterator[None]:
    """End motion and open routes at the first signal that ends the server, before the server does.

    A web server tells the application of a signal only when all its connections have closed, which
    an open route or a stream of events may delay forever. Within this block, which spans the
    lifespan of the application, the first signal does at once what the end of the lifespan would do
    later: the stop of each open lease is sent, even while a callback blocks the event loop; each
    block of `until_disconnected` is cancelled, and with it the goals and calls that it awaits, and
    its route answers with status 503; then `nodes` are destroyed, which ends the streams of their
    subscriptions. The server's own handler is called as well, and stays installed.

    In a thread other than the main one, where no signals arrive, as in Starlette's `TestClient`, it
    does nothing.

    Args:
        nodes: The nodes of the application; a `Supervisor` stands for its node.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    signalled = asyncio.Event()

    async def end() -> None:
        await signalled.wait()
        routes.end()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(CLEANUP_SEC):
                await routes.all_done.wait()
        for node in nodes:
            (node.node if isinstance(node, Supervisor) else node).destroy_node()

    listener = Listener(asyncio.get_running_loop(), signalled)
    routes.begun = listener.install
    listener.install()
    # Some servers set their handlers after the application has started.
    later = asyncio.get_running_loop().call_later(LATER_SEC, listener.install)
    try:
        async with asyncio.TaskGroup() as tasks:
            ending = tasks.create_task(end(), name="stopping_at_signals")
            yield
            if not signalled.is_set():
                ending.cancel()
    finally:
        later.cancel()
        listener.remove()
        routes.reset()


class Listener:
    """Handles the signals that end a server: sends the stops of leases, and notifies the loop.

    The previous handlers are called as well. An event loop's own handlers need no call: the loop
    learns of every signal that has a handler through its wakeup descriptor.

    Args:
        loop: The event loop of the application.
        signalled: Set by the first signal.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, signalled: asyncio.Event) -> None:
        self._loop = loop
        self._signalled = signalled
        self._before: dict[int, Any] = {}

    def install(self) -> None:
        """Handle the signals from now on, replacing handlers that were set meanwhile."""
        for number in SIGNALS:
            current: Any = signal.getsignal(number)
            is_left_alone = number == SIGQUIT and current is signal.SIG_DFL
            if current is not self and not is_left_alone:
                self._before[number] = current  # first: a signal may wait for this handler
                signal.signal(number, self)

    def remove(self) -> None:
        """Restore the previous handlers, unless others have been set meanwhile."""
        for number, handler in self._before.items():
            current: object = signal.getsignal(number)
            if current is self:
                signal.signal(number, signal.SIG_DFL if handler is None else handler)

    def __call__(self, number: int, frame: FrameType | None) -> None:
        """Handle a signal."""
        if not is_sending(frame):  # otherwise the loop does, and is not blocked
            send_stops(0.0)
        self._loop.call_soon_threadsafe(self._note)
        handler: object = self._before[number]
        if callable(handler):
            handler(number, frame)
        elif handler is signal.SIG_DFL:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)

    def _note(self) -> None:
        send_stops(0.0)
        self._signalled.set()


@contextlib.asynccontextmanager
async def until_disconnected(request: Request) -> AsyncIterator[None]:
    """Cancel the block when the client of `request` disconnects.

    A web server keeps running a route whose browser has left. Within the block, what the route
    awaits is cancelled instead, as by `asyncio.timeout`: a call is abandoned on both sides, and a
    goal is canceled.

    The body of the request is read first and kept for ``request.body()``, unless the route has
    read it already. The block has to end before the response begins: a server reports the client
    of a complete response as disconnected.

    Args:
        request: The request, as FastAPI gives it to an ``async def`` route that has a parameter of
            type `fastapi.Request`.

    Raises:
        HTTPException: the client has disconnected; its status is 499. Nobody gets the response, and
            nothing is logged. Or the application is shutting down (see `stopping_at_signals`); the
            status is 503, which tells clients that they may retry.
    """
    ending = HTTPException(503, "the server is shutting down", {"Retry-After": "1"})
    gone = HTTPException(CLIENT_CLOSED_REQUEST, "the client has disconnected")
    # The server reports the disconnection in place of the next part of the body.
    try:
        await request.body()
    except ClientDisconnect:
        raise gone from None
    except RuntimeError:
        pass  # the route has read the body as a stream
    if routes.is_ending():
        raise ending
    scope = asyncio.timeout(None)
    routes.add(scope)
    try:
        async with scope, watching(lambda: disconnected(request), scope):
            yield
    except TimeoutError:
        if not scope.expired():
            raise
        raise (ending if routes.is_ending() else gone) from None
    finally:
        routes.remove(scope)


async def disconnected(request: Request) -> None:
    """Wait until the client of a request disconnects."""
    while (await request.receive())["type"] != "http.disconnect":
        pass  # the empty end of the body


@contextlib.asynccontextmanager
async def watching(
    sign: Callable[[], Awaitable[object]], scope: asyncio.Timeout
) -> AsyncIterator[None]:
    """Cancel `scope` when the coroutine `sign` returns."""

    async def watch() -> None:
        await sign()
        cancel(scope)

    error: BaseException | None = None
    async with asyncio.TaskGroup() as tasks:
        watcher = tasks.create_task(watch(), name="until_disconnected")
        try:
            yield
        except BaseException as raised:  # noqa: BLE001  # raised below, without a group around it
            error = raised
        finally:
            watcher.cancel()
    if error is not None:
        raise error
