"""The hardware of a robot: the values that controllers read and write, and who may write them."""

from __future__ import annotations

import math
from typing import Final, Protocol

from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.controller_manager_msgs.msg import HardwareComponentState, HardwareInterface
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.programs._ros2_control.description import Description, HardwareComponent, Interface
from aionode.programs._ros2_control.mock_system import MockSystem
from aionode.programs._ros2_control.topic_system import TopicSystem

__all__ = ["Hardware"]

LABELS: Final = {
    State.PRIMARY_STATE_UNCONFIGURED: "unconfigured",
    State.PRIMARY_STATE_INACTIVE: "inactive",
    State.PRIMARY_STATE_ACTIVE: "active",
    State.PRIMARY_STATE_FINALIZED: "finalized",
}

MOCKS: Final = ("mock_components/GenericSystem", "fake_components/GenericSystem")
TOPICS: Final = (
    "topic_based_ros2_control/TopicBasedSystem",
    "joint_state_topic_hardware_interface/JointStateTopicSystem",
)


class Driver(Protocol):
    """Reads the states of a component and carries out its commands."""

    def claim(self, names: list[str]) -> None:
        """Note that these commands are given from now on."""

    def read(self, period_sec: float) -> None:
        """Update the states."""

    def write(self) -> None:
        """Carry out the commands."""

    def rest(self) -> None:
        """Stop what moves, until `write` is called again."""

    async def run(self) -> None:
        """Do what takes time, until it is cancelled or nothing is left to do."""


