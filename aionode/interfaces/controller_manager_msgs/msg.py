"""Messages of controller_manager_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, Sequence, uint16

__all__ = [
    "ChainConnection",
    "ControllerManagerActivity",
    "ControllerState",
    "HardwareComponentState",
    "HardwareInterface",
    "NamedLifecycleState",
]


class ChainConnection(Message, typename="controller_manager_msgs/msg/ChainConnection"):
    """ChainConnection, as ros2_control defines it."""

    name: str = ""
    reference_interfaces: Annotated[list[str], Sequence[str]] = DEFAULT


class NamedLifecycleState(Message, typename="controller_manager_msgs/msg/NamedLifecycleState"):
    """NamedLifecycleState, as ros2_control defines it."""

    name: str = ""
    state: State = DEFAULT


class ControllerManagerActivity(
    Message, typename="controller_manager_msgs/msg/ControllerManagerActivity"
):
    """ControllerManagerActivity, as ros2_control defines it."""

    header: Header = DEFAULT
    controllers: Annotated[list[NamedLifecycleState], Sequence[NamedLifecycleState]] = DEFAULT
    hardware_components: Annotated[list[NamedLifecycleState], Sequence[NamedLifecycleState]] = (
        DEFAULT
    )


class ControllerState(Message, typename="controller_manager_msgs/msg/ControllerState"):
    """ControllerState, as ros2_control defines it."""

    name: str = ""
    state: str = ""
    type: str = ""
    is_async: bool = False
    update_rate: uint16 = 0
    claimed_interfaces: Annotated[list[str], Sequence[str]] = DEFAULT
    required_command_interfaces: Annotated[list[str], Sequence[str]] = DEFAULT
    required_state_interfaces: Annotated[list[str], Sequence[str]] = DEFAULT
    is_chainable: bool = False
    is_chained: bool = False
    exported_state_interfaces: Annotated[list[str], Sequence[str]] = DEFAULT
    reference_interfaces: Annotated[list[str], Sequence[str]] = DEFAULT
    chain_connections: Annotated[list[ChainConnection], Sequence[ChainConnection]] = DEFAULT


class HardwareInterface(Message, typename="controller_manager_msgs/msg/HardwareInterface"):
    """HardwareInterface, as ros2_control defines it."""

    name: str = ""
    data_type: str = ""
    is_available: bool = False
    is_claimed: bool = False


class HardwareComponentState(
    Message, typename="controller_manager_msgs/msg/HardwareComponentState"
):
    """HardwareComponentState, as ros2_control defines it."""

    name: str = ""
    type: str = ""
    is_async: bool = False
    rw_rate: uint16 = 0
    class_type: str = ""
    plugin_name: str = ""
    state: State = DEFAULT
    command_interfaces: Annotated[list[HardwareInterface], Sequence[HardwareInterface]] = DEFAULT
    state_interfaces: Annotated[list[HardwareInterface], Sequence[HardwareInterface]] = DEFAULT
