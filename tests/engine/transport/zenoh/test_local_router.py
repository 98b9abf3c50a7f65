"""This machine's router to static peers: which process opens it, and which replaces it."""

from __future__ import annotations

import asyncio
from contextlib import AsyncExitStack

import pytest
import zenoh  # noqa: TID251  # type of sessions

from aionode.engine.context import Context
from aionode.engine.transport.zenoh._transport import ZenohTransport
from aionode.engine.transport.zenoh.session import local_router
from aionode.engine.transport.zenoh.session.local_router import ROUTER_IDS
from aionode.engine.transport.zenoh.session.session import answering_ports
from aionode.errors import ConfigurationError
from tests.support.peers import ros_router
from tests.support.waiting import until

LIMIT_S = 15.0
FAR = "tcp/192.0.2.1:7447"
"""An address for documentation: nothing answers there."""


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Do not wait for peers that do not exist."""
    monkeypatch.setattr(local_router, "LINKED_S", 0.0)


def router_of(context: Context) -> zenoh.Session | None:
    """Return the router that a context has opened."""
    transport = context.transports[1]
    assert isinstance(transport, ZenohTransport)
    return transport._local_router._router


def port_of(context: Context) -> int:
    """Return the port of a router of this machine."""
    return context.network.router_port


async def test_the_first_process_with_static_peers_opens_a_router() -> None:
    """The next one finds it, and through it all others."""
    async with (
        Context(static_peers=[FAR]) as first,
        Context(static_peers=[FAR]) as second,
        Context(),
    ):
        assert answering_ports([port_of(first)])
        routers = [router_of(each) for each in (first, second)]

        assert routers[0] is not None
        assert routers[1] is None
        assert str(routers[0].zid()).startswith(ROUTER_IDS)
    assert not answering_ports([port_of(first)])


async def test_another_process_takes_the_place_of_one_that_ended() -> None:
    """No process is cut off for longer than a moment."""
    async with AsyncExitStack() as stack:
        first = await stack.enter_async_context(Context(static_peers=[FAR]))
        async with AsyncExitStack() as rest:
            second = await rest.enter_async_context(Context(static_peers=[FAR]))
            await stack.aclose()
            await until(lambda: router_of(second) is not None)
            assert answering_ports([port_of(first)])


async def test_beside_a_router_it_only_links_that_one() -> None:
    """Two routers that take the same peers could both carry a message, or neither."""
    router = await asyncio.to_thread(ros_router)
    try:
        async with Context(static_peers=[FAR]) as context:
            opened = router_of(context)
            assert opened is not None
            await until(lambda: list(opened.info.routers_zid()) == [router.zid()])
            assert not list(opened.info.peers_zid())
    finally:
        await asyncio.to_thread(router.close)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"static_peers": ["tcp/127.0.0.1:7999"]},
        {"static_peers": [FAR], "discovery_range": "OFF"},
    ],
)
async def test_without_peers_on_other_machines_there_is_no_router(
    options: dict[str, object],
) -> None:
    """Nothing listens without being requested."""
    async with Context(**options) as context:  # type: ignore[arg-type]
        assert router_of(context) is None
        assert not answering_ports([port_of(context)])


async def test_a_wrong_setting_is_an_error_and_leaves_nothing_open() -> None:
    """The session would have the same error."""
    with pytest.raises(ConfigurationError):
        async with Context(static_peers=[FAR], config={"no/such/key": 1}):
            pass
