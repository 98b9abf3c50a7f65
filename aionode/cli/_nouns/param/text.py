"""Parameters as text in ros2's layout, as records, and as parameter files."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING, Any

from aionode.cli._support.lookup import absolute

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor
    from aionode.parameter import Parameter

__all__ = [
    "LABELS",
    "TYPE_NAMES",
    "description",
    "descriptor_record",
    "file_form",
    "file_text",
    "plain",
]

TYPE_NAMES = (
    "not set",
    "boolean",
    "integer",
    "double",
    "string",
    "byte array",
    "boolean array",
    "integer array",
    "double array",
    "string array",
)
LABELS = (
    "Parameter not set.",
    "Boolean value is:",
    "Integer value is:",
    "Double value is:",
    "String value is:",
    "Byte values are:",
    "Boolean values are:",
    "Integer values are:",
    "Double values are:",
    "String values are:",
)


def plain(parameter: Parameter, *, as_numbers: bool = False) -> Any:
    """Return the value of a parameter for printing, with bytes as in ros2 or as numbers."""
    value = parameter.value
    if isinstance(value, bytes | bytearray):
        value = [bytes((number,)) for number in value]
    if not isinstance(value, list | tuple):
        return value
    return [item[0] if as_numbers and isinstance(item, bytes) else item for item in value]


def description(descriptor: ParameterDescriptor) -> list[str]:
    """Return the description of a parameter as lines, in ros2's layout."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {TYPE_NAMES[descriptor.type]}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    for limits in ranges_of(descriptor)[:1]:
        lines.append(f"    Min value: {limits.from_value}")
        lines.append(f"    Max value: {limits.to_value}")
        if limits.step:
            lines.append(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines


def ranges_of(descriptor: ParameterDescriptor) -> list[Any]:
    """Return the range of a numeric parameter, or an empty list."""
    return [*descriptor.floating_point_range, *descriptor.integer_range]


def descriptor_record(node_name: str, descriptor: ParameterDescriptor) -> dict[str, Any]:
    """Return the description of a parameter as plain values."""
    ranges = ranges_of(descriptor)
    return {
        "node": absolute(node_name),
        "name": descriptor.name,
        "type": TYPE_NAMES[descriptor.type],
        "description": descriptor.description,
        "read_only": descriptor.read_only,
        "dynamic_typing": descriptor.dynamic_typing,
        "additional_constraints": descriptor.additional_constraints,
        "min": ranges[0].from_value if ranges else None,
        "max": ranges[0].to_value if ranges else None,
        "step": ranges[0].step if ranges else None,
    }


def file_form(parameters: Iterable[Parameter], *, as_numbers: bool = False) -> dict[str, Any]:
    """Return the contents of a parameter file: sorted, nested where names have dots."""
    values: dict[str, Any] = {}
    # `a` sorts before `a.b`, which then cannot be nested below it and keeps its dotted name.
    for parameter in sorted(parameters, key=attrgetter("name")):
        insert(values, parameter.name, plain(parameter, as_numbers=as_numbers))
    return ordered(values)


def file_text(record: dict[str, Any]) -> str:
    """Return the text of a parameter file, in the layout of ``ros2 param dump``.

    Unlike ros2, it quotes strings that parameter files would read as numbers. The rules differ from
    YAML's: ``INF`` is a number, for example.
    """
    import yaml

    from aionode.arguments import parse_scalar

    dumper: Any = type("Quoting", (yaml.SafeDumper,), {})

    def represent(to: Any, text: str) -> Any:
        style = None if parse_scalar(text) == text else "'"
        return to.represent_scalar("tag:yaml.org,2002:str", text, style)

    dumper.add_representer(str, represent)
    text: str = yaml.dump(record, Dumper=dumper, default_flow_style=False)
    return text


def insert(values: dict[str, Any], name: str, value: Any) -> None:
    """Insert a value, turning the dotted parts of its name into nested keys."""
    first, dot, rest = name.partition(".")
    if dot and isinstance(values.get(first, {}), dict):
        insert(values.setdefault(first, {}), rest, value)
    else:
        values[name] = value


def ordered(values: dict[str, Any]) -> dict[str, Any]:
    """Return the mapping with keys sorted at every level."""
    return {
        key: ordered(value) if isinstance(value, dict) else value
        for key, value in sorted(values.items())
    }
