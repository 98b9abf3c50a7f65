"""``joy_teleop joy_teleop``: buttons and axes publish messages, call services and send goals."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any, Final

import aionode
from aionode import Node, QoSProfile
from aionode.action import ActionClient
from aionode.errors import AionodeError, CommandError, LeaseExpiredError
from aionode.interfaces.sensor_msgs.msg import Joy
from aionode.message import from_builtins, to_builtins, type_name
from aionode.programs._leased_twists import TTL_SEC, LeasedCommands
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["JoyTeleop", "main"]

START_SEC: Final = 0.01
MAX_INDEX: Final = 10_000
"""The highest index in a list that an axis may set."""

DEFAULT: Final = "default"

MAX_UNANSWERED: Final = 100
"""Maximum unanswered requests of a command; further presses send nothing."""

MOTION: Final = frozenset(
    {
        *("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"),
        *("ackermann_msgs/msg/AckermannDrive", "ackermann_msgs/msg/AckermannDriveStamped"),
    }
)
"""Commands that apply until the next one, so they must be followed by a stop."""


def interface(name: Any, kind: str) -> Any:
    """Return the class of a type.

    Raises:
        CommandError: There is no such type.
    """
    package, given, short = [*str(name).split("/"), "", ""][:3]
    if str(name).count("/") != 2:
        raise CommandError(f"Invalid type_name '{name}'")
    if given != kind:
        raise CommandError(f"Cannot use interface of type '{given}' for an '{kind}'")
    try:
        return getattr(import_module(f"aionode.interfaces.{package}.{kind}"), short)
    except (ImportError, AttributeError, AionodeError) as error:
        raise CommandError(f"type '{name}' is not available: {error}") from None


def needed(config: Mapping[str, Any], key: str, command: str) -> Any:
    """Return a parameter of a command.

    Raises:
        CommandError: It is missing.
    """
    if key not in config:
        raise CommandError(f"command '{command}' has no '{key}'")
    return config[key]


def name_in(config: Mapping[str, Any], key: str, command: str) -> str:
    """Return the name of a topic, service or action.

    Raises:
        CommandError: It is missing, or not text.
    """
    found = needed(config, key, command)
    if isinstance(found, str):
        return found
    raise CommandError(f"command '{command}': '{key}' is {found!r}; use a name")


def parts(config: Mapping[str, Any], key: str, command: str) -> dict[str, dict[str, Any]]:
    """Return the fields of a message, and the mapping for each.

    Raises:
        CommandError: The value is not such a mapping.
    """
    found = config[key]
    if isinstance(found, dict) and all(isinstance(each, dict) for each in found.values()):
        return found
    raise CommandError(
        f"command '{command}': '{key}' is {found!r}; use a mapping from each field, such as "
        "'linear-x', to a mapping"
    )


def indices(config: Mapping[str, Any], key: str, command: str) -> list[int]:
    """Return the numbers of buttons or axes.

    Raises:
        CommandError: The value is not a list of such numbers.
    """
    found = config.get(key, [])
    if isinstance(found, list) and all(type(each) is int and each >= 0 for each in found):
        return found
    raise CommandError(
        f"command '{command}': '{key}' is {found!r}; use numbers from 0 on, in a list"
    )


def message_of(cls: Any, values: Mapping[str, Any], command: str) -> Any:
    """Return a message with these values.

    Raises:
        CommandError: They do not fit.
    """
    try:
        return from_builtins(cls, values)
    except AionodeError as error:
        raise CommandError(f"command '{command}': {error}") from None


def put(whole: dict[str, Any], path: Sequence[str], value: Any) -> None:
    """Set a value in nested values.

    Raises:
        CommandError: A part of it has a value too, or the whole that it belongs to.
    """
    *parents, last = path
    place: Any = whole
    for name in parents:
        place = place.setdefault(name, {}) if isinstance(place, dict) else place
    if not isinstance(place, dict) or isinstance(place.get(last), dict):
        raise CommandError(
            f"'{'-'.join(path)}' has a value, and so has a part of it or the whole; set only one"
        )
    place[last] = value


class Command:
    """A command of buttons and axes; it is active while all of them are pressed.

    The command `DEFAULT` needs none: without any, it is active while no button is pressed.

    Args:
        name: Its name in the parameters.
        config: Its parameters.
        prefix: The prefix of the parameters with the buttons and axes.

    Raises:
        CommandError: There are none.
    """

    def __init__(self, name: str, config: Mapping[str, Any], prefix: str = "") -> None:
        self.name = name
        self.buttons, self.axes, self.negative = (
            indices(config, f"{prefix}{key}", name) for key in ("buttons", "axes", "axes_negative")
        )
        self.is_default = not (self.buttons or self.axes or self.negative)
        if self.is_default and name != DEFAULT:
            raise CommandError(f"No buttons, axes or negative_axes configured for command '{name}'")
        self.is_active = False

    def is_pressed(self, joy: Joy) -> bool:
        """Return whether its buttons and axes are pressed; missing ones never are."""
        if self.is_default:
            return not any(joy.buttons)
        return (
            all(at < len(joy.buttons) and joy.buttons[at] == 1 for at in self.buttons)
            and all(at < len(joy.axes) and joy.axes[at] == 1.0 for at in self.axes)
            and all(at < len(joy.axes) and joy.axes[at] == -1.0 for at in self.negative)
        )

    def run(self, joy: Joy, *, is_new: bool) -> None:
        """Carry out the command if it is active; `is_new` if it was not at the last message."""
        raise NotImplementedError


class MessageCommand(Command):
    """Publishes a message, once each time it becomes active."""

    def __init__(self, name: str, config: Mapping[str, Any], node: Node) -> None:
        super().__init__(name, config, "deadman_")
        self.node = node
        self.kind = interface(needed(config, "interface_type", name), "msg")
        values: dict[str, Any] = {}
        for target, given in parts(config, "message_value", name).items():
            put(values, target.strip("-").split("-"), needed(given, "value", name))
        self.message = message_of(self.kind, values, name)
        topic = name_in(config, "topic_name", name)
        self.publisher = node.create_publisher(self.kind, topic, QoSProfile(depth=1))

    def run(self, joy: Joy, *, is_new: bool) -> None:
        """Publish the message."""
        del joy
        if self.is_active and is_new:
            stamp(self.message, self.node)
            self.publisher.publish(self.message)


class AxesCommand(Command):
    """Publishes the values of axes and buttons while it is active.

    A command that moves a robot is published under a lease, so that a stop follows it.
    """

    def __init__(self, name: str, config: Mapping[str, Any], node: Node) -> None:
        super().__init__(name, config, "deadman_")
        self.node = node
        self.kind = interface(needed(config, "interface_type", name), "msg")
        self.mappings = parts(config, "axis_mappings", name)
        for mapping in self.mappings.values():
            self.check(mapping)
        self.neutral = to_builtins(self.kind())
        self.as_int = {target for target in self.mappings if not self.takes_fraction(target)}
        message_of(self.kind, self.values(Joy()), name)
        topic = name_in(config, "topic_name", name)
        self.publisher = node.create_publisher(self.kind, topic, QoSProfile(depth=1))
        self.command: Any = None
        self.leased: LeasedCommands | None = None
        if type_name(self.kind) in MOTION:
            self.leased = LeasedCommands(
                self.publisher, lambda: self.command, self.stop, self.on_expired
            )
            create_wall_timer(node, START_SEC, self.leased.drive)

    def check(self, mapping: Mapping[str, Any]) -> None:
        """Reject a mapping that does not say what to publish.

        Raises:
            CommandError: It does not.
        """
        if not {"axis", "button", "value"} & set(mapping):
            raise CommandError(
                f"Axis mapping for '{self.name}' must have an axis, button, or value"
            )
        for key in ("offset", "scale"):
            if "axis" in mapping and key not in mapping:
                raise CommandError(f"Axis mapping for '{self.name}' must have an {key}")
        for key in ("axis", "button", "index"):
            if type(mapping.get(key, 0)) is not int:
                raise CommandError(f"'{self.name}': {key} is {mapping[key]!r}; use a whole number")
        for key in ("offset", "scale"):
            given = mapping.get(key, 0.0)
            if type(given) not in (int, float) or not math.isfinite(given):
                raise CommandError(f"'{self.name}': {key} is {given!r}; use a finite number")
        if not 0 <= mapping.get("index", 0) <= MAX_INDEX:
            raise CommandError(f"'{self.name}': index is {mapping['index']}; use 0 to {MAX_INDEX}")

    def takes_fraction(self, target: str) -> bool:
        """Return whether a field takes numbers with a fraction."""
        values: dict[str, Any] = {}
        path = target.strip("-").split("-")
        put(values, path, [0.5] if isinstance(self.present(path), list) else 0.5)
        try:
            from_builtins(self.kind, values)
        except AionodeError:
            return False
        return True

    def present(self, path: Sequence[str]) -> Any:
        """Return the value of a field by default; None if there is none."""
        value: Any = self.neutral
        for name in path:
            value = value.get(name) if isinstance(value, dict) else None
        return value

    def values(self, joy: Joy) -> dict[str, Any]:
        """Return the values of the message for a joystick."""
        result: dict[str, Any] = {}
        for target, mapping in self.mappings.items():
            path = target.strip("-").split("-")
            value = self.value_of(target, mapping, joy)
            if isinstance(self.present(path), list) and not isinstance(value, list):
                parent: Any = result
                for name in path[:-1]:
                    parent = parent.get(name, {})
                items = list(parent.get(path[-1], ()))
                at = mapping.get("index", 0)
                items += [0] * (at + 1 - len(items))
                items[at] = value
                value = items
            put(result, path, value)
        return result

    def value_of(self, target: str, mapping: Mapping[str, Any], joy: Joy) -> Any:
        """Return the value of a mapping; 0 for what the joystick does not have."""
        if not {"axis", "button"} & set(mapping):
            return mapping["value"]
        what, given = ("axis", joy.axes) if "axis" in mapping else ("button", joy.buttons)
        at, value = mapping[what], 0.0
        if 0 <= at < len(given):
            value = float(given[at]) * mapping.get("scale", 1.0) + mapping.get("offset", 0.0)
        elif len(joy.axes):
            self.node.get_logger().error(
                f"Joystick has only {len(given)} of those (indexed from 0), but {what} #{at} was "
                "referenced in config.",
                throttle_duration_sec=5.0,
            )
        if not math.isfinite(value):
            value = 0.0
        return int(value) if target in self.as_int else value

    def run(self, joy: Joy, *, is_new: bool) -> None:
        """Publish the values of the axes, or stop."""
        del is_new
        self.command = None
        if self.is_active:
            try:
                self.command = from_builtins(self.kind, self.values(joy))
                stamp(self.command, self.node)
            except AionodeError as error:  # the axes are farther out than a field can hold
                self.node.get_logger().error(
                    f"'{self.name}' publishes nothing: {error}", throttle_duration_sec=5.0
                )
        if self.leased is not None:
            self.leased.repeat()
        elif self.command is not None:
            self.publisher.publish(self.command)

    def stop(self) -> Any:
        """Return the command to stand still."""
        message = self.kind()
        if self.command is not None and hasattr(message, "header"):
            message.header.frame_id = self.command.header.frame_id
        stamp(message, self.node)
        return message

    def on_expired(self, _: LeaseExpiredError) -> None:
        """Forget the command of a joystick that sends nothing any more."""
        self.command = None
        self.node.get_logger().warning(
            f"'{self.name}' stopped: the joystick sent nothing for {TTL_SEC:g} s; it is unplugged, "
            "or its autorepeat_rate is too low"
        )


class CallCommand(Command):
    """Calls a service or sends a goal, once each time it becomes active and there is a server."""

    def __init__(self, name: str, config: Mapping[str, Any], node: Node) -> None:
        super().__init__(name, config)
        self.node = node
        self.was_ready = False
        self.unanswered: set[asyncio.Future[Any]] = set()
        self.is_ready: Callable[[], bool]
        self.send: Callable[[Any], asyncio.Future[Any]]
        type_given = needed(config, "interface_type", name)
        if config["type"] == "service":
            kind = interface(type_given, "srv")
            self.request = message_of(kind.Request, config.get("service_request", {}), name)
            client = node.create_client(kind, name_in(config, "service_name", name))
            self.is_ready, self.send = client.service_is_ready, client.call_async
        else:
            kind = interface(type_given, "action")
            self.request = message_of(kind.Goal, config.get("action_goal", {}), name)
            goals = ActionClient(node, kind, name_in(config, "action_name", name))
            self.is_ready, self.send = goals.server_is_ready, goals.send_goal_async

    def run(self, joy: Joy, *, is_new: bool) -> None:
        """Send the request; the answer is of no interest."""
        del joy
        if not self.is_active:
            return
        was_ready, self.was_ready = self.was_ready, self.is_ready()
        if not self.was_ready or (was_ready and not is_new):
            return
        if len(self.unanswered) >= MAX_UNANSWERED:
            self.node.get_logger().warning(
                f"'{self.name}' is not sent: {MAX_UNANSWERED} requests wait for their answers",
                throttle_duration_sec=5.0,
            )
            return
        answer = self.send(self.request)
        self.unanswered.add(answer)
        answer.add_done_callback(self.unanswered.discard)


def stamp(message: Any, node: Node) -> None:
    """Set the time in the header of a message, if it has one."""
    if hasattr(message, "header"):
        message.header.stamp = node.get_clock().now().to_msg()


def command_of(name: str, config: Mapping[str, Any], node: Node) -> Command:
    """Return a command.

    Raises:
        CommandError: Its parameters do not fit.
    """
    kind = config.get("type")
    if kind in ("service", "action"):
        return CallCommand(name, config, node)
    if kind != "topic":
        raise CommandError(f"unknown type '{kind}' for command '{name}'")
    if "message_value" in config and "axis_mappings" in config:
        raise CommandError(
            f"Only one of 'message_value' or 'axis_mappings' can be configured for command '{name}'"
        )
    if "message_value" in config:
        return MessageCommand(name, config, node)
    if "axis_mappings" in config:
        return AxesCommand(name, config, node)
    raise CommandError(f"No 'message_value' or 'axis_mappings' configured for command '{name}'")


class JoyTeleop(Node):
    """Runs the commands that its parameters assign to buttons and axes of the topic `joy`.

    Raises:
        CommandError: A parameter does not fit.
    """

    def __init__(self) -> None:
        super().__init__(
            "joy_teleop",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        whole: dict[str, Any] = {}
        for name, parameter in sorted(self.get_parameters_by_prefix("").items()):
            value = parameter.value
            value = value.tolist() if hasattr(value, "tolist") else value
            put(whole, name.split("."), value)
        self.commands = [
            command_of(name, config, self)
            for name, config in whole.items()
            if isinstance(config, dict) and "type" in config
        ]
        self.create_subscription(Joy, "joy", self.on_joy, QoSProfile(depth=1))

    def on_joy(self, joy: Joy) -> None:
        """Run the active commands; those no longer active end first: others may replace them."""
        states = [(command, command.is_pressed(joy)) for command in self.commands]
        for command, is_pressed in sorted(states, key=lambda state: state[1]):
            is_new = is_pressed and not command.is_active
            command.is_active = is_pressed
            command.run(joy, is_new=is_new)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(JoyTeleop)
