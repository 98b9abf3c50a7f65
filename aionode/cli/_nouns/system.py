"""``aionode system``: show a running system, and stop and restart its members."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._support import lookup
from aionode.cli._support.command import command
from aionode.errors import CommandError
from aionode.graph import EndpointKind
from aionode.interfaces.std_msgs.msg import String

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = [
    "list_systems",
    "print_log",
    "print_status",
    "restart_member",
    "stop_member",
    "system_command",
]

PREFIX, SUFFIX = "/aionode_system_", "/command"

ANSWER_S = 60.0
"""Timeout for a system to stop a member, in seconds: three signals, for two generations."""

HEADINGS = ("NAME", "STATE", "READY", "PID", "RESTARTS", "CPU", "MEMORY", "UPTIME")

system_option = click.option(
    "--system", "system_name", metavar="SYSTEM", help="The system, if several are running."
)


@click.group("system")
def system_command() -> None:
    """Show what runs in a system; stop and restart its members."""


def systems(node: Node) -> list[str]:
    """Return the names of the systems in the graph."""
    from aionode.system import SystemCommand  # the command's help does not need it

    return sorted(
        {
            server.name.removeprefix(PREFIX).removesuffix(SUFFIX)
            for server in lookup.endpoints(node, EndpointKind.SERVER)
            if server.type_name == SystemCommand.__ros_type__ and server.name.startswith(PREFIX)
        }
    )


def chosen(node: Node, name: str | None) -> str:
    """Return the named system, or the only one.

    Raises:
        CommandError: there is none, or there are several and none was named.
    """
    known = systems(node)
    if name is None and len(known) == 1:
        return known[0]
    if not known:
        raise CommandError("no system is running in this domain; `aionode launch FILE` starts one")
    if name not in known:
        what = "several systems are running" if name is None else f"no system {name} runs"
        raise CommandError(f"{what}: choose one with --system: {', '.join(known)}")
    return name


async def ask(node: Node, system: str, verb: str, member: str = "") -> list[dict[str, Any]]:
    """Send a request to a system, and return the resulting states of its members.

    Raises:
        CommandError: the system refused.
        RequestTimeoutError: it did not answer.
    """
    from aionode.system import SystemCommand  # as above

    client = node.create_client(SystemCommand, f"{PREFIX}{system}{SUFFIX}")
    request = SystemCommand.Request(command=verb, name=member)
    response = await client.call(request, timeout_sec=ANSWER_S)
    if not response.success:
        raise CommandError(response.text)
    members: list[dict[str, Any]] = json.loads(response.text)
    return members


@command(system_command, "list")
async def list_systems(node: Node, *, output: Output) -> None:
    """List the running systems."""
    output.items([(name, {"name": name}) for name in systems(node)])


@command(system_command, "status", system_option)
async def print_status(node: Node, *, output: Output, system_name: str | None = None) -> None:
    """Print a table of the members of a system.

    Raises:
        CommandError: there is no such system.
    """
    members = await ask(node, chosen(node, system_name), "status")
    if output.json:
        output.items([("", member) for member in members])
        return
    for line in table(members):
        output.text(line)


def table(members: list[dict[str, Any]]) -> list[str]:
    """Return the lines of a table."""
    rows = [HEADINGS, *(row(member) for member in members)]
    widths = [max(len(cells[column]) for cells in rows) for column in range(len(HEADINGS))]
    return [
        "  ".join(f"{cell:<{width}}" for cell, width in zip(cells, widths, strict=True)).rstrip()
        for cells in rows
    ]


def row(member: dict[str, Any]) -> tuple[str, ...]:
    """Return the cells of a member."""
    cpu, memory = member["cpu_percent"], member["memory_bytes"]
    return (
        member["name"],
        member["state"],
        "yes" if member["ready"] else "no",
        "-" if member["pid"] is None else str(member["pid"]),
        str(member["restarts"]),
        "-" if cpu is None else f"{cpu:.1f} %",
        "-" if memory is None else f"{memory / 1e6:.1f} MB",
        f"{member['uptime_sec']:.0f} s",
    )


member_argument = click.argument("member")


@command(system_command, "restart", member_argument, system_option)
async def restart_member(
    node: Node, member: str, *, output: Output, system_name: str | None = None
) -> None:
    """Stop a member of a system and start it again.

    Raises:
        CommandError: there is no such system or member.
    """
    await ask(node, chosen(node, system_name), "restart", member)
    output.item(f"{member} restarts", {"name": member, "restarted": True})


@command(
    system_command, "stop", click.argument("member", required=False), system_option,
    click.option("--all", "every", is_flag=True, help="Stop the whole system."),
)  # fmt: skip
async def stop_member(
    node: Node,
    member: str | None,
    *,
    output: Output,
    system_name: str | None = None,
    every: bool = False,
) -> None:
    """Stop a member of a system for good, or the whole system.

    Raises:
        CommandError: there is no such system or member, or neither was named.
    """
    if every == bool(member):
        raise CommandError("name a member, or use --all for the whole system")
    system = chosen(node, system_name)
    await ask(node, system, "stop", member or "")
    text = f"{member} is stopped" if member else f"system {system} ends"
    output.item(text, {"name": member or system, "stopped": True})


@command(system_command, "log", system_option, endless=True)
async def print_log(node: Node, *, output: Output, system_name: str | None = None) -> None:
    """Print the log of a system from now on.

    Raises:
        CommandError: there is no such system.
    """
    system = chosen(node, system_name)
    lines = node.create_subscription(String, f"{PREFIX}{system}/log", qos_profile=100)
    async for message in lines:
        for line in message.data.splitlines():
            output.item(line, {"text": line})
