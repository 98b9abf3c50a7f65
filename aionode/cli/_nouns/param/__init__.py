"""``aionode param``: read and set the parameters of nodes."""

from __future__ import annotations

import asyncio
import re
import warnings
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._nouns.param.text import (
    LABELS,
    TYPE_NAMES,
    description,
    descriptor_record,
    file_form,
    file_text,
    plain,
)
from aionode.cli._support import lookup
from aionode.cli._support.command import command
from aionode.cli._support.completion import complete_names, complete_of_node, name_argument
from aionode.cli._support.lookup import absolute
from aionode.cli._support.options import hidden_option, positive
from aionode.cli._support.yaml_messages import shortened
from aionode.errors import AionodeError, CommandError, ParameterFileError
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Sequence

    from aionode.cli._support.output import Output
    from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
    from aionode.node import Node
    from aionode.parameter import Parameter
    from aionode.parameter_client import AsyncParameterClient

__all__ = [
    "delete",
    "describe",
    "dump",
    "get",
    "list_parameters",
    "load",
    "message_of",
    "param_command",
    "parameter_value",
    "parameters_of",
    "set_parameters",
]

ANSWER_S = 5.0
"""Timeout for the parameter services of a node, in seconds; normally they take milliseconds."""

service_timeout_option = click.option(
    "--service-timeout",
    metavar="N",
    type=positive,
    default=ANSWER_S,
    show_default=True,
    help="Wait at most N seconds for the node's answers.",
)

timeout_option = click.option(
    "--timeout",
    metavar="N",
    type=positive,
    default=1.0,
    show_default=True,
    help="Wait at most N seconds for the node.",
)


@click.group("param")
def param_command() -> None:
    """Read and set the parameters of nodes."""


# The node


@asynccontextmanager
async def parameters_of(
    node: Node,
    node_name: str,
    *,
    hidden: bool = False,
    timeout: float = 1.0,
    service_timeout: float = ANSWER_S,
) -> AsyncIterator[AsyncParameterClient]:
    """Yield a client for the parameters of a node.

    Args:
        node: The command's node.
        node_name: Name of the other node.
        hidden: Whether it may be a hidden node.
        timeout: Maximum time to wait for the node and its services, in seconds.
        service_timeout: Maximum time to wait for its answers, in seconds.

    Raises:
        CommandError: there is no such node, it has no parameter services, or it does not answer.
    """
    from aionode.parameter_client import AsyncParameterClient

    name = absolute(node_name)
    await wait_for_node(node, name, hidden=hidden, timeout=timeout)
    client = AsyncParameterClient(node, name)
    try:
        if not await client.wait_for_services(timeout):
            raise CommandError(
                f"Node '{name}' has no parameter services (none within {timeout:g} s); was it "
                "created with start_parameter_services=False?"
            )
        async with asyncio.timeout(service_timeout):
            yield client
    except TimeoutError as error:
        raise CommandError(
            f"Node '{name}' did not answer within {service_timeout:g} s; is its event loop blocked?"
        ) from error
    finally:
        client.destroy()


async def wait_for_node(
    node: Node, name: str, *, hidden: bool = False, timeout: float = 1.0
) -> None:
    """Wait until a node of this name exists.

    Raises:
        CommandError: none appeared within `timeout`, in seconds.
    """
    try:
        async with asyncio.timeout(timeout):
            await node.graph.until(lambda: name in node_names(node, hidden=hidden), name)
    except TimeoutError:
        names = node_names(node, hidden=hidden)
        raise lookup.unknown("Node not found:", name, names, "node list") from None


def node_names(node: Node, *, hidden: bool) -> list[str]:
    """Return the full names of the other nodes."""
    return [info.fully_qualified_name for info in lookup.node_infos(node, hidden=hidden)]


async def not_declared(client: AsyncParameterClient, wanted: Sequence[str]) -> CommandError:
    """Return the error for parameters that are not declared or have no value."""
    known = (await client.list_parameters()).names
    missing = next((name for name in wanted if name not in known), None)
    if missing is None:
        return CommandError(f"Parameter not set: {', '.join(wanted)} has no value yet")
    where = f"param list {client.remote_node_name}"
    return lookup.unknown("Parameter not set: no parameter", missing, known, where)


