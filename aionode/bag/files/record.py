"""The contents of a bag: topics, and records of their messages."""

from __future__ import annotations

from typing import Any, Final

import msgspec

from aionode.clock import ClockType, Time
from aionode.qos import QoSProfile

__all__ = ["MAX_NS", "Record", "TopicInfo", "time_of"]

MAX_NS: Final = 2**63 - 1
"""The latest time that a `Time` can represent, in nanoseconds."""


def time_of(ns: int) -> Time:
    """Convert nanoseconds since 1970 to a `Time`, clamping times that it cannot represent."""
    return Time(nanoseconds=min(max(ns, 0), MAX_NS), clock_type=ClockType.ROS_TIME)


class TopicInfo(msgspec.Struct, kw_only=True, eq=False):
    """One topic of a bag.

    Attributes:
        name: Its full name.
        type: The ROS name of its type, such as ``std_msgs/msg/String``.
        type_hash: The RIHS01 hash of the type; empty if the bag has none.
        qos: The profiles that its publishers offered.
        message_count: Number of its messages in the bag.
        serialization_format: The encoding of messages: ``cdr``.
        encoding: The format of `definition`: ``ros2msg``, ``ros2idl``, or empty if there is none.
        definition: The text of the type's definition, including all types that it uses.
        problem: What could not be read about the topic, and is missing here; empty if nothing.
    """

    name: str
    type: str
    type_hash: str = ""
    qos: tuple[QoSProfile, ...] = ()
    message_count: int = 0
    serialization_format: str = "cdr"
    encoding: str = ""
    definition: str = ""
    problem: str = ""
    _class: Any = None

    @property
    def msg_type(self) -> Any:
        """The class of its messages: aionode's own, or one built from the definition in the bag.

        Raises:
            InterfaceNotFoundError: neither aionode nor the bag has a definition of the type.
        """
        if self._class is None:
            from aionode.bag.files.types import class_of  # copying a bag does not need it

            self._class = class_of(self.type, self.type_hash, self.encoding, self.definition)
        return self._class

    @property
    def key(self) -> tuple[str, str, str]:
        """What identifies a topic: its name, its type and the type's hash."""
        return (self.name, self.type, self.type_hash)


class Record:
    """One message of a bag.

    Attributes:
        info: Its topic.
        time_ns: The receive time, in nanoseconds since 1970.
        publish_time_ns: The publish time; `time_ns` if the bag does not contain it.
        sequence: The publisher's sequence number; 0 if the bag does not contain it.
        raw: The message as CDR bytes.
    """

    __slots__ = ("_message", "info", "publish_time_ns", "raw", "sequence", "time_ns")

    def __init__(
        self, info: TopicInfo, time_ns: int, publish_time_ns: int, sequence: int, raw: bytes
    ) -> None:
        self.info = info
        self.time_ns = time_ns
        self.publish_time_ns = publish_time_ns
        self.sequence = sequence
        self.raw = raw
        self._message: Any = None

    def __repr__(self) -> str:
        return f"<Record {self.topic} {self.type} at {self.time_ns} ns, {len(self.raw)} bytes>"

    @property
    def topic(self) -> str:
        """The name of its topic."""
        return self.info.name

    @property
    def type(self) -> str:
        """The ROS name of its type."""
        return self.info.type

    @property
    def time(self) -> Time:
        """The receive time."""
        return time_of(self.time_ns)

    @property
    def publish_time(self) -> Time:
        """The publish time; `time` if the bag does not contain it."""
        return time_of(self.publish_time_ns)

    @property
    def message(self) -> Any:
        """The message, decoded on first use.

        Raises:
            InterfaceNotFoundError: neither aionode nor the bag has a definition of the type.
            DecodeError: the bytes are not a message of this type.
        """
        if self._message is None:
            from aionode.engine.wire import cdr

            self._message = cdr.decode(self.info.msg_type, self.raw)
        return self._message
