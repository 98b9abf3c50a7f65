"""What LeRobot is told of a robot and of a teleoperator: the file of a contract."""

from __future__ import annotations

from dataclasses import dataclass, field

from lerobot.robots import RobotConfig
from lerobot.teleoperators import TeleoperatorConfig

__all__ = ["AionodeRobotConfig", "AionodeTeleoperatorConfig"]


@RobotConfig.register_subclass("aionode")
@dataclass(kw_only=True)
class AionodeRobotConfig(RobotConfig):
    """A ROS 2 robot: ``--robot.type=aionode --robot.contract=contract.yaml``.

    Attributes:
        contract: The file of the contract.
    """

    contract: str


@TeleoperatorConfig.register_subclass("aionode")
@dataclass(kw_only=True)
class AionodeTeleoperatorConfig(TeleoperatorConfig):
    """Whatever publishes the commands of a contract: ``--teleop.type=aionode``.

    Attributes:
        contract: The file of the contract.
        topics: The topic on which commands for each topic of the contract come, as the robot
            publishes on the contract's; by default that topic with ``/leader`` before it.
    """

    contract: str
    topics: dict[str, str] = field(default_factory=dict)
