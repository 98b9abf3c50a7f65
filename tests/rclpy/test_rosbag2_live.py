"""`rosbag2_py.Recorder`, `Player` and `Reindexer`, as programs use them."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

import rosbag2_py
from aionode import Context, Node, bag
from aionode.clock import Time
from aionode.interfaces.std_msgs.msg import String
from aionode.logging import LoggingSeverity, get_logger_level
from rosbag2_py._live import LiveThread
from tests.support.peers import isolated_environment, quiet_node
from tests.support.waiting import until

pytestmark = pytest.mark.one_loop


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Isolated from everything else on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)


@pytest.fixture
async def node(alone: None) -> AsyncIterator[Node]:
    """A node of aionode, in the loop of the test."""
    async with Context() as context, quiet_node("robot", context) as node:
        yield node


def options_of(path: Path) -> rosbag2_py.StorageOptions:
    """Return the options for the place of a bag."""
    return rosbag2_py.StorageOptions(uri=str(path), storage_id="mcap")


def write(path: Path, count: int, step_ns: int = 10**6) -> None:
    """Write numbered texts."""
    with bag.BagWriter(path) as out:
        for number in range(count):
            text = String(data=str(number))
            out.write_message("/words", text, Time(nanoseconds=1 + number * step_ns))


def recorded() -> bool:
    """Whether a recorder of this process has got a text."""
    stats = [thread.entity.stats for thread in LiveThread.running if thread.entity is not None]
    return any("/words" in each and each["/words"].recorded for each in stats)


async def test_a_recorder_records_in_its_thread_until_it_is_stopped(
    node: Node, tmp_path: Path
) -> None:
    """The program continues meanwhile, which rosbag2's first recorder did not allow."""
    words = node.create_publisher(String, "words", 10)
    record = rosbag2_py.RecordOptions()
    record.topics = ["/words"]
    recorder = rosbag2_py.Recorder(options_of(tmp_path / "run"), record, "error")
    await asyncio.to_thread(recorder.record)
    await words.wait_for_subscribers()
    words.publish(String(data="hello"))
    await until(recorded)
    await asyncio.to_thread(recorder.pause)
    assert await asyncio.to_thread(recorder.is_paused)
    await asyncio.to_thread(recorder.stop)
    with bag.open(tmp_path / "run") as run:
        assert run.counts == {"/words": 1}


async def test_the_older_form_records_until_it_is_cancelled(node: Node, tmp_path: Path) -> None:
    """Programs for Jazzy call it in a thread."""
    words = node.create_publisher(String, "words", 10)
    recorder = rosbag2_py.Recorder("error")
    record = rosbag2_py.RecordOptions(all_topics=True)
    place = options_of(tmp_path / "run")
    thread = threading.Thread(target=recorder.record, args=(place, record), daemon=True)
    thread.start()
    await words.wait_for_subscribers()
    words.publish(String(data="hello"))
    await until(recorded)
    await asyncio.to_thread(rosbag2_py.Recorder.cancel)
    await asyncio.to_thread(thread.join)
    with bag.open(tmp_path / "run") as run:
        assert run.counts["/words"] == 1


async def test_the_level_of_a_logger_is_that_of_before_when_a_recorder_has_ended(
    alone: None, tmp_path: Path
) -> None:
    """A level belongs to the process, where later recorders have the same logger."""
    before = get_logger_level("rosbag2_recorder")
    record = rosbag2_py.RecordOptions(all_topics=True)
    recorder = rosbag2_py.Recorder(options_of(tmp_path / "run"), record, "error")
    await asyncio.to_thread(recorder.start_spin)
    during = get_logger_level("rosbag2_recorder")
    await asyncio.to_thread(recorder.stop_spin)

    assert (before, during) == (LoggingSeverity.UNSET, LoggingSeverity.ERROR)
    assert get_logger_level("rosbag2_recorder") is LoggingSeverity.UNSET


