"""The cost of an endpoint does not depend on the number of others."""

from __future__ import annotations

import asyncio
import sys
from collections import defaultdict
from functools import partial
from statistics import median
from typing import TYPE_CHECKING, Any

import pytest
from msgspec.structs import replace

from aionode.engine.transport.link._manager import LinkManager
from aionode.engine.transport.link._protocol import Open, Opened, Switched
from aionode.graph import EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from aionode.testing import local_context
from tests.support.arrivals import writers_of
from tests.support.links import Counting, folder, link_of, manager_of, transport_of, two_nodes

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.link._connection import Connection
    from aionode.engine.transport.link._protocol import Control
    from aionode.graph import EndpointInfo

__all__ = ["folder"]  # a fixture


def calls_of(work: Callable[[], Any]) -> int:
    """Return how many functions are called, including those in C."""
    count = 0

    def note(_frame: object, event: str, _arg: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def costs(node: Node, count: int) -> tuple[list[int], list[int]]:
    """Return how many calls it takes to create each of many pairs, and to destroy each."""
    pairs: list[tuple[Any, Any]] = []

    def make() -> None:
        number = len(pairs)
        publisher = node.create_publisher(Int32, f"t{number}", 10)
        pairs.append((publisher, node.create_subscription(Int32, f"t{number}", lambda _: None, 10)))

    def destroy() -> None:
        for endpoint in pairs.pop():
            endpoint.destroy()

    return [calls_of(make) for _ in range(count)], [calls_of(destroy) for _ in range(count)]


async def test_making_and_destroying_endpoints_of_one_process_is_linear() -> None:
    """No other endpoint is looked at."""
    async with Node("n", context=local_context()) as node:
        made, destroyed = costs(node, 200)

    assert median(made[-20:]) <= median(made[10:30]) + 10  # numbers with more digits
    assert median(destroyed[:20]) <= median(destroyed[-30:-10]) + 10


@pytest.mark.slow
async def test_making_and_destroying_endpoints_beside_links_is_linear() -> None:
    """No other endpoint of this process is looked at."""
    async with asyncio.timeout(30), two_nodes() as nodes:
        made, destroyed = costs(nodes.a, 100)

    assert median(made[-20:]) <= median(made[10:30]) + 20
    assert median(destroyed[:20]) <= median(destroyed[-30:-10]) + 20


async def test_a_subscription_of_another_process_concerns_publishers_of_its_name_only() -> None:
    """Otherwise its cost would grow with the number of publishers here."""
    async with asyncio.timeout(30), two_nodes() as nodes:
        near = nodes.a.create_publisher(Int32, "near", 10)
        far = [nodes.a.create_publisher(Int32, f"far{number}", 10) for number in range(20)]
        asked: list[str] = []

        def note(name: str) -> Callable[[], None]:
            return lambda: asked.append(name)

        for publisher in (near, *far):
            writer: Any = writers_of(publisher)[1]
            writer.routes.reconsider = note(publisher.topic_name)
        nodes.b.create_subscription(Int32, "near", None, 10)
        await near.wait_for_subscribers()
        assert set(asked) == {near.topic_name}


async def test_a_subscription_of_another_context_costs_the_same_beside_many() -> None:
    """Otherwise the cost of one topic would grow with the cube of its endpoints."""
    async with asyncio.timeout(30), two_nodes() as nodes:
        publisher = nodes.a.create_publisher(Int32, "many", 10)
        state = transport_of(nodes.a).zenoh.session_state  # type: ignore[attr-defined]  # Zenoh's
        state.acknowledgements.participants.add("f00")
        other = NodeInfo("f00", 0, "other", "/")
        (endpoint,) = nodes.a.graph.endpoints(EndpointKind.PUBLISHER, name="/many")
        readers = [
            replace(
                endpoint,
                kind=EndpointKind.SUBSCRIPTION,
                node=other,
                endpoint_id=number,
                gid=number.to_bytes(16, "little"),
            )
            for number in range(1, 101)
        ]

        def come(reader: EndpointInfo) -> None:
            nodes.a.graph.add_endpoint(reader)
            state.tell_writers(reader, present=True)

        def go(reader: EndpointInfo) -> None:
            nodes.a.graph.remove_endpoint(reader)
            state.tell_writers(reader, present=False)

        came = [calls_of(partial(come, reader)) for reader in readers]
        assert publisher.get_subscription_count() == len(readers)
        gone = [calls_of(partial(go, reader)) for reader in readers]

    assert median(came[-20:]) <= median(came[10:30]) + 5
    assert median(gone[:20]) <= median(gone[-30:-10]) + 5


async def test_handing_subscriptions_over_to_a_link_costs_the_same_beside_many(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It used to take 10 to 52 s with 3000 endpoints of another process."""
    costs: dict[type, list[int]] = defaultdict(list)
    on_control = LinkManager.on_control

    def counted(self: LinkManager, connection: Connection, control: Control) -> None:
        cost = calls_of(lambda: on_control(self, connection, control))
        costs[type(control)].append(cost)

    async with asyncio.timeout(30), two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        monkeypatch.setattr(LinkManager, "on_control", counted)
        nodes.a.create_publisher(Int32, "many", 10)
        for _ in range(100):
            nodes.b.create_subscription(Int32, "many", lambda _: None, 10)
        while len(costs[Switched]) < 100:
            await numbers.go()

    for kind in (Open, Opened, Switched):
        assert median(costs[kind][-20:]) <= median(costs[kind][10:30]) + 5


async def test_a_link_to_many_endpoints_looks_at_each_of_them_once() -> None:
    """The link comes up when thousands are already known."""
    async with asyncio.timeout(30), two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        links, link = manager_of(nodes.b), link_of(nodes.b)
        looks: list[int] = []
        for count in (40, 80):
            for number in range(count // 2):
                nodes.a.create_publisher(Int32, f"t{count}_{number}", 10)
                nodes.b.create_subscription(Int32, f"t{count}_{number}", lambda _: None, 10)
            while len(link.receivers.handlers) < (61 if looks else 21):
                await numbers.go()
            looks.append(calls_of(lambda: links._open_publishers(link)))

    assert looks[1] <= 3.2 * looks[0]  # 60 of them after 20
