"""Bringing managed nodes up and down in order."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from typing import Any

import pytest
from msgspec.structs import replace

from aionode import Context, Node, Supervisor
from aionode.errors import TransitionError
from aionode.graph import EndpointKind
from aionode.lifecycle import (
    LifecycleManager,
    LifecycleNode,
    ManagedNodeEvent,
    State,
    TransitionCallbackReturn,
)
from aionode.testing import ManualClock, settle

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE


class Step(LifecycleNode):
    """Notes its transitions in a list that it shares with others."""

    def __init__(
        self, name: str, log: list[str], *, activates: bool = True, **options: Any
    ) -> None:
        super().__init__(name, **options)
        self.log = log
        self.activates = activates

    def note(self, what: str) -> TransitionCallbackReturn:
        """Add a line to the list."""
        self.log.append(f"{what} {self.get_name()}")
        return SUCCESS

    def on_configure(self, state: State) -> Any:
        """Record it."""
        return self.note("configure")

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Record it, and fail if the test wants that."""
        self.note("activate")
        return SUCCESS if self.activates else FAILURE

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Record it."""
        return self.note("deactivate")

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Record it."""
        return self.note("cleanup")


async def test_nodes_go_up_in_order_and_down_in_reverse(
    node: Node, node_factory: Callable[..., Any]
) -> None:
    """The planner needs the camera, so the camera is there first and goes last."""
    log: list[str] = []
    for name in ("camera", "planner"):
        node_factory(Step, name, log)
    await settle()

    async with LifecycleManager(node, ["/camera", "/planner"]):
        log.append("up")

    assert log == [
        *("configure camera", "configure planner", "activate camera", "activate planner", "up"),
        *("deactivate planner", "cleanup planner", "deactivate camera", "cleanup camera"),
    ]


async def test_a_failure_brings_the_others_down_again(
    node: Node, node_factory: Callable[..., Any]
) -> None:
    """Half a robot is not left running."""
    log: list[str] = []
    camera = node_factory(Step, "camera", log)
    planner = node_factory(Step, "planner", log, activates=False)
    await settle()

    with pytest.raises(TransitionError, match="/planner: cannot activate"):
        await LifecycleManager(node, ["/camera", "/planner"]).startup()

    assert camera.lifecycle_state.label == "unconfigured"
    assert planner.lifecycle_state.label == "unconfigured"


async def test_a_node_that_is_not_there_is_named(node: Node) -> None:
    """After the time limit, with that limit."""
    with pytest.raises(TransitionError, match=r"no such node appeared in 0\.01 s"):
        await LifecycleManager(node, ["/camera"], timeout_sec=0.01).startup()


async def test_shutdown_finalizes_the_nodes(node: Node, node_factory: Callable[..., Any]) -> None:
    """From any state, and twice is allowed."""
    camera = node_factory(Step, "camera", [])
    await settle()
    manager = LifecycleManager(node, ["/camera"])
    await manager.shutdown()
    await manager.shutdown()

    assert camera.lifecycle_state.label == "finalized"


# Nodes that go and return


