"""Bags after a power cut, and copies of bags."""

from __future__ import annotations

import errno
from collections.abc import Sequence
from pathlib import Path

import pytest
from mcap.reader import make_reader

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.bag.files import mcap_writer
from aionode.clock import Duration, Time
from aionode.engine.wire import cdr
from aionode.errors import BagError, BagWriteError
from aionode.interfaces.std_msgs.msg import Int32, String


def record(path: Path, count: int = 3, topic: str = "/words", first_s: int = 1) -> None:
    """Record texts, a second apart, each in a chunk of its own."""
    with bag.BagWriter(path) as out:
        number = out.add_topic(topic_info(topic, String))
        other = out.add_topic(topic_info("/numbers", Int32))
        for at in range(count):
            time_ns = (first_s + at) * 10**9
            out.write(number, time_ns, cdr.encode(String(data=str(at))))
            out.write(other, time_ns, cdr.encode(Int32(data=at)))
            out.flush()


def numbers(path: Path) -> list[int]:
    """Return the numbers in a bag."""
    with bag.open(path) as run:
        return [each.message.data for each in run.read("/numbers")]


@pytest.mark.slow
@pytest.mark.parametrize("step", [7, pytest.param(1, marks=pytest.mark.stress)])
def test_a_file_cut_at_any_byte_keeps_every_complete_chunk(
    step: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A power cut can end a file anywhere; only what was not on the disk is lost."""
    monkeypatch.setattr("os.fdatasync", lambda fd: None)  # thousands of them take half a minute
    record(tmp_path / "run")
    file = tmp_path / "run" / "run_0.mcap"
    whole = file.read_bytes()
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    ends = [index.chunk_start_offset + index.chunk_length for index in summary.chunk_indexes]
    shown = {ends[0], ends[1] + 5, ends[2], len(whole) - 1}
    borders = {end + near for end in ends for near in range(-9, 9)} - set(range(ends[0]))
    for at in sorted({*range(ends[0], len(whole), step), *borders, *shown}):
        file.write_bytes(whole[:at])
        (found,) = bag.check(file)
        kept = sum(end <= at for end in ends)
        assert found.messages == 2 * kept, at
        if at in shown:
            assert numbers(file) == list(range(kept))
            with file.open("rb") as stream:
                read = list(make_reader(stream, validate_crcs=True).iter_messages())
            assert len(read) == 2 * kept


def test_a_file_that_has_hardly_begun_is_made_an_empty_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A recorder that dies at once leaves a few bytes, and the bag's other files stay readable."""
    monkeypatch.setattr("os.fdatasync", lambda fd: None)
    with bag.BagWriter(tmp_path / "run"):
        pass
    file = tmp_path / "run" / "run_0.mcap"
    whole = file.read_bytes()
    header_end = 8 + 9 + int.from_bytes(whole[9:17], "little")
    for at in range(header_end + 1):
        for tail in (b"", bytes(99)):
            file.write_bytes(whole[:at] + tail)
            removed = len(tail) + (at if at < header_end else 0)
            assert bag.check(tmp_path / "run") == [("run_0.mcap", True, 0, removed)]
            with bag.open(tmp_path / "run") as run:
                assert run.message_count == 0


def test_a_tail_of_zeros_is_cut_off(tmp_path: Path) -> None:
    """Some file systems leave zeros where a power cut interrupted them."""
    record(tmp_path / "run")
    file = tmp_path / "run" / "run_0.mcap"
    whole = file.read_bytes()
    for at in (len(whole) // 2, len(whole) - 30):
        file.write_bytes(whole[:at] + bytes(9000))
        (found,) = bag.check(tmp_path / "run")
        assert found.repaired
        assert found.removed_bytes >= 9000
        assert numbers(tmp_path / "run") == list(range(found.messages // 2))


def test_a_bag_without_metadata_gets_new_ones(tmp_path: Path) -> None:
    """rosbag2 writes the metadata only at the end."""
    record(tmp_path / "run")
    (tmp_path / "run" / "metadata.yaml").unlink()
    with pytest.raises(BagError, match="aionode bag reindex"):
        bag.open(tmp_path / "run")
    (found,) = bag.check(tmp_path / "run")
    assert not found.repaired
    assert numbers(tmp_path / "run") == [0, 1, 2]


@pytest.mark.parametrize("what", ["cut", "removed", "reindexed"])
def test_what_was_recorded_and_is_gone_stays_known(what: str, tmp_path: Path) -> None:
    """A repair writes new metadata, and their counts would make a part of a bag a whole one."""
    record(tmp_path / "run")
    file = tmp_path / "run" / "run_0.mcap"
    if what == "removed":
        record(tmp_path / "other", first_s=9, count=1)
        (tmp_path / "other" / "other_0.mcap").rename(tmp_path / "run" / "run_1.mcap")
        file.unlink()
    else:
        with file.open("rb") as stream:
            summary = make_reader(stream).get_summary()
        assert summary is not None
        file.write_bytes(file.read_bytes()[: summary.chunk_indexes[1].chunk_start_offset])
        bag.check(file)
    repair = bag.reindex if what == "reindexed" else bag.check
    for _ in range(2):
        repair(tmp_path / "run")
        with bag.open(tmp_path / "run") as run:
            lacks = 3 - run.counts["/numbers"]
            assert run.missing == {"/numbers": lacks, "/words": lacks}
    bag.convert([tmp_path / "run"], tmp_path / "copy")
    with bag.open(tmp_path / "copy") as copied:
        assert copied.missing == {"/numbers": lacks, "/words": lacks}


def test_an_intact_bag_is_left_unchanged(tmp_path: Path) -> None:
    """Checking an intact bag changes nothing."""
    record(tmp_path / "run")
    before = {file: file.read_bytes() for file in (tmp_path / "run").iterdir()}
    (found,) = bag.check(tmp_path / "run")
    assert found == ("run_0.mcap", False, 6, 0)
    assert before == {file: file.read_bytes() for file in (tmp_path / "run").iterdir()}


def test_a_file_that_is_no_mcap_file_is_refused(tmp_path: Path) -> None:
    """There is nothing to recover, and nothing may be destroyed."""
    file = tmp_path / "x.mcap"
    file.write_bytes(b"hello, world")
    with pytest.raises(BagError, match="nothing can be recovered"):
        bag.check(file)
    assert file.read_bytes() == b"hello, world"


def test_a_piece_is_cut_out_of_a_bag(tmp_path: Path) -> None:
    """Without the YAML file that rosbag2 requires."""
    record(tmp_path / "run")
    start, end = Duration(seconds=1), Duration(seconds=2)
    count = bag.cut(tmp_path / "run", tmp_path / "piece", start=start, end=end, topics=["/words"])
    assert count == 1
    with bag.open(tmp_path / "piece") as piece:
        assert [(r.topic, r.message.data) for r in piece.read()] == [("/words", "1")]


def test_bags_are_merged_in_order_of_time(tmp_path: Path) -> None:
    """Two computers of one robot may record at the same time."""
    record(tmp_path / "one", topic="/one")
    record(tmp_path / "two", topic="/two", first_s=2)
    assert bag.merge([tmp_path / "two", tmp_path / "one"], tmp_path / "both") == 12
    with bag.open(tmp_path / "both") as both:
        times = [each.time_ns for each in both.read()]
        assert times == sorted(times)
        assert both.counts == {"/one": 3, "/two": 3, "/numbers": 6}


def test_a_bag_is_converted_to_another_compression(tmp_path: Path) -> None:
    """The records are the same, byte by byte."""
    record(tmp_path / "run")
    wanted = bag.Selection(topics=["/numbers"])
    bag.convert([tmp_path / "run"], tmp_path / "plain", selection=wanted, compression="none")
    assert numbers(tmp_path / "plain") == [0, 1, 2]


def test_what_did_not_fit_does_not_take_the_space_of_the_metadata(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The space reserved for summary and metadata on a full disk is used for nothing else."""
    writes = mcap_writer.write_all
    full = [True]

    def write_all(fd: int, pieces: Sequence[bytes]) -> None:
        if full.pop() if full else False:
            raise OSError(errno.ENOSPC, "no space")
        writes(fd, pieces)

    out = bag.BagWriter(tmp_path / "run")
    out.write_message("/words", String(data="x"), Time(seconds=1))
    monkeypatch.setattr(mcap_writer, "write_all", write_all)
    for end in (out.flush, out.close):
        with pytest.raises(BagWriteError, match="free some space"):
            end()
    with bag.open(tmp_path / "run") as run:
        assert (run.message_count, run.metadata["message_count"]) == (0, 0)
