"""A node whose callbacks run in the event loop that awaits it, without executors.

It is newer than Kilted. Programs that use it can just as well use `aionode.Node`, which offers the
same and more.
"""

from __future__ import annotations

import asyncio
import inspect
from typing import TYPE_CHECKING, Any, Self

from rclpy._impl.errors import InvalidHandle, TimerCancelledError
from rclpy.client import Client
from rclpy.clock import ROSClock
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import qos_profile_services_default
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Timer

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import TracebackType

    from rclpy._impl.destroyable import Arrivals
    from rclpy.qos import QoSProfile
    from rclpy.subscription_content_filter_options import ContentFilterOptions

__all__ = [
    "AsyncClient",
    "AsyncClock",
    "AsyncNode",
    "AsyncPublisher",
    "AsyncService",
    "AsyncSubscription",
    "AsyncTimer",
]

AsyncPublisher = Publisher
AsyncSubscription = Subscription
AsyncService = Service
AsyncTimer = Timer


class AsyncClock(ROSClock):
    """A ROS time clock that can be awaited: ``await clock.sleep(1.0)``."""


class AsyncClient(Client[Any, Any]):
    """A client with awaitable calls."""

    async def call(self, request: Any) -> Any:  # type: ignore[override] # that is the point
        """Send a request and wait for the response. Cancelling forgets the request.

        Raises:
            TypeError: `request` is of another class.
            InvalidHandle: the client is destroyed.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError
        loop = asyncio.get_running_loop()
        answer: asyncio.Future[bytes] = loop.create_future()

        def take(data: bytes) -> None:
            loop.call_soon_threadsafe(complete, answer, data)

        with self._handle:
            sequence = self._handle.send_request(request, take)
            try:
                return self._handle.receive(sequence, await answer)
            finally:
                self._handle.forget(sequence)

    async def wait_for_service(self, *, check_interval: float = 0.1) -> None:  # type: ignore[override] # as above
        """Wait until a server is available.

        Args:
            check_interval: How often to check, in seconds.
        """
        while not self.service_is_ready():
            await pause(check_interval)


def complete(future: asyncio.Future[Any], result: Any) -> None:
    """Set a result, unless the future is done."""
    if not future.done():
        future.set_result(result)


async def pause(seconds: float) -> None:
    """Wait for some seconds."""
    loop = asyncio.get_running_loop()
    over = loop.create_future()
    handle = loop.call_later(seconds, complete, over, None)
    try:
        await over
    finally:
        handle.cancel()


class LoopWakeup:
    """Sets an event of a loop, from any thread: the `Wakeup` of a node in an event loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop, event: asyncio.Event) -> None:
        self._loop = loop
        self._event = event

    def wake(self) -> None:
        """Set the event soon."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._event.set)


class AsyncNode(Node):
    """A node for ``await node.run()``, or ``async with node:``.

    Arguments are those of `Node`. Callbacks are functions or coroutine functions; calls of an
    entity's callback do not overlap, unless the entity is `concurrent`.
    """

    def __init__(self, node_name: str, **options: Any) -> None:
        self.__tasks: asyncio.TaskGroup | None = None
        self.__pumps: dict[Any, asyncio.Task[None]] = {}
        self.__news: dict[Any, asyncio.Event] = {}
        self.__concurrent: set[Any] = set()
        self.__destroyed = asyncio.Event()
        super().__init__(node_name, **options)

    def _Node__make_clock(self) -> ROSClock:
        return AsyncClock()

    def get_clock(self) -> AsyncClock:
        """Return its clock."""
        assert isinstance(self._clock, AsyncClock)  # noqa: S101  # made above
        return self._clock

    # Lifetime

    async def __aenter__(self) -> Self:
        """Start calling callbacks.

        Raises:
            RuntimeError: it is already running, or was destroyed.
        """
        if self.__destroyed.is_set():
            raise RuntimeError("Node has been destroyed and cannot be reentered")
        if self.__tasks is not None:
            raise RuntimeError("Node is already running")
        self.__tasks = await asyncio.TaskGroup().__aenter__()
        self.__event = asyncio.Event()
        self.__loop_wakeup: Any = LoopWakeup(asyncio.get_running_loop(), self.__event)
        self.handle.signal.add(self.__loop_wakeup)
        self.__dispatcher = self.__tasks.create_task(self.__dispatch())
        for entity in (*self._subscriptions, *self._services, *self._timers, *self._guards):
            self.__start(entity)
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the node; its callbacks are cancelled.

        Raises:
            ExceptionGroup: exceptions of callbacks.
        """
        tasks = self.__tasks
        assert tasks is not None  # noqa: S101  # set by __aenter__
        try:
            self.destroy_node()
            self.__dispatcher.cancel()
            await tasks.__aexit__(exc_type, exc, traceback)
        finally:
            self.__tasks = None

    async def run(self) -> None:
        """Call callbacks until `destroy_node`."""
        async with self:
            await self.__destroyed.wait()

    def destroy_node(self) -> None:
        """Destroy its entities, cancel their callbacks, and leave the graph."""
        if self.__destroyed.is_set():
            return
        self.__destroyed.set()
        for pump in list(self.__pumps.values()):
            pump.cancel()
        self._clock.destroy()
        super().destroy_node()

    async def wait_for_node(  # type: ignore[override] # awaited, and without a limit
        self, fully_qualified_node_name: str, *, check_interval: float = 0.1
    ) -> None:
        """Wait until a node with this name exists.

        Args:
            fully_qualified_node_name: Namespace and name; the leading slash may be omitted.
            check_interval: How often to check, in seconds.
        """
        wanted = "/" + fully_qualified_node_name.removeprefix("/")
        while wanted not in self.get_fully_qualified_node_names():
            await pause(check_interval)

    # Entities

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        raw: bool = False,
        concurrent: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
        **options: Any,
    ) -> Subscription[Any]:
        """Return a subscription; `concurrent` lets calls of its callback overlap."""
        subscription = super().create_subscription(
            msg_type,
            topic,
            callback,
            qos_profile,
            raw=raw,
            content_filter_options=content_filter_options,
            **options,
        )
        if concurrent:
            self.__concurrent.add(subscription)
        return subscription

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        concurrent: bool = False,
        **options: Any,
    ) -> Service[Any, Any]:
        """Return a service; `concurrent` lets calls of its callback overlap."""
        service = super().create_service(
            srv_type, srv_name, callback, qos_profile=qos_profile, **options
        )
        if concurrent:
            self.__concurrent.add(service)
        return service

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        **options: Any,
    ) -> AsyncClient:
        """Return a client whose `call` is awaitable."""
        plain = super().create_client(srv_type, srv_name, qos_profile=qos_profile, **options)
        client = AsyncClient(
            self.context, plain.handle, srv_type, srv_name, qos_profile, plain.callback_group
        )
        self._clients[self._clients.index(plain)] = client
        return client

    def create_timer(  # type: ignore[override] # of Lyrical's AsyncNode
        self, timer_period_sec: float, callback: Callable[..., Any], autostart: bool = True
    ) -> Timer:
        """Return a timer; the callback may take a `TimerInfo`."""
        return super().create_timer(timer_period_sec, callback, autostart=autostart)

    def _Node__add(
        self, entity: Any, entities: list[Any], arrivals: Arrivals | None = None
    ) -> None:
        super()._Node__add(entity, entities, arrivals)
        if self.__tasks is not None and entities is not self._clients:  # whose calls are awaited
            self.__start(entity)

    def _Node__destroy(self, entity: Any, entities: list[Any]) -> bool:
        pump = self.__pumps.pop(entity, None)
        if pump is not None and pump is not asyncio.current_task():
            pump.cancel()
        self.__news.pop(entity, None)
        return super()._Node__destroy(entity, entities)

    # Callbacks

    def __start(self, entity: Any) -> None:
        assert self.__tasks is not None  # noqa: S101  # the node runs
        self.__news[entity] = asyncio.Event()
        self.__news[entity].set()
        self.__pumps[entity] = self.__tasks.create_task(self.__pump(entity))

    async def __dispatch(self) -> None:
        """Notify all entities that something has happened to one of them."""
        while True:
            await self.__event.wait()
            self.__event.clear()
            for news in self.__news.values():
                news.set()

    async def __pump(self, entity: Any) -> None:
        """Call the callback of an entity whenever it is ready."""
        news = self.__news[entity]
        async with asyncio.TaskGroup() as overlapping:
            while entity.handle.is_valid:
                if not entity.handle.ready():
                    news.clear()
                    await self.__wait(entity, news)
                    continue
                work = self.__take(entity)
                if work is None:
                    continue
                if entity in self.__concurrent:
                    overlapping.create_task(work)
                else:
                    await work
                await pause(0)

    async def __wait(self, entity: Any, news: asyncio.Event) -> None:
        due_ns = entity.handle.due_in_ns() if isinstance(entity, Timer) else None
        if due_ns is None:
            await news.wait()
            return
        loop = asyncio.get_running_loop()
        alarm = loop.call_later(max(0.0, due_ns / 1e9), news.set)
        try:
            await news.wait()
        finally:
            alarm.cancel()

    def __take(self, entity: Any) -> Any:
        """Take the ready item, and return the coroutine that handles it, or None."""
        try:
            with entity.handle:
                if isinstance(entity, Subscription):
                    taken = entity.handle.take_message(entity.msg_type, entity.raw)
                    if taken is None:
                        return None
                    only = entity._callback_type is Subscription.CallbackType.MessageOnly
                    return called(entity.callback, *taken[: 1 if only else 2])
                if isinstance(entity, Service):
                    request, header = entity.handle.service_take_request(None)
                    return None if header is None else self.__answer(entity, request, header)
                if isinstance(entity, Timer) and entity.callback is not None:
                    info = entity.handle.call_timer_with_info()
                    return called(entity.callback, *self.__timer_arguments(entity, info))
                entity.handle.take()
                return called(entity.callback)
        except (InvalidHandle, TimerCancelledError):
            return None

    def __timer_arguments(self, timer: Timer, info: dict[str, int]) -> tuple[Any, ...]:
        try:
            inspect.signature(timer.callback).bind()  # type: ignore[arg-type] # it has one
        except TypeError:
            return (timer.info(info),)
        return ()

    async def __answer(self, service: Any, request: Any, header: Any) -> None:
        response = await called(service.callback, request, service.srv_type.Response())
        service.send_response(response, header)


async def called(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, and await its result if it is awaitable."""
    result = callback(*args)
    return await result if inspect.isawaitable(result) else result
