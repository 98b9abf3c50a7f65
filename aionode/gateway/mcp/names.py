"""The robot's names without infrastructure, and the names of the tools made from them."""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING, Any, Final, Literal

from aionode.errors import ToolError
from aionode.gateway.mcp.arguments import meant

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.session import Session

__all__ = ["MAX_CHARACTERS", "allowed", "commands_of", "limits_of", "may", "rights"]
__all__ += ["tool_name", "topic_of", "user_names"]

MAX_CHARACTERS: Final = 40
"""The longest name of a tool: some clients cut names at 64 characters, including a prefix of their
own."""

DIGITS: Final = 8
"""Digits of the hash at the end of a name that would be longer."""

VERBS: Final[dict[str, tuple[Verb, ...]]] = {
    "topic": ("subscribe", "publish"),
    "service": ("call",),
    "action": ("goal",),
}


def user_names(session: Session) -> dict[str, dict[str, list[str]]]:
    """Return the names that a client sees, without infrastructure, and their types."""
    offered = session.graph.offered()
    return {
        "nodes": {name: [] for name in offered.nodes},
        "topics": offered.topics,
        "services": offered.services,
        "actions": offered.actions,
    }


def may(session: Session, verb: Verb, name: str, type_name: str) -> bool:
    """Return whether the policy lets the client do something."""
    return session.rights.decision(verb, name, type_name).allowed


def rights(
    session: Session, kind: Literal["topic", "service", "action"], name: str, type_name: str
) -> list[str]:
    """Return what the client may do with a name, and within which limits."""
    found = []
    for verb in VERBS[kind]:
        decision = session.rights.decision(verb, name, type_name)
        if decision.allowed:
            word = "move" if decision.lease is not None else verb
            found.append(word + limits_of(decision.rule))
    return found


def limits_of(rule: Any) -> str:
    """Return the limits of a rule in words, in brackets; empty without any."""
    if rule is None:
        return ""
    parts = [
        f"{path} from {limit.min:g} to {limit.max:g}"
        + (", other values are replaced by the nearest" if limit.outside == "clamp" else "")
        for path, limit in rule.fields.items()
    ]
    if rule.rate_hz < float("inf"):
        parts.append(f"at most {rule.rate_hz:g} times a second")
    if rule.ask:
        parts.append("a person is asked each time")
    return f" ({'; '.join(parts)})" if parts else ""


def allowed(session: Session, kind: Literal["services", "actions"]) -> dict[str, str]:
    """Return the services or actions that a client may use, with their types."""
    verb: Literal["call", "goal"] = "call" if kind == "services" else "goal"
    return {
        name: types_of[0]
        for name, types_of in user_names(session)[kind].items()
        if may(session, verb, name, types_of[0])
    }


def commands_of(session: Session) -> dict[str, str]:
    """Return the topics on which a client may command a motion, with their types."""
    found = {}
    for topic, types_of in user_names(session)["topics"].items():
        decision = session.rights.decision("publish", topic, types_of[0])
        if decision.allowed and decision.lease is not None:
            found[topic] = types_of[0]
    return found


def topic_of(session: Session, name: str) -> str:
    """Return the full name of an existing topic.

    Raises:
        ToolError: there is none, or the client may not see it.
        InvalidTopicNameException: it is not a valid name (a ValueError).
    """
    topic = session.topic_name(name)
    if not session.graph.types_of(topic, "topic"):
        known = user_names(session)["topics"]
        raise ToolError(
            topic[:200], f"the robot has no such topic{meant(topic, known)}", "not_found"
        )
    return topic


def tool_name(verb: str, name: str) -> str:
    """Return the name of the tool for a service or action: always the same, and unique.

    A slash becomes a hyphen, which no ROS name contains. A name that is too long ends in a hash.
    """
    plain = f"{verb}_{name.removeprefix('/').replace('/', '-')}"
    if len(plain) <= MAX_CHARACTERS and re.fullmatch(r"[A-Za-z0-9_-]+", plain):
        return plain
    digest = hashlib.sha256(name.encode()).hexdigest()[:DIGITS]
    kept = re.sub(r"[^A-Za-z0-9_-]", "_", plain)[: MAX_CHARACTERS - DIGITS - 1]
    return f"{kept}-{digest}"