async def names_of(node: Node, node_name: str) -> list[str]:
    """Return the sorted parameter names of a node."""
    from aionode.parameter_client import AsyncParameterClient

    client = AsyncParameterClient(node, node_name)
    await client.wait_for_services()
    return sorted((await client.list_parameters()).names)


# Commands

node_argument = name_argument("node")
parameter_argument = click.argument("parameter_name", shell_complete=complete_of_node(names_of))
node_options = (
    hidden_option("--include-hidden-nodes", what="nodes"),
    timeout_option,
    service_timeout_option,
)
"""Options of all commands."""


@command(
    param_command,
    "list",
    name_argument("node", required=False),
    click.option(
        "--filter", "pattern", metavar="REGEX", help="Only names that match this pattern."
    ),
    click.option(
        "--param-prefixes",
        "prefixes",
        metavar="PREFIX",
        multiple=True,
        help="Only names with this prefix.",
    ),
    click.option("--param-type", "types", is_flag=True, help="Print the types too."),
    *node_options,
)
async def list_parameters(
    node: Node,
    node_name: str | None = None,
    *,
    output: Output,
    pattern: str | None = None,
    prefixes: Sequence[str] = (),
    types: bool = False,
    hidden: bool = False,
    timeout: float = 1.0,
    service_timeout: float = ANSWER_S,
) -> int:
    """List the parameters of one node, or of all.

    Returns:
        The exit status.

    Raises:
        CommandError: there is no such node, it has no parameter services, or `pattern` is invalid.
    """
    fits = pattern_from(pattern)
    if node_name is not None:
        names = [absolute(node_name)]
        await wait_for_node(node, names[0], hidden=hidden, timeout=timeout)
    else:
        names = nodes_with_parameters(node, hidden=hidden)
    reach: dict[str, Any] = {
        "hidden": hidden,
        "timeout": timeout,
        "service_timeout": service_timeout,
    }

    async def ask(name: str) -> list[ParameterDescriptor] | AionodeError:
        try:
            async with parameters_of(node, name, **reach) as client:
                declared = (await client.list_parameters(list(prefixes))).names
                return await client.describe_parameters(sorted(filter(fits, declared)))
        except AionodeError as error:
            if node_name is not None:
                raise
            return error

    answers = await asyncio.gather(*(ask(name) for name in names))
    status = 0
    for name, answer in zip(names, answers, strict=True):
        if isinstance(answer, AionodeError):
            output.warn(str(answer))
            status = 1
            continue
        if node_name is None and answer:
            output.text(f"{name}:")
        for descriptor in answer:
            kind = TYPE_NAMES[descriptor.type]
            output.item(
                f"  {descriptor.name} (type: {kind})" if types else f"  {descriptor.name}",
                {"node": name, "name": descriptor.name, "type": kind},
            )
    return status


def nodes_with_parameters(node: Node, *, hidden: bool) -> list[str]:
    """Return the names of the other nodes that have parameter services now."""
    return [
        name
        for name in dict.fromkeys(node_names(node, hidden=hidden))
        if node.graph.count(EndpointKind.SERVER, f"{name}/list_parameters") > 0
    ]


def pattern_from(pattern: str | None) -> Callable[[str], bool]:
    """Return a predicate for names that match a regular expression.

    Raises:
        CommandError: the regular expression is invalid.
    """
    try:
        with warnings.catch_warnings():
            # Python warns about patterns that later versions may read differently, such as "[[".
            warnings.simplefilter("ignore", FutureWarning)
            compiled = re.compile(pattern or "")
    except (re.error, OverflowError, RecursionError) as error:
        raise CommandError(
            f"--filter {pattern!r}: not a regular expression: {error}; expected one such as "
            "'camera.*'"
        ) from error
    return lambda name: compiled.match(name) is not None


