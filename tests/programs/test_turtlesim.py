"""The turtles of ROS's first tutorials."""

from __future__ import annotations

import io
import math
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import PIL.Image
import pytest

from aionode.errors import GoalRejectedError, ServiceError
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import CompressedImage
from aionode.interfaces.std_srvs.srv import Empty
from aionode.interfaces.turtlesim.action import RotateAbsolute
from aionode.interfaces.turtlesim.msg import Color, Pose
from aionode.interfaces.turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from aionode.programs._turtlesim.draw_square import DrawSquare
from aionode.programs._turtlesim.mimic import Mimic
from aionode.programs._turtlesim.node import TurtleSim
from aionode.programs._turtlesim.teleop_key import TeleopTurtle
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start
from tests.support.peers import isolated_environment

MIDDLE = 499 / 45 / 2


class Pond:
    """The turtles, and who plays with them."""

    def __init__(self, sim: Any, node: Any, clock: ManualClock) -> None:
        self.sim = sim
        self.node = node
        self.clock = clock
        self.pose = Pose()
        self.color = Color()
        node.create_subscription(Pose, "turtle1/pose", self.see)
        node.create_subscription(Color, "turtle1/color_sensor", self.look)
        self.command = node.create_publisher(Twist, "turtle1/cmd_vel", 7)
        self.rotations = node.create_action_client(RotateAbsolute, "turtle1/rotate_absolute")

    def see(self, pose: Pose) -> None:
        """Note where the turtle is."""
        self.pose = pose

    def look(self, color: Color) -> None:
        """Note what is under the turtle."""
        self.color = color

    async def wait(self, seconds: float) -> None:
        """Let time pass."""
        await self.clock.advance(seconds)
        await settle()

    async def drive(self, seconds: float = 0.0, **command: float) -> Pose:
        """Command the turtle once, and return where it then is."""
        linear = Vector3(x=command.get("x", 0.0), y=command.get("y", 0.0))
        self.command.publish(Twist(linear=linear, angular=Vector3(z=command.get("turn", 0.0))))
        await settle()
        await self.wait(seconds)
        return self.pose

    async def call(self, kind: Any, name: str, /, **fields: Any) -> Any:
        """Call a service."""
        return await self.node.create_client(kind, name).call(kind.Request(**fields))

    @property
    def place(self) -> tuple[float, float, float]:
        """The place of the turtle."""
        return self.pose.x, self.pose.y, self.pose.theta


@pytest.fixture
async def pond(manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]) -> Pond:
    """Start the program."""
    pond = Pond(start(TurtleSim), node_factory("child"), manual_clock)
    await settle()
    await pond.wait(0.02)
    return pond


async def test_the_first_turtle_is_in_the_middle_of_the_window(pond: Pond) -> None:
    """As the tutorials show it: 5.544444561004639."""
    assert pond.place == pytest.approx((MIDDLE, MIDDLE, 0.0))
    assert pond.pose.x == 5.544444561004639


async def test_a_command_stands_for_a_second(pond: Pond) -> None:
    """As in the original, whose tutorial shows a turtle that stops by itself."""
    await pond.drive(0.96, x=2.0)
    assert pond.pose.linear_velocity == 2.0

    await pond.wait(2.0)
    assert pond.place == pytest.approx((MIDDLE + 2.0, MIDDLE, 0.0), abs=0.04)
    assert pond.pose.linear_velocity == 0.0


async def test_a_turtle_that_turns_drives_an_arc(pond: Pond) -> None:
    """The command of the first tutorial: a half circle with a radius of 1.1."""
    await pond.drive(3.0, x=2.0, turn=1.8)

    assert pond.pose.theta == pytest.approx(1.8, abs=0.04)
    angle = 1.8
    expected = MIDDLE + 2 / 1.8 * math.sin(angle), MIDDLE + 2 / 1.8 * (1 - math.cos(angle))
    assert pond.place[:2] == pytest.approx(expected, abs=0.06)


async def test_a_turtle_goes_aside_only_if_it_is_holonomic(pond: Pond) -> None:
    """The parameter counts from the next command on."""
    await pond.drive(0.5, y=1.0)
    assert pond.pose.linear_velocity == 0.0

    pond.sim.set_parameters([type(pond.sim.get_parameter("holonomic"))("holonomic", value=True)])
    await pond.drive(0.5, y=1.0)
    assert pond.pose.y > MIDDLE + 0.4


