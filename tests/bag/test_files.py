"""Bag files are exchanged with other libraries in both directions."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

import pytest
import yaml
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from mcap.reader import NonSeekingReader, make_reader
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.bag.files.mcap_writer import LARGE_BYTES
from aionode.clock import Duration, Time
from aionode.engine.wire import cdr
from aionode.engine.wire.typehash import type_hash
from aionode.errors import BagError, InterfaceNotFoundError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
Row = tuple[str, int, int, int, bytes]


def write(path: Path, rows: list[Row], **options: Any) -> None:
    """Write rows of topic, time, publish time, sequence and bytes."""
    with bag.BagWriter(path, **options) as out:
        for topic, time_ns, publish_ns, sequence, raw in rows:
            number = out.add_topic(topic_info(topic, String, [LATCHED]))
            out.write(number, time_ns, raw, publish_time_ns=publish_ns, sequence=sequence)


def words(*texts: str) -> list[Row]:
    """Return rows of one topic, a second apart."""
    return [
        ("/words", 10**9 * (at + 1), 10**9 * (at + 1) - 5, at, cdr.encode(String(data=text)))
        for at, text in enumerate(texts)
    ]


def texts(path: Path, **limits: Any) -> list[str]:
    """Return the texts of a bag of strings."""
    with bag.open(path) as run:
        return [record.message.data for record in run.read(**limits)]


rows = st.lists(
    st.tuples(
        st.sampled_from(["/a", "/b", "/c"]),
        st.one_of(st.integers(0, 2), st.integers(0, 2**62)),
        st.integers(0, 2**62),
        st.integers(0, 2**32 - 1),
        st.one_of(
            st.binary(min_size=1, max_size=200),
            st.integers(LARGE_BYTES - 2, LARGE_BYTES + 2).map(bytes),
        ),
    ),
    max_size=30,
)


@settings(
    max_examples=settings().max_examples * 3 // 4,
    phases=(Phase.explicit, Phase.reuse, Phase.generate),  # files are too slow to look for less
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(rows=rows, compression=st.sampled_from(["zstd", "lz4", "none"]), split=st.integers(0, 7))
def test_all_readers_get_the_messages_that_were_written(
    rows: list[Row], compression: str, split: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Foxglove and other programs read bag files with their own libraries.

    We yield messages by time, and those of one time as they were written, across chunks and files.
    """
    path = tmp_path_factory.mktemp("bags") / "run"
    write(path, rows, compression=compression, max_messages=split)
    with bag.open(path) as run:
        ours = [(r.topic, r.time_ns, r.publish_time_ns, r.sequence, r.raw) for r in run.read()]
        assert run.message_count == len(rows)
    assert ours == sorted(rows, key=lambda row: row[1])
    theirs: list[Row] = []
    for file in sorted(path.glob("*.mcap")):
        with file.open("rb") as stream:
            theirs += [
                (c.topic, m.log_time, m.publish_time, m.sequence, m.data)
                for _, c, m in make_reader(stream, validate_crcs=True).iter_messages()
            ]
    assert sorted(theirs) == sorted(rows)
    with AnyReader([path]) as reader:
        raw = [(c.topic, at, data) for c, at, data in reader.messages()]
    assert sorted(raw) == sorted((topic, at, data) for topic, at, _, _, data in rows)


def test_a_bag_says_what_rosbag2_says_of_types_and_qos(tmp_path: Path) -> None:
    """ROS 2 tools decode with the schema, and play with the recorded QoS."""
    write(tmp_path / "run", words("hello"), custom_data={"robot": "r2"})
    with (tmp_path / "run" / "run_0.mcap").open("rb") as stream:
        reader = make_reader(stream)
        schema, channel, _ = next(iter(reader.iter_messages()))
        summary = reader.get_summary()
        assert summary is not None
        assert schema is not None
        assert reader.get_header().profile == "ros2"
        assert [entry.name for entry in summary.metadata_indexes] == ["rosbag2"]
    assert (schema.name, schema.encoding, schema.data) == (
        "std_msgs/msg/String",
        "ros2msg",
        b"string data\n",
    )
    assert channel.metadata["topic_type_hash"] == type_hash(String)
    qos = yaml.safe_load(channel.metadata["offered_qos_profiles"])
    assert qos[0]["durability"] == "transient_local"
    assert qos[0]["lifespan"] == {"sec": 9223372036, "nsec": 854775807}
    metadata = yaml.safe_load((tmp_path / "run" / "metadata.yaml").read_text())
    content = metadata["rosbag2_bagfile_information"]
    assert content["version"] == 9
    assert content["custom_data"] == {"robot": "r2"}
    assert content["files"][0]["message_count"] == content["message_count"] == 1
    with bag.open(tmp_path / "run") as run:
        assert run.topics["/words"].qos == (LATCHED.resolved(),)
        assert run.custom_data == {"robot": "r2"}


