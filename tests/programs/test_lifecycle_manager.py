"""The program that brings managed nodes up and down, by the service that Nav2 has for it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from aionode.errors import CommandError
from aionode.interfaces.nav2_msgs.srv import ManageLifecycleNodes
from aionode.interfaces.std_msgs.msg import Bool
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.programs._lifecycle_manager import Manager
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

Command = ManageLifecycleNodes.Request


class Server(LifecycleNode):
    """A managed node that notes what happens to it."""

    def __init__(self, name: str, story: list[str]) -> None:
        super().__init__(name)
        self.name = name
        self.story = story
        self.fails = False

    def note(self, what: str) -> TransitionCallbackReturn:
        """Note a transition."""
        self.story.append(f"{what} {self.name}")
        return TransitionCallbackReturn.FAILURE if self.fails else TransitionCallbackReturn.SUCCESS

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Note it."""
        return self.note("configure")

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Note it."""
        return self.note("activate")

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Note it."""
        return self.note("deactivate")

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        """Note it."""
        return self.note("cleanup")

    def on_shutdown(self, state: State) -> TransitionCallbackReturn:
        """Note it."""
        return self.note("shutdown")


class Robot:
    """Two managed nodes, and who commands their manager."""

    def __init__(self, node_factory: Callable[..., Any]) -> None:
        self.story: list[str] = []
        self.factory = node_factory
        self.servers = {name: self.make(name) for name in ("map", "planner")}
        node = node_factory("operator")
        self.manage = node.create_client(ManageLifecycleNodes, "/lifecycle_manager/manage_nodes")
        self.active = node.create_client(Trigger, "/lifecycle_manager/is_active")
        self.activity: list[bool] = []
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(
            Bool,
            "/lifecycle_manager/managed_nodes_activated",
            lambda msg: self.activity.append(msg.data),
            latched,
        )

    def make(self, name: str) -> Server:
        """Start a managed node."""
        server: Server = self.factory(Server, name, self.story)
        return server

    async def command(self, number: int) -> bool:
        """Give a command, and return whether it was done."""
        return bool((await self.manage.call(Command(command=number))).success)

    async def is_active(self) -> bool:
        """Ask whether the nodes are active."""
        return bool((await self.active.call(Trigger.Request())).success)


@pytest.fixture
async def robot(manual_clock: ManualClock, node_factory: Callable[..., Any]) -> Robot:
    """Start the nodes."""
    del manual_clock  # the context follows it
    return Robot(node_factory)


NAMES = {"node_names": ["map", "planner"]}


async def test_nodes_come_up_in_order_and_go_down_in_reverse(
    robot: Robot, start: Start, manual_clock: ManualClock
) -> None:
    """By themselves with autostart; then by commands, as Nav2's tools give them."""
    start(Manager, **NAMES, autostart=True)
    await manual_clock.advance(0.1)
    await settle()

    assert robot.story == ["configure map", "configure planner", "activate map", "activate planner"]
    assert await robot.is_active()
    assert robot.activity == [False, True]
    robot.story.clear()
    assert await robot.command(Command.PAUSE)
    assert await robot.command(Command.RESUME)
    assert await robot.command(Command.RESET)
    assert await robot.command(Command.CONFIGURE)
    assert await robot.command(Command.CLEANUP)
    assert await robot.command(Command.SHUTDOWN)
    assert not await robot.is_active()
    downs = [each for each in robot.story if "planner" in each]
    assert robot.story[:2] == ["deactivate planner", "deactivate map"]
    assert downs == [
        *("deactivate planner", "activate planner", "deactivate planner", "cleanup planner"),
        *("configure planner", "cleanup planner", "shutdown planner"),
    ]


async def test_a_node_that_refuses_ends_the_start(
    robot: Robot, start: Start, capfd: pytest.CaptureFixture[str]
) -> None:
    """Its client is told, and the log says which."""
    robot.servers["planner"].fails = True
    start(Manager, **NAMES)
    await settle()

    assert not await robot.command(Command.STARTUP)
    assert robot.story[:2] == ["configure map", "configure planner"]
    err = capfd.readouterr().err
    assert "Failed to change state for node: planner" in err
    assert "Failed to bring up all requested nodes. Aborting bringup." in err


async def test_each_command_is_logged_in_the_words_of_nav2(
    robot: Robot, start: Start, capfd: pytest.CaptureFixture[str]
) -> None:
    """Tools and people look for these lines."""
    start(Manager, **NAMES)
    await settle()
    for command in ("CONFIGURE", "CLEANUP", "STARTUP", "PAUSE", "RESUME", "RESET", "SHUTDOWN"):
        assert await robot.command(getattr(Command, command))

    said = [line.partition("]: ")[2] for line in capfd.readouterr().err.splitlines()]
    assert [line for line in said if "anaged nodes" in line] == [
        *("Configuring managed nodes...", "Managed nodes are now configured"),
        *("Cleaning up managed nodes...", "Managed nodes have been cleaned up"),
        *("Starting managed nodes bringup...", "Managed nodes are active"),
        *("Pausing managed nodes...", "Managed nodes have been paused"),
        *("Resuming managed nodes...", "Managed nodes are active"),
        *("Resetting managed nodes...", "Managed nodes have been reset"),
        *("Shutting down managed nodes...", "Managed nodes have been shut down"),
    ]


async def test_a_node_that_is_gone_does_not_keep_the_others_from_their_shutdown(
    robot: Robot, start: Start, manual_clock: ManualClock
) -> None:
    """The answer says that not all were shut down."""
    start(Manager, **NAMES, autostart=True, bond_timeout=0.0, service_timeout=0.5)
    await manual_clock.advance(0.1)
    await settle()
    robot.servers["planner"].destroy_node()
    await settle()

    async with asyncio.TaskGroup() as tasks:
        task = tasks.create_task(robot.command(Command.SHUTDOWN))
        while not task.done():
            await manual_clock.advance(0.5)
            await settle()

    assert not task.result()
    assert robot.story[-1] == "shutdown map"


async def test_a_node_that_goes_brings_all_down_and_one_that_comes_back_all_up(
    robot: Robot, start: Start, manual_clock: ManualClock
) -> None:
    """A planner without a map would plan into walls."""
    start(Manager, **NAMES, autostart=True)
    await manual_clock.advance(0.1)
    await settle()
    robot.story.clear()

    robot.servers["map"].destroy_node()
    await settle()
    await manual_clock.advance(0.5)
    await settle()
    assert robot.story == ["deactivate planner", "cleanup planner"]
    assert not await robot.is_active()

    robot.story.clear()
    robot.make("map")
    await settle()
    await manual_clock.advance(0.5)
    await settle()
    assert robot.story == ["configure map", "configure planner", "activate map", "activate planner"]


async def test_it_needs_the_names_of_nodes(start: Start) -> None:
    """Without them it would manage nothing."""
    with pytest.raises(CommandError, match="'node_names' is required"):
        start(Manager)
