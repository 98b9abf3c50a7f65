"""Programs import this as `rosbag2_py`: readers and writers of bags, over `aionode.bag`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final, Self

import msgspec

from aionode import bag
from aionode.bag.files.types import definition_of
from aionode.clock import Time as PlainTime
from aionode.engine.wire.typehash import type_hash
from aionode.errors import AionodeError, BagError, InterfaceNotFoundError
from aionode.interfaces import get_interface
from aionode.qos import QoSProfile
from rclpy.duration import Duration
from rclpy.time import Time
from rosbag2_py._live import (
    MessageOrder,
    Player,
    PlayOptions,
    Recorder,
    RecordOptions,
    ServiceRequestsSource,
)
from rosbag2_py._rewrite import Reindexer, bag_rewrite

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "FileInformation",
    "Info",
    "LocalMessageDefinitionSource",
    "MessageDefinition",
    "MessageOrder",
    "PlayOptions",
    "Player",
    "ReadOrder",
    "ReadOrderSortBy",
    "RecordOptions",
    "Recorder",
    "Reindexer",
    "SequentialCompressionReader",
    "SequentialReader",
    "SequentialWriter",
    "ServiceRequestsSource",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
    "bag_rewrite",
    "get_default_storage_id",
    "get_registered_compressors",
    "get_registered_readers",
    "get_registered_serializers",
    "get_registered_writers",
]

DEFAULT_STORAGE: Final = "mcap"


# Value classes, with rosbag2's names


class StorageOptions(msgspec.Struct):
    """The place of a bag, and its format."""

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = {}


class ConverterOptions(msgspec.Struct):
    """The formats of messages: CDR is the only one."""

    input_serialization_format: str = "cdr"
    output_serialization_format: str = "cdr"


class StorageFilter(msgspec.Struct):
    """The topics to read; all if none are given."""

    topics: list[str] = []
    services_events: list[str] = []
    actions_interfaces: list[str] = []
    regex: str = ""
    exclude_topics: list[str] = []
    exclude_service_events: list[str] = []
    exclude_actions_interfaces: list[str] = []
    regex_to_exclude: str = ""

    def admits(self, topic: str) -> bool:
        """Whether a topic is read."""
        if topic in (*self.exclude_topics, *self.exclude_service_events):
            return False
        if topic in self.exclude_actions_interfaces:
            return False
        if self.regex_to_exclude and re.search(self.regex_to_exclude, topic):
            return False
        wanted = (*self.topics, *self.services_events, *self.actions_interfaces)
        if topic in wanted or (self.regex and re.search(self.regex, topic)):
            return True
        return not (wanted or self.regex)


class ReadOrderSortBy:
    """The key by which messages are sorted."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


class ReadOrder(msgspec.Struct):
    """The order in which messages are read."""

    sort_by: int = ReadOrderSortBy.ReceivedTimestamp
    reverse: bool = False


class MessageDefinition(msgspec.Struct):
    """The definition of a type, as stored in bags."""

    topic_type: str = ""
    encoding: str = ""
    encoded_message_definition: str = ""
    type_hash: str = ""


class TopicMetadata:
    """One topic of a bag.

    Before Jazzy there was no `id`: with the name in its place, the other arguments move up.
    """

    def __init__(
        self,
        id: int | str = 0,  # noqa: A002  # rosbag2's name
        name: str = "",
        type: str = "",  # noqa: A002  # as above
        serialization_format: str = "cdr",
        offered_qos_profiles: Any = (),
        type_description_hash: str = "",
    ) -> None:
        if isinstance(id, str):
            serialization_format, type, name, id = type or "cdr", name, id, 0  # noqa: A001  # as above
        self.id: int = id
        self.name = name
        self.type = type
        self.serialization_format = serialization_format
        self.offered_qos_profiles = list(offered_qos_profiles)
        self.type_description_hash = type_description_hash

    def __repr__(self) -> str:
        return f"TopicMetadata(id={self.id}, name={self.name!r}, type={self.type!r})"

    def equals(self, other: TopicMetadata) -> bool:
        """Whether two topics have the same name, type and format."""
        return all(
            getattr(self, name) == getattr(other, name)
            for name in ("name", "type", "serialization_format")
        )

    def __eq__(self, other: object) -> bool:
        """Whether `other` is an equal topic."""
        return isinstance(other, TopicMetadata) and self.equals(other)

    __hash__ = None  # type: ignore[assignment]  # as rosbag2's


