"""Defaults of a type's fields are as they were recorded, never zeros, however a bag is handled."""

from __future__ import annotations

import asyncio
import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest

import rosbag2_py
from aionode import Node, bag
from aionode.clock import Duration
from aionode.engine.wire.described_type import type_from_description
from aionode.engine.wire.typehash import description_message
from aionode.idl import define
from aionode.testing import local_context, settle
from tests.bag.test_rosbag2_files import make_sqlite3

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

NAME = "defaults_in_bags/msg/Gains"
TEXT = """\
float64 tolerance 0.05
float32 f 0.5
int8 low -5
uint64 big 18446744073709551615
bool on true
string mode "auto, 'n"
wstring wide "w"
int32[3] steps [1, 2, 3]
bool[] flags [true, false]
string[<=4] names ["a", "it's"]
Part part
"""
PART = 'float64 weight 2.5\nstring unit "kg"\n'
GAINS: Any = define(NAME, TEXT, uses={"defaults_in_bags/msg/Part": PART})
DESCRIBED: Any = type_from_description(description_message(GAINS))
EXPECTED = repr(GAINS())


async def record(path: Path, kind: Any) -> None:
    """Record a message of defaults."""
    async with local_context() as context, Node("talker", context=context) as node:
        publisher = node.create_publisher(kind, "/gains", 10)
        async with bag.Recorder(path, topics=["/gains"], context=context):
            await settle()
            publisher.publish(kind())
            await settle()


def defaults_in(path: Path) -> str:
    """Return a default message of a type that only the bag defines."""
    with bag.open(path) as run:
        return repr(run.topics["/gains"].msg_type())


def converted(path: Path, out: Path) -> None:
    """Convert a bag."""
    bag.convert([path], out)


def cut(path: Path, out: Path) -> None:
    """Copy a piece of a bag."""
    bag.convert([path], out, start=Duration(), end=Duration(seconds=1))


def edited(path: Path, out: Path) -> None:
    """Rewrite a bag, with each message replaced by one that sets no field."""
    with bag.open(path) as run, bag.BagWriter(out) as writer:
        for each in run.read():
            writer.write_message(each.topic, type(each.message)(), each.time)


def converted_by_rosbag2_py(path: Path, out: Path) -> None:
    """Convert a bag as a program for `rosbag2_py` does."""
    reader, writer = rosbag2_py.SequentialReader(), rosbag2_py.SequentialWriter()
    reader.open_uri(str(path))
    writer.open(rosbag2_py.StorageOptions(uri=str(out)), rosbag2_py.ConverterOptions())
    (definition,) = reader.get_all_message_definitions()
    (topic,) = reader.get_all_topics_and_types()
    writer.create_topic(topic, definition)
    while reader.has_next():
        writer.write(*reader.read_next())
    writer.close()


@pytest.mark.parametrize("kind", [GAINS, DESCRIBED], ids=["own class", "description"])
@pytest.mark.parametrize("change", [converted, cut, edited, converted_by_rosbag2_py])
async def test_a_bag_keeps_the_defaults_of_its_types(
    kind: Any, change: Callable[[Path, Path], None], tmp_path: Path
) -> None:
    """A field that is left out has the default of the robot that was recorded."""
    await record(tmp_path / "run", kind)
    assert defaults_in(tmp_path / "run") == EXPECTED
    await asyncio.to_thread(change, tmp_path / "run", tmp_path / "new")
    assert defaults_in(tmp_path / "new") == EXPECTED
    with bag.open(tmp_path / "new") as run:
        assert [repr(each.message) for each in run.read()] == [EXPECTED]


async def test_a_player_describes_the_defaults_and_a_recorder_keeps_them(tmp_path: Path) -> None:
    """For `topic pub` while a recording is played, and for a recording of that."""
    await record(tmp_path / "run", GAINS)
    async with (
        local_context() as context,
        Node("ear", context=context) as node,
        bag.Player(tmp_path / "run", context=context) as player,
    ):
        found = await node.find_type(NAME)
        assert found is not GAINS
        assert repr(found()) == EXPECTED
        async with bag.Recorder(tmp_path / "again", topics=["/gains"], context=context):
            await settle()
            await player.play()
            await settle()
    assert defaults_in(tmp_path / "again") == EXPECTED


def test_defaults_in_a_database_are_read(tmp_path: Path) -> None:
    """As rosbag2 writes them into the files of its other storage."""
    make_sqlite3(tmp_path / "run", 4, 9)
    definition = f"{TEXT}{'=' * 80}\nMSG: defaults_in_bags/Part\n{PART}"
    file = tmp_path / "run" / "run_0.db3"
    with closing(sqlite3.connect(file)) as base, base:
        base.execute("UPDATE topics SET name = '/gains', type = ?", (NAME,))
        base.execute(
            "UPDATE message_definitions SET topic_type = ?, encoded_message_definition = ?",
            (NAME, definition),
        )
    assert defaults_in(file) == EXPECTED
