"""``aionode lifecycle``."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.cli._nouns.lifecycle import get_state, list_nodes, list_transitions, set_state
from aionode.errors import CommandError, RequestTimeoutError
from aionode.interfaces.lifecycle_msgs.srv import GetState
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.testing import ManualClock, settle


class Camera(LifecycleNode):
    """A node that cannot be activated."""

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Fail."""
        return TransitionCallbackReturn.FAILURE


@pytest.fixture
async def camera(node_factory: Callable[..., Any]) -> Camera:
    """A running managed node, beside one that is not managed."""
    node_factory("talker")
    camera_node: Camera = node_factory(Camera, "camera")
    await settle()
    return camera_node


async def test_nodes_lists_managed_nodes_only(tool: Node, camera: Camera, screen: Any) -> None:
    """Names, or their number."""
    await list_nodes(tool, output=screen.output)
    await list_nodes(tool, count=True, output=screen.output)

    assert screen.text == "/camera\n1\n"


async def test_get_prints_label_and_number(tool: Node, camera: Camera, screen: Any) -> None:
    """With the name of the node if all are asked."""
    await get_state(tool, "/camera", output=screen.output)
    await get_state(tool, None, output=screen.output)

    assert screen.text == "unconfigured [1]\n/camera: unconfigured [1]\n"


async def test_list_prints_what_is_available(tool: Node, camera: Camera, screen: Any) -> None:
    """Each with its start state and goal state."""
    await list_transitions(tool, "camera", output=screen.output)

    assert screen.text == (
        "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
        "- shutdown [5]\n\tStart: unconfigured\n\tGoal: shuttingdown\n"
    )


async def test_list_all_prints_the_whole_graph(tool: Node, camera: Camera, screen: Any) -> None:
    """All twenty-five."""
    await list_transitions(tool, "/camera", every=True, output=screen.json_output)

    assert len(screen.records) == 25


@pytest.mark.parametrize("transition", ["configure", "1"])
async def test_set_takes_a_label_or_a_number(
    tool: Node, camera: Camera, screen: Any, transition: str
) -> None:
    """As ros2's command does."""
    await set_state(tool, "/camera", transition, output=screen.output)

    assert screen.text == "Transitioning successful\n"
    assert camera.lifecycle_state.label == "inactive"


async def test_a_failed_transition_is_an_error(tool: Node, camera: Camera, screen: Any) -> None:
    """On stderr, with a status."""
    await set_state(tool, "/camera", "configure", output=screen.output)

    with pytest.raises(CommandError, match="Transitioning failed"):
        await set_state(tool, "/camera", "activate", output=screen.output)


async def test_an_unknown_transition_lists_those_there_are(
    tool: Node, camera: Camera, screen: Any
) -> None:
    """In ros2's words."""
    with pytest.raises(
        CommandError,
        match=r"Unknown transition requested, available ones are: configure \[1\], shutdown \[5\]",
    ):
        await set_state(tool, "/camera", "activate", output=screen.output)


async def test_an_unknown_node_is_an_error(tool: Node, camera: Camera, screen: Any) -> None:
    """A node that is not managed is not found either."""
    with pytest.raises(CommandError, match="Node not found"):
        await get_state(tool, "/talker", output=screen.output)


class Slow(LifecycleNode):
    """A node that is never configured."""

    async def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Wait forever."""
        await asyncio.Event().wait()
        return TransitionCallbackReturn.SUCCESS


async def test_set_waits_for_a_transition_as_long_as_asked(
    tool: Node,
    node_factory: Callable[..., Any],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """Without the option it waits as long as the transition takes, like ros2."""
    node_factory(Slow, "slow")
    await settle()

    waiting = set_state(tool, "/slow", "configure", timeout=0.2, output=screen.output)
    with pytest.raises(RequestTimeoutError, match="change_state"):
        await asyncio.gather(waiting, manual_clock.advance(3.0))


async def test_get_gives_up_a_node_that_does_not_answer(
    tool: Node,
    node_factory: Callable[..., Node],
    manual_clock: ManualClock,
    screen: Any,
) -> None:
    """After the time set by the option."""
    silent = node_factory("silent")

    async def never(request: Any, response: Any) -> Any:
        await asyncio.Event().wait()
        return response

    silent.create_service(GetState, "~/get_state", never)
    await settle()

    waiting = get_state(tool, "/silent", timeout=0.5, output=screen.output)
    with pytest.raises(RequestTimeoutError, match="get_state"):
        await asyncio.gather(waiting, manual_clock.advance(1.0))
