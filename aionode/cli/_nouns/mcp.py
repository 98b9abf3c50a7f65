"""``aionode mcp``: the robot for a language model's program, over standard streams."""

from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click
import msgspec

from aionode._process.bounded_files import read_file
from aionode.cli._support.options import in_environment, interfaces_option, json_option
from aionode.cli._support.session import run_verb
from aionode.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.cli._support.output import Output
    from aionode.gateway import Assistant, Policy
    from aionode.node import Node

__all__ = ["mcp_command", "policy_of", "serve", "try_tool", "words_of"]

VARIABLES: Final = {"domain": "ROS_DOMAIN_ID", "connect": "ZENOH_CONFIG_OVERRIDE"}
"""The variables that the options set, as desktop programs pass none of them on."""


def robot_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that name the robot, and say what may be done with it."""
    options = [
        interfaces_option,
        click.option(
            "--domain", type=click.IntRange(0, 232), expose_value=False, callback=set_variable,
            metavar="ID", help="The ROS domain; by default that of $ROS_DOMAIN_ID.",
        ),
        click.option(
            "--connect", expose_value=False, callback=set_variable, metavar="ENDPOINT",
            help="Address of the robot's nodes or router, if discovery does not find them, such as "
            "tcp/robot.local:7447.",
        ),
        click.option(
            "--policy", "path", metavar="FILE",
            help="TOML file that says what the assistant may do; reloaded when it changes. Without "
            "it, the assistant can only read.",
        ),
        click.option(
            "--allow-write", is_flag=True,
            help="Without a policy: let the assistant do anything; it moves the robot by lease.",
        ),
        click.option(
            "--as", "name", default="", metavar="NAME",
            help="Which [[who]] of the policy the assistant is; by default any program of this "
            "host.",
        ),
        click.option(
            "--about", default="", metavar="TEXT",
            help="A description of this robot for the model, or @FILE with one.",
        ),
        click.option(
            "--bags", default="", metavar="FOLDER",
            help="A folder of recordings that the assistant may summarize.",
        ),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def set_variable(ctx: click.Context, param: click.Parameter, value: Any) -> None:
    """Set the environment variable of an option."""
    if value is None:
        return
    name = VARIABLES[str(param.name)]
    if param.name == "connect":
        value = f"connect/endpoints={msgspec.json.encode([value]).decode()}"
        before = os.environ.get(name)
        value = f"{before};{value}" if before else value
    ctx.with_resource(in_environment(name, str(value)))


@click.group("mcp", invoke_without_command=True)
@robot_options
@click.option(
    "--print-config", "host", metavar="PROGRAM", is_flag=False, flag_value="all",
    help="Print the settings with which a program starts this command with these options: "
    "claude-desktop, claude-code, cursor, vscode, windsurf, gemini-cli, codex or zed; without a "
    "name, all of them.",
)  # fmt: skip
@click.pass_context
def mcp_command(ctx: click.Context, /, host: str | None, **options: Any) -> None:
    """Let a language model's program use the robot, bounded by a policy.

    It speaks the Model Context Protocol over standard input and output, and is started by that
    program: see --print-config. `aionode gateway --mcp` serves the same over HTTP.
    """
    if ctx.invoked_subcommand is not None:
        return
    if host is not None:
        click.echo(settings(host, sys.argv[1:]), nl=False)
        return
    verb = partial(serve, **checked(ctx, options))
    run_verb(verb, node_name=f"mcp_{os.getpid()}", endless=True)


@mcp_command.command("try")
@robot_options
@click.argument("tool", required=False)
@click.argument("arguments", nargs=-1, metavar="[NAME=VALUE]...")
@json_option
@click.pass_context
def try_command(
    ctx: click.Context,
    /,
    tool: str | None,
    arguments: tuple[str, ...],
    json: bool,  # click passes it by name
    **options: Any,
) -> None:
    """Call a tool without a model, or list the tools.

    A VALUE is JSON, or else text: aionode mcp try move topic=/cmd_vel seconds=1
    'message={"linear": {"x": 0.1}}'.
    """
    verb = partial(try_tool, tool=tool, arguments=arguments, **checked(ctx, options))
    run_verb(verb, json=json, node_name=f"mcp_{os.getpid()}")


def checked(ctx: click.Context, options: dict[str, Any]) -> dict[str, Any]:
    """Return the options of an assistant, with its policy."""
    path, allow_write = options.pop("path"), options.pop("allow_write")
    if path is not None and allow_write:
        raise click.UsageError("--allow-write is for an assistant without --policy", ctx)
    if options["name"] and path is None:
        raise click.UsageError("--as is the name of a [[who]] of a policy: give --policy", ctx)
    about = options["about"]
    if about.startswith("@"):
        try:
            options["about"] = read_file(about[1:]).decode()
        except (OSError, UnicodeError) as error:
            raise CommandError(f"--about: {about[1:]}: cannot be read: {error}") from error
    if options["bags"] and not Path(options["bags"]).is_dir():
        raise CommandError(f"--bags: {options['bags']}: no such folder")
    return {**options, "policy": policy_of(path, allow_write=allow_write)}


def policy_of(path: str | None, *, allow_write: bool) -> Policy:
    """Return the policy in a file, or the default policy without one.

    Raises:
        PolicyFileError: the file cannot be read, or is not a policy.
        ImportError: the extra ``gateway`` is not installed.
    """
    from aionode.gateway import Policy

    return Policy.default(allow_write=allow_write) if path is None else Policy.load(path)


def assistant_of(node: Node, policy: Policy, name: str, about: str, bags: str) -> Assistant:
    """Return an assistant.

    Raises:
        ImportError: the extra ``mcp`` is not installed.
        ConfigurationError: the policy has no client of that name.
    """
    from aionode.gateway import Assistant

    return Assistant(node, policy, name=name, about=about, bags=bags)


async def serve(
    node: Node, _output: Output, *, policy: Policy, name: str, about: str, bags: str
) -> None:
    """Serve the program at the other end of the standard streams, until it closes them."""
    async with assistant_of(node, policy, name, about, bags) as assistant:
        await assistant.serve_stdio()


async def try_tool(
    node: Node,
    output: Output,
    *,
    tool: str | None,
    arguments: Sequence[str],
    policy: Policy,
    name: str,
    about: str,
    bags: str,
) -> int:
    """Call a tool, and print its answer; without one, list the tools.

    Returns:
        1 if the tool has failed, and 0 otherwise.
    """
    made = assistant_of(node, policy, name, about, bags)  # it says which extra is missing
    import mcp
    import mcp_types

    async def ask(context: Any, params: Any) -> Any:  # as the SDK calls it
        says_yes = click.confirm(params.message, err=True)
        return mcp_types.ElicitResult(action="accept" if says_yes else "decline", content={})

    async def report(progress: float, total: float | None, message: str | None) -> None:
        output.warn(message or "")

    async with (
        made as assistant,
        mcp.Client(assistant.server, elicitation_callback=ask) as client,
    ):
        if tool is None:
            for each in (await client.list_tools()).tools:
                output.item(f"{each.name}: {each.description}", each.model_dump(mode="json"))
            return 0
        answered = await client.call_tool(tool, words_of(arguments), progress_callback=report)
        for part in answered.content:
            if part.type == "text":
                output.item(part.text, answered.structured_content)
            elif part.type == "image":
                output.warn(f"an image: {part.mime_type}, {len(part.data) * 3 // 4} bytes")
        return 1 if answered.is_error else 0


def words_of(arguments: Sequence[str]) -> dict[str, Any]:
    """Return the arguments of a tool from words such as ``seconds=1``.

    Raises:
        CommandError: a word has no equals sign.
    """
    values: dict[str, Any] = {}
    for word in arguments:
        name, equals, value = word.partition("=")
        if not equals:
            raise CommandError(f"{word}: give arguments as NAME=VALUE, such as seconds=1")
        try:
            values[name] = msgspec.json.decode(value)
        except msgspec.DecodeError:
            values[name] = value
    return values


def settings(host: str, words: Sequence[str]) -> str:
    """Return the settings of a program, or of all, for the command that is running.

    Args:
        host: The name of the program, or ``all``.
        words: The arguments of this command.

    Raises:
        CommandError: the program is not known.
    """
    from aionode.gateway.mcp.hosts import HOSTS, settings_for

    if host not in {*HOSTS, "all"}:
        raise CommandError(f"--print-config: {host!r} is unknown; there is {', '.join(HOSTS)}")
    command = [sys.executable, "-m", "aionode", *absolute(kept(words))]
    chosen = HOSTS if host == "all" else [host]
    return "\n".join(settings_for(each, command) for each in chosen)


def kept(words: Sequence[str]) -> list[str]:
    """Return the arguments without ``--print-config`` and its value."""
    from aionode.gateway.mcp.hosts import HOSTS

    left: list[str] = []
    was_flag = False
    for word in words:
        is_flag = word == "--print-config"
        is_value = was_flag and word in {*HOSTS, "all"}
        if not (is_flag or is_value or word.startswith("--print-config=")):
            left.append(word)
        was_flag = is_flag
    return left


def absolute(words: Sequence[str]) -> list[str]:
    """Return arguments with absolute paths, as the program that uses them runs elsewhere."""
    paths, whole = ("--policy", "--bags", "--interfaces"), []
    before = ""
    for word in words:
        option, equals, value = word.partition("=")
        if before in paths:
            whole.append(str(Path(word).absolute()))
        elif before == "--about" and word.startswith("@"):
            whole.append(f"@{Path(word[1:]).absolute()}")
        elif option in paths and equals:
            whole.append(f"{option}={Path(value).absolute()}")
        else:
            whole.append(word)
        before = word
    return whole
