"""Declaring a command by its verb: a coroutine that gets a node, plain arguments and an output."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any, TypeVar

import click

from aionode.cli._support.completion import complete_interfaces, complete_names
from aionode.cli._support.nouns import ACTION, Noun
from aionode.cli._support.options import (
    count_option,
    hidden_option,
    interfaces_option,
    json_option,
    ros2_options,
    sim_time_option,
)
from aionode.cli._support.session import STOP_S, run_verb

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["add_type_and_find", "command"]

Verb = Callable[..., Coroutine[Any, Any, int | None]]
VerbT = TypeVar("VerbT", bound=Verb)

SECTIONS = ("Args:", "Returns:", "Raises:")
"""The parts of a verb's docstring that its help leaves out."""


def command(
    group: click.Group,
    name: str,
    *parameters: Callable[[Any], Any],
    interfaces: bool = False,
    sim_time: bool = False,
    prepare: Callable[[dict[str, Any]], None] = lambda _: None,
    endless: bool | Callable[[Mapping[str, Any]], bool] = False,
    busy: bool = False,
    asks: bool = True,
    stop_s: float = STOP_S,
    **settings: Any,
) -> Callable[[VerbT], VerbT]:
    """Return the decorator that makes a command of its verb, and leaves the verb as it is.

    The verb is called with the node, the values of its parameters by name, and ``output``. Its
    docstring, up to the first section, is the command's help.

    Args:
        group: The group of commands of the noun.
        name: The name of the command.
        parameters: Its own arguments and options, as click declares them; ``--json`` and the
            options without a meaning here, which existing scripts may use, are added.
        interfaces: Whether it has the option ``--interfaces``.
        sim_time: Whether it has the option ``--use-sim-time``, for the time of its node.
        prepare: Changes the values of the parameters into those that the verb gets. It runs before
            there is a node; it raises `click.UsageError` if the values exclude each other.
        endless: Whether Ctrl-C is the normal end, also as a function of the prepared values.
        busy: As for `run_verb`.
        asks: As for `run_verb`.
        stop_s: As for `run_verb`.
        settings: Passed on to click.
    """
    shared = [json_option]
    if sim_time:
        shared.append(sim_time_option)
    if interfaces:
        shared.append(interfaces_option)

    def declare(verb: VerbT) -> VerbT:
        def run(json: bool, **values: Any) -> None:
            prepare(values)
            node_name = values.pop("own_name", None)
            use_sim_time = values.pop("use_sim_time", False)
            run_verb(
                lambda node, output: verb(node, output=output, **values),
                json=json,
                node_name=node_name,
                use_sim_time=use_sim_time,
                endless=endless(values) if callable(endless) else endless,
                busy=busy,
                asks=asks,
                stop_s=stop_s,
            )

        decorated: Callable[..., None] = run
        for add in reversed((*parameters, *shared, ros2_options)):
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


def add_type_and_find(group: click.Group, noun: Noun, kind: str) -> None:
    """Add the commands ``type`` and ``find``.

    Args:
        group: The group of commands of the noun.
        noun: Topics, services or actions.
        kind: The kind of their types: ``msg``, ``srv`` or ``action``.
    """
    word = noun.word
    type_word = "message" if kind == "msg" else word
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
