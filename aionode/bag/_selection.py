"""Selecting the topics to record or to play."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Collection

__all__ = ["ACTION_TOPICS", "CAUSES", "EVENT_SUFFIX", "Selection", "kind_of"]

CAUSES: Final = "/_aionode/causes"
"""The topic of the causes that a recorder has queried: it exists only in bags, and is not played.
"""

EVENT_SUFFIX: Final = "/_service_event"
ACTION: Final = "/_action/"
ACTION_TOPICS: Final = (
    "send_goal/_service_event",
    "cancel_goal/_service_event",
    "get_result/_service_event",
    "feedback",
    "status",
)
"""The topics that show what an action does, below ``<action>/_action/``."""


def kind_of(topic: str) -> tuple[str, str]:
    """Return ``topic``, ``service`` or ``action``, and the name of what a topic belongs to."""
    if ACTION in topic:
        return "action", topic.split(ACTION, maxsplit=1)[0]
    if topic.endswith(EVENT_SUFFIX):
        return "service", topic.removesuffix(EVENT_SUFFIX)
    return "topic", topic


@dataclass(frozen=True, slots=True)
class Selection:
    """A selection of topics, with rosbag2's options and semantics.

    Attributes:
        topics: Names of topics.
        services: Names of services, recorded through their introspection events.
        actions: Names of actions.
        types: Names of types.
        regex: Pattern for the names of further topics, services and actions to select.
        every: The kinds to select completely: ``topic``, ``service``, ``action``.
        exclude_regex: Pattern for names to exclude.
        exclude: Names of topics, services and actions to exclude.
        exclude_types: Names of types to exclude.
        hidden: Whether `every` includes hidden topics.
    """

    topics: Collection[str] = ()
    services: Collection[str] = ()
    actions: Collection[str] = ()
    types: Collection[str] = ()
    regex: str = ""
    every: Collection[str] = ()
    exclude_regex: str = ""
    exclude: Collection[str] = ()
    exclude_types: Collection[str] = ()
    hidden: bool = False

    def __post_init__(self) -> None:
        """Reject invalid regular expressions.

        Raises:
            BagError: one is invalid.
        """
        for text in (self.regex, self.exclude_regex):
            try:
                re.compile(text)
            except re.error as error:
                raise BagError(text, f"not a regular expression: {error}") from error

    def wants(self, topic: str, typename: str) -> bool:
        """Return whether a topic is selected."""
        kind, name = kind_of(topic)
        named = {"topic": self.topics, "service": self.services, "action": self.actions}[kind]
        if name in named or topic in self.topics:
            return True
        if name in self.exclude or topic in self.exclude or typename in self.exclude_types:
            return False
        if self.exclude_regex and re.search(self.exclude_regex, name):
            return False
        if typename in self.types:
            return True
        if kind == "topic" and not self.hidden and is_hidden(name):
            return False
        return kind in self.every or bool(self.regex and re.search(self.regex, name))


def is_hidden(name: str) -> bool:
    """Return whether a part of a name starts with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))
