"""The services of a controller manager."""

from __future__ import annotations

from typing import Any

from aionode import DurabilityPolicy, Node, QoSProfile
from aionode.errors import escaped
from aionode.interfaces.controller_manager_msgs import srv
from aionode.interfaces.controller_manager_msgs.msg import (
    ControllerManagerActivity,
    NamedLifecycleState,
)
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.programs._ros2_control.controllers import TYPES, Controllers, SwitchError
from aionode.programs._ros2_control.hardware import Hardware

__all__ = ["Services"]


def shown(name: str) -> str:
    """Return a name from a request, with control characters escaped for the log."""
    return escaped(name, one_line=True)


class Services:
    """Answers the requests to a controller manager, and carries out each update.

    Args:
        manager: The manager's node.
        hardware: The hardware.
        controllers: The controllers.
    """

    def __init__(self, manager: Node, hardware: Hardware, controllers: Controllers) -> None:
        self.hardware = hardware
        self.controllers = controllers
        self.logger = manager.get_logger()
        self.clock = manager.get_clock()
        self.updated = self.clock.now()
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.activity = manager.create_publisher(ControllerManagerActivity, "~/activity", latched)
        services: dict[str, tuple[Any, Any]] = {
            "list_controllers": (srv.ListControllers, self.list_controllers),
            "list_controller_types": (srv.ListControllerTypes, self.list_types),
            "load_controller": (srv.LoadController, self.load),
            "configure_controller": (srv.ConfigureController, self.change),
            "cleanup_controller": (srv.CleanupController, self.change),
            "unload_controller": (srv.UnloadController, self.change),
            "switch_controller": (srv.SwitchController, self.switch),
            "list_hardware_components": (srv.ListHardwareComponents, self.list_components),
            "list_hardware_interfaces": (srv.ListHardwareInterfaces, self.list_interfaces),
            "set_hardware_component_state": (srv.SetHardwareComponentState, self.set_component),
        }
        for name, (kind, callback) in services.items():
            manager.create_service(kind, f"~/{name}", callback)
        self.tell()

    def list_controllers(self, _request: Any, response: Any) -> Any:
        """List the loaded controllers."""
        response.controller = self.controllers.listed()
        return response

    def list_types(self, _request: Any, response: Any) -> Any:
        """List the types of controllers."""
        response.types = list(TYPES)
        response.base_classes = ["controller_interface::ControllerInterface"] * len(TYPES)
        return response

    def load(self, request: Any, response: Any) -> Any:
        """Load a controller."""
        response.ok = self.controllers.load(shown(request.name))
        self.tell()
        return response

    async def change(self, request: Any, response: Any) -> Any:
        """Configure, clean up or unload a controller."""
        verb = {
            srv.ConfigureController.Request: self.controllers.configure,
            srv.CleanupController.Request: self.controllers.cleanup,
            srv.UnloadController.Request: self.controllers.unload,
        }[type(request)]
        response.ok = await verb(shown(request.name))
        self.tell()
        return response

    async def switch(self, request: Any, response: Any) -> Any:
        """Deactivate controllers, and activate others."""
        try:
            response.message = await self.controllers.switch(
                [shown(name) for name in request.activate_controllers],
                [shown(name) for name in request.deactivate_controllers],
                is_strict=request.strictness != srv.SwitchController.Request.BEST_EFFORT,
            )
            response.ok = True
            self.logger.info(response.message)
        except SwitchError as error:
            response.message = str(error)
        self.tell()
        return response

    def list_components(self, _request: Any, response: Any) -> Any:
        """List the hardware components."""
        response.component = [self.hardware.report(name) for name in self.hardware.components]
        return response

    def list_interfaces(self, _request: Any, response: Any) -> Any:
        """List the interfaces of the hardware."""
        response.command_interfaces = self.hardware.listed("command")
        response.state_interfaces = self.hardware.listed("state")
        return response

    async def set_component(self, request: Any, response: Any) -> Any:
        """Take a hardware component to another state."""
        name, wanted = shown(request.name), request.target_state
        if name not in self.hardware.components:
            self.logger.error(f"hardware component with name '{name}' does not exist")
            return response
        state = wanted.id or self.hardware.state_called(wanted.label)
        response.ok = self.hardware.may_become(name, state)
        if response.ok:
            if state != State.PRIMARY_STATE_ACTIVE:
                await self.controllers.deactivate_users(name)
            self.hardware.set_state(name, state)
            self.tell()
        response.state = self.hardware.state_of(name)
        return response

    async def cycle(self) -> None:
        """Read the hardware, and let the controllers write commands."""
        now = self.clock.now()
        period_ns = now.nanoseconds - self.updated.nanoseconds
        self.updated = now
        if period_ns > 0:  # simulated time may be set back
            self.hardware.read(period_ns / 1e9)
            await self.controllers.update(now)
            self.hardware.write()

    def tell(self) -> None:
        """Publish the states of controllers and hardware."""
        msg = ControllerManagerActivity(
            controllers=self.controllers.activity(),
            hardware_components=[
                NamedLifecycleState(name=name, state=self.hardware.state_of(name))
                for name in self.hardware.components
            ],
        )
        msg.header.stamp = self.clock.now().to_msg()
        self.activity.publish(msg)
