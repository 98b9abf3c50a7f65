"""Recording demonstrations, and comparing a running robot with a contract."""

from __future__ import annotations

import asyncio
import errno
import os
import subprocess
import sys
import textwrap
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from aionode import bag, image
from aionode._process.concurrency import checkpoint
from aionode.action import GoalStatus
from aionode.clock import Time
from aionode.engine.context import Context
from aionode.errors import BagError, BagWriteError, DatasetError, EpisodeError
from aionode.gateway import Gateway, Policy
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.learn import Contract, Episodes, RecordEpisode, check, export
from aionode.node import Node
from aionode.testing import ManualClock, local_context, settle
from tests.support.chromium import CHROMIUM, chromium
from tests.support.demonstrations import START_NS, angle, contract, picture, stamp


class Robot:
    """A robot whose camera shows its joint."""

    def __init__(self, context: Context) -> None:
        self.node = Node("robot", context=context)
        self.camera = self.node.create_publisher(Image, "/camera0", 10)
        self.joints = self.node.create_publisher(JointState, "/joint_states", 10)
        self.commands = self.node.create_publisher(JointState, "/command", 10)
        self.count = 0
        self.demonstrates = True

    async def step(self, times: int = 1) -> None:
        """Publish everything, at steps of a thirtieth of a second that end now."""
        now = self.node.get_clock().now().nanoseconds
        begin_ns = now - round((self.count + times) / 30 * 1e9)
        for _ in range(times):
            sec = self.count / 30
            at = stamp(begin_ns + round(sec * 1e9))
            state = JointState(name=["joint"], position=[angle(sec)], velocity=[0.0])
            shown = image.from_numpy(picture(sec), "rgb8")
            state.header.stamp = shown.header.stamp = at
            if self.demonstrates:
                self.commands.publish(state)
            self.joints.publish(state)
            self.camera.publish(shown)
            self.count += 1
            await settle()


def stamped(**changes: Any) -> Contract:
    """Return a contract whose commands have stamps, as steps are faster than the clock."""
    action = {
        "feature": "action",
        "topic": "/command",
        "type": "sensor_msgs/msg/JointState",
        "fields": ["position.joint"],
        "names": ["joint"],
        "stop": "hold",
    }
    return contract(actions=[action], **changes)


@asynccontextmanager
async def recording(
    folder: Path, *, clock: ManualClock | None = None, **options: Any
) -> AsyncIterator[tuple[Robot, Episodes]]:
    """Run a robot, and a recorder of episodes."""
    async with local_context(clock=clock) as context:
        robot = Robot(context)
        async with robot.node, Episodes(folder, stamped(), context=context, **options) as episodes:
            yield robot, episodes


def metadata(path: Path) -> dict[str, str]:
    """Return the metadata of a bag."""
    with bag.open(path) as opened:
        return opened.custom_data


async def test_an_episode_is_a_closed_bag_with_its_task_and_outcome(tmp_path: Path) -> None:
    """A copy of its folder is complete."""
    async with recording(tmp_path) as (robot, episodes):
        async with episodes.record(task="wave") as episode:
            await robot.step(10)
        assert (episode.outcome, episode.messages, episode.lost) == ("success", 30, 0)
        found = metadata(episode.path)
    assert (found["task"], found["outcome"]) == ("wave", "success")
    assert '"fps": 30' in found["contract"]


async def test_a_discarded_episode_is_gone(tmp_path: Path) -> None:
    """The next one has its own number."""
    async with recording(tmp_path) as (robot, episodes):
        async with episodes.record() as episode:
            await robot.step(3)
            episode.discard()
        assert not episode.path.exists()
        async with episodes.record():
            await robot.step(3)
    assert [each.name for each in tmp_path.iterdir()] == ["episode_0000"]


@pytest.mark.slow
async def test_an_error_in_the_block_is_a_failure_which_an_export_leaves_out(
    tmp_path: Path,
) -> None:
    """The demonstration is not what was wanted."""
    async with recording(tmp_path / "runs") as (robot, episodes):
        async with episodes.record():
            await robot.step(30)

        async def fail() -> None:
            async with episodes.record():
                await robot.step(30)
                raise LookupError

        with pytest.raises(LookupError):
            await fail()
    assert metadata(tmp_path / "runs/episode_0001")["outcome"] == "failure"
    assert export(tmp_path / "out", [tmp_path / "runs"], jobs=1).episodes == 1
    assert export(tmp_path / "all", [tmp_path / "runs"], jobs=1, failures=True).episodes == 2
    with pytest.raises(
        DatasetError, match="1 episode, and only failures; --failures includes them"
    ):
        export(tmp_path / "none", [tmp_path / "runs/episode_0001"])


