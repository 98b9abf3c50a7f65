"""The program by which buttons and axes publish, call services and send goals."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from typing import Any

import pytest

from aionode.action import ActionServer
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.interfaces.sensor_msgs.msg import Joy
from aionode.interfaces.std_msgs.msg import Int8, String, UInt8MultiArray
from aionode.programs._joy.joy_teleop import MAX_UNANSWERED, JoyTeleop
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

WALK: dict[str, Any] = {
    "walk.type": "topic",
    "walk.interface_type": "geometry_msgs/msg/Twist",
    "walk.topic_name": "cmd_vel",
    "walk.deadman_buttons": [1],
    "walk.axis_mappings.linear-x.axis": 1,
    "walk.axis_mappings.linear-x.scale": 0.5,
    "walk.axis_mappings.linear-x.offset": 0.1,
    "walk.axis_mappings.angular-z.button": 0,
    "walk.axis_mappings.angular-z.scale": 3.0,
}

HELLO: dict[str, Any] = {
    "hello.type": "topic",
    "hello.interface_type": "std_msgs/msg/String",
    "hello.topic_name": "chatter",
    "hello.deadman_buttons": [0],
    "hello.message_value.data.value": "Hello",
}


class Desk:
    """A joystick, and what its program does."""

    def __init__(self, node: Any, clock: ManualClock, program: Any) -> None:
        self.node, self.clock, self.program = node, clock, program
        self.joy = node.create_publisher(Joy, "joy", 1)
        self.heard: list[Any] = []

    def listen(self, kind: Any, topic: str) -> None:
        """Note what is published."""
        self.node.create_subscription(kind, topic, self.heard.append)

    async def press(self, *buttons: int, axes: Any = (0.0, 0.0)) -> list[Any]:
        """Publish the state of the joystick, and return what has been published since then."""
        before = len(self.heard)
        self.joy.publish(Joy(buttons=list(buttons), axes=list(axes)))
        await settle()
        return self.heard[before:]


@pytest.fixture
def desk(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the program."""

    async def make(kind: Any = None, topic: str = "", **parameters: Any) -> Desk:
        program = start(JoyTeleop, **parameters)
        result = Desk(node_factory("people"), manual_clock, program)
        if kind is not None:
            result.listen(kind, topic)
        await settle()
        await manual_clock.advance(0.05)
        return result

    return make


def speeds(msgs: list[Any]) -> list[tuple[float, float]]:
    """Return forward and turning speeds."""
    return [(round(msg.linear.x, 3), round(msg.angular.z, 3)) for msg in msgs]


async def test_axes_and_buttons_are_scaled_while_the_button_is_held(
    desk: Callable[..., Any],
) -> None:
    """Each message of the joystick is a command."""
    it = await desk(Twist, "cmd_vel", **WALK)

    assert await it.press(0, 0, axes=(0.0, 1.0)) == []
    assert speeds(await it.press(0, 1, axes=(0.0, 1.0))) == [(0.6, 0.0)]
    assert speeds(await it.press(1, 1, axes=(0.0, -1.0))) == [(-0.4, 3.0)]


async def test_a_robot_stops_when_the_button_is_released(desk: Callable[..., Any]) -> None:
    """The original leaves it at the last command."""
    it = await desk(Twist, "cmd_vel", **WALK)
    await it.press(0, 1, axes=(0.0, 1.0))

    assert speeds(await it.press(0, 0, axes=(0.0, 1.0))) == [(0.0, 0.0)]
    assert await it.press(0, 0) == []


