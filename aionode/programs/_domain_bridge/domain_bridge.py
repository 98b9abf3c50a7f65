"""``domain_bridge domain_bridge``: passes topics from one domain id to another."""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections.abc import Mapping, Sequence
from contextlib import AsyncExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final

import aionode
from aionode import (
    Context,
    DurabilityPolicy,
    Duration,
    Node,
    Publisher,
    QoSProfile,
    ReliabilityPolicy,
    Subscription,
)
from aionode.arguments import remove_ros_args
from aionode.errors import AionodeError, escaped
from aionode.programs._domain_bridge.routes import Route, RouteError, domain_of, routes_in
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["Bridge", "bridges_for", "configured", "main"]

CHECK_SEC: Final = 0.1
CHECKS: Final = 5
"""The number of checks in a row that must find a publisher: others may follow the first one."""

MAX_GIDS: Final = 1000
MAX_WARNINGS: Final = 10


class Bridge:
    """Passes the messages of a topic from one domain to another, without decoding them.

    Args:
        route: The topic and its domains.
        source: The node in the domain with the publishers.
        target: The node in the domain with the subscriptions.
        is_mutual: Whether another bridge publishes on the topic in the first domain; its messages
            are not sent back.
    """

    def __init__(self, route: Route, source: Node, target: Node, *, is_mutual: bool) -> None:
        self.route = route
        self.source = source
        self.target = target
        self.is_mutual = is_mutual
        self.output: Publisher[Any] | None = None
        self.input: Subscription[bytes] | None = None
        self.seen = 0
        self.own: dict[bytes, bool] = {}
        self.warned: set[str] = set()

    async def check(self) -> None:
        """Create the bridge, or remove it, as publishers and subscriptions come and go."""
        route = self.route
        publishers = foreign(self.source.get_publishers_info_by_topic(route.topic), self.source)
        others = foreign(self.target.get_subscriptions_info_by_topic(route.renamed), self.target)
        is_wanted = (bool(publishers) or not route.waits_for_publisher) and (
            bool(others) or not route.waits_for_subscription
        )
        if self.output is not None:
            if route.is_removed and not is_wanted:
                self.remove()
            return
        self.seen = self.seen + 1 if is_wanted else 0
        if self.seen >= CHECKS:
            await self.make([each.qos_profile for each in publishers])

    async def make(self, offered: Sequence[QoSProfile]) -> None:
        """Create the publisher and the subscription."""
        route = self.route
        try:
            kind = await self.source.find_message(route.type_name)
        except (AionodeError, LookupError) as error:
            self.warn(f"{route.topic}: {error}")
            self.seen = -CHECKS  # every node of the type is asked: once a second is enough
            return
        qos = self.qos_for(offered)
        self.output = self.target.create_publisher(kind, route.renamed, qos)
        self.input = self.source.create_subscription(kind, route.topic, self.take, qos, raw=True)

    def remove(self) -> None:
        """Destroy the publisher and the subscription."""
        for entity in (self.input, self.output):
            if entity is not None:
                entity.destroy()
        self.input = self.output = None
        self.seen = 0

    def take(self, data: bytes, info: Any) -> None:
        """Pass a message on."""
        if self.output is None or (self.is_mutual and self.is_own(bytes(info["publisher_gid"]))):
            return
        self.output.publish(data)

    def is_own(self, gid: bytes) -> bool:
        """Return whether a publisher in the first domain belongs to the bridge."""
        if gid not in self.own:
            if len(self.own) >= MAX_GIDS:
                self.own.clear()
            self.own[gid] = any(
                bytes(each.endpoint_gid) == gid and is_of(each, self.source)
                for each in self.source.get_publishers_info_by_topic(self.route.topic)
            )
        return self.own[gid]

    def qos_for(self, offered: Sequence[QoSProfile]) -> QoSProfile:
        """Return a profile with the given policies, and others compatible with all publishers."""
        given = dict(self.route.qos)
        for name, strong, weak, words in (
            (
                "reliability",
                ReliabilityPolicy.RELIABLE,
                ReliabilityPolicy.BEST_EFFORT,
                ("'reliable' reliability", "'best effort' reliability"),
            ),
            (
                "durability",
                DurabilityPolicy.TRANSIENT_LOCAL,
                DurabilityPolicy.VOLATILE,
                ("'transient local' durability", "'volatile' durability"),
            ),
        ):
            found = {getattr(each, name) is strong for each in offered}
            if name in given or not found:
                continue
            if len(found) == 2:
                self.warn(
                    f"Some, but not all, publishers on topic '{self.route.topic}' on domain ID "
                    f"{self.route.source} offer {words[0]}. Falling back to {words[1]} in order to "
                    "connect to all publishers."
                )
            given[name] = strong if found == {True} else weak
        for name in ("deadline", "lifespan"):
            value = given.pop(name, -1)
            if value == "auto":
                if offered:
                    given[name] = max(getattr(each, name) for each in offered)
            elif value >= 0:
                given[name] = Duration(nanoseconds=value)
        return QoSProfile(**{"depth": 10} | given)

    def warn(self, text: str) -> None:
        """Warn once of each of the first problems; a check repeats them ten times a second."""
        if text not in self.warned and len(self.warned) < MAX_WARNINGS:
            self.warned.add(text)
            self.source.get_logger().warning(escaped(text, one_line=True))


