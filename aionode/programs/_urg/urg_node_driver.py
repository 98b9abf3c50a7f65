"""``urg_node urg_node_driver``: publishes the scans of a Hokuyo."""

from __future__ import annotations

import asyncio
import errno
import math
import statistics
from typing import Any, Final

import aionode
from aionode import Node, Parameter
from aionode.diagnostics import FrequencyStatusParam, HeaderlessTopicDiagnostic, Updater
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.programs._serial import SerialPort
from aionode.programs._stamps import stamp_of
from aionode.programs._urg.scans import Echoes, Window
from aionode.programs._urg.scip import (
    ANSWER_SEC,
    Limits,
    Link,
    Reply,
    Scip,
    Socket,
    echoes_in,
    time_of,
)
from aionode.programs._wall_timer import create_wall_timer, wall_clock

__all__ = ["UrgNode", "main"]

START_SEC: Final = 0.01
RETRY_SEC: Final = 0.5
RECONNECT_SEC: Final = 2.0
PERIODS: Final = 16
"""How many periods to wait for the next scan."""

MEASUREMENTS: Final = 10
WELL: Final = {"Sensor works well.", "Stable 000 no error.", "sensor is working normally"}

RANGES: Final = {"cluster": (1, 99), "skip": (0, 9), "error_limit": (0, 10**9)}
"""The least and the greatest value of parameters."""

NUMBERS: Final = ("default_user_latency", "angle_min", "angle_max")
MOST: Final = 1e6
FRAME: Final = "laser_frame_id"


