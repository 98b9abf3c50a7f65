"""Services of ur_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.geometry_msgs.msg import Vector3
from aionode.message import DEFAULT, Message, ServiceType, float32, float64, int8

__all__ = ["SetIO", "SetPayload", "SetSpeedSliderFraction"]


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
