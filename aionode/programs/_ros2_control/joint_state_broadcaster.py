"""``joint_state_broadcaster``: publishes the states of the hardware's joints."""

from __future__ import annotations

import math
from typing import Any, Final

from aionode import Time
from aionode.interfaces.control_msgs.msg import DynamicJointState, InterfaceValue
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.lifecycle import State, TransitionCallbackReturn
from aionode.programs._ros2_control.controller import Controller
from aionode.programs._ros2_control.hardware import Hardware

__all__ = ["JointStateBroadcaster"]

FIELDS: Final = ("position", "velocity", "effort")


class JointStateBroadcaster(Controller):
    """Publishes `joint_states`, and `dynamic_joint_states` while somebody listens."""

    def __init__(self, name: str, hardware: Hardware, **options: Any) -> None:
        super().__init__(name, hardware, **options)
        self.joints: list[str] = list(self.declare_parameter("joints", [""]).value)
        self.interfaces: list[str] = list(self.declare_parameter("interfaces", [""]).value)
        self.extra_joints: list[str] = list(self.declare_parameter("extra_joints", [""]).value)
        self.filters = self.declare_parameter("use_urdf_to_filter", True).value
        self.frame_id: str = self.declare_parameter("frame_id", "base_link").value
        prefix = "map_interface_to_joint_state"
        self.given = {
            field: self.declare_parameter(f"{prefix}.{field}", field).value for field in FIELDS
        }
        self.names: list[str] = []
        self.sources: dict[str, list[str]] = {}
        topics = "~/" if self.declare_parameter("use_local_topics", False).value else ""
        self.publisher = self.create_publisher(JointState, f"{topics}joint_states", 10)
        self.dynamic = self.create_publisher(DynamicJointState, f"{topics}dynamic_joint_states", 10)

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Find the interfaces."""
        joints, interfaces = (
            [each for each in names if each] for names in (self.joints, self.interfaces)
        )
        if joints and interfaces:
            self.get_logger().info(
                "Publishing state interfaces defined in 'joints' and 'interfaces' parameters."
            )
            self.state_names = [f"{joint}/{each}" for joint in joints for each in interfaces]
        else:
            self.get_logger().info(
                "'joints' or 'interfaces' parameter is empty. All available state interfaces will "
                "be published"
            )
            self.state_names = list(self.hardware.state_interfaces)
        names = {field: field if field in interfaces else self.given[field] for field in FIELDS}
        known = self.hardware.description.robot.joints
        wanted: dict[str, None] = {}
        for name in self.state_names:
            joint, _, interface = name.rpartition("/")
            if interface in names.values() and (joints or not self.filters or joint in known):
                wanted[joint] = None
        wanted |= dict.fromkeys(each for each in self.extra_joints if each)
        self.sources = {field: [f"{joint}/{names[field]}" for joint in wanted] for field in FIELDS}
        self.names = list(wanted)
        return super().on_configure(state)

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Start, if there is anything to publish."""
        if not self.state_names:
            self.get_logger().error("No state interfaces found to publish.")
            return TransitionCallbackReturn.FAILURE
        return super().on_activate(state)

    def update(self, now: Time, period_sec: float) -> None:
        """Publish."""
        del period_sec
        states = {name: self.hardware.states[name] for name in self.state_names}
        msg = JointState(name=self.names)
        msg.header.stamp = now.to_msg()
        msg.header.frame_id = self.frame_id
        for field, sources in self.sources.items():
            missing = [0.0 if joint in self.extra_joints else math.nan for joint in self.names]
            values = [states.get(name, other) for name, other in zip(sources, missing, strict=True)]
            setattr(msg, field, values)
        self.publisher.publish(msg)
        if self.dynamic.get_subscription_count():
            self.dynamic.publish(self.dynamic_states(msg))

    def dynamic_states(self, msg: JointState) -> DynamicJointState:
        """Return all interfaces with their values, by joint, sensor or GPIO."""
        groups: dict[str, InterfaceValue] = {}
        for name in self.state_names:
            part, _, interface = name.rpartition("/")
            group = groups.setdefault(part, InterfaceValue(interface_names=[], values=[]))
            group.interface_names = [*group.interface_names, interface]
            group.values = [*group.values, self.hardware.states[name]]
        return DynamicJointState(
            header=msg.header, joint_names=list(groups), interface_values=list(groups.values())
        )
