"""Drive with a lease: the wheels stop however this program ends, and when it hangs.

Run it with ``python examples/leased_driver.py``, and the wheels with ``python examples/wheels.py``.
"""

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3


class Driver(Node):
    """Publishes a velocity twenty times a second."""

    def __init__(self) -> None:
        super().__init__("driver")
        self.cmd_vel = self.create_publisher(Twist, "/cmd_vel", 1)
        self.start = self.create_timer(0.0, self.drive)

    async def drive(self) -> None:
        """Drive; the stop is sent when the block ends, or after 0.3 s without a command."""
        self.start.cancel()
        async with self.cmd_vel.lease(stop=Twist(), ttl_sec=0.3) as lease:
            async for _ in self.create_rate(20):
                lease.publish(Twist(linear=Vector3(x=0.2)))


if __name__ == "__main__":
    aionode.run(Driver)