async def test_the_default_command_is_active_while_no_button_is_pressed(
    desk: Callable[..., Any],
) -> None:
    """F1TENTH's cars so keep planners from driving until somebody holds a button."""
    still = {
        name.replace("walk", "default"): 0.0 if name.endswith(("scale", "offset")) else value
        for name, value in WALK.items()
        if not name.endswith("buttons")
    }
    it = await desk(Twist, "cmd_vel", **WALK | still)

    assert speeds(await it.press(0, 0, axes=(0.0, 1.0))) == [(0.0, 0.0)]
    assert speeds(await it.press(0, 1, axes=(0.0, 1.0)))[-1:] == [(0.6, 0.0)]
    assert len(await it.press(1, 0, axes=(0.0, 1.0))) == 1  # the stop of the other command
    assert await it.press(1, 0, axes=(0.0, 1.0)) == []


async def test_a_robot_stops_when_the_joystick_falls_silent(
    desk: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """It may be unplugged."""
    it = await desk(Twist, "cmd_vel", **WALK)
    await it.press(0, 1, axes=(0.0, 1.0))
    await it.clock.advance(0.4)
    await settle()

    assert speeds(it.heard)[-1] == (0.0, 0.0)
    assert "'walk' stopped: the joystick sent nothing for 0.3 s" in caplog.text
    assert speeds(await it.press(0, 1, axes=(0.0, 1.0))) == [(0.6, 0.0)]


async def test_a_robot_stops_when_the_program_ends(desk: Callable[..., Any]) -> None:
    """By Ctrl-C, for instance."""
    it = await desk(Twist, "cmd_vel", **WALK)
    await it.press(0, 1, axes=(0.0, 1.0))
    it.program.destroy_node()
    await settle()

    assert speeds(it.heard)[-1] == (0.0, 0.0)


async def test_of_two_buttons_the_one_that_is_pressed_commands(desk: Callable[..., Any]) -> None:
    """The stop of the other one comes before, whatever their order is."""
    turbo = {key.replace("walk", "run"): value for key, value in WALK.items()}
    turbo |= {"run.deadman_buttons": [2], "run.axis_mappings.linear-x.scale": 2.0}
    it = await desk(Twist, "cmd_vel", **WALK, **turbo)
    await it.press(0, 1, 0, axes=(0.0, 1.0))

    assert speeds(await it.press(0, 0, 1, axes=(0.0, 1.0))) == [(0.0, 0.0), (2.1, 0.0)]
    assert speeds(await it.press(0, 1, 0, axes=(0.0, 1.0))) == [(0.0, 0.0), (0.6, 0.0)]


async def test_a_message_gets_the_time_and_fixed_values(desk: Callable[..., Any]) -> None:
    """The stop too, so that a base takes it."""
    given = {key.replace("linear", "twist-linear"): value for key, value in WALK.items()}
    given = {key.replace("angular", "twist-angular"): value for key, value in given.items()}
    given["walk.interface_type"] = "geometry_msgs/msg/TwistStamped"
    given["walk.axis_mappings.header-frame_id.value"] = "base"
    it = await desk(TwistStamped, "cmd_vel", **given)
    await it.clock.advance(5.0)
    await it.press(0, 1, axes=(0.0, 1.0))
    await it.press(0, 0)

    command, _ = it.heard
    assert (command.header.stamp.sec, command.header.frame_id) == (5, "base")
    assert command.twist.linear.x == pytest.approx(0.6)


async def test_axes_that_are_no_numbers_or_not_there_are_zero(desk: Callable[..., Any]) -> None:
    """With its offset, an axis that does not exist would drive the robot."""
    it = await desk(Twist, "cmd_vel", **WALK)

    assert speeds(await it.press(0, 1, axes=(0.0, math.nan))) == [(0.0, 0.0)]
    assert speeds(await it.press(0, 1, axes=(0.5,))) == [(0.0, 0.0)]


async def test_an_axis_farther_out_than_its_field_holds_publishes_nothing(
    desk: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Whoever publishes the joystick must not end the program."""
    steer = {
        "walk.interface_type": "std_msgs/msg/Int8",
        "walk.type": "topic",
        "walk.topic_name": "steer",
        "walk.deadman_buttons": [0],
        "walk.axis_mappings.data.axis": 0,
        "walk.axis_mappings.data.scale": 100.0,
        "walk.axis_mappings.data.offset": 0.0,
    }
    it = await desk(Int8, "steer", **steer)
    await it.clock.advance(10.0)  # the errors are throttled

    assert await it.press(1, axes=[5.0]) == []
    assert "'walk' publishes nothing: std_msgs/msg/Int8.data: 500" in caplog.text
    assert await it.press(1, axes=[1.0]) == [Int8(data=100)]


async def test_buttons_that_are_not_there_are_not_pressed(desk: Callable[..., Any]) -> None:
    """A dead man's button above all; the original ignores it, and moves the robot."""
    it = await desk(Twist, "cmd_vel", **WALK | {"walk.deadman_buttons": [1, 10]})

    assert await it.press(0, 1, axes=(0.0, 1.0)) == []


async def test_axes_at_their_ends_are_buttons(desk: Callable[..., Any]) -> None:
    """The triggers of a game pad are such axes."""
    given = WALK | {"walk.deadman_axes": [0], "walk.deadman_axes_negative": [2]}
    it = await desk(Twist, "cmd_vel", **given)

    assert await it.press(0, 1, axes=(1.0, 1.0, 0.0)) == []
    assert len(await it.press(0, 1, axes=(1.0, 1.0, -1.0))) == 1


async def test_a_message_is_published_once_for_each_press(desk: Callable[..., Any]) -> None:
    """However long the button is held."""
    it = await desk(String, "chatter", **HELLO)
    for button in (1, 1, 0, 1):
        await it.press(button)

    assert [msg.data for msg in it.heard] == ["Hello", "Hello"]


async def test_other_messages_are_published_without_a_stop(desk: Callable[..., Any]) -> None:
    """Zeros would move the camera. Whole numbers are made of axes where the field needs them."""
    it = await desk(
        UInt8MultiArray,
        "bytes",
        **{
            "array.type": "topic",
            "array.interface_type": "std_msgs/msg/UInt8MultiArray",
            "array.topic_name": "bytes",
            "array.deadman_buttons": [0],
            "array.axis_mappings.data.axis": 0,
            "array.axis_mappings.data.scale": 10.0,
            "array.axis_mappings.data.offset": 0.0,
            "array.axis_mappings.data-.index": 2,
            "array.axis_mappings.data-.axis": 1,
            "array.axis_mappings.data-.scale": 1.0,
            "array.axis_mappings.data-.offset": 5.0,
        },
    )
    await it.press(1, axes=(0.55, 1.0))
    await it.press(0)

    (found,) = it.heard
    assert list(found.data) == [5, 0, 6]


async def test_a_service_is_called_once_for_each_press(desk: Callable[..., Any]) -> None:
    """Without a server, it is called as soon as there is one, while the button is held."""
    it = await desk(
        **{
            "add.type": "service",
            "add.interface_type": "example_interfaces/srv/AddTwoInts",
            "add.service_name": "add_two_ints",
            "add.service_request.a": 11,
            "add.service_request.b": 31,
            "add.buttons": [0],
        }
    )
    sums: list[int] = []

    def serve(request: Any, response: Any) -> Any:
        sums.append(request.a + request.b)
        return response

    await it.press(1)
    it.node.create_service(AddTwoInts, "add_two_ints", serve)
    await settle()
    for button in (1, 1, 0, 1):
        await it.press(button)

    assert sums == [42, 42]


async def test_a_goal_is_sent_once_for_each_press(desk: Callable[..., Any]) -> None:
    """With the values of the parameters."""
    it = await desk(
        **{
            "count.type": "action",
            "count.interface_type": "example_interfaces/action/Fibonacci",
            "count.action_name": "fibonacci",
            "count.action_goal.order": 5,
            "count.buttons": [0],
        }
    )
    orders: list[int] = []

    async def execute(goal: Any) -> Any:
        orders.append(goal.request.order)
        goal.succeed()
        return Fibonacci.Result()

    ActionServer(it.node, Fibonacci, "fibonacci", execute)
    await settle()
    for button in (1, 1, 0, 1):
        await it.press(button)

    assert orders == [5, 5]


async def test_only_so_many_requests_wait_for_a_server_that_hangs(
    desk: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """Somebody could fill the memory otherwise."""
    it = await desk(
        **{
            "add.type": "service",
            "add.interface_type": "example_interfaces/srv/AddTwoInts",
            "add.service_name": "add",
            "add.buttons": [0],
        }
    )
    asked: list[Any] = []

    async def hang(request: Any, response: Any) -> Any:
        asked.append(request)
        await asyncio.Event().wait()
        return response

    it.node.create_service(AddTwoInts, "add", hang, concurrent=True)
    await settle()
    await it.clock.advance(10.0)  # the warnings are throttled
    for _ in range(MAX_UNANSWERED + 2):
        await it.press(1)
        await it.press(0)

    assert len(asked) == MAX_UNANSWERED
    assert f"'add' is not sent: {MAX_UNANSWERED} requests wait" in caplog.text


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"walk.type": "magic"}, "unknown type 'magic' for command 'walk'"),
        ({"walk.interface_type": "Twist"}, "Invalid type_name 'Twist'"),
        ({"walk.interface_type": "a/srv/B"}, "Cannot use interface of type 'srv' for an 'msg'"),
        (
            {"walk.interface_type": "nowhere_msgs/msg/B"},
            "type 'nowhere_msgs/msg/B' is not available",
        ),
        ({"walk.deadman_buttons": [-1]}, r"'deadman_buttons' is \[-1\]; use numbers from 0 on"),
        ({"walk.deadman_buttons": 1}, "'deadman_buttons' is 1; use numbers from 0 on, in a list"),
        ({"walk.topic_name": 5}, "command 'walk': 'topic_name' is 5; use a name"),
        ({"walk.axis_mappings.linear-x.axis": "1"}, "'walk': axis is '1'; use a whole number"),
        ({"walk.axis_mappings.linear-x.scale": "a"}, "'walk': scale is 'a'; use a finite number"),
        ({"walk.axis_mappings.linear-x.offset": math.nan}, "offset is nan; use a finite number"),
        ({"walk.axis_mappings.linear-x.index": "a"}, "'walk': index is 'a'; use a whole number"),
        ({"walk.axis_mappings.linear-z": 5}, "'linear-z': 5}; use a mapping from each field"),
        ({"walk.axis_mappings.linear-x-y.value": 1}, "'linear-x' has a value, and so has a part"),
        ({"walk.axis_mappings.linear-y.axis": 1}, "Axis mapping for 'walk' must have an offset"),
        ({"walk.axis_mappings.linear-y.speed": 1}, "must have an axis, button, or value"),
        ({"walk.axis_mappings.speed.value": 1.0}, "command 'walk': "),
        ({"walk.axis_mappings.linear-x.index": -1}, "index is -1; use 0 to 10000"),
        ({"walk.message_value.linear-x.value": 1.0}, "Only one of 'message_value' or"),
        ({"more.type": "topic"}, "No 'message_value' or 'axis_mappings' configured for command"),
        ({"more.type": "service"}, "No buttons, axes or negative_axes configured"),
        (HELLO | {"hello.message_value.text.value": "a"}, "command 'hello': "),
        (
            {"more.type": "action", "more.buttons": [1]},
            "command 'more' has no 'interface_type'",
        ),
    ],
)
async def test_parameters_that_do_not_fit_say_why(
    desk: Callable[..., Any], changes: dict[str, Any], problem: str
) -> None:
    """At the start, when somebody looks; mostly in the words of the original."""
    with pytest.raises(CommandError, match=problem):
        await desk(**WALK | changes)