class TopicInformation(msgspec.Struct):
    """One topic of a bag, with the number of its messages."""

    topic_metadata: TopicMetadata
    message_count: int = 0


class FileInformation(msgspec.Struct):
    """One file of a bag."""

    path: str
    starting_time: Time
    duration: Duration
    message_count: int


class BagMetadata(msgspec.Struct):
    """A bag as described by ``metadata.yaml``."""

    version: int = 9
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = []
    files: list[FileInformation] = []
    duration: Any = None
    starting_time: Any = None
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = []
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = {}
    ros_distro: str = ""


# Reading


class SequentialReader:
    """Reads the messages of a bag, one after the other."""

    def __init__(self) -> None:
        self._bag: bag.Bag | None = None
        self._filter = StorageFilter()
        self._order = ReadOrder()
        self._from_ns = 0
        self._records: Any = None
        self._next: bag.Record | None = None

    def open_uri(self, uri: str) -> None:
        """Open a bag; see `open`."""
        self.open(StorageOptions(uri=uri), ConverterOptions())

    def open(
        self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None
    ) -> None:
        """Open a bag.

        Raises:
            RuntimeError: it is not a bag, it is damaged, or another format is requested.
        """
        wanted = (converter_options or ConverterOptions()).output_serialization_format
        if wanted not in {"", "cdr"}:
            raise RuntimeError(
                f"rosbag2_py: no converter to {wanted!r}; messages are only available as cdr"
            )
        try:
            self._bag = bag.open(storage_options.uri)
        except (AionodeError, OSError) as error:
            raise RuntimeError(
                f"No storage could be initialized from the inputs. {error}"
            ) from error
        self._uri = storage_options.uri
        self._from_ns = max(storage_options.start_time_ns, 0)
        self._end_ns = storage_options.end_time_ns
        self._restart()

    def close(self) -> None:
        """Close the bag."""
        if self._bag is not None:
            self._bag.close()
            self._bag = self._records = self._next = None

    def __del__(self) -> None:
        self.close()

    def _opened(self) -> bag.Bag:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._bag

    def _restart(self) -> None:
        topics = [name for name in self._opened().topics if self._filter.admits(name)]
        end = None if self._end_ns < 0 else PlainTime(nanoseconds=self._end_ns + 1)
        start = PlainTime(nanoseconds=self._from_ns)
        # In reverse, time is sought from the end: later messages are left out.
        if self._order.reverse and self._from_ns:
            start, end = PlainTime(nanoseconds=0), PlainTime(nanoseconds=self._from_ns + 1)
        records: Any = self._opened().read(topics=topics, start=start, end=end)
        if self._order.sort_by == ReadOrderSortBy.PublishedTimestamp:
            records = sorted(records, key=lambda record: record.publish_time_ns)
        if self._order.reverse:
            records = reversed(list(records))
        self._records = iter(records)
        self._advance()

    def _advance(self) -> None:
        try:
            self._next = next(self._records, None)
        except BagError as error:
            raise RuntimeError(str(error)) from error

    def has_next(self) -> bool:
        """Whether there is another message."""
        self._opened()
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """Return the topic, the CDR bytes and the time of the next message, in nanoseconds.

        Raises:
            RuntimeError: there is none.
        """
        self._opened()
        record = self._next
        if record is None:
            raise RuntimeError("Bag is at end. No next message.")
        self._advance()
        return record.topic, bytes(record.raw), record.time_ns

    def seek(self, timestamp: int) -> None:
        """Continue with the first message at or after a time in nanoseconds."""
        self._from_ns = int(timestamp)
        self._restart()

    def set_read_order(self, order: ReadOrder) -> bool:
        """Set the order of reading; return whether that is possible, which it always is."""
        self._order = order
        self._restart()
        return True

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Read only some topics from now on."""
        position, self._filter = self._next, storage_filter
        if position is not None:
            self._from_ns = position.time_ns
        self._restart()

    def reset_filter(self) -> None:
        """Read all topics from now on."""
        self.set_filter(StorageFilter())

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        """Return the topics."""
        return [topic.topic_metadata for topic in topics_of(self._opened())]

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        """Return the definitions of all types."""
        infos = {info.type: info for info in self._opened().topics.values()}
        return [
            MessageDefinition(info.type, info.encoding, info.definition, info.type_hash)
            for info in infos.values()
        ]

    def get_metadata(self) -> BagMetadata:
        """Return the contents of the bag's ``metadata.yaml``."""
        return metadata_of(self._opened())

    def has_next_file(self) -> bool:
        """Whether there is another file: never, since all are read as one."""
        return False


