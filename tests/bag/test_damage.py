"""Damaged, contradictory and malicious bags: readable data is read, the rest is reported."""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import lz4.frame
import pytest
import yaml
import zstandard
from mcap.reader import make_reader

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.bag.files.chunks import HEAD
from aionode.bag.files.compression import decompressed
from aionode.bag.files.summary import read_summary
from aionode.cli import main
from aionode.engine.wire import cdr
from aionode.errors import BagError
from aionode.interfaces.std_msgs.msg import Int32, String
from tests.bag.test_rosbag2_files import make_mcap, make_sqlite3

ALL = ["a", "b", "c"]


def texts(path: Path, **limits: Any) -> list[str]:
    """Return the texts of a bag."""
    with bag.open(path) as run:
        return [record.message.data for record in run.read(**limits)]


def heard_before_error(path: Path, *topics: str) -> tuple[list[str], BagError]:
    """Return the texts that a bag yields before an error, and the error."""
    heard: list[str] = []
    with bag.open(path) as run:
        try:
            heard.extend(each.message.data for each in run.read(topics or None))
        except BagError as error:
            return heard, error
    raise AssertionError("there is no error")


def record(path: Path, count: int = 4) -> Path:
    """Record texts, each in a chunk of its own, and return the file."""
    with bag.BagWriter(path, compression="none", custom_data={"robot": "r2"}) as out:
        number = out.add_topic(topic_info("/words", String))
        other = out.add_topic(topic_info("/numbers", Int32))
        for at in range(count):
            out.write(number, (at + 1) * 10**9, cdr.encode(String(data=str(at))))
            out.write(other, (at + 1) * 10**9, cdr.encode(Int32(data=at)))
            out.flush()
    return path / f"{path.name}_0.mcap"


def chunks(file: Path) -> list[Any]:
    """Return where the chunks of a file are."""
    with file.open("rb") as stream:
        return read_summary(stream).chunks


def damage_chunk(file: Path, number: int) -> None:
    """Change a byte near the end of a chunk."""
    index = chunks(file)[number]
    data = bytearray(file.read_bytes())
    data[index.chunk_start_offset + index.chunk_length - 1] ^= 1
    file.write_bytes(data)


def sql(file: Path, text: str) -> None:
    """Change a database."""
    with closing(sqlite3.connect(file)) as base, base:
        base.executescript(text)


# Two places that tell of one thing


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE topics SET offered_qos_profiles = ''",
        "UPDATE topics SET offered_qos_profiles = '- {history: keep_last, depth: 99}'",
        "UPDATE topics SET offered_qos_profiles = '- {history: [}'",
        "UPDATE topics SET offered_qos_profiles = 7",
        "UPDATE topics SET type_description_hash = ''",
    ],
)
def test_a_topic_whose_file_and_metadata_differ_in_qos_is_read(change: str, tmp_path: Path) -> None:
    """QoS does not identify a topic: rosbag2's own `convert` leaves it out of the database."""
    make_sqlite3(tmp_path / "run", 4, 9)
    sql(tmp_path / "run" / "run_0.db3", change)
    assert texts(tmp_path / "run") == ALL
    with bag.open(tmp_path / "run") as run:
        assert run.counts == {"/words": 3}
    assert bag.convert([tmp_path / "run"], tmp_path / "new") == 3
    assert [found.repaired for found in bag.check(tmp_path / "run")] == [False]


def test_files_of_one_topic_with_different_qos_are_read_as_one_topic(tmp_path: Path) -> None:
    """A publisher may have restarted with another profile when the second file began."""
    make_sqlite3(tmp_path / "run", 4, 9)
    make_sqlite3(tmp_path / "more", 4, 9)
    (tmp_path / "more" / "more_0.db3").rename(tmp_path / "run" / "run_1.db3")
    sql(tmp_path / "run" / "run_1.db3", "UPDATE topics SET offered_qos_profiles = ''")
    place = tmp_path / "run" / "metadata.yaml"
    place.write_text(place.read_text().replace("- run_0.db3", "- run_0.db3\n  - run_1.db3"))
    assert sorted(texts(tmp_path / "run")) == ["a", "a", "b", "b", "c", "c"]


