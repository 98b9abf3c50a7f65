"""A subscription of a client: from a message of the robot to a frame in the client's outbox."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import S_TO_NS
from aionode.engine.wire import cdr
from aionode.errors import AionodeError
from aionode.gateway.session.delivery.pacing import Pacing
from aionode.gateway.session.delivery.preparing import Preparing
from aionode.gateway.session.feed import Received
from aionode.gateway.session.refusals import Refusal

if TYPE_CHECKING:
    from aionode.gateway.session.delivery.outbox import Frame, Outbox
    from aionode.gateway.session.delivery.preparing import Prepare
    from aionode.gateway.session.rights import Rights
    from aionode.gateway.session.robot import Robot
    from aionode.qos import QoSProfile

__all__ = ["Subscribed"]

EVENT: Final = "rcl_interfaces/msg/ParameterEvent"
"""Contains parameter values, some of which the client may not be allowed to see."""


class Subscribed:
    """A subscription of a client; `close` ends it.

    Args:
        robot: The robot.
        rights: What the client may see.
        outbox: The queue for its frames.
        topic: The full name of the topic.
        message_class: The class of its messages.
        frame: Returns the frame of a message, or None for none.
        key: The queue of the outbox in which the frames wait.
        depth: Maximum number of frames waiting there.
        min_period_sec: The shortest time between two messages, in seconds.
        prepare: Encodes a large message; None if `frame` does.
        on_close: Called when it is closed.

    Attributes:
        topic: The full name of the topic.
        type_name: The name of its type.
        message_class: The class of its messages.
        key: The queue of the outbox in which its frames wait.
        failed: Number of messages that could not be encoded because they are malformed.
        take: Called with each message of the topic.
    """

    def __init__(
        self,
        robot: Robot,
        rights: Rights,
        outbox: Outbox,
        topic: str,
        message_class: Any,
        *,
        frame: Callable[[Received], Frame | None],
        key: Hashable,
        depth: int,
        min_period_sec: float,
        prepare: Prepare | None,
        on_close: Callable[[Subscribed], object],
    ) -> None:
        self.topic = topic
        self.message_class = message_class
        self.type_name: str = message_class.__ros_type__
        self.key = key
        self.failed = 0
        self._robot = robot
        self._rights = rights
        self._outbox = outbox
        self._frame = frame
        self._depth = depth
        self._on_close = on_close
        self._leave: Callable[[], None] | None = None
        self._preparing: Preparing | None = None
        self._pacing: Pacing | None = None
        self.take = self._deliver
        if prepare is not None:
            on_drop = partial(outbox.on_drop, key)
            self._preparing = Preparing(robot, prepare, self._deliver, depth, on_drop)
            self.take = self._preparing.put
        if min_period_sec:
            period_ns = round(min_period_sec * S_TO_NS)
            self._pacing = Pacing(robot.time_base, period_ns, self.take, depth)
            self.take = self._pacing.put
        if self.type_name == EVENT:
            self.take = partial(self._take_seen, self.take)

    def open(self, qos: QoSProfile | None) -> None:
        """Receive the messages of the topic from now on; see `Feeds.add` for what it raises."""
        self._leave = self._robot.feeds.add(self.topic, self.message_class, qos, self.take)

    @property
    def dropped(self) -> int:
        """The number of messages dropped because encoding or the client was too slow."""
        unprepared = 0 if self._preparing is None else self._preparing.dropped
        return unprepared + self._outbox.dropped.get(self.key, 0)

    def _take_seen(self, take: Callable[[Received], None], received: Received) -> None:
        """Pass on the part of a parameter event that the client may see."""
        try:
            seen = seen_event(self._rights, received)
        except AionodeError as error:
            self._note_unreadable(error)
            return
        if seen is not None:
            take(seen)

    def _deliver(self, received: Received) -> None:
        try:
            frame = self._frame(received)
        except (AionodeError, ValueError) as error:
            self._note_unreadable(error)
            return
        if frame is not None:
            self._outbox.put(self.key, frame, self._depth)

    def _note_unreadable(self, error: Exception) -> None:
        self.failed += 1
        self._rights.note(Refusal.UNREADABLE, f"subscribe {self.topic}", str(error))

    def close(self) -> None:
        """Unsubscribe; frames waiting for the client are dropped."""
        if self._leave is not None:
            self._leave()
            self._leave = None
            for waiting in (self._pacing, self._preparing):
                if waiting is not None:
                    waiting.close()
            self._outbox.discard(self.key)
            self._on_close(self)


def seen_event(rights: Rights, received: Received) -> Received | None:
    """Return the parts of a parameter event that the client may see; None if there are none.

    Raises:
        DecodeError: the bytes are not such an event (a ValueError).
    """
    event = received.message
    lists = ("new_parameters", "changed_parameters", "deleted_parameters")
    seen = {
        name: [each for each in getattr(event, name)
               if rights.sees(f"{event.node}:{each.name}", [])]
        for name in lists
    }  # fmt: skip
    if all(len(seen[name]) == len(getattr(event, name)) for name in lists):
        return received
    if not any(seen.values()):
        return None
    raw = cdr.encode(type(event)(stamp=event.stamp, node=event.node, **seen))
    return Received(
        received.topic, received.type_name, received.message_class, raw,
        received.time_ns, received.source_ns,
    )  # fmt: skip
