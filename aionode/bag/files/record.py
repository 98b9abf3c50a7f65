"""The content of a bag: topics, and records of their messages."""

from __future__ import annotations

from typing import Any, Final

import msgspec

from aionode.clock import ClockType, Time
from aionode.qos import QoSProfile

__all__ = ["MOST_NS", "Record", "TopicInfo", "time_of"]

MOST_NS: Final = 2**63 - 1
"""The latest time that a `Time` shows, in nanoseconds."""


def time_of(ns: int) -> Time:
    """Return nanoseconds since 1970 as a `Time`; a time that no `Time` can show is cut off."""
    return Time(nanoseconds=min(max(ns, 0), MOST_NS), clock_type=ClockType.ROS_TIME)


class TopicInfo(msgspec.Struct, kw_only=True, eq=False):
    """One topic of a bag.

    Attributes:
        name: Its full name.
        type: The ROS name of its type, such as ``std_msgs/msg/String``.
        type_hash: The RIHS01 hash of the type; empty if the bag has none.
        qos: The profiles that its publishers offered.
        message_count: How many of its messages the bag has.
        serialization_format: How messages are encoded: ``cdr``.
        encoding: The format of `definition`: ``ros2msg``, ``ros2idl``, or empty without one.
        definition: The text of the type, with all types that it uses.
        problem: What of the topic could not be read, so that it is missing here; empty if nothing.
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
        """The class of its messages: aionode's, or one made of the definition in the bag.

        Raises:
            InterfaceNotFoundError: neither aionode nor the bag has a definition of the type.
        """
        if self._class is None:
            from aionode.bag.files.types import class_of  # bags are often copied without decoding

            self._class = class_of(self.type, self.type_hash, self.encoding, self.definition)
        return self._class

    @property
    def key(self) -> tuple[str, str, str]:
        """The identity of a topic: its name, and its type with the hash."""
        return (self.name, self.type, self.type_hash)


class Record:
    """One message of a bag.

    Attributes:
        info: Its topic.
        time_ns: When it was received, in nanoseconds since 1970.
        publish_time_ns: When it was published; the same as `time_ns` if the bag does not tell.
        sequence: Its number, given by its publisher; 0 if the bag does not tell.
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
        """When it was received."""
        return time_of(self.time_ns)

    @property
    def publish_time(self) -> Time:
        """When it was published; the same as `time` if the bag does not tell."""
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
