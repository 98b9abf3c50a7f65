"""Teleoperators."""

# ruff: noqa: D102  # LeRobot's

from __future__ import annotations

import abc
from dataclasses import dataclass
from typing import Any, ClassVar

from lerobot.devices import Choices, Device, make_device_from_device_class

__all__ = ["Teleoperator", "TeleoperatorConfig", "make_teleoperator_from_config"]


@dataclass(kw_only=True)
class TeleoperatorConfig(Choices):
    """The configuration of a teleoperator."""

    known: ClassVar = {}


class Teleoperator(Device, abc.ABC):
    """A teleoperator, with what LeRobot 0.6 leaves to its plugins."""

    config_class: type[TeleoperatorConfig]
    name: str

    def __init__(self, config: TeleoperatorConfig) -> None:
        self.id = config.id

    @property
    @abc.abstractmethod
    def action_features(self) -> dict[str, Any]: ...

    @property
    @abc.abstractmethod
    def feedback_features(self) -> dict[str, Any]: ...

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
    def get_action(self) -> dict[str, Any]: ...

    @abc.abstractmethod
    def send_feedback(self, feedback: dict[str, Any]) -> None: ...

    @abc.abstractmethod
    def disconnect(self) -> None: ...


def make_teleoperator_from_config(config: TeleoperatorConfig) -> Teleoperator:
    """Return the teleoperator of a configuration."""
    return make_device_from_device_class(config)  # type: ignore[no-any-return]  # found by its name