async def test_services_begin_and_end_episodes(tmp_path: Path) -> None:
    """For pedals, buttons and the page of the gateway."""
    async with recording(tmp_path) as (robot, episodes):

        async def called(name: str) -> Trigger.Response:
            client = robot.node.create_client(Trigger, f"/episodes/{name}")
            return await client.call(Trigger.Request())

        assert "no episode is being recorded" in (await called("end")).message
        assert (await called("start")).success
        assert "end it first" in (await called("start")).message
        await robot.step(5)
        assert (await called("again")).success
        await robot.step(5)
        answer = await called("fail")
        assert answer.message == f"{tmp_path / 'episode_0000'}: failure"
        assert episodes.current is None
    assert metadata(tmp_path / "episode_0000")["outcome"] == "failure"


PAGE = Policy.parse("""
    [[who]]
    name = "operator"
    loopback = true
    [[allow]]
    call = "/episodes/*"
""")


@pytest.mark.slow
@pytest.mark.one_loop
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
async def test_the_page_of_the_gateway_begins_and_ends_episodes(tmp_path: Path) -> None:
    """In its Services panel, from a telephone beside the robot."""
    async with (
        recording(tmp_path) as (robot, episodes),
        Gateway(robot.node, policy=PAGE, port=0) as gateway,
        chromium() as browser,
    ):
        page = await browser.open(f"http://127.0.0.1:{gateway.port}/")
        for name, told in (("start", "recording"), ("end", "success"), ("end", "start one")):
            await page.choose("#services select", f"/episodes/{name}")
            await page.until(
                "document.querySelector('#services .type').textContent.includes('Trigger')"
            )
            await page.click("#services .call")
            await page.until(
                f"document.querySelector('#services pre').textContent.includes('{told}')"
            )
        assert episodes.current is None
    assert metadata(tmp_path / "episode_0000")["outcome"] == "success"


async def test_a_block_whose_episode_is_ended_elsewhere_waits_for_its_bag(tmp_path: Path) -> None:
    """Otherwise the result of a goal says that nothing was recorded."""
    async with recording(tmp_path) as (robot, episodes), asyncio.TaskGroup() as tasks:
        async with episodes.record("push") as episode:
            await robot.step(3)
            tasks.create_task(episodes.end())
            while episodes.current is episode:
                await checkpoint()
        assert episode.messages == 9


async def test_a_goal_records_an_episode_until_it_is_ended(tmp_path: Path) -> None:
    """Its result names the bag."""
    async with recording(tmp_path) as (robot, episodes):
        client = robot.node.create_action_client(RecordEpisode, "/episodes/record")
        goal = await client.send_goal(RecordEpisode.Goal(task="push"))
        while episodes.current is None:
            await settle()
        await robot.step(3)
        await episodes.end()
        result = (await goal.result()).result
        assert (result.outcome, result.messages) == ("success", 9)
        assert metadata(Path(result.path))["task"] == "push"


async def test_a_goal_that_is_canceled_discards_its_episode(tmp_path: Path) -> None:
    """A goal whose client is lost does so as well."""
    async with recording(tmp_path) as (robot, episodes):
        client = robot.node.create_action_client(RecordEpisode, "/episodes/record")
        goal = await client.send_goal(RecordEpisode.Goal())
        while episodes.current is None:
            await settle()
        await goal.cancel()
        await goal.result()
        assert [*tmp_path.iterdir()] == []


@pytest.fixture
def full_disk(monkeypatch: pytest.MonkeyPatch) -> Callable[[], None]:
    """Return what fills the disk."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.SYNC_NS", 0)

    def is_full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    return lambda: monkeypatch.setattr("os.fdatasync", is_full)


async def test_a_full_disk_is_reported_while_the_episode_is_recorded(
    tmp_path: Path, full_disk: Callable[[], None]
) -> None:
    """Whoever demonstrates would go on in vain. What was written before is there."""
    async with recording(tmp_path) as (robot, episodes):
        episode = await episodes.start()
        full_disk()
        await robot.step(3)
        with pytest.raises(BagWriteError, match="free some space"):
            await episodes.failed()
        assert episodes.text.startswith("episode_0000: ")
        with pytest.raises(BagWriteError, match="free some space"):
            await episodes.end()
        assert episodes.current is None
        assert metadata(episode.path)["outcome"] == "failure"  # its end is missing


async def test_an_episode_on_a_full_disk_can_be_discarded(
    tmp_path: Path, full_disk: Callable[[], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Discarding it makes room for the next one."""
    async with recording(tmp_path) as (robot, episodes):
        await episodes.start()
        full_disk()
        await robot.step(3)
        with pytest.raises(BagWriteError, match="free some space"):
            await episodes.failed()
        await episodes.discard()
        assert [*tmp_path.iterdir()] == []
        monkeypatch.undo()
        async with episodes.record() as episode:
            await robot.step(3)
        assert episode.lost == 0


