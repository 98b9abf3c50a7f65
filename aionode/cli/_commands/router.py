"""``aionode router``: its commands, arguments and options."""

from __future__ import annotations

import os

import click

from aionode.cli._support.output import Output
from aionode.cli._support.session import run_until_stopped
from aionode.cli._verbs.router import route

__all__ = ["router_command"]


@click.command()
@click.option(
    "-l",
    "--listen",
    metavar="ENDPOINT",
    multiple=True,
    help="Zenoh endpoint, such as tcp/192.168.0.2:7447 (default: port 7447 of all interfaces).",
)
@click.option("--json", is_flag=True, help="Print the endpoints as JSON.")
def router_command(listen: tuple[str, ...], json: bool) -> None:
    """Connect nodes across machines, as rmw_zenohd does.

    On a single machine no router is needed. Nodes on other machines find it through
    ROS_STATIC_PEERS=<this machine>.
    """
    from aionode.transport._zenoh_config import network_from

    endpoints = listen or (f"tcp/[::]:{network_from(os.environ).router_port}",)
    status = run_until_stopped(route(endpoints, output=Output(json=json)))
    raise click.exceptions.Exit(status or 0)