async def test_a_player_plays_in_its_thread(node: Node, tmp_path: Path) -> None:
    """It is paused, stepped, and plays to the end."""
    write(tmp_path / "run", 5)
    heard: list[str] = []
    words = node.create_subscription(String, "words", lambda msg: heard.append(msg.data), 10)
    play = rosbag2_py.PlayOptions(start_paused=True)
    player = rosbag2_py.Player(options_of(tmp_path / "run"), play, "error")
    await asyncio.to_thread(player.start_spin)
    await until(words.get_publisher_count)
    await asyncio.to_thread(player.play)
    assert await asyncio.to_thread(player.is_paused)
    assert await asyncio.to_thread(player.play_next)
    assert await asyncio.to_thread(player.burst, 2) == 2
    assert player.get_starting_time() == 1
    assert player.get_playback_duration() == 4 * 10**6
    assert not await asyncio.to_thread(player.wait_for_playback_to_finish, 0.01)
    await asyncio.to_thread(player.resume)
    assert await asyncio.to_thread(player.wait_for_playback_to_finish)
    await until(lambda: len(heard) == 5)
    await asyncio.to_thread(player.stop_spin)
    assert heard == [str(number) for number in range(5)]


def test_the_older_form_plays_to_the_end(tmp_path: Path) -> None:
    """A burst returns how many messages it has sent."""
    write(tmp_path / "run", 5)
    player = rosbag2_py.Player("error")
    player.play(options_of(tmp_path / "run"), rosbag2_py.PlayOptions(rate=100))
    assert player.burst(options_of(tmp_path / "run"), rosbag2_py.PlayOptions(), 3) == 3


def test_what_cannot_begin_is_a_runtime_error(tmp_path: Path) -> None:
    """As in rosbag2_py."""
    with pytest.raises(RuntimeError, match="no such file"):
        rosbag2_py.Player(options_of(tmp_path / "no"), rosbag2_py.PlayOptions()).play()
    with pytest.raises(RuntimeError, match="already exists"):
        rosbag2_py.Recorder(options_of(tmp_path), rosbag2_py.RecordOptions()).record()
    with pytest.raises(RuntimeError, match="storage options"):
        rosbag2_py.Recorder().record()


def test_metadata_are_written_anew(tmp_path: Path) -> None:
    """By its `Reindexer`."""
    write(tmp_path / "run", 2)
    (tmp_path / "run" / "metadata.yaml").unlink()
    rosbag2_py.Reindexer().reindex(options_of(tmp_path / "run"))
    with bag.open(tmp_path / "run") as run:
        assert run.message_count == 2
    with pytest.raises(RuntimeError, match="only a folder"):
        rosbag2_py.Reindexer().reindex(options_of(tmp_path / "none"))


def test_bags_are_written_anew_by_a_file(tmp_path: Path) -> None:
    """By `bag_rewrite`, like `ros2 bag convert`."""
    write(tmp_path / "a", 2)
    write(tmp_path / "b", 3)
    options = tmp_path / "out.yaml"
    options.write_text(f"output_bags:\n- uri: {tmp_path / 'both'}\n  topics: [/words]\n")
    places = [options_of(tmp_path / name) for name in "ab"]
    rosbag2_py.bag_rewrite(places, str(options))
    with bag.open(tmp_path / "both") as run:
        assert run.counts == {"/words": 5}
    with pytest.raises(RuntimeError, match="already exists"):
        rosbag2_py.bag_rewrite(places, str(options))
    options.write_text(f"output_bags:\n- uri: {tmp_path / 'none'}\n  exclude: wor.s\n")
    rosbag2_py.bag_rewrite(places, str(options))
    with bag.open(tmp_path / "none") as run:  # `exclude` is the former name of `exclude_regex`
        assert run.message_count == 0
    options.write_text("output_bags: 1")
    with pytest.raises(RuntimeError, match=r"out\.yaml: it needs output_bags"):
        rosbag2_py.bag_rewrite(places, str(options))


def test_a_recorder_takes_the_topics_of_a_file_and_repeats_latched_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Options of Lyrical, which programs set as attributes."""
    file = tmp_path / "topics.yaml"
    file.write_text("static_topics_and_types_list:\n- [map, std_msgs/msg/String]\n")
    record = rosbag2_py.RecordOptions()
    record.static_topics_uri = str(file)
    record.repeat_all_transient_local_depth = 3
    record.repeat_transient_local_messages = {"/map": 1}
    recorder = rosbag2_py.Recorder(options_of(tmp_path / "run"), record)
    given: dict[str, Any] = {}
    monkeypatch.setattr(bag, "Recorder", lambda _, **options: given.update(options))
    recorder._make(Context(transport="local"))
    assert given["static_topics"] == {"/map": "std_msgs/msg/String"}
    assert given["repeat_latched"] == {"*": 3, "/map": 1}
    file.write_text("static_topics_and_types_list: [1]")
    with pytest.raises(RuntimeError, match=r"topics\.yaml"):
        rosbag2_py.Recorder(options_of(tmp_path / "run"), record).record()