@command(
    param_command,
    "get",
    click.argument("node_name", metavar="[NODE_NAME]", shell_complete=complete_names("node")),
    click.argument("parameter_names", nargs=-1, shell_complete=complete_of_node(names_of)),
    click.option("--hide-type", is_flag=True, help="Print only the value."),
    *node_options,
)
async def get(
    node: Node,
    node_name: str,
    parameter_names: Sequence[str],
    *,
    output: Output,
    hide_type: bool = False,
    **reach: Any,
) -> int:
    """Print the values of parameters of a node, or of one parameter of all nodes.

    A single name is taken as a parameter, and every node is asked for it.

    Returns:
        The exit status.

    Raises:
        CommandError: there is no such node or parameter.
    """
    if not parameter_names:
        return await get_everywhere(node, node_name, output=output, hide_type=hide_type, **reach)
    async with parameters_of(node, node_name, **reach) as client:
        values = await client.get_parameters(parameter_names)
        if len(values) < len(parameter_names):
            raise await not_declared(client, parameter_names)
    for parameter in values:
        title = parameter.name if len(parameter_names) > 1 else ""
        print_value(output, absolute(node_name), parameter, title, hide_type=hide_type)
    return 0


async def get_everywhere(
    node: Node,
    name: str,
    *,
    output: Output,
    hide_type: bool,
    hidden: bool = False,
    **reach: Any,
) -> int:
    """Print the value of a parameter of each node that has it.

    Returns:
        The exit status: 1 if a node does not answer.

    Raises:
        CommandError: no node has it.
    """
    names = nodes_with_parameters(node, hidden=hidden)

    async def ask(node_name: str) -> list[Parameter] | AionodeError:
        try:
            async with parameters_of(node, node_name, hidden=hidden, **reach) as client:
                return await client.get_parameters([name])
        except AionodeError as error:
            return error

    answers = await asyncio.gather(*map(ask, names))
    status = 0
    for node_name, answer in zip(names, answers, strict=True):
        if isinstance(answer, AionodeError):
            output.warn(str(answer))
            status = 1
            continue
        for parameter in answer:
            print_value(output, node_name, parameter, node_name, hide_type=hide_type)
    if not any(answers):
        if absolute(name) in node_names(node, hidden=True):
            raise CommandError(
                f"'{name}' is a node; 'aionode param list {name}' lists its parameters"
            )
        raise CommandError(
            f"Parameter '{name}' is set on none of {len(names)} nodes; 'aionode param list' has "
            "the parameters of all of them"
        )
    return status


def print_value(
    output: Output, node_name: str, parameter: Parameter, title: str, *, hide_type: bool
) -> None:
    """Print the value of a parameter, below a title if there are several."""
    value = plain(parameter, as_numbers=output.json)
    label = LABELS[parameter.type_]
    text = str(value) if hide_type else label if value is None else f"{label} {value}"
    if title:
        text = f"{title}: {text}" if hide_type else f"{title}:\n  {text}"
    kind = TYPE_NAMES[parameter.type_]
    record = {"node": node_name, "name": parameter.name, "type": kind, "value": value}
    output.item(text, record)


