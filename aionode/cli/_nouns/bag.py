"""``aionode bag``: recordings of topics."""

from __future__ import annotations

import click

from aionode.cli._nouns.bag_replay import diff_command, shrink_command

__all__ = ["bag_command"]


@click.group("bag")
def bag_command() -> None:
    """Work with recordings of topics."""


for one in (diff_command, shrink_command):
    bag_command.add_command(one)
