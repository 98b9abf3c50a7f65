"""Reads the sqlite3 files of bags, in every version of rosbag2."""

from __future__ import annotations

import sqlite3
from contextlib import ExitStack, closing, suppress
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import quote

from aionode.bag.files.compression import plain_file, plain_message
from aionode.bag.files.qos import readable_profiles
from aionode.bag.files.record import MAX_NS, Record, TopicInfo
from aionode.bag.files.source import DAMAGE, damaged
from aionode.errors import BagError, brief

if TYPE_CHECKING:
    from collections.abc import Iterator
    from collections.abc import Set as AbstractSet
    from pathlib import Path

__all__ = ["SqliteSource"]

STEPS: Final = 100_000
"""Steps of SQLite's virtual machine between two checks of their number."""

STEPS_FOR_A_BYTE: Final = 10
MIN_STEPS: Final = 10_000_000

COUNT: Final = (
    "SELECT topic_id, COUNT(*), MIN(timestamp), MAX(timestamp) FROM messages "
    "WHERE typeof(timestamp) = 'integer' GROUP BY topic_id"
)
ROWS: Final = (
    "SELECT topic_id, timestamp FROM messages NOT INDEXED WHERE typeof(timestamp) = 'integer'"
)
BROKEN: Final = "SELECT id FROM messages WHERE typeof(timestamp) != 'integer' LIMIT 1"
ENCODINGS: Final = frozenset({"ros2msg", "ros2idl"})
SQL_END_NS: Final = 2**63 - 1


