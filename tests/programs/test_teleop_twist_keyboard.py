"""The program that drives a base by keys."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from aionode import Clock, ClockType
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.programs._teleop_twist_keyboard import MOVES, Keys, Teleop
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start
from tests.support.peers import isolated_environment

pexpect = pytest.importorskip("pexpect", reason="pseudo-terminals are of Unix")


def parts(twist: Twist | None) -> tuple[float, ...]:
    """Return what a command says."""
    assert twist is not None
    return twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.z


def test_each_key_moves_as_in_the_original() -> None:
    """Hands know them."""
    keys = Keys()
    found = {}
    for key in MOVES:
        keys.press(key)
        found[key] = parts(keys.twist)

    assert {key: found[key] for key in "iomJt"} == {
        "i": (0.5, 0.0, 0.0, 0.0),
        "o": (0.5, 0.0, 0.0, -1.0),
        "m": (-0.5, 0.0, 0.0, -1.0),
        "J": (0.0, 0.5, 0.0, 0.0),
        "t": (0.0, 0.0, 0.5, 0.0),
    }
    keys.press("k")
    assert keys.twist is None


def test_keys_change_speeds_by_a_tenth() -> None:
    """A base that moves continues at the new speed."""
    keys = Keys()
    keys.press("i")

    assert keys.press("q") == "currently:\tspeed 0.55\tturn 1.1 "
    keys.press("x")
    keys.press("e")
    assert parts(keys.twist) == pytest.approx((0.495, 0, 0, 0))
    assert keys.turn == pytest.approx(1.21)


class Wheels:
    """The commands that a base receives."""

    def __init__(self, node: Any, kind: Any = Twist) -> None:
        self.speeds: list[float] = []
        self.frames: list[str] = []
        self.kind = kind
        node.create_subscription(kind, "cmd_vel", self.hear)

    def hear(self, msg: Any) -> None:
        """Note the speed."""
        self.speeds.append((msg if self.kind is Twist else msg.twist).linear.x)
        self.frames.append("" if self.kind is Twist else msg.header.frame_id)


@pytest.fixture
def driving(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the program, with a hand at its keys."""
    del manual_clock  # the context follows it

    @asynccontextmanager
    async def make(**parameters: Any) -> AsyncIterator[tuple[Teleop, Wheels]]:
        kind = TwistStamped if parameters.get("stamped") else Twist
        wheels = Wheels(node_factory("wheels"), kind)
        node = start(Teleop, lambda _text: None, **parameters)
        async with asyncio.TaskGroup() as tasks:
            task = tasks.create_task(node.twists.drive())
            await settle()
            yield node, wheels
            task.cancel()
        await settle()

    return make


