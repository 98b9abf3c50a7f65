"""What topics there are: the verbs list, info, type and find of ``aionode topic``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.formatting import endpoint_text, names_text
from aionode.graph import TOPIC_KINDS, EndpointKind

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.errors import CommandError
    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["find", "info", "list_topics", "type_of_topic"]


async def list_topics(
    node: Node,
    *,
    output: Output,
    types: bool = False,
    count: bool = False,
    hidden: bool = False,
    verbose: bool = False,
) -> None:
    """Print every topic that somebody publishes or subscribes to."""
    found = lookup.names_and_types(node, *TOPIC_KINDS, hidden=hidden)
    if count:
        output.item(str(len(found)), {"topics": len(found)})
        return
    numbers = {
        name: {kind: len(lookup.endpoints(node, kind, name=name)) for kind in TOPIC_KINDS}
        for name in found
    }
    if verbose and not output.json:
        output.text(verbose_text("Published", "publisher", EndpointKind.PUBLISHER, found, numbers))
        output.text(
            verbose_text("Subscribed", "subscriber", EndpointKind.SUBSCRIPTION, found, numbers)
        )
        return
    for name, of in found.items():
        output.item(
            f"{name} [{', '.join(of)}]" if types else name,
            {
                "name": name,
                "types": of,
                "publishers": numbers[name][EndpointKind.PUBLISHER],
                "subscriptions": numbers[name][EndpointKind.SUBSCRIPTION],
            },
        )


def verbose_text(
    title: str,
    word: str,
    kind: EndpointKind,
    found: dict[str, list[str]],
    numbers: dict[str, dict[EndpointKind, int]],
) -> str:
    """Return the topics that have endpoints of one kind, with their number."""
    text = f"{title} topics:\n"
    for name, types in found.items():
        if number := numbers[name][kind]:
            plural = "s" if number > 1 else ""
            text += f" * {name} [{', '.join(types)}] {number} {word}{plural}\n"
    return text


async def info(node: Node, topic_name: str, *, output: Output, verbose: bool = False) -> None:
    """Print the type of a topic and who uses it."""
    name = node.resolve_topic_name(topic_name)
    publishers = lookup.endpoints(node, EndpointKind.PUBLISHER, name=name)
    subscriptions = lookup.endpoints(node, EndpointKind.SUBSCRIPTION, name=name)
    if not (publishers or subscriptions):
        raise unknown_topic(node, "Unknown topic", topic_name)
    types = sorted({user.type_name for user in (*publishers, *subscriptions)})
    if output.json:
        output.item("", info_record(name, types, publishers, subscriptions, verbose=verbose))
        return
    end = "\n" if verbose else ""
    output.text(f"Type: {names_text(types)}{end}")
    for title, users in (("Publisher", publishers), ("Subscription", subscriptions)):
        output.text(f"{title} count: {len(users)}{end}")
        for user in users if verbose else ():
            output.text(f"{endpoint_text(user)}\n")


def info_record(
    name: str,
    types: list[str],
    publishers: list[EndpointInfo],
    subscriptions: list[EndpointInfo],
    *,
    verbose: bool,
) -> dict[str, Any]:
    """Return what is known of a topic as plain values."""
    record: dict[str, Any] = {"name": name, "types": types}
    for word, users in (("publishers", publishers), ("subscriptions", subscriptions)):
        record[word] = [endpoint_record(user) for user in users] if verbose else len(users)
    return record


def endpoint_record(user: EndpointInfo) -> dict[str, Any]:
    """Return an endpoint as plain values; times in nanoseconds."""
    profile = user.qos
    return {
        "node": user.node.fully_qualified_name,
        "type": user.type_name,
        "type_hash": user.type_hash,
        "gid": user.gid.hex(),
        "qos": {
            "reliability": profile.reliability.short_key,
            "history": profile.history.short_key,
            "depth": profile.depth,
            "durability": profile.durability.short_key,
            "lifespan_ns": profile.lifespan.nanoseconds,
            "deadline_ns": profile.deadline.nanoseconds,
            "liveliness": profile.liveliness.short_key,
            "liveliness_lease_duration_ns": profile.liveliness_lease_duration.nanoseconds,
        },
    }


async def type_of_topic(node: Node, topic_name: str, *, output: Output) -> None:
    """Print the type of a topic."""
    name = node.resolve_topic_name(topic_name)
    types = lookup.names_and_types(node, *TOPIC_KINDS, hidden=True).get(name)
    if types is None:
        raise unknown_topic(node, "Unknown topic", topic_name)
    for one in types:
        output.item(one, {"name": name, "type": one})


async def find(
    node: Node, message_type: str, *, output: Output, count: bool = False, hidden: bool = False
) -> None:
    """Print the topics of one type."""
    found = lookup.names_and_types(node, *TOPIC_KINDS, hidden=hidden)
    names = [name for name, types in found.items() if message_type in types]
    if count:
        output.item(str(len(names)), {"topics": len(names)})
        return
    for name in names:
        output.item(name, {"name": name, "types": found[name]})


def unknown_topic(node: Node, text: str, topic_name: str) -> CommandError:
    """Return the error for a topic that nobody uses."""
    names = lookup.names_and_types(node, *TOPIC_KINDS, hidden=True)
    return lookup.unknown(text, topic_name, names, "topic list")
