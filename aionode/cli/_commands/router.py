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
@click.option(
    "-c",
    "--connect",
    metavar="HOST",
    multiple=True,
    help="Host of another router, host:port or Zenoh endpoint; it may be absent for a while.",
)
@click.option("--json", is_flag=True, help="Print the endpoints as JSON.")
def router_command(listen: tuple[str, ...], connect: tuple[str, ...], json: bool) -> None:
    """Connect nodes across machines, as rmw_zenohd does.

    On a single machine no router is needed. On another one, run
    `aionode router --connect <this machine>`: nodes find the router of their own machine.
    """
    from aionode.transport._zenoh_config import ROUTER_PORT, network_from, peer_endpoints

    endpoints = listen or (f"tcp/[::]:{network_from(os.environ).router_port}",)
    peers = [one for host in connect for one in peer_endpoints(host, "--connect", (ROUTER_PORT,))]
    status = run_until_stopped(route(endpoints, peers, output=Output(json=json)))
    raise click.exceptions.Exit(status or 0)
