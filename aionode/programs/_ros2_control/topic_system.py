"""Hardware behind topics: another program receives the commands and publishes the joint states."""

from __future__ import annotations

import asyncio
import math
from collections.abc import MutableMapping
from typing import Final

from aionode import Node
from aionode.errors import LeaseExpiredError
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.programs._ros2_control.description import HardwareComponent
from aionode.qos import qos_profile_sensor_data

__all__ = ["TopicSystem"]

FIELDS: Final = ("position", "velocity", "effort")
TTL_SEC: Final = 0.3
"""The time without an update of the controllers after which what moves is stopped."""


class TopicSystem:
    """Publishes commands, and reads states, as JointState messages, like ``TopicBasedSystem``.

    Velocities and efforts are published under a lease: a stop follows when the program ends, when
    it hangs, and when the component is deactivated.

    Args:
        component: Its description.
        commands: The values of all command interfaces.
        states: The values of all state interfaces.
        node: The node that publishes.
    """

    def __init__(
        self,
        component: HardwareComponent,
        commands: MutableMapping[str, float],
        states: MutableMapping[str, float],
        node: Node,
    ) -> None:
        given = component.parameters
        self.commands = commands
        self.states = states
        self.parts = [part for part in component.parts if part.kind == "joint"]
        self.moved = [part.name for part in self.parts if part.commands]
        self.fields = [
            field for field in FIELDS if any(f"{joint}/{field}" in commands for joint in self.moved)
        ]
        self.moves = not set(self.fields) <= {"position"}
        self.threshold = float(given.get("trigger_joint_command_threshold") or 1e-5)
        self.sums = given.get("sum_wrapped_joint_states", "").lower() == "true"
        self.logger, self.clock = node.get_logger(), node.get_clock()
        self.publisher = node.create_publisher(
            JointState, given.get("joint_commands_topic") or "/robot_joint_commands", 1
        )
        node.create_subscription(
            JointState,
            given.get("joint_states_topic") or "/robot_joint_states",
            self.hear,
            qos_profile_sensor_data,
        )
        self.heard: dict[str, float] = {}
        self.wanted: JointState | None = None
        self.is_due = asyncio.Event()

    def hear(self, msg: JointState) -> None:
        """Keep the received states of joints."""
        for field in FIELDS:
            for joint, value in zip(msg.name, getattr(msg, field), strict=False):
                self.heard[f"{joint}/{field}"] = float(value)

    def claim(self, names: list[str]) -> None:
        """Do nothing: all commands are published, whichever controller gives them."""

    def read(self, period_sec: float) -> None:
        """Update the states with those received; a joint that mimics another follows it."""
        del period_sec
        for name, value in self.heard.items():
            if name not in self.states:
                continue
            before = self.states[name]
            if self.sums and name.endswith("/position") and math.isfinite(before):
                self.states[name] = before + math.remainder(value - before, 2 * math.pi)
            else:
                self.states[name] = value
        for part in self.parts:
            part.follow(self.states)

    def write(self) -> None:
        """Publish the commands, unless none is given, or the joints have reached them."""
        values = {
            field: [self.commands.get(f"{joint}/{field}", math.nan) for joint in self.moved]
            for field in self.fields
        }
        if not any(math.isfinite(value) for row in values.values() for value in row):
            return
        msg = JointState(name=self.moved)
        for field, row in values.items():
            setattr(msg, field, row)
        msg.header.stamp = self.clock.now().to_msg()
        if self.moves:
            self.wanted = msg
            self.is_due.set()
        elif self.is_far(values.get("position", [])):
            self.publisher.publish(msg)

    def is_far(self, positions: list[float]) -> bool:
        """Return whether the joints are farther from their commands than the threshold, in sum."""
        return (
            sum(
                abs(wanted - self.states.get(f"{joint}/position", math.inf))
                for joint, wanted in zip(self.moved, positions, strict=True)
                if math.isfinite(wanted)
            )
            > self.threshold
        )

    def rest(self) -> None:
        """Stop what moves."""
        if self.wanted is not None:
            self.wanted = None
            self.is_due.set()

    def stop_of(self, msg: JointState) -> JointState:
        """Return the command that stops the joints: those with a position stay there."""
        stop = JointState(header=msg.header, name=self.moved, position=msg.position)
        for field in set(self.fields) - {"position"}:
            setattr(stop, field, [0.0] * len(self.moved))
        return stop

    async def run(self) -> None:
        """Publish velocities and efforts until cancelled, when a stop is sent as well."""
        while True:
            await self.due()
            if self.wanted is None:
                continue
            try:
                async with self.publisher.lease(None, TTL_SEC) as lease:
                    while (msg := self.wanted) is not None:
                        lease.publish(msg, stop=self.stop_of(msg))
                        await self.due()
            except LeaseExpiredError as error:
                self.logger.warning(f"the joints were stopped: {error}")

    async def due(self) -> None:
        """Wait for the next command."""
        await self.is_due.wait()
        self.is_due.clear()
