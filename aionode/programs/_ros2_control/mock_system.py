"""``mock_components/GenericSystem``: hardware whose states follow the commands."""

from __future__ import annotations

import math
from collections.abc import MutableMapping
from typing import Final

from aionode.programs._ros2_control.description import HardwareComponent, Part

__all__ = ["MockSystem"]

MODES: Final = ("position", "velocity", "acceleration")


class MockSystem:
    """Copies commands to states; with `calculate_dynamics` it also integrates velocities.

    Args:
        component: Its description.
        commands: The values of all command interfaces, NaN while there was no command.
        states: The values of all state interfaces.
    """

    def __init__(
        self,
        component: HardwareComponent,
        commands: MutableMapping[str, float],
        states: MutableMapping[str, float],
    ) -> None:
        given = component.parameters
        self.commands = commands
        self.states = states
        self.joints = [part for part in component.parts if part.kind == "joint"]
        self.modes = dict.fromkeys((part.name for part in self.joints), "position")
        self.has_dynamics = given.get("calculate_dynamics", "").lower() == "true"
        self.is_deaf = given.get("disable_commands", "").lower() == "true"
        self.offset = float(given.get("position_state_following_offset") or 0)
        self.shifted = given.get("custom_interface_with_following_offset", "")
        names = [each.name for each in component.states]
        computed = MODES if self.has_dynamics else ()
        joints = {f"{part.name}/{mode}" for part in self.joints for mode in computed}
        self.copied = [name for name in names if name not in joints]
        for part in self.joints:
            for each in part.states:
                if math.isnan(states[each.name]):
                    states[each.name] = 0.0
                if each.name.endswith("/position") and not self.shifted:
                    states[each.name] += self.offset

    def claim(self, names: list[str]) -> None:
        """Note that these commands are given from now on, so that the others are computed."""
        for name in names:
            joint, _, mode = name.rpartition("/")
            if joint in self.modes and mode in MODES:
                self.modes[joint] = mode

    def read(self, period_sec: float) -> None:
        """Move the states towards the commands for one period."""
        if self.is_deaf:
            return
        for name in self.copied:
            command = self.commands.get(name, math.nan)
            if math.isfinite(command):
                is_shifted = name.endswith("/position") and not self.shifted
                self.states[name] = command + (self.offset if is_shifted else 0.0)
        if self.has_dynamics:
            for part in self.joints:
                self.move(part.name, period_sec)
        for part in self.joints:
            self.follow(part)

    def write(self) -> None:
        """Do nothing: `read` carries out the commands."""

    def rest(self) -> None:
        """Nothing moves."""

    async def run(self) -> None:
        """Return at once: nothing takes time."""

    def move(self, joint: str, period_sec: float) -> None:
        """Compute the position, velocity and acceleration of a joint."""
        mode = self.modes[joint]
        command = self.commands.get(f"{joint}/{mode}", math.nan)
        position, velocity, acceleration = (
            self.states.get(f"{joint}/{each}", math.nan) for each in MODES
        )
        before = velocity if math.isfinite(velocity) else 0.0
        if mode == "position":
            if not math.isfinite(command):
                return
            command += 0.0 if self.shifted else self.offset
            velocity = (command - position) / period_sec
            position = command
        else:
            if mode == "acceleration":
                acceleration = command if math.isfinite(command) else acceleration
                velocity = before + (acceleration if math.isfinite(acceleration) else 0.0) * (
                    period_sec
                )
            elif math.isfinite(command):
                velocity = command
            position += (velocity if math.isfinite(velocity) else 0.0) * period_sec
        if mode != "acceleration" and math.isfinite(command):
            acceleration = (velocity - before) / period_sec
        for each, value in zip(MODES, (position, velocity, acceleration), strict=True):
            name = f"{joint}/{each}"
            if name in self.states and math.isfinite(value):
                self.states[name] = value

    def follow(self, part: Part) -> None:
        """Move a joint with the one that it mimics, and set the state that has an offset."""
        part.follow(self.states)
        name = f"{part.name}/{self.shifted}"
        position = self.commands.get(f"{part.name}/position", math.nan)
        if self.shifted and name in self.states and math.isfinite(position):
            self.states[name] = position + self.offset
