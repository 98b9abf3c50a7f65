"""Synchronize messages of several topics that have the same or nearly the same stamp.

The names and rules are those of ROS 2's Python package `message_filters`: a `Subscriber` starts a
chain, a `Cache` stores messages, and a synchronizer calls back with one message of each input. ::

    left = Subscriber(node, Image, "/left/image")
    right = Subscriber(node, Image, "/right/image")
    pairs = ApproximateTimeSynchronizer([left, right], queue_size=10, slop=0.05)
    pairs.registerCallback(on_pair)

`synchronize` does the same in an ``async for``, over subscriptions without callbacks::

    async for left, right in synchronize(left_subscription, right_subscription, slop=0.05):
        ...

Memory is bounded: each input keeps `queue_size` messages; unmatched messages beyond that are
dropped and counted.
"""

from __future__ import annotations

import asyncio
import math
from collections import deque
from typing import TYPE_CHECKING, Any, TypeVar, overload

from aionode.clock import ClockType, MachineTime, Time
from aionode.engine.causes import CAUSES, add_cause
from aionode.errors import EntityDestroyedError
from aionode.logging import get_logger

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Iterable, Iterator, Sequence

    from aionode.endpoints.subscription import Subscription
    from aionode.engine.causes import Run
    from aionode.message import Message
    from aionode.node import Node

__all__ = [
    "ApproximateTimeSynchronizer",
    "Cache",
    "Chain",
    "SimpleFilter",
    "Subscriber",
    "Synchronized",
    "TimeSynchronizer",
    "synchronize",
]

A = TypeVar("A")
B = TypeVar("B")
C = TypeVar("C")

logger = get_logger("message_filters")


# Matching


class Matcher:
    """Finds messages of several inputs with the same stamp.

    Args:
        inputs: The number of inputs.
        queue_size: How many messages of each input are kept; beyond that, the one with the lowest
            stamp is dropped.

    Attributes:
        dropped: How many messages were dropped.
    """

    def __init__(self, inputs: int, queue_size: int) -> None:
        if queue_size < 1:
            raise ValueError(f"queue_size={queue_size}; it must be at least 1")
        self.dropped = 0
        self._queue_size = queue_size
        # For each input, its unmatched messages by stamp, in nanoseconds.
        self._queues: list[dict[int, Any]] = [{} for _ in range(inputs)]

    def add(self, index: int, stamp_ns: int, msg: Any) -> list[tuple[Any, ...]]:
        """Add a message of an input; return the sets that are now complete, the oldest first."""
        queue = self._queues[index]
        queue[stamp_ns] = msg
        while len(queue) > self._queue_size:
            del queue[min(queue)]
            self.dropped += 1
        return [self._take(stamps) for stamps in self._matches(index, stamp_ns)]

    def _matches(self, index: int, stamp_ns: int) -> list[list[int]]:  # noqa: ARG002  # for subclasses
        """Return the stamps, one of each input, of each complete set."""
        common = set(self._queues[0]).intersection(*self._queues[1:])
        return [[stamp] * len(self._queues) for stamp in sorted(common)]

    def _take(self, stamps: list[int]) -> tuple[Any, ...]:
        return tuple(queue.pop(stamp) for queue, stamp in zip(self._queues, stamps, strict=True))


class ApproximateMatcher(Matcher):
    """Finds messages whose stamps are less than a slop apart, around the newest arrival.

    Args:
        inputs: The number of inputs.
        queue_size: As for `Matcher`.
        slop_sec: The slop, in seconds; with 0, which matches nothing in ROS 2, stamps have to be
            equal.

    Raises:
        ValueError: `queue_size` is below 1, or the slop is negative or not finite.
    """

    def __init__(self, inputs: int, queue_size: int, slop_sec: float) -> None:
        super().__init__(inputs, queue_size)
        if not 0 <= slop_sec < math.inf:
            raise ValueError(f"slop={slop_sec}; it must be 0 or more seconds, and finite")
        self._slop_ns = max(1, round(slop_sec * 1e9))

    def _matches(self, index: int, stamp_ns: int) -> list[list[int]]:
        if stamp_ns not in self._queues[index]:
            return []  # it was dropped at once
        candidates = []
        for other, queue in enumerate(self._queues):
            near = [stamp for stamp in queue if abs(stamp - stamp_ns) <= self._slop_ns]
            candidates.append(
                [stamp_ns] if other == index else sorted(near, key=lambda s: abs(s - stamp_ns))
            )
        combination = next(self._combinations(candidates, []), None)
        return [] if combination is None else [combination]

    def _combinations(self, candidates: list[list[int]], chosen: list[int]) -> Iterator[list[int]]:
        """Yield sets of close enough stamps, one of each input, those closest to the arrival first.

        A partial set that is too far apart is abandoned at once, so that many inputs stay
        affordable.
        """
        if len(chosen) == len(candidates):
            yield chosen
            return
        for stamp in candidates[len(chosen)]:
            longer = [*chosen, stamp]
            if max(longer) - min(longer) < self._slop_ns:
                yield from self._combinations(candidates, longer)


