"""When a returned participant that declares nothing is reconnected, in stepped time."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any

import pytest

from aionode.engine.transport.network import network_from
from aionode.engine.transport.zenoh._defects import stale_transports
from aionode.engine.transport.zenoh._defects._connection_mend import ATTEMPTS, POSTPONED_S
from aionode.engine.transport.zenoh._defects.stale_transports import (
    DECLARED_S,
    FEW,
    StaleTransports,
)
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.testing import ManualClock, SteppedLoop
from tests.support.connections import tell
from tests.support.peers import DOMAIN_ID

LONG_S = 20 * DECLARED_S
"""Nothing comes later than this."""


class Scene:
    """A context whose connections others open and lose.

    Args:
        loop: Lets time pass.
        clock: The time.

    Attributes:
        mend: It cuts connections.
        state: The session state of the context.
        cuts: The participants of each cut.
    """

    def __init__(self, loop: SteppedLoop, clock: ManualClock) -> None:
        self.cuts: list[set[str]] = []
        self.state = SessionState("a1", DOMAIN_ID)
        self.mend = StaleTransports(self.state, network_from({}))
        self._loop = loop
        self._clock = clock
        session: Any = SimpleNamespace()
        self.mend.start(session)

    def change(self, *zids: str, is_made: bool) -> None:
        """Open or lose connections."""
        for zid in zids:
            tell(self.state.connections, zid, is_made=is_made)

    def return_silently(self, *zids: str) -> None:
        """Lose participants, and reconnect them without their tokens."""
        self.state.acknowledgements.participants.update(zids)
        self.change(*zids, is_made=False)
        self.change(*zids, is_made=True)

    def declare(self, zid: str) -> None:
        """Deliver the token of a participant."""
        self.state.acknowledgements.present.add(zid)

    async def step(self, seconds: float) -> None:
        """Let time pass."""
        await self._loop.walk_to(self._clock.steady_ns() + round(seconds * 1e9))


@pytest.fixture
async def scene(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a context at the time 0; no connection is really cut."""
    clock = ManualClock()
    with SteppedLoop(clock) as loop:
        scene = Scene(loop, clock)
        monkeypatch.setattr(stale_transports, "start_thread", threading.Thread.run)
        monkeypatch.setattr(
            stale_transports, "cut_participants", lambda _session, zids: scene.cuts.append(zids)
        )
        yield scene
        scene.mend.stop()


async def test_a_participant_that_returns_and_declares_nothing_is_connected_anew(
    scene: Scene,
) -> None:
    """Zenoh took its new connection for another link of the one that is lost."""
    scene.return_silently("b2")
    await scene.step(DECLARED_S)
    assert scene.cuts == [{"b2"}]


async def test_it_is_connected_anew_only_so_often(scene: Scene) -> None:
    """It may be visible, but never reachable."""
    scene.return_silently("b2")
    await scene.step(LONG_S)
    assert scene.cuts == [{"b2"}] * ATTEMPTS


async def test_a_participant_that_is_new_may_take_its_time(scene: Scene) -> None:
    """It was never lost."""
    scene.state.acknowledgements.participants.add("new")
    scene.change("new", is_made=True)
    await scene.step(LONG_S)
    assert scene.cuts == []


async def test_a_participant_that_is_lost_once_more_has_no_connection_to_cut(scene: Scene) -> None:
    """Its return is waited for again."""
    scene.return_silently("b2")
    scene.change("b2", is_made=False)
    await scene.step(LONG_S)
    assert scene.cuts == []


async def test_a_participant_that_has_declared_itself_is_left_alone(scene: Scene) -> None:
    """Its tokens come a moment after its connection."""
    scene.return_silently("b2")
    await scene.step(DECLARED_S / 2)
    scene.declare("b2")
    await scene.step(LONG_S)
    assert scene.cuts == []


async def test_no_connection_is_cut_while_others_are_being_made(scene: Scene) -> None:
    """When 100 contexts started at once, each cut others that were merely slow."""
    scene.return_silently("b2")
    for number in range(10):
        await scene.step(0.4 * DECLARED_S)
        scene.change(f"new{number}", is_made=True)
    assert scene.cuts == []

    await scene.step(DECLARED_S)
    assert scene.cuts == [{"b2"}]


async def test_many_that_declare_nothing_are_waited_for_longer(scene: Scene) -> None:
    """They are slow, or laptops that were closed in one room: then all are cut at once."""
    names = {f"b{number}" for number in range(FEW + 1)}
    scene.return_silently(*names)
    await scene.step(POSTPONED_S - 0.1)
    assert scene.cuts == []

    await scene.step(DECLARED_S)
    assert scene.cuts == [names]


async def test_a_few_of_many_are_waited_for_no_longer(scene: Scene) -> None:
    """The tokens of all others have come."""
    names = {f"b{number}" for number in range(FEW + 1)}
    scene.return_silently(*names)
    await scene.step(DECLARED_S)
    scene.declare("b0")
    await scene.step(DECLARED_S / 2)
    assert scene.cuts == [names - {"b0"}]


async def test_tokens_may_take_longer_where_there_are_many_participants(scene: Scene) -> None:
    """On a busy machine all had lost each other, and each cut the others again and again."""
    scene.change(*(f"peer{number}" for number in range(100)), is_made=True)
    scene.return_silently("b2")
    await scene.step(5 * DECLARED_S)
    assert scene.cuts == []

    await scene.step(DECLARED_S)
    assert scene.cuts == [{"b2"}]


async def test_nothing_is_cut_after_the_session(scene: Scene) -> None:
    """A context that was closed and opened again begins anew."""
    scene.return_silently("b2")
    scene.mend.stop()
    await scene.step(LONG_S)
    assert scene.cuts == []
