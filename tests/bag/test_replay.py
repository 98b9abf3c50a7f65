"""Nodes that process a recording in stepped time publish the same in each run."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import time  # noqa: TID251  # what nodes must not use is tested
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from aionode import bag
from aionode.action import ServerGoalHandle
from aionode.bag import MachineUseWarning, Outputs
from aionode.clock import Time
from aionode.errors import BagError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from aionode.interfaces.std_msgs.msg import Float64, String
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.node import Node
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

START_NS = 1_700_000_000_000_000_000
MS = 1_000_000
SIM_TIME = Parameter("use_sim_time", value=True)


def write(path: Path, messages: Iterable[tuple[str, Any, int]]) -> Path:
    """Write a bag of messages with topics and times, in milliseconds after its start."""
    with bag.BagWriter(path) as writer:
        for topic, message, at_ms in messages:
            writer.write_message(topic, message, Time(nanoseconds=START_NS + at_ms * MS))
    return path


@pytest.fixture
def numbers(tmp_path: Path) -> Path:
    """A bag with ten numbers, one every 100 ms."""
    return write(tmp_path / "run", [("/x", Float64(data=float(i)), 100 * i) for i in range(10)])


def times_ms(outputs: Outputs) -> list[int]:
    """Return the times of what was published, in milliseconds after the start."""
    return [(record.time_ns - START_NS) // MS for record in outputs.records]


class Doubler(Node):
    """Publishes twice what it hears."""

    def __init__(self, factor: float = 2.0, **options: Any) -> None:
        super().__init__("doubler", **options)
        publisher = self.create_publisher(Float64, "/y", 10)
        self.create_subscription(
            Float64, "/x", lambda msg: publisher.publish(Float64(data=factor * msg.data)), 10
        )


async def play(
    path: Path, make: Callable[[Node, Callable[[str], None]], None], record: str = "/out"
) -> Outputs:
    """Play a bag to a node whose entities `make` creates; `make` is passed a publish function."""
    async with bag.replay(path) as run:
        node = Node("node", context=run.context)
        publisher = node.create_publisher(String, record, 100)
        make(node, lambda text: publisher.publish(String(data=text)))
        return await run.play(record=[record])


def texts(outputs: Outputs) -> list[str]:
    """Return the words that were published."""
    return [record.message.data for record in outputs.records]


async def test_each_message_is_published_at_its_own_time(numbers: Path) -> None:
    """Nodes see the robot's times, not those of the test."""
    async with bag.replay(numbers) as run:
        Doubler(context=run.context)
        outputs = await run.play(record=["/y"])

    assert [record.message.data for record in outputs.records] == [2.0 * i for i in range(10)]
    assert times_ms(outputs) == [100 * i for i in range(10)]


async def test_nodes_without_a_context_join_the_run(numbers: Path) -> None:
    """Nodes written by users take no context argument."""
    async with bag.replay(numbers) as run:
        Doubler()
        outputs = await run.play(record=["y"])

    assert len(outputs.records) == 10


async def test_timers_sleeps_timeouts_and_threads_follow_the_recording(numbers: Path) -> None:
    """Each wait takes as long as on the robot in stepped time, and no real time."""

    def make(node: Node, say: Callable[[str], None]) -> None:
        async def work() -> None:
            timer.cancel()
            await node.get_clock().sleep(0.05)
            await asyncio.sleep(0.1)  # noqa: TID251  # nodes of users do
            say("slept")
            try:
                async with asyncio.timeout(0.2):
                    await asyncio.Event().wait()
            except TimeoutError:
                say("timed out")
            say(await asyncio.to_thread(lambda: "thread"))

        timer = node.create_timer(0.25, work)

    outputs = await play(numbers, make)

    assert list(zip(texts(outputs), times_ms(outputs), strict=True)) == [
        ("slept", 400),
        ("timed out", 600),
        ("thread", 600),
    ]