class Stamps:
    """Returns the stamp of a message; logs once if a message has none.

    Args:
        allow_headerless: Whether a message without a header gets the current time.
    """

    def __init__(self, *, allow_headerless: bool) -> None:
        self._allow_headerless = allow_headerless
        self._time = MachineTime()

    def of(self, msg: Any) -> Any:
        """Return the stamp of a message; None if the message cannot be used."""
        stamp = getattr(getattr(msg, "header", None), "stamp", None)
        if hasattr(stamp, "nanoseconds"):
            return stamp
        if stamp is None:
            return self._without(msg)
        try:
            return self._from_msg(stamp)
        except ValueError:  # any node can send this; it must not end ours
            logger.warning(
                f"{type(msg).__name__} has a stamp before the year 1970, sec={stamp.sec}, and is "
                "ignored; so are further ones. `aionode topic info -v` names the publishers",
                once=True,
            )
            return None

    def _without(self, msg: Any) -> Any:
        """Return the substitute for a missing stamp, or None."""
        if self._allow_headerless:
            return self._now()
        logger.warning(
            f"{type(msg).__name__} has no header with a stamp, and is ignored; "
            "allow_headerless=True uses the time of arrival instead",
            once=True,
        )
        return None

    def _from_msg(self, stamp: Any) -> Any:
        return Time.from_msg(stamp)

    def _now(self) -> Any:
        return Time(nanoseconds=self._time.system_ns(), clock_type=ClockType.ROS_TIME)


# Callbacks, as in ROS 2


class SimpleFilter:
    """A filter that calls back with its output, which a subclass defines."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: Any) -> int:  # ROS 2's name
        """Call `cb` with each output, followed by `args`; return the number of the connection."""
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def _SimpleFilter__inner_callbacks(self) -> list[Callable[..., object]]:
        """Return the registered callbacks, which the log names in place of the filter's own."""
        return [callback for callback, _ in self.callbacks.values()]

    def signalMessage(self, *msg: Any) -> None:  # ROS 2's name
        """Call all registered callbacks."""
        for callback, args in list(self.callbacks.values()):
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """Starts a chain: a subscription that passes its messages to the connected filters.

    Args:
        node: The node that subscribes.
        msg_type: A message class.
        topic: Name of the topic.
        options: Further arguments of `Node.create_subscription`.

    Attributes:
        sub: The subscription.
    """

    def __init__(self, node: Node, msg_type: type[Message], topic: str, **options: Any) -> None:
        super().__init__()
        self.topic = topic
        self.sub: Subscription[Any] = node.create_subscription(
            msg_type, topic, self.signalMessage, **options
        )

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the subscription, as in ROS 2: ``subscriber.topic_name``."""
        if name == "sub":  # the subscription could not be created
            raise AttributeError(name)
        return getattr(self.sub, name)

    def getTopic(self) -> str:  # ROS 2's name
        """Return the name of the topic as given."""
        return self.topic


class Cache(SimpleFilter):
    """Stores the latest messages of another filter, and passes them on.

    Args:
        f: The filter whose messages are stored.
        cache_size: How many messages are kept.
        allow_headerless: Whether a message without a header is kept with its time of arrival.
    """

    def __init__(
        self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False
    ) -> None:
        super().__init__()
        self.cache_size = cache_size
        self._Cache__stamps = Stamps(allow_headerless=allow_headerless)
        self._Cache__entries: deque[tuple[Time, Any]] = deque(maxlen=cache_size)
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:  # ROS 2's name
        """Store another filter's messages as well."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Store a message, and pass it on."""
        stamp = self._Cache__stamps.of(msg)
        if stamp is not None:
            self._Cache__entries.append((stamp, msg))
            self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:  # ROS 2's name
        """Return the messages between two stamps, both included, in the order of their arrival.

        Raises:
            ValueError: `from_stamp` is later than `to_stamp`.
        """
        first, last = from_stamp.nanoseconds, to_stamp.nanoseconds
        if first > last:
            raise ValueError(f"from_stamp {from_stamp} is later than to_stamp {to_stamp}")
        return [msg for stamp, msg in self._Cache__entries if first <= stamp.nanoseconds <= last]

    def getElemAfterTime(self, stamp: Time) -> Any:  # ROS 2's name
        """Return the first message at or after a stamp, or None."""
        later = (msg for at, msg in self._Cache__entries if at.nanoseconds >= stamp.nanoseconds)
        return next(later, None)

    def getElemBeforeTime(self, stamp: Time) -> Any:  # ROS 2's name
        """Return the last message at or before a stamp, or None."""
        earlier = (
            msg for at, msg in reversed(self._Cache__entries) if at.nanoseconds <= stamp.nanoseconds
        )
        return next(earlier, None)

    def getLastestTime(self) -> Time | None:  # ROS 2's name, and its spelling
        """Return the stamp of the last message, or None."""
        return self._Cache__entries[-1][0] if self._Cache__entries else None

    def getLatestTime(self) -> Time | None:  # ROS 2's name, spelled right
        """Return the stamp of the last message, or None."""
        return self.getLastestTime()

    def getOldestTime(self) -> Time | None:  # ROS 2's name
        """Return the stamp of the first message, or None."""
        return self._Cache__entries[0][0] if self._Cache__entries else None

    def getLast(self) -> Any:  # ROS 2's name
        """Return the last message, or None."""
        return self._Cache__entries[-1][1] if self._Cache__entries else None


