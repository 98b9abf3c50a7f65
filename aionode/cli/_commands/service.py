"""``aionode service``: its commands, arguments and options."""

from __future__ import annotations

from typing import Any

import click

from aionode.cli._commands.completion import complete_names, complete_types_of, complete_values
from aionode.cli._commands.typed_names import add_type_and_find
from aionode.cli._support.nouns import SERVICE
from aionode.cli._support.options import (
    hertz,
    hidden_option,
    interfaces_option,
    json_option,
    positive,
    ros2_options,
    stdin_text,
    whole,
)
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.service import call, info

__all__ = ["service"]

service_argument = click.argument("service_name", shell_complete=complete_names("service"))


@click.group()
def service() -> None:
    """List, find, call and watch services."""


@service.command("list")
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option(
    "-c", "--count-services", "count", is_flag=True, help="Print only how many there are."
)
@hidden_option("--include-hidden-services", what="services")
@json_option
@ros2_options
def list_command(json: bool, **options: Any) -> None:
    """List the services that have a server."""
    run_verb(lambda node, output: SERVICE.list_names(node, output=output, **options), json=json)


@service.command("info")
@service_argument
@json_option
@ros2_options
def info_command(service_name: str, json: bool) -> None:
    """Print the type of a service, and the number of its clients and servers."""
    run_verb(lambda node, output: info(node, service_name, output=output), json=json)


add_type_and_find(service, SERVICE, "srv")


@service.command("call")
@service_argument
@click.argument("service_type", shell_complete=complete_types_of("service", "srv"))
@click.argument("values", required=False, shell_complete=complete_values("service"))
@click.option("--stdin", is_flag=True, help="Read the values from standard input.")
@click.option("-r", "--rate", metavar="N", type=hertz, help="Repeat the call, in Hz.")
@click.option("--timeout", metavar="N", type=positive, help="Wait at most N seconds.")
@json_option
@interfaces_option
@ros2_options
def call_command(json: bool, values: str | None, stdin: bool, **options: Any) -> None:
    """Call a service with a request in YAML, such as '{a: 1, b: 2}'."""
    text = stdin_text(values, stdin)
    run_verb(
        lambda node, output: call(node, values=text, output=output, **options),
        json=json,
        endless=options["rate"] is not None,
    )


@service.command("echo")
@service_argument
@click.argument("service_type", required=False, shell_complete=complete_types_of("service", "srv"))
@click.option("--csv", is_flag=True, help="Print all values on one line, separated by commas.")
@click.option("-f", "--full-length", is_flag=True, help="Print arrays and strings in full.")
@click.option(
    "-l",
    "--truncate-length",
    metavar="N",
    type=whole,
    default=128,
    show_default=True,
    help="Print arrays and strings up to this length.",
)
@click.option("--no-arr", is_flag=True, help="Describe arrays instead of printing them.")
@click.option("--no-str", is_flag=True, help="Describe strings instead of printing them.")
@click.option("--flow-style", is_flag=True, help="Print each array in brackets, on one line.")
@click.option("--once", is_flag=True, help="Print one event and end.")
@click.option("--timeout", metavar="N", type=positive, help="End after N seconds.")
@json_option
@interfaces_option
@ros2_options
def echo_command(json: bool, once: bool, **options: Any) -> None:
    """Print each request and response of a service that is introspected."""
    from aionode.cli._verbs.service_echo import echo

    if options.pop("full_length"):
        options["truncate_length"] = None
    run_verb(
        lambda node, output: echo(node, once=once, output=output, **options),
        json=json,
        endless=not once,
        busy=True,
    )