async def test_the_command_of_a_key_stands_until_the_next(
    driving: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """It is repeated, so that the base knows that its driver is alive."""
    async with driving() as (node, wheels):
        node.press("i")
        await settle()
        assert wheels.speeds == [0.5]
        await manual_clock.advance(1.0)
        await settle()

        assert set(wheels.speeds) == {0.5}
        assert len(wheels.speeds) >= 10
        node.press(" ")
        await settle()
        assert wheels.speeds[-1] == 0.0


async def test_nothing_is_published_while_the_robot_is_to_stand(
    driving: Callable[..., Any], manual_clock: ManualClock
) -> None:
    """Others may drive it meanwhile; a key that is none stops them, as in the original."""
    async with driving() as (node, wheels):
        await manual_clock.advance(1.0)
        assert wheels.speeds == []
        node.press("k")
        await manual_clock.advance(1.0)
        await settle()

        assert wheels.speeds == [0.0]


async def test_the_end_of_the_program_stops_the_robot(driving: Callable[..., Any]) -> None:
    """However it ends: the lease says it."""
    async with driving() as (node, wheels):
        node.press("i")
        await settle()

    assert wheels.speeds == [0.5, 0.0]


async def test_stamped_commands_are_an_option(driving: Callable[..., Any]) -> None:
    """With a frame, as the newer original has it."""
    async with driving(stamped=True, frame_id="base", speed=0.2) as (node, wheels):
        node.press("i")
        await settle()

        assert (wheels.speeds, wheels.frames) == ([0.2], ["base"])


async def test_a_frame_needs_stamped_commands(start: Start) -> None:
    """In the words of the original."""
    with pytest.raises(CommandError, match="'frame_id' can only be set when 'stamped' is True"):
        start(Teleop, lambda _text: None, frame_id="base")


# In a terminal

LISTENER = """
import aionode
from aionode.interfaces.geometry_msgs.msg import Twist

class Wheels(aionode.Node):
    def __init__(self):
        super().__init__("wheels")
        self.told = None
        self.create_subscription(Twist, "cmd_vel", self.hear, on_silence=self.fall_silent,
                                 silence_sec=0.3)
        print("ready", flush=True)

    def hear(self, twist):
        if twist.linear.x != self.told:
            self.told = twist.linear.x
            self.tell(f"speed {self.told}")

    def fall_silent(self):
        self.tell("silence")

    def tell(self, what):
        now = aionode.Clock(aionode.ClockType.STEADY_TIME).now()
        print(what, "at", now.nanoseconds / 1e9, flush=True)

aionode.run(Wheels)
"""


class Terminals:
    """The wheels, and a terminal with the program."""

    def __init__(self, env: dict[str, str]) -> None:
        self.env = {**os.environ, **env, "PYTHONUNBUFFERED": "1"}
        self.wheels = self.open("-c", LISTENER)
        self.wheels.expect("ready")
        self.keys = self.open("-m", "aionode", "teleop")
        self.keys.expect("currently:\tspeed 0.5\tturn 1.0")

    def open(self, *arguments: str) -> Any:
        """Start Python in a terminal of its own."""
        return pexpect.spawn(
            sys.executable, list(arguments), env=self.env, encoding="utf-8", timeout=30, echo=False
        )


@pytest.fixture
def terminals() -> Iterator[Terminals]:
    """Drive: the robot moves at 0.5 m/s."""
    opened = Terminals(isolated_environment())
    opened.keys.send("i")
    opened.wheels.expect("speed 0.5")
    yield opened
    for terminal in (opened.keys, opened.wheels):
        terminal.kill(signal.SIGKILL)
        terminal.wait()


IN_TERMINALS = [pytest.mark.timeout(90), pytest.mark.one_loop]


def end(keys: Any, how: str) -> None:
    """Let a program and its terminal go in one of several ways."""
    if how == "closed":
        os.close(keys.child_fd)
    elif how in ("ctrl-c", "twice"):
        for _ in range(2 if how == "twice" else 1):
            keys.sendintr()
    else:
        os.kill(keys.pid, signal.SIGKILL if how == "sigkill" else signal.SIGSTOP)


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize(
    ("how", "told"),
    [
        pytest.param("ctrl-c", "speed 0.0", marks=IN_TERMINALS),
        pytest.param("closed", "speed 0.0", marks=IN_TERMINALS),
        pytest.param("twice", "speed 0.0", marks=IN_TERMINALS),
        pytest.param("sigkill", "silence", marks=IN_TERMINALS),
        pytest.param("sigstop", "silence", marks=IN_TERMINALS),
    ],
)
def test_the_wheels_stop_in_whatever_way_the_program_goes(
    terminals: Terminals, how: str, told: str
) -> None:
    """By its lease; where it cannot say anything any more, by the silence that the base notices."""
    end(terminals.keys, how)

    terminals.wheels.expect(told, timeout=10)
    if how == "ctrl-c":
        terminals.keys.expect(pexpect.EOF)
        assert "Traceback" not in terminals.keys.before


@pytest.mark.stress
@pytest.mark.parametrize(
    "how", [pytest.param(how, marks=IN_TERMINALS) for how in ("ctrl-c", "closed", "twice",
                                                              "sigkill", "sigstop")]
)  # fmt: skip
def test_the_wheels_stop_within_half_a_second(terminals: Terminals, how: str) -> None:
    """Measured from the end to what the base hears or notices; it needs a quiet machine."""
    began = Clock(ClockType.STEADY_TIME).now().nanoseconds / 1e9
    end(terminals.keys, how)

    terminals.wheels.expect(r"(speed 0\.0|silence) at (\d+\.\d+)\s", timeout=10)
    passed = float(terminals.wheels.match[2]) - began
    print(f"{how}: {passed:.3f} s")  # noqa: T201  # the figure, with -s
    assert passed < 0.5


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize("key", [pytest.param(key, marks=IN_TERMINALS) for key in "\x1a\x1c\x13"])
def test_keys_that_freeze_or_end_programs_stop_the_robot_like_any_other(
    terminals: Terminals, key: str
) -> None:
    """Ctrl-Z, Ctrl-Backslash and Ctrl-S are keys in the original; the program goes on."""
    terminals.keys.send(key)
    terminals.wheels.expect("speed 0.0", timeout=10)

    terminals.keys.send("i")
    terminals.wheels.expect("speed 0.5", timeout=10)


async def test_the_help_is_shown_again_after_fifteen_changes(start: Start) -> None:
    """It has scrolled away by then, as in the original."""
    shown: list[str] = []
    node = start(Teleop, shown.append)
    for _ in range(15):
        node.press("w")

    assert ["Keys move the robot" in text for text in shown] == [False] * 14 + [True]


@pytest.mark.processes
def test_without_a_terminal_it_says_where_to_start_it() -> None:
    """A launch file has none for it."""
    from tests.support.fork_server import run

    done = run(
        ["-m", "aionode.programs", "teleop_twist_keyboard", "teleop_twist_keyboard"],
        env={**os.environ, **isolated_environment()},
        timeout=50,
    )

    assert done.returncode == 1
    assert "keys are read from a terminal, but stdin is not one" in done.stderr
