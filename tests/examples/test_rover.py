"""The rover of the examples: its wheels, its action, its battery, its description and its page."""

from __future__ import annotations

import asyncio
import math
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import httpx
import pytest

from aionode import Node, Parameter
from aionode.action import ActionClient
from aionode.errors import GoalAbortedError, GoalRejectedError
from aionode.examples import rover as rover_package
from aionode.examples.rover.battery import Battery
from aionode.examples.rover.description import LATCHED, Description
from aionode.examples.rover.driver import Driver
from aionode.examples.rover.interfaces import DriveTo
from aionode.examples.rover.simulator import MAX_SPEED, STEP_SEC, Simulator
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.rosgraph_msgs.msg import Clock
from aionode.interfaces.sensor_msgs.msg import BatteryState, Image, LaserScan
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleManager
from aionode.testing import settle
from aionode.tf import Buffer
from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Coroutine

    from aionode import Context
    from aionode.testing import ManualClock


ResultT = TypeVar("ResultT")


class Rover(NamedTuple):
    """The rover, and a node that watches and moves it."""

    simulator: Simulator
    watcher: Node
    to: ActionClient[DriveTo.Goal, DriveTo.Result, DriveTo.Feedback]

    @property
    def speed(self) -> float:
        """How fast the wheels drive."""
        return self.simulator.speed


@pytest.fixture
async def rover(aionode_context: Context) -> AsyncIterator[Rover]:
    """The rover without a network, in time that the test moves."""
    async with (
        Simulator(context=aionode_context) as simulator,
        Driver(context=aionode_context),
        Node("watcher", context=aionode_context) as watcher,
    ):
        yield Rover(simulator, watcher, watcher.create_action_client(DriveTo, "/drive_to"))


async def passing(clock: ManualClock, work: Coroutine[object, object, ResultT]) -> ResultT:
    """Return what `work` returns, while up to a minute passes."""
    is_over = asyncio.Event()

    async def working() -> ResultT:
        try:
            return await work
        finally:
            is_over.set()

    async def stepping() -> None:
        for _ in range(120):
            if not is_over.is_set():
                await clock.advance(0.5)

    result, _ = await asyncio.gather(working(), stepping())
    return result


# Wheels


async def test_the_wheels_drive_while_they_are_told_to(
    rover: Rover, manual_clock: ManualClock
) -> None:
    """Half a second of silence is enough to stop: whoever drove has crashed, or left."""
    commands = rover.watcher.create_publisher(Twist, "/cmd_vel", 1)
    for _ in range(10):
        commands.publish(Twist(linear=Vector3(x=0.3)))
        await manual_clock.advance(0.1)
    assert rover.speed == 0.3
    driven = rover.simulator.world.rover.x

    await manual_clock.advance(2.0)
    assert rover.speed == 0.0
    assert rover.simulator.world.rover.x - driven < 0.3 * 0.5


async def test_the_stop_of_a_lease_stops_the_wheels(
    rover: Rover, manual_clock: ManualClock
) -> None:
    """It comes with the end of the block, before any silence."""
    commands = rover.watcher.create_publisher(Twist, "/cmd_vel", 1)
    async with commands.lease(stop=Twist(), ttl_sec=0.3) as lease:
        lease.publish(Twist(angular=Vector3(z=1.0)))
        await settle()
        assert rover.simulator.turn == 1.0
    await settle()
    assert rover.simulator.turn == 0.0


@pytest.mark.parametrize("value", [math.nan, math.inf])
async def test_what_is_no_number_stops_the_wheels(rover: Rover, value: float) -> None:
    """Clamped to the limits of the motors, it would be full speed backwards."""
    commands = rover.watcher.create_publisher(Twist, "/cmd_vel", 1)
    for speed, expected in ((9.0, MAX_SPEED), (value, 0.0)):
        commands.publish(Twist(linear=Vector3(x=speed)))
        await settle()
        assert rover.speed == expected


# DriveTo


