"""The programs that read a joystick, and drive a base by it."""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest

from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.interfaces.sensor_msgs.msg import Joy, JoyFeedback
from aionode.programs._joy.joy_linux_node import JoyLinuxNode
from aionode.programs._joy.joy_node import JoyNode
from aionode.programs._joy.joystick import Joystick, input_devices
from aionode.programs._joy.teleop_node import TeleopTwistJoy
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start
from tests.programs.test_teleop_twist_keyboard import LISTENER
from tests.support.peers import isolated_environment

KEY, ABS = 1, 3
X, Y, TRIGGER, HAT_X, HAT_Y = 0, 1, 2, 0x10, 0x11
SOUTH, EAST, SELECT, EXTRA = 0x130, 0x131, 0x13A, 0x100


class Limits(NamedTuple):
    """The limits of an axis, as evdev reports them."""

    value: int
    min: int
    max: int


class Event(NamedTuple):
    """An event, as evdev reports it."""

    type: int
    code: int
    value: int


PAD: dict[int, list[Any]] = {
    0: [0, KEY, ABS],
    KEY: [EXTRA, SOUTH, EAST, SELECT],
    ABS: [
        (X, Limits(0, -32768, 32767)),
        (Y, Limits(0, -32768, 32767)),
        (TRIGGER, Limits(0, 0, 255)),
        (HAT_X, Limits(0, -1, 1)),
        (HAT_Y, Limits(0, -1, 1)),
    ],
}
"""The capabilities of a game pad, as evdev reports them."""

FF, RUMBLE = 0x15, 0x50

RECORDED = [
    Event(ABS, X, -3000), Event(0, 0, 0), Event(ABS, X, -9500), Event(ABS, Y, -16384),
    Event(0, 0, 0), Event(KEY, SOUTH, 1), Event(0, 0, 0), Event(ABS, HAT_Y, -1), Event(0, 0, 0),
    Event(KEY, SOUTH, 0), Event(0, 0, 0), Event(ABS, HAT_Y, 0), Event(0, 0, 0),
]  # fmt: skip
"""The events of a thumb and a finger, as evdev read them."""


class Pad:
    """A device that plays events; its descriptor is that of a pipe."""

    def __init__(self, name: str = "Pad", capabilities: Any = PAD) -> None:
        self.name = name
        self.known = capabilities
        self.events: list[Event] = []
        self.fd, self.other_end = os.pipe()
        self.is_there = self.is_writable = True
        self.is_closed = False
        self.uploaded: list[Any] = []
        self.played: list[tuple[int, int, int]] = []

    def capabilities(self, verbose: bool = False, absinfo: bool = True) -> Any:
        """Return what it has, as evdev does."""
        axes = self.known[ABS]
        return self.known | {ABS: axes if absinfo else [code for code, _ in axes]}

    def read(self) -> list[Event]:
        """Return what has happened."""
        if not self.is_there:
            raise OSError(errno.ENODEV, os.strerror(errno.ENODEV))
        events, self.events = self.events, []
        return events

    def upload_effect(self, effect: Any) -> int:
        """Note an effect, which has one number from then on."""
        if not self.is_writable:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        self.uploaded.append((effect.u.ff_rumble_effect, effect.ff_replay))
        return 7

    def write(self, etype: int, code: int, value: int) -> None:
        """Note what is played."""
        self.played.append((etype, code, value))

    def close(self) -> None:
        """Note that nobody reads it any more."""
        if not self.is_closed:
            os.close(self.fd)
            os.close(self.other_end)
        self.is_closed = True


class Desk:
    """A joystick, the program that reads it, and what it publishes."""

    def __init__(self, start: Start, node: Any, clock: ManualClock) -> None:
        self.start = start
        self.clock = clock
        self.plugged = [Pad()]
        self.heard: list[Joy] = []
        self.node: Any = None
        node.create_subscription(Joy, "joy", self.heard.append)

    async def begin(self, **parameters: Any) -> None:
        """Start the program."""
        self.node = self.start(JoyNode, lambda: list(self.plugged), **parameters)
        await settle()

    async def play(self, *events: Event) -> None:
        """Move the sticks and press buttons."""
        self.plugged[-1].events.extend(events)
        self.node.read()
        await self.wait(0.002)

    async def wait(self, seconds: float) -> None:
        """Let time pass."""
        await self.clock.advance(seconds)
        await settle()

    @property
    def state(self) -> tuple[list[float], list[int]]:
        """The newest axes and buttons."""
        joy = self.heard[-1]
        return [round(float(each), 3) for each in joy.axes], [int(each) for each in joy.buttons]


