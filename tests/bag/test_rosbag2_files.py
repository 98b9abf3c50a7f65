"""Files laid out as rosbag2's own storage plugins do, in each version, are read and played.

The tables are those of rosbag2, and the records those of its MCAP plugin.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import yaml
from mcap.writer import CompressionType, IndexType
from mcap.writer import Writer as McapLibraryWriter

from aionode import bag
from aionode.engine.wire import cdr
from aionode.engine.wire.typehash import type_hash
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy
from aionode.testing import local_context, settle

TYPE = "std_msgs/msg/String"
TEXTS = ["a", "b", "c"]
START_NS = 1_700_000_000_000_000_000
STEP_NS = 10**6
FOREVER = {"sec": 9223372036, "nsec": 854775807}
QOS: dict[str, Any] = {
    "history": 1,
    "depth": 4,
    "reliability": 1,
    "durability": 1,
    "deadline": FOREVER,
    "lifespan": FOREVER,
    "liveliness": 1,
    "liveliness_lease_duration": FOREVER,
    "avoid_ros_namespace_conventions": False,
}
NUMBERS = yaml.safe_dump([QOS], sort_keys=False)
NAMES = [
    QOS
    | {
        "history": "keep_last",
        "reliability": "reliable",
        "durability": "transient_local",
        "liveliness": "automatic",
    }
]


def metadata(version: int, storage: str, file: str) -> str:
    """Return ``metadata.yaml`` as a given version of rosbag2 writes it."""
    span = {
        "starting_time": {"nanoseconds_since_epoch": START_NS},
        "duration": {"nanoseconds": STEP_NS * (len(TEXTS) - 1)},
        "message_count": len(TEXTS),
    }
    topic: dict[str, Any] = {"name": "/words", "type": TYPE, "serialization_format": "cdr"}
    if version >= 4:
        topic["offered_qos_profiles"] = NAMES if version >= 9 else NUMBERS
    if version >= 7:
        topic["type_description_hash"] = type_hash(String)
    content = {
        "version": version,
        "storage_identifier": storage,
        "relative_file_paths": [file],
        **span,
        "topics_with_message_count": [{"topic_metadata": topic, "message_count": len(TEXTS)}],
    }
    if version >= 3:
        content |= {"compression_format": "", "compression_mode": ""}
    if version >= 5:
        content["files"] = [{"path": file, **span}]
    if version >= 6:
        content["custom_data"] = {}
    if version >= 8:
        content["ros_distro"] = "jazzy"
    return yaml.safe_dump({"rosbag2_bagfile_information": content}, sort_keys=False)


def make_sqlite3(folder: Path, schema: int, version: int) -> None:
    """Write a bag with one of the schemas of rosbag2_storage_sqlite3."""
    folder.mkdir()
    file = f"{folder.name}_0.db3"
    (folder / "metadata.yaml").write_text(metadata(version, "sqlite3", file))
    topic: dict[str, Any] = {"id": 1, "name": "/words", "type": TYPE, "serialization_format": "cdr"}
    if schema >= 2:
        topic["offered_qos_profiles"] = NUMBERS
    if schema >= 4:
        topic["type_description_hash"] = type_hash(String)
    kinds = {key: "INTEGER PRIMARY KEY" if key == "id" else "TEXT NOT NULL" for key in topic}
    columns = ", ".join(f"{name} {kind}" for name, kind in kinds.items())
    with closing(sqlite3.connect(folder / file)) as base, base:
        if schema >= 3:
            base.execute("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT)")
            base.execute("INSERT INTO schema VALUES (?, 'jazzy')", (schema,))
            base.execute(
                "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, "
                "metadata TEXT NOT NULL)"
            )
            text = metadata(version, "sqlite3", file)
            base.execute("INSERT INTO metadata VALUES (1, ?, ?)", (version, text))
        base.execute(f"CREATE TABLE topics({columns})")
        marks = ", ".join("?" * len(topic))
        base.execute(f"INSERT INTO topics VALUES ({marks})", list(topic.values()))  # noqa: S608  # of marks
        if schema >= 4:
            base.execute(
                "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,"
                " encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL, "
                "type_description_hash TEXT NOT NULL)"
            )
            base.execute(
                "INSERT INTO message_definitions VALUES (1, ?, 'ros2msg', 'string data\n', ?)",
                (TYPE, type_hash(String)),
            )
        base.execute(
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
            "timestamp INTEGER NOT NULL, data BLOB NOT NULL)"
        )
        base.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
        for at, text in enumerate(TEXTS):
            raw = cdr.encode(String(data=text))
            base.execute(
                "INSERT INTO messages(topic_id, timestamp, data) VALUES (1, ?, ?)",
                (START_NS + at * STEP_NS, bytes(raw)),
            )


def make_mcap(folder: Path, **options: Any) -> None:
    """Write a bag as rosbag2_storage_mcap does: metadata at both ends, and hashes and QoS."""
    folder.mkdir()
    file = f"{folder.name}_0.mcap"
    (folder / "metadata.yaml").write_text(metadata(9, "mcap", file))
    with (folder / file).open("wb") as stream:
        out = McapLibraryWriter(stream, chunk_size=768 << 10, enable_data_crcs=False, **options)
        out.start("ros2", "libmcap 1.3.0")
        text = metadata(9, "mcap", file)
        out.add_metadata("rosbag2", {"serialized_metadata": text})
        schema = out.register_schema(TYPE, "ros2msg", b"string data\n")
        qos = {"offered_qos_profiles": NUMBERS, "topic_type_hash": type_hash(String)}
        channel = out.register_channel("/words", "cdr", schema, metadata=qos)
        for at, each in enumerate(TEXTS):
            time_ns = START_NS + at * STEP_NS
            raw = bytes(cdr.encode(String(data=each)))
            out.add_message(channel, time_ns, raw, time_ns - 1, sequence=at)
        out.add_metadata("rosbag2", {"serialized_metadata": text})
        out.finish()  # type: ignore[no-untyped-call]  # of the library


async def play(folder: Path) -> list[str]:
    """Play a bag, and return what a node receives."""
    heard: list[str] = []
    async with local_context() as context, Node("ear", context=context) as node:
        node.create_subscription(String, "/words", lambda msg: heard.append(msg.data), 10)
        async with bag.Player(folder, context=context) as player:
            await settle()
            assert await player.play()
        await settle()
    return heard


@pytest.mark.parametrize(("schema", "version"), [(1, 3), (2, 4), (3, 5), (3, 6), (4, 7), (4, 9)])
async def test_sqlite3_of_every_version_of_rosbag2_is_played(
    schema: int, version: int, tmp_path: Path
) -> None:
    """Old bags of robots are still used in tests."""
    make_sqlite3(tmp_path / "old", schema, version)
    assert await play(tmp_path / "old") == TEXTS
    with bag.open(tmp_path / "old") as run:
        assert (run.start_ns, run.counts) == (START_NS, {"/words": 3})
        assert [record.message.data for record in run.read("/words")] == TEXTS
        qos = run.topics["/words"].qos
        assert bool(qos) == (version >= 4)
        assert all(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in qos)


@pytest.mark.parametrize(
    "options",
    [
        {"compression": CompressionType.NONE},
        {"compression": CompressionType.ZSTD},
        {"use_chunking": False, "index_types": IndexType.NONE},
    ],
    ids=["default", "zstd_fast", "fastwrite"],
)
async def test_mcap_as_rosbag2_writes_it_is_played(options: Any, tmp_path: Path) -> None:
    """With its presets: `fastwrite` has no chunks, hence no index of messages."""
    make_mcap(tmp_path / "run", **options)
    assert await play(tmp_path / "run") == TEXTS
    with bag.open(tmp_path / "run") as run:
        (first, *_) = run.read()
        assert (first.time_ns, first.publish_time_ns) == (START_NS, START_NS - 1)
        assert run.topics["/words"].type_hash == type_hash(String)
    bag.convert([tmp_path / "run"], tmp_path / "new")
    assert await play(tmp_path / "new") == TEXTS
