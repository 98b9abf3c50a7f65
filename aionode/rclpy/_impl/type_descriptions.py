"""Answers questions for the definition of a type that a node uses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.message import type_name
from aionode.rclpy._impl.typesupport import aionode_class, message_support
from aionode.rclpy._rosidl import message_class
from aionode.wire import cdr
from aionode.wire.typehash import description_message, referenced_types, type_hash

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.message import Message

__all__ = ["describe"]


def describe(node: Any, request: Any, response: Any) -> Any:
    """Fill in the response to a GetTypeDescription request."""
    found: dict[str, Any] = {
        type_hash(kind): kind for kind in types_of(node) if type_name(kind) == request.type_name
    }
    kind = found.get(request.type_hash) if request.type_hash else next(iter(found.values()), None)
    if kind is None:
        response.successful = False
        response.failure_reason = (
            f"{request.type_name} has the hash {', '.join(found)} here, not {request.type_hash}"
            if found
            else f"{request.type_name} is not in use by this node"
        )
        return response
    response.successful = True
    response.type_description = in_class_of(response.type_description, description_message(kind))
    if request.include_type_sources:
        response.type_sources = [source_of(part) for part in (kind, *referenced_types(kind))]
    return response


def in_class_of(wanted: Any, message: Message) -> Any:
    """Return one of aionode's messages in the class that `wanted` has."""
    wanted_class: Any = type(wanted)
    return message_support(wanted_class).decode(cdr.encode(message))


def types_of(node: Any) -> Iterator[Any]:
    """Yield the types of a node's entities, and those nested in them, as aionode's classes."""
    kinds = [endpoint.msg_type for endpoint in (*node.publishers, *node.subscriptions)]
    kinds += [endpoint.srv_type for endpoint in (*node.services, *node.clients)]
    for kind in dict.fromkeys(aionode_class(kind) for kind in kinds):
        yield kind
        yield from referenced_types(kind)


def source_of(kind: Any) -> Any:
    """Return the definition of a type, as text."""
    from aionode.idl import definition_text  # rarely asked for

    name = type_name(kind)
    return message_class("type_description_interfaces/msg/TypeSource")(
        type_name=name,
        encoding=name.split("/")[1],
        raw_file_contents=definition_text(kind),
    )
