"""Repairs bags: files that were not closed, and metadata that are missing."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, Final, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, MessageIndex, MetadataIndex, Schema
from mcap.records import Metadata as MetadataRecord

from aionode.bag._bag import merged_topics, source_of
from aionode.bag._chunks import HEAD, MESSAGE, checked_content
from aionode.bag._mcap_writer import MAGIC, McapWriter, Span, index_record
from aionode.bag._metadata import FILE_NAME, metadata_of, read_metadata, write_metadata
from aionode.bag._source import DAMAGE
from aionode.errors import BagError

if TYPE_CHECKING:
    from os import PathLike

__all__ = ["Checked", "check", "reindex"]

FIRST: Final = len(MAGIC) + HEAD.size
LONGEST_HEADER: Final = 64
"""The first record of a file is the header, which is shorter than this, in bytes."""

END: Final = frozenset({Opcode.DATA_END, Opcode.FOOTER})


class Checked(NamedTuple):
    """The findings in one file.

    Attributes:
        file: Its name.
        repaired: Whether it was damaged, and can be read now.
        messages: How many messages it has.
        removed_bytes: How many bytes at its end could not be used.
    """

    file: str
    repaired: bool
    messages: int
    removed_bytes: int


def check(path: str | PathLike[str]) -> list[Checked]:
    """Check a bag, and repair what a power cut left: files without an end, missing metadata.

    A damaged MCAP file is cut after its last complete chunk, and gets a new summary. Other files
    stay as they are.

    Args:
        path: A folder, or a single file.

    Raises:
        BagError: a file cannot be repaired.
        FileNotFoundError: there is nothing of this name.
        OSError: a file cannot be read or written.
    """
    place = Path(path)
    if not place.exists():
        raise FileNotFoundError(f"bag {path}: there is no such file or folder")
    if not place.is_dir():
        return [check_file(place)]
    checked = [check_file(file) for file in files_of(place)]
    for left in (".reserve", f".{FILE_NAME}"):
        (place / left).unlink(missing_ok=True)
    if not is_indexed(place, checked):
        reindex(place)
    return checked


def is_indexed(folder: Path, checked: list[Checked]) -> bool:
    """Return whether the metadata fit the files."""
    try:
        metadata = read_metadata(folder)
        names = {Path(name).name for name in metadata["relative_file_paths"]}
        count = int(metadata["message_count"])
    except (BagError, KeyError, TypeError, ValueError):
        return False
    return names == {file.file for file in checked} and count == sum(
        file.messages for file in checked
    )


def files_of(folder: Path) -> list[Path]:
    """Return the files of a bag in the order of their numbers."""
    files = [*folder.glob("*.mcap"), *folder.glob("*.db3"), *folder.glob("*.zstd")]
    if not files:
        raise BagError(str(folder), "there is no .mcap or .db3 file in the folder")

    def number(file: Path) -> tuple[int, str]:
        digits = file.name.split(".")[0].rpartition("_")[2]
        return (int(digits) if digits.isdigit() else -1, file.name)

    return sorted(files, key=number)


def check_file(file: Path) -> Checked:
    """Check one file, and repair it if it is a damaged MCAP file."""
    size = file.stat().st_size
    try:
        source = source_of(file)
    except BagError:
        if file.suffix != ".mcap":
            raise
        return repaired(file, size)
    count = sum(topic.message_count for topic in source.topics)
    source.close()
    return Checked(file.name, repaired=False, messages=count, removed_bytes=0)


def repaired(file: Path, size: int) -> Checked:
    """Cut a file after its last complete chunk, and write a new summary."""
    if has_hardly_begun(file):
        file.unlink()
        McapWriter(file).close()
        return Checked(file.name, repaired=True, messages=0, removed_bytes=size)
    with file.open("rb") as stream:
        scan = Scan(file, stream, size)
    writer = McapWriter.resume(file, scan)
    writer.close()
    return Checked(file.name, repaired=True, messages=scan.messages, removed_bytes=size - scan.end)


def has_hardly_begun(file: Path) -> bool:
    """Return whether a file ends, or goes on with zeros, before its first record is complete."""
    with file.open("rb") as stream:
        begin = stream.read(LONGEST_HEADER).rstrip(b"\0")
        if not MAGIC.startswith(begin[: len(MAGIC)]):
            return False
        if len(begin) >= FIRST and len(begin) >= FIRST + HEAD.unpack_from(begin, len(MAGIC))[1]:
            return False
        return not any(part.strip(b"\0") for part in iter(lambda: stream.read(1 << 20), b""))


class Scan:
    """The records of a file that can be used.

    Attributes:
        end: Where they end.
        spans: Its chunks.
        schemas: Its schemas by number.
        channels: Its channels by number.
        metadata: Its metadata records.
        rest: The index of the last chunk, if that was cut off.

    Raises:
        BagError: it is no MCAP file, or one without chunks.
    """

    def __init__(self, file: Path, stream: BinaryIO, size: int) -> None:
        self.end = len(MAGIC)
        self.spans: list[Span] = []
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.metadata: list[MetadataIndex] = []
        self.rest = b""
        self._entries: dict[int, list[int]] = {}
        self._offsets: dict[int, int] = {}
        self._chunk: ChunkIndex | None = None
        if stream.read(len(MAGIC)) != MAGIC:
            raise BagError(str(file), "it does not begin as an MCAP file, so nothing can be saved")
        while (head := stream.read(HEAD.size)) and len(head) == HEAD.size:
            opcode, length = HEAD.unpack(head)
            if opcode in END or not 0 < opcode <= Opcode.DATA_END:
                break
            if self.end + HEAD.size + length > size:
                break
            if opcode == Opcode.MESSAGE:
                problem = "its messages are not in chunks, so they have no index to repair"
                raise BagError(str(file), problem, "`mcap recover` can rewrite it")
            try:
                self._take(opcode, stream.read(length))
            except (*DAMAGE, ValueError):
                break
            self.end += HEAD.size + length
        self._finish_chunk()
        if self.end == len(MAGIC):
            raise BagError(str(file), "it has no complete record, so nothing can be saved")

    @property
    def messages(self) -> int:
        """The number of messages in the chunks."""
        return sum(sum(span.counts.values()) for span in self.spans)

    def _take(self, opcode: int, data: bytes) -> None:
        """Take one record; it raises one of `DAMAGE` if that is none."""
        fields = ReadDataStream(BytesIO(data))
        if opcode == Opcode.MESSAGE_INDEX and self._chunk is not None:
            index = MessageIndex.read(fields)
            flat = [value for entry in index.records for value in entry]
            if self._entries.get(index.channel_id) != flat:
                raise McapError("the index is not that of the chunk")
            self._offsets[index.channel_id] = self.end
            return
        self._finish_chunk()
        if opcode == Opcode.CHUNK:
            self._take_chunk(Chunk.read(fields), HEAD.size + len(data))
        elif opcode == Opcode.SCHEMA:
            schema = Schema.read(fields)
            self.schemas[schema.id] = schema
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(fields)
            self.channels[channel.id] = channel
        elif opcode == Opcode.METADATA:
            record = MetadataRecord.read(fields)
            if b"\0\0\0\0\0\0\0\0" in data[8:]:  # it has no checksum
                raise McapError("zeros in a text")
            self.metadata.append(MetadataIndex(self.end, HEAD.size + len(data), record.name))

    def _take_chunk(self, chunk: Chunk, length: int) -> None:
        """Take a chunk that is whole."""
        content = checked_content(chunk)
        entries: dict[int, list[int]] = {}
        schemas, channels = dict(self.schemas), dict(self.channels)
        at = 0
        while at < len(content):
            opcode, size = HEAD.unpack_from(content, at)
            body = at + HEAD.size
            if opcode == Opcode.MESSAGE:
                channel, _, log_ns, _ = MESSAGE.unpack_from(content, body)
                entries.setdefault(channel, []).extend((log_ns, at))
            else:
                fields = ReadDataStream(BytesIO(content[body : body + size]))
                if opcode == Opcode.SCHEMA:
                    schema = Schema.read(fields)
                    schemas[schema.id] = schema
                elif opcode == Opcode.CHANNEL:
                    known = Channel.read(fields)
                    channels[known.id] = known
            at = body + size
        self.schemas, self.channels = schemas, channels
        self._entries, self._offsets = entries, {}
        self._chunk = ChunkIndex(
            chunk_length=length,
            chunk_start_offset=self.end,
            compression=chunk.compression,
            compressed_size=len(chunk.data),
            message_end_time=chunk.message_end_time,
            message_index_length=0,
            message_index_offsets=self._offsets,
            message_start_time=chunk.message_start_time,
            uncompressed_size=chunk.uncompressed_size,
        )

    def _finish_chunk(self) -> None:
        """Note the last chunk with its index, of which the end may be missing."""
        index, self._chunk = self._chunk, None
        if index is None:
            return
        chunk_end = index.chunk_start_offset + index.chunk_length
        if self._offsets.keys() != self._entries.keys():
            records = [index_record(*entry) for entry in self._entries.items()]
            at = chunk_end
            for channel, record in zip(self._entries, records, strict=True):
                self._offsets[channel] = at
                at += len(record)
            self.rest = b"".join(records)
            self.end = chunk_end
            index.message_index_length = len(self.rest)
        else:
            index.message_index_length = self.end - chunk_end
        counts = {channel: len(entries) // 2 for channel, entries in self._entries.items()}
        self.spans.append(Span(index, counts))


def reindex(path: str | PathLike[str]) -> None:
    """Write the ``metadata.yaml`` of a bag anew, from its files.

    What only the old one has is lost: custom data.

    Args:
        path: The folder.

    Raises:
        BagError: there are no files, or one is damaged: `check` repairs it.
        OSError: a file cannot be read, or the metadata cannot be written.
    """
    folder = Path(path)
    if not folder.is_dir():
        raise BagError(str(path), "only a folder has metadata", "give the folder of the bag")
    sources = []
    parts = []
    try:
        for file in files_of(folder):
            source = source_of(file)
            sources.append(source)
            count = sum(topic.message_count for topic in source.topics)
            parts.append((file.name, source.start_ns, source.end_ns, count))
        storage = "mcap" if ".mcap" in parts[0][0] else "sqlite3"
        topics = merged_topics(sources, [])
        metadata = metadata_of(topics, parts, custom_data={}, ros_distro="", storage=storage)
        if parts[0][0].endswith(".zstd"):
            metadata |= {"compression_format": "zstd", "compression_mode": "FILE"}
        write_metadata(folder, metadata)
    finally:
        for source in sources:
            source.close()
