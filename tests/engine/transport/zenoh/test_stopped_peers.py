"""When the connections of a stopped process are cut, in stepped time."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace
from typing import Any

import pytest

from aionode._process.stopped import pid_space
from aionode.engine.transport import network
from aionode.engine.transport.network import new_participant, pid_of
from aionode.engine.transport.zenoh.connections import stopped_peers
from aionode.engine.transport.zenoh.connections.stopped_peers import (
    LOOK_S,
    LOOKS,
    SUCCESSORS,
    StoppedPeers,
)
from aionode.testing import ManualClock, SteppedLoop

GIVEN_UP_S = LOOKS * LOOK_S


class Scene:
    """The peers of a session, of whom some are stopped.

    Attributes:
        peers: The connected sessions.
        stopped: The processes that are stopped.
        cuts: The peers of each cut.
        watched: The processes that are looked at.
        said: The keys of what was sent to all others.
        hidden: The processes that the system hides from this one.
        be_told: Receives what another one has sent to all.
    """

    def __init__(self, loop: SteppedLoop, clock: ManualClock) -> None:
        self.peers: dict[str, None] = {}
        self.stopped: set[int] = set()
        self.cuts: list[set[str]] = []
        self.watched: list[int] = []
        self.said: list[str] = []
        self.be_told: Any = None
        self.hidden: set[int] = set()
        self._loop = loop
        self._clock = clock

    def queue(self, handle: Any, _limit: int) -> Any:
        """Return a queue."""
        self.be_told = handle
        return SimpleNamespace(put=handle, clear=lambda: None)

    def cut(self, _session: object, zids: set[str]) -> None:
        """Lose peers."""
        self.cuts.append(zids)
        for zid in zids:
            del self.peers[zid]

    def watch(self, pid: int) -> Any:
        """Look at a process."""
        self.watched.append(pid)
        return SimpleNamespace(
            is_stopped=lambda: pid in self.stopped, close=lambda: self.watched.remove(pid)
        )

    def pid_of(self, zid: str) -> int | None:
        """Return a process that is not hidden."""
        pid = pid_of(zid)
        return None if pid in self.hidden else pid

    def connect(self, pid: int, monkeypatch: pytest.MonkeyPatch) -> str:
        """Connect with a process of this machine; return its id."""
        space = pid_space()
        with monkeypatch.context() as patched:
            patched.setattr("os.getpid", lambda: pid)
            patched.setattr(network, "pid_space", lambda: space)
            peer = new_participant()
        self.peers[peer] = None
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
        monkeypatch.setattr(stopped_peers, "visible_pid_of", scene.pid_of)
        state: Any = SimpleNamespace(
            participant=new_participant(),
            domain_id=7,
            connections=SimpleNamespace(kinds=scene.peers),
            control_messages=SimpleNamespace(put=lambda key, _: scene.said.append(key)),
            queue=scene.queue,
        )
        watch = StoppedPeers(state)
        subscriber = SimpleNamespace(undeclare=lambda: None)
        session: Any = SimpleNamespace(declare_subscriber=lambda *_, **__: subscriber)

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
    """Earlier checks no longer count."""
    frozen = scene.connect(11, monkeypatch)
    scene.stopped.add(11)
    await scene.step(GIVEN_UP_S)
    scene.stopped.clear()
    scene.peers[frozen] = None
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
    del scene.peers[gone]

    await scene.step(LOOK_S)

    assert scene.watched == [12]


async def test_sessions_of_other_software_are_not_looked_at(scene: Scene) -> None:
    """The digits of their ids say nothing; their own lease tells."""
    scene.peers.update(dict.fromkeys(("a1", "f" * 32, "0" * 32)))

    await scene.step(GIVEN_UP_S)

    assert scene.watched == []


MANY = range(11, 41)


async def test_each_process_looks_at_a_few_others(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It checks those that started next: a hundred idle processes check 400 times, not 9900."""
    for pid in MANY:
        scene.connect(pid, monkeypatch)

    await scene.step(LOOK_S)

    assert sorted(scene.watched) == [*MANY][:SUCCESSORS]


async def test_the_one_who_started_last_looks_at_the_first(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each has as many others that look at it."""
    monkeypatch.setattr(network, "perf_ns", lambda: 1)  # they have started before
    for pid in MANY:
        scene.connect(pid, monkeypatch)

    await scene.step(LOOK_S)

    assert len(scene.watched) == SUCCESSORS


async def test_whoever_sees_a_stopped_process_tells_all_others(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Most of them look elsewhere."""
    scene.connect(11, monkeypatch)
    scene.stopped.add(11)

    await scene.step(LOOK_S)

    assert scene.said == ["@aionode/7/stopped"]


async def test_many_processes_that_are_stopped_at_once_are_given_up_at_once(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As with Ctrl-Z in the terminal of a launch: nobody who runs looks at most of them."""
    frozen = {scene.connect(pid, monkeypatch) for pid in MANY}
    scene.stopped.update(MANY)

    await scene.step(GIVEN_UP_S)

    assert scene.cuts == [frozen]


async def test_who_is_told_gives_up_the_stopped_one_like_the_one_who_tells(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others have as long to notice it as one that looks at it."""
    *_, frozen = [scene.connect(pid, monkeypatch) for pid in MANY]
    scene.stopped.add(MANY[-1])
    await scene.step(LOOK_S)
    assert MANY[-1] not in scene.watched

    scene.be_told(None)
    await scene.step(GIVEN_UP_S - LOOK_S)

    assert scene.cuts == [{frozen}]


async def test_after_a_while_each_looks_at_a_few_others_again(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever sends that message could otherwise keep all of them busy."""
    for pid in MANY:
        scene.connect(pid, monkeypatch)
    await scene.step(LOOK_S)

    scene.be_told(None)
    assert len(scene.watched) == len(MANY)
    await scene.step(GIVEN_UP_S + LOOK_S)

    assert len(scene.watched) == SUCCESSORS


async def test_processes_that_are_hidden_take_the_place_of_none(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The system may hide those of other users: one between them would be looked at by nobody."""
    scene.hidden.update(MANY[:-1])
    for pid in MANY:
        scene.connect(pid, monkeypatch)
    await scene.step(LOOK_S)

    assert scene.watched == [MANY[-1]]