class SqliteSource:
    """A sqlite3 file of a bag.

    Args:
        path: The file; a ``.zstd`` file is decompressed into a temporary folder.
        compressed_messages: Whether each message is compressed individually.

    Raises:
        BagError: it is not such a file, or is damaged.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path, *, compressed_messages: bool = False) -> None:
        self.path = path
        self._compressed_messages = compressed_messages
        with ExitStack() as stack:
            plain, _ = plain_file(path, stack)
            # The write-ahead log holds what is not in the database yet.
            log = plain.with_name(f"{plain.name}-wal")
            is_whole = not (log.is_file() and log.stat().st_size)
            options = "mode=ro&immutable=1" if is_whole else "mode=ro"
            place = f"file:{quote(str(plain.absolute()))}?{options}"
            try:
                base = sqlite3.connect(place, uri=True, check_same_thread=False)
                stack.callback(base.close)
                self._limit_steps(base, plain.stat().st_size)
                base.text_factory = lambda data: data.decode(errors="replace")
                self._base = base
                expect_tables(base)
                self._topics = topics_in(base)
                self._count()
            except sqlite3.Error as error:
                raise damaged(path, error) from error
            except DAMAGE as error:
                raise damaged(path, error) from error
            self._open = stack.pop_all()
        self.topics = list(self._topics.values())

    def _limit_steps(self, base: sqlite3.Connection, size: int) -> None:
        """Interrupt queries that take more steps than an intact file of this size needs."""
        most = MIN_STEPS + STEPS_FOR_A_BYTE * size
        self._steps = 0

        def are_too_many() -> bool:
            self._steps += STEPS
            return self._steps > most

        base.set_progress_handler(are_too_many, STEPS)

    def _count(self) -> None:
        """Count the messages of each topic."""
        self.start_ns, self.end_ns = MAX_NS, 0
        self._strays: list[tuple[object, int]] = []
        try:
            counted = self._base.execute(COUNT).fetchall()
            self._is_whole = True
        except sqlite3.DatabaseError:
            counted = self._counted()
            self._is_whole = False
        for number, count, first_ns, last_ns in counted:
            if number in self._topics:
                self._topics[number].message_count = count
                self.start_ns = min(self.start_ns, max(first_ns, 0))
                self.end_ns = max(self.end_ns, last_ns)
            else:
                self._strays.append((number, count))

    def _counted(self) -> list[tuple[object, int, int, int]]:
        """Count the messages of a damaged file up to the damage: its index may lie behind that."""
        found: dict[object, tuple[int, int, int]] = {}
        with suppress(sqlite3.DatabaseError):
            for number, time_ns in self._base.execute(ROWS):
                count, first_ns, last_ns = found.get(number, (0, time_ns, time_ns))
                found[number] = (count + 1, min(first_ns, time_ns), max(last_ns, time_ns))
        return [(number, *counts) for number, counts in found.items()]

    def records(
        self,
        topics: AbstractSet[str] | None,
        start_ns: int,
        end_ns: int,
        problems: list[BagError],
    ) -> Iterator[Record]:
        """Yield the records of some topics from `start_ns` until before `end_ns`, in order."""
        wanted = {
            number: info
            for number, info in self._topics.items()
            if topics is None or info.name in topics
        }
        for number, count in self._strays if topics is None else ():
            what = f"{count} messages belong to topic {brief(number)}, which is not listed"
            problems.append(damaged(self.path, LookupError(what)))
        if not wanted:
            return
        self._steps = 0
        # Times before 1970 count as 0; times that `Time` cannot represent are clamped to the last.
        first_ns = start_ns if start_ns > 0 else -(2**63)
        last_ns = min(end_ns - 1, SQL_END_NS)
        indexed, order = ("", "timestamp") if self._is_whole else ("NOT INDEXED", "id")
        text = f"SELECT id, topic_id, timestamp, data FROM messages {indexed} "  # noqa: S608  # of these words
        if start_ns > 0 or end_ns <= SQL_END_NS:
            first_ns = min(first_ns, SQL_END_NS)
            text += f"WHERE timestamp >= {first_ns} AND timestamp <= {last_ns} "
        try:
            if self._is_whole and (bad := self._base.execute(BROKEN).fetchone()):
                wrong = TypeError("its time is not a number")
                problems.append(damaged(self.path, wrong, f"the message {bad[0]}"))
            with closing(self._base.execute(f"{text}ORDER BY {order}")) as rows:
                for row, number, time_ns, data in rows:
                    info = wanted.get(number)
                    if info is None or not isinstance(time_ns, int):
                        continue
                    try:
                        if not isinstance(data, bytes):
                            raise TypeError("its data are not bytes")  # as others
                        raw = plain_message(data) if self._compressed_messages else data
                    except DAMAGE as error:
                        problems.append(damaged(self.path, error, f"the message {row}"))
                        continue
                    time_ns = max(time_ns, 0)  # noqa: PLW2901  # times count from 1970
                    yield Record(info, time_ns, time_ns, 0, raw)
        except (sqlite3.Error, *DAMAGE) as error:
            problems.append(damaged(self.path, error))

    def close(self) -> None:
        """Close the file."""
        self._open.close()


def expect_tables(base: sqlite3.Connection) -> None:
    """Raise ValueError unless the tables of a bag exist; views might never terminate."""
    named = base.execute("SELECT name, type, sql FROM sqlite_master").fetchall()
    tables = {
        name
        for name, kind, text in named
        if kind == "table" and str(text).upper().startswith("CREATE TABLE")
    }
    missing = {"topics", "messages"} - tables
    if missing:
        raise ValueError(f"it has no table {' and '.join(sorted(missing))}")


def columns_of(base: sqlite3.Connection, table: str) -> set[str]:
    """Return the column names of a table; empty if it does not exist."""
    return {row[1] for row in base.execute(f"PRAGMA table_info({table})")}


def topics_in(base: sqlite3.Connection) -> dict[int, TopicInfo]:
    """Return the topics by id, without counts."""
    definitions: dict[str, tuple[Any, ...]] = {}
    if columns_of(base, "message_definitions"):
        for kind, *rest in base.execute(
            "SELECT topic_type, encoding, encoded_message_definition, type_description_hash "
            "FROM message_definitions ORDER BY id"
        ):
            definitions.setdefault(text_from(kind), tuple(map(text_from, rest)))
    optional = [
        name if name in columns_of(base, "topics") else f"'' AS {name}"
        for name in ("offered_qos_profiles", "type_description_hash")
    ]
    topics: dict[int, TopicInfo] = {}
    for number, name, kind, form, profiles, digest in base.execute(
        f"SELECT id, name, type, serialization_format, {', '.join(optional)} "  # noqa: S608  # of these names
        "FROM topics ORDER BY id"
    ):
        encoding, definition, other_digest = definitions.get(text_from(kind), ("", "", ""))
        is_known = bool(definition) and encoding in ENCODINGS
        qos, problem = readable_profiles(text_from(profiles))
        topics[number] = TopicInfo(
            name=text_from(name),
            type=text_from(kind),
            type_hash=text_from(digest) or other_digest,
            qos=qos,
            serialization_format=text_from(form),
            encoding=encoding if is_known else "",
            definition=definition if is_known else "",
            problem=problem,
        )
    return topics


def text_from(value: object) -> str:
    """Return a column's value as text; SQLite allows any type of value."""
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    return "" if value is None else str(value)