class Hardware:
    """All hardware components of a robot.

    Args:
        description: The robot.
        node: The node that publishes for components behind topics.
        limits: Whether commands are kept within the limits of the description.

    Attributes:
        states: The value of each state interface.
        commands: The value of each command interface, NaN while there was no command.
        claims: The controller that writes a command interface.
        lifecycle: The state of each component.

    Raises:
        CommandError: A component needs a plugin in C++.
    """

    def __init__(self, description: Description, node: Node, *, limits: bool) -> None:
        self.description = description
        self.components = {each.name: each for each in description.components}
        self.lifecycle = dict.fromkeys(self.components, State.PRIMARY_STATE_UNCONFIGURED)
        self.owners: dict[str, str] = {}
        self.command_interfaces: dict[str, Interface] = {}
        self.state_interfaces: dict[str, Interface] = {}
        for each in description.components:
            refuse_compiled(each)
            commands = [*each.commands, *mocked(each)]
            self.command_interfaces |= {one.name: one for one in commands}
            self.state_interfaces |= {one.name: one for one in each.states}
            self.owners |= {one.name: each.name for one in (*commands, *each.states)}
        self.states = {name: one.initial for name, one in self.state_interfaces.items()}
        self.commands = {name: one.initial for name, one in self.command_interfaces.items()}
        self.claims: dict[str, str] = {}
        self.limited = [
            (name, one.least, one.greatest)
            for name, one in self.command_interfaces.items()
            if limits and (one.least > -math.inf or one.greatest < math.inf)
        ]
        self.known = {each.name: self.driver_of(each, node) for each in description.components}
        self.drivers: dict[str, Driver] = {}

    def driver_of(self, component: HardwareComponent, node: Node) -> Driver:
        """Return what drives a component."""
        if component.plugin in TOPICS:
            return TopicSystem(component, self.commands, self.states, node)
        return MockSystem(component, self.commands, self.states)

    def set_state(self, name: str, state: int) -> None:
        """Take a component to a state, through the states in between."""
        self.lifecycle[name] = state
        if state not in (State.PRIMARY_STATE_INACTIVE, State.PRIMARY_STATE_ACTIVE):
            self.drivers.pop(name, None)
        else:
            self.drivers[name] = self.known[name]
        if state != State.PRIMARY_STATE_ACTIVE:
            self.known[name].rest()

    @staticmethod
    def state_called(label: str) -> int:
        """Return the state with a label, or 0."""
        return next((state for state, name in LABELS.items() if name == label), 0)

    def may_become(self, name: str, state: int) -> bool:
        """Return whether a component can be taken to a state: nothing follows the final one."""
        return state in LABELS and self.lifecycle[name] != State.PRIMARY_STATE_FINALIZED

    def is_available(self, interface: str) -> bool:
        """Return whether an interface exists and its component is configured."""
        return self.owners.get(interface) in self.drivers

    def is_active(self, interface: str) -> bool:
        """Return whether an interface exists and its component is active."""
        owner = self.owners.get(interface)
        return owner is not None and self.lifecycle[owner] == State.PRIMARY_STATE_ACTIVE

    def claim(self, names: list[str], controller: str) -> None:
        """Let a controller write command interfaces."""
        self.claims |= dict.fromkeys(names, controller)
        for driver in self.drivers.values():
            driver.claim(names)

    def release(self, controller: str) -> None:
        """Take the command interfaces of a controller back; what it moved stops."""
        for name, owner in self.claims.items():
            if owner == controller and name.endswith(("/velocity", "/effort")):
                self.commands[name] = 0.0
        self.claims = {name: owner for name, owner in self.claims.items() if owner != controller}

    def read(self, period_sec: float) -> None:
        """Update the states of the hardware."""
        for driver in self.drivers.values():
            driver.read(period_sec)

    def write(self) -> None:
        """Carry out the commands, within the limits of the description."""
        for name, least, greatest in self.limited:
            command = self.commands[name]
            if not least <= command <= greatest and not math.isnan(command):
                self.commands[name] = min(max(command, least), greatest)
        for name, driver in self.drivers.items():
            if self.lifecycle[name] == State.PRIMARY_STATE_ACTIVE:
                driver.write()

    def report(self, name: str) -> HardwareComponentState:
        """Return a component, as the manager's services list it."""
        component = self.components[name]
        return HardwareComponentState(
            name=name,
            type=component.kind,
            class_type=component.plugin,
            plugin_name=component.plugin,
            state=self.state_of(name),
            command_interfaces=[
                each for each in self.listed("command") if self.owners[each.name] == name
            ],
            state_interfaces=[
                each for each in self.listed("state") if self.owners[each.name] == name
            ],
        )

    def state_of(self, name: str) -> State:
        """Return the state of a component."""
        return State(id=self.lifecycle[name], label=LABELS[self.lifecycle[name]])

    def listed(self, kind: str) -> list[HardwareInterface]:
        """Return all command or state interfaces, as the manager's services list them."""
        found = self.command_interfaces if kind == "command" else self.state_interfaces
        return [
            HardwareInterface(
                name=name,
                data_type=one.data_type,
                is_available=self.is_available(name),
                is_claimed=kind == "command" and name in self.claims,
            )
            for name, one in sorted(found.items())
        ]


def mocked(component: HardwareComponent) -> list[Interface]:
    """Return the commands that tell a mock what its sensors and GPIOs measure."""
    return [
        each
        for part in component.parts
        if component.parameters.get(f"mock_{part.kind}_commands", "").lower() == "true"
        and part.kind != "joint"
        for each in part.states
        if each not in part.commands
    ]


def refuse_compiled(component: HardwareComponent) -> None:
    """Raise if aionode does not have the plugin of a component.

    Raises:
        CommandError: The plugin is written in C++.
    """
    if component.plugin not in (*MOCKS, *TOPICS):
        raise CommandError(
            f"hardware component '{component.name}': {component.plugin} is a plugin in C++; use "
            f"{MOCKS[0]} to try the robot without its hardware (often an argument such as "
            f"use_mock_hardware:=true), {TOPICS[0]} with a program of yours behind its topics, or "
            "run ros2_control_node in a ROS 2 with rmw_zenoh beside aionode"
        )