class UrgNode(Node):
    """Publishes `scan`, or `echoes` and what they contain, and offers `update_laser_status`.

    Raises:
        CommandError: A parameter is invalid.
    """

    def __init__(self) -> None:
        super().__init__("urg_node")
        self.host = self.declare_parameter("ip_address", "").value
        self.port = self.declare_parameter("ip_port", 10940).value
        self.declare_parameter(FRAME, "laser")
        self.path = self.declare_parameter("serial_port", "/dev/ttyACM0").value
        self.baudrate = self.declare_parameter("serial_baud", 115200).value
        self.calibrates = self.declare_parameter("calibrate_time", False).value
        self.has_intensities = self.declare_parameter("publish_intensity", False).value
        self.has_echoes = self.declare_parameter("publish_multiecho", False).value
        self.declare_parameter("error_limit", 4)
        tolerance = self.declare_parameter("diagnostics_tolerance", 0.05).value
        window = self.declare_parameter("diagnostics_window_time", 5.0).value
        if self.declare_parameter("get_detailed_status", False).value:
            self.get_logger().warning(
                "get_detailed_status has no effect: neither the commands of safety lidars nor "
                "urg_node_msgs are available"
            )
        self.declare_parameter("default_user_latency", 0.0)
        self.declare_parameter("angle_min", -3.14)
        self.declare_parameter("angle_max", 3.14)
        self.declare_parameter("skip", 0)
        self.declare_parameter("cluster", 1)
        self.check_initial_parameters(tolerance, window)
        self.scip: Scip | None = None
        self.is_started = False
        self.error_count = 0
        self.status = "not connected."
        self.about = dict.fromkeys(
            ("Vendor Name", "Product Name", "Firmware Version", "Firmware Date"), ""
        ) | {"Protocol Version": "", "Device ID": ""}
        self.latency_sec = 0.0
        self.told = asyncio.Event()
        self.scans = None if self.has_echoes else self.create_publisher(LaserScan, "scan", 20)
        self.echoes = Echoes(self) if self.has_echoes else None
        self.create_service(Trigger, "update_laser_status", self.on_update_laser_status)
        self.updater = Updater(self)
        self.updater.add("Hardware Status", self.check_hardware)
        self.rate = {"min": 0.0, "max": math.inf}
        self.frequency = HeaderlessTopicDiagnostic(
            "Laser Echoes" if self.has_echoes else "Laser Scan",
            self.updater,
            FrequencyStatusParam(self.rate, tolerance, int(window)),
        )
        self.add_on_set_parameters_callback(self.check_parameters)
        create_wall_timer(self, START_SEC, self.work)

    # Parameters

    def check_initial_parameters(self, tolerance: float, window: float) -> None:
        """Check the parameters that were given at the start.

        Raises:
            CommandError: One is invalid.
        """
        given = [self.get_parameter(name) for name in (*RANGES, *NUMBERS)]
        result = self.check_parameters(given)
        if not result.successful:
            raise CommandError(result.reason)
        if not 1 <= self.port <= 65535:
            raise CommandError(f"ip_port is {self.port}; use a number from 1 to 65535")
        if not (0.0 <= tolerance < math.inf and 1.0 <= window <= MOST):
            raise CommandError(
                f"diagnostics_tolerance is {tolerance} and diagnostics_window_time {window}; use "
                "at least 0 and at least 1 s"
            )

    def check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        """Return whether new values are valid; they take effect at the next connection."""
        for parameter in parameters:
            name, value = parameter.name, parameter.value
            least, greatest = RANGES.get(name, (-MOST, MOST))
            if name in (*RANGES, *NUMBERS) and not least <= value <= greatest:
                reason = f"{name} is {value}; use a number from {least} to {greatest}"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    # The connection

    async def work(self) -> None:
        """Publish scans until the node ends; connect again whenever that fails."""
        clock = wall_clock(self)
        while True:
            pause_sec = RETRY_SEC
            try:
                link = await self.open()
            except OSError as error:
                self.complain(f"Error connecting to Hokuyo: {error}")
            else:
                self.scip = Scip(link)
                try:
                    await self.serve(self.scip)
                except OSError as error:
                    self.complain(f"{error.strerror or error}; reconnecting")
                    pause_sec = RECONNECT_SEC if self.is_started else RETRY_SEC
                finally:
                    scip, self.scip, self.is_started = self.scip, None, False
                    await scip.close()
            await clock.sleep(pause_sec)

    def complain(self, text: str) -> None:
        """Log an error, though not each time that it is repeated."""
        self.get_logger().error(text, throttle_duration_sec=10.0)

    async def open(self) -> Link:
        """Connect to the lidar.

        Raises:
            OSError: It is not there.
        """
        if self.host:
            return await Socket.open(self.host, self.port)
        return await SerialPort.open(self.path, self.baudrate)

    async def serve(self, scip: Scip) -> None:
        """Publish the scans of a lidar.

        Raises:
            OSError: It does not answer, or there were too many errors.
        """
        await scip.begin()
        limits = await scip.limits()
        await self.identify(scip)
        skip = self.get_parameter("skip").value
        window = self.window(limits)
        self.rate["min"] = self.rate["max"] = 1.0 / (limits.period_sec * (skip + 1))
        self.updater.setHardwareID(self.about["Device ID"])
        timeout_sec = (PERIODS + 2 * skip) * limits.period_sec
        if self.calibrates:
            await self.calibrate(scip, window, timeout_sec)
        await self.start(scip, window, skip)
        self.is_started = True
        self.error_count = 0
        self.get_logger().info("Streaming data.")
        while True:
            try:
                async with asyncio.timeout(timeout_sec):
                    reply = await scip.receive()
                self.take(reply, window)
            except TimeoutError:
                self.count_error(f"no scan for {timeout_sec:.2f} s")
            except OSError as error:
                if error.errno != errno.EBADMSG:
                    raise
                self.count_error(str(error.strerror))

    def count_error(self, problem: str) -> None:
        """Note a scan that could not be used.

        Raises:
            OSError: There were too many.
        """
        self.error_count += 1
        kind = "multi" if self.has_echoes else "single"
        self.get_logger().warning(f"Could not grab {kind} echo scan: {problem}")
        if self.error_count > self.get_parameter("error_limit").value:
            raise OSError("Error count exceeded limit")

    async def identify(self, scip: Scip) -> None:
        """Query the identity and the health of the lidar.

        Raises:
            OSError: It does not answer.
        """
        reply = await scip.command("VV")
        firmware = reply.text("FIRM")
        version, _, rest = firmware.partition("(")
        self.about = {
            "Vendor Name": reply.text("VEND"),
            "Product Name": reply.text("PROD"),
            "Firmware Version": version,
            "Firmware Date": rest.partition(")")[0],
            "Protocol Version": reply.text("PROT"),
            "Device ID": reply.text("SERI"),
        }
        self.status = (await scip.command("II")).text("STAT")
        self.get_logger().info(
            f"Connected to{' multiecho' if self.has_echoes else ''} "
            f"{'network' if self.host else 'serial'} device with"
            f"{' intensity and' if self.has_intensities else ''} ID: {self.about['Device ID']}"
        )

    def window(self, limits: Limits) -> Window:
        """Return what to measure, according to the parameters."""
        value = {each.name: each.value for each in self.get_parameters([*RANGES, *NUMBERS, FRAME])}
        first, last = sorted(limits.step(value[name]) for name in ("angle_min", "angle_max"))
        if first == last:
            first, last = (first, last + 1) if first <= limits.amin else (first - 1, last)
        return Window(
            *(limits, max(first, 0), last),
            *(value["cluster"], value["default_user_latency"], value[FRAME]),
        )

    async def start(self, scip: Scip, window: Window, skip: int) -> None:
        """Start the lidar's scans.

        Raises:
            OSError: The lidar does not start them.
        """
        command = window.command(skip, has_echoes=self.has_echoes, is_intense=self.has_intensities)
        try:
            await scip.command(command)
        except OSError as error:
            if error.errno != errno.EPROTO or not (self.has_intensities or self.has_echoes):
                raise
            raise OSError(
                f"{error.strerror}; check whether this lidar measures what publish_intensity and "
                "publish_multiecho ask for"
            ) from None

    async def calibrate(self, scip: Scip, window: Window, timeout_sec: float) -> None:
        """Measure how long scans take to get here.

        Raises:
            OSError: The lidar does not answer.
        """
        self.get_logger().info("Starting calibration. This will take a few seconds.")
        self.get_logger().warning("Time calibration is still experimental.")
        begin_sec = await self.clock_offset_sec(scip)
        before_sec = 0.0
        found = []
        for _ in range(MEASUREMENTS):
            scan_sec = await self.scan_offset_sec(scip, window, timeout_sec) - begin_sec
            after_sec = await self.clock_offset_sec(scip) - begin_sec
            found.append(scan_sec - (before_sec + after_sec) / 2)
            before_sec = after_sec
        self.latency_sec = statistics.median_high(found)
        total_sec = self.latency_sec + window.turn_sec
        self.get_logger().info(f"Calibration finished. Latency is: {total_sec:.4f} sec.")

    async def clock_offset_sec(self, scip: Scip) -> float:
        """Return the time of the lidar minus the time here."""
        clock = self.get_clock()
        await scip.command("TM0")
        before = clock.now().nanoseconds
        there_ms = await scip.time_ms()
        after = clock.now().nanoseconds
        await scip.command("TM2")
        return there_ms / 1e3 - (before + after) / 2e9

    async def scan_offset_sec(self, scip: Scip, window: Window, timeout_sec: float) -> float:
        """Return the time of a scan minus the time of its arrival."""
        await self.start(scip, window, 0)
        try:
            async with asyncio.timeout(timeout_sec):
                while (reply := await scip.receive()).status != "99":
                    pass
        except TimeoutError:
            raise OSError("Cannot get scan to measure time stamp offset.") from None
        offset_sec = time_of(reply) / 1e3 - self.get_clock().now().nanoseconds / 1e9
        await scip.command("QT")
        return offset_sec

    # Scans

    def take(self, reply: Reply, window: Window) -> None:
        """Publish a scan, or record the status of the lidar if the reply has that instead.

        Raises:
            OSError: It is damaged.
        """
        if reply.echo == "II":
            self.status = reply.text("STAT")
            self.told.set()
            return
        if not reply.echo.startswith(("M", "N")) or reply.status != "99" or not reply.lines:
            self.count_error(f"{reply.echo!r:.40} was answered by status {reply.status!r}")
            return
        now = self.get_clock().now().nanoseconds
        reply.check()
        time_of(reply)
        data = reply._replace(lines=reply.lines[1:]).data()
        values = echoes_in(data, window.size, has_intensities=self.has_intensities)
        delay_sec = self.latency_sec + window.latency_sec + window.turn_sec
        stamp = stamp_of(now + round(delay_sec * 1e9))
        if self.echoes is not None:
            self.echoes.publish(window, stamp, values)
        elif self.scans is not None:
            self.scans.publish(window.scan(stamp, values[..., 0]))
        self.frequency.tick()

    async def on_update_laser_status(self, _: Any, response: Any) -> Any:
        """Request the lidar's status."""
        self.get_logger().info("Got update lidar status callback")
        response.message = "Failed to update status"
        if self.scip is not None and self.is_started:
            self.told.clear()
            try:
                self.scip.send("II")
                async with asyncio.timeout(ANSWER_SEC):
                    await self.told.wait()
            except OSError:  # it does not answer in time, or is gone
                return response
            response.success, response.message = True, "Status retrieved"
        return response

    def check_hardware(self, status: Any) -> Any:
        """Fill the diagnostics of the lidar."""
        if self.scip is None:
            status.summary(DiagnosticStatus.ERROR, "Not Connected")
            return status
        if self.host:
            status.add("IP Address", self.host)
            status.add("IP Port", self.port)
        else:
            status.add("Serial Port", self.path)
            status.add("Serial Baud", self.baudrate)
        if not self.is_started:
            status.summary(DiagnosticStatus.ERROR, f"Not Connected: {self.status}")
        elif self.status not in WELL:
            status.summary(DiagnosticStatus.ERROR, f"Abnormal status: {self.status}")
        else:
            status.summary(DiagnosticStatus.OK, "Streaming")
        for name, value in self.about.items():
            status.add(name, value)
        status.add("Computed Latency", round(self.latency_sec * 1e9))
        status.add(
            "User Time Offset", round(self.get_parameter("default_user_latency").value * 1e9)
        )
        status.add("Device Status", self.status)
        status.add("Scan Retrieve Error Count", self.error_count)
        return status


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(UrgNode)
