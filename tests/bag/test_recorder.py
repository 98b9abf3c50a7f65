"""The recorder: each published message is in the bag or counted as lost."""

from __future__ import annotations

import asyncio
import errno
import os
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from aionode import bag
from aionode.bag.recording.recorder import adapted_qos
from aionode.clock import ClockType, Time
from aionode.engine.bare_node import BareNode
from aionode.engine.context import Context
from aionode.engine.wire import cdr
from aionode.errors import BagError, BagWriteError, InterfaceNotFoundError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rosbag2_interfaces.srv import IsPaused, Snapshot
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray, Int32, String
from aionode.message import ActionType, Message, float64
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from aionode.testing import local_context, settle

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def texts(path: Path, topic: str = "/words") -> list[str]:
    """Return the texts of one topic of a bag."""
    with bag.open(path) as run:
        return [record.message.data for record in run.read(topic)]


async def test_what_is_published_is_in_the_bag(tmp_path: Path) -> None:
    """Topic by topic, published = recorded + lost."""
    async with local_context() as context, Node("talker", context=context) as node:
        words = node.create_publisher(String, "words", 10)
        async with bag.Recorder(tmp_path / "run", topics=["/words"], context=context) as recorder:
            for text in "abc":
                words.publish(String(data=text))
            await settle()
            assert recorder.stats["/words"] == (3, 0, 0)
    assert texts(tmp_path / "run") == ["a", "b", "c"]


async def test_a_topic_that_appears_later_is_recorded(tmp_path: Path) -> None:
    """Robots start their nodes one after the other."""
    async with (
        local_context() as context,
        Node("talker", context=context) as node,
        bag.Recorder(tmp_path / "run", context=context),
    ):
        late = node.create_publisher(String, "late", LATCHED)
        late.publish(String(data="x"))
        await settle()
    assert texts(tmp_path / "run", "/late") == ["x"]


async def test_a_message_can_be_recorded_without_being_published(tmp_path: Path) -> None:
    """A program can record its own data without sending it."""
    async with (
        local_context() as context,
        bag.Recorder(tmp_path / "run", topics=[], context=context) as recorder,
    ):
        recorder.write("/notes", String(data="start"), time=Time(seconds=5))
    with bag.open(tmp_path / "run") as run:
        (record,) = run.read()
        assert record.time == Time(seconds=5, clock_type=ClockType.ROS_TIME)


async def test_nothing_is_recorded_while_the_recorder_is_paused(tmp_path: Path) -> None:
    """rosbag2's service pauses it, like the key."""
    async with local_context() as context, Node("talker", context=context) as node:
        words = node.create_publisher(String, "words", 10)
        async with bag.Recorder(tmp_path / "run", context=context, start_paused=True) as recorder:
            words.publish(String(data="a"))
            await settle()
            client = node.create_client(IsPaused, "/rosbag2_recorder/is_paused")
            assert (await client.call(IsPaused.Request())).paused
            recorder.resume()
            words.publish(String(data="b"))
            await settle()
    assert texts(tmp_path / "run") == ["b"]


async def test_a_snapshot_has_the_last_messages_and_the_latched_ones(tmp_path: Path) -> None:
    """What led to an event is written after it, together with the map."""
    async with local_context() as context, Node("talker", context=context) as node:
        maps = node.create_publisher(String, "map", LATCHED)
        words = node.create_publisher(String, "words", 10)
        async with bag.Recorder(tmp_path / "run", context=context, snapshot=True, cache_bytes=40):
            maps.publish(String(data="map"))
            for text in "abcdefgh":
                words.publish(String(data=text))
                await settle()
            client = node.create_client(Snapshot, "/rosbag2_recorder/snapshot")
            assert (await client.call(Snapshot.Request())).success
    assert texts(tmp_path / "run", "/map") == ["map"]
    assert texts(tmp_path / "run")[-1] == "h"
    assert len(texts(tmp_path / "run")) < 8


async def test_messages_that_the_disk_is_too_slow_for_are_counted(tmp_path: Path) -> None:
    """A recorder without a limit would use up the robot's memory."""
    async with local_context() as context, Node("talker", context=context) as node:
        words = node.create_publisher(String, "words", 100)
        async with bag.Recorder(tmp_path / "run", context=context, cache_bytes=30) as recorder:
            for _ in range(50):
                words.publish(String(data="0123456789"))
            await settle()
            recorded, _, lost = recorder.stats["/words"]
            assert recorded + lost == 50
            assert lost > 0
    assert len(texts(tmp_path / "run")) == recorded


