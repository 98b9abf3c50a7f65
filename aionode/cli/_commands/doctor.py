"""``aionode doctor``: its commands, arguments and options."""

from __future__ import annotations

import click

from aionode.cli._commands.completion import complete_names
from aionode.cli._support.options import json_option, ros2_options
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.doctor import doctor

__all__ = ["doctor_command"]


@click.command()
@click.argument("names", nargs=-1, shell_complete=complete_names("topic"))
@json_option
@ros2_options
def doctor_command(names: tuple[str, ...], json: bool) -> None:
    """Summarize the network, and find out why endpoints do not communicate.

    NAMES of nodes, topics and services limit it to those, and show by which route each publisher
    reaches each subscription. The exit status is 1 if a problem was found.
    """
    run_verb(lambda node, output: doctor(node, names, output=output), json=json)
