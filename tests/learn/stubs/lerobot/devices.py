"""What robots and teleoperators have in common here; in LeRobot each has it by itself."""

from __future__ import annotations

import contextlib
import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self, TypeVar

__all__ = ["Choices", "make_device_from_device_class"]

ConfigT = TypeVar("ConfigT")


@dataclass(kw_only=True)
class Choices:
    """What draccus has: configurations by the names of their types.

    Attributes:
        id: Which of several devices of one type.
        calibration_dir: Where its calibration is.
    """

    known: ClassVar[dict[str, type[Any]]]

    id: str | None = None
    calibration_dir: Path | None = None

    @classmethod
    def register_subclass(cls, name: str) -> Any:
        """Return a decorator that gives a configuration its name."""

        def register(config: type[ConfigT]) -> type[ConfigT]:
            cls.known[name] = config
            return config

        return register

    @property
    def type(self) -> str:
        """The name of its type."""
        return next(name for name, each in self.known.items() if each is type(self))


def make_device_from_device_class(config: Choices) -> Any:
    """Return the device of a configuration: its class has the name without ``Config``."""
    of_config = type(config)
    assert of_config.__name__.endswith("Config")
    name = of_config.__name__.removesuffix("Config")
    parent = of_config.__module__.rpartition(".")[0] or of_config.__module__
    for candidate in (parent, f"{parent}.{name.lower()}"):
        try:
            module = importlib.import_module(candidate)
        except ImportError:
            continue
        if hasattr(module, name):
            return getattr(module, name)(config)
    raise ImportError(f"Could not locate device class {name!r}")


class Device:
    """The base of robots and teleoperators."""

    id: str | None

    def __str__(self) -> str:
        return f"{self.id} {self.__class__.__name__}"

    def __del__(self) -> None:
        with contextlib.suppress(Exception):
            if self.is_connected:  # type: ignore[attr-defined]  # abstract in LeRobot
                self.disconnect()  # type: ignore[attr-defined]  # the same

    def __enter__(self) -> Self:
        self.connect()  # type: ignore[attr-defined]  # abstract in LeRobot
        return self

    def __exit__(self, exc_type: object, exc_value: object, traceback: object) -> None:
        self.disconnect()  # type: ignore[attr-defined]  # abstract in LeRobot