@pytest.fixture
async def desk(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> AsyncIterator[Desk]:
    """Return a desk with a joystick on it."""
    desk = Desk(start, node_factory("listener"), manual_clock)
    yield desk
    for pad in desk.plugged:
        pad.close()


async def test_recorded_events_become_axes_and_buttons(desk: Desk) -> None:
    """Left and forward are positive, hats come last, buttons as SDL counts them."""
    await desk.begin(autorepeat_rate=0.0)
    await desk.play(*RECORDED)

    pressed = [tuple(int(each) for each in joy.buttons) for joy in desk.heard]
    assert pressed == [(1, 0, 0, 0), (1, 0, 0, 0), (0, 0, 0, 0), (0, 0, 0, 0)]
    hats = [float(joy.axes[4]) for joy in desk.heard]
    assert hats == [0.0, 1.0, 1.0, 0.0]
    axes, _ = desk.state
    assert axes == [0.253, 0.474, 1.0, 0.0, 0.0]
    assert desk.heard[0].header.frame_id == "joy"


async def test_the_ends_of_an_axis_are_one(desk: Desk) -> None:
    """This includes the lower end, which is one step further away."""
    await desk.begin(autorepeat_rate=0.0)
    await desk.play(Event(ABS, X, -32768), Event(ABS, Y, 32767))

    assert desk.state[0][:2] == [1.0, -1.0]


async def test_what_does_not_change_is_repeated(desk: Desk) -> None:
    """It is repeated twenty times a second, so that listeners know that it is still there."""
    await desk.begin()
    await desk.wait(1.0)

    assert len(desk.heard) == 20


async def test_movements_within_a_moment_are_one_message(desk: Desk) -> None:
    """The kernel reports each axis alone."""
    await desk.begin(autorepeat_rate=0.0, coalesce_interval_ms=10)
    for value in range(5000, 20000, 1000):
        await desk.play(Event(ABS, X, value))

    assert len(desk.heard) in (2, 3)


async def test_sticky_buttons_change_with_each_press(desk: Desk) -> None:
    """They do not change with the release."""
    await desk.begin(autorepeat_rate=0.0, sticky_buttons=True)
    for value in (1, 0, 1, 0, 1, 0):
        await desk.play(Event(KEY, EAST, value))

    assert [int(joy.buttons[1]) for joy in desk.heard] == [1, 0, 1]


async def test_a_joystick_that_is_pulled_out_falls_silent_until_it_is_back(desk: Desk) -> None:
    """Nothing says what a hand does that is not there."""
    await desk.begin()
    pad = desk.plugged.pop()
    pad.is_there = False
    desk.node.read()
    desk.heard.clear()
    await desk.wait(2.0)
    assert desk.heard == []
    assert pad.is_closed

    desk.plugged.append(Pad())
    await desk.wait(1.0)
    assert len(desk.heard) >= 9


async def test_a_joystick_is_chosen_by_its_name_or_its_number(desk: Desk) -> None:
    """Other devices do not count, and are closed."""
    keyboard = Pad("Keyboard", PAD | {KEY: [30, 31], ABS: []})
    desk.plugged = [keyboard, Pad("One"), Pad("Two")]
    await desk.begin(device_id=1)
    assert [pad.is_closed for pad in desk.plugged] == [True, True, False]

    desk.plugged = [Pad("One"), Pad("Two")]
    await desk.begin(device_name="One")
    assert [pad.is_closed for pad in desk.plugged] == [False, True]


@pytest.mark.parametrize("parameters", [{"dev": "/dev/input/js1"}, {"dev_name": "Two"}])
async def test_a_joystick_of_joy_linux_is_chosen_by_its_device_or_its_name(
    start: Start, manual_clock: ManualClock, parameters: dict[str, Any]
) -> None:
    """These are the parameters of that package."""
    del manual_clock  # the context follows it
    plugged = [Pad("One"), Pad("Two")]
    start(JoyLinuxNode, lambda: plugged, **parameters)

    assert [pad.is_closed for pad in plugged] == [True, False]


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("dev", "/dev/ttyUSB", "use a joystick such as /dev/input/js0"),
        ("coalesce_interval", -1.0, "coalesce_interval must be 0 or more, in seconds"),
    ],
)
async def test_parameters_of_joy_linux_that_do_not_fit_are_refused(
    start: Start, name: str, value: Any, text: str
) -> None:
    """The error says what is valid."""
    with pytest.raises(CommandError, match=text):
        start(JoyLinuxNode, list, **{name: value})


