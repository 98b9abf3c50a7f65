"""``aionode gateway``: serve the robot to browsers, programs and apps."""

from __future__ import annotations

from contextlib import AsyncExitStack
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._support.completion import complete_interfaces
from aionode.cli._support.options import interfaces_option
from aionode.cli._support.session import run_verb
from aionode.errors import CommandError, InterfaceNotFoundError, PackageNotFoundError

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Iterable, Sequence

    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = ["gateway_command", "types"]

PORT = 9090
"""The default port of rosbridge, which its clients try first."""


@click.group("gateway", invoke_without_command=True)
@interfaces_option
@click.option(
    "--host", default="127.0.0.1", show_default=True, metavar="ADDRESS",
    help="Address to listen on; other machines need a policy with tokens or certificates.",
)  # fmt: skip
@click.option(
    "--port", type=click.IntRange(0, 65535), default=PORT, show_default=True,
    help="Port to listen on; 0 for a free one.",
)  # fmt: skip
@click.option(
    "--policy", "path", metavar="FILE",
    help="TOML file that says who may do what; reloaded when it changes.",
)  # fmt: skip
@click.option(
    "--allow-write", is_flag=True,
    help="Without a policy: let this host publish, call, send goals and set parameters.",
)  # fmt: skip
@click.option(
    "--limit", "limits", metavar="KEY=VALUE", multiple=True,
    help="Without a policy: change a limit for clients, such as call_sec=60. Can be repeated.",
)  # fmt: skip
@click.option(
    "--assets", metavar="PACKAGE", multiple=True,
    help="Without a policy: let clients read files of a package, such as meshes. Can be repeated.",
)  # fmt: skip
@click.option(
    "--mcp", is_flag=True,
    help="Serve clients of MCP, such as those of language models, at /mcp.",
)  # fmt: skip
@click.option(
    "--about", default="", metavar="TEXT",
    help="With --mcp: a description of this robot for models.",
)  # fmt: skip
@click.option(
    "--bags", default="", metavar="FOLDER",
    help="With --mcp: a folder of recordings that assistants may summarize.",
)  # fmt: skip
@click.pass_context
def gateway_command(
    ctx: click.Context,
    /,
    host: str,
    port: int,
    path: str | None,
    allow_write: bool,
    limits: tuple[str, ...],
    assets: tuple[str, ...],
    **assistants: Any,
) -> None:
    """Serve the robot to browsers, programs and apps.

    rosbridge and Foxglove clients, HTTP and a built-in web page share one port. Without --policy,
    programs on this host may read everything and write nothing. Pages from other web servers must
    be listed in a policy, even those on this host.
    """
    if ctx.invoked_subcommand is not None:
        return
    if path is not None and allow_write:
        raise click.UsageError(
            "--allow-write cannot be combined with --policy: allow it in the policy", ctx
        )
    if path is not None and limits:
        problem = "--limit cannot be combined with --policy: write it under [limits] there"
        raise click.UsageError(problem, ctx)
    if path is not None and assets:
        problem = "--assets cannot be combined with --policy: write `asset` in a rule there"
        raise click.UsageError(problem, ctx)
    serve = serving(path, allow_write, host, port, limits, assets, **assistants)
    run_verb(serve, node_name="gateway", endless=True, busy=True, asks=False)


def serving(
    path: str | None,
    allow_write: bool,
    host: str,
    port: int,
    limits: Sequence[str] = (),
    assets: Sequence[str] = (),
    **assistants: Any,
) -> Callable[[Node, Output], Coroutine[Any, Any, int | None]]:
    """Return the coroutine function that serves the robot until it is cancelled.

    Args:
        path: The policy file; None without one.
        allow_write: Whether this host may write without one.
        host: Where to listen.
        port: Which port.
        limits: Limits without a policy file, as text.
        assets: Packages whose files are served without a policy file.
        assistants: Further arguments of the gateway: ``mcp``, ``about`` and ``bags``.

    Raises:
        PolicyFileError: the policy file cannot be read, or is not a policy.
        CommandError: there is no such limit, or no such package.
        ImportError: the extra ``gateway``, or for assistants ``mcp``, is not installed.
    """
    from aionode._packages import here
    from aionode.gateway import Gateway, Limits, Policy

    if path is None:
        try:
            given = Limits().with_given(limits)
        except ValueError as error:
            raise CommandError(f"--limit: {error}") from error
        try:
            for package in assets:
                here().share(package)
        except PackageNotFoundError as error:
            near = f"; did you mean {error.suggestions[0]}?" if error.suggestions else ""
            raise CommandError(
                f"--assets: no package {error.name!r} in {', '.join(error.places)}{near}; start "
                "the gateway in the workspace that has it"
            ) from error
        policy = Policy.default(allow_write=allow_write, limits=given, assets=assets)
    else:
        policy = Policy.load(path)

    async def serve(node: Node, output: Output) -> int | None:
        gateway = Gateway(node, policy, host=host, port=port, **assistants)
        async with AsyncExitStack() as stack:
            try:
                await stack.enter_async_context(gateway)
            except OSError as error:
                raise CommandError(
                    f"gateway: cannot listen on port {port} of {host}: {error.strerror}; choose "
                    "another --port or --host"
                ) from error
            output.text(f"Gateway is listening on {host}:{gateway.port}")
            await node.until_destroyed()
        return None

    return serve


@gateway_command.command("types")
@click.argument("type_names", metavar="[TYPE]...", nargs=-1, shell_complete=complete_interfaces())
@interfaces_option
def types_command(type_names: tuple[str, ...]) -> None:
    """Write TypeScript types of the messages in use, or of each TYPE.

    Prints a module of declarations, to be saved in a file such as robot.d.ts.
    """
    run_verb(partial(types, type_names=type_names))


async def types(node: Node, output: Output, *, type_names: Sequence[str] = ()) -> None:
    """Print TypeScript types of the messages, services and actions in use, or of the given types.

    Raises:
        InterfaceNotFoundError: no node knows one of the given types.
    """
    from aionode.gateway import typescript

    if type_names:
        output.raw(typescript([await node.find_type(name) for name in type_names]))
        return
    used = {
        "topics": first_types(node.get_topic_names_and_types(include_hidden=False)),
        "services": first_types(node.get_service_names_and_types(include_hidden=False)),
        "actions": first_types(node.get_action_names_and_types()),
    }
    classes = []
    for name in sorted({name for names in used.values() for name in names.values()}):
        try:
            classes.append(await node.find_type(name))
        except InterfaceNotFoundError as error:
            output.warn(f"WARNING: {error}")
    output.raw(typescript(classes, **used))


def first_types(names_and_types: Iterable[tuple[str, list[str]]]) -> dict[str, str]:
    """Return the type of each name; the first if there are several."""
    return {name: types[0] for name, types in names_and_types}
