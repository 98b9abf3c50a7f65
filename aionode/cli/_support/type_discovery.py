"""Types without a local definition, built from the descriptions of the nodes that use them.

A node with ``~/get_type_description`` describes its types. A class built from a description is
accepted if it has the type hash that the graph shows; behind a bridge, it may show none.
"""

from __future__ import annotations

from types import new_class
from typing import TYPE_CHECKING, Annotated, Any

from aionode.errors import AionodeError
from aionode.graph import EndpointKind
from aionode.message import FieldType, Message, ServiceType

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["fetch_type", "type_from"]

ANSWER_S = 2.0
"""Timeout for a type description, in seconds; normally it takes milliseconds."""

KINDS = {
    1: "message",
    2: "int8",
    3: "uint8",
    4: "int16",
    5: "uint16",
    6: "int32",
    7: "uint32",
    8: "int64",
    9: "uint64",
    10: "float32",
    11: "float64",
    13: "char",
    15: "bool",
    16: "byte",
    17: "string",
    18: "wstring",
    21: "string",
    22: "wstring",
}
CONTAINERS = ("single", "array", "bounded", "unbounded")
PLACEHOLDER = "structure_needs_at_least_one_member"


async def fetch_type(node: Node, user: EndpointInfo) -> Any | None:
    """Return the class of an endpoint's type, or None if its node does not describe it."""
    from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
    from aionode.wire.typehash import type_hash

    service = f"{user.node.fully_qualified_name}/get_type_description"
    if not node.graph.count(EndpointKind.SERVER, service):
        return None
    client = node.create_client(GetTypeDescription, service)
    request = GetTypeDescription.Request(type_name=user.type_name, type_hash=user.type_hash)
    try:
        response: Any = await client.call(request, timeout_sec=ANSWER_S)
    except AionodeError:
        return None  # the caller reports it, with the other ways to provide the type
    finally:
        client.destroy()
    if not response.successful:
        return None
    try:
        made = type_from(response.type_description)
    except (LookupError, TypeError, ValueError, RecursionError):
        return None  # the description is invalid
    return made if user.type_hash in {"", type_hash(made)} else None


def type_from(description: Any) -> Any:
    """Return the message or service class that a ``TypeDescription`` describes.

    Raises:
        LookupError, TypeError, ValueError, RecursionError: the description is invalid.
    """
    main = description.type_description
    parts = {part.type_name: part for part in (main, *description.referenced_type_descriptions)}
    made: dict[str, type[Message]] = {}
    name: str = main.type_name
    if "/srv/" in name and f"{name}_Request" in parts:
        halves = {half: message(f"{name}_{half}", parts, made) for half in ("Request", "Response")}
        return new_class(
            name.rpartition("/")[2],
            (ServiceType,),
            {"typename": name},
            lambda namespace: namespace.update({"__doc__": f"{name}, as described.", **halves}),
        )
    return message(name, parts, made)


def message(name: str, parts: dict[str, Any], made: dict[str, type[Message]]) -> type[Message]:
    """Return the class of one message, created on the first call."""
    if name not in made:
        annotations = {
            field.name: Annotated[Any, field_type(field.type, parts, made)]
            for field in parts[name].fields
            if field.name != PLACEHOLDER
        }
        body = {"__annotations__": annotations, "__doc__": f"{name}, as described by a node."}
        made[name] = new_class(
            name.rpartition("/")[2],
            (Message,),
            {"typename": name},
            lambda namespace: namespace.update(body),
        )
    return made[name]


def field_type(type_: Any, parts: dict[str, Any], made: dict[str, type[Message]]) -> FieldType:
    """Return the type of a field; its `type_id` encodes both kind and container."""
    container, kind = divmod(type_.type_id, 48)
    nested = message(type_.nested_type_name, parts, made) if kind == 1 else None
    return FieldType(
        KINDS[kind],
        nested,
        type_.string_capacity or None,
        CONTAINERS[container],  # type: ignore[arg-type]  # one of the four words
        type_.capacity if container in {1, 2} else 0,
    )
