"""LeRobot's robot and teleoperator for any ROS 2 robot, by a contract of aionode.

LeRobot imports this package by the prefix of its name, and finds the devices by the names of their
configurations.
"""

from lerobot_robot_aionode.config import AionodeRobotConfig, AionodeTeleoperatorConfig
from lerobot_robot_aionode.robot import AionodeRobot
from lerobot_robot_aionode.teleoperator import AionodeTeleoperator

__all__ = [
    "AionodeRobot",
    "AionodeRobotConfig",
    "AionodeTeleoperator",
    "AionodeTeleoperatorConfig",
]
