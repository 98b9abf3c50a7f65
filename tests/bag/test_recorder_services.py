"""A recorder's services and topics as in rosbag2, with Lyrical's and earlier definitions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from aionode import bag
from aionode.bag.recording.services import answered, when
from aionode.clock import Time
from aionode.idl import define
from aionode.idl._installed import replaced_types
from aionode.interfaces.rosbag2_interfaces import srv as bag_srv
from aionode.interfaces.rosbag2_interfaces.msg import MessagesLostEvent, WriteSplitEvent
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import ManualClock, local_context, settle


@pytest.fixture
def lyrical(monkeypatch: pytest.MonkeyPatch) -> None:
    """The services as Lyrical has them, with answers."""
    monkeypatch.setenv("ROS_DISTRO", "lyrical")
    for name, srv_type in replaced_types("rosbag2_interfaces", "srv", vars(bag_srv)).items():
        monkeypatch.setattr(bag_srv, name, srv_type)


def texts(path: Path) -> list[str]:
    """Return the texts of a bag, or of one of its files."""
    with bag.open(path) as run:
        return [record.message.data for record in run.read("/words")]


async def asked(node: Node, srv_type: Any, name: str, **fields: Any) -> Any:
    """Call a service of the recorder."""
    client = node.create_client(srv_type, f"/rosbag2_recorder/{name}")
    return await client.call(srv_type.Request(**fields))


@pytest.mark.usefixtures("lyrical")
async def test_a_recorder_is_stopped_and_records_again_elsewhere(tmp_path: Path) -> None:
    """One process records many runs of a robot, on request."""
    async with local_context() as context, Node("talker", context=context) as node:
        words = node.create_publisher(String, "words", 10)
        async with bag.Recorder(tmp_path / "one", topics=["/words"], context=context) as recorder:
            words.publish(String(data="a"))
            await settle()
            assert (await asked(node, bag_srv.Stop, "stop")).return_code == 0
            assert recorder.stats["/words"].recorded == 1
            assert texts(tmp_path / "one") == ["a"]
            words.publish(String(data="b"))
            assert (await asked(node, bag_srv.Stop, "stop")).return_code == 1
            assert (await asked(node, bag_srv.SplitBagfile, "split_bagfile")).return_code == 1
            old = await asked(node, bag_srv.Record, "record")
            assert (old.return_code, "already exists" in old.error_string) == (1, True)
            uri = str(tmp_path / "two")
            assert (await asked(node, bag_srv.Record, "record", uri=uri)).return_code == 0
            assert (await asked(node, bag_srv.Record, "record", uri=uri)).return_code == 1
            words.publish(String(data="c"))
            await settle()
    assert texts(tmp_path / "two") == ["c"]


@pytest.mark.usefixtures("lyrical")
async def test_a_recording_is_split_and_resumed_at_given_times(tmp_path: Path) -> None:
    """By the node's time, or by the times of one topic's messages."""
    clock = ManualClock(Time(seconds=100))
    async with local_context(clock=clock) as context, Node("talker", context=context) as node:
        splits: list[WriteSplitEvent] = []
        node.create_subscription(WriteSplitEvent, "/events/write_split", splits.append, 10)
        words = node.create_publisher(String, "words", 10)
        async with bag.Recorder(
            tmp_path / "run", topics=["/words"], context=context, start_paused=True
        ):
            at = Time(seconds=101).to_msg()
            wrong = {"resume_time": at, "resume_mode": 2, "tracking_topic_name": "/none"}
            assert (await asked(node, bag_srv.Resume, "resume", **wrong)).return_code == 2
            assert (await asked(node, bag_srv.Resume, "resume", resume_mode=7)).return_code == 1
            assert (await asked(node, bag_srv.Resume, "resume", resume_time=at)).return_code == 0
            split: Any = bag_srv.SplitBagfile
            mode = split.Request.SPLIT_MODE_PUBLISH_TIME
            later: dict[str, Any] = {"split_time": Time(seconds=103).to_msg(), "split_mode": mode}
            later["tracking_topic_name"] = "/words"
            assert (await asked(node, split, "split_bagfile", **later)).return_code == 0
            for text in "abcde":
                words.publish(String(data=text))
                await clock.advance(1)
            await settle()
            assert (await asked(node, bag_srv.SplitBagfile, "split_bagfile")).return_code == 0
            await settle()
        assert [event.closed_file for event in splits] == ["run_0.mcap", "run_1.mcap"]
    assert texts(tmp_path / "run" / "run_0.mcap") == ["b", "c"]
    assert texts(tmp_path / "run" / "run_1.mcap") == ["d", "e"]


async def test_losses_are_told_and_are_in_the_bag(tmp_path: Path) -> None:
    """On rosbag2's topic while it records, and by `aionode bag info` afterwards."""
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("talker", context=context) as node:
        events: list[MessagesLostEvent] = []
        topic = "/events/rosbag2_messages_lost"
        node.create_subscription(MessagesLostEvent, topic, events.append, 10)
        words = node.create_publisher(String, "words", 100)
        async with bag.Recorder(tmp_path / "run", context=context, cache_bytes=30) as recorder:
            for _ in range(50):
                words.publish(String(data="0123456789"))
            await settle()
            lost = recorder.stats["/words"].lost_in_recorder
            assert lost > 0
            await clock.advance(2.5)
            (event,) = events
            (told,) = event.messages_lost_statistics
            assert (told.topic_name, told.messages_lost_in_recorder) == ("/words", lost)
    with bag.open(tmp_path / "run") as run:
        assert run.losses == {"/words": bag.Lost(in_transport=0, in_recorder=lost)}
    bag.merge([tmp_path / "run", tmp_path / "run"], tmp_path / "both")
    with bag.open(tmp_path / "both") as both:
        assert both.losses == {"/words": bag.Lost(in_transport=0, in_recorder=2 * lost)}
        assert both.custom_data == {}


def test_the_services_of_jazzy_and_kilted_have_no_fields() -> None:
    """With ROS_DISTRO=jazzy, clients of that release can stop and split a recorder."""
    empty = define("old_msgs/msg/Empty", "")
    assert when(empty(), "split") == (None, 0, "")
    response = empty()
    assert answered(response, 1, "no") is response


async def test_a_stopped_recorder_refuses_messages(tmp_path: Path) -> None:
    """Otherwise they would be lost silently."""
    from aionode.errors import BagError

    async with (
        local_context() as context,
        bag.Recorder(tmp_path / "run", topics=[], context=context) as recorder,
    ):
        await recorder.stop()
        with pytest.raises(BagError, match="stopped"):
            recorder.write("/x", String())