async def test_both_types_of_a_topic_whose_type_changes_are_recorded(tmp_path: Path) -> None:
    """A node restarted in a new version must not end the recording."""
    async with (
        local_context() as context,
        Node("talker", context=context) as node,
        bag.Recorder(tmp_path / "run", topics=["/x"], context=context),
    ):
        for msg in (String(data="a"), Int32(data=1)):
            publisher = node.create_publisher(type(msg), "x", LATCHED)
            publisher.publish(msg)
            await settle()
            publisher.destroy()
    with bag.open(tmp_path / "run") as run:
        assert [record.message.data for record in run.read()] == ["a", 1]


async def test_a_topic_of_an_unknown_type_is_named_once_and_the_rest_is_recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Its bytes would be useless without a definition."""
    known = Node.find_type

    async def find_type(self: Node, typename: str, **options: Any) -> Any:
        if typename == "std_msgs/msg/Int32":
            raise InterfaceNotFoundError(typename, problem="nobody describes it")
        return await known(self, typename, **options)

    monkeypatch.setattr(Node, "find_type", find_type)
    async with local_context() as context, Node("talker", context=context) as node:
        node.create_publisher(Int32, "odd", 1)
        words = node.create_publisher(String, "words", LATCHED)
        words.publish(String(data="a"))
        async with bag.Recorder(tmp_path / "run", context=context) as recorder:
            node.create_publisher(String, "more", 1)
            await settle()
            assert recorder.stats.keys() >= {"/words", "/more"}
            assert "/odd" not in recorder.stats
            assert recorder.summary().endswith("lost: /odd: all, as no node describes its type")
    assert texts(tmp_path / "run") == ["a"]
    told = [each.message for each in caplog.records if "/odd is not recorded" in each.message]
    assert len(told) == 1


class Walk(ActionType, typename="foreign_msgs/action/Walk", by_name=False):
    """An action that is not found by name, as if another program had it."""

    class Goal(Message):
        """How far."""

        metres: float64 = 0.5

    class Result(Message):
        """Nothing."""

    class Feedback(Message):
        """How far it has come."""

        metres: float64 = 0.0


async def test_the_feedback_of_an_action_that_only_its_node_knows_is_recorded(
    tmp_path: Path,
) -> None:
    """The node describes it, like the types of its other topics."""

    async def walk(goal: Any) -> Walk.Result:
        goal.publish_feedback(Walk.Feedback(metres=0.25))
        goal.succeed()
        return Walk.Result()

    topic = "/walk/_action/feedback"
    async with local_context() as context, Node("walker", context=context) as node:
        node.create_action_server(Walk, "walk", walk)
        client = node.create_action_client(Walk, "walk")
        async with bag.Recorder(tmp_path / "run", topics=[topic], context=context) as recorder:
            await client.call(Walk.Goal())
            await settle()
            assert recorder.stats[topic] == (1, 0, 0)
    with bag.open(tmp_path / "run") as run:
        assert [record.message.feedback.metres for record in run.read(topic)] == [0.25]


async def test_a_clock_that_is_set_back_is_one_line_and_no_message_is_lost(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Simulations restart, and computers without a battery get their time from the network."""
    async with local_context() as context, Node("talker", context=context) as node:
        words = node.create_publisher(String, "words", 10)
        clock = node.create_publisher(Clock, "/clock", 10)
        async with bag.Recorder(  # of the log as well, in which the line is
            tmp_path / "run", topics=["/words", "/rosout"], context=context, use_sim_time=True
        ):
            for sec in (100, 101, 40, 41):
                clock.publish(Clock(clock=Time(seconds=sec).to_msg()))
                await settle()
                words.publish(String(data=str(sec)))
                await settle()
    assert texts(tmp_path / "run") == ["40", "41", "100", "101"]
    told = [each.message for each in caplog.records if "was set back" in each.message]
    assert len(told) == 1
    assert "61.0 s" in told[0]
    assert not bag.check(tmp_path / "run")[0].repaired


