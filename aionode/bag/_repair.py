"""Repairs bags: files that were not closed, and missing metadata."""

from __future__ import annotations

import contextlib
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Final, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, MessageIndex, MetadataIndex, Schema
from mcap.records import Metadata as MetadataRecord

from aionode.bag._bag import Bag, merged_topics, source_of
from aionode.bag.files.chunks import HEAD, MESSAGE, checked_content
from aionode.bag.files.compression import TooLargeError
from aionode.bag.files.lock import FolderLock
from aionode.bag.files.losses import MISSING, missing_text
from aionode.bag.files.mcap_writer import LIBRARY, MAGIC, McapWriter, Span, index_record
from aionode.bag.files.metadata import FILE_NAME, metadata_of, read_metadata, write_metadata
from aionode.bag.files.source import CHECK, DAMAGE, McapSource, damaged
from aionode.bag.files.summary import index_of, read_summary
from aionode.clock import Clock, ClockType
from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike

    from aionode.bag.files.source import Source

__all__ = ["Checked", "check", "reindex"]

FIRST: Final = len(MAGIC) + HEAD.size
MAX_HEADER: Final = 64
"""Upper limit of the length of the header, the first record of a file, in bytes."""

UNKNOWN: Final = 0x80
"""The first opcode of the range that MCAP reserves for programs; all other readers skip it."""

QUIET_SEC: Final = 5.0
"""How long an open file of a program without our lock must be unchanged before it is repaired."""

END: Final = frozenset({Opcode.DATA_END, Opcode.FOOTER})


class Checked(NamedTuple):
    """What was found in one file.

    Attributes:
        file: Its name.
        repaired: Whether it was damaged, and is readable now.
        messages: Number of messages.
        removed_bytes: Number of bytes that were unusable, at its end or in damaged chunks.
    """

    file: str
    repaired: bool
    messages: int
    removed_bytes: int


def check(path: str | PathLike[str]) -> list[Checked]:
    """Check a bag, and repair what a power cut left: unfinished files, missing metadata.

    All messages are read. A damaged MCAP file is truncated after its last complete chunk and gets a
    new summary; earlier damaged chunks are turned into records that readers skip. Other files are
    not changed. A bag that is being recorded is refused, even while its topics are silent. From
    then on, `Bag.missing` has the messages that the metadata counted and the files no longer have.

    Args:
        path: A folder, or a single file.

    Raises:
        BagError: a file cannot be repaired; the others were checked nevertheless. Or the bag is
            being recorded, and nothing was done.
        FileNotFoundError: there is no such file or folder.
        OSError: a file cannot be read or written.
    """
    place = Path(path)
    if not place.exists():
        raise FileNotFoundError(f"bag {path}: there is no such file or folder")
    if not place.is_dir():
        return [check_file(place)]
    with FolderLock(place) as lock:
        return check_folder(place, lock)


def check_folder(place: Path, lock: FolderLock) -> list[Checked]:
    """Check the files of a folder whose lock is held, and its metadata."""
    checked: list[Checked] = []
    failures: list[BagError] = []
    for file in files_of(place):
        try:
            checked.append(check_file(file, lock))
        except BagError as error:
            failures.append(error)
    if failures:
        raise failures[0]
    for left in (".reserve", f".{FILE_NAME}"):
        (place / left).unlink(missing_ok=True)
    if not is_indexed(place, checked):
        rebuild_metadata(place)
    return checked


def is_indexed(folder: Path, checked: list[Checked]) -> bool:
    """Return whether the metadata match the files."""
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
    """Return the files of a bag, ordered by their numbers."""
    files = [*folder.glob("*.mcap"), *folder.glob("*.db3"), *folder.glob("*.zstd")]
    if not files:
        raise BagError(str(folder), "there is no .mcap or .db3 file in the folder")

    def number(file: Path) -> tuple[int, str]:
        digits = file.name.split(".")[0].rpartition("_")[2]
        return (int(digits) if digits.isdigit() else -1, file.name)

    return sorted(files, key=number)


def check_file(file: Path, lock: FolderLock | None = None) -> Checked:
    """Check one file, and repair it if it is a damaged MCAP file, under the lock of its folder."""
    try:
        return Checked(file.name, False, readable_messages(file), 0)  # a tuple
    except BagError as error:
        if file.suffix != ".mcap" or error.remedy != CHECK:
            raise
    if lock is None:
        with FolderLock(file.resolve().parent) as own:
            return check_file(file, own)  # its recorder may just have closed it
    if not is_closed(file) and (not lock.is_held or is_of_another_program(file)):
        expect_quiet(file)
    found = repaired(file, file.stat().st_size)
    readable_messages(file)
    return found


def is_closed(file: Path) -> bool:
    """Return whether a file has its end, so that its recorder is done with it."""
    with file.open("rb") as stream:
        stream.seek(max(file.stat().st_size - len(MAGIC), len(MAGIC)))
        return stream.read() == MAGIC


