"""``topic_tools transform``: publishes a Python expression of each message on another topic."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

import aionode
from aionode import DurabilityPolicy, Node, Publisher, QoSProfile, ReliabilityPolicy
from aionode.arguments import remove_ros_args
from aionode.errors import AionodeError, CommandError
from aionode.interfaces import get_message
from aionode.programs._wall_timer import create_wall_timer
from aionode.qos import HistoryPolicy, QoSPresetProfiles, qos_profile_sensor_data

__all__ = ["Transform", "add_qos", "chosen_qos", "main", "parser"]

POLICIES: dict[str, Any] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
}
"""The QoS policies that have their own option."""

SEARCH_SEC = 0.1
"""How often the type of the input is looked up."""


class Transform(Node):
    """Publishes the value of an expression of each message, or of one of its fields, ``m``.

    Args:
        arguments: The parsed arguments of `parser`.

    Raises:
        CommandError: The expression, a module or a type is invalid.
    """

    tool = "transform"

    def __init__(self, arguments: argparse.Namespace) -> None:
        super().__init__(f"{self.tool}_{os.getpid()}")
        self.arguments = arguments
        self.fields = [part for part in (arguments.field or "").split(".") if part]
        if arguments.field is not None and not self.fields:
            raise CommandError(f"Invalid field value '{arguments.field}'")
        self.function = self.compiled(arguments)
        self.type = get_message(arguments.output_type)
        self.output: Publisher[Any] | None = None
        self.timer = create_wall_timer(self, SEARCH_SEC, self.begin)

    def compiled(self, arguments: argparse.Namespace) -> Callable[[Any], Any]:
        """Compile the expression to a function.

        Raises:
            CommandError: The expression or a module is invalid.
        """
        names: dict[str, Any] = {}
        for module in arguments.modules:
            try:
                names[module.partition(".")[0]] = module_named(module)
            except ImportError as error:
                raise CommandError(f"Failed to import module: {module}: {error}") from None
        try:
            code = compile(f"lambda m: ({arguments.expression})", "<expression>", "eval")
        except SyntaxError as error:
            raise CommandError(f"Wrong expression: {arguments.expression}: {error.msg}") from None
        function: Callable[[Any], Any] = eval(code, names)  # noqa: S307  # the user's own program
        return function

    async def begin(self) -> None:
        """Subscribe as soon as the type of the input is known."""
        publishers = self.get_publishers_info_by_topic(self.arguments.input)
        if self.output is not None or not publishers:
            return
        try:
            message = await self.find_type(publishers[0].topic_type)
        except (AionodeError, LookupError) as error:
            raise CommandError(f"Wrong input topic: {self.arguments.input}: {error}") from None
        self.timer.cancel()
        qos = chosen_qos(self.arguments, [each.qos_profile for each in publishers])
        self.output = self.create_publisher(self.type, self.arguments.output_topic, qos)
        self.create_subscription(message, self.arguments.input, self.on_message, qos)

    def on_message(self, message: Any) -> None:
        """Publish the value of the expression for a message."""
        for field in self.fields:
            try:
                message = getattr(message, field)
            except AttributeError as error:
                raise CommandError(f"Invalid field '{'.'.join(self.fields)}': {error}") from None
        result = self.function(message)
        assert self.output is not None  # noqa: S101  # it is made before the subscription
        for each in result if isinstance(result, list | tuple) else [result]:
            self.output.publish(each)


def module_named(name: str) -> Any:
    """Return the module to which the first part of a name refers in an expression.

    ``std_msgs`` is aionode's package of messages; its ``msg`` is imported with it.
    """
    try:
        message_module = import_module(f"aionode.interfaces.{name.partition('.')[0]}.msg")
    except ImportError:
        import_module(name)
        return sys.modules[name.partition(".")[0]]
    return import_module(message_module.__name__.rpartition(".")[0])


def parser() -> argparse.ArgumentParser:
    """Return the argument parser."""
    found = argparse.ArgumentParser(
        prog="transform", description="Apply a Python operation to a topic."
    )
    found.add_argument("input", help="Input topic.")
    found.add_argument("output_topic", help="Output topic.")
    found.add_argument("output_type", help="Output topic type.")
    found.add_argument(
        "expression", nargs="?", default="m", help="Python expression of the message m."
    )
    found.add_argument("-i", "--import", dest="modules", nargs="+", default=["numpy"])
    found.add_argument("--field", help="A field of the message, such as orientation.x.")
    add_qos(found)
    return found


def add_qos(found: argparse.ArgumentParser) -> None:
    """Add the options for the QoS of the subscription."""
    found.add_argument(
        "--wait-for-start", action="store_true", help="Accepted: the input is always waited for."
    )
    found.add_argument(
        "--qos-profile",
        choices=QoSPresetProfiles.short_keys(),
        help="Preset to start from, if any of these options is given (default: sensor_data).",
    )
    found.add_argument("--qos-depth", type=int, metavar="N")
    for name, kind in POLICIES.items():
        found.add_argument(f"--qos-{name}", choices=kind.short_keys())


def chosen_qos(given: argparse.Namespace, offered: list[QoSProfile]) -> QoSProfile:
    """Return the QoS of the options, or else one that is compatible with all offers."""
    policies = {name: getattr(given, f"qos_{name}") for name in POLICIES}
    if given.qos_profile or given.qos_depth is not None or any(policies.values()):
        qos = QoSPresetProfiles.get_from_short_key(given.qos_profile or "sensor_data").replace()
        for name, value in policies.items():
            if value is not None:
                setattr(qos, name, POLICIES[name].get_from_short_key(value))
        if given.qos_depth is not None:
            qos.depth = given.qos_depth
        return qos
    reliable = all(each.reliability is ReliabilityPolicy.RELIABLE for each in offered)
    latched = all(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in offered)
    return QoSProfile(
        depth=qos_profile_sensor_data.depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


def main() -> None:
    """Run the node until Ctrl-C."""
    arguments = parser().parse_args(remove_ros_args(sys.argv)[1:])
    aionode.run(lambda: Transform(arguments))
