"""The thread that writes a recording, so that the event loop never waits for the disk.

The loop appends rows to a deque, and the thread takes them every 20 ms: one wake-up for many
messages. Each counter has a single writer, so no lock is needed.
"""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from time import sleep  # noqa: TID251  # for no time: it only releases the interpreter
from typing import TYPE_CHECKING, Final, NamedTuple

from aionode.bag._writer import BagWriter
from aionode.bag.files.mcap_writer import write_error
from aionode.clock import perf_ns
from aionode.errors import BagWriteError

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.bag.files.mcap_writer import Parts
    from aionode.bag.files.record import TopicInfo

__all__ = ["Row", "WriterThread"]

BATCH_S: Final = 0.02
"""Interval at which the thread looks for new rows, in seconds."""

SYNC_NS: Final = 250_000_000
"""Maximum age of messages that are not on disk yet, in nanoseconds. A power cut must not lose
more than the last second, and writing also takes time, most of it on a busy machine."""

TURN: Final = 32
"""Rows to take before other threads get a turn."""

TURN_BYTES: Final = 32 << 10
"""A row counts as one more for each of this many bytes, as large ones take longer."""

MAX_ROWS: Final = 1_000_000
"""Maximum rows that wait or are kept for a snapshot: small messages need more than their bytes."""

MIN_WAITING: Final = 16 << 20
"""Minimum bytes that may wait for the thread in snapshot mode, however few are kept."""


class Row(NamedTuple):
    """One message on its way to the file.

    Attributes:
        topic: The id of its topic, as assigned by the recorder.
        time_ns: The receive time, in nanoseconds since 1970.
        publish_time_ns: The publish time.
        sequence: The publisher's sequence number.
        size: Its size in bytes.
        raw: Its bytes, or a list of their parts.
    """

    topic: int
    time_ns: int
    publish_time_ns: int
    sequence: int
    size: int
    raw: Parts


