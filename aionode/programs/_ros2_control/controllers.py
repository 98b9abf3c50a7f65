"""Loads, configures, switches and updates the controllers of a controller manager."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Final

from aionode import Node, Parameter, Time
from aionode.errors import AionodeError
from aionode.interfaces.controller_manager_msgs.msg import ControllerState, NamedLifecycleState
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.lifecycle import TransitionCallbackReturn
from aionode.programs._ros2_control.controller import Controller
from aionode.programs._ros2_control.diff_drive_controller import DiffDriveController
from aionode.programs._ros2_control.forward_command_controller import (
    ForwardCommandController,
    JointGroupEffortController,
    JointGroupPositionController,
    JointGroupVelocityController,
)
from aionode.programs._ros2_control.hardware import Hardware
from aionode.programs._ros2_control.joint_state_broadcaster import JointStateBroadcaster
from aionode.programs._ros2_control.trajectories.joint_trajectory_controller import (
    JointTrajectoryController,
)

__all__ = ["TYPES", "Controllers"]

TYPES: Final[dict[str, type[Controller]]] = {
    "diff_drive_controller/DiffDriveController": DiffDriveController,
    "effort_controllers/JointGroupEffortController": JointGroupEffortController,
    "forward_command_controller/ForwardCommandController": ForwardCommandController,
    "joint_state_broadcaster/JointStateBroadcaster": JointStateBroadcaster,
    "joint_trajectory_controller/JointTrajectoryController": JointTrajectoryController,
    "position_controllers/JointGroupPositionController": JointGroupPositionController,
    "velocity_controllers/JointGroupVelocityController": JointGroupVelocityController,
}
"""The controllers; all are imported at the start, since the robot may move when one is loaded."""


class SwitchError(RuntimeError):
    """Controllers are not switched as requested; the text says why."""


class Controllers:
    """The controllers of a manager.

    Args:
        manager: The manager's node.
        hardware: The hardware that they control.
        tasks: The task group in which their nodes run.
    """

    def __init__(self, manager: Node, hardware: Hardware, tasks: asyncio.TaskGroup) -> None:
        self.manager = manager
        self.hardware = hardware
        self.tasks = tasks
        self.logger = manager.get_logger()
        self.loaded: dict[str, Controller] = {}
        self.kinds: dict[str, str] = {}
        self.updated: dict[str, Time] = {}

    def given(self, name: str, default: Any) -> Any:
        """Return the value of a parameter of the manager, or the default."""
        value = self.manager.get_parameter_or(name, Parameter(name, value=default)).value
        return default if value is None else value

    def state(self, name: str) -> str:
        """Return the state of a controller; ``missing`` if it is not loaded."""
        controller = self.loaded.get(name)
        return "missing" if controller is None else controller.lifecycle_state.label

    def load(self, name: str) -> bool:
        """Load a controller of the type in the manager's parameters."""
        kind = self.given(f"{name}.type", "")
        if not kind or not isinstance(kind, str):
            self.logger.error(f"The 'type' param was not defined for '{name}'.")
            return False
        self.logger.info(f"Loading controller : '{name}' of type '{kind}'")
        if name in self.loaded:
            self.logger.error(
                f"A controller named '{name}' was already loaded inside the controller manager"
            )
            return False
        if kind not in TYPES:
            self.logger.error(
                f"Loader for controller '{name}' (type '{kind}') not found: it is a plugin in C++, "
                f"or misspelt; aionode has {', '.join(TYPES)}"
            )
            return False
        try:
            controller = TYPES[kind](
                name,
                self.hardware,
                namespace=self.manager.get_namespace(),
                context=self.manager.context,
                cli_args=self.arguments(name),
            )
        except AionodeError as error:
            text = f"Could not initialize the controller named '{name}': {error}"
            self.logger.error(text)  # noqa: TRY400  # it says what to do
            return False
        self.tasks.create_task(controller.run())
        self.loaded[name], self.kinds[name] = controller, kind
        return True

    def arguments(self, name: str) -> list[str]:
        """Return the arguments for a controller's node besides those of the whole program."""
        own = ["--ros-args", "-r", f"__node:={name}", "-r", f"__ns:={self.manager.get_namespace()}"]
        files = self.given(f"{name}.params_file", [])
        for file in [files] if isinstance(files, str) else files:
            own += ["--params-file", file]
        if self.manager.get_parameter("use_sim_time").value:
            own += ["-p", "use_sim_time:=true"]
        more = [each for each in self.given(f"{name}.node_options_args", []) if each]
        return own + [each for each in more if each != "--ros-args"]

    async def configure(self, name: str) -> bool:
        """Configure a controller; an inactive one is cleaned up first."""
        self.logger.info(f"Configuring controller: '{name}'")
        state = self.state(name)
        if state == "missing":
            self.logger.error(
                f"Could not configure controller with name '{name}' because no controller with "
                "this name exists"
            )
            return False
        if state not in ("unconfigured", "inactive"):
            self.logger.error(f"Controller '{name}' can not be configured from '{state}' state.")
            return False
        if state == "inactive" and not await self.cleanup(name):
            return False
        return await self.change(name, "configure")

    async def cleanup(self, name: str) -> bool:
        """Clean a controller up."""
        state = self.state(name)
        if state == "missing":
            self.logger.error(
                f"Could not cleanup controller with name '{name}' because no controller with this "
                "name exists"
            )
            return False
        self.logger.info(f"Cleanup controller '{name}'")
        if state == "unconfigured":
            return True
        if state != "inactive":
            self.logger.error(f"Controller '{name}' can not be cleaned-up from '{state}' state.")
            return False
        return await self.change(name, "cleanup")

    async def unload(self, name: str) -> bool:
        """Remove a controller."""
        self.logger.info(f"Unloading controller: '{name}'")
        state = self.state(name)
        if state in ("missing", "active"):
            why = (
                "it is still active"
                if state == "active"
                else ("no controller with this name exists")
            )
            self.logger.error(f"Could not unload controller with name '{name}' because {why}")
            return False
        controller = self.loaded.pop(name)
        self.hardware.release(name)
        controller.destroy_node()
        await controller.ended()
        return True

    async def change(self, name: str, verb: str) -> bool:
        """Request a transition of a controller; return whether it succeeded."""
        try:
            result = await getattr(self.loaded[name], f"trigger_{verb}")()
        except AionodeError as error:
            self.logger.error(str(error))  # noqa: TRY400  # the node has logged the traceback
            return False
        return bool(result is TransitionCallbackReturn.SUCCESS)

    async def switch(self, start: list[str], stop: list[str], *, is_strict: bool) -> str:
        """Deactivate some controllers, and activate others.

        Returns:
            What was done.

        Raises:
            SwitchError: Nothing was switched, or a controller could not be activated.
        """
        for verb, names in (("Activating", start), ("Deactivating", stop)):
            if names:
                self.logger.info(f"{verb} controllers: [ {' '.join(names)} ]")
        stop = self.fitting(stop, self.stop_problem, is_strict=is_strict)
        start = self.fitting(
            start, lambda name: self.start_problem(name, stop), is_strict=is_strict
        )
        if not start and not stop:
            return (
                "After checking the controllers, no controllers need to be activated or "
                "deactivated."
            )
        self.refuse_conflicts(start, stop)
        for name in stop:
            await self.deactivate(name)
        failed = [name for name in start if not await self.activate(name)]
        if failed and is_strict:
            self.logger.error(
                "At least one controller failed to be activated. Releasing all interfaces and "
                "stopping all activated controllers because the switch strictness is set to STRICT."
            )
            for name in start:
                if self.state(name) == "active":
                    await self.deactivate(name)
        if failed:
            raise SwitchError(f"Unable to activate controllers: [ {' '.join(failed)} ]")
        return "Successfully switched controllers!"

    def fitting(
        self, names: list[str], problem_of: Callable[[str], str], *, is_strict: bool
    ) -> list[str]:
        """Return the controllers that can be switched; a strict switch needs all.

        Raises:
            SwitchError: The switch is strict, and a controller cannot be switched.
        """
        problems = {name: problem_of(name) for name in names}
        for problem in filter(None, problems.values()):
            self.logger.warning(problem)
            if is_strict:
                self.logger.error("Aborting, no controller is switched! ('STRICT' switch)")
                raise SwitchError(problem)
        return [name for name, problem in problems.items() if not problem]

    def stop_problem(self, name: str) -> str:
        """Return why a controller cannot be deactivated; empty if it can."""
        state = self.state(name)
        if state == "missing":
            return (
                f"Could not deactivate controller with name '{name}' because no controller with "
                "this name exists"
            )
        if state != "active":
            return f"Controller with name '{name}' can not be deactivated since it is not active."
        return ""

    def start_problem(self, name: str, stop: list[str]) -> str:
        """Return why a controller cannot be activated; empty if it can."""
        state = self.state(name)
        if state == "missing":
            return (
                f"Could not activate controller with name '{name}' because no controller with this "
                "name exists"
            )
        if state == "active" and name not in stop:
            return f"Controller with name '{name}' is already active."
        if state not in ("active", "inactive"):
            return (
                f"Controller with name '{name}' is in '{state}' state. The controller needs to be "
                "configured to be in 'inactive' state before it can be checked and activated."
            )
        return ""

    def refuse_conflicts(self, start: list[str], stop: list[str]) -> None:
        """Raise SwitchError if interfaces of controllers are not available or already claimed."""
        taken = {name: owner for name, owner in self.hardware.claims.items() if owner not in stop}
        may_be_inactive = "defaults.allow_controller_activation_with_inactive_hardware"
        is_usable = (
            self.hardware.is_available
            if self.given(may_be_inactive, "")
            else self.hardware.is_active
        )
        for name in start:
            controller = self.loaded[name]
            problem = ""
            for each in controller.command_names:
                if each not in self.hardware.commands or not is_usable(each):
                    problem = f"command interface '{each}' is not available."
                elif each in taken:
                    by = "is currently claimed by another controller."
                    if taken[each] in start:
                        by = "will be used by another controller that is being activated."
                    problem = f"command interface '{each}' {by}"
                taken[each] = name
            for each in controller.state_names:
                if each not in self.hardware.states or not is_usable(each):
                    problem = f"state interface '{each}' is not available."
            if problem:
                text = f"Unable to activate controller '{name}' since the {problem}"
                self.logger.warning(text)
                raise SwitchError(text)

    async def activate(self, name: str) -> bool:
        """Activate a controller, with its interfaces."""
        self.hardware.claim(self.loaded[name].command_names, name)
        self.updated[name] = self.manager.get_clock().now()
        if await self.change(name, "activate"):
            return True
        self.hardware.release(name)
        self.logger.error(
            f"After activation, controller '{name}' is in state '{self.state(name)}', expected "
            "'active'. Releasing interfaces!"
        )
        return False

    async def deactivate(self, name: str) -> None:
        """Deactivate a controller, and release its interfaces."""
        try:
            await self.change(name, "deactivate")
        finally:
            self.hardware.release(name)

    async def deactivate_users(self, component: str) -> None:
        """Deactivate the controllers that use a hardware component."""
        for name, controller in list(self.loaded.items()):
            used = (*controller.command_names, *controller.state_names)
            if self.state(name) == "active" and any(
                self.hardware.owners.get(each) == component for each in used
            ):
                self.logger.warning(f"Deactivating controller '{name}', which uses '{component}'")
                await self.deactivate(name)

    async def update(self, now: Time) -> None:
        """Update the active controllers that are due; one that fails is deactivated."""
        for name, controller in list(self.loaded.items()):
            if self.state(name) != "active":
                continue
            period_ns = now.nanoseconds - self.updated[name].nanoseconds
            if period_ns < 0:  # simulated time was set back
                self.updated[name] = now
            # A tenth of a period early is in time: timers are never exact.
            is_early = controller.update_rate and period_ns * controller.update_rate < 0.9e9
            if period_ns <= 0 or is_early:
                continue
            self.updated[name] = now
            try:
                controller.update(now, period_ns / 1e9)
            except Exception as error:  # noqa: BLE001  # of any kind; the other controllers go on
                text = f"Caught exception while updating controller '{name}': {error!r}"
                self.logger.error(text)  # noqa: TRY400  # rclpy's logger has no other
                await self.deactivate(name)

    def listed(self) -> list[ControllerState]:
        """Return the controllers as the manager's service lists them, the newest first."""
        return [
            ControllerState(
                name=name,
                state=self.state(name),
                type=self.kinds[name],
                update_rate=controller.update_rate or self.given("update_rate", 100),
                claimed_interfaces=[
                    each for each, owner in self.hardware.claims.items() if owner == name
                ],
                required_command_interfaces=controller.command_names,
                required_state_interfaces=controller.state_names,
            )
            for name, controller in self.loaded.items()
        ]

    def activity(self) -> list[NamedLifecycleState]:
        """Return the states of the controllers."""
        return [
            NamedLifecycleState(
                name=name,
                state=State(
                    id=controller.lifecycle_state.state_id, label=controller.lifecycle_state.label
                ),
            )
            for name, controller in self.loaded.items()
        ]