def test_a_definition_names_every_type_that_it_uses(tmp_path: Path) -> None:
    """The decoders of `mcap` and rosbags know only the types in the schema."""
    with bag.BagWriter(tmp_path / "run") as out:
        out.write_message("/imu", Imu(), Time(seconds=1))
    store = get_typestore(Stores.EMPTY)
    with AnyReader([tmp_path / "run"], default_typestore=store) as reader:
        ((connection, _, raw),) = reader.messages()
        imu: Any = reader.deserialize(raw, connection.msgtype)
        assert imu.header.stamp.sec == 0


def test_start_and_end_and_duration_are_those_of_the_messages(tmp_path: Path) -> None:
    """A bag's times are those of its messages, however it is split into files."""
    write(tmp_path / "run", words("a", "b", "c"), max_messages=2)
    with bag.open(tmp_path / "run") as run:
        assert (run.start, run.end) == (
            Time(seconds=1, clock_type=run.start.clock_type),
            Time(seconds=3, clock_type=run.end.clock_type),
        )
        assert run.duration == Duration(seconds=2)
        assert run.counts == {"/words": 3}


def test_a_piece_of_a_bag_begins_at_its_start_and_ends_before_its_end(tmp_path: Path) -> None:
    """Half-open ranges can be joined again, as in mcap and rosbags."""
    write(tmp_path / "run", words("a", "b", "c"))
    assert texts(tmp_path / "run", start=Duration(seconds=1)) == ["b", "c"]
    with bag.open(tmp_path / "run") as run:
        assert [r.message.data for r in run.read(end=run.end)] == ["a", "b"]


async def test_records_are_read_in_a_thread_by_async_for(tmp_path: Path) -> None:
    """Decompression takes milliseconds, too long for the event loop."""
    write(tmp_path / "run", words("a", "b", "c"))
    with bag.open(tmp_path / "run") as run:
        assert [r.message.data async for r in run.read("/words")] == ["a", "b", "c"]


def test_a_topic_that_is_not_there_is_named_with_those_that_are(tmp_path: Path) -> None:
    """Otherwise a misspelled topic would look like a robot that published nothing."""
    write(tmp_path / "run", words("a"))
    with bag.open(tmp_path / "run") as run, pytest.raises(BagError, match=r"/word; .*: /words"):
        run.read(topics=["/word"])


def test_a_type_unknown_here_is_made_of_the_definition_in_the_bag(tmp_path: Path) -> None:
    """A bag contains the definitions of a robot's own types, so they need no installation."""
    topic = bag.TopicInfo(
        name="/words",
        type="robot_msgs/msg/Words",
        encoding="ros2msg",
        definition=f"Part[] parts\n{'=' * 80}\nMSG: robot_msgs/Part\nstring text\nint8 weight 3\n",
    )
    with bag.BagWriter(tmp_path / "run") as out:
        part = cdr.encode(String(data="hello"))
        raw = part[:4] + b"\x01\0\0\0" + part[4:] + b"\x07"
        out.write(out.add_topic(topic), 1, raw)
    with bag.open(tmp_path / "run") as run:
        (record,) = run.read()
        assert (record.message.parts[0].text, record.message.parts[0].weight) == ("hello", 7)


def test_a_type_whose_definition_has_changed_is_decoded_as_it_was_recorded(tmp_path: Path) -> None:
    """Decoding an old bag with the program's new type would yield nonsense."""
    topic = bag.TopicInfo(
        name="/words", type="std_msgs/msg/String", encoding="ros2msg", definition="int32 number\n"
    )
    with bag.BagWriter(tmp_path / "run") as out:
        out.write(out.add_topic(topic), 1, b"\0\1\0\0\5\0\0\0")
    with bag.open(tmp_path / "run") as run:
        (record,) = run.read()
        assert record.message.number == 5


