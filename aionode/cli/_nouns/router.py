"""``aionode router``: a Zenoh router, where there is no ``rmw_zenohd``."""

from __future__ import annotations

import asyncio
import os
from typing import TYPE_CHECKING

import click

from aionode.cli._support.output import Output
from aionode.cli._support.session import run_until_stopped

if TYPE_CHECKING:
    from collections.abc import Sequence

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
    help="Another router: host, host:port or Zenoh endpoint. It may start later.",
)
@click.option("--json", is_flag=True, help="Print the endpoints as JSON.")
def router_command(listen: tuple[str, ...], connect: tuple[str, ...], json: bool) -> None:
    """Connect nodes across machines, as rmw_zenohd does.

    A single machine needs no router. On each other machine, run `aionode router --connect <this
    machine>`; nodes find the router on their own machine.
    """
    from aionode.engine.transport.network import ROUTER_PORT, network_from, peer_endpoints

    endpoints = listen or (f"tcp/[::]:{network_from(os.environ).router_port}",)
    peers = [
        endpoint
        for host in connect
        for endpoint in peer_endpoints(host, "--connect", (ROUTER_PORT,))
    ]
    status = run_until_stopped(route(endpoints, peers, output=Output(json=json)))
    raise click.exceptions.Exit(status or 0)


async def route(endpoints: Sequence[str], peers: Sequence[str] = (), *, output: Output) -> int:
    """Run a router until cancelled.

    Args:
        endpoints: Zenoh endpoints to listen on.
        peers: Zenoh endpoints of other routers to connect to.
        output: Where to print.

    Raises:
        TransportError: it cannot listen on an endpoint.
    """
    from aionode.engine.transport.zenoh.session.session import close_session, open_router

    session = await open_router(endpoints, peers)
    try:
        linked = f", and connects to {', '.join(peers)}" if peers else ""
        output.item(
            f"Router is listening on {', '.join(endpoints)}{linked}. Press Ctrl-C to stop it.",
            {"listen": list(endpoints), "connect": list(peers)},
        )
        await asyncio.get_running_loop().create_future()
    finally:
        await asyncio.shield(close_session(session))
    return 0
