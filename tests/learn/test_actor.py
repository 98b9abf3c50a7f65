"""A policy that drives: when its actions go out, and what stops the robot; tests set the time."""

from __future__ import annotations

import asyncio
import math
import multiprocessing
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from aionode import Node
from aionode.clock import Time
from aionode.endpoints.lease import send_stops
from aionode.errors import (
    ContractError,
    EntityDestroyedError,
    LeaseExpiredError,
    MessageError,
    PolicyTooSlowError,
    StaleError,
)
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.learn import Actor, Contract
from aionode.testing import ManualClock, local_context, settle

FPS = 30
LEASE_SEC = 0.2

CONTRACT: dict[str, Any] = {
    "fps": FPS,
    "observations": [
        {
            "feature": "observation.state",
            "topic": "/joint_states",
            "type": "sensor_msgs/msg/JointState",
            "fields": ["position[0]"],
            "names": ["time"],
        }
    ],
    "actions": [
        {
            "feature": "action",
            "topic": "/cmd_vel",
            "type": "geometry_msgs/msg/Twist",
            "fields": ["angular.z"],
            "lower": -2.0,
            "upper": 2.0,
            "stop": "zero",
            "lease_sec": LEASE_SEC,
        }
    ],
}


def curve(time_s: float) -> float:
    """Return what the policy wants at a time, in rad/s."""
    return math.sin(1.2 * time_s)


class Robot:
    """A robot with one joint, which shows the time, and what its wheels got."""

    def __init__(self, clock: ManualClock, node: Node, wheels: Node) -> None:
        self.clock = clock
        self.node = node
        self.got: list[tuple[float, float]] = []
        self.joints = node.create_publisher(JointState, "/joint_states", 1)
        self.timer = node.create_timer(1 / FPS, self.show)
        wheels.create_subscription(Twist, "/cmd_vel", self.take, 100)

    @property
    def now_s(self) -> float:
        """The time."""
        return self.clock.now().nanoseconds / 1e9

    def show(self) -> None:
        """Publish an observation."""
        msg = JointState(name=["joint"], position=[self.now_s])
        msg.header.stamp = self.clock.now().to_msg()
        self.joints.publish(msg)

    def take(self, msg: Twist) -> None:
        """Note a command."""
        self.got.append((self.now_s, msg.angular.z))

    def policy(self, latency_s: float, length: int) -> Callable[[Any], Awaitable[np.ndarray]]:
        """Return a policy that follows the curve."""

        async def answer(seen: dict[str, np.ndarray]) -> np.ndarray:
            await self.node.get_clock().sleep(latency_s)
            since_s = float(seen["observation.state"][0])
            return np.array([[curve(since_s + (step + 1) / FPS)] for step in range(length)])

        return answer


@pytest.fixture
async def robot() -> AsyncIterator[Robot]:
    """A robot without a network."""
    clock = ManualClock(Time(nanoseconds=1_000_000_000))
    async with (
        local_context(clock=clock) as context,
        Node("robot", context=context) as node,
        Node("wheels", context=context) as wheels,
    ):
        yield Robot(clock, node, wheels)


def contract_of(**changes: Any) -> Contract:
    """Return the contract, with changes of its action."""
    return Contract.from_dict({**CONTRACT, "actions": [{**CONTRACT["actions"][0], **changes}]})


async def driven(
    robot: Robot, policy: Callable[..., Any], seconds: float, **options: Any
) -> tuple[Any, BaseException | None]:
    """Let a policy drive for a time; return the actor's statistics and what it ended with."""
    stats: Any = None
    ended: BaseException | None = None

    async def drive() -> None:
        nonlocal stats, ended
        try:
            async with contract_of().act(robot.node) as actor:
                stats = actor.stats
                await actor.run(policy, **options)
        except Exception as error:  # noqa: BLE001  # the test looks at it
            ended = error

    async with asyncio.TaskGroup() as tasks:
        driving = tasks.create_task(drive())
        await robot.clock.advance(seconds)
        driving.cancel()
    return stats, ended


# Latency: see LEROBOT.md


@pytest.mark.parametrize(
    ("latency_s", "length"), [(0.01, 16), (0.12, 16), (0.3, 21)], ids=["10 ms", "120 ms", "300 ms"]
)
async def test_actions_are_those_for_their_time_whatever_the_latency(
    robot: Robot, latency_s: float, length: int
) -> None:
    """Sent when the chunk arrives, 120 ms would be an error of 0.09; and nothing is missing."""
    stats, ended = await driven(robot, robot.policy(latency_s, length), 4.0)

    errors = [abs(value - curve(now_s)) for now_s, value in robot.got[:-1]]
    assert ended is None
    assert max(errors[1:]) < 0.001
    assert errors[0] < 1.2 / FPS  # the first one applies since up to a period
    assert stats.underruns == 0
    assert stats.sent == len(robot.got) - 1 >= (4.0 - latency_s) * FPS - 3