async def test_a_name_that_no_joystick_has_is_said(
    desk: Desk, capsys: pytest.CaptureFixture[str]
) -> None:
    """Once, with those that there are."""
    desk.plugged = [Pad("One")]
    await desk.begin(device_name="Two")

    assert "Could not get joystick with name 'Two'; there are 'One'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("deadzone", 1.5, "Deadzone must be between 0.0 and 1.0"),
        ("autorepeat_rate", -1.0, "Autorepeat rate must be >= 0.0"),
        ("autorepeat_rate", 2000.0, "Autorepeat rate must be <= 1000.0"),
        ("coalesce_interval_ms", -1, "coalesce_interval_ms must be positive"),
    ],
)
async def test_parameters_that_do_not_fit_are_refused(
    desk: Desk, name: str, value: float, text: str
) -> None:
    """In the words of the original."""
    with pytest.raises(CommandError, match=text):
        await desk.begin(**{name: value})


@pytest.fixture
def motors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have evdev's structures of force feedback as tuples."""

    def effect(_kind: int, _id: int, _direction: int, _trigger: Any, replay: Any, u: Any) -> Any:
        return SimpleNamespace(ff_replay=replay, u=u)

    def pair(one: int, other: int) -> tuple[int, int]:
        return one, other

    ff = SimpleNamespace(
        Effect=effect, EffectType=SimpleNamespace, Replay=pair, Rumble=pair, Trigger=pair
    )
    monkeypatch.setitem(sys.modules, "evdev", SimpleNamespace(ff=ff))


def rumble(intensity: float, **others: int) -> JoyFeedback:
    """Return the feedback that makes a joystick rumble."""
    return JoyFeedback(type=JoyFeedback.TYPE_RUMBLE, intensity=intensity, **others)


@pytest.mark.usefixtures("motors")
async def test_feedback_rumbles_for_a_second(desk: Desk, node_factory: Callable[..., Any]) -> None:
    """As strongly as it says; other effects, or values out of range, are ignored as in joy."""
    pad = desk.plugged[0] = Pad(capabilities=PAD | {FF: [RUMBLE]})
    await desk.begin()
    publisher = node_factory("game").create_publisher(JoyFeedback, "joy/set_feedback", 10)
    ignored = [rumble(1.5), rumble(0.5, id=1), JoyFeedback(type=JoyFeedback.TYPE_LED)]
    for feedback in (rumble(1.0), *ignored, rumble(0.0)):
        publisher.publish(feedback)
        await settle()

    assert pad.uploaded == [((0xFFFF, 0xFFFF), (1000, 0)), ((0, 0), (1000, 0))]
    assert pad.played == [(FF, 7, 1)] * 2


@pytest.mark.usefixtures("motors")
@pytest.mark.parametrize(("effects", "warnings"), [([RUMBLE], 1), ([], 0)])
async def test_a_joystick_that_cannot_rumble_keeps_working(
    desk: Desk,
    node_factory: Callable[..., Any],
    capsys: pytest.CaptureFixture[str],
    effects: list[int],
    warnings: int,
) -> None:
    """One that may not be written to is said once; one without motors is nothing special."""
    pad = desk.plugged[0] = Pad(capabilities=PAD | {FF: effects})
    pad.is_writable = False
    await desk.begin()
    publisher = node_factory("game").create_publisher(JoyFeedback, "joy/set_feedback", 10)
    for _ in range(2):
        publisher.publish(rumble(1.0))
        await settle()
    await desk.play(Event(KEY, SOUTH, 1))

    assert desk.state[1][0] == 1
    said = "Joystick 'Pad' does not rumble: Permission denied"
    assert capsys.readouterr().err.count(said) == warnings


