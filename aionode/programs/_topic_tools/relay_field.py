"""``topic_tools relay_field``: publishes a message whose fields are expressions of another one."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import yaml

import aionode
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.message import Message, from_builtins, to_builtins
from aionode.programs._topic_tools.transform import Transform, add_qos

__all__ = ["RelayField", "main", "parser"]


class RelayField(Transform):
    """Publishes a message whose fields are expressions of each message, ``m``.

    Args:
        arguments: The parsed arguments of `parser`.

    Raises:
        CommandError: The expression is not a YAML mapping of fields, or the type is invalid.
    """

    tool = "relay_field"

    def compiled(self, arguments: argparse.Namespace) -> Callable[[Any], Any]:
        """Return a function that computes the fields of the output."""
        try:
            template = yaml.safe_load(arguments.expression)
        except yaml.YAMLError as error:
            raise CommandError(f"Wrong expression: {arguments.expression}: {error}") from None
        if not isinstance(template, dict):
            raise CommandError(
                f"Wrong expression: {arguments.expression}: use fields, such as '{{data: m.x}}'"
            )

        def filled(message: Any) -> Any:
            try:
                values = self.evaluated(template, message)
            except AttributeError as error:
                raise CommandError(f"Invalid field: {error}") from None
            return from_builtins(self.type, values)

        return filled

    def evaluated(self, template: dict[str, Any], message: Any) -> dict[str, Any]:
        """Return the fields with each string that is an expression replaced by its value."""
        values = dict(template)
        for name, value in template.items():
            if isinstance(value, dict):
                values[name] = self.evaluated(value, message)
            elif (name, value) == ("stamp", "now"):
                values[name] = to_builtins(self.get_clock().now().to_msg())
            elif (name, value) == ("header", "auto"):
                values[name] = {"stamp": to_builtins(self.get_clock().now().to_msg())}
            elif isinstance(value, str):
                with suppress(NameError, SyntaxError):  # it is plain text
                    values[name] = plain(eval(value, {}, {"m": message}))  # noqa: S307  # as in transform
        return values


def plain(value: Any) -> Any:
    """Return a value of a message as plain Python data."""
    if isinstance(value, Message):
        return to_builtins(value)
    return value.tolist() if hasattr(value, "tolist") else value


def parser() -> argparse.ArgumentParser:
    """Return the argument parser."""
    found = argparse.ArgumentParser(
        prog="relay_field", description="Allows to relay field data from one topic to another."
    )
    found.add_argument("input", help="Input topic.")
    found.add_argument("output_topic", help="Output topic.")
    found.add_argument("output_type", help="Output topic type.")
    found.add_argument(
        "expression", help="YAML of fields, with Python expressions of the message m."
    )
    add_qos(found)
    found.set_defaults(field=None, modules=[])
    return found


def main() -> None:
    """Run the node until Ctrl-C."""
    arguments = parser().parse_args(remove_ros_args(sys.argv)[1:])
    aionode.run(lambda: RelayField(arguments))
