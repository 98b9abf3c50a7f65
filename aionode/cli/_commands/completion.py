"""Shell completion: the scripts, and the names that are offered."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator
from typing import TYPE_CHECKING, Any

import click

from aionode.errors import AionodeError

if TYPE_CHECKING:
    from aionode.node import Node

__all__ = [
    "complete_fields",
    "complete_interfaces",
    "complete_names",
    "complete_parameters",
    "complete_transitions",
    "complete_types_of",
    "complete_values",
    "completion",
]

Completer = Callable[[click.Context, click.Parameter, str], list[str]]

QUIET_S = 0.3
"""How long discovery has to be quiet before names are offered, in seconds; a person is waiting."""

ANSWER_S = 1.0
"""Timeout for a node's list of parameters, in seconds; normally it takes milliseconds."""

SETUP = """\
# Put the following into {file}:
#   {line}
"""
BASH = """\
_aionode_completion() {
    local IFS=$'\\n' response completion type value
    response=$(env COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD \\
        _AIONODE_COMPLETE=bash_complete "$1")
    while IFS=',' read -r type value; do
        case $type in
            dir) COMPREPLY=(); compopt -o dirnames ;;
            file) COMPREPLY=(); compopt -o default ;;
            plain)
                # Values in YAML are one word of the shell.
                [[ $value == *[[:space:]]* ]] && value=${value@Q}
                COMPREPLY+=("$value")
                # A package name, which continues after its slash.
                [[ $value == */ ]] && compopt -o nospace ;;
        esac
    done <<< "$response"
    return 0
}
complete -o nosort -F _aionode_completion aionode
"""
ZSH = """\
#compdef aionode
_aionode_completion() {
    local -a response plain unfinished described quoted
    local type key descr
    (( ! $+commands[aionode] )) && return 1
    response=("${(@f)$(env COMP_WORDS="${words[*]}" COMP_CWORD=$((CURRENT-1)) \\
        _AIONODE_COMPLETE=zsh_complete aionode)}")
    for type key descr in ${response}; do
        case $type in
            dir) _path_files -/ ;;
            file) _path_files -f ;;
            plain)
                if [[ $descr != _ ]]; then
                    described+=("${key//:/\\\\:}:$descr")
                elif [[ $key == */ ]]; then
                    # A package name, which continues after its slash.
                    unfinished+=("$key")
                elif [[ $key == *[[:space:]]* ]]; then
                    # Values in YAML are one word of the shell.
                    quoted+=("${(qq)key}")
                else
                    plain+=("$key")
                fi ;;
        esac
    done
    (( $#described )) && _describe -V unsorted described -U
    (( $#unfinished )) && compadd -S '' -U -V unsorted -a unfinished
    (( $#quoted )) && compadd -Q -U -V unsorted -a quoted
    (( $#plain )) && compadd -U -V unsorted -a plain
    return 0
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    _aionode_completion "$@"
else
    compdef _aionode_completion aionode
fi
"""
FISH = """\
function _aionode_completion
    set -l response (env _AIONODE_COMPLETE=fish_complete COMP_WORDS=(commandline -cp) \\
        COMP_CWORD=(commandline -t) aionode)
    for completion in $response
        # Values in YAML have commas of their own.
        set -l metadata (string split -m 1 "," -- $completion)
        switch $metadata[1]
            case dir
                __fish_complete_directories $metadata[2]
            case file
                __fish_complete_path $metadata[2]
            case plain
                echo $metadata[2]
        end
    end
end
complete --no-files --command aionode --arguments "(_aionode_completion)"
"""
OWN_SCRIPTS = {"bash": BASH, "zsh": ZSH, "fish": FISH}
"""Replace click's scripts, which append a space to everything, and end a value at its comma."""

SHELLS = {
    "bash": ("~/.bashrc", 'eval "$(aionode completion bash)"'),
    "zsh": ("~/.zshrc", 'eval "$(aionode completion zsh)"'),
    "fish": ("~/.config/fish/completions/aionode.fish", "aionode completion fish | source"),
}


@click.command()
@click.argument("shell", type=click.Choice(list(SHELLS)))
def completion(shell: str) -> None:
    """Print the script with which SHELL completes commands, options, types and names."""
    file, line = SHELLS[shell]
    click.echo(SETUP.format(file=file, line=line), nl=False)
    click.echo(OWN_SCRIPTS[shell], nl=False)


def complete_names(what: str) -> Completer:
    """Return the completer for names of a ``node``, ``topic``, ``service`` or ``action``."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        return beginning(incomplete, now(lambda node: done(names_of(node, what))))

    return complete


def complete_types_of(what: str, kind: str) -> Completer:
    """Return the completer for the type after the name of a ``topic``, ``service`` or ``action``.

    It offers the types that the name has on the network. If none of them matches, it offers all of
    a kind (``msg``, ``srv``, ``action``).
    """
    any_type = complete_interfaces(kind)

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        name = ctx.params.get(f"{what}_name")
        known = now(lambda node: done(types_of(node, what, name))) if name else []
        return beginning(incomplete, known) or any_type(ctx, param, incomplete)

    return complete


def complete_parameters(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Complete the parameter names of the node earlier on the command line."""
    node_name = ctx.params.get("node_name")
    if not node_name:
        return []

    async def names(node: Node) -> list[str]:
        from aionode.parameter_client import AsyncParameterClient

        name = node_name if node_name.startswith("/") else f"/{node_name}"
        client = AsyncParameterClient(node, name)
        async with asyncio.timeout(ANSWER_S):
            await client.wait_for_services()
            found: list[str] = (await client.list_parameters()).names
        return found

    return beginning(incomplete, sorted(now(names)))