def test_a_type_that_nobody_defines_can_be_read_as_bytes(tmp_path: Path) -> None:
    """Such a topic can still be played, cut out and copied."""
    with bag.BagWriter(tmp_path / "run") as out:
        out.write(out.add_topic(bag.TopicInfo(name="/x", type="robot_msgs/msg/X")), 1, b"\0\1\0\0")
    with bag.open(tmp_path / "run") as run:
        (record,) = run.read()
        assert record.raw == b"\0\1\0\0"
        with pytest.raises(InterfaceNotFoundError, match="robot_msgs/msg/X"):
            _ = record.message


def test_a_service_event_is_decoded_by_its_service(tmp_path: Path) -> None:
    """Services are recorded by their events, whose types are hidden."""
    event = AddTwoInts.Event(request=[AddTwoInts.Request(a=2)])
    with bag.BagWriter(tmp_path / "run") as out:
        out.write_message("/add/_service_event", event, Time(seconds=1))
    with bag.open(tmp_path / "run") as run:
        (record,) = run.read()
        assert record.type == "example_interfaces/srv/AddTwoInts_Event"
        assert record.message.request[0].a == 2


def test_each_file_of_a_split_bag_begins_with_the_latched_messages(tmp_path: Path) -> None:
    """Without the map and the static transforms, a single file is useless."""
    with bag.BagWriter(tmp_path / "run", max_messages=3) as out:
        latched = out.add_topic(topic_info("/map", String), latched_depth=1)
        other = out.add_topic(topic_info("/x", String))
        out.write(latched, 1, cdr.encode(String(data="map")))
        for at in range(2, 6):
            out.write(other, at, cdr.encode(String(data=str(at))))
    assert texts(tmp_path / "run" / "run_1.mcap") == ["map", "4", "5"]


def test_only_the_newest_files_are_kept_if_there_is_a_limit(tmp_path: Path) -> None:
    """A robot that records all day has a disk of limited size."""
    write(tmp_path / "run", words(*"abcdef"), max_messages=2, max_files=2)
    assert texts(tmp_path / "run") == ["c", "d", "e", "f"]
    assert len(list((tmp_path / "run").glob("*.mcap"))) == 2


@pytest.mark.parametrize("storage", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
@pytest.mark.parametrize("mode", [CompressionMode.NONE, CompressionMode.FILE])
@pytest.mark.parametrize("version", [8, 9])
def test_bags_of_rosbags_are_read(
    storage: StoragePlugin, mode: CompressionMode, version: Literal[8, 9], tmp_path: Path
) -> None:
    """Users have such bags from their robots, plain and compressed."""
    store = get_typestore(Stores.ROS2_JAZZY)
    writer = Writer(tmp_path / "old", version=version, storage_plugin=storage)
    if mode is not CompressionMode.NONE:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer as out:
        topic = out.add_connection("/words", "std_msgs/msg/String", typestore=store)
        for row in words("a", "b"):
            out.write(topic, row[1], row[4])
    assert texts(tmp_path / "old") == ["a", "b"]
    with bag.open(tmp_path / "old") as run:
        assert run.counts == {"/words": 2}


def test_a_file_that_is_not_closed_is_an_error_that_names_the_remedy(tmp_path: Path) -> None:
    """A power cut leaves files like this."""
    write(tmp_path / "run", words("a"))
    file = tmp_path / "run" / "run_0.mcap"
    file.write_bytes(file.read_bytes()[:-40])
    with pytest.raises(BagError, match="aionode bag check"):
        bag.open(tmp_path / "run")
    with file.open("rb") as stream, pytest.raises(Exception):  # noqa: B017, PT011  # whichever it is
        list(NonSeekingReader(stream).iter_messages())


def test_an_output_folder_that_exists_is_refused(tmp_path: Path) -> None:
    """A recording never overwrites another one."""
    with pytest.raises(BagError, match="already exists"):
        bag.BagWriter(tmp_path)


def test_reliability_of_old_bags_is_read_from_numbers() -> None:
    """Bags before version 9 have numbers, and Foxy's infinite times."""
    from aionode.bag.files.qos import profiles_from

    text = (
        "- history: 1\n  depth: 5\n  reliability: 2\n  durability: 2\n"
        "  deadline: {sec: 2147483647, nsec: 4294967295}\n"
    )
    (qos,) = profiles_from(text)
    assert (qos.reliability, qos.depth) == (ReliabilityPolicy.BEST_EFFORT, 5)