SequentialCompressionReader = SequentialReader
"""The same class reads compressed bags."""


def topics_of(opened: bag.Bag) -> list[TopicInformation]:
    """Return the topics of a bag, with their counts."""
    return [
        TopicInformation(
            TopicMetadata(
                number,
                info.name,
                info.type,
                info.serialization_format,
                info.qos,
                info.type_hash,
            ),
            info.message_count,
        )
        for number, info in enumerate(opened.topics.values())
    ]


def metadata_of(opened: bag.Bag) -> BagMetadata:
    """Return the metadata of a bag."""
    path, known = opened.path, opened.metadata
    files = (
        [file for file in sorted(path.rglob("*")) if file.is_file()] if path.is_dir() else [path]
    )
    return BagMetadata(
        version=int(known.get("version", 9)),
        bag_size=sum(file.stat().st_size for file in files),
        storage_identifier=str(known.get("storage_identifier") or storage_of(files)),
        relative_file_paths=list(known.get("relative_file_paths") or [path.name]),
        files=[
            FileInformation(
                file["path"],
                Time(nanoseconds=file["starting_time"]["nanoseconds_since_epoch"]),
                Duration(nanoseconds=file["duration"]["nanoseconds"]),
                file["message_count"],
            )
            for file in known.get("files") or ()
        ],
        duration=Duration(nanoseconds=opened.duration.nanoseconds),
        starting_time=Time(nanoseconds=opened.start_ns),
        message_count=opened.message_count,
        topics_with_message_count=topics_of(opened),
        compression_format=str(known.get("compression_format") or ""),
        compression_mode=str(known.get("compression_mode") or ""),
        custom_data=dict(opened.custom_data),
        ros_distro=str(known.get("ros_distro") or ""),
    )


def storage_of(files: list[Path]) -> str:
    """Return the format of files without metadata, by their names."""
    return "sqlite3" if any(".db3" in file.name for file in files) else DEFAULT_STORAGE


