"""``aionode router``: a Zenoh router for those who have no ``rmw_zenohd``."""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING

import click

from aionode.cli.output import Output
from aionode.cli.session import run_until_stopped

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["route", "router_command"]


async def route(endpoints: Sequence[str], *, output: Output) -> int:
    """Run a router that listens on Zenoh endpoints, until cancelled.

    Raises:
        TransportError: it cannot listen there.
    """
    from aionode.transport.zenoh.session import close_session, open_router

    session = await open_router(endpoints)
    try:
        output.item(
            f"Router is listening on {', '.join(endpoints)}. Ctrl-C ends it.",
            {"listen": list(endpoints)},
        )
        await asyncio.get_running_loop().create_future()
    finally:
        await asyncio.shield(close_session(session))
    return 0


@click.command()
@click.option(
    "-l",
    "--listen",
    metavar="ENDPOINT",
    multiple=True,
    help="Zenoh endpoint, such as tcp/192.168.0.2:7447 (default: port 7447 of all interfaces).",
)
@click.option("--json", is_flag=True, help="Print where it listens as JSON.")
def router_command(listen: tuple[str, ...], json: bool) -> None:
    """Introduce nodes to each other across machines, as rmw_zenohd does.

    On one machine none is needed. Nodes of other machines find it through
    ROS_STATIC_PEERS=<this machine>.
    """
    from aionode.transport.zenoh_config import network_from

    endpoints = listen or (f"tcp/[::]:{network_from(os.environ).router_port}",)
    status = run_until_stopped(route(endpoints, output=Output(json=json)))
    raise click.exceptions.Exit(status or 0)
