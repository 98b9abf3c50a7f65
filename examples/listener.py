"""Print the messages of /chatter."""

import aionode
from aionode import Node
from aionode.interfaces.std_msgs.msg import String


class Listener(Node):
    """Subscribes with a callback, which may be a function or a coroutine function."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.create_subscription(String, "/chatter", self.hear, 10)

    async def hear(self, msg: String) -> None:
        """Print one message."""
        print(f"I heard: {msg.data}")


if __name__ == "__main__":
    aionode.run(Listener)
