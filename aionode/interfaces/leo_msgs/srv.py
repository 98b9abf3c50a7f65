"""Services of leo_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message, ServiceType, float64

__all__ = ["SetImuCalibration"]


class SetImuCalibration(ServiceType, typename="leo_msgs/srv/SetImuCalibration"):
    """SetImuCalibration, as Leo Rover defines it."""

    class Request(Message):
        """The request of SetImuCalibration."""

        gyro_bias_x: float64 = 0.0
        gyro_bias_y: float64 = 0.0
        gyro_bias_z: float64 = 0.0

    class Response(Message):
        """The response of SetImuCalibration."""

        success: bool = False