@pytest.mark.parametrize("kind", ["mcap", "sqlite3"])
def test_messages_that_are_compressed_one_by_one_are_read(kind: str, tmp_path: Path) -> None:
    """rosbag2's compression mode `message` works with each storage."""
    if kind == "mcap":
        run = record(tmp_path / "run").parent
        with bag.open(run) as opened:
            rows = list(opened.read("/words"))
        with bag.BagWriter(tmp_path / "new") as out:
            for row in rows:
                row.raw = zstandard.compress(row.raw)
                out.write_record(row)
        run, wanted = tmp_path / "new", ["0", "1", "2", "3"]
    else:
        run, wanted = tmp_path / "run", ALL
        make_sqlite3(run, 4, 9)
        with closing(sqlite3.connect(run / "run_0.db3")) as base, base:
            for number, raw in base.execute("SELECT id, data FROM messages").fetchall():
                packed = zstandard.compress(raw)
                base.execute("UPDATE messages SET data = ? WHERE id = ?", (packed, number))
    place = run / "metadata.yaml"
    content = yaml.safe_load(place.read_text())
    content["rosbag2_bagfile_information"] |= {
        "compression_mode": "MESSAGE",
        "compression_format": "zstd",
    }
    place.write_text(yaml.safe_dump(content))
    assert texts(run) == wanted


def test_a_count_that_is_not_what_can_be_read_is_an_error(tmp_path: Path) -> None:
    """Otherwise a copy with fewer messages than `info` shows would pass as complete."""
    file = record(tmp_path / "run")
    data = bytearray(file.read_bytes())
    (at, *_) = [at for at in range(len(data)) if data[at : at + 9] == HEAD.pack(0x0B, 66)] or [0]
    assert at
    count_at = at + HEAD.size
    data[count_at] += 3  # of all messages
    data[-8 - 4 : -8] = bytes(4)  # no checksum
    for _ in range(2):
        at = data.index(HEAD.pack(0x0B, 66))
    counts = at + HEAD.size + 8 + 2 + 4 * 4 + 8 + 8 + 4
    data[counts + 2] += 3
    file.write_bytes(data)
    with pytest.raises(BagError, match="claims to have 11 messages, but 8 can be read"):
        texts(tmp_path / "run")
    assert [found.repaired for found in bag.check(tmp_path / "run")] == [True]
    assert len(texts(tmp_path / "run")) == 8


# Damage


def test_the_other_chunks_of_a_file_with_a_damaged_one_are_read(tmp_path: Path) -> None:
    """A flipped bit on a disk costs one second of a recording, not the rest of the day."""
    file = record(tmp_path / "run")
    damage_chunk(file, 1)
    heard, error = heard_before_error(tmp_path / "run", "/words")
    assert "the chunk at byte" in str(error)
    assert heard == ["0", "2", "3"]


async def test_async_for_gives_what_it_read_before_the_damage(tmp_path: Path) -> None:
    """It reads many records at a time, and raises the error after the last good one."""
    file = record(tmp_path / "run")
    damage_chunk(file, 3)
    heard: list[str] = []

    async def read() -> None:
        with bag.open(tmp_path / "run") as run:
            async for each in run.read("/words"):
                heard.append(each.message.data)  # noqa: PERF401  # kept when it raises

    with pytest.raises(BagError, match="the chunk at byte"):
        await read()
    assert heard == ["0", "1", "2"]


