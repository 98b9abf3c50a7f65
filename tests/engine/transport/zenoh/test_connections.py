"""The connections of a session, shared by all parts of a context."""

from __future__ import annotations

import asyncio
import os
import sys
from contextlib import closing
from typing import Any

import pytest
import zenoh  # noqa: TID251  # tells of connections, as Zenoh does

from aionode.clock import perf_ns
from aionode.engine.context import Context
from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.network import network_from
from aionode.engine.transport.zenoh._defects.early_connections import waits_for_link
from aionode.engine.transport.zenoh.connections import connections as _connections
from aionode.engine.transport.zenoh.connections.connections import (
    MOMENT_NS,
    QUIET_S,
    QUIETS,
    ConnectionChange,
    Connections,
)
from aionode.engine.transport.zenoh.session.local_sessions import announce
from tests.support.connections import tell, tell_early

pytestmark = pytest.mark.one_loop


@pytest.fixture
def connections() -> Connections:
    """Return those of a session that is not open."""
    return Connections(LoopWaker(), waits_for_link)


async def test_a_peer_that_was_lost_and_is_connected_again_has_returned(
    connections: Connections,
) -> None:
    """A new peer has not: its tokens are still in transit."""
    told: list[ConnectionChange] = []
    connections.on_change.append(told.append)
    tell(connections, "b2", is_made=True)
    tell(connections, "b2", is_made=False)
    assert (connections.kinds, connections.lost) == ({}, {"b2"})
    tell(connections, "b2", is_made=True)

    assert [(change.is_made, change.is_return) for change in told] == [
        (True, False),
        (False, False),
        (True, True),
    ]
    assert (set(connections.kinds), connections.lost) == ({"b2"}, set())


async def test_a_connection_counts_once_its_link_is_reported(connections: Connections) -> None:
    """Before that, Zenoh answers queries for tokens without asking the peer."""
    tell_early(connections, "b2", is_made=True)
    assert not connections.kinds
    connections.take("b2")

    assert connections.kinds == {"b2": zenoh.WhatAmI.PEER}


async def test_a_connection_that_ends_before_its_link_is_reported_never_was(
    connections: Connections,
) -> None:
    """Nobody was told of it, so nothing is lost; the link may be reported afterwards."""
    told: list[ConnectionChange] = []
    connections.on_change.append(told.append)
    tell_early(connections, "b2", is_made=True)
    tell_early(connections, "b2", is_made=False)
    connections.take("b2")

    assert (told, connections.kinds, connections.lost) == ([], {}, set())


async def test_a_client_that_leaves_is_not_lost(connections: Connections) -> None:
    """It dials by itself, and nobody else can dial it."""
    tell(connections, "c3", zenoh.WhatAmI.CLIENT, is_made=True)
    tell(connections, "c3", zenoh.WhatAmI.CLIENT, is_made=False)

    assert not connections.lost


async def test_a_change_is_known_before_it_is_told(connections: Connections) -> None:
    """Each part of a context may rely on what the others see."""
    seen: list[bool] = []
    connections.on_change.append(lambda change: seen.append(change.zid in connections.kinds))
    tell(connections, "b2", is_made=True)
    tell(connections, "b2", is_made=False)

    assert seen == [True, False]


async def test_lost_sessions_are_remembered_up_to_a_limit(
    connections: Connections, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Any process may open and close any number of sessions."""
    monkeypatch.setattr(_connections, "REMEMBERED", 3)
    for number in range(20):
        tell(connections, f"a{number}", is_made=False)
        assert len(connections.lost) <= 3


async def test_a_connection_that_is_made_anew_at_once_was_lost_all_the_same(
    connections: Connections,
) -> None:
    """Tokens that vanished with it may still have to return."""
    for is_made in (True, False, True):
        tell(connections, "b2", is_made=is_made)

    assert connections.has_lost("b2")
    assert not connections.has_lost("a1")


async def test_tokens_that_vanish_long_after_a_loss_were_withdrawn(
    connections: Connections, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Their session is connected again, and has withdrawn something itself."""
    for is_made in (False, True):
        tell(connections, "b2", is_made=is_made)
    now_ns = perf_ns() + MOMENT_NS
    monkeypatch.setattr(_connections, "perf_ns", lambda: now_ns)

    assert not connections.has_lost("b2")


@pytest.mark.parametrize(("others", "waits"), [(2, False), (3, True), (None, True)])
async def test_no_further_peer_is_waited_for_when_all_are_connected(
    others: int | None, waits: bool, connections: Connections, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each start of a process took 15 ms longer, although the machine lists its sessions."""
    limits: list[float] = []
    limit = asyncio.timeout

    def note(delay_s: float) -> asyncio.Timeout:
        limits.append(delay_s)
        return limit(delay_s)

    monkeypatch.setattr(asyncio, "timeout", note)
    for zid in ("a1", "b2"):
        tell(connections, zid, is_made=True)
    await connections.wait_until_connected(1, others)

    assert (QUIET_S in limits) is waits


@pytest.mark.parametrize(
    ("expected", "others"),
    [(1, 2), (1, 1), (0, 1), (1, None)],
    ids=["too few", "one is a client", "at no meeting port", "beside a router"],
)
async def test_a_listed_peer_is_waited_for_though_others_are_quiet(
    expected: int, others: int | None, connections: Connections, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With 30 processes and a load of 10, three of five starts knew 21 to 28 of them."""
    monkeypatch.setattr(_connections, "QUIET_S", 0.0)
    looks = iter([True] * (QUIETS // 2) + [False] * 3)
    tell(connections, "c3", zenoh.WhatAmI.CLIENT, is_made=True)
    await connections.wait_until_connected(expected, others, lambda: next(looks))

    assert True not in looks


async def test_a_listed_peer_that_does_not_answer_is_given_up(connections: Connections) -> None:
    """A frozen process does not delay every start by more than a quarter of a second."""
    looks = 0

    def is_missing() -> bool:
        nonlocal looks
        looks += 1
        return True

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(_connections, "QUIET_S", 0.0)
        tell(connections, "a1", is_made=True)
        await connections.wait_until_connected(1, 2, is_missing)

    assert looks == QUIETS - 1


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists sessions")
async def test_the_listed_sessions_without_a_connection_are_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Whatever else is connected: clients and probes come and go."""
    missing: set[object] = set()
    wait = Connections.wait_until_connected

    async def note(self: Connections, expected: int, others: int, look: Any) -> None:
        await wait(self, expected, others, look)
        missing.add(frozenset(look()))

    async with Context():
        monkeypatch.setattr(Connections, "wait_until_connected", note)
        with closing(announce(network_from(os.environ).meeting_ports[0], 4711)):
            async with Context():
                pass

    assert missing == {frozenset({4711})}
