"""Services of controller_manager_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Duration
from aionode.interfaces.controller_manager_msgs.msg import (
    ControllerState,
    HardwareComponentState,
    HardwareInterface,
)
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.message import DEFAULT, Message, Sequence, ServiceType, int32

__all__ = [
    "CleanupController",
    "ConfigureController",
    "ListControllerTypes",
    "ListControllers",
    "ListHardwareComponents",
    "ListHardwareInterfaces",
    "LoadController",
    "ReloadControllerLibraries",
    "SetHardwareComponentState",
    "SwitchController",
    "UnloadController",
]


class CleanupController(ServiceType, typename="controller_manager_msgs/srv/CleanupController"):
    """CleanupController, as ros2_control defines it."""

    class Request(Message):
        """The request of CleanupController."""

        name: str = ""

    class Response(Message):
        """The response of CleanupController."""

        ok: bool = False


class ConfigureController(ServiceType, typename="controller_manager_msgs/srv/ConfigureController"):
    """ConfigureController, as ros2_control defines it."""

    class Request(Message):
        """The request of ConfigureController."""

        name: str = ""

    class Response(Message):
        """The response of ConfigureController."""

        ok: bool = False


class ListControllerTypes(ServiceType, typename="controller_manager_msgs/srv/ListControllerTypes"):
    """ListControllerTypes, as ros2_control defines it."""

    class Request(Message):
        """The request of ListControllerTypes."""

    class Response(Message):
        """The response of ListControllerTypes."""

        types: Annotated[list[str], Sequence[str]] = DEFAULT
        base_classes: Annotated[list[str], Sequence[str]] = DEFAULT


class ListControllers(ServiceType, typename="controller_manager_msgs/srv/ListControllers"):
    """ListControllers, as ros2_control defines it."""

    class Request(Message):
        """The request of ListControllers."""

    class Response(Message):
        """The response of ListControllers."""

        controller: Annotated[list[ControllerState], Sequence[ControllerState]] = DEFAULT


class ListHardwareComponents(
    ServiceType, typename="controller_manager_msgs/srv/ListHardwareComponents"
):
    """ListHardwareComponents, as ros2_control defines it."""

    class Request(Message):
        """The request of ListHardwareComponents."""

    class Response(Message):
        """The response of ListHardwareComponents."""

        component: Annotated[list[HardwareComponentState], Sequence[HardwareComponentState]] = (
            DEFAULT
        )


class ListHardwareInterfaces(
    ServiceType, typename="controller_manager_msgs/srv/ListHardwareInterfaces"
):
    """ListHardwareInterfaces, as ros2_control defines it."""

    class Request(Message):
        """The request of ListHardwareInterfaces."""

    class Response(Message):
        """The response of ListHardwareInterfaces."""

        command_interfaces: Annotated[list[HardwareInterface], Sequence[HardwareInterface]] = (
            DEFAULT
        )
        state_interfaces: Annotated[list[HardwareInterface], Sequence[HardwareInterface]] = DEFAULT


class LoadController(ServiceType, typename="controller_manager_msgs/srv/LoadController"):
    """LoadController, as ros2_control defines it."""

    class Request(Message):
        """The request of LoadController."""

        name: str = ""

    class Response(Message):
        """The response of LoadController."""

        ok: bool = False


class ReloadControllerLibraries(
    ServiceType, typename="controller_manager_msgs/srv/ReloadControllerLibraries"
):
    """ReloadControllerLibraries, as ros2_control defines it."""

    class Request(Message):
        """The request of ReloadControllerLibraries."""

        force_kill: bool = False

    class Response(Message):
        """The response of ReloadControllerLibraries."""

        ok: bool = False


class SetHardwareComponentState(
    ServiceType, typename="controller_manager_msgs/srv/SetHardwareComponentState"
):
    """SetHardwareComponentState, as ros2_control defines it."""

    class Request(Message):
        """The request of SetHardwareComponentState."""

        name: str = ""
        target_state: State = DEFAULT

    class Response(Message):
        """The response of SetHardwareComponentState."""

        ok: bool = False
        state: State = DEFAULT


class SwitchController(ServiceType, typename="controller_manager_msgs/srv/SwitchController"):
    """SwitchController, as ros2_control defines it."""

    class Request(Message):
        """The request of SwitchController."""

        BEST_EFFORT: ClassVar[int32] = 1
        STRICT: ClassVar[int32] = 2
        AUTO: ClassVar[int32] = 3
        FORCE_AUTO: ClassVar[int32] = 4

        activate_controllers: Annotated[list[str], Sequence[str]] = DEFAULT
        deactivate_controllers: Annotated[list[str], Sequence[str]] = DEFAULT
        strictness: int32 = 0
        activate_asap: bool = False
        timeout: Duration = DEFAULT

    class Response(Message):
        """The response of SwitchController."""

        ok: bool = False
        message: str = ""


class UnloadController(ServiceType, typename="controller_manager_msgs/srv/UnloadController"):
    """UnloadController, as ros2_control defines it."""

    class Request(Message):
        """The request of UnloadController."""

        name: str = ""

    class Response(Message):
        """The response of UnloadController."""

        ok: bool = False