def is_of_another_program(file: Path) -> bool:
    """Return whether a file names a writer that does not know our lock."""
    with file.open("rb") as stream:
        begin = stream.read(MAX_HEADER)
    is_mcap = begin.startswith(MAGIC) and not has_hardly_begun(file)
    return is_mcap and LIBRARY.encode() not in begin


def expect_quiet(file: Path) -> None:
    """Raise an error for a file without a lock whose recorder may be alive."""
    now = Clock(clock_type=ClockType.SYSTEM_TIME).now().nanoseconds
    if abs(now - file.stat().st_mtime_ns) / 1e9 < QUIET_SEC:
        raise BagError(
            str(file),
            "it is not closed, and was just written to",
            f"end its recording first, or wait {QUIET_SEC:g} s if its recorder was killed",
        )


def readable_messages(file: Path) -> int:
    """Read all messages of a file, and count them.

    Raises:
        BagError: it is damaged.
    """
    source = source_of(file)
    with Bag(file, [source]) as opened:
        count = sum(1 for _ in opened.read())
        if isinstance(source, McapSource):
            source.expect_index()
        return count


def repaired(file: Path, size: int) -> Checked:
    """Truncate a file after its last complete chunk, and write a new summary."""
    if has_hardly_begun(file):
        file.unlink()
        McapWriter(file).close()
        return Checked(file.name, repaired=True, messages=0, removed_bytes=size)
    has_end = is_closed(file)
    with file.open("rb") as stream:
        scan = Scan(file, stream, size)
    for at, _ in scan.damaged:
        pass_over(file, at)
    writer = McapWriter.resume(file, scan)
    writer.close()
    removed = 0 if has_end else size - scan.end
    removed += sum(length for _, length in scan.damaged)
    return Checked(file.name, repaired=True, messages=scan.messages, removed_bytes=removed)


def pass_over(file: Path, at: int) -> None:
    """Make readers skip a record: its bytes stay, but its opcode becomes one that nobody uses."""
    with file.open("r+b") as stream:
        stream.seek(at)
        stream.write(bytes([UNKNOWN]))


def has_hardly_begun(file: Path) -> bool:
    """Return whether a file ends, or continues with zeros, before its first record is complete."""
    with file.open("rb") as stream:
        begin = stream.read(MAX_HEADER).rstrip(b"\0")
        if not MAGIC.startswith(begin[: len(MAGIC)]):
            return False
        if len(begin) >= FIRST and len(begin) >= FIRST + HEAD.unpack_from(begin, len(MAGIC))[1]:
            return False
        return not any(part.strip(b"\0") for part in iter(lambda: stream.read(1 << 20), b""))


def heads(stream: BinaryIO, at: int, size: int) -> Iterator[tuple[int, int, int]]:
    """Yield the opcode, offset and length of each record that may be complete."""
    while at <= size - HEAD.size:
        stream.seek(at)
        opcode, length = HEAD.unpack(stream.read(HEAD.size))
        is_known = 0 < opcode <= Opcode.DATA_END or opcode == UNKNOWN
        if opcode in END or not is_known or at + HEAD.size + length > size:
            return
        yield opcode, at, length
        at += HEAD.size + length


