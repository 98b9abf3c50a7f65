"""The former name of `rclpy.event_handler`."""

from __future__ import annotations

import warnings

from rclpy import event_handler
from rclpy.event_handler import *  # noqa: F403  # the same names

__all__ = event_handler.__all__

warnings.warn("importing 'qos_event' is deprecated; import 'event_handler' instead", stacklevel=2)
