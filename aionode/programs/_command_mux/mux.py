"""Of several sources of commands for a base, the one with the highest priority wins."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from aionode.interfaces.std_msgs.msg import Bool
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["CommandMux"]

DIAGNOSTICS_SEC: Final = 1.0


class Source:
    """A topic with commands, or a lock for sources of lower priority.

    Args:
        name: Its name in the parameters.
        topic: The topic.
        timeout: How long a message is valid, in seconds; 0 means forever.
        priority: Its priority, from 0 to 255.
        now: Returns the time in nanoseconds.
    """

    def __init__(
        self, name: str, topic: str, timeout: float, priority: int, now: Callable[[], int]
    ) -> None:
        self.name = name
        self.topic = topic
        self.timeout = timeout
        self.priority = max(0, min(255, priority))
        self.is_set = False
        self.stamp_ns = -math.inf
        self._now = now

    def hear(self, *, is_set: bool) -> None:
        """Record the arrival of a message."""
        self.stamp_ns = self._now()
        self.is_set = is_set

    @property
    def has_expired(self) -> bool:
        """Whether the last message is too old, or there was none.

        A message from before the clock was set back is in the future, and could stay valid for
        hours.
        """
        return self.timeout > 0 and not 0 <= (self._now() - self.stamp_ns) / 1e9 <= self.timeout

    @property
    def is_locked(self) -> bool:
        """Whether the lock is active: its value is true, or it has fallen silent."""
        return self.has_expired or self.is_set


class CommandMux(Node):
    """Publishes the commands of the source with the highest priority.

    The parameters ``topics.NAME.topic``, ``.timeout`` and ``.priority`` define command sources,
    those below ``locks`` locks.

    Args:
        name: The name of the node.
        title: What its diagnostics call it.

    Raises:
        CommandError: A parameter is missing or invalid.
    """

    def __init__(self, name: str, title: str) -> None:
        super().__init__(
            name,
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        self.title = title
        self.commands = self.sources("topics")
        self.locks = self.sources("locks")

    def connect(self, kind: Any, output: str) -> None:
        """Create the publishers, subscriptions and timer.

        Args:
            kind: The type of the commands.
            output: The topic of those that win.
        """
        self.output = self.create_publisher(kind, output, 1)
        self.diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 1)
        for source in self.commands:
            self.create_subscription(kind, source.topic, self.commanding(source), 10)
        for source in self.locks:
            self.create_subscription(Bool, source.topic, self.locking(source), 10)
        create_wall_timer(self, DIAGNOSTICS_SEC, self.tell)
        if not self.commands:
            self.get_logger().warning(
                "no command passes, because there are no sources; set the parameters "
                "topics.NAME.topic, topics.NAME.timeout and topics.NAME.priority of the node "
                f"{self.get_fully_qualified_name()}"
            )

    def sources(self, prefix: str) -> list[Source]:
        """Return the sources below a prefix of parameters, and log them."""
        given = self.get_parameters_by_prefix(prefix)
        found = []
        for name in sorted({key.rpartition(".")[0] for key in given}):
            values: list[Any] = []
            for part, kind in (("topic", str), ("timeout", float), ("priority", int)):
                parameter = given.get(f"{name}.{part}")
                if parameter is None:
                    raise CommandError(
                        f"Error parsing params '{prefix}': could not load parameter "
                        f"'{prefix}.{name}.{part}'. (namespace: {self.get_namespace()})"
                    )
                value = parameter.value
                if kind is float and type(value) is int:
                    value = float(value)
                if type(value) is not kind:
                    raise CommandError(
                        f"parameter '{prefix}.{name}.{part}' is {value!r}; "
                        f"its type has to be {kind.__name__}"
                    )
                if isinstance(value, float) and not math.isfinite(value):
                    raise CommandError(
                        f"parameter '{prefix}.{name}.{part}' is {value}; it has to be a finite "
                        "number of seconds, or 0 for a message that stays valid"
                    )
                values.append(value)
            topic, timeout, priority = values
            found.append(Source(f"{prefix}.{name}", topic, timeout, priority, self.now_ns))
            lasts = f"{timeout:f}s" if timeout > 0 else "None"
            self.get_logger().info(
                f"Topic handler '{prefix}.{name}' subscribed to topic '{topic}': timeout = {lasts} "
                f", priority = {found[-1].priority}."
            )
        return found

    def now_ns(self) -> int:
        """Return the time in nanoseconds."""
        return self.get_clock().now().nanoseconds

    def commanding(self, source: Source) -> Callable[[Any], None]:
        """Return the callback for the commands of a source."""

        def on_command(command: Any) -> None:
            source.hear(is_set=True)
            if self.leader() is source:
                self.output.publish(command)

        return on_command

    def locking(self, source: Source) -> Callable[[Bool], None]:
        """Return the callback for a lock."""
        return lambda msg: source.hear(is_set=msg.data)

    def lock_priority(self) -> int:
        """Return the highest priority of the active locks."""
        return max((lock.priority for lock in self.locks if lock.is_locked), default=0)

    def leader(self) -> Source | None:
        """Return the source in command: the first of those with the highest priority."""
        lowest = self.lock_priority()
        heard = [
            source
            for source in self.commands
            if not source.has_expired and source.priority >= lowest and source.priority > 0
        ]
        return max(heard, key=lambda source: source.priority, default=None)

    def tell(self) -> None:
        """Publish diagnostics of the sources and locks."""
        leader, lowest = self.leader(), self.lock_priority()
        values = {
            f"velocity {source.name}": (
                f"{'masked' if source.has_expired or source.priority < lowest else 'unmasked'} "
                f"(listening to {source.topic} @ {source.timeout:f}s with priority "
                f"#{source.priority})"
            )
            for source in self.commands
        } | {
            f"lock {source.name}": (
                f"{'locked' if source.is_locked else 'free'} (listening to {source.topic} @ "
                f"{source.timeout:f}s with priority #{source.priority})"
            )
            for source in self.locks
        }
        values["current priority"] = str(lowest)
        # Nothing measures these two, in the original either.
        values["loop time in [sec]"] = values["data age in [sec]"] = "0"
        values["current source"] = "none" if leader is None else leader.name
        status = DiagnosticStatus(
            level=DiagnosticStatus.OK,
            name=f"{self.get_name()}: {self.title} status",
            message="ok",
            hardware_id="none",
            values=[KeyValue(key=key, value=value) for key, value in values.items()],
        )
        msg = DiagnosticArray(status=[status])
        msg.header.stamp = self.get_clock().now().to_msg()
        self.diagnostics.publish(msg)
