"""``ydlidar_ros2_driver ydlidar_ros2_driver_node``: publishes the scans of a YDLIDAR."""

from __future__ import annotations

import asyncio
import math
from itertools import pairwise
from typing import Any, Final

import aionode
from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_srvs.srv import Empty
from aionode.programs._serial import SerialPort
from aionode.programs._stamps import stamp_of
from aionode.programs._wall_timer import create_wall_timer, wall_clock
from aionode.programs._ydlidar.lidar import TRIANGLE, TYPES, Lidar
from aionode.programs._ydlidar.packets import SAMPLES, Packet, Packets, Points
from aionode.programs._ydlidar.scan import Form, joined, scan_of
from aionode.qos import qos_profile_sensor_data

__all__ = ["YdlidarDriver", "main"]

START_SEC: Final = 0.01
RETRY_SEC: Final = 0.3
WAKE_SEC: Final = 0.1
"""The longest time until a command to stop ends the scans."""

SILENCE_SEC: Final = 2.0
"""The time without a packet after which the lidar counts as lost."""

CHECK_SEC: Final = 2.5
"""The time for the first revolution, to be multiplied by `abnormal_check_count`."""

MAX_POINTS: Final = 5000
"""The most points of a revolution; longer ones are dropped."""

NETWORK: Final = {1: "TCP", 2: "UDP"}