async def test_walls_stop_a_turtle(pond: Pond, capsys: pytest.CaptureFixture[str]) -> None:
    """The log says so in the words of the original."""
    await pond.drive(0.9, x=10.0)

    assert pond.pose.x == np.float32(499 / 45)
    assert "Oh no! I hit the wall! (Clamping from [x=11." in capsys.readouterr().err


async def test_a_command_that_is_no_number_stops_the_turtle(pond: Pond) -> None:
    """The original would be nowhere from then on."""
    await pond.drive(0.1, x=1.0)
    await pond.drive(0.1, x=math.nan)

    assert pond.pose.linear_velocity == 0.0
    assert math.isfinite(pond.pose.x)


async def test_a_turtle_sees_the_color_of_what_it_has_drawn(pond: Pond) -> None:
    """White where there is nothing, as in the original."""
    assert pond.color == Color(r=255, g=255, b=255)

    await pond.drive(0.5, x=1.0)
    assert pond.color == Color(r=0xB3, g=0xB8, b=0xFF)


async def test_a_pen_has_a_color_and_can_be_lifted(pond: Pond) -> None:
    """By the service of the turtle."""
    await pond.call(SetPen, "turtle1/set_pen", r=255, g=1, b=2, width=5)
    await pond.drive(0.3, x=1.0)
    assert pond.color == Color(r=255, g=1, b=2)

    await pond.call(SetPen, "turtle1/set_pen", off=1)
    await pond.drive(0.9, x=1.0)
    assert pond.color == Color(r=255, g=255, b=255)


async def test_a_turtle_can_be_elsewhere_at_once(pond: Pond) -> None:
    """Absolutely, and from where it is; there is a line then."""
    await pond.call(TeleportAbsolute, "turtle1/teleport_absolute", x=1.0, y=2.0, theta=0.5)
    await pond.wait(0.02)
    assert pond.place == pytest.approx((1.0, 2.0, 0.5))

    await pond.call(TeleportRelative, "turtle1/teleport_relative", linear=2.0, angular=-0.5)
    await pond.wait(0.02)
    assert pond.place == pytest.approx((3.0, 2.0, 0.0), abs=1e-6)
    assert pond.color == Color(r=0xB3, g=0xB8, b=0xFF)


async def test_no_turtle_is_teleported_to_infinity(pond: Pond) -> None:
    """The caller is told."""
    with pytest.raises(ServiceError, match="x is inf; use a finite number"):
        await pond.call(TeleportAbsolute, "turtle1/teleport_absolute", x=math.inf)


async def test_turtles_are_spawned_and_killed(
    pond: Pond, capsys: pytest.CaptureFixture[str]
) -> None:
    """Under a name of their own, or the next one; their topics come and go with them."""
    assert (await pond.call(Spawn, "spawn", x=2.0, y=2.0, theta=0.2)).name == "turtle2"
    assert (await pond.call(Spawn, "spawn", x=2.0, y=3.0, name="bob")).name == "bob"
    assert (await pond.call(Spawn, "spawn", name="bob")).name == ""
    assert "A turtle named [bob] already exists" in capsys.readouterr().err

    await pond.call(Kill, "kill", name="bob")
    await pond.call(Kill, "kill", name="bob")
    assert "Tried to kill turtle [bob], which does not exist" in capsys.readouterr().err
    await settle()
    names = {name for name, _ in pond.node.get_topic_names_and_types()}
    assert "/turtle2/pose" in names
    assert "/bob/pose" not in names


async def test_a_turtle_needs_a_name_of_topics(pond: Pond) -> None:
    """The original ends; here its client is told, and the others go on."""
    with pytest.raises(ServiceError, match="InvalidTopicName"):
        await pond.call(Spawn, "spawn", name="no name")

    assert (await pond.call(Spawn, "spawn")).name == "turtle2"


async def test_clear_removes_the_lines_only(pond: Pond) -> None:
    """The turtle stays where it is."""
    await pond.drive(1.5, x=1.0)
    await pond.call(Empty, "clear")
    await pond.wait(0.1)

    assert pond.color == Color(r=255, g=255, b=255)
    assert pond.pose.x > MIDDLE + 0.9


async def test_reset_begins_anew(pond: Pond) -> None:
    """One turtle in the middle, which can be driven."""
    await pond.call(Spawn, "spawn", name="bob")
    await pond.drive(0.5, x=1.0)
    await pond.call(Empty, "reset")
    await pond.wait(0.1)

    assert pond.place == pytest.approx((MIDDLE, MIDDLE, 0.0))
    assert list(pond.sim.turtles) == ["turtle1"]
    assert (await pond.drive(0.5, x=1.0)).x > MIDDLE + 0.4


