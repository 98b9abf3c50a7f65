"""Runs nodes on a recording in stepped time: the same input gives the same bytes every time.

Each message is published at its time on a manual clock, after everything that is due earlier, and
time advances only once nothing can run. So all callbacks run in the order of their times, however
fast the machine is; `SteppedLoop` does the same for asyncio and threads.
"""

from __future__ import annotations

import asyncio
import os
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Final, Self

import msgspec

from aionode.bag._bag import open as open_bag
from aionode.bag._selection import CAUSES
from aionode.bag.replaying.machine_use import MachineUse
from aionode.bag.replaying.outputs import Outputs, Tap
from aionode.clock import Time
from aionode.engine.bare_node import BareNode
from aionode.engine.context import Context
from aionode.engine.membership import nodes_of
from aionode.errors import (
    BagError,
    DecodeError,
    InterfaceNotFoundError,
    NameValidationException,
    escaped,
)
from aionode.graph import EndpointKind
from aionode.logging import get_logger
from aionode.node import Node
from aionode.qos import QoSProfile
from aionode.testing import ManualClock, SteppedLoop, local_context

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from types import TracebackType

    from aionode.bag._bag import Bag
    from aionode.bag.files.record import Record, TopicInfo
    from aionode.engine.bare_node import BarePublisher

__all__ = ["PIECE_VARIABLE", "Piece", "Replay", "replay"]

PIECE_VARIABLE: Final = "AIONODE_REPLAY_PIECE"
"""The piece of a bag to replay instead of all of it, in JSON; set by ``bag shrink``."""

SKIPPED: Final = ("/rosout", "/parameter_events", CAUSES)
"""Topics that every node publishes itself, and what only a recorder has written."""

logger = get_logger("aionode.bag.replay")


class Piece(msgspec.Struct, kw_only=True):
    """A piece of a bag.

    Attributes:
        path: The bag, resolved.
        start_ns: The time of its first message, in nanoseconds since 1970.
        end_ns: The time before which it ends.
        topics: The topics it has.
    """

    path: str
    start_ns: int
    end_ns: int
    topics: list[str]


