"""``vesc_driver vesc_driver_node``: drives the motor and servo of a VESC, and reads it."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from typing import Final

import aionode
from aionode import Node
from aionode.errors import CommandError, escaped
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_msgs.msg import Float64, Header
from aionode.interfaces.vesc_msgs.msg import VescImuStamped, VescStateStamped
from aionode.programs._serial import SerialPort
from aionode.programs._vesc import packets
from aionode.programs._vesc.numbers import FIXED, number
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["VescDriver", "main"]

BAUDRATE: Final = 115_200
POLL_SEC: Final = 0.02
SILENT_POLLS: Final = 100
"""The number of polls without an answer after which the VESC counts as silent."""

MIN_SEC: Final = 0.01
MAX_SEC: Final = 3600.0
"""The range of `command_timeout`."""

LOG_SEC: Final = 10.0
"""How often a recurring problem is logged."""


class Limit:
    """The range of a command, as the parameters ``NAME_min`` and ``NAME_max`` say.

    Args:
        node: The node with the parameters.
        name: The name of the command.
        feasible: The range within which the limits have to be.
    """

    def __init__(self, node: Node, name: str, feasible: tuple[float, float]) -> None:
        self.name = name
        self.log = node.get_logger()
        self.least = self.limit(node, f"{name}_min", feasible)
        self.greatest = self.limit(node, f"{name}_max", feasible)
        if self.greatest < self.least:
            self.log.warning(
                f"Parameter {name}_max ({self.greatest:g}) is less than parameter {name}_min "
                f"({self.least:g})."
            )
            self.least, self.greatest = self.greatest, self.least

    def limit(self, node: Node, name: str, feasible: tuple[float, float]) -> float:
        """Return the value of a parameter, moved into the feasible range."""
        given = number(node, name, 0.0)
        moved = min(max(given, feasible[0]), feasible[1])
        if moved != given:
            below = given < moved
            self.log.warning(
                f"Parameter {name} ({given:g}) is {'less' if below else 'greater'} than the "
                f"feasible {'minimum' if below else 'maximum'} ({moved:g})."
            )
        return moved

    def clip(self, value: float) -> float:
        """Return a command within the range."""
        if value < self.least:
            self.log.info(
                f"{self.name} command value ({value:f}) below minimum limit ({self.least:f}), "
                "clipping.",
                throttle_duration_sec=LOG_SEC,
            )
        elif value > self.greatest:
            self.log.info(
                f"{self.name} command value ({value:f}) above maximum limit ({self.greatest:f}), "
                "clipping.",
                throttle_duration_sec=LOG_SEC,
            )
        return min(max(value, self.least), self.greatest)


class VescDriver(Node):
    """Passes commands to a VESC, and publishes what it measures.

    The motor is released when its commands stop, and when the node ends.

    Raises:
        CommandError: A parameter is invalid.
    """

    port: SerialPort | None = None

    def __init__(self) -> None:
        super().__init__("vesc_driver")
        self.path = self.declare_parameter("port", "", FIXED).value
        if not self.path:
            raise CommandError("parameter 'port' is missing; it names a device: /dev/ttyACM0")
        unlimited = (-math.inf, math.inf)
        self.limits = {
            "duty_cycle": Limit(self, "duty_cycle", (-1.0, 1.0)),
            **{name: Limit(self, name, unlimited) for name in ("current", "brake", "speed")},
            "position": Limit(self, "position", unlimited),
            "servo": Limit(self, "servo", (0.0, 1.0)),
        }
        self.silence_sec = number(self, "command_timeout", 0.3)
        if not MIN_SEC <= self.silence_sec <= MAX_SEC:
            raise CommandError(
                f"parameter 'command_timeout' is {self.silence_sec:g}; it has to be from "
                f"{MIN_SEC:g} to {MAX_SEC:g} seconds: the motor is released when its "
                "commands stop for that long"
            )
        self.frames = packets.Frames()
        self.answers = {
            packets.GET_FIRMWARE: self.on_firmware,
            packets.GET_VALUES: self.on_values,
            packets.GET_IMU[:1]: self.on_imu,
        }
        self.firmware: packets.Firmware | None = None
        self.unanswered = 0
        self.commanded = ""
        self.state = self.create_publisher(VescStateStamped, "sensors/core", 10)
        self.imu = self.create_publisher(VescImuStamped, "sensors/imu", 10)
        self.raw_imu = self.create_publisher(Imu, "sensors/imu/raw", 10)
        self.servo = self.create_publisher(Float64, "sensors/servo_position_command", 10)
        for name in packets.COMMANDS:
            self.create_subscription(
                Float64,
                f"commands/motor/{name}",
                self.commanding(name),
                10,
                on_silence=self.silencing(name),
                silence_sec=self.silence_sec,
            )
        self.create_subscription(Float64, "commands/servo/position", self.on_servo, 10)
        self.polling = create_wall_timer(self, POLL_SEC, self.poll, autostart=False)
        self.start = create_wall_timer(self, 0.0, self.serve)

    async def serve(self) -> None:
        """Read what the VESC sends; release the motor when the node ends, even when it fails.

        Raises:
            CommandError: The serial port cannot be opened, or is gone.
        """
        self.start.cancel()
        try:
            self.port = await SerialPort.open(self.path, BAUDRATE)
        except OSError as error:
            raise CommandError(f"Failed to connect to the VESC, {error}.") from None
        self.polling.reset()
        try:
            while True:
                self.on_data(await self.port.read())
        except OSError as error:
            raise CommandError(
                f"Unexpectedly disconnected from serial port: {error.strerror}"
            ) from None
        finally:
            self.release()
            self.port.close()

    def poll(self) -> None:
        """Request the measurements of the VESC or, before anything else, its version."""
        self.unanswered += 1
        if self.unanswered == SILENT_POLLS:
            self.get_logger().warning(
                f"no VESC answers on {self.path!r}: check its power, and that USB, or its "
                "UART with 115200 baud, is enabled"
            )
        if self.firmware is None:
            self.send(packets.GET_FIRMWARE)
        else:
            self.send(packets.GET_VALUES)
            self.send(packets.GET_IMU)

    def send(self, payload: bytes) -> None:
        """Send a payload in a frame; while the VESC accepts nothing, only the newest is kept."""
        if self.port is not None:
            with suppress(OSError):  # it is gone, which ends `serve`, or takes nothing at all
                self.port.write_latest(packets.framed(payload))

    def on_data(self, data: bytes) -> None:
        """Process received bytes."""
        skipped = self.frames.skipped
        for payload in self.frames.feed(data):
            answer = self.answers.get(payload[:1])
            if answer is None:
                continue
            if answer(payload):
                self.unanswered = 0
            else:
                self.get_logger().warning(
                    f"ignored an answer of the VESC, {payload[0]} with {len(payload)} bytes: "
                    "its firmware is older than 5.2, or damaged",
                    throttle_duration_sec=LOG_SEC,
                )
        if self.frames.skipped > skipped:
            self.get_logger().warning(
                f"Out-of-sync with VESC, {self.frames.skipped} bytes discarded so far.",
                throttle_duration_sec=LOG_SEC,
            )

    def on_firmware(self, payload: bytes) -> bool:
        """Begin to pass commands; return whether the answer is understood."""
        firmware = packets.firmware_of(payload)
        if firmware is not None and self.firmware is None:
            self.firmware = firmware
            log = self.get_logger()
            hardware = escaped(firmware.hardware, one_line=True)
            log.info(f"-={hardware}=- hardware paired {firmware.is_paired:d}")
            log.info(f"Connected to VESC with firmware version {firmware.major}.{firmware.minor}")
            self.release()  # it may still turn as another program has left it
        return firmware is not None

    def on_values(self, payload: bytes) -> bool:
        """Publish the measured values; return whether the answer is understood."""
        state = packets.state_of(payload)
        if state is not None:
            self.state.publish(VescStateStamped(header=self.header(), state=state))
        return state is not None

    def on_imu(self, payload: bytes) -> bool:
        """Publish the values of the IMU; return whether the answer is understood."""
        imu = packets.imu_of(payload)
        if imu is not None:
            header = self.header()
            self.imu.publish(VescImuStamped(header=header, imu=imu))
            self.raw_imu.publish(
                Imu(
                    header=header,
                    orientation=imu.orientation,
                    angular_velocity=imu.angular_velocity,
                    linear_acceleration=imu.linear_acceleration,
                )
            )
        return imu is not None

    def header(self) -> Header:
        """Return a header with the time."""
        return Header(stamp=self.get_clock().now().to_msg())

    def commanding(self, name: str) -> Callable[[Float64], None]:
        """Return the callback for a command of the motor."""

        def on_command(msg: Float64) -> None:
            if self.firmware is None:
                return
            if not math.isfinite(msg.data):
                self.warn_of(name, msg.data)
                self.release()  # it does not go on as before
                return
            self.commanded = name
            self.send(packets.command(name, self.limits[name].clip(msg.data)))

        return on_command

    def silencing(self, name: str) -> Callable[[], None]:
        """Return the callback for the silence of a command; others may have taken its place."""

        def on_silence() -> None:
            if self.commanded == name:
                self.release()

        return on_silence

    def release(self) -> None:
        """Stop driving the motor."""
        self.commanded = ""
        self.send(packets.RELEASE)

    def on_servo(self, msg: Float64) -> None:
        """Move the servo, and publish where it is, as the VESC does not say that."""
        if self.firmware is None:
            return
        if not math.isfinite(msg.data):
            self.warn_of("servo", msg.data)
            return
        position = self.limits["servo"].clip(msg.data)
        self.send(packets.command("servo", position))
        self.servo.publish(Float64(data=position))

    def warn_of(self, name: str, value: float) -> None:
        """Log a command that is not finite."""
        self.get_logger().warning(
            f"ignored a {name} command, because it is not finite: {value}",
            throttle_duration_sec=LOG_SEC,
        )


def main() -> None:
    """Run the node until Ctrl-C, or until the VESC is unplugged."""
    aionode.run(VescDriver)
