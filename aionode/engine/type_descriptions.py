"""Answers requests for the definition of a type that a node uses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.wire.typehash import description_message, referenced_types, type_hash
from aionode.message import type_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

__all__ = ["describe_type", "type_of"]


def describe_type(
    used: Iterable[Any],
    request: Any,
    response: Any,
    own_message: Callable[[Any], Any] = lambda message: message,
) -> Any:
    """Return the response to a GetTypeDescription request.

    Args:
        used: The types of a node's entities.
        request: The request.
        response: The response, to be filled in.
        own_message: Converts a message to the class that the response uses.
    """
    classes = {
        type_hash(kind): kind for kind in with_nested(used) if type_name(kind) == request.type_name
    }
    kind = (
        classes.get(request.type_hash) if request.type_hash else next(iter(classes.values()), None)
    )
    if kind is None:
        response.failure_reason = (
            f"{request.type_name} has the hash {', '.join(classes)} here, not {request.type_hash}"
            if classes
            else f"{request.type_name} is not in use by this node"
        )
        return response
    response.successful = True
    response.type_description = own_message(description_message(kind))
    if request.include_type_sources:
        parts = (kind, *referenced_types(kind))
        response.type_sources = [own_message(source_of(part)) for part in parts]
    return response


def type_of(entity: Any) -> Any:
    """Return the type of a publisher, subscription, service or client."""
    return entity.msg_type if hasattr(entity, "msg_type") else entity.srv_type


def with_nested(used: Iterable[Any]) -> Iterator[Any]:
    """Yield the types, and those nested in them."""
    for kind in dict.fromkeys(used):
        yield kind
        yield from referenced_types(kind)


def source_of(kind: Any) -> Any:
    """Return the definition of a type as text."""
    # Imported on demand: rarely requested, and slow to import.
    from aionode.idl import definition_text
    from aionode.interfaces.type_description_interfaces.msg import TypeSource

    name = type_name(kind)
    return TypeSource(
        type_name=name,
        encoding=name.split("/")[1],
        raw_file_contents=definition_text(kind),
    )