class Info:
    """Reads the metadata of a bag."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:  # taken from the files
        """Return the contents of a bag's ``metadata.yaml``.

        Raises:
            RuntimeError: it is not a bag, or it is damaged.
        """
        reader = SequentialReader()
        reader.open_uri(uri)
        try:
            return reader.get_metadata()
        finally:
            reader.close()


# Writing


class SequentialWriter:
    """Writes a bag, in MCAP."""

    def __init__(self) -> None:
        self._writer: bag.BagWriter | None = None
        self._numbers: dict[str, int] = {}

    def open(
        self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None
    ) -> None:
        """Create a bag in a folder that does not exist yet.

        Raises:
            RuntimeError: the folder exists, or a format other than MCAP or CDR is requested.
        """
        wanted = (converter_options or ConverterOptions()).output_serialization_format
        if wanted not in {"", "cdr"}:
            raise RuntimeError(
                f"rosbag2_py: no converter to {wanted!r}; messages are only available as cdr"
            )
        if storage_options.storage_id not in {"", DEFAULT_STORAGE}:
            raise RuntimeError(
                "No storage could be initialized from the inputs. aionode writes mcap, not "
                f"{storage_options.storage_id}; omit storage_id, or use 'mcap'"
            )
        try:
            self._writer = bag.BagWriter(
                storage_options.uri,
                max_bytes=storage_options.max_bagfile_size,
                max_duration_ns=storage_options.max_bagfile_duration * 10**9,
                custom_data=storage_options.custom_data,
            )
        except (AionodeError, OSError) as error:
            raise RuntimeError(str(error)) from error

    def close(self) -> None:
        """Finish the bag."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None

    def __del__(self) -> None:
        self.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _opened(self) -> bag.BagWriter:
        if self._writer is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._writer

    def create_topic(
        self, topic: TopicMetadata, message_definition: MessageDefinition | None = None
    ) -> None:
        """Add a topic; adding it again has no effect.

        Args:
            topic: Its name and type.
            message_definition: The definition of its type, if this program does not know it.
        """
        writer = self._opened()
        definition = message_definition or definition_by_name(topic.type)
        profiles = tuple(topic.offered_qos_profiles) or (QoSProfile(depth=10),)
        self._numbers[topic.name] = writer.add_topic(
            bag.TopicInfo(
                name=topic.name,
                type=topic.type,
                type_hash=topic.type_description_hash or definition.type_hash,
                encoding=definition.encoding,
                definition=definition.encoded_message_definition,
                qos=profiles,
            )
        )

    def remove_topic(self, topic: TopicMetadata) -> None:
        """Accept no further messages of a topic."""
        self._numbers.pop(topic.name, None)

    def write(
        self,
        topic_name: str,
        message: bytes,
        time_stamp: int,
        send_timestamp: int | None = None,
        sequence_number: int = 0,
    ) -> None:
        """Add a message.

        Args:
            topic_name: A topic that was created.
            message: Its CDR bytes.
            time_stamp: When it was received, in nanoseconds.
            send_timestamp: When it was sent; `time_stamp` if not given.
            sequence_number: Its number.

        Raises:
            RuntimeError: the topic was not created.
            BagWriteError: the disk is full, or fails (an OSError).
        """
        writer = self._opened()
        number = self._numbers.get(topic_name)
        if number is None:
            raise RuntimeError(
                f"Tried to write on topic '{topic_name}' before creating it; call create_topic()"
            )
        writer.write(
            number,
            int(time_stamp),
            bytes(message),
            publish_time_ns=send_timestamp,
            sequence=sequence_number,
        )

    def take_snapshot(self) -> bool:
        """Return whether a snapshot was written: never, since there is no snapshot mode here."""
        return False

    def split_bagfile(self) -> None:
        """Continue in a new file."""
        self._opened().split(0)


class LocalMessageDefinitionSource:
    """The definitions of the types that are found here."""

    def get_full_text(self, root_topic_type: str) -> MessageDefinition:
        """Return the definition of a type; one that is not found has the encoding ``unknown``."""
        found = definition_by_name(root_topic_type)
        if not found.encoding:
            found.encoding = "unknown"
        return found


def definition_by_name(typename: str) -> MessageDefinition:
    """Return the definition of a type by its name; without text if it is unknown."""
    try:
        cls = get_interface(typename)
    except InterfaceNotFoundError:
        return MessageDefinition(topic_type=typename)
    return MessageDefinition(typename, "ros2msg", definition_of(cls), type_hash(cls))


# Listings


def get_registered_readers() -> set[str]:
    """Return the formats that can be read."""
    return {"mcap", "sqlite3"}


def get_registered_writers() -> set[str]:
    """Return the formats that can be written."""
    return {DEFAULT_STORAGE}


def get_registered_compressors() -> set[str]:
    """Return the compressions of whole files that can be written: none."""
    return set()


def get_registered_serializers() -> set[str]:
    """Return the formats of messages."""
    return {"cdr"}


def get_default_storage_id() -> str:
    """Return the format that is written."""
    return DEFAULT_STORAGE
