"""Drive until Ctrl-C, then publish a last message that stops the wheels.

Run it with ``python examples/last_message.py``, watch it with ``aionode topic echo /cmd_vel``, and
end it with Ctrl-C.
"""

import aionode
from aionode import Node
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3


class Wanderer(Node):
    """Publishes a velocity ten times a second."""

    def __init__(self) -> None:
        super().__init__("wanderer")
        self.cmd_vel = self.create_publisher(Twist, "/cmd_vel", 10)
        self.start = self.create_timer(0.0, self.wander)

    async def wander(self) -> None:
        """Drive; stop the wheels on Ctrl-C, SIGTERM, destroy_node or an error."""
        self.start.cancel()
        try:
            async for _ in self.create_rate(10):
                self.cmd_vel.publish(Twist(linear=Vector3(x=0.2)))
        finally:
            self.cmd_vel.publish(Twist())


if __name__ == "__main__":
    aionode.run(Wanderer)
