"""A lidar driver that reports its health on /diagnostics.

Run it with ``python examples/diagnostics.py``, and see it with ``aionode topic echo /diagnostics``.
"""

from __future__ import annotations

import aionode
from aionode import Context, Node
from aionode.diagnostics import (
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    FrequencyStatusParam,
    TimeStampStatusParam,
    Updater,
)
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.interfaces.sensor_msgs.msg import LaserScan


class Lidar(Node):
    """Publishes ten scans a second."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__("lidar", context=context)
        updater = Updater(self)
        updater.setHardwareID("lidar 0042")
        updater.add("temperature", self.check_temperature)
        self.scans = DiagnosedPublisher(
            self.create_publisher(LaserScan, "/scan", 10),
            updater,
            FrequencyStatusParam({"min": 10.0, "max": 10.0}, tolerance=0.2),
            TimeStampStatusParam(max_acceptable=0.5),
        )
        self.create_timer(0.1, self.scan)

    def scan(self) -> None:
        """Publish a scan."""
        message = LaserScan()
        message.header.stamp = self.get_clock().now().to_msg()
        self.scans.publish(message)

    async def check_temperature(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Report the temperature of the device."""
        celsius = await self.read_temperature()
        if celsius > 60.0:
            stat.summary(DiagnosticStatus.WARN, "too warm")
        else:
            stat.summary(DiagnosticStatus.OK, "as warm as it should be")
        stat.add("temperature (°C)", f"{celsius:.1f}")
        return stat

    async def read_temperature(self) -> float:
        """Ask the device, which takes a while."""
        await self.get_clock().sleep(0.02)
        return 41.5


if __name__ == "__main__":
    aionode.run(Lidar)
