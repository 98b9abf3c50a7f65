"""``ros2_control_node``: the controller manager with the robot's hardware and controllers."""

from __future__ import annotations

import asyncio
from functools import partial
from typing import Any, Final

import aionode
from aionode import DurabilityPolicy, Node, Parameter, QoSProfile
from aionode.errors import CommandError
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.interfaces.std_msgs.msg import String
from aionode.programs._ros2_control.controllers import Controllers
from aionode.programs._ros2_control.description import Description
from aionode.programs._ros2_control.hardware import Hardware
from aionode.programs._ros2_control.services import Services
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["ControllerManager", "main"]

START_SEC: Final = 0.001
REMIND_SEC: Final = 1.0

INITIAL_STATES: Final = {
    "unconfigured": State.PRIMARY_STATE_UNCONFIGURED,
    "inactive": State.PRIMARY_STATE_INACTIVE,
}


class ControllerManager(Node):
    """Loads controllers, and updates the active ones after it has read the hardware.

    The robot is the one of the topic `robot_description`, or of the parameter of this name.

    Raises:
        CommandError: The robot is not a URDF, or its hardware needs a plugin in C++.
    """

    def __init__(self) -> None:
        super().__init__(
            "controller_manager",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        self.update_rate = self.given("update_rate", 100)
        if type(self.update_rate) is not int or self.update_rate <= 0:
            raise CommandError(f"update_rate is {self.update_rate!r}; use an integer above 0")
        self.get_logger().info(f"update rate is {self.update_rate} Hz")
        self.hardware: Hardware | None = None
        topic = "robot_description"
        self.reminder = create_wall_timer(self, REMIND_SEC, self.remind)
        if text := self.given(topic, ""):
            self.get_logger().warning(
                "[Deprecated] Passing the robot description parameter directly to the "
                "control_manager node is deprecated. Use the 'robot_description' topic from "
                "'robot_state_publisher' instead."
            )
            self.use(text)
            return
        if self.context.ros_distro == "humble":
            topic = f"~/{topic}"
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        description = self.create_subscription(String, topic, self.on_description, latched)
        self.get_logger().info(
            f"Subscribing to '{description.topic_name}' topic for robot description."
        )

    def given(self, name: str, default: Any) -> Any:
        """Return the value of a parameter, or the default."""
        return self.get_parameter_or(name, Parameter(name, value=default)).value

    def remind(self) -> None:
        """Log that there is no description yet."""
        self.get_logger().warning(
            "Waiting for data on 'robot_description' topic to finish initialization"
        )

    def on_description(self, msg: String) -> None:
        """Use the first description.

        Raises:
            CommandError: It is not a URDF, or its hardware needs a plugin in C++.
        """
        self.get_logger().info("Received robot description from topic.")
        if self.hardware is None:
            self.use(msg.data)
        else:
            self.get_logger().warning(
                "ResourceManager has already loaded a urdf and is initialized. Ignoring attempt to "
                "reload a robot description."
            )

    def use(self, text: str) -> None:
        """Start the hardware of a description, and the services.

        Raises:
            CommandError: It is not a URDF, or its hardware needs a plugin in C++.
        """
        default = self.context.ros_distro not in ("humble", "jazzy")
        limits = self.given("enforce_command_limits", default)
        try:
            hardware = self.hardware = Hardware(Description.of(text), self, limits=limits)
        except ValueError as error:
            raise CommandError(f"robot_description cannot be used: {error}") from None
        wanted = {
            name: state
            for label, state in INITIAL_STATES.items()
            for name in self.given(f"hardware_components_initial_state.{label}", [])
        }
        for name in wanted:
            if name not in hardware.components:
                self.get_logger().warning(f"Hardware component '{name}' is unknown")
        for name in hardware.components:
            hardware.set_state(name, wanted.get(name, State.PRIMARY_STATE_ACTIVE))
        self.reminder.cancel()
        self.starting = create_wall_timer(self, START_SEC, partial(self.control, hardware))

    async def control(self, hardware: Hardware) -> None:
        """Serve, and update the controllers, until the node ends."""
        self.starting.cancel()
        async with asyncio.TaskGroup() as tasks:
            for driver in hardware.known.values():
                tasks.create_task(driver.run())
            services = Services(self, hardware, Controllers(self, hardware, tasks))
            self.get_logger().info(
                "Resource Manager has been successfully initialized. Starting Controller Manager "
                "services..."
            )
            self.create_timer(1.0 / self.update_rate, services.cycle)
            await self.until_destroyed()


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(ControllerManager)
