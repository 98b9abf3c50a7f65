"""The graph, as the policy lets one caller see and use it."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import AionodeError
from aionode.gateway.http.openapi import Kind, Offer

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.session import Session

__all__ = ["may", "offers"]

DESCRIBED_SEC: Final = 5.0
"""How long to ask nodes for the types of a document, in seconds."""

VERBS: Final[dict[Kind, tuple[Verb, ...]]] = {
    "topic": ("subscribe", "publish"),
    "service": ("call",),
    "action": ("goal",),
}
"""The verbs of HTTP for topics, services and actions."""


def may(session: Session, verb: Verb, name: str, type_name: str) -> bool:
    """Return whether the policy lets the caller do something."""
    return session.rights.decision(verb, name, type_name).allowed


async def offers(session: Session, *, user_only: bool = True) -> list[Offer]:
    """Return the names that the caller may use, with the classes of their types.

    Args:
        session: The session of the caller.
        user_only: Whether to omit infrastructure.
    """
    found = session.graph.offered(user_only=user_only)
    graph: dict[Kind, dict[str, list[str]]] = {
        "topic": found.topics,
        "service": found.services,
        "action": found.actions,
    }
    used: list[tuple[Kind, str, str, frozenset[str]]] = []
    for kind, names in graph.items():
        for name, (type_name, *_) in sorted(names.items()):
            verbs = frozenset(verb for verb in VERBS[kind] if may(session, verb, name, type_name))
            if verbs:
                used.append((kind, name, type_name, verbs))
    classes = await classes_of(session, {(kind, type_name) for kind, _, type_name, _ in used})
    offered = [
        Offer(kind, name, verbs, classes.get(type_name)) for kind, name, type_name, verbs in used
    ]
    services = session.graph.services()
    for node in found.nodes:
        if f"{node}/list_parameters" in services:
            sets = may(session, "parameter", node, "")
            offered.append(Offer("node", node, frozenset({"parameter"} if sets else ())))
    return offered


async def classes_of(session: Session, types: set[tuple[Kind, str]]) -> dict[str, Any]:
    """Return the classes of types by name, omitting those that no node knows.

    The nodes are asked concurrently, for a few seconds in total.
    """
    ask = {
        "topic": session.message_class,
        "service": session.service_class,
        "action": session.action_class,
    }
    classes: dict[str, Any] = {}

    async def find(kind: Kind, type_name: str) -> None:
        with suppress(AionodeError):
            classes[type_name] = await ask[kind](type_name)

    with suppress(TimeoutError):
        async with asyncio.timeout(DESCRIBED_SEC), asyncio.TaskGroup() as tasks:
            for kind, type_name in types:
                tasks.create_task(find(kind, type_name))
    return classes
