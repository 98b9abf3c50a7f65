"""Services of ur_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.geometry_msgs.msg import PoseStamped, Twist, Vector3, Wrench
from aionode.interfaces.ur_msgs.msg import Analog
from aionode.message import (
    DEFAULT,
    Array,
    Message,
    ServiceType,
    float32,
    float64,
    int8,
    uint8,
    uint32,
)

__all__ = [
    "GetRobotSoftwareVersion",
    "SetAnalogOutput",
    "SetForceMode",
    "SetIO",
    "SetPayload",
    "SetSpeedSliderFraction",
]


class GetRobotSoftwareVersion(ServiceType, typename="ur_msgs/srv/GetRobotSoftwareVersion"):
    """GetRobotSoftwareVersion, as Universal Robots defines it."""

    class Request(Message):
        """The request of GetRobotSoftwareVersion."""

    class Response(Message):
        """The response of GetRobotSoftwareVersion."""

        major: uint32 = 0
        minor: uint32 = 0
        bugfix: uint32 = 0
        build: uint32 = 0


class SetAnalogOutput(ServiceType, typename="ur_msgs/srv/SetAnalogOutput"):
    """SetAnalogOutput, as Universal Robots defines it."""

    class Request(Message):
        """The request of SetAnalogOutput."""

        data: Analog = DEFAULT

    class Response(Message):
        """The response of SetAnalogOutput."""

        success: bool = False


class SetForceMode(ServiceType, typename="ur_msgs/srv/SetForceMode"):
    """SetForceMode, as Universal Robots defines it."""

    class Request(Message):
        """The request of SetForceMode."""

        TCP_TO_ORIGIN: ClassVar[uint8] = 1
        NO_TRANSFORM: ClassVar[uint8] = 2
        TCP_VELOCITY_TO_X_Y: ClassVar[uint8] = 3

        task_frame: PoseStamped = DEFAULT
        selection_vector_x: bool = False
        selection_vector_y: bool = False
        selection_vector_z: bool = False
        selection_vector_rx: bool = False
        selection_vector_ry: bool = False
        selection_vector_rz: bool = False
        wrench: Wrench = DEFAULT
        type: uint8 = 2
        speed_limits: Twist = DEFAULT
        deviation_limits: Array[float32, 6] = (0.01, 0.01, 0.01, 0.01, 0.01, 0.01)
        damping_factor: float32 = 0.025
        gain_scaling: float32 = 0.5

    class Response(Message):
        """The response of SetForceMode."""

        success: bool = False


class SetIO(ServiceType, typename="ur_msgs/srv/SetIO"):
    """SetIO, as Universal Robots defines it."""

    class Request(Message):
        """The request of SetIO."""

        PIN_AOUT0: ClassVar[int8] = 0
        PIN_AOUT1: ClassVar[int8] = 1
        PIN_DOUT0: ClassVar[int8] = 0
        PIN_DOUT1: ClassVar[int8] = 1
        PIN_DOUT2: ClassVar[int8] = 2
        PIN_DOUT3: ClassVar[int8] = 3
        PIN_DOUT4: ClassVar[int8] = 4
        PIN_DOUT5: ClassVar[int8] = 5
        PIN_DOUT6: ClassVar[int8] = 6
        PIN_DOUT7: ClassVar[int8] = 7
        PIN_CONF_OUT0: ClassVar[int8] = 8
        PIN_CONF_OUT1: ClassVar[int8] = 9
        PIN_CONF_OUT2: ClassVar[int8] = 10
        PIN_CONF_OUT3: ClassVar[int8] = 11
        PIN_CONF_OUT4: ClassVar[int8] = 12
        PIN_CONF_OUT5: ClassVar[int8] = 13
        PIN_CONF_OUT6: ClassVar[int8] = 14
        PIN_CONF_OUT7: ClassVar[int8] = 15
        PIN_TOOL_DOUT0: ClassVar[int8] = 16
        PIN_TOOL_DOUT1: ClassVar[int8] = 17
        FUN_SET_DIGITAL_OUT: ClassVar[int8] = 1
        FUN_SET_FLAG: ClassVar[int8] = 2
        FUN_SET_ANALOG_OUT: ClassVar[int8] = 3
        FUN_SET_TOOL_VOLTAGE: ClassVar[int8] = 4
        STATE_OFF: ClassVar[int8] = 0
        STATE_ON: ClassVar[int8] = 1
        STATE_TOOL_VOLTAGE_0V: ClassVar[int8] = 0
        STATE_TOOL_VOLTAGE_12V: ClassVar[int8] = 12
        STATE_TOOL_VOLTAGE_24V: ClassVar[int8] = 24

        fun: int8 = 0
        pin: int8 = 0
        state: float32 = 0.0

    class Response(Message):
        """The response of SetIO."""

        success: bool = False


class SetPayload(ServiceType, typename="ur_msgs/srv/SetPayload"):
    """SetPayload, as Universal Robots defines it."""

    class Request(Message):
        """The request of SetPayload."""

        mass: float32 = 0.0
        center_of_gravity: Vector3 = DEFAULT

    class Response(Message):
        """The response of SetPayload."""

        success: bool = False


class SetSpeedSliderFraction(ServiceType, typename="ur_msgs/srv/SetSpeedSliderFraction"):
    """SetSpeedSliderFraction, as Universal Robots defines it."""

    class Request(Message):
        """The request of SetSpeedSliderFraction."""

        speed_slider_fraction: float64 = 0.0

    class Response(Message):
        """The response of SetSpeedSliderFraction."""

        success: bool = False
