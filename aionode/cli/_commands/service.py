"""``aionode service``: its commands, arguments and options."""

from __future__ import annotations

from typing import Any

import click

from aionode.cli._commands.completion import complete_interfaces, complete_names, complete_types_of
from aionode.cli._support.options import (
    hertz,
    hidden_option,
    interfaces_option,
    json_option,
    positive,
    ros2_options,
    stdin_text,
)
from aionode.cli._support.session import run_verb
from aionode.cli._verbs.service import call, find, info, list_services, type_of_service

__all__ = ["service"]

service_argument = click.argument("service_name", shell_complete=complete_names("service"))

hidden_services = hidden_option("--include-hidden-services", what="services")

# Commands


@click.group()
def service() -> None:
    """List, find and call services."""


@service.command("list")
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option(
    "-c", "--count-services", "count", is_flag=True, help="Print only how many there are."
)
@hidden_services
@json_option
@ros2_options
def list_command(json: bool, **options: Any) -> None:
    """List the services that somebody serves."""
    run_verb(lambda node, output: list_services(node, output=output, **options), json=json)


@service.command("info")
@service_argument
@json_option
@ros2_options
def info_command(service_name: str, json: bool) -> None:
    """Print the type of a service, and how many serve and call it."""
    run_verb(lambda node, output: info(node, service_name, output=output), json=json)


@service.command("type")
@service_argument
@json_option
@ros2_options
def type_command(service_name: str, json: bool) -> None:
    """Print the type of a service."""
    run_verb(lambda node, output: type_of_service(node, service_name, output=output), json=json)


@service.command("find")
@click.argument("service_type", shell_complete=complete_interfaces("srv"))
@click.option(
    "-c", "--count-services", "count", is_flag=True, help="Print only how many there are."
)
@hidden_services
@json_option
@ros2_options
def find_command(service_type: str, json: bool, **options: Any) -> None:
    """List the services of one type."""
    run_verb(lambda node, output: find(node, service_type, output=output, **options), json=json)


@service.command("call")
@service_argument
@click.argument("service_type", shell_complete=complete_types_of("service", "srv"))
@click.argument("values", required=False)
@click.option("--stdin", is_flag=True, help="Read the values from standard input.")
@click.option("-r", "--rate", metavar="N", type=hertz, help="Call again and again, in Hz.")
@click.option("--timeout", metavar="N", type=positive, help="Wait no longer than N seconds.")
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