def complete_pairs(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Complete the name of a parameter; offer nothing for its value."""
    given = ctx.params.get("pairs") or ()
    return [] if len(given) % 2 else complete_of_node(names_of)(ctx, param, incomplete)


def expect_pairs(options: dict[str, Any]) -> None:
    """Pair up the names and values, which are given alternately."""
    given = options["pairs"]
    if len(given) % 2:
        raise click.UsageError(f"Parameter {given[-1]!r} has no value: give NAME VALUE for each.")
    options["pairs"] = list(zip(given[::2], given[1::2], strict=True))


@command(
    param_command,
    "set",
    node_argument,
    click.argument(
        "pairs", metavar="NAME VALUE...", nargs=-1, required=True, shell_complete=complete_pairs
    ),
    click.option("--atomic", is_flag=True, help="Set all of them, or none if one is refused."),
    *node_options,
    prepare=expect_pairs,
    context_settings={"ignore_unknown_options": True},
)
async def set_parameters(
    node: Node,
    node_name: str,
    pairs: Sequence[tuple[str, str]],
    *,
    output: Output,
    atomic: bool = False,
    **reach: Any,
) -> int:
    """Set parameters to values in YAML: a name and a value for each.

    Returns:
        The exit status.

    Raises:
        CommandError: there is no such node, or a value is not valid YAML.
    """
    from aionode.parameter import Parameter

    messages = [message_of(name, parameter_value(value)) for name, value in pairs]
    parameters = list(map(Parameter.from_parameter_msg, messages))
    where = {"node": absolute(node_name)}
    async with parameters_of(node, node_name, **reach) as client:
        if atomic:
            result = await client.set_parameters_atomically(parameters)
            words = ("Set parameters atomically successful", "Setting parameters atomically failed")
            return print_result(output, result, words, {**where, "names": [n for n, _ in pairs]})
        results = await client.set_parameters(parameters)
    words = ("Set parameter successful", "Setting parameter failed")
    status = 0
    for (name, _), result in zip(pairs, results, strict=True):
        title = f"{name}: " if len(pairs) > 1 else ""
        titled = (title + words[0], title + words[1])
        status |= print_result(output, result, titled, {**where, "name": name})
    return status


def parameter_value(text: str) -> Any:
    """Return the message for a YAML value, parsed as ``ros2 param set`` does.

    `get_parameter_value` would accept text with an unclosed bracket or quote as a string.

    Raises:
        CommandError: brackets or quotes are not balanced, or the value is a mapping.
    """
    from aionode.parameter import get_parameter_value

    if text.lstrip()[:1] in {"[", "{", '"', "'"}:
        expect_value(text)
    return get_parameter_value(text)


def expect_value(text: str) -> None:
    """Raise CommandError unless a text is a YAML scalar or list."""
    import yaml

    from aionode._process.bounded_yaml import composed_yaml

    expected = "expected a scalar or a list of scalars"
    try:
        node = composed_yaml(text)
    except yaml.YAMLError as error:
        problem = getattr(error, "problem", None) or str(error).partition("\n")[0]
        raise CommandError(f"value {shortened(text)}: not YAML: {problem}; {expected}") from error
    if isinstance(node, yaml.MappingNode):
        raise CommandError(f"value {shortened(text)}: a mapping; {expected}")


def message_of(name: str, value: Any) -> Any:
    """Return a parameter as a message."""
    from aionode.interfaces.rcl_interfaces.msg import Parameter

    return Parameter(name=name, value=value)


def print_result(
    output: Output, result: SetParametersResult, words: tuple[str, str], record: dict[str, Any]
) -> int:
    """Print the result of a change, and return the exit status."""
    reason = f": {result.reason}" if result.reason else ""
    text = f"{words[0] if result.successful else words[1]}{reason}"
    if output.json:
        output.item("", {**record, "successful": result.successful, "reason": result.reason})
    elif result.successful:
        output.text(text)
    else:
        output.warn(text)
    return 0 if result.successful else 1


@command(param_command, "delete", node_argument, parameter_argument, *node_options)
async def delete(
    node: Node,
    node_name: str,
    parameter_name: str,
    *,
    output: Output,
    **reach: Any,
) -> int:
    """Undeclare a parameter.

    Returns:
        The exit status.

    Raises:
        CommandError: there is no such node.
    """
    async with parameters_of(node, node_name, **reach) as client:
        (result,) = await client.delete_parameters([parameter_name])
    return print_result(
        output,
        result,
        ("Deleted parameter successfully", "Deleting parameter failed"),
        {"node": absolute(node_name), "name": parameter_name},
    )


@command(
    param_command,
    "describe",
    node_argument,
    click.argument(
        "parameter_names", nargs=-1, required=True, shell_complete=complete_of_node(names_of)
    ),
    *node_options,
)
async def describe(
    node: Node,
    node_name: str,
    parameter_names: Sequence[str],
    *,
    output: Output,
    **reach: Any,
) -> None:
    """Print the type, description and constraints of parameters.

    Raises:
        CommandError: there is no such node or parameter.
    """
    async with parameters_of(node, node_name, **reach) as client:
        descriptors = await client.describe_parameters(parameter_names)
        if len(descriptors) < len(parameter_names):
            raise await not_declared(client, parameter_names)
    for descriptor in descriptors:
        output.item("\n".join(description(descriptor)), descriptor_record(node_name, descriptor))


@command(param_command, "dump", node_argument, *node_options)
async def dump(node: Node, node_name: str, *, output: Output, **reach: Any) -> None:
    """Print all parameters of a node as a parameter file.

    Raises:
        CommandError: there is no such node.
    """
    async with parameters_of(node, node_name, **reach) as client:
        names = sorted((await client.list_parameters()).names)
        parameters = await get_all(client, names)
    record = {
        absolute(node_name): {"ros__parameters": file_form(parameters, as_numbers=output.json)}
    }
    output.item("" if output.json else file_text(record), record)


async def get_all(client: AsyncParameterClient, names: list[str]) -> list[Parameter]:
    """Return the parameters that have a value.

    A node answers a request that includes a parameter without a value with an empty list; in that
    case, each parameter is requested separately.
    """
    parameters = await client.get_parameters(names)
    if parameters or not names:
        return parameters
    return [parameter for name in names for parameter in await client.get_parameters([name])]


@command(
    param_command,
    "load",
    node_argument,
    click.argument("parameter_file", type=click.Path(path_type=Path)),
    click.option(
        "--no-use-wildcard",
        "wildcards",
        is_flag=True,
        flag_value=False,
        default=True,
        help="Ignore the file's values for wildcard nodes.",
    ),
    *node_options,
)
async def load(
    node: Node,
    node_name: str,
    parameter_file: Path,
    *,
    output: Output,
    wildcards: bool = True,
    **reach: Any,
) -> int:
    """Set the parameters of a node from a file.

    Returns:
        The exit status.

    Raises:
        CommandError: there is no such node.
        ParameterFileError: the file cannot be read, or has no parameters for the node.
    """
    from aionode.arguments import matching_parameters, read_parameter_file

    name = absolute(node_name)
    rules = read_parameter_file(parameter_file)
    wanted = [rule for rule in rules if wildcards or "*" not in rule.node]
    values = matching_parameters(wanted, name)
    if not values:
        given = ", ".join(dict.fromkeys(rule.node for rule in rules)) or "no node"
        raise ParameterFileError(
            str(parameter_file), 0, f"no parameters for {name}, only for {given}"
        )
    async with parameters_of(node, name, **reach) as client:
        declared = (await client.list_parameters()).names
        present = await get_all(client, [key for key in values if key in declared])
        before = {parameter.name: parameter for parameter in present}
        parameters = [like(before.get(key), key, value) for key, value in values.items()]
        results = await client.set_parameters(parameters)
    for parameter, result in zip(parameters, results, strict=True):
        # `dump` includes read-only parameters; loading one with its current value is not a failure.
        if not result.successful and before.get(parameter.name) == parameter:
            result.successful = True
            result.reason = "it already has this value"
    return max(
        print_result(
            output,
            result,
            (
                f"Set parameter {parameter.name} successful",
                f"Set parameter {parameter.name} failed",
            ),
            {"node": name, "name": parameter.name},
        )
        for parameter, result in zip(parameters, results, strict=True)
    )


def like(before: Parameter | None, name: str, value: Any) -> Parameter:
    """Return a parameter with a value from a file, keeping its type if YAML cannot express it.

    This concerns bytes, which a file may contain as integers, and empty lists.
    """
    from aionode.parameter import Parameter, ParameterType

    type_ = None if before is None else before.type_
    if value == [] and type_ is not None and type_.name.endswith("_ARRAY"):
        return Parameter(name, type_, value)
    if type_ is ParameterType.BYTE_ARRAY and is_bytes(value):
        return Parameter(name, type_, [bytes([number]) for number in value])
    return Parameter(name, value=value)


def is_bytes(value: Any) -> bool:
    """Return whether a value is a list of integers from 0 to 255."""
    return isinstance(value, list) and all(
        isinstance(number, int) and not isinstance(number, bool) and 0 <= number < 256
        for number in value
    )
