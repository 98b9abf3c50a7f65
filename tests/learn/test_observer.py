"""What a robot shows at a time: every feature as of the reference. The test sets the time."""

from __future__ import annotations

import asyncio
import contextlib
import math
from collections.abc import AsyncIterator, Coroutine
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Node
from aionode.clock import Time
from aionode.errors import MessageError, StaleError
from aionode.image import from_numpy
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_msgs.msg import Header
from aionode.learn import Contract
from aionode.learn._observer import History, Seen
from aionode.learn._series import Series, in_order
from aionode.testing import ManualClock, local_context, settle

MS = 1_000_000

CONTRACT = Contract.from_dict(
    {
        "fps": 10,
        "observations": [
            {
                "feature": "observation.images.front",
                "topic": "/camera",
                "type": "sensor_msgs/msg/Image",
                "image": "color",
                "height": 2,
                "width": 3,
            },
            {
                "feature": "observation.state",
                "topic": "/arm",
                "type": "sensor_msgs/msg/JointState",
                "fields": ["position[0]"],
                "names": ["arm"],
                "max_age": 0.1,
            },
            {
                "feature": "observation.state",
                "topic": "/gripper",
                "type": "sensor_msgs/msg/JointState",
                "fields": ["position[0]"],
                "names": ["gripper"],
                "resample": "hold",
                "max_age": 0.5,
            },
        ],
        "actions": [
            {
                "feature": "action",
                "topic": "/cmd",
                "type": "std_msgs/msg/Float64",
                "fields": ["data"],
                "stop": "zero",
            }
        ],
    }
)


class Robot:
    """A camera and two joints, whose messages a test stamps."""

    def __init__(self, clock: ManualClock, node: Node) -> None:
        self.clock = clock
        self.node = node
        self.camera = node.create_publisher(Image, "/camera", 10)
        self.joints = {
            name: node.create_publisher(JointState, f"/{name}", 10) for name in ("arm", "gripper")
        }

    async def show(self, time_ms: int, value: int = 0, height: int = 2) -> None:
        """Publish a picture."""
        pixels = np.full((height, 3, 3), value, np.uint8)
        self.camera.publish(from_numpy(pixels, "rgb8", header=header(time_ms)))
        await settle()

    async def move(self, name: str, time_ms: int, value: float) -> None:
        """Publish the place of a joint."""
        self.joints[name].publish(JointState(header=header(time_ms), position=[value]))
        await settle()


def header(time_ms: int) -> Header:
    """Return a header with a stamp."""
    return Header(stamp=Time(nanoseconds=time_ms * MS).to_msg())


@pytest.fixture
async def robot() -> AsyncIterator[Robot]:
    """A robot at 1 s, without a network."""
    clock = ManualClock(Time(nanoseconds=1000 * MS))
    async with local_context(clock=clock) as context, Node("robot", context=context) as node:
        yield Robot(clock, node)


def begin(work: Coroutine[Any, Any, Seen]) -> asyncio.Task[Seen]:
    """Begin a task, whose end the test waits for."""
    return asyncio.get_running_loop().create_task(work)


async def next_of(seen: AsyncIterator[Seen]) -> Seen:
    """Return the next observation; fail if there is none yet."""
    async with asyncio.timeout(50):
        return await anext(seen)


async def test_everything_is_as_of_the_reference(robot: Robot) -> None:
    """Numbers between two messages in proportion, or held, as the contract says."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 950, 1.0)
        await robot.move("gripper", 800, 5.0)
        await robot.move("arm", 1050, 2.0)
        await robot.move("gripper", 1040, 6.0)
        await robot.show(975, 7)

        seen = await next_of(observations.at())
        assert seen.at.nanoseconds == 975 * MS
        assert seen.values["observation.state"].tolist() == [1.25, 5.0]
        assert seen.values["observation.images.front"].tolist() == [[[7] * 3] * 3] * 2
        assert seen.age == {
            "observation.images.front": 0.0,
            "observation.state": pytest.approx(0.175),
        }


async def test_infinite_numbers_are_observed_if_the_contract_says_what_they_mean(
    robot: Robot,
) -> None:
    """As in the rows that an export makes."""
    given = CONTRACT.to_dict()
    given["observations"][1]["infinity"] = 12.0
    async with Contract.from_dict(given).observe(robot.node) as observations:
        await robot.move("arm", 950, math.inf)
        await robot.move("gripper", 800, 5.0)
        await robot.show(975)
        seen = await next_of(observations.at())
        assert seen.values["observation.state"].tolist() == [12.0, 5.0]


async def test_the_newest_reference_counts_and_none_twice(robot: Robot) -> None:
    """References that came while a policy computed are left out."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 960, 1.0)
        await robot.move("gripper", 960, 1.0)
        for time_ms in (960, 980, 1000):
            await robot.show(time_ms)
        seen = observations.at(100)
        assert (await next_of(seen)).at.nanoseconds == 1000 * MS
        waiting = begin(next_of(seen))
        await settle()
        assert not waiting.done()
        await robot.show(1010)
        assert (await waiting).at.nanoseconds == 1010 * MS


