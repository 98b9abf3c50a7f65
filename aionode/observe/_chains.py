"""The causes of an item as lines of text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from aionode.errors import escaped

if TYPE_CHECKING:
    from aionode.observe._causes import Cause, Caused, Unknown, Why

__all__ = ["to_chains"]

ARROW: Final = " ← "

UNKNOWN: Final[dict[Unknown, str]] = {
    "no aionode": "ROS 2",
    "older": "an older version of aionode",
    "silent": "does not answer",
    "not kept": "keeps no causes",
    "not sent": "has sent nothing yet",
    "forgotten": "no longer kept",
    "above": "see above",
    "too far": "and so on",
    "hidden": "not yours to see",
}

KINDS: Final = {"request": "request of ", "response": "response of ", "goal": "goal of "}

REMEDY: Final = "start it with AIONODE_CAUSES=1, or with Context(causes=True)"


def to_chains(why: Why) -> str:
    """Return what led to an item as text: one chain per line, with a branch for several causes.

    Below it are the processes about which nothing is known, with a remedy.
    """
    lines = [line for sent in why.sent for line in chain(sent)]
    notes = {
        f"no causes are kept: {REMEDY}": why.not_kept,
        "no answer": why.silent,
        "an older version of aionode, which keeps no causes": why.older,
        "an answer that this version cannot read": why.unreadable,
    }
    lines += [
        f"{', '.join(nodes) or 'a process'}: {text}"
        for text, those in notes.items()
        for nodes in those.values()
    ]
    return "\n".join(escaped(line, one_line=True) for line in lines)


def chain(sent: Caused) -> list[str]:
    """Return the lines of a sent item."""
    first = what(sent)
    if len(sent.causes) == 1:
        rest = link(sent.causes[0])
        return [first + ARROW + rest[0], *rest[1:]]
    lines = [first]
    for number, cause in enumerate(sent.causes, 1):
        is_last = number == len(sent.causes)
        rest = link(cause)
        lines.append(("└─" if is_last else "├─") + ARROW + rest[0])
        lines += [("   " if is_last else "│  ") + line for line in rest[1:]]
    return lines


def link(cause: Cause) -> list[str]:
    """Return the lines of a cause and of what led to it."""
    node = cause.node.lstrip("/") or "a hidden node"
    if not cause.callback:
        first = f"{node} (awaited, sent {took(cause.ran_ns)} later)"
    else:
        times = f"run {took(cause.ran_ns)}, waited {took(cause.waited_ns)}"
        if cause.source is None:
            times = f"{cause.name if cause.party == 'timer' else 'silence'}, {times}"
        first = f"{node}.{cause.callback.rpartition('.')[2]} ({times})"
    if cause.source is None:
        return [first]
    rest = chain(cause.source)
    return [first + ARROW + rest[0], *rest[1:]]


def what(sent: Caused) -> str:
    """Return the description of a sent item, and when it was sent."""
    name = (
        f"start of {sent.name}"
        if sent.kind == "timer"
        else KINDS.get(sent.kind, "") + (sent.name or "something")
    )
    who = [sent.node.lstrip("/")] if sent.node and (sent.unknown or not sent.causes) else []
    who += [UNKNOWN[sent.unknown]] if sent.unknown else [] if sent.causes else ["not in a callback"]
    told = f" ({', '.join(who)})" if who else ""
    return f"{name}{told}" + ("" if sent.ago_ns is None else f" {took(sent.ago_ns)} ago")


def took(duration_ns: int) -> str:
    """Return a duration with a suitable unit and precision."""
    for unit, size in (("s", 1e9), ("ms", 1e6)):
        if duration_ns >= size:
            value = duration_ns / size
            return f"{value:.0f} {unit}" if value >= 10 else f"{value:.1f} {unit}"
    return f"{duration_ns / 1e3:.0f} us"
