"""`rosbag2_py`, as programs use it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosbag2_py
from aionode import bag
from aionode.engine.wire import cdr
from aionode.interfaces.std_msgs.msg import Float64, String

if TYPE_CHECKING:
    from pathlib import Path

CDR = rosbag2_py.ConverterOptions("cdr", "cdr")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A bag of two topics with three messages each, written as in ROS 2's tutorial."""
    writer = rosbag2_py.SequentialWriter()
    options = rosbag2_py.StorageOptions(uri=str(tmp_path / "run"), storage_id="mcap")
    writer.open(options, CDR)
    writer.create_topic(
        rosbag2_py.TopicMetadata(
            id=0, name="/words", type="std_msgs/msg/String", serialization_format="cdr"
        )
    )
    writer.create_topic(rosbag2_py.TopicMetadata("/numbers", "std_msgs/msg/Float64", "cdr"))
    for number in range(3):
        writer.write("/words", cdr.encode(String(data=str(number))), 10 * number)
        writer.write("/numbers", cdr.encode(Float64(data=float(number))), 10 * number + 5)
    writer.close()
    return tmp_path / "run"


def reader_of(path: Path) -> rosbag2_py.SequentialReader:
    """Return a reader of a bag."""
    reader = rosbag2_py.SequentialReader()
    reader.open(rosbag2_py.StorageOptions(uri=str(path), storage_id="mcap"), CDR)
    return reader


def rest(reader: rosbag2_py.SequentialReader) -> list[tuple[str, int]]:
    """Return the topics and times that a reader still has."""
    found = []
    while reader.has_next():
        topic, _, time_ns = reader.read_next()
        found.append((topic, time_ns))
    return found


def test_a_bag_is_read_as_in_the_tutorial(path: Path) -> None:
    """Topics and types first, then one message after another."""
    reader = reader_of(path)

    types = {topic.name: topic.type for topic in reader.get_all_topics_and_types()}
    topic, data, time_ns = reader.read_next()

    assert types == {"/words": "std_msgs/msg/String", "/numbers": "std_msgs/msg/Float64"}
    assert (topic, cdr.decode(String, data).data, time_ns) == ("/words", "0", 0)
    assert [time_ns for _, time_ns in rest(reader)] == [5, 10, 15, 20, 25]
    with pytest.raises(RuntimeError, match="Bag is at end"):
        reader.read_next()


def test_a_filter_and_a_time_choose_what_is_read(path: Path) -> None:
    """A filter applies to messages that were not read yet."""
    reader = reader_of(path)

    reader.read_next()
    reader.set_filter(rosbag2_py.StorageFilter(topics=["/words"]))
    assert rest(reader) == [("/words", 10), ("/words", 20)]
    reader.seek(15)
    assert rest(reader) == [("/words", 20)]
    reader.set_filter(rosbag2_py.StorageFilter(regex="/num.*", regex_to_exclude="x"))
    reader.seek(0)
    assert rest(reader) == [("/numbers", 5), ("/numbers", 15), ("/numbers", 25)]


def test_a_bag_is_read_in_reverse(path: Path) -> None:
    """The newest messages first."""
    reader = reader_of(path)

    assert reader.set_read_order(rosbag2_py.ReadOrder(reverse=True))
    assert [time_ns for _, time_ns in rest(reader)] == [25, 20, 15, 10, 5, 0]


def test_info_says_what_is_in_a_bag(path: Path) -> None:
    """With rclpy's times and durations."""
    metadata = rosbag2_py.Info().read_metadata(str(path), "mcap")

    assert metadata.message_count == 6
    assert metadata.starting_time.nanoseconds == 0
    assert metadata.duration.nanoseconds == 25
    assert metadata.storage_identifier == "mcap"
    counts = {
        each.topic_metadata.name: each.message_count for each in metadata.topics_with_message_count
    }
    assert counts == {"/words": 3, "/numbers": 3}


def test_types_are_defined_in_what_is_written(path: Path) -> None:
    """Other programs can read it without this program's types."""
    reader = reader_of(path)

    texts = {one.topic_type: one for one in reader.get_all_message_definitions()}

    assert texts["std_msgs/msg/String"].encoding == "ros2msg"
    assert "string data" in texts["std_msgs/msg/String"].encoded_message_definition
    with bag.open(path) as opened:
        assert [record.message.data for record in opened.read("/words")] == ["0", "1", "2"]


def test_what_is_no_bag_is_refused_as_by_rosbag2(tmp_path: Path) -> None:
    """Programs catch a RuntimeError."""
    with pytest.raises(RuntimeError, match="No storage could be initialized from the inputs"):
        reader_of(tmp_path / "nothing")
    with pytest.raises(RuntimeError, match="not open"):
        rosbag2_py.SequentialReader().has_next()


def test_a_topic_has_to_be_created_before_it_is_written(path: Path) -> None:
    """Its type would be unknown."""
    writer = rosbag2_py.SequentialWriter()
    writer.open(rosbag2_py.StorageOptions(uri=f"{path}2"), CDR)

    with pytest.raises(RuntimeError, match="before creating it"):
        writer.write("/x", b"", 0)
    with pytest.raises(RuntimeError, match="exists"):
        rosbag2_py.SequentialWriter().open(rosbag2_py.StorageOptions(uri=f"{path}2"), CDR)
    writer.close()


def test_the_definition_of_a_type_is_found_by_its_name() -> None:
    """For a bag that a program writes; an unknown type has no text."""
    source = rosbag2_py.LocalMessageDefinitionSource()

    found = source.get_full_text("geometry_msgs/msg/Point")
    assert (found.topic_type, found.encoding) == ("geometry_msgs/msg/Point", "ros2msg")
    assert "float64 x" in found.encoded_message_definition
    unknown = source.get_full_text("nothing/msg/Nothing")
    assert (unknown.encoding, unknown.encoded_message_definition) == ("unknown", "")
