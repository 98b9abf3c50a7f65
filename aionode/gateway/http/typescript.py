"""TypeScript types of messages, services and actions, in the JSON form that the gateway uses.

The text is a module of declarations, for a file such as ``robot.d.ts``. It has an interface for
each message, in a namespace for its package, and maps from ROS names to these interfaces.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any, Final

from aionode.message import (
    ActionType,
    Constant,
    FieldType,
    Message,
    ServiceType,
    constants,
    documentation,
    fields,
    type_name,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

__all__ = ["typescript"]

HEADER: Final = """\
// The messages of a robot, as its gateway writes and reads them in JSON.
// Written by `aionode gateway types`.

/** A floating-point number; null stands for NaN and for the infinities. */
export type Real = number | null;

/** The bytes of an array, in Base64. */
export type Base64 = string;

/** A message to send: every field may be left out, and then has its default; null is refused. */
export type Outgoing<T> = T extends null
  ? never
  : T extends readonly (infer Item)[]
    ? Outgoing<Item>[]
    : T extends object
      ? { [Name in keyof T]?: Outgoing<T[Name]> }
      : T;
"""

PARTS: Final = {
    ServiceType: ("Request", "Response"),
    ActionType: ("Goal", "Result", "Feedback"),
}
"""The messages that a service and an action consist of, as attributes of their class."""


def typescript(
    classes: Iterable[Any],
    *,
    topics: Mapping[str, str] | None = None,
    services: Mapping[str, str] | None = None,
    actions: Mapping[str, str] | None = None,
) -> str:
    """Return a TypeScript module of declarations.

    Args:
        classes: Classes of messages, services and actions; nested messages are found from them.
        topics: The type of each topic, as a map named ``Topics``; types without a class are left
            out of these maps.
        services: The type of each service, as ``Services``.
        actions: The type of each action, as ``Actions``.
    """
    known = {type_name(cls): cls for cls in classes}
    messages: dict[str, type[Message]] = {}
    for cls in known.values():
        for part in parts_of(cls).values():
            collect(part, messages)
    maps = {
        "MessageTypes": {name: name for name, cls in known.items() if is_message(cls)},
        "ServiceTypes": {name: name for name, cls in known.items() if is_a(cls, ServiceType)},
        "ActionTypes": {name: name for name, cls in known.items() if is_a(cls, ActionType)},
        "Topics": topics,
        "Services": services,
        "Actions": actions,
    }
    texts = [HEADER, *namespaces(messages)]
    texts += [map_text(name, entries, known) for name, entries in maps.items() if entries]
    return "\n".join(texts)


def is_a(cls: Any, base: type) -> bool:
    """Return whether a class is a service or an action."""
    return isinstance(cls, type) and issubclass(cls, base)


def is_message(cls: Any) -> bool:
    """Return whether a class is neither a service nor an action."""
    return not any(is_a(cls, base) for base in PARTS)


def parts_of(cls: Any) -> dict[str, type[Message]]:
    """Return the messages of a service or an action by their role; a message is its own part."""
    for base, parts in PARTS.items():
        if is_a(cls, base):
            return {part: getattr(cls, part) for part in parts}
    return {"": cls}


def collect(cls: type[Message], classes: dict[str, type[Message]]) -> None:
    """Add a message and those nested in it to `classes`, by name."""
    if type_name(cls) in classes:
        return
    classes[type_name(cls)] = cls
    for field in fields(cls):
        if field.type.nested is not None:
            collect(field.type.nested, classes)


def dotted(name: str) -> str:
    """Return the name of an interface, such as ``std_msgs.msg.String``."""
    return name.replace("/", ".")


def namespaces(messages: Mapping[str, type[Message]]) -> Iterator[str]:
    """Yield the text of each namespace, such as ``geometry_msgs.msg``."""
    by_package: dict[str, list[type[Message]]] = {}
    for name in sorted(messages):
        by_package.setdefault(name.rpartition("/")[0], []).append(messages[name])
    for package, classes in by_package.items():
        body = "\n".join(interface_text(cls) for cls in classes)
        yield f"export namespace {dotted(package)} {{\n{body}}}\n"


def interface_text(cls: type[Message]) -> str:
    """Return the interface of one message, indented for its namespace."""
    text, described = documentation(cls)
    lines = comment([text, *map(constant_text, constants(cls))], "  ")
    lines.append(f"  interface {type_name(cls).rpartition('/')[2]} {{")
    for field in fields(cls):
        wide = {"int64", "uint64"} & {field.type.kind}
        notes = ["Beyond 2**53 JavaScript loses the last digits."] if wide else []
        lines += comment([described.get(field.name, ""), *notes], "    ")
        lines.append(f"    {field.name}: {type_text(field.type)};")
    return "\n".join([*lines, "  }", ""])


def constant_text(constant: Constant) -> str:
    """Return a constant as it is written in a definition."""
    value = constant.value[0] if isinstance(constant.value, bytes) else constant.value
    return f"{constant.type} {constant.name} = {value!r}"


def comment(texts: Iterable[str], indent: str) -> list[str]:
    """Return the lines of a comment; empty if there is no text."""
    # A description must not be able to end the comment that contains it.
    said = [re.sub(r"\*/", "* /", " ".join(text.split())) for text in texts if text]
    if len(said) < 2:
        return [f"{indent}/** {text} */" for text in said]
    return [f"{indent}/**", *(f"{indent} * {text}" for text in said), f"{indent} */"]


def type_text(type_: FieldType) -> str:
    """Return the TypeScript type of a field."""
    if type_.container != "single":
        if type_.kind in {"uint8", "char"}:
            return "Base64"
        return f"{type_text(type_.element)}[]"
    if type_.nested is not None:
        return dotted(type_name(type_.nested))
    if type_.kind in {"float32", "float64"}:
        return "Real"
    return {"bool": "boolean", "string": "string", "wstring": "string"}.get(type_.kind, "number")


def map_text(name: str, entries: Mapping[str, str], known: Mapping[str, Any]) -> str:
    """Return an interface that maps names to types."""
    lines = [
        f"  {json.dumps(key)}: {reference(known[entry])};"
        for key, entry in sorted(entries.items())
        if entry in known
    ]
    return "\n".join([f"export interface {name} {{", *lines, "}", ""])


def reference(cls: Any) -> str:
    """Return how a map refers to a class; services and actions are objects of their parts."""
    parts = {role.lower(): dotted(type_name(part)) for role, part in parts_of(cls).items()}
    if "" in parts:
        return parts[""]
    return f"{{ {'; '.join(f'{role}: {name}' for role, name in parts.items())} }}"
