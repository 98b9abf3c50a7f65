"""The commands that topics, services and actions share: ``type`` and ``find``."""

from __future__ import annotations

from typing import Any

import click

from aionode.cli._commands.completion import complete_interfaces, complete_names
from aionode.cli._support.nouns import ACTION, Noun
from aionode.cli._support.options import hidden_option, json_option, ros2_options
from aionode.cli._support.session import run_verb

__all__ = ["add_type_and_find"]


def add_type_and_find(group: click.Group, noun: Noun, kind: str) -> None:
    """Add the commands ``type`` and ``find``.

    Args:
        group: The group of commands of the noun.
        noun: Topics, services or actions.
        kind: The kind of their types: ``msg``, ``srv`` or ``action``.
    """
    word = noun.word
    type_of = "message" if kind == "msg" else word

    @group.command("type", help=f"Print the type of a{'n' * (noun is ACTION)} {word}.")
    @click.argument("name", metavar=f"{word}_name".upper(), shell_complete=complete_names(word))
    @json_option
    @ros2_options
    def type_command(name: str, json: bool) -> None:
        run_verb(lambda node, output: noun.print_type(node, name, output=output), json=json)

    @group.command("find", help=f"List the {word}s of one type.")
    @click.argument(
        "type_name", metavar=f"{type_of}_type".upper(), shell_complete=complete_interfaces(kind)
    )
    @click.option(
        "-c", f"--count-{word}s", "count", is_flag=True, help="Print only how many there are."
    )
    @json_option
    @ros2_options
    def find_command(json: bool, **options: Any) -> None:
        run_verb(lambda node, output: noun.find(node, output=output, **options), json=json)

    if noun is not ACTION:  # the topics and services of an action are hidden, its name is not
        hidden_option(f"--include-hidden-{word}s", what=f"{word}s")(find_command)
