"""The verbs of ``aionode param``."""

from __future__ import annotations

import asyncio
import re
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.lookup import absolute
from aionode.cli._support.param_text import (
    LABELS,
    TYPE_NAMES,
    description,
    descriptor_record,
    file_form,
    file_text,
    plain,
)
from aionode.cli._support.yaml_messages import shortened
from aionode.errors import AionodeError, CommandError, ParameterFileError
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Sequence
    from pathlib import Path

    from aionode.cli._support.output import Output
    from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
    from aionode.node import Node
    from aionode.parameter import Parameter
    from aionode.parameter_client import AsyncParameterClient

__all__ = ["delete", "describe", "dump", "get", "list_parameters", "load", "set_parameter"]

ANSWER_S = 5.0
"""Timeout for the parameter services of a node, in seconds; normally they take milliseconds."""


# The node


@asynccontextmanager
async def parameters_of(
    node: Node, node_name: str, timeout_s: float, *, hidden: bool = False
) -> AsyncIterator[AsyncParameterClient]:
    """Yield a client for the parameters of a node, waiting at most `timeout_s` for the node.

    Raises:
        CommandError: there is no such node, it has no parameter services, or it does not answer.
    """
    from aionode.parameter_client import AsyncParameterClient

    name = absolute(node_name)
    await wait_for_node(node, name, timeout_s, hidden=hidden)
    client = AsyncParameterClient(node, name)
    try:
        if not await client.wait_for_services(timeout_s):
            raise CommandError(
                f"Node '{name}' has no parameter services (none within {timeout_s:g} s); was it "
                "created with start_parameter_services=False?"
            )
        async with asyncio.timeout(ANSWER_S):
            yield client
    except TimeoutError as error:
        raise CommandError(
            f"Node '{name}' did not answer within {ANSWER_S:g} s; is its event loop blocked?"
        ) from error
    finally:
        client.destroy()


async def wait_for_node(node: Node, name: str, timeout_s: float, *, hidden: bool) -> None:
    """Wait until a node of this name exists.

    Raises:
        CommandError: none appeared within `timeout_s`.
    """

    def names() -> list[str]:
        infos = lookup.node_infos(node, hidden=hidden)
        return [info.fully_qualified_name for info in infos]

    try:
        async with asyncio.timeout(timeout_s):
            await node.graph.until(lambda: name in names(), name)
    except TimeoutError:
        raise lookup.unknown("Node not found:", name, names(), "node list") from None


async def not_declared(client: AsyncParameterClient, wanted: Sequence[str]) -> CommandError:
    """Return the error for parameters that are not declared or have no value."""
    known = (await client.list_parameters()).names
    missing = next((name for name in wanted if name not in known), None)
    if missing is None:
        return CommandError(f"Parameter not set: {', '.join(wanted)} has no value yet")
    where = f"param list {client.remote_node_name}"
    return lookup.unknown("Parameter not set: no parameter", missing, known, where)


# Verbs


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
) -> int:
    """Print the names of the parameters of one node, or of all; return the exit status.

    Raises:
        CommandError: there is no such node, it has no parameter services, or `pattern` is invalid.
    """
    fits = pattern_from(pattern)
    if node_name is not None:
        names = [absolute(node_name)]
        await wait_for_node(node, names[0], timeout, hidden=hidden)
    else:
        infos = lookup.node_infos(node, hidden=hidden)
        names = [info.fully_qualified_name for info in infos]
        names = [name for name in dict.fromkeys(names) if offers_parameters(node, name)]

    async def ask(name: str) -> list[ParameterDescriptor] | AionodeError:
        try:
            async with parameters_of(node, name, timeout, hidden=hidden) as client:
                found = (await client.list_parameters(list(prefixes))).names
                return await client.describe_parameters(sorted(filter(fits, found)))
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


def offers_parameters(node: Node, name: str) -> bool:
    """Return whether a node has parameter services now."""
    return node.graph.count(EndpointKind.SERVER, f"{name}/list_parameters") > 0


def pattern_from(pattern: str | None) -> Callable[[str], bool]:
    """Return a predicate for names that match a regular expression.

    Raises:
        CommandError: the regular expression is invalid.
    """
    try:
        compiled = re.compile(pattern or "")
    except (re.error, OverflowError, RecursionError) as error:
        raise CommandError(
            f"--filter {pattern!r}: not a regular expression: {error}; expected one such as "
            "'camera.*'"
        ) from error
    return lambda name: compiled.match(name) is not None


async def get(
    node: Node,
    node_name: str,
    parameter_name: str,
    *,
    output: Output,
    hide_type: bool = False,
    hidden: bool = False,
    timeout: float = 1.0,
) -> None:
    """Print the value of a parameter.

    Raises:
        CommandError: there is no such node or parameter.
    """
    async with parameters_of(node, node_name, timeout, hidden=hidden) as client:
        found = await client.get_parameters([parameter_name])
        if not found:
            raise await not_declared(client, [parameter_name])
    (parameter,) = found
    value = plain(parameter, as_numbers=output.json)
    label = LABELS[parameter.type_]
    text = label if value is None else f"{label} {value}"
    output.item(
        str(value) if hide_type else text,
        {
            "node": absolute(node_name),
            "name": parameter_name,
            "type": TYPE_NAMES[parameter.type_],
            "value": value,
        },
    )