def test_check_looks_into_the_chunks_and_keeps_all_that_are_whole(tmp_path: Path) -> None:
    """The summary may be intact while the data is not; every reader skips damaged chunks."""
    file = record(tmp_path / "run")
    damage_chunk(file, 1)
    lost = chunks(file)[1].chunk_length
    (found,) = bag.check(tmp_path / "run")
    assert found == ("run_0.mcap", True, 6, lost)
    assert texts(tmp_path / "run", topics="/words") == ["0", "2", "3"]
    with file.open("rb") as stream:
        assert len(list(make_reader(stream, validate_crcs=True).iter_messages())) == 6
    assert bag.check(tmp_path / "run") == [("run_0.mcap", False, 6, 0)]
    with bag.open(tmp_path / "run") as run:
        assert run.custom_data == {"robot": "r2"}


def test_a_file_without_an_end_keeps_what_follows_a_damaged_chunk(tmp_path: Path) -> None:
    """A power cut and a bad block may come together."""
    file = record(tmp_path / "run")
    damage_chunk(file, 1)
    file.write_bytes(file.read_bytes()[:-50])
    (found,) = bag.check(tmp_path / "run")
    assert (found.repaired, found.messages) == (True, 6)
    assert texts(tmp_path / "run", topics="/words") == ["0", "2", "3"]


def test_one_topic_whose_qos_cannot_be_read_leaves_the_others_readable(tmp_path: Path) -> None:
    """It is read as well, and reports what is missing."""
    file = record(tmp_path / "run")
    data = file.read_bytes().replace(b"history: keep_last", b"history: [eep_last")
    data = data[:-12] + bytes(4) + data[-8:]
    for index in chunks(file):  # no checksums
        at = index.chunk_start_offset + HEAD.size + 24
        data = data[:at] + bytes(4) + data[at + 4 :]
    file.write_bytes(data)
    assert texts(file, topics="/words") == ["0", "1", "2", "3"]
    with bag.open(file) as run:
        assert "its QoS cannot be read" in run.topics["/words"].problem


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ("UPDATE messages SET timestamp = 'noon' WHERE id = 2", "the message 2 is damaged"),
        ("UPDATE messages SET data = 'text' WHERE id = 2", "the message 2 is damaged"),
        ("UPDATE messages SET data = NULL WHERE id = 2", "the message 2 is damaged"),
    ],
)
def test_the_other_rows_of_a_database_with_a_strange_one_are_read(
    change: str, problem: str, tmp_path: Path
) -> None:
    """SQLite's columns accept any value, whatever their type."""
    make_sqlite3(tmp_path / "run", 4, 9)
    file = tmp_path / "run" / "run_0.db3"
    change = change.replace("messages", "copy")
    sql(
        file,
        "CREATE TABLE copy AS SELECT * FROM messages; DROP TABLE messages;"  # noqa: S608  # of this file
        + change
        + "; ALTER TABLE copy RENAME TO messages",
    )
    heard, error = heard_before_error(tmp_path / "run")
    assert problem in str(error)
    assert heard == ["a", "c"]
    with pytest.raises(BagError, match=problem):
        bag.check(tmp_path / "run")


@pytest.mark.parametrize("time_ns", [-5, 2**63 - 1])
def test_times_that_no_clock_shows_are_the_nearest_that_one_does(
    time_ns: int, tmp_path: Path
) -> None:
    """They come from damage and from clocks that were never set."""
    make_sqlite3(tmp_path / "run", 4, 9)
    with closing(sqlite3.connect(tmp_path / "run" / "run_0.db3")) as base, base:
        base.execute("UPDATE messages SET timestamp = ? WHERE id = 2", (time_ns,))
    with bag.open(tmp_path / "run") as run:
        assert sorted(each.message.data for each in run.read()) == ALL
        assert all(each.time.nanoseconds == max(each.time_ns, 0) for each in run.read())
        assert run.duration.nanoseconds > 0


def test_a_message_of_a_time_beyond_all_clocks_is_read(tmp_path: Path) -> None:
    """MCAP's times are unsigned 64-bit numbers."""
    with bag.BagWriter(tmp_path / "run") as out:
        number = out.add_topic(topic_info("/words", String))
        out.write(number, 2**64 - 2, cdr.encode(String(data="late")))
    assert texts(tmp_path / "run") == ["late"]
    assert bag.check(tmp_path / "run")[0].messages == 1