def is_of(endpoint: Any, node: Node) -> bool:
    """Return whether an endpoint belongs to a node."""
    return (endpoint.node_namespace, endpoint.node_name) == (node.get_namespace(), node.get_name())


def foreign(endpoints: Sequence[Any], node: Node) -> list[Any]:
    """Return the endpoints of other nodes."""
    return [each for each in endpoints if not is_of(each, node)]


def bridges_for(routes: Sequence[Route], nodes: Mapping[int, Node]) -> list[Bridge]:
    """Return the bridges of topics, each once."""
    ways = {route.way: route for route in routes}
    ends = {(route.target, route.renamed) for route in ways.values()}
    return [
        Bridge(
            route,
            nodes[route.source],
            nodes[route.target],
            is_mutual=(route.source, route.topic) in ends,
        )
        for route in ways.values()
    ]


async def serve(name: str, routes: Sequence[Route]) -> None:
    """Pass messages until it is cancelled."""
    async with AsyncExitStack() as stack:
        nodes: dict[int, Node] = {}
        for domain in sorted({each for route in routes for each in (route.source, route.target)}):
            context = await stack.enter_async_context(Context(domain_id=domain))
            node = Node(
                f"{name}_{domain}",
                context=context,
                use_global_arguments=False,
                start_parameter_services=False,
            )
            nodes[domain] = await stack.enter_async_context(node)
        for bridge in bridges_for(routes, nodes):
            create_wall_timer(bridge.source, CHECK_SEC, bridge.check)
        await asyncio.Event().wait()


def parser() -> argparse.ArgumentParser:
    """Return the parser of the arguments."""
    result = argparse.ArgumentParser(prog="domain_bridge", description=__doc__)
    result.add_argument("configs", nargs="+", type=Path, metavar="YAML_CONFIG")
    for name in ("from", "to"):
        text = f"all data is bridged {name} this domain ID, whatever the YAML file says"
        result.add_argument(
            f"--{name}", type=int, metavar="DOMAIN_ID", dest=f"{name}_domain", help=text
        )
    for name, text in (
        ("wait-for-subscription", "wait for a subscription before bridging a topic"),
        ("wait-for-publisher", "wait for a publisher before bridging a topic; by default true"),
        ("auto-remove", "remove the bridge when its publishers or subscriptions are gone"),
    ):
        result.add_argument(f"--{name}", choices=("true", "false"), help=text)
    result.add_argument("--mode", choices=("normal",), help="messages are never compressed here")
    return result


def configured(words: Sequence[str]) -> tuple[str, list[Route]]:
    """Return the name of the bridge and its topics, according to the arguments.

    Raises:
        RouteError: The arguments cannot be used.
    """
    given = parser().parse_args(words)
    name, routes = "domain_bridge", list[Route]()
    for path in given.configs:
        found, more = routes_in(path)
        name, routes = found or name, routes + more
    changes: dict[str, Any] = {
        field: domain_of(value, option)
        for field, value, option in (
            ("source", given.from_domain, "--from"),
            ("target", given.to_domain, "--to"),
        )
        if value is not None
    } | {
        field: value == "true"
        for field, value in (
            ("waits_for_subscription", given.wait_for_subscription),
            ("waits_for_publisher", given.wait_for_publisher),
            ("is_removed", given.auto_remove),
        )
        if value is not None
    }
    routes = [way for route in routes for way in replace(route, **changes).ways()]
    if not routes:
        raise RouteError("there are no topics in the configuration")
    return name, routes


def main() -> None:
    """Pass messages until Ctrl-C.

    Raises:
        SystemExit: With status 1 if the configuration cannot be used, and 2 for the arguments.
    """
    try:
        name, routes = configured(remove_ros_args(sys.argv)[1:])
    except RouteError as error:
        sys.stderr.write(f"{error}\n")
        raise SystemExit(1) from None
    aionode.run(partial(serve, name, routes))
