"""Robots."""

# ruff: noqa: D102  # LeRobot's

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import Any, ClassVar

from lerobot.devices import Choices, Device, make_device_from_device_class

__all__ = ["Robot", "RobotConfig", "make_robot_from_config"]


@dataclass(kw_only=True)
class RobotConfig(Choices):
    """The configuration of a robot."""

    known: ClassVar = {}


class Robot(Device, abc.ABC):
    """A robot, with what LeRobot 0.6 leaves to its plugins."""

    config_class: type[RobotConfig]
    name: str

    def __init__(self, config: RobotConfig) -> None:
        self.robot_type = self.name
        self.id = config.id

    @property
    @abc.abstractmethod
    def observation_features(self) -> dict[str, Any]: ...

    @property
    @abc.abstractmethod
    def action_features(self) -> dict[str, Any]: ...

    @property
    @abc.abstractmethod
    def is_connected(self) -> bool: ...

    @abc.abstractmethod
    def connect(self, calibrate: bool = True) -> None: ...

    @property
    @abc.abstractmethod
    def is_calibrated(self) -> bool: ...

    @abc.abstractmethod
    def calibrate(self) -> None: ...

    @abc.abstractmethod
    def configure(self) -> None: ...

    @abc.abstractmethod
    def get_observation(self) -> dict[str, Any]: ...

    @abc.abstractmethod
    def send_action(self, action: dict[str, Any]) -> dict[str, Any]: ...

    @abc.abstractmethod
    def disconnect(self) -> None: ...


def make_robot_from_config(config: RobotConfig) -> Robot:
    """Return the robot of a configuration."""
    return make_device_from_device_class(config)  # type: ignore[no-any-return]  # found by its name
