"""The player: the messages of a bag, at their times."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

from aionode import bag
from aionode.action import ActionServer, CancelResponse, ServerGoalHandle
from aionode.bag._writer import topic_info
from aionode.clock import ClockType, Duration, Time
from aionode.endpoints.service_introspection import ServiceIntrospectionState
from aionode.engine.wire import cdr
from aionode.errors import BagError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rosbag2_interfaces.msg import ReadSplitEvent
from aionode.interfaces.rosbag2_interfaces.srv import Burst, GetRate, Play, PlayNext, SetRate
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import ManualClock, local_context, settle

LATCHED = QoSProfile(depth=9, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def record(path: Path, *texts: str, topic: str = "/words", first_s: int = 100) -> Path:
    """Record texts, a second apart."""
    with bag.BagWriter(path) as out:
        number = out.add_topic(topic_info(topic, String, [LATCHED]))
        for at, text in enumerate(texts):
            out.write(number, (first_s + at) * 10**9, cdr.encode(String(data=text)))
    return path


def at(seconds: float) -> Time:
    """Return a time of the recording."""
    return Time(seconds=seconds, clock_type=ClockType.ROS_TIME)


class Listener:
    """Records what arrives on a topic, and when."""

    def __init__(self, node: Node, clock: ManualClock, topic: str = "/words") -> None:
        self.heard: list[tuple[float, str]] = []
        began_ns = clock.steady_ns()
        node.create_subscription(
            String,
            topic,
            lambda msg: self.heard.append(((clock.steady_ns() - began_ns) / 1e9, msg.data)),
            50,
        )

    @property
    def texts(self) -> list[str]:
        """The texts alone."""
        return [text for _, text in self.heard]


async def reading() -> None:
    """Wait until the player's thread has read and everything has settled."""
    for _ in range(3):
        await settle()


async def test_messages_are_played_at_their_times(tmp_path: Path) -> None:
    """A second of the recording is a second, or half of one at rate 2."""
    record(tmp_path / "run", "a", "b", "c")
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock)
        async with (
            bag.Player(tmp_path / "run", context=context, rate=2) as player,
            asyncio.TaskGroup() as tasks,
        ):
            playing = tasks.create_task(player.play())
            await reading()
            assert ear.heard == [(0, "a")]
            await clock.advance(0.75)
            assert ear.heard == [(0, "a"), (0.5, "b")]
            player.set_rate(0.5)
            await clock.advance(0.9)
            assert ear.texts == ["a", "b"]
            await clock.advance(0.2)
            assert await playing
            assert ear.texts == ["a", "b", "c"]


async def test_a_paused_player_publishes_one_by_one(tmp_path: Path) -> None:
    """With rosbag2's services, which its users know."""
    record(tmp_path / "run", "a", "b", "c", "d")
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock)
        async with (
            bag.Player(tmp_path / "run", context=context, start_paused=True) as player,
            asyncio.TaskGroup() as tasks,
        ):
            playing = tasks.create_task(player.play())
            await reading()
            assert ear.texts == []
            step = node.create_client(PlayNext, "/rosbag2_player/play_next")
            assert (await step.call(PlayNext.Request())).success
            assert ear.texts == ["a"]
            burst = node.create_client(Burst, "/rosbag2_player/burst")
            assert (await burst.call(Burst.Request(num_messages=2))).actually_burst == 2
            await settle()
            assert ear.texts == ["a", "b", "c"]
            assert (await burst.call(Burst.Request())).actually_burst == 1
            assert await playing


async def test_a_player_seeks_and_continues_there(tmp_path: Path) -> None:
    """It can also seek backward, and not beyond the recording."""
    record(tmp_path / "run", "a", "b", "c")
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock)
        async with (
            bag.Player(tmp_path / "run", context=context) as player,
            asyncio.TaskGroup() as tasks,
        ):
            playing = tasks.create_task(player.play())
            await reading()
            assert not player.seek(at(99))
            assert player.seek(at(102))
            await reading()
            assert await playing
            assert ear.texts == ["a", "c"]


async def test_a_player_loops_until_it_is_stopped(tmp_path: Path) -> None:
    """As in a demonstration."""
    record(tmp_path / "run", "a", "b")
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock)
        async with (
            bag.Player(tmp_path / "run", context=context, loop=True) as player,
            asyncio.TaskGroup() as tasks,
        ):
            playing = tasks.create_task(player.play())
            for _ in range(3):
                await reading()
                await clock.advance(1)
            await reading()
            player.stop()
            assert await playing
            assert ear.texts[:5] == ["a", "b", "a", "b", "a"]


