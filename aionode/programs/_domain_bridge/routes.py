"""The configuration of a domain_bridge: which topics go where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import yaml

from aionode import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import composed_yaml, value_of_node
from aionode.errors import AionodeError
from aionode.names import resolve

__all__ = ["Route", "RouteError", "domain_of", "routes_in"]

MAX_DOMAIN: Final = 232
"""The highest domain id for which DDS has ports."""

MAX_NUMBER: Final = 2**63 - 1
"""The longest duration, in nanoseconds."""

POLICIES: Final[dict[str, dict[str, Any]]] = {
    "reliability": {
        "reliable": ReliabilityPolicy.RELIABLE,
        "best_effort": ReliabilityPolicy.BEST_EFFORT,
    },
    "durability": {
        "volatile": DurabilityPolicy.VOLATILE,
        "transient_local": DurabilityPolicy.TRANSIENT_LOCAL,
    },
    "history": {"keep_last": HistoryPolicy.KEEP_LAST, "keep_all": HistoryPolicy.KEEP_ALL},
}


class RouteError(ValueError):
    """A configuration cannot be used; the text says why."""


@dataclass(frozen=True)
class Route:
    """A topic on its way from one domain to another.

    Attributes:
        topic: Its name.
        type_name: Its type, such as ``std_msgs/msg/String``.
        source: The domain with its publishers.
        target: The domain with its subscriptions.
        renamed: Its name in the target.
        qos: The given policies; the others follow the publishers.
        is_reversed: Whether messages go from the target to the source.
        is_bidirectional: Whether messages go both ways.
        waits_for_publisher: Whether to create the bridge only when there is a publisher.
        waits_for_subscription: Whether to create the bridge only when there is a subscription.
        is_removed: Whether the bridge ends when the awaited publishers or subscriptions are gone.
    """

    topic: str
    type_name: str
    source: int
    target: int
    renamed: str
    qos: Mapping[str, Any] = field(default_factory=dict)
    is_reversed: bool = False
    is_bidirectional: bool = False
    waits_for_publisher: bool = True
    waits_for_subscription: bool = False
    is_removed: bool = False

    @property
    def way(self) -> tuple[str, str, int, int, str]:
        """The values that distinguish it from other routes."""
        return self.topic, self.type_name, self.source, self.target, self.renamed

    def ways(self) -> list[Route]:
        """Return one route for each of its directions.

        Raises:
            RouteError: The source and the target are the same domain.
        """
        if self.source == self.target:
            raise RouteError(
                f"Cannot bridge topic '{self.topic}' from domain {self.source} to domain "
                f"{self.target}. Domain IDs must be different."
            )
        back = replace(self, source=self.target, target=self.source)
        if self.is_bidirectional:
            return [self, back]
        return [back if self.is_reversed else self]


def routes_in(path: Path) -> tuple[str | None, list[Route]]:
    """Read a configuration: the name of the bridge, and the topics.

    Raises:
        RouteError: It cannot be used.
    """
    try:
        return parsed(composed_yaml(read_file(path)))
    except (OSError, yaml.YAMLError, AionodeError, ValueError) as error:
        raise RouteError(f"error parsing the file '{path}': {error}") from None


def parsed(node: Any) -> tuple[str | None, list[Route]]:
    """Return the name and the topics in a configuration; a topic may occur more than once.

    Raises:
        RouteError: It cannot be used.
    """
    if not isinstance(node, yaml.MappingNode):
        raise RouteError("expected a map with 'topics'")
    whole = {str(value_of_node(key)): value for key, value in node.value}
    topics = whole.pop("topics", None)
    default = {key: value_of_node(value) for key, value in whole.items()}
    if default.get("mode", "normal") != "normal":
        raise RouteError(f"mode {default['mode']!r} is not available here; use 'normal'")
    if topics is not None and not isinstance(topics, yaml.MappingNode):
        raise RouteError("expected map value for 'topics'")
    routes = [
        route_of(str(value_of_node(key)), value_of_node(value), default)
        for key, value in ([] if topics is None else topics.value)
    ]
    name = default.get("name")
    return None if name is None else str(name), routes


def route_of(topic: str, given: Any, default: Mapping[str, Any]) -> Route:
    """Return the route of a topic.

    Raises:
        RouteError: A value is missing or invalid.
    """
    if not isinstance(given, dict):
        raise RouteError("expected map value for each topic")
    if not isinstance(given.get("type"), str):
        raise RouteError(f"missing 'type' for topic '{topic}'")
    source, target = (
        domain_of(given.get(key, default.get(key)), f"'{key}' of topic '{topic}'")
        for key in ("from_domain", "to_domain")
    )
    full = resolve(topic, "domain_bridge", "/")
    renamed = resolve(str(given.get("remap") or topic), "domain_bridge", "/")
    qos = policies_in(given.get("qos", {}))
    return Route(
        full,
        given["type"],
        source,
        target,
        renamed,
        qos,
        is_reversed=bool(given.get("reversed")),
        is_bidirectional=bool(given.get("bidirectional")),
    )


def domain_of(value: Any, what: str) -> int:
    """Return a domain id.

    Raises:
        RouteError: The value is not a domain id.
    """
    if type(value) is int and 0 <= value <= MAX_DOMAIN:
        return value
    raise RouteError(f"{what} is {value!r}; use a domain id from 0 to {MAX_DOMAIN}")


def policies_in(given: Any) -> dict[str, Any]:
    """Return the policies of a topic.

    Raises:
        RouteError: There is no such policy, or it has no such value.
    """
    if not isinstance(given, dict):
        raise RouteError("expected map value for 'qos'")
    found: dict[str, Any] = {}
    for name, value in given.items():
        number = value if type(value) is int and value <= MAX_NUMBER else None
        if isinstance(value, str) and value in POLICIES.get(name, {}):
            found[name] = POLICIES[name][value]
        elif (name == "depth" and (number or 0) > 0) or (
            name in ("deadline", "lifespan") and (number is not None or value == "auto")
        ):
            found[name] = value
        elif name != "liveliness" or value not in ("automatic", "system_default"):
            raise RouteError(f"unsupported {name} policy value {value!r}")
    return found
