"""Drive until Ctrl-C, and stop the wheels with the last message.

Run it with ``python examples/last_message.py``, watch it with ``aionode topic echo /cmd_vel``, and
end it with Ctrl-C.
"""

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3


class Wanderer(Node):
    """Drives on, ten commands a second."""

    def __init__(self) -> None:
        super().__init__("wanderer")
        self.cmd_vel = self.create_publisher(Twist, "/cmd_vel", 10)
        self.start = self.create_timer(0.0, self.wander)

    async def wander(self) -> None:
        """Drive, and stop whatever ends it: Ctrl-C, SIGTERM, destroy_node, an error."""
        self.start.cancel()
        try:
            async for _ in self.create_rate(10):
                self.cmd_vel.publish(Twist(linear=Vector3(x=0.2)))
        finally:
            self.cmd_vel.publish(Twist())


if __name__ == "__main__":
    aionode.run(Wanderer)