async def test_a_policy_slower_than_half_its_chunk_is_reported_before_anything_moves(
    robot: Robot, caplog: pytest.LogCaptureFixture
) -> None:
    """One inference at a time cannot do it: 0.3 s for 0.53 s. The missing actions are counted."""
    policy = robot.policy(0.3, 16)
    reported: list[bool] = []

    async def answer(seen: dict[str, np.ndarray]) -> np.ndarray:
        reported.append("more than half" in caplog.text)
        assert len(reported) == 1 or reported[-1]
        assert bool(robot.got) <= reported[-1]
        return await policy(seen)

    stats, ended = await driven(robot, answer, 4.0)

    assert ended is None
    assert "took 0.300 s to answer with actions for 0.533 s, more than half" in caplog.text
    assert stats.underruns > 0
    assert stats.sent + stats.underruns == pytest.approx((4.0 - 0.3) * FPS, abs=4)


async def test_a_policy_slower_than_its_chunk_is_an_error_and_nothing_moves(robot: Robot) -> None:
    """It would stand still forever, and nothing would say so."""
    stats, ended = await driven(robot, robot.policy(0.7, 16), 4.0)

    assert isinstance(ended, PolicyTooSlowError)
    assert (ended.latency_sec, ended.chunk_sec) == pytest.approx((0.7, 16 / FPS))
    assert stats.sent == 0
    assert [value for _, value in robot.got] == [0.0]  # the stop of the lease


async def test_a_slow_first_answer_is_tolerated(robot: Robot) -> None:
    """It loads the weights, or compiles."""
    latencies = [5.0]

    async def answer(seen: dict[str, np.ndarray]) -> np.ndarray:
        return await robot.policy(latencies.pop() if latencies else 0.02, 16)(seen)

    stats, ended = await driven(robot, answer, 8.0)

    assert ended is None
    assert stats.underruns == 0
    assert stats.latency.max_ns < 1e9


async def test_a_single_action_is_a_chunk(robot: Robot) -> None:
    """A policy that answers every picture with one action."""

    def answer(seen: dict[str, np.ndarray]) -> list[float]:
        return [curve(float(seen["observation.state"][0]) + 1 / FPS)]

    stats, ended = await driven(robot, answer, 2.0)

    assert ended is None
    assert stats.underruns == 0
    assert max(abs(value - curve(now_s)) for now_s, value in robot.got[:-1]) < 0.001


# What stops the robot


async def test_a_policy_that_hangs_stops_the_robot_within_the_lease(robot: Robot) -> None:
    """After its chunk, whose actions it has asked for."""
    asked = 0

    async def answer(seen: dict[str, np.ndarray]) -> np.ndarray:
        nonlocal asked
        asked += 1
        if asked == 4:
            await asyncio.Event().wait()
        return np.ones((16, 1))

    stats, ended = await driven(robot, answer, 6.0)

    assert isinstance(ended, LeaseExpiredError)
    assert "the policy was asked" in ended.__notes__[0]
    last_s = max(now_s for now_s, value in robot.got if value)
    stop_s = min(now_s for now_s, value in robot.got if now_s > last_s)
    assert stop_s - last_s == pytest.approx(LEASE_SEC, abs=0.001)
    assert robot.got[-1][1] == 0.0
    assert stats.underruns >= LEASE_SEC * FPS - 2


async def test_a_policy_that_fails_stops_the_robot_at_once(robot: Robot) -> None:
    """It raises what the policy raised."""
    asked = 0

    def answer(seen: dict[str, np.ndarray]) -> np.ndarray:
        nonlocal asked
        asked += 1
        if asked == 3:
            raise ArithmeticError("no gradient")
        return np.ones((4, 1))

    _, ended = await driven(robot, answer, 2.0)

    assert isinstance(ended, ArithmeticError)
    assert robot.got[-1][1] == 0.0


@pytest.mark.parametrize("bad", [math.nan, math.inf])
async def test_a_value_that_is_not_a_number_stops_the_robot(robot: Robot, bad: float) -> None:
    """NaN is not a command, and no limit catches it."""
    _, ended = await driven(robot, lambda _: [[1.0], [bad]], 1.0)

    assert isinstance(ended, ValueError)
    assert "angular.z of action 1" in str(ended)
    assert [value for _, value in robot.got] == [0.0]