async def test_the_action_turns_a_turtle_to_an_angle(pond: Pond) -> None:
    """With feedback, and how far it has turned; at one radian per second."""
    left = []
    goal = await pond.rotations.send_goal(
        RotateAbsolute.Goal(theta=1.57),
        feedback_callback=lambda each: left.append(each.feedback.remaining),
    )
    await pond.wait(1.0)
    assert pond.pose.angular_velocity == 1.0
    await pond.wait(1.0)

    outcome = await goal.result()
    assert outcome.result.delta == pytest.approx(-1.57, abs=0.02)
    assert pond.place[2] == pytest.approx(1.57, abs=0.02)
    assert left[0] == pytest.approx(1.57)
    assert len(left) > 90


async def test_a_command_aborts_a_rotation(pond: Pond, capsys: pytest.CaptureFixture[str]) -> None:
    """Whoever drives has the turtle."""
    goal = await pond.rotations.send_goal(RotateAbsolute.Goal(theta=3.0))
    await pond.wait(0.5)
    await pond.drive(0.1, x=1.0)

    assert (await goal.result()).status.name == "ABORTED"
    assert "Velocity command received during rotation goal. Aborting goal" in (
        capsys.readouterr().err
    )
    assert pond.pose.linear_velocity == 1.0


async def test_a_rotation_aborts_the_one_before(pond: Pond) -> None:
    """A turtle turns to one angle only."""
    first = await pond.rotations.send_goal(RotateAbsolute.Goal(theta=3.0))
    await pond.wait(0.1)
    second = await pond.rotations.send_goal(RotateAbsolute.Goal(theta=-0.5))
    await pond.wait(2.0)

    assert (await first.result()).status.name == "ABORTED"
    assert (await second.result()).status.name == "SUCCEEDED"
    assert pond.pose.theta == pytest.approx(-0.5, abs=0.02)


async def test_a_rotation_can_be_canceled(pond: Pond) -> None:
    """The turtle stands then."""
    goal = await pond.rotations.send_goal(RotateAbsolute.Goal(theta=3.0))
    await pond.wait(0.5)
    await goal.cancel()
    await pond.wait(0.1)

    assert (await goal.result()).status.name == "CANCELED"
    assert pond.pose.angular_velocity == 0.0


async def test_a_goal_without_an_angle_is_rejected(pond: Pond) -> None:
    """There is no way to turn to NaN."""
    with pytest.raises(GoalRejectedError):
        await pond.rotations.send_goal(RotateAbsolute.Goal(theta=math.nan))


async def test_the_window_is_a_topic(pond: Pond) -> None:
    """As PNG, with background, lines and turtles; a still one comes once a second."""
    pictures: list[CompressedImage] = []
    pond.node.create_subscription(CompressedImage, "turtlesim/image/compressed", pictures.append)
    await settle()
    await pond.drive(1.5, x=2.0)

    pixels = np.asarray(PIL.Image.open(io.BytesIO(bytes(pictures[-1].data))))
    assert pixels.shape == (500, 500, 3)
    assert pixels[10, 10].tolist() == [0x45, 0x56, 0xFF]
    line, turtle = pixels[250, 270].tolist(), pixels[250, 338].tolist()
    assert line == [0xB3, 0xB8, 0xFF]
    assert turtle not in (line, [0x45, 0x56, 0xFF])
    await pond.wait(1.0)
    before = len(pictures)
    await pond.wait(3.0)
    assert len(pictures) == before + 3


async def test_the_background_is_a_parameter(pond: Pond) -> None:
    """As the tutorial of parameters sets it; the window shows it without `clear`."""
    pictures: list[CompressedImage] = []
    pond.node.create_subscription(CompressedImage, "turtlesim/image/compressed", pictures.append)
    parameter = type(pond.sim.get_parameter("background_r"))
    assert pond.sim.set_parameters([parameter("background_r", value=150)])[0].successful
    assert not pond.sim.set_parameters([parameter("background_r", value=256)])[0].successful
    await pond.wait(0.3)

    pixels = np.asarray(PIL.Image.open(io.BytesIO(bytes(pictures[-1].data))))
    assert pixels[10, 10].tolist() == [150, 0x56, 0xFF]