@pytest.mark.parametrize("at", [2**63, 2**64 - 1, 10**6])
def test_an_offset_beyond_the_file_is_damage_with_its_place(at: int, tmp_path: Path) -> None:
    """The offset may be larger than any file."""
    file = record(tmp_path / "run")
    data = bytearray(file.read_bytes())
    data[-8 - 20 : -8 - 12] = at.to_bytes(8, "little")
    file.write_bytes(data)
    with pytest.raises(BagError, match="its summary would begin at byte"):
        bag.open(file)
    assert bag.check(file)[0].messages == 8


def test_a_database_with_a_damaged_page_is_read_up_to_it(tmp_path: Path) -> None:
    """The error names a tool for the rest, since `bag check` does not repair databases."""
    make_sqlite3(tmp_path / "run", 4, 9)
    file = tmp_path / "run" / "run_0.db3"
    sql(
        file,
        "WITH RECURSIVE n(i) AS (SELECT 4 UNION ALL SELECT i + 1 FROM n WHERE i < 5000) "
        "INSERT INTO messages(topic_id, timestamp, data) "
        "SELECT 1, 2000000000000000000 + i, (SELECT data FROM messages WHERE id = 1) FROM n",
    )
    data = bytearray(file.read_bytes())
    page = 4096
    for at in range(len(data) // 2 // page * page, len(data), page):
        data[at : at + 16] = b"\xff" * 16
    file.write_bytes(data)

    heard, error = heard_before_error(tmp_path / "run")

    assert heard[:3] == ALL
    assert len(heard) > 500
    assert ".recover" in str(error)
    with pytest.raises(BagError, match="recover"):
        bag.check(tmp_path / "run")


def test_a_view_in_place_of_a_table_is_refused(tmp_path: Path) -> None:
    """A view may produce rows forever."""
    make_sqlite3(tmp_path / "run", 4, 9)
    sql(
        tmp_path / "run" / "run_0.db3",
        "DROP TABLE messages; CREATE VIEW messages AS WITH RECURSIVE r(id) AS (SELECT 1 UNION ALL "
        "SELECT id + 1 FROM r) SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM r",
    )
    with pytest.raises(BagError, match="no table messages"):
        bag.open(tmp_path / "run")


# What fills the memory or the disk


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
@pytest.mark.parametrize("said", [100, 200 << 20])
def test_a_chunk_that_is_larger_than_is_believable_is_refused(
    compression: str, said: int, tmp_path: Path
) -> None:
    """A file of 32 kB may not allocate 1 GiB, whatever size it claims."""
    plain = bytes(200 << 20)
    packed = zstandard.compress(plain) if compression == "zstd" else lz4.frame.compress(plain)
    if compression == "lz4" and said > 100:
        packed = packed[:1000]
    with pytest.raises(Exception, match=r"but its header says|fewer than|at most"):
        decompressed(compression, packed, said)


@pytest.mark.parametrize("name", ["run_0.mcap.zstd", "run_0.db3.zstd"])
def test_a_file_that_decompresses_to_more_than_is_believable_is_refused(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It would fill the temporary folder, which other programs need."""
    monkeypatch.setattr("aionode.bag.files.compression.MAX_FILE", 1 << 20)
    (tmp_path / name).write_bytes(zstandard.compress(bytes(64 << 20)))
    with pytest.raises(BagError, match="decompresses to more than"):
        bag.open(tmp_path / name)


def test_a_full_temporary_folder_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bag is not damaged; another temporary folder is the remedy."""
    file = record(tmp_path / "run")
    packed = tmp_path / "run_0.mcap.zstd"
    packed.write_bytes(zstandard.compress(file.read_bytes()))

    def is_full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("aionode.bag.files.compression.write_plain", is_full)
    with pytest.raises(BagError, match=r"not have enough space .* set TMPDIR"):
        bag.open(packed)


def test_aliases_of_aliases_in_metadata_are_refused(tmp_path: Path) -> None:
    """Ten lines can expand to ten billion values."""
    lines = ["a0: &a0 [1,1,1,1,1,1,1,1,1,1]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 10)]
    (tmp_path / "metadata.yaml").write_text("\n".join(lines))
    with pytest.raises(BagError, match="counting the values of each alias"):
        bag.open(tmp_path)


@pytest.mark.parametrize("name", ["x.mcap", "x.db3", "metadata.yaml"])
def test_a_pipe_is_refused_at_once(name: str, tmp_path: Path) -> None:
    """Opening it would wait forever for a writer."""
    os.mkfifo(tmp_path / name)
    with pytest.raises(BagError, match="pipe or a device"):
        bag.open(tmp_path if name == "metadata.yaml" else tmp_path / name)


def test_the_pointer_of_git_lfs_is_called_one(tmp_path: Path) -> None:
    """Cloning without LFS leaves a pointer, which no repair can turn into a bag."""
    make_mcap(tmp_path / "run")
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 5\n"
    for name in ("run_0.mcap", "x.db3"):
        (tmp_path / "run" / name).write_text(pointer)
        for use in (bag.open, bag.check):
            with pytest.raises(BagError, match="`git lfs pull` fetches"):
                use(tmp_path / "run" / name)
        assert (tmp_path / "run" / name).read_text() == pointer
    place = tmp_path / "run" / "metadata.yaml"
    place.write_text(pointer)
    with pytest.raises(BagError, match="only the Git LFS pointer to the file; `git lfs pull`"):
        bag.open(tmp_path / "run")


def test_a_chunk_that_is_too_large_is_no_damage_to_repair(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It can be read with a higher limit, so a check must not remove it."""
    monkeypatch.setattr("aionode.bag.files.compression.MAX_PART", 1000)
    with bag.BagWriter(tmp_path / "run") as out:
        out.write(
            out.add_topic(topic_info("/words", String)), 1, cdr.encode(String(data="a" * 99_999))
        )
    file = tmp_path / "run" / "run_0.mcap"
    before = file.read_bytes()
    with pytest.raises(BagError, match="AIONODE_BAG_LARGEST_BYTES raises the limit"):
        bag.check(file)
    assert file.read_bytes() == before
    monkeypatch.setenv("AIONODE_BAG_LARGEST_BYTES", "200000")
    assert texts(file) == ["a" * 99_999]


def test_rows_of_a_topic_that_is_not_listed_are_said(tmp_path: Path) -> None:
    """A join of the tables would silently leave them out."""
    make_sqlite3(tmp_path / "run", 4, 9)
    sql(tmp_path / "run" / "run_0.db3", "UPDATE messages SET topic_id = 7 WHERE id = 2")
    heard, error = heard_before_error(tmp_path / "run")
    assert heard == ["a", "c"]
    assert "1 messages belong to topic 7" in str(error)


# Names of others


def test_names_in_a_bag_cannot_look_like_other_lines(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A newline in a name would add a line to `bag info`, and an escape code move the cursor."""
    odd = "/a\nTopic: /b | Type: x | Count: 9\r\x1b[2J"
    for name in ("one", "two"):
        with bag.BagWriter(tmp_path / name, custom_data={"x\ny": "1\n2"}) as out:
            number = out.add_topic(topic_info(odd, String))
            out.write(number, 1, cdr.encode(String(data=f"{name}\n\x1b")))
    assert main(["bag", "info", str(tmp_path / "one")]) == 0
    assert main(["bag", "info", "-t", str(tmp_path / "one")]) == 0
    main(["bag", "diff", str(tmp_path / "one"), str(tmp_path / "two")])
    shown = capsys.readouterr().out
    assert "\r" not in shown
    assert "\x1b" not in shown
    assert not any(line.startswith(("Topic: /b", "2", "y")) for line in shown.splitlines())
