"""The thread that writes a recording is timely, bounded and exact about losses."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from aionode.bag._writer import BagWriter, topic_info
from aionode.bag.files.mcap_writer import MAX_AT_ONCE, write_all
from aionode.bag.recording.writer_thread import Row, WriterThread
from aionode.errors import BagWriteError
from aionode.interfaces.std_msgs.msg import String

ROW = Row(0, 1, 1, 1, 4, b"0123")


def thread_of(writer: BagWriter, *, snapshot: bool = False) -> WriterThread:
    """Return the writer thread of a bag with one topic, without a limit in bytes."""
    return WriterThread(
        writer,
        [(topic_info("/x", String), 0)],
        1 << 30,
        snapshot=snapshot,
        on_failure=lambda: None,
        before_close=lambda: None,
    )


class Endless(BagWriter):
    """A bag that gets another row with each row written, until it is synced."""

    thread: WriterThread
    synced = False

    def write(self, *args: object, **kwargs: object) -> None:
        """Put another row, unless this has gone on for too long."""
        super().write(*args, **kwargs)  # type: ignore[arg-type]  # as they come
        if not self.synced and self.message_count < 5000:
            self.thread.put(ROW)

    def sync(self) -> None:
        """Note it."""
        self.synced = True


def test_the_disk_confirms_in_time_although_more_comes_all_the_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a busy machine the queue may never be empty, and a power cut would lose everything."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.SYNC_NS", 0)
    writer = Endless(tmp_path / "run")
    writer.thread = thread_of(writer)
    writer.thread.put(ROW)
    writer.thread.stop()
    assert writer.synced
    assert writer.message_count < 5000


class Full(BagWriter):
    """A bag on a full disk."""

    def write(self, *_: object, **__: object) -> None:
        """Refuse it."""
        raise BagWriteError(str(self.path), "no space", is_full=True)


def test_rows_that_wait_when_the_disk_is_found_full_at_the_end_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a busy machine the thread may not have begun when the recording ends."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.BATCH_S", 60)
    thread = thread_of(Full(tmp_path / "run"))
    for _ in range(10):
        thread.put(ROW)
    thread.stop()
    assert thread.failure is not None
    assert thread.lost == {0: 10}


def test_no_more_than_a_number_of_small_messages_waits_or_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even empty messages take memory."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.BATCH_S", 60)
    monkeypatch.setattr("aionode.bag.recording.writer_thread.MAX_ROWS", 3)
    thread = thread_of(BagWriter(tmp_path / "waiting"))
    assert [thread.put(ROW) for _ in range(5)] == [True, True, True, False, False]
    thread.stop()
    monkeypatch.setattr("aionode.bag.recording.writer_thread.BATCH_S", 0)
    with BagWriter(tmp_path / "kept") as writer:
        thread = thread_of(writer, snapshot=True)
        for _ in range(5):
            taken = threading.Event()
            thread.put(ROW)
            thread.call(taken.set)
            taken.wait()
        thread.call(thread.write_snapshot)
        thread.stop()
    assert writer.message_count == 3


def test_large_messages_are_written_in_pieces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A long call may keep the event loop from running, and any call may write less."""
    plain, sizes = os.writev, []

    def writev(fd: int, pieces: list[memoryview]) -> int:
        sizes.append(sum(map(len, pieces)))
        return plain(fd, [pieces[0][:1000], *pieces[1:]] if len(pieces) == 1 else pieces)

    monkeypatch.setattr(os, "writev", writev)
    pieces = [
        b"head",
        os.urandom(1_000_000),
        b"",
        *(bytes([at % 256]) for at in range(2000)),
        b"end",
    ]
    with (tmp_path / "file").open("wb") as file:
        write_all(file.fileno(), pieces)
    assert (tmp_path / "file").read_bytes() == b"".join(pieces)
    assert max(sizes) <= MAX_AT_ONCE
