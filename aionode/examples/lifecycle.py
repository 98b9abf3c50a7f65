"""A program configures, activates and shuts down a managed talker.

It is ROS 2's lifecycle demo with async and await. Run it with
``python -m aionode.examples.lifecycle``.
"""

from __future__ import annotations

import asyncio

import aionode
from aionode import Node
from aionode.errors import TransitionError
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleManager, LifecycleNode, State, TransitionCallbackReturn

__all__ = ["Talker", "application", "main"]


class Talker(LifecycleNode):
    """Publishes greetings while it is active; its device takes a moment to open."""

    def __init__(self) -> None:
        super().__init__("lifecycle_talker")
        self.broken = False
        self.count = 0
        self.publisher = self.create_lifecycle_publisher(String, "/lifecycle_chatter", 10)
        self.create_lifecycle_timer(0.1, self.say)

    async def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Open the device; the time it takes is awaited, and can be canceled."""
        if self.broken:
            raise OSError("no device at /dev/voice")
        for done in (0.5, 1.0):
            await self.get_clock().sleep(0.05)
            self.report_progress(f"opening the device, {state.label} so far", done)
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: State, error: Exception | None = None) -> TransitionCallbackReturn:
        """Prepare for another try. Unlike rclpy's, this callback gets the error."""
        print(f"on_error:   after {state.label}: {error}", flush=True)
        self.broken = False
        return TransitionCallbackReturn.SUCCESS

    def say(self) -> None:
        """Publish one greeting."""
        self.count += 1
        self.publisher.publish(String(data=f"Hello {self.count}"))


async def application() -> None:
    """Fail, be canceled, then activate the talker, receive three messages, and shut it down."""
    talker = Talker()
    async with talker, Node("manager") as node:
        greetings = node.create_subscription(String, "/lifecycle_chatter")

        talker.broken = True
        try:
            await talker.trigger_configure()
        except TransitionError as error:
            print(f"error:      {error}", flush=True)

        try:
            async with asyncio.timeout(0.02):
                await talker.trigger_configure()
        except TimeoutError:
            print(f"canceled:   the talker is {talker.lifecycle_state}", flush=True)

        async with LifecycleManager(node, ["/lifecycle_talker"]):
            print(f"up:         the talker is {talker.lifecycle_state}", flush=True)
            for _ in range(3):
                print(f"heard:      {(await greetings.receive()).data}", flush=True)
        print(f"down:       the talker is {talker.lifecycle_state}", flush=True)


def main() -> None:
    """Run the application until it is done, or until Ctrl-C."""
    aionode.run(application)


if __name__ == "__main__":
    main()