async def test_a_piece_is_played_under_another_name_with_the_clock(tmp_path: Path) -> None:
    """Offset, duration and remapping belong together, for a test on one scene."""
    record(tmp_path / "run", "a", "b", "c", "d")
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock, "/replayed")
        times: list[int] = []
        node.create_subscription(Clock, "/clock", lambda msg: times.append(msg.clock.sec), 10)
        async with (
            bag.Player(
                tmp_path / "run",
                context=context,
                start_offset=Duration(seconds=1),
                duration=Duration(seconds=2),
                remap={"/words": "/replayed"},
                clock_hz=1,
            ) as player,
            asyncio.TaskGroup() as tasks,
        ):
            playing = tasks.create_task(player.play())
            await reading()
            await clock.advance(2)
            assert await playing
            assert ear.texts == ["b", "c"]
            assert times[0] == 102


async def test_several_bags_are_played_in_order_of_time(tmp_path: Path) -> None:
    """They were recorded by several computers of one robot."""
    paths = [record(tmp_path / "b", "2"), record(tmp_path / "a", "1", first_s=99)]
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock)
        async with bag.Player(paths, context=context) as player, asyncio.TaskGroup() as tasks:
            playing = tasks.create_task(player.play())
            await reading()
            await clock.advance(1)
            assert await playing
            assert ear.texts == ["1", "2"]


async def test_publishers_have_the_recorded_qos(tmp_path: Path) -> None:
    """A late subscription gets the map of the recording, as on the robot."""
    record(tmp_path / "run", "a")
    async with local_context() as context, bag.Player(tmp_path / "run", context=context) as player:
        (publisher,) = [each for each in player.node.publishers if each.topic_name == "/words"]
        assert publisher.qos_profile == LATCHED.resolved()


async def test_a_rate_that_is_not_positive_is_refused(tmp_path: Path) -> None:
    """Time would stand still or run backward; the service refuses it as well."""
    record(tmp_path / "run", "a")
    async with (
        local_context() as context,
        Node("user", context=context) as node,
        bag.Player(tmp_path / "run", context=context) as player,
    ):
        with pytest.raises(ValueError, match="positive"):
            player.set_rate(0)
        client = node.create_client(SetRate, "/rosbag2_player/set_rate")
        assert not (await client.call(SetRate.Request(rate=-1.0))).success
        asked = node.create_client(GetRate, "/rosbag2_player/get_rate")
        assert (await asked.call(GetRate.Request())).rate == 1


async def test_the_service_plays_from_an_offset(tmp_path: Path) -> None:
    """Its request gives the offset as a time, as in rosbag2."""
    record(tmp_path / "run", "a", "b", "c")
    heard: list[str] = []
    async with (
        local_context() as context,
        Node("user", context=context) as node,
        bag.Player(tmp_path / "run", context=context, rate=1000) as player,
    ):
        node.create_subscription(String, "/words", lambda msg: heard.append(msg.data), 50)
        client = node.create_client(Play, f"/{player.node.get_name()}/play")
        response = await client.call(Play.Request(start_offset=at(1).to_msg()))
        await settle()

    assert response.success
    assert heard == ["b", "c"]


