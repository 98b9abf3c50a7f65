"""Writes a bag: a folder of MCAP files and their metadata, as rosbag2 does."""

from __future__ import annotations

import contextlib
import os
from collections import deque
from copy import copy
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

from aionode._distribution import choose_distribution
from aionode.bag.files.lock import FolderLock
from aionode.bag.files.mcap_writer import COMPRESSIONS, McapWriter, write_error
from aionode.bag.files.metadata import (
    FILE_NAME,
    FilePart,
    metadata_of,
    metadata_text,
    sync_folder,
    write_metadata,
)
from aionode.bag.files.qos import profiles_to_yaml
from aionode.bag.files.record import TopicInfo
from aionode.bag.files.types import definition_of
from aionode.engine.wire import cdr
from aionode.engine.wire.typehash import type_hash
from aionode.errors import BagError, BagWriteError
from aionode.message import type_name
from aionode.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from os import PathLike
    from types import TracebackType

    from aionode.bag.files.mcap_writer import Parts
    from aionode.bag.files.record import Record
    from aionode.clock import Time

__all__ = ["BagWriter", "topic_info"]

RESERVE: Final = ".reserve"
RESERVE_BYTES: Final = 64 << 10
"""Space reserved for the summary and the metadata of a bag, in case the disk fills up."""

DEFAULT_QOS: Final = QoSProfile(depth=10)


def topic_info(
    name: str,
    msg_type: Any,
    qos: Iterable[QoSProfile] = (DEFAULT_QOS,),
) -> TopicInfo:
    """Return the entry of a topic whose message class is known."""
    return TopicInfo(
        name=name,
        type=type_name(msg_type),
        type_hash=type_hash(msg_type),
        qos=tuple(qos),
        encoding="ros2msg",
        definition=definition_of(msg_type),
        _class=msg_type,
    )