async def test_observations_that_end_stop_the_robot(robot: Robot) -> None:
    """The chunk that was planned is sent; then there is nothing to answer."""
    async with asyncio.TaskGroup() as tasks:

        async def blind() -> None:
            await robot.node.get_clock().sleep(1.0)
            robot.timer.cancel()

        tasks.create_task(blind())
        stats, ended = await driven(robot, robot.policy(0.01, 16), 4.0)

    assert isinstance(ended, StaleError | LeaseExpiredError)
    assert robot.got[-1][1] == 0.0
    assert robot.got[-1][0] <= 2.0 + 17 / FPS + LEASE_SEC
    assert stats.sent > 30


async def go_on(robot: Robot, actor: Actor) -> None:
    """Plan more, as a block that goes on in spite of its end."""
    for _ in range(5):
        actor.plan([[1.0]], robot.clock.now())
        await robot.clock.advance(0.1)


async def sent(robot: Robot, contract: Contract, *rows: float) -> Actor:
    """Send one chunk, and then nothing until the block of the actor ends."""
    async with contract.act(robot.node) as actor:
        actor.plan(np.array(rows)[:, np.newaxis], robot.clock.now())
        try:
            await asyncio.gather(robot.clock.advance(1.0), asyncio.Event().wait())
        finally:
            with pytest.raises((LeaseExpiredError, MessageError)):
                await go_on(robot, actor)
    return actor


async def test_nothing_follows_the_stop(robot: Robot) -> None:
    """A block that goes on in spite of its end has no say any more."""
    with pytest.raises(LeaseExpiredError):
        await sent(robot, contract_of(), 1.0, 2.0)
    assert [value for _, value in robot.got] == [1.0, 2.0, 0.0]


# Chunks


async def by_hand(
    contract: Contract, node: Node, policy: Callable[[dict[str, np.ndarray]], np.ndarray]
) -> None:
    """Ask a policy ten times a second."""
    async with contract.observe(node) as observations, contract.act(node) as actor:
        async for seen in observations.at(10):
            chunk = await asyncio.to_thread(policy, seen.values)
            actor.plan(chunk, since=seen.at)


async def test_a_loop_by_hand_does_what_run_does(robot: Robot) -> None:
    """For programs that want more of it."""

    def policy(seen: dict[str, np.ndarray]) -> np.ndarray:
        since_s = float(seen["observation.state"][0])
        return np.array([[curve(since_s + (step + 1) / FPS)] for step in range(16)])

    asyncio.get_running_loop().set_default_executor(ThreadPoolExecutor(1))
    async with asyncio.TaskGroup() as tasks:
        driving = tasks.create_task(by_hand(contract_of(), robot.node, policy))
        for _ in range(60):
            await robot.clock.advance(1 / FPS)
            await asyncio.to_thread(int)  # after what the one thread has to do
        driving.cancel()
    assert len(robot.got) > 50
    assert max(abs(value - curve(now_s)) for now_s, value in robot.got[1:-1]) < 0.001


async def test_limits_clamp_and_are_counted(robot: Robot) -> None:
    """The contract's, not the policy's."""
    async with contract_of().act(robot.node) as actor:
        actor.plan([[9.0], [1.0], [-9.0]], robot.clock.now())
        await robot.clock.advance(0.11)
        assert [value for _, value in robot.got] == [2.0, 1.0, -2.0]
        assert (actor.stats.sent, actor.stats.clamped) == (3, 2)


async def test_a_chunk_of_another_shape_is_refused(robot: Robot) -> None:
    """The error says what is valid."""
    async with contract_of().act(robot.node) as actor:
        with pytest.raises(
            ValueError, match=r"shape is \(1, 2\); pass a row of 1 numbers .*angular.z"
        ):
            actor.plan([[1.0, 2.0]], robot.clock.now())


async def test_an_action_may_be_sent_now(robot: Robot) -> None:
    """By a loop that has a pace of its own, however fast it is."""
    async with contract_of().act(robot.node) as actor:
        for value in (1.0, 1.5, 9.0):
            actor.send([value])
            await robot.clock.advance(0.001)
        assert (actor.stats.sent, actor.stats.clamped) == (3, 1)
    await settle()
    assert [value for _, value in robot.got] == [1.0, 1.5, 2.0, 0.0]


async def test_what_is_left_over_answers_the_observation(robot: Robot) -> None:
    """Its first row is for one period after it, as that of a chunk is."""
    async with contract_of().act(robot.node) as actor:
        actor.plan([[1.0], [2.0], [1.5]], robot.clock.now())
        await robot.clock.advance(0.04)
        assert actor.left_over().ravel().tolist() == [2.0, 1.5]