class Replay:
    """A run of nodes on a recording; created by `replay`, and used with ``async with``.

    Attributes:
        bag: The recording.
        clock: The clock, which shows the time of the first message until `play` is called.
        context: The context of the nodes, without network. It is the default context meanwhile.
    """

    bag: Bag
    clock: ManualClock
    context: Context

    def __init__(self, path: str | os.PathLike[str], *, seed: int = 0) -> None:
        self._path = path
        self._seed = seed
        self._stack = AsyncExitStack()

    async def __aenter__(self) -> Self:
        """Open the recording and the context.

        Raises:
            BagError: the path is not a bag, or the bag is damaged (a ValueError).
        """
        async with AsyncExitStack() as stack:
            self.bag = stack.enter_context(open_bag(self._path))
            self._piece = piece_of(self._path) or whole(self.bag)
            self.clock = ManualClock(Time(nanoseconds=self._piece.start_ns))
            self.context = local_context(clock=self.clock, seed=self._seed)
            stack.enter_context(Context.as_default(self.context))
            await stack.enter_async_context(self.context)
            self._tasks = await stack.enter_async_context(asyncio.TaskGroup())
            stack.callback(self.context.shutdown)
            self._stepped = stack.enter_context(SteppedLoop(self.clock))
            self._player = BareNode(self.context, "_bag_replay")
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the nodes, and wait until they have ended.

        Raises:
            ExceptionGroup: callbacks of nodes started by `play` failed.
        """
        try:
            await self._stack.__aexit__(exc_type, exc, traceback)
        except BaseExceptionGroup as group:
            if exc is None or group.exceptions != (exc,):
                raise  # an error of the block itself is raised as it is

    async def play(
        self, record: Iterable[str] = (), *, topics: Iterable[str] | None = None
    ) -> Outputs:
        """Publish the recording, and return what the nodes published meanwhile.

        Nodes of the context that are not running yet are started first. Time passes as in the
        recording, but takes only as long as the callbacks do.

        Args:
            record: The topics whose messages to return. They are not published from the recording,
                unless they are in `topics`.
            topics: The topics to publish from the recording; by default all except those of
                `record`, of actions and service events, ``/rosout`` and ``/parameter_events``.

        Raises:
            BagError: no node publishes a topic of `record`, or the recording is damaged or does not
                have a topic of `topics` (a ValueError).
            asyncio.CancelledError: a callback of a node failed; its error is raised by the
            ``async with`` block.
        """
        recorded = [absolute(name) for name in record]
        publish = self._publishers(self._chosen(recorded, topics))
        with Tap(self._player, recorded) as tap, MachineUse():
            for node in nodes_of(self.context):
                if isinstance(node, Node) and not (node.is_running or node.destroyed):
                    self._tasks.create_task(node.run())
            stepped = self._stepped
            await stepped.settle()
            for entry in self.bag.read(
                topics=publish.keys(),
                start=Time(nanoseconds=self._piece.start_ns),
                end=Time(nanoseconds=self._piece.end_ns),
            ):
                await stepped.walk_to(entry.time_ns)
                publish[entry.topic](entry)
                await stepped.settle()
            await stepped.walk_to(min(self._piece.end_ns - 1, self.bag.end_ns))
            await stepped.settle()
            tap.check(str(self.bag.path))
        return tap.outputs

    def _chosen(self, recorded: list[str], topics: Iterable[str] | None) -> list[str]:
        """Return the topics of the bag to publish."""
        if topics is not None:
            chosen = [absolute(name) for name in topics]
        else:
            chosen = [name for name in self.bag.topics if is_input(name) and name not in recorded]
        return [
            name for name in chosen if name in self._piece.topics or name not in self.bag.topics
        ]

    def _publishers(self, topics: list[str]) -> dict[str, Callable[[Record], None]]:
        """Return a function for each topic that publishes a record of it."""
        unknown = [name for name in topics if name not in self.bag.topics]
        if unknown:
            there = ", ".join(self.bag.topics) or "none"
            raise BagError(str(self.bag.path), f"no topic {unknown[0]}", f"its topics: {there}")
        published: dict[str, Callable[[Record], None]] = {}
        for name in topics:
            info = self.bag.topics[name]
            try:
                publisher = self._player.create_publisher(info.msg_type, name, offered(info))
            except (InterfaceNotFoundError, NameValidationException) as error:
                logger.warning(escaped(f"{name} is skipped: {error}", one_line=True))
                continue
            self._warn_of_second(name)
            published[name] = publishing(publisher, self.clock)
        return published

    def _warn_of_second(self, name: str) -> None:
        """Warn if a node also publishes what is recorded, except for transforms."""
        others = [
            endpoint.node.fully_qualified_name
            for endpoint in self.context.graph.endpoints(EndpointKind.PUBLISHER, name=name)
            if endpoint.node != self._player.info
        ]
        if others and name not in {"/tf", "/tf_static"}:
            logger.warning(
                f"{name}: published by {', '.join(others)} and from the recording; exclude "
                "the recorded messages with record=[…] or topics=[…]"
            )


def replay(path: str | os.PathLike[str], *, seed: int = 0) -> Replay:
    """Return a run on a recording, for tests: the same nodes publish the same bytes each time.

    ::

        async with bag.replay("run") as run:
            node = Filter(context=run.context)
            outputs = await run.play(record=["/cmd_vel"])
        assert not bag.compare(outputs, "golden")

    Timers, sleeps, timeouts, services, actions, simulated time and awaited threads follow the time
    of the recording. The page "A recording as a test" lists what cannot be reproduced.

    Args:
        path: The folder or file of a bag.
        seed: Seed for the ids of goals and everything else random that nodes create.
    """
    return Replay(path, seed=seed)


def absolute(topic: str) -> str:
    """Return a topic's name with its leading slash."""
    return topic if topic.startswith("/") else f"/{topic}"


def is_input(topic: str) -> bool:
    """Return whether nodes listen to a recorded topic, rather than it being their own output."""
    return topic not in SKIPPED and not ("/_action/" in topic or topic.endswith("/_service_event"))


def offered(info: TopicInfo) -> QoSProfile:
    """Return the QoS profile for publishing a recorded topic.

    It is that of the recorded publishers if all had the same, or else one that fits most readers.
    """
    profiles = info.qos
    if profiles and all(profile == profiles[0] for profile in profiles):
        return profiles[0]
    return QoSProfile(depth=10)


def publishing(publisher: BarePublisher, clock: ManualClock) -> Callable[[Record], None]:
    """Return a function that publishes a record if anything listens."""

    def publish(record: Record) -> None:
        if not publisher.is_heard():
            return  # no need to decode the message
        try:
            message = record.message
        except DecodeError as error:
            logger.warning(f"{record.topic} at {record.time_ns} ns is skipped: {error}")
        else:
            publisher.publish(message, clock.system_ns())

    return publish


def piece_of(path: str | os.PathLike[str]) -> Piece | None:
    """Return the piece of this bag that the environment selects; None for all of it.

    Raises:
        BagError: the variable is not one set by ``bag shrink`` (a ValueError).
    """
    text = os.environ.get(PIECE_VARIABLE)
    if not text:
        return None
    try:
        piece = msgspec.json.decode(text, type=Piece)
    except msgspec.DecodeError as error:
        raise BagError(
            PIECE_VARIABLE, str(error), "unset it; only `aionode bag shrink` sets it"
        ) from error
    return piece if piece.path == os.path.realpath(path) else None


def whole(bag: Bag) -> Piece:
    """Return the whole bag as a piece."""
    return Piece(
        path=os.path.realpath(bag.path),
        start_ns=bag.start_ns,
        end_ns=bag.end_ns + 1,
        topics=list(bag.topics),
    )