class BagWriter:
    """A bag that is open for writing; ``with`` closes it.

    Calls may block on the disk: programs with an event loop use a `Recorder` or a thread.

    Args:
        path: The folder, which must not exist.
        compression: ``zstd``, ``zstd_small`` (slow), ``lz4`` or ``none``.
        max_bytes: The size at which to start a new file; 0 for a single file.
        max_duration_ns: The duration after which to start a new file, in nanoseconds; 0 for one
            file.
        max_messages: Maximum number of messages per file; 0 for no limit.
        max_files: Number of files to keep, removing older ones; 0 for all.
        custom_data: Additional metadata.
        on_split: Called with the names of the closed file and the new one.

    Attributes:
        path: The folder.
        topics: The topics, with counts.

    Raises:
        BagError: the folder exists, or the compression is unknown.
        OSError: it cannot be created.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        *,
        compression: str = "zstd",
        max_bytes: int = 0,
        max_duration_ns: int = 0,
        max_messages: int = 0,
        max_files: int = 0,
        custom_data: Mapping[str, str] | None = None,
        on_split: Callable[[str, str], None] | None = None,
    ) -> None:
        if compression not in COMPRESSIONS:
            choices = ", ".join(COMPRESSIONS)
            raise BagError(str(path), f"no compression {compression!r}", f"use one of {choices}")
        self.path = Path(path)
        self.topics: list[TopicInfo] = []
        self.custom_data = dict(custom_data or {})
        self._compression = compression
        self._limits = (max_bytes, max_duration_ns, max_messages)
        self._has_limits = any(self._limits)
        self._max_files = max_files
        self._on_split = on_split
        self._closed: list[tuple[FilePart, dict[int, int]]] = []
        self._channels: dict[int, int] = {}
        self._numbers: dict[tuple[str, str, str], int] = {}
        self._latched: dict[int, deque[tuple[int, int, Parts]]] = {}  # id, time, bytes
        self._file_number = 0
        self._is_open = True
        try:
            self.path.mkdir(parents=True)
        except FileExistsError as error:
            raise BagError(
                str(path), "this output folder already exists", "give another name, or remove it"
            ) from error
        except OSError as error:
            raise BagWriteError(str(path), error.strerror or str(error)) from error
        self._lock = FolderLock(self.path)
        try:
            sync_folder(self.path.parent)
            (self.path / RESERVE).write_bytes(b"#" * RESERVE_BYTES)
            self._file = self._new_file()
            self.write_metadata()
        except BagWriteError:
            raise
        except OSError as error:
            raise BagWriteError(str(path), error.strerror or str(error)) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def message_count(self) -> int:
        """The number of messages in the bag, including those waiting to be written."""
        return sum(topic.message_count for topic in self.topics)

    @property
    def file_name(self) -> str:
        """The name of the current file."""
        return self._file.path.name

    def add_topic(self, topic: TopicInfo, *, latched_depth: int = 0) -> int:
        """Add a topic, or look up an existing one, and return its id.

        Args:
            topic: Its name and type.
            latched_depth: How many of its last messages to repeat at the start of each further
                file, as for late subscriptions.
        """
        number = self._numbers.get(topic.key)
        if number is None:
            number = self._numbers[topic.key] = len(self.topics)
            self.topics.append(copy(topic))
            self.topics[number].message_count = 0
            if latched_depth:
                self._latched[number] = deque(maxlen=latched_depth)
        return number

    def write(
        self,
        topic: int,
        time_ns: int,
        raw: Parts,
        *,
        publish_time_ns: int | None = None,
        sequence: int = 0,
    ) -> None:
        """Add a message.

        Args:
            topic: The id of its topic.
            time_ns: The receive time, in nanoseconds since 1970.
            raw: Its CDR bytes, or a list of parts, which are kept and must not change.
            publish_time_ns: The publish time; defaults to `time_ns`.
            sequence: The publisher's sequence number.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        if self._has_limits and self._is_full(time_ns):
            self.split(time_ns)
        sent_ns = time_ns if publish_time_ns is None else publish_time_ns
        latched = self._latched.get(topic) if self._latched else None
        if latched is not None:
            latched.append((sequence, sent_ns, raw))
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._open_channel(topic)
        if not self._count_in_file:
            self._file_start_ns = time_ns
        self._count_in_file += 1
        self.topics[topic].message_count += 1
        self._file.add_message(channel, sequence, time_ns, sent_ns, raw)

    def write_message(self, topic: str, message: Any, time: Time) -> None:
        """Add a message by the name and class of its topic; see `write`."""
        number = self.add_topic(topic_info(topic, type(message)))
        self.write(number, time.nanoseconds, cdr.encode(message))

    def write_record(self, record: Record) -> None:
        """Add a record of another bag; see `write`."""
        self.write(
            self.add_topic(record.info),
            record.time_ns,
            record.raw,
            publish_time_ns=record.publish_time_ns,
            sequence=record.sequence,
        )

    def flush(self) -> None:
        """Write pending messages, so that they survive if the process is killed.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        self._file.flush()

    def sync(self) -> None:
        """Write pending messages and sync them to disk, so that they survive a power cut.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        self._file.flush()
        self._file.sync()

    def split(self, time_ns: int) -> None:
        """Finish the file, and start the next one with the latched messages, at `time_ns`.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        closed = self.file_name
        self._close_file()
        self._channels.clear()
        self._file_number += 1
        self._file = self._new_file()
        self._remove_oldest()
        for number, kept in self._latched.items():
            for sequence, sent_ns, raw in kept:
                channel = self._channels.get(number) or self._open_channel(number)
                self._file.add_message(channel, sequence, time_ns, sent_ns, raw)
                self.topics[number].message_count += 1
        self.write_metadata()
        if self._on_split is not None:
            self._on_split(closed, self.file_name)

    def close(self) -> None:
        """Write pending messages, the summary and the metadata. Closing again has no effect.

        Raises:
            BagWriteError: messages were lost because the disk was full or failed; the bag is
                readable nevertheless.
        """
        if self._is_open:
            self._is_open = False
            with self._lock:
                self._finish()

    def _finish(self) -> None:
        """Write all that is missing."""
        with contextlib.suppress(OSError):
            (self.path / RESERVE).unlink()
        failure: BagWriteError | None = None
        try:
            self._close_file()
        except BagWriteError as error:
            failure = error
        removed = self._removed_file()
        failure = failure or removed
        self._count_again()
        try:
            self.write_metadata()
        except OSError as error:
            failure = failure or write_error(self.path / FILE_NAME, error)
        if failure is not None:
            raise failure

    def _removed_file(self) -> BagWriteError | None:
        """Subtract files that were removed from the counts; return the error for the first."""
        failure: BagWriteError | None = None
        for part, counts in self._closed:
            place = self.path / part[0]
            if sum(counts.values()) and not place.exists():
                counts.clear()
                problem = "the file was removed, and its messages are lost"
                failure = failure or BagWriteError(str(place), problem)
        return failure

    def _is_full(self, time_ns: int) -> bool:
        """Return whether a message with this time belongs in the next file."""
        max_bytes, max_duration_ns, max_messages = self._limits
        if self._count_in_file == 0:
            return False
        return bool(
            (max_bytes and self._file.size >= max_bytes)
            or (max_messages and self._count_in_file >= max_messages)
            or (max_duration_ns and time_ns - self._file_start_ns >= max_duration_ns)
        )

    def _open_channel(self, number: int) -> int:
        """Add a topic to the current file."""
        topic = self.topics[number]
        metadata = {"offered_qos_profiles": profiles_to_yaml(topic.qos)}
        if topic.type_hash:
            metadata["topic_type_hash"] = topic.type_hash
        schema = (topic.type, topic.encoding or "unknown", topic.definition)
        channel = self._file.add_channel(topic.name, topic.serialization_format, metadata, schema)
        self._channels[number] = channel
        return channel

    def _new_file(self) -> McapWriter:
        """Open the next file, with a metadata record that describes the bag."""
        name = f"{self.path.name}_{self._file_number}.mcap"
        self._count_in_file = 0
        self._file_start_ns = 0
        return McapWriter(self.path / name, compression=self._compression)

    def _close_file(self) -> None:
        """Close the current file, and record what it contains."""
        file = self._file
        try:
            with contextlib.suppress(BagWriteError):  # `close` raises it again
                file.add_metadata("rosbag2", {"serialized_metadata": self._file_metadata()})
            file.close()
        finally:
            counts = {number: file.counts[channel] for number, channel in self._channels.items()}
            part = (file.path.name, file.start_ns, file.end_ns, sum(counts.values()))
            self._closed.append((part, counts))

    def _remove_oldest(self) -> None:
        """Remove files beyond the limit, and subtract them from the counts."""
        while self._max_files and len(self._closed) >= self._max_files:
            part, counts = self._closed.pop(0)
            (self.path / part[0]).unlink(missing_ok=True)
            for number, count in counts.items():
                self.topics[number].message_count -= count

    def _count_again(self) -> None:
        """Set the counts of the topics to what the files contain."""
        for number, topic in enumerate(self.topics):
            topic.message_count = sum(counts.get(number, 0) for _, counts in self._closed)

    def _file_metadata(self) -> str:
        """Return the metadata of the current file as text."""
        file = self._file
        topics = []
        for number, channel in self._channels.items():
            topics.append(copy(self.topics[number]))
            topics[-1].message_count = file.counts[channel]
        part = (file.path.name, file.start_ns, file.end_ns, file.message_count)
        return metadata_text(self._metadata(topics, [part]))

    def _metadata(self, topics: list[TopicInfo], files: list[FilePart]) -> dict[str, Any]:
        distro = choose_distribution(os.environ, None)
        return metadata_of(topics, files, custom_data=self.custom_data, ros_distro=distro)

    def write_metadata(self) -> None:
        """Write ``metadata.yaml`` in its current state.

        Raises:
            OSError: it cannot be written.
        """
        files = [part for part, _ in self._closed]
        if self._is_open:
            files.append((self.file_name, 0, 0, 0))
        write_metadata(self.path, self._metadata(self.topics, files))