async def test_a_message_without_a_credible_stamp_is_recorded_with_the_time_of_its_arrival(
    tmp_path: Path,
) -> None:
    """A publisher may set any stamp, even one before 1970, which a bag cannot store."""
    async with (
        local_context() as context,
        bag.Recorder(tmp_path / "run", topics=["/words"], context=context) as recorder,
    ):
        node = BareNode(context, "odd")
        words = node.create_publisher(String, "/words", QoSProfile(depth=10))
        await settle()
        for stamp_ns in (-5, 0, 7):
            words.publish(String(data="a"), stamp_ns)
        assert recorder.stats["/words"] == (3, 0, 0)
        node.destroy_node()
    with bag.open(tmp_path / "run") as run:
        records = list(run.read())
    assert [record.publish_time_ns for record in records[2:]] == [7]
    assert all(record.publish_time_ns == record.time_ns for record in records[:2])


async def test_a_split_at_the_end_of_a_recording_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The node has ended when the last rows are written, so the new file cannot be announced."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.BATCH_S", 60)
    async with local_context() as context:
        async with bag.Recorder(
            tmp_path / "run", topics=[], context=context, max_messages=1
        ) as recorder:
            for text in "ab":
                recorder.write("/words", String(data=text))
        await settle()
    assert texts(tmp_path / "run") == ["a", "b"]
    assert not [each for each in caplog.records if each.name == "asyncio"]


@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
async def test_a_large_message_is_recorded_as_it_was_published_and_again_in_each_file(
    compression: str, tmp_path: Path
) -> None:
    """Its array is not copied first, and the program may modify it at once."""
    array = np.arange(100_000, dtype=np.float64)
    wanted = cdr.encode(Float64MultiArray(data=array))
    async with local_context() as context, Node("map", context=context) as node:
        maps = node.create_publisher(Float64MultiArray, "map", LATCHED)
        words = node.create_publisher(String, "words", 10)
        async with bag.Recorder(
            tmp_path / "run", context=context, compression=compression, max_messages=2
        ) as recorder:
            maps.publish(Float64MultiArray(data=array))
            array[:] = 0
            for text in "abc":
                words.publish(String(data=text))
            assert recorder.stats["/map"] == (1, 0, 0)
    with bag.open(tmp_path / "run") as run:
        raws = [record.raw for record in run.read("/map")]
    assert raws == [wanted, wanted]


async def test_a_message_of_several_middling_parts_is_compressed_as_a_small_one(
    tmp_path: Path,
) -> None:
    """No single array is large enough to try, and a sample of one says nothing about the rest."""
    joints = JointState(position=np.zeros(6000), velocity=np.zeros(6000), effort=np.zeros(6000))
    async with local_context() as context, Node("arm", context=context) as node:
        arm = node.create_publisher(JointState, "arm", 10)
        async with bag.Recorder(tmp_path / "run", topics=["/arm"], context=context):
            arm.publish(joints)
    with bag.open(tmp_path / "run") as run:
        assert [record.raw for record in run.read()] == [cdr.encode(joints)]
    assert (tmp_path / "run" / "run_0.mcap").stat().st_size < 20_000


async def test_a_service_is_recorded_by_its_events(tmp_path: Path) -> None:
    """rosbag2 records services like that."""
    from aionode.endpoints.service_introspection import ServiceIntrospectionState

    async with local_context() as context, Node("adder", context=context) as node:
        service = node.create_service(AddTwoInts, "add", lambda request, response: response)
        contents = ServiceIntrospectionState.CONTENTS
        service.configure_introspection(node.get_clock(), 10, contents)
        client = node.create_client(AddTwoInts, "add")
        wanted = bag.Selection(services=["/add"])
        async with bag.Recorder(tmp_path / "run", selection=wanted, context=context):
            await client.call(AddTwoInts.Request(a=2))
            await settle()
    with bag.open(tmp_path / "run") as run:
        first = next(iter(run.read("/add/_service_event")))
        assert first.message.request[0].a == 2


async def test_an_error_of_the_block_is_raised_unchanged(tmp_path: Path) -> None:
    """A program catches its own errors, not groups of them."""
    async with local_context() as context:
        with pytest.raises(KeyError, match="mine"):
            async with bag.Recorder(tmp_path / "run", topics=[], context=context):
                raise KeyError("mine")


