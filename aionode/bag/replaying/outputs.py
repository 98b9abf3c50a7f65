"""The messages that nodes published while a recording was replayed to them."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any, Final, Self

from aionode.bag._writer import BagWriter, topic_info
from aionode.bag.files.record import Record, TopicInfo
from aionode.errors import BagError
from aionode.graph import EndpointKind
from aionode.interfaces import get_interface
from aionode.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from os import PathLike

    from aionode.clock import TimeBase
    from aionode.engine.bare_node import BareNode
    from aionode.errors import DecodeError
    from aionode.graph import EndpointInfo

__all__ = ["Outputs", "Tap"]

LATCHED_DEPTH: Final = 1000
"""Maximum number of latched messages from before the run to take."""


class Outputs:
    """The messages that nodes published in a run, in order.

    Attributes:
        records: The messages, with the time at which each was published.
    """

    def __init__(self, records: Iterable[Record] = ()) -> None:
        self.records = list(records)

    def __repr__(self) -> str:
        topics = {record.topic for record in self.records}
        return f"<Outputs: {len(self.records)} messages of {len(topics)} topics>"

    def __len__(self) -> int:
        return len(self.records)

    def digest(self) -> str:
        """Return the SHA-256 of all messages, by topic, time and CDR bytes, in hexadecimal."""
        total = hashlib.sha256()
        for record in self.records:
            topic = record.topic.encode()
            total.update(len(topic).to_bytes(4, "little") + topic)
            total.update(record.time_ns.to_bytes(8, "little", signed=True))
            total.update(len(record.raw).to_bytes(8, "little"))
            total.update(record.raw)
        return total.hexdigest()

    def save(self, path: str | PathLike[str]) -> None:
        """Write the messages as a bag, for example to compare with later.

        Raises:
            BagError: the folder already exists (a ValueError).
            BagWriteError: the disk is full or fails (an OSError).
        """
        with BagWriter(path) as writer:
            for record in self.records:
                writer.write_record(record)


class Tap:
    """Collects what is published on some topics, within the call that publishes it.

    Unlike a subscription with a callback, it drops nothing and wakes nothing.

    Args:
        node: The node that listens.
        topics: Their full names.

    Attributes:
        outputs: What was collected.
    """

    def __init__(self, node: BareNode, topics: Iterable[str]) -> None:
        self.outputs = Outputs()
        self._graph = node.context.graph
        self._node = node
        self._missing = dict.fromkeys(topics)
        self._closes: list[Callable[[], None]] = []

    def __enter__(self) -> Self:
        for topic in list(self._missing):
            self._closes.append(self._graph.watch(EndpointKind.PUBLISHER, topic, self._note))
        return self

    def __exit__(self, *_: object) -> None:
        for close in self._closes:
            close()

    def check(self, subject: str) -> None:
        """Reject outputs if a requested topic was not published.

        Raises:
            BagError: no node publishes it (a ValueError).
        """
        if self._missing:
            publishers = self._graph.endpoints(EndpointKind.PUBLISHER)
            others = sorted(
                {publisher.name for publisher in publishers if publisher.node != self._node.info}
            )
            raise BagError(
                subject,
                f"no node of the run publishes {', '.join(self._missing)}",
                f"published are {', '.join(others) or 'no topics'}",
            )

    def _note(self, publisher: EndpointInfo, present: bool) -> None:  # as `Graph.watch` calls it
        """Listen to a topic from its first publisher on, starting with its latched messages."""
        is_own = publisher.node == self._node.info
        if is_own or not present or publisher.name not in self._missing:
            return
        del self._missing[publisher.name]
        msg_type = get_interface(publisher.type_name)
        qos = QoSProfile(
            depth=LATCHED_DEPTH,
            reliability=ReliabilityPolicy.BEST_EFFORT,
            durability=publisher.qos.durability,
        )
        info = topic_info(publisher.name, msg_type, (publisher.qos,))
        reader = TapReader(info, self.outputs.records, self._node.context.time_base)
        tap = self._node.create_subscription(msg_type, publisher.name, qos, reader)
        self._closes.append(tap.destroy)


class TapReader:
    """Collects the messages of one topic from a transport; see `aionode.transport.base.Reader`."""

    raw = True
    waiting = 0

    endpoint: EndpointInfo

    def __init__(self, info: TopicInfo, records: list[Record], time_base: TimeBase) -> None:
        self._info = info
        self._records = records
        self._now_ns = time_base.system_ns

    def deliver(  # as in `Reader`
        self,
        msg: Any,
        gid: bytes,  # noqa: ARG002
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,  # noqa: ARG002
        arrived_ns: int = 0,  # noqa: ARG002
    ) -> None:
        self._records.append(Record(self._info, self._now_ns(), source_ns, sequence, bytes(msg)))

    def note_alive(self, gid: bytes) -> None:
        """Ignore signs of life."""

    def reject(self, error: DecodeError) -> None:
        """Do nothing: within a process, nothing is decoded."""

    def has_room(self) -> bool:
        """Return True: it accepts everything."""
        return True

    async def wait_for_room(self) -> None:
        """Return immediately: it accepts everything."""

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call `callback` right away: there is always room."""
        callback()
