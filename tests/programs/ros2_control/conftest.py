"""A robot on mock hardware with its controller manager, and who uses it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aionode import DurabilityPolicy, Node, QoSProfile
from aionode.interfaces.controller_manager_msgs import srv
from aionode.interfaces.std_msgs.msg import String
from aionode.programs._ros2_control.client import ManagerClient
from aionode.programs._ros2_control.manager import ControllerManager
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

WHEEL = """
  <joint name="{0}" type="continuous"> <parent link="base"/> <child link="{0}_link"/> </joint>
  <link name="{0}_link"/>
"""
DRIVE = """
  <joint name="{0}">
    <command_interface name="velocity"/>
    <state_interface name="position"/> <state_interface name="velocity"/>
  </joint>
"""
ARM = """
<robot name="bot">
  <link name="base"/> <link name="upper"/> <link name="finger"/>
  <joint name="lift" type="revolute">
    <parent link="base"/> <child link="upper"/> <limit lower="-1" upper="2" velocity="3"/>
  </joint>
  <joint name="grip" type="prismatic">
    <parent link="upper"/> <child link="finger"/> <limit lower="0" upper="1"/>
    <mimic joint="lift" multiplier="0.5" offset="0.1"/>
  </joint>
  {wheels}
  <ros2_control name="{name}" type="system">
    <hardware> <plugin>{plugin}</plugin> {parameters} </hardware>
    <joint name="lift">
      <command_interface name="position"/> <command_interface name="velocity"/>
      <state_interface name="position"> <param name="initial_value">0.25</param> </state_interface>
      <state_interface name="velocity"/>
    </joint>
    <joint name="grip"> <state_interface name="position"/> </joint>
    <sensor name="force"> <state_interface name="z"/> </sensor>
    <gpio name="lamp"> <command_interface name="on"/> <state_interface name="on"/> </gpio>
    {drives}
  </ros2_control>
</robot>
"""


def urdf(
    plugin: str = "mock_components/GenericSystem", name: str = "Bot", **parameters: object
) -> str:
    """Return the description of a robot with an arm and two wheels."""
    given = "".join(f'<param name="{key}">{value}</param>' for key, value in parameters.items())
    return ARM.format(
        plugin=plugin,
        name=name,
        parameters=given,
        wheels="".join(WHEEL.format(each) for each in ("left", "right")),
        drives="".join(DRIVE.format(each) for each in ("left", "right")),
    )


MOVING = urdf(calculate_dynamics="true")

BASE: dict[str, Any] = {
    "joints.type": "joint_state_broadcaster/JointStateBroadcaster",
    "base.type": "diff_drive_controller/DiffDriveController",
    "arm.type": "position_controllers/JointGroupPositionController",
    "other.type": "forward_command_controller/ForwardCommandController",
    "far.type": "mecanum_drive_controller/MecanumDriveController",
}
"""Parameters of the manager."""

OWN = """
base:
  ros__parameters:
    left_wheel_names: [left]
    right_wheel_names: [right]
    wheel_separation: 0.5
    wheel_radius: 0.1
    {base}
arm: {{ros__parameters: {{joints: [lift]}}}}
other: {{ros__parameters: {{joints: [lift], interface_name: position}}}}
"""
"""Parameters of controllers."""


class Robot:
    """A running manager, and who uses it."""

    def __init__(self, manager: Node, user: Node, clock: ManualClock) -> None:
        self.manager: Any = manager
        self.user = user
        self.clock = clock
        self.client = ManagerClient(user, "/controller_manager")

    async def pass_time(self, seconds: float) -> None:
        """Let time pass."""
        await self.clock.advance(seconds)
        await settle()

    async def call(self, service: str, kind: Any, /, **fields: Any) -> Any:
        """Call a service of the manager."""
        return await self.client.call(kind, service, kind.Request(**fields))

    async def load(self, name: str) -> bool:
        """Load and configure a controller."""
        loaded = await self.call("load_controller", srv.LoadController, name=name)
        return bool(
            loaded.ok
            and (await self.call("configure_controller", srv.ConfigureController, name=name)).ok
        )

    async def switch(self, start: list[str], stop: list[str], *, strict: bool = True) -> Any:
        """Switch controllers."""
        return await self.call(
            "switch_controller",
            srv.SwitchController,
            activate_controllers=start,
            deactivate_controllers=stop,
            strictness=2 if strict else 1,
        )

    async def start(self, name: str) -> None:
        """Load, configure and activate a controller."""
        assert await self.load(name)
        assert (await self.switch([name], [])).ok
        await settle()

    async def states(self) -> dict[str, str]:
        """Return the states of the controllers."""
        answer = await self.call("list_controllers", srv.ListControllers)
        return {each.name: each.state for each in answer.controller}

    def hear(self, kind: Any, topic: str) -> list[Any]:
        """Return what comes on a topic from now on."""
        heard: list[Any] = []
        self.user.create_subscription(kind, topic, heard.append, 10)
        return heard

    @property
    def commands(self) -> dict[str, float]:
        """The commands to the hardware."""
        commands: dict[str, float] = self.manager.hardware.commands
        return commands


@pytest.fixture
def robot(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any], tmp_path: Path
) -> Callable[..., Any]:
    """Start the manager with a robot, on which an arm, wheels and sensors are mocked."""

    async def make(description: str = MOVING, base: str = "", **parameters: Any) -> Robot:
        file = tmp_path / "controllers.yaml"
        file.write_text(OWN.format(base=base))
        files = {f"{name}.params_file": str(file) for name in ("base", "arm", "other")}
        await manual_clock.advance(100.0)
        manager = start(ControllerManager, **BASE | files | parameters)
        user = node_factory("user")
        publisher = user.create_publisher(String, "robot_description", LATCHED)
        publisher.publish(String(data=description))
        await settle()
        await manual_clock.advance(0.01)
        await settle()
        return Robot(manager, user, manual_clock)

    return make
