"""The verbs list and info of ``aionode topic``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.cli._support.formatting import endpoint_text, names_text
from aionode.cli._support.nouns import TOPIC
from aionode.graph import TOPIC_KINDS, EndpointKind

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.graph import EndpointInfo
    from aionode.node import Node

__all__ = ["info", "list_topics"]


async def list_topics(
    node: Node,
    *,
    output: Output,
    types: bool = False,
    count: bool = False,
    hidden: bool = False,
    verbose: bool = False,
) -> None:
    """Print every topic that has a publisher or a subscription."""
    found = TOPIC.types_by_name(node, hidden=hidden)
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
    """Return the topics with endpoints of one kind, and how many."""
    text = f"{title} topics:\n"
    for name, types in found.items():
        if number := numbers[name][kind]:
            plural = "s" if number > 1 else ""
            text += f" * {name} [{', '.join(types)}] {number} {word}{plural}\n"
    return text


async def info(node: Node, topic_name: str, *, output: Output, verbose: bool = False) -> None:
    """Print the type of a topic, and its publishers and subscriptions.

    Raises:
        CommandError: the topic does not exist.
    """
    name = TOPIC.resolve(node, topic_name)
    publishers = lookup.endpoints(node, EndpointKind.PUBLISHER, name=name)
    subscriptions = lookup.endpoints(node, EndpointKind.SUBSCRIPTION, name=name)
    if not (publishers or subscriptions):
        raise TOPIC.unknown(node, topic_name)
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
    """Return the record of a topic."""
    record: dict[str, Any] = {"name": name, "types": types}
    for word, users in (("publishers", publishers), ("subscriptions", subscriptions)):
        record[word] = [endpoint_record(user) for user in users] if verbose else len(users)
    return record


def endpoint_record(user: EndpointInfo) -> dict[str, Any]:
    """Return the record of an endpoint; times are in nanoseconds."""
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