async def test_a_folder_that_cannot_be_made_is_one_clear_error(tmp_path: Path) -> None:
    """Before anything is recorded, not at the end."""
    (tmp_path / "file").touch()
    async with local_context() as context:
        with pytest.raises(BagWriteError, match="file/run"):
            async with bag.Recorder(tmp_path / "file" / "run", context=context):
                pass


async def test_a_recording_whose_folder_is_removed_says_so_at_the_next_sync(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The open file accepts bytes without an error, and they are gone when it is closed."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.SYNC_NS", 0)
    async with local_context() as context:
        recorder = bag.Recorder(tmp_path / "run", topics=[], context=context)
        with pytest.raises(BagWriteError, match="the file was removed"):  # noqa: PT012  # leaving raises
            async with recorder:
                recorder.write("/x", String(data="one"), time=Time(nanoseconds=1))
                shutil.rmtree(tmp_path / "run")
                recorder.write("/x", String(data="two"), time=Time(nanoseconds=2))
                await recorder.failed()
        assert recorder.stats["/x"] == (0, 0, 2)


@pytest.mark.parametrize("removed", ["run", "run/run_0.mcap", "run/run_1.mcap"])
async def test_what_was_removed_is_counted_as_lost_at_the_end(removed: str, tmp_path: Path) -> None:
    """Nobody should believe that there is a bag; messages in earlier files count as well."""
    async with local_context() as context:
        recorder = bag.Recorder(tmp_path / "run", topics=[], context=context)
        with pytest.raises(BagWriteError, match="the file was removed"):  # noqa: PT012  # leaving raises
            async with recorder:
                recorder.write("/x", String(data="one"), time=Time(nanoseconds=1))
                await recorder.split()
                recorder.write("/x", String(data="two"), time=Time(nanoseconds=2))
                place = tmp_path / removed
                if place.is_dir():
                    shutil.rmtree(place)
                else:
                    place.unlink()
        lost = 2 if removed == "run" else 1
        assert recorder.stats["/x"] == (2 - lost, 0, lost)
        assert "lost: nothing" not in recorder.summary()