class WriterThread:
    """Writes rows to a bag.

    Args:
        writer: The bag.
        topics: The topics by id, each with the number of messages that further files start with;
            the recorder adds to it.
        cache_bytes: How many bytes may wait for the disk; in snapshot mode, how many are kept.
        cache_ns: How long messages are kept in snapshot mode, in nanoseconds; 0 for no limit.
        snapshot: Whether to only keep messages until a snapshot is requested.
        on_failure: Called once, in the thread, when nothing can be written any more.
        before_close: Called in the thread before the bag is closed, and again if losses are counted
            after that.

    Attributes:
        failure: Why nothing is written any more; None while everything works.
        lost: Number of rows of each topic that were not written because the disk was full or
            failed.
    """

    def __init__(
        self,
        writer: BagWriter,
        topics: list[tuple[TopicInfo, int]],
        cache_bytes: int,
        *,
        cache_ns: int = 0,
        snapshot: bool,
        on_failure: Callable[[], None],
        before_close: Callable[[], None],
    ) -> None:
        self.failure: BagWriteError | None = None
        self.lost: dict[int, int] = {}
        self._writer = writer
        self._topics = topics
        self._cache_bytes = cache_bytes
        self._cache_ns = cache_ns
        self._waiting_bytes = max(cache_bytes, MIN_WAITING) if snapshot else cache_bytes
        self._on_failure = on_failure
        self._before_close = before_close
        self._rows: deque[Row | Callable[[], None]] = deque()
        self._put_bytes = 0
        self._taken_bytes = 0
        self._numbers: dict[int, int] = {}  # ids of the topics in the bag
        self._written: dict[int, int] = {}
        self._is_dirty = False
        self._synced_ns = perf_ns()
        self._kept: deque[Row] | None = deque() if snapshot else None
        self._kept_bytes = 0
        self._latched: dict[int, deque[Row]] = {}
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="aionode-bag-writer", daemon=True)
        self._thread.start()

    # In the loop

    @property
    def waiting_bytes(self) -> int:
        """The number of bytes that the thread has not taken yet."""
        return self._put_bytes - self._taken_bytes

    def put(self, row: Row) -> bool:
        """Enqueue a row, and return whether there was room for it."""
        size = row.size
        waiting = len(self._rows)
        if waiting and (self.waiting_bytes + size > self._waiting_bytes or waiting >= MAX_ROWS):
            return False
        self._put_bytes += size
        self._rows.append(row)
        return True

    def call(self, work: Callable[[], None]) -> None:
        """Call `work` in the thread once all earlier rows are written."""
        self._rows.append(work)

    def stop(self) -> None:
        """Write all rows, close the bag, and wait for both; not in the event loop's thread."""
        self._stopping.set()
        self._thread.join()

    # In the thread

    def _run(self) -> None:
        while not self._stopping.wait(BATCH_S):
            self._guarded(self._step)
        while self._rows:  # an error leaves the rest, which is then counted
            self._guarded(self._take_all)
        self._before_close()
        try:
            self._writer.close()
        except BagWriteError as error:
            self._fail(error)
        if self.failure is not None:
            self._count_lost()
            self._before_close()
            with contextlib.suppress(OSError):
                self._writer.write_metadata()

    def _guarded(self, step: Callable[[], None]) -> None:
        try:
            step()
        except BagWriteError as error:
            self._fail(error)
        except OSError as error:  # a removed file, or a sync that fails
            self._fail(write_error(self._writer.path, error))

    def _fail(self, error: BagWriteError) -> None:
        if self.failure is None:
            self.failure = error
            self._on_failure()

    def _step(self) -> None:
        """Write new rows, and sync them to disk in time."""
        if not self._is_dirty:
            self._synced_ns = perf_ns()
        self._take_all()
        self._sync_in_time()

    def _sync_in_time(self) -> None:
        """Sync the file to disk if a sync is due."""
        if self._is_dirty and perf_ns() - self._synced_ns >= SYNC_NS:
            self._is_dirty = False
            self._synced_ns = perf_ns()
            self._writer.sync()

    def _take_all(self) -> None:
        rows = self._rows
        taken = 0
        while rows:
            if taken >= TURN:
                taken = 0
                sleep(0)  # the event loop may be waiting for its turn
                self._sync_in_time()  # under constant load, nothing else does
            row = rows.popleft()
            if not isinstance(row, Row):
                row()
                continue
            taken += 1 + row.size // TURN_BYTES
            self._taken_bytes += row.size
            if self.failure is not None:
                self.lost[row.topic] = self.lost.get(row.topic, 0) + 1
            elif self._kept is None:
                self._write(row)
            else:
                self._keep(row, self._kept)

    def _write(self, row: Row) -> None:
        number = self._numbers.get(row.topic)
        if number is None:
            topic, latched_depth = self._topics[row.topic]
            number = self._writer.add_topic(topic, latched_depth=latched_depth)
            self._numbers[row.topic] = number
            self._written[row.topic] = 0
        self._written[row.topic] += 1
        self._is_dirty = True
        self._writer.write(
            number,
            row.time_ns,
            row.raw,
            publish_time_ns=row.publish_time_ns,
            sequence=row.sequence,
        )

    def _count_lost(self) -> None:
        """Count the messages that a full disk made the writer remove, once the bag is closed."""
        in_bag = {topic.key: topic.message_count for topic in self._writer.topics}
        for number, written in self._written.items():
            missing = written - in_bag.get(self._topics[number][0].key, 0)
            if missing > 0:
                self.lost[number] = self.lost.get(number, 0) + missing

    # Snapshots

    def _keep(self, row: Row, kept: deque[Row]) -> None:
        """Keep a row for a snapshot, dropping the oldest ones."""
        kept.append(row)
        self._kept_bytes += row.size
        while len(kept) > 1 and self._is_too_much(kept):
            oldest = kept.popleft()
            self._kept_bytes -= oldest.size
            depth = self._topics[oldest.topic][1]
            if depth:
                self._latched.setdefault(oldest.topic, deque(maxlen=depth)).append(oldest)

    def _is_too_much(self, kept: deque[Row]) -> bool:
        """Return whether the oldest row has to be dropped."""
        if self._kept_bytes > self._cache_bytes or len(kept) > MAX_ROWS:
            return True
        return 0 < self._cache_ns < kept[-1].time_ns - kept[0].time_ns

    def write_snapshot(self) -> None:
        """Write the rows kept, preceded by earlier latched messages; only through `call`."""
        kept, self._kept = self._kept or deque(), deque()
        self._kept_bytes = 0
        first_ns = kept[0].time_ns if kept else 0
        with contextlib.suppress(IndexError):
            for rows in self._latched.values():
                for row in rows:
                    self._write(row._replace(time_ns=first_ns or row.time_ns))
        for row in kept:
            self._write(row)
        self._writer.sync()

    def split(self, time_ns: int) -> None:
        """Start a new file; only through `call`."""
        self._writer.split(time_ns)
