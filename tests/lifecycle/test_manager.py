"""Bringing managed nodes up and down in order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.errors import TransitionError
from aionode.lifecycle import LifecycleManager, LifecycleNode, State, TransitionCallbackReturn
from aionode.testing import settle

SUCCESS = TransitionCallbackReturn.SUCCESS
FAILURE = TransitionCallbackReturn.FAILURE


class Step(LifecycleNode):
    """Notes its transitions in a list that it shares with others."""

    def __init__(self, name: str, log: list[str], *, activates: bool = True) -> None:
        super().__init__(name)
        self.log = log
        self.activates = activates

    def note(self, what: str) -> TransitionCallbackReturn:
        """Add a line to the list."""
        self.log.append(f"{what} {self.get_name()}")
        return SUCCESS

    def on_configure(self, state: State) -> TransitionCallbackReturn:
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