async def test_the_rover_drives_to_a_place(rover: Rover, manual_clock: ManualClock) -> None:
    """It turns, drives, and stands still there."""
    result = await passing(manual_clock, rover.to.call(DriveTo.Goal(x=-1.0, y=0.5)))

    place = rover.simulator.world.rover
    assert math.dist(place[:2], (-1.0, 0.5)) <= 0.06
    assert result.driven == pytest.approx(math.dist((-2.0, -1.0), (-1.0, 0.5)), abs=0.1)
    assert rover.speed == 0.0


async def test_a_goal_that_is_cancelled_stops_the_rover(
    rover: Rover, manual_clock: ManualClock
) -> None:
    """The lease of the driver ends with the goal."""
    goal = await rover.to.send_goal(DriveTo.Goal(x=-1.0, y=-1.0))
    await manual_clock.advance(1.0)
    assert rover.speed > 0.0

    await goal.cancel()
    await settle()
    assert rover.speed == 0.0
    assert rover.simulator.world.rover.x < -1.2


async def test_the_rover_does_not_drive_into_a_wall(
    rover: Rover, manual_clock: ManualClock
) -> None:
    """The lidar sees the wall between the rover and its goal; the client learns why it ended."""
    rover.simulator.world.ball = (2.0, 1.0)
    with pytest.raises(GoalAbortedError, match=r"something is 0\.\d\d m ahead"):
        await passing(manual_clock, rover.to.call(DriveTo.Goal(x=2.0, y=-1.0)))

    assert rover.simulator.world.rover.x < 0.5 - 0.25
    assert rover.speed == 0.0


@pytest.mark.parametrize("goal", [DriveTo.Goal(x=1e6), DriveTo.Goal(y=math.nan)])
async def test_a_place_that_is_none_is_rejected(rover: Rover, goal: DriveTo.Goal) -> None:
    """The rover would drive until somebody notices."""
    with pytest.raises(GoalRejectedError, match=r"too far: \S+ m of at most"):
        await rover.to.call(goal)


async def test_the_rover_takes_one_goal_at_a_time(rover: Rover, manual_clock: ManualClock) -> None:
    """After the end of the first, the next one is welcome."""
    first = await rover.to.send_goal(DriveTo.Goal(x=-1.0, y=-1.0))
    await manual_clock.advance(0.5)
    with pytest.raises(GoalRejectedError, match="a goal is under way"):
        await rover.to.send_goal(DriveTo.Goal(x=-2.0, y=1.0))
    await first.cancel()
    await settle()

    await passing(manual_clock, rover.to.call(DriveTo.Goal(x=-1.6, y=-1.0)))


# Sensors, battery and description


async def test_the_sensors_see_the_room(rover: Rover, manual_clock: ManualClock) -> None:
    """The lidar has the wall at the right, 1 m away; the camera sends when somebody looks."""
    scans: list[LaserScan] = []
    pictures: list[Image] = []
    rover.watcher.create_subscription(LaserScan, "/scan", scans.append, 10)
    await manual_clock.advance(0.5)
    rover.watcher.create_subscription(Image, "/camera/image", pictures.append, 10)
    await manual_clock.advance(0.5)

    scan = scans[-1]
    right = round((-math.pi / 2 - scan.angle_min) / scan.angle_increment)
    assert scan.ranges[right] == pytest.approx(1.0, abs=1e-3)
    assert {(picture.width, picture.height) for picture in pictures} == {(160, 120)}


async def test_the_battery_tells_while_it_is_active(
    aionode_context: Context, manual_clock: ManualClock
) -> None:
    """It is managed: a manager switches it on, and off again at the end of its block."""
    async with Battery(context=aionode_context), Node("watcher", context=aionode_context) as node:
        states: list[BatteryState] = []
        node.create_subscription(BatteryState, "/battery", states.append, 10)
        await manual_clock.advance(3.0)
        assert states == []

        manager = LifecycleManager(node, ["/battery"])
        await passing(manual_clock, manager.__aenter__())
        await manual_clock.advance(3.0)
        await passing(manual_clock, manager.__aexit__(None, None, None))
        count = len(states)
        await manual_clock.advance(3.0)

    assert len(states) == count >= 3
    assert states[-1].percentage < states[0].percentage < 1.0


