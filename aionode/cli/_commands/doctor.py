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
    """Say what is on the network, and why two endpoints do not talk.

    NAMES of nodes, topics and services limit it to those, and show which way each publisher
    reaches each subscription. The exit status is 1 if something does not work.
    """
    run_verb(lambda node, output: doctor(node, names, output=output), json=json)