class YdlidarDriver(Node):
    """Publishes `scan`, and has the services `start_scan` and `stop_scan`.

    Raises:
        CommandError: A parameter is invalid.
    """

    def __init__(self) -> None:
        super().__init__("ydlidar_ros2_driver_node")
        self.path = self.declare_parameter("port", "/dev/ydlidar").value
        self.baudrate = self.declare_parameter("baudrate", 230400).value
        self.lidar_type = self.declare_parameter("lidar_type", TRIANGLE).value
        device_type = self.declare_parameter("device_type", 0).value
        self.rate = self.declare_parameter("sample_rate", 9).value
        checks = self.declare_parameter("abnormal_check_count", 4).value
        self.bits = self.declare_parameter("intensity_bit", 0).value
        self.is_fixed = self.declare_parameter("fixed_resolution", False).value
        self.reconnects = self.declare_parameter("auto_reconnect", True).value
        self.is_silent = self.declare_parameter("isSingleChannel", False).value
        self.declare_parameter("intensity", False)
        self.has_dtr = self.declare_parameter("support_motor_dtr", False).value
        self.shows_bytes = self.declare_parameter("debug", False).value
        self.frequency = self.declare_parameter("frequency", 10.0).value
        self.form = self.declared_form()
        if device_type in NETWORK:
            raise CommandError(
                f"device_type is {device_type} ({NETWORK[device_type]}), which is not available; "
                "use 0, a serial port"
            )
        if self.lidar_type not in TYPES:
            raise CommandError(
                f"lidar_type is {self.lidar_type}; use 0 (TOF), 1 (triangle) or 4 (SCL): others "
                "have protocols that are not available"
            )
        if self.bits not in SAMPLES:
            raise CommandError(f"intensity_bit is {self.bits}; use 0, 8, 10 or 16")
        if not 0.0 < self.frequency < math.inf:
            raise CommandError(f"frequency is {self.frequency}; use a number above 0, in Hz")
        self.patience_sec = CHECK_SEC * min(max(checks, 2), 100)
        self.count = 0
        self.parts: list[Points] = []
        self.began_ns: int | None = None
        self.size = 0
        self.has_run = self.has_failed = False
        self.wanted = asyncio.Event()
        self.wanted.set()
        self.publisher = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self.create_service(Empty, "stop_scan", self.on_stop_scan)
        self.create_service(Empty, "start_scan", self.on_start_scan)
        create_wall_timer(self, START_SEC, self.work)

    def declared_form(self) -> Form:
        """Return the form of scans that the parameters ask for.

        Raises:
            CommandError: A parameter is invalid.
        """
        value = {
            name: self.declare_parameter(name, default).value
            for name, default in (
                *(("frame_id", "laser_frame"), ("ignore_array", "")),
                *(("reversion", True), ("inverted", True), ("invalid_range_is_inf", False)),
                *(("angle_min", -180.0), ("angle_max", 180.0)),
                *(("range_min", 0.1), ("range_max", 64.0)),
            )
        }
        angles = sorted((value["angle_min"], value["angle_max"]))
        ranges = (value["range_min"], value["range_max"])
        if not -180.0 <= angles[0] < angles[1] <= 180.0:
            raise CommandError(
                f"angle_min is {value['angle_min']} and angle_max {value['angle_max']}; use two "
                "angles from -180 to 180, in degrees"
            )
        if not 0.0 <= ranges[0] < ranges[1] < math.inf:
            raise CommandError(
                f"range_min is {ranges[0]} and range_max {ranges[1]}; use two ranges from 0, in "
                "metres, of which the second is greater"
            )
        return Form(
            frame_id=value["frame_id"],
            angles=(math.radians(angles[0]), math.radians(angles[1])),
            ranges=ranges,
            ignored=pairs(value["ignore_array"]),
            is_turned=value["reversion"],
            is_mirrored=value["inverted"],
            missing=math.inf if value["invalid_range_is_inf"] else 0.0,
        )

    async def work(self) -> None:
        """Publish scans until the node ends.

        Raises:
            CommandError: There is no lidar, or it is gone and `auto_reconnect` is false.
        """
        while True:
            try:
                await self.serve()
            except OSError as error:
                text = error.strerror or str(error)
                if not (self.has_run and self.reconnects):
                    raise CommandError(text) from None
                if not self.has_failed:
                    self.get_logger().warning(f"{text}; trying until it is back")
                self.has_failed = True
            await wall_clock(self).sleep(RETRY_SEC)

    async def serve(self) -> None:
        """Connect to the lidar, and publish its scans while that is wanted.

        Raises:
            OSError: There is no lidar, or it is gone.
        """
        port = await SerialPort.open(self.path, self.baudrate, dtr=not self.has_dtr)
        lidar = Lidar(
            port,
            self.lidar_type,
            self.get_logger(),
            wall_clock(self),
            has_answers=not self.is_silent,
            runs_with_dtr=self.has_dtr,
            shows_bytes=self.shows_bytes,
        )
        try:
            self.get_logger().info(f"Lidar successfully connected [{self.path}:{self.baudrate}]")
            await lidar.prepare(self.frequency, self.rate)
            while True:
                await self.wanted.wait()
                await self.scan(lidar)
        finally:
            lidar.stop()
            port.close()

    async def scan(self, lidar: Lidar) -> None:
        """Publish scans until they are no longer wanted.

        Raises:
            OSError: It sends no packets, or the port is gone.
        """
        packets = Packets(self.bits)
        clock, kind = wall_clock(self), lidar.kind()
        self.parts.clear()
        self.began_ns, self.count, self.size = None, 0, 0
        data = await lidar.start()
        heard, limit = clock.now(), self.patience_sec
        while self.wanted.is_set():
            found = packets.feed(data)
            for packet in found:
                self.take(packet, packet.points(kind), lidar)
            if found and self.count:
                heard, limit = clock.now(), SILENCE_SEC
            elif (clock.now() - heard).nanoseconds / 1e9 > limit:
                raise OSError(
                    f"{self.path} has sent no scan for {limit:g} s; check the lidar's motor and "
                    "supply, baudrate and intensity_bit"
                )
            data = b""
            try:
                async with asyncio.timeout(WAKE_SEC):
                    data = await lidar.port.read()
            except TimeoutError:
                pass
        lidar.stop()
        self.get_logger().info("Lidar has stopped!")

    def take(self, packet: Packet, points: Points, lidar: Lidar) -> None:
        """Add a packet to the revolution; publish the one that ends with it."""
        if packet.is_start:
            now_ns = self.get_clock().now().nanoseconds
            if self.began_ns is not None:
                self.publish(joined(self.parts), self.began_ns, now_ns, lidar)
            self.parts.clear()
            self.began_ns = now_ns
            self.size = 0
        if self.size < MAX_POINTS:
            self.parts.append(points)
            self.size += len(points.ranges)

    def publish(self, points: Points, began_ns: int, now_ns: int, lidar: Lidar) -> None:
        """Publish a revolution that ends now."""
        size = len(points.ranges)
        seconds = max(now_ns - began_ns, 0) / 1e9
        if not self.count:
            self.count = self.fixed_count(size, seconds, lidar)
            self.has_run, self.has_failed = True, False
            self.get_logger().info("Lidar has started!")
        count = self.count if self.is_fixed else size
        scan = scan_of(points, self.form, max(count, 2), lidar.offset)
        scan.scan_time, scan.time_increment = seconds, seconds / size
        scan.header.stamp = stamp_of(began_ns)
        self.publisher.publish(scan)

    def fixed_count(self, size: int, seconds: float, lidar: Lidar) -> int:
        """Return the steps of a revolution with a fixed resolution, from the first revolution."""
        if self.is_silent or not lidar.rates:
            return max(round(size, -1), 10)
        measured = size / seconds / 1e3 if seconds else 0.0
        rates = lidar.rates
        near = (low for low, high in pairwise(rates) if measured <= low + (high - low) / 5)
        rate = next(near, rates[-1])
        return min(max(int((rate + 0.3) * 1e3 / lidar.frequency), 10), MAX_POINTS)

    def on_stop_scan(self, _: Any, response: Any) -> Any:
        """Stop the lidar until `start_scan` is called."""
        self.wanted.clear()
        return response

    def on_start_scan(self, _: Any, response: Any) -> Any:
        """Start the lidar, unless it is running."""
        self.wanted.set()
        return response


def pairs(text: str) -> tuple[tuple[float, float], ...]:
    """Return the pairs of angles in `ignore_array`, in radians.

    Raises:
        CommandError: The text is not a list of pairs.
    """
    words = [word for word in text.split(",") if word.strip()]
    try:
        angles = [math.radians(float(word)) for word in words]
    except ValueError:
        angles = [math.nan]
    if len(angles) % 2 or not all(map(math.isfinite, angles)):
        raise CommandError(
            f"ignore_array is {text!r}; use pairs of angles in degrees, such as '-90, -80, 30, 40'"
        )
    return tuple(zip(angles[::2], angles[1::2], strict=True))


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(YdlidarDriver)