def complete_values(kind: str) -> Completer:
    """Return the completer for values of the type before them, with their defaults, in YAML.

    Args:
        kind: ``message``, ``service`` or ``action``.
    """

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        cls = class_named(ctx.params.get(f"{kind}_type"))
        if cls is None or incomplete:
            return []  # an edited text is not replaced
        part = {"message": "", "service": "Request", "action": "Goal"}[kind]
        made = getattr(cls, part, None) if part else cls
        return [] if made is None else [prototype(made)]

    return complete


def prototype(cls: Any) -> str:
    """Return the defaults of a message in YAML on one line, without single quotes."""
    from aionode.message import to_yaml

    return to_yaml(cls(), flow_style=True).strip().replace("''", '""')


def class_named(type_name: str | None) -> Any:
    """Return the class of a type, if need be as the nodes describe it; None if there is none."""
    from aionode.errors import InterfaceNotFoundError
    from aionode.interfaces import get_interface

    if not type_name:
        return None
    try:
        return get_interface(type_name)
    except InterfaceNotFoundError:
        return next(iter(now(lambda node: listed(node.find_type(type_name)))), None)


async def listed(awaited: Awaitable[Any]) -> list[Any]:
    """Return the result of an awaitable in a list."""
    return [await awaited]


def complete_fields(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Complete the path of a field of the topic earlier on the command line."""
    # An option that has no value yet ends click's parsing: it leaves the arguments as they are.
    given = [*ctx.args, ctx.params.get("topic_name"), ctx.params.get("message_type")]
    name, *types = list(filter(None, given)) or [""]
    if name and not types:
        types = now(lambda node: done(types_of(node, "topic", name)))
    classes = [class_named(each) for each in types]
    paths = [path for cls in classes if cls is not None for path in field_paths(cls)]
    return beginning(incomplete, list(dict.fromkeys(paths)))


def field_paths(cls: Any) -> Iterator[str]:
    """Yield the paths of all fields of a message class; those of messages in arrays have none."""
    from aionode.message import fields

    for field in fields(cls):
        yield field.name
        if field.type.nested is not None and field.type.container == "single":
            yield from (f"{field.name}.{path}" for path in field_paths(field.type.nested))


def complete_transitions(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Complete the transitions available to the managed node earlier on the command line."""
    node_name = ctx.params.get("node_name")
    if not node_name:
        return []

    async def labels(node: Node) -> list[str]:
        from aionode.cli._support.lookup import absolute
        from aionode.cli._verbs.lifecycle import managed_nodes, transitions

        name = absolute(node_name)
        if name not in managed_nodes(node, hidden=True):
            return []
        async with asyncio.timeout(ANSWER_S):
            found = await transitions(node, name)
        return [one.transition.label for one in found]

    return beginning(incomplete, now(labels))


def beginning(incomplete: str, names: list[str]) -> list[str]:
    """Return the names that begin with `incomplete`."""
    return [name for name in names if name.startswith(incomplete)]


def now(question: Callable[[Node], Awaitable[list[Any]]]) -> list[Any]:
    """Return the network's answer to a question, or nothing after an error.

    An error cannot be shown in the middle of a command line.
    """

    async def ask() -> list[Any]:
        from aionode.cli._support.session import make_node

        async with make_node() as node:
            for transport in node.context.transports:
                await transport.all_known(QUIET_S)
            return await question(node)

    try:
        return asyncio.run(ask())
    except (AionodeError, ExceptionGroup, TimeoutError):
        return []


async def done(names: list[str]) -> list[str]:
    """Return `names`, as a coroutine."""
    return names


def names_of(node: Node, what: str) -> list[str]:
    """Return the names of one kind that are not hidden."""
    from aionode.cli._support import lookup
    from aionode.cli._support.nouns import NOUNS

    if what == "node":
        return [info.fully_qualified_name for info in lookup.node_infos(node)]
    return list(NOUNS[what].types_by_name(node))


def types_of(node: Node, what: str, name: str) -> list[str]:
    """Return the types of a name on the network."""
    from aionode.cli._support.nouns import NOUNS

    known = NOUNS[what].types_by_name(node, hidden=True)
    return known.get(name if name.startswith("/") else f"/{name}", [])


def complete_interfaces(kind: str = "") -> Completer:
    """Return the completer for type names of a `kind`: ``msg``, ``srv``, ``action``, "" for all."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        from aionode.interfaces import interface_names, known_packages

        package, slash, _ = incomplete.partition("/")
        if not slash:
            return [f"{name}/" for name in sorted(known_packages()) if name.startswith(package)]
        found: Any = interface_names(package)
        return [name for name in found if name.startswith(incomplete) and f"/{kind}" in name]

    return complete