async def test_a_policy_is_given_what_is_left_over(robot: Robot) -> None:
    """If it takes two arguments: for real-time chunking."""
    given: list[int] = []

    async def answer(seen: dict[str, np.ndarray], left_over: np.ndarray) -> np.ndarray:
        given.append(len(left_over))
        return await robot.policy(0.1, 16)(seen)

    await driven(robot, answer, 2.0)
    assert given[0] == 0
    assert given[1:] == [3] * (len(given) - 1)


async def test_a_function_runs_in_a_thread_of_its_own(robot: Robot) -> None:
    """The loop sends meanwhile; and it is always the same thread."""
    threads: set[threading.Thread] = set()

    def answer(seen: dict[str, np.ndarray]) -> np.ndarray:
        threads.add(threading.current_thread())
        return np.ones((4, 1))

    await driven(robot, answer, 0.5)
    (thread,) = threads
    assert thread is not threading.main_thread()
    thread.join(10)
    assert not thread.is_alive()


def half(seen: dict[str, np.ndarray]) -> np.ndarray:
    """Answer with the number of the process."""
    return np.full((4, 1), 0.5 + (multiprocessing.parent_process() is not None))


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
async def test_a_function_may_run_in_another_process(robot: Robot) -> None:
    """It may hold the GIL there."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as executor:
        await driven(robot, half, 0.5, executor=executor)
    assert {value for _, value in robot.got[:-1]} == {1.5}


async def test_a_robot_that_holds_gets_its_last_command_again(robot: Robot) -> None:
    """An arm with commands of positions: zero would be a motion."""
    with pytest.raises(LeaseExpiredError):
        await sent(robot, contract_of(stop="hold"), 1.0, 0.5)
    assert [value for _, value in robot.got] == [1.0, 0.5, 0.5]


async def test_a_robot_that_holds_is_stopped_past_the_loop(robot: Robot) -> None:
    """As by a second Ctrl-C, and at the end of the interpreter."""

    async def drive() -> None:
        async with contract_of(stop="hold").act(robot.node) as actor:
            actor.send([0.5])
            assert await asyncio.to_thread(send_stops, 0)
            await asyncio.Event().wait()

    with pytest.raises(LeaseExpiredError, match="the process was about to end"):
        await drive()
    await settle()
    assert [value for _, value in robot.got] == [0.5, 0.5]


async def test_a_robot_that_holds_gets_its_last_command_again_as_the_block_ends(
    robot: Robot,
) -> None:
    """Nobody has to wait for the end of the lease."""
    async with contract_of(stop="hold").act(robot.node) as actor:
        actor.send([0.5])
    await settle()
    assert [value for _, value in robot.got] == [0.5, 0.5]


async def test_a_robot_that_holds_is_sent_nothing_before_the_first_command(robot: Robot) -> None:
    """There is nothing to hold."""
    async with contract_of(stop="hold").act(robot.node):
        await robot.clock.advance(1.0)
    assert robot.got == []


async def test_a_number_that_its_field_cannot_hold_ends_the_block(robot: Robot) -> None:
    """The contract has no limit for it."""
    contract = contract_of(
        type="std_msgs/msg/Int8", topic="/gear", fields=["data"], lower=-1e9, upper=1e9
    )
    with pytest.raises(MessageError):
        await sent(robot, contract, 1.0, 300.0)


async def test_a_number_that_its_field_cannot_hold_is_reported_at_once(robot: Robot) -> None:
    """By the call that has it, rather than by the next one."""
    contract = contract_of(type="std_msgs/msg/Int8", topic="/gear", fields=["data"], upper=1e9)
    async with contract.act(robot.node) as actor:
        with pytest.raises(MessageError):
            actor.send([300.0])


async def test_a_lease_that_is_shorter_than_the_time_between_actions_is_refused(
    robot: Robot,
) -> None:
    """It would end between two of them."""
    with pytest.raises(ContractError, match=r"lease_sec: 0.04 s; use more than 0.050 s"):
        contract_of(lease_sec=0.04).act(robot.node)


async def test_a_node_that_ends_refuses_further_chunks(robot: Robot) -> None:
    """Its stop was its last message."""
    async with contract_of().act(robot.node) as actor:
        actor.plan([[1.0], [1.0]], robot.clock.now())
        robot.node.destroy_node()
        await robot.clock.advance(0.1)
        with pytest.raises(EntityDestroyedError):
            actor.plan([[1.0]], robot.clock.now())