async def set_parameter(
    node: Node,
    node_name: str,
    parameter_name: str,
    value: str,
    *,
    output: Output,
    hidden: bool = False,
    timeout: float = 1.0,
) -> int:
    """Set a parameter to a value in YAML; return the exit status.

    Raises:
        CommandError: there is no such node, or the value is not valid YAML.
    """
    from aionode.parameter import Parameter

    message = parameter_value(value)
    parameter = Parameter.from_parameter_msg(message_of(parameter_name, message))
    async with parameters_of(node, node_name, timeout, hidden=hidden) as client:
        (result,) = await client.set_parameters([parameter])
    return print_result(
        output,
        result,
        ("Set parameter successful", "Setting parameter failed"),
        {"node": absolute(node_name), "name": parameter_name},
    )


def parameter_value(text: str) -> Any:
    """Return the message for a value in YAML, read as ``ros2 param set`` reads it.

    `get_parameter_value` would store text with an unclosed bracket or quote as a string.

    Raises:
        CommandError: brackets or quotes are not balanced, or the value is a mapping.
    """
    from aionode.parameter import get_parameter_value

    if text.lstrip()[:1] in {"[", "{", '"', "'"}:
        expect_value(text)
    return get_parameter_value(text)


def expect_value(text: str) -> None:
    """Raise CommandError unless a text is a scalar or a list in YAML."""
    import yaml

    expected = "expected a scalar or a list of scalars"
    try:
        node = yaml.compose(text, yaml.SafeLoader)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
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


async def delete(
    node: Node,
    node_name: str,
    parameter_name: str,
    *,
    output: Output,
    hidden: bool = False,
    timeout: float = 1.0,
) -> int:
    """Undeclare a parameter; return the exit status.

    Raises:
        CommandError: there is no such node.
    """
    async with parameters_of(node, node_name, timeout, hidden=hidden) as client:
        (result,) = await client.delete_parameters([parameter_name])
    return print_result(
        output,
        result,
        ("Deleted parameter successfully", "Deleting parameter failed"),
        {"node": absolute(node_name), "name": parameter_name},
    )


async def describe(
    node: Node,
    node_name: str,
    parameter_names: Sequence[str],
    *,
    output: Output,
    hidden: bool = False,
    timeout: float = 1.0,
) -> None:
    """Print the type, description and constraints of parameters.

    Raises:
        CommandError: there is no such node or parameter.
    """
    async with parameters_of(node, node_name, timeout, hidden=hidden) as client:
        found = await client.describe_parameters(parameter_names)
        if len(found) < len(parameter_names):
            raise await not_declared(client, parameter_names)
    for descriptor in found:
        output.item("\n".join(description(descriptor)), descriptor_record(node_name, descriptor))


async def dump(
    node: Node, node_name: str, *, output: Output, hidden: bool = False, timeout: float = 1.0
) -> None:
    """Print all parameters of a node as a parameter file.

    Raises:
        CommandError: there is no such node.
    """
    async with parameters_of(node, node_name, timeout, hidden=hidden) as client:
        names = sorted((await client.list_parameters()).names)
        found = await get_all(client, names)
    record = {absolute(node_name): {"ros__parameters": file_form(found, as_numbers=output.json)}}
    output.item("" if output.json else file_text(record), record)


async def get_all(client: AsyncParameterClient, names: list[str]) -> list[Parameter]:
    """Return the parameters that have a value.

    A node answers a request that includes a parameter without a value with an empty list; then each
    parameter is requested alone.
    """
    found = await client.get_parameters(names)
    if found or not names:
        return found
    each = [await client.get_parameters([name]) for name in names]
    return [parameter for one in each for parameter in one]


async def load(
    node: Node,
    node_name: str,
    parameter_file: Path,
    *,
    output: Output,
    wildcards: bool = True,
    hidden: bool = False,
    timeout: float = 1.0,
) -> int:
    """Set the parameters of a node from a file; return the exit status.

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
    async with parameters_of(node, name, timeout, hidden=hidden) as client:
        declared = (await client.list_parameters()).names
        present = await get_all(client, [key for key in values if key in declared])
        before = {one.name: one for one in present}
        parameters = [like(before.get(key), key, value) for key, value in values.items()]
        results = await client.set_parameters(parameters)
    for one, result in zip(parameters, results, strict=True):
        # `dump` includes read-only parameters; loading the same value of one is not a failure.
        if not result.successful and before.get(one.name) == one:
            result.successful = True
            result.reason = "it already has this value"
    return max(
        print_result(
            output,
            result,
            (f"Set parameter {one.name} successful", f"Set parameter {one.name} failed"),
            {"node": name, "name": one.name},
        )
        for one, result in zip(parameters, results, strict=True)
    )


def like(before: Parameter | None, name: str, value: Any) -> Parameter:
    """Return a parameter with a value from a file, keeping its type where YAML cannot express it.

    That concerns bytes, which a file may hold as integers, and empty lists.
    """
    from aionode.parameter import Parameter, ParameterType

    type_ = None if before is None else before.type_
    if value == [] and type_ is not None and type_.name.endswith("_ARRAY"):
        return Parameter(name, type_, value)
    if type_ is ParameterType.BYTE_ARRAY and is_bytes(value):
        return Parameter(name, type_, [bytes([each]) for each in value])
    return Parameter(name, value=value)


def is_bytes(value: Any) -> bool:
    """Return whether a value is a list of integers from 0 to 255."""
    return isinstance(value, list) and all(
        isinstance(each, int) and not isinstance(each, bool) and 0 <= each < 256 for each in value
    )