class Chain(SimpleFilter):
    """Several filters in a row as one: each gets the output of the previous one.

    Input goes to the first filter, and the output of the last one is that of the chain. A filter in
    a chain has the methods `add` and `connectInput`, like `Cache`. A chain without filters passes
    everything on.
    """

    def __init__(self) -> None:
        super().__init__()
        self.__filters: list[Any] = []

    def connectInput(self, f: SimpleFilter) -> None:  # ROS 2's name
        """Take the output of another filter as input."""
        self.incoming_connection = f.registerCallback(self.add)

    def addFilter(self, f: Any) -> int:  # ROS 2's name
        """Append a filter; return its index."""
        index = len(self.__filters)
        if self.__filters:
            f.connectInput(self.__filters[-1])
        self.__filters.append(f)
        f.registerCallback(self.__on_output, index)
        return index

    def getFilter(self, index: int) -> Any:  # ROS 2's name
        """Return a filter of the chain.

        Raises:
            KeyError: there is no filter of this index.
        """
        if not 0 <= index < len(self.__filters):
            raise KeyError(
                f"the chain has {len(self.__filters)} filters, but none of index {index}"
            )
        return self.__filters[index]

    def add(self, *msg: Any) -> None:
        """Give a message to the first filter."""
        if self.__filters:
            self.__filters[0].add(*msg)
        else:
            self.signalMessage(*msg)

    def __on_output(self, *msg_and_index: Any) -> None:
        *msg, index = msg_and_index
        if index == len(self.__filters) - 1:
            self.signalMessage(*msg)


class Synchronizer(SimpleFilter):
    """Calls back with one message of each input, as put together by a matcher."""

    def __init__(self, fs: Sequence[SimpleFilter], matcher: Matcher, stamps: Stamps) -> None:
        super().__init__()
        self._Synchronizer__matcher = matcher
        self._Synchronizer__stamps = stamps
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:  # ROS 2's name
        """Take the inputs from these filters; their number stays the same."""
        self.input_connections = [f.registerCallback(self.add, index) for index, f in enumerate(fs)]

    def add(self, msg: Any, index: int) -> None:
        """Add a message of an input."""
        stamp = self._Synchronizer__stamps.of(msg)
        if stamp is not None:
            arrived = (msg, CAUSES.get())
            for pairs in self._Synchronizer__matcher.add(index, stamp.nanoseconds, arrived):
                act_for(pairs)
                self.signalMessage(*(message for message, _ in pairs))


def act_for(pairs: Iterable[tuple[Any, tuple[Run, ...]]]) -> None:
    """Make the runs that brought several messages the cause of what is sent from now on."""
    add_cause(*dict.fromkeys(run for _, runs in pairs for run in runs))


