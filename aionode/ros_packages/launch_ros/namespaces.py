"""Names of nodes, and the namespaces that groups give them."""

from __future__ import annotations

from aionode.names import validate_namespace
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    text_of,
)

__all__ = ["is_absolute", "joined", "namespace_in", "text_or_none"]


def joined(base: str | None, namespace: str | None) -> str | None:
    """Join two namespaces, without a slash at the end; return None if both are None."""
    if namespace is None:
        combined = base
    elif not base or namespace.startswith("/"):
        combined = namespace
    else:
        combined = f"{base.rstrip('/')}/{namespace}"
    if combined is None or combined in {"", "/"}:
        return combined
    return combined.rstrip("/")


def text_or_none(context: LaunchContext, subs: SomeSubstitutionsType | None) -> str | None:
    """Return the text of substitutions, if there are any."""
    if subs is None:
        return None
    return text_of(context, subs)


def is_absolute(namespace: str) -> bool:
    """Return whether a namespace starts at the root."""
    return namespace.startswith("/")


def namespace_in(context: LaunchContext, given: str | None) -> str | None:
    """Return the absolute namespace of a node: the given one, below those pushed by groups.

    Raises:
        InvalidNamespaceException: It is not valid.
    """
    namespace = joined(context.launch_configurations.get("ros_namespace"), given)
    if namespace is None:
        return None
    if not is_absolute(namespace):
        namespace = f"/{namespace}"
    validate_namespace(namespace)
    return namespace
