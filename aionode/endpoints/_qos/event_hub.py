"""Dispatches the events of one endpoint to its callbacks and its stream."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from msgspec import structs

from aionode.endpoints.core.callback_runner import accepts, consume
from aionode.endpoints.core.entity import Entity
from aionode.endpoints.core.message_queue import MessageQueue
from aionode.endpoints.events import EVENTS_KEPT, EventStream
from aionode.endpoints.stats import CallbackStats
from aionode.errors import brief
from aionode.qos import is_unlimited

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Mapping

    from aionode.clock import Duration
    from aionode.endpoints.core.callback_runner import Callbacks
    from aionode.endpoints.core.endpoint import Endpoint
    from aionode.endpoints.events import PublisherEventCallbacks, SubscriptionEventCallbacks

__all__ = ["EventHandler", "EventHub", "is_limited"]


def is_limited(*durations: Duration) -> bool:
    """Return whether a policy sets a limit, so that the endpoint has to be monitored."""
    return not all(map(is_unlimited, durations))


class EventHandler(Entity):
    """Calls the event callbacks of one endpoint, one at a time.

    Args:
        subject: The endpoint, for errors and reports.
        event_callbacks: The functions, by event name.
        callbacks: How the node runs callbacks.

    Raises:
        CallbackSignatureError: a function takes the wrong number of arguments (a TypeError).
    """

    def __init__(
        self,
        subject: str,
        event_callbacks: Mapping[str, Callable[[Any], object]],
        callbacks: Callbacks,
    ) -> None:
        super().__init__(f"events of the {subject}")
        self._stats = CallbackStats()
        self._queue: MessageQueue[tuple[str, Any]] = MessageQueue(
            EVENTS_KEPT, self._stats, slice_ns=callbacks.slice_ns
        )
        for name, callback in event_callbacks.items():
            accepts(callback, 1, subject=f"{subject}, event callback {name}", wanted="(event)")
        self._runners = {
            name: callbacks.make_runner(
                callback, self, self._stats, on_error="raise", offload=False
            )
            for name, callback in event_callbacks.items()
        }

    def calls(self, name: str) -> bool:
        """Return whether a callback was given for the events called `name`."""
        return name in self._runners

    def put(self, name: str, event: object) -> None:
        """Schedule the callback for this event, if there is one."""
        if name in self._runners and not self.destroyed:
            self._queue.put((name, event))

    def _run(self) -> Coroutine[Any, Any, None]:
        return consume(self._queue, self._handle, concurrent=False)

    def _handle(self, entered_ns: int, item: tuple[str, Any]) -> Coroutine[Any, Any, None] | None:
        name, event = item
        return self._runners[name].receive(entered_ns, event)

    def _close(self) -> None:
        self._queue.discard()
        self._queue.wake()


class EventHub:
    """Dispatches the events of one endpoint, and remembers the latest of each kind.

    Args:
        entity: The endpoint.
        event_callbacks: The callbacks that the program passed.
        wanted: Their class.

    Attributes:
        handler: Calls the callbacks; None if there are none.

    Raises:
        TypeError: `event_callbacks` is of another class, or a function in it takes other arguments.
    """

    __slots__ = (
        "_ended",
        "_newest",
        "_stream",
        "handler",
    )

    def __init__(
        self,
        entity: Endpoint,
        event_callbacks: PublisherEventCallbacks | SubscriptionEventCallbacks | None,
        wanted: type[PublisherEventCallbacks | SubscriptionEventCallbacks],
    ) -> None:
        self.handler: EventHandler | None = None
        self._stream: EventStream[Any] | None = None
        self._newest: dict[str, Any] = {}
        self._ended = False
        if event_callbacks is None:
            return
        subject = entity._subject
        if not isinstance(event_callbacks, wanted):
            raise TypeError(
                f"{subject}: event_callbacks is {brief(event_callbacks)}; give a "
                f"{wanted.__name__}, such as {wanted.__name__}(matched=print)"
            )
        given = {
            name: callback
            for name, callback in vars(event_callbacks).items()
            if callback is not None and name != "use_default_callbacks"
        }
        if given:
            self.handler = EventHandler(subject, given, entity._callbacks)
        silent = not event_callbacks.use_default_callbacks
        handled = {"qos"} if silent or "incompatible_qos" in given else set()
        if silent or "incompatible_type" in given:
            handled.update(("type", "definition"))
        entity._leave_unreported(handled)

    def calls(self, name: str) -> bool:
        """Return whether a callback was given for the events called `name`."""
        return self.handler is not None and self.handler.calls(name)

    @property
    def has_listeners(self) -> bool:
        """Whether the program listens to events in either form."""
        return self.handler is not None or self._stream is not None

    def emitter(self, name: str) -> Callable[[Any], None]:
        """Return the function that emits the events called `name`."""
        return partial(self.emit, name)

    def emit(self, name: str, event: Any) -> None:
        """Dispatch an event; it replaces the latest of its name."""
        self._newest[name] = event
        if self.handler is not None:
            self.handler.put(name, event)
        if self._stream is not None:
            self._stream._put(event)

    def stream(self) -> EventStream[Any]:
        """Return the stream; a new one begins with the totals so far."""
        if self._stream is None:
            self._stream = EventStream()
            for event in self._newest.values():
                self._stream._put(since_creation(event))
            if self._ended:
                self._stream._end()
        return self._stream

    def close(self) -> None:
        """End the callbacks and the stream."""
        self._ended = True
        if self.handler is not None:
            self.handler.destroy()
        if self._stream is not None:
            self._stream._end()


def since_creation(event: Any) -> Any:
    """Return an event in which each change is replaced by its total, counted since creation."""
    changes = {
        name: getattr(event, name.removesuffix("_change"))
        for name in event.__struct_fields__
        if name.endswith("_change")
    }
    return structs.replace(event, **changes)
