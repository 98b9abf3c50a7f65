"""One of two processes that communicate over Zenoh, or both ends in one, by its argument."""

from __future__ import annotations

import asyncio
import importlib
import pkgutil
import sys

import aionode
import aionode.rclpy
from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import Trigger


def tell(*words: object) -> None:
    """Print a line at once."""
    print(*words, flush=True)  # noqa: T201  # read by the test


class Talker(Node):
    """Publishes the same repeatedly, and serves."""

    def __init__(self, **options: object) -> None:
        super().__init__("talker", **options)  # type: ignore[arg-type]
        publisher = self.create_publisher(String, "/chatter", 10)
        self.create_timer(0.02, lambda: publisher.publish(String(data="hello")))
        self.create_service(Trigger, "/ask", self.answer)

    def answer(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Answer with success."""
        del request
        response.success = True
        return response


async def listen(context: Context) -> None:
    """Receive a message, and call a service."""
    async with asyncio.timeout(20), Node("listener", context=context) as node:
        subscription = node.create_subscription(String, "/chatter", None, 10)
        for _ in range(3):
            tell("heard", (await subscription.receive()).data)
        client = node.create_client(Trigger, "/ask")
        await client.wait_for_service()
        tell("answer", (await client.call(Trigger.Request())).success)


async def both() -> None:
    """Communicate within one process."""
    async with Context(transport="local") as context, Talker(context=context):
        await listen(context)


if __name__ == "__main__":
    if sys.argv[1] == "import":
        aionode.rclpy.install()  # what evaluates launch files imports launch
        for module in pkgutil.walk_packages(aionode.__path__, "aionode."):
            if not module.name.endswith("__main__"):
                importlib.import_module(module.name)
        tell("imported")
    elif sys.argv[1] == "both":
        asyncio.run(both())
    elif sys.argv[1] == "listen":
        asyncio.run(listen(Context()))
    else:
        aionode.run(Talker)
