"""Declaring a command by its verb: a coroutine that gets a node, plain arguments and an output."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from aionode.cli._support.completion import TYPES, complete_interfaces, complete_names
from aionode.cli._support.nouns import ACTION, Noun
from aionode.cli._support.options import (
    count_option,
    hidden_option,
    interfaces_option,
    json_option,
    ros2_options,
    sim_time_option,
)
from aionode.cli._support.output import Output
from aionode.cli._support.session import STOP_S, run_verb

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["VerbT", "add_type_and_find", "command"]

Verb = Callable[..., Any]
"""A coroutine function that may return an exit status; a function if there is no node."""

VerbT = TypeVar("VerbT", bound=Verb)

SECTIONS = ("Args:", "Returns:", "Raises:")
"""The sections of a verb's docstring that its help omits."""


def command(
    group: click.Group,
    name: str,
    *parameters: Callable[[Any], Any],
    node: bool = True,
    interfaces: bool = False,
    sim_time: bool = False,
    prepare: Callable[[dict[str, Any]], None] = lambda _: None,
    endless: bool | Callable[[Mapping[str, Any]], bool] = False,
    busy: bool = False,
    asks: bool = True,
    stop_s: float = STOP_S,
    **settings: Any,
) -> Callable[[VerbT], VerbT]:
    """Return a decorator that creates a command from its verb, and returns the verb unchanged.

    The verb is called with the node, its parameters by name, and ``output``. The command's help is
    the verb's docstring up to the first section; the help of the options describes the arguments.

    Args:
        group: The group of commands of the noun.
        name: The name of the command.
        parameters: Its own arguments and options, declared with click. ``--json`` is added, and for
            commands with a node also ros2's options that have no meaning here.
        node: Whether the verb needs a node; without one, it is a plain function.
        interfaces: Whether it has the option ``--interfaces``.
        sim_time: Whether it has the option ``--use-sim-time``, for the clock of its node.
        prepare: Converts the values of the parameters to what the verb gets, before there is a
            node. Raises `click.UsageError` if the values exclude each other.
        endless: Whether Ctrl-C is the normal end; may be a function of the prepared values.
        busy: As for `run_verb`.
        asks: As for `run_verb`.
        stop_s: As for `run_verb`.
        settings: Passed on to click.
    """
    shared = [json_option]
    unused = [ros2_options] if node else []
    if sim_time:
        shared.append(sim_time_option)
    if interfaces:
        shared.append(interfaces_option)

    def declare(verb: VerbT) -> VerbT:
        def run(json: bool, **values: Any) -> None:
            prepare(values)
            if not node:
                verb(output=Output(json=json), **values)
                return
            node_name = values.pop("own_name", None)
            use_sim_time = values.pop("use_sim_time", False)
            run_verb(
                lambda own_node, output: verb(own_node, output=output, **values),
                json=json,
                node_name=node_name,
                use_sim_time=use_sim_time,
                endless=endless(values) if callable(endless) else endless,
                busy=busy,
                asks=asks,
                stop_s=stop_s,
            )

        decorated: Callable[..., None] = run
        for add in reversed((*parameters, *shared, *unused)):
            decorated = add(decorated)
        group.command(name, **{"help": help_of(verb), **settings})(decorated)
        return verb

    return declare


def help_of(verb: Verb) -> str:
    """Return the docstring of a verb up to its first section."""
    lines = []
    for line in (verb.__doc__ or "").splitlines():
        if line.strip() in SECTIONS:
            break
        lines.append(line)
    return "\n".join(lines)


def add_type_and_find(group: click.Group, noun: Noun) -> None:
    """Add the commands ``type`` and ``find`` to the group of a noun."""
    word = noun.word
    type_word, kind = TYPES[word]
    command(
        group,
        "type",
        click.argument("name", metavar=f"{word}_name".upper(), shell_complete=complete_names(word)),
        help=f"Print the type of a{'n' * (noun is ACTION)} {word}.",
    )(noun.print_type)
    command(
        group,
        "find",
        click.argument(
            "type_name",
            metavar=f"{type_word}_type".upper(),
            shell_complete=complete_interfaces(kind),
        ),
        count_option(f"{word}s"),
        help=f"List the {word}s of one type.",
    )(noun.find)
    if noun is not ACTION:  # the topics and services of an action are hidden, its name is not
        hidden_option(f"--include-hidden-{word}s", what=f"{word}s")(group.commands["find"])