def test_an_axis_without_a_range_stays_in_its_middle() -> None:
    """Some devices claim such axes."""
    pad = Pad(capabilities=PAD | {ABS: [(X, Limits(3, 0, 0)), (Y, Limits(0, -1, 1))]})
    joystick = Joystick(pad, 0.05, is_sticky=False)
    joystick.take(Event(ABS, X, 5))
    pad.close()

    assert joystick.axes == [0.0, 0.0]


def test_without_evdev_the_program_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is an extra."""
    monkeypatch.setitem(sys.modules, "evdev", None)

    with pytest.raises(CommandError, match=r"pip install 'aionode\[joy\]'"):
        list(input_devices())


# The wheels


class Base:
    """The commands that a base receives, and the thumb."""

    def __init__(self, node: Any, clock: ManualClock, kind: Any = Twist) -> None:
        self.clock = clock
        self.twists: list[Any] = []
        self.joy = node.create_publisher(Joy, "joy", 10)
        node.create_subscription(kind, "cmd_vel", self.twists.append)

    async def hold(self, *buttons: int, axes: tuple[float, ...] = (), seconds: float = 0.0) -> None:
        """Hold buttons and axes for a time, with what is repeated twenty times a second."""
        pressed = [int(number in buttons) for number in range(8)]
        for _ in range(1 + round(seconds / 0.05)):
            self.joy.publish(Joy(axes=list(axes), buttons=pressed))
            await settle()
            await self.wait(0.05 if seconds else 0.0)

    async def wait(self, seconds: float) -> None:
        """Let time pass."""
        await self.clock.advance(seconds)
        await settle()

    @property
    def speeds(self) -> list[float]:
        """The speeds that were commanded."""
        return [getattr(each, "twist", each).linear.x for each in self.twists]


@pytest.fixture
def base(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the program, with the axes of the tests."""

    async def make(kind: Any = Twist, **parameters: Any) -> Base:
        base = Base(node_factory("base"), manual_clock, kind)
        given = {"axis_linear.x": 1, "axis_angular.yaw": 0, "enable_turbo_button": 4}
        start(TeleopTwistJoy, **given | parameters)
        await settle()
        await base.wait(0.02)
        return base

    return make


async def test_the_robot_moves_while_the_button_is_held(base: Callable[..., Any]) -> None:
    """It stops at once when the button is released, with one message."""
    wheels = await base()
    await wheels.hold(5, axes=(0.5, 1.0), seconds=0.5)
    assert set(wheels.speeds) == {0.5}
    assert wheels.twists[-1].angular.z == 0.25

    await wheels.hold(axes=(0.5, 1.0), seconds=0.5)
    assert wheels.speeds.count(0.0) == 1
    assert wheels.speeds[-1] == 0.0


async def test_the_turbo_button_has_scales_of_its_own(base: Callable[..., Any]) -> None:
    """It needs no other button."""
    wheels = await base()
    await wheels.hold(4, axes=(0.0, 1.0))

    assert wheels.speeds == [1.0]


async def test_without_a_button_the_robot_stands(base: Callable[..., Any]) -> None:
    """One stop says so, as in the original, then others may drive it."""
    wheels = await base()
    await wheels.hold(axes=(0.0, 1.0), seconds=1.0)

    assert wheels.speeds == [0.0]


async def test_no_button_may_be_required(base: Callable[..., Any]) -> None:
    """A parameter says so."""
    wheels = await base(require_enable_button=False)
    await wheels.hold(axes=(0.0, 1.0))

    assert wheels.speeds == [0.5]


async def test_a_joystick_that_falls_silent_stops_the_robot(base: Callable[..., Any]) -> None:
    """It was pulled out, or its program has ended: within 0.35 s."""
    wheels = await base()
    await wheels.hold(5, axes=(0.0, 1.0), seconds=0.5)
    assert wheels.speeds[-1] == 0.5
    await wheels.wait(0.3)

    assert wheels.speeds[-1] == 0.0
    await wheels.hold(5, axes=(0.0, 1.0), seconds=0.1)
    assert wheels.speeds[-1] == 0.5