async def test_a_fast_reference_is_thinned_out(robot: Robot) -> None:
    """As many a second as asked for, by their stamps."""
    times = []
    async with CONTRACT.observe(robot.node) as observations:

        async def look() -> None:
            async for seen in observations.at():
                times.append(seen.at.nanoseconds // MS)  # noqa: PERF401  # it is cancelled

        async with asyncio.TaskGroup() as tasks:
            looking = tasks.create_task(look())
            for time_ms in range(1000, 1300, 20):
                await robot.move("arm", time_ms, 1.0)
                await robot.move("gripper", time_ms, 1.0)
                await robot.show(time_ms)
                await robot.clock.advance(0.02)
            looking.cancel()
    assert times == [1000, 1080, 1160, 1240]


async def test_a_topic_that_is_never_heard_is_named(robot: Robot) -> None:
    """After five seconds; before that it may be starting."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 1000, 1.0)
        waiting = begin(next_of(observations.at()))
        for time_ms in range(1000, 6100, 100):
            assert not waiting.done()
            await robot.show(time_ms)
            await robot.move("arm", time_ms, 1.0)
            await robot.clock.advance(0.1)
        with pytest.raises(StaleError, match="/gripper was never heard") as raised:
            await waiting
        assert raised.value.ages == {"/gripper": None}


async def test_a_robot_that_is_not_there_is_named(robot: Robot) -> None:
    """Its reference is missing too."""
    async with CONTRACT.observe(robot.node) as observations:
        waiting = begin(next_of(observations.at()))
        await robot.clock.advance(4.9)
        assert not waiting.done()
        await robot.clock.advance(0.2)
        with pytest.raises(StaleError, match="/camera was never heard"):
            await waiting


async def test_what_is_too_old_at_the_reference_is_named(robot: Robot) -> None:
    """With its age, and what the contract allows."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 800, 1.0)
        await robot.move("gripper", 800, 1.0)
        await robot.show(1000)
        with pytest.raises(StaleError, match=r"/arm is 0.200 s old; at most 0.1 s are") as raised:
            observations.newest()
        assert raised.value.ages == {"/arm": pytest.approx(0.2)}


async def test_a_reference_that_falls_silent_is_named(robot: Robot) -> None:
    """As soon as its next message would have been too old."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 1000, 1.0)
        await robot.move("gripper", 1000, 1.0)
        await robot.show(1000)
        seen = observations.at()
        await next_of(seen)
        waiting = begin(next_of(seen))
        await robot.clock.advance(0.249)
        assert not waiting.done()
        await robot.clock.advance(0.002)
        with pytest.raises(StaleError, match=r"/camera is 0\.250 s old"):
            await waiting


async def test_a_camera_with_another_clock_is_named(robot: Robot) -> None:
    """Its actions would be for another time."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 5000, 1.0)
        await robot.move("gripper", 5000, 1.0)
        await robot.show(5000)
        with pytest.raises(StaleError, match=r"/camera is -4.000 s old"):
            observations.newest()


async def test_a_picture_of_another_size_is_an_error(robot: Robot) -> None:
    """The policy was trained on others."""
    async with CONTRACT.observe(robot.node) as observations:
        await robot.move("arm", 1000, 1.0)
        await robot.move("gripper", 1000, 1.0)
        await robot.show(1000, height=4)
        with pytest.raises(MessageError, match="contract has 3 by 2"):
            observations.newest()


async def test_one_reference_of_the_future_does_not_shut_out_the_next(robot: Robot) -> None:
    """It is named once; an export leaves it out, too."""
    async with CONTRACT.observe(robot.node) as observations:
        for time_ms in range(1000, 1400, 100):
            await robot.move("arm", time_ms, 1.0)
            await robot.move("gripper", time_ms, 1.0)
            await robot.show(time_ms + (100_000 if time_ms == 1200 else 0))
            if time_ms == 1200:
                with pytest.raises(StaleError, match=r"/camera is -100\.000 s old"):
                    await next_of(observations.at())
            else:
                assert (await next_of(observations.at())).at.nanoseconds == time_ms * MS
            await robot.clock.advance(0.1)


async def test_a_reference_that_falls_silent_after_a_false_time_is_named(robot: Robot) -> None:
    """As soon as without it, as its arrival counts."""
    async with CONTRACT.observe(robot.node) as observations:
        for time_ms in (1000, 100_000):
            await robot.move("arm", 1000, 1.0)
            await robot.move("gripper", 1000, 1.0)
            await robot.show(time_ms)
            with contextlib.suppress(StaleError):
                await next_of(observations.at())
        waiting = begin(next_of(observations.at()))
        await robot.clock.advance(0.251)
        assert waiting.done()
        with pytest.raises(StaleError):
            await waiting


async def test_one_joint_of_the_future_does_not_shut_out_the_next(robot: Robot) -> None:
    """It does not make the messages before it disappear either."""
    async with CONTRACT.observe(robot.node) as observations:
        for time_ms in (930, 950, 100_000, 970):
            await robot.move("arm", time_ms, time_ms / 1000)
            await robot.move("gripper", 900, 5.0)
        for time_ms in (940, 970):
            await robot.show(time_ms)
            seen = await next_of(observations.at(100))
            assert seen.values["observation.state"].tolist() == pytest.approx([time_ms / 1000, 5])


def histories(messages: list[tuple[int, int]]) -> tuple[History, list[int]]:
    """Return a history of messages, given their times and arrivals, and what an export keeps."""
    history = History()
    for time_ms, arrival_ms in messages:
        history.add(time_ms * MS, arrival_ms * MS, time_ms)
    times, arrivals = (np.array(each, np.int64) * MS for each in zip(*messages, strict=True))
    count = len(messages)
    series = Series(times, arrivals, np.empty((count, 0)), np.arange(count))
    return history, in_order(series).times.tolist()


@given(
    steps=st.lists(st.integers(min_value=1, max_value=15), min_size=4, max_size=60),
    place=st.integers(min_value=2, max_value=57),
    error_ms=st.integers(min_value=-100_000, max_value=100_000),
)
def test_a_history_keeps_what_an_export_keeps(steps: list[int], place: int, error_ms: int) -> None:
    """A false time, in the past or in the future, is left out once the next message has come."""
    arrivals = np.cumsum(steps).tolist()
    false = min(place, len(steps) - 2)
    times = [each + error_ms * (at == false) for at, each in enumerate(arrivals)]
    history, exported = histories(list(zip(times, arrivals, strict=True)))
    assert history.times == exported
    assert [each * MS for each in history.messages] == exported


@given(times=st.lists(st.integers(min_value=0, max_value=3_000), min_size=1, max_size=60))
def test_a_history_is_in_order(times: list[int]) -> None:
    """Whatever the times and however they arrive."""
    history, _ = histories([(time, 10 * at) for at, time in enumerate(times)])
    assert history.times == sorted(set(history.times))
    assert [each * MS for each in history.messages] == history.times


def test_a_simulation_that_begins_again_is_observed() -> None:
    """Its times are before all others, and so are their arrivals."""
    history, _ = histories([(9000, 9000), (9010, 9010), (0, 0), (10, 10)])
    assert history.messages == [0, 10]


def test_a_history_is_bounded() -> None:
    """A reference that is silent may not fill the memory with another camera's pictures."""
    history = History()
    for index in range(5_000):
        history.add(index * MS // 10, index * MS // 10, index)
    assert len(history.times) == len(history.messages) == 2_000