async def test_services_and_actions_follow_the_recording(numbers: Path) -> None:
    """A goal takes as long as on the robot, and its id is the same in each run."""
    ids: list[bytes] = []

    def make(node: Node, say: Callable[[str], None]) -> None:
        async def execute(goal: Any) -> Fibonacci.Result:
            ids.append(bytes(goal.goal_id.uuid))
            await asyncio.sleep(0.3)  # noqa: TID251  # as above
            goal.succeed()
            return Fibonacci.Result(sequence=[1, 2])

        def serve(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            response.success = True
            return response

        async def ask() -> None:
            timer.cancel()
            result = await actions.call(Fibonacci.Goal(order=2))
            answer = await client.call(Trigger.Request(), timeout_sec=1.0)
            say(f"{result.sequence.tolist()} {answer.success}")

        node.create_action_server(Fibonacci, "fibonacci", execute)
        node.create_service(Trigger, "trigger", serve, offload=True)
        actions = node.create_action_client(Fibonacci, "fibonacci")
        client = node.create_client(Trigger, "trigger")
        timer = node.create_timer(0.1, ask)

    runs = [await play(numbers, make) for _ in range(2)]

    assert texts(runs[0]) == ["[1, 2] True"]
    assert times_ms(runs[0]) == [400]
    assert runs[0].digest() == runs[1].digest()
    assert ids[0] == ids[1]


async def test_a_goal_is_sent_while_the_recording_plays(
    replay_bag: Callable[..., bag.Replay], numbers: Path
) -> None:
    """The node under test serves it; the test sends it at a time of the recording."""
    done: list[int] = []

    async with replay_bag(numbers) as run:
        doubler = Doubler()
        client = Node("operator").create_action_client(Fibonacci, "count")

        async def count(goal: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
            await doubler.get_clock().sleep(0.3)
            goal.succeed()
            return Fibonacci.Result(sequence=range(goal.request.order))

        async def send() -> None:
            timer.cancel()
            result = await client.call(Fibonacci.Goal(order=3))
            done.extend(result.sequence)

        doubler.create_action_server(Fibonacci, "count", count)
        timer = doubler.create_timer(0.2, send)
        outputs = await run.play(record=["/y"], topics=["/x"])

    assert done == [0, 1, 2]
    assert [record.message.data for record in outputs.records][:3] == [0.0, 2.0, 4.0]


async def test_simulated_time_follows_the_clock_in_the_recording(tmp_path: Path) -> None:
    """A bag of a simulation contains /clock, which nodes with use_sim_time follow."""
    ticks = [ClockMsg(clock=Time(nanoseconds=i * 500 * MS).to_msg()) for i in range(5)]
    path = write(tmp_path / "sim", [("/clock", tick, 10 * i) for i, tick in enumerate(ticks)])
    async with bag.replay(path) as run:
        node = Node("node", context=run.context, parameter_overrides=[SIM_TIME])
        publisher = node.create_publisher(String, "/out", 10)
        node.create_timer(
            1.0, lambda: publisher.publish(String(data=str(node.get_clock().now().nanoseconds)))
        )
        outputs = await run.play(record=["/out"])

    assert texts(outputs) == ["1000000000", "2000000000"]
    assert times_ms(outputs) == [20, 40]


async def test_what_is_recorded_is_not_played_as_well(tmp_path: Path) -> None:
    """A recording of a robot also contains what the nodes under test published."""
    path = write(tmp_path / "run", [("/x", Float64(data=1.0), 0), ("/y", Float64(data=9.0), 1)])
    async with bag.replay(path) as run:
        Doubler(context=run.context)
        outputs = await run.play(record=["/y"])

    assert [record.message.data for record in outputs.records] == [2.0]


async def test_a_failing_callback_ends_the_run_with_its_error(numbers: Path) -> None:
    """A test must fail when a node fails."""

    def fail(_: Float64) -> None:
        raise ZeroDivisionError

    with pytest.raises(ExceptionGroup) as caught:  # noqa: PT012  # the block is the subject
        async with bag.replay(numbers) as run:
            Node("node", context=run.context).create_subscription(Float64, "/x", fail, 10)
            await run.play()

    assert caught.value.subgroup(ZeroDivisionError) is not None


async def test_an_error_of_the_test_propagates_unchanged(numbers: Path) -> None:
    """An assertion in the block is reported like any other."""
    with pytest.raises(AssertionError, match="as it is"):  # noqa: PT012  # as above
        async with bag.replay(numbers) as run:
            Doubler(context=run.context)
            await run.play(record=["/y"])
            raise AssertionError("as it is")


async def test_a_topic_that_nobody_publishes_is_an_error(numbers: Path) -> None:
    """A misspelled name would record nothing, and every comparison would succeed."""
    with pytest.raises(BagError, match="no node of the run publishes /cmd; "):  # noqa: PT012  # as above
        async with bag.replay(numbers) as run:
            Doubler(context=run.context)
            await run.play(record=["/cmd"])


@pytest.mark.skipif(sys.version_info < (3, 12), reason="nothing is watched there")
async def test_the_first_use_of_the_machines_time_is_named(numbers: Path) -> None:
    """The cause of a difference between runs is hard to find in the outputs."""

    def make(node: Node, say: Callable[[str], None]) -> None:
        node.create_timer(0.1, lambda: say(str(time.time())))  # nodes of users do

    with pytest.warns(MachineUseWarning, match=r"time\.time\(\) is called during a") as warned:
        await play(numbers, make)

    assert len(warned) == 1
    assert warned[0].filename == __file__


async def test_outputs_can_be_saved_and_read(numbers: Path, tmp_path: Path) -> None:
    """Later runs are compared with a result that was right once."""
    async with bag.replay(numbers) as run:
        Doubler(context=run.context)
        outputs = await run.play(record=["/y"])
    outputs.save(tmp_path / "golden")

    with bag.open(tmp_path / "golden") as saved:
        assert Outputs(saved.read()).digest() == outputs.digest()


@pytest.mark.slow
@pytest.mark.processes
def test_another_process_with_other_hashes_publishes_the_same(numbers: Path) -> None:
    """The order of sets and the addresses of objects differ between processes."""
    digests = {
        subprocess.run(  # the program below
            [sys.executable, "-c", PROGRAM, str(numbers), loop],
            env={"PYTHONHASHSEED": seed, "PATH": "", "PYTHONPATH": str(Path(__file__).parents[2])},
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        for seed, loop in (("1", "asyncio"), ("2", "uvloop"))
    }

    assert len(digests) == 1
    assert len(digests.pop().strip()) == 64


PROGRAM = """
import asyncio, sys
from aionode import Node, bag
from aionode.interfaces.std_msgs.msg import Float64, String

async def main():
    async with bag.replay(sys.argv[1]) as run:
        for name in ("one", "two", "three"):
            node = Node(name, context=run.context)
            publisher = node.create_publisher(String, "/out", 10)
            async def answer(msg, node=node, publisher=publisher):
                await asyncio.to_thread(lambda: None)
                now = node.get_clock().now()
                publisher.publish(String(data=f"{node.get_name()} {msg.data} {now}"))
            node.create_subscription(Float64, "/x", answer, 10)
        print((await run.play(record=["/out"])).digest())

if sys.argv[2] == "uvloop":
    import uvloop
    uvloop.run(main())
else:
    asyncio.run(main())
"""