async def test_who_comes_late_gets_the_description(
    rover: Rover, aionode_context: Context, manual_clock: ManualClock
) -> None:
    """It is latched, as the static transforms are: rviz and Foxglove start whenever they like."""
    async with Description(context=aionode_context):
        await manual_clock.advance(1.0)
        texts: list[String] = []
        rover.watcher.create_subscription(String, "/robot_description", texts.append, LATCHED)
        buffer = Buffer(rover.watcher)
        await manual_clock.advance(0.1)

        assert [text.data.count("<link ") for text in texts] == [5]
        for link, height in (("lidar", 0.16), ("camera", 0.25), ("left_wheel", 0.06)):
            found = await buffer.wait_for_transform("odom", link)
            assert found.transform.translation.z == pytest.approx(height)


async def test_the_simulator_makes_the_time(aionode_context: Context) -> None:
    """Whoever uses simulated time follows it, and the wheels are silent by it, too."""
    options = [Parameter("use_sim_time", value=True), Parameter("rate", value=50.0)]
    async with (
        Simulator(context=aionode_context, parameter_overrides=options) as simulator,
        Node("follower", context=aionode_context, parameter_overrides=options[:1]) as follower,
    ):
        ticks = follower.create_subscription(Clock, "/clock", None, 10)
        while (await ticks.receive()).clock.sec < 2:
            pass

    assert simulator.steps * STEP_SEC >= 2.0
    assert follower.get_clock().now().nanoseconds >= 2_000_000_000


# The program


def started(*prelude: str) -> subprocess.Popen[str]:
    """Start the whole rover, with its page at any port."""
    run = "import runpy; runpy.run_module('aionode.examples.rover', run_name='__main__')"
    return subprocess.Popen(
        [sys.executable, "-c", "; ".join([*prelude, run]), "--ros-args", "-p", "port:=0"],
        env=os.environ | isolated_environment(),
        stderr=subprocess.PIPE,
        text=True,
    )


def line_with(pattern: str, program: subprocess.Popen[str]) -> re.Match[str]:
    """Return the match of the first line of its log that matches."""
    assert program.stderr is not None
    for line in program.stderr:
        if found := re.search(pattern, line):
            return found
    pytest.fail(f"no line with {pattern!r}")


def ended(program: subprocess.Popen[str]) -> int:
    """End a program as Ctrl-C does, and return its status."""
    program.send_signal(signal.SIGINT)
    program.communicate(timeout=30)
    return program.returncode


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(60)
def test_the_rover_has_a_page() -> None:
    """One command, and a browser; Ctrl-C ends all of it."""
    with started() as program:
        address = line_with(r"Open (http://127\.0\.0\.1:\d+)", program)[1]
        page = httpx.get(address, timeout=50)
        status = ended(program)

    assert (page.status_code, status) == (200, 0)
    assert "<html" in page.text


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(60)
def test_without_the_extra_the_rover_says_what_its_page_needs() -> None:
    """It runs all the same: everything but the page is there."""
    with started("import sys", "sys.modules['starlette'] = None") as program:
        line = line_with(r"no page.*", program)[0]
        status = ended(program)

    assert "pip install 'aionode[gateway]'" in line
    assert status == 0


@pytest.mark.timeout(60)
def test_the_launch_file_starts_a_process_for_each_part() -> None:
    """It is shipped beside the nodes, so it has to name files that are there."""
    file = Path(rover_package.__file__).with_name("rover.launch.py")
    command = [sys.executable, "-m", "aionode", "launch", str(file), "rate:=5.0", "--print"]
    plan = subprocess.run(command, capture_output=True, text=True, check=True).stdout

    started = set(re.findall(r"rover/(\w+)\.py", plan)) - {"rover"}
    assert started == {"simulator", "description", "battery", "driver", "page"}
    assert "5.0" in plan