async def test_a_disk_that_is_full_at_the_sync_is_called_full(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some file systems notice it only then."""

    def is_full(fd: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    async with local_context() as context:
        recorder = bag.Recorder(tmp_path / "run", topics=[], context=context)
        with pytest.raises(BagWriteError, match="free some space") as caught:  # noqa: PT012  # leaving raises
            async with recorder:
                recorder.write("/x", String(data="one"), time=Time(nanoseconds=1))
                monkeypatch.setattr("os.fdatasync", is_full)
        assert caught.value.is_full


def test_a_subscription_of_the_recorder_fits_all_publishers() -> None:
    """It is reliable and transient local only if every publisher is, as in rosbag2."""
    assert adapted_qos([LATCHED]).durability is DurabilityPolicy.TRANSIENT_LOCAL
    mixed = adapted_qos([LATCHED, qos_profile_sensor_data])
    assert mixed.durability is DurabilityPolicy.VOLATILE
    assert mixed.reliability is ReliabilityPolicy.BEST_EFFORT


def test_a_limit_of_files_without_a_limit_of_one_file_is_refused() -> None:
    """There would never be a second file."""
    with pytest.raises(BagError, match="max_files"):
        bag.Recorder("run", max_files=2, context=Context(transport="local"))


def mount_in(folder: Path) -> list[str]:
    """Return the command prefix that mounts a disk of 300 kB as a folder."""
    folder.mkdir()
    mount = f"mount -t tmpfs -o size=300k tmpfs {shlex.quote(str(folder))}"
    tried = subprocess.run(
        ["unshare", "--mount", "sh", "-c", mount], capture_output=True, check=False
    )
    if tried.returncode:
        pytest.skip(f"no disk can be mounted here: {tried.stderr.decode()}")
    return ["unshare", "--mount", "sh", "-c", f'{mount} && exec "$0" "$@"']


def limit_files() -> None:
    """Limit the files of this process to 300 kB."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


@pytest.mark.processes
@pytest.mark.parametrize("disk", ["a limit", pytest.param("a disk", marks=pytest.mark.slow)])
def test_a_full_disk_leaves_a_bag_with_its_summary_and_exact_counts(
    disk: str, tmp_path: Path
) -> None:
    """What does not fit into 300 kB is counted as lost, and one line says so."""
    program = textwrap.dedent("""
        import asyncio, os, sys
        from aionode import bag
        from aionode.errors import BagWriteError
        from aionode.clock import Time
        from aionode.interfaces.std_msgs.msg import String
        from aionode.testing import local_context

        async def main():
            async with local_context() as context:
                recorder = bag.Recorder(sys.argv[1], topics=[], context=context)
                try:
                    async with recorder:
                        for at in range(2000):
                            text = os.urandom(500).hex()
                            recorder.write("/x", String(data=text), time=Time(nanoseconds=at + 1))
                            await asyncio.sleep(0.0001)
                except BagWriteError:
                    _, _, lost = recorder.stats["/x"]
                    with bag.open(sys.argv[1]) as run:
                        there = len(list(run.read()))
                        assert run.message_count == there == recorder.stats["/x"].recorded
                        assert run.losses["/x"].in_recorder == lost
                    print("stats", there, lost)

        asyncio.run(main())
    """)
    folder = tmp_path / "disk"
    before = mount_in(folder) if disk == "a disk" else []
    done = subprocess.run(
        [*before, sys.executable, "-c", program, str(folder / "run")],
        preexec_fn=None if before else limit_files,  # no threads here
        capture_output=True,
        text=True,
        timeout=50,
        check=True,
    )
    word, recorded, lost = done.stdout.split()[-3:]
    assert word == "stats"
    assert int(recorded) > 0
    assert int(recorded) + int(lost) == 2000
    assert done.stderr.count("cannot be written any further") == 1


async def test_a_power_cut_takes_only_what_came_after_the_last_sync(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file then has its length of the last sync, or continues with zeros."""
    synced = asyncio.Event()
    loop = asyncio.get_running_loop()
    sizes: list[int] = []

    def sync(fd: int) -> None:
        sizes.append(os.fstat(fd).st_size)
        loop.call_soon_threadsafe(synced.set)

    monkeypatch.setattr(os, "fdatasync", sync)
    monkeypatch.setattr("aionode.bag.recording.writer_thread.SYNC_NS", 0)
    async with (
        local_context() as context,
        bag.Recorder(tmp_path / "run", topics=[], context=context) as recorder,
    ):
        for text in "abc":
            recorder.write("/words", String(data=text))
        await synced.wait()
        size = sizes[0]
        recorder.write("/words", String(data="late"))
    data = (tmp_path / "run" / "run_0.mcap").read_bytes()
    for tail in (b"", bytes(len(data) - size)):
        (tmp_path / "run" / "run_0.mcap").write_bytes(data[:size] + tail)
        (found,) = bag.check(tmp_path / "run")
        assert found.repaired
        assert found.messages > 0
        assert texts(tmp_path / "run") == list("abc")[: found.messages]


def test_a_recorder_that_is_killed_loses_only_what_is_not_on_the_disk_yet(tmp_path: Path) -> None:
    """SIGKILL leaves a file without its end; `check` recovers what was written."""
    program = textwrap.dedent("""
        import asyncio, os, signal, sys
        from pathlib import Path
        from aionode import bag
        from aionode.clock import Time
        from aionode.interfaces.std_msgs.msg import String
        from aionode.testing import local_context

        async def main():
            file = Path(sys.argv[1], "run_0.mcap")
            async with local_context() as context:
                async with bag.Recorder(sys.argv[1], topics=[], context=context) as recorder:
                    empty = file.stat().st_size
                    for at in range(200):
                        if at == 100:
                            while file.stat().st_size == empty:
                                await asyncio.sleep(0.01)
                        recorder.write("/x", String(data="x"), time=Time(nanoseconds=at + 1))
                    os.kill(os.getpid(), signal.SIGKILL)

        asyncio.run(main())
    """)
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "run")], check=False, timeout=50
    )
    assert done.returncode == -signal.SIGKILL
    with pytest.raises(BagError, match="aionode bag check"):
        bag.open(tmp_path / "run")
    (found,) = bag.check(tmp_path / "run")
    assert found.repaired
    assert found.messages >= 100
    with bag.open(tmp_path / "run") as run:
        assert [record.time_ns for record in run.read()] == list(range(1, found.messages + 1))
