"""The program by which several command one base."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from aionode.interfaces.std_msgs.msg import Bool
from aionode.programs._command_mux.mux import Source
from aionode.programs._command_mux.twist_mux import TwistMux
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

PARAMETERS: dict[str, Any] = {
    "topics.navigation.topic": "nav_vel",
    "topics.navigation.timeout": 0.5,
    "topics.navigation.priority": 10,
    "topics.joystick.topic": "joy_vel",
    "topics.joystick.timeout": 0.5,
    "topics.joystick.priority": 100,
    "locks.pause.topic": "pause",
    "locks.pause.timeout": 0.0,
    "locks.pause.priority": 50,
    "locks.alive.topic": "alive",
    "locks.alive.timeout": 2.0,
    "locks.alive.priority": 255,
}


class Robot:
    """The commanding nodes, and the commands that the base receives."""

    def __init__(self, node: Any, kind: Any = Twist) -> None:
        self.speeds: list[float] = []
        self.statuses: list[Any] = []
        self.publishers = {
            name: node.create_publisher(kind, f"{name}_vel", 10) for name in ("nav", "joy")
        }
        self.locks = {name: node.create_publisher(Bool, name, 10) for name in ("pause", "alive")}
        node.create_subscription(
            kind,
            "cmd_vel_out",
            lambda msg: self.speeds.append((msg if kind is Twist else msg.twist).linear.x),
        )
        node.create_subscription(
            DiagnosticArray, "/diagnostics", lambda msg: self.statuses.append(msg.status[0])
        )
        self.kind = kind

    async def drive(self, name: str, speed: float) -> list[float]:
        """Command a speed, and return those that have arrived."""
        twist = Twist(linear=Vector3(x=speed))
        self.publishers[name].publish(twist if self.kind is Twist else TwistStamped(twist=twist))
        await settle()
        return self.speeds

    async def lock(self, name: str, *, locked: bool) -> None:
        """Lock or free."""
        self.locks[name].publish(Bool(data=locked))
        await settle()


@pytest.fixture
def robot(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the program, with its lock of life fed."""

    async def make(kind: Any = Twist, **more: Any) -> Robot:
        if kind is Twist:
            more["use_stamped"] = False
        await manual_clock.advance(100.0)
        start(TwistMux, **PARAMETERS | more)
        robot = Robot(node_factory("people"), kind)
        await settle()
        await robot.lock("alive", locked=False)
        return robot

    return make


async def test_the_highest_priority_is_heard_until_it_falls_silent(
    robot: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """Whoever takes the joystick has the robot."""
    people = await robot()

    assert await people.drive("nav", 0.1) == [0.1]
    assert await people.drive("joy", 0.2) == [0.1, 0.2]
    assert await people.drive("nav", 0.3) == [0.1, 0.2]
    await manual_clock.advance(0.6)
    assert await people.drive("nav", 0.4) == [0.1, 0.2, 0.4]


async def test_a_lock_stops_lower_priorities(robot: Callable[..., Any]) -> None:
    """Higher ones drive on."""
    people = await robot()
    await people.lock("pause", locked=True)

    assert await people.drive("nav", 0.1) == []
    assert await people.drive("joy", 0.2) == [0.2]
    await people.lock("pause", locked=False)


async def test_a_lock_that_falls_silent_locks(
    robot: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """Its publisher may have died."""
    people = await robot()
    await manual_clock.advance(2.5)

    assert await people.drive("joy", 0.2) == []


async def test_a_lock_that_was_never_heard_locks_as_simulated_time_begins(
    start: Start, node_factory: Callable[..., Any]
) -> None:
    """A message that has not come is not one of the time 0."""
    start(TwistMux, **PARAMETERS, use_stamped=False, use_sim_time=True)
    people = Robot(node_factory("people"))
    await settle()

    assert await people.drive("joy", 0.2) == []


def test_a_clock_that_is_set_back_ends_what_was_heard() -> None:
    """Who freed a lock, or commanded, may be dead since."""
    times = [5 * 10**9]
    source = Source("locks.alive", "alive", 2.0, 255, lambda: times[-1])
    source.hear(is_set=False)
    assert not source.has_expired
    times.append(10**9)

    assert source.has_expired


async def test_a_program_without_sources_says_what_is_missing(
    start: Start, capsys: pytest.CaptureFixture[str]
) -> None:
    """As when the name of the node is not that in the parameter file."""
    start(TwistMux)

    assert "no command passes, because there are no sources" in capsys.readouterr().err


async def test_commands_are_stamped_by_default(robot: Callable[..., Any]) -> None:
    """As since version 4.4, which Jazzy and Kilted have."""
    people = await robot(TwistStamped)

    assert await people.drive("nav", 0.1) == [0.1]


async def test_commands_of_humble_have_no_header(
    start: Start, aionode_context: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its version, 4.3, has no such parameter."""
    monkeypatch.setattr(aionode_context, "ros_distro", "humble")
    assert start(TwistMux, **PARAMETERS).get_parameter("use_stamped").value is False


async def test_diagnostics_say_who_is_heard(
    robot: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """Once a second."""
    people = await robot()
    await manual_clock.advance(0.9)
    await people.drive("nav", 0.1)
    await manual_clock.advance(0.1)
    await settle()

    values = {each.key: each.value for each in people.statuses[-1].values}
    assert values["current source"] == "topics.navigation"
    assert values["loop time in [sec]"] == values["data age in [sec]"] == "0"
    assert values["velocity topics.joystick"].startswith("masked (listening to joy_vel")
    assert values["lock locks.pause"].startswith("free")


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("topics.tablet.topic", "tab_vel", "could not load parameter 'topics.tablet.timeout'"),
        (
            "topics.joystick.priority",
            1.5,
            "priority' is 1.5; its type has to be int",
        ),
        ("topics.joystick.timeout", math.nan, "timeout' is nan; it has to be a finite number"),
        ("use_stamped", 1, "'use_stamped' is 1; its type has to be bool"),
    ],
)
async def test_parameters_that_do_not_fit_are_named(
    start: Start, name: str, value: Any, text: str
) -> None:
    """A source that is left out would be heard by nobody."""
    with pytest.raises(CommandError, match=text):
        start(TwistMux, **PARAMETERS | {name: value})
