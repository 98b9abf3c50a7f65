"""Linked nodes beside a router: messages go once, and sessions behind the router get all."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the router and who listens behind it, without aionode

from aionode.engine.transport.zenoh.connections.sockets import cut_participants
from aionode.engine.transport.zenoh.discovery import router_matching
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.session.settings import router_settings
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire.typehash import type_hash
from aionode.interfaces.std_msgs.msg import Int32
from tests.support.links import Counting, Two, folder, link_of, transport_of, two_nodes, writer_of
from tests.support.peers import (
    DOMAIN_ID,
    Collector,
    free_ports,
    ros_router,
    router_client,
    zenoh_config,
)
from tests.support.waiting import until

__all__ = ["folder"]  # a fixture

NUMBERS = data_key(DOMAIN_ID, "/n", "std_msgs/msg/Int32", type_hash(Int32))


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Query the router at once, without waiting between queries."""
    monkeypatch.setattr(router_matching, "SETTLE_S", 0.01)
    monkeypatch.setattr(router_matching, "AGAIN_S", 0.01)


@asynccontextmanager
async def router(settings: dict[str, Any] | None = None) -> AsyncIterator[zenoh.Session]:
    """A router like that of ROS, at the port of this test; or one of aionode's with `settings`."""
    if settings is None:
        session = await asyncio.to_thread(ros_router)
    else:
        session = await asyncio.to_thread(zenoh.open, zenoh_config(settings))
    try:
        yield session
    finally:
        await asyncio.to_thread(session.close)


def here() -> str:
    """Return the port of this machine's router."""
    return os.environ["AIONODE_ROUTER_PORT"]


def number_of(sample: Any) -> int:
    """Return the number that a plain session has received."""
    return cdr.decode(Int32, sample.payload.to_bytes()).data


class Linked:
    """Two linked nodes, and what the publisher's end of both routes passes to Zenoh."""

    def __init__(self, nodes: Two, numbers: Counting, monkeypatch: pytest.MonkeyPatch) -> None:
        self.nodes = nodes
        self.numbers = numbers
        self.over_zenoh = 0
        writer = writer_of(numbers.publisher)._zenoh
        assert isinstance(writer, ZenohWriter)
        write = writer.write

        def count(*arguments: Any) -> None:
            self.over_zenoh += 1
            write(*arguments)

        monkeypatch.setattr(writer, "write", count)

    @property
    def matching(self) -> router_matching.RouterMatching:
        """The state of the router matching in the publisher's context."""
        zenoh_transport: Any = transport_of(self.nodes.a).zenoh
        return zenoh_transport._router_matching  # type: ignore[no-any-return]  # it is private

    @property
    def router(self) -> router_matching.RouterSession:
        """The second session, which is connected to the router only."""
        (session,) = self.matching._routers.values()
        return session

    async def until_it_needs_zenoh(self, needed: bool) -> None:
        """Publish until messages go to Zenoh as well, or until they no longer do."""
        await self.numbers.go_until(
            lambda: writer_of(self.numbers.publisher).routes.update() == needed
        )

    async def until_zenoh_knows_others(self) -> None:
        """Wait until the sending session knows of a subscriber to all topics of the domain.

        The router informs the second session and this one separately.
        """
        zenoh_transport: Any = transport_of(self.nodes.a).zenoh
        publisher = zenoh_transport.session_state.session.declare_publisher(f"{DOMAIN_ID}/any")
        await until(lambda: publisher.matching_status.matching)
        publisher.undeclare()


@asynccontextmanager
async def linked(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Linked]:
    """Two nodes whose messages take only the link."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        both = Linked(nodes, numbers, monkeypatch)
        await both.until_it_needs_zenoh(False)
        yield both


async def test_linked_readers_beside_a_router_get_each_message_over_the_link_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The copy over Zenoh, which they would drop, costs more than half of what the link costs."""
    async with router(), linked(monkeypatch) as both:
        before = both.over_zenoh
        await both.numbers.go(100)

        assert both.over_zenoh == before
        assert list(both.numbers.publisher.stats.routes.values()) == ["link"]


@pytest.mark.parametrize("where", ["the router", "another router"])
async def test_a_plain_subscriber_behind_a_router_gets_the_next_message(
    where: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As soon as it subscribes, it gets each message once, as the linked reader does.

    It announces nothing, and cannot be seen from here.
    """
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(router())
        both = await stack.enter_async_context(linked(monkeypatch))
        port = here()
        if where == "another router":
            port = str(free_ports(1)[0])
            settings = router_settings([f"tcp/127.0.0.1:{port}"], [f"tcp/127.0.0.1:{here()}"])
            await stack.enter_async_context(router(settings))
        session = stack.enter_context(router_client(port))
        samples, numbers = Collector(), both.numbers
        subscriber = session.declare_subscriber(f"{DOMAIN_ID}/**", samples)
        await both.until_it_needs_zenoh(True)
        await both.until_zenoh_knows_others()
        first = numbers.next
        await numbers.go(100)
        await samples.have(100)
        subscriber.undeclare()
        await both.until_it_needs_zenoh(False)

        heard = [number_of(sample) for sample in samples.items]
        assert heard[:100] == list(range(first, first + 100))
        assert heard == list(range(first, first + len(heard)))
        assert numbers.subscription.stats.lost == 0


async def test_a_router_that_cannot_tell_who_listens_is_taken_to_have_listeners(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The session with it is cut; both routes are then used until there is a new one."""
    async with router(), linked(monkeypatch) as both:
        before = both.router
        assert before.session is not None
        cut_participants(before.session, {before.zid})
        await both.until_it_needs_zenoh(True)
        await both.until_it_needs_zenoh(False)

        assert both.router.session is not before.session


@pytest.mark.slow
async def test_a_router_that_comes_back_is_asked_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is a different one, behind which other sessions may subscribe."""
    async with router(), linked(monkeypatch) as both:
        pass
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        both = Linked(nodes, numbers, monkeypatch)
        await both.until_it_needs_zenoh(False)
        for _ in range(2):
            async with router():
                await both.until_it_needs_zenoh(True)
                await both.until_it_needs_zenoh(False)
                assert both.router.excludes(NUMBERS)
            await numbers.go_until(lambda: not both.matching._routers)


async def test_a_stream_whose_link_ends_beside_a_router_loses_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The subscription stays subscribed over Zenoh all the time."""
    async with router(), linked(monkeypatch) as both:
        numbers = both.numbers
        numbers.publish(50)
        link_of(both.nodes.a).close()
        numbers.publish(50)
        received = [(await numbers.subscription.receive()).data for _ in range(100)]
        await numbers.until_linked()
        await both.until_it_needs_zenoh(False)

        assert received == list(range(received[0], received[0] + 100))
        assert numbers.subscription.stats.lost == 0


async def test_the_router_is_told_when_a_publisher_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its key is no longer of interest; when the context closes, so does the second session."""
    async with router() as session:
        async with linked(monkeypatch) as both:
            there = both.router
            both.numbers.publisher.destroy()

            assert not there.known
            assert not there.declared
            assert not both.matching._asked
        # # the router learns of it after a moment
        await until(lambda: not session.info.transports())


async def test_the_router_is_not_asked_for_its_admin_space(monkeypatch: pytest.MonkeyPatch) -> None:
    """Querying it could deadlock; the declarations are enough."""
    asked: list[object] = []
    async with router():
        with router_client(here()) as session:
            session.declare_queryable("@/**", asked.append)
            session.declare_subscriber("@/**", asked.append)
            async with linked(monkeypatch):
                list(session.get("@/none", timeout=1))

    assert len(asked) == 1