async def test_the_end_of_the_program_stops_the_robot(
    base: Callable[..., Any], start: Start, manual_clock: ManualClock
) -> None:
    """However it ends: the lease says it."""
    wheels = await base(require_enable_button=False)
    other = start(TeleopTwistJoy, **{"axis_linear.x": 1, "require_enable_button": False})
    await settle()
    await wheels.wait(0.02)
    await wheels.hold(axes=(0.0, 1.0))
    wheels.twists.clear()
    other.destroy_node()
    await settle()

    assert wheels.speeds == [0.0]


async def test_axes_that_are_no_numbers_command_nothing(base: Callable[..., Any]) -> None:
    """NaN is not a speed, and an axis that is not there has none."""
    wheels = await base()
    await wheels.hold(5, axes=(float("nan"),))

    assert wheels.twists == [Twist()]


async def test_backwards_the_turn_may_be_inverted(base: Callable[..., Any]) -> None:
    """As a car is steered."""
    wheels = await base(inverted_reverse=True)
    await wheels.hold(5, axes=(1.0, -1.0))

    assert wheels.twists[-1].angular.z == -0.5


async def test_stamped_commands_are_an_option(base: Callable[..., Any]) -> None:
    """With a frame, as since Jazzy."""
    wheels = await base(TwistStamped, publish_stamped_twist=True, frame="base")
    await wheels.hold(5, axes=(0.0, 1.0))

    assert wheels.speeds == [0.5]
    assert wheels.twists[-1].header.frame_id == "base"


# In processes


@pytest.fixture
def driving() -> Iterator[dict[str, Any]]:
    """Drive at 0.5 m/s: the wheels, the program, and a joystick that is held."""
    pexpect = pytest.importorskip("pexpect", reason="pseudo-terminals are of Unix")
    env = {**os.environ, **isolated_environment(), "PYTHONUNBUFFERED": "1"}
    held = "{axes: [0.0, 1.0], buttons: [0, 0, 0, 0, 0, 1]}"
    commands = {
        "wheels": ["-c", LISTENER],
        "program": [
            *("-m", "aionode", "run", "teleop_twist_joy", "teleop_node"),
            *("--ros-args", "-p", "axis_linear.x:=1"),
        ],
        "joystick": [
            *("-m", "aionode", "topic", "pub", "-r", "20", "/joy", "sensor_msgs/msg/Joy", held)
        ],
    }
    terminals = {
        name: pexpect.spawn(sys.executable, words, env=env, encoding="utf-8", timeout=30)
        for name, words in commands.items()
    }
    terminals["wheels"].expect("speed 0.5")
    yield terminals
    for terminal in terminals.values():
        terminal.kill(signal.SIGKILL)
        terminal.wait()


IN_PROCESSES = [pytest.mark.timeout(90), pytest.mark.one_loop]


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize(
    ("who", "number", "told"),
    [
        pytest.param("program", signal.SIGINT, "speed 0.0", marks=IN_PROCESSES),
        pytest.param("program", signal.SIGHUP, "speed 0.0", marks=IN_PROCESSES),
        pytest.param("program", signal.SIGKILL, "silence", marks=IN_PROCESSES),
        pytest.param("program", signal.SIGSTOP, "silence", marks=IN_PROCESSES),
        pytest.param("joystick", signal.SIGKILL, "speed 0.0|silence", marks=IN_PROCESSES),
        pytest.param("joystick", signal.SIGSTOP, "speed 0.0|silence", marks=IN_PROCESSES),
    ],
)
def test_the_wheels_stop_whoever_goes(
    driving: dict[str, Any], who: str, number: signal.Signals, told: str
) -> None:
    """By the lease; where it cannot say anything any more, by the silence that the base notices.

    Both take 0.3 s, so either may be the first where the joystick goes.
    """
    os.kill(driving[who].pid, number)

    driving["wheels"].expect(told, timeout=10)