async def test_a_goal_is_aborted_as_soon_as_the_disk_is_full(
    tmp_path: Path, full_disk: Callable[[], None]
) -> None:
    """Its client may be the robot's program, which reads no log."""
    async with recording(tmp_path) as (robot, episodes):
        client = robot.node.create_action_client(RecordEpisode, "/episodes/record")
        goal = await client.send_goal(RecordEpisode.Goal())
        while episodes.current is None:
            await settle()
        full_disk()
        await robot.step(3)
        assert (await goal.result()).status == GoalStatus.STATUS_ABORTED
        assert episodes.current is None


async def test_an_episode_without_a_task_is_refused(tmp_path: Path) -> None:
    """A policy that listens to words would learn from none."""
    async with local_context() as context:
        silent = Episodes(tmp_path, contract(task=""), context=context)
        async with silent:
            with pytest.raises(EpisodeError, match="there is no task"):
                await silent.start()


@pytest.mark.parametrize("given", ["file", "file/runs"])
async def test_an_unusable_folder_is_reported_before_anything_is_recorded(
    tmp_path: Path, given: str
) -> None:
    """Whoever demonstrates has prepared the robot, and would notice it at the first key."""
    (tmp_path / "file").touch()
    async with local_context() as context:
        with pytest.raises(EpisodeError, match=rf"the folder \S+{given}: .*; give another one"):
            async with Episodes(tmp_path / given, contract(), context=context):
                pass


async def test_what_was_recorded_is_exported(tmp_path: Path) -> None:
    """With the contract and the task of the recording."""
    clock = ManualClock(Time(nanoseconds=START_NS))
    async with recording(tmp_path / "runs", clock=clock) as (robot, episodes):
        for _ in range(2):
            async with episodes.record():
                await robot.step(40)
    exported = export(tmp_path / "out", [tmp_path / "runs"], jobs=1)
    assert (exported.episodes, exported.problems) == (2, {})


PROGRAM = textwrap.dedent("""
    import asyncio, sys
    from pathlib import Path
    from tests.learn.test_record import recording

    async def main():
        async with recording(Path(sys.argv[1])) as (robot, episodes):
            async with episodes.record():
                await robot.step(60)
                await asyncio.sleep(1.5)
                await robot.step(3)
                print("recorded", flush=True)
                await asyncio.sleep(60)

    asyncio.run(main())
""")


@pytest.mark.slow
@pytest.mark.processes
def test_an_episode_is_exported_once_its_recorder_was_killed(tmp_path: Path) -> None:
    """With its task and contract; nobody said how it ended. It is not touched before."""
    arguments = (tmp_path / "out", [tmp_path / "runs"])
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM, str(tmp_path / "runs")], stdout=subprocess.PIPE
    ) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == b"recorded\n"
        for file in (tmp_path / "runs").rglob("*.mcap"):
            os.utime(file, (1, 1))  # as if its topics had been silent for long
        with pytest.raises(BagError, match="is recording or repairing it"):
            export(*arguments)
        program.kill()
    exported = export(*arguments)
    assert 55 <= exported.rows <= 62
    assert exported.reports[0]["outcome"] == ""


# A running robot


async def checked(
    made: Contract, *, steps: int = 30, length_sec: float = 0.3, demonstrates: bool = True
) -> Any:
    """Check a robot that runs with a contract; the check ends when the robot has stepped."""
    clock = ManualClock(Time(nanoseconds=START_NS))
    async with local_context(clock=clock) as context:
        robot = Robot(context)
        robot.demonstrates = demonstrates
        async with (
            robot.node,
            Node("checker", context=context) as node,
            asyncio.TaskGroup() as tasks,
        ):
            checking = tasks.create_task(check(node, made, length_sec))
            await settle()
            await robot.step(steps)
            assert not checking.done()
            await clock.advance(length_sec)
        return checking.result()


async def test_a_check_reports_rate_age_and_qos_of_each_topic() -> None:
    """Before anything is recorded."""
    found = await checked(stamped())
    assert found.problems == []
    assert "/camera0 (observation.images.camera0): 30 messages at 30.0 Hz" in found.text
    assert "/joint_states (observation.state): 30 messages at 30.0 Hz; age p50 0.0" in found.text
    assert "reliable, volatile" in found.text