class Scan:
    """The usable records of a file.

    Attributes:
        end: Offset at which they end.
        spans: Its chunks.
        schemas: Its schemas by id.
        channels: Its channels by id.
        metadata: Its metadata records.
        rest: The index of the last chunk, if it was cut off.
        damaged: Offsets and lengths of incomplete or damaged chunks.

    Raises:
        BagError: it is not an MCAP file, has no chunks, or has a chunk that is too large to read.
    """

    def __init__(self, file: Path, stream: BinaryIO, size: int) -> None:
        self.end = len(MAGIC)
        self.spans: list[Span] = []
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.metadata: list[MetadataIndex] = []
        self.rest = b""
        self.damaged: list[tuple[int, int]] = []
        self._entries: dict[int, list[int]] = {}
        self._offsets: dict[int, int] = {}
        self._chunk: ChunkIndex | None = None
        if stream.read(len(MAGIC)) != MAGIC:
            raise BagError(
                str(file), "it does not start like an MCAP file, so nothing can be recovered"
            )
        with contextlib.suppress(*DAMAGE):  # of the summary, which may be the damaged part
            _, self.schemas, self.channels, _ = read_summary(stream)
        stream.seek(self.end)
        self._read(file, stream, size)
        self._finish_last_chunk()
        if self.end == len(MAGIC):
            raise BagError(str(file), "it has no complete record, so nothing can be recovered")

    def _read(self, file: Path, stream: BinaryIO, size: int) -> None:
        """Process the records one by one, as long as they are usable."""
        bad: list[tuple[int, int]] = []  # since the last usable record
        for opcode, at, length in heads(stream, self.end, size):
            if opcode == Opcode.MESSAGE:
                problem = "its messages are not in chunks, so they have no index to repair"
                raise BagError(str(file), problem, "`mcap recover` can rewrite it")
            try:
                self._take(opcode, at, stream.read(length))
            except TooLargeError as error:
                raise damaged(file, error, f"the chunk at byte {at}") from error
            except DAMAGE:
                if opcode == Opcode.CHUNK:
                    bad.append((at, HEAD.size + length))
                elif opcode != Opcode.MESSAGE_INDEX:
                    break
            else:
                if opcode != Opcode.MESSAGE_INDEX or not bad:
                    self.end = at + HEAD.size + length
                    self.damaged += bad
                    bad = []

    @property
    def messages(self) -> int:
        """The number of messages in the chunks."""
        return sum(sum(span.counts.values()) for span in self.spans)

    def _take(self, opcode: int, at: int, data: bytes) -> None:
        """Process the record at an offset; raise one of `DAMAGE` if it is not valid."""
        fields = ReadDataStream(BytesIO(data))
        if opcode == Opcode.MESSAGE_INDEX and self._chunk is not None:
            index = MessageIndex.read(fields)
            flat = [value for entry in index.records for value in entry]
            if self._entries.get(index.channel_id) != flat:
                raise McapError("the index is not that of the chunk")
            self._offsets[index.channel_id] = at
            return
        self._finish_chunk()
        if opcode == Opcode.CHUNK:
            self._take_chunk(Chunk.read(fields), at, HEAD.size + len(data))
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
            self.metadata.append(MetadataIndex(at, HEAD.size + len(data), record.name))

    def _take_chunk(self, chunk: Chunk, start: int, length: int) -> None:
        """Process a complete chunk."""
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
        self._entries = entries
        self._chunk = index_of(chunk, start, length)
        self._offsets = self._chunk.message_index_offsets
        times = [time_ns for each in entries.values() for time_ns in each[::2]]
        self._chunk.message_start_time = min(times, default=0)
        self._chunk.message_end_time = max(times, default=0)

    def _finish_chunk(self) -> None:
        """Record a chunk and its index; omit an incomplete index, which makes readers search."""
        index, self._chunk = self._chunk, None
        if index is None:
            return
        if self._offsets.keys() == self._entries.keys():
            chunk_end = index.chunk_start_offset + index.chunk_length
            index.message_index_length = self.end - chunk_end
        else:
            self._offsets.clear()
        self._note(index)

    def _finish_last_chunk(self) -> None:
        """Record the last chunk and its index, whose end may be missing."""
        index = self._chunk
        if index is None or self._offsets.keys() == self._entries.keys():
            self._finish_chunk()
            return
        at = self.end = index.chunk_start_offset + index.chunk_length
        records = [index_record(*entry) for entry in self._entries.items()]
        for channel, record in zip(self._entries, records, strict=True):
            self._offsets[channel] = at
            at += len(record)
        self.rest = b"".join(records)
        index.message_index_length = len(self.rest)
        self._note(index)

    def _note(self, index: ChunkIndex) -> None:
        counts = {channel: len(entries) // 2 for channel, entries in self._entries.items()}
        self.spans.append(Span(index, counts))


def reindex(path: str | PathLike[str]) -> None:
    """Rebuild the ``metadata.yaml`` of a bag from its files.

    The custom data are kept if the old file is readable. From then on, `Bag.missing` has the
    messages that it counted and the files no longer have.

    Args:
        path: The folder.

    Raises:
        BagError: there are no files, one is damaged and `check` can repair it, or the bag is being
            recorded.
        OSError: a file cannot be read, or the metadata cannot be written.
    """
    folder = Path(path)
    if not folder.is_dir():
        raise BagError(str(path), "only a folder has metadata", "give the folder of the bag")
    with FolderLock(folder):
        rebuild_metadata(folder)


def rebuild_metadata(folder: Path) -> None:
    """Write ``metadata.yaml`` from the files of a folder whose lock is held."""
    sources = []
    parts = []
    try:
        for file in files_of(folder):
            source = source_of(file)
            sources.append(source)
            count = sum(topic.message_count for topic in source.topics)
            parts.append((file.name, source.start_ns, source.end_ns, count))
        storage = "mcap" if ".mcap" in parts[0][0] else "sqlite3"
        before = metadata_in(folder)
        topics, custom = merged_topics(sources, []), custom_data_of(folder, sources, before)
        metadata = metadata_of(topics, parts, custom_data=custom, ros_distro="", storage=storage)
        if parts[0][0].endswith(".zstd"):
            metadata |= {"compression_format": "zstd", "compression_mode": "FILE"}
        write_metadata(folder, metadata)
    finally:
        for source in sources:
            source.close()


def metadata_in(folder: Path) -> dict[str, Any]:
    """Return the metadata of a folder; empty if they cannot be read."""
    with contextlib.suppress(BagError):
        return read_metadata(folder)
    return {}


def custom_data_of(folder: Path, sources: list[Source], before: dict[str, Any]) -> dict[str, str]:
    """Return the custom data of a folder, with the messages that only its metadata count."""
    told = before.get("custom_data")
    custom = {str(key): str(value) for key, value in told.items()} if isinstance(told, dict) else {}
    missing = Bag(folder, sources, before | {"custom_data": custom}).missing
    return custom | {MISSING: missing_text(missing)} if missing else custom