class TimeSynchronizer(Synchronizer):
    """Calls back with one message of each input, all with the same stamp.

    Args:
        fs: The inputs.
        queue_size: How many messages of each input wait for the others.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__(fs, Matcher(len(fs), queue_size), Stamps(allow_headerless=False))

    @property
    def dropped(self) -> int:
        """The number of messages that were dropped before their counterparts arrived."""
        return self._Synchronizer__matcher.dropped


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Calls back with one message of each input, whose stamps are nearly the same.

    When a message arrives, it is matched with those of the other inputs that are closest to it.

    Args:
        fs: The inputs.
        queue_size: How many messages of each input wait for the others.
        slop: The stamps differ by less than this, in seconds; with 0 they are equal.
        allow_headerless: Whether to use the time of arrival for messages without a header.

    Raises:
        ValueError: `queue_size` is below 1, or `slop` is negative or not finite.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
    ) -> None:
        matcher = ApproximateMatcher(len(fs), queue_size, slop)
        stamps = Stamps(allow_headerless=allow_headerless)
        Synchronizer.__init__(self, fs, matcher, stamps)


# Iteration


class Synchronized:
    """Iterates over sets of matching messages of several subscriptions; see `synchronize`."""

    def __init__(
        self, subscriptions: Sequence[Subscription[Any]], matcher: Matcher, stamps: Stamps
    ) -> None:
        self._subscriptions = subscriptions
        self._matcher = matcher
        self._stamps = stamps
        self._complete: deque[tuple[tuple[Any, tuple[Run, ...]], ...]] = deque()
        self._ended = False

    @property
    def dropped(self) -> int:
        """The number of messages that were dropped before their counterparts arrived."""
        return self._matcher.dropped

    def __aiter__(self) -> AsyncIterator[tuple[Any, ...]]:
        """Iterate until one of the subscriptions is destroyed."""
        return self

    async def __anext__(self) -> tuple[Any, ...]:
        """Return the next set of matching messages. Cancelling loses no message."""
        while not self._complete:
            if self._ended:
                raise StopAsyncIteration
            await self._receive()
        pairs = self._complete.popleft()
        act_for(pairs)
        return tuple(message for message, _ in pairs)

    async def _receive(self) -> None:
        """Wait for the next message of any subscription."""
        try:
            async with asyncio.TaskGroup() as group:
                receiving = [
                    group.create_task(received(subscription))
                    for subscription in self._subscriptions
                ]
                try:
                    await asyncio.wait(receiving, return_when=asyncio.FIRST_COMPLETED)
                finally:
                    for index, task in enumerate(receiving):
                        if not task.done():
                            task.cancel()  # a message that arrives now stays in the queue
                        elif not task.cancelled() and task.exception() is None:
                            self._take(index, task.result())
        except* EntityDestroyedError:
            self._ended = True

    def _take(self, index: int, pair: tuple[Any, tuple[Run, ...]]) -> None:
        stamp = self._stamps.of(pair[0])
        if stamp is not None:
            self._complete.extend(self._matcher.add(index, stamp.nanoseconds, pair))


async def received(subscription: Subscription[Any]) -> tuple[Any, tuple[Run, ...]]:
    """Return the next message of a subscription, with the run of having read it."""
    return await subscription.receive(), CAUSES.get()[-1:]


@overload
def synchronize(
    first: Subscription[A],
    second: Subscription[B],
    /,
    *,
    slop: float | None = None,
    queue_size: int = 10,
    allow_headerless: bool = False,
) -> AsyncIterator[tuple[A, B]]: ...


@overload
def synchronize(
    first: Subscription[A],
    second: Subscription[B],
    third: Subscription[C],
    /,
    *,
    slop: float | None = None,
    queue_size: int = 10,
    allow_headerless: bool = False,
) -> AsyncIterator[tuple[A, B, C]]: ...


@overload
def synchronize(
    *subscriptions: Subscription[Any],
    slop: float | None = None,
    queue_size: int = 10,
    allow_headerless: bool = False,
) -> AsyncIterator[tuple[Any, ...]]: ...


def synchronize(
    *subscriptions: Subscription[Any],
    slop: float | None = None,
    queue_size: int = 10,
    allow_headerless: bool = False,
) -> AsyncIterator[tuple[Any, ...]]:
    """Return an iterator over sets of matching messages, one of each subscription.

    Args:
        subscriptions: Subscriptions without callbacks; the iterator reads them.
        slop: The stamps differ by less than this, in seconds; by default, and with 0, they are
            equal.
        queue_size: How many messages of each subscription wait for the others; `dropped` of the
            iterator counts those dropped.
        allow_headerless: Whether to use the time of arrival for messages without a header.

    Raises:
        ValueError: there are fewer than two subscriptions, `queue_size` is below 1, or `slop` is
            negative or not finite.
    """
    count = len(subscriptions)
    if count < 2:
        raise ValueError(f"{count} subscription(s) given; pass at least two")
    matcher = (
        Matcher(count, queue_size) if slop is None else ApproximateMatcher(count, queue_size, slop)
    )
    return Synchronized(subscriptions, matcher, Stamps(allow_headerless=allow_headerless))
