"""Nodes that are run again when they fail, and what is said of them."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from aionode._process.concurrency import checkpoint
from aionode.errors import NodeNotRunningError
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.supervisor import Supervisor
from aionode.testing import ManualClock, settle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.context import Context


class Robot(Node):
    """Fails or ends when it hears a certain word."""

    def __init__(self, context: Context) -> None:
        super().__init__("robot", context=context)
        self.create_subscription(String, "/word", self.hear)
        self.create_service(AddTwoInts, "/add", self.add)

    def hear(self, msg: String) -> None:
        """Obey one word."""
        if msg.data == "fail":
            raise ValueError("no map")
        self.destroy_node()

    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        """Refuse to count below zero."""
        if request.a < 0:
            raise ValueError("only counts")
        return AddTwoInts.Response(sum=request.a + request.b)


@pytest.fixture
async def say(node_factory: Callable[..., Node]) -> Callable[[str], None]:
    """A function that publishes a word to the robot."""
    publisher = node_factory("operator").create_publisher(String, "/word", 10)
    return lambda word: publisher.publish(String(data=word))


@pytest.fixture
def supervise(context: Context, manual_clock: ManualClock) -> Callable[..., Supervisor[Robot]]:
    """Creates supervisors whose delays are stepped."""
    return lambda **options: Supervisor(lambda: Robot(context), clock=manual_clock, **options)


async def test_a_node_that_fails_is_made_anew_after_a_delay(
    supervise: Callable[..., Supervisor[Robot]],
    say: Callable[[str], None],
    manual_clock: ManualClock,
) -> None:
    """As systemd's Restart=on-failure and RestartSec= do for a process."""
    async with supervise(min_delay_sec=2.0) as robot:
        first = robot.node
        say("fail")
        await settle()
        assert robot.health().state == "restarting"

        await manual_clock.advance(2.0)

        assert robot.health().ok
        assert robot.health().restarts == 1
        assert robot.node is not first


async def test_health_says_what_a_web_application_answers(
    supervise: Callable[..., Supervisor[Robot]],
    say: Callable[[str], None],
    manual_clock: ManualClock,
) -> None:
    """State, count, time and reason, each of them plain."""
    async with supervise() as robot:
        await manual_clock.advance(5.0)
        well = robot.health()
        say("fail")
        await settle()
        ill = robot.health()

    assert (well.ok, well.state, well.node, well.uptime_sec) == (True, "running", "/robot", 5.0)
    assert (ill.ok, ill.state, ill.uptime_sec) == (False, "restarting", 0.0)
    assert ill.error == "ValueError: no map"
    assert robot.health().state == "ended"


async def test_while_no_node_runs_asking_for_it_says_why(
    supervise: Callable[..., Supervisor[Robot]], say: Callable[[str], None]
) -> None:
    """A web application answers 503 in that time instead of 500."""
    supervisor = supervise()
    with pytest.raises(NodeNotRunningError, match="not started yet"):
        _ = supervisor.node
    async with supervisor as robot:
        say("fail")
        await settle()
        with pytest.raises(NodeNotRunningError, match=r"/robot: not running.*no map.*503"):
            _ = robot.node


async def test_the_delay_doubles_up_to_its_longest(
    supervise: Callable[..., Supervisor[Robot]],
    say: Callable[[str], None],
    manual_clock: ManualClock,
) -> None:
    """A node that fails at once again must not burn a core, nor flood the log."""
    async with supervise(min_delay_sec=1.0, max_delay_sec=4.0) as robot:
        for number, delay_sec in enumerate([1.0, 2.0, 4.0, 4.0], start=1):
            say("fail")
            await settle()
            await manual_clock.advance(delay_sec - 0.5)
            assert robot.health().state == "restarting"
            await manual_clock.advance(0.5)
            assert robot.health().restarts == number


async def test_a_node_that_ran_for_long_begins_with_the_first_delay(
    supervise: Callable[..., Supervisor[Robot]],
    say: Callable[[str], None],
    manual_clock: ManualClock,
) -> None:
    """One failure a day is not a loop of failures."""
    async with supervise(min_delay_sec=1.0, max_delay_sec=4.0) as robot:
        for number in (1, 2, 3):
            say("fail")
            await settle()
            await manual_clock.advance(1.0)
            assert robot.health().restarts == number
            await manual_clock.advance(4.0)


async def test_a_node_that_was_destroyed_is_not_restarted(
    supervise: Callable[..., Supervisor[Robot]], say: Callable[[str], None]
) -> None:
    """It has done its work; `run` returns."""
    supervisor = supervise()

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(supervisor.run())
        await settle()
        say("end")

    assert supervisor.health().state == "ended"
    assert supervisor.health().error == ""


async def test_always_restarts_a_node_that_was_destroyed_too(
    supervise: Callable[..., Supervisor[Robot]],
    say: Callable[[str], None],
    manual_clock: ManualClock,
) -> None:
    """For a node that should never end."""
    async with supervise(restart="always") as robot:
        say("end")
        await settle()
        await manual_clock.advance(0.5)

        assert robot.health().restarts == 1


async def test_without_restarts_run_raises_what_the_node_failed_with(
    supervise: Callable[..., Supervisor[Robot]], say: Callable[[str], None]
) -> None:
    """Then the process ends, and what supervises that goes on."""

    async def run() -> None:
        with pytest.raises(ExceptionGroup) as caught:
            await supervise(restart="no").run()
        assert caught.group_contains(ValueError, match="no map")

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(run())
        await settle()
        say("fail")