async def test_a_check_does_not_ask_for_commands() -> None:
    """A page or a gamepad that nobody touches publishes none."""
    found = await checked(stamped(), demonstrates=False)
    assert found.problems == []
    assert "/command (action): no messages" in found.text


async def test_a_check_names_what_is_missing_and_what_is_near() -> None:
    """A typing error is the usual reason."""
    observations = contract().to_dict()["observations"]
    observations[1]["topic"] = "/joint_state"
    found = await checked(stamped(observations=observations))
    assert found.problems == ["/joint_state: nobody publishes it; did you mean /joint_states?"]


async def test_a_check_names_another_type_and_a_joint_that_is_not_there() -> None:
    """The contract is of another robot."""
    observations = contract().to_dict()["observations"]
    observations[1]["fields"] = ["position.elbow", "velocity.joint"]
    actions = [
        {
            "feature": "action",
            "topic": "/command",
            "type": "std_msgs/msg/Float64",
            "fields": ["data"],
            "stop": "zero",
        }
    ]
    found = await checked(contract(observations=observations, actions=actions))
    text = "\n".join(found.problems)
    assert (
        "/joint_states: 30 messages: sensor_msgs/msg/JointState.position.elbow: not there" in text
    )
    assert "/command: it is sensor_msgs/msg/JointState, but std_msgs/msg/Float64 in the" in text


async def test_a_check_names_a_camera_of_another_rate() -> None:
    """Its pictures would be played too fast."""
    found = await checked(stamped(fps=50))
    assert found.problems == ["/camera0: 30.0 Hz, and fps is 50; set the camera's rate, or fps"]


async def test_a_check_names_numbers_that_are_not_there_and_not_that_they_are_old() -> None:
    """The rate of a topic of which nothing fits is no help."""
    observations = contract().to_dict()["observations"]
    observations[1]["fields"] = ["position.elbow", "velocity.joint"]
    found = await checked(stamped(observations=observations))
    assert len(found.problems) == 1
    assert (
        "/joint_states (observation.state): 30 messages, none of them as in the contract"
        in found.text
    )


async def test_a_check_does_not_take_what_is_slow_to_arrive_for_missing() -> None:
    """In the end of what it heard there are pictures whose joints are on their way."""
    clock = ManualClock(Time(nanoseconds=START_NS))
    async with local_context(clock=clock) as context:
        robot = Robot(context)
        async with (
            robot.node,
            Node("checker", context=context) as node,
            asyncio.TaskGroup() as tasks,
        ):
            checking = tasks.create_task(check(node, stamped(), 0.3))
            await settle()
            for number in range(30):
                at_ns = START_NS - (30 - number) * 10**9 // 30
                shown = image.from_numpy(picture(0), "rgb8")
                shown.header.stamp = stamp(at_ns)
                state = JointState(name=["joint"], position=[0.0], velocity=[0.0])
                state.header.stamp = stamp(at_ns)
                robot.camera.publish(shown)
                robot.commands.publish(state)
                if number < 24:  # the others are 0.2 s late
                    robot.joints.publish(state)
                await settle()
            await clock.advance(0.3)
    assert checking.result().problems == []


async def test_a_check_names_what_fell_silent() -> None:
    """A robot that froze or was killed meanwhile has good rates up to then."""
    found = await checked(stamped(), length_sec=3.0)
    assert found.problems == [
        "/camera0: silent for the last 3.0 s; is its driver running?",
        "/joint_states: silent for the last 3.0 s; is its driver running?",
    ]


async def test_a_check_names_a_flood_before_what_it_keeps_from_arriving() -> None:
    """Whoever looks for a camera's driver looks in the wrong place."""
    clock = ManualClock(Time(nanoseconds=START_NS))
    async with local_context(clock=clock) as context:
        robot = Robot(context)
        async with (
            robot.node,
            Node("checker", context=context) as node,
            asyncio.TaskGroup() as tasks,
        ):
            checking = tasks.create_task(check(node, stamped(), 1.0))
            await settle()
            for number in range(400):
                stamp_ns = START_NS + number * 100_000
                state = JointState(name=["joint"], position=[0.0], velocity=[0.0])
                state.header.stamp = stamp(stamp_ns)
                robot.joints.publish(state)
                await settle()
            await clock.advance(1.0)
    first, second, *_ = checking.result().problems
    assert first.startswith("/joint_states: 400 messages in 1 s, published faster than they are")
    assert second.startswith("/camera0: published, but nothing arrived")
