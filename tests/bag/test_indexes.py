"""Wrong or missing summaries and indexes never cost a message."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import pytest
import yaml
from mcap.opcode import Opcode
from mcap.writer import CompressionType, IndexType, Writer

from aionode import bag
from aionode.bag.files.chunks import HEAD
from aionode.cli import main
from aionode.clock import Duration, Time
from aionode.engine.wire import cdr
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import local_context, settle

STEP_NS = 1_000_000
TEXTS = ["a", "b", "c", "d"]


def write(file: Path, *, first_ns: int = 0, other: bool = False, **options: Any) -> None:
    """Write an MCAP file with four texts, the first at a time, each in a chunk of its own."""
    with file.open("wb") as stream:
        out = Writer(stream, chunk_size=1, **options)
        out.start("ros2", "a test")
        kind = out.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
        numbers = [out.register_channel("/words", "cdr", kind)]
        numbers.append(out.register_channel("/more", "cdr", kind) if other else numbers[0])
        for at, text in enumerate(TEXTS):
            time_ns = first_ns + at * STEP_NS
            raw = bytes(cdr.encode(String(data=text)))
            out.add_message(numbers[at % 2], time_ns, raw, time_ns, at)
        out.finish()  # type: ignore[no-untyped-call]  # of the library


def patch(file: Path, kind: Opcode, at: int, value: int, *, which: int = 0) -> None:
    """Write a 64-bit number into a record of the summary, and remove its checksum."""
    data = bytearray(file.read_bytes())
    footer = len(data) - 8 - 20
    place = struct.unpack_from("<Q", data, footer)[0]
    while data[place] != kind or which:
        which -= data[place] == kind
        place += HEAD.size + HEAD.unpack_from(data, place)[1]
    struct.pack_into("<Q", data, place + HEAD.size + at, value)
    struct.pack_into("<I", data, footer + 16, 0)
    file.write_bytes(data)


START_IN_STATISTICS = 8 + 2 + 4 + 4 + 4 + 4
START_IN_CHUNK_INDEX, END_IN_CHUNK_INDEX = 0, 8


def make_folder(folder: Path, start_ns: int) -> None:
    """Turn a file's folder into a bag whose metadata gives its start."""
    content = {
        "version": 5,
        "storage_identifier": "mcap",
        "relative_file_paths": ["run_0.mcap"],
        "starting_time": {"nanoseconds_since_epoch": start_ns},
        "duration": {"nanoseconds": 3 * STEP_NS},
        "message_count": 4,
        "topics_with_message_count": [],
    }
    text = yaml.safe_dump({"rosbag2_bagfile_information": content})
    (folder / "metadata.yaml").write_text(text)


def texts(path: Path, **limits: Any) -> list[str]:
    """Return the texts that are read from a bag."""
    with bag.open(path) as run:
        return [record.message.data for record in run.read(**limits)]


async def played(path: Path, **options: Any) -> list[str]:
    """Return the texts that a player publishes."""
    heard: list[str] = []
    async with local_context() as context, bag.Player(path, context=context, **options) as player:
        for topic in ("/words", "/more"):
            player.node.create_subscription(
                String, topic, lambda message: heard.append(message.data), 10
            )
        await settle()
        await player.play()
        await settle()
    return heard


def leave_out_the_first(file: Path, how: str) -> None:
    """Rewrite a file's summary so that it leaves out the message at time 0."""
    write(file, use_chunking=how != "no chunks")
    patch(file, Opcode.STATISTICS, START_IN_STATISTICS, STEP_NS)
    if how == "chunk index":
        patch(file, Opcode.CHUNK_INDEX, START_IN_CHUNK_INDEX, STEP_NS)
        patch(file, Opcode.CHUNK_INDEX, END_IN_CHUNK_INDEX, STEP_NS)


@pytest.mark.parametrize("how", ["statistics", "chunk index", "no chunks"])
async def test_a_message_that_the_summary_leaves_out_is_played(how: str, tmp_path: Path) -> None:
    """Some versions of libmcap do not count time 0 in statistics, as files of rosbag2 show."""
    file = tmp_path / "run_0.mcap"
    leave_out_the_first(file, how)
    assert texts(file) == TEXTS
    assert texts(file, start=Duration()) == TEXTS
    assert await played(file) == TEXTS
    make_folder(tmp_path, 0)
    with bag.open(tmp_path) as run:
        assert (run.start_ns, run.end_ns) == (0, 3 * STEP_NS)
    assert await played(tmp_path) == TEXTS
    assert await played(tmp_path, start_offset=Duration(nanoseconds=STEP_NS)) == TEXTS[1:]
    assert bag.convert([tmp_path], tmp_path / "new") == 4
    with bag.open(tmp_path / "new") as run:
        assert run.start_ns == 0


def test_a_start_in_the_metadata_at_which_nothing_is_does_not_count(tmp_path: Path) -> None:
    """A player would wait for years."""
    write(tmp_path / "run_0.mcap", first_ns=10**18)
    make_folder(tmp_path, 0)
    with bag.open(tmp_path) as run:
        assert run.start_ns == 10**18


@pytest.mark.parametrize(
    "options",
    [
        {"use_statistics": False},
        {"use_statistics": False, "use_chunking": False},
        {"index_types": IndexType.NONE},
        {"index_types": IndexType.NONE, "compression": CompressionType.NONE},
        {"repeat_channels": False, "repeat_schemas": False},
        {
            "repeat_channels": False,
            "repeat_schemas": False,
            "use_statistics": False,
            "index_types": IndexType.NONE,
            "use_summary_offsets": False,
        },
    ],
)
async def test_what_a_summary_lacks_is_found_in_the_file(options: Any, tmp_path: Path) -> None:
    """rosbag2 has options to leave out each part, which is not damage."""
    file = tmp_path / "run_0.mcap"
    write(file, first_ns=STEP_NS, other=True, **options)
    with bag.open(file) as run:
        assert run.counts == {"/words": 2, "/more": 2}
        assert (run.start_ns, run.end_ns) == (STEP_NS, 4 * STEP_NS)
    assert texts(file) == TEXTS
    assert texts(file, topics="/more") == ["b", "d"]
    assert texts(file, start=Time(nanoseconds=3 * STEP_NS)) == ["c", "d"]
    assert sorted(await played(file)) == TEXTS
    assert [found.repaired for found in bag.check(file)] == [False]


def test_check_repairs_the_index_of_a_chunk_that_leaves_out_messages(tmp_path: Path) -> None:
    """A reader of a part of the recording relies on the index."""
    file = tmp_path / "run_0.mcap"
    write(file)
    patch(file, Opcode.CHUNK_INDEX, START_IN_CHUNK_INDEX, 90 * STEP_NS, which=2)
    patch(file, Opcode.CHUNK_INDEX, END_IN_CHUNK_INDEX, 90 * STEP_NS, which=2)
    assert sorted(texts(file)) == TEXTS
    assert main(["bag", "check", str(file)]) == 0
    assert texts(file, end=Time(nanoseconds=3 * STEP_NS)) == ["a", "b", "c"]
    assert [found.repaired for found in bag.check(file)] == [False]