async def test_a_bad_request_is_no_reason_to_restart(
    supervise: Callable[..., Supervisor[Robot]], node: Node
) -> None:
    """Servers survive it, so that other clients are not affected."""
    async with supervise() as robot:
        client = node.create_client(AddTwoInts, "/add")
        with pytest.raises(RuntimeError, match="only counts"):
            await client.call(AddTwoInts.Request(a=-1))

        assert (await client.call(AddTwoInts.Request(a=1))).sum == 1
        assert robot.health().restarts == 0


async def test_what_fails_at_the_first_start_is_raised() -> None:
    """A typo in a constructor is not tried again forever."""

    def make() -> Node:
        raise LookupError("no such port")

    with pytest.raises(LookupError, match="no such port"):
        async with Supervisor(make):
            pytest.fail("began")


async def test_a_node_that_cannot_be_made_again_is_tried_again(
    context: Context, say: Callable[[str], None], manual_clock: ManualClock
) -> None:
    """Its port may be free a little later."""
    made: list[str] = []

    def make() -> Robot:
        made.append("")
        if len(made) == 2:
            raise OSError("the port is in use")
        return Robot(context)

    async with Supervisor(make, clock=manual_clock) as robot:
        say("fail")
        await settle()
        await manual_clock.advance(0.5)
        assert robot.health().error == "OSError: the port is in use"
        await manual_clock.advance(1.0)

        assert robot.health().ok
    assert len(made) == 3


@pytest.mark.parametrize("state", ["running", "restarting"])
async def test_leaving_the_block_ends_the_node(
    supervise: Callable[..., Supervisor[Robot]], say: Callable[[str], None], state: str
) -> None:
    """In the middle of a delay too."""
    async with supervise() as robot:
        if state == "restarting":
            say("fail")
            await settle()
        assert robot.health().state == state

    assert robot.health().state == "ended"


async def test_leaving_the_block_while_a_node_fails_starts_no_other(
    supervise: Callable[..., Supervisor[Robot]], say: Callable[[str], None]
) -> None:
    """Ctrl-C at that moment: the exceptions of the node hid it, and the program never ended."""
    cleaning_up = asyncio.Event()

    async def work() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            cleaning_up.set()
            await checkpoint()

    async with supervise() as robot:
        robot.node.create_timer(0.0, work)
        await settle()
        say("fail")
        await cleaning_up.wait()

    assert robot.health().restarts == 0
    assert robot.health().state == "ended"


async def test_what_the_block_raises_comes_out_as_it_is(
    supervise: Callable[..., Supervisor[Robot]],
) -> None:
    """The lifespan of a web application can be caught by its own errors."""
    with pytest.raises(KeyError, match="mine"):
        async with supervise():
            raise KeyError("mine")


@pytest.mark.parametrize(
    "options",
    [{"restart": "sometimes"}, {"min_delay_sec": -1.0}, {"min_delay_sec": 2.0, "max_delay_sec": 1}],
)
def test_impossible_options_are_refused(options: dict[str, object]) -> None:
    """The error is raised where they are given."""
    with pytest.raises(ValueError, match="Supervisor: "):
        Supervisor(lambda: Node("node"), **options)  # type: ignore[arg-type]  # the mistake


# How a node ended


async def test_a_node_that_never_ran_has_ended_when_destroyed(context: Context) -> None:
    """Nothing is to be waited for."""
    node = Node("node", context=context)
    node.destroy_node()

    assert str(await node.ended()) == "destroyed"


async def test_a_node_that_is_destroyed_has_ended_when_its_callbacks_have(
    context: Context,
) -> None:
    """The code that follows may rely on nothing of it running any more."""
    node = Node("node", context=context)
    cleaned: list[str] = []

    async def slow(_: String) -> None:
        try:
            node.destroy_node()
            await asyncio.Event().wait()
        finally:
            await checkpoint()
            cleaned.append("up")

    node.create_subscription(String, "word", slow)
    node.create_publisher(String, "word", 10).publish(String())

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(node.run())
        end = await node.ended()

    assert end.reason == "destroyed"
    assert cleaned == ["up"]


async def test_a_node_that_failed_says_with_what(
    context: Context, say: Callable[[str], None]
) -> None:
    """The error is what came out of `run`; asking again gives the same."""
    robot = Robot(context)

    async def run() -> None:
        with pytest.raises(ExceptionGroup):
            await robot.run()

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(run())
        await settle()
        say("fail")
        end = await robot.ended()

    assert str(end) == "failed: ValueError: no map"
    assert await robot.ended() is end


async def test_a_node_whose_task_is_cancelled_says_so(context: Context) -> None:
    """As by a TaskGroup that fails elsewhere."""
    node = Node("node", context=context)
    async with asyncio.TaskGroup() as tasks:
        task = tasks.create_task(node.run())
        await settle()
        task.cancel()

    assert (await node.ended()).reason == "cancelled"


async def test_waiting_for_the_end_of_ones_own_block_is_refused(context: Context) -> None:
    """It would hang without a word."""
    async with Node("node", context=context) as node:
        with pytest.raises(RuntimeError, match=r"/node: awaiting ended.*would wait forever"):
            await node.ended()
