"""Full names of topics."""

from __future__ import annotations

from aionode import names

__all__ = ["expand_topic_name"]


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the full name of a topic that a node would use, without remapping.

    Raises:
        InvalidTopicNameException, InvalidNodeNameException, InvalidNamespaceException: a name is
            invalid (ValueErrors).
    """
    names.validate_node_name(node_name)
    names.validate_namespace(node_namespace)
    return names.expand(topic_name, node_name, node_namespace)
