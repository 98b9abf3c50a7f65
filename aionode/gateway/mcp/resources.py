"""Resources and the prompt: what a client may read of a robot without a tool."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import quote, unquote

import mcp_types as types
import msgspec

from aionode.errors import ToolError
from aionode.gateway.mcp.answers import MAX_BYTES, bounded
from aionode.gateway.mcp.collecting import Arrivals
from aionode.gateway.mcp.events import EVENTS, LOG, Events
from aionode.gateway.mcp.names import allowed, commands_of, limits_of, may, topic_of, user_names
from aionode.gateway.mcp.reading import type_description
from aionode.message import summarize

if TYPE_CHECKING:
    from aionode.gateway.session.session import Session

__all__ = ["PROMPT", "how_to_move", "read_resource", "resources_of", "templates"]

ABOUT: Final = "robot://about"
TOPIC: Final = "robot://topic"
TYPE: Final = "robot://type/"
JSON: Final = "application/json"

WAIT_SEC: Final = 5.0
"""The longest wait for a message of a topic, in seconds."""

PROMPT: Final = types.Prompt(
    name="how_to_move", description="How this robot moves, and what you may ask it to do."
)


def resources_of(session: Session) -> list[types.Resource]:
    """Return the resources that a client sees: the robot, its events, and each topic."""
    topics = [
        types.Resource(
            uri=TOPIC + quote(name), name=name, description=f"The next message, a {of[0]}.",
            mime_type=JSON,
        )
        for name, of in user_names(session)["topics"].items()
    ]  # fmt: skip
    return [
        types.Resource(uri=ABOUT, name="about", description="What this robot is.",
                       mime_type="text/plain"),
        types.Resource(uri=EVENTS, name="events", mime_type=JSON,
                       description="Recent events of the robot: its newest warnings."),
        *topics,
    ]  # fmt: skip


def templates() -> list[types.ResourceTemplate]:
    """Return the templates of resources."""
    return [
        types.ResourceTemplate(
            uri_template=f"{TYPE}{{package}}/{{kind}}/{{name}}", name="type", mime_type=JSON,
            description="The fields of a type, such as robot://type/geometry_msgs/msg/Twist.",
        )
    ]  # fmt: skip


async def read_resource(
    session: Session, uri: str, about: str, events: Events
) -> types.TextResourceContents:
    """Return a resource.

    Raises:
        ToolError: there is no resource with that address, or no message came.
        RefusedError: the policy does not allow reading it.
        InterfaceNotFoundError: nobody knows the type.
    """
    if uri == ABOUT:
        return types.TextResourceContents(uri=uri, text=about, mime_type="text/plain")
    values: dict[str, Any]
    if uri == EVENTS:
        events.follow_log()
        with_log = may(session, "subscribe", LOG, "rcl_interfaces/msg/Log")
        values = {"events": events.seen(with_log=with_log)}
    elif uri.startswith(TYPE):
        values = await type_description(session, uri.removeprefix(TYPE))
    elif uri.startswith(f"{TOPIC}/"):
        values = await newest(session, unquote(uri.removeprefix(TOPIC)))
    else:
        raise ToolError(uri[:200], "there is no such resource; list the resources", "not_found")
    text = msgspec.json.encode(bounded(values, 2 * MAX_BYTES)).decode()
    return types.TextResourceContents(uri=uri, text=text, mime_type=JSON)


async def newest(session: Session, name: str) -> dict[str, Any]:
    """Return the next message of a topic.

    Raises:
        ToolError: there is no such topic, or no message came.
    """
    topic = topic_of(session, name)
    arrivals = Arrivals(1)
    await session.subscribe(topic, frame=arrivals.put, key=arrivals, depth=1)
    try:
        async with asyncio.timeout(WAIT_SEC):
            return summarize((await arrivals.get()).message, MAX_BYTES)
    except TimeoutError:
        raise ToolError(topic, f"no message within {WAIT_SEC:g} s", "timeout") from None


def how_to_move(session: Session) -> str:
    """Return how the robot moves, according to what the policy lets a client do."""
    rights, lines = session.rights, []
    for topic, type_name in commands_of(session).items():
        limits = limits_of(rights.decision("publish", topic, type_name).rule)
        lines.append(f"- `move` repeats a command on {topic}, a {type_name}{limits}.")
    for kind, verb, word in (("actions", "goal", "goal to"), ("services", "call", "call of")):
        for name, type_name in allowed(session, kind).items():  # type: ignore[arg-type]  # one of both
            limits = limits_of(rights.decision(verb, name, type_name).rule)  # type: ignore[arg-type]
            lines.append(f"- a {word} {name}, a {type_name}{limits}.")
    what = "\n".join(lines) or "- nothing: you may only look."
    return (
        f"With this robot you may do the following.\n{what}\n\n"
        f"A move lasts {rights.limits.move_sec:g} s at most, a goal {rights.limits.goal_sec:g} s, "
        "and both end when their call is cancelled. Move in small steps, and look in between with "
        "`look`, `read` and `transform`. When something is wrong, call `stop`, which is always "
        "allowed, and then say so."
    )
