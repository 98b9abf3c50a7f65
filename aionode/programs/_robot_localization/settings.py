"""The parameters of robot_localization's filters."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from aionode import Node, Parameter
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.programs._poses import Array
from aionode.programs._robot_localization.kalman import SIZE, Control, Filter
from aionode.programs._robot_localization.measurements import Frames

__all__ = ["OK", "SettingsNode"]

OK: Final = DiagnosticStatus.OK


class SettingsNode(Node):
    """Reads the parameters, and keeps the texts of the diagnostics.

    Args:
        name: The name of the node.
        make_filter: Returns the filter, with the parameters of the node.

    Raises:
        CommandError: A parameter is invalid.
    """

    def __init__(self, name: str, make_filter: Callable[[Node], Filter]) -> None:
        super().__init__(name)
        self.filter = make_filter(self)
        self.has_diagnostics = self.given("print_diagnostics", value=False)
        self.fixed: dict[str, str] = {}
        self.fixed_level = OK
        self.passing: dict[str, str] = {}
        self.declare_frames()
        self.declare_behaviour()
        self.declare_control()
        self.declare_estimate()

    def given(self, name: str, value: Any) -> Any:
        """Declare a parameter, and return its value."""
        return self.declare_parameter(name, value).value

    def optional(self, name: str, kind: Any) -> Any:
        """Declare a parameter without a default; return its value, or None."""
        self.declare_parameter(name, kind)
        return self.get_parameter_or(name, Parameter("", value=None)).value

    def now_ns(self) -> int:
        """Return the time in nanoseconds."""
        return self.get_clock().now().nanoseconds

    def tell(self, key: str, text: str) -> None:
        """Show a text in the next diagnostics, as a warning."""
        if self.has_diagnostics:
            self.passing[key] = text

    def tell_for_good(self, key: str, text: str, level: bytes) -> None:
        """Show a text in all diagnostics."""
        self.fixed[key] = text
        self.fixed_level = max(self.fixed_level, level)

    def declare_frames(self) -> None:
        """Read the names of the frames."""
        self.map = self.given("map_frame", "map")
        self.odom = self.given("odom_frame", "odom")
        base = self.given("base_link_frame", "base_link")
        self.child = self.given("base_link_frame_output", base)
        world = self.given("world_frame", self.odom)
        if len({self.map, self.odom, base}) < 3 or self.child in (self.map, self.odom):
            self.get_logger().error(
                "Invalid frame configuration! The values for map_frame, odom_frame, and "
                "base_link_frame must be unique. If using a base_link_frame_output values, it must "
                "not match the map_frame or odom_frame."
            )
        is_flat = self.given("two_d_mode", value=False)
        gravity = self.given("gravitational_acceleration", 9.80665)
        self.frames = Frames(world, base, is_flat, gravity)

    def declare_behaviour(self) -> None:
        """Read the parameters of timing."""
        self.publishes_tf = self.given("publish_tf", value=True)
        self.publishes_acceleration = self.given("publish_acceleration", value=False)
        self.publishes_corrections = self.given("permit_corrected_publication", value=False)
        self.tf_offset_ns = round(self.given("transform_time_offset", 0.0) * 1e9)
        self.tf_timeout_sec = self.given("transform_timeout", 0.0)
        self.frequency = self.given("frequency", 30.0)
        if not 0.0 < self.frequency < math.inf:
            raise CommandError(f"frequency is {self.frequency}; use a number above 0, in Hz")
        self.predicts_always = self.given("predict_to_current_time", value=False)
        self.sensor_timeout_ns = round(self.given("sensor_timeout", 1.0 / self.frequency) * 1e9)
        self.is_smoothing = self.given("smooth_lagged_data", value=False)
        history = self.given("history_length", 0.0)
        self.history_ns = round(abs(history) * 1e9)
        if history and not self.is_smoothing:
            self.get_logger().error(
                f"Filter history interval of {history:g} specified, but smooth_lagged_data is set "
                "to false. Lagged data will not be smoothed."
            )
        elif history < 0:
            self.get_logger().error(
                f"Negative history interval of {history:g} specified. Absolute value will be "
                "assumed."
            )
        self.resets_on_jump = self.given("reset_on_time_jump", value=False)
        self.is_enabled = not self.given("disabled_at_startup", value=False)
        if self.given("debug", value=False):
            self.get_logger().warning("debug: aionode writes no file with debug output")

    def declare_control(self) -> None:
        """Read the parameters of how the robot follows its commands."""
        is_used = self.given("use_control", value=False)
        timeout_ns = round(self.given("control_timeout", 0.0) * 1e9)
        if not is_used:
            return
        mask = self.optional("control_config", Parameter.Type.BOOL_ARRAY)
        if mask is None or len(mask) != 6:
            what = "is missing" if mask is None else f"has {len(mask)} values, not 6"
            self.get_logger().error(
                f"use_control is set to true, but control_config {what}. No control term will be "
                "used."
            )
            return
        limits = self.six("acceleration_limits", [1.0] * 6)
        gains = self.six("acceleration_gains", [1.0] * 6)
        self.filter.control = Control(
            list(mask),
            timeout_ns,
            limits,
            gains,
            self.six("deceleration_limits", limits),
            self.six("deceleration_gains", gains),
        )

    def six(self, name: str, default: list[float]) -> list[float]:
        """Return a parameter with a value for each velocity."""
        values = self.optional(name, Parameter.Type.DOUBLE_ARRAY)
        if values is None:
            return default
        if len(values) != 6:
            raise CommandError(f"{name} has {len(values)} values; use six, one for each velocity")
        return list(values)

    def declare_estimate(self) -> None:
        """Read the initial state of the filter, its covariance and the process noise."""
        self.filter.is_noise_dynamic = self.given("dynamic_process_noise_covariance", value=False)
        state = self.optional("initial_state", Parameter.Type.DOUBLE_ARRAY)
        if state is not None and len(state) != SIZE:
            self.get_logger().error(
                f"Initial state must be of size {SIZE}. Provided config was of size {len(state)}. "
                "The initial state will be ignored."
            )
        elif state is not None:
            self.filter.state = np.array(state, dtype=float)
        noise = self.covariance("process_noise_covariance")
        if noise is not None:
            self.filter.process_noise = noise
        self.first_covariance = self.covariance("initial_estimate_covariance")
        if self.first_covariance is not None:
            self.filter.covariance = self.first_covariance.copy()

    def covariance(self, name: str) -> Array | None:
        """Return a parameter with a covariance, or with its diagonal."""
        values = self.optional(name, Parameter.Type.DOUBLE_ARRAY)
        if values is None:
            return None
        given = np.array(values, dtype=float)
        if len(given) == SIZE:
            return np.diag(given)
        if len(given) == SIZE * SIZE:
            return given.reshape(SIZE, SIZE)
        raise CommandError(
            f"Invalid {name} specified. Expected a length of {SIZE} or {SIZE * SIZE}, received "
            f"length {len(given)}"
        )
