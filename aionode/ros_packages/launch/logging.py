"""`launch.logging`."""

from __future__ import annotations

import logging
import os
from pathlib import Path

__all__ = ["LaunchConfig", "get_logger", "launch_config"]


class LaunchConfig:
    """The settings of launch's log that programs use."""

    @property
    def level(self) -> int:
        """The minimum level of messages to show."""
        return logging.getLogger("launch").getEffectiveLevel()

    @level.setter
    def level(self, new_level: int | str) -> None:
        logging.getLogger("launch").setLevel(new_level)

    @property
    def log_dir(self) -> str:
        """The folder of logs: ROS_LOG_DIR, or log below ROS_HOME."""
        home = os.environ.get("ROS_HOME") or str(Path.home() / ".ros")
        return os.environ.get("ROS_LOG_DIR") or str(Path(home, "log"))


launch_config = LaunchConfig()


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger of Python's logging module, below ``launch``."""
    return logging.getLogger(f"launch.{name}" if name else "launch")