async def test_keys_move_and_turn_the_turtle(pond: Pond, start: Start) -> None:
    """Arrow keys send three characters, of which the last one counts."""
    keys = start(TeleopTurtle, scale_linear=1.0)
    await settle()
    for key in "\x1b[A":
        keys.press(key)
    await pond.wait(2.0)
    assert pond.pose.x == pytest.approx(MIDDLE + 1.0, abs=0.04)

    keys.press("r")
    await pond.wait(0.5)
    keys.press("f")
    await pond.wait(0.1)
    assert pond.pose.angular_velocity == 0.0
    keys.press("r")
    await pond.wait(2.0)
    assert pond.pose.theta == pytest.approx(1.57, abs=0.02)
    keys.press("q")
    assert keys.is_ended.is_set()


async def test_a_square_is_drawn(pond: Pond, start: Start) -> None:
    """Its corners are two units apart."""
    await pond.drive(0.5, x=1.0)
    start(DrawSquare)
    await pond.wait(2.3)
    assert pond.place[:2] == pytest.approx((MIDDLE + 1.95, MIDDLE), abs=0.1)

    await pond.wait(6.0)
    assert pond.pose.y > MIDDLE + 1.0


async def test_one_turtle_mimics_another_one(pond: Pond, start: Start) -> None:
    """Its speeds are those of the other one's pose."""
    commands: list[Twist] = []
    pond.node.create_subscription(Twist, "output/cmd_vel", commands.append)
    poses = pond.node.create_publisher(Pose, "input/pose", 7)
    start(Mimic)
    await settle()
    poses.publish(Pose(linear_velocity=1.5, angular_velocity=-0.5))
    await settle()

    assert (commands[-1].linear.x, commands[-1].angular.z) == (1.5, -0.5)


# As the tutorials have it

AIONODE = [sys.executable, "-m", "aionode"]


@pytest.fixture
def environment() -> Iterator[dict[str, str]]:
    """Start the program as the first tutorial says."""
    env = {**os.environ, **isolated_environment(), "PYTHONUNBUFFERED": "1"}
    command = [*AIONODE, "run", "turtlesim", "turtlesim_node"]
    with subprocess.Popen(command, env=env, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        while "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]" not in (
            process.stderr.readline()
        ):
            assert process.poll() is None
        yield env
        process.send_signal(signal.SIGINT)
        process.stderr.read()
    assert process.returncode in (0, 130)


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(90)
@pytest.mark.one_loop
def test_the_commands_of_the_tutorials_work_word_for_word(environment: dict[str, str]) -> None:
    """With `aionode` in place of `ros2`."""

    def say(*words: str) -> str:
        done = subprocess.run(
            [*AIONODE, *words], env=environment, capture_output=True, text=True, check=False,
            timeout=40,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "/turtlesim" in say("node", "list")
    assert "geometry_msgs/msg/Twist" in say("topic", "list", "-t")
    assert "turtlesim/srv/Spawn" in say("service", "type", "/spawn")
    spawn = "{x: 2, y: 2, theta: 0.2, name: ''}"
    assert "turtle2" in say("service", "call", "/spawn", "turtlesim/srv/Spawn", spawn)
    twist = "{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"
    say("topic", "pub", "--once", "-w", "1", "/turtle1/cmd_vel", "geometry_msgs/msg/Twist", twist)
    assert "theta" in say("topic", "echo", "--once", "/turtle1/pose")
    assert "Set parameter successful" in say("param", "set", "/turtlesim", "background_r", "150")
    theta = "{theta: 1.57}"
    rotate = ("turtlesim/action/RotateAbsolute", theta, "--feedback")
    said = say("action", "send_goal", "/turtle1/rotate_absolute", *rotate)
    assert "remaining" in said
    assert "SUCCEEDED" in said


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(90)
@pytest.mark.one_loop
def test_arrow_keys_of_a_terminal_move_the_turtle(environment: dict[str, str]) -> None:
    """'q' ends the program."""
    pexpect = pytest.importorskip("pexpect", reason="pseudo-terminals are of Unix")

    def open_terminal(*words: str) -> Any:
        return pexpect.spawn(
            *(AIONODE[0], [*AIONODE[1:], *words]), env=environment, encoding="utf-8", timeout=30
        )

    pose = open_terminal("topic", "echo", "/turtle1/pose")
    keys = open_terminal("run", "turtlesim", "turtle_teleop_key")
    try:
        pose.expect(r"x: 5\.5444")
        keys.expect("'Q' to quit.")
        keys.send("\x1b[A")
        pose.expect(r"x: [67]\.")
        keys.send("q")
        keys.expect(pexpect.EOF)
        assert "Traceback" not in keys.before
    finally:
        for terminal in (pose, keys):
            terminal.close(force=True)