async def test_requests_are_sent_as_by_their_client(tmp_path: Path) -> None:
    """Playing a recording sends its requests and goals to the current servers."""
    contents = ServiceIntrospectionState.CONTENTS
    sums: list[int] = []
    orders: list[int] = []
    cancels: list[int] = []
    waiting = asyncio.Event()

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        sums.append(request.a + request.b)
        return response

    async def count(goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
        orders.append(goal.request.order)
        if goal.request.order == 9:
            waiting.set()
            await asyncio.Event().wait()  # until it is cancelled
        goal.succeed()
        return Fibonacci.Result()

    def cancel(_: object) -> CancelResponse:
        cancels.append(1)
        return CancelResponse.ACCEPT

    async with local_context() as context, Node("robot", context=context) as node:
        service = node.create_service(AddTwoInts, "add", add)
        server = ActionServer(node, Fibonacci, "count", count, cancel_callback=cancel)
        for entity in (service, server):
            entity.configure_introspection(node.get_clock(), 10, contents)
        client = node.create_client(AddTwoInts, "add")
        action = node.create_action_client(Fibonacci, "count")
        wanted = bag.Selection(every=("service", "action"))
        async with bag.Recorder(tmp_path / "run", selection=wanted, context=context):
            await client.call(AddTwoInts.Request(a=2, b=3))
            await (await action.send_goal(Fibonacci.Goal(order=4))).result()
            goal = await action.send_goal(Fibonacci.Goal(order=9))
            await waiting.wait()
            await goal.cancel()
            await settle()
        assert (sums, orders, cancels) == ([5], [4, 9], [1])
        events: list[object] = []
        node.create_subscription(AddTwoInts.Event, "/add/_service_event", events.append, 10)
        async with bag.Player(
            tmp_path / "run", context=context, send_requests=("service", "action"), rate=100
        ) as player:
            assert await player.play()
        await settle()
        assert (sums, orders, cancels) == ([5, 5], [4, 9, 4, 9], [1, 1])
        assert len(events) == 2, "those of the server itself"


async def test_a_request_without_a_server_is_named(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """It is not kept for a server that appears later, when its time has passed."""
    event = AddTwoInts.Event(request=[AddTwoInts.Request(a=2)])
    event.info.event_type = 1
    with bag.BagWriter(tmp_path / "run") as out:
        out.write_message("/add/_service_event", event, Time(seconds=1))
    async with (
        local_context() as context,
        bag.Player(tmp_path / "run", context=context, send_requests=("service",)) as player,
    ):
        assert await player.play()
    assert [each.message for each in caplog.records if "it has no server" in each.message]


async def test_messages_are_played_in_the_order_in_which_they_were_sent(tmp_path: Path) -> None:
    """Over a slow network, messages arrive in another order."""
    with bag.BagWriter(tmp_path / "run") as out:
        number = out.add_topic(topic_info("/words", String))
        for text, received_s, sent_s in (("b", 10, 7), ("a", 11, 5), ("c", 12, 8)):
            raw = cdr.encode(String(data=text))
            out.write(number, received_s * 10**9, raw, publish_time_ns=sent_s * 10**9)
    clock = ManualClock()
    async with local_context(clock=clock) as context, Node("ear", context=context) as node:
        ear = Listener(node, clock)
        async with (
            bag.Player(tmp_path / "run", context=context, in_order_sent=True) as player,
            asyncio.TaskGroup() as tasks,
        ):
            playing = tasks.create_task(player.play())
            await reading()
            await clock.advance(1)
            assert await playing
        assert ear.texts == ["a", "b", "c"]
        assert player.played == 3


async def test_the_next_file_is_announced(tmp_path: Path) -> None:
    """On rosbag2's topic, also after seeking."""
    with bag.BagWriter(tmp_path / "run", max_messages=1) as out:
        for second in (1, 2, 3):
            out.write_message("/words", String(data=str(second)), at(second))
    async with local_context() as context, Node("ear", context=context) as node:
        told: list[ReadSplitEvent] = []
        node.create_subscription(ReadSplitEvent, "/events/read_split", told.append, 10)
        async with bag.Player(tmp_path / "run", context=context, rate=1000) as player:
            assert await player.play()
            await settle()
            assert [(event.closed_file, event.opened_file) for event in told] == [
                ("run_0.mcap", "run_1.mcap"),
                ("run_1.mcap", "run_2.mcap"),
            ]
            assert await player.play(Duration(seconds=1))
            await settle()
            assert len(told) == 3


async def test_the_clock_is_published_with_the_messages_of_a_topic(tmp_path: Path) -> None:
    """Nodes in simulated time then see no time between messages."""
    record(tmp_path / "run", "a", "b")
    async with local_context() as context, Node("ear", context=context) as node:
        times: list[int] = []
        node.create_subscription(Clock, "/clock", lambda msg: times.append(msg.clock.sec), 10)
        async with bag.Player(
            tmp_path / "run", context=context, clock_topics=["/words"], rate=100, wait_acked_sec=5
        ) as player:
            assert await player.play()
        await settle()
        assert times == [100, 101]


async def test_a_damaged_file_ends_playing_with_its_error(tmp_path: Path) -> None:
    """The error is that of `open` and `read`, not an ExceptionGroup."""
    record(tmp_path / "run", "a", "b")
    file = tmp_path / "run" / "run_0.mcap"
    data = bytearray(file.read_bytes())
    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    chunk = summary.chunk_indexes[0]
    end = chunk.chunk_start_offset + chunk.chunk_length
    data[end - 20 : end] = bytes(20)
    file.write_bytes(data)
    async with local_context() as context, bag.Player(tmp_path / "run", context=context) as player:
        with pytest.raises(BagError, match="aionode bag check"):
            await player.play()
