"""When the connections of a stopped process are cut, in stepped time."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace
from typing import Any

import pytest

from aionode._process.stopped import pid_space
from aionode.engine.transport import network
from aionode.engine.transport.network import new_participant
from aionode.engine.transport.zenoh.connections import stopped_peers
from aionode.engine.transport.zenoh.connections.stopped_peers import LOOK_S, LOOKS, StoppedPeers
from aionode.testing import ManualClock, SteppedLoop

GIVEN_UP_S = LOOKS * LOOK_S


class Scene:
    """The peers of a session, of whom some are stopped.

    Attributes:
        peers: The connected sessions.
        stopped: The processes that are stopped.
        cuts: The peers of each cut.
        watched: The processes that are looked at.
    """

    def __init__(self, loop: SteppedLoop, clock: ManualClock) -> None:
        self.peers: set[str] = set()
        self.stopped: set[int] = set()
        self.cuts: list[set[str]] = []
        self.watched: list[int] = []
        self._loop = loop
        self._clock = clock

    def cut(self, _session: object, zids: set[str]) -> None:
        """Lose peers."""
        self.cuts.append(zids)
        self.peers -= zids

    def watch(self, pid: int) -> Any:
        """Look at a process."""
        self.watched.append(pid)
        return SimpleNamespace(
            is_stopped=lambda: pid in self.stopped, close=lambda: self.watched.remove(pid)
        )

    def connect(self, pid: int, monkeypatch: pytest.MonkeyPatch) -> str:
        """Connect with a process of this machine; return its id."""
        space = pid_space()
        with monkeypatch.context() as patched:
            patched.setattr("os.getpid", lambda: pid)
            patched.setattr(network, "pid_space", lambda: space)
            peer = new_participant()
        self.peers.add(peer)
        return peer

    async def step(self, seconds: float) -> None:
        """Let time pass."""
        await self._loop.walk_to(self._clock.steady_ns() + round(seconds * 1e9))


@pytest.fixture
async def scene(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a session at the time 0, without peers."""
    clock = ManualClock()
    with SteppedLoop(clock) as loop:
        scene = Scene(loop, clock)
        monkeypatch.setattr(stopped_peers, "start_thread", threading.Thread.run)
        monkeypatch.setattr(stopped_peers, "cut_participants", scene.cut)
        monkeypatch.setattr(stopped_peers, "WatchedProcess", scene.watch)
        watch = StoppedPeers(scene.peers)
        session: Any = SimpleNamespace()

        async def start() -> None:
            watch.start(session)

        async with asyncio.TaskGroup() as tasks:  # the time of the task itself stays real
            tasks.create_task(start())
        yield scene
        watch.stop()
        assert scene.watched == []


async def test_a_stopped_process_is_given_up(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """Within the time of a lease of ten seconds, and no other process with it."""
    frozen = scene.connect(11, monkeypatch)
    scene.connect(12, monkeypatch)
    scene.stopped.add(11)

    await scene.step(GIVEN_UP_S)

    assert scene.cuts == [{frozen}]


async def test_a_process_that_is_stopped_for_a_moment_keeps_its_connections(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each time anew, as with Ctrl-Z and fg."""
    scene.connect(11, monkeypatch)
    for _ in range(3):
        scene.stopped.add(11)
        await scene.step((LOOKS - 1) * LOOK_S)
        scene.stopped.clear()
        await scene.step(LOOK_S)

    assert scene.cuts == []


async def test_a_process_that_returns_and_is_stopped_again_is_given_up_again(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was seen before counts no more."""
    frozen = scene.connect(11, monkeypatch)
    scene.stopped.add(11)
    await scene.step(GIVEN_UP_S)
    scene.stopped.clear()
    scene.peers.add(frozen)
    await scene.step(LOOK_S)

    scene.stopped.add(11)
    await scene.step(GIVEN_UP_S)

    assert scene.cuts == [{frozen}, {frozen}]


async def test_a_process_that_has_gone_is_looked_at_no_more(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each one that is looked at takes a descriptor."""
    gone = scene.connect(11, monkeypatch)
    scene.connect(12, monkeypatch)
    await scene.step(LOOK_S)
    scene.peers.remove(gone)

    await scene.step(LOOK_S)

    assert scene.watched == [12]


async def test_sessions_of_other_software_are_not_looked_at(scene: Scene) -> None:
    """The digits of their ids say nothing; their own lease tells."""
    scene.peers.update({"a1", "f" * 32, "0" * 32})

    await scene.step(GIVEN_UP_S)

    assert scene.watched == []