class Crashing(Step):
    """Fails when told to; `wakes` and `gate` are for the nodes that come after it."""

    wakes = True
    gate: asyncio.Event | None = None

    async def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Record it, and wait for the gate, if there is one."""
        self.note("configure")
        if self.gate is not None:
            await self.gate.wait()
        return SUCCESS if self.wakes else FAILURE

    def crash(self) -> None:
        """Fail in a callback."""

        def fail() -> None:
            raise ValueError("no picture")

        self.create_timer(0.0, fail)


class Events:
    """Collects the events of a manager."""

    def __init__(self) -> None:
        self.kinds: list[str] = []
        self.all: list[ManagedNodeEvent] = []

    async def read(self, manager: LifecycleManager) -> None:
        """Read until the manager ends."""
        async for event in manager.events():
            self.kinds.append(f"{event.kind} {event.node_name}")
            self.all.append(event)


@pytest.fixture
async def supervisor(
    context: Context, manual_clock: ManualClock, log: list[str], monkeypatch: pytest.MonkeyPatch
) -> AsyncIterator[Supervisor[Crashing]]:
    """A camera that starts again half a second after it has failed."""
    monkeypatch.setattr(Crashing, "wakes", True)
    monkeypatch.setattr(Crashing, "gate", None)
    make = lambda: Crashing("camera", log, context=context)  # noqa: E731
    async with Supervisor(make, clock=manual_clock) as supervisor:
        yield supervisor


@pytest.fixture
def log() -> list[str]:
    """The notes of the nodes."""
    return []


@pytest.mark.parametrize("restore", [True, False])
async def test_a_node_that_is_back_gets_the_state_it_had_if_that_is_wanted(
    node: Node,
    supervisor: Supervisor[Crashing],
    manual_clock: ManualClock,
    log: list[str],
    capfd: pytest.CaptureFixture[str],
    *,
    restore: bool,
) -> None:
    """Its supervisor starts it unconfigured; the default leaves it so, as it might move."""
    events = Events()
    manager = LifecycleManager(node, ["/camera"], restore=restore)
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(events.read(manager))
        async with manager:
            log.clear()
            supervisor.node.crash()
            await settle()
            assert events.kinds == ["lost /camera"]

            await manual_clock.advance(1.0)
            state = supervisor.node.lifecycle_state.label
        down = supervisor.node.lifecycle_state.label

    if restore:
        assert state == "active"
        assert events.kinds == ["lost /camera", "returned /camera", "restored /camera"]
        assert log == ["configure camera", "activate camera", "deactivate camera", "cleanup camera"]
    else:
        assert state == "unconfigured"
        assert events.kinds == ["lost /camera", "returned /camera"]
        assert log == []
    assert down == "unconfigured"
    said = capfd.readouterr().err
    assert "/camera has gone, or cannot be reached; it was active" in said
    assert "/camera is back and unconfigured; it was active" in said
    assert ("/camera is active again" in said) is restore


async def test_the_state_is_the_one_it_had_at_last_whoever_brought_it_there(
    node: Node, supervisor: Supervisor[Crashing], manual_clock: ManualClock
) -> None:
    """An operator has deactivated the camera: it must not move again after a failure."""
    async with LifecycleManager(node, ["/camera"], restore=True):
        await supervisor.node.trigger_deactivate()
        await settle()
        supervisor.node.crash()
        await settle()
        await manual_clock.advance(1.0)

        assert supervisor.node.lifecycle_state.label == "inactive"


async def test_a_node_that_cannot_be_restored_is_told_and_tried_again_when_it_is_back(
    node: Node,
    supervisor: Supervisor[Crashing],
    manual_clock: ManualClock,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    """A camera may need two starts."""
    events = Events()
    manager = LifecycleManager(node, ["/camera"], restore=True)
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(events.read(manager))
        async with manager:
            supervisor.node.crash()
            await settle()
            monkeypatch.setattr(Crashing, "wakes", False)
            await manual_clock.advance(1.0)
            monkeypatch.setattr(Crashing, "wakes", True)
            assert events.kinds[-1] == "failed /camera"
            assert "it refused or failed" in str(events.all[-1].error)

            supervisor.node.crash()
            await settle()
            await manual_clock.advance(2.0)
            assert supervisor.node.lifecycle_state.label == "active"

    assert "/camera could not be made active again" in capfd.readouterr().err


async def test_a_node_that_replaces_another_before_that_is_gone_is_noticed(
    node: Node, node_factory: Callable[..., Any]
) -> None:
    """The tokens of a killed process stay in the graph until its lease is over."""
    camera = node_factory(Step, "camera", [])
    await settle()
    async with LifecycleManager(node, ["/camera"], restore=True):
        (old,) = node.graph.endpoints(EndpointKind.SERVER, name="/camera/change_state")
        lingering = replace(old, gid=b"2" * 16)
        node.graph.add_endpoint(lingering)
        await settle()
        camera.destroy_node()
        await settle()
        new = node_factory(Step, "camera", [])
        await settle()
        node.graph.remove_endpoint(lingering)

        assert new.lifecycle_state.label == "active"


async def test_what_is_gone_at_the_end_is_named(
    node: Node, node_factory: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """If it cannot be reached only, it works on."""
    camera = node_factory(Step, "camera", [])
    await settle()
    async with LifecycleManager(node, ["/camera"]):
        camera.destroy_node()
        await settle()

    said = capfd.readouterr().err
    assert "/camera was active when it was last seen" in said
    assert "it could not be brought down; check that it has stopped" in said


async def test_what_could_not_be_brought_down_after_a_failed_start_is_named(
    node: Node, node_factory: Callable[..., Any], capfd: pytest.CaptureFixture[str]
) -> None:
    """The error tells of the start alone."""
    camera = node_factory(Step, "camera", [])
    node_factory(Step, "planner", [], activates=False)
    camera.on_cleanup = lambda _state: FAILURE
    await settle()

    with pytest.raises(TransitionError, match="/planner: cannot activate"):
        await LifecycleManager(node, ["/camera", "/planner"]).startup()

    assert "lifecycle manager: /camera: cannot cleanup" in capfd.readouterr().err


async def test_the_end_waits_for_a_restore_that_is_under_way(
    node: Node,
    supervisor: Supervisor[Crashing],
    manual_clock: ManualClock,
    log: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A node that is configuring cannot be brought down: it would become active afterwards."""
    gate = asyncio.Event()
    async with LifecycleManager(node, ["/camera"], restore=True):
        supervisor.node.crash()
        await settle()
        log.clear()
        monkeypatch.setattr(Crashing, "gate", gate)
        await manual_clock.advance(1.0)
        assert log == ["configure camera"]
        asyncio.get_running_loop().call_soon(gate.set)

    assert supervisor.node.lifecycle_state.label == "unconfigured"


async def test_a_manager_whose_node_ends_watches_no_more(
    context: Context,
    supervisor: Supervisor[Crashing],
    manual_clock: ManualClock,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The body goes on, and the end says what it could not do."""
    gate = asyncio.Event()
    node = Node("manager", context=context)
    manager = LifecycleManager(node, ["/camera"], restore=True)
    async with node:
        await manager.__aenter__()
        supervisor.node.crash()
        await settle()
        monkeypatch.setattr(Crashing, "gate", gate)
        await manual_clock.advance(1.0)
    gate.set()

    with pytest.raises(ExceptionGroup, match="could not be brought down"):
        await manager.__aexit__(None, None, None)
